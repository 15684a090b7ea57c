//! Sectors: the corners around a vertex from one feature edge to the next, or all of them; and the pieces into which feature edges cut a
//! surface. Edges of the boundary are features.

use crate::error::Result;
use crate::mesh::{EdgeId, FixedEdges, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, PerVertex, VertexId};

/// The number of a half-edge that lies in no sector, since it has no face.
const OUTSIDE: u32 = u32::MAX;

/// The sectors of a surface, numbered by vertex. Flips of edges that are no features change neither sectors nor pieces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sectors {
    is_feature: PerEdge<bool>,
    /// Per vertex its sector, if no feature edge ends there.
    whole: PerVertex<Option<u32>>,
    /// Per half-edge on a feature, with a face, the sector that begins at it and goes on counterclockwise.
    beginning: PerHalfedge<Option<u32>>,
    /// Per sector the vertex that it lies at.
    pub vertex: Vec<VertexId>,
    /// Per sector the piece of the surface that it lies in.
    pub piece: Vec<u32>,
    /// The number of pieces.
    pub n_pieces: usize,
}

impl Sectors {
    /// The sectors between these feature edges and those of the boundary.
    ///
    /// # Errors
    /// [`crate::Error::Argument`] for an edge that the mesh does not have.
    pub fn new(mesh: &Mesh, features: &[EdgeId]) -> Result<Sectors> {
        let listed = FixedEdges::new(mesh, features)?;
        let is_feature = PerEdge::from_fn(mesh.n_edges(), |e| listed.contains(e) || mesh.is_boundary_edge(e));
        let mut whole = PerVertex::filled(mesh.n_vertices(), None);
        let mut beginning = PerHalfedge::filled(mesh.n_halfedges(), None);
        let mut vertex = Vec::new();
        for v in mesh.vertices() {
            let ends = mesh.outgoing(v).filter(|h| is_feature[h.edge()]);
            let mut ends: Vec<HalfedgeId> = ends.filter(|&h| mesh.face(h).is_some()).collect();
            ends.sort_unstable();
            for h in &ends {
                beginning[*h] = Some(vertex.len() as u32);
                vertex.push(v);
            }
            if ends.is_empty() {
                whole[v] = Some(vertex.len() as u32);
                vertex.push(v);
            }
        }
        let mut sectors =
            Sectors { is_feature, whole, beginning, piece: vec![0; vertex.len()], vertex, n_pieces: 0 };
        let (pieces, n_pieces) = sectors.pieces_of_faces(mesh);
        let corners = sectors.of_corners(mesh);
        for f in mesh.faces() {
            for h in mesh.face_halfedges(f) {
                sectors.piece[corners[h] as usize] = pieces[f];
            }
        }
        sectors.n_pieces = n_pieces;
        Ok(sectors)
    }

    /// The number of sectors.
    pub fn len(&self) -> usize {
        self.vertex.len()
    }

    /// True for an edge on the boundary and for a feature.
    pub fn is_feature(&self, e: EdgeId) -> bool {
        self.is_feature[e]
    }

    /// True if there is no feature and no boundary.
    pub fn are_vertices(&self) -> bool {
        self.len() == self.whole.len() && self.whole.iter().all(Option::is_some)
    }

    /// True for a sector between features, false for one all around a vertex.
    pub fn is_bounded(&self, sector: usize) -> bool {
        self.whole[self.vertex[sector]].is_none()
    }

    /// The features, which are not flipped.
    ///
    /// # Errors
    /// None for the mesh that the sectors were made of.
    pub fn fixed(&self, mesh: &Mesh) -> Result<FixedEdges> {
        FixedEdges::new(mesh, &self.features())
    }

    /// The features and the edges of the boundary, ascending.
    pub fn features(&self) -> Vec<EdgeId> {
        (0..self.is_feature.len()).map(EdgeId::from).filter(|&e| self.is_feature[e]).collect()
    }

    /// The features inside the surface, ascending.
    pub fn inner_features(&self, mesh: &Mesh) -> Vec<EdgeId> {
        self.features().into_iter().filter(|&e| !mesh.is_boundary_edge(e)).collect()
    }

    /// The features inside the surface that do not bound this piece.
    pub fn features_off(&self, mesh: &Mesh, piece: u32) -> Vec<EdgeId> {
        let corners = self.of_corners(mesh);
        let is_off = |h: HalfedgeId| self.piece[corners[h] as usize] != piece;
        let inner = self.inner_features(mesh).into_iter();
        inner.filter(|e| is_off(e.halfedge()) && is_off(e.halfedge().twin())).collect()
    }

    /// Per half-edge the sector of the corner at its origin, in its face.
    pub fn of_corners(&self, mesh: &Mesh) -> PerHalfedge<u32> {
        let mut of = PerHalfedge::filled(mesh.n_halfedges(), OUTSIDE);
        for h in mesh.halfedges() {
            if let Some(sector) = self.whole[mesh.origin(h)] {
                of[h] = sector;
            }
            if let Some(sector) = self.beginning[h] {
                self.fan(mesh, h).into_iter().for_each(|x| of[x] = sector);
            }
        }
        of
    }

    /// The half-edges whose corners make up the sector that begins at a feature, counterclockwise.
    pub fn fan(&self, mesh: &Mesh, first: HalfedgeId) -> Vec<HalfedgeId> {
        let mut fan = vec![first];
        let mut last = mesh.prev(first);
        while !self.is_feature[last.edge()] {
            fan.push(last.twin());
            last = mesh.prev(last.twin());
        }
        fan
    }

    /// Per sector the half-edge at which it begins, of a sector all around a vertex any.
    pub fn beginnings(&self, mesh: &Mesh) -> Vec<HalfedgeId> {
        let mut first: Vec<_> = self.vertex.iter().map(|&v| mesh.out(v)).collect();
        for h in mesh.halfedges() {
            if let Some(sector) = self.beginning[h] {
                first[sector as usize] = h;
            }
        }
        first
    }

    /// The closed walks along features that bound the pieces, each as half-edges with the piece on their left.
    pub fn walks(&self, mesh: &Mesh) -> Vec<Vec<HalfedgeId>> {
        let mut is_seen = PerHalfedge::filled(mesh.n_halfedges(), false);
        let mut walks = Vec::new();
        for first in mesh.halfedges().filter(|&h| self.beginning[h].is_some()) {
            let (mut walk, mut h) = (Vec::new(), first);
            while !std::mem::replace(&mut is_seen[h], true) {
                walk.push(h);
                h = mesh.next(h);
                while !self.is_feature[h.edge()] {
                    h = mesh.next(h.twin());
                }
            }
            if !walk.is_empty() {
                walks.push(walk);
            }
        }
        walks
    }

    /// Per piece its Euler characteristic, that of the surface which cutting along all features leaves.
    pub fn euler(&self, mesh: &Mesh) -> Vec<i64> {
        // Twice χ = S − E + F: a piece has as many vertices as sectors, and a feature is an edge of its own on each of its sides.
        let mut twice = vec![0; self.n_pieces];
        self.piece.iter().for_each(|&p| twice[p as usize] += 2);
        let corners = self.of_corners(mesh);
        for f in mesh.faces() {
            let sides = mesh.face_halfedges(f);
            let halves: i64 = sides.iter().map(|h| if self.is_feature[h.edge()] { 2 } else { 1 }).sum();
            twice[self.piece[corners[sides[0]] as usize] as usize] += 2 - halves;
        }
        twice.into_iter().map(|x| x / 2).collect()
    }

    fn pieces_of_faces(&self, mesh: &Mesh) -> (PerFace<u32>, usize) {
        let mut piece = PerFace::filled(mesh.n_faces(), OUTSIDE);
        let mut n = 0;
        for first in mesh.faces() {
            if piece[first] != OUTSIDE {
                continue;
            }
            let mut waiting = vec![first];
            piece[first] = n;
            while let Some(f) = waiting.pop() {
                for h in mesh.face_halfedges(f).into_iter().filter(|h| !self.is_feature[h.edge()]) {
                    if let Some(g) = mesh.face(h.twin())
                        && piece[g] == OUTSIDE
                    {
                        piece[g] = n;
                        waiting.push(g);
                    }
                }
            }
            n += 1;
        }
        (piece, n as usize)
    }
}

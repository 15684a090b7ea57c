//! The common subdivision of source and target in the domain where they were matched.
//!
//! Edges of both are straight in the domain, so a face of the source and one of the target have convex pieces in common. The edges of the
//! source are traced through the target, the vertices of both, the crossings and the parts of edges make a planar graph, and the faces of
//! this graph are the pieces. All decisions are signs of determinants in double-double precision. So that none of these is 0, or
//! smaller than the gaps that rounding leaves between copies of the domain, vertices of the source are first moved aside by tiny
//! distances. Boundaries, which lie on each other, and common vertices stay where they are.

mod arcs;
mod opened;
mod pieces;
mod stand;
mod trace;

use super::cover::PlacedMesh;
use super::cover::WalkSeed;
use crate::archive::{in_range, stored};
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::{Motion, Space};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use crate::metric::{CommonSubdivision, Split};
use crate::parallel::within;
use arcs::OverlayGraph;
use opened::{OpenedFaces, opened};
use pieces::GivenSurface;
use stand::SettledVertices;

/// Both triangulations of a matching in the domain of the target.
#[derive(Debug, Clone, PartialEq)]
pub struct CommonDomain {
    /// The source and the target in the domain. An edge that joined two vertices of the boundary is halved.
    placed: [PlacedMesh; 2],
    seeds: [WalkSeed; 2],
    given: [GivenSurface; 2],
}
stored!(sections CommonDomain { placed, seeds, given } check CommonDomain::check_parts);

/// A face of the source or the target in the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DomainTriangle {
    /// In the plane as (x, y, 1), on the hyperboloid or on the sphere.
    pub corners: [[f64; 3]; 3],
    /// Its vertices. Numbers beyond those of the surface belong to vertices on edges that were halved.
    pub vertices: [VertexId; 3],
    /// The face of the surface that contains it.
    pub face: FaceId,
}

impl CommonDomain {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        for s in 0..2 {
            let (placed, given) = (&self.placed[s], &self.given[s]);
            let mesh = &placed.cover.mesh;
            check_size("frames of vertices", placed.at.len(), mesh.n_vertices())?;
            check_size("parts of faces", given.parts.len(), mesh.n_faces())?;
            in_range("face", given.parts.iter().map(|(f, _)| f.index()), given.mesh.n_faces())?;
            let (seed, other) = (self.seeds[s], &self.placed[1 - s].cover.mesh);
            in_range("vertex", [seed.vertex.index()].into_iter(), mesh.n_vertices())?;
            in_range("half-edge", [seed.near.index()].into_iter(), other.n_halfedges())?;
        }
        Ok(())
    }

    pub(super) fn new(placed: [PlacedMesh; 2], seeds: [WalkSeed; 2], splits: [&Split; 2]) -> CommonDomain {
        let given = [0, 1].map(|s| GivenSurface {
            mesh: splits[s].given().mesh().clone(),
            parts: placed[s].cover.mesh.faces().map(|f| splits[s].place(f)).collect(),
        });
        CommonDomain { placed, seeds, given }
    }

    /// The space of the domain.
    pub fn space(&self) -> Space {
        self.placed[1].cover.space
    }

    /// The faces of one of the two (0 the source, 1 the target) in the domain. The surface is opened along its cut, or grown about a face
    /// until it meets itself. Corners that meet in the opened surface have the same coordinates.
    pub fn triangles(&self, side: usize) -> Vec<DomainTriangle> {
        let placed = &self.placed[side];
        let mesh = &placed.cover.mesh;
        let OpenedFaces { homes, crossed } = opened(placed, self.seeds[1 - side].near);
        let mut one = UnionFind::new(mesh.n_halfedges());
        let is_whole = |h: &HalfedgeId| !mesh.is_outside(*h) && !mesh.is_outside(h.twin());
        let meets = mesh.halfedges().filter(is_whole).filter(|&h| placed.cover.across(h).is_none());
        for h in meets.chain(crossed) {
            one.join(h.0, mesh.next(h.twin()).0);
            one.join(h.twin().0, mesh.next(h).0);
        }
        let mut at: Vec<Option<[f64; 3]>> = vec![None; mesh.n_halfedges()];
        let mut corner = |h: HalfedgeId| {
            let home = mesh.face(h).map_or(Motion::identity(self.space()), |f| homes[f.index()]);
            let root = one.root(h.0) as usize;
            *at[root].get_or_insert_with(|| home.apply(placed.corner(h)).map(f64::from))
        };
        let of = |f: FaceId| DomainTriangle {
            corners: mesh.face_halfedges(f).map(&mut corner),
            vertices: mesh.face_vertices(f),
            face: self.given[side].parts[f.index()].0,
        };
        mesh.faces().map(of).collect()
    }

    /// The common subdivision of both triangulations: the map is projective on every triangle of it. The source's vertices lie where the
    /// matching has them up to 1e-5, mostly 1e-11, of the height of the triangles there. `threads`: 0 for one per core; the result does not
    /// depend on it.
    ///
    /// # Errors
    /// [`crate::Error::Matching`] if triangles are so thin that the sides of lines on which vertices lie cannot be decided;
    /// [`crate::Error::TooLarge`]; [`crate::Error::Cancelled`].
    pub fn overlay(&self, threads: usize, control: &Control) -> Result<CommonSubdivision> {
        control.check()?;
        within(threads, || {
            let [source, target] = &self.placed;
            let settled = SettledVertices::new([source, target], self.seeds, &control.part(0.0, 0.5))?;
            let arcs = OverlayGraph::new(&settled, target, &control.part(0.5, 0.9))?;
            control.check()?;
            pieces::subdivision(&arcs, &settled, target, [&self.given[0], &self.given[1]])
        })
    }
}

//! Makes one planar graph on the surface of both triangulations: vertices of either, crossings, the parts of edges between them, and their
//! order around every vertex.

use super::super::cover::PlacedMesh;
use super::stand::{SettledVertices, VertexPlace};
use super::trace::{Departure, EdgeTracer, TracedCrossing, TracedEdge};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::DoubleDouble;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, VertexId};
use crate::parallel;

/// Marks the absence of a number.
pub(super) const NONE: u32 = u32::MAX;
/// Largest number of half-edges per vertex and crossing. It bounds the size of graphs whose half-edges u32 can number.
const HALFEDGES_PER_VERTEX: usize = 16;

/// The graph. Its vertices are those of the source, those of the target (with gaps where they are at one of the source), and the crossings.
pub(super) struct OverlayGraph {
    /// Numbers of vertices of source and target.
    pub n: [usize; 2],
    pub crossings: Vec<TracedCrossing>,
    /// Per crossing, the edge of the source.
    pub crossed_by: Vec<EdgeId>,
    /// Per half-edge.
    pub origin: Vec<u32>,
    /// Per half-edge: the half-edge of the source, of the target, that it is a part of.
    pub along: [Vec<Option<HalfedgeId>>; 2],
    /// Per vertex the half-edges that leave it, counterclockwise, on the boundary from that along it to the one outside.
    pub around: Vec<Vec<u32>>,
}

/// The numbers of the parts of edges.
struct EdgeParts {
    /// Per edge of the target, its first part, and after the last edge the end.
    target: Vec<u32>,
    /// Per edge of the source, its first part; [`NONE`] for one that is an edge of the target, or on the boundary.
    source: Vec<u32>,
    /// Per edge of the source: the number of its first crossing, and after the last edge the end.
    first: Vec<u32>,
    /// Per crossing, and per vertex of the source on a side of the target: the number of others before it along the target's half-edge 2e.
    rank: Vec<u32>,
    side_rank: Vec<u32>,
}

impl EdgeParts {
    /// The half-edge along one of the target from its origin.
    fn leaving(&self, h: HalfedgeId) -> u32 {
        let [begin, end] = [0, 1].map(|k| self.target[h.edge().index() + k]);
        if h.0 & 1 == 0 { 2 * begin } else { 2 * (end - 1) + 1 }
    }

    /// The two half-edges that leave a point on one of the target, in its direction and against it. `rank`: the number of points before it.
    fn both(&self, h: HalfedgeId, rank: u32) -> [u32; 2] {
        let at = self.target[h.edge().index()] + rank;
        let [on, back] = [2 * (at + 1), 2 * at + 1];
        if h.0 & 1 == 0 { [on, back] } else { [back, on] }
    }

    /// The half-edge along one of the source from its origin.
    fn leaving_by(&self, h: HalfedgeId, paths: &[Option<TracedEdge>]) -> u32 {
        let e = h.edge().index();
        match &paths[e] {
            Some(TracedEdge::Along(along)) => self.leaving(if h.0 & 1 == 0 { *along } else { along.twin() }),
            _ if h.0 & 1 == 0 => 2 * self.source[e],
            _ => 2 * (self.source[e] + self.first[e + 1] - self.first[e]) + 1,
        }
    }
}

impl OverlayGraph {
    /// # Errors
    /// [`Error::Matching`] if lines are so near to each other that their order cannot be decided; [`Error::TooLarge`]; [`Error::Cancelled`].
    pub fn new(settled: &SettledVertices, target: &PlacedMesh, control: &Control) -> Result<OverlayGraph> {
        let paths = paths(settled, target, control)?;
        let (source_mesh, target_mesh) = (&settled.source.cover.mesh, &target.cover.mesh);
        let n = [source_mesh.n_vertices(), target_mesh.n_vertices()];
        let (mut crossings, mut crossed_by, mut first) = (Vec::new(), Vec::new(), vec![0u32]);
        for (e, path) in source_mesh.edges().zip(&paths) {
            if let Some(TracedEdge::Through(_, found)) = path {
                crossings.extend_from_slice(found);
                crossed_by.resize(crossings.len(), e);
            }
            first.push(crossings.len() as u32);
        }
        let count = n[0] + n[1] + crossings.len();
        if count > u32::MAX as usize / HALFEDGES_PER_VERTEX {
            return Err(Error::TooLarge { what: "vertices of an overlay", count });
        }
        let mut arcs = OverlayGraph {
            n,
            crossings,
            crossed_by,
            origin: Vec::new(),
            along: [Vec::new(), Vec::new()],
            around: vec![Vec::new(); count],
        };
        control.check()?;
        let parts = arcs.part_edges(settled, target_mesh, &paths, first)?;
        arcs.name_boundary(settled, target_mesh, &parts)?;
        control.check()?;
        arcs.turn(settled, target_mesh, &paths, &parts);
        if arcs.around.iter().map(Vec::len).sum::<usize>() != arcs.origin.len() {
            return Err(Error::Matching("edges of the overlay meet in no clear order".into()));
        }
        Ok(arcs)
    }

    pub fn tip(&self, h: u32) -> usize {
        self.origin[h as usize ^ 1] as usize
    }

    fn target_vertex(&self, settled: &SettledVertices, b: VertexId) -> u32 {
        settled.taken[b].map_or((self.n[0] + b.index()) as u32, |v| v.0)
    }

    /// Append the parts of an edge between points.
    fn part(&mut self, points: &[u32], along: [Option<HalfedgeId>; 2]) {
        for ends in points.windows(2) {
            self.origin.extend(ends);
            for (labels, along) in self.along.iter_mut().zip(along) {
                labels.extend([along, along.map(HalfedgeId::twin)]);
            }
        }
    }

    /// Append the parts of the target's edges, then those of the source's edges that run through its faces.
    fn part_edges(
        &mut self,
        settled: &SettledVertices,
        target: &Mesh,
        paths: &[Option<TracedEdge>],
        first: Vec<u32>,
    ) -> Result<EdgeParts> {
        let mut points: Vec<Vec<(DoubleDouble, u32)>> = vec![Vec::new(); target.n_edges()];
        let crossing_at = (self.n[0] + self.n[1]) as u32;
        for (k, crossing) in self.crossings.iter().enumerate() {
            points[crossing.halfedge.edge().index()].push((crossing.across, crossing_at + k as u32));
        }
        for (v, standing) in settled.forward.iter().enumerate() {
            if let VertexPlace::Side(_, x) = standing.at {
                let x = if standing.near.0 & 1 == 0 { x } else { -x };
                points[standing.near.edge().index()].push((x.into(), v as u32));
            }
        }
        let (mut rank, mut side_rank) = (vec![0; self.crossings.len()], vec![0; self.n[0]]);
        let mut starts = vec![0u32];
        for (e, points) in target.edges().zip(&mut points) {
            points.sort_by(|(x, i), (y, j)| {
                x.high.total_cmp(&y.high).then(x.low.total_cmp(&y.low)).then(i.cmp(j))
            });
            let [a, b] =
                [e.halfedge(), e.halfedge().twin()].map(|h| self.target_vertex(settled, target.origin(h)));
            for (k, &(_, v)) in points.iter().enumerate() {
                match v.checked_sub(crossing_at) {
                    Some(c) => rank[c as usize] = k as u32,
                    None => side_rank[v as usize] = k as u32,
                }
            }
            let all: Vec<u32> =
                std::iter::once(a).chain(points.iter().map(|p| p.1)).chain(std::iter::once(b)).collect();
            self.part(&all, [None, Some(e.halfedge())]);
            starts.push((self.origin.len() / 2) as u32);
        }
        let mut parts = EdgeParts { target: starts, source: vec![NONE; paths.len()], first, rank, side_rank };
        let mesh = &settled.source.cover.mesh;
        for (e, path) in mesh.edges().zip(paths) {
            match path {
                Some(TracedEdge::Along(along)) => self.name(&parts, *along, e)?,
                Some(TracedEdge::Through(..)) => {
                    parts.source[e.index()] = (self.origin.len() / 2) as u32;
                    let [a, b] = mesh.ends(e);
                    let between = parts.first[e.index()]..parts.first[e.index() + 1];
                    let all: Vec<u32> = std::iter::once(a.0)
                        .chain(between.map(|k| crossing_at + k))
                        .chain(std::iter::once(b.0))
                        .collect();
                    self.part(&all, [Some(e.halfedge()), None]);
                }
                None => {}
            }
        }
        Ok(parts)
    }

    /// Record that an edge of the target is also one of the source.
    fn name(&mut self, parts: &EdgeParts, along: HalfedgeId, e: EdgeId) -> Result<()> {
        let h = parts.leaving(along) as usize;
        if parts.leaving(along.twin()) as usize != h ^ 1 || self.along[0][h].is_some() {
            return Err(Error::Matching(format!("edge {e} of the source and others lie on one edge")));
        }
        (self.along[0][h], self.along[0][h ^ 1]) = (Some(e.halfedge()), Some(e.halfedge().twin()));
        Ok(())
    }

    /// Record the edges of the source that parts of the boundary belong to.
    fn name_boundary(&mut self, settled: &SettledVertices, target: &Mesh, parts: &EdgeParts) -> Result<()> {
        let mut out = vec![NONE; self.n[0] + self.n[1]];
        for b in target.vertices().filter(|&b| target.is_boundary_vertex(b)) {
            if let Some(&h) = target.fan(b).first() {
                out[self.target_vertex(settled, b) as usize] = parts.leaving(h);
            }
        }
        for (v, standing) in settled.forward.iter().enumerate() {
            if let VertexPlace::Side(..) = standing.at {
                out[v] = parts.both(standing.near, parts.side_rank[v])[0];
            }
        }
        let source = &settled.source.cover.mesh;
        for a in source.vertices().filter(|&v| source.is_boundary_vertex(v)) {
            let Some(&h) = source.fan(a).first() else { continue };
            let (mut at, end) = (a.index(), source.tip(h).index());
            while at != end || at == a.index() {
                let arc = out.get(at).copied().filter(|&arc| arc != NONE);
                let arc = arc.filter(|&arc| self.along[0][arc as usize].is_none());
                let Some(arc) = arc else {
                    return Err(Error::Matching("the boundaries do not lie on each other".into()));
                };
                self.along[0][arc as usize] = Some(h);
                self.along[0][arc as usize ^ 1] = Some(h.twin());
                at = self.tip(arc);
                if at == a.index() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Find the order of half-edges around every vertex.
    fn turn(
        &mut self,
        settled: &SettledVertices,
        target: &Mesh,
        paths: &[Option<TracedEdge>],
        parts: &EdgeParts,
    ) {
        let source = &settled.source.cover.mesh;
        let mut shared: Vec<Vec<(HalfedgeId, [DoubleDouble; 2], u32)>> = vec![Vec::new(); self.n[0]];
        for (e, path) in source.edges().zip(paths) {
            let Some(TracedEdge::Through(leaving, _)) = path else { continue };
            for (h, leaving) in [e.halfedge(), e.halfedge().twin()].into_iter().zip(leaving) {
                let leaving: &Departure = leaving;
                if let Some((corner, direction)) = *leaving {
                    let arc = parts.leaving_by(h, paths);
                    shared[source.origin(h).index()].push((corner, direction, arc));
                }
            }
        }
        for (v, standing) in source.vertices().zip(&settled.forward) {
            let around = match standing.at {
                VertexPlace::Inside(_) => source.fan(v).iter().map(|&h| parts.leaving_by(h, paths)).collect(),
                VertexPlace::Side(..) => {
                    let [on, back] = parts.both(standing.near, parts.side_rank[v.index()]);
                    let inner = source.fan(v).into_iter().skip(1).map(|h| parts.leaving_by(h, paths));
                    std::iter::once(on).chain(inner).chain(std::iter::once(back)).collect()
                }
                VertexPlace::Vertex(b) => around_target(target, b, parts, &shared[v.index()]),
            };
            self.around[v.index()] = around;
        }
        for b in target.vertices().filter(|&b| settled.taken[b].is_none()) {
            self.around[self.n[0] + b.index()] = around_target(target, b, parts, &[]);
        }
        for (k, (crossing, e)) in self.crossings.iter().zip(&self.crossed_by).enumerate() {
            let before = k as u32 - parts.first[e.index()];
            let at = parts.source[e.index()] + before;
            let [up, down] = parts.both(crossing.halfedge, parts.rank[k]);
            self.around[self.n[0] + self.n[1] + k] = vec![2 * (at + 1), up, 2 * at + 1, down];
        }
    }
}

/// The half-edges around a vertex of the target, and those of the source that leave it between them.
fn around_target(
    target: &Mesh,
    b: VertexId,
    parts: &EdgeParts,
    shared: &[(HalfedgeId, [DoubleDouble; 2], u32)],
) -> Vec<u32> {
    let fan = target.fan(b);
    let mut around = Vec::with_capacity(fan.len() + shared.len() + 1);
    for &h in &fan {
        around.push(parts.leaving(h));
        // Inside one corner, which is less than a half turn, from right to left.
        let mut inside: Vec<([DoubleDouble; 2], u32)> = Vec::new();
        for (_, y, arc) in shared.iter().filter(|(corner, ..)| *corner == h) {
            let is_right = |(x, _): &([DoubleDouble; 2], u32)| f64::from(x[0] * y[1] - x[1] * y[0]) > 0.0;
            let at = inside.iter().position(|x| !is_right(x)).unwrap_or(inside.len());
            inside.insert(at, (*y, *arc));
        }
        around.extend(inside.into_iter().map(|(_, arc)| arc));
    }
    let last = fan.last().map(|&h| target.prev(h).twin());
    around.extend(last.filter(|_| target.is_boundary_vertex(b)).map(|h| parts.leaving(h)));
    around
}

/// The edges of the source inside the surface, on the target.
fn paths(
    settled: &SettledVertices,
    target: &PlacedMesh,
    control: &Control,
) -> Result<Vec<Option<TracedEdge>>> {
    let mesh = &settled.source.cover.mesh;
    let tracer = EdgeTracer { settled, target };
    let mut all: Vec<Option<Result<TracedEdge>>> = Vec::new();
    all.resize_with(mesh.n_edges(), || None);
    control.step(Stage::Layout, 0.0)?;
    parallel::fill(&mut all, |e| {
        let e = EdgeId::from(e);
        let path = || control.check().and_then(|()| tracer.path(e.halfedge()));
        (!mesh.is_boundary_edge(e)).then(path)
    });
    control.step(Stage::Layout, 1.0)?;
    all.into_iter().map(Option::transpose).collect()
}

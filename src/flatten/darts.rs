//! Flat maps with darts: seams that open from the border inwards where a sheet would be stretched too much.
//!
//! A dart leads from the border to the vertex at which the conformal map with the border's own lengths changes lengths most, as in
//! [GGH02, Section 4.2]; after each the surface is laid flat anew.

use super::flat_map::{Flattening, flatten};
use super::options::FlattenOptions;
use super::strain::{FaceStrain, StrainLimits, strains};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, Mesh, PerEdge, Point, VertexId};
use crate::metric::Surface;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The options of [`flatten_with_darts`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DartOptions {
    /// What the sheet bears. Darts are added until no triangle is strained more.
    pub limits: StrainLimits,
    /// The angle of the warp in the plane from the x axis, radians. Default 0.
    pub warp: f64,
    /// The most length of all darts together, in units of the surface's lengths. Default infinite.
    pub budget: f64,
    /// The most darts. Default 8.
    pub most: usize,
}

impl Default for DartOptions {
    fn default() -> DartOptions {
        DartOptions { limits: StrainLimits::default(), warp: 0.0, budget: f64::INFINITY, most: 8 }
    }
}

/// A seam from the border to a vertex inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Dart {
    /// The vertices of the surface, from the tip to the border.
    pub path: Vec<VertexId>,
    /// The length on the surface.
    pub length: f64,
    /// The symmetric Dirichlet energy of the flat map with this dart and those before it.
    pub energy: f64,
    /// The largest part of its limit that a triangle takes in that map ([`StrainLimits::taken`]).
    pub taken: f64,
}

/// A flat map of a surface that darts have opened.
#[derive(Debug, Clone)]
pub struct DartedFlattening {
    /// The surface with the vertices of darts doubled; faces in the order of the given ones.
    pub surface: Surface,
    /// Per vertex of it the given vertex.
    pub origins: Vec<VertexId>,
    /// Its flat map.
    pub flat: Flattening,
    /// The strain of each face.
    pub strains: Vec<FaceStrain>,
    /// The darts in the order in which they were opened.
    pub darts: Vec<Dart>,
    /// The largest part of its limit that a triangle takes without a dart, and at the end: at most 1 where all bear it.
    pub taken: [f64; 2],
}

/// The flat map of an open surface of genus 0 ([`flatten`]) with as many darts as its strain needs, or as its options allow.
///
/// # Errors
/// Those of [`flatten`]; [`Error::Argument`] for limits or a budget that are not positive, and for pinned vertices and straight pieces, which
/// darts can take apart.
pub fn flatten_with_darts(
    surface: &Surface,
    options: &FlattenOptions,
    darts: &DartOptions,
    control: &Control,
) -> Result<DartedFlattening> {
    darts.limits.check()?;
    if darts.budget.is_nan() || darts.budget <= 0.0 {
        return Err(Error::argument("budget", darts.budget, "a positive length"));
    }
    if !options.pins.is_empty() || !options.straight.is_empty() {
        let need = "none beside darts, which can take them apart";
        return Err(Error::argument("pins and straight pieces", "given", need));
    }
    let mut is_cut = PerEdge::filled(surface.mesh().n_edges(), false);
    let (mut found, mut left) = (Vec::new(), darts.budget);
    let mut now = Opened::new(surface, &is_cut, options, darts, &control.part_of(0, darts.most + 1))?;
    let before = now.taken;
    while found.len() < darts.most && now.taken > 1.0 {
        control.check()?;
        let tip = now.tip(surface, options, &control.still())?;
        let Some((path, length)) = path_to_border(surface, &is_cut, tip) else { break };
        if length > left {
            break;
        }
        path.iter().for_each(|&e| is_cut[e] = true);
        let part = control.part_of(found.len() + 1, darts.most + 1);
        now = Opened::new(surface, &is_cut, options, darts, &part)?;
        left -= length;
        let (energy, taken) = (now.flat.report.after.energy, now.taken);
        found.push(Dart { path: vertices_of(surface.mesh(), tip, &path), length, energy, taken });
    }
    control.finish();
    let Opened { surface, origins, flat, strains, taken } = now;
    Ok(DartedFlattening { surface, origins, flat, strains, darts: found, taken: [before, taken] })
}

/// A surface with its cuts opened, laid flat.
struct Opened {
    surface: Surface,
    origins: Vec<VertexId>,
    flat: Flattening,
    strains: Vec<FaceStrain>,
    taken: f64,
}

impl Opened {
    fn new(
        given: &Surface,
        is_cut: &PerEdge<bool>,
        options: &FlattenOptions,
        darts: &DartOptions,
        control: &Control,
    ) -> Result<Opened> {
        let (surface, origins) = cut_open(given, is_cut)?;
        let flat = flatten(&surface, options, control)?;
        let strains = strains(&surface, &flat.points, darts.warp)?;
        let taken = strains.iter().map(|strain| darts.limits.taken(strain)).fold(0.0, f64::max);
        Ok(Opened { surface, origins, flat, strains, taken })
    }

    /// The vertex inside at which the start of the descent changes areas most, by its number in the given surface.
    fn tip(&self, given: &Surface, options: &FlattenOptions, control: &Control) -> Result<VertexId> {
        let start = FlattenOptions { max_iterations: 0, ..options.clone() };
        let points = flatten(&self.surface, &start, control)?.points;
        let mesh = self.surface.mesh();
        let mut sums = vec![[0.0; 2]; mesh.n_vertices()];
        for (f, strain) in mesh.faces().zip(strains(&self.surface, &points, 0.0)?) {
            let growth = (1.0 + strain.warp) * (1.0 + strain.weft) * strain.shear.cos();
            for v in mesh.face_vertices(f) {
                let [weight, sum] = sums[v.index()];
                sums[v.index()] = [weight + strain.share, sum + strain.share * growth.ln()];
            }
        }
        let change = |v: VertexId| (sums[v.index()][1] / sums[v.index()][0]).abs();
        let inside = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
        let tip = inside.reduce(|best, v| if change(v) > change(best) { v } else { best });
        tip.map(|v| self.origins[v.index()]).ok_or_else(|| {
            let n = given.mesh().n_vertices();
            Error::Layout(format!(
                "none of the {n} vertices is inside: refine the surface, so that a dart can end"
            ))
        })
    }
}

/// The edges of the shortest way along edges from a vertex to the border or to a cut, from the vertex on, and its length.
fn path_to_border(surface: &Surface, is_cut: &PerEdge<bool>, tip: VertexId) -> Option<(Vec<EdgeId>, f64)> {
    let mesh = surface.mesh();
    let ends_here = |v: VertexId| mesh.is_boundary_vertex(v) || mesh.outgoing(v).any(|h| is_cut[h.edge()]);
    let mut least = vec![f64::INFINITY; mesh.n_vertices()];
    let mut before = vec![None; mesh.n_vertices()];
    let mut queue = BinaryHeap::new();
    least[tip.index()] = 0.0;
    // Bits of positive numbers have the order of the numbers.
    queue.push(Reverse((0, tip)));
    while let Some(Reverse((bits, v))) = queue.pop() {
        let length = f64::from_bits(bits);
        if length > least[v.index()] {
            continue;
        }
        if ends_here(v) {
            let mut path = Vec::new();
            let mut at = v;
            while let Some((e, from)) = before[at.index()] {
                path.push(e);
                at = from;
            }
            path.reverse();
            return (!path.is_empty()).then_some((path, length));
        }
        for h in mesh.outgoing(v) {
            let (w, further) = (mesh.tip(h), length + surface.lengths()[h.edge()]);
            if further < least[w.index()] {
                (least[w.index()], before[w.index()]) = (further, Some((h.edge(), v)));
                queue.push(Reverse((further.to_bits(), w)));
            }
        }
    }
    None
}

/// The vertices along a path of edges.
fn vertices_of(mesh: &Mesh, tip: VertexId, path: &[EdgeId]) -> Vec<VertexId> {
    let mut all = vec![tip];
    for &e in path {
        let [a, b] = mesh.ends(e);
        all.push(if Some(&a) == all.last() { b } else { a });
    }
    all
}

/// The surface with edges cut open: a vertex for each fan of faces that no cut divides, and per vertex the given one.
///
/// # Errors
/// Those of [`Mesh::from_faces`] and of [`Surface::in_space`] or [`Surface::intrinsic`].
pub fn cut_open(surface: &Surface, is_cut: &PerEdge<bool>) -> Result<(Surface, Vec<VertexId>)> {
    let mesh = surface.mesh();
    // Corners are numbered by the half-edges that leave them.
    let mut fans = UnionFind::new(mesh.n_halfedges());
    for e in mesh.edges().filter(|&e| !is_cut[e] && !mesh.is_boundary_edge(e)) {
        let h = e.halfedge();
        let t = h.twin();
        fans.join(h.0, mesh.next(t).0);
        fans.join(t.0, mesh.next(h).0);
    }
    let mut number = vec![u32::MAX; mesh.n_halfedges()];
    // First fans keep the numbers of their vertices.
    let mut is_taken = vec![false; mesh.n_vertices()];
    let mut origins: Vec<VertexId> = mesh.vertices().collect();
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        let root = fans.root(h.0) as usize;
        if number[root] != u32::MAX {
            continue;
        }
        let v = mesh.origin(h);
        number[root] = if std::mem::replace(&mut is_taken[v.index()], true) {
            origins.push(v);
            origins.len() as u32 - 1
        } else {
            v.0
        };
    }
    let faces: Vec<[u32; 3]> =
        mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| number[fans.root(h.0) as usize])).collect();
    let cut = Mesh::from_faces(origins.len(), &faces)?;
    let opened = match surface.positions() {
        Some(positions) => {
            let all: Vec<Point> = origins.iter().map(|v| positions[v.index()]).collect();
            Surface::in_space(cut, all)?
        }
        None => {
            let mut lengths = PerEdge::filled(cut.n_edges(), 0.0);
            for (f, g) in mesh.faces().zip(cut.faces()) {
                for (h, k) in mesh.face_halfedges(f).into_iter().zip(cut.face_halfedges(g)) {
                    lengths[k.edge()] = surface.lengths()[h.edge()];
                }
            }
            Surface::intrinsic(cut, lengths, surface.geometry())?
        }
    };
    Ok((opened, origins))
}

//! Surfaces with handles or cones laid flat with as little stretch as possible: the surface is cut open, and its seams stay rotations by
//! multiples of 90°. A boundary is free.
//!
//! The cones and the turning along loops are those of a seamless metric ([`crate::seamless`]). Among all maps with these, Newton's method
//! descends the energy of [`super::flatten()`], from the map of that metric.

use super::darts::cut_open;
use super::flat_map::{Flattener, Flattening, out_of_range};
use super::options::{DistortionEnergy, FlattenOptions};
use super::plane_start::PlaneStart;
use super::report::{FlattenReport, FlattenStart};
use super::rest_triangle::rest_triangles;
use super::rim::BorderRim;
use super::seam_ties::SeamTies;
use crate::control::Control;
use crate::embed::{Layout, LayoutOptions, LayoutScale, OnInput};
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::Space;
use crate::geometry::complex::{norm, scale, sub};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{EdgeId, PerEdge, PerHalfedge, Point};
use crate::metric::{Class, CommonSubdivision, Surface};
use crate::parallel;
use crate::seamless::Seamless;
use std::sync::Arc;
use std::time::Instant;

/// A surface, cut open and laid flat with little stretch, with seams that are rotations by multiples of 90° and translations exactly.
#[derive(Debug, Clone)]
pub struct SeamlessFlattening {
    /// The surface, with edges split where the map that the descent started from would turn triangles over without; its first vertices are
    /// the given ones.
    pub surface: Surface,
    /// The common subdivision of the given surface (side 0) and of this one (side 1); none where no edge was split.
    pub refinement: Option<Arc<CommonSubdivision>>,
    /// The metric of the plane on it.
    pub solution: Solution,
    /// The map. Its seams are exact ([`Layout::make_seams_exact_beside_free_boundary`]).
    pub layout: Layout,
    /// The largest distance by which a corner was moved to make the seams exact.
    pub moved: f64,
    /// How the map was found, and how much it distorts. [`FlattenReport::overlap`] and [`FlattenReport::one_to_one`] are those of the surface
    /// cut open along the edges on which the descent had its seams.
    pub report: FlattenReport,
}

/// The parts of the progress that the seamless map, and all before the descent, fill.
const OF_MAP: f64 = 0.2;
const OF_START: f64 = 0.3;
const OF_DESCENT: f64 = 0.9;

/// The map to the plane of least distortion among those of a surface with the cones and the turning of a seamless metric of it: Newton's
/// method on the energy of the options [SS15; SGK19], in unknowns in which seams are rotations whatever their values. The boundary of an
/// open surface is free: it need not stay straight, nor do features.
///
/// The triangles are those of the surface; where the map of the seamless metric turns some over, the fewest of its edges are split
/// ([`Layout::repaired_input`]). A descent that does not converge leaves the best map found.
///
/// # Errors
/// [`Error::Argument`] for options outside their ranges, conditions and energies of maps without seams alone, and a surface that is not
/// flat inside its triangles; [`Error::Layout`] for a metric that is not seamless to rounding, triangles that stay turned over, and a
/// triangle without area; [`Error::TriangleInequality`]; [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn flatten_seamless(
    seamless: &Seamless,
    options: &FlattenOptions,
    control: &Control,
) -> Result<SeamlessFlattening> {
    let shares = options.shares()?;
    let given = seamless.solution.surface();
    check(given, options)?;
    parallel::within(options.threads, || {
        let begun = Instant::now();
        let map = seamless.map(&control.part(0.0, OF_MAP))?;
        let start = SeamlessStart::new(given, &map.layout, &control.part(OF_MAP, OF_START))?;
        let (opened, _) = cut_open(&start.surface, &start.is_cut())?;
        let corners = opened.mesh().triangles();
        let points = start.points(&corners, opened.mesh().n_vertices());
        let ties = SeamTies::new(start.surface.mesh(), &corners, &points)?;
        // A power of two near the root of the area.
        let unit = opened.area()?.sqrt().log2().round().exp2();
        let rest = rest_triangles(&opened, unit, &start.weights(&options.weights))?;
        let rim = BorderRim::new(opened.mesh());
        let seconds = begun.elapsed().as_secs_f64();
        let flat = Flattener { surface: &opened, rest, unit, shares, options, rim, ties: Some(&ties) };
        let from = PlaneStart { points: ties.tied(&points), way: FlattenStart::Seamless };
        let found = flat.descended(from, &control.part(OF_START, OF_DESCENT))?;
        let seconds = [seconds, begun.elapsed().as_secs_f64() - seconds];
        start.finish(&corners, found, seconds, &control.part(OF_DESCENT, 1.0))
    })
}

/// Refuses surfaces and options that have no such map.
fn check(given: &Surface, options: &FlattenOptions) -> Result<()> {
    let mesh = given.mesh();
    options.check_parts(mesh)?;
    if given.geometry() != Space::E2 {
        let need = "e2: a map to the plane is linear on flat triangles";
        return Err(Error::argument("geometry of the surface", given.geometry().name(), need));
    }
    if options.energy == DistortionEnergy::Distance {
        let need = "isometric, arap or area: shortest paths that cross seams have no length in one piece of the plane";
        return Err(Error::argument("energy", options.energy.name(), need));
    }
    let conditions = [
        ("injective", options.injective),
        ("pins", !options.pins.is_empty()),
        ("straight", !options.straight.is_empty()),
    ];
    match conditions.into_iter().find(|(_, is_given)| *is_given) {
        Some((what, _)) => Err(Error::argument(what, "given", "left out: it is for maps without seams")),
        None => Ok(()),
    }
}

/// The surface on whose triangles the map of a seamless metric turns none over.
struct SeamlessStart {
    surface: Surface,
    refinement: Option<Arc<CommonSubdivision>>,
    corner_index: PerHalfedge<u32>,
    coordinates: Vec<[f64; 2]>,
}

impl SeamlessStart {
    fn new(given: &Surface, layout: &Layout, control: &Control) -> Result<SeamlessStart> {
        let no_cut = || Error::Layout("the seamless map is not cut along the surface's edges".into());
        let OnInput { corner_index, coordinates, flipped, .. } = layout.on_input().ok_or_else(no_cut)?;
        if flipped.is_empty() {
            return Ok(SeamlessStart { surface: given.clone(), refinement: None, corner_index, coordinates });
        }
        let repaired = layout.repaired_input(control)?.ok_or_else(no_cut)?;
        if let Some(f) = repaired.flipped.first() {
            let why = format!(
                "face {f} of the seamless map stays turned over: parts of it are too small for doubles; ask for other cones, or remesh the surface"
            );
            return Err(Error::Layout(why));
        }
        let surface = refined(given, &repaired.refinement)?;
        Ok(SeamlessStart {
            surface,
            refinement: Some(repaired.refinement),
            corner_index: repaired.corner_index,
            coordinates: repaired.coordinates,
        })
    }

    /// The edges whose sides are at different places.
    fn is_cut(&self) -> PerEdge<bool> {
        let (mesh, corner) = (self.surface.mesh(), &self.corner_index);
        let differs = |e: EdgeId| {
            let (h, t) = (e.halfedge(), e.halfedge().twin());
            if mesh.is_boundary_edge(e) {
                return false;
            }
            corner[h] != corner[mesh.next(t)] || corner[mesh.next(h)] != corner[t]
        };
        PerEdge::from_fn(mesh.n_edges(), differs)
    }

    /// The places of the vertices of the opened surface.
    fn points(&self, corners: &[[u32; 3]], n: usize) -> Vec<[f64; 2]> {
        let mesh = self.surface.mesh();
        let mut points = vec![[0.0; 2]; n];
        for (f, at) in mesh.faces().zip(corners) {
            for (h, &p) in mesh.face_halfedges(f).into_iter().zip(at) {
                points[p as usize] = self.coordinates[self.corner_index[h] as usize];
            }
        }
        points
    }

    /// The weights of the given faces at those of this surface.
    fn weights(&self, given: &[f64]) -> Vec<f64> {
        match &self.refinement {
            Some(refinement) if !given.is_empty() => {
                refinement.faces[0].iter().map(|f| given[f.index()]).collect()
            }
            _ => given.to_vec(),
        }
    }

    /// The map of the opened surface's points as a layout with exact seams.
    fn finish(
        self,
        corners: &[[u32; 3]],
        found: Flattening,
        seconds: [f64; 2],
        control: &Control,
    ) -> Result<SeamlessFlattening> {
        let mesh = self.surface.mesh();
        let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
        for (f, at) in mesh.faces().zip(corners) {
            for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
                let [a, b] = [at[k], at[(k + 1) % 3]].map(|p| found.points[p as usize]);
                lengths[h.edge()] = norm(sub(b, a));
            }
        }
        let flat = Surface::intrinsic(mesh.clone(), lengths, Space::E2)?;
        let flat = match self.surface.positions() {
            Some(positions) => flat.with_positions(positions.clone())?,
            None => flat,
        };
        let solution = Solution::initial_of(flat, Class::yamabe(Space::E2))?;
        let options = LayoutOptions { scale: LayoutScale::AsSolved, ..LayoutOptions::default() };
        let mut layout = Layout::of_solution(&solution, &options, control)?;
        let moved = layout.make_seams_exact_beside_free_boundary()?;
        if !layout.flipped.is_empty() {
            return Err(out_of_range());
        }
        control.finish();
        let SeamlessStart { surface, refinement, .. } = self;
        let report = FlattenReport { seconds, ..found.report };
        Ok(SeamlessFlattening { surface, refinement, solution, layout, moved, report })
    }
}

/// A surface with its edges split.
fn refined(given: &Surface, refinement: &CommonSubdivision) -> Result<Surface> {
    let mesh = refinement.mesh.clone();
    if let Some(positions) = given.positions() {
        let positions: Vec<Point> = refinement.from_vertices(0, positions)?;
        return Surface::in_space(mesh, positions);
    }
    let own = given.mesh();
    let in_plane = |f| {
        let sides = own.opposite_edges(f).map(|e| given.lengths()[e]);
        let (direction, _) = PlaneTriangle::direction_at(sides, 0);
        [[0.0; 2], [sides[2], 0.0], scale(sides[1], direction)]
    };
    let places: Vec<[[f64; 2]; 3]> = own.faces().map(in_plane).collect();
    let corners = refinement.from_corners(0, &places)?;
    let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
    for (f, at) in mesh.faces().zip(&corners) {
        for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
            lengths[h.edge()] = norm(sub(at[(k + 1) % 3], at[k]));
        }
    }
    Surface::intrinsic(mesh, lengths, given.geometry())
}

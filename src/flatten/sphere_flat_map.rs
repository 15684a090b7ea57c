//! Maps of closed surfaces of genus 0 to the sphere of their area, with as little stretch as possible.

use super::coarse_sphere::coarse_to_fine;
use super::descent::{MapDescent, MovingMap};
use super::descent_matrix::DescentMatrix;
use super::distortion::Distortion;
use super::energy::EnergyShares;
use super::options::{DistortionEnergy, FlattenOptions};
use super::report::{FlattenReport, FlattenStart, FlattenStop};
use super::rest_triangle::{RestTriangle, rest_triangles};
use super::sphere_moves::SphereMoves;
use super::sphere_triangle::SoftDet;
use crate::canonical::{SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::vector::{Vector, cross, distance, dot, normalised, sub};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel;
use nalgebra::{Matrix3, Vector3 as NalgebraVector};
use std::f64::consts::PI;
use std::time::Instant;

/// The part of the progress that the start fills.
const OF_START: f64 = 0.4;
/// Most Newton steps that turn triangles back without fewer of them being left than before, and the decrement that is small enough for the
/// last of them.
const MOST_UNTANGLING: usize = 60;
const UNTANGLED: f64 = 1e-3;
/// The softness of determinants in the depth of the deepest triangle that is turned over, and at least.
const SOFTNESS: f64 = 0.2;
const LEAST_SOFTNESS: f64 = 1e-3;
/// The factor by which it grows where no step lowers the energy, and the most that it becomes so.
const SOFTER: f64 = 10.0;
const MOST_SOFTER: f64 = 1e6;

/// What helps where no map is found that turns no triangle over.
const STAY_TURNED: &str = "triangles stay turned over on the sphere, and there is no map of the triangulation alone, as two edges have the same ends: refine the surface";

/// A map of a surface to the unit sphere that turns no triangle over, by exact arithmetic on these numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct SphereFlattening {
    /// Per vertex its place on the unit sphere (V entries). Faces run counterclockwise as seen from outside.
    pub points: Vec<Vector>,
    /// How the map was found, and how much it distorts: between the surface and the flat triangles under a sphere of the surface's area.
    pub report: FlattenReport,
}

/// The map to the sphere of least distortion of a closed surface of genus 0: Newton's method on the energy of the options [SS15; SGK19] from
/// the conformal map ([`uniformize_sphere`]), whose triangles are turned back first where it turns any over \[GKKPR21\]. Where some stay turned over,
/// as on long thin limbs, which the conformal map makes too small for doubles, the start is a map of the triangulation alone, from coarse to
/// fine \[PH03\]. The sphere has the area of the surface. With the isometric energy areal and shape distortion are balanced; [`FlattenOptions::conformal`] and
/// [`DistortionEnergy::Area`] weigh them otherwise. The sphere is turned as the surface is in space, if it has positions.
///
/// # Errors
/// [`Error::Argument`] for options outside their ranges, for energies and conditions that are those of plane maps alone, and for a surface
/// that is no sphere; [`Error::Layout`] for a triangle without area and where no map without a turned triangle is found, as of a triangulation with two edges between the same vertices;
/// [`Error::TriangleInequality`]; [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn flatten_sphere(
    surface: &Surface,
    options: &FlattenOptions,
    control: &Control,
) -> Result<SphereFlattening> {
    let shares = options.shares()?;
    options.check_parts(surface.mesh())?;
    check_options(options, surface)?;
    parallel::within(options.threads, || {
        let begun = Instant::now();
        let unit = (surface.area()? / (4.0 * PI)).sqrt();
        let rest = rest_triangles(surface, unit, &options.weights)?;
        let sphere = SphereOptions { threads: options.threads, ..SphereOptions::default() };
        let start = uniformize_sphere(surface, &sphere, &control.part(0.0, 0.8 * OF_START))?;
        let map = RoundMap { surface, rest, unit, shares };
        let points = turned(surface, start.positions.iter().copied().collect());
        let mut found = map.descended(points, options, control)?;
        control.finish();
        let [before, after] = found.report.seconds;
        found.report.seconds = [begun.elapsed().as_secs_f64() - after, before + after];
        Ok(found)
    })
}

/// The points turned so that they look, as seen from the middle, as nearly as possible where the surface is in space \[Kab76\].
fn turned(surface: &Surface, points: Vec<Vector>) -> Vec<Vector> {
    let Some(positions) = surface.positions() else { return points };
    let mean = |all: &[Vector]| [0, 1, 2].map(|c| all.iter().map(|p| p[c]).sum::<f64>() / all.len() as f64);
    let centre = mean(positions);
    let mut products = Matrix3::<f64>::zeros();
    for (p, q) in positions.iter().zip(&points) {
        let way = sub(*p, centre);
        products += NalgebraVector::from(way) * NalgebraVector::from(*q).transpose();
    }
    let svd = products.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return points };
    let mirror = NalgebraVector::new(1.0, 1.0, (u * v).determinant().signum());
    let turn = u * Matrix3::from_diagonal(&mirror) * v;
    let image = |q: Vector| normalised((turn * NalgebraVector::from(q)).into());
    points.into_iter().map(image).collect()
}

fn check_options(options: &FlattenOptions, surface: &Surface) -> Result<()> {
    if surface.geometry() != Space::E2 {
        let need = "e2: a map to the sphere is that of flat triangles";
        return Err(Error::argument("geometry of the surface", surface.geometry().name(), need));
    }
    if !matches!(options.energy, DistortionEnergy::Isometric | DistortionEnergy::Area) {
        return Err(Error::argument(
            "energy",
            options.energy.name(),
            "isometric or area for a map to the sphere",
        ));
    }
    let is_plain = options.pins.is_empty() && options.straight.is_empty() && !options.injective;
    let of_plane = "none: pins, straight pieces and injectivity are conditions of maps to the plane";
    if is_plain { Ok(()) } else { Err(Error::argument("conditions", "given", of_plane)) }
}

/// What a descent on the sphere needs.
struct RoundMap<'a> {
    surface: &'a Surface,
    rest: Vec<RestTriangle>,
    /// The radius of the sphere, in the unit of the surface's lengths.
    unit: f64,
    shares: EnergyShares,
}

impl RoundMap<'_> {
    fn descended(
        &self,
        points: Vec<Vector>,
        options: &FlattenOptions,
        control: &Control,
    ) -> Result<SphereFlattening> {
        let mesh = self.surface.mesh();
        let corners = mesh.triangles();
        let begun = Instant::now();
        let mut system = DescentMatrix::new(mesh, Vec::new(), None, control)?;
        let (points, start) = self.start(points, &mut system, &control.part(0.8 * OF_START, OF_START))?;
        let before = self.distortion(&corners, &points);
        let untangling = begun.elapsed().as_secs_f64();
        let mut descent = MapDescent::new(self.moves(&corners, 0.0), points);
        let FlattenOptions { tolerance, max_iterations, .. } = *options;
        let stop = descent.run(&mut system, tolerance, max_iterations, &control.part(OF_START, 1.0))?;
        descent.map.assemble(&mut system, &descent.points, true);
        let gradient = system.steepest();
        let MapDescent { points, energies, unclamped, decrement, .. } = descent;
        let after = self.distortion(&corners, &points);
        let report = FlattenReport {
            start,
            stop,
            energies,
            unclamped,
            decrement,
            // In units of the radius: the sphere has the diameter 2.
            gradient: 2.0 * gradient,
            before,
            after,
            overlap: 0.0,
            one_to_one: is_one_to_one(&corners, &points),
            misfit: 0.0,
            seconds: [untangling, begun.elapsed().as_secs_f64() - untangling],
        };
        Ok(SphereFlattening { points, report })
    }

    fn moves<'a>(&'a self, corners: &'a [[u32; 3]], softness: f64) -> SphereMoves<'a> {
        SphereMoves { corners, rest: &self.rest, shares: self.shares, soft: SoftDet { softness } }
    }

    /// The conformal map, its triangles turned back where it turns any over; where they stay turned over, a map of the triangulation alone.
    fn start(
        &self,
        points: Vec<Vector>,
        system: &mut DescentMatrix<'_>,
        control: &Control,
    ) -> Result<(Vec<Vector>, FlattenStart)> {
        let mesh = self.surface.mesh();
        let corners = mesh.triangles();
        let moves = |softness: f64| self.moves(&corners, softness);
        if moves(0.0).n_turned(&points) == 0 {
            return Ok((points, FlattenStart::Conformal));
        }
        if let Some(points) = untangled(moves, points, system, &control.part(0.0, 0.5))? {
            return Ok((points, FlattenStart::Untangled));
        }
        match coarse_to_fine(mesh, &control.part(0.5, 1.0))? {
            Some(points) if moves(0.0).n_turned(&points) == 0 => Ok((points, FlattenStart::CoarseToFine)),
            _ => Err(Error::Layout(STAY_TURNED.into())),
        }
    }

    fn distortion(&self, corners: &[[u32; 3]], points: &[Vector]) -> Distortion {
        let plane = |f: usize| in_its_plane(corners[f].map(|v| points[v as usize]));
        let length = |ends: [VertexId; 2]| {
            let [a, b] = ends.map(|v| points[v.index()]);
            distance(a, b) * self.unit
        };
        Distortion::of_triangles(self.surface, &self.rest, plane, length)
    }
}

/// The triangle in its own plane, the first corner at 0 and the second on the positive axis.
fn in_its_plane([a, b, c]: [Vector; 3]) -> [[f64; 2]; 3] {
    let (p, q) = (sub(b, a), sub(c, a));
    let length = dot(p, p).sqrt();
    let along = dot(p, q) / length;
    let normal = cross(p, q);
    [[0.0; 2], [length, 0.0], [along, dot(normal, normal).sqrt() / length]]
}

/// True if the triangles, none of which is turned over, cover the sphere once: their solid angles are 4π in all, not a multiple.
fn is_one_to_one(corners: &[[u32; 3]], points: &[Vector]) -> bool {
    let angle = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| points[v as usize]);
        let volume = dot(a, cross(sub(b, a), sub(c, a)));
        2.0 * volume.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a))
    };
    let total: f64 = corners.iter().map(angle).sum();
    (total / (4.0 * PI) - 1.0).abs() < 0.25
}

/// Turns triangles back that are turned over: descends energies that are finite there, and harden as the triangles come back. `None` where
/// some stay turned over.
fn untangled<'a>(
    moves: impl Fn(f64) -> SphereMoves<'a>,
    points: Vec<Vector>,
    system: &mut DescentMatrix<'_>,
    control: &Control,
) -> Result<Option<Vec<Vector>>> {
    let mut points = points;
    let (mut left, mut softer, mut fewest) = (MOST_UNTANGLING, 1.0, usize::MAX);
    loop {
        let hard = moves(0.0);
        let turned = hard.n_turned(&points);
        if turned == 0 {
            return Ok(Some(points));
        }
        if turned < fewest {
            (fewest, left) = (turned, MOST_UNTANGLING);
        }
        if left == 0 || softer > MOST_SOFTER {
            return Ok(None);
        }
        let depth = -hard.least_det(&points).min(0.0);
        let softness = softer * LEAST_SOFTNESS.max(SOFTNESS * depth);
        let mut descent = MapDescent::new(moves(softness), points);
        let stop = descent.run(system, UNTANGLED, 1, control)?;
        softer = if stop == FlattenStop::NoStep { SOFTER * softer } else { f64::max(1.0, softer / SOFTER) };
        left -= 1;
        points = descent.points;
    }
}

//! Inflated views of closed surfaces: folds are smoothed away, and what lies deep in them comes to the surface.
//!
//! The flow is that of the mean curvature with the Laplacian of the surface that it starts from, which runs into no singularities and for
//! spheres ends at a conformal one \[KSB12\].

use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, norm, scale, sub, triangle_normal};
use crate::harmonic::{Domain, Laplace};
use crate::mesh::Point;
use crate::metric::Surface;
use crate::parallel;

/// Default of [`InflateOptions::time`].
pub const INFLATE_TIME: f64 = 0.002;
/// Default of [`InflateOptions::steps`].
pub const INFLATE_STEPS: usize = 10;

/// The options of [`inflate`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InflateOptions {
    /// The time of the flow, a share of the surface's area: folds narrower than about its root times that of the area are gone. Default
    /// [`INFLATE_TIME`].
    pub time: f64,
    /// The number of implicit steps. Default [`INFLATE_STEPS`].
    pub steps: usize,
    /// The number of threads; default 0: one per core. The result does not depend on it.
    pub threads: usize,
}

impl Default for InflateOptions {
    fn default() -> InflateOptions {
        InflateOptions { time: INFLATE_TIME, steps: INFLATE_STEPS, threads: 0 }
    }
}

/// The positions of a closed surface in space after its folds were smoothed away: implicit steps
/// `(M + τ L) x' = M x` with the Laplacian L of the surface and the areas M of its vertices as they are \[KSB12, Eqn 11\]. The area and the
/// centre of the surface are kept.
///
/// # Errors
/// [`Error::Argument`] for a surface that is not closed or has no positions, and for options outside their ranges; those of [`Domain::new`]
/// and [`Laplace::with_mass`]; [`Error::Cancelled`].
pub fn inflate(surface: &Surface, options: &InflateOptions, control: &Control) -> Result<Vec<Point>> {
    if !(options.time > 0.0 && options.time.is_finite()) {
        return Err(Error::argument("time", options.time, "a positive number"));
    }
    if options.steps == 0 {
        return Err(Error::argument("steps", options.steps, "at least 1"));
    }
    let Some(positions) = surface.positions().filter(|_| surface.mesh().is_closed()) else {
        return Err(Error::argument("surface", "open, or without positions", "a closed surface in space"));
    };
    parallel::within(options.threads, || {
        let faces = surface.mesh().triangles();
        let begun = VertexAreas::new(&faces, positions);
        let mut points: Vec<Point> = positions.to_vec();
        let domain = Domain::new(surface, &control.still())?;
        let step = options.time * begun.total / options.steps as f64;
        let mass = |of: &VertexAreas| of.each.iter().map(|area| area / step).collect::<Vec<f64>>();
        let mut laplace = Laplace::with_mass(&domain, &mass(&begun), control)?;
        for k in 0..options.steps {
            control.step(Stage::Layout, k as f64 / options.steps as f64)?;
            let now = VertexAreas::new(&faces, &points);
            let mass = mass(&now);
            laplace.set_mass(&mass)?;
            let n = points.len();
            let mut columns: Vec<f64> = (0..3)
                .flat_map(|c| (0..n).map(move |v| (v, c)))
                .map(|(v, c)| mass[v] * points[v][c])
                .collect();
            laplace.solve(&mut columns)?;
            (0..n).for_each(|v| points[v] = [0, 1, 2].map(|c| columns[c * n + v]));
            restore(&begun, &faces, &mut points);
        }
        control.finish();
        Ok(points)
    })
}

/// The areas of a surface's vertices, one third of those of their faces.
pub(super) struct VertexAreas {
    pub each: Vec<f64>,
    pub total: f64,
    pub centre: Vector,
}

impl VertexAreas {
    pub fn new(faces: &[[u32; 3]], points: &[Point]) -> VertexAreas {
        let mut each = vec![0.0; points.len()];
        for face in faces {
            let third = norm(triangle_normal(face.map(|v| points[v as usize]))) / 6.0;
            face.iter().for_each(|&v| each[v as usize] += third);
        }
        let total = each.iter().sum();
        let sum = each.iter().zip(points).fold([0.0; 3], |sum, (area, p)| add(sum, scale(*area, *p)));
        VertexAreas { each, total, centre: scale(1.0 / total, sum) }
    }
}

/// Gives points the area and the centre that a surface had.
fn restore(begun: &VertexAreas, faces: &[[u32; 3]], points: &mut [Point]) {
    let now = VertexAreas::new(faces, points);
    let factor = (begun.total / now.total).sqrt();
    points.iter_mut().for_each(|p| *p = add(begun.centre, scale(factor, sub(*p, now.centre))));
}

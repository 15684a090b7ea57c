//! A surface as the search for landmarks sees it: vertices that lie evenly, their distances, and eigenfunctions of the Laplacian.

use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{cross, dot, norm, sub, triangle_normal};
use crate::harmonic::{Domain, spectrum_within};
use crate::matching::even_sample::EvenSample;
use crate::mesh::{Point, VertexId};
use crate::metric::Surface;

/// Number of vertices by which a surface is sampled.
const SAMPLES: usize = 300;
/// Number of eigenfunctions: a fifth of the samples, at which they have to be told apart.
pub(super) const FUNCTIONS: usize = 60;
/// Residual of an eigenfunction, over its eigenvalue: far below the differences between surfaces.
const PRECISION: f64 = 1e-5;
/// Times of the heat kernel on a surface of area 1, in a geometric sequence, from those of details to those of the whole.
const HEAT: [f64; 2] = [0.003, 0.3];
/// Number of these times.
const TIMES: usize = 12;
/// Weight of the logarithm of a heat kernel beside the remoteness: logarithms vary by far more.
const HEAT_WEIGHT: f64 = 0.15;

/// A surface, its samples, and the first eigenfunctions; lengths are those of the surface scaled to the area 1.
pub(super) struct SampledSurface<'a> {
    pub even: EvenSample<'a>,
    /// The unit normals at the vertices.
    pub normals: Vec<Point>,
    values: Vec<f64>,
    /// Per vertex the values of the eigenfunctions, whose squares have the mean 1.
    pub functions: Vec<Vec<f64>>,
}

impl<'a> SampledSurface<'a> {
    /// # Errors
    /// [`crate::Error::Argument`] for a surface without positions; those of [`crate::harmonic::spectrum()`]; [`crate::Error::Cancelled`].
    pub fn new(surface: &'a Surface, control: &Control) -> Result<SampledSurface<'a>> {
        let even = EvenSample::new(surface, SAMPLES, &control.part(0.0, 0.4))?;
        let domain = Domain::new(surface, &control.part(0.4, 0.5))?;
        let total: f64 = domain.vertex_areas().iter().sum();
        let found = spectrum_within(&domain, FUNCTIONS, PRECISION, &control.part(0.5, 1.0))?;
        let n = surface.mesh().n_vertices();
        Ok(SampledSurface {
            normals: normals(surface, &even.points),
            even,
            values: found.values.iter().map(|value| value.max(0.0) * total).collect(),
            functions: (0..n).map(|v| found.functions.iter().map(|f| f[v]).collect()).collect(),
        })
    }

    /// The values of the eigenfunctions at the samples.
    pub fn at_samples(&self) -> Vec<&[f64]> {
        self.even.samples.iter().map(|v| self.functions[v.index()].as_slice()).collect()
    }

    /// Numbers that are alike at corresponding points of surfaces that are nearly isometric: how remote the vertex is, and its heat kernel
    /// signature \[SOG09\] at several times, each over its mean.
    pub fn descriptor(&self, v: VertexId) -> Vec<f64> {
        let mut all = vec![self.even.remoteness[v]];
        for k in 0..TIMES {
            let time = HEAT[0] * (HEAT[1] / HEAT[0]).powf(k as f64 / (TIMES - 1) as f64);
            let heat: Vec<f64> = self.values.iter().map(|value| (-time * value).exp()).collect();
            let trace: f64 = heat.iter().sum();
            let own: f64 = self.functions[v.index()].iter().zip(&heat).map(|(f, h)| f * f * h).sum();
            all.push(HEAT_WEIGHT * (own / trace).max(f64::MIN_POSITIVE).ln());
        }
        all
    }

    /// The vector from one sample to another, in a frame of the plane across the normal at the first.
    pub fn step(&self, from: usize, to: usize) -> [f64; 2] {
        let [v, w] = [from, to].map(|k| self.even.samples[k].index());
        let normal = self.normals[v];
        let axis = if normal[0].abs() < 0.8 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let across = cross(normal, axis);
        let first = across.map(|x| x / norm(across).max(f64::MIN_POSITIVE));
        let step = sub(self.even.points[w], self.even.points[v]);
        [dot(step, first), dot(step, cross(normal, first))]
    }
}

/// The unit normals at the vertices, means of those of the faces by area.
fn normals(surface: &Surface, points: &[Point]) -> Vec<Point> {
    let mesh = surface.mesh();
    let mut sums = vec![[0.0; 3]; points.len()];
    for f in mesh.faces() {
        let corners = mesh.face_vertices(f);
        let normal = triangle_normal(corners.map(|v| points[v.index()]));
        corners.into_iter().for_each(|v| (0..3).for_each(|k| sums[v.index()][k] += normal[k]));
    }
    let unit = |n: Point| n.map(|x| x / norm(n).max(f64::MIN_POSITIVE));
    sums.into_iter().map(unit).collect()
}

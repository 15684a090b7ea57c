//! The options of a fit to a whole surface, and the sizes that follow from them.

use super::domain::SurfaceDomain;
use super::flat::FlatMetric;
use super::holes::whole_turns;
use super::sizes::TriangleSizes;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{Vector, diagonal};
use crate::mesh::{Mesh, VertexId};
use crate::spline::{Fill, Hole, Parameter, SplineSpace};

/// Least number of vertices in a hole.
const LEAST_INSIDE: usize = 60;
/// Largest share of all vertices in a hole.
const MOST_INSIDE: f64 = 0.3;
/// Area of a hole around a vertex whose total angle is no multiple of 2π, over that of one with one turn: triangles at the vertex lie in its
/// middle.
const BARE_HOLE: f64 = 4.0;
/// Default spread of knots: with knots far apart, a spline bends less sharply between its triangles.
const WIDE: f64 = 0.9;
/// Vertices in a hole for each coefficient of its filling.
const POINTS: f64 = 6.0;
/// Tolerance of the root mean square distance, over that of the largest distance.
pub(super) const RMS: f64 = 0.1;
/// Times that a domain with too many control points is made again with fewer vertices.
const TRIES: usize = 4;
/// Growth of a hole's radius from trial to trial, in the coordinate in which its vertex is a regular point.
const GROWTH: f64 = 1.15;

/// Options of [`super::fit_surface`].
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFitOptions {
    /// Degree of the spline, 1 to 5. Default 3.
    pub degree: usize,
    /// Most control points. Default: a quarter of the number of vertices; see [`super::fit_surface_over`] for more.
    pub control_points: Option<usize>,
    /// Largest distance of a vertex from the spline, over the diagonal of the bounding box; the root mean square distance is to be a tenth
    /// of it. Default 0.01.
    pub tolerance: f64,
    /// Times that the triangles' sizes are adapted to the errors. Default 6.
    pub rounds: usize,
    /// Most times that the places of the vertices are moved to the nearest points of the spline; fewer if the tolerance is met or little is
    /// gained. Default 20.
    pub corrections: usize,
    /// Weight of the fairness in the first round, relative to the mean square distance: that of the mean over all triangles of ∫ h⁶ |D³F|² +
    /// 0.1 h⁴ |D²F|² over their area, h being a triangle's longest side. 0 (default): chosen by cross-validation, so that it follows the
    /// noise of the vertices. Later rounds take less where the tolerance is missed, and more where the spline folds.
    pub fairness: f64,
    /// [`crate::spline::KnotOptions::spread`]. Default 0.9.
    pub spread: f64,
    /// Area of a hole over that of m² mean triangles, for a vertex with a total angle of m turns. Default 1.5.
    pub hole: f64,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for SurfaceFitOptions {
    fn default() -> Self {
        SurfaceFitOptions {
            degree: 3,
            control_points: None,
            tolerance: 0.01,
            rounds: 6,
            corrections: 20,
            fairness: 0.0,
            spread: WIDE,
            hole: 1.5,
            threads: 0,
        }
    }
}

/// The largest distance over its tolerance, or the root mean square distance over its own, whichever is larger.
pub(super) fn miss([rms, max]: [f64; 2], tolerance: f64) -> f64 {
    f64::max(max, rms / RMS) / tolerance
}

/// A number that is smaller for a better fit: first by the tolerance, then by the count of folds, then by the distance.
pub(super) fn cost(measures: [f64; 2], folds: &[usize], tolerance: f64) -> (f64, usize, f64) {
    let miss = miss(measures, tolerance);
    (if miss <= 1.0 { 0.0 } else { miss }, folds.len(), miss)
}

/// The number of vertices of a triangulation of this surface, or plane, that has at most `control_points` control points of a spline: V
/// vertices have at most n²V − (n² − 1)χ, less for each edge of the boundary.
fn vertices_for(control_points: usize, flat: &FlatMetric, degree: usize) -> usize {
    let square = (degree * degree).max(1) as i64;
    let euler = if flat.plane.is_some() { 1 } else { flat.mesh.euler() };
    let vertices = (control_points as i64 + (square - 1) * euler) / square;
    vertices.max(1) as usize
}

/// Points, options and sizes that all rounds of a fit have in common.
pub(super) struct FitSetting<'a> {
    pub points: &'a [Vector],
    /// For each vertex, true if it lies on the boundary of the surface.
    pub is_boundary: Vec<bool>,
    pub diagonal: f64,
    pub options: &'a SurfaceFitOptions,
    /// Triangles of a closed surface with as many control points as are wanted, which has n² for each two triangles.
    pub triangles: usize,
}

impl<'a> FitSetting<'a> {
    pub fn new(mesh: &Mesh, points: &'a [Vector], options: &'a SurfaceFitOptions) -> FitSetting<'a> {
        let is_boundary = mesh.vertices().map(|v| mesh.is_boundary_vertex(v)).collect();
        let setting = FitSetting { points, is_boundary, diagonal: diagonal(points), options, triangles: 0 };
        let triangles = 2 * setting.most_control_points() / (options.degree * options.degree).max(1);
        FitSetting { triangles, ..setting }
    }

    fn most_control_points(&self) -> usize {
        self.options.control_points.unwrap_or(self.points.len() / 4)
    }

    /// A domain whose splines have no more control points than wanted, the coefficients of fillings included.
    pub fn domain(
        &self,
        sizes: &TriangleSizes<'_>,
        flat: &FlatMetric,
        control: &Control,
    ) -> Result<SurfaceDomain> {
        let degree = self.options.degree;
        let usual = sizes.inside().map(|inside| self.coefficients(inside));
        let fills: usize = usual.chain(sizes.bare().map(|inside| self.coefficients(inside))).sum();
        let most = self.most_control_points().saturating_sub(fills);
        let mut count = vertices_for(most, flat, degree).saturating_sub(sizes.added());
        let mut domain = sizes.domain(count, control)?;
        for _ in 0..TRIES {
            // The domain can have vertices beside those that were chosen.
            let excess = control_points(&domain, degree).saturating_sub(most);
            if excess == 0 {
                break;
            }
            count = count.saturating_sub(excess.div_ceil(degree * degree).max(1));
            domain = sizes.domain(count, control)?;
        }
        Ok(domain)
    }

    /// The number of vertices of the surface in the hole of a singular vertex with this number of turns: [`SurfaceFitOptions::hole`] times
    /// the area of turns² triangles; times [`BARE_HOLE`] more, if the number is not whole.
    pub fn inside(&self, turns: f64) -> usize {
        let vertices = self.points.len() as f64;
        let area = if whole_turns(turns).is_some() { turns * turns } else { BARE_HOLE * turns.max(1.0) };
        let wanted = self.options.hole * area * vertices / self.triangles.max(1) as f64;
        (wanted as usize).clamp(LEAST_INSIDE, LEAST_INSIDE.max((MOST_INSIDE * vertices) as usize))
    }

    /// The number of coefficients of the filling of a hole with this number of vertices.
    pub fn coefficients(&self, inside: usize) -> usize {
        Fill::blank((inside as f64 / POINTS) as usize).coefficients().len()
    }

    /// The hole around a singular vertex: the widest with no more vertices than wanted, so that triangles beyond it are small compared to
    /// their distance from the vertex.
    pub fn hole(
        &self,
        domain: &SurfaceDomain,
        space: &SplineSpace,
        places: &[Parameter],
        v: VertexId,
    ) -> Result<Hole> {
        if let Some(bare) = domain.bare.get(&v) {
            let hole = domain.bare_hole(v, bare.radius, space)?;
            return Ok(hole.blank(self.coefficients(bare.inside)));
        }
        let mut hole = domain.hole(v)?;
        let wanted = self.inside(hole.turns);
        let growth = GROWTH.powf(hole.turns);
        loop {
            let wider = domain.wide_hole(v, growth * hole.radius)?;
            let inside = places.iter().filter(|&&at| wider.contains(at)).count();
            if wider.radius <= hole.radius || inside > wanted {
                break;
            }
            hole = wider;
        }
        let coefficients = self.coefficients(wanted);
        Ok(hole.blank(coefficients))
    }
}

/// The number of control points of splines of degree n over a domain: one for each vertex, n − 1 for each edge, (n − 1)(n − 2)/2 for each
/// triangle.
fn control_points(domain: &SurfaceDomain, degree: usize) -> usize {
    let mesh = &domain.coarse().mesh;
    let inner = degree.saturating_sub(1);
    mesh.n_vertices() + inner * mesh.n_edges() + inner * degree.saturating_sub(2) / 2 * mesh.n_faces()
}

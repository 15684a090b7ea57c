//! Flat metrics of surfaces, over which splines are fitted: by the flow, by a holomorphic 1-form, or a sphere as a plane.

use super::areas::vertex_areas;
use super::pole::{evenest_vertex, from_pole};
use super::singular::{Curvatures, FlatMetricOptions, NEAR_CONE, SingularVertices, curvatures, zeros};
use crate::canonical::{SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::embed::FaceTransitions;
use crate::error::{Error, Result};
use crate::flow::{self, Solution, flow, outside_neighbourhoods};
use crate::geometry::Space;
use crate::geometry::complex::{Complex, cross, distance, norm, norm2};
use crate::harmonic::{ComplexForm, Domain, FormsOptions, HarmonicForms, even_combination, with_conjugate};
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::curvature::curvature;
use crate::metric::{Class, Surface, Target};
use crate::parallel::Pool;
use crate::structure::AffineSource;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Largest curvature, in radians, of a vertex that counts as flat: above what a converged flow leaves, and its rounding.
pub(super) const FLAT: f64 = 1e-7;

/// A flat metric of a surface: a triangulation with edge lengths.
#[derive(Debug, Clone)]
pub struct FlatMetric {
    /// The triangulation. Its first vertices are those of the surface, in order; the others lie on edges of the surface.
    pub mesh: Arc<Mesh>,
    /// The lengths of its edges; infinite at a vertex at infinity.
    pub lengths: PerEdge<f64>,
    /// For a sphere the positions of its vertices in the plane, one of them at infinity.
    pub plane: Option<PerVertex<Complex>>,
}

impl FlatMetric {
    /// A flat metric in the conformal class of a surface.
    ///
    /// By the flow, singular vertices inside the surface and corners of its boundary have all curvature; the boundary is straight between
    /// corners. A sphere with one singular vertex becomes a plane with this vertex at infinity. By a holomorphic 1-form ω, for closed
    /// surfaces of genus 1 and more, lengths are |ω| on the intrinsic Delaunay triangulation, and vertices at zeros of order k have the
    /// curvature −2πk. If ω turns triangles over, as it does where a zero lies inside one, |ω| is no metric; each zero then moves to a vertex
    /// of its triangle, and the metric is that with these curvatures in the conformal class, by the flow.
    ///
    /// # Errors
    /// [`Error::Argument`] for a form on a closed surface of genus 0 or an open surface, singular vertices where there are none or beside
    /// given corners; [`Error::TargetKind`] for a number of singular vertices that the surface cannot have; [`Error::Layout`] for a flow that
    /// does not converge; those of [`flow()`], [`uniformize_sphere`] and [`HarmonicForms::new`]; [`Error::Cancelled`].
    pub fn new(surface: &Surface, options: &FlatMetricOptions, control: &Control) -> Result<FlatMetric> {
        if options.source == AffineSource::Form {
            return FlatMetric::by_form(surface, options, control);
        }
        let all = curvatures(surface, options, &control.part(0.0, 0.5))?;
        FlatMetric::best(surface, &all, options, &control.part(0.5, 1.0)).map(|(flat, _)| flat)
    }

    /// The flat metrics among which [`SingularVertices::Auto`] chooses: the usual one first, with no singular vertex or one, and where its
    /// factor between lengths leaves the range, those with more; for any other choice the metric of [`FlatMetric::new`] alone. Which is best
    /// shows in a fit over each ([`super::fit_surface_over`]).
    ///
    /// # Errors
    /// Those of [`FlatMetric::new`].
    pub fn candidates(
        surface: &Surface,
        options: &FlatMetricOptions,
        control: &Control,
    ) -> Result<Vec<FlatMetric>> {
        if options.source == AffineSource::Form {
            return Ok(vec![FlatMetric::by_form(surface, options, control)?]);
        }
        let all = curvatures(surface, options, &control.part(0.0, 0.5))?;
        let mesh = surface.mesh();
        // On a short boundary of a surface with handles there is no room for all corners.
        let least = if !mesh.is_closed() && mesh.euler() < 0 { all.len() } else { 1 };
        let found = FlatMetric::within_range(surface, &all, least, options, &control.part(0.5, 1.0))?;
        Ok(found.into_iter().map(|(_, flat, _)| flat).collect())
    }

    /// The first of the flat metrics with these curvatures that keeps the factor between lengths within the range, or that with the least
    /// range; beside it, its number.
    fn best(
        surface: &Surface,
        all: &[Curvatures],
        options: &FlatMetricOptions,
        control: &Control,
    ) -> Result<(FlatMetric, usize)> {
        let found = FlatMetric::within_range(surface, all, 1, options, control)?;
        let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let none = || Error::Layout("there is no flat metric to choose".into());
        best.map(|(_, flat, k)| (flat, k)).ok_or_else(none)
    }

    /// The flat metrics with these curvatures, each with the range of its factor and its number, up to the first within the range of the
    /// options, and so many at least. Those whose flow fails are left out, unless all do.
    fn within_range(
        surface: &Surface,
        all: &[Curvatures],
        least: usize,
        options: &FlatMetricOptions,
        control: &Control,
    ) -> Result<Vec<(f64, FlatMetric, usize)>> {
        let (mut metrics, mut failure) = (Vec::new(), None);
        for (k, curvatures) in all.iter().enumerate() {
            let control = &control.attempt(k);
            let found = match curvatures {
                Curvatures::Infinity(vertex) => FlatMetric::of_sphere(surface, *vertex, options, control),
                Curvatures::At(target) => FlatMetric::by_flow(surface, target.clone(), options, control),
            };
            control.check()?;
            match found {
                Ok(flat) => {
                    let range = if all.len() == 1 { 1.0 } else { flat.factor_range(surface)? };
                    metrics.push((range, flat, k));
                    if range <= options.range && metrics.len() >= least {
                        break;
                    }
                }
                Err(error) => failure = Some(error),
            }
        }
        match failure {
            Some(error) if metrics.is_empty() => Err(error),
            _ => Ok(metrics),
        }
    }

    /// The flat metric with these curvatures.
    fn by_flow(
        surface: &Surface,
        target: PerVertex<f64>,
        options: &FlatMetricOptions,
        control: &Control,
    ) -> Result<FlatMetric> {
        let target = Target::All(target);
        let flat =
            flow(surface.clone(), Class::yamabe(Space::E2), &target, &options.flow, &control.part(0.0, 0.8))?;
        if !flat.converged() {
            let error = flat.report().map_or(f64::NAN, |report| report.max_curvature_error);
            return Err(not_converged(error, options.flow.tolerance));
        }
        FlatMetric::of(&flat, &control.part(0.8, 1.0))
    }

    /// The flat metric that a flow found; for a surface that was doubled or has caps, on what was given.
    ///
    /// # Errors
    /// [`Error::Argument`] for a metric that is not Euclidean; those of [`Solution::common_subdivision`].
    pub fn of(flat: &Solution, control: &Control) -> Result<FlatMetric> {
        if flat.metric().space != Space::E2 {
            return Err(Error::argument("metric", flat.metric().space, "flat, of the Euclidean plane"));
        }
        if !flat.goes_beyond_given() {
            return Ok(FlatMetric {
                mesh: flat.mesh().clone(),
                lengths: flat.metric().lengths(flat.mesh())?,
                plane: None,
            });
        }
        let refinement = Arc::new(flat.common_subdivision(control)?);
        let steps = FaceTransitions::new(flat, Some(&refinement))?;
        let mut lengths = PerEdge::filled(steps.mesh.n_edges(), 0.0);
        for f in steps.mesh.faces() {
            let at = steps.corners[f].map(|[x, y, _]| [x, y]);
            for (k, h) in steps.mesh.face_halfedges(f).into_iter().enumerate() {
                lengths[h.edge()] = distance(at[k], at[(k + 1) % 3]);
            }
        }
        Ok(FlatMetric { mesh: steps.mesh, lengths, plane: None })
    }

    /// The plane with a vertex at infinity, by stereographic projection of the uniformized sphere.
    fn of_sphere(
        surface: &Surface,
        puncture: Option<VertexId>,
        options: &FlatMetricOptions,
        control: &Control,
    ) -> Result<FlatMetric> {
        let flow::Options { tolerance, max_iterations, threads, .. } = options.flow;
        let options = SphereOptions { tolerance, max_iterations, puncture, threads };
        let sphere = uniformize_sphere(surface, &options, control)?;
        if !sphere.report.converged {
            return Err(not_converged(sphere.report.max_curvature_error, tolerance));
        }
        let mesh = sphere.metric.mesh().clone();
        let plane = match options.puncture {
            Some(_) => sphere.plane,
            None => from_pole(&sphere.positions, evenest_vertex(surface, &mesh, &sphere.positions)),
        };
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
            let ends = mesh.ends(e).map(|v| plane[v]);
            if ends.as_flattened().iter().all(|x| x.is_finite()) {
                distance(ends[0], ends[1])
            } else {
                f64::INFINITY
            }
        });
        Ok(FlatMetric { mesh, lengths, plane: Some(plane) })
    }

    /// Edge lengths that are comparable everywhere: the flat ones, or for a plane with a vertex at infinity the chords of the unit sphere
    /// that projects to it.
    pub(super) fn finite_lengths(&self) -> PerEdge<f64> {
        let Some(plane) = &self.plane else { return self.lengths.clone() };
        let shrink = |z: Complex| 2.0 / (1.0 + norm2(z)).sqrt();
        PerEdge::from_fn(self.mesh.n_edges(), |e| match self.mesh.ends(e).map(|v| plane[v]) {
            [z, w] if !z[0].is_finite() => shrink(w),
            [z, w] if !w[0].is_finite() => shrink(z),
            [z, w] => 0.5 * distance(z, w) * shrink(z) * shrink(w),
        })
    }

    /// The singular vertices inside the surface, ascending.
    ///
    /// # Errors
    /// Those of [`FlatMetric::curvature`].
    pub fn singular(&self) -> Result<Vec<VertexId>> {
        let curvature = self.curvature()?;
        let is_cone = |v: &VertexId| !self.mesh.is_boundary_vertex(*v) && curvature[*v].abs() > FLAT;
        Ok(self.mesh.vertices().filter(is_cone).collect())
    }

    /// The metric |ω| of a holomorphic 1-form with zeros of small order.
    fn by_form(surface: &Surface, options: &FlatMetricOptions, control: &Control) -> Result<FlatMetric> {
        if surface.mesh().is_closed() && surface.mesh().euler() > 0 {
            let need = "of genus 1 or more, for a metric by a holomorphic form: a sphere has none";
            return Err(Error::argument("surface", "closed, of genus 0", need));
        }
        if !surface.mesh().is_closed() {
            return Err(Error::argument(
                "surface",
                "with boundary",
                "closed, for a metric by a holomorphic form",
            ));
        }
        if options.singular != SingularVertices::Auto {
            let need = "left out: a form has its zeros where they are";
            return Err(Error::argument("singular vertices", format!("{:?}", options.singular), need));
        }
        let domain = Domain::new(surface, control)?;
        let form = Pool::new(options.flow.threads)?.run(|| {
            let forms = HarmonicForms::new(&domain, &FormsOptions::default(), control)?;
            with_conjugate(&forms, &forms, &even_combination(&forms, control)?)
        })?;
        match zeros(domain.mesh(), &form) {
            Some(target) => FlatMetric::by_flow(surface, target, options, control),
            None => FlatMetric::of_form(domain.mesh(), &form),
        }
    }

    /// The ratio of the largest factor between flat lengths and lengths on the surface to the least, at the vertices of the surface except
    /// for the 60 around each singular vertex and corner; for a plane, of the factor between the unit sphere and the surface.
    ///
    /// # Errors
    /// Those of [`FlatMetric::curvature`].
    pub fn factor_range(&self, surface: &Surface) -> Result<f64> {
        let (mesh, curvature) = (surface.mesh(), self.curvature()?);
        let singular = mesh.vertices().filter(|&v| curvature[v].abs() > FLAT);
        let outside = outside_neighbourhoods(mesh, singular, NEAR_CONE);
        let areas = [vertex_areas(mesh, surface.lengths()), vertex_areas(&self.mesh, &self.finite_lengths())];
        let factor = |v: VertexId| (areas[1][v] / areas[0][v]).sqrt();
        let [low, high] = mesh
            .vertices()
            .filter(|&v| outside[v] && factor(v).is_finite())
            .fold([f64::INFINITY, 0.0], |[low, high], v| {
                [f64::min(low, factor(v)), f64::max(high, factor(v))]
            });
        Ok(if high > 0.0 && low > 0.0 { high / low } else { 1.0 })
    }

    /// The metric |ω| of a given holomorphic 1-form ω.
    ///
    /// # Errors
    /// [`Error::Layout`] for triangles that ω turns over.
    pub fn of_form(mesh: &Arc<Mesh>, form: &ComplexForm) -> Result<FlatMetric> {
        let is_upright = |f: &crate::mesh::FaceId| {
            let [p, q, _] = mesh.face_halfedges(*f).map(|h| form.along(h));
            cross(p, q) > 0.0
        };
        let wrong = mesh.faces().filter(|f| !is_upright(f)).count();
        if let Some(f) = mesh.faces().find(|f| !is_upright(f)) {
            return Err(Error::Layout(format!(
                "the holomorphic form turns {wrong} triangles over, triangle {f} among them, so that |ω| is no metric there: refine the surface (`ricci refine --levels 1`), or take the flow"
            )));
        }
        let lengths =
            PerEdge::from_fn(mesh.n_edges(), |e: crate::mesh::EdgeId| norm(form.along(e.halfedge())));
        Ok(FlatMetric { mesh: mesh.clone(), lengths, plane: None })
    }

    /// The curvature at each vertex; of a plane, 4π at infinity and 0 elsewhere.
    ///
    /// # Errors
    /// Those of [`curvature()`].
    pub fn curvature(&self) -> Result<PerVertex<f64>> {
        if let Some(plane) = &self.plane {
            let at = |v: VertexId| if plane[v][0].is_finite() { 0.0 } else { 2.0 * TAU };
            return Ok(PerVertex::from_fn(plane.len(), at));
        }
        Ok(curvature(&self.mesh, Space::E2, &self.lengths)?.at)
    }
}

fn not_converged(error: f64, tolerance: f64) -> Error {
    Error::Layout(format!(
        "the flow to the flat metric did not converge: curvatures miss by {error:e}, asked for {tolerance:e}"
    ))
}

/// The curvature of each vertex, radians, in the flat metric that [`FlatMetric::new`] makes by the flow with these options. Where that is a
/// plane with a vertex at infinity, where no flow leads, those of three and more singular vertices.
///
/// # Errors
/// [`Error::Argument`] for a sphere with one singular vertex, or with too few vertices for three; those of [`FlatMetric::new`].
pub fn flat_curvatures(
    surface: &Surface,
    options: &FlatMetricOptions,
    control: &Control,
) -> Result<PerVertex<f64>> {
    let all = curvatures(surface, options, &control.part(0.0, 0.5))?;
    let best =
        if all.len() > 1 { FlatMetric::best(surface, &all, options, &control.part(0.5, 1.0))?.1 } else { 0 };
    match (&all[best], all.last()) {
        (Curvatures::At(target), _) | (_, Some(Curvatures::At(target))) => Ok(target.clone()),
        _ => {
            let need = "three and more on a sphere, which needs 500 vertices for each";
            Err(Error::argument("number of singular vertices", 1, need))
        }
    }
}

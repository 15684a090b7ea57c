//! The figures of a sphere, as the report has them, and what is said of it.

use super::sphere::{Round, Way};
use crate::figures::Course;
use crate::input::Input;
use crate::say;
use ricci::embed::Quality;
use ricci::metric::Refinement;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub struct SphereFigures {
    space: &'static str,
    scheme: &'static str,
    #[serde(flatten)]
    course: Course,
    /// max |K| of the spherical metric.
    max_curvature_error: f64,
    tolerance: f64,
    flipped_triangles: usize,
    #[serde(flatten)]
    quality: Option<SphereQuality>,
    /// Why the way back to the given triangulation, and with it `qc_mean` and the like, is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_refinement: Option<String>,
    area: f64,
    /// Length of the shortest edge.
    smallest_edge: f64,
    /// Faces whose positions in doubles cannot be told from a point; the metric has them all the same.
    degenerate_faces: usize,
    #[serde(flatten)]
    plane: Option<PlaneFigures>,
    word: Vec<String>,
    traces: Vec<f64>,
    /// The universal cover of a sphere is the sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    copies: Option<usize>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    failed: BTreeMap<&'static str, String>,
}

/// What the way over the punctured plane has to say.
#[derive(Serialize)]
struct PlaneFigures {
    puncture: u32,
    tried: usize,
    planar_curvature_error: f64,
    u_range: f64,
    delaunay_violation: f64,
    link_turning: f64,
    nonconvexity: f64,
    centring: f64,
}

/// How the map of the pieces of the common refinement to the sphere distorts.
#[derive(Serialize)]
struct SphereQuality {
    qc_mean: f64,
    qc_max: f64,
    area_ratio_min: f64,
    area_ratio_max: f64,
    degenerate_pieces: usize,
}

impl SphereFigures {
    /// `copies`: whether a cover was asked for.
    pub fn new(input: &Input, s: &Round, copies: bool) -> SphereFigures {
        let start_flips = s.metric.start_flips();
        let course = match &s.way {
            Way::Flow(r, _) => Course::new(r, start_flips),
            Way::Puncture(r) => {
                let (stop_reason, flips) = (r.stop_reason.name(), start_flips + r.flips);
                let (converged, iterations) = (r.converged, r.iterations);
                Course { converged, stop_reason, iterations, flips, start_flips }
            }
        };
        let plane = match &s.way {
            Way::Flow(..) => None,
            Way::Puncture(r) => Some(PlaneFigures {
                puncture: r.puncture.0,
                tried: r.tried,
                planar_curvature_error: r.max_curvature_error,
                u_range: r.u_range,
                delaunay_violation: r.delaunay_violation,
                link_turning: r.link_turning,
                nonconvexity: r.nonconvexity,
                centring: r.centring,
            }),
        };
        SphereFigures {
            space: "s2",
            scheme: s.scheme.name(),
            course,
            max_curvature_error: s.curvature_error(),
            tolerance: s.tolerance,
            flipped_triangles: s.inward(),
            quality: s.refinement().ok().and_then(|r| SphereQuality::new(input, s, r).ok()),
            no_refinement: s.refinement.as_ref().and_then(|r| r.as_ref().err()).cloned(),
            area: s.curvature.area,
            smallest_edge: s.lengths.iter().copied().fold(f64::INFINITY, f64::min),
            degenerate_faces: s.points(),
            plane,
            word: Vec::new(),
            traces: Vec::new(),
            copies: copies.then_some(1),
            failed: s.failed.0.clone(),
        }
    }
}

impl SphereQuality {
    fn new(input: &Input, s: &Round, r: &Refinement) -> ricci::Result<SphereQuality> {
        let q = Quality::on_sphere(r, input.mesh(), input.surface.lengths(), |f| s.piece(r, f))?;
        Ok(SphereQuality {
            qc_mean: q.qc_mean,
            qc_max: q.qc_max,
            area_ratio_min: q.area_ratio_min,
            area_ratio_max: q.area_ratio_max,
            degenerate_pieces: q.degenerate.len(),
        })
    }
}

/// The summary of a sphere.
pub fn text(s: &Round, copies: bool) -> String {
    let (stop, steps) = match &s.way {
        Way::Puncture(r) => (r.stop_reason, r.iterations),
        Way::Flow(r, _) => (r.stop_reason, r.iterations),
    };
    let mut text = format!(
        "metric   s2 {}: {stop} after {}, max |K| = {:.1e}{}, area {:.6}\n",
        s.scheme,
        say::count(steps, "step", "steps"),
        s.curvature_error(),
        say::tolerance(s.tolerance),
        s.curvature.area,
    );
    if let Way::Puncture(r) = &s.way {
        text += &format!(
            "sphere   vertex {} at infinity, u over {:.2}, off the middle by {:.1e}, convex to {:.1e}\n",
            r.puncture, r.u_range, r.centring, r.nonconvexity
        );
    }
    let points = s.points();
    if points > 0 {
        text += &format!(
            "digits   {} too small for positions in doubles; the metric has all lengths\n",
            say::count(points, "face is", "faces are")
        );
    }
    if copies {
        text += "cover    1 copy: a sphere is its own universal cover\n";
    }
    text
}

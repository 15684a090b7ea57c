//! The figures of a uniformization, as its report has them.

use super::group_file::letters;
use super::quotient::Uniformized;
use crate::figures::{Course, Distortion};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub struct UniformFigures {
    space: &'static str,
    scheme: &'static str,
    #[serde(flatten)]
    course: Course,
    max_curvature_error: f64,
    /// max |K| of the metric that was laid out, whose lengths have twice the digits of doubles.
    angle_defect: f64,
    tolerance: f64,
    rounding_floor: Option<f64>,
    double_double: bool,
    flipped_triangles: usize,
    /// With --on input: faces of the input that fold where the map is made linear on them.
    #[serde(skip_serializing_if = "Option::is_none")]
    flipped_input_faces: Option<usize>,
    #[serde(flatten)]
    distortion: Distortion,
    /// Of the metric: 4π(g − 1) in H², that of the surface as given in E².
    area: f64,
    /// The vertex at the origin.
    base: u32,
    /// Largest distance of a vertex from it.
    radius: f64,
    /// Largest distance of the two places of a corner, see the check layout_consistency.
    disagreement: f64,
    word: Vec<String>,
    relation_residual: f64,
    /// ‖R − I‖ of the relator's matrix, not relative to anything.
    relation_error: f64,
    /// How far the isometries of the layout's sides are from those of their words.
    side_residual: f64,
    traces: Vec<f64>,
    translation_lengths: Vec<f64>,
    /// Total length of each generator's loop on the surface, in the metric.
    loop_lengths: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    modulus: Option<[f64; 2]>,
    domain: Option<DomainFigures>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_domain: Option<String>,
    /// Why the layout is not carried back to the given triangulation, and figures of that are null.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_refinement: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    copies: Option<usize>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    failed: BTreeMap<&'static str, String>,
    left_out: Vec<&'static str>,
    residuals: Vec<f64>,
}

/// The Dirichlet domain of the base point.
#[derive(Serialize)]
struct DomainFigures {
    sides: usize,
    area: f64,
    radius: f64,
}

impl UniformFigures {
    /// `copies`: whether they were asked for.
    pub fn new(u: &Uniformized, copies: bool) -> UniformFigures {
        let laid = u.laid().ok();
        let layout = laid.map_or(&u.layout, |laid| &laid.layout);
        let length = |path: &Vec<ricci::mesh::HalfedgeId>| path.iter().map(|h| u.lengths[h.edge()]).sum();
        UniformFigures {
            space: u.deck.space.name(),
            scheme: u.scheme.name(),
            course: Course::new(&u.report, u.metric.start_flips()),
            max_curvature_error: u.curvature_error(),
            angle_defect: u.angle_defect,
            tolerance: u.report.tolerance,
            rounding_floor: u.report.rounding_floor,
            double_double: u.report.double_double,
            flipped_triangles: u.flipped().len(),
            flipped_input_faces: laid.and_then(|l| l.on_input.as_ref()).map(|o| o.flipped.len()),
            distortion: Distortion::of(laid),
            area: u.area(),
            base: u.basis.base.0,
            radius: layout.radius,
            disagreement: layout.disagreement,
            word: letters(&u.deck.group, &u.deck.group.relator()),
            relation_residual: u.deck.relation_residual,
            relation_error: u.deck.relation_error,
            side_residual: u.deck.side_residual,
            traces: u.deck.traces(),
            translation_lengths: u.deck.translation_lengths(),
            loop_lengths: u.basis.loops.iter().map(length).collect(),
            modulus: u.modulus,
            domain: u.domain().ok().map(|d| DomainFigures {
                sides: d.sides.len(),
                area: d.area,
                radius: d.radius,
            }),
            no_domain: u.domain.as_ref().and_then(|d| d.as_ref().err()).cloned(),
            no_refinement: u.laid.as_ref().and_then(|laid| laid.as_ref().err()).cloned(),
            copies: u.elements.as_ref().ok().filter(|_| copies).map(Vec::len),
            failed: u.failed.0.clone(),
            left_out: u.left_out.clone(),
            residuals: u.report.residuals.clone(),
        }
    }
}

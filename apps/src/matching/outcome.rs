//! A matching with its checks, its figures and its summary.

use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::geometry::vector::{diagonal, distance};
use ricci::geometry::{Space, model, worse};
use ricci::matching::{
    DilatationBracket, FoundLandmarks, FoundPairs, LowerBoundKind, MapJudgement, MapQuality, MapVerdict,
    Matching, RoundHole, cycle_error, map_quality, point_error, uncovered,
};
use ricci::mesh::VertexId;
use ricci::metric::CommonSubdivision;
use serde_json::{Value, json};

/// Largest distance of a landmark's image from its partner, as a share of the diagonal of the target's bounding box.
const LANDMARK: f64 = 1e-8;
/// Largest share of the area of a surface that an overlay misses.
const AREA: f64 = 1e-10;
/// Largest distance of a vertex from the circle of its loop, as a share of the radius.
const ROUND: f64 = 1e-9;
/// Largest difference from 1 of the sum of the weights of a place, and most that one of them is below 0.
const WEIGHTS: f64 = 1e-12;

/// What lets a map be more likely.
const UNLIKELY: &str = "parts of the surfaces that are not alike go to each other: name corresponding vertices with --landmarks L.csv, at tips and joints";

/// A map with its judgement, and its landmarks.
pub struct MatchedSurfaces {
    pub matching: Matching,
    pub landmarks: Vec<[VertexId; 2]>,
    pub judgement: MapJudgement,
    /// What was found by the shapes of the surfaces, where that was asked for.
    pub found: Option<FoundLandmarks>,
}

pub struct MatchOutcome {
    pub source: Input,
    pub target: Input,
    pub matching: Matching,
    pub landmarks: Vec<[VertexId; 2]>,
    judgement: MapJudgement,
    found: Option<FoundLandmarks>,
    quality: MapQuality,
    /// The largest distance between the image of a point that corresponds and its partner, as a share of the diagonal.
    point_error: f64,
    /// The mean and the largest distance of a vertex from where the map and its inverse bring it.
    cycle: [f64; 2],
    /// Per vertex the distance of its image from the target's vertex of the same number, where numbers correspond.
    pub partners: Option<Vec<f64>>,
    pub overlay: Option<CommonSubdivision>,
    /// The shares of the areas of source and target that the overlay misses.
    uncovered: [f64; 2],
    /// The bracket of the Teichmüller distance, where it is asked for.
    pub distance: Option<DilatationBracket>,
}

/// The bracket for the summary.
fn bracket_line(found: &DilatationBracket) -> String {
    let [low, high] = [found.lower, found.upper].map(|k| 0.5 * k.ln());
    format!(
        "distance between {low:.8} and {high:.8} in Teichmüller's metric: dilatations {:.8} and {:.8}\n",
        found.lower, found.upper
    )
}

/// The bracket as the report has it.
fn bracket(found: &DilatationBracket) -> Value {
    let by = match found.kind {
        LowerBoundKind::PeriodMatrices => "period matrices",
        LowerBoundKind::Moduli => "moduli",
        LowerBoundKind::None => "nothing",
    };
    let dilatation = [found.lower, found.upper];
    json!({
        "dilatation": dilatation,
        "distance": dilatation.map(|k| 0.5 * k.ln()),
        "dilatation_99": found.most,
        "lower_by": by,
        "gaps": found.gaps,
        "by_numbers": found.by_numbers,
        "pieces_left_out": found.left_out,
        "area_left_out": found.left_out_area,
    })
}

impl MatchOutcome {
    pub fn new(
        surfaces: [Input; 2],
        matched: MatchedSurfaces,
        same_numbering: bool,
    ) -> ricci::Result<MatchOutcome> {
        let MatchedSurfaces { matching, landmarks, judgement, found } = matched;
        let [source, target] = surfaces;
        let surfaces = [&source.surface, &target.surface];
        let quality = map_quality(surfaces, &matching.forward, &landmarks)?;
        let cycle = cycle_error(surfaces, [&matching.forward, &matching.backward])?;
        let positions = target.positions().unwrap_or_default();
        let point_error = point_error(&target.surface, &matching)?;
        let partners = if same_numbering {
            let size = diagonal(positions).max(f64::MIN_POSITIVE);
            let images = matching.forward.carry(target.mesh(), positions)?;
            Some(images.iter().zip(positions).map(|(&p, &q)| distance(p, q) / size).collect())
        } else {
            None
        };
        let (overlay, uncovered) = (None, [0.0; 2]);
        Ok(MatchOutcome {
            source,
            target,
            matching,
            landmarks,
            judgement,
            found,
            quality,
            point_error,
            cycle,
            partners,
            overlay,
            uncovered,
            distance: None,
        })
    }

    pub fn lay_over(&mut self, overlay: CommonSubdivision) -> ricci::Result<()> {
        self.uncovered = uncovered([&self.source.surface, &self.target.surface], &overlay)?;
        self.overlay = Some(overlay);
        Ok(())
    }

    /// The mean and the largest distance of a vertex's image from the target's vertex of the same number.
    fn partners(&self) -> Option<[f64; 2]> {
        let off = self.partners.as_ref()?;
        let mean = off.iter().sum::<f64>() / off.len().max(1) as f64;
        Some([mean, off.iter().copied().fold(0.0, f64::max)])
    }
}

impl JobOutcome for MatchOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        let flipped = self.matching.flipped.len() + self.matching.target_flipped.len();
        checks.add("flipped_triangles", flipped as f64, 0.0);
        checks.add("landmark_error", self.quality.landmark_error, LANDMARK);
        if !self.matching.points.is_empty() {
            checks.add("point_error", self.point_error, LANDMARK);
        }
        let places = [&self.matching.forward, &self.matching.backward];
        let off = places.iter().flat_map(|map| &map.places).map(|place| {
            let least = place.weights.iter().copied().fold(0.0, f64::min);
            (place.weights.iter().sum::<f64>() - 1.0).abs().max(-least)
        });
        if self.overlay.is_some() {
            checks.add("overlay_area", self.uncovered[0].max(self.uncovered[1]), AREA);
        }
        if !self.matching.holes.is_empty() {
            let off = self.matching.holes.iter().map(|hole| hole.deviation);
            checks.add("roundness", off.fold(0.0, worse), ROUND);
        }
        checks.add("weights", off.fold(0.0, f64::max), WEIGHTS);
        // Where landmarks are given the user has said what corresponds.
        let are_given = self.found.is_none() && !self.landmarks.is_empty();
        if !are_given {
            let is_unlikely = self.judgement.verdict == MapVerdict::Unlikely;
            checks.add_with_remedy("unlikely", f64::from(u8::from(is_unlikely)), 0.0, UNLIKELY);
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.source).with_target(InputSummary::of(&self.target)))
    }

    fn figures(&self, _: &CommandRun<'_>) -> Figures {
        let (m, q) = (&self.matching, &self.quality);
        let [first, second] = m.balance;
        let partners = self.partners();
        Figures::default()
            .if_some("teichmueller", self.distance.as_ref().map(bracket))
            .with("space", m.space.name())
            .with("landmarks", self.landmarks.len())
            .if_some("points", Some(m.points.len()).filter(|n| *n > 0))
            .if_some("point_error", Some(self.point_error).filter(|_| !m.points.is_empty()))
            .if_some("soft_left", Some(m.soft_left.clone()).filter(|left| !left.is_empty()))
            .with("flipped_triangles", m.flipped.len() + m.target_flipped.len())
            .with("landmark_error", q.landmark_error)
            .with("qc_mean", q.qc_mean)
            .with("qc_max", q.qc_max)
            .with("area_ratio_min", q.area_ratio_min)
            .with("area_ratio_mean", q.area_ratio_mean)
            .with("area_ratio_max", q.area_ratio_max)
            .with("area_log", q.area_log)
            .with("area_log_99", self.judgement.area_log_99)
            .with("qc_99", self.judgement.qc_99)
            .with("agreement", self.judgement.agreement)
            .with("verdict", self.judgement.verdict.name())
            .if_some("landmarks_found", self.found.as_ref().map(|_| pairs(&self.landmarks)))
            .if_some("mirror", self.found.as_ref().map(FoundLandmarks::is_mirrored))
            .if_some("search", self.found.as_ref().map(search))
            .with("distance_mean", q.distance_mean)
            .with("distance_max", q.distance_max)
            .with("cycle_mean", self.cycle[0])
            .with("cycle_max", self.cycle[1])
            .if_some("partner_mean", partners.map(|p| p[0]))
            .if_some("partner_max", partners.map(|p| p[1]))
            .if_some("overlay_faces", self.overlay.as_ref().map(|o| o.mesh.n_faces()))
            .if_some("overlay_crossings", self.overlay.as_ref().map(|o| o.crossings.len()))
            .if_some("overlay_uncovered", self.overlay.as_ref().map(|_| self.uncovered.to_vec()))
            .if_some("circles", circles(m))
            .with("outside", m.outside)
            .with("markings", m.markings)
            .with("energy", first.energy)
            .with("target_energy", second.energy)
            .with("balance_residual", first.residual.max(second.residual))
            .with("iterations", m.flow_iterations.to_vec())
    }

    fn summary(&self, done: &Done) -> String {
        let (m, q) = (&self.matching, &self.quality);
        let partners = self.partners().map_or(String::new(), |[mean, most]| {
            format!("partners vertices of the same number are {mean:.2e} of the diagonal apart, at most {most:.2e}\n")
        });
        format!(
            "{}target   {}map      in {}, {}, {} compared; no face folds\n\
             quality  dilatation {:.2} on average, at most {:.1e}; there and back {:.1e} of the diagonal, at most {:.1e}\n{}{partners}{}{}",
            say::surface(&self.source),
            say::surface(&self.target).trim_start_matches("surface").trim_start(),
            m.space,
            landmarks(self),
            say::count(m.markings, "class", "classes"),
            q.qc_mean,
            q.qc_max,
            self.cycle[0],
            self.cycle[1],
            verdict(self),
            self.distance.as_ref().map_or_else(String::new, bracket_line),
            say::finish(done),
        )
    }
}

/// The number of landmarks, and whether they were found.
fn landmarks(outcome: &MatchOutcome) -> String {
    let count = outcome.landmarks.len();
    match &outcome.found {
        Some(_) if count > 0 => say::count(count, "landmark found", "landmarks found"),
        _ => say::count(count, "landmark", "landmarks"),
    }
}

/// Pairs of vertices by their numbers.
fn pairs(landmarks: &[[VertexId; 2]]) -> Vec<[u32; 2]> {
    landmarks.iter().map(|pair| pair.map(|v| v.0)).collect()
}

/// The best candidates of the search for landmarks, that which keeps the sides of the surface and that which turns it over.
fn search(found: &FoundLandmarks) -> Value {
    let [paired, signed] = found.candidates;
    let side = |side: &FoundPairs| {
        let begin = if side.candidate < paired { "extremities" } else { "signs" };
        json!({"pairs": pairs(&side.pairs), "misfit": side.misfit, "candidate": side.candidate, "begins_with": begin})
    };
    json!({
        "candidates": {"extremities": paired, "signs": signed},
        "kept": found.kept.as_ref().map(side),
        "mirrored": found.mirrored.as_ref().map(side),
    })
}

/// What a map is good for, in one line, and what else is to be known of the search for its landmarks.
fn verdict(outcome: &MatchOutcome) -> String {
    let j = &outcome.judgement;
    let mirror = match &outcome.found {
        Some(found) if found.is_mirrored() => {
            "mirror   one surface is like a mirror image of the other: a map that turns it over would fit better\n"
        }
        _ => "",
    };
    format!(
        "verdict  {}: areas change by e^{:.2} on average, by e^{:.1} on 1 % of the surface; dilatation {:.1} on 1 %; agreement {:.2}\n{mirror}",
        j.verdict.name(),
        j.area_log_mean,
        j.area_log_99,
        j.qc_99,
        j.agreement
    )
}

/// The loops as circles; none where they are geodesics.
fn circles(matching: &Matching) -> Option<Vec<Value>> {
    let circle = |hole: &RoundHole| {
        let centre = match matching.space {
            Space::H2 => model::poincare(hole.centre),
            _ => [hole.centre[0], hole.centre[1]],
        };
        json!({"loop": hole.boundary_loop, "center": centre, "radius": hole.radius, "deviation": hole.deviation})
    };
    Some(matching.holes.iter().map(circle).collect()).filter(|all: &Vec<Value>| !all.is_empty())
}

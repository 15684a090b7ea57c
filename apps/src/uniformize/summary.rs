//! The figures and the summaries of `ricci uniformize` and `ricci cover`.

use super::figures::of_quotient;
use super::lifts;
use super::quotient::Uniformized;
use super::shape::{CanonicalOutcome, UniformShape};
use super::sphere_figures;
use crate::flow_summary;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;

impl JobOutcome for CanonicalOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        self.shape.checks()
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        match &self.shape {
            UniformShape::Quotient(u) => of_quotient(u, self.has_copies, run),
            UniformShape::Sphere(s) => sphere_figures::of_sphere(&self.input, s, self.has_copies, run),
        }
    }

    fn summary(&self, done: &Done) -> String {
        let text = match &self.shape {
            UniformShape::Quotient(u) => quotient(u, self.has_copies),
            UniformShape::Sphere(s) => sphere_figures::text(s, self.has_copies),
        };
        say::surface(&self.input) + &text + &say::ending(&self.input, done, self.shape.solved().may_flip)
    }
}

fn quotient(u: &Uniformized, copies: bool) -> String {
    let mut text = format!(
        "metric   {} {}: {} after {}, max |K| = {:.1e}{}, area {}\n",
        u.deck.space,
        u.solved.scheme,
        u.report.stop_reason,
        say::count(u.report.iterations, "step", "steps"),
        u.solved.curvature_error(),
        say::tolerance(u.report.allowed_error()),
        say::size(u.layout.area, 6),
    );
    text += &u.solved.scheme_line();
    let flipped = || say::count(u.flipped().len(), "triangle flipped", "triangles flipped");
    let layout = u.laid().map_or_else(|_| flipped(), flow_summary::layout);
    let modulus = u.extremal_distance.map_or_else(String::new, |m| format!(", modulus {m:.6}"));
    // The layout on the given surface has told that of a torus.
    let is_told = u.laid().is_ok_and(|laid| laid.modulus.is_some());
    let of_torus = if is_told { String::new() } else { say::modulus(u.deck.modulus()) };
    text += &format!("layout   {layout}{of_torus}{modulus}\n");
    text += &crate::modulus::line(u.modulus.as_ref());
    if let Some(Err(why)) = &u.laid {
        text += &format!("FAILED   to carry it back to the given triangulation: {why}\n");
    }
    text += &boundary(u);
    if u.deck.sides.is_empty() {
        return text;
    }
    let [least, most] = [(f64::min as fn(f64, f64) -> f64, f64::INFINITY), (f64::max, 0.0)]
        .map(|(pick, start)| u.deck.translation_lengths().into_iter().fold(start, pick));
    text += &format!(
        "group    {} with {}, residual {:.1e}, of side pairings {:.1e}, translation lengths {} to {}\n",
        say::count(u.deck.generators.len(), "generator", "generators"),
        relator(u),
        u.deck.relation_residual,
        u.deck.side_residual,
        say::size(least, 4),
        say::size(most, 4),
    );
    if let Some(Ok(domain)) = &u.domain {
        text += &format!(
            "domain   {}, radius {}\n",
            say::count(domain.sides.len(), "side", "sides"),
            say::size(domain.radius, 4)
        );
    }
    if let Some(Err(why)) = &u.domain {
        text += &format!("domain   none: {why}\n");
    }
    if let (true, Ok(elements)) = (copies, &u.elements) {
        let n = elements.len();
        text += &format!("cover    {}", say::count(n, "copy", "copies"));
        text += &u.laid().map_or("\n".into(), |laid| format!(", {} triangles\n", n * laid.mesh().n_faces()));
    }
    text + &lifts::text(u)
}

/// The lines about the boundary, with the closed geodesics that were asked for.
fn boundary(u: &Uniformized) -> String {
    let sides: Vec<f64> = u.boundary.iter().flat_map(|b| &b.sides).map(|side| side.length).collect();
    if sides.is_empty() {
        return String::new();
    }
    let (kind, [least, most]) = (
        if u.corners.is_empty() { ["closed geodesic", "closed geodesics"] } else { ["side", "sides"] },
        [sides.iter().copied().fold(f64::INFINITY, f64::min), sides.iter().copied().fold(0.0, f64::max)],
    );
    let mut text = format!(
        "boundary {}, lengths {} to {}, straight to {:.1e}\n",
        say::count(sides.len(), kind[0], kind[1]),
        say::size(least, 4),
        say::size(most, 4),
        u.straightness(),
    );
    for (word, length) in &u.geodesics {
        text += &format!("geodesic {word}: length {}\n", say::size(*length, 6));
    }
    text
}

/// The relator; of many generators only the first and the last handle.
fn relator(u: &Uniformized) -> String {
    const HANDLES: usize = 3;
    let all = u.deck.group.text(&u.deck.group.relator());
    let letters: Vec<&str> = all.split(' ').collect();
    if letters.len() > 4 * HANDLES {
        format!("{} … {}", letters[..4].join(" "), letters[letters.len() - 4..].join(" "))
    } else {
        all
    }
}

//! What the commands say on stdout.

use super::commands::Done;
use crate::say;

/// The summary of a run; `copies`: whether a cover was asked for.
pub fn say(done: &Done, copies: bool) {
    let (u, mesh) = (&done.uniformized, &done.input.mesh);
    let mut text = say::surface(&done.input);
    text += &format!(
        "metric   {} {}: {} after {}, max |K| = {:.1e}, area {:.6}\n",
        u.deck.space,
        u.metric.scheme(),
        u.report.stop_reason,
        say::count(u.report.iterations, "step", "steps"),
        u.curvature_error(),
        u.area(),
    );
    text += &format!("layout   {}\n", say::layout(&u.laid));
    let [least, most] = [(f64::min as fn(f64, f64) -> f64, f64::INFINITY), (f64::max, 0.0)]
        .map(|(pick, start)| u.deck.translation_lengths().into_iter().fold(start, pick));
    text += &format!(
        "group    {} with {}, residual {:.1e}, translation lengths {least:.4} to {most:.4}\n",
        say::count(u.deck.generators.len(), "generator", "generators"),
        u.deck.group.text(&u.deck.group.relator()),
        u.deck.relation_residual,
    );
    if let Ok(domain) = &u.domain {
        text += &format!(
            "domain   {}, radius {:.4}\n",
            say::count(domain.sides.len(), "side", "sides"),
            domain.radius
        );
    }
    if let Err(why) = &u.domain {
        text += &format!("domain   none: {why}\n");
    }
    if copies {
        let n = u.elements.len();
        let triangles = n * u.laid.mesh.n_faces();
        text += &format!(
            "cover    {} of {} faces, {triangles} in all\n",
            say::count(n, "copy", "copies"),
            mesh.n_faces()
        );
    }
    text += &say::ending(&u.left_out, &u.failed, &done.checks, &done.files, done.seconds);
    say::lines(&text);
}

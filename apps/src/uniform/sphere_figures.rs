//! The figures of a sphere, as the report has them, and what is said of it.

use super::sphere::{Round, Way};
use crate::input::Input;
use crate::report::Figures;
use crate::say;
use ricci::geometry::vector::distance;
use ricci::geometry::worse;
use ricci::mesh::FaceId;
use ricci::metric::Refinement;

/// Least length of the longest edge of a piece on the unit sphere whose distortion is measured: coordinates of 1e-16 then give the
/// shape to 1e-9.
const MEASURED_EDGE: f64 = 1e-7;
/// Least area over the square of the longest edge of a piece whose distortion is measured: flatter ones count as degenerate.
const MEASURED_SHARE: f64 = 1e-12;

/// `copies`: whether a cover was asked for.
pub fn of_sphere(input: &Input, s: &Round, copies: bool) -> Figures {
    let (solved, start_flips) = (&s.solved, s.solved.solution.start_flips());
    let figures = Figures::of_metric(solved);
    let mut figures = match &s.way {
        Way::Flow(r, _) => figures.course(r, solved),
        Way::Puncture(r) => figures
            .with("converged", r.converged)
            .with("stop_reason", r.stop_reason.name())
            .with("iterations", r.iterations)
            .with("flips", start_flips + r.flips)
            .with("start_flips", start_flips),
    };
    figures = figures
        .with("max_curvature_error", solved.curvature_error())
        .with("tolerance", s.tolerance)
        .with("flipped_triangles", s.inward());
    if let Ok(q) = s.refinement().map(|r| SphereQuality::new(input, s, r)) {
        figures = figures
            .with("qc_mean", q.qc_mean)
            .with("qc_max", q.qc_max)
            .with("area_ratio_min", q.area_ratio_min)
            .with("area_ratio_max", q.area_ratio_max)
            .with("degenerate_pieces", q.degenerate_pieces);
    }
    figures = figures
        // Why the way back to the given triangulation, and with it `qc_mean` and the like, is missing.
        .if_some("no_refinement", s.refinement.as_ref().and_then(|r| r.as_ref().err()).cloned())
        .with("area", solved.curvature.area)
        .with("smallest_edge", solved.lengths.iter().copied().fold(f64::INFINITY, f64::min))
        // Faces whose positions in doubles cannot be told from a point; the metric has them all the same.
        .with("degenerate_faces", s.points());
    if let Way::Puncture(r) = &s.way {
        figures = figures
            .with("puncture", r.puncture.0)
            .with("tried", r.tried)
            .with("planar_curvature_error", r.max_curvature_error)
            .with("u_range", r.u_range)
            .with("delaunay_violation", r.delaunay_violation)
            .with("link_turning", r.link_turning)
            .with("nonconvexity", r.nonconvexity)
            .with("centring", r.centring);
    }
    let none = Vec::<String>::new;
    // The universal cover of a sphere is the sphere.
    figures.with("word", none()).with("traces", none()).if_some("copies", copies.then_some(1)).missing(solved)
}

/// How the map of the pieces of the common refinement to the sphere distorts.
struct SphereQuality {
    qc_mean: f64,
    qc_max: f64,
    area_ratio_min: f64,
    area_ratio_max: f64,
    degenerate_pieces: usize,
}

impl SphereQuality {
    fn new(input: &Input, s: &Round, r: &Refinement) -> SphereQuality {
        let mut pieces = Vec::with_capacity(r.mesh.n_faces());
        let mut degenerate_pieces = 0;
        for f in r.mesh.faces() {
            match (flat(sides_in_input(input, r, f)), flat(sides(s.piece(r, f)))) {
                (Some(from), Some(to)) if to.0 >= MEASURED_EDGE => pieces.push((from, to)),
                _ => degenerate_pieces += 1,
            }
        }
        let area = |p: &[[f64; 2]; 2]| 0.5 * (p[0][0] * p[1][1]);
        let total = |all: &mut dyn Iterator<Item = f64>| all.sum::<f64>();
        let [before, after] = [
            total(&mut pieces.iter().map(|(from, _)| area(&from.1))),
            total(&mut pieces.iter().map(|(_, to)| area(&to.1))),
        ];
        let mut q = SphereQuality {
            qc_mean: 0.0,
            qc_max: 1.0,
            area_ratio_min: f64::INFINITY,
            area_ratio_max: 0.0,
            degenerate_pieces,
        };
        for ((_, from), (_, to)) in &pieces {
            let ratio = area(to) / after / (area(from) / before);
            let k = dilatation(from, to);
            q.qc_mean += k * area(from) / before;
            q.qc_max = worse(q.qc_max, k);
            q.area_ratio_min = q.area_ratio_min.min(ratio);
            q.area_ratio_max = worse(q.area_ratio_max, ratio);
        }
        if pieces.is_empty() {
            (q.qc_mean, q.area_ratio_min, q.area_ratio_max) = (1.0, 1.0, 1.0);
        }
        q
    }
}

/// Lengths of a piece's sides 0 → 1, 1 → 2, 2 → 0 in the input.
fn sides_in_input(input: &Input, r: &Refinement, f: FaceId) -> [f64; 3] {
    let given = r.input_face[f];
    let [a, b, c] = input.mesh().opposite_edges(given).map(|e| input.surface.lengths()[e]);
    let w = r.input_barycentric(f);
    [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
        // |Σ w_k p_k|² = −Σ w_j w_k l_jk² for weights that add up to 0.
        let [x, y, z] = [0, 1, 2].map(|k| w[j][k] - w[i][k]);
        (-(y * z * a * a + z * x * b * b + x * y * c * c)).max(0.0).sqrt()
    })
}

fn sides([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    [distance(a, b), distance(b, c), distance(c, a)]
}

/// A triangle with these sides in the plane: its longest side, and the vectors from corner 0 to the others, the first along x; none for one
/// without a shape.
fn flat([l01, l12, l20]: [f64; 3]) -> Option<(f64, [[f64; 2]; 2])> {
    let longest = l01.max(l12).max(l20);
    let x = (l01 * l01 + l20 * l20 - l12 * l12) / (2.0 * l01);
    let y = (l20 * l20 - x * x).max(0.0).sqrt();
    (0.5 * l01 * y > MEASURED_SHARE * longest * longest && x.is_finite())
        .then_some((longest, [[l01, 0.0], [x, y]]))
}

/// The quotient of the singular values of the linear map from one triangle to another.
fn dilatation(from: &[[f64; 2]; 2], to: &[[f64; 2]; 2]) -> f64 {
    let ([[a, _], [b, c]], [[p, _], [q, r]]) = (*from, *to);
    // Upper triangular: [[p/a, (q − p b/a)/c], [0, r/c]].
    let (m, n, o) = (p / a, (q - p * b / a) / c, r / c);
    let (sum, product) = (m * m + n * n + o * o, m * o);
    let root = ((sum - 2.0 * product) * (sum + 2.0 * product)).max(0.0).sqrt();
    worse((sum + root) / (2.0 * product), 1.0)
}

/// The summary of a sphere.
pub fn text(s: &Round, copies: bool) -> String {
    let (stop, steps) = match &s.way {
        Way::Puncture(r) => (r.stop_reason, r.iterations),
        Way::Flow(r, _) => (r.stop_reason, r.iterations),
    };
    let mut text = format!(
        "metric   s2 {}: {stop} after {}, max |K| = {:.1e}{}, area {:.6}\n",
        s.solved.scheme,
        say::count(steps, "step", "steps"),
        s.solved.curvature_error(),
        say::tolerance(s.tolerance),
        s.solved.curvature.area,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dilatation_is_the_quotient_of_singular_values() {
        let unit = [[1.0, 0.0], [0.3, 0.8]];
        assert!((dilatation(&unit, &unit) - 1.0).abs() < 1e-12);
        let scaled = unit.map(|v| v.map(|x| 7.0 * x));
        assert!((dilatation(&unit, &scaled) - 1.0).abs() < 1e-12);
        let stretched = [[3.0, 0.0], [0.9, 0.8]];
        assert!((dilatation(&unit, &stretched) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn triangles_are_laid_flat_by_their_sides() {
        let (longest, [a, b]) = flat([3.0, 5.0, 4.0]).unwrap();
        assert_eq!((longest, a, b), (5.0, [3.0, 0.0], [0.0, 4.0]));
        assert!(flat([1.0, 2.0, 1.0]).is_none() && flat([0.0, 1.0, 1.0]).is_none());
    }
}

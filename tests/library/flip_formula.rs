//! Flips against brute-force geometry of circles in the plane.

use crate::common::Random;
use ricci::geometry::Space;
use ricci::geometry::flip::{Hinge, Weight, diagonal};

/// Circles with centre and ε r², the power of a point p is |p − c|² − ε r².
#[derive(Clone, Copy, Debug)]
struct Weighted {
    centre: [f64; 2],
    epsilon: f64,
    r: f64,
}

fn squared(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
}

/// η from the length, with w = r (for ε = 0 any number).
fn eta(a: Weighted, b: Weighted) -> f64 {
    (squared(a.centre, b.centre) - a.epsilon * a.r * a.r - b.epsilon * b.r * b.r) / (2.0 * a.r * b.r)
}

fn hinge([i, j, k, l]: [Weighted; 4]) -> Hinge {
    let all = [i, j, k, l];
    Hinge::new(
        all.map(|c| c.epsilon),
        all.map(|c| c.r),
        [eta(i, j), eta(i, k), eta(j, k), eta(i, l), eta(j, l)],
    )
}

/// Centre and power of the circle orthogonal to three others: `2 x·(c_0 − c_k) = |c_0|² − ρ_0 − (|c_k|² − ρ_k)`.
fn orthogonal(c: [Weighted; 3]) -> ([f64; 2], f64) {
    let height = |w: Weighted| squared(w.centre, [0.0; 2]) - w.epsilon * w.r * w.r;
    let row = |k: usize| {
        let d = [0, 1].map(|x| 2.0 * (c[0].centre[x] - c[k].centre[x]));
        (d, height(c[0]) - height(c[k]))
    };
    let ((p, x), (q, y)) = (row(1), row(2));
    let det = p[0] * q[1] - p[1] * q[0];
    let centre = [(x * q[1] - y * p[1]) / det, (p[0] * y - q[0] * x) / det];
    (centre, squared(centre, c[0].centre) - c[0].epsilon * c[0].r * c[0].r)
}

struct Draw(Random);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }

    /// A convex quadrilateral i, j with k on the left and l on the right; circles that are smaller than the distances.
    fn quadrilateral(&mut self, epsilon: [f64; 4]) -> [Weighted; 4] {
        let at = [[0.0, 0.0], [1.0, 0.0]];
        let k = [self.between(0.1, 0.9), self.between(0.2, 1.2)];
        let l = [self.between(0.1, 0.9), -self.between(0.2, 1.2)];
        let centres = [at[0], at[1], k, l];
        std::array::from_fn(|v| Weighted {
            centre: centres[v],
            epsilon: epsilon[v],
            r: self.between(0.02, 0.09),
        })
    }
}

#[test]
fn an_edge_is_delaunay_where_the_fourth_circle_does_not_meet_the_orthogonal_one_of_three() {
    let mut random = Draw(Random::new(5));
    let types = [[0.0; 4], [1.0; 4], [1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 1.0]];
    let (mut flips, mut stays, mut imaginary) = (0, 0, 0);
    for epsilon in types.into_iter().cycle().take(10_000) {
        let [i, j, k, l] = random.quadrilateral(epsilon);
        let (centre, power) = orthogonal([i, j, k]);
        imaginary += usize::from(power < 0.0);
        // Power of the circle l with respect to the orthogonal one: negative where it reaches inside.
        let inside = squared(centre, l.centre) - l.epsilon * l.r * l.r - power;
        let height = hinge([i, j, k, l]).height().unwrap();
        if inside.abs() > 1e-9 {
            assert_eq!(height > 0.0, inside > 0.0, "{epsilon:?}: {height} {inside}");
            let [flip, stay] = if inside < 0.0 { [1, 0] } else { [0, 1] };
            (flips, stays) = (flips + flip, stays + stay);
        }
    }
    assert!(flips > 1000 && stays > 1000, "{flips} {stays}");
    assert_eq!(imaginary, 0);
}

#[test]
fn a_flip_keeps_the_plane_where_the_four_circles_have_a_common_orthogonal_one() {
    let mut random = Draw(Random::new(6));
    let mut seen = [0, 0];
    for round in 0..10_000 {
        let epsilon = [[0.0; 4], [1.0; 4], [1.0, 0.0, 0.0, 1.0], [-1.0, 1.0, 0.0, 1.0]][round % 4];
        let mut q = random.quadrilateral(epsilon);
        let (centre, power) = orthogonal([q[0], q[1], q[2]]);
        // Choose the radius of l such that it is orthogonal too: ε r² = |c − x|² − power.
        let square = squared(centre, q[3].centre) - power;
        if square.abs() < 1e-4 {
            continue;
        }
        q[3] = Weighted { epsilon: square.signum(), r: square.abs().sqrt(), ..q[3] };
        let flippable = hinge(q);
        if let Some(kl) = flippable.flipped() {
            let (k, l) = (q[2], q[3]);
            let known = 0.5 * (squared(k.centre, l.centre) - k.epsilon * k.r * k.r - l.epsilon * l.r * l.r);
            let size = squared(k.centre, l.centre) + k.r * k.r + l.r * l.r;
            assert!((kl - known).abs() < 1e-11 * size, "{kl} {known}");
            assert!(flippable.height().unwrap().abs() < 1e-9, "{:?}", flippable.height());
            seen[usize::from(power < 0.0)] += 1;
        }
    }
    // Imaginary ones have no flip to compare: see below.
    assert!(seen[0] > 3000 && seen[1] == 0, "{seen:?}");
}

// An imaginary circle orthogonal to others, |c − x|² − ε r² = −d² < 0 for each of them: then ε r² = |c − x|² + d² > 0, all are
// real circles, and η_ij = −((c_i − x)·(c_j − x) + d²)/(r_i r_j), the cosine between two vectors (c − x, d) of space, has |η_ij| < 1:
// D = η² − 1 < 0. (The complement of a time-like vector of Lorentz space is Euclidean.) So no edge with such a circle on either
// side can be flipped, and the common circle of a flip is real, of whatever types the vertices are.

#[test]
fn circles_with_an_imaginary_orthogonal_one_cross_and_are_never_flipped() {
    let mut random = Draw(Random::new(7));
    for round in 0..10_000 {
        let mut q = random.quadrilateral([1.0; 4]);
        let x = [random.between(-3.0, 3.0), random.between(-3.0, 3.0)];
        let depth = random.between(-6.0, 2.0).exp();
        // Of all four circles, or of one triangle alone and the fourth of any type.
        let common = round % 2 == 0;
        for c in &mut q[..if common { 4 } else { 3 }] {
            c.r = (squared(c.centre, x) + depth * depth).sqrt();
        }
        if !common {
            q[3] =
                Weighted { epsilon: [-1.0, 0.0, 1.0][round % 3], r: random.between(-3.0, 1.0).exp(), ..q[3] };
        }
        let (centre, power) = orthogonal([q[0], q[1], q[2]]);
        assert!(squared(centre, x) < 1e-12 && (power + depth * depth).abs() < 1e-9, "{centre:?} {power}");
        assert!([eta(q[0], q[1]), eta(q[0], q[2]), eta(q[1], q[2])].iter().all(|eta| eta.abs() < 1.0));
        let hinge = hinge(q);
        assert!(hinge.flipped().is_none() && hinge.meeting().is_none() && !hinge.wants_flip());
    }
}

#[test]
fn an_edge_that_can_be_flipped_has_a_real_orthogonal_circle_on_both_sides() {
    let mut random = Draw(Random::new(12));
    // Flippable edges by the number of ε = −1, 0, 1 among their vertices; imaginary circles by whether the edge can be flipped.
    let (mut types, mut imaginary) = ([0; 3], 0);
    for _ in 0..40_000 {
        let mut q = random.quadrilateral([0.0; 4]);
        for c in &mut q {
            let epsilon = [-1.0, 0.0, 1.0, 1.0, 1.0, 1.0][(random.0.unit() * 6.0) as usize];
            *c = Weighted { epsilon, r: random.between(-3.0, 0.5).exp(), ..*c };
        }
        let [i, j, k, l] = q;
        let powers = [orthogonal([i, j, k]).1, orthogonal([i, j, l]).1];
        if hinge(q).flipped().is_some() {
            assert!(powers.iter().all(|&p| p > -1e-12), "{q:?}: {powers:?}");
            q.iter().for_each(|c| types[(c.epsilon + 1.0) as usize] += 1);
        } else {
            imaginary += usize::from(powers.iter().any(|&p| p < -1e-6));
        }
    }
    println!("{types:?} vertices of flippable edges, {imaginary} edges with an imaginary circle");
    assert!(types.iter().all(|&n| n > 1000) && imaginary > 1000, "{types:?} {imaginary}");
}

#[test]
fn flipping_twice_gives_the_weight_back() {
    let mut random = Draw(Random::new(8));
    for epsilon in
        [[0.0; 4], [1.0; 4], [1.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]].into_iter().cycle().take(10_000)
    {
        // Any class. (A circle far smaller than its neighbours leaves η = 1 + little on the other diagonal: digits lost.)
        let mut weight = || random.between(-4.0, 4.0).exp();
        let w: [f64; 4] = std::array::from_fn(|_| weight());
        let eta: [f64; 5] = std::array::from_fn(|_| 1.0 + weight());
        let [ij, ik, jk, il, jl] = eta;
        let Some(flipped) = Hinge::new(epsilon, w, eta).flipped() else { continue };
        let kl = flipped / (w[2] * w[3]);
        let [i, j, k, l] = [0, 1, 2, 3];
        let back = [k, l, j, i];
        let again = Hinge::new(back.map(|v| epsilon[v]), back.map(|v| w[v]), [kl, jk, jl, ik, il]);
        let Some(found) = again.flipped() else { continue };
        let found = found / (w[0] * w[1]);
        assert!((found / ij - 1.0).abs() < 1e-9, "{epsilon:?}: {found} {ij}");
        // The same with other scales of the vectors.
        let plain = Hinge::new(epsilon, [1.0; 4], eta).flipped().unwrap();
        assert!((plain / kl - 1.0).abs() < 1e-12, "{plain} {kl}");
    }
}

/// Four vertices that are 2^±3000 times as large decide alike, bit for bit, and have the same η.
#[test]
fn weights_beyond_doubles_flip_as_others_do() {
    let mut random = Draw(Random::new(12));
    let mut flips = 0;
    for epsilon in [[0.0; 4], [1.0; 4], [1.0, 0.0, 1.0, 0.0]].into_iter().cycle().take(3000) {
        let w: [f64; 4] = std::array::from_fn(|_| random.between(-3.0, 3.0).exp());
        let eta: [f64; 5] = std::array::from_fn(|_| 1.0 + random.between(-3.0, 3.0).exp());
        let plain = Hinge::new(epsilon, w, eta);
        for exponent in [-3000, -40, 0, 3000] {
            let (hinge, scale) = Hinge::of_weights(epsilon, w.map(|value| Weight { value, exponent }), eta);
            assert_eq!(hinge.wants_flip(), plain.wants_flip(), "{epsilon:?} {exponent}");
            let [ours, theirs] =
                [(hinge, scale), (plain, w[2] * w[3])].map(|(h, by)| h.flipped().map(|x| x / by));
            assert_eq!(ours, theirs, "{epsilon:?} {exponent}");
        }
        flips += usize::from(plain.wants_flip());
    }
    assert!((100..2900).contains(&flips), "{flips}");
}

#[test]
fn ptolemy_is_the_case_of_no_circles() {
    let mut random = Draw(Random::new(9));
    for _ in 0..1000 {
        let l: [f64; 5] = std::array::from_fn(|_| random.between(-60.0, 60.0).exp());
        let kl = (2.0 * Hinge::new([0.0; 4], [1.0; 4], l.map(|l| 0.5 * l * l)).flipped().unwrap()).sqrt();
        let known = (l[1] * l[4] + l[2] * l[3]) / l[0];
        assert!((kl / known - 1.0).abs() < 1e-14, "{kl} {known}");
    }
}

#[test]
fn tangent_circles_are_never_flipped() {
    let tangent = Hinge::new([1.0; 4], [1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 2.0, 2.0, 2.0]);
    assert!(tangent.flipped().is_none() && !tangent.wants_flip());
    let crossing = Hinge::new([1.0; 4], [1.0; 4], [0.5, 2.0, 2.0, 2.0, 2.0]);
    assert!(crossing.flipped().is_none() && !crossing.wants_flip());
}

#[test]
fn diagonals_agree_with_positions() {
    let mut random = Draw(Random::new(10));
    for _ in 0..1000 {
        let (a, b, angle) = (random.between(0.1, 2.0), random.between(0.1, 2.0), random.between(0.01, 3.1));
        let plane = squared([a, 0.0], [b * angle.cos(), b * angle.sin()]).sqrt();
        assert!((diagonal(Space::E2, a, b, angle) - plane).abs() < 1e-14);
        let cosh = a.cosh() * b.cosh() - a.sinh() * b.sinh() * angle.cos();
        assert!((diagonal(Space::H2, a, b, angle).cosh() / cosh - 1.0).abs() < 1e-14);
        let (a, b) = (0.5 * a, 0.5 * b);
        let cos = a.cos() * b.cos() + a.sin() * b.sin() * angle.cos();
        assert!((diagonal(Space::S2, a, b, angle).cos() - cos).abs() < 1e-14);
    }
}

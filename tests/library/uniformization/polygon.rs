//! Tests reduced fundamental polygons.

use crate::uniformization::surfaces::{corpus, generated};
use ricci::Control;
use ricci::embed::{DeckElement, DirichletDomain, dirichlet_domain};
use ricci::geometry::motion::precise_point;
use ricci::geometry::{DoubleDouble, Space};
use std::f64::consts::{PI, TAU};

/// Poincaré's conditions for the Dirichlet domain: sides paired by isometries that carry one onto the other, corners cycle with angles that
/// add up to 2π, convex; and the area is the surface's.
#[test]
fn dirichlet_domains_meet_the_conditions_of_the_polygon_theorem() {
    for surface in generated().into_iter().chain(corpus()) {
        let name = &surface.name;
        let q = surface.uniformized();
        let at = q.layout.corner(q.deck.corner);
        let d = dirichlet_domain(&q.deck, at, q.layout.area, &Control::new())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let n = d.corners.len();
        let genus = surface.mesh.genus();
        assert!(n >= 4 * genus && n <= 12 * genus - 6, "{name}: {n} sides");
        assert!((d.area / q.layout.area - 1.0).abs() < 1e-9, "{name}");
        let far = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).hypot(p[1] - q[1]) / p[2].max(q[2]);
        for (k, side) in d.sides.iter().enumerate() {
            let partner = d.partner[k].unwrap();
            assert!(d.partner[partner] == Some(k) && partner != k, "{name}");
            assert!(q.deck.group.is_trivial(&side.word.times(&d.sides[partner].word)), "{name}");
            // The element carries the partner onto this side, turned round, and its word is the element's.
            let apply = |p: [f64; 3]| side.motion.apply(precise_point(q.layout.space, p)).map(f64::from);
            let (from, to) = (apply(d.corners[partner]), apply(d.corners[(partner + 1) % n]));
            let digits = 1e-13 * (1.0 + d.radius.min(30.0)).exp().min(1e6);
            assert!(
                far(from, d.corners[(k + 1) % n]) < digits && far(to, d.corners[k]) < digits,
                "{name}: side {k}"
            );
            let spelled = q.deck.motion(&side.word).unwrap().compose(&side.motion.inverse());
            assert!(spelled.distance_from_identity() < 1e-12 * side.motion.norm_square(), "{name}: side {k}");
            // The side lies half way to the image of the centre.
            let image = side.motion.apply(precise_point(q.layout.space, d.centre)).map(f64::from);
            for p in [d.corners[k], d.corners[(k + 1) % n]] {
                let form = |c: [f64; 3]| match q.layout.space {
                    Space::E2 => (p[0] - c[0]).hypot(p[1] - c[1]),
                    _ => p[2] * c[2] - p[0] * c[0] - p[1] * c[1],
                };
                assert!((form(image) / form(d.centre) - 1.0).abs() < 1e-6, "{name}: side {k}");
            }
        }
        // Angles by cycles of corners: around the corner where side k starts, over side k, to the corner where its partner ends.
        let angle: Vec<f64> = (0..n).map(|k| corner_angle(q.layout.space, &d, k)).collect();
        assert!(angle.iter().all(|&a| a > 0.0 && a <= PI + 1e-9), "{name}: not convex");
        let mut seen = vec![false; n];
        for start in 0..n {
            let (mut k, mut sum) = (start, 0.0);
            while !std::mem::replace(&mut seen[k], true) {
                sum += angle[k];
                k = (d.partner[k].unwrap() + 1) % n;
            }
            assert!(sum == 0.0 || (sum - TAU).abs() < 1e-6, "{name}: cycle of {start}: {sum}");
        }
    }
}

/// Interior angle at corner k, between the lines of the sides that meet there: bisectors of the centre and its images (corners as doubles
/// say little of the direction of a short side).
fn corner_angle(space: Space, d: &DirichletDomain, k: usize) -> f64 {
    let dot = |a: [DoubleDouble; 3], b: [DoubleDouble; 3]| match space {
        Space::E2 => a[0] * b[0] + a[1] * b[1],
        _ => a[0] * b[0] + a[1] * b[1] - a[2] * b[2],
    };
    let normal = |side: &DeckElement| {
        let centre = precise_point(space, d.centre);
        let image = side.motion.apply(centre);
        let out = [0, 1, 2].map(|i| image[i] - centre[i]);
        out.map(|x| x / dot(out, out).sqrt())
    };
    let n = d.sides.len();
    let cos = dot(normal(&d.sides[(k + n - 1) % n]), normal(&d.sides[k]));
    let sin = (DoubleDouble::from(1.0) - cos * cos).sqrt();
    PI - f64::from(sin).atan2(cos.into())
}

/// The canonical polygon: its 4g corners are one point of the surface, so its angles add up to 2π; and its area, from these angles, is the
/// surface's.
#[test]
fn the_angles_of_the_canonical_polygon_add_up_to_a_full_turn() {
    for surface in generated().into_iter().chain(corpus()) {
        let q = surface.uniformized();
        let at = q.layout.corner(q.deck.corner);
        let angles = q.deck.canonical_angles(at).unwrap();
        let corners = q.deck.canonical_polygon(at).unwrap();
        let genus = surface.mesh.genus();
        assert_eq!((angles.len(), corners.len()), (4 * genus, 4 * genus));
        let sum: f64 = angles.iter().sum();
        assert!((sum - TAU).abs() < 1e-9, "{}: {sum}", surface.name);
        assert!(corners.iter().flatten().all(|x| x.is_finite()));
    }
}

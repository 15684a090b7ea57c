//! Tests finite pieces of the universal cover.

use crate::common::Random;
use crate::uniformization::surfaces::{Surface, generated};
use ricci::canonical::Quotient;
use ricci::embed::cover::{elements_to_depth, elements_within, moved};
use ricci::embed::{DeckElement, dirichlet_domain};
use ricci::geometry::model::klein;
use ricci::geometry::motion::precise_point;
use ricci::geometry::predicates::orientation;
use ricci::geometry::{DoubleDouble, Motion, Space};
use ricci::mesh::{HalfedgeId, shapes};
use ricci::topology::word::{Letter, Word};
use ricci::{Control, Error};
use std::cmp::Ordering;
use std::collections::HashSet;

fn samples() -> Vec<Surface> {
    vec![
        Surface::from_soup("torus of revolution", &shapes::torus(2.0, 0.7, 12, 9).unwrap()),
        Surface::intrinsic("Bolza surface", &shapes::bolza(2).unwrap()),
        Surface::from_soup("genus 2", &shapes::genus(2, 2).unwrap()),
        Surface::from_soup("genus 3", &shapes::genus(3, 2).unwrap()),
    ]
}

/// The number of elements of word length at most n: of ℤ² 2n² + 2n + 1; of genus 2 the growth of its one-relator presentation, free up to
/// length 3, since the relator has length 8.
#[test]
fn no_copy_comes_twice_and_none_is_missing() {
    let counts = |surface: &Surface, depth: usize| {
        let q = surface.uniformized();
        elements_to_depth(&q.deck, depth, 1 << 20, &Control::new()).unwrap()
    };
    let torus = &samples()[0];
    for depth in 0..6 {
        assert_eq!(counts(torus, depth).len(), 2 * depth * depth + 2 * depth + 1);
    }
    let genus2 = &samples()[1];
    // Spheres of the free group have 8·7^(n−1) elements; words of length 4 are equal in pairs where they are halves of the
    // relator: 8 rotations of it and 8 of its inverse, 16 halves in 8 pairs.
    let balls: Vec<usize> = (0..5).map(|depth| counts(genus2, depth).len()).collect();
    assert_eq!(balls, [1, 9, 65, 457, 457 + 8 * 343 - 8]);
    let all = counts(genus2, 4);
    let places: HashSet<[i64; 4]> = all
        .iter()
        .map(|g| g.motion.positive().rounded())
        .map(|m| [m.a[0], m.a[1], m.b[0], m.b[1]].map(|x| (x * 1e6).round() as i64))
        .collect();
    assert_eq!(places.len(), all.len(), "two copies in one place");
}

#[test]
fn copies_within_a_radius_are_those_of_any_word_length() {
    for surface in samples() {
        let q = surface.uniformized();
        let at = q.layout.corner(q.deck.corner);
        let d = dirichlet_domain(&q.deck, at, q.layout.area, &Control::new()).unwrap();
        let radius = 1.7 * d.radius;
        let near = elements_within(&q.deck, &d, radius, 1 << 20, &Control::new()).unwrap();
        assert!(near.windows(2).all(|w| w[0].motion.displacement() <= w[1].motion.displacement() + 1e-9));
        let words = elements_to_depth(&q.deck, 4, 1 << 20, &Control::new()).unwrap();
        for g in words.iter().filter(|g| g.motion.displacement() <= radius) {
            let found = near.iter().any(|h| q.deck.group.equal(&g.word, &h.word));
            assert!(found, "{}: {} is missing", surface.name, q.deck.group.text(&g.word));
        }
        for (i, g) in near.iter().enumerate() {
            assert!(g.motion.displacement() <= radius);
            let off = q.deck.motion(&g.word).unwrap().compose(&g.motion.inverse()).distance_from_identity();
            assert!(off < 1e-12 * g.motion.norm_square());
            assert!(near[..i].iter().all(|h| !q.deck.group.equal(&g.word, &h.word)), "{}", surface.name);
        }
    }
}

/// Copies γ D and γ s D, s the element of a side, share that side: vertex for vertex, the two placed independently of each other, the one
/// by γ's word, the other by that of γ s. In the Poincaré disk, where copies are drawn; and by hyperbolic distance as far as isometries of
/// twice the digits tell points apart there (up to e^33 from the base, 1e-8 is 1e-30 of the products). A wrong corner of the side's
/// triangle is far away by that distance.
#[test]
fn shared_sides_coincide() {
    let mut random = Random::new(9);
    let mut far_enough = 0;
    for surface in generated() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        let space = q.layout.space;
        for length in [0, 1, 2, 3, 6] {
            let letters = (0..length).map(|_| Letter(random.below(2 * q.deck.group.n_generators()) as u32));
            let word = q.deck.group.reduce(&Word::from_iter(letters));
            let gamma = q.deck.motion(&word).unwrap();
            let limit = if length < 6 { 1e-8 } else { 1e-6 };
            let cut: Vec<HalfedgeId> = mesh.halfedges().filter(|&h| q.layout.side(h) != 0).collect();
            for &h in cut.iter().step_by(1 + cut.len() / 40) {
                // The neighbour by its word, through the generators; not by the side's own isometry.
                let neighbour = gamma.compose(&q.deck.motion(&q.basis_word(mesh, h)).unwrap());
                let [here, other] = [h, mesh.next(h)].map(|h| moved(&[q.layout.corner(h)], &gamma)[0]);
                let there = moved(&[q.layout.corner(mesh.next(h.twin()))], &neighbour)[0];
                let apart = drawn(space, here, there);
                assert!(apart < limit, "{}, word length {length}: {apart:e}", surface.name);
                let reach = gamma.displacement() + neighbour.displacement() + 2.0 * q.layout.radius;
                if space == Space::H2 && reach > 50.0 {
                    continue;
                }
                far_enough += usize::from(length >= 3);
                // Back to where the first copy lies.
                let home = gamma.inverse().compose(&neighbour);
                let image = home.apply(precise_point(space, q.layout.corner(mesh.next(h.twin()))));
                let from = |p: [f64; 3]| distance(space, p, image.map(f64::from));
                assert!(
                    from(q.layout.corner(h)) < limit,
                    "{}, {length}: {:e}",
                    surface.name,
                    from(q.layout.corner(h))
                );
                assert!(drawn(space, here, other) > 0.0 && from(q.layout.corner(mesh.next(h))) > 1e-3);
            }
        }
    }
    assert!(far_enough > 100, "{far_enough}");
}

/// Distance in the plane, hyperbolic distance near the origin.
fn distance(space: Space, p: [f64; 3], q: [f64; 3]) -> f64 {
    match space {
        Space::E2 => (p[0] - q[0]).hypot(p[1] - q[1]),
        _ => {
            let [p, q] = [p, q].map(|p| precise_point(space, p));
            let d = [0, 1, 2].map(|i| p[i] - q[i]);
            2.0 * (f64::from(d[0] * d[0] + d[1] * d[1] - d[2] * d[2]).max(0.0).sqrt() / 2.0).asinh()
        }
    }
}

/// Distance where copies are drawn: in the plane, in the Poincaré disk.
fn drawn(space: Space, p: [f64; 3], q: [f64; 3]) -> f64 {
    let at = |[x, y, w]: [f64; 3]| if space == Space::E2 { [x, y] } else { [x / (1.0 + w), y / (1.0 + w)] };
    let [p, q] = [at(p), at(q)];
    (p[0] - q[0]).hypot(p[1] - q[1])
}

trait Sides {
    fn basis_word(&self, mesh: &ricci::mesh::Mesh, h: HalfedgeId) -> Word;
}

impl Sides for Quotient {
    /// The word of the side of the layout's domain that a cut half-edge belongs to.
    fn basis_word(&self, mesh: &ricci::mesh::Mesh, h: HalfedgeId) -> Word {
        let domain =
            ricci::topology::FundamentalDomain::new(mesh, &self.layout.cut.is_cut, &self.basis).unwrap();
        let side = domain.sides.iter().find(|side| side.halfedges.contains(&h)).unwrap();
        side.element.clone()
    }
}

/// Areas of the triangles of all copies, from their coordinates, add up to N times the domain's.
#[test]
fn the_area_of_the_copies_is_that_of_the_domain_times_their_number() {
    for surface in samples() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        let all = elements_to_depth(&q.deck, 1, 1000, &Control::new()).unwrap();
        for g in &all {
            let points = moved(&q.layout.points, &g.motion);
            let mut area = 0.0;
            for f in mesh.faces() {
                let corners = mesh.face_halfedges(f).map(|h| points[q.layout.corner_index[h] as usize]);
                area += triangle_area(q.layout.space, corners);
            }
            let error = (area / q.layout.area - 1.0).abs();
            assert!(error < 1e-9, "{}: {error:e} at {}", surface.name, g.motion.displacement());
        }
    }
}

/// Area from the corners alone: the shoelace formula; in H² tan(A/2) = det / (1 + Σ cosh) (the hyperbolic Eriksson formula). Far out the
/// products need twice the digits.
fn triangle_area(space: Space, corners: [[f64; 3]; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| precise_point(space, p));
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    let det = f64::from(a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1));
    if space == Space::E2 {
        return 0.5 * det;
    }
    let cosh =
        |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| f64::from(p[2] * q[2] - p[0] * q[0] - p[1] * q[1]);
    2.0 * (det / (1.0 + cosh(a, b) + cosh(b, c) + cosh(c, a))).atan()
}

/// Points of one copy lie in no triangle of another, by exact predicates in the plane and the Klein disk; each copy is itself embedded.
#[test]
fn no_two_copies_overlap() {
    let mut random = Random::new(3);
    for surface in samples() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        let flat = |p: [f64; 3]| if q.layout.space == Space::E2 { [p[0], p[1]] } else { klein(p) };
        let at = q.layout.corner(q.deck.corner);
        let d = dirichlet_domain(&q.deck, at, q.layout.area, &Control::new()).unwrap();
        // The copies that are near enough to touch.
        let near = elements_within(&q.deck, &d, 2.0 * q.layout.radius, 1 << 20, &Control::new()).unwrap();
        let triangles: Vec<[[f64; 2]; 3]> = mesh.faces().map(|f| q.layout.face_points(f).map(flat)).collect();
        let inside = |p: [f64; 2], t: &[[f64; 2]; 3]| {
            (0..3).all(|k| orientation(t[k], t[(k + 1) % 3], p) == Ordering::Greater)
        };
        for g in &near {
            for _ in 0..8 {
                let t = mesh.faces().nth(random.below(mesh.n_faces())).unwrap();
                let corners = q.layout.face_points(t);
                let centre = [0, 1, 2].map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
                let p = flat(g.motion.apply(centre.map(DoubleDouble::from)).map(f64::from));
                let hits = triangles.iter().filter(|t| inside(p, t)).count();
                let expected = usize::from(g.word.is_empty());
                assert_eq!(hits, expected, "{}: copy {}", surface.name, q.deck.group.text(&g.word));
            }
        }
    }
}

#[test]
fn too_many_copies_are_refused() {
    let q = samples()[1].uniformized();
    let run = |depth, limit| elements_to_depth(&q.deck, depth, limit, &Control::new());
    assert!(matches!(run(6, 1000), Err(Error::TooLarge { .. })));
    assert_eq!(
        run(0, 1).unwrap(),
        [DeckElement { word: Word::identity(), motion: Motion::identity(Space::H2) }]
    );
    let control = Control::new();
    control.cancel();
    assert!(matches!(elements_to_depth(&q.deck, 3, 1 << 20, &control), Err(Error::Cancelled)));
}

//! Lifts of edge paths in the layout's space, and uniformization from a metric of the surface.

use crate::common::Random;
use crate::uniformization::surfaces::generated;
use ricci::canonical::{QuotientOptions, quotient_of};
use ricci::embed::cover::moved;
use ricci::geometry::Space;
use ricci::mesh::{HalfedgeId, Mesh, VertexId, shapes};
use ricci::{Class, Control, Error, Solution, Surface};

/// A random walk of edges from a vertex.
fn walk(mesh: &Mesh, from: VertexId, length: usize, random: &mut Random) -> Vec<HalfedgeId> {
    let mut at = from;
    let step = |_| {
        let leaving: Vec<HalfedgeId> = mesh.outgoing(at).collect();
        let h = leaving[random.below(leaving.len())];
        at = mesh.tip(h);
        h
    };
    (0..length).map(step).collect()
}

/// Distance in the plane or the Poincaré disk.
fn apart(space: Space, p: [f64; 3], q: [f64; 3]) -> f64 {
    let flat = |[x, y, w]: [f64; 3]| if space == Space::E2 { [x, y] } else { [x / (1.0 + w), y / (1.0 + w)] };
    let (p, q) = (flat(p), flat(q));
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The lift of a walk that goes home along the tree ends where the walk's word carries the base lift, and its way back along itself at
/// the base lift.
#[test]
fn lifts_of_loops_end_where_their_elements_carry_the_base() {
    let mut random = Random::new(4);
    for surface in generated() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        let base = q.layout.corner(q.deck.corner);
        for length in [0, 1, 2, 7, 30] {
            let mut path = walk(mesh, q.basis.base, length, &mut random);
            let end = path.last().map_or(q.basis.base, |&h| mesh.tip(h));
            let home = q.basis.tree_path(mesh, end).unwrap();
            path.extend(home.into_iter().rev().map(HalfedgeId::twin));
            let lift = q.layout.lift(q.deck.corner, &path).unwrap();
            // Isometries have about 32 digits, of which a walk to height w takes log10 w², there and back twice as many.
            if lift.iter().any(|p| p[2] > 1e6) {
                continue;
            }
            assert_eq!(lift.len(), path.len() + 1);
            let word = q.basis.path_word(mesh, &path).unwrap();
            let there = moved(&[base], &q.deck.motion(&word).unwrap())[0];
            let off = apart(q.layout.space, lift[path.len()], there);
            assert!(off < 1e-10, "{}, {length} steps: {off:e}", surface.name);
            path.extend(path.clone().into_iter().rev().map(HalfedgeId::twin));
            let back = q.layout.lift(q.deck.corner, &path).unwrap();
            let off = apart(q.layout.space, back[path.len()], base);
            assert!(off < 1e-10, "{}, there and back: {off:e}", surface.name);
        }
    }
}

#[test]
fn paths_that_do_not_start_at_the_corner_are_refused() {
    let surface = &generated()[0];
    let q = surface.uniformized();
    let mesh = &**q.metric.mesh();
    let away = mesh.halfedges().find(|&h| mesh.origin(h) != q.basis.base).unwrap();
    for (corner, path) in
        [(q.deck.corner, vec![away]), (HalfedgeId(u32::MAX), vec![]), (away, vec![away, away])]
    {
        let error = q.layout.lift(corner, &path).unwrap_err();
        assert!(matches!(error, Error::Argument { .. }), "{error}");
    }
}

/// From the initial metric the same flow starts; from its end nothing is left to do.
#[test]
fn a_metric_is_taken_up_where_it_is() {
    for surface in generated().into_iter().take(5) {
        let first = surface.uniformized();
        let class = Class::yamabe(first.layout.space);
        let start = Solution::initial_of(surface.given(), class).unwrap();
        let (options, control) = (QuotientOptions::default(), Control::new());
        let second = quotient_of(&start, &options, &control).unwrap();
        assert_eq!(first.layout, second.layout, "{}", surface.name);
        let third = quotient_of(&first.metric, &options, &control).unwrap();
        assert_eq!(third.report.iterations, 0, "{}", surface.name);
        assert!((third.layout.area / first.layout.area - 1.0).abs() < 1e-12, "{}", surface.name);
    }
}

#[test]
fn a_metric_in_another_space_is_refused() {
    let (mesh, lengths) = shapes::bolza(1).unwrap().build().unwrap();
    let bolza = Surface::intrinsic(mesh, lengths, Space::H2).unwrap();
    let flat = Solution::initial_of(bolza, Class::yamabe(Space::E2)).unwrap();
    let error = quotient_of(&flat, &QuotientOptions::default(), &Control::new()).unwrap_err();
    assert!(matches!(&error, Error::Layout(message) if message.contains("h2")), "{error}");
}

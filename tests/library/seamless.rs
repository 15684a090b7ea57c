//! Seamless metrics: known answers, angles recomputed along other loops, exact seams, and what is refused.

use crate::common::Random;
use ricci::mesh::{Mesh, PerHalfedge, VertexId, shapes};
use ricci::seamless::{
    ConeValence, DualLoops, Seamless, SeamlessCones, SeamlessMap, SeamlessOptions, field_cones, seamless,
};
use ricci::{Control, Error, Surface};
use std::f64::consts::FRAC_PI_2;

fn found(surface: &Surface, cones: SeamlessCones) -> Seamless {
    let options = SeamlessOptions { cones, ..SeamlessOptions::default() };
    seamless(surface, &options, &Control::new()).unwrap()
}

fn valences(cones: &[(u32, u32)]) -> SeamlessCones {
    let cone = |&(v, valence): &(u32, u32)| ConeValence { vertex: VertexId(v), valence };
    SeamlessCones::Valences(cones.iter().map(cone).collect())
}

/// The angle at the origin of each half-edge, in its face, by the law of cosines alone.
fn angles(mesh: &Mesh, lengths: &[f64]) -> PerHalfedge<f64> {
    let mut angles = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f);
        let l = sides.map(|h| lengths[h.edge().index()]);
        for k in 0..3 {
            let (a, b, c) = (l[k], l[(k + 2) % 3], l[(k + 1) % 3]);
            angles[sides[k]] = ((a * a + b * b - c * c) / (2.0 * a * b)).acos();
        }
    }
    angles
}

/// Largest distance of turning from multiples of 90°, along loops found from a vertex.
fn off_quarters(of: &Seamless, root: u32) -> f64 {
    let mesh = of.solution.mesh();
    let lengths = of.solution.metric().lengths(mesh).unwrap();
    let turning = DualLoops::new(mesh, VertexId(root)).unwrap().turning(mesh, &angles(mesh, &lengths));
    turning.iter().map(|t| (t / FRAC_PI_2 - (t / FRAC_PI_2).round()).abs()).fold(0.0, f64::max)
}

#[test]
fn metrics_are_seamless_along_loops_found_anew() {
    for (name, soup, cones) in [
        ("torus", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Valences(Vec::new())),
        ("torus with cones", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Auto(4)),
        ("torus with the field's", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Field),
        ("genus 2", shapes::genus(2, 6).unwrap(), SeamlessCones::Auto(8)),
        ("genus 2, field", shapes::genus(2, 6).unwrap(), SeamlessCones::Field),
        ("genus 3", shapes::genus(3, 6).unwrap(), SeamlessCones::Auto(12)),
        ("ellipsoid", shapes::ellipsoid([1.6, 1.0, 0.7], 8).unwrap(), SeamlessCones::Field),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let of = found(&surface, cones);
        assert!(of.converged(), "{name}: {:e} after {:?}", of.error, of.iterations);
        for root in [0, 7, 41] {
            let off = off_quarters(&of, root);
            assert!(off < 1e-9, "{name}, loops from {root}: {off:e}");
        }
        assert!(of.iterations[1] <= 12, "{name}: {:?}", of.iterations);
        println!("{name}: {} cones, {:?} iterations, {:.1e}", of.cones.len(), of.iterations, of.error);
    }
}

#[test]
fn a_conformal_signature_changes_nothing() {
    let surface = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 16).unwrap()).unwrap();
    let of = found(&surface, SeamlessCones::Valences(Vec::new()));
    let flow = ricci::Flow::new(
        surface,
        ricci::Class::yamabe(ricci::geometry::Space::E2),
        &ricci::flow::Options::default(),
        &Control::new(),
    )
    .and_then(|mut flow| flow.solve(&ricci::Target::Uniform, &Control::new()))
    .unwrap();
    assert_eq!(**of.solution.mesh(), **flow.mesh());
    let [ours, theirs] = [&of.solution, &flow].map(|s| s.metric().lengths(s.mesh()).unwrap());
    let ratio: Vec<f64> = ours.iter().zip(theirs.iter()).map(|(a, b)| (a / b).ln()).collect();
    let spread =
        ratio.iter().fold(f64::MIN, |a, b| a.max(*b)) - ratio.iter().fold(f64::MAX, |a, b| a.min(*b));
    assert!(spread < 1e-8, "{spread:e}");
    assert_eq!(of.quarter_turns, [0, 0]);
}

#[test]
fn seams_are_exact() {
    for (soup, n) in [(shapes::genus(2, 6).unwrap(), 8), (shapes::torus(2.0, 1.0, 20, 12).unwrap(), 4)] {
        let surface = Surface::from_soup(&soup).unwrap();
        let of = found(&surface, SeamlessCones::Auto(n));
        let SeamlessMap { layout, moved, .. } = of.map(&Control::new()).unwrap();
        assert!(moved < 1e-10 * layout.diameter && layout.flipped.is_empty(), "{moved:e}");
        let mesh = layout.mesh();
        let mut seams = 0;
        for e in mesh.edges() {
            let side = |h| {
                let [a, b] = [layout.uv(h), layout.uv(mesh.next(h))];
                [b[0] - a[0], b[1] - a[1]]
            };
            let ([a, b], [c, d]) = (side(e.halfedge()), side(e.halfedge().twin()));
            // Differences of numbers on one grid are exact.
            assert!([[-a, -b], [b, -a], [a, b], [-b, a]].contains(&[c, d]), "edge {e}: {a} {b}, {c} {d}");
            seams += usize::from([c, d] != [-a, -b] || layout.cut.is_cut[e]);
        }
        assert!(seams > 20, "{seams}");
    }
}

#[test]
fn cones_of_the_field_add_up() {
    for (name, soup) in [
        ("sphere", shapes::icosphere(6).unwrap()),
        ("ellipsoid", shapes::ellipsoid([3.0, 1.0, 0.5], 8).unwrap()),
        ("torus", shapes::torus(3.0, 1.0, 30, 15).unwrap()),
        ("genus 3", shapes::genus(3, 6).unwrap()),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let cones = field_cones(&surface, &Control::new()).unwrap();
        let total: i64 = cones.iter().map(|&k| i64::from(k)).sum();
        assert_eq!(total, 4 * surface.mesh().euler(), "{name}");
    }
}

#[test]
fn turning_is_kept_by_flips_that_keep_the_surface() {
    let surface = Surface::from_soup(&shapes::genus(2, 5).unwrap()).unwrap();
    let (mut mesh, mut lengths) = (Mesh::clone(surface.mesh()), surface.lengths().to_vec());
    let mut loops = DualLoops::new(&mesh, VertexId(3)).unwrap();
    let before = loops.turning(&mesh, &angles(&mesh, &lengths));
    let mut random = Random::new(5);
    let mut flips = 0;
    for _ in 0..4000 {
        let e = ricci::mesh::EdgeId::from(random.below(mesh.n_edges()));
        let h = e.halfedge();
        let alpha = angles(&mesh, &lengths);
        let at = |h| alpha[h];
        // The quadrilateral has to be convex, for the other diagonal to lie inside it.
        let corners = [at(h) + at(mesh.next(h.twin())), at(mesh.next(h)) + at(h.twin())];
        if mesh.face(h) == mesh.face(h.twin()) || corners.iter().any(|x| *x > 3.0) {
            continue;
        }
        let [p, q] = [mesh.prev(h), mesh.next(h.twin())].map(|x| lengths[x.edge().index()]);
        let diagonal = (p * p + q * q - 2.0 * p * q * corners[0].cos()).sqrt();
        loops.before_flip(&mesh, e);
        assert!(mesh.flip(e));
        lengths[e.index()] = diagonal;
        flips += 1;
    }
    let after = loops.turning(&mesh, &angles(&mesh, &lengths));
    for (a, b) in before.iter().zip(&after) {
        assert!((a - b).abs() < 1e-9, "{flips} flips: {before:?} {after:?}");
    }
    assert!(flips > 1000 && before.len() == 4, "{flips}");
}

#[test]
fn impossible_signatures_are_refused_by_name() {
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 12, 8).unwrap()).unwrap();
    let with = |cones, quarter_turns| {
        let options = SeamlessOptions { cones, quarter_turns, ..SeamlessOptions::default() };
        seamless(&torus, &options, &Control::new())
    };
    let is_refused = |result: ricci::Result<Seamless>, word: &str| match result {
        Err(Error::TargetKind { message, .. }) => message.contains(word),
        _ => false,
    };
    assert!(is_refused(with(valences(&[]), Some(vec![1, 0])), "torus"));
    assert!(is_refused(with(valences(&[(0, 3), (40, 5)]), None), "IKRSS13"));
    assert!(is_refused(with(valences(&[(0, 3)]), None), "4 − valence"));
    assert!(is_refused(with(valences(&[(0, 0), (1, 8)]), None), "valence 0"));
    assert!(matches!(with(valences(&[]), Some(vec![0])), Err(Error::Size { .. })));
    let disk = Surface::from_soup(&shapes::disk(4).unwrap()).unwrap();
    let on_disk = |cones| {
        let options = SeamlessOptions { cones, ..SeamlessOptions::default() };
        seamless(&disk, &options, &Control::new())
    };
    assert!(matches!(on_disk(SeamlessCones::Auto(4)), Err(Error::Argument { .. })));
    assert!(is_refused(on_disk(valences(&[])), "on the boundary"));
}

#[test]
fn the_bits_do_not_depend_on_threads() {
    let surface = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let lengths = [1, 2, 5].map(|threads| {
        let options = SeamlessOptions { threads, ..SeamlessOptions::default() };
        let of = seamless(&surface, &options, &Control::new()).unwrap();
        of.solution.metric().lengths(of.solution.mesh()).unwrap()
    });
    assert!(lengths[0] == lengths[1] && lengths[1] == lengths[2]);
}

//! Tests the metric of a quotient, its layout and the deck group.

use crate::common::Random;
use crate::uniformization::surfaces::{Surface, corpus, generated};
use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::embed::{Layout, LayoutOptions, dirichlet_domain};
use ricci::flow::{Options, flow};
use ricci::geometry::{DoubleDouble, Motion, Space};
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::Scheme;
use ricci::topology::word::{Letter, Word};
use ricci::{Class, Control, Error, Target};
use std::f64::consts::PI;
use std::sync::Arc;

/// Everything that must hold of a uniformization, measured from what it returns.
pub fn check(surface: &Surface, q: &Quotient) {
    let name = &surface.name;
    assert!(
        q.report.converged() && q.report.max_curvature_error <= 1e-10,
        "{name}: {}",
        q.report.stop_reason
    );
    let (mesh, genus) = (&**q.metric.mesh(), surface.mesh.genus());
    let layout = &q.layout;
    assert!(layout.broken.is_empty() && layout.flipped.is_empty(), "{name}");
    assert!(q.angle_defect < 1e-28, "{name}: {:e}", q.angle_defect);
    // Hyperbolic distance; points are rounded to doubles at e^radius.
    assert!(layout.disagreement < 1e-15 * (10.0 + layout.radius.exp()), "{name}: {:e}", layout.disagreement);
    sides_have_their_lengths(q, mesh, name);

    let curvature = q.metric.metric().curvature(mesh).unwrap();
    if genus == 1 {
        assert_eq!(layout.space, Space::E2);
        for g in &q.deck.generators {
            assert!(g.rotation_angle() <= 1e-10, "{name}: rotation {:e}", g.rotation_angle());
        }
    } else {
        assert_eq!(layout.space, Space::H2);
        let worst = curvature.at.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
        let v = mesh.n_vertices() as f64;
        let off = (curvature.area - 4.0 * PI * (genus as f64 - 1.0)).abs();
        assert!(off <= v * worst + 1e-12 * v, "{name}: area off by {off:e}");
        for (trace, length) in q.deck.traces().into_iter().zip(q.deck.translation_lengths()) {
            assert!(trace > 2.0 && length > 0.0, "{name}: trace {trace}");
            assert!((2.0 * (0.5 * length).cosh() / trace - 1.0).abs() < 1e-12, "{name}");
        }
    }
    assert!(q.deck.relation_residual <= 1e-15, "{name}: {:e}", q.deck.relation_residual);
    assert!(q.deck.side_residual <= 1e-15, "{name}: {:e}", q.deck.side_residual);
}

/// Distances between the corners of each triangle, by the cosh of their Lorentz product about the triangle, are the metric's lengths.
fn sides_have_their_lengths(q: &Quotient, mesh: &Mesh, name: &str) {
    let lengths = q.metric.metric().lengths(mesh).unwrap();
    let scale = match q.layout.space {
        // E²: scaled to the area of the given surface.
        Space::E2 => (q.layout.area / q.metric.metric().curvature(mesh).unwrap().area).sqrt(),
        _ => 1.0,
    };
    for f in mesh.faces() {
        for h in mesh.face_halfedges(f) {
            let (a, b) = (q.layout.corner(h), q.layout.corner(mesh.next(h)));
            let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            let (l, found) = match q.layout.space {
                Space::E2 => (scale * lengths[h.edge()], d[0].hypot(d[1])),
                // cosh l = −⟨a, b⟩: enough where points are near the origin.
                _ => (lengths[h.edge()].cosh(), a[2] * b[2] - a[0] * b[0] - a[1] * b[1]),
            };
            let digits = 1e-14 * (l + a[2] * a[2]) * (1.0 + q.layout.radius);
            assert!((l - found).abs() < digits, "{name}: face {f}: {l} {found}");
        }
    }
}

#[test]
fn generated_surfaces_are_quotients_of_the_plane_and_the_hyperbolic_plane() {
    for surface in generated() {
        check(&surface, &surface.uniformized());
    }
}

#[test]
fn corpus_surfaces_are_quotients_of_the_plane_and_the_hyperbolic_plane() {
    for surface in corpus() {
        check(&surface, &surface.uniformized());
    }
}

#[test]
fn circle_packings_uniformize_too() {
    let surface = Surface::from_soup("genus 2", &ricci::mesh::shapes::genus(2, 3).unwrap());
    let q = surface.with(&QuotientOptions { scheme: Scheme::Inversive, ..QuotientOptions::default() });
    assert!(q.report.converged() && q.layout.flipped.is_empty());
    // Lengths between circles have the digits of doubles alone.
    assert!(
        q.layout.disagreement < 1e-10 && q.deck.relation_residual < 1e-10,
        "{:e}",
        q.deck.relation_residual
    );
    assert!(q.deck.traces().iter().all(|&t| t > 2.0));
}

/// M(word of a path) carries the base lift to where the path ends when it is walked from triangle to triangle: developed anew, face by
/// face, with plain matrices.
#[test]
fn the_lift_of_a_loop_ends_where_its_word_says() {
    let mut random = Random::new(5);
    for surface in generated() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        let lengths = q.metric.metric().lengths(mesh).unwrap();
        for _ in 0..12 {
            // A random walk from the base, and back along the tree.
            let mut path: Vec<HalfedgeId> = Vec::new();
            let mut at = q.basis.base;
            for _ in 0..random.below(25) {
                let out: Vec<_> = mesh.outgoing(at).collect();
                path.push(out[random.below(out.len())]);
                at = mesh.tip(path[path.len() - 1]);
            }
            let back = q.basis.tree_path(mesh, at).unwrap();
            path.extend(back.iter().rev().map(|h| h.twin()));
            let word = q.basis.path_word(mesh, &path).unwrap();
            let expected = q.deck.motion(&word).unwrap();
            let walked = walk(mesh, &lengths, &q, &path);
            let off = walked.compose(&expected.inverse()).distance_from_identity();
            let size = expected.norm_square().max(walked.norm_square());
            // Lengths are rounded to doubles here.
            assert!(off < 1e-12 * size * (1.0 + path.len() as f64), "{}: {off:e} of {size:e}", surface.name);
        }
    }
}

/// The isometry along a closed path at the base, from the corner of the base lift: turning by angles of the cosine law, stepping by
/// lengths.
fn walk(mesh: &Mesh, lengths: &PerEdge<f64>, q: &Quotient, path: &[HalfedgeId]) -> Motion<DoubleDouble> {
    let space = q.layout.space;
    let scale = match space {
        Space::E2 => (q.layout.area / q.metric.metric().curvature(mesh).unwrap().area).sqrt(),
        _ => 1.0,
    };
    let angle = |h: HalfedgeId| {
        let [a, b, c] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
        match space {
            Space::E2 => ((a * a + c * c - b * b) / (2.0 * a * c)).acos(),
            _ => ((a.cosh() * c.cosh() - b.cosh()) / (a.sinh() * c.sinh())).acos(),
        }
    };
    let turn = |angle: f64| {
        let (s, c) = (0.5 * angle).sin_cos();
        Motion::<DoubleDouble>::rotation([c.into(), s.into()], space)
    };
    // Direction of a half-edge, from another one at the same origin: the angles between, counterclockwise.
    let between = |from: HalfedgeId, to: HalfedgeId| {
        let (mut at, mut sum) = (from, 0.0);
        while at != to {
            sum += angle(at);
            at = mesh.prev(at).twin();
        }
        sum
    };
    // The base lift: the frame of the corner's half-edge, moved to the layout's place.
    let start = start_frame(mesh, q, q.deck.corner);
    let mut frame = start;
    let mut facing = q.deck.corner;
    for &h in path {
        frame = frame.compose(&turn(between(facing, h)));
        frame = frame.compose(&Motion::translation(scale * lengths[h.edge()], space)).compose(&turn(PI));
        facing = h.twin();
    }
    frame = frame.compose(&turn(between(facing, q.deck.corner)));
    frame.compose(&start.inverse())
}

/// The isometry from the origin and the x axis to a half-edge of the layout, from its two ends.
fn start_frame(mesh: &Mesh, q: &Quotient, h: HalfedgeId) -> Motion<DoubleDouble> {
    let (p, tip) = (q.layout.corner(h), q.layout.corner(mesh.next(h)));
    assert!(p[0].hypot(p[1]) < 1e-15, "the base lies at the origin");
    let half = 0.5 * tip[1].atan2(tip[0]);
    Motion::rotation([half.cos().into(), half.sin().into()], q.layout.space)
}

#[test]
fn contractible_loops_close() {
    for surface in generated() {
        let q = surface.uniformized();
        let mesh = &**q.metric.mesh();
        for f in mesh.faces().take(20) {
            let word = q.basis.path_word(mesh, &mesh.face_halfedges(f)).unwrap();
            assert!(word.is_empty(), "{}", surface.name);
        }
        let relator = q.deck.group.relator();
        assert!(q.deck.group.is_trivial(&relator));
        let conjugate =
            Word::from_iter([Letter::generator(1)]).times(&relator).times(&Word::from_iter([Letter(3)]));
        assert!(q.deck.motion(&conjugate).unwrap().distance_from_identity() < 1e-9, "{}", surface.name);
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let surface = Surface::from_soup("genus 3", &ricci::mesh::shapes::genus(3, 4).unwrap());
    let run = |threads| {
        let flow = Options { threads, ..Options::default() };
        surface.with(&QuotientOptions { flow, ..QuotientOptions::default() })
    };
    let (one, three) = (run(1), run(3));
    assert_eq!(one.layout, three.layout);
    assert_eq!(one.deck.generators, three.deck.generators);
    assert_eq!(one.basis.loops, three.basis.loops);
}

/// Chains of handles: loops lead to the far end, where the layout is e^28 away from doubles.
#[test]
fn generators_keep_their_digits_on_long_surfaces() {
    for (genus, residual, area) in [(14, 1e-21, true), (18, 1e-18, true), (25, 1e-12, false)] {
        let surface = Surface::from_soup("chain", &ricci::mesh::shapes::genus(genus, 1).unwrap());
        let q = surface.uniformized();
        let (deck, radius) = (&q.deck, q.layout.radius);
        println!("genus {genus}, radius {radius:.1}: side pairings within {:.1e}", deck.side_residual);
        // At a distance r the layout's numbers are e^r large, and their products lose e^{2r} of the 1e-32 of double-double precision.
        let rounding = 1e-13 + 1e-31 * (2.0 * radius).exp();
        assert!(radius > 16.0 && q.angle_defect < 1e-28 && q.layout.disagreement < rounding);
        assert!(deck.side_residual < residual && deck.relation_residual < 1e-8, "{:e}", deck.side_residual);
        assert!(deck.generators.iter().all(|g| f64::from(g.half_trace()).abs() > 1.0));
        let domain = dirichlet_domain(deck, [0.0, 0.0, 1.0], q.layout.area, &Control::new());
        match domain {
            Ok(domain) => assert!((domain.area / q.layout.area - 1.0).abs() < 1e-6),
            Err(error) => assert!(!area && error.to_string().contains("take another base vertex"), "{error}"),
        }
    }
}

#[test]
fn what_is_no_quotient_is_refused() {
    let run = |surface: &Surface, options: &QuotientOptions| {
        uniformize_quotient(&surface.given(), options, &Control::new())
    };
    let sphere = Surface::from_soup("sphere", &ricci::mesh::shapes::icosphere(2).unwrap());
    let disk = Surface::from_soup("disk", &ricci::mesh::shapes::disk(3).unwrap());
    for surface in [&sphere, &disk] {
        assert!(matches!(run(surface, &QuotientOptions::default()), Err(Error::Layout(_))));
    }
    let torus = Surface::from_soup("torus", &ricci::mesh::shapes::torus(2.0, 1.0, 6, 5).unwrap());
    let far = QuotientOptions { base: Some(VertexId(30)), ..QuotientOptions::default() };
    assert!(matches!(run(&torus, &far), Err(Error::Argument { .. })));
    let control = Control::new();
    control.cancel();
    let cancelled = uniformize_quotient(&torus.given(), &QuotientOptions::default(), &control);
    assert!(matches!(cancelled, Err(Error::Cancelled)));
}

/// The refined layout: input vertices are where the final triangulation has them, no piece is flipped, and pieces of a face that are joined
/// have the face's area.
#[test]
fn subdivisions_lie_in_the_layout() {
    for surface in generated().into_iter().chain(corpus()) {
        let q = surface.uniformized();
        let r = Arc::new(q.metric.common_subdivision(&Control::new()).unwrap());
        let refined = q.layout.on_subdivision(&r, q.metric.metric(), &Control::new()).unwrap();
        assert!(refined.flipped.is_empty(), "{}: {:?}", surface.name, refined.flipped);
        let quality = refined.quality(&surface.mesh, &surface.lengths);
        if surface.geometry == Space::E2 {
            let quality = quality.unwrap();
            assert!(
                quality.qc_mean >= 1.0 && quality.qc_mean < 12.0,
                "{}: {}",
                surface.name,
                quality.qc_mean
            );
        }
        let corners = |f: FaceId| refined.face_points(f);
        for f in r.mesh.faces() {
            let whole = q.layout.face_points(r.faces[1][f]);
            for (p, weights) in corners(f).into_iter().zip(r.barycentric(1, f)) {
                // On the line or in the plane of the three corners' cone: the combination, up to its length.
                let sum = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * whole[k][i]).sum::<f64>());
                let scale = sum[2] / p[2];
                let off = (0..2).map(|i| (sum[i] - scale * p[i]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-12 * sum[2].powi(2), "{}: {off:e}", surface.name);
            }
        }
    }
}

/// A surface with geodesic boundary is laid out from its double: the given half alone, every piece the right way round, closed where it is
/// not cut; and the boundary is straight: at each of its vertices the pieces' angles add up to π.
#[test]
fn the_given_half_of_a_double_is_laid_out() {
    let torus = ricci::mesh::shapes::torus(2.0, 0.8, 24, 14).unwrap();
    let surfaces = [
        Surface::from_soup("torus with 2 holes", &ricci::mesh::shapes::punch(&torus, 2).unwrap()),
        Surface::from_soup(
            "genus 2 with 3 holes",
            &ricci::mesh::shapes::punch(&ricci::mesh::shapes::genus(2, 3).unwrap(), 3).unwrap(),
        ),
    ];
    for surface in surfaces {
        let (Surface { name, mesh, .. }, control) = (&surface, Control::new());
        let class = Class::yamabe(Space::H2);
        let flat = flow(surface.given(), class, &Target::Uniform, &Options::default(), &control).unwrap();
        assert!(flat.converged() && flat.double().is_some(), "{name}");
        assert!(flat.report().unwrap().angle_defect.unwrap() < 1e-18, "{name}");
        let r = flat.common_subdivision(&control).unwrap();
        let (root, subdivision) = (Some(VertexId(0)), Some(Arc::new(r.clone())));
        let options = LayoutOptions { root, subdivision, ..LayoutOptions::default() };
        let layout = Layout::of_solution(&flat, &options, &control).unwrap();
        assert!((layout.area + 2.0 * PI * mesh.euler() as f64).abs() < 1e-9, "{name}: {}", layout.area);
        assert!(layout.on_input().unwrap().flipped.len() * 100 < mesh.n_faces(), "{name}");
        assert!(layout.flipped.is_empty() && layout.degenerate.is_empty(), "{name}");
        assert!(layout.disagreement < 1e-12, "{name}: {:e}", layout.disagreement);
        assert!(ricci::topology::cut::is_disk(&r.mesh, &layout.cut.is_cut), "{name}");
        // Half the double's area: that of a surface of this Euler characteristic.
        let area: f64 = r.mesh.faces().map(|f| hyperbolic_area(layout.face_points(f))).sum();
        let expected = -2.0 * PI * mesh.euler() as f64;
        assert!((area - expected).abs() < 1e-9, "{name}: {area} {expected}");
        let mut angle = PerVertex::filled(r.mesh.n_vertices(), 0.0);
        for f in r.mesh.faces() {
            let points = layout.face_points(f);
            for (k, v) in r.mesh.face_vertices(f).into_iter().enumerate() {
                angle[v] += hyperbolic_angle(points[k], points[(k + 1) % 3], points[(k + 2) % 3]);
            }
        }
        for v in r.mesh.vertices() {
            let whole = if r.mesh.is_boundary_vertex(v) { PI } else { 2.0 * PI };
            assert!((angle[v] - whole).abs() < 1e-7, "{name}: vertex {v}: {}", angle[v]);
        }
    }
}

/// tan(A/2) = det / (1 + Σ cosh).
fn hyperbolic_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    let cosh = |p: [f64; 3], q: [f64; 3]| p[2] * q[2] - p[0] * q[0] - p[1] * q[1];
    2.0 * (det / (1.0 + cosh(a, b) + cosh(b, c) + cosh(c, a))).atan()
}

/// The angle at a, between tangents `b − cosh(ab) a` and `c − cosh(ac) a`: cosine by their product, sine by the determinant.
fn hyperbolic_angle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] - p[2] * q[2];
    let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    det.atan2(dot(b, c) + dot(a, b) * dot(a, c))
}

//! Checks that every common subdivision and its layout have to pass.

use crate::common::Random;
use crate::common_subdivision::flown::Flown;
use ricci::embed::{Layout, LayoutOptions, LayoutScale};
use ricci::flow::{self, Options};
use ricci::geometry::Space;
use ricci::mesh::{FaceId, Mesh, PerEdge, Point};
use ricci::metric::{CommonSubdivision, curvature};
use ricci::{Class, Control, Surface, Target};
use std::sync::Arc;

#[derive(Default, Debug)]
pub struct Worst {
    pub area: f64,
    pub position: f64,
    pub projective: f64,
}

/// Checks a common subdivision of `input` (the half, for a double).
pub fn check(r: &CommonSubdivision, input: &Mesh, flown: &Flown, positions: &[Point], what: &str) -> Worst {
    let mut worst = Worst::default();
    r.mesh.validate().unwrap();
    assert_eq!(r.mesh.euler(), input.euler(), "{what}");
    assert_eq!(r.mesh.boundary_loops().len(), input.boundary_loops().len(), "{what}");
    assert_eq!(r.n_vertices[0], input.n_vertices(), "{what}");
    assert!(r.weight.iter().all(|&q| q > 0.0 && q.is_finite()));

    // Areas of the pieces add up to the faces'.
    let mut input_area = vec![0.0; input.n_faces()];
    let mut final_area = vec![0.0; flown.mesh.n_faces()];
    for f in r.mesh.faces() {
        for (corners, sum) in [
            (r.barycentric(0, f), &mut input_area[r.faces[0][f].index()]),
            (r.barycentric(1, f), &mut final_area[r.faces[1][f].index()]),
        ] {
            let area = determinant(corners);
            assert!(area > -1e-12, "{what}: {area}");
            assert!(corners.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
            *sum += area;
        }
    }
    let closed = input.is_closed();
    for area in input_area.iter().chain(final_area.iter().filter(|_| closed)) {
        worst.area = worst.area.max((area - 1.0).abs());
    }

    // The crossings of an edge follow each other, and cut it into one more part than they are.
    let mut parts = vec![0; input.n_edges()];
    r.mesh.edges().filter_map(|e| r.edge(0, e)).for_each(|e| parts[e.index()] += 1);
    let mut crossings = vec![Vec::new(); input.n_edges()];
    r.crossings.iter().for_each(|c| crossings[c[0].edge.index()].push(c[0].weights[1]));
    for (parts, crossings) in parts.iter().zip(&crossings) {
        assert_eq!(*parts, crossings.len() + 1, "{what}");
        assert!(crossings.is_sorted(), "{what}: {crossings:?}");
    }

    // Positions: every corner of every piece, seen from its own face of the input, is where its vertex is.
    let at = r.from_vertices(0, positions).unwrap();
    let extent = positions.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for f in r.mesh.faces() {
        let corners = input.face_vertices(r.faces[0][f]).map(|v| positions[v.index()]);
        for (b, v) in r.barycentric(0, f).into_iter().zip(r.mesh.face_vertices(f)) {
            for i in 0..3 {
                let x: f64 = (0..3).map(|k| b[k] * corners[k][i]).sum();
                worst.position = worst.position.max((x - at[v.index()][i]).abs() / extent);
            }
        }
    }
    // There and back again.
    let (forward, backward) = (r.forward(), r.backward());
    let mut random = Random::new(1);
    for _ in 0..200 {
        let face = FaceId::from(random.below(input.n_faces()));
        let (x, y) = (random.unit(), random.unit());
        let b = if x + y > 1.0 { [1.0 - x, 1.0 - y, x + y - 1.0] } else { [x, y, 1.0 - x - y] };
        let (there, image) = forward.image(face, b).unwrap();
        let (back, again) = backward.image(there, image).unwrap();
        let place = |f, b: [f64; 3]| {
            let corners = input.face_vertices(f).map(|v| positions[v.index()]);
            [0, 1, 2].map(|i| (0..3).map(|k| b[k] * corners[k][i]).sum::<f64>())
        };
        let (p, q) = (place(face, b), place(back, again));
        let off = (0..3).fold(0.0f64, |m, i| m.max((p[i] - q[i]).abs()));
        worst.position = worst.position.max(off / extent);
    }

    // One projective map per piece: q · (final weights) is linear in the input weights.
    let faces: Vec<_> = r.mesh.faces().collect();
    for piece in faces.chunk_by(|&f, &g| r.polygon_of[f] == r.polygon_of[g]) {
        let corners: Vec<_> = piece
            .iter()
            .flat_map(|&f| {
                let (a, b, q) = (r.barycentric(0, f), r.barycentric(1, f), r.weights(f));
                (0..3).map(move |k| (a[k], b[k].map(|x| q[k] * x)))
            })
            .collect();
        for other in corners.iter().skip(3) {
            // other = Σ t_k corner_k, in both.
            let base = [corners[0].0, corners[1].0, corners[2].0];
            let total = determinant(base);
            if total < 1e-6 {
                continue;
            }
            let t = [0, 1, 2].map(|k| {
                let mut with = base;
                with[k] = other.0;
                determinant(with) / total
            });
            let size = other.1.iter().fold(0.0f64, |m, x| m.max(*x));
            for i in 0..3 {
                let terms = [0, 1, 2].map(|k| t[k] * corners[k].1[i]);
                let scale = terms.iter().fold(size, |m, x| m.max(x.abs()));
                worst.projective =
                    worst.projective.max((terms.iter().sum::<f64>() - other.1[i]).abs() / scale);
            }
        }
    }
    worst
}

/// Everything that holds of the layout of a flow's result on the subdivision.
pub fn check_layout(surface: &Surface, class: Class, target: &Target, what: &str) {
    let control = Control::new();
    let solution = flow::flow(surface.clone(), class, target, &Options::default(), &control).unwrap();
    let r = &Arc::new(solution.common_subdivision(&control).unwrap());
    let (subdivision, scale) = (Some(r.clone()), LayoutScale::AsSolved);
    let options = LayoutOptions { subdivision, scale, ..LayoutOptions::default() };
    let laid = Layout::of_solution(&solution, &options, &control).unwrap();
    let (input, lengths): (&Mesh, &PerEdge<f64>) = (surface.mesh(), surface.lengths());
    let quality = laid.quality(input, lengths).unwrap();
    println!(
        "    consistency {:.0e}, {:.0e} of a face; of {} triangles {} flipped, {} degenerate; qc mean {:.2}, max {:.0e}",
        laid.consistency(),
        laid.local_consistency,
        r.mesh.n_faces(),
        laid.flipped.len(),
        laid.degenerate.len(),
        quality.qc_mean,
        quality.qc_max
    );
    assert!(laid.consistency() < 1e-10, "{what}");
    // Pieces of faces so small, compared with their coordinates, that f64 loses their shape are not checked.
    if laid.local_consistency < 1e-6 {
        assert!(laid.flipped.is_empty() && laid.degenerate.is_empty(), "{what}");
    }
    // The isometry that glues two sides of a seam carries one onto the other.
    assert!(laid.seams.iter().all(|seam| seam.residual < 1e-10), "{what}");
    seams_run_along_input_edges(r, input, &laid, what);
    if input.is_closed() {
        let lengths = solution.metric().lengths(solution.mesh()).unwrap();
        let area = curvature(solution.mesh(), Space::E2, &lengths).unwrap().area;
        assert!((laid.area / area - 1.0).abs() < 1e-10, "{what}");
        let mut scaled = laid.clone();
        scaled.scale_to_area(2.0).unwrap();
        let sum: f64 = r.mesh.faces().map(|f| plane_area(scaled.face_uv(f))).sum();
        assert!((sum - 2.0).abs() < 1e-9, "{what}: {sum}");
    }
    assert!(laid.broken.is_empty(), "{what}");
}

/// The cut is one of the input, and the input's own corners lie where the pieces have them.
fn seams_run_along_input_edges(r: &CommonSubdivision, input: &Mesh, laid: &Layout, what: &str) {
    let on_input = laid.on_input().unwrap();
    for e in r.mesh.edges().filter(|&e| laid.cut.is_cut[e]) {
        assert!(r.edge(0, e).is_some_and(|e| on_input.cut.is_cut[e]), "{what}: edge {e}");
    }
    assert_eq!(laid.cut.segments.len(), on_input.cut.segments.len(), "{what}");
    let corners = laid.corner_uv().unwrap();
    assert_eq!(corners.len(), input.n_faces());
    for f in r.mesh.faces() {
        for (uv, weights) in laid.face_uv(f).into_iter().zip(r.barycentric(0, f)) {
            if let Some(corner) = weights.iter().position(|&w| w == 1.0) {
                assert_eq!(corners[r.faces[0][f].index()][corner], uv, "{what}: face {f}");
            }
        }
    }
    // The ends of an edge that is not cut have the same coordinates in both faces.
    let index = |h| on_input.corner_index[h];
    for e in input.edges().filter(|&e| !input.is_boundary_edge(e)) {
        let (h, t) = (e.halfedge(), e.halfedge().twin());
        let joined = index(h) == index(input.next(t)) && index(input.next(h)) == index(t);
        assert!(joined || on_input.cut.is_cut[e], "{what}: edge {e}");
    }
}

fn plane_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

pub fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

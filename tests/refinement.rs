//! The way back from the final triangulation to the input's: the common refinement.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Random;
use ricci::Control;
use ricci::embed::{layout_refined, refined_cut};
use ricci::flow::{Flips, Options, Solver};
use ricci::geometry::Space;
use ricci::mesh::{Double, EdgeId, Mesh, NormalCoordinates, PerEdge, PerVertex, Point, VertexId, io, shapes};
use ricci::metric::delaunay::{Queue, failing, restore_delaunay};
use ricci::metric::refinement::{Final, Input};
use ricci::metric::{
    Metric, Refinement, Scheme, Target, delaunay_start, initial_metric, lengths_from_positions,
};
use std::f64::consts::PI;

const SCHEMES: [Scheme; 2] = [Scheme::Yamabe, Scheme::Inversive];
/// Largest mesh that the optimised tests of a debug build take.
const MOST_VERTICES: usize = 3000;

/// A flow from a surface to its target, flips recorded.
struct Flown {
    mesh: Mesh,
    metric: Metric,
    input_u: PerVertex<f64>,
    normal: NormalCoordinates,
    flips: usize,
}

/// The start's flips, then those inside the class on a straight way to the solution: the triangulation that the solver ends with.
fn flow(
    input: &Mesh,
    lengths: &PerEdge<f64>,
    (space, scheme): (Space, Scheme),
    target: &PerVertex<f64>,
    double: Option<&Double>,
) -> Option<Flown> {
    let (mut mesh, mut lengths) = (input.clone(), lengths.clone());
    let mut normal = NormalCoordinates::new(&mesh);
    let mut flips = 0;
    let mut record = |mesh: &Mesh, e: EdgeId| {
        flips += 1;
        normal.record(mesh, e);
    };
    let start =
        delaunay_start(&mut mesh, &mut lengths, Space::E2, scheme, space, double, &mut record).unwrap();
    let mut metric = start.metric;
    let options = Options { flips: Flips::Auto, ..Options::default() };
    let mut solver = Solver::new(mesh.clone(), metric.clone(), options).unwrap();
    let report = solver.solve(target, &Control::new()).unwrap();
    if !report.converged {
        return None;
    }
    let (from, to) = (metric.u.clone(), &solver.metric().u);
    for step in 1..=20 {
        let s = f64::from(step) / 20.0;
        let u = PerVertex::from_fn(from.len(), |v: VertexId| (1.0 - s) * from[v] + s * to[v]);
        let mut queue = Queue::new(mesh.n_edges());
        failing(&mesh, &metric, &u).into_iter().for_each(|e| queue.push(e));
        restore_delaunay(&mut mesh, &mut metric, &u, &mut queue, &mut record).unwrap();
        metric.u = u;
    }
    Some(Flown { mesh, metric, input_u: start.input_u, normal, flips })
}

impl Flown {
    fn refine(&self, input: &Mesh, double: Option<&Double>) -> Refinement {
        let keep = |f| double.is_none_or(|double| double.is_original(f));
        let given = Input { mesh: input, geometry: Space::E2, u: &self.input_u };
        let result = Final { mesh: &self.mesh, metric: &self.metric, normal: &self.normal };
        Refinement::new(given, result, &keep, &Control::new()).unwrap()
    }
}

#[derive(Default, Debug)]
struct Worst {
    area: f64,
    position: f64,
    projective: f64,
}

/// Everything that holds of every refinement of `input` (the half, for a double).
fn check(r: &Refinement, input: &Mesh, flown: &Flown, positions: &[Point], what: &str) -> Worst {
    let mut worst = Worst::default();
    r.mesh.validate().unwrap();
    assert_eq!(r.mesh.euler(), input.euler(), "{what}");
    assert_eq!(r.mesh.boundary_loops().len(), input.boundary_loops().len(), "{what}");
    assert_eq!(r.n_input_vertices, input.n_vertices(), "{what}");
    assert!(r.weight.iter().all(|&q| q > 0.0 && q.is_finite()));

    // Areas of the pieces add up to the faces'.
    let mut input_area = vec![0.0; input.n_faces()];
    let mut final_area = vec![0.0; flown.mesh.n_faces()];
    for f in r.mesh.faces() {
        for (corners, sum) in [
            (r.input_barycentric(f), &mut input_area[r.input_face[f].index()]),
            (r.final_barycentric(f), &mut final_area[r.final_face[f].index()]),
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

    // Edges of both triangulations are cut into parts that follow each other.
    let mut parts = vec![0.0; input.n_edges()];
    for e in r.mesh.edges() {
        if let Some(edge) = r.origin[e].input {
            let [a, b] = r.mesh.ends(e).map(|v| match r.crossing(v) {
                Some(c) => c.input_weights[1],
                None => f64::NAN,
            });
            let whole = flown.normal.along(&flown.mesh, edge.halfedge()).is_some();
            let _ = (a, b, whole);
            parts[edge.index()] += 1.0;
        }
    }
    assert!(parts.iter().all(|&n| n >= 1.0), "{what}");

    // Positions: every corner of every piece, seen from its own face of the input, is where its vertex is.
    let at = r.from_input_vertices(positions).unwrap();
    let extent = positions.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for f in r.mesh.faces() {
        let corners = input.face_vertices(r.input_face[f]).map(|v| positions[v.index()]);
        for (b, v) in r.input_barycentric(f).into_iter().zip(r.mesh.face_vertices(f)) {
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
        let face = ricci::mesh::FaceId::from(random.below(input.n_faces()));
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
    for piece in faces.chunk_by(|&f, &g| r.piece[f] == r.piece[g]) {
        let corners: Vec<_> = piece
            .iter()
            .flat_map(|&f| {
                let (a, b, q) = (r.input_barycentric(f), r.final_barycentric(f), r.weights(f));
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

fn check_layout(
    r: &Refinement,
    input: &Mesh,
    lengths: &PerEdge<f64>,
    flown: &Flown,
    target: &PerVertex<f64>,
    what: &str,
) {
    let cones: Vec<_> =
        input.vertices().filter(|&v| !input.is_boundary_vertex(v) && target[v].abs() > 1e-12).collect();
    let cut = refined_cut(r, &flown.mesh, &flown.metric, &cones).unwrap();
    let laid = layout_refined(r, &flown.mesh, &flown.metric, &cut, &Control::new()).unwrap();
    let quality = laid.quality(r, input, lengths).unwrap();
    println!(
        "    consistency {:.1e} {:.1e}, flipped {}, degenerate {} of {}, qc {:.3} {:.1e}, degenerate {}",
        laid.layout.consistency,
        laid.layout.local_consistency,
        laid.layout.flipped.len(),
        laid.degenerate.len(),
        r.mesh.n_faces(),
        quality.qc_mean,
        quality.qc_max,
        quality.degenerate.len()
    );
    assert!(laid.layout.broken.is_empty(), "{what}");
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Uniform, or four cones of π on a sphere.
fn default_target(mesh: &Mesh, lengths: &PerEdge<f64>, space: Space, scheme: Scheme) -> PerVertex<f64> {
    if space == Space::E2 && mesh.genus() == 0 {
        let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
        let step = mesh.n_vertices() / 4;
        (0..4).for_each(|k| target[(k * step).into()] = PI);
        return target;
    }
    Target::Uniform.resolve(mesh, lengths, space, scheme).unwrap()
}

fn corpus() -> Vec<(String, Mesh, PerEdge<f64>, Vec<Point>)> {
    let Some((folder, rows)) = common::index("good") else { return Vec::new() };
    let mut all = Vec::new();
    for row in &rows {
        if row["V"].parse::<usize>().unwrap() <= MOST_VERTICES {
            let soup = io::read(&folder.join(&row["file"])).unwrap();
            let mesh = Mesh::from_soup(&soup).unwrap();
            let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
            all.push((row["file"].clone(), mesh, lengths, soup.positions));
        }
    }
    all
}

#[test]
fn every_closed_mesh_is_refined_with_its_flat_and_hyperbolic_metrics() {
    for (name, mesh, lengths, positions) in corpus().into_iter().filter(|(_, mesh, ..)| mesh.is_closed()) {
        let kinds = SCHEMES.map(|scheme| (Space::E2, scheme));
        let curved = (mesh.genus() >= 2).then_some((Space::H2, Scheme::Yamabe));
        for (space, scheme) in kinds.into_iter().chain(curved) {
            let target = default_target(&mesh, &lengths, space, scheme);
            let what = format!("{name} {space} {scheme}");
            let Some(flown) = flow(&mesh, &lengths, (space, scheme), &target, None) else {
                panic!("{what} does not converge")
            };
            let time = std::time::Instant::now();
            let r = flown.refine(&mesh, None);
            let seconds = time.elapsed().as_secs_f64();
            let worst = check(&r, &mesh, &flown, &positions, &what);
            println!(
                "{what}: {} flips, V {} → {}, {seconds:.3} s, {worst:?}",
                flown.flips,
                mesh.n_vertices(),
                r.mesh.n_vertices()
            );
            if space == Space::E2 {
                check_layout(&r, &mesh, &lengths, &flown, &target, &what);
            }
        }
    }
}

#[test]
fn every_open_mesh_is_refined_in_its_half_of_the_double() {
    for (name, half, lengths, positions) in corpus().into_iter().filter(|(_, mesh, ..)| !mesh.is_closed()) {
        let double = Double::new(&half).unwrap();
        let lengths_of_double: PerEdge<f64> = double.spread_edges(&lengths).into();
        for scheme in SCHEMES {
            let Ok(target) = Target::Boundary.resolve(&half, &lengths, Space::E2, scheme) else { continue };
            let target: PerVertex<f64> = double.target(&target).into();
            let kind = (Space::E2, scheme);
            let Some(flown) = flow(&double.mesh, &lengths_of_double, kind, &target, Some(&double)) else {
                println!("{name} {scheme} does not converge");
                continue;
            };
            let r = flown.refine(&double.mesh, Some(&double));
            let worst = check(&r, &half, &flown, &positions, &name);
            println!(
                "{name} {scheme}: {} flips, V {} → {}, {worst:?}",
                flown.flips,
                half.n_vertices(),
                r.mesh.n_vertices()
            );
            check_layout(&r, &half, &lengths, &flown, &target, &name);
        }
    }
}

#[test]
fn without_flips_the_refinement_is_the_input() {
    let soup = shapes::genus(2, 3).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let initial = initial_metric(&mesh, &lengths, Space::E2, Scheme::Inversive, Space::E2).unwrap();
    let normal = NormalCoordinates::new(&mesh);
    let mut metric = initial.metric;
    metric.u.iter_mut().for_each(|u| *u += 0.5);
    let given = Input { mesh: &mesh, geometry: Space::E2, u: &initial.input_u };
    let r = Refinement::new(
        given,
        Final { mesh: &mesh, metric: &metric, normal: &normal },
        &|_| true,
        &Control::new(),
    )
    .unwrap();
    assert_eq!(r.mesh.n_vertices(), mesh.n_vertices());
    for f in r.mesh.faces() {
        assert_eq!(r.mesh.face_vertices(f), mesh.face_vertices(f));
        assert!(r.input_face[f] == f && r.final_face[f] == f);
    }
    assert!(r.weight.iter().all(|q| (q * 0.5f64.exp() - 1.0).abs() < 1e-14));
}

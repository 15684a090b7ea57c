//! Closed surfaces of genus 0 on the unit sphere.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Random;
use common::flips::{measure, shuffle};
use ricci::canonical::{Sphere, SphereOptions, uniformize_sphere};
use ricci::geometry::Space;
use ricci::geometry::vector::{add, cross, dot, norm, scale, sub};
use ricci::mesh::shapes::{self, Intrinsic};
use ricci::mesh::{Mesh, PerEdge, Point, VertexId, io};
use ricci::metric::lengths_from_positions;
use ricci::{Control, Error, Result};
use std::sync::Arc;

/// Largest mesh of the corpus that the optimised tests of a debug build take: all but one.
const MOST_VERTICES: usize = 30_000;

fn run(mesh: &Mesh, lengths: &PerEdge<f64>, options: &SphereOptions) -> Result<Sphere> {
    let (mesh, lengths) = (Arc::new(mesh.clone()), Arc::new(lengths.clone()));
    uniformize_sphere(mesh, lengths, Space::E2, options, &Control::new())
}

fn surface(soup: &io::Soup) -> (Mesh, PerEdge<f64>) {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    (mesh, lengths)
}

fn on_sphere(soup: &io::Soup) -> Sphere {
    let (mesh, lengths) = surface(soup);
    run(&mesh, &lengths, &SphereOptions::default()).unwrap()
}

/// A third of the area of the faces at each vertex, by Heron's formula.
fn areas(mesh: &Mesh, lengths: &PerEdge<f64>) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.n_vertices()];
    for f in mesh.faces() {
        let mut l = mesh.opposite_edges(f).map(|e| lengths[e]);
        l.sort_by(|a, b| b.total_cmp(a));
        let [a, b, c] = l;
        let square = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
        mesh.face_vertices(f).iter().for_each(|v| areas[v.index()] += 0.25 * square.max(0.0).sqrt() / 3.0);
    }
    areas
}

/// Signed distance of each vertex over the planes of the faces next to its own, at most.
fn nonconvexity(mesh: &Mesh, x: &[Point]) -> f64 {
    let mut worst = f64::NEG_INFINITY;
    for h in mesh.halfedges() {
        let [a, b, c] = [h, mesh.next(h), mesh.prev(h)].map(|h| x[mesh.origin(h).index()]);
        let top = x[mesh.origin(mesh.prev(h.twin())).index()];
        let normal = cross(sub(b, a), sub(c, a));
        worst = worst.max(dot(normal, sub(top, a)) / (norm(normal) + 1e-300));
    }
    worst
}

/// Everything that holds of every result, computed again.
fn check(sphere: &Sphere, given: &Mesh, lengths: &PerEdge<f64>, what: &str) {
    let (report, x) = (&sphere.report, &sphere.positions);
    assert!(report.converged && report.max_curvature_error <= 1e-10, "{what}: {report:?}");
    assert!(report.delaunay_violation <= 1e-9 && report.link_turning >= -1e-12, "{what}: {report:?}");
    let mesh = sphere.metric.mesh();
    mesh.validate().unwrap();
    assert_eq!((mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()), {
        (given.n_vertices(), given.n_edges(), given.n_faces())
    });

    // The sphere's metric: K = 0 everywhere, and chords where the positions have digits.
    let metric = sphere.metric.metric();
    assert_eq!(metric.space, Space::S2);
    let curvature = metric.curvature(mesh).unwrap();
    assert!(curvature.broken.is_empty() && curvature.gauss_bonnet < 1e-11, "{what}");
    assert!(curvature.at.iter().all(|k| k.abs() <= 1e-10), "{what}: {report:?}");
    let on_sphere = metric.lengths(mesh).unwrap();
    for e in mesh.edges() {
        let [a, b] = mesh.ends(e).map(|v| x[v]);
        let off = (2.0 * (0.5 * on_sphere[e]).sin() - norm(sub(a, b))).abs();
        assert!(off < 1e-11, "{what}: edge {e}: {off:e}");
    }
    assert_eq!(on_sphere.iter().copied().fold(f64::INFINITY, f64::min), report.smallest_edge);

    assert!(x.iter().all(|x| (norm(*x) - 1.0).abs() < 1e-15), "{what}");
    let worst = nonconvexity(mesh, x);
    assert!(report.u_range >= 30.0 || worst <= 1e-12, "{what}: {worst:e} at range {}", report.u_range);
    let w = areas(given, lengths);
    let mean = x.iter().zip(&w).fold([0.0; 3], |sum, (x, w)| add(sum, scale(*w, *x)));
    assert!(norm(mean) <= 1e-12 * w.iter().sum::<f64>(), "{what}: {:e}", norm(mean));
    // Outward, where a face has an area in doubles.
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| x[v]);
        let normal = cross(sub(b, a), sub(c, a));
        let size = [sub(a, b), sub(b, c), sub(c, a)].map(norm).into_iter().fold(0.0, f64::max);
        assert!(size < 1e-6 || dot(normal, a) > -1e-15 * size, "{what}: face {f}");
    }
}

/// Two maps to the sphere differ by a Möbius transformation: cross-ratios of chords agree.
fn same_up_to_moebius(a: &[Point], b: &[Point], tolerance: f64, what: &str) {
    let mut random = Random::new(5);
    let ratio = |x: &[Point], [i, j, k, l]: [usize; 4]| {
        let chord = |i: usize, j: usize| norm(sub(x[i], x[j]));
        chord(i, j) * chord(k, l) / (chord(i, k) * chord(j, l))
    };
    let mut compared = 0;
    for _ in 0..2000 {
        let four = [(); 4].map(|()| random.below(a.len()));
        let distinct = (0..4).all(|i| (0..i).all(|j| four[i] != four[j]));
        if distinct {
            let (p, q) = (ratio(a, four), ratio(b, four));
            assert!((p / q - 1.0).abs() < tolerance, "{what}: {p} {q}");
            compared += 1;
        }
    }
    assert!(compared > 100);
}

fn finger() -> io::Soup {
    // A sphere with a finger three radii long.
    let mut soup = shapes::icosphere(12).unwrap();
    for x in &mut soup.positions {
        let along = ((x[2] - 0.8) / 0.2).max(0.0);
        *x = add(*x, [0.0, 0.0, 3.0 * along]);
    }
    soup
}

fn rough(seed: u64, height: f64) -> io::Soup {
    let mut random = Random::new(seed);
    let mut soup = shapes::icosphere(7).unwrap();
    for x in &mut soup.positions {
        *x = scale(1.0 + height * random.symmetric(), *x);
    }
    soup
}

#[test]
fn generated_shapes_become_convex_spheres() {
    let shapes = [
        ("icosahedron", shapes::icosphere(1).unwrap()),
        ("icosphere", shapes::icosphere(9).unwrap()),
        ("ellipsoid", shapes::ellipsoid([3.0, 1.0, 0.4], 10).unwrap()),
        ("needle", shapes::ellipsoid([1.0, 1.0, 12.0], 10).unwrap()),
        ("coin", shapes::ellipsoid([1.0, 1.0, 0.01], 10).unwrap()),
        ("finger", finger()),
        ("rough", rough(1, 0.3)),
        ("rougher", rough(2, 0.8)),
        ("spikes", rough(3, 0.95)),
    ];
    for (name, soup) in &shapes {
        let (mesh, lengths) = surface(soup);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, name);
    }
}

#[test]
fn every_sphere_of_the_corpus_uniformizes() {
    let Some((folder, rows)) = common::index("good") else { return };
    let mut n = 0;
    for row in rows.iter().filter(|row| row["genus"] == "0" && row["boundary_loops"] == "0") {
        n += 1;
        if row["V"].parse::<usize>().unwrap() > MOST_VERTICES {
            continue;
        }
        let (mesh, lengths) = surface(&io::read(&folder.join(&row["file"])).unwrap());
        let clock = std::time::Instant::now();
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        let r = &sphere.report;
        println!(
            "{:32} range {:5.2}, {:2} steps, {:5} + {:5} flips, nonconvexity {:8.1e}, shortest edge {:7.1e}, {:.2} s",
            row["name"],
            r.u_range,
            r.iterations,
            r.start_flips,
            r.flips,
            r.nonconvexity,
            r.smallest_edge,
            clock.elapsed().as_secs_f64()
        );
        check(&sphere, &mesh, &lengths, &row["name"]);
    }
    assert_eq!(n, 29);
}

#[test]
fn the_round_sphere_comes_back_up_to_a_rotation() {
    for n in [1, 2, 5, 12] {
        let soup = shapes::icosphere(n).unwrap();
        let sphere = on_sphere(&soup);
        let (x, y) = (&soup.positions, &sphere.positions);
        let far = [0, 1, x.len() - 1];
        for (i, p) in x.iter().enumerate() {
            for &j in &far {
                let off = (dot(*p, x[j]) - dot(y[i.into()], y[j.into()])).abs();
                assert!(off < 1e-13, "{n}: {off:e}");
            }
        }
        // Not its mirror image either.
        let volume = |[a, b, c]: [Point; 3]| dot(a, cross(b, c));
        let three = [0, 1, 2];
        let (before, after) = (volume(three.map(|i| x[i])), volume(three.map(|i| y[i.into()])));
        assert!((before - after).abs() < 1e-13);
    }
}

/// Latitude θ on the sphere of reduced latitude β on the spheroid with half axes 1, 1, c: the isometric latitudes
/// `artanh sin θ = artanh sin β + ∫₀^β (√(sin² + c² cos²) − 1)/cos dβ` agree.
fn spheroid_latitude(c: f64, beta: f64) -> f64 {
    let f = |t: f64| {
        let (sin, cos) = t.sin_cos();
        (c * c - 1.0) * cos / ((sin * sin + c * c * cos * cos).sqrt() + 1.0)
    };
    let (n, mut sum) = (2000, 0.0);
    let h = beta / f64::from(n);
    for k in 0..n {
        let t = f64::from(k) * h;
        sum += h / 6.0 * (f(t) + 4.0 * f(t + 0.5 * h) + f(t + h));
    }
    (beta.sin().atanh() + sum).tanh().asin()
}

/// Largest distance of the result from the analytic map, after the rotation that fits best.
fn spheroid_error(c: f64, n: usize) -> f64 {
    let round = shapes::icosphere(n).unwrap();
    let sphere = on_sphere(&shapes::ellipsoid([1.0, 1.0, c], n).unwrap());
    let exact: Vec<Point> = round
        .positions
        .iter()
        .map(|x| {
            let theta = spheroid_latitude(c, x[2].clamp(-1.0, 1.0).asin());
            let r = x[0].hypot(x[1]);
            let [cos, sin] = if r > 0.0 { [x[0] / r, x[1] / r] } else { [1.0, 0.0] };
            [theta.cos() * cos, theta.cos() * sin, theta.sin()]
        })
        .collect();
    // Σ exactᵀ x is the rotation times a symmetric matrix: its polar factor, by Newton's iteration R ← (R + R⁻ᵀ)/2.
    let mut m = [[0.0; 3]; 3];
    for (p, x) in exact.iter().zip(sphere.positions.iter()) {
        (0..3).for_each(|i| (0..3).for_each(|j| m[i][j] += x[i] * p[j]));
    }
    for _ in 0..60 {
        let cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
        let det = dot(m[0], cofactors[0]);
        (0..3).for_each(|i| m[i] = scale(0.5, add(m[i], scale(1.0 / det, cofactors[i]))));
    }
    let distance = |(p, x): (&Point, &Point)| norm(sub(m.map(|row| dot(row, *p)), *x));
    exact.iter().zip(sphere.positions.iter()).map(distance).fold(0.0, f64::max)
}

#[test]
fn spheroids_converge_to_the_analytic_map_with_the_square_of_the_edge_length() {
    for c in [0.5, 2.0, 3.0] {
        let errors = [6, 12, 24].map(|n| spheroid_error(c, n));
        println!("half axis {c}: {errors:?}");
        assert!(errors[0] < 0.1 && errors[2] < 4e-3, "{c}: {errors:?}");
        assert!(errors[0] / errors[1] > 3.0 && errors[1] / errors[2] > 3.3, "{c}: {errors:?}");
    }
}

#[test]
fn any_puncture_leads_to_the_same_sphere() {
    let (mesh, lengths) = surface(&rough(4, 0.4));
    let first = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    for v in [0, 100, 300, 491] {
        let options = SphereOptions { puncture: Some(VertexId(v)), ..SphereOptions::default() };
        let other = run(&mesh, &lengths, &options).unwrap();
        check(&other, &mesh, &lengths, "other puncture");
        assert_eq!(other.report.puncture, VertexId(v));
        assert_eq!(other.positions[VertexId(v)], [0.0, 0.0, -1.0]);
        for i in 0..mesh.n_vertices() {
            for j in [0, 17, 200] {
                let dots = [&first, &other].map(|s| dot(s.positions[i.into()], s.positions[j.into()]));
                assert!((dots[0] - dots[1]).abs() < 1e-11, "{v}: {i} {j} {dots:?}");
            }
        }
    }
}

#[test]
fn the_sphere_depends_on_the_surface_not_on_its_triangulation() {
    let (mesh, lengths) = surface(&rough(6, 0.3));
    let first = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    let mut random = Random::new(11);
    for _ in 0..3 {
        let (mut mesh, mut lengths) = (mesh.clone(), lengths.clone());
        // Edges become loops and double edges on the way.
        assert!(shuffle(&mut mesh, &mut lengths, 4000, &mut random) > 500);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, "shuffled");
        same_up_to_moebius(&first.positions, &sphere.positions, 1e-9, "shuffled");
    }
}

#[test]
fn a_polyhedron_in_the_sphere_is_its_own_image() {
    let first = on_sphere(&rough(8, 0.5));
    let mesh = Mesh::clone(first.metric.mesh());
    let lengths = lengths_from_positions(&mesh, &first.positions).unwrap();
    let again = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&again, &mesh, &lengths, "again");
    same_up_to_moebius(&first.positions, &again.positions, 1e-9, "again");
    let triangles = |mesh: &Mesh| {
        let smallest_first = |t: [VertexId; 3]| (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]).min();
        let mut all: Vec<_> = mesh.faces().map(|f| smallest_first(mesh.face_vertices(f))).collect();
        all.sort();
        all
    };
    assert_eq!(triangles(again.metric.mesh()), triangles(&mesh));
}

#[test]
fn four_vertices_are_enough() {
    // A tetrahedron's three opposite products of lengths are, up to a factor, those of its image: the class is all there is.
    let points = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 0.9, 0.0], [0.3, 0.3, 1.7]];
    let mesh = Mesh::from_faces(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    let lengths = lengths_from_positions(&mesh, &points).unwrap();
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&sphere, &mesh, &lengths, "tetrahedron");
    assert!(sphere.metric.is_unflipped());
    same_up_to_moebius(&points, &sphere.positions, 1e-12, "tetrahedron");

    let corners: Vec<Point> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .flat_map(|x| [x, scale(-1.0, x)])
        .collect();
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let mesh = Mesh::from_faces(6, &faces).unwrap();
    let lengths = lengths_from_positions(&mesh, &corners).unwrap();
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&sphere, &mesh, &lengths, "octahedron");
    for i in 0..6 {
        for j in 0..6 {
            let off =
                dot(corners[i], corners[j]) - dot(sphere.positions[i.into()], sphere.positions[j.into()]);
            assert!(off.abs() < 1e-14);
        }
    }
}

#[test]
fn a_cube_with_and_without_noise() {
    // Squares of four points on a circle: ties of the Delaunay condition, and outlines that turn by nothing.
    let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 1.0 } else { -1.0 });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = squares.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::from_faces(8, &faces).unwrap();
    let mut random = Random::new(2);
    for noise in [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3] {
        let points: Vec<Point> =
            (0..8).map(|k| corner(k).map(|x: f64| x + noise * random.symmetric())).collect();
        let lengths = lengths_from_positions(&mesh, &points).unwrap();
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, &format!("cube, noise {noise:e}"));
        let tolerance = 1e-13 + 20.0 * noise;
        same_up_to_moebius(&points, &sphere.positions, tolerance, "cube");
    }
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let (mesh, lengths) = surface(&rough(9, 0.6));
    let spheres = [1, 2, 3]
        .map(|threads| run(&mesh, &lengths, &SphereOptions { threads, ..SphereOptions::default() }).unwrap());
    for other in &spheres[1..] {
        assert_eq!(other.positions, spheres[0].positions);
        assert_eq!(other.report, spheres[0].report);
        assert_eq!(other.metric.metric(), spheres[0].metric.metric());
        assert_eq!(other.metric.mesh(), spheres[0].metric.mesh());
    }
}

#[test]
fn the_way_back_is_a_refinement_of_the_given_faces() {
    let (mesh, lengths) = surface(&rough(2, 0.8));
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    assert!(sphere.report.flips > 0 && sphere.report.start_flips > 0, "{:?}", sphere.report);
    assert_eq!(sphere.metric.flips(), sphere.report.flips + sphere.report.start_flips);
    let refinement = sphere.metric.refinement(&Control::new()).unwrap();
    refinement.mesh.validate().unwrap();
    assert_eq!(refinement.mesh.euler(), 2);
    assert_eq!(refinement.n_input_vertices, mesh.n_vertices());
    for crossing in &refinement.crossings {
        assert!(crossing.final_weights.iter().all(|w| *w > 0.0 && *w < 1.0));
    }
    // The metric it is made of is flat in the plane too: the same class.
    let mut plane = sphere.metric.metric().clone();
    plane.space = Space::E2;
    for v in mesh.vertices().filter(|&v| v != sphere.report.puncture) {
        let [x, y] = sphere.plane[v];
        plane.u[v] += (1.0 + x * x + y * y).ln();
    }
    let link: Vec<VertexId> = {
        let mesh = sphere.metric.mesh();
        mesh.outgoing(sphere.report.puncture).map(|h| mesh.tip(h)).collect()
    };
    plane.u[sphere.report.puncture] = 60.0;
    let found = measure(sphere.metric.mesh(), &plane);
    for v in mesh.vertices().filter(|v| *v != sphere.report.puncture && !link.contains(v)) {
        assert!(found.curvature[v.index()].abs() < 1e-9, "{v}: {:e}", found.curvature[v.index()]);
    }
}

#[test]
fn a_cancelled_call_says_so() {
    let (mesh, lengths) = surface(&rough(1, 0.2));
    let control = Control::new();
    control.cancel();
    let result =
        uniformize_sphere(Arc::new(mesh), Arc::new(lengths), Space::E2, &SphereOptions::default(), &control);
    assert!(matches!(result, Err(Error::Cancelled)));
}

#[test]
fn cancelling_from_another_thread_stops_it() {
    let (mesh, lengths) = surface(&shapes::ellipsoid([1.0, 1.0, 9.0], 40).unwrap());
    let control = Control::new();
    let handle = control.clone();
    let worker = std::thread::spawn(move || {
        uniformize_sphere(Arc::new(mesh), Arc::new(lengths), Space::E2, &SphereOptions::default(), &handle)
    });
    std::thread::sleep(std::time::Duration::from_millis(60));
    control.cancel();
    assert!(matches!(worker.join().unwrap(), Err(Error::Cancelled)));
}

fn refused(intrinsic: &Intrinsic) -> String {
    let (mesh, lengths) = intrinsic.build().unwrap();
    run(&mesh, &lengths, &SphereOptions::default()).unwrap_err().to_string()
}

#[test]
fn what_is_no_sphere_is_refused_by_name() {
    assert!(refused(&shapes::two_triangle_sphere()).contains("at least four vertices"));
    assert!(refused(&shapes::one_vertex(2).unwrap()).contains("genus 0"));
    let (mesh, lengths) = surface(&shapes::disk(3).unwrap());
    let error = run(&mesh, &lengths, &SphereOptions::default()).unwrap_err();
    assert!(error.to_string().contains("with boundary"), "{error}");

    let (mesh, lengths) = surface(&shapes::icosphere(2).unwrap());
    let missing = SphereOptions { puncture: Some(VertexId(1000)), ..SphereOptions::default() };
    assert!(matches!(run(&mesh, &lengths, &missing), Err(Error::Argument { what: "vertex", .. })));
    let tolerance = SphereOptions { tolerance: 0.0, ..SphereOptions::default() };
    assert!(matches!(run(&mesh, &lengths, &tolerance), Err(Error::Argument { what: "tolerance", .. })));
    let short = PerEdge::filled(3, 1.0);
    assert!(matches!(run(&mesh, &short, &SphereOptions::default()), Err(Error::Size { .. })));

    // Both sides of a square: four points on a circle, and no polyhedron.
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]]).unwrap();
    let lengths = lengths_from_positions(&mesh, &points).unwrap();
    match run(&mesh, &lengths, &SphereOptions::default()) {
        Ok(sphere) => assert!(!sphere.report.converged, "{:?}", sphere.report),
        Err(error) => println!("flat: {error}"),
    }
}

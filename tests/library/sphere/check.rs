//! Checks that every sphere has to pass, computed again from its data.

use crate::common::Random;
use ricci::canonical::{Sphere, SphereOptions, uniformize_sphere};
use ricci::geometry::Space;
use ricci::geometry::vector::{add, cross, dot, norm, scale, sub};
use ricci::mesh::{Mesh, PerEdge, Point, io, shapes};
use ricci::metric::lengths_from_positions;
use ricci::{Control, Result, Surface};

pub fn run(mesh: &Mesh, lengths: &PerEdge<f64>, options: &SphereOptions) -> Result<Sphere> {
    let given = Surface::intrinsic(mesh.clone(), lengths.clone(), Space::E2)?;
    uniformize_sphere(&given, options, &Control::new())
}

pub fn surface(soup: &io::Soup) -> (Mesh, PerEdge<f64>) {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    (mesh, lengths)
}

pub fn on_sphere(soup: &io::Soup) -> Sphere {
    let (mesh, lengths) = surface(soup);
    run(&mesh, &lengths, &SphereOptions::default()).unwrap()
}

/// A third of the area of the faces at each vertex, by Heron's formula.
pub fn areas(mesh: &Mesh, lengths: &PerEdge<f64>) -> Vec<f64> {
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
pub fn nonconvexity(mesh: &Mesh, x: &[Point]) -> f64 {
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
pub fn check(sphere: &Sphere, given: &Mesh, lengths: &PerEdge<f64>, what: &str) {
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
    let shortest = on_sphere.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((shortest / report.smallest_edge - 1.0).abs() < 1e-12, "{what}");

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
pub fn same_up_to_moebius(a: &[Point], b: &[Point], tolerance: f64, what: &str) {
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

pub fn finger() -> io::Soup {
    // A sphere with a finger three radii long.
    let mut soup = shapes::icosphere(12).unwrap();
    for x in &mut soup.positions {
        let along = ((x[2] - 0.8) / 0.2).max(0.0);
        *x = add(*x, [0.0, 0.0, 3.0 * along]);
    }
    soup
}

pub fn rough(seed: u64, height: f64) -> io::Soup {
    let mut random = Random::new(seed);
    let mut soup = shapes::icosphere(7).unwrap();
    for x in &mut soup.positions {
        *x = scale(1.0 + height * random.symmetric(), *x);
    }
    soup
}

//! The removal of flat vertices from flat surfaces.

use ricci::flow::{Options, Solution, flow};
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::SplitMix64;
use ricci::mesh::{PerVertex, VertexId, shapes};
use ricci::spline::{CoarseTriangulation, FlatMetric};
use ricci::{Class, Control, Surface, Target};

/// A square of n × n cells whose inner vertices are moved a little.
fn square(n: usize) -> Surface {
    let mut random = SplitMix64::new(7);
    let mut soup = Soup::default();
    for j in 0..=n {
        for i in 0..=n {
            let mut shift = |k: usize| if k == 0 || k == n { 0.0 } else { 0.6 * (random.unit() - 0.5) };
            soup.positions.push([i as f64 + shift(i), j as f64 + shift(j), 0.0]);
        }
    }
    let at = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        soup.faces.extend([[a, b, c], [a, c, d]]);
    }
    Surface::from_soup(&soup).unwrap()
}

fn every(n: usize, step: usize) -> PerVertex<bool> {
    PerVertex::from_fn(n, |v: VertexId| v.index().is_multiple_of(step))
}

#[test]
fn vertices_of_a_square_lie_where_their_places_say() {
    let surface = square(20);
    let points = surface.positions().unwrap().clone();
    let flat = Solution::initial_of(surface, Class::yamabe(Space::E2)).unwrap();
    for step in [2, 5, 17, 1000] {
        let coarse = CoarseTriangulation::new(
            &FlatMetric::of(&flat, &Control::new()).unwrap(),
            &every(points.len(), step),
            &Control::new(),
        )
        .unwrap();
        let mesh = &coarse.mesh;
        mesh.validate().unwrap();
        assert_eq!((mesh.euler(), mesh.genus()), (1, 0));
        // The four corners stay, and so do the named vertices except for a few next to a corner.
        let named = points.len().div_ceil(step);
        assert!(
            (named.max(16) - 16..=named + 3).contains(&mesh.n_vertices()),
            "{} of {named}",
            mesh.n_vertices()
        );
        let place = |v: VertexId| {
            let place = coarse.places[v].unwrap();
            let corners = mesh.face_vertices(place.face).map(|c| points[coarse.vertices[c.index()].index()]);
            [0, 1].map(|x| (0..3).map(|k| place.weights[k] * corners[k][x]).sum::<f64>())
        };
        for v in flat.mesh().vertices() {
            let ([x, y], p) = (place(v), points[v.index()]);
            assert!(f64::hypot(x - p[0], y - p[1]) < 1e-11, "{v}: {x} {y} {p:?}");
        }
        for e in mesh.edges() {
            let [p, q] = mesh.ends(e).map(|v| points[coarse.vertices[v.index()].index()]);
            assert!((coarse.lengths[e] - f64::hypot(p[0] - q[0], p[1] - q[1])).abs() < 1e-12);
        }
    }
}

/// A vertex inside the triangle of a corner and its neighbours on the boundary would leave the corner in two triangles or more.
#[test]
fn each_corner_of_a_square_is_in_one_triangle() {
    let n = 20;
    let flat = Solution::initial_of(square(n), Class::yamabe(Space::E2)).unwrap();
    let flat = FlatMetric::of(&flat, &Control::new()).unwrap();
    let near = |i: usize| i == 1 || i + 1 == n;
    let keep = PerVertex::from_fn((n + 1) * (n + 1), |v: VertexId| {
        let [i, j] = [v.index() % (n + 1), v.index() / (n + 1)];
        (near(i) && near(j)) || (i.is_multiple_of(5) && j.is_multiple_of(5))
    });
    let coarse = CoarseTriangulation::new(&flat, &keep, &Control::new()).unwrap();
    let mesh = &coarse.mesh;
    mesh.validate().unwrap();
    let curvature = ricci::metric::curvature(mesh, Space::E2, &coarse.lengths).unwrap().at;
    let corners: Vec<VertexId> = mesh.vertices().filter(|&v| curvature[v] > 1.0).collect();
    assert_eq!(corners.len(), 4);
    for v in corners {
        assert_eq!(mesh.fan(v).len(), 1, "triangles at {v}");
    }
}

#[test]
fn a_torus_keeps_few_vertices_and_its_area() {
    let (mesh, lengths) = shapes::flat_torus([0.3, 1.1], 12, 12).unwrap().build().unwrap();
    let torus = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
    let flat = Solution::initial_of(torus, Class::yamabe(Space::E2)).unwrap();
    for step in [144, 48, 5] {
        let coarse = CoarseTriangulation::new(
            &FlatMetric::of(&flat, &Control::new()).unwrap(),
            &every(144, step),
            &Control::new(),
        )
        .unwrap();
        coarse.mesh.validate().unwrap();
        // The last vertices of a torus are possibly not removable.
        assert!(coarse.mesh.n_vertices() <= 144usize.div_ceil(step) + 1);
        let curvature = ricci::metric::curvature(&coarse.mesh, Space::E2, &coarse.lengths).unwrap();
        assert!((curvature.area - 1.1).abs() < 1e-12, "{}", curvature.area);
        assert!(curvature.at.iter().all(|k| k.abs() < 1e-11));
    }
}

#[test]
fn a_metric_with_one_cone_keeps_its_area_and_its_cone() {
    let surface = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let target = Target::Single(VertexId(0));
    let class = Class::yamabe(Space::E2);
    let flat = flow(surface, class, &target, &Options::default(), &Control::new()).unwrap();
    let n = flat.mesh().n_vertices();
    let coarse = CoarseTriangulation::new(
        &FlatMetric::of(&flat, &Control::new()).unwrap(),
        &every(n, 20),
        &Control::new(),
    )
    .unwrap();
    coarse.mesh.validate().unwrap();
    assert_eq!(coarse.mesh.euler(), -2);
    let curvature = ricci::metric::curvature(&coarse.mesh, Space::E2, &coarse.lengths).unwrap();
    let before = flat.curvature().unwrap().area;
    assert!((curvature.area / before - 1.0).abs() < 1e-9, "{} {before}", curvature.area);
    for v in coarse.mesh.vertices() {
        let expected = if v == VertexId(0) { -4.0 * std::f64::consts::PI } else { 0.0 };
        assert!((curvature.at[v] - expected).abs() < 1e-7, "{v}: {}", curvature.at[v]);
    }
    assert!(coarse.places.iter().flatten().all(|p| p.weights.iter().all(|w| (0.0..=1.0).contains(w))));
}

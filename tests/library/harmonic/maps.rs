//! Harmonic maps to Rⁿ, disks, polygons, rectangles and the sphere.

use crate::common;
use crate::harmonic::samples::{in_space, intrinsic};
use ricci::geometry::Space;
use ricci::harmonic::map::{energy, heat_step};
use ricci::harmonic::planar::{
    corners_by_length, flipped, regular_polygon, to_disk, to_polygon, to_rectangle,
};
use ricci::harmonic::{
    Domain, MapConstraints, SphereMapOptions, SphereMethod, harmonic_map, simple_domain, sphere_map,
};
use ricci::mesh::{VertexId, shapes};
use ricci::{Control, Error, Surface};

fn domain(surface: &Surface) -> Domain {
    Domain::new(surface, &Control::new()).unwrap()
}

fn bumpy_disk(n: usize) -> Surface {
    let mut soup = shapes::disk(n).unwrap();
    soup.positions.iter_mut().for_each(|[x, y, z]| *z = 0.6 * (3.0 * *x).sin() * (2.0 * *y).cos());
    in_space(&soup)
}

/// Linear functions are harmonic in the plane, with their boundary values, with their fluxes, and with some of either.
#[test]
fn linear_functions_are_reproduced() {
    let surface = in_space(&shapes::disk(9).unwrap());
    let (domain, positions) = (domain(&surface), surface.positions().unwrap());
    let mesh = domain.mesh();
    let linear = |v: VertexId| {
        let [x, y, _] = positions[v.index()];
        [2.0 * x - y + 0.5, 0.3 * y - 1.0]
    };
    let on_boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let all: Vec<[f64; 2]> = mesh.vertices().map(linear).collect();
    // The flux of a linear function through the boundary in the weak form.
    let columns = [0, 1].map(|k| domain.apply_laplacian(&all.iter().map(|p| p[k]).collect::<Vec<_>>()));
    let flux = |keep: &dyn Fn(VertexId) -> bool| -> Vec<[f64; 2]> {
        let of = |v: VertexId| if keep(v) { [0, 1].map(|k| columns[k][v.index()]) } else { [0.0; 2] };
        mesh.vertices().map(of).collect()
    };
    let half = |v: VertexId| positions[v.index()][0] > 0.1;
    let values = |keep: &dyn Fn(VertexId) -> bool| -> Vec<(VertexId, [f64; 2])> {
        on_boundary.iter().copied().filter(|&v| keep(v)).map(|v| (v, linear(v))).collect()
    };
    let cases = [
        MapConstraints { values: values(&|_| true), flux: None },
        MapConstraints {
            values: values(&half),
            flux: Some(flux(&|v| mesh.is_boundary_vertex(v) && !half(v))),
        },
        MapConstraints { values: vec![], flux: Some(flux(&|v| mesh.is_boundary_vertex(v))) },
    ];
    for (case, data) in cases.iter().enumerate() {
        let map = harmonic_map(&domain, data, &Control::new()).unwrap();
        // Without values the map is found up to a constant.
        let shift = [0, 1].map(|k| if case == 2 { linear(VertexId(0))[k] - map.points[0][k] } else { 0.0 });
        for v in mesh.vertices() {
            let off = (0..2).map(|k| (map.points[v.index()][k] + shift[k] - linear(v)[k]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "case {case}, vertex {v}");
        }
        assert!(map.mean_value_residual < 1e-13 && (map.energy - energy(&domain, &all)).abs() < 1e-11);
    }
    let unbalanced = MapConstraints::<1> { values: vec![], flux: Some(vec![[1.0]; mesh.n_vertices()]) };
    assert!(matches!(harmonic_map(&domain, &unbalanced, &Control::new()), Err(Error::Argument { .. })));
}

/// The number of vertices that had to be added so that neither a triangle nor a piece of the subdivision turns over.
fn check_disk(name: &str, surface: &Surface) -> usize {
    let (split, domain) = simple_domain(surface, false, &Control::new()).unwrap();
    let map = to_disk(&domain, &Control::new()).unwrap();
    assert!(flipped(&domain, &map.points).is_empty(), "{name}");
    assert!(map.mean_value_residual < 1e-10, "{name}: {}", map.mean_value_residual);
    if let Some(subdivision) = domain.common_subdivision(&Control::new()).unwrap() {
        let points = subdivision.from_vertices(1, &map.points).unwrap();
        for f in subdivision.mesh.faces() {
            let [a, b, c] = subdivision.mesh.face_vertices(f).map(|v| points[v.index()]);
            let [p, q] = [[b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]];
            let longest = p[0].hypot(p[1]).max(q[0].hypot(q[1]));
            assert!(p[0] * q[1] - p[1] * q[0] > -1e-12 * longest * longest, "{name}: piece {f}");
        }
    }
    split.n_added()
}

#[test]
fn maps_to_the_disk_flip_no_triangle() {
    assert_eq!(check_disk("bumpy", &bumpy_disk(12)), 0);
    let mut soup = shapes::disk(8).unwrap();
    shapes::slivers(&mut soup, shapes::Sliver::Cap, 20, 1e-3, 3).unwrap();
    check_disk("slivers", &in_space(&soup));
    // Around a spike with a vertex half-way up one of its edges the Delaunay triangulation has edges with the same ends.
    let mut soup = shapes::disk(4).unwrap();
    let [half, tip] = [0, 1].map(|k| (soup.positions.len() + k) as u32);
    let [a, b, c] = soup.faces[0];
    let mean = |k: usize| [a, b, c].iter().map(|&v| soup.positions[v as usize][k]).sum::<f64>() / 3.0;
    let top = [mean(0), mean(1), 2.0];
    let foot = soup.positions[a as usize];
    soup.positions.extend([[0, 1, 2].map(|k| 0.5 * (foot[k] + top[k])), top]);
    soup.faces[0] = [a, b, half];
    soup.faces.extend([[half, b, tip], [b, c, tip], [c, half, tip], [c, a, half]]);
    let spike = in_space(&soup);
    assert!(!flipped(&domain(&spike), &to_disk(&domain(&spike), &Control::new()).unwrap().points).is_empty());
    assert!(check_disk("spike", &spike) > 0);
}

/// The small disks of the corpus, one whose Delaunay triangulation needs vertices, and the largest; all of them are in
/// docs/results/maps.md.
#[test]
fn maps_of_the_corpus_to_the_disk_flip_no_triangle() {
    let Some((folder, rows)) = common::index("good") else { return };
    let mut seen = 0;
    for row in rows {
        let (is_disk, n) = (
            row["genus"] == "0" && row["boundary_loops"] == "1" && row["components"] == "1",
            row["V"].parse::<usize>().unwrap(),
        );
        let chosen = ["camelhead", "cortex_human_brain_48k_open"].contains(&&*row["name"]);
        if is_disk && (n <= 5000 || chosen) {
            let added = check_disk(&row["name"], &Surface::read(folder.join(&row["file"])).unwrap());
            assert_eq!(added > 0, row["name"] == "camelhead", "{}: {added}", row["name"]);
            seen += 1;
        }
    }
    assert!(seen >= 4, "{seen}");
}

#[test]
fn maps_to_convex_polygons_flip_no_triangle() {
    let surface = bumpy_disk(10);
    let (_, domain) = simple_domain(&surface, true, &Control::new()).unwrap();
    let polygon = [[0.0, 0.0], [2.0, -0.3], [2.5, 1.0], [0.7, 1.8]];
    let map = to_polygon(&domain, &polygon, None, &Control::new()).unwrap();
    assert!(flipped(&domain, &map.points).is_empty());
    for n in [3, 5, 12] {
        let corners = corners_by_length(&domain, n).unwrap();
        let map = to_polygon(&domain, &regular_polygon(n), Some(&corners), &Control::new()).unwrap();
        assert!(flipped(&domain, &map.points).is_empty(), "{n}");
        for (v, p) in corners.iter().zip(regular_polygon(n)) {
            assert_eq!(map.points[v.index()], p);
        }
    }
    let concave = [[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]];
    assert!(to_polygon(&domain, &concave, None, &Control::new()).is_err());
    assert!(matches!(corners_by_length(&domain, usize::MAX), Err(Error::Argument { .. })));
    let annulus = self::domain(&in_space(&shapes::annulus(0.4, 1.0, 3, 16).unwrap()));
    assert!(matches!(to_disk(&annulus, &Control::new()), Err(Error::Layout(_))));
}

/// A sector of a plane annulus is conformal to the rectangle of its logarithm.
#[test]
fn a_sector_has_the_modulus_of_its_logarithm() {
    let error = |n: usize| {
        // The annulus from radius 1 to e, from angle 0 to 1, as a grid that is even in the logarithm of the radius, but not square.
        let (m, n) = (2 * n, n);
        let at = |i: usize, j: usize| {
            let (r, t) = ((i as f64 / m as f64).exp(), j as f64 / n as f64);
            [r * t.cos(), r * t.sin(), 0.0]
        };
        let positions = (0..=n).flat_map(|j| (0..=m).map(move |i| at(i, j))).collect();
        let id = |i: usize, j: usize| (j * (m + 1) + i) as u32;
        let quads = (0..n).flat_map(|j| (0..m).map(move |i| (i, j)));
        let faces = quads
            .flat_map(|(i, j)| {
                [[id(i, j), id(i + 1, j), id(i + 1, j + 1)], [id(i, j), id(i + 1, j + 1), id(i, j + 1)]]
            })
            .collect();
        let soup = ricci::mesh::io::Soup { positions, faces, ..Default::default() };
        let domain = domain(&in_space(&soup));
        let corners = [id(0, 0), id(m, 0), id(m, n), id(0, n)].map(VertexId);
        let map = to_rectangle(&domain, Some(corners), &Control::new()).unwrap().map;
        let width = map.points.iter().map(|p| p[0]).fold(0.0, f64::max);
        assert!(flipped(&domain, &map.points).is_empty());
        (width - 1.0).abs()
    };
    let errors = [4, 8, 16].map(error);
    assert!(errors.windows(2).all(|pair| 3.0 * pair[1] <= pair[0]), "{errors:?}");
}

#[test]
fn implicit_steps_of_the_heat_flow_lower_the_energy_and_end_at_constants() {
    let torus = in_space(&shapes::torus(2.0, 0.8, 24, 12).unwrap());
    let domain = domain(&torus);
    let mut points = torus.positions().unwrap().to_vec();
    let mut before = energy(&domain, &points);
    for _ in 0..12 {
        heat_step(&domain, &mut points, 20.0, &Control::new()).unwrap();
        let after = energy(&domain, &points);
        assert!(after < before);
        before = after;
    }
    assert!(before < 1e-12);
    assert!(heat_step(&domain, &mut points, 0.0, &Control::new()).is_err());
}

#[test]
fn maps_of_the_round_sphere_are_moebius_up_to_the_square_of_the_edges() {
    let error = |n: usize| {
        let sphere = in_space(&shapes::icosphere(n).unwrap());
        let domain = domain(&sphere);
        let options = SphereMapOptions { tolerance: 1e-14, ..SphereMapOptions::default() };
        let map = sphere_map(&domain, &options, &Control::new()).unwrap();
        assert!(map.converged && map.flipped.is_empty());
        assert!(map.energies.windows(2).all(|pair| pair[1] <= pair[0]), "{:?}", map.energies);
        // Centred Möbius transformations are rotations: they keep lengths.
        let length = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        let positions = sphere.positions().unwrap();
        let off = |e| {
            let [i, j] = sphere.mesh().ends(e).map(|v| v.index());
            (length(map.points[i], map.points[j]) / length(positions[i], positions[j]) - 1.0).abs()
        };
        sphere.mesh().edges().map(off).fold(0.0, f64::max)
    };
    let errors = [4, 8, 16].map(error);
    assert!(errors.windows(2).all(|pair| 3.2 * pair[1] <= pair[0]), "{errors:?}");
}

/// The paper's flow and implicit steps end at one map, up to a rotation and to O(h²): the energy of a mesh is that far from invariant under
/// the Möbius transformations that centre every step.
#[test]
fn both_flows_to_the_sphere_agree() {
    let difference = |n: usize| {
        let domain = domain(&in_space(&shapes::ellipsoid([1.0, 1.3, 0.8], n).unwrap()));
        let [implicit, explicit] = [SphereMethod::Implicit, SphereMethod::HeatFlow].map(|method| {
            let options = SphereMapOptions { method, tolerance: 1e-14, max_iterations: 20_000 };
            sphere_map(&domain, &options, &Control::new()).unwrap()
        });
        for map in [&implicit, &explicit] {
            assert!(map.converged && map.energies.windows(2).all(|pair| pair[1] <= pair[0]));
        }
        let steps = [&implicit, &explicit].map(|map| map.energies.len());
        assert!(steps[0] < steps[1], "{steps:?}");
        let length = |points: &[[f64; 3]], [i, j]: [usize; 2]| {
            (0..3).map(|k| (points[i][k] - points[j][k]).powi(2)).sum::<f64>().sqrt()
        };
        let off = |e| {
            let ends = domain.mesh().ends(e).map(|v| v.index());
            (length(&implicit.points, ends) / length(&explicit.points, ends) - 1.0).abs()
        };
        domain.mesh().edges().map(off).fold(0.0, f64::max)
    };
    let differences = [3, 6].map(difference);
    assert!(differences[0] < 0.02 && 2.0 * differences[1] < differences[0], "{differences:?}");
}

#[test]
fn only_closed_surfaces_of_genus_0_map_to_the_sphere() {
    let flat = domain(&intrinsic(&shapes::flat_torus([0.0, 1.0], 3, 3).unwrap(), Space::E2));
    assert!(matches!(
        sphere_map(&flat, &SphereMapOptions::default(), &Control::new()),
        Err(Error::Layout(_))
    ));
}

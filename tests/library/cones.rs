//! Cones placed to lower the distortion of area.

use crate::common;
use crate::common::flow::{attempt, euclidean, surface};
use ricci::flow::cones::MAX_AUTO_CONES;
use ricci::flow::{AutoCones, Options, auto_cones, with_cones_placed};
use ricci::geometry::Space;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::repair::{Repair, repair};
use ricci::mesh::shapes;
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::Scheme;
use ricci::metric::curvature::curvature;
use ricci::metric::delaunay::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
use ricci::metric::target::{check_total, check_vertices};
use ricci::topology::farthest_vertices;
use ricci::{Class, Control, Error, Flow, Surface, Target};
use std::f64::consts::PI;

fn place(mesh: &Mesh, lengths: &PerEdge<f64>, n: usize) -> AutoCones {
    let cones = auto_cones(mesh, lengths, n, &Control::new()).unwrap();
    assert_eq!(cones.cones.len(), n);
    assert_eq!(cones.distortion.len(), n + 1);
    check_vertices(mesh, Scheme::Yamabe, &cones.target).unwrap();
    check_total(mesh, Space::E2, &cones.target).unwrap();
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        let given = cones.cones.iter().find(|c| c.0 == v).map_or(0.0, |c| c.1);
        assert_eq!(cones.target[v], given);
    }
    cones
}

/// `∫ (u − ū)² dA / ∫ dA` of the metric with this curvature, by vertex areas of the input: the flow itself, not its linear model.
fn measured(mesh: &Mesh, lengths: &PerEdge<f64>, target: &PerVertex<f64>) -> f64 {
    let mut mass = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let [a, b, c] = mesh.opposite_edges(f).map(|e| lengths[e]);
        let s = 0.5 * (a + b + c);
        let area = (s * (s - a) * (s - b) * (s - c)).max(0.0).sqrt();
        mesh.face_vertices(f).into_iter().for_each(|v| mass[v] += area / 3.0);
    }
    assert!(mesh.is_closed());
    let (given, class) = (euclidean(mesh, lengths), Class::yamabe(Space::E2));
    let mut flow = Flow::new(given, class, &Options::default(), &Control::new()).unwrap();
    let report = attempt(&mut flow, target);
    assert!(report.is_reached(), "{:?} {:e}", report.stop_reason, report.max_curvature_error);
    let u = &flow.metric().u;
    let total: f64 = mass.iter().sum();
    let mean = u.iter().zip(mass.iter()).map(|(u, m)| u * m).sum::<f64>() / total;
    u.iter().zip(mass.iter()).map(|(u, m)| (u - mean).powi(2) * m).sum::<f64>() / total
}

/// Farthest-point cones with equal shares of 2πχ.
fn equal_cones(mesh: &Mesh, lengths: &PerEdge<f64>, n: usize) -> PerVertex<f64> {
    let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
    let share = 2.0 * PI * mesh.euler() as f64 / n as f64;
    let cones = farthest_vertices(mesh, lengths, VertexId(0), n, &Control::new()).unwrap();
    cones.into_iter().for_each(|v| target[v] = share);
    target
}

fn noisy(mut soup: Soup, amplitude: f64) -> Soup {
    shapes::noise(&mut soup, amplitude, 7).unwrap();
    soup
}

#[test]
fn more_cones_lower_the_distortion_of_the_metric_itself() {
    for (name, soup, first) in [
        ("ellipsoid", shapes::ellipsoid([1.0, 0.6, 0.4], 10).unwrap(), 3),
        ("torus", shapes::torus(1.0, 0.4, 48, 24).unwrap(), 0),
        ("genus 2", shapes::genus(2, 8).unwrap(), 1),
        ("genus 3", shapes::genus(3, 8).unwrap(), 1),
    ] {
        let (mesh, lengths) = surface(&soup);
        let mut last = f64::INFINITY;
        let mut row = Vec::new();
        for n in [first, 4, 8, 16] {
            let now = measured(&mesh, &lengths, &place(&mesh, &lengths, n).target);
            row.push(format!("{n}: {now:.4}"));
            assert!(now < last, "{name}: {now} with {n} cones, {last} with fewer");
            last = now;
        }
        println!("{name}, V = {}: {}", mesh.n_vertices(), row.join(", "));
    }
}

#[test]
fn the_linear_model_expects_less_with_every_cone() {
    for soup in [shapes::ellipsoid([1.0, 0.5, 0.5], 8).unwrap(), shapes::genus(2, 6).unwrap()] {
        let (mesh, lengths) = surface(&soup);
        let expected = place(&mesh, &lengths, 12).distortion;
        // Cones of a sphere are bounded once there are three.
        assert!(expected[3..].windows(2).all(|w| w[1] <= w[0] * (1.0 + 1e-9)), "{expected:?}");
    }
}

#[test]
fn placed_cones_beat_farthest_points_with_equal_shares() {
    for (name, soup) in [
        ("ellipsoid", noisy(shapes::ellipsoid([1.0, 0.6, 0.3], 10).unwrap(), 0.004)),
        ("genus 2", shapes::genus(2, 8).unwrap()),
    ] {
        let (mesh, lengths) = surface(&soup);
        let placed = measured(&mesh, &lengths, &place(&mesh, &lengths, 8).target);
        let equal = measured(&mesh, &lengths, &equal_cones(&mesh, &lengths, 8));
        println!("{name}: 8 cones {placed:.4}, farthest points {equal:.4}");
        assert!(placed < 0.5 * equal, "{name}: {placed}, farthest points {equal}");
    }
}

#[test]
fn on_real_surfaces_placed_cones_beat_farthest_points() {
    let names =
        ["bob", "spot_low", "kitten_10k", "rocker_arm", "bumpy_cube", "genus3", "pretzel", "hand_cgal"];
    let Some(soups) = common::named("good", &names) else { return };
    println!("| mesh | V | χ | 4 | 8 | 16 | farthest 8 |");
    for (file, soup) in soups {
        let (mesh, lengths) = surface(&soup);
        let [four, eight, sixteen] =
            [4, 8, 16].map(|n| measured(&mesh, &lengths, &place(&mesh, &lengths, n).target));
        let equal = (mesh.euler() != 0).then(|| measured(&mesh, &lengths, &equal_cones(&mesh, &lengths, 8)));
        let (n, chi) = (mesh.n_vertices(), mesh.euler());
        println!("| {file} | {n} | {chi} | {four:.4} | {eight:.4} | {sixteen:.4} | {equal:.4?} |");
        assert!(sixteen < eight && eight < four, "{file}");
        assert!(equal.is_none_or(|equal| eight < equal), "{file}: {eight}, farthest points {equal:?}");
    }
}

/// Genus 24 with needles: four cones of about −70 stalled at a broken triangle, as long as flips rounded η to doubles.
#[test]
fn a_few_cones_carry_the_curvature_of_many_handles() {
    let Some(folder) = common::corpus("bad") else { return };
    let soup = io::read(&folder.join("gravgen_675cc.obj")).unwrap();
    let one = Repair { component: Some(0), ..Repair::default() };
    let (mesh, lengths) = surface(&repair(&soup, &one, &Control::new()).unwrap().soup);
    assert_eq!(mesh.euler(), -46);
    let class = Class::yamabe(Space::E2);
    for n in [1, 4, 5] {
        let placed = place(&mesh, &lengths, n);
        let mut flow =
            Flow::new(euclidean(&mesh, &lengths), class, &Options::default(), &Control::new()).unwrap();
        let report = attempt(&mut flow, &placed.target);
        println!("{n} cones: {} after {} steps", report.stop_reason, report.iterations);
        assert!(report.converged(), "{n} cones: {report:?}");
    }
}

#[test]
fn open_surfaces_keep_their_boundary_where_it_was() {
    for soup in [
        shapes::punch(&shapes::ellipsoid([1.0, 0.7, 0.5], 10).unwrap(), 1).unwrap(),
        shapes::punch(&shapes::torus(1.0, 0.5, 40, 20).unwrap(), 2).unwrap(),
    ] {
        let (mesh, lengths) = surface(&soup);
        let mut last = f64::INFINITY;
        for n in [0, 2, 6] {
            let cones = place(&mesh, &lengths, n);
            let now = *cones.distortion.last().unwrap();
            assert!(now < last, "{now} with {n} cones, {last} with fewer");
            last = now;
        }
    }
}

#[test]
fn a_flat_disk_needs_no_cone_and_keeps_its_boundary() {
    let (mesh, lengths) = surface(&shapes::disk(8).unwrap());
    let cones = place(&mesh, &lengths, 0);
    let given = curvature(&mesh, Space::E2, &lengths).unwrap().at;
    assert!(mesh.vertices().all(|v| (cones.target[v] - given[v]).abs() < 1e-12));
    assert!(cones.distortion[0] < 1e-24);
}

#[test]
fn the_vertices_of_a_polyhedron_are_found_as_its_cones() {
    // A regular tetrahedron and a cube, finely and flatly triangulated: u = 0 is possible, with cones at the corners alone.
    let (mesh, lengths, corners) = tetrahedron(12);
    let cones = place(&mesh, &lengths, 4);
    let found: Vec<_> = cones.cones.iter().map(|c| c.0).collect();
    assert_eq!(found, corners);
    assert!(cones.cones.iter().all(|c| (c.1 - PI).abs() < 1e-9), "{cones:?}");
    assert!(cones.distortion[4] < 1e-18);
}

/// A regular tetrahedron with faces cut into n² triangles, and its corners.
fn tetrahedron(n: usize) -> (Mesh, PerEdge<f64>, Vec<VertexId>) {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let (mut positions, mut faces) = (Vec::<[f64; 3]>::new(), Vec::new());
    for [a, b, c] in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] {
        let mut number = |i: usize, j: usize| {
            let weights = [(a, (n - i - j) as f64), (b, i as f64), (c, j as f64)];
            let p =
                [0, 1, 2].map(|k| weights.iter().map(|&(v, w)| w * corners[v][k]).sum::<f64>() / n as f64);
            let same = |q: &[f64; 3]| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9);
            positions.iter().position(same).unwrap_or_else(|| {
                positions.push(p);
                positions.len() - 1
            }) as u32
        };
        for i in 0..n {
            for j in 0..n - i {
                faces.push([number(i, j), number(i + 1, j), number(i, j + 1)]);
                if i + j + 2 <= n {
                    faces.push([number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]);
                }
            }
        }
    }
    let is_corner = |p: &[f64; 3]| p.iter().all(|x| (x.abs() - 1.0).abs() < 1e-12);
    let mut found: Vec<_> =
        (0..positions.len()).filter(|&v| is_corner(&positions[v])).map(VertexId::from).collect();
    found.sort();
    let soup = Soup { positions, faces, ..Soup::default() };
    let (mesh, lengths) = surface(&soup);
    (mesh, lengths, found)
}

#[test]
fn the_triangulation_does_not_matter() {
    let (mesh, lengths) = surface(&noisy(shapes::genus(2, 6).unwrap(), 0.003));
    let before = place(&mesh, &lengths, 6);
    let mut flips = 0;
    let mut surface = Triangulated { mesh, lengths, geometry: Space::E2 };
    let (options, mut count) = (IntrinsicOptions::default(), |_: &Mesh, _| flips += 1);
    intrinsic_delaunay(&mut surface, options, &mut count, &Control::new()).unwrap();
    let Triangulated { mesh, lengths, .. } = surface;
    assert!(flips > 0);
    let after = place(&mesh, &lengths, 6);
    for (a, b) in before.cones.iter().zip(&after.cones) {
        assert_eq!(a.0, b.0);
        assert!((a.1 - b.1).abs() < 1e-7);
    }
}

#[test]
fn numbers_of_cones_that_cannot_be_are_refused() {
    let refused = |soup: Soup, n: usize| {
        let (mesh, lengths) = surface(&soup);
        let error = auto_cones(&mesh, &lengths, n, &Control::new()).unwrap_err();
        assert!(matches!(error, Error::TargetKind { target: "auto", .. }), "{error}");
        error.to_string()
    };
    let sphere = || shapes::icosphere(2).unwrap();
    assert!(refused(sphere(), 2).contains("3 cones"));
    assert!(refused(sphere(), 43).contains("42 interior"));
    assert!(refused(shapes::icosphere(6).unwrap(), MAX_AUTO_CONES + 1).contains("256"));
    assert!(refused(shapes::torus(1.0, 0.5, 12, 8).unwrap(), 1).contains("torus"));
    assert!(refused(shapes::genus(2, 6).unwrap(), 0).contains("needs a cone"));
    assert!(refused(shapes::disk(1).unwrap(), 2).contains("interior"));
}

#[test]
fn open_surfaces_with_handles_have_cones_by_default() {
    let default = |soup: &Soup| {
        let (mesh, lengths) = surface(soup);
        Target::default_for(&euclidean(&mesh, &lengths), Space::E2).unwrap()
    };
    let open = shapes::punch(&shapes::genus(2, 4).unwrap(), 3).unwrap();
    assert_eq!(default(&open), Target::Auto(5));
    assert_eq!(default(&shapes::punch(&shapes::genus(1, 3).unwrap(), 1).unwrap()), Target::Auto(4));
    assert_eq!(default(&shapes::disk(3).unwrap()), Target::Outer(None));
    assert_eq!(default(&shapes::genus(2, 4).unwrap()), Target::Uniform);

    let (mesh, lengths) = surface(&open);
    let (given, free) = (euclidean(&mesh, &lengths), Control::new());
    assert_eq!(Target::default_for(&given, Space::H2).unwrap(), Target::Uniform);
    let curved = Surface::intrinsic(mesh.clone(), lengths.clone(), Space::H2).unwrap();
    assert_eq!(Target::default_for(&curved, Space::E2).unwrap(), Target::Boundary);
    let auto = Target::Auto(5);
    assert!(matches!(auto.values(&given, Space::E2), Err(Error::TargetKind { target: "auto", .. })));
    for (surface, space) in [(&given, Space::H2), (&curved, Space::E2)] {
        let refused = with_cones_placed(&auto, surface, space, &free);
        assert!(matches!(refused, Err(Error::TargetKind { target: "auto", .. })));
    }

    // A flow places the cones itself, and names them.
    let placed = place(&mesh, &lengths, 5);
    let mut flow = Flow::new(given, Class::yamabe(Space::E2), &Options::default(), &free).unwrap();
    let flat = flow.solve(&auto, &free).unwrap();
    assert!(flat.converged());
    assert!(flat.target().unwrap().iter().zip(placed.target.iter()).all(|(a, b)| (a - b).abs() < 1e-12));
    assert_eq!(flat.cones(), placed.cones.iter().map(|cone| cone.0).collect::<Vec<_>>());
}

#[test]
fn every_vertex_may_be_a_cone() {
    let (mesh, lengths) = surface(&shapes::icosphere(1).unwrap());
    let cones = place(&mesh, &lengths, 12);
    // Then nothing needs to change: the cones keep the curvature of the icosahedron.
    assert!(cones.cones.iter().all(|c| (c.1 - PI / 3.0).abs() < 1e-9), "{cones:?}");
}

#[test]
fn a_cancelled_call_says_so() {
    let (mesh, lengths) = surface(&shapes::genus(2, 6).unwrap());
    let control = Control::new();
    control.cancel();
    assert_eq!(auto_cones(&mesh, &lengths, 4, &control), Err(Error::Cancelled));
}

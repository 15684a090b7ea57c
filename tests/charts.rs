//! Layouts cut into charts that do not overlap, packed into the unit square.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Random;
use common::flow::surface;
use ricci::embed::overlap::{Triangle, overlapping};
use ricci::embed::{ChartOptions, Charts, Layout, charts, layout_of};
use ricci::flow::{Flips, Options, Solver, auto_cones};
use ricci::geometry::Space;
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::shapes;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::{Scheme, delaunay_start};
use ricci::topology::cut_graph;
use ricci::{Control, Error};
use std::cmp::Ordering;
use std::f64::consts::{PI, TAU};
use std::time::Instant;

fn cut(mesh: &Mesh, uv: impl Fn(HalfedgeId) -> [f64; 2]) -> Charts {
    let result = charts(mesh, &uv, &ChartOptions::default(), &Control::new()).unwrap();
    verify(mesh, &uv, &result);
    result
}

/// What charts promise, by other means than they were made with.
fn verify(mesh: &Mesh, uv: &impl Fn(HalfedgeId) -> [f64; 2], charts: &Charts) {
    // Inside the unit square, every motion is rigid, and the scale is the same everywhere.
    assert!(charts.coordinates.as_flattened().iter().all(|x| (0.0..=1.0).contains(x)));
    for f in mesh.faces() {
        for h in mesh.face_halfedges(f) {
            let motion = charts.motions[charts.chart[f] as usize];
            let expected = motion.apply(uv(h).map(|x| charts.scale * x));
            let got = charts.corner_uv(h);
            assert!((0..2).all(|k| (expected[k] - got[k]).abs() < 1e-9), "{expected:?} {got:?}");
        }
    }
    // Each chart is connected, and corners are shared except at seams.
    let mut seen = vec![false; mesh.n_faces()];
    let mut pieces = 0;
    for f in mesh.faces() {
        if std::mem::replace(&mut seen[f.index()], true) {
            continue;
        }
        pieces += 1;
        let mut open = vec![f];
        while let Some(f) = open.pop() {
            for h in mesh.face_halfedges(f).into_iter().filter(|h| !charts.is_seam[h.edge()]) {
                let t = h.twin();
                let Some(g) = mesh.face(t) else { continue };
                assert_eq!(charts.chart[f], charts.chart[g]);
                assert_eq!(charts.corner_index[h], charts.corner_index[mesh.next(t)]);
                if !std::mem::replace(&mut seen[g.index()], true) {
                    open.push(g);
                }
            }
        }
    }
    assert_eq!(pieces, charts.count());
    // Faces keep their orientation, in the layout exactly.
    let sound = |f: &FaceId| {
        let [a, b, c] = mesh.face_halfedges(*f).map(uv);
        orientation(a, b, c) == Ordering::Greater
    };
    assert_eq!(charts.flipped, mesh.faces().filter(|f| !sound(f)).collect::<Vec<_>>());
    // No two faces of a chart overlap in the layout, none of different charts in the square.
    let of_chart = |c: usize| -> Vec<Triangle> {
        let faces = mesh.faces().filter(|&f| charts.chart[f] as usize == c);
        faces.map(|f| mesh.face_halfedges(f).map(uv)).collect()
    };
    if charts.count() < 50 {
        (0..charts.count()).for_each(|c| assert_eq!(overlapping(&of_chart(c)), [0usize; 0]));
    }
    covered_at_most_once(mesh, charts);
    assert!(charts.seam_length[1] >= charts.seam_length[0]);
    assert!(charts.efficiency > 0.0 && charts.efficiency <= 1.0);
}

/// Random points of the unit square lie in one face at most.
fn covered_at_most_once(mesh: &Mesh, charts: &Charts) {
    let triangles: Vec<Triangle> = mesh.faces().map(|f| charts.face_uv(mesh, f)).collect();
    let mut random = Random::new(11);
    let mut covered = 0;
    for _ in 0..600 {
        let p = [random.unit(), random.unit()];
        let inside = |t: &Triangle| {
            let side =
                |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            let sides = [side(t[0], t[1]), side(t[1], t[2]), side(t[2], t[0])];
            sides.iter().all(|&s| s > 1e-12) || sides.iter().all(|&s| s < -1e-12)
        };
        let count = triangles.iter().filter(|t| inside(t)).count();
        assert!(count <= 1, "{p:?} lies in {count} faces");
        covered += count;
    }
    // The covered share is the efficiency, to the accuracy of 600 points.
    assert!((covered as f64 / 600.0 - charts.efficiency).abs() < 0.1, "{covered} {}", charts.efficiency);
}

/// A strip of 2·n·m triangles, as a rectangle [0, n] × [0, m].
fn strip(n: usize, m: usize) -> (Mesh, Vec<[f64; 3]>) {
    let id = |i: usize, j: usize| (i * (m + 1) + j) as u32;
    let mut soup = Soup::default();
    for i in 0..=n {
        (0..=m).for_each(|j| soup.positions.push([i as f64, j as f64, 0.0]));
    }
    for i in 0..n {
        for j in 0..m {
            soup.faces.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            soup.faces.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
    }
    (Mesh::from_soup(&soup).unwrap(), soup.positions)
}

#[test]
fn an_injective_layout_stays_one_chart() {
    for soup in [shapes::disk(12).unwrap(), shapes::annulus(0.3, 1.0, 8, 40).unwrap()] {
        let (mesh, _) = surface(&soup);
        let uv = |h| {
            let [x, y, _] = soup.positions[mesh.origin(h).index()];
            [x, y]
        };
        let result = cut(&mesh, uv);
        assert_eq!(result.count(), 1);
        assert_eq!(result.seam_length, [0.0, 0.0]);
        assert!(mesh.edges().all(|e| !result.is_seam[e]));
        // A round shape fills π/4 of its square.
        assert!(result.efficiency > 0.7, "{}", result.efficiency);
    }
}

#[test]
fn a_spiral_needs_as_many_charts_as_it_has_turns() {
    for turns in [2, 3, 5] {
        let (mesh, positions) = strip(60 * turns, 4);
        let uv = |h| {
            let [x, y, _] = positions[mesh.origin(h).index()];
            let (angle, radius) = (TAU * x / 60.0 * 0.97, 2.0 - 0.2 * y);
            [radius * angle.cos(), radius * angle.sin()]
        };
        let result = cut(&mesh, uv);
        println!("{turns} turns: {} charts, efficiency {:.2}", result.count(), result.efficiency);
        assert!((turns..=turns + 1).contains(&result.count()), "{} charts of {turns} turns", result.count());
    }
}

#[test]
fn sheets_that_lie_on_each_other_come_apart() {
    // A cone with more than a full turn around its tip: no two faces overlap near each other, all do across.
    let n = 30;
    let (mesh, positions) = strip(n, 6);
    let uv = |h| {
        let [x, y, _] = positions[mesh.origin(h).index()];
        let (angle, radius) = (1.6 * TAU * x / n as f64, 6.2 - y);
        [radius * angle.cos(), radius * angle.sin()]
    };
    assert_eq!(cut(&mesh, uv).count(), 2);
}

#[test]
fn a_flipped_face_is_a_chart_of_its_own() {
    let (mesh, mut positions) = strip(6, 6);
    positions[24] = [5.2, 3.1, 0.0];
    let uv = |h| {
        let [x, y, _] = positions[mesh.origin(h).index()];
        [x, y]
    };
    let result = cut(&mesh, uv);
    assert!(!result.flipped.is_empty());
    for &f in &result.flipped {
        assert_eq!(mesh.faces().filter(|&g| result.chart[g] == result.chart[f]).count(), 1);
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let (mesh, positions) = strip(3, 3);
    let plane = |h| {
        let [x, y, _] = positions[mesh.origin(h).index()];
        [x, y]
    };
    let with = |margin: f64| charts(&mesh, plane, &ChartOptions { margin }, &Control::new());
    for margin in [-0.1, 1.0, f64::NAN] {
        assert!(matches!(with(margin), Err(Error::Argument { what: "margin", .. })));
    }
    assert!(with(0.5).unwrap().scale < with(0.0).unwrap().scale);
    let none = |uv: [f64; 2]| {
        let uv = |h: HalfedgeId| if mesh.origin(h).index() == 7 { uv } else { [0.0; 2] };
        charts(&mesh, uv, &ChartOptions::default(), &Control::new()).unwrap_err().to_string()
    };
    assert!(none([f64::NAN, 0.0]).contains("not finite"));
    assert!(none([1.0, 1.0]).contains("no area"));
    let control = Control::new();
    control.cancel();
    assert_eq!(charts(&mesh, plane, &ChartOptions::default(), &control), Err(Error::Cancelled));
}

/// The flat metric with these curvatures, laid out.
fn lay_out(mesh: &Mesh, lengths: &PerEdge<f64>, target: &PerVertex<f64>) -> (Mesh, Layout) {
    let (mut mesh, mut lengths) = (mesh.clone(), lengths.clone());
    let start = delaunay_start(
        &mut mesh,
        &mut lengths,
        Space::E2,
        Scheme::Yamabe,
        Space::E2,
        None,
        &[],
        &mut |_, _| {},
    )
    .unwrap();
    let mut solver =
        Solver::new(mesh, start.metric, Options { flips: Flips::Auto, ..Options::default() }).unwrap();
    assert!(solver.solve(target, &Control::new()).unwrap().converged);
    let (mesh, metric) = (solver.mesh().clone(), solver.metric().clone());
    let cones: Vec<_> =
        mesh.vertices().filter(|&v| target[v] != 0.0 && !mesh.is_boundary_vertex(v)).collect();
    let cut = cut_graph(&mesh, &metric.lengths(&mesh).unwrap(), &cones).unwrap();
    let layout = layout_of(&mesh, &metric, &cut, &Control::new()).unwrap();
    (mesh, layout)
}

#[test]
fn layouts_of_high_genus_come_apart_into_few_charts() {
    for genus in [2, 3, 4] {
        let (mesh, lengths) = surface(&shapes::genus(genus, 8).unwrap());
        let single = PerVertex::from_fn(mesh.n_vertices(), |v| {
            if v == VertexId(0) { 2.0 * PI * mesh.euler() as f64 } else { 0.0 }
        });
        let placed = auto_cones(&mesh, &lengths, 8, &Control::new()).unwrap().target;
        for (name, target) in [("single", single), ("auto:8", placed)] {
            let (mesh, layout) = lay_out(&mesh, &lengths, &target);
            let start = Instant::now();
            let result = cut(&mesh, |h| layout.corner_uv(h));
            println!(
                "genus {genus}, {name}: {} faces, {} charts, efficiency {:.2}, seams {:.2} -> {:.2}, {:.2} s",
                mesh.n_faces(),
                result.count(),
                result.efficiency,
                result.seam_length[0] / layout.diameter,
                result.seam_length[1] / layout.diameter,
                start.elapsed().as_secs_f64()
            );
            let all: Vec<Triangle> = mesh.faces().map(|f| layout.face_uv(&mesh, f)).collect();
            assert_eq!(result.count() == 1, overlapping(&all).is_empty());
            assert!(result.count() < 50);
        }
    }
}

#[test]
fn layouts_of_real_surfaces_come_apart() {
    let Some(folder) = common::corpus("good") else { return };
    for (file, n) in [
        ("bob", 8),
        ("kitten_10k", 8),
        ("rocker_arm", 12),
        ("bumpy_cube", 20),
        ("pretzel", 8),
        ("hand_cgal", 6),
    ] {
        let Ok(soup) = io::read(&folder.join(format!("{file}.obj"))) else { continue };
        let (mesh, lengths) = surface(&soup);
        let target = auto_cones(&mesh, &lengths, n, &Control::new()).unwrap().target;
        let (mesh, layout) = lay_out(&mesh, &lengths, &target);
        let start = Instant::now();
        let result =
            charts(&mesh, |h| layout.corner_uv(h), &ChartOptions::default(), &Control::new()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        verify(&mesh, &|h| layout.corner_uv(h), &result);
        let triangles: Vec<Triangle> = mesh.faces().map(|f| result.face_uv(&mesh, f)).collect();
        println!(
            "{file}, {n} cones: {} faces, {} charts, efficiency {:.2}, {} overlap after rounding, {seconds:.2} s",
            mesh.n_faces(),
            result.count(),
            result.efficiency,
            overlapping(&triangles).len()
        );
    }
}

//! Layouts cut into charts that do not overlap, packed into the unit square.

use crate::common;
use crate::common::Random;
use crate::common::flow::{attempt, surface};
use ricci::embed::{ChartOptions, Charts, Layout, LayoutOpening, LayoutOptions, LayoutScale, charts};
use ricci::flow::{Options, auto_cones, flow};
use ricci::geometry::Space;
use ricci::geometry::predicates::orientation;
use ricci::geometry::triangle_overlap::{TriangleCorners, overlapping};
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::{Triangulated, delaunay_start};
use ricci::topology::cut_graph;
use ricci::{Class, Control, Error, Flow, Surface, Target};
use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;
use std::time::Instant;

fn cut(mesh: &Mesh, uv: impl Fn(HalfedgeId) -> [f64; 2]) -> Charts {
    let result = charts(mesh, &uv, &ChartOptions::default(), &Control::new()).unwrap();
    verify(mesh, &uv, &result);
    result
}

/// The guarantees of charts, checked by other means than those that made them.
fn verify(mesh: &Mesh, uv: &impl Fn(HalfedgeId) -> [f64; 2], charts: &Charts) {
    // All charts lie inside the unit square; every motion is rigid, and the scale is the same for all.
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
    // Faces that are neither named as flipped nor as degenerate are counterclockwise, in the layout and in the square, exactly.
    let is_solid = |f: &FaceId| charts.degenerate.binary_search(f).is_err();
    let sound = |f: &FaceId, uv: &dyn Fn(HalfedgeId) -> [f64; 2]| {
        let [a, b, c] = mesh.face_halfedges(*f).map(uv);
        orientation(a, b, c) == Ordering::Greater
    };
    for f in mesh.faces().filter(is_solid) {
        let sides = [sound(&f, &uv), sound(&f, &|h| charts.corner_uv(h))];
        assert_eq!(sides, [charts.flipped.binary_search(&f).is_err(); 2], "face {f}");
    }
    // Degenerate ones are lower than 3 roundings in the square or the layout, or no higher than 1e-11 of their length.
    let size = mesh.halfedges().flat_map(uv).fold(0.0f64, |m, x| m.max(x.abs()));
    for &f in &charts.degenerate {
        let low = |t: TriangleCorners, size: f64| {
            let longest = (0..3).map(|k| distance(t[k], t[(k + 1) % 3])).fold(0.0, f64::max);
            let height = doubled_area(&t).abs() / longest;
            longest == 0.0 || height < 1e-11 * longest || height < 3.0 * f64::EPSILON * size
        };
        assert!(low(charts.face_uv(mesh, f), 1.0) || low(mesh.face_halfedges(f).map(uv), size), "face {f}");
    }
    // No two other faces overlap in the square, and no two of one chart overlap in the layout.
    let of_chart = |c: usize| -> Vec<TriangleCorners> {
        let faces = mesh.faces().filter(|&f| charts.chart[f] as usize == c).filter(is_solid);
        faces.map(|f| mesh.face_halfedges(f).map(uv)).collect()
    };
    let overlapping = |all: &[TriangleCorners]| overlapping(all, &Control::new()).unwrap();
    (0..charts.count()).for_each(|c| assert_eq!(overlapping(&of_chart(c)), [0usize; 0]));
    let all: Vec<TriangleCorners> = mesh.faces().filter(is_solid).map(|f| charts.face_uv(mesh, f)).collect();
    assert_eq!(overlapping(&all), [0usize; 0]);
    covered_at_most_once(mesh, charts);
    keep_their_distance(mesh, charts, ChartOptions::default().margin);
    assert!(charts.seam_length[1] >= charts.seam_length[0]);
    assert!(charts.efficiency > 0.0 && charts.efficiency <= 1.0);
}

/// The boxes of any two charts are the margin apart, and half of it from the border.
fn keep_their_distance(mesh: &Mesh, charts: &Charts, margin: f64) {
    let mut boxes =
        vec![[f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]; charts.count()];
    for f in mesh.faces() {
        for [x, y] in charts.face_uv(mesh, f) {
            let b = &mut boxes[charts.chart[f] as usize];
            *b = [b[0].min(x), b[1].min(y), b[2].max(x), b[3].max(y)];
        }
    }
    for (i, a) in boxes.iter().enumerate() {
        assert!(a.iter().all(|x| (0.5 * margin - 1e-14..=1.0 - 0.5 * margin + 1e-14).contains(x)), "{a:?}");
        for b in &boxes[..i] {
            let gap = [b[0] - a[2], a[0] - b[2], b[1] - a[3], a[1] - b[3]];
            assert!(gap.iter().any(|&g| g >= margin - 1e-14), "{a:?} {b:?}");
        }
    }
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

fn doubled_area(&[a, b, c]: &TriangleCorners) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Random points of the unit square lie in one face at most.
fn covered_at_most_once(mesh: &Mesh, charts: &Charts) {
    let triangles: Vec<TriangleCorners> = mesh.faces().map(|f| charts.face_uv(mesh, f)).collect();
    let mut random = Random::new(11);
    let mut covered = 0;
    for _ in 0..600 {
        let p = [random.unit(), random.unit()];
        let inside = |t: &TriangleCorners| {
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
fn a_layout_that_shrinks_beyond_f64_stays_together() {
    // A logarithmic spiral: radii from 1 to 1e-30, two and a half turns. Most faces are far smaller than the square resolves.
    let (n, m) = (240, 6);
    let (mesh, positions) = strip(n, m);
    let uv = |h| {
        let [x, y, _] = positions[mesh.origin(h).index()];
        let angle = 2.5 * TAU * x / n as f64;
        let radius = (-30.0 * std::f64::consts::LN_10 * x / n as f64 - 0.05 * y).exp();
        [radius * angle.cos(), radius * angle.sin()]
    };
    let result = cut(&mesh, uv);
    println!("{} charts, {} faces without area", result.count(), result.degenerate.len());
    assert!(result.count() <= 3, "{} charts", result.count());
    assert!(result.degenerate.len() > n * m / 2 && result.flipped.is_empty());
}

#[test]
fn what_touches_does_not_overlap_once_it_is_packed() {
    // Teeth that reach an edge far away from theirs, to the last digit: rounding in the square puts about half of them across it.
    for seed in 1..6 {
        let mut random = Random::new(seed);
        let n = 40;
        let (mesh, mut positions) = strip(n, 3);
        // Bent into a U along a line that is not one of the grid's: the tips of one leg end on the other.
        let (s, c) = (0.3 + random.unit()).sin_cos();
        let (near, tips) = (n / 2 - 4, 3);
        for (k, p) in positions.iter_mut().enumerate() {
            let (i, j) = (k / 4, (k % 4) as f64);
            let [x, y] = match i {
                i if i <= near => [i as f64, -1.0 - j],
                i if i < n - near => {
                    let angle = FRAC_PI_2 * ((i - near) as f64 / (n / 2 - near) as f64 - 1.0);
                    [near as f64 + (1.0 + j) * angle.cos(), (1.0 + j) * angle.sin()]
                }
                i => [(n - i) as f64, 1.0 + j],
            };
            // The inner side of the upper leg comes down to the line of the lower one, every third vertex.
            let y = if i > n - near && j == 0.0 && i % tips == 0 { -1.0 } else { y };
            *p = [c * x + s * y, s * x - c * y, 0.0];
        }
        for k in 0..positions.len() {
            let (i, j) = (k / 4, k % 4);
            if i > n - near && j == 0 && i % tips == 0 {
                // Exactly where the vertex of the lower leg is, or between two of them.
                let (a, b) = (positions[(n - i) * 4], positions[(n - i - 1) * 4]);
                let t = random.unit();
                positions[k] = std::array::from_fn(|x| (1.0 - t) * a[x] + t * b[x]);
            }
        }
        let uv = |h| {
            let [x, y, _] = positions[mesh.origin(h).index()];
            [x, y]
        };
        let result = cut(&mesh, uv);
        println!("{} charts", result.count());
        // The strip, and at worst each of the five teeth.
        assert!(result.count() <= 6, "{} charts", result.count());
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

/// The layout of the flat metric with these curvatures.
fn flat_layout(mesh: &Mesh, lengths: &PerEdge<f64>, target: &PerVertex<f64>) -> (Mesh, Layout) {
    let mut surface = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry: Space::E2 };
    let class = Class::yamabe(Space::E2).into();
    let start = delaunay_start(&mut surface, class, &mut |_, _| {}, &Control::new()).unwrap();
    let mut flow = Flow::from_metric(surface.mesh, start.metric, &Options::default()).unwrap();
    assert!(attempt(&mut flow, target).is_reached());
    let (mesh, metric) = (flow.mesh().clone(), flow.metric().clone());
    let cones: Vec<_> =
        mesh.vertices().filter(|&v| target[v] != 0.0 && !mesh.is_boundary_vertex(v)).collect();
    let cut = cut_graph(&mesh, &metric.lengths(&mesh).unwrap(), &cones, &Control::new()).unwrap();
    let (opening, scale) = (LayoutOpening::MetricCut(cut), LayoutScale::AsSolved);
    let options = LayoutOptions { opening, scale, ..LayoutOptions::default() };
    let layout = Layout::of_solution(&flow.solution(), &options, &Control::new()).unwrap();
    (Arc::unwrap_or_clone(mesh), layout)
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
            let (mesh, layout) = flat_layout(&mesh, &lengths, &target);
            let start = Instant::now();
            let result = cut(&mesh, |h| layout.uv(h));
            println!(
                "genus {genus}, {name}: {} faces, {} charts, efficiency {:.2}, seams {:.2} -> {:.2}, {:.2} s",
                mesh.n_faces(),
                result.count(),
                result.efficiency,
                result.seam_length[0] / layout.diameter,
                result.seam_length[1] / layout.diameter,
                start.elapsed().as_secs_f64()
            );
            let all: Vec<TriangleCorners> = mesh.faces().map(|f| layout.face_uv(f)).collect();
            assert_eq!(result.count() == 1, overlapping(&all, &Control::new()).unwrap().is_empty());
            assert!(result.count() < 50);
        }
    }
}

#[test]
fn layouts_of_real_surfaces_come_apart() {
    let names = ["bob", "kitten_10k", "rocker_arm", "bumpy_cube", "pretzel", "hand_cgal"];
    let Some(soups) = common::named("good", &names) else { return };
    for ((file, soup), n) in soups.into_iter().zip([8, 8, 12, 20, 8, 6]) {
        let (mesh, lengths) = surface(&soup);
        let target = auto_cones(&mesh, &lengths, n, &Control::new()).unwrap().target;
        let (mesh, layout) = flat_layout(&mesh, &lengths, &target);
        let start = Instant::now();
        let result = charts(&mesh, |h| layout.uv(h), &ChartOptions::default(), &Control::new()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        verify(&mesh, &|h| layout.uv(h), &result);
        println!(
            "{file}, {n} cones: {} faces, {} charts, efficiency {:.2}, {seconds:.2} s",
            mesh.n_faces(),
            result.count(),
            result.efficiency,
        );
    }
}

/// All curvature at a single vertex, on surfaces of high genus, laid out on the common subdivision: e^40 between the scales.
#[test]
fn layouts_with_a_single_cone_come_apart_into_few_charts() {
    let Some(soups) = common::named("good", &["elephant_2775", "holes_7b", "casting"]) else { return };
    for (file, soup) in soups {
        let (options, control) = (Options::default(), Control::new());
        let given = Surface::from_soup(&soup).unwrap();
        let target = Target::Single(VertexId(0));
        let flat = flow(given, Class::yamabe(Space::E2), &target, &options, &control).unwrap();
        assert!(flat.report().unwrap().is_reached(), "{file}: {:?}", flat.report());
        let inside = !flat.given().is_boundary_vertex(VertexId(0));
        assert_eq!(flat.cones(), &[VertexId(0)][..usize::from(inside)], "{file}");
        let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &control).unwrap();
        let (start, laid) = (Instant::now(), layout.mesh());
        let result = charts(laid, |h| layout.uv(h), &ChartOptions::default(), &control).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        verify(laid, &|h| layout.uv(h), &result);
        println!(
            "{file}: genus {}, {} faces, {} charts, {} degenerate, efficiency {:.2}, {seconds:.2} s",
            flat.given().genus(),
            laid.n_faces(),
            result.count(),
            result.degenerate.len(),
            result.efficiency
        );
        assert!(result.count() < 60, "{file}: {} charts", result.count());
    }
}

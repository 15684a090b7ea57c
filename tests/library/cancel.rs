//! Cancelling: every stage between a surface and its charts ends soon, with an error, and leaves its input as it was.

use crate::common::Random;
use crate::common::flow::{euclidean, surface};
use ricci::embed::{ChartOptions, Layout, LayoutOpening, LayoutOptions, charts};
use ricci::flow::{Options, auto_cones};
use ricci::geometry::Space;
use ricci::geometry::packing::pack;
use ricci::geometry::triangle_overlap::overlapping;
use ricci::mesh::{Curves, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::delaunay::{ClassFlips, FlipQueue, IntrinsicOptions, intrinsic_delaunay};
use ricci::metric::{Scheme, Triangulated, delaunay_start, initial_metric};
use ricci::topology::{cut_graph, farthest_vertices, homology_generators, shortest_paths};
use ricci::{Class, Control, Error, Flow, Result, Target};
use std::time::Duration;

/// A torus whose triangulation is far from Delaunay.
fn skewed(n: usize) -> (Mesh, PerEdge<f64>) {
    let mut soup = shapes::torus(2.0, 0.2, n, n).unwrap();
    let mut random = Random::new(4);
    let step = 0.8 / n as f64;
    soup.positions.as_flattened_mut().iter_mut().for_each(|x| *x += step * (random.unit() - 0.5));
    surface(&soup)
}

fn cancelled() -> Control {
    let control = Control::new();
    control.cancel();
    control
}

fn flow((mesh, lengths): &(Mesh, PerEdge<f64>), control: &Control) -> Result<Flow> {
    Flow::new(euclidean(mesh, lengths), Class::inversive(Space::E2), &Options::default(), control)
}

fn is_cancelled<T>(what: &str, result: Result<T>) {
    assert!(matches!(result, Err(Error::Cancelled)), "{what}");
}

#[test]
fn a_cancelled_control_stops_every_stage() {
    let given = skewed(40);
    let (mesh, lengths) = &given;
    let (free, stop) = (Control::new(), cancelled());
    is_cancelled("Flow::new", flow(&given, &stop));
    let target = Target::Cones(vec![(VertexId(3), 3.0), (VertexId(700), -3.0)]);
    let mut made = flow(&given, &free).unwrap();
    let before = (made.mesh().clone(), made.metric().clone());
    is_cancelled("solve", made.solve(&target, &stop));
    is_cancelled("resume", Flow::resume(&made.solution(), &Options::default(), &stop));
    assert!(before == (made.mesh().clone(), made.metric().clone()));
    let now = made.solve(&target, &free).unwrap();
    assert!(now.converged());
    is_cancelled("subdivision", now.common_subdivision(&stop));
    let normal = NormalCoordinates::new(mesh);
    is_cancelled("Curves::trace", Curves::trace(mesh, &normal, &stop));
    let cones = [VertexId(3), VertexId(700)];
    is_cancelled("cut_graph", cut_graph(mesh, lengths, &cones, &stop));
    is_cancelled("shortest_paths", shortest_paths(mesh, lengths, cones, &stop));
    is_cancelled("farthest_vertices", farthest_vertices(mesh, lengths, VertexId(0), 4, &stop));
    is_cancelled("homology_generators", homology_generators(mesh, lengths, &stop));
    let options = LayoutOptions { cones: Some(cones.to_vec()), ..LayoutOptions::default() };
    is_cancelled("Layout::of_solution", Layout::of_solution(&now, &options, &stop));
    let layout = Layout::of_solution(&now, &options, &free).unwrap();
    let options = LayoutOptions { opening: LayoutOpening::MetricEdges, ..LayoutOptions::default() };
    is_cancelled("Layout::of_solution", Layout::of_solution(&now, &options, &stop));
    is_cancelled("charts", charts(layout.mesh(), |h| layout.uv(h), &ChartOptions::default(), &stop));
    is_cancelled("pack", pack(&[[1.0, 2.0], [1.0, 1.0]], 0.0, &stop));
    let triangles: Vec<_> = layout.mesh().faces().map(|f| layout.face_uv(f)).collect();
    is_cancelled("overlapping", overlapping(&triangles, &stop));
    is_cancelled("auto_cones", auto_cones(mesh, lengths, 4, &stop));
}

#[test]
fn flips_that_are_cancelled_on_their_way_leave_the_surface() {
    let (mesh, lengths) = skewed(120);
    let given = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry: Space::E2 };
    for stop_at in [1, 1000] {
        let mut m = given.clone();
        let (control, mut flips) = (Control::new(), 0);
        let mut record = |_: &Mesh, _| {
            flips += 1;
            if flips == stop_at {
                control.cancel();
            }
        };
        is_cancelled(
            "intrinsic_delaunay",
            intrinsic_delaunay(&mut m, IntrinsicOptions::default(), &mut record, &control),
        );
        assert!(m == given);
        // It looks every 4096 edges, each of which is one flip at most.
        assert!((stop_at..stop_at + 4097).contains(&flips), "{flips}");
    }
    // In the second round of flips, to the weighted triangulation, the surface is the same on another triangulation.
    let mut flipped = given.clone();
    let mut first_round = 0;
    let mut record = |_: &Mesh, _| first_round += 1;
    intrinsic_delaunay(&mut flipped, IntrinsicOptions::default(), &mut record, &Control::new()).unwrap();
    let mut m = given.clone();
    let (control, mut flips) = (Control::new(), 0);
    let mut record = |_: &Mesh, _| {
        flips += 1;
        if flips == first_round + 1 {
            control.cancel();
        }
    };
    let class = Class::new(Scheme::Inversive, Space::E2);
    let start = delaunay_start(&mut m, class.into(), &mut record, &control);
    assert!(flips > first_round);
    // The end may come before the next look.
    assert!(matches!(start, Ok(_) | Err(Error::Cancelled)));
    assert!(start.is_ok() || m == flipped);

    let mut metric = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2)).unwrap().metric;
    metric.u = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| (v.index() as f64).sin());
    let vertices = metric.vertices();
    let (mut m, mut queue, control) =
        (mesh.clone(), FlipQueue::all(&mesh, &FixedEdges::none()), Control::new());
    let mut record = |_: &Mesh, _: Flip<_>| control.cancel();
    is_cancelled(
        "restore_delaunay",
        ClassFlips { mesh: &mut m, metric: &mut metric, record: &mut record }
            .restore_delaunay(&vertices, &mut queue, &control),
    );
}

/// Latencies allowed, in factorisations of the same surface's Newton matrix measured in the same run: the longest piece of work without a
/// look at the control is one of them, with the filling of the matrix; the rest is for a machine with other work to do.
const FACTORISATIONS: u32 = 10;

/// Cancel from another thread, at a moment that depends on the machine: whatever the work has come to, it ends or is cancelled, and
/// soon.
fn interrupt<T>(what: &str, factorisation: Duration, work: impl Fn(&Control) -> Result<T>) {
    let mut latencies = Vec::new();
    for delay in [1, 4, 16, 64] {
        let control = Control::new();
        let other = control.clone();
        let canceller = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(delay));
            other.cancel();
        });
        let result = work(&control);
        let latency = control.since_cancel();
        canceller.join().unwrap();
        match result {
            Err(Error::Cancelled) => latencies.extend(latency),
            result => assert!(result.is_ok(), "{what}"),
        }
    }
    let worst = latencies.iter().max().copied().unwrap_or_default();
    println!("{what}: cancelled {} times of 4, at most {worst:?} later", latencies.len());
    assert!(
        worst <= FACTORISATIONS * factorisation,
        "{what}: {worst:?}, a factorisation takes {factorisation:?}"
    );
}

#[test]
fn work_ends_soon_after_it_is_cancelled_from_another_thread() {
    let given = skewed(200);
    let (mesh, lengths) = &given;
    let free = Control::new();
    let uniform = Target::Uniform;
    let measured = flow(&given, &free).unwrap().solve(&uniform, &free).unwrap();
    let report = measured.report().unwrap();
    let one = Duration::from_secs_f64(report.seconds.factor / report.factorisations as f64);
    println!("one of {} factorisations: {one:?}", report.factorisations);
    let surface = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry: Space::E2 };
    interrupt("Flow::new", one, |c| flow(&given, c).map(drop));
    interrupt("intrinsic_delaunay", one, |c| {
        let mut m = surface.clone();
        let flips = intrinsic_delaunay(&mut m, IntrinsicOptions::default(), &mut |_, _| {}, c);
        assert!(flips.is_ok() || m == surface);
        flips
    });
    let mut flat = surface.clone();
    let mut normal = NormalCoordinates::new(mesh);
    let mut record = |mesh: &Mesh, flip: Flip| normal.record(mesh, flip.edge);
    delaunay_start(&mut flat, Class::yamabe(Space::E2).into(), &mut record, &free).unwrap();
    interrupt("Curves::trace", one, |c| Curves::trace(&flat.mesh, &normal, c).map(drop));
    interrupt("cut_graph", one, |c| cut_graph(mesh, lengths, &[], c).map(drop));
    interrupt("homology_generators", one, |c| homology_generators(mesh, lengths, c).map(drop));
    interrupt("farthest_vertices", one, |c| farthest_vertices(mesh, lengths, VertexId(0), 8, c).map(drop));
    interrupt("auto_cones", one, |c| auto_cones(mesh, lengths, 6, c).map(drop));
    let class = Class::yamabe(Space::E2);
    let mut made = Flow::new(euclidean(mesh, lengths), class, &Options::default(), &free).unwrap();
    let before = (made.mesh().clone(), made.metric().clone());
    for delay in [5, 50, 200] {
        let control = Control::new();
        let other = control.clone();
        std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(delay));
            other.cancel();
        });
        if made.solve(&Target::Uniform, &control).is_ok() {
            break;
        }
        let latency = control.since_cancel().unwrap();
        println!("solve: cancelled {latency:?} later");
        assert!(latency <= FACTORISATIONS * one, "solve: {latency:?}, a factorisation takes {one:?}");
        assert!(before == (made.mesh().clone(), made.metric().clone()));
    }
    made.solve(&Target::Uniform, &free).unwrap();
    let cut = cut_graph(made.mesh(), &made.metric().lengths(made.mesh()).unwrap(), &[], &free).unwrap();
    let options = LayoutOptions { opening: LayoutOpening::MetricCut(cut), ..LayoutOptions::default() };
    let layout = Layout::of_solution(&made.solution(), &options, &free).unwrap();
    let uv = |h| layout.uv(h);
    interrupt("charts", one, |c| charts(made.mesh(), uv, &ChartOptions::default(), c).map(drop));
    let triangles: Vec<_> = made.mesh().faces().map(|f| layout.face_uv(f)).collect();
    interrupt("overlapping", one, |c| overlapping(&triangles, c));
    let sides: Vec<[f64; 2]> = (1..3000).map(|k| [k as f64, 1.0 + (k % 7) as f64]).collect();
    interrupt("pack", one, |c| pack(&sides, 0.001, c));
}

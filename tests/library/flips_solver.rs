//! The solver with flips as an object: threads, cancellation, pins, ways there and back, and Delaunay by hand.

use crate::common::Random;
use crate::common::flips::{SCHEMES, honest, measure, reach, started};
use crate::common::flow::{attempt, distance, euclidean, prescribing_target, surface};
use ricci::flow::{Flips, Options, StopReason};
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{EdgeId, Mesh, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::{CommonSubdivision, Metric, Scheme, initial_metric};
use ricci::{Class, Control, Error, Flow, Target};
use std::f64::consts::PI;
use std::time::Duration;

type Surface = (Mesh, PerEdge<f64>);

fn noisy(mut soup: Soup, amplitude: f64) -> Surface {
    shapes::noise(&mut soup, amplitude, 9).unwrap();
    surface(&soup)
}

/// Random curvature at eight vertices inside, what is left of 2πχ at the others in equal shares.
fn cones(mesh: &Mesh, seed: u64) -> PerVertex<f64> {
    let mut random = Random::new(seed);
    let inside: Vec<VertexId> = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)).collect();
    let mut at: Vec<VertexId> = (0..8).map(|_| inside[random.below(inside.len())]).collect();
    at.sort_unstable();
    at.dedup();
    let k: Vec<f64> = at.iter().map(|_| 1.5 * PI * random.symmetric()).collect();
    let left = 2.0 * PI * mesh.euler() as f64 - k.iter().sum::<f64>();
    let mut target = PerVertex::filled(mesh.n_vertices(), left / (mesh.n_vertices() - at.len()) as f64);
    at.iter().zip(k).for_each(|(&v, k)| target[v] = k);
    target
}

fn everything(flow: &Flow) -> (Mesh, Metric, CommonSubdivision) {
    (Mesh::clone(flow.mesh()), flow.metric().clone(), flow.common_subdivision(&Control::new()).unwrap())
}

#[test]
fn after_a_solve_without_a_step_the_next_is_the_same_for_any_number_of_threads() {
    let (mesh, lengths) = noisy(shapes::torus(2.0, 0.8, 100, 50).unwrap(), 0.2);
    let surface = ricci::Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
    let run = |amplitude: f64, threads: usize| {
        let (options, control) = (Options { threads, ..Options::default() }, Control::new());
        let mut flow = Flow::new(surface.clone(), Class::yamabe(Space::E2), &options, &control).unwrap();
        let own = Target::All(flow.curvature().unwrap().at);
        assert_eq!(flow.solve(&own, &control).unwrap().report().unwrap().iterations, 0);
        // Far enough that edges flip before the first matrix, few of them or many.
        let mut random = Random::new(3);
        flow.set_u(PerVertex::from_fn(flow.mesh().n_vertices(), |_| amplitude * random.symmetric())).unwrap();
        let end = flow.solve(&Target::Uniform, &control).unwrap();
        assert!(end.converged() && end.report().unwrap().flips > 0);
        everything(&flow)
    };
    for amplitude in [1e-4, 1e-3, 2e-3, 5e-3, 2e-2] {
        assert!(run(amplitude, 1) == run(amplitude, 2), "{amplitude}");
    }
}

#[test]
fn the_result_is_the_same_bit_for_bit_for_any_number_of_threads() {
    let surfaces = [
        ("torus", noisy(shapes::torus(2.0, 0.8, 100, 50).unwrap(), 0.2)),
        ("genus 2", noisy(shapes::genus(2, 6).unwrap(), 0.1)),
        ("disk", noisy(shapes::disk(30).unwrap(), 0.2)),
    ];
    for (name, surface) in &surfaces {
        let spaces = [Some(Space::E2), (surface.0.euler() < 0).then_some(Space::H2)];
        for space in spaces.into_iter().flatten() {
            let target = match space {
                Space::E2 => cones(&surface.0, 5),
                _ => PerVertex::filled(surface.0.n_vertices(), 0.0),
            };
            for scheme in SCHEMES {
                let what = format!("{name} {space} {scheme}");
                let run = |threads: usize| {
                    let mut flow =
                        started(surface, (space, scheme), &Options { threads, ..Options::default() });
                    let report = reach(&mut flow, &target, &what);
                    assert!(flow.start_flips() > 0 && report.flips > 0, "{what}");
                    (everything(&flow), report.residuals, report.flips)
                };
                let one = run(1);
                assert!(run(2) == one && run(3) == one, "{what}");
            }
        }
    }
}

#[test]
fn a_cancelled_flow_leaves_everything_as_it_was() {
    let surface = noisy(shapes::torus(2.0, 0.8, 120, 60).unwrap(), 0.2);
    let (target, next) = (cones(&surface.0, 6), cones(&surface.0, 7));
    for scheme in SCHEMES {
        let kind = (Space::E2, scheme);
        let mut flow = started(&surface, kind, &Options::default());
        let start = everything(&flow);
        let before = Control::new();
        before.cancel();
        assert!(matches!(flow.solve(&Target::All(target.clone()), &before), Err(Error::Cancelled)));
        assert!(everything(&flow) == start, "{scheme}: cancelled before it began");
        reach(&mut flow, &target, "first target");
        let reached = everything(&flow);
        let mut reference = started(&surface, kind, &Options::default());
        reach(&mut reference, &target, "first target");
        let report = reach(&mut reference, &next, "second target");
        // At some moment of the second flow, the earliest ones first.
        let mut stopped = 0;
        for part in 0..8 {
            let control = Control::new();
            let result = std::thread::scope(|scope| {
                scope.spawn(|| {
                    std::thread::sleep(Duration::from_secs_f64(report.seconds.total * f64::from(part) / 8.0));
                    control.cancel();
                });
                flow.solve(&Target::All(next.clone()), &control)
            });
            match result {
                Err(error) => {
                    assert_eq!(error, Error::Cancelled);
                    assert!(everything(&flow) == reached, "{scheme}: cancelled in part {part}");
                    stopped += 1;
                }
                // It was faster than the first time.
                Ok(_) => break,
            }
        }
        println!("{scheme}: cancelled at {stopped} moments");
        assert!(stopped > 0);
        let mut again = started(&surface, kind, &Options::default());
        reach(&mut again, &target, "first target");
        reach(&mut again, &next, "second target");
        assert!(everything(&again) == everything(&reference), "{scheme}: after the cancellations");
    }
}

#[test]
fn without_flips_the_triangulation_stays() {
    let (mesh, lengths) = surface(&shapes::genus(2, 3).unwrap());
    let start = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2)).unwrap().metric;
    let target = Target::Single(VertexId(7)).values(&euclidean(&mesh, &lengths), Space::E2).unwrap();
    let options = |flips| Options { flips, ..Options::default() };
    let mut rigid = Flow::from_metric(mesh.clone(), start.clone(), &options(Flips::Never)).unwrap();
    let report = attempt(&mut rigid, &target);
    assert!(**rigid.mesh() == mesh && rigid.metric().eta == start.eta && report.flips == 0);
    assert!(!report.is_reached(), "this target needs flips");
    let mut free = Flow::from_metric(mesh.clone(), start, &options(Flips::Auto)).unwrap();
    let report = attempt(&mut free, &target);
    assert_eq!(report.stop_reason, StopReason::Converged);
    assert!(report.flips > 0 && **free.mesh() != mesh);
}

#[test]
fn fixed_edges_stay() {
    let (given, lengths) = surface(&shapes::punch(&shapes::genus(2, 4).unwrap(), 1).unwrap());
    let fixed: Vec<EdgeId> = given.edges().filter(|e| e.index() % 5 == 0).collect();
    let ends: Vec<[VertexId; 2]> = fixed.iter().map(|&e| given.ends(e)).collect();
    let surface = euclidean(&given, &lengths);
    let target = Target::Boundary;
    let begin = |fixed_edges| {
        let options = Options { fixed_edges, ..Options::default() };
        Flow::new(surface.clone(), Class::yamabe(Space::E2), &options, &Control::new())
    };
    let run = |fixed_edges| {
        let mut flow = begin(fixed_edges).unwrap();
        flow.solve(&target, &Control::new()).unwrap();
        flow
    };
    let kept = |flow: &Flow| {
        let sides = |e: EdgeId| [e.halfedge(), e.halfedge().twin()].map(|h| flow.mesh().prev(h));
        fixed.iter().zip(&ends).all(|(&e, ends)| flow.mesh().ends(e) == *ends && sides(e)[0] != sides(e)[1])
    };
    assert!(!kept(&run(Vec::new())) && kept(&run(fixed.clone())));
    let refused = begin(vec![EdgeId(given.n_edges() as u32)]);
    assert!(refused.is_err_and(|e| e.to_string().contains("fixed edge")));
}

#[test]
fn the_way_back_gives_the_first_metric_back() {
    let surfaces = [noisy(shapes::icosphere(6).unwrap(), 0.2), noisy(shapes::genus(2, 3).unwrap(), 0.1)];
    for surface in &surfaces {
        for space in [Some(Space::E2), (surface.0.euler() < 0).then_some(Space::H2)].into_iter().flatten() {
            for scheme in SCHEMES {
                let what = format!("χ = {} {space} {scheme}", surface.0.euler());
                let mut flow = started(surface, (space, scheme), &Options::default());
                let first = PerVertex::from(measure(flow.mesh(), flow.metric()).curvature);
                let sorted = |flow: &Flow| {
                    let mut lengths = flow.metric().lengths(flow.mesh()).unwrap().to_vec();
                    lengths.sort_by(f64::total_cmp);
                    lengths
                };
                let (u, lengths) = (flow.metric().u.clone(), sorted(&flow));
                let there = match space {
                    Space::E2 => cones(&surface.0, 8),
                    _ => PerVertex::filled(surface.0.n_vertices(), 0.0),
                };
                let flips = reach(&mut flow, &there, &what).flips + reach(&mut flow, &first, &what).flips;
                assert!(flips > 0);
                // u up to a constant in E².
                let shift =
                    if space == Space::E2 { flow.metric().u[0usize.into()] - u[0usize.into()] } else { 0.0 };
                let back: Vec<f64> = flow.metric().u.iter().map(|u| u - shift).collect();
                let scaled: Vec<f64> = sorted(&flow).iter().map(|l| l * (-shift).exp()).collect();
                let worst = [distance(&back, &u), distance(&scaled, &lengths)];
                println!("{what}: {flips} flips, u differs by {:.1e}, lengths by {:.1e}", worst[0], worst[1]);
                assert!(worst[0] < 1e-9 && worst[1] < 1e-9, "{what}: {worst:?}");
            }
        }
    }
}

#[test]
fn pinned_vertices_hold_while_edges_flip() {
    let disk = noisy(shapes::disk(12).unwrap(), 0.2);
    let torus = noisy(shapes::torus(2.0, 0.7, 24, 12).unwrap(), 0.2);
    let boundary: Vec<VertexId> = disk.0.vertices().filter(|&v| disk.0.is_boundary_vertex(v)).collect();
    let cases = [("disk", disk, boundary), ("torus", torus, [0, 50, 51, 200].map(VertexId).to_vec())];
    for (name, surface, pins) in &cases {
        let mesh = &surface.0;
        for scheme in SCHEMES {
            let what = format!("{name} {scheme}");
            let options = Options { pinned: pins.clone(), ..Options::default() };
            let mut flow = started(surface, (Space::E2, scheme), &options);
            let start = flow.metric().u.clone();
            let mut target = cones(mesh, 9);
            let report = attempt(&mut flow, &target);
            assert!(flow.double().is_none() && flow.start_flips() + report.flips > 0, "{what}");
            assert!(pins.iter().all(|&v| flow.metric().u[v] == start[v]), "{what}");
            // Their curvature is free.
            let found = measure(flow.mesh(), flow.metric());
            pins.iter().for_each(|&v| target[v] = found.curvature[v.index()]);
            let reached = honest(&flow, &report, &target, &what);
            println!("{what}: {} after {}, {} flips", report.stop_reason, report.iterations, report.flips);
            assert!(reached, "{what}: {:?}", report.stop_reason);
            let edges: Vec<_> = mesh.edges().filter(|e| mesh.face(e.halfedge().twin()).is_none()).collect();
            assert!(edges.iter().all(|&e| flow.mesh().face(e.halfedge().twin()).is_none()), "{what}");
        }
    }
}

#[test]
fn imaginary_circles_flip_as_far_as_they_can_and_claim_no_more() {
    let surfaces = [
        ("sphere", noisy(shapes::icosphere(5).unwrap(), 0.2)),
        ("torus", noisy(shapes::torus(2.0, 0.8, 20, 10).unwrap(), 0.2)),
        ("genus 2", noisy(shapes::genus(2, 3).unwrap(), 0.1)),
        ("disk", noisy(shapes::disk(8).unwrap(), 0.2)),
    ];
    for (name, surface) in &surfaces {
        for space in [Some(Space::E2), (surface.0.euler() < 0).then_some(Space::H2)].into_iter().flatten() {
            let given = euclidean(&surface.0, &surface.1);
            let default = prescribing_target(&given, space).values(&given, space).unwrap();
            let mut targets = vec![("default", default)];
            targets.extend((space == Space::E2).then(|| ("cones", cones(&surface.0, 10))));
            for (kind, target) in targets {
                let what = format!("{name} {space} {kind}");
                let mut flow = started(surface, (space, Scheme::Virtual), &Options::default());
                let report = attempt(&mut flow, &target);
                let reached = honest(&flow, &report, &target, &what);
                println!(
                    "virtual, {what}: {} after {}, {} flips",
                    report.stop_reason, report.iterations, report.flips
                );
                // Whatever came of it, the report says what the metric is.
                let (found, wanted) =
                    (measure(flow.mesh(), flow.metric()), flow.spread_target(&target).unwrap());
                assert_eq!(found.broken, report.broken_triangles, "{what}");
                let off = |v: VertexId| (found.curvature[v.index()] - wanted[v]).abs();
                let error = flow.mesh().vertices().map(off).fold(0.0, f64::max);
                let rounding = found.rounding.iter().copied().fold(1e-12, f64::max);
                let agree = (error - report.max_curvature_error).abs() <= rounding;
                // A broken triangle has no angles in the measurement.
                assert!(
                    agree || found.broken > 0,
                    "{what}: {error}, reported {}",
                    report.max_curvature_error
                );
                assert!(flow.start_flips() + report.flips > 0, "{what}");
                // Near the start's own curvature the class has the metric.
                let near = kind == "default" && *name != "sphere";
                assert!(reached || !near, "{what}: {}", report.stop_reason);
            }
        }
    }
}

/// Largest power, with respect to the circle orthogonal to those around a face's corners, that the circle beyond a side has below
/// zero: relative to the squared size of the two triangles, laid out in the plane.
fn deepest(flow: &Flow) -> f64 {
    let (mesh, metric) = (flow.mesh(), flow.metric());
    let lengths = metric.lengths(mesh).unwrap();
    let square = |v: VertexId| f64::from(metric.epsilon[v]) * metric.radii().unwrap()[v].powi(2);
    let squares: PerVertex<f64> = PerVertex::from_fn(mesh.n_vertices(), square);
    let mut worst = 0.0f64;
    for e in mesh.edges() {
        let h = e.halfedge();
        if mesh.is_outside(h) || mesh.is_outside(h.twin()) || mesh.face(h) == mesh.face(h.twin()) {
            continue;
        }
        let apex = |h| {
            let [base, left, right] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
            let x = (base * base + right * right - left * left) / (2.0 * base);
            [x, (right * right - x * x).max(0.0).sqrt()]
        };
        let base = lengths[e];
        let (k, l) = (apex(h), apex(h.twin()));
        let l = [base - l[0], -l[1]];
        let [i, j] = [mesh.origin(h), mesh.tip(h)].map(|v| squares[v]);
        let [sk, sl] = [mesh.prev(h), mesh.prev(h.twin())].map(|h| squares[mesh.origin(h)]);
        // Centre (x, y) and power p of the orthogonal circle: |c − q|² − s_q = p at the three corners.
        let x = (base * base + i - j) / (2.0 * base);
        let p_at = |y: f64| x * x + y * y - i;
        // |c − k|² − s_k = |c|² − i  ⇒  2 c·k = |k|² − s_k + i.
        let y = (k[0] * k[0] + k[1] * k[1] - sk + i - 2.0 * x * k[0]) / (2.0 * k[1]);
        let beyond = (x - l[0]).powi(2) + (y - l[1]).powi(2) - sl - p_at(y);
        let size = p_at(y).abs() + (x - l[0]).powi(2) + (y - l[1]).powi(2) + base * base;
        worst = worst.max(-beyond / size);
    }
    worst
}

#[test]
fn the_final_triangulation_is_weighted_delaunay_by_the_circles_themselves() {
    let long = shapes::torus(2.0, 0.8, 40, 8).unwrap();
    for surface in [noisy(long, 0.2), noisy(shapes::genus(2, 3).unwrap(), 0.1)] {
        for scheme in SCHEMES {
            let mut flow = started(&surface, (Space::E2, scheme), &Options::default());
            let start = deepest(&flow);
            let report = reach(&mut flow, &cones(&surface.0, 11), "cones");
            println!(
                "{scheme}: {start:.1e} at the start, {:.1e} after {} flips",
                deepest(&flow),
                report.flips
            );
            assert!(start < 1e-9 && deepest(&flow) < 1e-9, "{scheme}");
            let never = Options { flips: Flips::Never, ..Options::default() };
            assert!(
                deepest(&started(&surface, (Space::E2, scheme), &never)) > 1e-2,
                "{scheme}: no flip is due"
            );
        }
    }
}

#[test]
fn flows_that_go_on_from_a_metric_end_where_new_ones_do() {
    for soup in [shapes::genus(1, 3).unwrap(), shapes::punch(&shapes::genus(1, 3).unwrap(), 2).unwrap()] {
        let (given, lengths) = surface(&soup);
        let whole = euclidean(&given, &lengths);
        let rule = if given.is_closed() { Target::Uniform } else { Target::Boundary };
        let first = rule.values(&whole, Space::E2).unwrap();
        let inside: Vec<VertexId> = given.vertices().filter(|&v| !given.is_boundary_vertex(v)).collect();
        let mut second = first.clone();
        (second[inside[3]], second[inside[40]]) = (1.5, -1.5);
        for scheme in SCHEMES {
            let options = Options::default();
            let class = Class::new(scheme, Space::E2);
            let begin = || Flow::new(whole.clone(), class, &options, &Control::new()).unwrap();
            let (mut straight, mut aside) = (begin(), begin());
            assert!(attempt(&mut straight, &second).converged());
            assert!(attempt(&mut aside, &first).converged());
            let halfway = aside.solution();
            assert!(halfway.double().is_none() || !given.is_closed());
            let k = halfway.curvature().unwrap().at;
            assert!(given.vertices().all(|v| (k[v] - first[v]).abs() < 1e-9));
            let mut resumed = Flow::resume(&halfway, &options, &Control::new()).unwrap();
            assert!(attempt(&mut resumed, &second).converged());
            let (a, b) = (straight.solution(), resumed.solution());
            assert!(b.flips() >= halfway.flips() && a.start_flips() == b.start_flips());
            let [a, b] = [a, b].map(|end| end.conformal_factor().unwrap());
            // Up to scale.
            let shift = a[inside[0]] - b[inside[0]];
            let worst = given.vertices().map(|v| (a[v] - b[v] - shift).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-8, "{scheme}: {worst}");

            // Without flips the triangulation stays where it is; other fixed edges begin anew.
            let never = Options { flips: Flips::Never, ..Options::default() };
            let mut rigid = Flow::resume(&halfway, &never, &Control::new()).unwrap();
            attempt(&mut rigid, &first);
            assert!(rigid.solution().mesh() == halfway.mesh() && rigid.solution().flips() == halfway.flips());
            let fixed = Options { fixed_edges: given.edges().collect(), ..Options::default() };
            let anew = Flow::resume(&halfway, &fixed, &Control::new()).unwrap().solution();
            assert!(anew.flips() == 0 && anew.is_unflipped());
        }
    }
}

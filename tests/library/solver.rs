//! The solver as an object: kept, pinned, cancelled, after a failure, and at the ends of its domain.

use crate::common::flow::{attempt, converged, distance, euclidean, rigid, solve, surface};
use ricci::control::Stage;
use ricci::flow::{Flips, Gradient, Method, Options, StepRule, StopReason};
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::mesh::{PerEdge, PerVertex, VertexId};
use ricci::metric::initial::{MixedClass, initial_mixed};
use ricci::metric::{Scheme, initial_metric};
use ricci::{Class, Control, Error, Flow, Surface, Target};
use std::f64::consts::PI;

#[test]
fn a_kept_solver_gives_what_a_fresh_one_gives() {
    let (mesh, lengths) = surface(&shapes::torus(2.0, 0.9, 20, 12).unwrap());
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::inversive(Space::E2)).unwrap();
    let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &rigid()).unwrap();
    for (a, b) in [(0, 100), (17, 30), (200, 5)] {
        let cones = Target::Cones(vec![(VertexId(a), 1.0), (VertexId(b), -1.0)]);
        let target = cones.resolve(&euclidean(&mesh, &lengths), Class::inversive(Space::E2)).unwrap();
        let report = attempt(&mut flow, &target);
        converged(&report);
        let (fresh, _) = solve(&mesh, &initial.metric, &target, &rigid());
        assert!(distance(&flow.metric().u, &fresh.u) < 1e-9);
    }
}

#[test]
fn a_failed_solve_does_not_spoil_the_next() {
    let (mesh, lengths) = surface(&shapes::torus(2.0, 0.9, 20, 12).unwrap());
    for scheme in [Scheme::Yamabe, Scheme::Inversive, Scheme::Tangential] {
        let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::E2)).unwrap();
        let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &rigid()).unwrap();
        // Two neighbours below the bound that holds for them together.
        let mut target = PerVertex::filled(mesh.n_vertices(), 6.2 * PI / (mesh.n_vertices() - 2) as f64);
        let [a, b] = mesh.ends(7usize.into());
        (target[a], target[b]) = (-3.1 * PI, -3.1 * PI);
        let failed = attempt(&mut flow, &target);
        assert!(!failed.is_reached(), "{scheme}");
        let flat = PerVertex::filled(mesh.n_vertices(), 0.0);
        let after = attempt(&mut flow, &flat);
        converged(&after);
        let (fresh, report) = solve(&mesh, &initial.metric, &flat, &rigid());
        assert_eq!((&flow.metric().u, after.iterations), (&fresh.u, report.iterations), "{scheme}");
    }
}

#[test]
fn a_total_that_is_off_by_rounding_is_shared_and_reached() {
    let (mesh, lengths) = surface(&shapes::icosphere(4).unwrap());
    // Four cones of π written with nine decimals.
    let written = (1e9 * PI).round() / 1e9;
    let cones = Target::Cones([0, 1, 2, 3].map(|v| (VertexId(v), written)).to_vec());
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::inversive(Space::E2)).unwrap();
    let values = cones.values(&euclidean(&mesh, &lengths), Space::E2).unwrap();
    assert!((values.iter().sum::<f64>() - 4.0 * PI).abs() > 1e-9);
    let (_, report) = solve(&mesh, &initial.metric, &values, &rigid());
    converged(&report);
    let resolved = cones.resolve(&euclidean(&mesh, &lengths), Class::inversive(Space::E2)).unwrap();
    assert!((resolved.iter().sum::<f64>() - 4.0 * PI).abs() < 1e-14);
    assert!(mesh.vertices().skip(4).all(|v| resolved[v] == 0.0));
}

#[test]
fn pinned_vertices_keep_u_and_the_rest_reach_their_curvature() {
    let (mesh, lengths) = surface(&shapes::disk(6).unwrap());
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2)).unwrap();
    let boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &rigid()).unwrap();
    flow.pin(&boundary, &Control::new()).unwrap();
    // u = log |f'| of the conformal map f(z) = z + z²/5, on the boundary.
    let factor = |v: VertexId, soup: &Soup| {
        let [x, y, _] = soup.positions[v.index()];
        (1.0 + 0.4 * x).hypot(0.4 * y).ln()
    };
    let soup = shapes::disk(6).unwrap();
    let u = PerVertex::from_fn(mesh.n_vertices(), |v| {
        if mesh.is_boundary_vertex(v) { factor(v, &soup) } else { 0.0 }
    });
    flow.set_u(u.clone()).unwrap();
    let report = attempt(&mut flow, &PerVertex::filled(mesh.n_vertices(), 0.0));
    converged(&report);
    assert!(boundary.iter().all(|&v| flow.metric().u[v] == u[v]));
    // The flat metric inside is that of f up to the discretisation: h² = 1/36.
    for v in mesh.vertices() {
        assert!((flow.metric().u[v] - factor(v, &soup)).abs() < 0.02, "vertex {v}");
    }
}

#[test]
fn pinned_vertices_keep_u_in_every_space_and_by_every_method() {
    let (mesh, lengths) = surface(&shapes::ellipsoid([1.0, 1.1, 0.9], 3).unwrap());
    let pins = [VertexId(0), VertexId(5), VertexId(17)];
    for space in [Space::E2, Space::H2, Space::S2] {
        for area_normalised in [false, true] {
            for method in [Method::Newton, Method::Gradient] {
                let initial = initial_metric(&mesh, &lengths, Space::E2, Class::inversive(space)).unwrap();
                let gradient = Gradient { area_normalised, ..Gradient::default() };
                let options = Options { method, gradient, max_iterations: 50, ..rigid() };
                let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &options).unwrap();
                flow.pin(&pins, &Control::new()).unwrap();
                // Near the curvature that the start has.
                let mut target = initial.metric.curvature(&mesh).unwrap().at;
                target.iter_mut().enumerate().for_each(|(v, k)| *k += 0.01 * (v as f64).sin());
                let report = attempt(&mut flow, &target);
                assert!(
                    pins.iter().all(|&v| flow.metric().u[v] == initial.metric.u[v]),
                    "{space} {method:?}"
                );
                assert!(report.iterations > 0);
                assert!(report.worst.iter().all(|(v, _)| !pins.contains(v)));
                if method == Method::Newton && space != Space::S2 {
                    converged(&report);
                }
            }
        }
    }
    // Every vertex pinned: nothing to do, nothing to miss.
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2)).unwrap();
    let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &rigid()).unwrap();
    flow.pin(&mesh.vertices().collect::<Vec<_>>(), &Control::new()).unwrap();
    let report = attempt(&mut flow, &PerVertex::filled(mesh.n_vertices(), 0.0));
    assert_eq!((report.stop_reason, report.iterations), (StopReason::Converged, 0));
    assert_eq!(flow.metric(), &initial.metric);
}

#[test]
fn an_open_surface_in_the_hyperbolic_plane_has_the_area_of_gauss_and_bonnet() {
    let (mesh, lengths) = surface(&shapes::disk(5).unwrap());
    let boundary = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).count();
    let share = (2.0 * PI + 0.8) / boundary as f64;
    let target =
        PerVertex::from_fn(mesh.n_vertices(), |v| if mesh.is_boundary_vertex(v) { share } else { 0.0 });
    for scheme in Scheme::ALL {
        let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::H2)).unwrap();
        let (metric, report) = solve(&mesh, &initial.metric, &target, &rigid());
        converged(&report);
        assert!((metric.curvature(&mesh).unwrap().area - 0.8).abs() < 1e-9, "{scheme}");
    }
}

#[test]
fn the_unit_of_length_does_not_matter_as_far_as_doubles_go() {
    let (mesh, lengths) = surface(&shapes::torus(2.0, 0.9, 20, 12).unwrap());
    let target = PerVertex::filled(mesh.n_vertices(), 0.0);
    for scheme in [Scheme::Yamabe, Scheme::Inversive, Scheme::Thurston] {
        let result = |exponent: i32| {
            let lengths = PerEdge::from_fn(mesh.n_edges(), |e| lengths[e] * 2f64.powi(exponent));
            let start =
                initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::E2)).unwrap().metric;
            let (metric, report) = solve(&mesh, &start, &target, &rigid());
            converged(&report);
            let lengths = metric.lengths(&mesh).unwrap();
            PerEdge::from_fn(mesh.n_edges(), |e| lengths[e] / lengths[0usize.into()])
        };
        let one = result(0);
        for exponent in [-450, -40, 40, 450] {
            assert!(distance(&result(exponent), &one) < 1e-11, "{scheme} {exponent}");
        }
    }
    let far = PerEdge::from_fn(mesh.n_edges(), |e| lengths[e] * 1e-160);
    let error = initial_metric(&mesh, &far, Space::E2, Class::yamabe(Space::E2)).unwrap_err();
    assert!(matches!(error, Error::EdgeLength { edge: 0, .. }), "{error}");
}

#[test]
fn imaginary_circles_have_a_radius_for_every_u() {
    // In H² and E² the domain of ε = −1 is all u; radii and the conformal factor are finite there.
    let (mesh, lengths) = surface(&shapes::icosphere(1).unwrap());
    for space in [Space::E2, Space::H2] {
        let n = mesh.n_vertices();
        let (epsilon, radii) = (PerVertex::filled(n, -1), PerVertex::filled(n, 0.3));
        let initial =
            initial_mixed(&mesh, &lengths, Space::E2, MixedClass { epsilon, radii, space }).unwrap();
        for shift in [-3.0, 0.0, 0.1, 2.0] {
            let mut metric = initial.metric.clone();
            metric.u.iter_mut().for_each(|u| *u = shift);
            assert!(metric.radii().unwrap().iter().all(|r| *r > 0.0 && r.is_finite()), "{space} {shift}");
            let factor = initial.conformal_factor(&metric).unwrap();
            assert!(factor.iter().all(|f| f.is_finite()), "{space} {shift}");
        }
    }
}

#[test]
fn cancelling_stops_the_flow_and_leaves_the_metric() {
    let (mesh, lengths) = surface(&shapes::genus(2, 6).unwrap());
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::H2)).unwrap();
    let mut flow = Flow::from_metric(mesh.clone(), initial.metric.clone(), &rigid()).unwrap();
    let control = Control::new();
    control.cancel();
    let target = PerVertex::filled(mesh.n_vertices(), 0.0);
    let cancelled = flow.solve(&Target::All(target.clone()), &control);
    assert!(matches!(cancelled, Err(Error::Cancelled)));
    assert_eq!(flow.metric(), &initial.metric);
    converged(&attempt(&mut flow, &target));
}

#[test]
fn cancelling_from_another_thread_ends_a_running_flow() {
    let (mesh, lengths) = surface(&shapes::torus(2.0, 0.9, 300, 150).unwrap());
    let surface = euclidean(&mesh, &lengths);
    // The stable gradient flow needs far longer than the test is willing to wait.
    let gradient = Gradient { step: StepRule::Stable, ..Gradient::default() };
    let options = Options { method: Method::Gradient, gradient, ..rigid() };
    let control = Control::new();
    let outcome = std::thread::scope(|scope| {
        let run = scope.spawn(|| {
            ricci::flow::flow(surface, Class::inversive(Space::E2), &Target::Uniform, &options, &control)
        });
        while control.progress().0 == Stage::Idle {
            std::thread::yield_now();
        }
        control.cancel();
        run.join().unwrap()
    });
    println!("{} vertices: {:?} after the cancellation", mesh.n_vertices(), control.since_cancel().unwrap());
    assert!(matches!(outcome, Err(Error::Cancelled)));
}

#[test]
fn later_steps_take_the_first_factor_and_converge_quadratically_all_the_same() {
    let mut soup = shapes::torus(2.0, 0.9, 80, 40).unwrap();
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    for scheme in [Scheme::Yamabe, Scheme::Inversive] {
        for flips in [Flips::Never, Flips::Auto] {
            let options = Options { flips, threads: 1, ..Options::default() };
            let flow = |options: &Options| {
                let class = Class::new(scheme, Space::E2);
                ricci::flow::flow(surface.clone(), class, &Target::Uniform, options, &Control::new()).unwrap()
            };
            let solution = flow(&options);
            let report = solution.report().unwrap();
            converged(report);
            assert!(report.iterations >= 3 && report.factorisations == 1, "{scheme}: {report:?}");
            assert!(flips == Flips::Never || solution.flips() > 100, "{scheme}");
            // The constant is below 1 in the first step; a linear rate would be off by orders of magnitude.
            for pair in report.residuals.windows(2).filter(|pair| pair[1] > 1e-13) {
                assert!(pair[1] < 2.0 * pair[0] * pair[0], "{scheme}: {:?}", report.residuals);
            }
            let two = flow(&Options { threads: 2, ..options });
            assert_eq!(two.metric(), solution.metric(), "{scheme}: another number of threads");
        }
    }
}

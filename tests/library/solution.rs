//! Tests the solution and the report of a flow: the tolerance asked for, rounding floors, cones, and the same from one line as from
//! the object.

use crate::common::Random;
use crate::common::flips::{SCHEMES, honest};
use ricci::flow::{FlowSeconds, Options, Report, StopReason, flow};
use ricci::geometry::Space;
use ricci::mesh::{PerVertex, VertexId, shapes};
use ricci::metric::Scheme;
use ricci::{Class, Control, Flow, Solution, Surface, Target};
use std::f64::consts::PI;

fn solved(surface: &Surface, class: Class, target: &Target, options: &Options) -> Solution {
    flow(surface.clone(), class, target, options, &Control::new()).unwrap()
}

/// The report without its times, which differ from run to run.
fn timeless(solution: &Solution) -> Report {
    Report { seconds: FlowSeconds::default(), ..solution.report().unwrap().clone() }
}

/// Inversive distance in H² is carried in doubles: no metric has less error than about 1e-15.
#[test]
fn a_rounding_floor_above_the_tolerance_is_not_called_converged() {
    let surface = Surface::from_soup(&shapes::genus(2, 3).unwrap()).unwrap();
    for scheme in [Scheme::Inversive, Scheme::Thurston] {
        let class = Class::new(scheme, Space::H2);
        let options = Options { tolerance: 1e-17, ..Options::default() };
        let solution = solved(&surface, class, &Target::Uniform, &options);
        let report = solution.report().unwrap();
        let StopReason::RoundingFloor { size } = report.stop_reason else { panic!("{scheme}: {report:?}") };
        println!("{scheme}: error {:.1e}, floor {size:.1e}", report.max_curvature_error);
        assert!(!report.converged() && !solution.converged() && report.is_reached(), "{scheme}");
        assert_eq!((report.tolerance, report.allowed_error()), (1e-17, size), "{scheme}");
        assert_eq!(report.stop_reason.name(), "rounding_floor");
        assert!(1e-17 < report.max_curvature_error && report.max_curvature_error <= size, "{report:?}");
        assert!(size < 1e-11, "{scheme}: {size:e}");
        // The same metric is within a tolerance above the floor, and then the flow has converged.
        let options = Options::default();
        let solution = solved(&surface, class, &Target::Uniform, &options);
        assert!(solution.converged() && solution.report().unwrap().is_reached(), "{scheme}");
        assert_eq!(solution.report().unwrap().allowed_error(), options.tolerance);
    }
}

#[test]
fn one_line_gives_what_the_object_gives() {
    let mut soup = shapes::disk(8).unwrap();
    shapes::noise(&mut soup, 0.3, 9).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    let (target, options, control) = (Target::Boundary, Options::default(), Control::new());
    for scheme in SCHEMES {
        let class = Class::new(scheme, Space::E2);
        let one = solved(&surface, class, &target, &options);
        let mut made = Flow::new(surface.clone(), class, &options, &control).unwrap();
        let other = made.solve(&target, &control).unwrap();
        assert!(one.double().is_some() && one.flips() > 0, "{scheme}: needs its double and flips");
        let values = target.values(&surface, Space::E2).unwrap();
        assert!(honest(&made, other.report().unwrap(), &values, "rough disk"), "{scheme}");
        assert!(one.mesh() == other.mesh() && one.metric() == other.metric(), "{scheme}");
        let bits = |s: &Solution| s.metric().u.iter().map(|u| u.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one), bits(&other), "{scheme}");
        assert_eq!(timeless(&one), timeless(&other), "{scheme}");
        assert_eq!((one.flips(), one.cones()), (other.flips(), other.cones()));
        assert!(
            one.common_subdivision(&control).unwrap() == other.common_subdivision(&control).unwrap(),
            "{scheme}"
        );
    }
}

#[test]
fn cones_are_named_or_truly_curved() {
    let sphere = Surface::from_soup(&shapes::icosphere(4).unwrap()).unwrap();
    let (class, options) = (Class::yamabe(Space::E2), Options::default());
    let cones = [0, 3, 7, 11].map(VertexId);
    // Four cones of π, and noise of 1e-17 everywhere else.
    let mut random = Random::new(3);
    let mut noisy = PerVertex::from_fn(sphere.mesh().n_vertices(), |_: VertexId| 1e-17 * random.symmetric());
    cones.into_iter().for_each(|v| noisy[v] = PI);
    assert!(noisy.iter().all(|&k| k != 0.0));
    let solution = solved(&sphere, class, &Target::All(noisy), &options);
    assert!(solution.converged());
    assert_eq!(solution.cones(), cones);
    // A vertex that is named is a cone, whatever its curvature.
    let mut named: Vec<_> = cones.into_iter().map(|v| (v, PI)).collect();
    named.push((VertexId(20), 0.0));
    let solution = solved(&sphere, class, &Target::Cones(named), &options);
    assert_eq!(solution.cones(), [0, 3, 7, 11, 20].map(VertexId));
    // Curvature of a boundary is no cone, and a metric that no flow has made has none.
    let disk = Surface::from_soup(&shapes::disk(4).unwrap()).unwrap();
    assert!(solved(&disk, class, &Target::Boundary, &options).cones().is_empty());
    let start = Solution::initial_of(sphere, class).unwrap();
    assert!(start.cones().is_empty() && start.report().is_none() && !start.converged());
}

#[test]
fn closed_hyperbolic_surfaces_are_smooth_to_twice_the_digits() {
    let options = Options::default();
    for genus in [2, 3] {
        let surface = Surface::from_soup(&shapes::genus(genus, 3).unwrap()).unwrap();
        let solution = solved(&surface, Class::yamabe(Space::H2), &Target::Uniform, &options);
        let report = solution.report().unwrap();
        let reported = report.angle_defect.unwrap();
        println!("genus {genus}: {reported:.1e}");
        assert!(report.converged() && reported <= 1e-28, "genus {genus}: {reported:e}");
        // It is that of the metric.
        let found = solution.metric().angle_defects(solution.mesh()).unwrap();
        let found = found.iter().fold(0.0f64, |most, &k| most.max(k.abs()));
        assert_eq!(found, reported, "genus {genus}");
    }
    // Other targets end where doubles do.
    let surface = Surface::from_soup(&shapes::genus(2, 3).unwrap()).unwrap();
    let flat = solved(&surface, Class::yamabe(Space::E2), &Target::Uniform, &options);
    assert_eq!(flat.report().unwrap().angle_defect, None);
}

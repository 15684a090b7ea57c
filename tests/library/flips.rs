//! Tests on the corpus that edge flips make every admissible target reachable.

use crate::common::flips::{SCHEMES, reach, started};
use crate::common::flow::{attempt, default_target, euclidean, small_meshes};
use ricci::flow::{Options, Report};
use ricci::geometry::Space;
use ricci::mesh::{PerVertex, VertexId};
use ricci::metric::delaunay::{IntrinsicOptions, Triangulated, failing, intrinsic_delaunay};
use ricci::metric::{Scheme, curvature};
use ricci::{Class, Control, Flow, Target};

/// Largest mesh that tests take, so that they are quick in a debug build too.
const MOST_VERTICES: usize = 3000;

/// Converged, and the metric, measured anew, has the curvature, whole triangles and a Delaunay triangulation.
fn check(flow: &Flow, report: &Report, target: &PerVertex<f64>, what: &str) {
    assert!(report.is_reached(), "{what}: {} after {} steps", report.stop_reason, report.iterations);
    let (mesh, metric, target) = (flow.mesh(), flow.metric(), flow.spread_target(target).unwrap());
    mesh.validate().unwrap();
    let k = curvature(mesh, metric.space, &metric.lengths(mesh).unwrap()).unwrap();
    assert!(k.broken.is_empty(), "{what}");
    assert!(k.gauss_bonnet < 1e-10, "{what}: {}", k.gauss_bonnet);
    // Lengths are rounded; the report's own error is formed from u.
    let worst = mesh.vertices().map(|v| (k.at[v] - target[v]).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-8 && report.max_curvature_error <= report.allowed_error(), "{what}: {worst}");
    assert!(failing(mesh, metric).is_empty(), "{what}");
}

#[test]
fn every_closed_mesh_reaches_its_uniform_metric() {
    let mut steps = Vec::new();
    for (name, mesh, lengths, _) in
        small_meshes(MOST_VERTICES).into_iter().filter(|(_, mesh, ..)| mesh.is_closed())
    {
        for scheme in SCHEMES {
            for space in [Space::E2, Space::H2].into_iter().filter(|s| *s == Space::E2 || mesh.genus() >= 2) {
                let target = default_target(&mesh, &lengths, space, scheme);
                let mut flow =
                    started(&(mesh.clone(), lengths.clone()), (space, scheme), &Options::default());
                let report = attempt(&mut flow, &target);
                check(&flow, &report, &target, &format!("{name} {space} {scheme}"));
                steps.push(report.iterations);
            }
        }
    }
    steps.sort_unstable();
    if let Some(most) = steps.last() {
        println!("{} flows, steps: median {}, most {most}", steps.len(), steps[steps.len() / 2]);
        assert!(steps[steps.len() / 2] <= 8 && *most <= 50);
    }
}

#[test]
fn every_open_mesh_becomes_flat_through_its_double() {
    for (name, half, lengths, _) in
        small_meshes(MOST_VERTICES).into_iter().filter(|(_, mesh, ..)| !mesh.is_closed())
    {
        let given = euclidean(&half, &lengths);
        let surface = (half, lengths);
        for scheme in SCHEMES {
            let target = Target::Boundary.resolve(&given, Class::new(scheme, Space::E2));
            // A packing's own limit at a vertex of one triangle is that of the input triangulation: flips lift it.
            let Ok(target) = target else { continue };
            let mut flow = started(&surface, (Space::E2, scheme), &Options::default());
            let report = attempt(&mut flow, &target);
            let what = format!("{name} {scheme}");
            check(&flow, &report, &target, &what);
            let Some(double) = flow.double() else { continue };
            // The solution is unique, and so symmetric.
            let u = &flow.metric().u;
            let range = u.iter().fold(0.0f64, |m, u| m.max(u.abs())).max(1.0);
            for v in flow.mesh().vertices() {
                let difference = (u[v] - u[double.mirror(v)]).abs();
                assert!(difference < 1e-6 * range, "{what}: {difference} at {v}");
            }
        }
    }
}

#[test]
fn rounding_that_differs_between_mirror_images_does_not_hold_the_error() {
    // All of 2πχ at one vertex of a surface with 106 boundary loops: a hundred thousand flips on each half of the double, in another
    // order, leave η so different that symmetric steps alone stop at 1e-5.
    let found = small_meshes(MOST_VERTICES).into_iter().find(|(name, ..)| name == "elephant_with_holes.obj");
    let Some((name, mesh, lengths, _)) = found else { return };
    let target = Target::Single(VertexId(0));
    let target = target.resolve(&euclidean(&mesh, &lengths), Class::yamabe(Space::E2)).unwrap();
    let mut flow = started(&(mesh, lengths), (Space::E2, Scheme::Yamabe), &Options::default());
    let report = reach(&mut flow, &target, &name);
    println!("{name}: {} steps, {} flips", report.iterations, report.flips);
    assert!(report.flips > 100_000, "{}", report.flips);
}

#[test]
fn intrinsic_delaunay_keeps_the_surface() {
    let flipped = |surface: &mut Triangulated| {
        intrinsic_delaunay(surface, IntrinsicOptions::default(), &mut |_, _| {}, &Control::new()).unwrap()
    };
    for (name, mesh, lengths, _) in small_meshes(MOST_VERTICES) {
        let before = curvature(&mesh, Space::E2, &lengths).unwrap();
        let mut surface = Triangulated { mesh, lengths, geometry: Space::E2 };
        flipped(&mut surface);
        let Triangulated { mesh, lengths, .. } = &surface;
        let after = curvature(mesh, Space::E2, lengths).unwrap();
        assert!(after.broken.is_empty(), "{name}");
        assert!((after.area / before.area - 1.0).abs() < 1e-9, "{name}: {} {}", before.area, after.area);
        let worst = mesh.vertices().map(|v| (before.at[v] - after.at[v]).abs()).fold(0.0, f64::max);
        // Needles of the input leave their rounding.
        assert!(worst < 1e-5, "{name}: {worst}");
        assert_eq!(flipped(&mut surface), 0, "{name}");
    }
}

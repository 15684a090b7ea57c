//! Tests which targets have a metric: admissibility before the flow, and the report of a flow that cannot succeed.

use crate::common::Random;
use crate::common::flow::{converged, euclidean, rigid, solve, surface};
use ricci::flow::StopReason;
use ricci::geometry::Space;
use ricci::mesh::shapes;
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::{Scheme, curvature, initial_metric};
use ricci::{Class, Error, Surface, Target};
use std::f64::consts::PI;

#[test]
fn inadmissible_targets_are_refused_with_the_amount() {
    let sphere = Surface::from_soup(&shapes::icosphere(2).unwrap()).unwrap();
    let resolve = |target: Target, space| target.resolve(&sphere, Class::yamabe(space)).unwrap_err();
    match resolve(Target::Cones(vec![(VertexId(3), 7.0)]), Space::E2) {
        Error::TargetAtVertex { vertex: 3, excess, .. } => assert!((excess - (7.0 - 2.0 * PI)).abs() < 1e-14),
        other => panic!("{other}"),
    }
    match resolve(Target::Cones(vec![(VertexId(0), 4.0), (VertexId(1), 4.0), (VertexId(2), 4.0)]), Space::E2)
    {
        Error::TargetTotal { miss, .. } => assert!((miss - (12.0 - 4.0 * PI)).abs() < 1e-13),
        other => panic!("{other}"),
    }
    assert!(matches!(resolve(Target::Uniform, Space::H2), Error::TargetTotal { .. }));
    assert!(matches!(resolve(Target::Boundary, Space::E2), Error::TargetKind { target: "boundary", .. }));
    assert!(matches!(
        resolve(Target::Single(VertexId(0)), Space::H2),
        Error::TargetKind { target: "single", .. }
    ));
    assert!(matches!(resolve(Target::Cones(vec![(VertexId(99), 1.0)]), Space::E2), Error::TargetKind { .. }));
    let twice = vec![(VertexId(1), 1.0), (VertexId(2), -2.0), (VertexId(1), 1.0)];
    assert!(resolve(Target::Cones(twice), Space::E2).to_string().contains("vertex 1 is named twice"));
    // A vertex of five triangles cannot have curvature below 2π − 5π in a packing.
    let low = Target::Cones(vec![
        (VertexId(0), -10.0),
        (VertexId(20), 5.0),
        (VertexId(21), 5.0),
        (VertexId(22), 5.0),
        (VertexId(23), 5.0),
    ]);
    let error = low.resolve(&sphere, Class::new(Scheme::Tangential, Space::E2)).unwrap_err();
    assert!(matches!(error, Error::TargetBelow { vertex: 0, .. }), "{error}");
    let disk = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
    let error = Target::Uniform.resolve(&disk, Class::yamabe(Space::E2)).unwrap_err();
    assert!(matches!(error, Error::TargetKind { target: "uniform", .. }));
}

/// Least total curvature at `set` of the circle packings with weights `eta`, not attained: one triangle at a time.
fn packing_bound(mesh: &Mesh, eta: &PerEdge<f64>, set: &[VertexId]) -> f64 {
    let full = |v: &VertexId| if mesh.is_boundary_vertex(*v) { PI } else { 2.0 * PI };
    let angles = |f| {
        let inside = mesh.face_vertices(f).map(|v| set.contains(&v));
        match inside.iter().filter(|x| **x).count() {
            0 => 0.0,
            1 => PI - eta[mesh.opposite_edges(f)[inside.iter().position(|x| *x).unwrap()]].acos(),
            _ => PI,
        }
    };
    set.iter().map(full).sum::<f64>() - mesh.faces().map(angles).sum::<f64>()
}

#[test]
fn a_target_below_thurstons_bound_is_reported_with_the_vertices_that_prove_it() {
    let (mesh, lengths) = surface(&shapes::icosphere(2).unwrap());
    let mut random = Random::new(23);
    for scheme in [Scheme::Thurston, Scheme::Tangential] {
        for space in [Space::E2, Space::H2] {
            let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, space)).unwrap();
            let eta = &initial.metric.rounded_eta();
            // Two neighbours, each of them above its own bound, together below theirs.
            let [a, b] = mesh.ends(5usize.into());
            let pair = [a, b];
            let bound = packing_bound(&mesh, eta, &pair);
            let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
            target[a] = 0.5 * bound - 0.05;
            target[b] = target[a];
            assert!(
                target[a] > packing_bound(&mesh, eta, &[a]) && target[b] > packing_bound(&mesh, eta, &[b])
            );
            // The rest takes the curvature back (with a little more than Gauss–Bonnet's in H²).
            let total = if space == Space::E2 { 4.0 * PI } else { 4.0 * PI + 0.3 };
            let share = (total - 2.0 * target[a]) / (mesh.n_vertices() - 2) as f64;
            mesh.vertices().filter(|v| !pair.contains(v)).for_each(|v| target[v] = share);
            let (_, report) = solve(&mesh, &initial.metric, &target, &rigid());
            assert_eq!(report.stop_reason, StopReason::Infeasible, "{space} {scheme} {report:?}");
            let proof = report.obstruction.unwrap();
            assert_eq!(proof.vertices, if a < b { [a, b] } else { [b, a] });
            assert!((proof.least - bound).abs() < 1e-12 && proof.curvature <= proof.least);
            assert!((proof.curvature - 2.0 * target[a]).abs() < 1e-12);
            assert!(!report.worst.is_empty() && report.worst[0].1.abs() == report.max_curvature_error);
            // No metric of the class goes below the bound, and some come near it.
            let mut least = f64::INFINITY;
            for _ in 0..200 {
                let mut metric = initial.metric.clone();
                metric.u.iter_mut().for_each(|u| *u += random.symmetric() - 1.0);
                let sink = 12.0 * random.unit();
                pair.iter().for_each(|&v| metric.u[v] -= sink);
                let k = curvature(&mesh, space, &metric.lengths(&mesh).unwrap()).unwrap().at;
                least = least.min(k[a] + k[b]);
            }
            assert!(least > bound && least < bound + 0.05, "{least} {bound}");
            // A little more curvature at the pair, and there is a metric.
            pair.iter().for_each(|&v| target[v] += 0.1);
            let share = (total - 2.0 * target[a]) / (mesh.n_vertices() - 2) as f64;
            mesh.vertices().filter(|v| !pair.contains(v)).for_each(|v| target[v] = share);
            converged(&solve(&mesh, &initial.metric, &target, &rigid()).1);
        }
    }
}

#[test]
fn a_triangulation_without_solution_is_reported_as_such() {
    // A cone of almost 2π on a sphere of twelve vertices: the five angles there cannot be that small.
    let (mesh, lengths) = surface(&shapes::icosphere(1).unwrap());
    let mut target = PerVertex::filled(12, (4.0 * PI - 6.2) / 11.0);
    target[VertexId(0)] = 6.2;
    // Another vertex takes the curvature back.
    target[VertexId(3)] -= 6.0;
    (0..12).filter(|v| ![0, 3].contains(v)).for_each(|v| target[VertexId(v)] += 0.6);
    let initial = euclidean(&mesh, &lengths).initial(Class::yamabe(Space::E2)).unwrap();
    let (metric, report) = solve(&mesh, &initial.metric, &target, &rigid());
    assert!(!report.is_reached(), "{report:?}");
    assert!(report.broken_triangles > 0);
    assert_eq!(report.stop_reason, StopReason::BrokenTriangles);
    assert!(metric.u.iter().all(|u| u.is_finite()));
}

//! Closed surfaces of genus 0 on the unit sphere.

mod check;
mod flat;
mod known;

use crate::common;
use crate::common::Random;
use crate::common::flips::{measure, shuffle};
use check::{check, finger, on_sphere, rough, run, same_up_to_moebius, surface};
use ricci::canonical::{
    QuotientOptions, Sphere, SphereOptions, SphereReport, Uniformization, flow_to_sphere, uniformize,
    uniformize_sphere,
};
use ricci::flow::{FlowSeconds, Method, Options, StopReason};
use ricci::geometry::Space;
use ricci::geometry::vector::dot;
use ricci::mesh::shapes::{self, IntrinsicSurface};
use ricci::mesh::{Mesh, PerEdge, VertexId, io};
use ricci::metric::{Scheme, lengths_from_positions};
use ricci::{Control, Error, Surface};

/// A report but for its times.
fn timeless(report: &SphereReport) -> SphereReport {
    SphereReport { seconds: FlowSeconds::default(), ..report.clone() }
}

#[test]
fn generated_shapes_become_convex_spheres() {
    let shapes = [
        ("icosahedron", shapes::icosphere(1).unwrap()),
        ("icosphere", shapes::icosphere(9).unwrap()),
        ("ellipsoid", shapes::ellipsoid([3.0, 1.0, 0.4], 10).unwrap()),
        ("needle", shapes::ellipsoid([1.0, 1.0, 12.0], 10).unwrap()),
        ("coin", shapes::ellipsoid([1.0, 1.0, 0.01], 10).unwrap()),
        ("finger", finger()),
        ("rough", rough(1, 0.3)),
        ("rougher", rough(2, 0.8)),
        ("spikes", rough(3, 0.95)),
    ];
    for (name, soup) in &shapes {
        let (mesh, lengths) = surface(soup);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, name);
    }
}

#[test]
fn the_flow_in_s2_ends_at_the_sphere_over_the_plane_up_to_a_moebius_transformation() {
    let (mesh, lengths) = surface(&shapes::ellipsoid([1.0, 1.2, 0.9], 8).unwrap());
    let given = Surface::intrinsic(mesh.clone(), lengths.clone(), Space::E2).unwrap();
    let flow = Options { method: Method::Gradient, ..Options::default() };
    let how = QuotientOptions { base: Some(VertexId(5)), flow, ..QuotientOptions::default() };
    let Uniformization::FlowedSphere(flowed) = uniformize(&given, &how, &Control::new()).unwrap() else {
        panic!("the flow in S²")
    };
    assert!(flowed.report.converged() && flowed.root == VertexId(5));
    let over_plane = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    same_up_to_moebius(&flowed.positions, &over_plane.positions, 1e-6, "ellipsoid");
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 12, 8).unwrap()).unwrap();
    let refused = flow_to_sphere(&torus, Scheme::Yamabe, None, &how.flow, &Control::new());
    assert!(matches!(refused, Err(Error::Argument { what: "surface", .. })));
}

#[test]
fn every_sphere_of_the_corpus_uniformizes() {
    let Some((folder, rows)) = common::index("good") else { return };
    let mut n = 0;
    for row in rows.iter().filter(|row| row["genus"] == "0" && row["boundary_loops"] == "0") {
        n += 1;
        let (mesh, lengths) = surface(&io::read(&folder.join(&row["file"])).unwrap());
        let clock = std::time::Instant::now();
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        let r = &sphere.report;
        println!(
            "{:32} range {:5.2}, {:2} steps, {:5} + {:5} flips, nonconvexity {:8.1e}, shortest edge {:7.1e}, {:.2} s",
            row["name"],
            r.u_range,
            r.iterations,
            r.start_flips,
            r.flips,
            r.nonconvexity,
            r.smallest_edge,
            clock.elapsed().as_secs_f64()
        );
        check(&sphere, &mesh, &lengths, &row["name"]);
    }
    assert_eq!(n, 29);
}

#[test]
fn any_puncture_leads_to_the_same_sphere() {
    let (mesh, lengths) = surface(&rough(4, 0.4));
    let first = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    for v in [0, 100, 300, 491] {
        let options = SphereOptions { puncture: Some(VertexId(v)), ..SphereOptions::default() };
        let other = run(&mesh, &lengths, &options).unwrap();
        check(&other, &mesh, &lengths, "other puncture");
        assert_eq!(other.report.puncture, VertexId(v));
        assert_eq!(other.positions[VertexId(v)], [0.0, 0.0, -1.0]);
        for i in 0..mesh.n_vertices() {
            for j in [0, 17, 200] {
                let dots = [&first, &other].map(|s| dot(s.positions[i.into()], s.positions[j.into()]));
                assert!((dots[0] - dots[1]).abs() < 1e-11, "{v}: {i} {j} {dots:?}");
            }
        }
    }
}

#[test]
fn the_sphere_depends_on_the_surface_not_on_its_triangulation() {
    let (mesh, lengths) = surface(&rough(6, 0.3));
    let first = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    let mut random = Random::new(11);
    for _ in 0..3 {
        let (mut mesh, mut lengths) = (mesh.clone(), lengths.clone());
        // Edges become loops and double edges on the way.
        assert!(shuffle(&mut mesh, &mut lengths, 4000, &mut random) > 500);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, "shuffled");
        same_up_to_moebius(&first.positions, &sphere.positions, 1e-9, "shuffled");
    }
}

#[test]
fn a_polyhedron_in_the_sphere_is_its_own_image() {
    let first = on_sphere(&rough(8, 0.5));
    let mesh = Mesh::clone(first.metric.mesh());
    let lengths = lengths_from_positions(&mesh, &first.positions).unwrap();
    let again = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&again, &mesh, &lengths, "again");
    same_up_to_moebius(&first.positions, &again.positions, 1e-9, "again");
    let triangles = |mesh: &Mesh| {
        let smallest_first = |t: [VertexId; 3]| (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]).min();
        let mut all: Vec<_> = mesh.faces().map(|f| smallest_first(mesh.face_vertices(f))).collect();
        all.sort();
        all
    };
    assert_eq!(triangles(again.metric.mesh()), triangles(&mesh));
}

#[test]
fn lengths_of_any_size_give_the_same_sphere() {
    let (mesh, lengths) = surface(&rough(5, 0.4));
    let spheres = [1.0, 2f64.powi(200), 2f64.powi(-200)].map(|factor| {
        let lengths: PerEdge<f64> = lengths.iter().map(|l| factor * l).collect::<Vec<_>>().into();
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        assert!(sphere.report.converged);
        sphere
    });
    for other in &spheres[1..] {
        // Powers of two: to the last bit.
        assert_eq!(spheres[0].positions, other.positions);
    }
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let (mesh, lengths) = surface(&rough(9, 0.6));
    let spheres = [1, 2, 3]
        .map(|threads| run(&mesh, &lengths, &SphereOptions { threads, ..SphereOptions::default() }).unwrap());
    for other in &spheres[1..] {
        assert_eq!(other.positions, spheres[0].positions);
        assert_eq!(timeless(&other.report), timeless(&spheres[0].report));
        assert_eq!(other.metric.metric(), spheres[0].metric.metric());
        assert_eq!(other.metric.mesh(), spheres[0].metric.mesh());
    }
}

#[test]
fn the_way_back_is_a_subdivision_of_the_given_faces() {
    let (mesh, lengths) = surface(&rough(2, 0.8));
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    assert!(sphere.report.flips > 0 && sphere.report.start_flips > 0, "{:?}", sphere.report);
    assert_eq!(sphere.metric.flips(), sphere.report.flips + sphere.report.start_flips);
    let subdivision = sphere.metric.common_subdivision(&Control::new()).unwrap();
    subdivision.mesh.validate().unwrap();
    assert_eq!(subdivision.mesh.euler(), 2);
    assert_eq!(subdivision.n_vertices[0], mesh.n_vertices());
    for crossing in &subdivision.crossings {
        assert!(crossing[1].weights.iter().all(|w| *w > 0.0 && *w < 1.0));
    }
    // The metric it is made of is flat in the plane too: the same class.
    let mut plane = sphere.metric.metric().clone();
    plane.space = Space::E2;
    for v in mesh.vertices().filter(|&v| v != sphere.report.puncture) {
        let [x, y] = sphere.plane[v];
        plane.u[v] += (1.0 + x * x + y * y).ln();
    }
    let link: Vec<VertexId> = {
        let mesh = sphere.metric.mesh();
        mesh.outgoing(sphere.report.puncture).map(|h| mesh.tip(h)).collect()
    };
    plane.u[sphere.report.puncture] = 60.0;
    let found = measure(sphere.metric.mesh(), &plane);
    for v in mesh.vertices().filter(|v| *v != sphere.report.puncture && !link.contains(v)) {
        assert!(found.curvature[v.index()].abs() < 1e-9, "{v}: {:e}", found.curvature[v.index()]);
    }
}

#[test]
fn a_cancelled_call_says_so() {
    let given = Surface::from_soup(&rough(1, 0.2)).unwrap();
    let control = Control::new();
    control.cancel();
    let result = uniformize_sphere(&given, &SphereOptions::default(), &control);
    assert!(matches!(result, Err(Error::Cancelled)));
}

#[test]
fn cancelling_from_another_thread_stops_it() {
    let given = Surface::from_soup(&shapes::ellipsoid([1.0, 1.0, 9.0], 40).unwrap()).unwrap();
    let control = Control::new();
    let handle = control.clone();
    let worker = std::thread::spawn(move || uniformize_sphere(&given, &SphereOptions::default(), &handle));
    std::thread::sleep(std::time::Duration::from_millis(60));
    control.cancel();
    assert!(matches!(worker.join().unwrap(), Err(Error::Cancelled)));
}

fn refused(intrinsic: &IntrinsicSurface) -> String {
    let (mesh, lengths) = intrinsic.build().unwrap();
    run(&mesh, &lengths, &SphereOptions::default()).unwrap_err().to_string()
}

#[test]
fn what_is_no_sphere_is_refused_by_name() {
    assert!(refused(&shapes::two_triangle_sphere()).contains("at least four vertices"));
    assert!(refused(&shapes::one_vertex(2).unwrap()).contains("genus 0"));
    let (mesh, lengths) = surface(&shapes::disk(3).unwrap());
    let error = run(&mesh, &lengths, &SphereOptions::default()).unwrap_err();
    assert!(error.to_string().contains("with boundary"), "{error}");

    let (mesh, lengths) = surface(&shapes::icosphere(2).unwrap());
    let missing = SphereOptions { puncture: Some(VertexId(1000)), ..SphereOptions::default() };
    assert!(matches!(run(&mesh, &lengths, &missing), Err(Error::Argument { what: "vertex", .. })));
    let tolerance = SphereOptions { tolerance: 0.0, ..SphereOptions::default() };
    assert!(matches!(run(&mesh, &lengths, &tolerance), Err(Error::Argument { what: "tolerance", .. })));
    let short = PerEdge::filled(3, 1.0);
    assert!(matches!(run(&mesh, &short, &SphereOptions::default()), Err(Error::Size { .. })));
}

#[test]
fn the_step_limit_is_that_of_the_whole_call() {
    let (mesh, lengths) = surface(&rough(2, 0.8));
    let needed = run(&mesh, &lengths, &SphereOptions::default()).unwrap().report;
    assert!(needed.tried > 1 && needed.iterations > 4, "{needed:?}");
    let mut ended = 0;
    for most in 1..needed.iterations + 3 {
        let options = SphereOptions { max_iterations: most, ..SphereOptions::default() };
        match run(&mesh, &lengths, &options) {
            Ok(Sphere { report, .. }) if most < needed.iterations => {
                assert!(report.iterations <= most && !report.converged, "{most}: {report:?}");
                assert_eq!(report.stop_reason, StopReason::IterationLimit, "{most}: {report:?}");
                ended += 1;
            }
            // One evaluation more than steps.
            Ok(Sphere { report, .. }) if most <= needed.iterations + 1 => assert!(report.iterations <= most),
            Ok(Sphere { report, .. }) => assert_eq!(timeless(&report), timeless(&needed)),
            // So early that there is no plane yet.
            Err(error) => {
                assert!(most < needed.iterations && matches!(error, Error::Layout(_)), "{most}: {error}")
            }
        }
    }
    assert!(ended > 0);
}

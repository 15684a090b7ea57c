//! With edge flips every admissible target is reached.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Random;
use ricci::Control;
use ricci::flow::{Flips, Options, Report, Solver, StopReason, SurfaceFlow};
use ricci::geometry::Space;
use ricci::mesh::{Double, EdgeId, Mesh, PerEdge, PerVertex, VertexId, io, shapes};
use ricci::metric::delaunay::{failing, intrinsic_delaunay};
use ricci::metric::{Scheme, Target, curvature, delaunay_start, initial_metric, lengths_from_positions};
use std::f64::consts::PI;

const SCHEMES: [Scheme; 2] = [Scheme::Yamabe, Scheme::Inversive];
/// Largest mesh that the optimised tests of a debug build take.
const MOST_VERTICES: usize = 3000;

/// Make the triangulation intrinsic Delaunay, and flow.
fn solve(
    mut mesh: Mesh,
    mut lengths: PerEdge<f64>,
    geometry: Space,
    (space, scheme): (Space, Scheme),
    target: &PerVertex<f64>,
    double: Option<&Double>,
) -> (Solver, Report) {
    let start = delaunay_start(&mut mesh, &mut lengths, geometry, scheme, space, double, &[], &mut |_, _| {});
    let start = start.unwrap().metric;
    let mut solver = Solver::new(mesh, start, Options::default()).unwrap();
    if let Some(double) = double {
        let mirror: Vec<VertexId> = solver.mesh().vertices().map(|v| double.mirror(v)).collect();
        solver.keep_symmetric(&mirror).unwrap();
    }
    let report = solver.solve(target, &Control::new()).unwrap();
    (solver, report)
}

/// Converged, and the metric, measured anew, has the curvature, whole triangles and a Delaunay triangulation.
fn check(solver: &Solver, report: &Report, target: &PerVertex<f64>, what: &str) {
    assert!(report.converged, "{what}: {} after {} steps", report.stop_reason, report.iterations);
    let (mesh, metric) = (solver.mesh(), solver.metric());
    mesh.validate().unwrap();
    let k = curvature(mesh, metric.space, &metric.lengths(mesh).unwrap()).unwrap();
    assert!(k.broken.is_empty(), "{what}");
    assert!(k.gauss_bonnet < 1e-10, "{what}: {}", k.gauss_bonnet);
    // Lengths are rounded; the report's own error is formed from u.
    let worst = mesh.vertices().map(|v| (k.at[v] - target[v]).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-8 && report.max_curvature_error <= report.tolerance, "{what}: {worst}");
    assert!(failing(mesh, metric, &metric.u).is_empty(), "{what}");
}

/// Uniform, or four cones of π on a sphere.
fn default_target(mesh: &Mesh, lengths: &PerEdge<f64>, space: Space, scheme: Scheme) -> PerVertex<f64> {
    if space == Space::E2 && mesh.genus() == 0 {
        let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
        let step = mesh.n_vertices() / 4;
        (0..4).for_each(|k| target[(k * step).into()] = PI);
        return target;
    }
    Target::Uniform.resolve(mesh, lengths, space, scheme).unwrap()
}

fn corpus() -> Vec<(String, Mesh, PerEdge<f64>)> {
    let Some((folder, rows)) = common::index("good") else { return Vec::new() };
    let mut all = Vec::new();
    for row in &rows {
        if row["V"].parse::<usize>().unwrap() <= MOST_VERTICES {
            let soup = io::read(&folder.join(&row["file"])).unwrap();
            let mesh = Mesh::from_soup(&soup).unwrap();
            let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
            all.push((row["file"].clone(), mesh, lengths));
        }
    }
    all
}

#[test]
fn every_closed_mesh_reaches_its_uniform_metric() {
    let mut steps = Vec::new();
    for (name, mesh, lengths) in corpus().into_iter().filter(|(_, mesh, _)| mesh.is_closed()) {
        for scheme in SCHEMES {
            for space in [Space::E2, Space::H2].into_iter().filter(|s| *s == Space::E2 || mesh.genus() >= 2) {
                let target = default_target(&mesh, &lengths, space, scheme);
                let (solver, report) =
                    solve(mesh.clone(), lengths.clone(), Space::E2, (space, scheme), &target, None);
                check(&solver, &report, &target, &format!("{name} {space} {scheme}"));
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
    for (name, half, lengths) in corpus().into_iter().filter(|(_, mesh, _)| !mesh.is_closed()) {
        let double = Double::new(&half).unwrap();
        let lengths_of_double: PerEdge<f64> = double.spread_edges(&lengths).into();
        for scheme in SCHEMES {
            let target = Target::Boundary.resolve(&half, &lengths, Space::E2, scheme);
            // A packing's own limit at a vertex of one triangle is that of the input triangulation: flips lift it.
            let Ok(target) = target else { continue };
            let target: PerVertex<f64> = double.target(&target).into();
            let kind = (Space::E2, scheme);
            let (solver, report) = solve(
                double.mesh.clone(),
                lengths_of_double.clone(),
                Space::E2,
                kind,
                &target,
                Some(&double),
            );
            let what = format!("{name} {scheme}");
            check(&solver, &report, &target, &what);
            // The solution is unique, and so symmetric.
            let u = &solver.metric().u;
            let range = u.iter().fold(0.0f64, |m, u| m.max(u.abs())).max(1.0);
            for v in solver.mesh().vertices() {
                let difference = (u[v] - u[double.mirror(v)]).abs();
                assert!(difference < 1e-6 * range, "{what}: {difference} at {v}");
            }
        }
    }
}

#[test]
fn random_targets_on_a_sphere_and_on_genus_two_are_reached() {
    let mut random = Random::new(11);
    let mut distribution = [0usize; 51];
    for (soup, rounds) in [(shapes::icosphere(10).unwrap(), 40), (shapes::genus(2, 4).unwrap(), 10)] {
        let mesh = Mesh::from_soup(&soup).unwrap();
        let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
        for round in 0..rounds {
            // Curvature uniform in (−2π, 2π) about its mean, drawn towards it as far as 2π asks for.
            let total = 2.0 * PI * mesh.euler() as f64;
            let mean = total / mesh.n_vertices() as f64;
            let mut target = PerVertex::from_fn(mesh.n_vertices(), |_| 2.0 * PI * random.symmetric());
            let shift = target.iter().sum::<f64>() / mesh.n_vertices() as f64;
            target.iter_mut().for_each(|k| *k += mean - shift);
            let largest = target.iter().copied().fold(0.0, f64::max);
            let pull = ((2.0 * PI - 0.05 - mean) / (largest - mean)).min(1.0);
            target.iter_mut().for_each(|k| *k = mean + pull * (*k - mean));
            let scheme = SCHEMES[round % 2];
            let (solver, report) =
                solve(mesh.clone(), lengths.clone(), Space::E2, (Space::E2, scheme), &target, None);
            check(&solver, &report, &target, &format!("round {round} {scheme}"));
            distribution[report.iterations.min(50)] += 1;
        }
    }
    let steps: Vec<_> =
        (0..51).filter(|&k| distribution[k] > 0).map(|k| format!("{k}: {}", distribution[k])).collect();
    println!("steps and how often: {}", steps.join(", "));
    assert_eq!(distribution[50], 0);
}

#[test]
fn the_result_depends_on_the_metric_and_not_on_its_triangulation() {
    let soup = shapes::genus(2, 3).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    // Other geodesic triangulations of the same surface: every kept flip is isometric.
    let (mut other, mut other_lengths) = (mesh.clone(), lengths.clone());
    let mut random = Random::new(3);
    let mut flipped = 0;
    for _ in 0..2000 {
        let e = EdgeId((random.symmetric().abs() * mesh.n_edges() as f64) as u32);
        flipped += usize::from(isometric_flip(&mut other, &mut other_lengths, e));
    }
    assert!(flipped > 500, "{flipped}");
    let target = |space| default_target(&mesh, &lengths, space, Scheme::Yamabe);
    for space in [Space::E2, Space::H2] {
        for scheme in SCHEMES {
            let run = |mesh: &Mesh, lengths: &PerEdge<f64>| {
                let target = target(space);
                let (solver, report) =
                    solve(mesh.clone(), lengths.clone(), Space::E2, (space, scheme), &target, None);
                check(&solver, &report, &target, &format!("{space} {scheme}"));
                solver.metric().u.clone()
            };
            let (one, two) = (run(&mesh, &lengths), run(&other, &other_lengths));
            let worst = one.iter().zip(two.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-8, "{space} {scheme}: {worst}");
        }
    }
}

/// Flip an edge whose two triangles form a strictly convex quadrilateral in the plane; the surface stays as it is.
fn isometric_flip(mesh: &mut Mesh, lengths: &mut PerEdge<f64>, e: EdgeId) -> bool {
    let h = e.halfedge();
    let place = |h| {
        let [base, left, right] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
        let x = (base * base + right * right - left * left) / (2.0 * base);
        [x, (right * right - x * x).max(0.0).sqrt()]
    };
    if mesh.face(h) == mesh.face(h.twin()) {
        return false;
    }
    let (k, l) = (place(h), place(h.twin()));
    let l = [lengths[e] - l[0], -l[1]];
    // Where the new edge crosses the line of the old one, well inside.
    let crossing = k[0] + (l[0] - k[0]) * k[1] / (k[1] - l[1]);
    if !(0.05 * lengths[e]..0.95 * lengths[e]).contains(&crossing) {
        return false;
    }
    let length = (k[0] - l[0]).hypot(k[1] - l[1]);
    mesh.flip(e) && {
        lengths[e] = length;
        true
    }
}

#[test]
fn intrinsic_delaunay_keeps_the_surface() {
    for (name, mut mesh, mut lengths) in corpus() {
        let before = curvature(&mesh, Space::E2, &lengths).unwrap();
        intrinsic_delaunay(&mut mesh, &mut lengths, None, Space::E2, &[], &mut |_, _| {}).unwrap();
        let after = curvature(&mesh, Space::E2, &lengths).unwrap();
        assert!(after.broken.is_empty(), "{name}");
        assert!((after.area / before.area - 1.0).abs() < 1e-9, "{name}: {} {}", before.area, after.area);
        let worst = mesh.vertices().map(|v| (before.at[v] - after.at[v]).abs()).fold(0.0, f64::max);
        // Needles of the input leave their rounding.
        assert!(worst < 1e-5, "{name}: {worst}");
        let again =
            intrinsic_delaunay(&mut mesh, &mut lengths, None, Space::E2, &[], &mut |_, _| {}).unwrap();
        assert_eq!(again, 0, "{name}");
    }
}

#[test]
fn without_flips_the_triangulation_stays_and_a_cancelled_flow_changes_nothing() {
    let soup = shapes::genus(2, 3).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let start = initial_metric(&mesh, &lengths, Space::E2, Scheme::Yamabe, Space::E2).unwrap().metric;
    let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
    target[7usize.into()] = -4.0 * PI;
    let options = |flips| Options { flips, ..Options::default() };
    let mut rigid = Solver::new(mesh.clone(), start.clone(), options(Flips::Never)).unwrap();
    let report = rigid.solve(&target, &Control::new()).unwrap();
    assert!(rigid.mesh() == &mesh && report.flips == 0 && !report.converged);
    let mut solver = Solver::new(mesh.clone(), start.clone(), options(Flips::Auto)).unwrap();
    let cancelled = Control::new();
    cancelled.cancel();
    assert!(solver.solve(&target, &cancelled).is_err());
    assert!(solver.mesh() == &mesh && solver.metric() == &start);
    let report = solver.solve(&target, &Control::new()).unwrap();
    assert_eq!(report.stop_reason, StopReason::Converged);
    assert!(report.flips > 0 && solver.mesh() != &mesh);
    check(&solver, &report, &target, "single cone");
    // The next target starts from there.
    let uniform = Target::Uniform.resolve(&mesh, &lengths, Space::E2, Scheme::Yamabe).unwrap();
    let report = solver.solve(&uniform, &Control::new()).unwrap();
    check(&solver, &report, &uniform, "after a single cone");
}

#[test]
fn fixed_edges_stay() {
    let soup = shapes::punch(&shapes::genus(2, 4).unwrap(), 1).unwrap();
    let given = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&given, &soup.positions).unwrap();
    let fixed: Vec<EdgeId> = given.edges().filter(|e| e.index() % 5 == 0).collect();
    let ends: Vec<[VertexId; 2]> = fixed.iter().map(|&e| given.ends(e)).collect();
    let target = Target::default_for(&given, &lengths, Space::E2).unwrap();
    let target = target.values(&given, &lengths, Space::E2).unwrap();
    let run = |fixed_edges| {
        let options = Options { fixed_edges, ..Options::default() };
        let mut flow =
            SurfaceFlow::new(&given, &lengths, Space::E2, Scheme::Yamabe, Space::E2, &[], &options).unwrap();
        flow.solve(&target, &Control::new()).unwrap();
        flow
    };
    let kept = |flow: &SurfaceFlow| {
        let sides = |e: EdgeId| [e.halfedge(), e.halfedge().twin()].map(|h| flow.mesh().prev(h));
        fixed.iter().zip(&ends).all(|(&e, ends)| flow.mesh().ends(e) == *ends && sides(e)[0] != sides(e)[1])
    };
    assert!(!kept(&run(Vec::new())) && kept(&run(fixed.clone())));
    let missing = vec![EdgeId(given.n_edges() as u32)];
    let options = Options { fixed_edges: missing, ..Options::default() };
    let refused = SurfaceFlow::new(&given, &lengths, Space::E2, Scheme::Yamabe, Space::E2, &[], &options);
    assert!(refused.is_err_and(|e| e.to_string().contains("fixed edge")));
}

#[test]
fn flows_that_go_on_from_a_metric_end_where_new_ones_do() {
    for soup in [shapes::genus(1, 3).unwrap(), shapes::punch(&shapes::genus(1, 3).unwrap(), 2).unwrap()] {
        let given = Mesh::from_soup(&soup).unwrap();
        let lengths = lengths_from_positions(&given, &soup.positions).unwrap();
        let first = Target::default_for(&given, &lengths, Space::E2).unwrap();
        let first = first.values(&given, &lengths, Space::E2).unwrap();
        let inside: Vec<VertexId> = given.vertices().filter(|&v| !given.is_boundary_vertex(v)).collect();
        let mut second = first.clone();
        (second[inside[3]], second[inside[40]]) = (1.5, -1.5);
        for scheme in SCHEMES {
            let options = Options::default();
            let begin =
                || SurfaceFlow::new(&given, &lengths, Space::E2, scheme, Space::E2, &[], &options).unwrap();
            let (mut straight, mut aside) = (begin(), begin());
            assert!(straight.solve(&second, &Control::new()).unwrap().converged);
            assert!(aside.solve(&first, &Control::new()).unwrap().converged);
            let halfway = aside.now();
            assert_eq!(halfway.double().is_some(), !given.is_closed());
            let k = halfway.curvature().unwrap().at;
            assert!(given.vertices().all(|v| (k[v] - first[v]).abs() < 1e-9));
            let mut resumed = SurfaceFlow::resume(&halfway, &[], &options).unwrap();
            assert!(resumed.solve(&second, &Control::new()).unwrap().converged);
            let (a, b) = (straight.now(), resumed.now());
            assert!(b.flips() >= halfway.flips() && a.start_flips() == b.start_flips());
            let [a, b] = [a, b].map(|end| end.conformal_factor().unwrap());
            // Up to scale.
            let shift = a[inside[0]] - b[inside[0]];
            let worst = given.vertices().map(|v| (a[v] - b[v] - shift).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-8, "{scheme}: {worst}");

            // Without flips the triangulation stays where it is; other fixed edges begin anew.
            let never = Options { flips: Flips::Never, ..Options::default() };
            let mut rigid = SurfaceFlow::resume(&halfway, &[], &never).unwrap();
            rigid.solve(&first, &Control::new()).unwrap();
            assert!(rigid.now().mesh() == halfway.mesh() && rigid.now().flips() == halfway.flips());
            let fixed = Options { fixed_edges: given.edges().collect(), ..Options::default() };
            let anew = SurfaceFlow::resume(&halfway, &[], &fixed).unwrap().now();
            assert!(anew.flips() == 0 && (anew.is_unflipped() || anew.double().is_some()));
        }
    }
}

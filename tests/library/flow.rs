//! The flow against known answers.

use crate::common::Random;
use crate::common::flow::{converged, distance, euclidean, prescribing_target, rigid, solve, surface};
use ricci::embed::Layout;
use ricci::flow::{Gradient, Method, Options, Report, StepRule, StopReason, curvature_derivative};
use ricci::geometry::Space;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::geometry::modulus::modulus;
use ricci::mesh::shapes;
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::{Initial, Metric, Scheme, curvature, initial_metric};
use ricci::topology::cut_graph;
use ricci::{Class, Control, Surface, Target};
use std::f64::consts::PI;
use std::sync::Arc;

const EXACT: [Scheme; 3] = [Scheme::Yamabe, Scheme::Inversive, Scheme::Virtual];

/// Default flow to the default (or given) target; the metric, its start, the report.
fn run(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    geometry: Space,
    class: Class,
    target: Option<Target>,
) -> (Initial, Metric, Report) {
    let surface = Surface::intrinsic(mesh.clone(), lengths.clone(), geometry).unwrap();
    let initial = surface.initial(class).unwrap();
    let target = target.unwrap_or_else(|| prescribing_target(&surface, class.space));
    let target = target.resolve(&surface, class).unwrap();
    let (metric, report) = solve(mesh, &initial.metric, &target, &rigid());
    (initial, metric, report)
}

#[test]
fn constant_curvature_metrics_are_fixed_points() {
    let torus = shapes::flat_torus([0.2, 1.1], 6, 5).unwrap();
    let bolza = shapes::bolza(2).unwrap();
    for surface in [torus, bolza] {
        let (mesh, lengths) = surface.build().unwrap();
        for scheme in EXACT {
            let (initial, metric, report) =
                run(&mesh, &lengths, surface.geometry, Class::new(scheme, surface.geometry), None);
            converged(&report);
            assert_eq!(report.iterations, 0, "{scheme}");
            let moved = metric.lengths(&mesh).unwrap();
            let start = initial.metric.lengths(&mesh).unwrap();
            let ratio = moved[0usize.into()] / start[0usize.into()];
            assert!(mesh.edges().all(|e| (moved[e] / start[e] / ratio - 1.0).abs() < 1e-13), "{scheme}");
            if surface.geometry == Space::H2 {
                assert!(distance(&moved, &lengths) < 1e-13);
            }
        }
    }
}

#[test]
fn round_sphere_is_a_fixed_point_of_the_spherical_flow() {
    let soup = shapes::icosphere(6).unwrap();
    let (mesh, chords) = surface(&soup);
    let arcs = PerEdge::from_fn(mesh.n_edges(), |e| 2.0 * (0.5 * chords[e]).asin());
    for scheme in EXACT {
        let (_, metric, report) = run(&mesh, &arcs, Space::S2, Class::new(scheme, Space::S2), None);
        converged(&report);
        assert_eq!(report.iterations, 0);
        assert!(distance(&metric.lengths(&mesh).unwrap(), &arcs) < 1e-13);
    }
}

#[test]
fn spherical_flow_rounds_an_ellipsoid_by_newton_and_by_gradient() {
    let (mesh, lengths) = surface(&shapes::ellipsoid([1.0, 1.2, 0.9], 5).unwrap());
    for scheme in [Scheme::Yamabe, Scheme::Inversive, Scheme::Thurston] {
        let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::S2)).unwrap();
        let target =
            Target::Uniform.resolve(&euclidean(&mesh, &lengths), Class::new(scheme, Space::S2)).unwrap();
        let (metric, report) = solve(&mesh, &initial.metric, &target, &rigid());
        converged(&report);
        let k = curvature(&mesh, Space::S2, &metric.lengths(&mesh).unwrap()).unwrap();
        assert!((k.area - 4.0 * PI).abs() < 1e-9);
        let options = Options { method: Method::Gradient, ..rigid() };
        converged(&solve(&mesh, &initial.metric, &target, &options).1);
    }
}

/// Modulus of the flat metric on a torus, from the holonomy of two homology generators.
fn modulus_of(mesh: &Mesh, lengths: &PerEdge<f64>) -> [f64; 2] {
    let cut = cut_graph(mesh, lengths, &[], &Control::new()).unwrap();
    let laid = Layout::of_lengths(&Arc::new(mesh.clone()), lengths, &cut, &Control::new()).unwrap();
    assert!(laid.flipped.is_empty() && laid.consistency() < 1e-9);
    let turns = |s: &ricci::embed::Seam| s.isometry().rotation.abs();
    assert!(laid.seams.iter().all(|s| turns(s) < 1e-8 && s.residual < 1e-9), "{:?}", laid.seams);
    // The segments of the cut cross the generators of the deck group: their translations span the lattice.
    let mut periods: Vec<[f64; 2]> = laid.seams.iter().map(|s| s.isometry().translation).collect();
    periods.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
    let independent = |p: &&[f64; 2]| {
        let q = periods[0];
        (p[0] * q[1] - p[1] * q[0]).abs() > 1e-6 * p[0].hypot(p[1]) * q[0].hypot(q[1])
    };
    let second = *periods.iter().find(independent).unwrap();
    modulus([periods[0], second]).unwrap()
}

#[test]
fn modulus_of_the_torus_of_revolution_converges_quadratically() {
    let (big, small) = (2.0f64, 0.8f64);
    let exact = small / (big * big - small * small).sqrt();
    // Reduced to |τ| ≥ 1.
    let exact = exact.max(1.0 / exact);
    let error = |n: usize| {
        let (mesh, lengths) = surface(&shapes::torus(big, small, 2 * n, n).unwrap());
        let (_, metric, report) =
            run(&mesh, &lengths, Space::E2, Class::new(Scheme::Yamabe, Space::E2), None);
        converged(&report);
        let tau = modulus_of(&mesh, &metric.lengths(&mesh).unwrap());
        (tau[0].hypot(tau[1] - exact)).abs()
    };
    let errors = [10, 20, 40].map(error);
    for pair in errors.windows(2) {
        let rate = (pair[0] / pair[1]).log2();
        assert!((rate - 2.0).abs() < 0.2, "errors {errors:?}, rate {rate}");
    }
}

#[test]
fn modulus_of_an_elliptic_curve_converges_to_its_periods() {
    let point = |(re, im)| num_complex::Complex64::new(re, im);
    // Square and hexagonal lattices, whose spheres are symmetric too, and one without symmetry.
    for points in [
        vec![(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)],
        vec![(1.0, 0.0), (-0.5, 0.75f64.sqrt()), (-0.5, -(0.75f64.sqrt()))],
        vec![(-1.0, 0.2), (0.3, 0.9), (0.8, -0.7), (2.0, 0.5)],
    ] {
        let points: Vec<_> = points.into_iter().map(point).collect();
        let tau = period_matrix(&points).unwrap()[0][0];
        let exact = modulus([[1.0, 0.0], [tau.re, tau.im]]).unwrap();
        let error = |n: usize| {
            let (mesh, lengths) = shapes::hyperelliptic(&points, n).unwrap().build().unwrap();
            let (_, metric, report) =
                run(&mesh, &lengths, Space::S2, Class::new(Scheme::Yamabe, Space::E2), None);
            converged(&report);
            let tau = modulus_of(&mesh, &metric.lengths(&mesh).unwrap());
            (tau[0] - exact[0]).hypot(tau[1] - exact[1])
        };
        // Corners of 4π at the branch points: first order.
        let errors = [8usize, 16, 32, 64].map(|n| n as f64 * error(n));
        assert!(errors.iter().all(|&e| e < 0.06), "{errors:?}");
    }
}

#[test]
fn scaling_the_input_leaves_the_result_unchanged() {
    let soup = shapes::genus(2, 3).unwrap();
    let (mesh, lengths) = surface(&soup);
    for (space, scheme) in [Space::E2, Space::H2].into_iter().flat_map(|s| EXACT.map(|c| (s, c))) {
        let result = |factor: f64| {
            let lengths = PerEdge::from_fn(mesh.n_edges(), |e| factor * lengths[e]);
            let (_, metric, report) = run(&mesh, &lengths, Space::E2, Class::new(scheme, space), None);
            converged(&report);
            metric.lengths(&mesh).unwrap()
        };
        let (one, large) = (result(1.0), result(1000.0));
        // E² results are normalised to Σ u = 0; the input's scale is in η for ε = 0 and drops out for circles.
        let ratio = if space == Space::H2 { 1.0 } else { large[0usize.into()] / one[0usize.into()] };
        assert!(mesh.edges().all(|e| (large[e] / one[e] / ratio - 1.0).abs() < 1e-9), "{space} {scheme}");
    }
}

#[test]
fn relabelling_and_reflection_leave_the_result_unchanged() {
    let soup = shapes::genus(2, 3).unwrap();
    let (mesh, lengths) = surface(&soup);
    let mut random = Random::new(17);
    let n = soup.positions.len();
    let mut label: Vec<u32> = (0..n as u32).collect();
    (1..n).for_each(|i| label.swap(i, random.below(i + 1)));
    let mut other = soup.clone();
    (0..n).for_each(|v| other.positions[label[v] as usize] = soup.positions[v]);
    other.faces = soup.faces.iter().map(|f| f.map(|v| label[v as usize])).collect();
    // Reflect in x = 0 and reverse, and list the faces in another order.
    other.positions.iter_mut().for_each(|p| p[0] = -p[0]);
    other.faces.iter_mut().for_each(|f| f.swap(1, 2));
    other.faces.reverse();
    let (mesh2, lengths2) = surface(&other);
    for (space, scheme) in
        [(Space::E2, Scheme::Inversive), (Space::H2, Scheme::Yamabe), (Space::H2, Scheme::Thurston)]
    {
        let (_, a, report) = run(&mesh, &lengths, Space::E2, Class::new(scheme, space), None);
        converged(&report);
        let (_, b, report) = run(&mesh2, &lengths2, Space::E2, Class::new(scheme, space), None);
        converged(&report);
        for v in 0..n {
            let there = VertexId(label[v]);
            assert!((a.u[VertexId::from(v)] - b.u[there]).abs() < 1e-8, "{space} {scheme}");
        }
    }
}

#[test]
fn gradient_flow_and_newton_agree() {
    let torus = surface(&shapes::torus(2.0, 0.9, 12, 8).unwrap());
    let disk = surface(&shapes::disk(4).unwrap());
    let genus2 = surface(&shapes::genus(2, 2).unwrap());
    let mut unreached = 0;
    for (mesh, lengths, space) in
        [(&torus.0, &torus.1, Space::E2), (&disk.0, &disk.1, Space::E2), (&genus2.0, &genus2.1, Space::H2)]
    {
        for scheme in Scheme::ALL {
            let initial = initial_metric(mesh, lengths, Space::E2, Class::new(scheme, space)).unwrap();
            let given = euclidean(mesh, lengths);
            let target = prescribing_target(&given, space);
            let target = target.resolve(&given, Class::new(scheme, space)).unwrap();
            let (newton, report) = solve(mesh, &initial.metric, &target, &rigid());
            if !report.is_reached() {
                // Virtual radii do not reach every target on a fixed triangulation.
                assert_eq!((scheme, report.stop_reason), (Scheme::Virtual, StopReason::BrokenTriangles));
                unreached += 1;
                continue;
            }
            let options = Options { method: Method::Gradient, ..rigid() };
            let (gradient, report) = solve(mesh, &initial.metric, &target, &options);
            converged(&report);
            assert!(distance(&newton.u, &gradient.u) < 1e-8, "{space} {scheme}");
            assert_eq!(report.trace.len(), report.iterations + 1);
        }
    }
    assert!(unreached <= 1);
}

#[test]
fn energy_decreases_along_the_stable_gradient_flow() {
    let (mesh, lengths) = surface(&shapes::torus(2.0, 0.7, 12, 8).unwrap());
    for area_normalised in [false, true] {
        let initial =
            initial_metric(&mesh, &lengths, Space::E2, Class::new(Scheme::Thurston, Space::E2)).unwrap();
        let target = Target::Uniform
            .resolve(&euclidean(&mesh, &lengths), Class::new(Scheme::Thurston, Space::E2))
            .unwrap();
        let gradient = Gradient { step: StepRule::Stable, area_normalised };
        let options = Options { method: Method::Gradient, gradient, ..rigid() };
        let (_, report) = solve(&mesh, &initial.metric, &target, &options);
        converged(&report);
        assert!(report.trace.windows(2).all(|w| w[1].energy <= w[0].energy + 1e-14));
        assert!(report.trace.windows(2).all(|w| w[1].max_curvature_error <= w[0].max_curvature_error * 1.01));
        let (first, last) = (report.trace[0], report.trace[report.iterations]);
        assert!(!area_normalised || (last.area / first.area - 1.0).abs() < 1e-12);
    }
}

#[test]
fn newton_converges_quadratically() {
    let genus2 = surface(&shapes::genus(2, 4).unwrap());
    let mut bumpy = shapes::torus(2.0, 0.9, 24, 12).unwrap();
    shapes::noise(&mut bumpy, 0.1, 3).unwrap();
    let torus = surface(&bumpy);
    for (name, (mesh, lengths), space) in [("genus 2", &genus2, Space::H2), ("torus", &torus, Space::E2)] {
        for scheme in Scheme::ALL {
            let initial = initial_metric(mesh, lengths, Space::E2, Class::new(scheme, space)).unwrap();
            let target =
                Target::Uniform.resolve(&euclidean(mesh, lengths), Class::new(scheme, space)).unwrap();
            let (_, report) = solve(mesh, &initial.metric, &target, &rigid());
            if !report.is_reached() {
                // Virtual radii do not reach every target on a fixed triangulation.
                assert_eq!((scheme, report.stop_reason), (Scheme::Virtual, StopReason::BrokenTriangles));
                continue;
            }
            let tail: Vec<String> = report.residuals.iter().map(|r| format!("{r:.1e}")).collect();
            println!("{name} {space} {scheme}: {}", tail.join(" "));
            let constant = tail_constant(&report.residuals);
            println!("    r' ≤ {constant:.2} r²");
            assert!(constant <= QUADRATIC, "{scheme}: {constant}, {tail:?}");
            let small = |w: &[f64]| w[0] < 1e-4 && w[1] > 1e-16;
            assert!(report.residuals.windows(2).any(small), "{scheme}: {tail:?}");
        }
    }
}

/// Bound of C in `r' ≤ C r²` on the tails of Newton's method: the largest is 17 here, and three times as much is allowed.
const QUADRATIC: f64 = 50.0;

/// The least C of `r' ≤ C r²` from the first small residual down to rounding.
fn tail_constant(residuals: &[f64]) -> f64 {
    let ratio = |w: &[f64]| (w[1] - 1e-12) / (w[0] * w[0]);
    residuals.windows(2).filter(|w| w[0] < 1e-2).map(ratio).fold(0.0, f64::max)
}

/// The constant of the tail tells Newton's method from one whose derivative is off by a hundredth beside the diagonal.
#[test]
fn the_tail_of_a_wrong_derivative_is_not_quadratic() {
    let (mesh, lengths) = surface(&shapes::genus(2, 2).unwrap());
    let start = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::H2)).unwrap().metric;
    let n = mesh.n_vertices();
    let tail = |wrong: f64| {
        let (mut metric, mut residuals) = (start.clone(), Vec::new());
        for _ in 0..12 {
            let k = metric.curvature(&mesh).unwrap().at;
            residuals.push(k.iter().fold(0.0, |m: f64, k| m.max(k.abs())));
            let mut matrix = vec![vec![0.0; n + 1]; n];
            for (i, j, x) in curvature_derivative(&mesh, &metric).unwrap() {
                let x = if i == j { x } else { x * (1.0 + wrong) };
                (matrix[i.index()][j.index()], matrix[j.index()][i.index()]) = (x, x);
            }
            k.iter().enumerate().for_each(|(i, k)| matrix[i][n] = -k);
            let step = solved(matrix);
            step.iter().enumerate().for_each(|(i, step)| metric.u[i.into()] += step);
        }
        residuals
    };
    let [right, wrong] = [0.0, -0.01].map(|wrong| tail_constant(&tail(wrong)));
    println!("r' ≤ C r² with C = {right:.2}, of the wrong derivative {wrong:.1e}");
    assert!(right <= QUADRATIC && wrong > 100.0 * QUADRATIC, "{right} {wrong}");
}

/// The solution of a definite system, whose right-hand side is the last column, by elimination.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for k in 0..n {
        let pivot = rows[k].clone();
        for row in rows.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot[k];
            (k..=n).for_each(|j| row[j] -= factor * pivot[j]);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (mesh, lengths) = surface(&shapes::genus(3, 12).unwrap());
    assert!(mesh.n_vertices() > 8000);
    for scheme in [Scheme::Yamabe, Scheme::Thurston] {
        let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::H2)).unwrap();
        let target = PerVertex::filled(mesh.n_vertices(), 0.0);
        let bits = |threads| {
            let options = Options { threads, ..rigid() };
            let (metric, report) = solve(&mesh, &initial.metric, &target, &options);
            converged(&report);
            metric.u.iter().map(|u| u.to_bits()).collect::<Vec<_>>()
        };
        let one = bits(1);
        assert_eq!(one, bits(2));
        assert_eq!(one, bits(3));
    }
}

#[test]
fn inversive_distance_and_vertex_scaling_represent_the_input_exactly() {
    let (mesh, lengths) = surface(&shapes::ellipsoid([1.0, 2.0, 0.7], 6).unwrap());
    for scheme in EXACT {
        let initial = initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::E2)).unwrap();
        let back = initial.metric.lengths(&mesh).unwrap();
        assert!(mesh.edges().all(|e| (back[e] / lengths[e] - 1.0).abs() < 1e-13), "{scheme}");
        assert_eq!((initial.clamped_edges, initial.max_length_change), (0, 0.0));
        assert!(initial.conformal_factor(&initial.metric).unwrap().iter().all(|f| f.abs() < 1e-14));
        if scheme == Scheme::Inversive {
            assert!(initial.metric.eta.iter().all(|eta| eta.high >= 1.0 - 1e-12));
        }
    }
    let thurston =
        initial_metric(&mesh, &lengths, Space::E2, Class::new(Scheme::Thurston, Space::E2)).unwrap();
    assert!(thurston.clamped_edges > 0 && thurston.max_length_change > 0.0);
    assert!(thurston.metric.eta.iter().all(|eta| (0.0..=1.0).contains(&eta.high)));
}

//! One shared test of the derivative, for every space × scheme and for mixed types: against central differences,
//! against the chain rule and automatic differentiation of plain cosine laws (independent implementations), and as an
//! exact 1-form.

use crate::common::Random;
use num_dual::{Dual64, DualNum};
use ricci::flow::curvature_derivative;
use ricci::geometry::{Space, triangle};
use ricci::mesh::{FaceId, Mesh, PerEdge, PerVertex};
use ricci::metric::initial::{MixedClass, initial_mixed};
use ricci::metric::{Class, Metric, Scheme, curvature, initial_metric};

const SPACES: [Space; 3] = [Space::E2, Space::H2, Space::S2];

/// An octahedron, a disk of six triangles around a vertex, and the torus with one vertex (loops and multi-edges).
fn surfaces() -> Vec<(&'static str, Mesh)> {
    let octahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];
    let disk: Vec<[u32; 3]> = (0..6).map(|i| [6, i, (i + 1) % 6]).collect();
    let torus = Mesh::from_gluing(1, &[[0; 3]; 2], &[[2, -3, 1], [-1, -2, 3]]);
    vec![
        ("octahedron", Mesh::from_faces(6, &octahedron).unwrap()),
        ("disk", Mesh::from_faces(7, &disk).unwrap()),
        ("one-vertex torus", torus.unwrap()),
    ]
}

/// A random metric near the equilateral one: of a scheme, or (`None`) with mixed types. The torus has a single
/// vertex and so a single type.
fn random_metric(mesh: &Mesh, space: Space, scheme: Option<Scheme>, random: &mut Random) -> Metric {
    let size = if space == Space::S2 { 0.5 } else { 0.8 };
    let lengths = PerEdge::from_fn(mesh.n_edges(), |_| size * (1.0 + 0.1 * random.symmetric()));
    let mut metric = match scheme {
        Some(scheme) => initial_metric(mesh, &lengths, space, Class::new(scheme, space)).unwrap().metric,
        None => {
            let epsilon = PerVertex::from_fn(mesh.n_vertices(), |_| (3.0 * random.unit()) as i8 - 1);
            let radii = PerVertex::from_fn(mesh.n_vertices(), |_| size * (0.2 + 0.2 * random.unit()));
            initial_mixed(mesh, &lengths, space, MixedClass { epsilon, radii, space }).unwrap().metric
        }
    };
    metric.u.iter_mut().for_each(|u| *u += 0.05 * random.symmetric());
    metric
}

fn all_metrics(mut test: impl FnMut(&str, &Mesh, &Metric)) {
    let mut random = Random::new(7);
    for (name, mesh) in surfaces() {
        for space in SPACES {
            for scheme in Scheme::ALL.into_iter().map(Some).chain([None, None, None]) {
                let metric = random_metric(&mesh, space, scheme, &mut random);
                test(&format!("{name} {space} {scheme:?}"), &mesh, &metric);
            }
        }
    }
}

fn curvatures(mesh: &Mesh, metric: &Metric, u: Vec<f64>) -> Vec<f64> {
    let metric = Metric { u: u.into(), ..metric.clone() };
    let k = curvature(mesh, metric.space, &metric.lengths(mesh).unwrap()).unwrap();
    assert!(k.broken.is_empty());
    assert!(k.gauss_bonnet <= 1e-12, "Gauss–Bonnet residual {}", k.gauss_bonnet);
    k.at.into_vec()
}

/// The matrix as a dense one.
fn matrix(mesh: &Mesh, metric: &Metric) -> Vec<Vec<f64>> {
    let n = mesh.n_vertices();
    let mut dense = vec![vec![0.0; n]; n];
    for (i, j, x) in curvature_derivative(mesh, metric).unwrap() {
        dense[i.index()][j.index()] = x;
        dense[j.index()][i.index()] = x;
    }
    dense
}

/// ∂θ_i/∂u_j of one face by the chain rule through its lengths, `dθ_i = f(l_i)/A (dl_i − cos θ_k dl_j − cos θ_j dl_k)`
/// with `A = f(l_j) f(l_k) sin θ_i`: nothing makes it symmetric but the theorem.
fn angle_block(mesh: &Mesh, metric: &Metric, f: FaceId) -> [[f64; 3]; 3] {
    let (space, corners, edges) = (metric.space, mesh.face_vertices(f), mesh.opposite_edges(f));
    let lengths = metric.lengths(mesh).unwrap();
    let l = edges.map(|e| lengths[e]);
    let theta = triangle::angles(space, l).at;
    let x = corners.map(|v| f64::from(metric.epsilon[v]) * (2.0 * metric.u[v]).exp());
    let sine = |l: f64| match space {
        Space::E2 => l,
        Space::H2 => l.sinh(),
        Space::S2 => l.sin(),
    };
    // dl[k][j]: derivative of the length opposite corner k along u_j, from the length formulas of notation.md §2.
    let mut dl = [[0.0; 3]; 3];
    for k in 0..3 {
        for (i, j) in [((k + 1) % 3, (k + 2) % 3), ((k + 2) % 3, (k + 1) % 3)] {
            let cross = metric.eta[edges[k]].high * (metric.u[corners[i]] + metric.u[corners[j]]).exp();
            dl[k][i] = match space {
                Space::E2 => (x[i] + cross) / l[k],
                Space::H2 => {
                    let scale = (1.0 - x[i]) * (1.0 - x[j]);
                    let numerator = (2.0 * x[i] * (1.0 + x[j]) + 4.0 * cross) / scale;
                    (numerator + l[k].cosh() * 2.0 * x[i] / (1.0 - x[i])) / l[k].sinh()
                }
                Space::S2 => {
                    let scale = (1.0 + x[i]) * (1.0 + x[j]);
                    let numerator = (2.0 * x[i] * (1.0 - x[j]) + 4.0 * cross) / scale;
                    (numerator + l[k].cos() * 2.0 * x[i] / (1.0 + x[i])) / l[k].sin()
                }
            };
        }
    }
    let mut block = [[0.0; 3]; 3];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let area = sine(l[j]) * sine(l[k]) * theta[i].sin();
        for m in 0..3 {
            let change = dl[i][m] - theta[k].cos() * dl[j][m] - theta[j].cos() * dl[k][m];
            block[i][m] = sine(l[i]) / area * change;
        }
    }
    block
}

/// Size of what is added up in ∂K/∂u: the largest entry of any face's block. (On the flat torus with one vertex the
/// sum is zero.)
fn scale(mesh: &Mesh, metric: &Metric) -> f64 {
    let blocks = mesh.faces().flat_map(|f| angle_block(mesh, metric, f));
    blocks.flatten().fold(0.0, |m, x| f64::max(m, x.abs()))
}

#[test]
fn derivative_of_the_angles_is_symmetric_and_is_ours() {
    all_metrics(|name, mesh, metric| {
        let mut total = vec![vec![0.0; mesh.n_vertices()]; mesh.n_vertices()];
        let bound = 1e-12 * scale(mesh, metric);
        for f in mesh.faces() {
            let (block, corners) = (angle_block(mesh, metric, f), mesh.face_vertices(f));
            for i in 0..3 {
                for j in 0..3 {
                    assert!((block[i][j] - block[j][i]).abs() <= bound, "{name} face {f} ({i}, {j})");
                    total[corners[i].index()][corners[j].index()] -= block[i][j];
                }
            }
        }
        let ours = matrix(mesh, metric);
        for (ours, theirs) in ours.iter().flatten().zip(total.iter().flatten()) {
            assert!((ours - theirs).abs() <= 10.0 * bound, "{name}: {ours} {theirs}");
        }
    });
}

#[test]
fn derivative_of_curvature_agrees_with_central_differences() {
    let h = 1e-5;
    all_metrics(|name, mesh, metric| {
        let (ours, bound) = (matrix(mesh, metric), 1e-6 * scale(mesh, metric));
        for j in 0..mesh.n_vertices() {
            let moved = |h: f64| {
                let mut u = metric.u.to_vec();
                u[j] += h;
                curvatures(mesh, metric, u)
            };
            let (plus, minus) = (moved(h), moved(-h));
            for i in 0..mesh.n_vertices() {
                let difference = (plus[i] - minus[i]) / (2.0 * h);
                assert!((ours[i][j] - difference).abs() <= bound, "{name} ({i}, {j})");
            }
        }
    });
}

/// ∂K/∂u by dual numbers through the formulas of notation.md §2 and the cosine laws, as printed.
fn automatic(mesh: &Mesh, metric: &Metric) -> Vec<Vec<f64>> {
    let n = mesh.n_vertices();
    let mut dense = vec![vec![0.0; n]; n];
    for j in 0..n {
        let u: Vec<Dual64> =
            (0..n).map(|i| Dual64::new(metric.u[i.into()], if i == j { 1.0 } else { 0.0 })).collect();
        let length = |e| {
            let [a, b] = mesh.ends(e);
            let ea = f64::from(metric.epsilon[a]);
            let eb = f64::from(metric.epsilon[b]);
            let (xa, xb) = ((u[a.index()] * 2.0).exp() * ea, (u[b.index()] * 2.0).exp() * eb);
            let cross = (u[a.index()] + u[b.index()]).exp() * metric.eta[e].high;
            match metric.space {
                Space::E2 => (cross * 2.0 + xa + xb).sqrt(),
                Space::H2 => {
                    let cosh = (cross * 4.0 + (xa + 1.0) * (xb + 1.0)) / ((-xa + 1.0) * (-xb + 1.0));
                    (cosh + (cosh * cosh - 1.0).sqrt()).ln()
                }
                Space::S2 => ((cross * -4.0 + (-xa + 1.0) * (-xb + 1.0)) / ((xa + 1.0) * (xb + 1.0))).acos(),
            }
        };
        for f in mesh.faces() {
            let l = mesh.opposite_edges(f).map(length);
            for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
                let (a, b, c) = (l[(k + 1) % 3], l[(k + 2) % 3], l[k]);
                let cos = match metric.space {
                    Space::E2 => (a * a + b * b - c * c) / (a * b * 2.0),
                    Space::H2 => (a.cosh() * b.cosh() - c.cosh()) / (a.sinh() * b.sinh()),
                    Space::S2 => (c.cos() - a.cos() * b.cos()) / (a.sin() * b.sin()),
                };
                dense[v.index()][j] -= cos.acos().eps;
            }
        }
    }
    dense
}

#[test]
fn derivative_of_curvature_is_symmetric_and_agrees_with_automatic_differentiation() {
    all_metrics(|name, mesh, metric| {
        let (ours, theirs) = (matrix(mesh, metric), automatic(mesh, metric));
        let bound = 1e-12 * scale(mesh, metric);
        for i in 0..mesh.n_vertices() {
            for j in 0..mesh.n_vertices() {
                assert!((theirs[i][j] - theirs[j][i]).abs() <= bound, "{name}: not symmetric");
                // The plain cosine laws lose a digit or two themselves.
                assert!((ours[i][j] - theirs[i][j]).abs() <= 10.0 * bound, "{name} ({i}, {j})");
            }
        }
    });
}

#[test]
fn derivative_is_semidefinite_in_the_plane_and_definite_in_the_hyperbolic_plane() {
    let mut random = Random::new(3);
    all_metrics(|name, mesh, metric| {
        let ours = matrix(mesh, metric);
        let n = ours.len();
        for _ in 0..20 {
            let x: Vec<f64> = (0..n).map(|_| random.symmetric()).collect();
            let form: f64 = (0..n).map(|i| (0..n).map(|j| x[i] * ours[i][j] * x[j]).sum::<f64>()).sum();
            let square: f64 = x.iter().map(|x| x * x).sum();
            match metric.space {
                Space::E2 => assert!(form >= -1e-13, "{name}: {form}"),
                Space::H2 => assert!(form >= 1e-3 * square, "{name}: {form}"),
                Space::S2 => {}
            }
        }
        if metric.space == Space::E2 {
            for row in &ours {
                assert!(row.iter().sum::<f64>().abs() < 1e-13, "{name}: constants are in the kernel");
            }
        }
    });
}

/// Curvature from the variables, whatever breaks; `None` where an edge has no length. And the number of broken faces.
fn extended(mesh: &Mesh, metric: &Metric, u: Vec<f64>) -> Option<(Vec<f64>, usize)> {
    let k = Metric { u: u.into(), ..metric.clone() }.curvature(mesh).ok()?;
    Some((k.at.into_vec(), k.broken.len()))
}

/// The t, to rounding, at which the first triangle along `u + t direction` breaks. `None` where none does within reach, or an edge loses
/// its length first.
fn breaking_point(mesh: &Mesh, metric: &Metric, direction: &[f64]) -> Option<f64> {
    let broken = |t: f64| {
        let u = metric.u.iter().zip(direction).map(|(u, d)| u + t * d).collect();
        extended(mesh, metric, u).map(|(_, broken)| broken > 0)
    };
    let mut high = (1..600).map(|k| 0.01 * f64::from(k)).find(|&t| broken(t) != Some(false))?;
    let mut low = high - 0.01;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match broken(middle)? {
            true => high = middle,
            false => low = middle,
        }
    }
    (broken(high) == Some(true)).then_some(high)
}

/// The matrix at `u + t direction` against differences there, as far as `reach` to either side: central ones, and one-sided ones.
/// Returns how far each is off, relative to the largest entry.
fn against_differences(mesh: &Mesh, at: &Metric, h: f64, broken: usize, what: &str) -> [f64; 2] {
    let ours = matrix(mesh, at);
    let largest = ours.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
    let mut worst = [0.0f64; 2];
    let moved = |j: usize, h: f64| {
        let mut u = at.u.to_vec();
        u[j] += h;
        let (k, now) = extended(mesh, at, u).unwrap();
        assert_eq!(now, broken, "{what}: the step is too long");
        k
    };
    for j in 0..mesh.n_vertices() {
        let [plus, here, minus] = [h, 0.0, -h].map(|h| moved(j, h));
        for i in 0..mesh.n_vertices() {
            let central = (plus[i] - minus[i]) / (2.0 * h);
            let sides = [(plus[i] - here[i]) / h, (here[i] - minus[i]) / h];
            worst[0] = worst[0].max((ours[i][j] - central).abs() / largest);
            worst[1] = sides.iter().fold(worst[1], |m, side| m.max((ours[i][j] - side).abs() / largest));
        }
    }
    worst
}

/// Next to a triangle that is about to break its angles move as the root of the distance, on the other side not at all: the matrix says
/// both, for every space and scheme whose triangles can break.
#[test]
fn derivative_is_right_next_to_triangles_that_break() {
    let mut random = Random::new(29);
    let mut tested = 0;
    for (name, mesh) in &surfaces()[..2] {
        for space in SPACES {
            for scheme in Scheme::ALL {
                let metric = random_metric(mesh, space, Some(scheme), &mut random);
                let n = mesh.n_vertices();
                let first =
                    (0..n).map(|v| (0..n).map(|w| if v == w { -1.0 } else { 0.0 }).collect::<Vec<f64>>());
                let more: Vec<Vec<f64>> =
                    (0..20).map(|_| (0..n).map(|_| random.symmetric()).collect()).collect();
                let found = first.chain(more).find_map(|d| breaking_point(mesh, &metric, &d).map(|t| (t, d)));
                // Any three circles that meet at right angles or less have a triangle, but on the sphere.
                let never = matches!(scheme, Scheme::Thurston | Scheme::Tangential) && space != Space::S2;
                assert_eq!(found.is_none(), never, "{name} {space} {scheme}: {found:?}");
                let Some((t, direction)) = found else { continue };
                for distance in [1e-2f64, 1e-4, 1e-6] {
                    for side in [-1.0, 1.0] {
                        let at = |t: f64| {
                            metric.u.iter().zip(&direction).map(|(u, d)| u + t * d).collect::<Vec<_>>()
                        };
                        let u = at(t + side * distance);
                        let Some((_, broken)) = extended(mesh, &metric, u.clone()) else { continue };
                        let what = format!("{name} {space} {scheme}, {:e} from {t}", side * distance);
                        assert_eq!(broken > 0, side > 0.0, "{what}");
                        let here = Metric { u: u.into(), ..metric.clone() };
                        let [central, sided] =
                            against_differences(mesh, &here, 1e-4 * distance, broken, &what);
                        println!(
                            "{what}: central differences off by {central:.1e}, one-sided by {sided:.1e}"
                        );
                        // Rounding of K over the step, and the root's second and third derivatives.
                        let rounding = 1e-14 / (1e-4 * distance);
                        assert!(central < 1e-6 + rounding && sided < 1e-3 + rounding, "{what}");
                        tested += 1;
                    }
                }
            }
        }
    }
    assert!(tested > 100, "{tested}");
}

/// Gauss–Legendre nodes and weights on [0, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// `∫ Σ (K − K̄) du` along the straight line from `metric.u` to `end`.
fn energy(mesh: &Mesh, metric: &Metric, target: &[f64], end: &[f64]) -> f64 {
    let start = metric.u.to_vec();
    let along = |(t, w): &(f64, f64)| {
        let u = start.iter().zip(end).map(|(a, b)| a + t * (b - a)).collect();
        let k = curvatures(mesh, metric, u);
        let form = |i: usize| (k[i] - target[i]) * (end[i] - start[i]);
        w * (0..k.len()).map(form).sum::<f64>()
    };
    GAUSS.iter().map(along).sum()
}

#[test]
fn gradient_of_the_energy_is_the_curvature_error() {
    let mut random = Random::new(11);
    all_metrics(|name, mesh, metric| {
        let n = mesh.n_vertices();
        let target: Vec<f64> = (0..n).map(|_| random.symmetric()).collect();
        let end: Vec<f64> = metric.u.iter().map(|u| u + 0.05 * random.symmetric()).collect();
        let k = curvatures(mesh, metric, end.clone());
        let gradient: Vec<f64> = k.iter().zip(&target).map(|(k, t)| k - t).collect();
        let largest = gradient.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
        let h = 1e-4;
        for i in 0..n {
            let moved = |h: f64| {
                let mut end = end.clone();
                end[i] += h;
                energy(mesh, metric, &target, &end)
            };
            let difference = (moved(h) - moved(-h)) / (2.0 * h);
            assert!((difference - gradient[i]).abs() <= 1e-6 * largest, "{name} vertex {i}");
        }
    });
}

#[test]
fn curvature_evolves_by_its_derivative_along_the_flow() {
    // dK/dt = (∂K/∂u)(K̄ − K)
    let mut random = Random::new(5);
    all_metrics(|name, mesh, metric| {
        let n = mesh.n_vertices();
        let k = curvatures(mesh, metric, metric.u.to_vec());
        let speed: Vec<f64> = k.iter().map(|k| k * 0.1 + 0.1 * random.symmetric() - k).collect();
        let h = 1e-6;
        let moved =
            |h: f64| curvatures(mesh, metric, metric.u.iter().zip(&speed).map(|(u, s)| u + h * s).collect());
        let (plus, minus, ours) = (moved(h), moved(-h), matrix(mesh, metric));
        let bound = 1e-6 * scale(mesh, metric) * speed.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        for i in 0..n {
            let rate = (plus[i] - minus[i]) / (2.0 * h);
            let predicted: f64 = (0..n).map(|j| ours[i][j] * speed[j]).sum();
            assert!((rate - predicted).abs() <= bound, "{name} vertex {i}");
        }
    });
}

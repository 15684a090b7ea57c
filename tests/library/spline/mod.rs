//! Triangular B-splines against their theorems and against the bare recurrence.

mod bicubic;
mod closed;
mod closest;
#[cfg(feature = "json")]
mod files;
mod fit;
mod knots;
mod quad;
mod quad_places;
#[cfg(feature = "step")]
mod quad_step;
mod quad_strips;
mod smooth;

use ricci::spline::{
    KnotOptions, Parameter, Patch, PlaneDomain, Polynomial, Spline, SplineSpace, Support, monomials,
    multi_indices, simplex_spline, simplex_spline_gradient,
};
use ricci::{Control, Error};
use std::sync::Arc;

/// Pseudo-random numbers between 0 and 1, the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A place in a patch.
    fn place(&mut self, space: &SplineSpace) -> Parameter {
        let patch = (self.next() * space.patches().len() as f64) as u32;
        let (mut s, mut t) = (self.next(), self.next());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let corners = [0, 1, 2].map(|k| space.patches()[patch as usize].knots[k][0]);
        let [x, y] = [0, 1].map(|x| corners[0][x] * (1.0 - s - t) + corners[1][x] * s + corners[2][x] * t);
        Parameter { patch, x, y }
    }
}

/// A square whose n × n cells are moved about a little and cut in two.
fn square(n: usize) -> PlaneDomain {
    let mut random = Random(7);
    let mut vertices = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let inner = i > 0 && j > 0 && i < n && j < n;
            let mut moved =
                |k: usize| (k as f64 + if inner { 0.4 * (random.next() - 0.5) } else { 0.0 }) / n as f64;
            vertices.push([moved(i), moved(j)]);
        }
    }
    let at = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let cells = (0..n * n).map(|c| (c % n, c / n));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    });
    PlaneDomain { vertices, triangles: triangles.collect() }
}

fn space(n: usize, degree: usize) -> Arc<SplineSpace> {
    let domain = square(n);
    let knots = domain.knots(degree, &KnotOptions::default()).unwrap();
    Arc::new(SplineSpace::planar(&domain, &knots).unwrap())
}

/// A surface with pseudo-random control points.
fn random_surface(space: &Arc<SplineSpace>) -> Spline {
    let mut random = Random(3);
    let points = (0..space.n_control_points()).map(|_| [random.next(), random.next(), random.next()]);
    Spline::new(space.clone(), points.collect()).unwrap()
}

fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|x| (a[x] - b[x]).abs()).fold(0.0, f64::max)
}

#[test]
fn control_points_are_shared_as_lagrange_nodes_are() {
    let (n, cells) = (4, 16);
    for degree in 1..=5 {
        let nodes = (n * degree + 1) * (n * degree + 1);
        assert_eq!(space(n, degree).n_control_points(), nodes, "{degree} {cells}");
    }
}

#[test]
fn the_basis_is_a_partition_of_unity() {
    for degree in 1..=5 {
        let space = space(4, degree);
        let ones = Spline::new(space.clone(), vec![[1.0, 0.0, 0.0]; space.n_control_points()]).unwrap();
        let mut random = Random(1);
        for _ in 0..2000 {
            let at = random.place(&space);
            let found = ones.surface_point(at).unwrap();
            assert!((found.point[0] - 1.0).abs() < 1e-12, "{degree} {at:?} {found:?}");
            assert!(difference(found.first[0], [0.0; 3]) < 1e-9, "{degree} {at:?} {found:?}");
        }
    }
}

#[test]
fn polynomials_are_reproduced_with_their_derivatives() {
    let mut random = Random(5);
    for degree in 1..=5 {
        let space = space(4, degree);
        let coefficients: Vec<[f64; 3]> =
            monomials(degree).map(|_| [random.next(), random.next(), random.next()]).collect();
        let polynomial = Polynomial::new(degree, coefficients.clone());
        let surface = Spline::new(space.clone(), space.control_points_of(&polynomial).unwrap()).unwrap();
        let power = |x: f64, p: usize, d: usize| match d {
            d if d > p => 0.0,
            d => (p - d + 1..=p).map(|k| k as f64).product::<f64>() * x.powi((p - d) as i32),
        };
        for _ in 0..1000 {
            let at = random.place(&space);
            let found = surface.surface_point(at).unwrap();
            let exact = |dx: usize, dy: usize| {
                monomials(degree).zip(&coefficients).fold([0.0; 3], |sum, ((p, q), c)| {
                    let term = power(at.x, p, dx) * power(at.y, q, dy);
                    [0, 1, 2].map(|x| sum[x] + c[x] * term)
                })
            };
            assert!(difference(found.point, exact(0, 0)) < 1e-12, "{degree} {at:?}");
            assert!(difference(found.point, polynomial.value([at.x, at.y])) < 1e-12, "{degree} {at:?}");
            assert!(difference(found.first[0], exact(1, 0)) < 1e-10, "{degree} {at:?}");
            assert!(difference(found.first[1], exact(0, 1)) < 1e-10, "{degree} {at:?}");
            if degree > 1 {
                for (second, (dx, dy)) in found.second.into_iter().zip([(2, 0), (1, 1), (0, 2)]) {
                    assert!(
                        difference(second, exact(dx, dy)) < 1e-7,
                        "{degree} {at:?} {second:?} {:?}",
                        exact(dx, dy)
                    );
                }
            }
        }
    }
}

#[test]
fn shared_recurrence_and_bare_one_agree() {
    for degree in 1..=4 {
        let space = space(3, degree);
        let surface = random_surface(&space);
        let mut random = Random(11);
        for _ in 0..100 {
            let at = random.place(&space);
            let (mut value, mut slope) = ([0.0; 3], [[0.0; 3]; 2]);
            for patch in space.patches() {
                for (beta, &control) in multi_indices(degree).zip(&patch.control) {
                    let set: Vec<[f64; 2]> =
                        (0..3).flat_map(|k| patch.knots[k][..=beta[k]].to_vec()).collect();
                    let [a, b, c] = [0, 1, 2].map(|k| patch.knots[k][beta[k]]);
                    let d = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
                    let m = simplex_spline(&set, [at.x, at.y]);
                    let gradient = simplex_spline_gradient(&set, [at.x, at.y]);
                    let point = surface.control_points()[control as usize];
                    for x in 0..3 {
                        value[x] += d * m * point[x];
                        (0..2).for_each(|y| slope[y][x] += d * gradient[y] * point[x]);
                    }
                }
            }
            let found = surface.surface_point(at).unwrap();
            assert!(difference(found.point, value) < 1e-12, "{degree} {at:?} {:?} {value:?}", found.point);
            for (first, slope) in found.first.into_iter().zip(slope) {
                assert!(difference(first, slope) < 1e-9, "{degree} {at:?} {first:?} {slope:?}");
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_finite_differences() {
    let space = space(3, 4);
    let surface = random_surface(&space);
    let mut random = Random(2);
    let h = 1e-5;
    for _ in 0..200 {
        let at = random.place(&space);
        let moved =
            |x: f64, y: f64| surface.surface_point(Parameter { x: at.x + x * h, y: at.y + y * h, ..at });
        let (Ok(east), Ok(west), Ok(north), Ok(south)) =
            (moved(1.0, 0.0), moved(-1.0, 0.0), moved(0.0, 1.0), moved(0.0, -1.0))
        else {
            continue;
        };
        let here = surface.surface_point(at).unwrap();
        let quotient = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|x| (a[x] - b[x]) / (2.0 * h));
        assert!(difference(here.first[0], quotient(east.point, west.point)) < 1e-5);
        assert!(difference(here.first[1], quotient(north.point, south.point)) < 1e-5);
        assert!(difference(here.second[0], quotient(east.first[0], west.first[0])) < 1e-2);
        assert!(difference(here.second[1], quotient(east.first[1], west.first[1])) < 1e-2);
        assert!(difference(here.second[2], quotient(north.first[1], south.first[1])) < 1e-2);
    }
}

#[test]
fn places_outside_and_other_bad_input_have_names() {
    let space = space(2, 3);
    let surface = random_surface(&space);
    for (at, index) in [((0, 2.0, 2.0), 0), ((99, 0.0, 0.0), 99), ((0, f64::NAN, 0.0), 0)] {
        let (patch, x, y) = at;
        let refused = surface.point(Parameter { patch, x, y });
        assert!(
            matches!(refused, Err(Error::Spline { what: "patch", index: i, .. }) if i == index),
            "{refused:?}"
        );
    }
    for degree in [0, 6] {
        let refused = square(2).knots(degree, &KnotOptions::default());
        assert!(matches!(refused, Err(Error::Argument { what: "degree", .. })), "{refused:?}");
        let text = refused.unwrap_err().to_string();
        assert!(text.contains(&degree.to_string()) && text.contains("1 to 5"), "{text}");
    }
    for spread in [0.0, 1.0, f64::NAN] {
        let refused = square(2).knots(3, &KnotOptions { spread, ..KnotOptions::default() });
        assert!(matches!(refused, Err(Error::Argument { what: "spread", .. })), "{refused:?}");
    }
    for options in [
        KnotOptions { coincident: vec![0, 9], ..KnotOptions::default() },
        KnotOptions { creases: vec![[9, 0]], ..KnotOptions::default() },
    ] {
        let refused = square(2).knots(3, &options);
        assert!(matches!(refused, Err(Error::Spline { what: "vertex", index: 9, .. })), "{refused:?}");
    }
    let mut turned = square(2);
    turned.triangles[5].swap(0, 1);
    let refused = turned.knots(3, &KnotOptions::default());
    assert!(matches!(refused, Err(Error::Spline { what: "triangle", index: 5, .. })), "{refused:?}");
    let mut knots = square(2).knots(2, &KnotOptions::default()).unwrap();
    knots[4] = vec![[0.5, 0.5], [0.0, 0.0], [1.0, 1.0]];
    let crossed = SplineSpace::planar(&square(2), &knots).unwrap_err();
    assert!(matches!(crossed, Error::Spline { what: "patch", .. }), "{crossed}");
    // Three knots of different corners on a line.
    let [a, b] = [square(2).vertices[0], square(2).vertices[1]];
    let mut knots = square(2).knots(1, &KnotOptions::default()).unwrap();
    knots[4][1] = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let collinear = SplineSpace::planar(&square(2), &knots).unwrap_err().to_string();
    assert!(collinear.contains("on a line") && collinear.contains("t[0][0]"), "{collinear}");
    let places = [Parameter { patch: 0, x: 5.0, y: 0.0 }];
    assert!(surface.evaluate(&places, 0, 1, &Control::new()).is_err());
}

/// The derivative of order k along a segment from a place, in the direction of the segment.
fn along(surface: &Spline, at: Parameter, [dx, dy]: [f64; 2], order: usize) -> [f64; 3] {
    let found = surface.surface_point(at).unwrap();
    let ([x, y], [xx, xy, yy]) = (found.first, found.second);
    [0, 1, 2].map(|k| match order {
        0 => found.point[k],
        1 => dx * x[k] + dy * y[k],
        _ => dx * dx * xx[k] + 2.0 * dx * dy * xy[k] + dy * dy * yy[k],
    })
}

/// The largest jumps of the derivative of order n − 1 and of its slope, over the largest value of each, at the lines through pairs of knots
/// that cross a segment inside a patch.
fn jumps(surface: &Spline, patch: usize) -> [f64; 2] {
    let space = surface.space();
    let order = space.degree() - 1;
    let corners = [0, 1, 2].map(|k| space.patches()[patch].knots[k][0]);
    // From near one corner to near the middle of the other side.
    let from = [0, 1].map(|x| 0.9 * corners[0][x] + 0.06 * corners[1][x] + 0.04 * corners[2][x]);
    let to = [0, 1].map(|x| 0.02 * corners[0][x] + 0.47 * corners[1][x] + 0.51 * corners[2][x]);
    let direction = [to[0] - from[0], to[1] - from[1]];
    let place = |s: f64| Parameter {
        patch: patch as u32,
        x: from[0] + s * direction[0],
        y: from[1] + s * direction[1],
    };
    let value = |s: f64| along(surface, place(s), direction, order);
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let mut lines = vec![0.0, 1.0];
    for support in &space.supports()[patch] {
        let knots = space.patches()[support.patch as usize].knots.concat();
        for (i, a) in knots.iter().enumerate() {
            for b in &knots[i + 1..] {
                let side = [b[0] - a[0], b[1] - a[1]];
                let s = cross([a[0] - from[0], a[1] - from[1]], side) / cross(direction, side);
                lines.extend((0.0 < s && s < 1.0).then_some(s));
            }
        }
    }
    lines.sort_by(f64::total_cmp);
    lines.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let (mut value_jump, mut slope_jump, mut largest, mut steepest) =
        (0.0f64, 0.0f64, f64::MIN_POSITIVE, f64::MIN_POSITIVE);
    let slope = |a: f64, b: f64| {
        let (low, high) = (value(a + 0.1 * (b - a)), value(b - 0.1 * (b - a)));
        [0, 1, 2].map(|x| (high[x] - low[x]) / (0.8 * (b - a)))
    };
    for around in lines.windows(3).filter(|w| (w[1] - w[0]).min(w[2] - w[1]) > 1e-4) {
        let h = 1e-12;
        let (below, above) = (value(around[1] - h), value(around[1] + h));
        value_jump = value_jump.max(difference(below, above));
        largest = largest.max(difference(below, [0.0; 3]));
        let (left, right) = (slope(around[0], around[1]), slope(around[1], around[2]));
        slope_jump = slope_jump.max(difference(left, right));
        steepest = steepest.max(difference(left, [0.0; 3]));
    }
    [value_jump / largest, slope_jump / steepest]
}

#[test]
fn derivatives_are_continuous_up_to_the_degree_less_one() {
    for degree in 1..=3 {
        let space = space(3, degree);
        let surface = random_surface(&space);
        let mut roughest = 0.0f64;
        for patch in 0..space.patches().len() {
            let [value, slope] = jumps(&surface, patch);
            assert!(value < 1e-8, "{degree} {patch}: {value:e}");
            roughest = roughest.max(slope);
        }
        // The n-th derivative is constant between the lines and jumps at them; with degree 1 only between patches.
        assert!(degree == 1 || roughest > 1e-2, "{degree}: {roughest:e}");
    }
}

#[test]
fn knots_on_a_line_make_a_crease() {
    let domain = square(4);
    // A crease along the inner edge from vertex 7 up to 12: the knots of both ends coincide, or lie on its line.
    let options = KnotOptions { creases: vec![[7, 12]], ..KnotOptions::default() };
    let smooth = domain.knots(3, &KnotOptions::default()).unwrap();
    let creased = domain.knots(3, &options).unwrap();
    let slopes = |knots: &[Vec<[f64; 2]>]| {
        let space = Arc::new(SplineSpace::planar(&domain, knots).unwrap());
        let surface = random_surface(&space);
        let [a, b] = [domain.vertices[7], domain.vertices[12]];
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let across = [b[1] - a[1], a[0] - b[0]];
        let sides: Vec<u32> = (0..space.patches().len() as u32)
            .filter(|&p| [7, 12].iter().all(|v| domain.triangles[p as usize].contains(v)))
            .collect();
        let of = |patch: u32| {
            let found = [-1e-9, 1e-9].map(|h| Parameter {
                patch,
                x: middle[0] + h * across[0],
                y: middle[1] + h * across[1],
            });
            found
                .into_iter()
                .find_map(|at| surface.point(at).is_ok().then(|| along(&surface, at, across, 1)))
                .unwrap()
        };
        assert_eq!(sides.len(), 2);
        difference(of(sides[0]), of(sides[1]))
    };
    assert!(slopes(&smooth) < 1e-6);
    assert!(slopes(&creased) > 1e-2, "{}", slopes(&creased));
}

#[test]
fn charts_can_be_exchanged_by_affine_maps() {
    let mut random = Random(17);
    let space = space(3, 3);
    let surface = random_surface(&space);
    let places: Vec<Parameter> = (0..50).map(|_| random.place(&space)).collect();
    for _ in 0..100 {
        // Every patch has a chart of its own.
        let maps: Vec<[[f64; 3]; 2]> = (0..space.patches().len())
            .map(|_| {
                let (turn, size, shear) = (6.0 * random.next(), 0.3 + random.next(), random.next() - 0.5);
                let (c, s) = (size * turn.cos(), size * turn.sin());
                [[c, shear * c - s, 5.0 * random.next()], [s, shear * s + c, 5.0 * random.next()]]
            })
            .collect();
        let image = |m: &[[f64; 3]; 2], [x, y]: [f64; 2]| m.map(|[a, b, c]| a * x + b * y + c);
        let after = |m: &[[f64; 3]; 2], n: &[[f64; 3]; 2]| {
            // The map m ∘ n⁻¹.
            let [[a, b, e], [c, d, f]] = *n;
            let det = a * d - b * c;
            m.map(|[p, q, r]| {
                let (x, y) = ((p * d - q * c) / det, (q * a - p * b) / det);
                [x, y, r - x * e - y * f]
            })
        };
        let patches = space.patches().iter().zip(&maps).zip(0..).map(|((patch, map), chart)| Patch {
            chart,
            knots: patch.knots.clone().map(|of| of.into_iter().map(|knot| image(map, knot)).collect()),
            control: patch.control.clone(),
        });
        let supports = space.supports().iter().zip(&maps).map(|(of, map)| {
            of.iter().map(|s| Support { to: after(map, &maps[s.patch as usize]), ..*s }).collect()
        });
        let moved = SplineSpace::new(3, patches.collect(), supports.collect()).unwrap();
        let moved = Spline::new(Arc::new(moved), surface.control_points().to_vec()).unwrap();
        for &at in &places {
            let [x, y] = image(&maps[at.patch as usize], [at.x, at.y]);
            let there = moved.point(Parameter { x, y, ..at }).unwrap();
            assert!(difference(there, surface.point(at).unwrap()) < 1e-11);
        }
    }
}

#[test]
fn blossoms_are_the_polynomials_of_omega() {
    let space = space(3, 4);
    let surface = random_surface(&space);
    let mut random = Random(23);
    for patch in 0..space.patches().len() {
        let omega = surface.omega(patch);
        let centre = [0, 1].map(|x| omega.iter().map(|p| p[x]).sum::<f64>() / omega.len() as f64);
        let near = |random: &mut Random| {
            let corner = omega[(random.next() * omega.len() as f64) as usize];
            let share = random.next();
            [0, 1].map(|x| share * corner[x] + (1.0 - share) * centre[x])
        };
        let at = near(&mut random);
        let value = surface.point(Parameter { patch: patch as u32, x: at[0], y: at[1] }).unwrap();
        assert!(difference(value, surface.blossom(patch, &[at; 4]).unwrap()) < 1e-12);
        // The polar form is symmetric.
        let [a, b, c, d] = [(); 4].map(|()| near(&mut random));
        let (one, other) = (surface.blossom(patch, &[a, b, c, d]), surface.blossom(patch, &[d, b, a, c]));
        assert!(difference(one.unwrap(), other.unwrap()) < 1e-12);
    }
}

#[test]
fn spheres_and_saddles_have_their_curvatures() {
    // z = x²/2 − y² over the plane: at the origin the principal curvatures are 1 and −2.
    let space = space(2, 2);
    let mut coefficients = vec![[0.0; 3]; 6];
    coefficients[0] = [-0.5, -0.5, 0.125 - 0.25];
    coefficients[1] = [1.0, 0.0, -0.5];
    coefficients[2] = [0.0, 1.0, 1.0];
    (coefficients[3], coefficients[5]) = ([0.0, 0.0, 0.5], [0.0, 0.0, -1.0]);
    let points = space.control_points_of(&Polynomial::new(2, coefficients)).unwrap();
    let surface = Spline::new(space.clone(), points).unwrap();
    let centre = (0..space.patches().len() as u32)
        .find_map(|patch| surface.surface_point(Parameter { patch, x: 0.5, y: 0.5 }).ok())
        .unwrap();
    let [first, second] = centre.principal_curvatures().unwrap();
    assert!((first - 1.0).abs() < 1e-9 && (second + 2.0).abs() < 1e-9, "{first} {second}");
    assert!(difference(centre.normal().unwrap(), [0.0, 0.0, 1.0]) < 1e-9);
}

//! Domains of planar splines, and fits to points.

use crate::spline::{Random, random_surface, space};
use ricci::spline::{FitOptions, KnotOptions, Locator, Parameter, Spline, SplineSpace, fit, triangulate};
use ricci::{Control, Error};
use std::sync::Arc;

/// An L-shape of 2 × 2 with a triangular hole.
fn l_shape() -> Vec<Vec<[f64; 2]>> {
    vec![
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]],
        vec![[0.3, 0.3], [0.5, 0.7], [0.7, 0.3]],
    ]
}

#[test]
fn domains_have_the_area_of_their_polygons_and_every_point_is_found() {
    let domain = triangulate(&l_shape(), 0.15).unwrap();
    domain.check().unwrap();
    let area: f64 = domain
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| domain.vertices[v as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        })
        .sum();
    // Three corners of the hole and one of the L are reflex.
    let (rough, mut cut) = (domain.clone().make_ears(), domain.clone());
    assert_eq!((cut.make_ears(), &cut), (rough, &domain));
    assert!((4..12).contains(&rough), "{rough}");
    assert!((area - (3.0 - 0.5 * 0.4 * 0.4)).abs() < 1e-12, "{area}");
    let locator = Locator::new(&domain);
    for knots in [SplineSpace::planar(&domain, &domain.knots(3, &KnotOptions::default()).unwrap()).unwrap()] {
        let mut random = Random(31);
        for _ in 0..2000 {
            let at = random.place(&knots);
            assert_eq!(locator.locate([at.x, at.y]).unwrap().patch, at.patch);
        }
    }
    assert!(locator.locate([1.5, 1.5]).is_none() && locator.locate([0.5, 0.5]).is_none());
    assert!(locator.locate([-1.0, 9.0]).is_none());
    let crossing = vec![vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]];
    assert!(matches!(triangulate(&crossing, 0.1), Err(Error::Spline { what: "polygon", index: 0, .. })));
    assert!(triangulate(&l_shape(), 0.0).is_err() && triangulate(&l_shape(), 1e-9).is_err());
}

#[test]
fn fits_reproduce_polynomials_and_come_near_smooth_functions() {
    let domain = triangulate(&l_shape(), 0.3).unwrap();
    let locator = Locator::new(&domain);
    let mut random = Random(37);
    let places: Vec<Parameter> =
        std::iter::repeat_with(|| locator.locate([2.0 * random.next(), 2.0 * random.next()]))
            .flatten()
            .take(6000)
            .collect();
    let heights = |f: &dyn Fn(f64, f64) -> f64| -> Vec<[f64; 3]> {
        places.iter().map(|p| [p.x, p.y, f(p.x, p.y)]).collect()
    };
    let (wave, control) = (|x: f64, y: f64| (2.0 * x).sin() * (1.5 * y).cos(), Control::new());
    let mut errors = Vec::new();
    for degree in 1..=5 {
        let knots = domain.knots(degree, &KnotOptions::default()).unwrap();
        let space = Arc::new(SplineSpace::planar(&domain, &knots).unwrap());
        let none = FitOptions { fairness: 0.0, threads: 1 };
        let polynomial = heights(&|x, y| (1.0 + x - 2.0 * y).powi(degree as i32));
        let exact = fit(&space, &places, &polynomial, &none, &control).unwrap();
        assert!(exact.max < 1e-9, "{degree}: {:e}", exact.max);
        let smooth = fit(&space, &places, &heights(&wave), &FitOptions::default(), &control).unwrap();
        assert!(smooth.rms <= smooth.max);
        errors.push(smooth.max);
        let two = FitOptions { threads: 2, ..FitOptions::default() };
        let again = fit(&space, &places, &heights(&wave), &two, &control).unwrap();
        assert_eq!(again.spline.control_points(), smooth.spline.control_points());
    }
    // Each higher degree fits better.
    assert!(errors.windows(2).all(|e| e[1] < 0.5 * e[0]), "{errors:?}");
    let few = fit(
        &Arc::new(SplineSpace::planar(&domain, &domain.knots(3, &KnotOptions::default()).unwrap()).unwrap()),
        &places[..20],
        &heights(&wave)[..20],
        &FitOptions { fairness: 0.0, threads: 1 },
        &control,
    );
    assert!(matches!(few, Err(Error::Factorisation { .. })), "{few:?}");
}

#[test]
fn identities_are_measured() {
    for degree in 1..=5 {
        let surface = random_surface(&space(3, degree));
        let found = surface.identities(2, &Control::new()).unwrap();
        assert!(
            found.partition_of_unity < 1e-12 && found.polynomial_reproduction.unwrap() < 1e-10,
            "{degree} {found:?}"
        );
        assert!(found.continuity < 1e-8, "{degree} {found:?}");
        assert_eq!(found.rough_sides, 2, "{degree} {found:?}");
        // The second derivatives of a plane are rounding, so jumps of them tell nothing.
        let space = surface.space().clone();
        let plane = space.abscissas().iter().map(|&[x, y]| [x, y, 0.5 * x - y]).collect();
        let found = Spline::new(space, plane).unwrap().identities(1, &Control::new()).unwrap();
        assert!(found.continuity < 1e-8, "{degree} {found:?}");
    }
}

/// The advice at `fairness` in spline.h: with noise of 0.1 % of the size a weight of 1e-8 is nearer to the surface than the default, for few
/// points and for many.
#[test]
fn a_fairness_for_noise_of_a_thousandth() {
    let height = |x: f64, y: f64| 0.2 * (3.0 * x + 1.0).sin() * (4.0 * y).cos();
    let square = triangulate(&[vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]], 0.1).unwrap();
    let knots = square.knots(3, &KnotOptions::default()).unwrap();
    let space = Arc::new(SplineSpace::planar(&square, &knots).unwrap());
    let locator = Locator::new(&square);
    // Uniform noise with the root mean square 0.001 of the diagonal.
    let noise = 1e-3 * 2f64.sqrt() * 3f64.sqrt();
    for n in [500, 2000, 10_000] {
        let mut random = Random(5);
        let mut number = || random.next();
        let over: Vec<[f64; 2]> = (0..n).map(|_| [number(), number()]).collect();
        let points: Vec<[f64; 3]> =
            over.iter().map(|&[x, y]| [x, y, height(x, y) + noise * (2.0 * number() - 1.0)]).collect();
        let places: Vec<Parameter> = over.iter().map(|&p| locator.locate(p).unwrap()).collect();
        let error = |fairness: f64| {
            let options = FitOptions { fairness, threads: 1 };
            let spline = fit(&space, &places, &points, &options, &Control::new()).unwrap().spline;
            let found = spline.evaluate(&places, 0, 1, &Control::new()).unwrap();
            let squares = found.iter().zip(&over).map(|(at, &[x, y])| (at.point[2] - height(x, y)).powi(2));
            (squares.sum::<f64>() / n as f64).sqrt()
        };
        let [usual, advised] = [FitOptions::default().fairness, 1e-8].map(error);
        assert!(advised < 0.7 * usual, "{n} points: {advised:.1e} against {usual:.1e}");
    }
}

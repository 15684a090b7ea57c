//! Bicubic patches near splines.

use ricci::Control;
use ricci::spline::{
    BicubicFit, BicubicOptions, BicubicSurface, FitOptions, KnotOptions, Locator, Parameter, PlaneDomain,
    Polynomial, Spline, SplineSpace, fit, triangulate,
};
use std::sync::Arc;

/// A square with a hole in it, coarsely triangulated.
fn domain() -> PlaneDomain {
    let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let hole = vec![[0.4, 0.4], [0.4, 0.6], [0.6, 0.6], [0.6, 0.4]];
    triangulate(&[square, hole], 0.25).unwrap()
}

fn space(domain: &PlaneDomain, degree: usize) -> Arc<SplineSpace> {
    Arc::new(SplineSpace::planar(domain, &domain.knots(degree, &KnotOptions::default()).unwrap()).unwrap())
}

/// z = x³ − 2 x y² + y, a cubic.
fn cubic(degree: usize) -> Spline {
    let space = space(&domain(), degree);
    let mut coefficients = vec![[0.0; 3]; (degree + 1) * (degree + 2) / 2];
    (coefficients[1], coefficients[2]) = ([1.0, 0.0, 0.0], [0.0, 1.0, 1.0]);
    (coefficients[6], coefficients[8]) = ([0.0, 0.0, 1.0], [0.0, 0.0, -2.0]);
    let points = space.control_points_of(&Polynomial::new(degree, coefficients)).unwrap();
    Spline::new(space, points).unwrap()
}

/// A smooth height field fitted at many points.
fn hill(domain: &PlaneDomain, degree: usize) -> Spline {
    let space = space(domain, degree);
    let locator = Locator::new(domain);
    let at = |i: usize| i as f64 / 80.0;
    let all = (0..=80).flat_map(|i| (0..=80).map(move |j| [at(i), at(j)]));
    let places: Vec<Parameter> = all.filter_map(|p| locator.locate(p)).collect();
    let height = |p: &Parameter| [p.x, p.y, 0.2 * (3.0 * p.x).sin() * (2.0 * p.y).cos()];
    let points: Vec<[f64; 3]> = places.iter().map(height).collect();
    fit(&space, &places, &points, &FitOptions::default(), &Control::new()).unwrap().spline
}

fn patches(spline: &Spline, tolerance: f64, threads: usize) -> BicubicFit {
    let options = BicubicOptions { tolerance, threads, ..BicubicOptions::default() };
    spline.to_bicubic(&options, &Control::new()).unwrap()
}

/// The largest distance of the patches from a surface over the plane, at places of no grid that was used to make or measure them: the
/// difference in height, times the cosine of the slope.
fn distance(surface: &BicubicSurface, spline: &Spline) -> f64 {
    let domain = spline.space().domain().unwrap();
    let locator = Locator::new(&domain);
    let mut worst = 0.0f64;
    for patch in &surface.patches {
        for k in 0..49 {
            let at = [0.013 + 0.137 * f64::from(k % 7), 0.029 + 0.131 * f64::from(k / 7)];
            let [x, y, z] = patch.evaluate(at).point;
            let Some(place) = locator.locate([x, y]) else { continue };
            let found = spline.surface_point(place).unwrap();
            worst = worst.max((found.point[2] - z).abs() * found.normal().unwrap()[2]);
        }
    }
    worst
}

#[test]
fn cubics_are_one_span_without_a_jump_of_normals() {
    for degree in [3, 4] {
        let spline = cubic(degree);
        let found = patches(&spline, 1e-3, 2);
        assert_eq!(found.surface.patches.len(), 3 * spline.space().patches().len());
        assert!(found.distance < 1e-3 && distance(&found.surface, &spline) < 1e-3 * found.diagonal);
        assert!(found.angles.largest < 0.5f64.to_radians(), "{:?}", found.angles);
        assert!(!found.surface.is_closed() && found.surface.open_sides() == 0);
        found.surface.check().unwrap();
    }
}

#[test]
fn patches_near_a_height_field_keep_to_the_tolerance() {
    for (degree, tolerance) in [(2, 1e-3), (3, 1e-3), (3, 1e-5), (4, 1e-5)] {
        let spline = hill(&domain(), degree);
        let found = patches(&spline, tolerance, 0);
        let miss = distance(&found.surface, &spline) / found.diagonal;
        eprintln!("degree {degree}: {miss:e} {:e} {:?} {:?}", found.distance, found.angles, found.spans);
        assert!(found.distance <= tolerance && miss <= tolerance, "{miss:e} {:e}", found.distance);
        assert_eq!(found.surface.open_sides(), 0);
        // The bits do not depend on the number of threads.
        assert_eq!(found, patches(&spline, tolerance, 1));
    }
}

#[test]
fn a_tolerance_out_of_reach_is_an_error_that_names_the_patch() {
    let options = |tolerance| BicubicOptions { tolerance, ..BicubicOptions::default() };
    let two = PlaneDomain {
        vertices: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let spline = hill(&two, 3);
    let error = |tolerance| spline.to_bicubic(&options(tolerance), &Control::new()).unwrap_err().to_string();
    assert!(error(0.0).contains("tolerance is 0"), "{}", error(0.0));
    assert!(error(f64::NAN).contains("tolerance is NaN"));
    let far = error(1e-10);
    assert!(far.starts_with("patch ") && far.contains("with 128 spans per side"), "{far}");
}

#[test]
fn a_spline_that_folds_and_more_control_points_than_allowed_are_refused() {
    let spline = cubic(3);
    let options = BicubicOptions { tolerance: 1e-2, ..BicubicOptions::default() };
    let made = spline.to_bicubic(&options, &Control::new()).unwrap();
    let needed = made.surface.n_control_points();
    let limited = |n| {
        let options = BicubicOptions { control_points: Some(n), ..options };
        spline.to_bicubic(&options, &Control::new())
    };
    assert_eq!(limited(needed).unwrap(), made);
    assert!(limited(needed / 2).unwrap_err().to_string().contains("larger tolerance"));
    let mut points = spline.control_points().to_vec();
    let middle = points.len() / 2;
    points[middle][0] += 100.0;
    let bent = Spline::new(spline.space().clone(), points).unwrap();
    let refused = bent.to_bicubic(&options, &Control::new()).unwrap_err().to_string();
    assert!(refused.starts_with("patch ") && refused.contains("turns back on itself"), "{refused}");
    let allowed = BicubicOptions { folds: true, ..options };
    assert!(bent.to_bicubic(&allowed, &Control::new()).is_ok());
}

#[test]
fn files_of_patches_are_read_as_they_were_and_tampering_is_named() {
    let surface = patches(&cubic(3), 1e-2, 0).surface;
    let mut bytes = Vec::new();
    surface.write_json(&mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    assert_eq!(BicubicSurface::from_json(&text, "t").unwrap(), surface);
    for share in [1, 3, 7, 9] {
        let error = BicubicSurface::from_json(&text[..text.len() * share / 10], "t").unwrap_err();
        assert!(error.to_string().starts_with("t:"), "{error}");
    }
    let told = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        BicubicSurface::from_json(&text.replacen(from, to, 1), "t").unwrap_err().to_string()
    };
    assert!(told("ricci-patches 1", "ricci-patches 2").contains("this version reads"));
    assert!(told("\"reversed\":true", "\"reversed\":false").contains("sides do not follow each other"));
    assert!(told("\"curve\":0,", "\"curve\":99999,").contains("does not exist"));
    assert!(told("\"knots\":[0.0,0.0", "\"knots\":[0.0,0.1").contains("not clamped"));
    // A change of the last bit of a common control point is found.
    let mut moved = surface.clone();
    moved.patches[3].control[1][0][2] = moved.patches[3].control[1][0][2].next_up();
    let error = moved.check().unwrap_err().to_string();
    assert!(error.starts_with("bicubic patch 3:") && error.contains("not those of its curve"), "{error}");
    assert_eq!(moved.open_sides(), 1);
    moved.points[0][0] = f64::NAN;
    assert!(moved.check().unwrap_err().to_string().contains("does not end at the points"));
}

/// The exact way, three patches of bidegree (n, n) for each triangle, needs a spline that is one polynomial on each of its triangles. It is
/// not: knot lines cross the triangles, and the polynomial of the middle misses the spline outside of it.
#[test]
fn a_triangle_is_not_one_polynomial() {
    for degree in [3, 4] {
        let [share, miss] = polynomials(&hill(&domain(), degree));
        eprintln!("degree {degree}: {:.1} % in the middle, off by {miss:.1e}", 100.0 * share);
        assert!(miss > 1e-6 && (0.1..0.9).contains(&share), "{miss} {share}");
    }
}

/// The share of places of a spline that lie in the middle of their triangles, where the spline is one polynomial, and the largest distance
/// of these polynomials from the spline on all of their triangles, over the size of the spline.
pub fn polynomials(spline: &Spline) -> [f64; 2] {
    let (mut worst, mut largest, mut inside, mut all) = (0.0f64, 0.0f64, 0, 0);
    let degree = spline.space().degree();
    for (patch, of) in spline.space().patches().iter().enumerate() {
        let corners = [0, 1, 2].map(|k| of.knots[k][0]);
        let omega = spline.omega(patch);
        for weights in ricci::spline::multi_indices(20) {
            let at = [0, 1].map(|x| (0..3).map(|k| weights[k] as f64 / 20.0 * corners[k][x]).sum::<f64>());
            let found = spline.point(Parameter { patch: patch as u32, x: at[0], y: at[1] }).unwrap();
            let polynomial = spline.blossom(patch, &vec![at; degree]).unwrap();
            let square = |p: [f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
            worst = worst.max(square([0, 1, 2].map(|x| found[x] - polynomial[x])));
            largest = largest.max(square(found));
            all += 1;
            inside += usize::from(omega.len() > 2 && is_in(&omega, at));
        }
    }
    [inside as f64 / f64::from(all), worst / largest]
}

/// True if a point lies in a convex polygon.
fn is_in(polygon: &[[f64; 2]], p: [f64; 2]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .all(|(a, b)| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0)
}

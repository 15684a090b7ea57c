//! Splines over spheres: a plane with one vertex at infinity.

use ricci::mesh::{Mesh, VertexId, shapes};
use ricci::spline::{
    BicubicOptions, FlatMetric, FlatMetricOptions, Parameter, SingularVertices, Spline, SurfaceFit,
    SurfaceFitOptions, fit_surface,
};
use ricci::structure::AffineSource;
use ricci::{Control, Error, Surface};
use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

const AXES: [f64; 3] = [1.0, 0.7, 1.6];

fn surface() -> Surface {
    Surface::from_soup(&shapes::ellipsoid(AXES, 16).unwrap()).unwrap()
}

fn fitted() -> &'static SurfaceFit {
    static FITTED: OnceLock<SurfaceFit> = OnceLock::new();
    FITTED.get_or_init(|| {
        let (surface, control) = (surface(), Control::new());
        let options = FlatMetricOptions {
            singular: SingularVertices::At(vec![VertexId(5)]),
            ..FlatMetricOptions::default()
        };
        let flat = FlatMetric::new(&surface, &options, &control).unwrap();
        fit_surface(&surface, &flat, &SurfaceFitOptions::default(), &control).unwrap()
    })
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|x| (a[x] - b[x]).powi(2)).sum::<f64>().sqrt()
}

/// The distance of a point from the ellipsoid, to first order.
fn off(p: [f64; 3]) -> f64 {
    let value: f64 = (0..3).map(|x| (p[x] / AXES[x]).powi(2)).sum();
    let gradient = (0..3).map(|x| (2.0 * p[x] / AXES[x].powi(2)).powi(2)).sum::<f64>().sqrt();
    (value - 1.0).abs() / gradient
}

#[test]
fn a_sphere_has_one_hole_at_infinity() {
    let fit = fitted();
    let surface = surface();
    let control_points = fit.spline.space().n_control_points();
    let [hole] = fit.spline.holes() else { panic!("one hole") };
    let all = control_points + hole.fill.as_ref().unwrap().coefficients().len();
    assert!(4 * all <= surface.mesh().n_vertices(), "{all} of {}", surface.mesh().n_vertices());
    assert!(fit.rms < 1e-3 && fit.max < 1e-2, "{:e} {:e}", fit.rms, fit.max);
    assert_eq!(fit.singular, [VertexId(5)]);
    assert!(hole.is_at_infinity() && hole.turns == -1.0);
    // The vertex at infinity is the origin of the hole's chart, except for the corrections of its place.
    let Parameter { patch, x, y } = fit.places[5];
    assert!(patch == hole.chart && f64::hypot(x, y) < 0.05, "{x} {y}");
    let vertex = surface.positions().unwrap()[5];
    let found = fit.spline.surface_point(Parameter { patch, x: 0.0, y: 0.0 }).unwrap();
    // Points slide along the surface while it is fitted.
    assert!(distance(found.point, vertex) < 5e-2 && off(found.point) < 1e-2, "{:?} {vertex:?}", found.point);
    // Normals point outwards, as those of the mesh do.
    let normal = found.normal().unwrap();
    let gradient = [0, 1, 2].map(|x| vertex[x] / AXES[x].powi(2));
    assert!((0..3).map(|x| normal[x] * gradient[x]).sum::<f64>() > 0.0);
    let identities = fit.spline.identities(0, &Control::new()).unwrap();
    assert!(identities.partition_of_unity < 1e-12 && identities.continuity < 1e-8, "{identities:?}");
    eprintln!("{all} coefficients, rms {:e}, max {:e}, {identities:?}", fit.rms, fit.max);
}

#[test]
fn patches_and_the_chart_of_the_hole_are_one_surface() {
    let spline = &fitted().spline;
    let (hole, space) = (&spline.holes()[0], spline.space());
    let mut worst = [0.0f64; 3];
    for j in 0..48 {
        let angle = TAU * (f64::from(j) + 0.3) / 48.0;
        // With w = ρ/z, a place with |w| from 0.65 to 0.7 has coordinates in a patch and in the chart of the hole.
        for size in [0.66, 0.699] {
            let patch = hole.place(space, hole.radius / size, -angle).unwrap();
            assert!(patch.patch != hole.chart);
            let chart = Parameter { patch: hole.chart, x: size * angle.cos(), y: size * angle.sin() };
            let [a, b] = [patch, chart].map(|at| spline.surface_point(at).unwrap());
            worst[0] = worst[0].max(distance(a.point, b.point));
            worst[1] = worst[1].max(distance(a.normal().unwrap(), b.normal().unwrap()));
            let [k, l] = [a, b].map(|at| at.principal_curvatures().unwrap());
            worst[2] = worst[2].max((k[0] - l[0]).abs().max((k[1] - l[1]).abs()));
        }
        // Derivatives agree with differences where the filling is blended into the spline.
        for size in [0.72, 0.85, 0.99] {
            let at = hole.place(space, hole.radius / size, -angle).unwrap();
            let found = spline.surface_point(at).unwrap();
            let h = 1e-5;
            let moved =
                |dx: f64, dy: f64| spline.surface_point(Parameter { x: at.x + dx, y: at.y + dy, ..at });
            let (Ok(a), Ok(b), Ok(c), Ok(d)) = (moved(-h, 0.0), moved(h, 0.0), moved(0.0, -h), moved(0.0, h))
            else {
                continue;
            };
            for x in 0..3 {
                let by_x = (b.point[x] - a.point[x]) / (2.0 * h) - found.first[0][x];
                let by_xy = (d.first[0][x] - c.first[0][x]) / (2.0 * h) - found.second[1][x];
                assert!(by_x.abs() < 1e-6 && by_xy.abs() < 1e-4, "{size} {by_x:e} {by_xy:e}");
            }
        }
    }
    eprintln!("{worst:?}");
    assert!(worst[0] < 1e-13 && worst[1] < 1e-11 && worst[2] < 1e-9, "{worst:?}");
    let beyond = Parameter { patch: hole.chart, x: 0.6, y: 0.6 };
    assert!(matches!(spline.point(beyond), Err(Error::Spline { what: "patch", .. })));
}

#[test]
fn it_is_tessellated_exported_and_written_as_a_closed_surface() {
    let spline = &fitted().spline;
    let control = Control::new();
    let soup = spline.tessellate(5, 0, &control).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    assert!(mesh.is_closed() && mesh.euler() == 2);
    let worst = soup.positions.iter().map(|&p| off(p)).fold(0.0, f64::max);
    assert!(worst < 0.03, "{worst:e}");
    let exact = 4.0 / 3.0 * PI * AXES.iter().product::<f64>();
    let bicubic =
        spline.to_bicubic(&BicubicOptions { tolerance: 1e-4, ..BicubicOptions::default() }, &control);
    let bicubic = bicubic.unwrap();
    let surface = &bicubic.surface;
    assert!(surface.is_closed() && surface.open_sides() == 0 && bicubic.distance <= 1e-4);
    assert!(bicubic.angles.largest.to_degrees() < 1.0, "{:?}", bicubic.angles);
    let all: Vec<usize> = (0..surface.patches.len()).collect();
    let volume = surface.volume(&all);
    assert!((volume / exact - 1.0).abs() < 5e-3, "{volume} {exact}");
    eprintln!("{:?} {:?} volume {volume} of {exact}", bicubic.angles, bicubic.spans);
    let text = spline.to_json();
    let back = Spline::from_json(&text, "sphere").unwrap();
    assert_eq!(back.to_json(), text);
    let middle = Parameter { patch: spline.holes()[0].chart, x: 0.1, y: -0.2 };
    assert_eq!(back.point(middle).unwrap(), spline.point(middle).unwrap());
}

#[test]
fn nearest_points_are_found_at_infinity_too() {
    let fit = fitted();
    let spline = &fit.spline;
    let chart = spline.holes()[0].chart;
    let control = Control::new();
    let finder = spline.closest_points(0, &control).unwrap();
    let soup = spline.tessellate(7, 0, &control).unwrap();
    let normals = soup.attributes.normals.as_ref().unwrap();
    let lifted: Vec<[f64; 3]> =
        soup.positions.iter().zip(normals).map(|(p, n)| [0, 1, 2].map(|x| p[x] + 1e-2 * n[x])).collect();
    let mut in_hole = 0;
    let mut back = 0;
    for (found, from) in finder.find(&lifted, 0, &control).unwrap().iter().zip(&soup.positions) {
        assert!(found.distance < 1e-2 + 1e-12);
        assert_eq!(found.point, spline.point(found.place).unwrap());
        in_hole += usize::from(found.place.patch == chart);
        back += usize::from(distance(found.point, *from) < 1e-9);
    }
    // Exceptions are places where the surface bends with a radius below the distance.
    assert!(in_hole > 50 && 100 * back > 98 * lifted.len(), "{in_hole} {back} of {}", lifted.len());
}

#[test]
fn a_sphere_has_no_holomorphic_form() {
    let options = FlatMetricOptions { source: AffineSource::Form, ..FlatMetricOptions::default() };
    let error = FlatMetric::new(&surface(), &options, &Control::new()).unwrap_err();
    assert!(error.to_string().contains("genus 0"), "{error}");
}

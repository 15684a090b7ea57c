//! The surface around a singular vertex.

use ricci::flow::{Options, flow};
use ricci::geometry::Space;
use ricci::mesh::{VertexId, shapes};
use ricci::spline::{FlatMetric, Parameter, Spline, SurfaceFitOptions, SurfacePoint, fit_surface};
use ricci::{Class, Control, Surface, Target};

#[test]
fn a_filled_hole_is_smooth_and_near_the_surface() {
    let soup = shapes::genus(2, 8).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    let control = Control::new();
    let target = Target::Single(VertexId(0));
    let flat =
        flow(surface.clone(), Class::yamabe(Space::E2), &target, &Options::default(), &control).unwrap();
    let options = SurfaceFitOptions { rounds: 4, ..SurfaceFitOptions::default() };
    let fitted =
        fit_surface(&surface, &FlatMetric::of(&flat, &control).unwrap(), &options, &control).unwrap();
    assert!(fitted.rms < 1e-3 && fitted.max < 0.01, "{} {}", fitted.rms, fitted.max);
    let (domain, spline) = (&fitted.domain, &fitted.spline);
    let [vertex] = domain.singular()[..] else { panic!("one singular vertex") };
    let points = surface.positions().unwrap();
    let [hole] = spline.holes() else { panic!("one hole") };
    let space = spline.space();
    let bare = Spline::new(space.clone(), spline.control_points().to_vec()).unwrap();
    assert!(domain.coarse().vertices[vertex.index()] == VertexId(0));
    assert!((hole.turns - 3.0).abs() < 1e-12);
    let at = |place: Parameter| -> Option<SurfacePoint> {
        hole.surface(place, &bare.surface_point(place).unwrap())
    };
    // Derivatives agree with differences, from the middle to the rim.
    let (mut compared, mut worst) = (0, [0.0f64; 2]);
    for ring in [0.02, 0.2, 0.45, 0.55, 0.7, 0.9, 0.99] {
        for j in 0..36 {
            let radius = hole.radius * f64::powi(ring, 3);
            let Some(place) = hole.place(space, radius, 0.1 + 0.5 * f64::from(j)) else { continue };
            let found = at(place).unwrap();
            let h = 1e-5 * radius / hole.radius;
            let moved = |dx: f64, dy: f64| at(Parameter { x: place.x + dx, y: place.y + dy, ..place });
            let [Some(a), Some(b), Some(c), Some(d)] =
                [moved(-h, 0.0), moved(h, 0.0), moved(0.0, -h), moved(0.0, h)]
            else {
                continue;
            };
            let size = (0..3).map(|x| found.first[0][x].hypot(found.first[1][x])).fold(0.0, f64::max);
            let size2 = found.second.as_flattened().iter().fold(0.0, |m, x| f64::max(m, x.abs()));
            for x in 0..3 {
                let first = [(b.point[x] - a.point[x]) / (2.0 * h), (d.point[x] - c.point[x]) / (2.0 * h)];
                let second = [
                    (b.first[0][x] - a.first[0][x]) / (2.0 * h),
                    (d.first[0][x] - c.first[0][x]) / (2.0 * h),
                    (d.first[1][x] - c.first[1][x]) / (2.0 * h),
                ];
                for k in 0..2 {
                    worst[0] = worst[0].max((first[k] - found.first[k][x]).abs() / size);
                }
                for k in 0..3 {
                    worst[1] = worst[1].max((second[k] - found.second[k][x]).abs() / size2);
                }
            }
            compared += 1;
        }
    }
    assert!(compared > 150 && worst[0] < 1e-5 && worst[1] < 1e-4, "{compared} {worst:?}");
    // Outside the hole the surface is the spline.
    let outside = hole.place(space, 1.001 * hole.radius, 1.0).unwrap();
    assert!(at(outside).is_none());
    // The vertex itself is a regular point of the surface.
    let middle = hole.place(space, 0.0, 0.0).unwrap();
    let found = at(middle).unwrap();
    let size = 10.0;
    let off: f64 = (0..3).map(|x| (found.point[x] - points[0][x]).powi(2)).sum::<f64>().sqrt();
    assert!(off < 0.01 * size, "{off}");
    eprintln!("rms {:e} max {:e} off {off:e} worst {worst:?}", fitted.rms, fitted.max);
}

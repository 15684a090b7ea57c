//! Nearest points of a spline over a whole surface, around its singular vertex too.

use crate::surface_fit::sample;
use ricci::Control;
use ricci::mesh::shapes::SplitMix64;
use ricci::spline::Parameter;

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|x| (a[x] - b[x]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn nearest_points_are_found_everywhere() {
    let spline = &sample().spline;
    let [hole] = spline.holes() else { panic!("one hole") };
    let (space, control) = (spline.space(), Control::new());
    let finder = spline.closest_points(2, &Control::new()).unwrap();
    let mut random = SplitMix64::new(5);
    let mut places: Vec<Parameter> = Vec::new();
    // Places all over the surface, and evenly spread in w over the hole.
    for patch in 0..space.patches().len() {
        let corners = space.patches()[patch].corners();
        for _ in 0..50 {
            let (s, t) = (random.unit(), random.unit());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let [x, y] =
                [0, 1].map(|x| (1.0 - s - t) * corners[0][x] + s * corners[1][x] + t * corners[2][x]);
            places.push(Parameter { patch: patch as u32, x, y });
        }
    }
    let turns = hole.turns;
    for _ in 0..1000 {
        let (far, angle) = (random.unit().sqrt(), std::f64::consts::TAU * turns * random.unit());
        places.extend(hole.place(space, hole.radius * far.powf(turns), angle));
    }
    places.extend(hole.place(space, 0.0, 0.0));
    let samples = spline.evaluate(&places, 2, 0, &control).unwrap();
    // Every point of the surface has a normal, the singular vertex too.
    assert!(samples.iter().all(|at| at.normal().is_some()));
    let last = samples.last().unwrap();
    assert!(last.principal_curvatures().is_some());

    let step = places.len() / 100;
    let mut points: Vec<[f64; 3]> = (0..50).map(|_| [0; 3].map(|_| 8.0 * (random.unit() - 0.5))).collect();
    points.extend(samples.iter().step_by(step).map(|at| at.point.map(|x| x + 0.05 * (random.unit() - 0.5))));
    let (mut cells, mut steps) = (0, 0);
    for (point, found) in points.iter().zip(finder.find(&points, 2, &control).unwrap()) {
        let nearest = samples.iter().map(|at| distance(at.point, *point)).fold(f64::INFINITY, f64::min);
        assert!(found.distance <= nearest, "{point:?} {found:?} {nearest}");
        assert_eq!(found.point, spline.point(found.place).unwrap());
        (cells, steps) = (cells + found.cells as usize, steps + found.steps as usize);
    }
    assert!(steps <= 60 * 3 * cells);
    // The nearest points of points on normals are the feet of the normals.
    let lifted = |far: f64| -> Vec<[f64; 3]> {
        let lift = |at: &ricci::spline::SurfacePoint| {
            let normal = at.normal().unwrap();
            [0, 1, 2].map(|x| at.point[x] + far * normal[x])
        };
        samples.iter().skip(3).step_by(60).chain([last]).map(lift).collect()
    };
    for far in [0.0, 1e-3] {
        let points = lifted(far);
        let one = finder.find(&points, 1, &control).unwrap();
        let (mut back, mut worst) = (0, 0.0f64);
        for (found, from) in one.iter().zip(samples.iter().skip(3).step_by(60).chain([last])) {
            let bend = from.principal_curvatures().unwrap().iter().fold(0.0f64, |m, k| m.max(k.abs()));
            assert!(found.distance <= far + 1e-12, "{found:?}");
            // Another part of the surface can be nearer.
            if bend * far < 0.5 && found.distance > far - 1e-12 {
                worst = worst.max(distance(found.point, from.point));
                back += 1;
            }
        }
        // Near the foot, distances are equal in f64, for a surface of size 8.
        let blur = f64::max(1e-11, (8.0 * f64::EPSILON * far * 8.0).sqrt());
        assert!(
            10 * back >= 9 * points.len() && worst < blur,
            "{far}: {back} of {}, {worst:e}",
            points.len()
        );
        assert_eq!(one, finder.find(&points, 3, &control).unwrap());
    }
}

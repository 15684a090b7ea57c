//! Splines over four-sided patches at places: nearest ones against brute force, triangle meshes, extraction matrices, patches of faces.

use super::Random;
use super::quad::{AXES, any_spline, block, cells, ellipsoid_foot, fitted_ellipsoid, lidded};
use ricci::geometry::vector::{
    Vector, add, cross, distance, dot, norm, normalised, scale, sub, triangle_normal,
};
use ricci::mesh::io::Soup;
use ricci::spline::{NearestPlace, PatchPlace, QuadSpline, QuadSplineSpace, TessellationSize};
use ricci::{Control, Error};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::sync::Arc;

fn nearest(spline: &QuadSpline, points: &[Vector], threads: usize) -> Vec<NearestPlace> {
    let control = Control::new();
    spline.nearest_places(threads, &control).unwrap().find(points, threads, &control).unwrap()
}

/// Points of all patches, n × n of each.
fn samples(spline: &QuadSpline, n: u32) -> Vec<Vector> {
    let at = |patch: usize, i: u32, j: u32| {
        let uv = [i, j].map(|k| f64::from(k) / f64::from(n - 1));
        spline.evaluate(patch, uv).unwrap().point
    };
    let patches = 0..spline.space().layout().patches().len();
    patches.flat_map(|p| (0..n * n).map(move |k| at(p, k / n, k % n))).collect()
}

fn points_around(n: usize, size: f64) -> Vec<Vector> {
    let mut random = Random(7);
    (0..n).map(|_| [0; 3].map(|_| size * (2.0 * random.next() - 1.0))).collect()
}

#[test]
fn nearest_places_of_an_ellipsoid_are_its_feet() {
    let spline = fitted_ellipsoid(12, 2, 0).spline;
    let points = points_around(300, 2.0);
    let all = samples(&spline, 60);
    for (point, found) in points.iter().zip(nearest(&spline, &points, 0)) {
        let at = spline.evaluate(found.place.patch, found.place.parameters).unwrap();
        assert_eq!(at.point, found.point);
        assert!((distance(at.point, *point) - found.distance).abs() < 1e-15);
        let brute = all.iter().map(|&p| distance(p, *point)).fold(f64::INFINITY, f64::min);
        assert!(found.distance <= brute, "{point:?}: {} {brute}", found.distance);
        let exact = distance(ellipsoid_foot(AXES, *point)[0], *point);
        let is_outside = (0..3).map(|x| (point[x] / AXES[x]).powi(2)).sum::<f64>() > 1.0;
        assert!(
            !is_outside || (found.distance - exact).abs() < 5e-4,
            "{point:?}: {} {exact}",
            found.distance
        );
        // The way there is perpendicular to the surface, also where it ends on a side of a patch.
        let way = normalised(sub(*point, at.point));
        let cosine = at.first.map(|d| dot(normalised(d), way).abs());
        assert!(found.distance < 1e-6 || cosine.iter().all(|&c| c < 1e-6), "{point:?}: {cosine:?}");
    }
}

#[test]
fn nearest_places_of_a_surface_that_crosses_itself_are_nearer_than_all_samples() {
    for spline in
        [any_spline(&cells(&block([1, 1, 1])).space(2)), any_spline(&cells(&block([2, 1, 1])).space(1))]
    {
        let all = samples(&spline, 80);
        let points = points_around(120, 1.5);
        let [one, two] = [1, 2].map(|threads| nearest(&spline, &points, threads));
        assert_eq!(one, two);
        for (point, found) in points.iter().zip(one) {
            let brute = all.iter().map(|&p| distance(p, *point)).fold(f64::INFINITY, f64::min);
            assert!(found.distance <= brute + 1e-14, "{point:?}: {} {brute}", found.distance);
        }
    }
}

#[test]
fn points_on_the_surface_are_found_where_they_are() {
    let spline = fitted_ellipsoid(6, 1, 0).spline;
    let mut random = Random(11);
    let n = spline.space().layout().patches().len();
    let places: Vec<PatchPlace> =
        (0..200).map(|k| PatchPlace { patch: k % n, parameters: [0; 2].map(|_| random.next()) }).collect();
    let control = Control::new();
    let at: Vec<Vector> =
        spline.evaluate_places(&places, 2, &control).unwrap().iter().map(|at| at.point).collect();
    for (place, found) in places.iter().zip(nearest(&spline, &at, 0)) {
        assert!(found.distance < 1e-12, "{place:?} {found:?}");
        assert_eq!(found.place.patch, place.patch);
        let off = (0..2).map(|x| (found.place.parameters[x] - place.parameters[x]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{off}");
    }
}

#[test]
fn places_and_points_that_cannot_be_are_refused() {
    let spline = any_spline(&cells(&block([1, 1, 1])).space(1));
    let control = Control::new();
    let search = spline.nearest_places(1, &control).unwrap();
    for wrong in [f64::NAN, f64::INFINITY, 1e160] {
        let refused = search.find(&[[0.0; 3], [0.0, wrong, 0.0]], 1, &control).unwrap_err();
        assert!(matches!(refused, Error::Argument { .. }), "{refused}");
    }
    assert!(search.find(&[], 1, &control).unwrap().is_empty());
    for (patch, parameters) in [(6, [0.5; 2]), (0, [-0.1, 0.5]), (0, [0.5, f64::NAN])] {
        let place = PatchPlace { patch, parameters };
        assert!(matches!(spline.third_derivatives(place), Err(Error::Spline { .. })));
        assert!(matches!(spline.evaluate_places(&[place], 1, &control), Err(Error::Spline { .. })));
    }
    assert!(matches!(spline.arc_control_points(12), Err(Error::Spline { .. })));
    for size in [TessellationSize::Parts(0), TessellationSize::Chord(0.0), TessellationSize::Chord(f64::NAN)]
    {
        assert!(matches!(spline.tessellate(size, 1, &control), Err(Error::Argument { .. })));
    }
    let large = TessellationSize::Parts(1 << 20);
    assert!(matches!(spline.tessellate(large, 1, &control), Err(Error::TooLarge { .. })));
    control.cancel();
    assert!(matches!(search.find(&[[0.0; 3]], 1, &control), Err(Error::Cancelled)));
}

/// The volume inside a closed mesh, all of whose edges have a face on either side.
fn volume(soup: &Soup) -> f64 {
    let mut sides = BTreeSet::new();
    for face in &soup.faces {
        for k in 0..3 {
            assert!(sides.insert([face[k], face[(k + 1) % 3]]), "{face:?}");
        }
    }
    assert!(sides.iter().all(|&[a, b]| sides.contains(&[b, a])));
    let sixfold = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| soup.positions[v as usize]);
        dot(a, cross(b, c))
    };
    soup.faces.iter().map(sixfold).sum::<f64>() / 6.0
}

#[test]
fn triangle_meshes_are_closed_and_their_volume_converges() {
    let spline = fitted_ellipsoid(12, 2, 0).spline;
    let of = |size| spline.tessellate(size, 0, &Control::new()).unwrap();
    let volumes = [4, 8, 16, 64].map(|parts| volume(&of(TessellationSize::Parts(parts))));
    let exact = 4.0 / 3.0 * PI * AXES.iter().product::<f64>();
    assert!((volumes[3] / exact - 1.0).abs() < 2e-3, "{volumes:?} {exact}");
    let misses = [0, 1, 2].map(|k| (volumes[k] - volumes[3]).abs());
    for pair in misses.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.4).contains(&order), "{misses:?}");
    }
    let mesh = of(TessellationSize::Parts(4));
    assert_eq!((mesh.faces.len(), mesh.positions.len()), (14 * 32, 14 * 16 + 2));
    assert!(mesh.attributes.corner_normals.is_none());
    for (point, normal) in mesh.positions.iter().zip(mesh.attributes.normals.unwrap()) {
        assert!((norm(normal) - 1.0).abs() < 1e-12);
        assert!(dot(normal, ellipsoid_foot(AXES, *point)[1]) > 0.999);
    }
}

#[test]
fn triangle_meshes_keep_their_tolerance() {
    for spline in [fitted_ellipsoid(6, 1, 0).spline, any_spline(&cells(&block([1, 1, 1])).space(2))] {
        for tolerance in [0.05, 0.01] {
            let size = TessellationSize::Chord(tolerance);
            let mesh = spline.tessellate(size, 0, &Control::new()).unwrap();
            assert_eq!(mesh.faces.len(), spline.tessellation_faces(size).unwrap());
            let (uv, patches) = (mesh.attributes.uv.unwrap(), &mesh.attributes.face_numbers[0].values);
            let mut worst = 0.0f64;
            for (f, face) in mesh.faces.iter().enumerate() {
                for weights in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
                    let at = [0, 1].map(|x| (0..3).map(|k| weights[k] * uv[f][k][x]).sum::<f64>().min(1.0));
                    let corner = |k: usize| scale(weights[k], mesh.positions[face[k] as usize]);
                    let flat = (0..3).fold([0.0; 3], |sum, k| add(sum, corner(k)));
                    let point = spline.evaluate(patches[f] as usize, at).unwrap().point;
                    worst = worst.max(distance(point, flat));
                }
            }
            assert!(worst <= tolerance && worst > 0.02 * tolerance, "{worst} {tolerance}");
        }
    }
}

#[test]
fn corners_at_creases_have_the_normals_of_their_patch() {
    let (_, layout) = lidded();
    let spline = any_spline(&Arc::new(QuadSplineSpace::new(layout, 1).unwrap()));
    let mesh = spline.tessellate(TessellationSize::Parts(5), 0, &Control::new()).unwrap();
    let (uv, corner_normals) = (mesh.attributes.uv.unwrap(), mesh.attributes.corner_normals.unwrap());
    let patches = &mesh.attributes.face_numbers[0].values;
    let mut at_vertex: BTreeMap<u32, Vec<Vector>> = BTreeMap::new();
    for (f, face) in mesh.faces.iter().enumerate() {
        for k in 0..3 {
            // At corners of the lid, whose border is smooth there, the derivatives are parallel.
            let own = spline.evaluate(patches[f] as usize, uv[f][k]).unwrap().normal().unwrap_or_default();
            assert!(distance(own, corner_normals[f][k]) < 1e-6, "face {f}, corner {k}");
            at_vertex.entry(face[k]).or_default().push(corner_normals[f][k]);
        }
    }
    let jumps = at_vertex.values().filter(|all| all.iter().any(|&n| distance(n, all[0]) > 1e-3)).count();
    assert_eq!(jumps, 8 * 5);
}

#[test]
fn the_extraction_matrix_gives_all_control_points() {
    let space = cells(&block([2, 1, 1])).space(2);
    let matrix = space.extraction();
    let free = points_around(space.dimension(), 1.0);
    let spline = QuadSpline::of_free(space.clone(), &free).unwrap();
    assert_eq!(matrix.starts.len(), space.n_control_points() + 1);
    let mut alone = BTreeSet::new();
    for (row, &point) in spline.control_points().iter().enumerate() {
        let entries = matrix.starts[row]..matrix.starts[row + 1];
        let values = &matrix.values[entries.clone()];
        assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-9, "row {row}");
        let columns = &matrix.columns[entries];
        let sum =
            columns.iter().zip(values).fold([0.0; 3], |sum, (&c, &w)| add(sum, scale(w, free[c as usize])));
        assert!(distance(sum, point) < 1e-12);
        if let ([column], [1.0]) = (columns, values) {
            alone.insert(*column);
        }
    }
    assert_eq!(alone.len(), space.dimension());
}

#[test]
fn bezier_points_give_the_surface() {
    let spline = any_spline(&cells(&block([1, 1, 1])).space(3));
    let (net, [of_u, of_v]) = (spline.net(2), spline.space().bezier_extraction(2));
    assert_eq!([of_u.len(), of_v.len()], [3, 3]);
    let bernstein = |t: f64| {
        let binomials = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        [0, 1, 2, 3, 4, 5].map(|k| binomials[k as usize] * t.powi(k) * (1.0 - t).powi(5 - k))
    };
    for (i, j, s, t) in [(0, 2, 0.3, 0.8), (1, 1, 0.0, 1.0), (2, 0, 0.6, 0.1)] {
        let mut point = [0.0; 3];
        for (a, b) in (0..6).flat_map(|a| (0..6).map(move |b| (a, b))) {
            for (k, l) in (0..6).flat_map(|k| (0..6).map(move |l| (k, l))) {
                let weight = bernstein(s)[a] * bernstein(t)[b] * of_u[i][a][k] * of_v[j][b][l];
                point = add(point, scale(weight, net[3 * i + k][3 * j + l]));
            }
        }
        let exact = spline.evaluate(2, [(i as f64 + s) / 3.0, (j as f64 + t) / 3.0]).unwrap().point;
        assert!(distance(point, exact) < 1e-12);
    }
}

#[test]
fn third_derivatives_are_difference_quotients() {
    let spline = any_spline(&cells(&block([1, 1, 1])).space(2));
    let (uv, step) = ([0.31, 0.72], 1e-5);
    let third = spline.third_derivatives(PatchPlace { patch: 1, parameters: uv }).unwrap();
    let second = |at| spline.evaluate(1, at).unwrap().second;
    let [[a, b], [c, d]] = [
        [second([uv[0] - step, uv[1]]), second([uv[0] + step, uv[1]])],
        [second([uv[0], uv[1] - step]), second([uv[0], uv[1] + step])],
    ];
    for k in 0..3 {
        for (from, to, exact) in [(a[k], b[k], third[k]), (c[k], d[k], third[k + 1])] {
            let quotient = scale(0.5 / step, sub(to, from));
            let miss = distance(quotient, exact);
            assert!(miss < 1e-5 * norm(exact), "{k}: {miss} {}", norm(exact));
        }
    }
}

#[test]
fn faces_lie_on_the_patch_that_they_are_of_and_never_on_one_behind() {
    let spline = fitted_ellipsoid(12, 1, 0).spline;
    let control = Control::new();
    let mesh = spline.tessellate(TessellationSize::Parts(15), 0, &control).unwrap();
    let search = spline.nearest_places(0, &control).unwrap();
    let found = search.patches_of_faces(&mesh.positions, &mesh.faces, 0, &control).unwrap();
    let own: Vec<u32> = mesh.attributes.face_numbers[0].values.iter().map(|&x| x as u32).collect();
    assert_eq!(found, own);
    // Moved down, the upper faces are nearer to the lower side of the ellipsoid, which faces the other way.
    let up = |f: usize| {
        let corners = mesh.faces[f].map(|v| mesh.positions[v as usize]);
        normalised(triangle_normal(corners))[2] > 0.998
    };
    let upper: BTreeSet<u32> = (0..own.len()).filter(|&f| up(f)).map(|f| own[f]).collect();
    assert!((1..3).contains(&upper.len()), "{upper:?}");
    let moved: Vec<Vector> = mesh.positions.iter().map(|&p| add(p, [0.0, 0.0, -0.8])).collect();
    let found = search.patches_of_faces(&moved, &mesh.faces, 0, &control).unwrap();
    let plain = nearest(&spline, &[[0.0, 0.0, -0.1]], 1);
    assert!(plain[0].point[2] < 0.0);
    assert!((0..own.len()).filter(|&f| up(f)).all(|f| upper.contains(&found[f])));
    let wrong = search.patches_of_faces(&mesh.positions[..3], &mesh.faces, 0, &control);
    assert!(matches!(wrong, Err(Error::Size { .. })));
}

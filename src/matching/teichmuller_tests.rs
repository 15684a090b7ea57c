//! Brackets of surfaces whose distance is known.

use super::teichmuller::*;
use crate::control::Control;
use crate::geometry::Space;
use crate::matching::{MatchOptions, match_surfaces};
use crate::mesh::shapes;
use crate::metric::Surface;
use crate::moduli::BoundsOptions;

fn flat_torus(tau: [f64; 2], n: usize) -> Surface {
    let (mesh, lengths) = shapes::flat_torus(tau, n, n).unwrap().build().unwrap();
    Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
}

fn bracket(surfaces: [&Surface; 2], options: &MatchOptions) -> DilatationBracket {
    let control = Control::new();
    let found = match_surfaces(surfaces[0], surfaces[1], options, &control).unwrap();
    let overlay = found.domain.overlay(0, &control).unwrap();
    dilatation_bracket(surfaces, &overlay, &options.landmarks, &BoundsOptions::default(), &control).unwrap()
}

/// The extremal map of flat tori is affine, and log K the hyperbolic distance of their moduli in the class of the map.
#[test]
fn flat_tori_have_the_distance_of_their_moduli() {
    for (a, b, m) in
        [([0.1, 1.1], [0.35, 1.4], 7), ([0.0, 1.0], [0.0, 3.0], 6), ([-0.3, 2.0], [0.3, 0.96], 5)]
    {
        let (source, target) = (flat_torus(a, 8), flat_torus(b, m));
        let found = bracket([&source, &target], &MatchOptions::default());
        println!("{a:?} {b:?}: {found:?}");
        assert!(found.lower > 1.0 && found.upper / found.lower < 1.0 + 1e-6, "{found:?}");
        // One of the distances between τ and the images of τ' under the modular group.
        let is_one = (-6..=6i32).flat_map(|p| (-6..=6).map(move |q| (p, q))).any(|(p, q)| {
            (-6..=6).flat_map(|r| (-6..=6).map(move |s| (r, s))).any(|(r, s): (i32, i32)| {
                let [p, q, r, s] = [p, q, r, s].map(f64::from);
                let (dx, dy) = (r * b[0] + s, r * b[1]);
                let square = dx * dx + dy * dy;
                let image = [((p * b[0] + q) * dx + p * b[1] * dy) / square, b[1] / square];
                let chord = ((a[0] - image[0]).powi(2) + (a[1] - image[1]).powi(2)) / (4.0 * a[1] * image[1]);
                p * s - q * r == 1.0 && ((2.0 * chord.sqrt().asinh()).exp() / found.lower - 1.0).abs() < 1e-6
            })
        });
        assert!(is_one, "{a:?} {b:?}: {found:?}");
    }
}

/// Three squares in an L, cut into n × n cells of this size: the affine map between two is extremal, with the loops of both its classes.
fn squares_in_an_l(width: f64, height: f64, n: usize) -> Surface {
    let (right, up) = ([1, 0, 2], [2, 1, 0]);
    let (mut faces, mut face_edges, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
    let mut edges = std::collections::HashMap::new();
    let mut corners = crate::mesh::union_find::UnionFind::new(3 * (n + 1) * (n + 1));
    let place = |i: usize, x: usize, y: usize| (i * (n + 1) * (n + 1) + x * (n + 1) + y) as u32;
    for i in 0..3 {
        for k in 0..=n {
            corners.join(place(i, n, k), place(right[i], 0, k));
            corners.join(place(i, k, n), place(up[i], k, 0));
        }
    }
    let mut names = std::collections::HashMap::new();
    for (i, x, y) in (0..3).flat_map(|i| (0..n).flat_map(move |x| (0..n).map(move |y| (i, x, y)))) {
        let mut vertex = |x: usize, y: usize| {
            let next = names.len() as u32;
            *names.entry(corners.root(place(i, x, y))).or_insert(next)
        };
        let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
        let mut edge = |kind: usize, i: usize, x: usize, y: usize| {
            let length = [width, height, width.hypot(height)][kind] / n as f64;
            *edges.entry((kind, i, x, y)).or_insert_with(|| {
                lengths.push(length);
                lengths.len() as i32
            })
        };
        let east = if x + 1 == n { edge(1, right[i], 0, y) } else { edge(1, i, x + 1, y) };
        let north = if y + 1 == n { edge(0, up[i], x, 0) } else { edge(0, i, x, y + 1) };
        let [south, west, across] = [edge(0, i, x, y), edge(1, i, x, y), edge(2, i, x, y)];
        faces.extend([[a, b, c], [a, c, d]]);
        face_edges.extend([[east, -across, south], [-north, -west, across]]);
    }
    let given =
        shapes::IntrinsicSurface { n_vertices: names.len(), faces, face_edges, lengths, geometry: Space::E2 };
    let (mesh, lengths) = given.build().unwrap();
    Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
}

#[test]
fn square_tiled_surfaces_have_the_dilatation_of_their_stretch() {
    for (n, k) in [(4, 1.5f64), (6, 2.0)] {
        let (square, long) = (squares_in_an_l(1.0, 1.0, n), squares_in_an_l(k.sqrt(), 1.0 / k.sqrt(), n));
        let options = BoundsOptions { width: 1e-4, ..BoundsOptions::default() };
        let control = Control::new();
        let found = match_surfaces(&square, &long, &MatchOptions::default(), &control).unwrap();
        let overlay = found.domain.overlay(0, &control).unwrap();
        let found = dilatation_bracket([&square, &long], &overlay, &[], &options, &control).unwrap();
        println!("{n}, {k}: {found:?}");
        assert!(found.by_numbers && (found.upper / k - 1.0).abs() < 1e-12, "{k}: {found:?}");
        assert!(found.lower <= k && found.lower > k / (1.0 + 2.5e-4), "{k}: {found:?}");
    }
}

#[test]
fn an_inversion_of_a_surface_of_genus_2_has_the_distance_0() {
    let surface =
        |n: usize, ratio: f64| Surface::from_soup(&shapes::tapered_genus(2, n, ratio).unwrap()).unwrap();
    // An inversion is conformal: the distance is 0.
    let found = bracket([&surface(4, 1.0), &surface(4, 2.2)], &MatchOptions::default());
    assert!(found.lower < 1.0 + 1e-2 && found.upper > 1.0 && found.most < 1.1, "{found:?}");
}

#[test]
fn round_annuli_have_the_ratio_of_their_moduli() {
    let mut last = f64::INFINITY;
    for n in [6, 12, 24] {
        let ring =
            |inner: f64, m: usize| Surface::from_soup(&shapes::annulus(inner, 1.0, n, m).unwrap()).unwrap();
        let found = bracket([&ring(0.5, 6 * n), &ring(0.3, 5 * n)], &MatchOptions::default());
        let truth = 0.3f64.ln() / 0.5f64.ln();
        println!("{n}: {found:?}, {truth}");
        assert!(found.lower <= found.upper && (found.lower / truth - 1.0).abs() < 0.02, "{found:?}");
        let width = found.upper / found.lower;
        assert!(width < last, "{n}: {width}");
        last = width;
    }
    assert!(last < 1.2, "{last}");
}

/// The affine map of tori is found in the class of the least distance, whatever the triangulations.
#[test]
fn tori_are_matched_in_the_nearest_class() {
    let (source, target) = (flat_torus([-0.3, 2.0], 8), flat_torus([0.3, 1.2], 5));
    let found = bracket([&source, &target], &MatchOptions::default());
    // cosh of the distance of −0.3 + 2 i and −0.7 + 1.2 i.
    let cosh: f64 = 1.0 + (0.16 + 0.64) / 4.8;
    let k = cosh + (cosh * cosh - 1.0).sqrt();
    assert!((found.upper / k - 1.0).abs() < 1e-6 && (found.lower / k - 1.0).abs() < 1e-6, "{k}: {found:?}");
}

/// A sphere with three holes, one of them of another size.
fn pants(hole: f64) -> Surface {
    let soup = shapes::icosphere(4).unwrap();
    let centres = [[1.0, 0.0, 0.0], [-0.5, 0.8660254, 0.0], [-0.5, -0.8660254, 0.0]];
    let cosines = [hole, 0.4, 0.4].map(f64::cos);
    let is_kept = |f: &[u32; 3]| {
        let p: [f64; 3] =
            std::array::from_fn(|k| f.iter().map(|&v| soup.positions[v as usize][k]).sum::<f64>() / 3.0);
        let size = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        centres.iter().zip(cosines).all(|(c, cos)| (0..3).map(|k| c[k] * p[k] / size).sum::<f64>() < cos)
    };
    let faces: Vec<[u32; 3]> = soup.faces.iter().copied().filter(is_kept).collect();
    let mut number = vec![u32::MAX; soup.positions.len()];
    let mut positions = Vec::new();
    let faces = faces.iter().map(|f| {
        f.map(|v| {
            if number[v as usize] == u32::MAX {
                number[v as usize] = positions.len() as u32;
                positions.push(soup.positions[v as usize]);
            }
            number[v as usize]
        })
    });
    let faces = faces.collect();
    Surface::from_soup(&crate::mesh::io::Soup { positions, faces, ..Default::default() }).unwrap()
}

/// Spheres with three holes are doubled: a larger hole has a distance, which is above 0 by proof, and a surface has none from itself.
#[test]
fn doubles_bound_the_distance_of_surfaces_with_boundary() {
    let (first, second) = (pants(0.4), pants(0.75));
    assert_eq!((first.mesh().boundary_loops().len(), second.mesh().boundary_loops().len()), (3, 3));
    let found = bracket([&first, &second], &MatchOptions::default());
    println!("{found:?}");
    assert!(found.kind == LowerBoundKind::PeriodMatrices, "{found:?}");
    assert!(found.lower > 1.1 && found.lower <= found.upper, "{found:?}");
    let same = bracket([&first, &first], &MatchOptions::default());
    assert!(same.lower <= same.upper && same.lower < 1.001, "{same:?}");
}

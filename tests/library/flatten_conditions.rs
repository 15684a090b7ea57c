//! Flat maps under conditions: weights, pinned vertices, straight pieces of the border, distances along paths, maps that are one to one.

use crate::common::named;
use ricci::flatten::{DistortionEnergy, FlattenOptions, FlattenStop, Flattening, flatten};
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, VertexId, shapes};
use ricci::{Control, Error, Surface};
use std::cmp::Ordering;

fn flat(surface: &Surface, options: &FlattenOptions) -> Flattening {
    let found = flatten(surface, options, &Control::new()).unwrap();
    let is_turned = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| found.points[v as usize]);
        orientation(a, b, c) != Ordering::Greater
    };
    assert!(!surface.mesh().triangles().iter().any(is_turned));
    found
}

/// A sheet of squares of side 1/n over (0, 1)², lifted to a height.
fn sheet(n: usize, height: impl Fn(f64, f64) -> f64) -> Surface {
    let w = n + 1;
    let at = |k: usize| {
        let (x, y) = ((k % w) as f64 / n as f64, (k / w) as f64 / n as f64);
        [x, y, height(x, y)]
    };
    let squares = (0..n).flat_map(|j| (0..n).map(move |i| (w * j + i) as u32));
    let w = w as u32;
    let faces: Vec<_> = squares.flat_map(|a| [[a, a + 1, a + w + 1], [a, a + w + 1, a + w]]).collect();
    Surface::from_soup(&Soup::new((0..(n + 1) * (n + 1)).map(at).collect(), faces)).unwrap()
}

/// The vertices of the border of [`sheet`] on the side y = 0, y = 1, x = 0 or x = 1, in order.
fn side(n: usize, which: usize) -> Vec<VertexId> {
    let w = n + 1;
    let vertex = |k: usize| match which {
        0 => k,
        1 => w * n + k,
        2 => w * k,
        _ => w * k + n,
    };
    (0..w).map(|k| VertexId(vertex(k) as u32)).collect()
}

fn hump(x: f64, y: f64) -> f64 {
    0.4 * (3.0 * x).sin() * (2.5 * y + 0.3).cos()
}

#[test]
fn a_sheet_whose_sides_are_pinned_apart_is_stretched_alike_everywhere() {
    // The least map of a flat square with two sides pinned to lines 1.5 apart, its vertices free along them, is x ↦ 1.5 x, y ↦ c y with
    // the c of least c² + c⁻²... where the sides are pinned in both directions at c = 1, the map is affine: the energy of (1.5, 1).
    let n = 8;
    let surface = sheet(n, |_, _| 0.0);
    let mut pins = Vec::new();
    for which in 0..4 {
        for v in side(n, which) {
            let p = surface.positions().unwrap()[v.index()];
            if !pins.iter().any(|&(w, _)| w == v) {
                pins.push((v, [1.5 * p[0] + 0.25, p[1] - 3.0]));
            }
        }
    }
    let found = flat(&surface, &FlattenOptions { pins: pins.clone(), ..FlattenOptions::default() });
    assert!(found.report.converged() && found.report.misfit < 1e-12, "{:?}", found.report);
    let known = 2.25 + 1.0 + 1.0 / 2.25 + 1.0;
    assert!((found.report.after.energy - known).abs() < 1e-12 * known, "{}", found.report.after.energy);
    for (v, at) in pins {
        assert_eq!(found.points[v.index()], at);
    }
    for (v, p) in surface.positions().unwrap().iter().enumerate() {
        let [x, y] = found.points[v];
        assert!((x - 1.5 * p[0] - 0.25).abs() < 1e-9 && (y - p[1] + 3.0).abs() < 1e-9);
    }
}

#[test]
fn two_pins_of_a_map_that_they_suit_turn_and_shift_it_alone() {
    let surface = sheet(10, hump);
    let free = flat(&surface, &FlattenOptions::default());
    let (sin, cos) = 2.0_f64.sin_cos();
    let turned = |[x, y]: [f64; 2]| [cos * x - sin * y + 5.0, sin * x + cos * y - 1.0];
    let pins: Vec<_> = [0_u32, 57].map(|v| (VertexId(v), turned(free.points[v as usize]))).to_vec();
    let pinned = flat(&surface, &FlattenOptions { pins, ..FlattenOptions::default() });
    assert!(pinned.report.converged(), "{:?}", pinned.report.stop);
    assert!((pinned.report.after.energy - free.report.after.energy).abs() < 1e-12);
    for (p, q) in free.points.iter().zip(&pinned.points) {
        let p = turned(*p);
        assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-7);
    }
}

#[test]
fn straight_pieces_are_straight_and_cost_no_more_than_a_square() {
    let n = 10;
    let surface = sheet(n, hump);
    let free = flat(&surface, &FlattenOptions::default()).report.after.energy;
    let straight: Vec<_> = (0..4).map(|which| side(n, which)).collect();
    let found = flat(&surface, &FlattenOptions { straight: straight.clone(), ..FlattenOptions::default() });
    assert!(found.report.converged() && found.report.misfit < 1e-12, "{:?}", found.report);
    for piece in &straight {
        let [a, b] = [piece[0], piece[n]].map(|v| found.points[v.index()]);
        let way = [b[0] - a[0], b[1] - a[1]];
        for v in piece {
            let p = found.points[v.index()];
            let off = (way[0] * (p[1] - a[1]) - way[1] * (p[0] - a[0])) / way[0].hypot(way[1]);
            assert!(off.abs() < 1e-11, "{v}: {off}");
        }
    }
    // A quadrilateral is one of the maps with straight sides, and the free map is one of all maps.
    let square: Vec<_> = straight
        .iter()
        .flatten()
        .map(|&v| {
            (v, [surface.positions().unwrap()[v.index()][0], surface.positions().unwrap()[v.index()][1]])
        })
        .collect::<std::collections::BTreeMap<_, _>>()
        .into_iter()
        .collect();
    let pinned = flat(&surface, &FlattenOptions { pins: square, ..FlattenOptions::default() });
    let energy = found.report.after.energy;
    assert!(free < energy && energy < pinned.report.after.energy, "{free} {energy}");
}

#[test]
fn heavier_triangles_are_stretched_less() {
    let surface = sheet(12, hump);
    let n_faces = surface.mesh().n_faces();
    let half = |f: usize| if f < n_faces / 2 { 100.0 } else { 1.0 };
    let weights: Vec<f64> = (0..n_faces).map(half).collect();
    let stretch = |found: &Flattening| {
        let lengths = |e: ricci::mesh::EdgeId| {
            let [p, q] = surface.mesh().ends(e).map(|v| found.points[v.index()]);
            ((p[0] - q[0]).hypot(p[1] - q[1]) / surface.lengths()[e] - 1.0).abs()
        };
        let of_heavy: Vec<f64> = surface
            .mesh()
            .faces()
            .take(n_faces / 2)
            .flat_map(|f| surface.mesh().opposite_edges(f))
            .map(lengths)
            .collect();
        of_heavy.iter().sum::<f64>() / of_heavy.len() as f64
    };
    let even = flat(&surface, &FlattenOptions::default());
    let weighted = flat(&surface, &FlattenOptions { weights, ..FlattenOptions::default() });
    println!("{} and {}", stretch(&weighted), stretch(&even));
    assert!(weighted.report.converged(), "{:?}", weighted.report.stop);
    assert!(stretch(&weighted) < 0.9 * stretch(&even));
    // Weights that are all the same are none.
    let same = flat(&surface, &FlattenOptions { weights: vec![3.0; n_faces], ..FlattenOptions::default() });
    assert!((same.report.after.energy - even.report.after.energy).abs() < 1e-13);
}

#[test]
fn distances_are_kept_where_that_is_possible_and_are_nearer_where_it_is_not() {
    let unrolled = sheet(9, |_, _| 0.0);
    let options =
        FlattenOptions { energy: DistortionEnergy::Distance, rings: 3, ..FlattenOptions::default() };
    let found = flat(&unrolled, &options);
    assert!(found.report.converged() && found.report.after.max_length_error < 1e-12, "{:?}", found.report);
    let bowl = sheet(12, |x, y| 0.6 * ((x - 0.5).powi(2) + (y - 0.5).powi(2)));
    let isometric = flat(&bowl, &FlattenOptions::default());
    let distance = flat(&bowl, &FlattenOptions { rings: 2, ..options });
    assert!(distance.report.converged(), "{:?}", distance.report.stop);
    let (of_both, of_edges) = (distance.report.after, isometric.report.after);
    assert!(of_both.mean_length_error < of_edges.mean_length_error, "{of_both:?} {of_edges:?}");
    assert!(of_both.energy >= of_edges.energy);
}

#[test]
fn maps_are_one_to_one_where_that_is_asked_for() {
    // A strip in the form of a spiral that leans outwards: its flat map overlaps itself unless that is forbidden.
    let (n, turns) = (90, 1.4 * std::f64::consts::TAU);
    let at = |k: usize| {
        let (angle, j) = (turns * (k / 4) as f64 / n as f64, (k % 4) as f64 / 3.0);
        let r = 1.0 + 0.3 * j;
        [r * angle.cos(), r * angle.sin(), 0.05 * angle]
    };
    let squares = (0..n).flat_map(|i| (0..3).map(move |j| (4 * i + j) as u32));
    let faces: Vec<_> = squares.flat_map(|a| [[a, a + 1, a + 5], [a, a + 5, a + 4]]).rev().collect();
    let faces: Vec<[u32; 3]> = faces.into_iter().map(|[a, b, c]| [a, c, b]).collect();
    let surface = Surface::from_soup(&Soup::new((0..4 * (n + 1)).map(at).collect(), faces)).unwrap();
    let free = flat(&surface, &FlattenOptions::default());
    assert!(!free.report.one_to_one && free.report.overlap > 0.1, "{:?}", free.report.overlap);
    let options = FlattenOptions { injective: true, ..FlattenOptions::default() };
    let apart = flat(&surface, &options);
    assert!(apart.report.one_to_one && apart.report.overlap == 0.0, "{:?}", apart.report);
    assert!(apart.report.after.energy > free.report.after.energy);
    println!("{:?} {} {}", apart.report.stop, apart.report.after.energy, free.report.after.energy);
    // No two triangles of the map share a point inside them: by the winding of the border around their middles.
    let loops = surface.mesh().boundary_loops();
    for f in surface.mesh().faces() {
        let corners = surface.mesh().face_vertices(f).map(|v| apart.points[v.index()]);
        let middle = [0, 1].map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / 3.0);
        let mut winding = 0.0;
        for h in loops.iter().flatten() {
            let [p, q] = [surface.mesh().tip(*h), surface.mesh().origin(*h)].map(|v| {
                let [x, y] = apart.points[v.index()];
                [x - middle[0], y - middle[1]]
            });
            winding += (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
        }
        assert!((winding / std::f64::consts::TAU - 1.0).abs() < 1e-9);
    }
    // Where nothing overlaps the least map is one to one anyway.
    let bowl = sheet(8, hump);
    assert!(flat(&bowl, &FlattenOptions::default()).report.one_to_one);
}

#[test]
fn real_surfaces_can_be_one_to_one() {
    let Some(meshes) = named("good", &["camel_b", "eight_open", "head_3b"]) else { return };
    for (name, soup) in meshes {
        let surface = Surface::from_soup(&soup).unwrap();
        let free = flat(&surface, &FlattenOptions::default());
        assert!(!free.report.one_to_one, "{name}");
        let found = flat(&surface, &FlattenOptions { injective: true, ..FlattenOptions::default() });
        println!(
            "{name}: {:?} {} steps, {} and {}",
            found.report.stop,
            found.report.iterations(),
            found.report.after.energy,
            free.report.after.energy
        );
        assert!(found.report.one_to_one && found.report.overlap == 0.0, "{name}");
    }
}

#[test]
fn conditions_that_do_not_fit_the_mesh_are_refused() {
    let surface = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
    let refused = |options: FlattenOptions| flatten(&surface, &options, &Control::new()).unwrap_err();
    let usual = FlattenOptions::default;
    let what = |error: Error| match error {
        Error::Argument { what, .. } => what,
        other => panic!("{other}"),
    };
    let n = surface.mesh().n_faces();
    assert_eq!(what(refused(FlattenOptions { weights: vec![1.0; n - 1], ..usual() })), "number of weights");
    assert_eq!(what(refused(FlattenOptions { weights: vec![0.0; n], ..usual() })), "weights");
    let pin = |v: u32, x: f64| (VertexId(v), [x, 0.0]);
    for pins in [vec![pin(999, 0.0)], vec![pin(1, 0.0), pin(1, 1.0)]] {
        assert_eq!(what(refused(FlattenOptions { pins, ..usual() })), "pins");
    }
    let pins = vec![pin(0, f64::NAN)];
    assert_eq!(what(refused(FlattenOptions { pins, ..usual() })), "place of pinned vertex");
    let straight = vec![vec![VertexId(0), VertexId(1)]];
    assert_eq!(what(refused(FlattenOptions { straight, ..usual() })), "vertices of a straight piece");
    let rings = FlattenOptions { energy: DistortionEnergy::Distance, rings: 0, ..usual() };
    assert_eq!(what(refused(rings)), "rings");
    // Two vertices that are to change places along the border: no map does that without turning triangles over.
    let mesh: &Mesh = surface.mesh();
    let rim: Vec<VertexId> = mesh.boundary_loops()[0].iter().map(|&h| mesh.origin(h)).collect();
    let at = |k: usize| {
        let p = surface.positions().unwrap()[rim[k].index()];
        [p[0], p[1]]
    };
    let mut pins: Vec<_> = (0..rim.len()).map(|k| (rim[k], at(k))).collect();
    (pins[2].1, pins[7].1) = (at(7), at(2));
    let options = FlattenOptions { pins, max_iterations: 300, ..usual() };
    let found = flat(&surface, &options);
    assert!(
        matches!(found.report.stop, FlattenStop::Unmet | FlattenStop::MaxIterations),
        "{:?}",
        found.report.stop
    );
    assert!(!found.report.converged() && found.report.misfit > 1e-3);
}

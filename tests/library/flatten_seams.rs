//! Surfaces with handles and cones laid flat with seams that are rotations: boxes, open or closed, unfold without stretch, whatever map the descent starts from, seams are exact,
//! and nothing is turned over.

use ricci::flatten::{
    DistortionEnergy, FlattenOptions, FlattenStart, SeamlessFlattening, flatten, flatten_seamless,
};
use ricci::geometry::Space;
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::Soup;
use ricci::mesh::{PerVertex, VertexId, shapes};
use ricci::seamless::{ConeValence, Seamless, SeamlessCones, SeamlessOptions, seamless};
use ricci::{Control, Error, Surface};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// The surface of unit cubes, each side of a cube in n × n squares, and the number of squares around each vertex.
fn cubes(cells: &[[i32; 3]], n: i32) -> (Surface, Vec<u32>) {
    open_cubes(cells, n, 0)
}

/// The same without the last squares, so many.
fn open_cubes(cells: &[[i32; 3]], n: i32, n_missing: usize) -> (Surface, Vec<u32>) {
    let mut number: HashMap<[i32; 3], u32> = HashMap::new();
    let (mut faces, mut squares) = (Vec::new(), Vec::new());
    for &cell in cells {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beside = cell;
            beside[axis] += 2 * side - 1;
            if cells.contains(&beside) {
                continue;
            }
            let corner = |i: i32, j: i32| {
                let mut at = cell.map(|x| n * x);
                at[axis] += n * side;
                at[(axis + 1) % 3] += i;
                at[(axis + 2) % 3] += j;
                at
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut square = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                if side == 0 {
                    square.reverse();
                }
                let [a, b, c, d] = square.map(|at| {
                    let next = number.len() as u32;
                    *number.entry(at).or_insert(next)
                });
                faces.extend([[a, b, c], [a, c, d]]);
                squares.extend([a, b, c, d]);
            }
        }
    }
    faces.truncate(faces.len() - 2 * n_missing);
    squares.truncate(squares.len() - 4 * n_missing);
    let mut positions = vec![[0.0; 3]; number.len()];
    number.into_iter().for_each(|(at, v)| positions[v as usize] = at.map(f64::from));
    let mut around = vec![0; positions.len()];
    squares.into_iter().for_each(|v| around[v as usize] += 1);
    let soup = Soup { positions, faces, ..Soup::default() };
    (Surface::from_soup(&soup).unwrap(), around)
}

/// A metric with the cones of the cubes that is far from their own lengths.
fn swollen(surface: &Surface, around: &[u32]) -> Seamless {
    let regular = |v: VertexId| if surface.mesh().is_boundary_vertex(v) { 2 } else { 4 };
    let cones = surface.mesh().vertices().zip(around).filter(|(v, valence)| **valence != regular(*v));
    let cones = cones.map(|(vertex, &valence)| ConeValence { vertex, valence }).collect();
    let positions = surface.positions().unwrap();
    let size = |v: VertexId| f64::exp(0.15 * positions[v.index()][0]);
    let options = SeamlessOptions {
        cones: SeamlessCones::Valences(cones),
        sizes: Some(PerVertex::from_fn(around.len(), size)),
        isometric_steps: 2,
        ..SeamlessOptions::default()
    };
    seamless(surface, &options, &Control::new()).unwrap()
}

/// Checks that seams are rotations by multiples of 90° to the last bit, angles around vertices multiples of 90°, and no triangle turned over.
fn check_map(found: &SeamlessFlattening) {
    let (layout, mesh) = (&found.layout, found.layout.mesh());
    let side = |h| {
        let ([ax, ay], [bx, by]) = (layout.uv(h), layout.uv(mesh.next(h)));
        [bx - ax, by - ay]
    };
    for e in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
        // A side, and the opposite of the other one: the same but for a rotation.
        let [x, y] = side(e.halfedge());
        let other = side(e.halfedge().twin()).map(|z| -z);
        assert!([[x, y], [-y, x], [-x, -y], [y, -x]].contains(&other), "edge {e}: {x} {y} and {other:?}");
    }
    let mut total = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let [a, b, c] = layout.face_uv(f);
        assert_eq!(orientation(a, b, c), Ordering::Greater, "face {f}");
        for h in mesh.face_halfedges(f) {
            let ([x, y], [z, w]) = (side(h), side(mesh.prev(h)).map(|z| -z));
            total[mesh.origin(h)] += (x * w - y * z).atan2(x * z + y * w);
        }
    }
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        let quarters = total[v] / FRAC_PI_2;
        assert!((quarters - quarters.round()).abs() < 1e-9, "vertex {v}: {quarters} right angles");
    }
}

fn flat(found: &Seamless, options: &FlattenOptions) -> SeamlessFlattening {
    let flat = flatten_seamless(found, options, &Control::new()).unwrap();
    check_map(&flat);
    assert!(flat.report.converged(), "{:?}", flat.report.stop);
    assert_eq!(flat.report.start, FlattenStart::Seamless);
    flat
}

#[test]
fn boxes_and_rings_of_cubes_unfold_without_stretch_closed_and_open() {
    let ring: Vec<_> = (0..9).filter(|k| *k != 4).map(|k| [k / 3, k % 3, 0]).collect();
    let one = vec![[0, 0, 0]];
    for (name, cells, genus, n_missing) in
        [("cube", &one, 0, 0), ("open cube", &one, 0, 1), ("ring", &ring, 1, 0), ("open ring", &ring, 1, 1)]
    {
        let (surface, around) = open_cubes(cells, 3 - genus, n_missing);
        assert_eq!(surface.mesh().genus() as i32, genus);
        assert_eq!(surface.mesh().boundary_loops().len(), n_missing);
        let flat = flat(&swollen(&surface, &around), &FlattenOptions::default());
        let (before, after) = (flat.report.before, flat.report.after);
        assert!(before.energy > 4.01, "{name}: {before:?}");
        assert!((after.energy - 4.0).abs() < 1e-12 && after.max_length_error < 1e-7, "{name}: {after:?}");
        assert!(flat.moved < 1e-12 * flat.layout.diameter, "{name}: {:e}", flat.moved);
    }
}

#[test]
fn a_flat_torus_keeps_its_lengths() {
    let (mesh, lengths) = shapes::flat_torus([0.3, 1.1], 6, 5).unwrap().build().unwrap();
    let torus = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
    let found = seamless(&torus, &SeamlessOptions::default(), &Control::new()).unwrap();
    let flat = flat(&found, &FlattenOptions::default());
    assert!((flat.report.after.energy - 4.0).abs() < 1e-12, "{:?}", flat.report.after);
    assert!(flat.report.after.max_length_error < 1e-12);
}

#[test]
fn handles_are_stretched_less_than_in_the_seamless_map() {
    for (name, soup, rotations) in [
        ("torus", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Auto(4)),
        ("genus 2", shapes::genus(2, 6).unwrap(), SeamlessCones::Field),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let options = SeamlessOptions { cones: rotations, isometric_steps: 3, ..SeamlessOptions::default() };
        let found = seamless(&surface, &options, &Control::new()).unwrap();
        let flat = flat(&found, &FlattenOptions::default());
        let (before, after) = (flat.report.before.energy, flat.report.after.energy);
        assert!(after < before && after > 4.0, "{name}: {before} to {after}");
        // The given vertices come first, where they were.
        let given = surface.positions().unwrap();
        assert_eq!(flat.surface.positions().unwrap()[..given.len()], given[..]);
        let n_added = flat.surface.mesh().n_vertices() - given.len();
        assert_eq!(flat.refinement.is_some(), n_added > 0, "{name}");
    }
}

#[test]
fn what_has_no_seams_is_refused_by_name() {
    let (cube, around) = cubes(&[[0, 0, 0]], 2);
    let found = swollen(&cube, &around);
    let refused = |options: &FlattenOptions| flatten_seamless(&found, options, &Control::new()).unwrap_err();
    let usual = FlattenOptions::default();
    let distance = FlattenOptions { energy: DistortionEnergy::Distance, ..usual.clone() };
    assert!(matches!(refused(&distance), Error::Argument { what: "energy", .. }));
    let injective = FlattenOptions { injective: true, ..usual.clone() };
    assert!(matches!(refused(&injective), Error::Argument { what: "injective", .. }));
    let pins = FlattenOptions { pins: vec![(VertexId(0), [0.0; 2])], ..usual.clone() };
    assert!(matches!(refused(&pins), Error::Argument { what: "pins", .. }));
    let control = Control::new();
    control.cancel();
    assert!(matches!(flatten_seamless(&found, &usual, &control), Err(Error::Cancelled)));
}

#[test]
fn without_cones_inside_the_map_is_that_of_the_open_surface() {
    let mut bowl = shapes::disk(4).unwrap();
    bowl.positions.iter_mut().for_each(|[x, y, z]| *z = 0.4 * (*x * *x + 0.5 * *y * *y));
    let surface = Surface::from_soup(&bowl).unwrap();
    let rim = surface.mesh().vertices().filter(|&v| surface.mesh().is_boundary_vertex(v));
    let mut rim: Vec<VertexId> = rim.collect();
    let angle = |v: &VertexId| bowl.positions[v.index()][1].atan2(bowl.positions[v.index()][0]);
    rim.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    // Four corners of a right angle, so that the metric is that of a rectangle.
    let cones = (0..4).map(|k| ConeValence { vertex: rim[k * rim.len() / 4], valence: 1 }).collect();
    let options = SeamlessOptions { cones: SeamlessCones::Valences(cones), ..SeamlessOptions::default() };
    let rectangle = seamless(&surface, &options, &Control::new()).unwrap();
    let with_seams = flat(&rectangle, &FlattenOptions::default());
    let free = flatten(&surface, &FlattenOptions::default(), &Control::new()).unwrap();
    let [one, other] = [with_seams.report.after.energy, free.report.after.energy];
    assert!((one - other).abs() < 1e-10 && one > 4.0, "{one} and {other}");
    assert!(with_seams.report.before.energy > one + 0.01);
}

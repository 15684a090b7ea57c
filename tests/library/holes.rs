//! Tests of filling holes: the topology, planes that stay planes, spheres whose error falls, what is left open and why.

use ricci::control::Control;
use ricci::mesh::holes::{HoleChoice, MOST_EXACT, fill_holes};
use ricci::mesh::io::{Attributes, Soup};
use ricci::mesh::repair::{NEW, Repair, repair};
use ricci::mesh::{Mesh, shapes};
use std::f64::consts::TAU;

/// A square of n × n squares of side 1/n without those for which `is_hole` holds.
fn plate(n: u32, is_hole: impl Fn(u32, u32) -> bool) -> Soup {
    let at = |k: u32| [f64::from(k % (n + 1)) / f64::from(n), f64::from(k / (n + 1)) / f64::from(n), 0.0];
    let kept = (0..n * n).filter(|k| !is_hole(k % n, k / n)).map(|k| k % n + (n + 1) * (k / n));
    let faces = kept.flat_map(|k| [[k, k + 1, k + n + 2], [k, k + n + 2, k + n + 1]]).collect();
    let mut soup = Soup::new((0..(n + 1) * (n + 1)).map(at).collect(), faces);
    soup = repair(&soup, &Repair::default(), &Control::new()).unwrap().soup;
    soup
}

fn area(soup: &Soup) -> f64 {
    let corners = |f: &[u32; 3]| f.map(|v| soup.positions[v as usize]);
    let twice = |[a, b, c]: [[f64; 3]; 3]| {
        let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        n[0].hypot(n[1]).hypot(n[2])
    };
    soup.faces.iter().map(|f| 0.5 * twice(corners(f))).sum()
}

#[test]
fn a_hole_in_a_plate_stays_planar() {
    // An L with corners inwards, the plate tilted and far from the origin.
    let flat = plate(20, |i, j| {
        (4..14).contains(&i) && (5..9).contains(&j) || (4..8).contains(&i) && (5..15).contains(&j)
    });
    let (cos, sin) = (0.6, 0.8);
    let mut tilted = flat.clone();
    tilted.positions.iter_mut().for_each(|p| *p = [p[0] + 7.0, cos * p[1] - 3.0, sin * p[1] + 2.0]);
    for (soup, height) in
        [(flat, [0.0, 0.0, 1.0, 0.0]), (tilted, [0.0, -sin, cos, -4.0 * cos + sin.mul_add(-3.0, 2.0 * cos)])]
    {
        let mut filled = soup.clone();
        let filling = fill_holes(&mut filled, &HoleChoice::UpTo(60), &Control::new()).unwrap();
        assert_eq!((filling.filled.len(), filling.open.len()), (1, 0));
        let mesh = Mesh::from_soup(&filled).unwrap();
        assert_eq!((mesh.euler(), mesh.boundary_loops().len()), (1, 1));
        assert!(!filling.filled[0].vertices.is_empty());
        // Heights are taken against those of the plate itself.
        let of = |p: &[f64; 3]| height[0] * p[0] + height[1] * p[1] + height[2] * p[2];
        let level = of(&soup.positions[0]);
        let most = filled.positions.iter().map(|p| (of(p) - level).abs()).fold(0.0, f64::max);
        assert!(most < 1e-13, "{most:e}");
        // No fold: the area is that of the square.
        assert!((area(&filled) - 1.0).abs() < 1e-12, "{}", area(&filled));
        assert_eq!(filled.positions[..soup.positions.len()], soup.positions);
        assert_eq!(filled.faces[..soup.faces.len()], soup.faces);
    }
}

#[test]
fn a_sphere_with_a_hole_closes_and_its_error_falls() {
    let mut last = f64::INFINITY;
    for n in [8, 16, 32] {
        let mut soup = shapes::icosphere(n).unwrap();
        // A cap with a radius of a few edges, whose faces lie in it wholly: a faired patch is off the sphere by about the square of that.
        let least = (2.5 / n as f64).cos();
        let is_cap = |f: &[u32; 3]| f.iter().all(|&v| soup.positions[v as usize][2] > least);
        soup.faces.retain(|f| !is_cap(f));
        let done =
            repair(&soup, &Repair { holes: HoleChoice::All, ..Repair::default() }, &Control::new()).unwrap();
        assert_eq!((done.diagnosis.euler, done.diagnosis.defects.len()), (2, 0));
        let error = |p: &[f64; 3]| (p[0].hypot(p[1]).hypot(p[2]) - 1.0).abs();
        let most = done.soup.positions.iter().map(error).fold(0.0, f64::max);
        assert!(most < 0.4 * last && most < 0.005, "{n}: {most:e} after {last:e}");
        last = most;
        let hole = &done.filling.filled[0];
        let new = |list: &[u32]| list.iter().filter(|origin| **origin == NEW).count();
        assert_eq!(new(&done.vertex_origin), hole.vertices.len());
        assert_eq!(new(&done.face_origin), hole.faces.len());
        // Triangles of the patch are as large as those around it, within a factor of two (measured: 1.57).
        let mean = area(&soup) / soup.faces.len() as f64;
        let size = hole.area / hole.faces.len() as f64 / mean;
        assert!(size <= 2.0, "{size}");
    }
}

#[test]
fn only_the_loops_that_are_chosen_are_filled() {
    let soup = plate(12, |i, j| (i, j) == (2, 2) || (6..9).contains(&i) && (6..9).contains(&j));
    let filled = |holes: HoleChoice| {
        let done = repair(&soup, &Repair { holes, ..Repair::default() }, &Control::new()).unwrap();
        (done.filling.filled.iter().map(|hole| hole.edges).collect::<Vec<_>>(), done.diagnosis.boundary_loops)
    };
    assert_eq!(filled(HoleChoice::Nothing), (vec![], 3));
    assert_eq!(filled(HoleChoice::UpTo(4)), (vec![4], 2));
    assert_eq!(filled(HoleChoice::UpTo(12)), (vec![4, 12], 1));
    let vertex = 6 + 13 * 6;
    assert_eq!(filled(HoleChoice::Through(vec![vertex])), (vec![12], 2));
    assert_eq!(filled(HoleChoice::All).1, 0);
    let inside = repair(
        &soup,
        &Repair { holes: HoleChoice::Through(vec![5 + 13 * 4]), ..Repair::default() },
        &Control::new(),
    );
    assert!(inside.unwrap_err().to_string().contains("boundary loop"));
}

#[test]
fn long_loops_are_filled_ear_by_ear() {
    // A ring whose inner loop is a star and has more edges than are triangulated exactly.
    let n = MOST_EXACT as u32 + 100;
    let at = |k: u32, outer: bool| {
        let angle = TAU * f64::from(k) / f64::from(n);
        let radius = if outer { 1.3 } else { 1.0 + 0.2 * (5.0 * angle).cos() };
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    };
    let positions = (0..n).map(|k| at(k, false)).chain((0..n).map(|k| at(k, true))).collect();
    let faces =
        (0..n).flat_map(|k| [[k, k + n, (k + 1) % n + n], [k, (k + 1) % n + n, (k + 1) % n]]).collect();
    let mut soup = Soup::new(positions, faces);
    let ring = area(&soup);
    let filling = fill_holes(&mut soup, &HoleChoice::Through(vec![0]), &Control::new()).unwrap();
    let hole = &filling.filled[0];
    assert_eq!(hole.edges, n as usize);
    let polygon: f64 = (0..n)
        .map(|k| {
            let (p, q) = (at(k, false), at(k + 1, false));
            0.5 * (p[0] * q[1] - p[1] * q[0])
        })
        .sum();
    assert!((hole.area - polygon).abs() < 1e-12, "{} {polygon}", hole.area);
    assert!((area(&soup) - ring - polygon).abs() < 1e-12);
    assert_eq!(Mesh::from_soup(&soup).unwrap().euler(), 1);
}

#[test]
fn what_cannot_be_filled_is_said() {
    // A single triangle, whose patch would repeat it; a slit without area.
    let mut triangle = Soup::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]);
    let filling = fill_holes(&mut triangle, &HoleChoice::All, &Control::new()).unwrap();
    assert!(filling.filled.is_empty() && filling.open[0].reason.contains("repeat"));
    let positions = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 2.0, 0.0],
        [1.0, -2.0, 0.0],
    ];
    let mut slit = Soup::new(positions, vec![[4, 0, 1], [4, 1, 2], [5, 3, 0], [5, 2, 3], [4, 2, 5]]);
    let filling = fill_holes(&mut slit, &HoleChoice::Through(vec![1]), &Control::new()).unwrap();
    assert_eq!((filling.filled.len(), filling.open.len()), (0, 1), "{filling:?}");
}

#[test]
fn attributes_are_continued() {
    let mut soup = plate(8, |i, j| (3..6).contains(&i) && (3..6).contains(&j));
    let color = |p: &[f64; 3]| [p[0], p[1], 0.5, 1.0];
    soup.attributes = Attributes {
        normals: Some(vec![[0.0, 0.0, 1.0]; soup.positions.len()]),
        colors: Some(soup.positions.iter().map(color).collect()),
        uv: Some(
            soup.faces
                .iter()
                .map(|f| f.map(|v| [soup.positions[v as usize][0], soup.positions[v as usize][1]]))
                .collect(),
        ),
        ..Attributes::default()
    };
    fill_holes(&mut soup, &HoleChoice::UpTo(12), &Control::new()).unwrap();
    let Attributes { normals, colors, uv, .. } = &soup.attributes;
    assert!(normals.as_ref().unwrap().iter().all(|n| *n == [0.0, 0.0, 1.0]));
    assert_eq!(colors.as_ref().unwrap().len(), soup.positions.len());
    for (p, c) in soup.positions.iter().zip(colors.as_ref().unwrap()) {
        assert!((p[0] - c[0]).abs() < 1e-12 && (p[1] - c[1]).abs() < 1e-12, "{p:?} {c:?}");
    }
    for (face, uv) in soup.faces.iter().zip(uv.as_ref().unwrap()) {
        for (&v, uv) in face.iter().zip(uv) {
            let p = soup.positions[v as usize];
            assert!((p[0] - uv[0]).abs() < 1e-12 && (p[1] - uv[1]).abs() < 1e-12);
        }
    }
}

#[test]
fn vertices_that_are_not_finite_are_dropped_and_their_holes_filled() {
    let mut soup = shapes::icosphere(6).unwrap();
    for v in [20, 100, 101] {
        soup.positions[v] = [f64::NAN; 3];
    }
    assert!(repair(&soup, &Repair::default(), &Control::new()).is_err());
    let options = Repair { drop_non_finite: true, holes: HoleChoice::All, ..Repair::default() };
    let done = repair(&soup, &options, &Control::new()).unwrap();
    assert!(done.steps.non_finite_faces >= 12 && done.steps.isolated_vertices == 3, "{:?}", done.steps);
    assert_eq!((done.diagnosis.euler, done.diagnosis.defects.len()), (2, 0));
    assert!(done.soup.positions.as_flattened().iter().all(|x| x.is_finite()));
}

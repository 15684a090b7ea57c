//! Splines over control meshes: where the limit surface is such a spline they are that one, elsewhere they come nearer with the quads.

use ricci::Control;
use ricci::geometry::vector::Vector;
use ricci::spline::{ControlMesh, ControlMeshFit, LayoutFitOptions, fit_control_mesh};
use std::f64::consts::TAU;

fn fitted(mesh: &ControlMesh, options: &LayoutFitOptions) -> ControlMeshFit {
    fit_control_mesh(mesh, options, &Control::new()).unwrap()
}

/// A torus of m × n quads.
fn torus(m: usize, n: usize) -> ControlMesh {
    let point = |k: usize| -> Vector {
        let [a, b] = [(k / n) as f64 / m as f64, (k % n) as f64 / n as f64].map(|x| TAU * x);
        let r = 2.0 + 0.8 * b.cos();
        [r * a.cos(), r * a.sin(), 0.8 * b.sin()]
    };
    let corner = |i: usize, j: usize| (i % m * n + j % n) as u32;
    let quad = |q: usize| {
        let (i, j) = (q / n, q % n);
        vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
    };
    ControlMesh::new((0..m * n).map(point).collect(), (0..m * n).map(quad).collect()).unwrap()
}

/// A cube whose sides are n × n quads.
fn cube(n: usize) -> ControlMesh {
    let mut numbers = std::collections::BTreeMap::new();
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, n)]) {
        let mut corner = |i: usize, j: usize| {
            let mut at = [0; 3];
            (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, i, j);
            *numbers.entry(at).or_insert_with(|| {
                points.push(at.map(|x| 2.0 * x as f64 / n as f64 - 1.0));
                points.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut face = vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            if side == 0 {
                face.reverse();
            }
            faces.push(face);
        }
    }
    ControlMesh::new(points, faces).unwrap()
}

#[test]
fn a_torus_of_quads_is_one_spline() {
    let found = fitted(&torus(12, 8), &LayoutFitOptions::default());
    let space = found.fit.spline.space();
    println!(
        "{} patches, {:.1e}, volume {}",
        space.layout().patches().len(),
        found.fit.max(),
        found.fit.spline.volume()
    );
    assert_eq!(space.layout().patches().len(), 1);
    let mut spans = space.spans().to_vec();
    spans.sort_unstable();
    assert_eq!(spans, [8, 12]);
    assert!(found.fit.max() < 1e-6, "{:e}", found.fit.max());
    assert!(found.patch_of_quads.iter().all(|&p| p == 0) && found.patch_of_quads.len() == 96);
}

/// The corners of the cube have three quads around them, where no spline is the limit.
#[test]
fn a_cube_comes_nearer_with_its_quads() {
    let errors = [1, 2, 4].map(|n| {
        let options = LayoutFitOptions { tolerance: Some(1e-2), ..LayoutFitOptions::default() };
        let ControlMeshFit { fit, .. } = fitted(&cube(n), &options);
        println!("{n}: {:.2e} at most, {:.2e} rms, volume {:.6}", fit.max(), fit.rms(), fit.spline.volume());
        assert_eq!(fit.spline.space().layout().patches().len(), 6);
        assert!(fit.folded_patches.is_empty() && fit.spline.normal_jump() < 1e-8);
        [fit.rms(), fit.max()]
    });
    let [of_one, of_two, of_four] = errors;
    assert!(of_one[1] < 2e-4 && of_two[1] < of_one[1] && of_four[1] < of_two[1], "{errors:?}");
    assert!(of_two[0] < of_one[0] / 3.0 && of_four[0] < of_two[0] / 2.0, "{errors:?}");
}

#[test]
fn borders_and_other_polygons_are_fitted() {
    let n = 5;
    let points = (0..n * n).map(|k| [(k % n) as f64, (k / n) as f64, 0.1 * ((k * k) % 7) as f64]).collect();
    let corner = |i: usize, j: usize| (j * n + i) as u32;
    let faces = (0..(n - 1) * (n - 1)).map(|q| (q % (n - 1), q / (n - 1)));
    let quad = |(i, j)| vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
    let sheet = ControlMesh::new(points, faces.map(quad).collect()).unwrap();
    let found = fitted(&sheet, &LayoutFitOptions::default());
    assert_eq!(found.fit.spline.space().layout().patches().len(), 1);
    assert!(found.fit.max() < 1e-4, "{:e}", found.fit.max());
    // Four triangles are refined to twelve quads, three around each corner and each middle of a face: every one is a patch.
    let points = vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|face| face.to_vec()).to_vec();
    let found = fitted(&ControlMesh::new(points, faces).unwrap(), &LayoutFitOptions::default());
    assert_eq!((found.fit.spline.space().layout().patches().len(), found.patch_of_quads.len()), (12, 12));
    assert!(found.fit.is_within(1e-3), "{:e}", found.fit.max());
}

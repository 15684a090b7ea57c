//! Maps of least stretch to the sphere: what is round stays so, energies settle under refinement, and nothing is turned over.

use crate::common::named;
use ricci::flatten::{
    DistortionEnergy, FlattenOptions, FlattenStart, FlattenStop, SphereFlattening, flatten_sphere,
};
use ricci::geometry::predicates::winding;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::{Control, Error, Surface};
use std::cmp::Ordering;
use std::f64::consts::TAU;

fn round(surface: &Surface, options: &FlattenOptions) -> SphereFlattening {
    let found = flatten_sphere(surface, options, &Control::new()).unwrap();
    let is_turned = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| found.points[v as usize]);
        winding(a, b, c) != Ordering::Greater
    };
    assert!(!surface.mesh().triangles().iter().any(is_turned) && found.report.one_to_one);
    let off = |p: &[f64; 3]| (p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs();
    assert!(found.points.iter().map(off).fold(0.0, f64::max) < 1e-14);
    found
}

fn ellipsoid(axes: [f64; 3], n: usize) -> Surface {
    Surface::from_soup(&shapes::ellipsoid(axes, n).unwrap()).unwrap()
}

#[test]
fn a_sphere_is_isometric_to_the_fourth_order() {
    // The polyhedron has less area than its sphere by a part of the second order, and with it all lengths change alike.
    let errors: Vec<f64> = [6, 12, 24]
        .map(|n| round(&ellipsoid([1.0; 3], n), &FlattenOptions::default()))
        .iter()
        .map(|found| {
            assert!(found.report.converged(), "{:?}", found.report.stop);
            found.report.after.energy - 4.0
        })
        .collect();
    println!("{errors:?}");
    assert!(errors[0] > 0.0 && errors[0] < 0.01, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.5, "{errors:?}");
    }
}

#[test]
fn an_ellipsoid_settles_under_refinement_and_energies_trade_areas_for_angles() {
    let axes = [1.0, 1.4, 2.2];
    let energies = [8, 16, 32].map(|n| {
        let found = round(&ellipsoid(axes, n), &FlattenOptions::default());
        assert_eq!(found.report.stop, FlattenStop::Converged);
        assert!(found.report.after.energy < found.report.before.energy);
        found.report.after.energy
    });
    println!("{energies:?}");
    // The sphere is turned as the surface is.
    let surface = ellipsoid(axes, 8);
    for (p, q) in surface.positions().unwrap().iter().zip(round(&surface, &FlattenOptions::default()).points)
    {
        assert!((0..3).map(|c| p[c] / axes[c] * q[c]).sum::<f64>() > 0.7);
    }
    let order = ((energies[1] - energies[0]) / (energies[2] - energies[1])).log2();
    assert!((order - 2.0).abs() < 0.5, "{order} {energies:?}");
    let with = |energy, conformal| {
        let options = FlattenOptions { energy, conformal, ..FlattenOptions::default() };
        round(&ellipsoid(axes, 10), &options).report.after
    };
    let isometric = with(DistortionEnergy::Isometric, None);
    let area = with(DistortionEnergy::Area, None);
    let angles = with(DistortionEnergy::Isometric, Some(0.8));
    assert!(area.mean_area_error < isometric.mean_area_error, "{area:?}");
    assert!(angles.mean_dilatation < isometric.mean_dilatation, "{angles:?}");
}

#[test]
fn cortices_come_to_the_sphere_without_a_turned_triangle_with_the_same_bits_for_any_number_of_threads() {
    let names = ["cortex_fsaverage5_pial_left", "cortex_fsaverage5_white_left"];
    let Some(meshes) = named("good", &names) else { return };
    for (name, soup) in meshes {
        let surface = Surface::from_soup(&soup).unwrap();
        let found = round(&surface, &FlattenOptions::default());
        let report = &found.report;
        println!(
            "{name}: {:?} from {:?}, {} steps, {:?} to {:?}, {:?} s",
            report.stop,
            report.start,
            report.iterations(),
            report.before,
            report.after,
            report.seconds
        );
        assert!(report.converged(), "{name}: {:?}", report.stop);
        assert!(report.energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-13)), "{name}");
        if name == names[0] {
            let one = round(
                &surface,
                &FlattenOptions { threads: 1, max_iterations: 3, ..FlattenOptions::default() },
            );
            let two = round(
                &surface,
                &FlattenOptions { threads: 2, max_iterations: 3, ..FlattenOptions::default() },
            );
            assert!(one.points == two.points);
        }
    }
}

#[test]
fn triangles_that_the_conformal_map_turns_over_are_turned_back() {
    let Some(meshes) = named("good", &["fuze"]) else { return };
    for (name, soup) in meshes {
        let found = round(&Surface::from_soup(&soup).unwrap(), &FlattenOptions::default());
        assert_eq!(found.report.start, FlattenStart::Untangled, "{name}");
        assert!(found.report.converged(), "{name}: {:?}", found.report.stop);
    }
}

/// A triangular tube of so many rings between two tips, with regular triangles.
fn tube(n: usize) -> Surface {
    let at = |i: usize, j: usize| (1 + 3 * i + j % 3) as u32;
    let last = 3 * n as u32 + 1;
    let mut positions = vec![[0.0, 0.0, -0.5]];
    let mut faces = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let angle = (j as f64 + 0.5 * (i % 2) as f64) * TAU / 3.0;
        positions.push([0.5 * angle.cos(), 0.5 * angle.sin(), 0.8 * i as f64]);
        // Rings are turned by half a side, forth and back.
        let [below, above] = [[at(i, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1)]];
        match i % 2 {
            _ if i + 1 == n => {}
            0 => faces.extend([[below[0], below[1], above[0]], [above[0], below[1], above[1]]]),
            _ => faces.extend([[below[0], above[1], above[0]], [below[0], below[1], above[1]]]),
        }
    }
    positions.push([0.0, 0.0, 0.8 * n as f64 - 0.3]);
    for j in 0..3 {
        faces.extend([[0, at(0, j + 1), at(0, j)], [last, at(n - 1, j), at(n - 1, j + 1)]]);
    }
    Surface::from_soup(&Soup::new(positions, faces)).unwrap()
}

#[test]
fn limbs_that_the_conformal_map_makes_too_small_for_doubles_start_from_the_triangulation_alone() {
    let options = FlattenOptions { max_iterations: 5, ..FlattenOptions::default() };
    let found = round(&tube(60), &options);
    assert_eq!(found.report.start, FlattenStart::CoarseToFine);
    assert!(found.report.energies.is_sorted_by(|a, b| a > b) && found.report.energies.len() == 6);
}

#[test]
fn what_has_no_map_to_the_sphere_is_refused_by_name() {
    let refused = |surface: &Surface, options: &FlattenOptions| {
        flatten_sphere(surface, options, &Control::new()).unwrap_err()
    };
    let usual = FlattenOptions::default;
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 12, 8).unwrap()).unwrap();
    assert!(matches!(refused(&torus, &usual()), Error::Argument { what: "surface", .. }));
    let ball = ellipsoid([1.0; 3], 3);
    for energy in [DistortionEnergy::Arap, DistortionEnergy::Distance] {
        let options = FlattenOptions { energy, ..usual() };
        assert!(matches!(refused(&ball, &options), Error::Argument { what: "energy", .. }));
    }
    let options = FlattenOptions { injective: true, ..usual() };
    assert!(matches!(refused(&ball, &options), Error::Argument { what: "conditions", .. }));
    let control = Control::new();
    control.cancel();
    assert_eq!(flatten_sphere(&ball, &usual(), &control).unwrap_err(), Error::Cancelled);
}

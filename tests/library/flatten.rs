//! Flat maps: surfaces that unroll do so, a cap of the sphere comes to the answer of another method, and nothing is turned over.

use crate::common::named;
use ricci::flatten::{DistortionEnergy, FlattenOptions, FlattenStart, FlattenStop, Flattening, flatten};
use ricci::geometry::Space;
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::Soup;
use ricci::mesh::{Point, shapes};
use ricci::{Control, Error, Surface};
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

/// The number of triangles that the map turns over.
fn turned(surface: &Surface, points: &[[f64; 2]]) -> usize {
    let is_turned = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| points[v as usize]);
        orientation(a, b, c) != Ordering::Greater
    };
    surface.mesh().triangles().iter().filter(|f| is_turned(f)).count()
}

fn flat(surface: &Surface, options: &FlattenOptions) -> Flattening {
    let found = flatten(surface, options, &Control::new()).unwrap();
    assert_eq!(turned(surface, &found.points), 0);
    found
}

fn sheet(n: u32, m: u32, place: impl Fn(f64, f64) -> Point) -> Soup {
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let corners = (0..=m)
        .flat_map(|j| (0..=n).map(move |i| (f64::from(i) / f64::from(n), f64::from(j) / f64::from(m))));
    let positions = corners.map(|(x, y)| place(x, y)).collect();
    let squares = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
    let faces = squares.flat_map(|(i, j)| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Soup::new(positions, faces.collect())
}

#[test]
fn what_unrolls_is_isometric() {
    let cylinder = sheet(24, 10, |x, y| [(2.5 * x).cos(), (2.5 * x).sin(), 1.3 * y]);
    let cone = |x: f64, y: f64| {
        let (r, angle) = (0.4 + y, 4.0 * x);
        [0.6 * r * angle.cos(), 0.6 * r * angle.sin(), 0.8 * r]
    };
    // Rows of a prism and of a pyramid without its top: bent at lines through the whole surface, and flat between them.
    for soup in [cylinder, sheet(30, 8, cone)] {
        let surface = Surface::from_soup(&soup).unwrap();
        for energy in [DistortionEnergy::Isometric, DistortionEnergy::Arap] {
            let found = flat(&surface, &FlattenOptions { energy, ..FlattenOptions::default() });
            let after = &found.report.after;
            assert!(found.report.converged(), "{:?}", found.report);
            assert!(after.max_length_error < 1e-12 && (after.energy - 4.0).abs() < 1e-12, "{after:?}");
        }
    }
}

/// A cap of the unit sphere around the pole, to an angle, as a disk of rings with 6 k vertices on the k-th.
fn cap(rings: usize, angle: f64) -> Surface {
    let mut soup = shapes::disk(rings).unwrap();
    for p in &mut soup.positions {
        let r = p[0].hypot(p[1]);
        let (sin, cos) = (r * angle).sin_cos();
        let s = if r > 0.0 { sin / r } else { 0.0 };
        *p = [s * p[0], s * p[1], cos];
    }
    Surface::from_soup(&soup).unwrap()
}

/// The least energy among the maps of a cap that turn rings into rings: of f(s) ↦ ∫ (f'² + f'⁻² + (f/sin s)² + (sin s/f)²) sin s ds, over
/// ∫ sin s ds, by shooting: Euler's equation d/ds((2 f' − 2 f'⁻³) sin s) = 2 f/sin s − 2 sin³ s/f³ from the pole with f'(0) such that the
/// boundary is free, f' = 1. At the pole f = a s + b s³.
fn least_by_rings(angle: f64) -> f64 {
    /// f, the momentum (2 f' − 2 f'⁻³) sin s, and the energy so far.
    type Ring = [f64; 3];
    let slope_of = |p: f64| {
        // 2 q − 2 q⁻³ = p by Newton from the side where the iteration is monotone.
        let mut q = 1.0 + p.abs();
        if p < 0.0 {
            q = (1.0 / (1.0 - 0.5 * p)).cbrt();
        }
        for _ in 0..100 {
            q -= (2.0 * q - 2.0 / q.powi(3) - p) / (2.0 + 6.0 / q.powi(4));
        }
        q
    };
    let rate = |s: f64, [f, momentum, _]: Ring| -> Ring {
        let sin = s.sin();
        let q = slope_of(momentum / sin);
        let around = f / sin;
        let density = q * q + 1.0 / (q * q) + around * around + 1.0 / (around * around);
        [q, 2.0 * around - 2.0 / around.powi(3), density * sin]
    };
    let shot = |a: f64| {
        let n = 4000;
        let begin = 1e-3;
        let density = 2.0 * (a * a + 1.0 / (a * a));
        let mut at: Ring =
            [a * begin, (2.0 * a - 2.0 / a.powi(3)) * begin.sin(), density * (1.0 - begin.cos())];
        let h = (angle - begin) / f64::from(n);
        for k in 0..n {
            let s = begin + f64::from(k) * h;
            let ahead = |by: f64, d: Ring| [0, 1, 2].map(|i| at[i] + by * d[i]);
            let d1 = rate(s, at);
            let d2 = rate(s + 0.5 * h, ahead(0.5 * h, d1));
            let d3 = rate(s + 0.5 * h, ahead(0.5 * h, d2));
            let d4 = rate(s + h, ahead(h, d3));
            at = [0, 1, 2].map(|i| at[i] + h / 6.0 * (d1[i] + 2.0 * d2[i] + 2.0 * d3[i] + d4[i]));
        }
        at
    };
    let (mut low, mut high) = (0.5, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shot(middle)[1] > 0.0 { high = middle } else { low = middle }
    }
    shot(0.5 * (low + high))[2] / (1.0 - angle.cos())
}

#[test]
fn a_cap_comes_to_the_least_energy_of_rings_with_the_second_order() {
    let angle = FRAC_PI_2;
    let known = least_by_rings(angle);
    let errors: Vec<f64> = [8, 16, 32]
        .map(|n| flat(&cap(n, angle), &FlattenOptions::default()))
        .iter()
        .map(|found| {
            assert_eq!(found.report.stop, FlattenStop::Converged);
            found.report.after.energy - known
        })
        .collect();
    println!("hemisphere: {known:.8}, off by {errors:?}");
    assert!(known > 4.0 && known < 5.0);
    assert!(errors[2].abs() < 1e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.3, "order {order}: {errors:?}");
    }
}

#[test]
fn energies_trade_lengths_for_areas_and_angles() {
    let surface = cap(12, 1.2);
    let with = |energy, conformal| {
        let options = FlattenOptions { energy, conformal, ..FlattenOptions::default() };
        let found = flat(&surface, &options);
        assert!(found.report.converged(), "{energy:?} {conformal:?}: {:?}", found.report.stop);
        found.report.after
    };
    let isometric = with(DistortionEnergy::Isometric, None);
    let area = with(DistortionEnergy::Area, None);
    let blends = [0.2, 0.6, 0.9].map(|c| with(DistortionEnergy::Isometric, Some(c)));
    assert!(area.mean_area_error < 0.5 * isometric.mean_area_error, "{area:?} {isometric:?}");
    let dilatations: Vec<f64> =
        std::iter::once(&isometric).chain(&blends).map(|d| d.mean_dilatation).collect();
    assert!(dilatations.windows(2).all(|pair| pair[1] < pair[0]), "{dilatations:?}");
    let energies: Vec<f64> = std::iter::once(&isometric).chain(&blends).map(|d| d.energy).collect();
    assert!(energies.windows(2).all(|pair| pair[1] > pair[0]), "{energies:?}");
    let conformal = with(DistortionEnergy::Isometric, Some(1.0));
    assert!(
        (conformal.area - 1.0).abs() < 1e-12 && conformal.mean_dilatation < dilatations[3],
        "{conformal:?}"
    );
}

#[test]
fn real_surfaces_converge_without_a_turned_triangle() {
    let Some(meshes) = named("good", &["camel_b", "train_station", "demosthenes_low", "gargoyle_cut"]) else {
        return;
    };
    for (name, soup) in meshes {
        let found = flat(&Surface::from_soup(&soup).unwrap(), &FlattenOptions::default());
        let report = &found.report;
        assert!(report.converged(), "{name}: {:?}", report.stop);
        assert!(report.energies.windows(2).all(|pair| pair[1] <= pair[0] + 1e-13 * pair[0]), "{name}");
        let start = if name == "demosthenes_low" { FlattenStart::Tutte } else { FlattenStart::Conformal };
        assert_eq!(report.start, start, "{name}");
    }
}

#[test]
fn results_have_the_same_bits_for_any_number_of_threads_and_scale_with_powers_of_two() {
    let surface = cap(20, 1.4);
    let with = |threads| flat(&surface, &FlattenOptions { threads, ..FlattenOptions::default() }).points;
    let one = with(1);
    assert!(one == with(2) && one == with(7));
    let positions = surface.positions().unwrap().iter().map(|p| p.map(|x| 1024.0 * x)).collect::<Vec<_>>();
    let large = Surface::in_space(surface.mesh().clone(), positions).unwrap();
    let large = flat(&large, &FlattenOptions::default()).points;
    let apart =
        one.iter().zip(&large).map(|(p, q)| (p[0] - q[0] / 1024.0).abs().max((p[1] - q[1] / 1024.0).abs()));
    assert!(apart.fold(0.0, f64::max) < 1e-9);
}

#[test]
fn what_cannot_be_flattened_is_refused_by_name() {
    let refused =
        |surface: &Surface, options: &FlattenOptions| flatten(surface, options, &Control::new()).unwrap_err();
    let usual = FlattenOptions::default();
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 12, 8).unwrap()).unwrap();
    assert!(matches!(refused(&torus, &usual), Error::Layout(why) if why.contains("genus 1")));
    let disk = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
    let hyperbolic = disk.clone().read_in(Space::H2);
    assert!(matches!(refused(&hyperbolic, &usual), Error::Argument { .. }));
    for conformal in [-0.1, 1.1, f64::NAN] {
        let options = FlattenOptions { conformal: Some(conformal), ..usual.clone() };
        assert!(matches!(refused(&disk, &options), Error::Argument { what: "conformal", .. }));
    }
    let areas = FlattenOptions { energy: DistortionEnergy::Area, conformal: Some(0.0), ..usual.clone() };
    assert!(matches!(refused(&disk, &areas), Error::Argument { what: "conformal", .. }));
    let tolerance = FlattenOptions { tolerance: 0.0, ..usual.clone() };
    assert!(matches!(refused(&disk, &tolerance), Error::Argument { what: "tolerance", .. }));
    let control = Control::new();
    control.cancel();
    assert_eq!(flatten(&disk, &usual, &control).unwrap_err(), Error::Cancelled);
    // Without a step the map is the conformal one, which is not converged.
    let start = flat(&cap(6, 1.0), &FlattenOptions { max_iterations: 0, ..usual });
    assert_eq!((start.report.stop, start.report.iterations()), (FlattenStop::MaxIterations, 0));
    assert!(start.report.before == start.report.after && start.report.decrement.is_infinite());
}

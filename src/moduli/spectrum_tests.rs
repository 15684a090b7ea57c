//! Length spectra of surfaces for which they are known.

use super::geodesic::closed_geodesic;
use super::spectrum::{LengthSpectrum, SpectrumOptions, geodesic_length, length_spectrum};
use crate::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use crate::geometry::random::SplitMix64;
use crate::mesh::VertexId;
use crate::mesh::shapes::{self, IntrinsicSurface};
use crate::topology::{Letter, Word};
use crate::{Control, Error, Surface};
use std::f64::consts::SQRT_2;

/// Largest difference of lengths that are one.
const SAME: f64 = 1e-9;

fn uniformized(given: &IntrinsicSurface, base: Option<VertexId>) -> Quotient {
    let (mesh, lengths) = given.build().unwrap();
    quotient(&Surface::intrinsic(mesh, lengths, given.geometry).unwrap(), base)
}

fn quotient(surface: &Surface, base: Option<VertexId>) -> Quotient {
    let options = QuotientOptions { base, ..QuotientOptions::default() };
    uniformize_quotient(surface, &options, &Control::new()).unwrap()
}

fn spectrum(of: &Quotient, longest: f64) -> LengthSpectrum {
    let options = SpectrumOptions { longest, ..SpectrumOptions::default() };
    length_spectrum(of, &options, &Control::new()).unwrap()
}

/// The n for which cosh(l/2) = m + n √2 with the odd m nearest to n √2.
fn bolza_number(length: f64) -> Option<f64> {
    let half = (0.5 * length).cosh();
    let n = (half / (2.0 * SQRT_2)).round();
    let near = [-1.0, 0.0, 1.0].map(|step| n + step);
    near.into_iter().find(|n| {
        let m = 2.0 * ((n * SQRT_2 - 1.0) / 2.0).round() + 1.0;
        (2.0 * (m + n * SQRT_2).acosh() - length).abs() < SAME
    })
}

#[test]
fn lengths_of_the_bolza_surface_are_of_its_ring_whatever_the_base() {
    let mut first: Option<Vec<(f64, usize)>> = None;
    for (level, base) in [(1, None), (1, Some(VertexId(0))), (2, Some(VertexId(17))), (2, Some(VertexId(40)))]
    {
        let found = spectrum(&uniformized(&shapes::bolza(level).unwrap(), base), 7.0);
        let all = found.multiplicities(SAME);
        for &(length, n) in &all {
            assert!(bolza_number(length).is_some(), "{length} × {n}");
        }
        assert_eq!(all[0].1, 12);
        for (length, expected) in all.iter().zip([(1.0, 1.0), (3.0, 2.0), (5.0, 3.0), (5.0, 4.0)]) {
            let (m, n): (f64, f64) = expected;
            assert!((length.0 - 2.0 * (m + n * SQRT_2).acosh()).abs() < 1e-11, "{length:?} {expected:?}");
        }
        // Loops that run twice around the twelve shortest ones.
        let twice = found.classes.iter().filter(|class| class.power == 2).count();
        assert_eq!((twice, found.classes.iter().all(|class| class.power <= 2)), (12, true));
        let first = first.get_or_insert_with(|| all.clone());
        let counts = |of: &[(f64, usize)]| of.iter().map(|x| x.1).collect::<Vec<_>>();
        assert_eq!(counts(first), counts(&all), "level {level}, base {base:?}");
    }
    println!("{first:?}");
}

/// By the prime geodesic theorem the number of primitive oriented classes up to L is about Ei(L), for a surface whose Laplacian has no
/// eigenvalue in (0, 1/4), as that of Bolza.
#[test]
fn the_spectrum_grows_as_the_prime_geodesic_theorem_has_it() {
    let found = spectrum(&uniformized(&shapes::bolza(1).unwrap(), None), 8.5);
    // Ei(x) = γ + ln x + Σ xᵏ/(k k!).
    let integral = |x: f64| {
        let terms = (1..80).scan(1.0, |power, k| {
            *power *= x / f64::from(k);
            Some(*power / f64::from(k))
        });
        0.577_215_664_901_532_9 + x.ln() + terms.sum::<f64>()
    };
    for longest in [7.5f64, 8.0, 8.5] {
        let primitive = found.classes.iter().filter(|c| c.power == 1 && c.length <= longest).count();
        let ratio = 2.0 * primitive as f64 / integral(longest);
        println!("up to {longest}: {primitive} primitive geodesics, {ratio:.4} of the asymptotic number");
        assert!((ratio - 1.0).abs() < 0.15, "{longest}: {primitive} {ratio}");
    }
}

#[test]
fn lengths_of_a_flat_torus_are_those_of_its_lattice() {
    let tau = [0.3, 1.2];
    let found = spectrum(&uniformized(&shapes::flat_torus(tau, 4, 4).unwrap(), None), 6.0);
    let mut expected: Vec<f64> = (-20..=20i32)
        .flat_map(|m| (0..=20i32).map(move |n| (f64::from(m), f64::from(n))))
        .filter(|&(m, n)| n > 0.0 || m > 0.0)
        .map(|(m, n)| (m + n * tau[0]).hypot(n * tau[1]))
        .filter(|&l| l <= 6.0)
        .collect();
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.classes.len(), expected.len());
    for (class, l) in found.classes.iter().zip(&expected) {
        assert!((class.length - l).abs() < 1e-12, "{} {l}", class.length);
    }
    // Multiples m of lattice vectors are m-th powers: those of the shortest vector, 1, are 2, …, 6.
    let powers = found.classes.iter().filter(|c| (c.length - c.length.round()).abs() < 1e-12 && c.power > 1);
    assert!(powers.clone().count() >= 5 && powers.into_iter().all(|c| c.power <= 6));
}

#[test]
fn pants_have_their_boundary_loops_and_figure_eights() {
    let cuffs = [1.0, 1.5, 2.0];
    let found = spectrum(&uniformized(&shapes::pants(cuffs, 2).unwrap(), None), 6.0);
    let has = |l: f64| found.classes.iter().any(|c| c.power == 1 && (c.length - l).abs() < SAME);
    let [a, b, c] = cuffs.map(|l: f64| (0.5 * l).cosh());
    // Around two cuffs and the third between them: cosh(l/2) = 2 cosh(a/2) cosh(b/2) + cosh(c/2).
    for (x, y, z) in [(a, b, c), (b, c, a), (c, a, b)] {
        assert!(has(2.0 * z.acosh()) && has(2.0 * (2.0 * x * y + z).acosh()), "{x} {y} {z}");
    }
    let simple: Vec<f64> = found.multiplicities(SAME).iter().map(|x| x.0).take(3).collect();
    assert!(simple.iter().zip(cuffs).all(|(l, cuff)| (l - cuff).abs() < SAME), "{simple:?}");
}

#[test]
fn conjugates_of_words_have_one_length_which_is_in_the_spectrum() {
    let of = quotient(&Surface::from_soup(&shapes::genus(2, 4).unwrap()).unwrap(), None);
    let found = spectrum(&of, 5.0);
    let mut random = SplitMix64::new(3);
    let mut word = |n: usize| -> Word { (0..n).map(|_| Letter((random.bits() % 8) as u32)).collect() };
    let mut short = 0;
    for _ in 0..2000 {
        let (w, by) = (word(4), word(3));
        let length = geodesic_length(&of.deck, &w).unwrap();
        let other = geodesic_length(&of.deck, &by.times(&w).times(&by.inverse())).unwrap();
        assert!((length - other).abs() < SAME, "{length} {other}");
        if length > 0.0 && length <= 5.0 {
            short += 1;
            assert!(found.classes.iter().any(|c| (c.length - length).abs() < SAME), "{length}");
        }
    }
    assert!(short > 10, "{short}");
}

#[test]
fn geodesics_close_on_the_triangles_after_their_length() {
    let of = quotient(&Surface::from_soup(&shapes::genus(2, 4).unwrap()).unwrap(), None);
    let both = std::sync::Arc::new(of.metric.common_subdivision(&Control::new()).unwrap());
    let refined = of.layout.on_subdivision(&both, of.metric.metric(), &Control::new()).unwrap();
    let found = spectrum(&of, 4.5);
    assert!(found.classes.len() > 10, "{}", found.classes.len());
    for layout in [&of.layout, &refined] {
        for class in &found.classes {
            let line = closed_geodesic(layout, &class.element.motion, &Control::new()).unwrap();
            let off = line.length * class.power as f64 - class.length;
            assert!(off.abs() < 1e-7, "{class:?}: {} {off:e}", line.length);
            assert!(line.crossings.iter().all(|(_, share)| (0.0..=1.0).contains(share)));
        }
    }
}

/// By symmetry the shortest geodesics of the Bolza surface run through vertices and along edges.
#[test]
fn geodesics_along_edges_close() {
    for level in 0..=2 {
        let of = uniformized(&shapes::bolza(level).unwrap(), None);
        let found = spectrum(&of, 5.0);
        assert_eq!(found.classes.len(), 24);
        for class in &found.classes {
            let line = closed_geodesic(&of.layout, &class.element.motion, &Control::new()).unwrap();
            assert!((line.length - class.length).abs() < 1e-7, "level {level}, {class:?}: {}", line.length);
        }
    }
}

#[test]
fn what_has_no_spectrum_is_refused() {
    let of = uniformized(&shapes::bolza(0).unwrap(), None);
    let with = |longest: f64, limit: usize| {
        length_spectrum(&of, &SpectrumOptions { longest, limit }, &Control::new()).map(|s| s.classes.len())
    };
    assert!(matches!(with(0.0, 10), Err(Error::Argument { .. })));
    assert!(matches!(with(f64::INFINITY, 10), Err(Error::Argument { .. })));
    assert!(matches!(with(6.0, 100), Err(Error::TooLarge { .. })));
    assert_eq!(with(3.0, 100_000).unwrap(), 0);
    let control = Control::new();
    control.cancel();
    assert!(matches!(length_spectrum(&of, &SpectrumOptions::default(), &control), Err(Error::Cancelled)));
}

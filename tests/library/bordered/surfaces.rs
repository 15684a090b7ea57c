//! Surfaces with boundary, and what holds of every one with geodesic boundary.

use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::embed::dirichlet_domain;
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::{Control, Surface};
use std::f64::consts::PI;

pub const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];

pub fn from_soup(soup: &Soup) -> Surface {
    Surface::from_soup(soup).unwrap()
}

pub fn uniformized(surface: &Surface, options: &QuotientOptions) -> Quotient {
    uniformize_quotient(surface, options, &Control::new()).unwrap()
}

/// Everything that must hold of a surface with geodesic boundary, measured from what comes back.
pub fn check_geodesic(name: &str, q: &Quotient) {
    let given = q.metric.given();
    assert!(q.report.converged(), "{name}: {}", q.report.stop_reason);
    assert!(q.angle_defect < 1e-25, "{name}: {:e}", q.angle_defect);
    assert!(q.layout.flipped.is_empty() && q.layout.broken.is_empty(), "{name}");
    assert_eq!(q.deck.space, if given.euler() == 0 { Space::E2 } else { Space::H2 });
    let exact = -2.0 * PI * given.euler() as f64;
    if q.deck.space == Space::H2 {
        assert!((q.layout.area - exact).abs() < 1e-9 * exact, "{name}: area {} for {exact}", q.layout.area);
        assert!(q.deck.traces().into_iter().all(|trace| trace > 2.0), "{name}");
    }
    assert_eq!(q.boundary.len(), given.boundary_loops().len());
    for around in &q.boundary {
        assert_eq!(around.sides.len(), 1);
        let side = around.sides[0];
        assert!(side.straightness <= 1e-9, "{name}: {:e} off its geodesic", side.straightness);
        // The distance of two lifts of one vertex of the boundary, and the translation by its loop, agree where the loop is a geodesic.
        let length = q.deck.translation_lengths()[around.generator];
        assert!((side.length - length).abs() < 1e-11 * length, "{name}: {} {length}", side.length);
    }
    assert!(q.deck.relation_residual <= 1e-15, "{name}: {:e}", q.deck.relation_residual);
    assert!(q.deck.side_residual <= 1e-15, "{name}: {:e}", q.deck.side_residual);
    let domain = dirichlet_domain(&q.deck, ORIGIN, q.layout.area, &Control::new())
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!((domain.area - q.layout.area).abs() < 1e-7 * q.layout.area, "{name}: {}", domain.area);
    // Along its sides on the boundary lies the whole of the boundary, once.
    let n = domain.sides.len();
    let mut covered = vec![0.0; q.boundary.len()];
    for k in (0..n).filter(|&k| domain.partner[k].is_none()) {
        let length = domain.sides[k].motion.translation_length();
        let nearest = |&i: &usize| (q.boundary[i].length() - length).abs();
        let loops = (0..q.boundary.len()).filter(|i| nearest(i) < 1e-7 * length);
        let [a, b] = [domain.corners[k], domain.corners[(k + 1) % n]];
        let share = ricci::embed::layout::distance(q.deck.space, a, b);
        loops.for_each(|i| covered[i] += share);
    }
    for (around, covered) in q.boundary.iter().zip(covered) {
        let twins = q.boundary.iter().filter(|o| (o.length() / around.length() - 1.0).abs() < 1e-7).count();
        let whole = twins as f64 * around.length();
        assert!((covered / whole - 1.0).abs() < 1e-5, "{name}: {covered} of {whole}");
    }
}

//! Uniformizations with known answers.

use crate::uniformization::quotient::check;
use crate::uniformization::surfaces::Surface;
use ricci::Control;
use ricci::canonical::{QuotientOptions, Uniformization, uniformize};
use ricci::embed::cover::elements_within;
use ricci::embed::{Layout, LayoutOpening, LayoutOptions, dirichlet_domain};
use ricci::geometry::Space;
use ricci::geometry::modulus::modulus;
use ricci::mesh::{VertexId, shapes};

const SQRT_2: f64 = std::f64::consts::SQRT_2;

#[test]
fn a_flat_torus_keeps_its_modulus() {
    for tau in [[0.3, 1.2], [0.0, 1.0], [0.5, 0.75f64.sqrt()], [2.3, 0.4]] {
        let surface = Surface::intrinsic("flat torus", &shapes::flat_torus(tau, 6, 5).unwrap());
        let q = surface.uniformized();
        check(&surface, &q);
        let expected = modulus([[1.0, 0.0], tau]).unwrap();
        let found = q.deck.modulus().unwrap();
        assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1e-12), "{tau:?}: {found:?} {expected:?}");
    }
}

/// The modulus i r/√(R² − r²) of the torus of revolution is approached with the square of the edge length.
#[test]
fn the_modulus_of_the_torus_of_revolution_converges() {
    let (big, small) = (2.0f64, 1.2f64);
    let expected = modulus([[1.0, 0.0], [0.0, small / (big * big - small * small).sqrt()]]).unwrap();
    let error = |n: usize| {
        let surface = Surface::from_soup("torus", &shapes::torus(big, small, n, n).unwrap());
        let found = surface.uniformized().deck.modulus().unwrap();
        (found[0] - expected[0]).hypot(found[1] - expected[1])
    };
    let errors = [12, 24, 48].map(error);
    println!("modulus of the torus of revolution: errors {errors:?}");
    assert!(errors[0] / errors[1] > 3.5 && errors[1] / errors[2] > 3.5 && errors[2] < 3e-3, "{errors:?}");
}

/// The Bolza surface: the Dirichlet domain of the octagon's centre is the octagon, whose side pairings have |tr| = 2(1 + √2), the
/// systole's; every trace is 2(m + n√2) with whole m, n.
#[test]
fn the_bolza_surface_has_its_octagon_and_its_traces() {
    for level in [0, 2, 3] {
        let surface = Surface::intrinsic("Bolza surface", &shapes::bolza(level).unwrap());
        // The centre is the vertex of degree 8 whose neighbourhood the generator builds first.
        let (coarse, _) = shapes::bolza(0).unwrap().build().unwrap();
        let centre = coarse.vertices().find(|&v| coarse.outgoing(v).count() == 8).unwrap();
        let q = surface.with(&QuotientOptions { base: Some(centre), ..QuotientOptions::default() });
        check(&surface, &q);
        let at = q.layout.corner(q.deck.corner);
        let domain = dirichlet_domain(&q.deck, at, q.layout.area, &Control::new()).unwrap();
        assert_eq!(domain.sides.len(), 8);
        for side in &domain.sides {
            let trace = 2.0 * side.motion.half_trace().high.abs();
            assert!((trace - 2.0 * (1.0 + SQRT_2)).abs() < 1e-9, "{trace}");
        }
        let all = elements_within(&q.deck, &domain, 8.0, 100_000, &Control::new()).unwrap();
        assert!(all.len() > 500, "{}", all.len());
        for g in &all[1..] {
            let half = g.motion.half_trace().high.abs();
            assert!(half > 1.0 + SQRT_2 - 1e-9, "{half}");
            let found = (0..2000).any(|n| {
                let m = half - f64::from(n) * SQRT_2;
                (m - m.round()).abs() < 1e-9 * half
            });
            assert!(found, "{half}");
        }
        let shortest =
            all[1..].iter().map(|g| g.motion.half_trace().high.abs()).fold(f64::INFINITY, f64::min);
        assert!((shortest - 1.0 - SQRT_2).abs() < 1e-12);
    }
}

/// The same surface on other triangulations has the same group: traces of all elements within a radius agree.
#[test]
fn traces_depend_on_the_surface_alone() {
    let lengths = |level: usize| {
        let surface = Surface::intrinsic("Bolza surface", &shapes::bolza(level).unwrap());
        let q = surface.with(&QuotientOptions { base: Some(VertexId(0)), ..QuotientOptions::default() });
        let at = q.layout.corner(q.deck.corner);
        let domain = dirichlet_domain(&q.deck, at, q.layout.area, &Control::new()).unwrap();
        let all = elements_within(&q.deck, &domain, 5.0, 10_000, &Control::new()).unwrap();
        let mut lengths: Vec<f64> = all.iter().map(|g| g.motion.translation_length()).collect();
        lengths.sort_by(f64::total_cmp);
        lengths
    };
    let (coarse, fine) = (lengths(1), lengths(3));
    assert_eq!(coarse.len(), fine.len());
    assert!(coarse.iter().zip(&fine).all(|(a, b)| (a - b).abs() < 1e-12));
}

/// On the unit sphere the layout closes without a cut, and its triangles are those of the polyhedron.
#[test]
fn a_sphere_is_laid_out_without_a_cut() {
    let surface = Surface::from_soup("ellipsoid", &shapes::ellipsoid([1.0, 1.3, 0.8], 4).unwrap());
    let one = uniformize(&surface.given(), &QuotientOptions::default(), &Control::new());
    let Uniformization::Sphere(sphere) = one.unwrap() else { panic!("a sphere") };
    let mesh = sphere.metric.mesh();
    let (opening, root) = (LayoutOpening::MetricEdges, Some(VertexId(7)));
    let options = LayoutOptions { opening, root, ..LayoutOptions::default() };
    let layout = Layout::of_solution(&sphere.metric, &options, &Control::new()).unwrap();
    assert!(layout.cut.segments.is_empty() && layout.seams.is_empty());
    assert!(layout.flipped.is_empty() && layout.broken.is_empty());
    assert!(layout.disagreement < 1e-10, "{:e}", layout.disagreement);
    assert!((layout.area - 4.0 * std::f64::consts::PI).abs() < 1e-10);
    // The polyhedron's, turned: the same products.
    for e in mesh.edges() {
        let h = e.halfedge();
        let [p, q] = [layout.corner(h), layout.corner(mesh.next(h))];
        let [a, b] = mesh.ends(e).map(|v| sphere.positions[v]);
        let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        assert!((dot(p, q) - dot(a, b)).abs() < 1e-10);
    }
}

/// One call goes by the Euler characteristic.
#[test]
fn one_call_serves_every_closed_surface() {
    let surfaces = [
        (Surface::from_soup("sphere", &shapes::icosphere(3).unwrap()), Space::S2),
        (Surface::from_soup("torus", &shapes::torus(2.0, 0.8, 12, 8).unwrap()), Space::E2),
        (Surface::from_soup("genus 2", &shapes::genus(2, 2).unwrap()), Space::H2),
    ];
    for (surface, space) in surfaces {
        let one = uniformize(&surface.given(), &QuotientOptions::default(), &Control::new()).unwrap();
        assert!(one.converged() && one.space() == space, "{}", surface.name);
        let curvature = one.metric().curvature().unwrap();
        assert!(curvature.at.iter().all(|k| k.abs() < 1e-9), "{}", surface.name);
    }
}

#[test]
fn the_base_of_a_sphere_is_its_puncture() {
    let surface = Surface::from_soup("ellipsoid", &shapes::ellipsoid([1.0, 1.3, 0.8], 3).unwrap());
    for v in [5, 17] {
        let options = QuotientOptions { base: Some(VertexId(v)), ..QuotientOptions::default() };
        let one = uniformize(&surface.given(), &options, &Control::new());
        let Uniformization::Sphere(sphere) = one.unwrap() else { panic!("a sphere") };
        assert_eq!(sphere.report.puncture, VertexId(v));
    }
}

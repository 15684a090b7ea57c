//! Structures with known answers.

use crate::structure::{glued, made, of, options};
use ricci::geometry::modulus::modulus;
use ricci::mesh::{VertexId, shapes};
use ricci::structure::{
    AffineSource, Atlas, AtlasOptions, ChartKind, GroupElement, Structure, least_distorting_vertex,
};
use ricci::{Control, harmonic::Domain};

/// The translation of a transition whose linear part is the identity.
fn translation(element: &GroupElement) -> [f64; 2] {
    let GroupElement::Projective(m) = element else { panic!("{element:?}") };
    for (i, j, expected) in [(0, 0, 1.0), (0, 1, 0.0), (1, 0, 0.0), (1, 1, 1.0), (2, 0, 0.0), (2, 1, 0.0)] {
        assert!((m[(i, j)] - expected).abs() < 1e-12, "{m}");
    }
    [m[(0, 2)], m[(1, 2)]]
}

/// Charts placed along a tree of overlaps: every transition is then a translation by a vector of the lattice that the holonomy spans.
fn check_lattice(atlas: &Atlas) {
    let [a, b] = [0, 1].map(|k| translation(&atlas.holonomy.element(Structure::Affine, k).unwrap()));
    let det = a[0] * b[1] - a[1] * b[0];
    let mut place: Vec<Option<[f64; 2]>> = vec![None; atlas.charts.len()];
    place[0] = Some([0.0; 2]);
    let (mut grown, mut moved) = (true, 0);
    while grown {
        grown = false;
        for t in &atlas.transitions {
            let [x, y] = translation(&t.element);
            let ends = [t.from, t.to].map(|chart| chart as usize);
            match (place[ends[0]], place[ends[1]]) {
                (Some(p), None) => place[ends[1]] = Some([p[0] - x, p[1] - y]),
                (None, Some(q)) => place[ends[0]] = Some([q[0] + x, q[1] + y]),
                _ => continue,
            }
            grown = true;
        }
    }
    for t in &atlas.transitions {
        let [x, y] = translation(&t.element);
        let [p, q] = [t.from, t.to].map(|chart| place[chart as usize].unwrap());
        let by = [x - p[0] + q[0], y - p[1] + q[1]];
        let share = [(by[0] * b[1] - by[1] * b[0]) / det, (a[0] * by[1] - a[1] * by[0]) / det];
        assert!(share.iter().all(|s| (s - s.round()).abs() < 1e-10), "{share:?}");
        moved += usize::from(share.iter().any(|s| s.round() != 0.0));
    }
    assert!(moved > 0);
}

#[test]
fn transitions_of_a_flat_torus_are_translations_of_its_lattice() {
    let tau = [0.3, 1.2];
    let torus = glued(shapes::flat_torus(tau, 5, 7));
    for source in [AffineSource::Flow, AffineSource::Form] {
        for charts in [ChartKind::Stars, ChartKind::Patches] {
            let found = made(&torus, &AtlasOptions { source, ..options(Structure::Affine, charts) });
            check_lattice(&found);
            let periods = [0, 1].map(|k| translation(&found.holonomy.element(Structure::Affine, k).unwrap()));
            let own = modulus(periods).unwrap();
            assert!((own[0] - tau[0]).abs() < 1e-9 && (own[1] - tau[1]).abs() < 1e-9, "{own:?}");
        }
    }
}

/// Translation lengths on the Bolza surface: cosh(L/2) = m + n√2 with whole numbers, at least 1 + √2.
#[test]
fn the_holonomy_of_the_bolza_surface_has_the_traces_of_its_group() {
    let bolza = glued(shapes::bolza(2));
    let found = made(&bolza, &options(Structure::Hyperbolic, ChartKind::Stars));
    for k in 0..4 {
        let Some(GroupElement::Mobius(m)) = found.holonomy.element(Structure::Hyperbolic, k) else {
            panic!()
        };
        let half = 0.5 * m.trace().re.abs();
        assert!(half > 1.0 + 2f64.sqrt() - 1e-9, "{half}");
        let is_whole = |n: i32| {
            let rest = half - f64::from(n) * 2f64.sqrt();
            (rest - rest.round()).abs() < 1e-9
        };
        assert!((0..60).any(is_whole), "{half}");
        // The same element of SO(2,1): its trace is tr² − 1.
        let Some(GroupElement::Projective(p)) = found.holonomy.element(Structure::Projective, k) else {
            panic!()
        };
        assert!((p.trace() / (4.0 * half * half - 1.0) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn rotations_of_the_sphere_are_unitary() {
    let sphere = of(shapes::ellipsoid([1.0, 1.5, 2.0], 3));
    for charts in [ChartKind::Stars, ChartKind::Patches] {
        let found = made(&sphere, &options(Structure::Spherical, charts));
        for t in &found.transitions {
            let GroupElement::Mobius(m) = t.element else { panic!() };
            let off = m * m.adjoint() - GroupElement::identity(Structure::Spherical).matrix2();
            assert!(off.iter().all(|z| z.norm() < 1e-14) && (m.determinant().re - 1.0).abs() < 1e-14);
        }
    }
}

trait Matrix2 {
    fn matrix2(&self) -> nalgebra::Matrix2<nalgebra::Complex<f64>>;
}

impl Matrix2 for GroupElement {
    fn matrix2(&self) -> nalgebra::Matrix2<nalgebra::Complex<f64>> {
        let GroupElement::Mobius(m) = self else { panic!() };
        *m
    }
}

/// Straight lines of one Klein chart are straight in every other; in the Poincaré disk they are not.
#[test]
fn projective_transitions_carry_lines_to_lines() {
    let two = of(shapes::genus(2, 2));
    let bend = |structure| {
        let found = made(&two, &options(structure, ChartKind::Patches));
        let mut most: f64 = 0.0;
        for t in &found.transitions {
            let from = &found.charts[t.from as usize];
            for pair in t.pairs.windows(2) {
                let [p, q] = [0, 1].map(|k| from.coordinates[pair[k][0] as usize]);
                let on = |s: f64| t.element.apply([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
                let [a, b, c] = [0.0, 0.4, 1.0].map(on);
                let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                let length = (c[0] - a[0]).hypot(c[1] - a[1]);
                most = most.max(area.abs() / (length * length));
            }
        }
        most
    };
    assert!(bend(Structure::Projective) < 1e-9);
    assert!(bend(Structure::Hyperbolic) > 1e-4);
}

/// Charts of the same shape: the Klein charts are those of the Poincaré disk under 2z/(1 + |z|²).
#[test]
fn projective_charts_are_the_hyperbolic_ones_in_the_klein_disk() {
    let two = of(shapes::genus(2, 2));
    let [poincare, klein] = [Structure::Hyperbolic, Structure::Projective]
        .map(|structure| made(&two, &options(structure, ChartKind::Stars)));
    for (p, k) in poincare.charts.iter().zip(&klein.charts) {
        assert_eq!(p.vertices, k.vertices);
        for (z, w) in p.coordinates.iter().zip(&k.coordinates) {
            let factor = 2.0 / (1.0 + z[0] * z[0] + z[1] * z[1]);
            assert!((factor * z[0] - w[0]).abs() < 1e-15 && (factor * z[1] - w[1]).abs() < 1e-15);
        }
    }
}

/// Area-weighted variance of the logarithm of how the flow to one cone changes areas.
fn distortion(surface: &ricci::Surface, v: VertexId) -> f64 {
    let asked = AtlasOptions { singular: Some(v), ..options(Structure::Affine, ChartKind::Stars) };
    let found = made(surface, &asked);
    assert_eq!(found.singular_vertices, [v]);
    let factor = found.metric.conformal_factor().unwrap();
    let areas = Domain::new(surface, &Control::new()).unwrap().vertex_areas().clone();
    let area: f64 = areas.iter().sum();
    let mean = factor.iter().zip(&areas).map(|(u, a)| a * u).sum::<f64>() / area;
    factor.iter().zip(&areas).map(|(u, a)| a * (u - mean) * (u - mean)).sum::<f64>() / area
}

/// The linear estimate picks a vertex whose flow distorts areas less than at almost every vertex of a sample.
#[test]
fn the_vertex_that_the_library_chooses_distorts_areas_little() {
    for surface in [of(shapes::genus(2, 2)), of(shapes::genus(3, 2))] {
        let domain = Domain::new(&surface, &Control::new()).unwrap();
        let best = least_distorting_vertex(&domain, &Control::new()).unwrap();
        let chosen = distortion(&surface, best);
        let n = surface.mesh().n_vertices();
        let sample: Vec<f64> = (0..10).map(|k| distortion(&surface, VertexId::from(k * n / 10))).collect();
        let better = sample.iter().filter(|x| **x < 0.95 * chosen).count();
        assert!(better <= 1, "{chosen}: {sample:?}");
    }
}

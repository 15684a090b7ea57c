//! Singular vertices of any total angle, as many as the shape of a surface needs, and none where none is needed.

use ricci::canonical::{BoundaryCorner, Corners};
use ricci::mesh::{Mesh, VertexId, io::Soup, shapes};
use ricci::spline::{
    FlatMetric, FlatMetricOptions, SingularVertices, SurfaceFit, SurfaceFitOptions, fit_surface,
};
use ricci::structure::AffineSource;
use ricci::{Control, Error, Surface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Directions of limbs.
const LIMBS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];

/// A ball with four limbs, three times as long as its radius.
fn with_limbs(n: usize) -> Surface {
    let mut soup = shapes::icosphere(n).unwrap();
    for p in &mut soup.positions {
        let size = |a: [f64; 3]| a.iter().map(|x| x * x).sum::<f64>().sqrt();
        let far = size(*p);
        let limb = |axis: &[f64; 3]| {
            let cosine = (0..3).map(|k| axis[k] * p[k]).sum::<f64>() / (size(*axis) * far);
            2.0 * ((cosine - 1.0) / 0.05).exp()
        };
        let scale = (1.0 + LIMBS.iter().map(limb).sum::<f64>()) / far;
        *p = p.map(|x| scale * x);
    }
    Surface::from_soup(&soup).unwrap()
}

fn fit(surface: &Surface, options: &FlatMetricOptions) -> (FlatMetric, SurfaceFit) {
    let flat = FlatMetric::new(surface, options, &Control::new()).unwrap();
    let found = fit_surface(surface, &flat, &SurfaceFitOptions::default(), &Control::new()).unwrap();
    (flat, found)
}

fn with_singular(singular: SingularVertices) -> FlatMetricOptions {
    FlatMetricOptions { singular, ..FlatMetricOptions::default() }
}

#[test]
fn limbs_get_cones_and_keep_their_size() {
    let surface = with_limbs(20);
    let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &Control::new()).unwrap();
    let once = SurfaceFitOptions { rounds: 1, corrections: 5, ..SurfaceFitOptions::default() };
    let found = fit_surface(&surface, &flat, &once, &Control::new()).unwrap();
    let curvature = flat.curvature().unwrap();
    let total: f64 = curvature.iter().sum();
    assert!((total - 2.0 * TAU).abs() < 1e-6, "{total}");
    // Each limb has a cone of positive curvature at its tip.
    let positions = surface.positions().unwrap();
    for axis in LIMBS {
        let is_at_tip = |&&v: &&VertexId| {
            let along = (0..3).map(|k| axis[k] * positions[v.index()][k]).sum::<f64>() / 3f64.sqrt();
            curvature[v] > 0.5 && along > 2.0
        };
        assert_eq!(found.singular.iter().filter(is_at_tip).count(), 1, "{axis:?}");
    }
    // With one vertex at infinity, tips of limbs shrink to nothing.
    let one = FlatMetric::new(&surface, &with_singular(SingularVertices::Count(1)), &Control::new()).unwrap();
    let [range, before] = [&flat, &one].map(|flat| flat.factor_range(&surface).unwrap());
    eprintln!("factors within {range:.1} by {} cones, {before:.1} by one", found.singular.len());
    assert!(range < 40.0 && before > 3.0 * range, "{range} {before}");
    eprintln!("rms {:.1e} max {:.1e} folds {:?}", found.rms, found.max, found.folds);
    assert!(found.rms < 1e-2, "{}", found.rms);
    assert_eq!(found.spline.holes().len(), found.singular.len());
    // Outside the holes it is as smooth as its degree allows.
    let identities = found.spline.identities(0, &Control::new()).unwrap();
    assert!(identities.continuity < 1e-8 && identities.partition_of_unity < 1e-12, "{identities:?}");
}

#[test]
fn the_filling_around_a_narrow_cone_has_normals_and_curvatures() {
    let surface = Surface::from_soup(&shapes::icosphere(16).unwrap()).unwrap();
    let (_, found) = fit(&surface, &with_singular(SingularVertices::Count(4)));
    assert_eq!(found.spline.holes().len(), 4);
    for hole in found.spline.holes() {
        assert!(hole.turns > 0.1 && hole.turns < 1.0, "{}", hole.turns);
        for far in [0.0, 0.3, 0.9, 1.1] {
            for k in 0..8 {
                let angle = TAU * hole.turns * f64::from(k) / 8.0;
                let at = hole.place(found.spline.space(), hole.radius * far, angle).unwrap();
                let at = found.spline.surface_point(at).unwrap();
                let [low, high] = at.principal_curvatures().unwrap();
                let size = at.point.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!((size - 1.0).abs() < 1e-2, "{size}");
                assert!((low.abs() - 1.0).abs() < 0.5 && (high.abs() - 1.0).abs() < 0.5, "{low} {high}");
            }
        }
    }
}

/// A surface of this genus with a hole punched into it.
fn punctured(genus: usize, n: usize) -> Surface {
    let soup: Soup = match genus {
        1 => shapes::torus(2.0, 1.0, 60, 40).unwrap(),
        _ => shapes::genus(genus, n).unwrap(),
    };
    Surface::from_soup(&shapes::punch(&soup, 1).unwrap()).unwrap()
}

fn has_one_loop(mesh: &Mesh, genus: usize) -> bool {
    mesh.boundary_loops().len() == 1 && mesh.genus() == genus
}

#[test]
fn a_surface_with_boundary_needs_no_singular_vertex() {
    for genus in [1, 2] {
        let surface = punctured(genus, 8);
        let mesh = surface.mesh();
        assert!(has_one_loop(mesh, genus));
        let options = with_singular(SingularVertices::Count(0));
        let flat = FlatMetric::new(&surface, &options, &Control::new()).unwrap();
        assert!(flat.singular().unwrap().is_empty());
        let curvature = flat.curvature().unwrap();
        let inside = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
        assert!(inside.map(|v| curvature[v].abs()).fold(0.0, f64::max) < 1e-7);
        let total: f64 = curvature.iter().sum();
        assert!((total - TAU * mesh.euler() as f64).abs() < 1e-6, "{total}");
        let found = fit_surface(&surface, &flat, &SurfaceFitOptions::default(), &Control::new()).unwrap();
        assert!(found.spline.holes().is_empty());
    }
}

#[test]
fn corners_are_taken_as_given_or_refused() {
    let surface = punctured(1, 8);
    let walk = surface.mesh().boundary_loops().remove(0);
    let corner = |k: usize, angle: f64| BoundaryCorner {
        vertex: surface.mesh().tip(walk[k * walk.len() / 4]),
        angle: Some(angle),
    };
    let corners = |angle: f64| Corners::At((0..4).map(|k| corner(k, angle)).collect());
    let options = |angle: f64| FlatMetricOptions { corners: corners(angle), ..FlatMetricOptions::default() };
    let flat = FlatMetric::new(&surface, &options(1.5 * PI), &Control::new()).unwrap();
    let curvature = flat.curvature().unwrap();
    for k in 0..4 {
        let found = curvature[corner(k, 0.0).vertex];
        assert!((found + FRAC_PI_2).abs() < 1e-7, "{found}");
    }
    let wrong = FlatMetric::new(&surface, &options(PI), &Control::new()).unwrap_err();
    assert!(matches!(wrong, Error::TargetTotal { .. }), "{wrong}");
    let both = FlatMetricOptions { singular: SingularVertices::Count(1), ..options(1.5 * PI) };
    let both = FlatMetric::new(&surface, &both, &Control::new()).unwrap_err();
    assert!(both.to_string().contains("corners"), "{both}");
    let closed = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let wrong = FlatMetric::new(&closed, &options(1.5 * PI), &Control::new()).unwrap_err();
    assert!(wrong.to_string().contains("no boundary"), "{wrong}");
}

#[test]
fn a_form_on_genus_three_has_four_singular_vertices() {
    let surface = Surface::from_soup(&shapes::genus(3, 10).unwrap()).unwrap();
    let options = FlatMetricOptions { source: AffineSource::Form, ..FlatMetricOptions::default() };
    let (flat, found) = fit(&surface, &options);
    let curvature = flat.curvature().unwrap();
    let orders: Vec<f64> = found.singular.iter().map(|&v| -curvature[v] / TAU).collect();
    assert!(orders.iter().all(|order| (order - order.round()).abs() < 1e-7), "{orders:?}");
    assert_eq!(orders.iter().sum::<f64>().round() as i64, 4, "{orders:?}");
    eprintln!("orders {orders:?} rms {:.1e} max {:.1e} folds {:?}", found.rms, found.max, found.folds);
    assert!(found.rms < 2e-3 && found.max < 2e-2, "{} {}", found.rms, found.max);
}

#[test]
fn numbers_of_singular_vertices_that_cannot_be_are_refused() {
    let sphere = Surface::from_soup(&shapes::icosphere(6).unwrap()).unwrap();
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12).unwrap()).unwrap();
    for (surface, singular) in [
        (&sphere, SingularVertices::Count(0)),
        (&sphere, SingularVertices::Count(2)),
        (&torus, SingularVertices::Count(1)),
        (&torus, SingularVertices::At(vec![VertexId(3)])),
        (&sphere, SingularVertices::At(vec![VertexId(3), VertexId(4), VertexId(3)])),
        (&sphere, SingularVertices::At(vec![VertexId(100_000)])),
    ] {
        let error = FlatMetric::new(surface, &with_singular(singular), &Control::new()).unwrap_err();
        assert!(matches!(error, Error::TargetKind { .. } | Error::Argument { .. }), "{error}");
    }
}

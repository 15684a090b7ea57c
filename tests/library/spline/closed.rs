//! Bicubic patches of splines over whole surfaces, and their STEP files.

use ricci::mesh::{VertexId, shapes};
use ricci::spline::{
    BicubicFit, BicubicOptions, BicubicPatch, FlatMetric, FlatMetricOptions, SingularVertices, Spline,
    SurfaceFitOptions, fit_surface,
};
use ricci::{Control, Surface};

fn fitted(soup: &ricci::mesh::io::Soup, control_points: usize) -> Spline {
    let (surface, control) = (Surface::from_soup(soup).unwrap(), Control::new());
    let singular = match surface.mesh().euler() {
        0 => SingularVertices::Auto,
        _ => SingularVertices::At(vec![VertexId(0)]),
    };
    let flat =
        FlatMetric::new(&surface, &FlatMetricOptions { singular, ..FlatMetricOptions::default() }, &control)
            .unwrap();
    let control_points = Some(control_points);
    let options = SurfaceFitOptions { rounds: 2, control_points, ..SurfaceFitOptions::default() };
    fit_surface(&surface, &flat, &options, &control).unwrap().spline
}

fn patches(spline: &Spline, tolerance: f64) -> BicubicFit {
    let options = BicubicOptions { tolerance, ..BicubicOptions::default() };
    spline.to_bicubic(&options, &Control::new()).unwrap()
}

#[test]
fn a_torus_closes_up_with_its_volume() {
    let spline = fitted(&shapes::torus(2.0, 0.8, 120, 60).unwrap(), 400);
    let BicubicFit { surface, distance, angles, spans, .. } = patches(&spline, 1e-3);
    eprintln!(
        "{distance:e} {angles:?} {spans:?}; one polynomial: {:?}",
        crate::spline::bicubic::polynomials(&spline)
    );
    assert!(surface.is_closed() && surface.open_sides() == 0 && distance <= 1e-3);
    let all: Vec<usize> = (0..surface.patches.len()).collect();
    assert_eq!(surface.parts(), std::slice::from_ref(&all));
    let exact = 2.0 * std::f64::consts::PI.powi(2) * 2.0 * 0.8 * 0.8;
    assert!((surface.volume(&all) / exact - 1.0).abs() < 0.02, "{} {exact}", surface.volume(&all));
}

#[test]
fn the_surroundings_of_a_singular_vertex_are_patches_as_others() {
    let spline = fitted(&shapes::genus(2, 8).unwrap(), 700);
    let surface = patches(&spline, 1.0).surface;
    assert!(surface.is_closed() && surface.open_sides() == 0);
    let [hole] = spline.holes() else { panic!("one hole") };
    // Patches at the vertex share one point and one tangent plane; all turns of the chart are one turn on the surface.
    let at_vertex = |patch: &&BicubicPatch| {
        let (of, corner) = patch.source;
        let [x, y] = spline.space().patches()[of as usize].knots[corner][0];
        hole.sectors
            .iter()
            .any(|s| s.patch == of && s.to.iter().all(|r| (r[0] * x + r[1] * y + r[2]).abs() < 1e-9))
    };
    let corners: Vec<_> = surface.patches.iter().filter(at_vertex).map(|p| p.evaluate([0.0, 0.0])).collect();
    assert!(corners.len() > 3 * hole.turns as usize, "{}", corners.len());
    let mut turn = 0.0;
    for corner in &corners {
        assert_eq!(corner.point, corners[0].point);
        let (m, n) = (corner.normal().unwrap(), corners[0].normal().unwrap());
        assert!((0..3).map(|x| m[x] * n[x]).sum::<f64>() > 0.98);
        let [s, t] = corner.first;
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|x| a[x] * b[x]).sum::<f64>();
        turn += (dot(s, t) / (dot(s, s) * dot(t, t)).sqrt()).acos();
    }
    assert!((turn - std::f64::consts::TAU).abs() < 0.01, "{turn}");
}

#[cfg(feature = "step")]
#[test]
fn the_same_patches_give_the_same_bytes_twice_and_a_second_reader_finds_their_topology() {
    use ricci::spline::StepOptions;
    let surface = patches(&fitted(&shapes::torus(2.0, 0.8, 60, 30).unwrap(), 200), 1e-2).surface;
    let options = StepOptions { name: "torus".into(), ..StepOptions::default() };
    let text = || {
        let mut bytes = Vec::new();
        surface.write_step(&options, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let first = text();
    assert_eq!(first, text());
    let count = |name: &str| first.matches(&format!("= {name}(")).count();
    assert_eq!(count("ADVANCED_FACE"), surface.patches.len());
    assert_eq!(count("EDGE_CURVE"), surface.curves.len());
    assert_eq!(count("PCURVE"), 2 * surface.curves.len());
    assert_eq!(count("VERTEX_POINT"), surface.points.len());
    assert_eq!([count("MANIFOLD_SOLID_BREP"), count("CLOSED_SHELL")], [1, 1]);
    assert!(first.contains("AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"));
}

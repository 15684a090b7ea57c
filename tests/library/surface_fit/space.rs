//! Triangular B-splines on surfaces: the identities that hold on every flat region, across charts.

use ricci::flow::{Options, Solution, flow};
use ricci::geometry::Space;
use ricci::mesh::shapes::SplitMix64;
use ricci::mesh::{PerVertex, VertexId, shapes};
use ricci::spline::{
    CoarseTriangulation, FitOptions, FlatMetric, Parameter, Spline, SplineSpace, SurfaceDomain, fit,
};
use ricci::{Class, Control, Surface, Target};
use std::sync::Arc;

/// A surface with all of its curvature at vertex 0, and the domain of every few vertices.
fn domain(surface: Surface, step: usize) -> (Solution, SurfaceDomain) {
    let class = Class::yamabe(Space::E2);
    let target = if surface.mesh().euler() == 0 { Target::Uniform } else { Target::Single(VertexId(0)) };
    let flat = flow(surface, class, &target, &Options::default(), &Control::new()).unwrap();
    let keep = PerVertex::from_fn(flat.mesh().n_vertices(), |v: VertexId| v.index().is_multiple_of(step));
    let coarse =
        CoarseTriangulation::new(&FlatMetric::of(&flat, &Control::new()).unwrap(), &keep, &Control::new())
            .unwrap();
    (flat, SurfaceDomain::new(coarse).unwrap())
}

fn places(domain: &SurfaceDomain, each: usize) -> Vec<Parameter> {
    let mut random = SplitMix64::new(3);
    let mesh = &domain.coarse().mesh;
    let mut place = |f| {
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        domain.parameter(ricci::mesh::Place { face: f, weights: [1.0 - s - t, s, t] })
    };
    mesh.faces().flat_map(|f| [f].repeat(each)).map(&mut place).collect()
}

#[test]
fn basis_functions_add_up_to_one() {
    for (surface, step) in
        [(shapes::genus(2, 6).unwrap(), 25), (shapes::torus(2.0, 0.8, 40, 20).unwrap(), 31)]
    {
        let (_, domain) = domain(Surface::from_soup(&surface).unwrap(), step);
        for degree in 1..=4 {
            let space = Arc::new(domain.space(degree, 0.5, &Control::new()).unwrap());
            let ones = Spline::new(space.clone(), vec![[1.0, 2.0, -1.0]; space.n_control_points()]).unwrap();
            let mut worst = 0.0f64;
            for point in ones.evaluate(&places(&domain, 20), 1, 1, &Control::new()).unwrap() {
                worst = worst.max((point.point[0] - 1.0).abs()).max((point.point[1] - 2.0).abs());
                worst = worst.max(point.first[0][0].abs());
            }
            assert!(worst < 1e-11, "degree {degree}: {worst:e}");
        }
    }
}

/// The root mean square distance of the vertices from a cubic fit: 5.8e-4 on a torus of 174 patches, 1.3e-2 on a surface of genus 2 with 310,
/// where the spline without a filled hole has coinciding knots at its singular vertex.
#[test]
fn a_fit_comes_near_the_surface() {
    let cases = [(shapes::torus(2.0, 0.8, 80, 40), 1e-3), (shapes::genus(2, 8), 2e-2)];
    for (soup, most) in cases {
        let surface = Surface::from_soup(&soup.unwrap()).unwrap();
        let points = surface.positions().unwrap().to_vec();
        let (_, domain) = domain(surface, 37);
        let space: Arc<SplineSpace> = Arc::new(domain.space(3, 0.5, &Control::new()).unwrap());
        let places = domain.places(points.len()).unwrap();
        let fitted = fit(&space, &places, &points, &FitOptions::default(), &Control::new()).unwrap();
        assert!(fitted.rms < most, "{} control points: {:e}", space.n_control_points(), fitted.rms);
    }
}

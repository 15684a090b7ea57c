//! Surfaces to flow on, and conditions that every flow must satisfy.
#![allow(dead_code)]

use ricci::flow::{Flips, Options, Report, StopReason};
use ricci::geometry::Space;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::{Mesh, PerEdge, PerVertex, Point};
use ricci::metric::{Metric, Scheme, lengths_from_positions};
use ricci::{Class, Control, Flow, Surface, Target};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Connectivity and edge lengths of a triangle list.
pub fn surface(soup: &Soup) -> (Mesh, PerEdge<f64>) {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    (mesh, lengths)
}

/// The meshes of the corpus with at most so many vertices, by file name; none where the corpus is absent.
pub fn small_meshes(most_vertices: usize) -> Vec<(String, Mesh, PerEdge<f64>, Vec<Point>)> {
    let Some((folder, rows)) = super::index("good") else { return Vec::new() };
    let is_small = |row: &&HashMap<String, String>| row["V"].parse::<usize>().unwrap() <= most_vertices;
    let read = |row: &HashMap<String, String>| {
        let soup = io::read(&folder.join(&row["file"])).unwrap();
        let (mesh, lengths) = surface(&soup);
        (row["file"].clone(), mesh, lengths, soup.positions)
    };
    rows.iter().filter(is_small).map(read).collect()
}

/// The default target of a surface, where that prescribes the curvature of every vertex; `Boundary` where the flow finds the curvature
/// of the boundary.
pub fn prescribing_target(surface: &Surface, space: Space) -> Target {
    match Target::default_for(surface, space).unwrap() {
        Target::Outer(_) => Target::Boundary,
        target => target,
    }
}

/// The uniform target, or four cones of π on a sphere in E².
pub fn default_target(mesh: &Mesh, lengths: &PerEdge<f64>, space: Space, scheme: Scheme) -> PerVertex<f64> {
    if space == Space::E2 && mesh.genus() == 0 {
        let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
        let step = mesh.n_vertices() / 4;
        (0..4).for_each(|k| target[(k * step).into()] = PI);
        return target;
    }
    Target::Uniform.resolve(&euclidean(mesh, lengths), Class::new(scheme, space)).unwrap()
}

/// A surface with Euclidean lengths.
pub fn euclidean(mesh: &Mesh, lengths: &PerEdge<f64>) -> Surface {
    Surface::intrinsic(mesh.clone(), lengths.clone(), Space::E2).unwrap()
}

/// Flow to these curvatures, and the report of it.
pub fn attempt(flow: &mut Flow, target: &PerVertex<f64>) -> Report {
    let solution = flow.solve(&Target::All(target.clone()), &Control::new()).unwrap();
    solution.report().unwrap().clone()
}

/// The default options without flips.
pub fn rigid() -> Options {
    Options { flips: Flips::Never, ..Options::default() }
}

/// The flow without flips; whatever its outcome, Gauss–Bonnet holds.
pub fn solve(mesh: &Mesh, start: &Metric, target: &PerVertex<f64>, options: &Options) -> (Metric, Report) {
    let mut flow = Flow::from_metric(mesh.clone(), start.clone(), options).unwrap();
    let report = attempt(&mut flow, target);
    assert!(report.gauss_bonnet <= 1e-10, "Gauss–Bonnet residual {}", report.gauss_bonnet);
    (flow.metric().clone(), report)
}

/// Asserts that a flow has converged to 1e-10 and says so.
pub fn converged(report: &Report) {
    assert_eq!(report.stop_reason, StopReason::Converged, "{report:?}");
    assert!(report.converged() && report.max_curvature_error <= 1e-10);
}

/// Maximum norm of a − b.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

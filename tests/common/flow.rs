//! Surfaces to flow on, and what every flow must satisfy.
#![allow(dead_code)]

use ricci::Control;
use ricci::flow::{Flips, Options, Report, StopReason, flow};
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, PerEdge, PerVertex};
use ricci::metric::{Metric, lengths_from_positions};

/// Connectivity and edge lengths of a triangle list.
pub fn surface(soup: &Soup) -> (Mesh, PerEdge<f64>) {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    (mesh, lengths)
}

/// Defaults, on the triangulation as it is.
pub fn rigid() -> Options {
    Options { flips: Flips::Never, ..Options::default() }
}

/// The flow without flips; whatever its outcome, Gauss–Bonnet holds.
pub fn solve(mesh: &Mesh, start: &Metric, target: &PerVertex<f64>, options: &Options) -> (Metric, Report) {
    let (_, metric, report) = flow(mesh, start, target, options, &Control::new()).unwrap();
    assert!(report.gauss_bonnet <= 1e-10, "Gauss–Bonnet residual {}", report.gauss_bonnet);
    (metric, report)
}

/// Converged to 1e-10, and says so.
pub fn converged(report: &Report) {
    assert_eq!(report.stop_reason, StopReason::Converged, "{report:?}");
    assert!(report.converged && report.max_curvature_error <= 1e-10);
}

/// Maximum norm of a − b.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

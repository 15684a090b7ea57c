//! A metric that a command has found, with its measures and checks.

use crate::failure::Failure;
use crate::metric_file::MetricFile;
use crate::output::Outputs;
use crate::report::Checks;
use ricci::flow::Solution;
use ricci::geometry::worse;
use ricci::mesh::{PerEdge, PerVertex};
use ricci::metric::{Curvature, Measured, Scheme};
use ricci::parallel::within;
use std::path::Path;

/// Largest residual of Gauss–Bonnet. Each of the 3F angles is off by a few ulp, which add up like a random walk: 1e-12 for a million
/// faces.
pub const GAUSS_BONNET: f64 = 1e-10;

/// A metric that a command has found, with its lengths and curvatures on the triangulation of its solution.
pub struct SolvedMetric {
    pub solution: Solution,
    pub scheme: Scheme,
    pub lengths: PerEdge<f64>,
    pub curvature: Curvature,
    /// The curvature asked for, per vertex.
    pub target: PerVertex<f64>,
    /// True if edges were allowed to be flipped.
    pub may_flip: bool,
}

/// The lengths and the curvatures of a metric, on the triangulation of its solution.
pub struct MetricMeasures {
    lengths: PerEdge<f64>,
    pub curvature: Curvature,
}

impl MetricMeasures {
    /// The measures of a metric, after `first` has been done with its edges.
    ///
    /// # Errors
    /// [`Failure::Failed`]: an error once the flow has ended is no fault of the input.
    pub fn after<T: Send>(
        solution: &Solution,
        first: impl FnOnce(&Measured) -> T + Send,
    ) -> Result<(T, MetricMeasures), Failure> {
        let measure = || {
            let measured = solution.metric().measured(solution.mesh())?;
            let done = first(&measured);
            Ok((done, MetricMeasures { lengths: measured.lengths()?, curvature: measured.curvature()? }))
        };
        within(solution.threads(), measure).map_err(failed)
    }
}

fn failed(error: ricci::Error) -> Failure {
    Failure::Failed(error.to_string())
}

impl SolvedMetric {
    /// The metric of a solution with its measures; without a target the curvature asked for is 0.
    ///
    /// # Errors
    /// [`Failure::Failed`]: an error once the flow has ended is no fault of the input.
    pub fn new(solution: Solution, target: Option<PerVertex<f64>>) -> Result<SolvedMetric, Failure> {
        let zeros = || PerVertex::filled(solution.mesh().n_vertices(), 0.0);
        let ((), measures) = MetricMeasures::after(&solution, |_| ())?;
        let target = target.unwrap_or_else(zeros);
        SolvedMetric::measured(solution, measures, target)
    }

    /// [`SolvedMetric::new`] of a metric that has been measured.
    ///
    /// # Errors
    /// As there.
    pub fn measured(
        solution: Solution,
        MetricMeasures { lengths, curvature }: MetricMeasures,
        target: PerVertex<f64>,
    ) -> Result<SolvedMetric, Failure> {
        let scheme = solution.scheme().map_err(failed)?;
        Ok(SolvedMetric { solution, scheme, lengths, curvature, target, may_flip: true })
    }

    /// |K − K̄| per vertex.
    fn errors(&self) -> impl Iterator<Item = f64> {
        self.curvature.at.iter().zip(self.target.iter()).map(|(k, t)| (k - t).abs())
    }

    /// max |K − K̄| of the metric as it is written.
    pub fn curvature_error(&self) -> f64 {
        self.errors().fold(0.0, worse)
    }

    /// The sum of |K − K̄| over the vertices, which bounds how far the two sides of a seam are apart.
    pub fn total_error(&self) -> f64 {
        self.errors().sum()
    }

    /// The checks of every metric.
    pub fn checks(&self, tolerance: f64) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", self.curvature_error(), tolerance);
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        checks
    }

    /// The line of the summary that says how far the start of a circle packing lies from the surface; empty for other schemes.
    pub fn scheme_line(&self) -> String {
        if !self.scheme.is_packing() {
            return String::new();
        }
        let d = &self.solution.initial().distance;
        let at =
            |what: &str, index: Option<u32>| index.map_or_else(String::new, |i| format!(" ({what} {i})"));
        let mut text = format!(
            "start    |log| of lengths over the surface's: mean {:.3} max {:.3}{}; dilatation mean {:.4} max {:.3e}{}\n",
            d.mean_log_length,
            d.max_log_length,
            at("edge", d.edge.map(|e| e.0)),
            d.mean_dilatation,
            d.max_dilatation,
            at("face", d.face.map(|f| f.0))
        );
        if d.is_far() {
            text += &format!(
                "WARNING  the result is conformal to that start, not to the surface, at any refinement: {} does not represent these \
                 lengths; --scheme yamabe, inversive or virtual does\n",
                self.scheme
            );
        }
        text
    }

    /// Write the metric.
    pub fn write_metric(&self, outputs: &mut Outputs, path: &Path) -> Result<(), Failure> {
        let file = MetricFile::new(&self.solution, &self.target)?;
        outputs.add(path, |out| file.write(out))
    }
}

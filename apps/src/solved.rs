//! A metric that a command has found, and what came of the other wishes of the run.

use crate::failure::Failure;
use crate::metric_file::MetricFile;
use crate::output::Outputs;
use crate::report::{Attempts, Checks, Seconds};
use ricci::flow::Solution;
use ricci::geometry::worse;
use ricci::mesh::{PerEdge, PerVertex};
use ricci::metric::{Curvature, Measured, Scheme};
use ricci::parallel::within;
use std::path::Path;

/// Gauss–Bonnet must hold to this. Each of the 3F angles is off by a few ulp, which add up like a random walk: 1e-12 for a
/// million faces.
const GAUSS_BONNET: f64 = 1e-10;

/// A metric, and what came of the other wishes of the run.
pub struct Solved {
    pub solution: Solution,
    pub scheme: Scheme,
    /// On the triangulation of the solution.
    pub lengths: PerEdge<f64>,
    /// On the triangulation of the solution.
    pub curvature: Curvature,
    /// The curvature asked for, per vertex of that triangulation.
    pub target: PerVertex<f64>,
    pub failed: Attempts,
    /// Whether edges were allowed to be flipped.
    pub may_flip: bool,
    /// Vertices and faces of the layout's file beyond those of the input.
    pub added: [usize; 2],
    /// What the input's file holds and the layout's file does not.
    pub left_out: Vec<&'static str>,
    pub seconds: Seconds,
}

/// What a metric measures, on the triangulation of its solution.
pub struct Measures {
    lengths: PerEdge<f64>,
    pub curvature: Curvature,
}

impl Measures {
    /// # Errors
    /// [`Failure::Failed`]: what goes wrong once the flow has ended is no fault of the input.
    pub fn of(solution: &Solution) -> Result<Measures, Failure> {
        Measures::after(solution, |_| ()).map(|((), measures)| measures)
    }

    /// [`Measures::of`], after something else that is to be done with what the metric says of its edges.
    ///
    /// # Errors
    /// As there.
    pub fn after<T: Send>(
        solution: &Solution,
        first: impl FnOnce(&Measured) -> T + Send,
    ) -> Result<(T, Measures), Failure> {
        let measure = || {
            let measured = solution.metric().measured(solution.mesh())?;
            let done = first(&measured);
            Ok((done, Measures { lengths: measured.lengths()?, curvature: measured.curvature()? }))
        };
        within(solution.threads(), measure).map_err(failed)
    }
}

fn failed(error: ricci::Error) -> Failure {
    Failure::Failed(error.to_string())
}

impl Solved {
    /// Without a target the curvature asked for is 0.
    ///
    /// # Errors
    /// [`Failure::Failed`]: what goes wrong once the flow has ended is no fault of the input.
    pub fn new(
        solution: Solution,
        target: Option<PerVertex<f64>>,
        seconds: Seconds,
    ) -> Result<Solved, Failure> {
        let zeros = || PerVertex::filled(solution.mesh().n_vertices(), 0.0);
        let measures = Measures::of(&solution)?;
        let target = target.unwrap_or_else(zeros);
        Solved::measured(solution, measures, target, seconds)
    }

    /// [`Solved::new`] of what has been measured.
    ///
    /// # Errors
    /// As there.
    pub fn measured(
        solution: Solution,
        Measures { lengths, curvature }: Measures,
        target: PerVertex<f64>,
        seconds: Seconds,
    ) -> Result<Solved, Failure> {
        Ok(Solved {
            lengths,
            scheme: solution.scheme().map_err(failed)?,
            curvature,
            target,
            solution,
            failed: Attempts::default(),
            may_flip: true,
            added: [0; 2],
            left_out: Vec::new(),
            seconds,
        })
    }

    /// |K − K̄| per vertex.
    fn errors(&self) -> impl Iterator<Item = f64> {
        self.curvature.at.iter().zip(self.target.iter()).map(|(k, t)| (k - t).abs())
    }

    /// max |K − K̄| of the metric as it is written.
    pub fn curvature_error(&self) -> f64 {
        self.errors().fold(0.0, worse)
    }

    /// The sum of |K − K̄| over the vertices: how far the two sides of a seam may be apart.
    pub fn total_error(&self) -> f64 {
        self.errors().sum()
    }

    /// What every metric is held against.
    pub fn checks(&self, tolerance: f64) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", self.curvature_error(), tolerance);
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        checks
    }

    /// Write the metric, if it is asked for.
    pub fn write_metric(&mut self, outputs: &mut Outputs, path: Option<&Path>) -> Result<(), Failure> {
        let Some(path) = path else { return Ok(()) };
        let file = MetricFile::new(&self.solution, &self.target).map_err(Failure::from);
        let written = file.and_then(|file| outputs.add(path, |out| file.write(out)));
        self.failed.attempt("metric", written).map(drop)
    }
}

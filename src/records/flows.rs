//! The records of metrics and of harmonic forms.

use crate::archive::{Kept, stored};
use crate::error::{Result, check_size};
use crate::flow::{Report, Solution};
use crate::harmonic::{HarmonicForms, PeriodMatrix};

/// A metric, with its surface, its triangulation, and the way back.
#[derive(Debug, Clone)]
pub struct MetricRecord {
    /// The metric.
    pub solution: Solution,
    /// The report of the work that led to the metric, where the metric has none of its own.
    pub report: Option<Report>,
}
stored!(sections MetricRecord { solution, report });

impl Kept for MetricRecord {
    const KIND: &'static str = "metric";
}

impl From<Solution> for MetricRecord {
    fn from(solution: Solution) -> MetricRecord {
        MetricRecord { solution, report: None }
    }
}

/// Harmonic forms, with those of the dual classes and the period matrix, where they were asked for.
#[derive(Debug, Clone)]
pub struct FormsRecord {
    /// The forms.
    pub forms: HarmonicForms,
    /// The harmonic forms of the dual classes; none on a closed surface, whose classes are their own duals.
    pub dual: Option<HarmonicForms>,
    /// The period matrix of a closed surface.
    pub periods: Option<PeriodMatrix>,
}
stored!(sections FormsRecord { forms, dual, periods } check FormsRecord::check_parts);

impl Kept for FormsRecord {
    const KIND: &'static str = "forms";
}

impl FormsRecord {
    /// Checks that every form has a number per edge.
    fn check_parts(&self) -> Result<()> {
        for HarmonicForms { domain, forms, .. } in std::iter::once(&self.forms).chain(&self.dual) {
            let n_edges = domain.mesh().n_edges();
            forms.iter().try_for_each(|form| check_size("numbers of a form", form.0.len(), n_edges))?;
        }
        Ok(())
    }
}

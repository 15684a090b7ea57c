//! Options of flows.
//!
//! ```
//! # use ricci::flow::{Flips, Options};
//! let options = Options { flips: Flips::Never, tolerance: 1e-12, ..Options::default() };
//! options.check()?;
//! assert_eq!(options.iteration_limit(), 500);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use crate::mesh::{EdgeId, VertexId};

/// The method by which the target is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Newton with a line search (E², H²); in S², where the energy is not convex, damped Newton.
    #[default]
    Newton,
    /// The flow itself, explicit in time.
    Gradient,
}

/// True if edges may be flipped inside the conformal class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Flips {
    /// As often as needed (Newton in E² and H²): the triangulation is weighted Delaunay throughout. The solver's mesh changes with it.
    #[default]
    Auto,
    /// The triangulation stays as it is.
    Never,
}

/// Step size of the gradient flow. With all rules but [`StepRule::BarzilaiBorwein`] the energy falls at every step, as it does along the
/// continuous flow: a step after which it has not fallen enough (Armijo's rule \[Arm66\]), or which leaves the domain, is shortened.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum StepRule {
    /// The step that Barzilai and Borwein propose, shortened until the energy falls.
    #[default]
    Armijo,
    /// Barzilai–Borwein's two steps in turn \[BB88\] as they are (halved where they leave the domain or raise the error tenfold): the energy
    /// may rise on the way.
    BarzilaiBorwein,
    /// The largest step for which the explicit scheme is stable by Gershgorin's bound on ∂K/∂u.
    Stable,
    /// Always the same step.
    Fixed(f64),
}

/// Options of the gradient flow.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gradient {
    /// Step size rule.
    pub step: StepRule,
    /// Keep the total area of the start (E²; in S² the area is always kept, in H² curvature fixes it).
    pub area_normalised: bool,
}

/// Options of a flow.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Default Newton.
    pub method: Method,
    /// Largest |K − K̄| of a converged metric, radians. Default 1e-10.
    pub tolerance: f64,
    /// Iterations before giving up; 0 (default) means 500 for Newton, 200 000 for the gradient flow.
    pub max_iterations: usize,
    /// Largest change of any u in one Newton step. Default 3: lengths change by at most e³ at a time.
    pub max_step: f64,
    /// Default `Auto`.
    pub flips: Flips,
    /// Edges that are not flipped: seams, feature lines. Default none. Targets that only their flips would reach are then out of reach.
    pub fixed_edges: Vec<EdgeId>,
    /// Vertices of the given surface that hold their u; their curvature is then free. Default none. They keep a surface with boundary
    /// from being doubled.
    pub pinned: Vec<VertexId>,
    /// Number of threads of this flow's own pool; 0 (default) is one per core. With 0 or several, a caller inside a pool lends its threads.
    /// The result does not depend on the number.
    pub threads: usize,
    /// Options of [`Method::Gradient`].
    pub gradient: Gradient,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            method: Method::Newton,
            tolerance: 1e-10,
            max_iterations: 0,
            max_step: 3.0,
            flips: Flips::Auto,
            fixed_edges: Vec::new(),
            pinned: Vec::new(),
            threads: 0,
            gradient: Gradient::default(),
        }
    }
}

impl Options {
    /// Checks that the tolerance and all step sizes are positive finite numbers.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub fn check(&self) -> Result<()> {
        let positive = |what, value: f64| {
            if value > 0.0 && value.is_finite() {
                return Ok(());
            }
            Err(Error::Argument { what, value: value.to_string(), need: "a positive finite number" })
        };
        positive("tolerance", self.tolerance)?;
        positive("max_step", self.max_step)?;
        match self.gradient.step {
            StepRule::Fixed(step) => positive("gradient.step", step),
            _ => Ok(()),
        }
    }

    /// The largest number of iterations, with the default for `max_iterations` 0.
    pub fn iteration_limit(&self) -> usize {
        match (self.max_iterations, self.method) {
            (0, Method::Newton) => 500,
            (0, Method::Gradient) => 200_000,
            (n, _) => n,
        }
    }
}

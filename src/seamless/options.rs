//! Options of seamless metrics.

use super::aligned_field::FieldGuide;
use super::signature::ConeValence;
use crate::mesh::{EdgeId, PerVertex};

/// The way in which the cones of a seamless metric are chosen.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SeamlessCones {
    /// Those of the smoothest field of four directions: along features and the boundary, and near the guides, if there are any
    /// ([`super::CrossField`]); else that of [`super::field_cones`].
    #[default]
    Field,
    /// This many, placed so that areas change little ([`crate::flow::auto_cones`]), with their curvature rounded to quarter turns. The total
    /// is kept by those that rounding changes most. Closed surfaces without features only.
    Auto(usize),
    /// These; any other vertex inside has valence 4 and any other on the boundary has 2. The sum of 4 − valence, and of 2 − valence on the
    /// boundary, is 4χ. Without features only.
    Valences(Vec<ConeValence>),
}

/// Options of [`super::seamless`].
#[derive(Debug, Clone, PartialEq)]
pub struct SeamlessOptions {
    /// The cones.
    pub cones: SeamlessCones,
    /// The turning of each path in quarter turns, of the paths that [`super::DualLoops::along_features`] finds from vertex 0 on the triangulation of
    /// the conformal metric with these cones. Default: the nearest to that metric's, in the energy of the field that turns by the difference.
    pub quarter_turns: Option<Vec<i32>>,
    /// Edges that become straight and parallel to an axis, with angles of multiples of 90° where they meet. Edges of the boundary do so
    /// anyway. Features around a piece with too few vertices to have right angles in all its corners are left out, until all pieces have
    /// enough, and with the cones of the field those without which a metric is reached ([`super::Seamless::left_out`]). Default none.
    pub features: Vec<EdgeId>,
    /// Directions that the field of [`SeamlessCones::Field`] is to be near. Default none.
    pub guides: Vec<FieldGuide>,
    /// Steps towards the lengths of the surface among all metrics with the same angles and turning. Default 0: the result is near the
    /// conformal metric with these cones.
    pub isometric_steps: usize,
    /// Per vertex (V entries) the factor by which lengths near it are to be larger than those of the surface, for the isometric steps;
    /// positive. Default: 1.
    pub sizes: Option<PerVertex<f64>>,
    /// Largest deviation of an angle, around a vertex or along a loop, from the target, radians. Default 1e-10.
    pub tolerance: f64,
    /// Most Newton steps after the conformal flow. Default 100.
    pub max_iterations: usize,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for SeamlessOptions {
    fn default() -> Self {
        let cones = SeamlessCones::Field;
        SeamlessOptions {
            cones,
            quarter_turns: None,
            features: Vec::new(),
            guides: Vec::new(),
            isometric_steps: 0,
            sizes: None,
            tolerance: 1e-10,
            max_iterations: 100,
            threads: 0,
        }
    }
}

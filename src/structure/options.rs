//! What an atlas can be asked.

use super::kind::Structure;
use crate::flow;
use crate::mesh::VertexId;

/// What the charts of an atlas are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Charts {
    /// The star of every vertex that is not singular.
    #[default]
    Stars,
    /// Faces added one by one, nearest first, until they would overlap or a radius is reached, and the faces around them. The stars of
    /// vertices that none of these has inside are charts too.
    Patches,
}

/// Where an affine structure comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AffineSource {
    /// The flow to a metric that is flat but for one vertex of a closed surface, or but for the boundary.
    #[default]
    Flow,
    /// A holomorphic 1-form of a closed surface of genus 1 or more: the integrals of a harmonic form that distorts areas little, and of
    /// its conjugate. Transitions are translations.
    Form,
}

/// What [`super::atlas`] can be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct AtlasOptions {
    /// The structure. Default [`Structure::Conformal`].
    pub structure: Structure,
    /// Its charts. Default [`Charts::Stars`].
    pub charts: Charts,
    /// How far the core of a patch reaches at most, on the unit sphere or in the hyperbolic plane; only its first face may reach farther.
    /// Default: three times the median of the longest sides of the triangles, but from 0.5 to 0.8 on the sphere, to 3 in the hyperbolic
    /// plane, so that coordinates keep their digits.
    pub radius: Option<f64>,
    /// Where an affine structure comes from. Default [`AffineSource::Flow`].
    pub source: AffineSource,
    /// The singular vertex of the flow's affine structure on a closed surface of genus 0 (where it is sent to infinity) or at least 2.
    /// Default: on a sphere the one of [`crate::canonical::SphereOptions::puncture`], else [`super::least_distorting_vertex`].
    pub singular: Option<VertexId>,
    /// Of the flow.
    pub flow: flow::Options,
}

impl Default for AtlasOptions {
    fn default() -> Self {
        AtlasOptions {
            structure: Structure::Conformal,
            charts: Charts::default(),
            radius: None,
            source: AffineSource::default(),
            singular: None,
            flow: flow::Options::default(),
        }
    }
}

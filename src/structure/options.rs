//! Options of an atlas.

use super::kind::Structure;
use crate::flow;
use crate::mesh::VertexId;

/// The kind of charts of an atlas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChartKind {
    /// The stars of all regular vertices.
    #[default]
    Stars,
    /// Charts that grow face by face, nearest first, until they would overlap or a radius is reached, with the faces around them. The stars
    /// of vertices that are inside none of these are charts too.
    Patches,
}

/// The source of an affine structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AffineSource {
    /// The flow to a metric that is flat except at one vertex of a closed surface, or except on the boundary.
    #[default]
    Flow,
    /// A holomorphic 1-form of a closed surface of genus 1 or more: a harmonic form that distorts areas little, and its conjugate, are
    /// integrated. Transitions are translations.
    Form,
}

/// Options of [`super::atlas`].
#[derive(Debug, Clone, PartialEq)]
pub struct AtlasOptions {
    /// The structure. Default [`Structure::Conformal`].
    pub structure: Structure,
    /// The kind of charts. Default [`ChartKind::Stars`].
    pub charts: ChartKind,
    /// Largest radius of the core of a grown chart, on the unit sphere or in the hyperbolic plane; only its first face may reach farther.
    /// Default: three times the median of the longest sides of the triangles, clamped to 0.5 to 0.8 on the sphere and 0.5 to 3 in the
    /// hyperbolic plane, so that coordinates keep their digits.
    pub radius: Option<f64>,
    /// The source of an affine structure. Default [`AffineSource::Flow`].
    pub source: AffineSource,
    /// The singular vertex of the flow's affine structure, on a closed surface of genus 0 (where it goes to infinity) or at least 2.
    /// Default: on a sphere that of [`crate::canonical::SphereOptions::puncture`], else [`super::least_distorting_vertex`].
    pub singular: Option<VertexId>,
    /// The number of quads of an integer structure, about. Default: the quads of the layout with as few patches as are found
    /// ([`crate::quads::quad_layout`]).
    pub quads: Option<usize>,
    /// Options of the flow.
    pub flow: flow::Options,
}

impl Default for AtlasOptions {
    fn default() -> Self {
        AtlasOptions {
            structure: Structure::Conformal,
            charts: ChartKind::default(),
            radius: None,
            source: AffineSource::default(),
            singular: None,
            quads: None,
            flow: flow::Options::default(),
        }
    }
}

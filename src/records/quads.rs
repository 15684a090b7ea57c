//! The records of seamless metrics, quad meshes, layouts of four-sided patches, and splines over them.

use crate::archive::{Kept, in_range, stored};
use crate::error::{Result, check_size};
use crate::mesh::Point;
use crate::quads::{QuadLayout, QuadMesh};
use crate::seamless::Seamless;

impl Kept for Seamless {
    const KIND: &'static str = "seamless metric";
}

/// A quad mesh.
#[derive(Debug, Clone)]
pub struct QuadsRecord {
    /// The quads, and their places on the surface.
    pub mesh: QuadMesh,
    /// The positions of the vertices; none of an intrinsic surface.
    pub positions: Option<Vec<Point>>,
}
stored!(sections QuadsRecord { mesh, positions } check QuadsRecord::check_parts);

impl Kept for QuadsRecord {
    const KIND: &'static str = "quad mesh";
}

impl QuadsRecord {
    /// Checks that quads name no vertex that is not there.
    fn check_parts(&self) -> Result<()> {
        let n = self.mesh.places.len();
        in_range("vertex", self.mesh.quads.as_flattened().iter().map(|&v| v as usize), n)?;
        in_range("vertex", self.mesh.creases.as_flattened().iter().map(|&v| v as usize), n)?;
        check_size("rectangles of quads", self.mesh.rectangle.len(), self.mesh.quads.len())?;
        self.positions.as_ref().map_or(Ok(()), |all| check_size("positions", all.len(), n))
    }
}

/// A layout of four-sided patches.
#[derive(Debug, Clone)]
pub struct QuadLayoutRecord {
    /// The layout.
    pub layout: QuadLayout,
    /// The positions of the vertices of its quads; none of an intrinsic surface.
    pub positions: Option<Vec<Point>>,
    /// The fingerprint of the seamless metric that it divides ([`Seamless::fingerprint`]).
    pub metric: u64,
}
stored!(sections QuadLayoutRecord { layout, positions, metric } check QuadLayoutRecord::check_parts);

impl Kept for QuadLayoutRecord {
    const KIND: &'static str = "quad layout";
}

impl QuadLayoutRecord {
    /// Checks that nodes, arcs and patches name no element that is not there.
    fn check_parts(&self) -> Result<()> {
        let QuadLayout { mesh, nodes, arcs, patches, .. } = &self.layout;
        QuadsRecord { mesh: mesh.clone(), positions: self.positions.clone() }.check_parts()?;
        let n = mesh.places.len();
        in_range("vertex", nodes.iter().map(|node| node.vertex as usize), n)?;
        in_range("vertex", arcs.iter().flat_map(|arc| &arc.vertices).map(|&v| v as usize), n)?;
        in_range("node", arcs.iter().flat_map(|arc| arc.ends).map(|k| k as usize), nodes.len())?;
        let sides = patches.iter().flat_map(|patch| patch.sides.iter().flatten());
        in_range("arc", sides.map(|k| (k.unsigned_abs() as usize).wrapping_sub(1)), arcs.len())?;
        in_range("quad", patches.iter().flat_map(|patch| &patch.quads).map(|&q| q as usize), mesh.quads.len())
    }
}

#[cfg(feature = "splines")]
pub use splines::QuadSplineRecord;

#[cfg(feature = "splines")]
mod splines {
    use crate::archive::{Kept, stored};
    use crate::spline::QuadFit;

    /// A spline over a layout of four-sided patches, with the figures of its fit.
    #[derive(Clone)]
    pub struct QuadSplineRecord {
        /// The spline and its distances.
        pub fit: QuadFit,
        /// The diagonal of the bounding box of the surface.
        pub diagonal: f64,
        /// The largest distance, over the diagonal, that was asked for.
        pub tolerance: f64,
        /// True if the spline is within the tolerance and does not fold.
        pub converged: bool,
    }
    stored!(sections QuadSplineRecord { fit, diagonal, tolerance, converged });

    impl Kept for QuadSplineRecord {
        const KIND: &'static str = "quad spline";
    }
}

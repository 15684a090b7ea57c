//! Archives of the handles of parts that a build can leave out: seamless metrics, quad meshes, layouts of patches, splines.

use crate::archive_records::ArchivedHandle;
use crate::failure::Outcome;
#[cfg(feature = "quads")]
use crate::metric::ricci_metric;
#[cfg(feature = "quads")]
use crate::quad_layout::ricci_quad_layout;
#[cfg(all(feature = "quads", feature = "splines"))]
use crate::quad_spline::ricci_quad_spline;
#[cfg(feature = "quads")]
use crate::quads::{QuadsState, ricci_quads};
#[cfg(feature = "quads")]
use crate::seamless::ricci_seamless;
#[cfg(feature = "splines")]
use crate::spline::ricci_spline;
#[cfg(all(feature = "quads", feature = "splines"))]
use ricci::records::QuadSplineRecord;
#[cfg(feature = "splines")]
use ricci::records::SplineRecord;
#[cfg(feature = "quads")]
use ricci::{
    records::{QuadLayoutRecord, QuadsRecord},
    seamless::Seamless,
};
#[cfg(feature = "quads")]
use std::sync::Arc;

#[cfg(feature = "quads")]
impl ArchivedHandle for ricci_seamless {
    type Record = Seamless;

    fn record(&self, _: bool) -> Seamless {
        self.found.clone()
    }

    fn restored(found: Seamless) -> Outcome<ricci_seamless> {
        let state = ricci_metric::at(found.solution.clone(), None)?.0;
        Ok(ricci_seamless { state, found })
    }
}

#[cfg(feature = "quads")]
impl ArchivedHandle for ricci_quads {
    type Record = QuadsRecord;

    fn record(&self, _: bool) -> QuadsRecord {
        QuadsRecord { mesh: self.0.mesh.clone(), positions: self.0.positions.clone() }
    }

    fn restored(QuadsRecord { mesh, positions }: QuadsRecord) -> Outcome<ricci_quads> {
        Ok(ricci_quads(Arc::new(QuadsState::new(mesh, positions))))
    }
}

#[cfg(feature = "quads")]
impl ArchivedHandle for ricci_quad_layout {
    type Record = QuadLayoutRecord;

    fn record(&self, _: bool) -> QuadLayoutRecord {
        let positions = self.quads.positions.clone();
        QuadLayoutRecord { layout: self.layout(), positions, metric: self.metric }
    }

    fn restored(record: QuadLayoutRecord) -> Outcome<ricci_quad_layout> {
        Ok(ricci_quad_layout::of(record.layout, record.positions, record.metric))
    }
}

#[cfg(all(feature = "quads", feature = "splines"))]
impl ArchivedHandle for ricci_quad_spline {
    type Record = QuadSplineRecord;

    fn record(&self, _: bool) -> QuadSplineRecord {
        QuadSplineRecord {
            fit: self.fit.clone(),
            diagonal: self.diagonal,
            tolerance: self.figures.tolerance,
            converged: self.figures.converged != 0,
        }
    }

    fn restored(record: QuadSplineRecord) -> Outcome<ricci_quad_spline> {
        let QuadSplineRecord { fit, diagonal, tolerance, converged } = record;
        Ok(ricci_quad_spline::new(fit, diagonal, tolerance, converged))
    }
}

#[cfg(feature = "splines")]
impl ArchivedHandle for ricci_spline {
    type Record = SplineRecord;

    fn record(&self, _: bool) -> SplineRecord {
        SplineRecord { spline: self.spline.clone(), figures: self.fitted.clone() }
    }

    fn restored(SplineRecord { spline, figures }: SplineRecord) -> Outcome<ricci_spline> {
        Ok(ricci_spline { spline, fitted: figures })
    }
}

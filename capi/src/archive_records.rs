//! What the archive of each type of handle holds, and the handle that is made of it again.

use crate::charts::ricci_charts;
use crate::circle_domain::ricci_circle_domain;
use crate::failure::Outcome;
use crate::forms::ricci_forms;
use crate::guard::OpaqueHandle;
use crate::layout::ricci_layout;
use crate::map::ricci_map;
use crate::matching::ricci_matching;
use crate::mesh::ricci_mesh;
use crate::metric::{MetricState, ricci_metric};
use crate::structure::ricci_structure;
use crate::uniformize::{CanonicalShape, ricci_uniform};
use ricci::Solution;
use ricci::archive::Kept;
use ricci::canonical::{CircleDomain, Uniformization};
use ricci::embed::Layout;
use ricci::geometry::Model;
use ricci::matching::FoundLandmarks;
use ricci::records::{
    ChartsRecord, FormsRecord, LayoutRecord, MapRecord, MatchingRecord, MeshRecord, MetricRecord,
};
use ricci::structure::Atlas;
use std::sync::{Arc, OnceLock};

/// A type of handle with archives.
pub trait ArchivedHandle: OpaqueHandle + Sized {
    /// What its archive holds.
    type Record: Kept;

    /// Its record; `is_mirrored`: the caller says that the source of a matching is a mirror image.
    fn record(&self, is_mirrored: bool) -> Self::Record;

    fn restored(record: Self::Record) -> Outcome<Self>;

    /// True for a matching whose source is a mirror image.
    fn is_mirrored(&self) -> bool {
        false
    }

    /// What it was made from.
    fn origin(&self) -> ArchiveOrigin {
        ArchiveOrigin::default()
    }
}

/// The objects that an object was made from, as far as callers go on with them.
#[derive(Default)]
pub struct ArchiveOrigin {
    /// The mesh, of a map or a matching that of the source.
    pub mesh: Option<MeshRecord>,
    /// The mesh that a map or a matching leads to.
    pub target: Option<MeshRecord>,
    /// The layout of charts.
    pub layout: Option<LayoutRecord>,
}

/// The mesh of a metric.
fn mesh_of(solution: &Solution) -> ArchiveOrigin {
    ArchiveOrigin { mesh: Some(solution.surface().into()), ..ArchiveOrigin::default() }
}

impl ArchivedHandle for ricci_mesh {
    type Record = MeshRecord;

    fn record(&self, _: bool) -> MeshRecord {
        MeshRecord {
            mesh: self.connectivity.clone(),
            positions: self.positions.clone(),
            lengths: self.lengths.clone(),
            attributes: self.attributes.clone(),
            places: self.places.clone(),
        }
    }

    fn restored(record: MeshRecord) -> Outcome<ricci_mesh> {
        Ok(ricci_mesh::of(record))
    }
}

impl ricci_mesh {
    /// The handle of a mesh.
    pub(crate) fn of(record: MeshRecord) -> ricci_mesh {
        let MeshRecord { mesh: connectivity, positions, lengths, attributes, places } = record;
        let (surface, summary) = (OnceLock::new(), OnceLock::new());
        ricci_mesh { connectivity, positions, lengths, attributes, places, surface, summary }
    }
}

/// The record of a metric, without a report that it has itself.
fn metric_record(state: &MetricState) -> MetricRecord {
    let solution = state.solution.clone();
    let report = if solution.report().is_some() { None } else { state.report.clone() };
    MetricRecord { solution, report }
}

impl ArchivedHandle for ricci_metric {
    type Record = MetricRecord;

    fn record(&self, _: bool) -> MetricRecord {
        metric_record(&self.0)
    }

    fn restored(record: MetricRecord) -> Outcome<ricci_metric> {
        ricci_metric::at(record.solution, record.report)
    }

    fn origin(&self) -> ArchiveOrigin {
        mesh_of(&self.0.solution)
    }
}

impl ArchivedHandle for ricci_layout {
    type Record = LayoutRecord;

    fn record(&self, _: bool) -> LayoutRecord {
        let (metric, layout) = (metric_record(&self.state), Layout::clone(&self.layout));
        LayoutRecord { metric, layout, model: self.model }
    }

    fn restored(LayoutRecord { metric, layout, model }: LayoutRecord) -> Outcome<ricci_layout> {
        ricci_layout::new(ricci_metric::restored(metric)?.0, layout, model)
    }

    fn origin(&self) -> ArchiveOrigin {
        mesh_of(&self.state.solution)
    }
}

impl ArchivedHandle for ricci_charts {
    type Record = ChartsRecord;

    fn record(&self, _: bool) -> ChartsRecord {
        ChartsRecord {
            metric: metric_record(&self.state),
            layout: Layout::clone(&self.layout),
            positions: self.positions.clone(),
            charts: self.charts.clone(),
        }
    }

    fn restored(record: ChartsRecord) -> Outcome<ricci_charts> {
        let ChartsRecord { metric, layout, positions, charts } = record;
        let state = ricci_metric::restored(metric)?.0;
        Ok(ricci_charts { state, layout: Arc::new(layout), positions, charts })
    }

    fn origin(&self) -> ArchiveOrigin {
        let (metric, layout) = (metric_record(&self.state), Layout::clone(&self.layout));
        let layout = LayoutRecord { metric, layout, model: Model::default() };
        ArchiveOrigin { layout: Some(layout), ..mesh_of(&self.state.solution) }
    }
}

impl ArchivedHandle for ricci_map {
    type Record = MapRecord;

    fn record(&self, _: bool) -> MapRecord {
        let (first, second) = (self.first.clone(), self.second.clone());
        MapRecord { first, second, subdivision: self.subdivision.clone() }
    }

    fn restored(MapRecord { first, second, subdivision }: MapRecord) -> Outcome<ricci_map> {
        Ok(ricci_map { first, second, subdivision })
    }

    fn origin(&self) -> ArchiveOrigin {
        ArchiveOrigin { mesh: Some((&self.first).into()), target: Some(self.second.clone()), layout: None }
    }
}

impl ArchivedHandle for ricci_uniform {
    type Record = Uniformization;

    fn record(&self, _: bool) -> Uniformization {
        match &self.shape {
            CanonicalShape::Sphere(sphere) => Uniformization::Sphere(Box::new((**sphere).clone())),
            CanonicalShape::FlowedSphere(sphere) => {
                Uniformization::FlowedSphere(Box::new((**sphere).clone()))
            }
            CanonicalShape::Quotient(quotient) => Uniformization::Quotient(Box::new((**quotient).clone())),
        }
    }

    fn restored(shape: Uniformization) -> Outcome<ricci_uniform> {
        ricci_uniform::of(shape)
    }

    fn origin(&self) -> ArchiveOrigin {
        mesh_of(&self.metric.0.solution)
    }
}

impl ArchivedHandle for ricci_circle_domain {
    type Record = CircleDomain;

    fn record(&self, _: bool) -> CircleDomain {
        self.domain.clone()
    }

    fn restored(domain: CircleDomain) -> Outcome<ricci_circle_domain> {
        ricci_circle_domain::of(domain)
    }
}

impl ArchivedHandle for ricci_forms {
    type Record = FormsRecord;

    fn record(&self, _: bool) -> FormsRecord {
        FormsRecord { forms: self.forms.clone(), dual: self.dual.clone(), periods: self.periods.clone() }
    }

    fn restored(FormsRecord { forms, dual, periods }: FormsRecord) -> Outcome<ricci_forms> {
        Ok(ricci_forms { forms, dual, periods })
    }

    fn origin(&self) -> ArchiveOrigin {
        mesh_of(self.forms.domain.metric())
    }
}

impl ArchivedHandle for ricci_matching {
    type Record = MatchingRecord;

    fn record(&self, is_mirrored: bool) -> MatchingRecord {
        MatchingRecord {
            matching: self.matching.clone(),
            source: self.source.clone(),
            target: self.target.clone(),
            quality: self.quality,
            point_error: self.point_error,
            mirrored: self.mirrored || is_mirrored,
        }
    }

    fn restored(record: MatchingRecord) -> Outcome<ricci_matching> {
        let MatchingRecord { matching, source, target, quality, point_error, mirrored } = record;
        Ok(ricci_matching {
            matching,
            source,
            target,
            quality,
            point_error,
            landmarks: Vec::new(),
            found: FoundLandmarks::default(),
            threads: 0,
            mirrored,
        })
    }

    fn origin(&self) -> ArchiveOrigin {
        ArchiveOrigin {
            mesh: Some((&self.source).into()),
            target: Some((&self.target).into()),
            ..ArchiveOrigin::default()
        }
    }

    fn is_mirrored(&self) -> bool {
        self.mirrored
    }
}

impl ArchivedHandle for ricci_structure {
    type Record = Atlas;

    fn record(&self, _: bool) -> Atlas {
        self.atlas.clone()
    }

    fn restored(atlas: Atlas) -> Outcome<ricci_structure> {
        Ok(ricci_structure { atlas })
    }

    fn origin(&self) -> ArchiveOrigin {
        mesh_of(&self.atlas.metric)
    }
}

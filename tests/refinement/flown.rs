//! Flows whose flips are recorded.

use crate::common::flow::{attempt, euclidean};
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::{Double, EdgeId, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use ricci::metric::delaunay::{Queue, failing, restore_delaunay};
use ricci::metric::refinement::{Final, Input, Intrinsic};
use ricci::metric::{Metric, Refinement, Scheme, delaunay_start};
use ricci::{Class, Control, Flow, Target};
use std::f64::consts::PI;

pub const SCHEMES: [Scheme; 2] = [Scheme::Yamabe, Scheme::Inversive];

/// A flow from a surface to its target, flips recorded.
pub struct Flown {
    pub mesh: Mesh,
    pub metric: Metric,
    /// Of the input.
    pub geometry: Space,
    pub input_u: PerVertex<f64>,
    pub normal: NormalCoordinates,
    pub flips: usize,
    /// Where the isometric flips have led, if there were any: triangulation, lengths, the input's edges on it, its own on `mesh`.
    pub start: Option<(Mesh, PerEdge<f64>, NormalCoordinates, NormalCoordinates)>,
}

/// The start's flips, then those inside the class on a straight way to the solution: the triangulation that the solver ends with.
pub fn flow(
    input: &Mesh,
    lengths: &PerEdge<f64>,
    kind: (Space, Scheme),
    target: &PerVertex<f64>,
    double: Option<&Double>,
) -> Option<Flown> {
    let mut flown = Flown::start(input, lengths, kind, double);
    let Flown { mesh, metric, normal, flips, start, .. } = &mut flown;
    let mut record = |mesh: &Mesh, e: EdgeId| {
        *flips += 1;
        normal.record(mesh, e);
        if let Some((.., its_own)) = start {
            its_own.record(mesh, e);
        }
    };
    let mut flow = Flow::from_metric(mesh.clone(), metric.clone(), &Options::default()).unwrap();
    if !attempt(&mut flow, target).is_reached() {
        return None;
    }
    let (from, to) = (metric.u.clone(), &flow.metric().u);
    for step in 1..=20 {
        let s = f64::from(step) / 20.0;
        let u = PerVertex::from_fn(from.len(), |v: VertexId| (1.0 - s) * from[v] + s * to[v]);
        let mut queue = Queue::new(mesh.n_edges(), &[]);
        failing(mesh, metric, &u).into_iter().for_each(|e| queue.push(e));
        restore_delaunay(mesh, metric, &u, &mut queue, &mut record, &Control::new()).unwrap();
        metric.u = u;
    }
    Some(flown)
}

impl Flown {
    /// The start's flips, from Euclidean lengths.
    pub fn start(
        input: &Mesh,
        lengths: &PerEdge<f64>,
        kind: (Space, Scheme),
        double: Option<&Double>,
    ) -> Flown {
        Flown::start_in(Space::E2, (input, lengths), kind, double)
    }

    /// The start's flips, from lengths in any geometry.
    pub fn start_in(
        geometry: Space,
        (input, lengths): (&Mesh, &PerEdge<f64>),
        (space, scheme): (Space, Scheme),
        double: Option<&Double>,
    ) -> Flown {
        let (mut mesh, mut lengths) = (input.clone(), lengths.clone());
        let mut normal = NormalCoordinates::new(&mesh);
        let mut flips = 0;
        let mut record = |mesh: &Mesh, e: EdgeId| {
            flips += 1;
            normal.record(mesh, e);
        };
        let start = delaunay_start(
            &mut mesh,
            &mut lengths,
            geometry,
            scheme,
            space,
            double,
            &[],
            &mut record,
            &Control::new(),
        )
        .unwrap();
        let intrinsic =
            (flips > 0).then(|| (mesh.clone(), lengths, normal.clone(), NormalCoordinates::new(&mesh)));
        Flown {
            mesh,
            metric: start.metric,
            geometry,
            input_u: start.input_u,
            normal,
            flips,
            start: intrinsic,
        }
    }

    pub fn refine(&self, input: &Mesh, double: Option<&Double>) -> Refinement {
        let keep = |f| double.is_none_or(|double| double.is_original(f));
        let given = Input { mesh: input, geometry: self.geometry, u: &self.input_u };
        let result = Final { mesh: &self.mesh, metric: &self.metric, normal: &self.normal };
        let intrinsic = self.start.as_ref().map(|(mesh, lengths, given, normal)| Intrinsic {
            mesh,
            lengths,
            given,
            normal,
        });
        Refinement::new(given, intrinsic, result, &keep, &Control::new()).unwrap()
    }
}

/// Uniform, or four cones of π on a sphere.
pub fn default_target(mesh: &Mesh, lengths: &PerEdge<f64>, space: Space, scheme: Scheme) -> PerVertex<f64> {
    if space == Space::E2 && mesh.genus() == 0 {
        let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
        let step = mesh.n_vertices() / 4;
        (0..4).for_each(|k| target[(k * step).into()] = PI);
        return target;
    }
    Target::Uniform.resolve(&euclidean(mesh, lengths), Class::new(scheme, space)).unwrap()
}

//! Flows whose flips are recorded, for the checks of the common subdivision.

use crate::common::flow::attempt;
use ricci::flow::Options;
use ricci::geometry::{DoubleDouble, Space};
use ricci::mesh::{Double, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use ricci::metric::common_subdivision::{
    FinalTriangulation, InputTriangulation, IntrinsicTriangulation, Triangulations,
};
use ricci::metric::delaunay::{ClassFlips, FlipQueue, failing};
use ricci::metric::{CommonSubdivision, Metric, Scheme, StartOptions, Triangulated, delaunay_start};
use ricci::{Class, Control, Flow};

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
    /// The start after isometric flips, if there were any: triangulation, lengths, the input's edges on it, its own on `mesh`.
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
    let mut record = |mesh: &Mesh, flip: Flip<DoubleDouble>| {
        *flips += 1;
        normal.record(mesh, flip.edge);
        if let Some((.., its_own)) = start {
            its_own.record(mesh, flip.edge);
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
        let mut queue = FlipQueue::new(mesh.n_edges(), &FixedEdges::none());
        metric.u = u;
        failing(mesh, metric).into_iter().for_each(|e| queue.push(e));
        let vertices = metric.vertices();
        ClassFlips { mesh, metric, record: &mut record }
            .restore_delaunay(&vertices, &mut queue, &Control::new())
            .unwrap();
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
        let mut surface = Triangulated { mesh: input.clone(), lengths: lengths.clone(), geometry };
        let mut normal = NormalCoordinates::new(input);
        let mut flips = 0;
        let mut record = |mesh: &Mesh, flip: Flip| {
            flips += 1;
            normal.record(mesh, flip.edge);
        };
        let options = StartOptions { double, ..Class::new(scheme, space).into() };
        let start = delaunay_start(&mut surface, options, &mut record, &Control::new()).unwrap();
        let Triangulated { mesh, lengths, .. } = surface;
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

    pub fn refine(&self, input: &Mesh, double: Option<&Double>) -> CommonSubdivision {
        let keep = |f| double.is_none_or(|double| double.is_original(f));
        let given = InputTriangulation { mesh: input, geometry: self.geometry, u: &self.input_u };
        let result = FinalTriangulation { mesh: &self.mesh, metric: &self.metric, normal: &self.normal };
        let intrinsic = self.start.as_ref().map(|(mesh, lengths, given, normal)| IntrinsicTriangulation {
            mesh,
            lengths,
            given,
            normal,
        });
        CommonSubdivision::new(Triangulations { input: given, intrinsic, result }, &keep, &Control::new())
            .unwrap()
    }
}

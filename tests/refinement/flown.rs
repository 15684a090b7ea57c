//! Flows whose flips are recorded.

use ricci::Control;
use ricci::flow::{Flips, Options, Solver};
use ricci::geometry::Space;
use ricci::mesh::{Double, EdgeId, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use ricci::metric::delaunay::{Queue, failing, restore_delaunay};
use ricci::metric::refinement::{Final, Input};
use ricci::metric::{Metric, Refinement, Scheme, Target, delaunay_start};
use std::f64::consts::PI;

pub const SCHEMES: [Scheme; 2] = [Scheme::Yamabe, Scheme::Inversive];

/// A flow from a surface to its target, flips recorded.
pub struct Flown {
    pub mesh: Mesh,
    pub metric: Metric,
    pub input_u: PerVertex<f64>,
    pub normal: NormalCoordinates,
    pub flips: usize,
}

/// The start's flips, then those inside the class on a straight way to the solution: the triangulation that the solver ends with.
pub fn flow(
    input: &Mesh,
    lengths: &PerEdge<f64>,
    (space, scheme): (Space, Scheme),
    target: &PerVertex<f64>,
    double: Option<&Double>,
) -> Option<Flown> {
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
        Space::E2,
        scheme,
        space,
        double,
        &[],
        &mut record,
        &Control::new(),
    )
    .unwrap();
    let mut metric = start.metric;
    let options = Options { flips: Flips::Auto, ..Options::default() };
    let mut solver = Solver::new(mesh.clone(), metric.clone(), options).unwrap();
    let report = solver.solve(target, &Control::new()).unwrap();
    if !report.converged {
        return None;
    }
    let (from, to) = (metric.u.clone(), &solver.metric().u);
    for step in 1..=20 {
        let s = f64::from(step) / 20.0;
        let u = PerVertex::from_fn(from.len(), |v: VertexId| (1.0 - s) * from[v] + s * to[v]);
        let mut queue = Queue::new(mesh.n_edges(), &[]);
        failing(&mesh, &metric, &u).into_iter().for_each(|e| queue.push(e));
        restore_delaunay(&mut mesh, &mut metric, &u, &mut queue, &mut record, &Control::new()).unwrap();
        metric.u = u;
    }
    Some(Flown { mesh, metric, input_u: start.input_u, normal, flips })
}

impl Flown {
    pub fn refine(&self, input: &Mesh, double: Option<&Double>) -> Refinement {
        let keep = |f| double.is_none_or(|double| double.is_original(f));
        let given = Input { mesh: input, geometry: Space::E2, u: &self.input_u };
        let result = Final { mesh: &self.mesh, metric: &self.metric, normal: &self.normal };
        Refinement::new(given, result, &keep, &Control::new()).unwrap()
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
    Target::Uniform.resolve(mesh, lengths, space, scheme).unwrap()
}

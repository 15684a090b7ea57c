//! The cost of edge flips on surfaces that need none and on surfaces that need many, and of the subdivision that leads back.

use crate::common::{heap, median, seconds};
use ricci::flow::{Flips, Options, Report};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerVertex, shapes};
use ricci::metric::Scheme;
use ricci::{Class, Control, Flow, Surface, Target};
use std::f64::consts::PI;

/// Rounds of measurements, of which the medians are printed: below 100,000 vertices they are short.
fn rounds(vertices: usize) -> usize {
    if vertices < 100_000 { 5 } else { 3 }
}
/// Number of cones of the surface that needs flips.
const CONES: usize = 8;

/// Seconds of one flow from the input to the metric, and to the subdivision.
#[derive(Clone)]
pub struct Run {
    /// [`Flow::new`]: the double, Delaunay, circles.
    pub start: f64,
    /// [`Flow::solve`].
    pub report: Report,
    pub start_flips: usize,
}

impl Run {
    pub fn whole(&self) -> f64 {
        self.start + self.report.seconds.total
    }
}

/// The measurements of one size and scheme.
pub struct Row {
    pub vertices: usize,
    pub scheme: Scheme,
    /// No flips needed: never and auto, of median time.
    pub plain: [Run; 2],
    /// Medians over the rounds of auto over never: the flow alone, and with its start.
    pub ratio: [f64; 2],
    /// The same on a surface with boundary, from the input on: never, auto, and the ratio of their times.
    pub open: ([Run; 2], f64),
    /// Flips needed.
    pub flipped: Run,
    /// Seconds of the subdivision, and its triangles.
    pub subdivision: (f64, usize),
    /// Heap bytes of flow and subdivision per vertex of the input.
    pub bytes: usize,
}

/// The flow of a surface in the class of `scheme`, and the seconds of its start.
fn start(surface: &Surface, scheme: Scheme, flips: Flips) -> (f64, Flow) {
    let (class, options) = (Class::new(scheme, Space::E2), Options { flips, ..Options::default() });
    seconds(|| Flow::new(surface.clone(), class, &options, &Control::new()).unwrap())
}

/// The report of a flow to a target.
fn solve(flow: &mut Flow, target: &Target) -> Report {
    flow.solve(target, &Control::new()).unwrap().report().unwrap().clone()
}

/// A flat torus of equilateral triangles.
fn acute(vertices: usize) -> Surface {
    let side = (vertices as f64).sqrt() as usize;
    let (mesh, lengths) = shapes::flat_torus([-0.5, 0.75f64.sqrt()], side, side).unwrap().build().unwrap();
    Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
}

/// A flat disk of nearly equilateral triangles.
fn acute_disk(vertices: usize) -> Surface {
    let rings = (vertices as f64 / 3.0).sqrt() as usize;
    Surface::from_soup(&shapes::disk(rings).unwrap()).unwrap()
}

/// A torus of revolution whose triangles are twice as long as wide, with noise.
fn rough(vertices: usize) -> Surface {
    let side = (vertices as f64 / 4.0).sqrt();
    let mut soup = shapes::torus(2.0, 0.9, (4.0 * side) as usize, side as usize).unwrap();
    shapes::noise(&mut soup, 0.2, 1).unwrap();
    Surface::from_soup(&soup).unwrap()
}

/// Curvature in waves, so small that no edge loses the Delaunay property.
fn waves(mesh: &Mesh) -> PerVertex<f64> {
    let mut target =
        PerVertex::from_fn(mesh.n_vertices(), |v: ricci::mesh::VertexId| 0.02 * (v.0 as f64).sin());
    let mean = target.iter().sum::<f64>() / target.len() as f64;
    target.iter_mut().for_each(|k| *k -= mean);
    target
}

/// Cones of ±π in turn, evenly spread over the vertices.
fn cones(surface: &Surface) -> Target {
    let n = surface.mesh().n_vertices();
    let at = (0..CONES).map(|k| ((n / CONES * k).into(), if k % 2 == 0 { PI } else { -PI }));
    Target::Cones(at.collect())
}

/// From the input to a disk of waves, with and without flips.
fn open(vertices: usize, scheme: Scheme) -> ([Run; 2], f64) {
    let surface = acute_disk(vertices);
    let mut target = Target::Boundary.values(&surface, Space::E2).unwrap();
    // Smaller than on the torus, since the disk is less regular.
    target.iter_mut().zip(waves(surface.mesh()).iter()).for_each(|(k, wave)| *k += 0.1 * wave);
    let target = Target::All(target);
    let run = |flips| {
        let (start, mut flow) = start(&surface, scheme, flips);
        let report = solve(&mut flow, &target);
        assert!(
            report.converged() && report.flips == 0 && flow.double().is_none(),
            "flips where none should be"
        );
        Run { start, report, start_flips: 0 }
    };
    let (never, auto): (Vec<_>, Vec<_>) =
        (0..rounds(vertices)).map(|_| (run(Flips::Never), run(Flips::Auto))).unzip();
    let ratio = median(auto.iter().zip(&never).map(|(a, n)| a.whole() / n.whole()));
    ([middle(never), middle(auto)], ratio)
}

pub fn measure(vertices: usize, scheme: Scheme) -> Row {
    let surface = acute(vertices);
    let target = Target::All(waves(surface.mesh()));
    let (mut never, mut auto) = (Vec::new(), Vec::new());
    // Inversive distance starts from smaller circles where edges may flip: both flows start from those.
    let (_, first) = start(&surface, scheme, Flips::Auto);
    assert_eq!(first.start_flips(), 0, "flips where none should be");
    let metric = &first.initial().metric;
    let rounds = rounds(vertices);
    for round in 1..=rounds {
        eprintln!("{vertices} {scheme}: round {round} of {rounds}");
        for (flips, runs) in [(Flips::Never, &mut never), (Flips::Auto, &mut auto)] {
            let (start, _) = start(&surface, scheme, flips);
            let options = Options { flips, ..Options::default() };
            let mesh = Mesh::clone(surface.mesh());
            let report = solve(&mut Flow::from_metric(mesh, metric.clone(), &options).unwrap(), &target);
            assert!(report.converged() && report.flips == 0, "flips where none should be");
            runs.push(Run { start, report, start_flips: 0 });
        }
        assert_eq!(auto[round - 1].report.iterations, never[round - 1].report.iterations);
    }
    let ratio = |of: fn(&Run) -> f64| median(auto.iter().zip(&never).map(|(a, n)| of(a) / of(n)));
    let ratio = [ratio(|run| run.report.seconds.total), ratio(Run::whole)];
    let surface = rough(vertices);
    let target = cones(&surface);
    let (mut flipped, mut refined, mut bytes, mut triangles) = (Vec::new(), Vec::new(), 0, 0);
    for _ in 0..rounds {
        let (peak, (took, run)) = heap::peak(|| {
            let (start, mut flow) = start(&surface, scheme, Flips::Auto);
            let report = solve(&mut flow, &target);
            assert!(report.converged(), "{report:?}");
            let run = Run { start, report, start_flips: flow.start_flips() };
            let (took, subdivision) =
                seconds(|| flow.solution().common_subdivision(&Control::new()).unwrap());
            triangles = subdivision.mesh.n_faces();
            (took, run)
        });
        flipped.push(run);
        refined.push(took);
        bytes = peak / surface.mesh().n_vertices();
    }
    Row {
        vertices: surface.mesh().n_vertices(),
        scheme,
        plain: [middle(never), middle(auto)],
        ratio,
        open: open(vertices, scheme),
        flipped: middle(flipped),
        subdivision: (median(refined.into_iter()), triangles),
        bytes,
    }
}

/// The run of median time.
fn middle(mut runs: Vec<Run>) -> Run {
    runs.sort_by(|a, b| a.whole().total_cmp(&b.whole()));
    runs.swap_remove(runs.len() / 2)
}

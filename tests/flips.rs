//! Flips.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use ricci::Control;
use ricci::flow::{Flips, Options, Solver};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerVertex, io};
use ricci::metric::delaunay::intrinsic_delaunay;
use ricci::metric::{Scheme, Target, initial_metric, lengths_from_positions};

#[test]
fn corpus() {
    let Some((folder, rows)) = common::index("good") else { return };
    let only = std::env::var("ONLY").unwrap_or_default();
    let most: usize = std::env::var("MOST").ok().and_then(|m| m.parse().ok()).unwrap_or(20_000);
    for row in &rows {
        let name = &row["file"];
        let soup = io::read(&folder.join(name)).unwrap();
        if !name.contains(&only) || soup.positions.len() > most {
            continue;
        }
        for (space, scheme) in [
            (Space::E2, Scheme::Yamabe),
            (Space::E2, Scheme::Inversive),
            (Space::H2, Scheme::Yamabe),
            (Space::H2, Scheme::Inversive),
        ] {
            let mut mesh = Mesh::from_soup(&soup).unwrap();
            if !mesh.is_closed() || (space == Space::H2 && mesh.genus() < 2) {
                continue;
            }
            let mut lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
            let isometric =
                intrinsic_delaunay(&mut mesh, &mut lengths, None, Space::E2, &mut |_, _| {}).unwrap();
            let initial = initial_metric(&mesh, &lengths, Space::E2, scheme, space).unwrap();
            let target: PerVertex<f64> = match space {
                Space::E2 if mesh.genus() == 0 => {
                    let mut t = PerVertex::filled(mesh.n_vertices(), 0.0);
                    let step = mesh.n_vertices() / 4;
                    (0..4).for_each(|k| t[(k * step).into()] = std::f64::consts::PI);
                    t
                }
                _ => Target::Uniform.resolve(&mesh, &lengths, space, scheme).unwrap(),
            };
            let start = std::time::Instant::now();
            let options = Options { flips: Flips::Auto, max_iterations: 200, ..Options::default() };
            let mut solver = Solver::new(mesh, initial.metric, options).unwrap();
            let report = solver.solve(&target, &Control::new()).unwrap();
            println!(
                "{name} {space} {scheme}: {} it {} flips {isometric}+{} broken {} err {:.1e} {:.2}s (flip {:.2} analyse {:.2} factor {:.2})",
                report.stop_reason,
                report.iterations,
                report.flips,
                report.broken_triangles,
                report.max_curvature_error,
                start.elapsed().as_secs_f64(),
                report.seconds.flip,
                report.seconds.analyse,
                report.seconds.factor,
            );
        }
    }
}

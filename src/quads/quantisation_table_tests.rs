//! The table of quantisations of the T-meshes of real surfaces beside an integer program.

use super::tests::least_cost;
use super::*;
use crate::control::Control;
use crate::mesh::io;
use crate::metric::Surface;
use crate::quads::grid_surface::GridSurface;
use crate::quads::relaxation::Usable;
use crate::seamless::{SeamlessOptions, seamless};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What an integer program may take.
const LONGEST: Duration = Duration::from_secs(60);
/// Share of the least cost within which numbers are to be.
const NEAR: f64 = 0.01;

/// A quantisation beside the least cost.
struct Judged {
    seconds: f64,
    cost: f64,
    least: Option<f64>,
}

impl Judged {
    /// Numbers of at least `least` for about this number of quads.
    fn new(t_mesh: &TMesh, quads: f64, least: i64) -> Judged {
        let area: f64 = t_mesh.rectangles.iter().map(|r| r.size[0] as f64 * r.size[1] as f64).sum();
        let edge = (area / quads).sqrt();
        let wanted = t_mesh.arcs.iter().map(|arc| arc.length as f64 / edge).collect();
        let start = Instant::now();
        let mut found = Quantisation::balanced(t_mesh, wanted, least, &Control::new()).unwrap();
        found.lower(Usable { enforce: &mut |_| Ok(()), holds: &mut |_| true }, &Control::new()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        assert!(found.excess().iter().all(|e| *e == 0));
        Judged { seconds, cost: found.cost(), least: least_cost(&found, least, LONGEST) }
    }

    fn over(&self) -> Option<f64> {
        self.least.map(|least| self.cost / least - 1.0)
    }
}

fn t_mesh(path: &Path) -> TMesh {
    let surface = Surface::from_soup(&io::read(path).unwrap()).unwrap();
    let of = seamless(&surface, &SeamlessOptions::default(), &Control::new()).unwrap();
    TMesh::new(&GridSurface::new(&of, &Control::new()).unwrap(), &Control::new()).unwrap()
}

#[test]
#[ignore = "writes docs/results/quantisation.md, in a release build"]
fn table_of_real_surfaces() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder =
        std::env::var_os("RICCI_MESHES").map_or(root.join("../shared/meshes"), PathBuf::from).join("good");
    let files = std::fs::read_dir(&folder)
        .expect("RICCI_MESHES names the mesh corpus")
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e != "csv")).collect();
    files.sort();
    let meshes: Vec<(String, TMesh)> = files
        .iter()
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), t_mesh(path)))
        .collect();
    let mut page = String::from(
        "# Quantisations beside an integer program\n\nMade by `cargo test --release -p ricci --lib table_of_real_surfaces -- --ignored`, every mesh of one \
         component. The T-meshes are those of\n`ricci quads`; the cost of a whole number per arc is the sum of squared differences from the wanted \
         lengths. *over*: by how much more\nthe numbers cost than the best ones, which an integer program (microlp, at most 60 s) finds; `-`: it was not \
         done by then. Arcs may have\nthe length 0 in the second half, where no test asks whether cones stay apart, as the program knows none.\n",
    );
    let (mut near, mut judged, mut slowest) = (0, 0, 0.0f64);
    for (quads, least) in [(1000.0, 1), (10000.0, 1), (1000.0, 0), (10000.0, 0)] {
        writeln!(page, "\n## About {quads} quads, each arc at least {least}\n\n| mesh | arcs | cost | over | s |\n|---|---|---|---|---|").unwrap();
        let (mut here, mut of) = (0, 0);
        for (name, t_mesh) in &meshes {
            let found = Judged::new(t_mesh, quads, least);
            let over = found.over().map_or("-".into(), |over| format!("{:.2} %", 100.0 * over.max(0.0)));
            writeln!(
                page,
                "| {name} | {} | {:.2} | {over} | {:.3} |",
                t_mesh.arcs.len(),
                found.cost,
                found.seconds
            )
            .unwrap();
            of += usize::from(found.least.is_some());
            here += usize::from(found.over().is_some_and(|over| over <= NEAR));
            slowest = slowest.max(found.seconds);
        }
        writeln!(page, "\nWithin 1 %: {here} of {of}.").unwrap();
        near += here;
        judged += of;
    }
    writeln!(page, "\nAltogether within 1 %: {near} of {judged} that the program solved; the slowest took {slowest:.2} s.").unwrap();
    std::fs::write(root.join("docs/results/quantisation.md"), page).unwrap();
    assert!(near as f64 >= 0.95 * judged as f64, "{near} of {judged}");
}

//! Times of harmonic forms by phase, compared with one factorisation and 2g solves, and of harmonic maps of disks, compared with CGAL's.
//!
//! `cargo bench --bench forms [-- VERTICES…] > docs/results/bench-forms.md` (default: 10000 50000 300000). Forms: generated closed
//! surfaces of genus 2, 10, 46 and 73 of about that size. Disks: a wavy disk with noise, and with `RICCI_MESHES` some of the corpus.
//!
//! CGAL is measured by the program `maps` of benches/peers: in the folder `RICCI_PEERS`, or else cmake builds it. Where it is missing,
//! the page says so and has no columns for it.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "../common/mod.rs"]
mod common;
mod disks;
mod page;

use common::peers::Program;
use common::{heap, machine, median, seconds};
use ricci::harmonic::forms::FormsSeconds;
use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, Laplace, PeriodMatrix};
use ricci::mesh::shapes;
use ricci::{Control, Surface};

const GENERA: [usize; 4] = [2, 10, 46, 73];

/// Rounds of measurements, of which the medians are printed.
fn rounds(vertices: usize) -> usize {
    if vertices < 100_000 { 5 } else { 3 }
}

/// The measurements of the forms of one surface.
pub struct Row {
    vertices: usize,
    genus: usize,
    /// The seconds of the triangulation and its weights.
    domain: f64,
    phases: FormsSeconds,
    /// The seconds of [`HarmonicForms::new`], all phases.
    forms: f64,
    /// The seconds of the period matrix.
    periods: f64,
    /// The seconds of one assembly, analysis and factorisation of the same matrix and as many solves, and nothing else.
    yardstick: f64,
    /// Heap bytes of the forms at their peak, beyond the surface.
    bytes: usize,
}

fn measure(genus: usize, vertices: usize) -> Row {
    let layers = (vertices as f64 / (8.0 * (5.0 * genus as f64 + 1.0))).sqrt().round().max(1.0);
    let mut soup = shapes::genus(genus, layers as usize).unwrap();
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    drop(soup);
    let control = Control::new();
    let rounds = rounds(vertices);
    let (mut rows, mut bytes) = (Vec::new(), 0);
    for round in 1..=rounds {
        eprintln!("genus {genus}, {} vertices: round {round} of {rounds}", surface.mesh().n_vertices());
        let before = heap::live();
        let (peak, (domain, forms, periods, phases)) = heap::peak(|| {
            let (domain, place) = seconds(|| Domain::new(&surface, &control).unwrap());
            let (forms, found) =
                seconds(|| HarmonicForms::new(&place, &FormsOptions::default(), &control).unwrap());
            let (periods, matrix) = seconds(|| PeriodMatrix::new(&found).unwrap());
            assert!(found.coclosedness < 1e-9 && matrix.least_eigenvalue > 0.0);
            (domain, forms, periods, found.seconds)
        });
        bytes = bytes.max(peak - before);
        rows.push((domain, forms, periods, phases, yardstick(&surface, genus)));
    }
    let of = |field: fn(&(f64, f64, f64, FormsSeconds, f64)) -> f64| median(rows.iter().map(field));
    Row {
        vertices: surface.mesh().n_vertices(),
        genus,
        domain: of(|row| row.0),
        forms: of(|row| row.1),
        periods: of(|row| row.2),
        phases: FormsSeconds {
            topology: of(|row| row.3.topology),
            assemble: of(|row| row.3.assemble),
            analyse: of(|row| row.3.analyse),
            factor: of(|row| row.3.factor),
            solve: of(|row| row.3.solve),
        },
        yardstick: of(|row| row.4),
        bytes,
    }
}

/// One factorisation and 2g solves, eight right sides at a time.
fn yardstick(surface: &Surface, genus: usize) -> f64 {
    let domain = Domain::new(surface, &Control::new()).unwrap();
    let n = surface.mesh().n_vertices();
    let mut loads = vec![0.0; 8 * n];
    let (factor, laplace) = seconds(|| Laplace::new(&domain, |_| false, &Control::new()).unwrap());
    let solves = (0..2 * genus).step_by(8).map(|k| {
        let columns = &mut loads[..n * (2 * genus - k).min(8)];
        columns.iter_mut().enumerate().for_each(|(i, x)| *x = if i % 2 == 0 { 1.0 } else { -1.0 });
        seconds(|| laplace.solve(columns).unwrap()).0
    });
    factor + solves.sum::<f64>()
}

fn main() {
    // Cargo adds --bench.
    let arguments = std::env::args().skip(1).filter(|a| a != "--bench");
    let mut sizes: Vec<usize> =
        arguments.map(|a| a.parse().unwrap_or_else(|_| panic!("{a} is no number of vertices"))).collect();
    if sizes.is_empty() {
        sizes = vec![10_000, 50_000, 300_000];
    }
    let load = machine::load();
    let peers = Program::find("maps");
    if let Err(why) = &peers {
        eprintln!("no peers: {why}");
    }
    // A surface of high genus with few vertices is no surface that anyone has.
    let fits = |genus: usize, vertices: usize| vertices >= 600 * genus;
    let cases = sizes.iter().flat_map(|&size| GENERA.map(|genus| (genus, size)));
    let forms: Vec<Row> =
        cases.filter(|&(g, n)| fits(g, n)).map(|(genus, size)| measure(genus, size)).collect();
    let disks = disks::measure(&sizes, peers.as_ref().ok());
    println!("{}", page::page(&forms, &disks, peers.map(|p| p.libraries()), [load, machine::load()]));
}

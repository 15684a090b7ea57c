//! Many solves of one flow do not ask for their memory again and again: what a later one allocates is the solution that it returns.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use ricci::flow::{Flips, Flow, Options};
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::mesh::shapes;
use ricci::{Class, Control, Surface, Target};

#[allow(dead_code)]
#[path = "../benches/common/heap.rs"]
mod heap;

/// Bytes per vertex that a later solve may ask for: a solution with its target and triangulation has about 400 (and 1,000 more were asked
/// for when the states and vectors of a solve were new each time).
const MOST: usize = 500;

#[test]
fn later_solves_allocate_little_but_what_they_return() {
    let mut soup = shapes::torus(2.0, 0.9, 64, 32).unwrap();
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    let n = surface.mesh().n_vertices();
    let options = Options { flips: Flips::Never, threads: 1, ..Options::default() };
    let control = Control::new();
    let mut flow = Flow::new(surface, Class::yamabe(Space::E2), &options, &control).unwrap();
    let taken: Vec<usize> = (0..4)
        .map(|k| {
            let target = Target::Cones(vec![(VertexId(k), 0.3), (VertexId(k + 40), -0.3)]);
            let (taken, solution) = heap::asked(|| flow.solve(&target, &control).unwrap());
            assert!(solution.report().unwrap().converged());
            taken / n
        })
        .collect();
    println!("bytes per vertex: {taken:?}");
    assert!(taken[0] > MOST && taken[1..].iter().all(|&bytes| bytes <= MOST), "{taken:?}");
}

//! Many solves of one flow do not ask for their memory again and again: what a later one allocates is the solution that it returns.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use ricci::flow::{Flips, Flow, Options};
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::mesh::shapes;
use ricci::{Class, Control, Surface, Target};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Counts bytes that are asked for.
struct Counting;

static BYTES: AtomicUsize = AtomicUsize::new(0);

// SAFETY: forwards to the system allocator; the counter does not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's contract is the same.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's contract is the same.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
            let before = BYTES.load(Ordering::Relaxed);
            let solution = flow.solve(&target, &control).unwrap();
            let taken = (BYTES.load(Ordering::Relaxed) - before) / n;
            assert!(solution.report().unwrap().converged());
            taken
        })
        .collect();
    println!("bytes per vertex: {taken:?}");
    assert!(taken[0] > MOST && taken[1..].iter().all(|&bytes| bytes <= MOST), "{taken:?}");
}

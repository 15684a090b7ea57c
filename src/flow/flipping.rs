//! Flips while the metric changes.

use crate::error::Result;
use crate::mesh::{Mesh, PerVertex};
use crate::metric::Metric;
use crate::metric::delaunay::{Queue, failing, restore_delaunay};

/// Flip inside the class until the triangulation is weighted Delaunay at u: the edges that fail there, and those around what is
/// flipped. Returns the number of flips.
pub(super) fn flip_to_delaunay(mesh: &mut Mesh, class: &mut Metric, u: &PerVertex<f64>) -> Result<usize> {
    let first = failing(mesh, class, u);
    if first.is_empty() {
        return Ok(0);
    }
    let mut queue = Queue::new(mesh.n_edges());
    first.into_iter().for_each(|e| queue.push(e));
    restore_delaunay(mesh, class, u, &mut queue, &mut |_, _| {})
}

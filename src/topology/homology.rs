//! Homology generators by tree and cotree.

use super::spanning::{leftover, shortest_paths};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, VertexId};

/// A basis of the first homology: closed loops, each a sequence of half-edges in which every half-edge starts where the one before it ends.
///
/// There are 2g loops on a closed surface of genus g and 2g + b − 1 on one with b > 0 boundary loops. Let T be the shortest-path tree of
/// vertex 0 and C a maximum spanning tree of the dual graph, in which an edge weighs as much as
/// the loop is long that it closes with the paths of T from its ends to vertex 0 \[EW05\]; each edge in neither of them closes a loop. With a
/// boundary the dual graph has one more node, for the outside of all boundary loops, and the surface retracts onto T and the edges in neither
/// tree. The common part of the two paths of a loop is cut off, so that it need not pass through vertex 0. Shortest loops come first.
/// O(E log E + total length).
///
/// `lengths`: finite and positive, one per edge.
///
/// ```
/// use ricci::{Control, mesh::shapes, topology::homology_generators};
/// let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
/// let loops = homology_generators(&mesh, &lengths, &Control::new())?;
/// assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
/// # Ok::<(), ricci::Error>(())
/// ```
///
/// # Errors
///
/// [`crate::Error::Size`], [`crate::Error::EdgeLength`]; [`crate::Error::Cancelled`].
pub fn homology_generators(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    control: &Control,
) -> Result<Vec<Vec<HalfedgeId>>> {
    let root = (mesh.n_vertices() > 0).then_some(VertexId(0));
    let tree = shortest_paths(mesh, lengths, root, control)?;
    control.check()?;
    let close = |h: HalfedgeId| {
        // A path lists half-edges that point away from the root, the last one first.
        let mut to_origin: Vec<_> = tree.path(mesh, mesh.origin(h)).collect();
        let mut to_tip: Vec<_> = tree.path(mesh, mesh.tip(h)).collect();
        while to_origin.last().is_some() && to_origin.last() == to_tip.last() {
            to_origin.pop();
            to_tip.pop();
        }
        let to_origin = to_origin.into_iter().rev();
        to_origin.chain([h]).chain(to_tip.into_iter().map(HalfedgeId::twin)).collect()
    };
    let is_excluded = |_| false;
    Ok(leftover(mesh, lengths, &tree, is_excluded).into_iter().map(|e| close(e.halfedge())).collect())
}

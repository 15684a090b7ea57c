//! Homology generators by tree and cotree.

use super::spanning::{leftover, shortest_paths};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, VertexId};

/// A basis of the first homology: closed loops of half-edges, each starting where the one before it ends.
///
/// There are 2g loops on a closed surface of genus g and 2g + b − 1 on one with b > 0 boundary loops. Let T be the shortest-path tree of
/// vertex 0 and C a maximum spanning tree of the dual graph, weighted by the length of an edge's loop through vertex 0 \[EW05\]; each
/// edge in neither of them closes a loop. With a boundary the outside is a node of the dual graph, so the surface collapses onto T and
/// those edges. The path to vertex 0 and back that a loop starts and ends with is removed. Shortest loops come first. O(E log E + total
/// length).
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
        let mut there: Vec<_> = tree.path(mesh, mesh.origin(h)).collect();
        let mut back: Vec<_> = tree.path(mesh, mesh.tip(h)).collect();
        while there.last().is_some() && there.last() == back.last() {
            there.pop();
            back.pop();
        }
        let there = there.into_iter().rev();
        there.chain([h]).chain(back.into_iter().map(HalfedgeId::twin)).collect()
    };
    Ok(leftover(mesh, lengths, &tree, |_| false).into_iter().map(|e| close(e.halfedge())).collect())
}

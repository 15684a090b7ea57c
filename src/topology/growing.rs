//! The cut along which a growing disk meets itself.

use super::cut::CutGraph;
use super::farthest::central;
use super::nearest::NearestQueue;
use super::spanning::{mean, shortest_paths};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerVertex, VertexId};

/// Faces added between two checks of the control: they take a fraction of a millisecond.
const FACES_PER_CHECK: usize = 1024;

/// The cut along which a disk that grows about `root` meets itself. The disk adds one face after the other, each time the one whose far
/// corner is nearest to the root along edges, so that paths inside the disk to the root are short. Empty on a sphere.
///
/// # Errors
///
/// [`Error::EdgeLength`]; [`Error::Argument`] for a vertex that does not exist; [`Error::Layout`] for a surface of several components;
/// [`Error::Cancelled`].
pub(crate) fn cut_about(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    root: VertexId,
    control: &Control,
) -> Result<CutGraph> {
    cut_about_joined(mesh, lengths, root, &|_| 0, control)
}

/// [`cut_about`] the [central vertex](super::central_vertex), with that vertex.
///
/// # Errors
///
/// Those of [`cut_about`].
pub(crate) fn cut_about_centre(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    control: &Control,
) -> Result<(VertexId, CutGraph)> {
    let (root, distance) = central(mesh, lengths, control)?;
    let disk = GrowingDisk { mesh, root, distance, unit: mean(lengths) };
    Ok((root, disk.grown(&|_| 0, control)?))
}

/// Like [`cut_about`], but the disk grows first across edges whose `joined` is not 0, the largest ones first. So the cut avoids vertices
/// all of whose edges are joined, unless a chain of them leads around the surface.
///
/// # Errors
///
/// Those of [`cut_about`].
pub(crate) fn cut_about_joined(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    root: VertexId,
    joined: &dyn Fn(EdgeId) -> u8,
    control: &Control,
) -> Result<CutGraph> {
    let distance = shortest_paths(mesh, lengths, [root], control)?.distance;
    GrowingDisk { mesh, root, distance, unit: mean(lengths) }.grown(joined, control)
}

/// A disk that grows about a vertex.
struct GrowingDisk<'a> {
    mesh: &'a Mesh,
    root: VertexId,
    /// The distance along edges from the root to each vertex.
    distance: PerVertex<f64>,
    /// About the length of an edge, see [`NearestQueue::new`].
    unit: f64,
}

impl GrowingDisk<'_> {
    /// The cut along which the disk meets itself, see [`cut_about_joined`].
    fn grown(&self, joined: &dyn Fn(EdgeId) -> u8, control: &Control) -> Result<CutGraph> {
        let GrowingDisk { mesh, root, ref distance, unit } = *self;
        let mut reached = PerFace::filled(mesh.n_faces(), false);
        let mut closed = PerEdge::filled(mesh.n_edges(), false);
        let mut queue = NearestQueue::new(unit);
        let far = |f: FaceId| mesh.face_vertices(f).map(|v| distance[v]).into_iter().fold(0.0, f64::max);
        let mut next = mesh.outgoing(root).find(|&h| !mesh.is_outside(h));
        let (mut n_reached, mut is_first) = (0, true);
        while let Some(entry) = next {
            if let Some(f) = mesh.face(entry).filter(|&f| !std::mem::replace(&mut reached[f], true)) {
                control.check_every(FACES_PER_CHECK, &mut n_reached)?;
                closed[entry.edge()] |= !std::mem::replace(&mut is_first, false);
                for h in mesh.face_halfedges(f).map(HalfedgeId::twin) {
                    if let Some(g) = mesh.face(h).filter(|&g| !reached[g]) {
                        let key = match joined(h.edge()) {
                            0 => far(g),
                            urgency => -f64::from(urgency),
                        };
                        queue.push(key, h);
                    }
                }
            }
            next = queue.pop().map(|(_, h)| h);
        }
        if n_reached < mesh.n_faces() {
            let message = "the surface is empty or has several components: lay out each alone";
            return Err(Error::Layout(message.into()));
        }
        Ok(CutGraph::around(mesh, PerEdge::from_fn(mesh.n_edges(), |e| !closed[e])))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::topology::cut::is_disk;

    #[test]
    fn a_growing_disk_meets_itself_in_a_cut() {
        for (n, m) in [(12, 8), (9, 21), (5, 4)] {
            let mesh = Mesh::from_soup(&shapes::torus(2.0, 1.0, n, m).unwrap()).unwrap();
            let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| 1.0 + (e.index() % 5) as f64 / 50.0);
            let cut = cut_about(&mesh, &lengths, VertexId(0), &Control::new()).unwrap();
            assert!(is_disk(&mesh, &cut.is_cut));
            assert!((2..=3).contains(&cut.segments.len()), "{n}, {m}: {}", cut.segments.len());
            let edges: usize = cut.segments.iter().map(Vec::len).sum();
            assert_eq!(edges, cut.is_cut.iter().filter(|&&c| c).count());
            // The cut stays away from the vertex.
            let near = shortest_paths(&mesh, &lengths, [VertexId(0)], &Control::new()).unwrap().distance;
            let ends = |e: EdgeId| mesh.ends(e).map(|v| near[v]);
            let least = mesh.edges().filter(|&e| cut.is_cut[e]).flat_map(ends).fold(f64::INFINITY, f64::min);
            assert!(least >= (n.min(m) / 3) as f64, "{n}, {m}: {least}");
        }
        let sphere = Mesh::from_soup(&shapes::icosphere(3).unwrap()).unwrap();
        let lengths = PerEdge::filled(sphere.n_edges(), 1.0);
        assert!(cut_about(&sphere, &lengths, VertexId(5), &Control::new()).unwrap().segments.is_empty());
        let control = Control::new();
        control.cancel();
        assert!(matches!(cut_about(&sphere, &lengths, VertexId(0), &control), Err(Error::Cancelled)));
    }
}

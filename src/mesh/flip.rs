//! Edge flips, and sets of edges that must not be flipped.
//!
//! ```
//! use ricci::mesh::{EdgeId, Mesh, VertexId};
//! let mut mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]])?;
//! let diagonal = EdgeId(2);
//! assert_eq!(mesh.ends(diagonal), [VertexId(2), VertexId(0)]);
//! assert!(mesh.flip(diagonal) && !mesh.flip(EdgeId(0))); // edge 0 lies on the boundary
//! assert_eq!(mesh.ends(diagonal), [VertexId(3), VertexId(1)]);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, HalfedgeId};
use crate::archive::stored;
use crate::error::{Error, Result};

/// A flip of an edge that has a value, its length or its weight η. Callbacks that follow flips receive it just before the flip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flip<T = f64> {
    /// The edge. The other diagonal keeps its number.
    pub edge: EdgeId,
    /// The value of the edge before the flip.
    pub value: T,
}

/// A set of edges of one surface that must not be flipped. The default is the empty set, which fits every surface.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FixedEdges {
    /// For each edge, true if it is in the set; empty for the empty set.
    is_fixed: Vec<bool>,
}
stored!(sections FixedEdges { is_fixed });

impl FixedEdges {
    /// The empty set.
    pub const fn none() -> FixedEdges {
        FixedEdges { is_fixed: Vec::new() }
    }

    /// The set of the given edges of `mesh`, in any order. O(E).
    ///
    /// # Errors
    /// [`Error::Argument`] for an edge that the mesh does not have.
    pub fn new(mesh: &Mesh, edges: &[EdgeId]) -> Result<FixedEdges> {
        if edges.is_empty() {
            return Ok(FixedEdges::none());
        }
        Ok(FixedEdges { is_fixed: marked("fixed edge", mesh.n_edges(), edges)? })
    }

    /// True if the edge is in the set. O(1).
    #[inline]
    pub fn contains(&self, e: EdgeId) -> bool {
        self.is_fixed.get(e.index()).is_some_and(|&fixed| fixed)
    }
}

/// For each edge of a surface with `n_edges`, true if it is among `edges`; [`Error::Argument`] names one that does not exist.
pub(super) fn marked(what: &'static str, n_edges: usize, edges: &[EdgeId]) -> Result<Vec<bool>> {
    let mut is_marked = vec![false; n_edges];
    for e in edges {
        let mark = is_marked.get_mut(e.index());
        *mark.ok_or_else(|| Error::argument(what, e, "an existing edge"))? = true;
    }
    Ok(is_marked)
}

/// The first half-edges of the faces and vertices at an edge before a flip. With them [`Mesh::unflip`] restores a mesh bit for bit; three
/// more flips would also turn the edge back, but leave other first half-edges.
#[derive(Debug, Clone, Copy)]
pub(super) struct FlipUndo {
    /// The position, counted from the edge, of the first corner's side in the left and the right face.
    first: [u8; 2],
    /// True where the first outgoing half-edge of the origin, of the tip, is the edge itself.
    is_out: [bool; 2],
}

impl Mesh {
    /// Replaces an edge by the other diagonal of the quadrilateral of its two faces.
    ///
    /// ```text
    ///        c                  c        before: h = 2e = a → b, its face f = (a, b, c), its twin's g = (b, a, d)
    ///      /   \              / | \      after:  h = d → c, f = (d, c, a), g = (c, d, b), first corners in this
    ///     /  f  \            /  |  \             order: the edge turns counterclockwise
    ///    a —————→ b    ⇒    a f h g b
    ///     \  g  /            \  |  /      No other half-edge changes its ends.
    ///      \   /              \ | /
    ///        d                  d
    /// ```
    ///
    /// Some of the four vertices may be the same, and some of the quadrilateral's sides. Returns false and does nothing for an edge on
    /// the boundary and for one with the same face on both sides, which have no other diagonal.
    pub fn flip(&mut self, e: EdgeId) -> bool {
        let h = e.halfedge();
        let t = h.twin();
        let (Some(f), Some(g)) = (self.face(h), self.face(t)) else { return false };
        if f == g {
            return false;
        }
        let (bc, ca) = (self.next(h), self.prev(h));
        let (ad, db) = (self.next(t), self.prev(t));
        let [a, b, c, d] = [h, t, ca, db].map(|x| self.origin(x));
        self.set_triangle(f, [h, ca, ad]);
        self.set_triangle(g, [t, db, bc]);
        self.set_origin(h, d);
        self.set_origin(t, c);
        for (v, lost, kept) in [(a, h, ad), (b, t, bc)] {
            if self.out(v) == lost {
                self.set_out(v, kept);
            }
        }
        true
    }

    /// The state around an edge between two faces that [`Mesh::unflip`] needs, to be taken before the flip.
    pub(super) fn before_flip(&self, e: EdgeId) -> FlipUndo {
        let sides = [e.halfedge(), e.halfedge().twin()];
        let first = sides.map(|h| {
            let is_first = |h: HalfedgeId| self.face(h).is_some_and(|f| self.face_halfedge(f) == h);
            if is_first(h) {
                0
            } else if is_first(self.next(h)) {
                1
            } else {
                2
            }
        });
        FlipUndo { first, is_out: sides.map(|h| self.out(self.origin(h)) == h) }
    }

    /// Undoes the last flip, which must have been one of this edge. `before` is from [`Mesh::before_flip`]; the mesh is then bit for bit
    /// what it was. Does nothing for an edge without two faces, which no flip leaves.
    pub(super) fn unflip(&mut self, e: EdgeId, before: FlipUndo) {
        let h = e.halfedge();
        let t = h.twin();
        let (Some(f), Some(g)) = (self.face(h), self.face(t)) else { return };
        let (ca, ad) = (self.next(h), self.prev(h));
        let (db, bc) = (self.next(t), self.prev(t));
        let [a, b] = [ad, bc].map(|x| self.origin(x));
        for (face, mut sides, first) in [(f, [h, bc, ca], before.first[0]), (g, [t, ad, db], before.first[1])]
        {
            sides.rotate_left(usize::from(first));
            self.set_triangle(face, sides);
        }
        for (halfedge, v, is_out) in [(h, a, before.is_out[0]), (t, b, before.is_out[1])] {
            self.set_origin(halfedge, v);
            if is_out {
                self.set_out(v, halfedge);
            }
        }
    }

    /// The sides of the quadrilateral around an interior edge h = a → b with opposite vertices c (left) and d (right): `[b → c, c → a, a
    /// → d, d → b]`.
    pub(crate) fn quadrilateral(&self, h: HalfedgeId) -> [HalfedgeId; 4] {
        let t = h.twin();
        [self.next(h), self.prev(h), self.next(t), self.prev(t)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::mesh::shapes::SplitMix64;

    /// The faces as sets of corners, in an order that does not depend on their numbers.
    fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
        let mut all: Vec<[u32; 3]> = mesh
            .faces()
            .map(|f| {
                let [a, b, c] = mesh.face_vertices(f).map(|v| v.0);
                [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c])
            })
            .collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn flipping_twice_restores_the_triangulation_and_four_times_every_half_edge() {
        let soup = shapes::icosphere(2).unwrap();
        let before = Mesh::from_soup(&soup).unwrap();
        for e in before.edges() {
            let mut mesh = before.clone();
            assert!(mesh.flip(e));
            mesh.validate().unwrap();
            assert_ne!(triangles(&mesh), triangles(&before));
            assert!(mesh.flip(e));
            assert_eq!(triangles(&mesh), triangles(&before));
            assert_eq!(mesh.ends(e).map(|v| v.0), {
                let [a, b] = before.ends(e);
                [b.0, a.0]
            });
            assert!(mesh.flip(e) && mesh.flip(e));
            mesh.validate().unwrap();
            assert!(
                mesh.halfedges()
                    .all(|h| mesh.origin(h) == before.origin(h) && mesh.next(h) == before.next(h))
            );
        }
    }

    #[test]
    fn random_flips_keep_every_rule_down_to_one_vertex() {
        let mut random = SplitMix64::new(3);
        let surfaces = [
            shapes::one_vertex(2).unwrap().build().unwrap().0,
            shapes::two_triangle_sphere().build().unwrap().0,
            shapes::two_vertex(1).unwrap().build().unwrap().0,
            Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap(),
        ];
        for mut mesh in surfaces {
            let (euler, loops) = (mesh.euler(), mesh.boundary_loops().len());
            let mut flipped = 0;
            for _ in 0..300 {
                let e = EdgeId((random.bits() % mesh.n_edges() as u64) as u32);
                let h = e.halfedge();
                let possible = mesh.face(h).zip(mesh.face(h.twin())).is_some_and(|(f, g)| f != g);
                assert_eq!(mesh.flip(e), possible);
                flipped += usize::from(possible);
                mesh.validate().unwrap();
            }
            assert!(flipped > 20);
            assert_eq!((mesh.euler(), mesh.boundary_loops().len()), (euler, loops));
        }
    }
}

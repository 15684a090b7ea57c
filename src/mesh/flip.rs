//! Edge flips.

use super::halfedge::Mesh;
use super::ids::{EdgeId, HalfedgeId};

impl Mesh {
    /// Replace an edge by the other diagonal of the quadrilateral of its two faces.
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
    /// Any of the four vertices may be the same, as may the quadrilateral's sides. False, and nothing done, for an edge on
    /// the boundary and for one with the same face on both sides: it has no other diagonal.
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

    /// The sides of the quadrilateral around an interior edge h = a → b with opposite vertices c (left) and d (right): `[b → c,
    /// c → a, a → d, d → b]`.
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

    /// Faces as sets of corners, whatever their order and number.
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

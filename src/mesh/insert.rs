//! Vertices added to a triangulation: inside a face, which becomes three, or on an edge, whose faces become two each.

use super::halfedge::Mesh;
use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};

impl Mesh {
    /// Adds a vertex inside a face.
    ///
    /// ```text
    ///          c            The face (a, b, c) becomes (a, b, v); the new faces are (b, c, v) and (c, a, v).
    ///        / | \          Returns v and its edges to a, b, c, whose half-edges 2e start at v.
    ///       /  v  \
    ///      / /   \ \
    ///     a ——————— b
    /// ```
    pub(crate) fn insert_in_face(&mut self, f: FaceId) -> (VertexId, [EdgeId; 3]) {
        let sides = self.face_halfedges(f);
        let corners = sides.map(|h| self.origin(h));
        let v = self.add_vertex();
        let spokes = corners.map(|corner| self.add_edge(v, corner));
        let faces = [f, self.add_face(), self.add_face()];
        for k in 0..3 {
            let [from, to] = [spokes[k], spokes[(k + 1) % 3]].map(EdgeId::halfedge);
            self.set_triangle(faces[k], [sides[k], to.twin(), from]);
        }
        self.set_out(v, spokes[0].halfedge());
        (v, spokes)
    }

    /// Adds a vertex on an edge that has two different faces, or lies on the boundary.
    ///
    /// ```text
    ///          c            The edge a → b keeps its number between a and v; the new edges are v → b, then v → c on the left and
    ///        / | \          v → d on the right, where there is a face.
    ///       /  |  \         Returns v, the edge v → b, and the edges on the left and on the right.
    ///     a —— v —— b
    ///       \  |  /
    ///        \ | /
    ///          d
    /// ```
    pub(crate) fn insert_on_edge(&mut self, e: EdgeId) -> (VertexId, EdgeId, [Option<EdgeId>; 2]) {
        let there = e.halfedge();
        let back = there.twin();
        let tip = self.tip(there);
        let before_back = self.is_outside(back).then(|| self.outside_before(back));
        let v = self.add_vertex();
        let far = self.add_edge(v, tip);
        let (on, home) = (far.halfedge(), far.halfedge().twin());
        let left = self.face(there).map(|f| {
            let [next, prev] = [self.next(there), self.prev(there)];
            let line = self.add_edge(v, self.origin(prev));
            let new = self.add_face();
            self.set_triangle(f, [there, line.halfedge(), prev]);
            self.set_triangle(new, [on, next, line.halfedge().twin()]);
            line
        });
        let right = self.face(back).map(|g| {
            let [next, prev] = [self.next(back), self.prev(back)];
            let line = self.add_edge(v, self.origin(prev));
            let new = self.add_face();
            self.set_triangle(g, [back, next, line.halfedge().twin()]);
            self.set_triangle(new, [home, line.halfedge(), prev]);
            line
        });
        if left.is_none() {
            self.set_next(on, self.next(there));
            self.set_next(there, on);
        }
        if let Some(before) = before_back {
            self.set_next(before, home);
            self.set_next(home, back);
        }
        if self.out(tip) == back {
            self.set_out(tip, home);
        }
        self.set_origin(back, v);
        self.set_out(v, if right.is_none() { back } else { on });
        (v, far, [left, right])
    }

    /// The half-edge of a boundary loop before one of the loop.
    fn outside_before(&self, h: HalfedgeId) -> HalfedgeId {
        let mut leaving = self.next(h.twin());
        while !self.is_outside(leaving.twin()) {
            leaving = self.next(leaving.twin());
        }
        leaving.twin()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn vertices_inside_faces_and_on_edges_keep_the_rules_of_the_structure() {
        let two = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        for e in two.edges() {
            let mut mesh = two.clone();
            let (v, far, lines) = mesh.insert_on_edge(e);
            mesh.validate().unwrap();
            assert_eq!(mesh.ends(e)[1], v);
            assert_eq!(mesh.ends(far), [v, two.ends(e)[1]]);
            let n_lines = lines.into_iter().flatten().count();
            assert_eq!(n_lines, if two.is_boundary_edge(e) { 1 } else { 2 });
            assert_eq!((mesh.n_faces(), mesh.euler()), (2 + n_lines, 1));
            assert_eq!(mesh.boundary_loops()[0].len(), if n_lines == 1 { 5 } else { 4 });
        }
        for f in two.faces() {
            let mut mesh = two.clone();
            let (v, spokes) = mesh.insert_in_face(f);
            mesh.validate().unwrap();
            assert_eq!(spokes.map(|e| mesh.ends(e)[1]), two.face_vertices(f));
            assert_eq!((mesh.fan(v).len(), mesh.euler()), (3, 1));
        }
    }

    #[test]
    fn a_torus_of_one_vertex_takes_vertices_on_its_loops() {
        let mut torus = crate::mesh::shapes::flat_torus([0.3, 1.0], 1, 1).unwrap().build().unwrap().0;
        let euler = torus.euler();
        torus.insert_on_edge(EdgeId(0));
        torus.insert_in_face(FaceId(1));
        torus.insert_on_edge(EdgeId(1));
        torus.validate().unwrap();
        assert_eq!((torus.euler(), torus.n_vertices()), (euler, 4));
    }
}

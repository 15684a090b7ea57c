//! Lifts of closed loops of a surface to its universal cover: paths whose ends are related by a deck transformation.
//!
//! ```
//! use ricci::canonical::{QuotientOptions, uniformize_quotient};
//! use ricci::{Control, Surface, mesh::shapes};
//! let surface = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let torus = uniformize_quotient(&surface, &QuotientOptions::default(), &Control::new())?;
//! let word = torus.deck.group.parse("a1 b1^-1")?;
//! let lifted = torus.deck.lift_word(&torus.layout, &torus.basis, &word)?;
//! assert!(lifted.end_error < 1e-9 && lifted.element.word == word);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::deck::DeckGroup;
use super::element::DeckElement;
use super::layout::Layout;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::topology::word::Word;
use crate::topology::{HomotopyBasis, check_vertex, crossed_halfedges};

/// The lift of a closed loop to the universal cover.
#[derive(Debug, Clone, PartialEq)]
pub struct LiftedLoop {
    /// The vertices of [`Layout::mesh`] along the loop, the first again at the end.
    pub vertices: Vec<VertexId>,
    /// The lift of each in ambient coordinates, from the layout on into its copies.
    pub points: Vec<[f64; 3]>,
    /// The deck transformation that carries the first point to the last.
    pub element: DeckElement,
    /// The distance between the last point and the image of the first under the isometry of the element's word, in ambient coordinates and
    /// over the size of the last point's.
    pub end_error: f64,
}

/// Largest distance of two side pairings that are one: those of different sides differ by at least the shortest closed geodesic.
const SAME_PAIRING: f64 = 1e-6;

impl DeckGroup {
    /// The lift, from the base point of this group on, of the loops of a homotopy basis that a word names, one after the other. The layout
    /// and the basis are those that the group was made of.
    ///
    /// # Errors
    /// [`Error::Argument`] for a letter that the basis does not have; those of [`Layout::lift`].
    pub fn lift_word(&self, layout: &Layout, basis: &HomotopyBasis, word: &Word) -> Result<LiftedLoop> {
        let mut path = Vec::new();
        for letter in word.letters() {
            let Some(around) = basis.loops.get(letter.index()) else {
                let value = format!("number {}", letter.index());
                return Err(Error::Argument { what: "generator", value, need: "one of the basis" });
            };
            if letter.is_inverse() {
                path.extend(around.iter().rev().map(|h| h.twin()));
            } else {
                path.extend_from_slice(around);
            }
        }
        self.lifted(layout, self.corner, &path, word.clone())
    }

    /// The lift of a closed loop through these vertices of the given surface, each joined to the next by an edge and the last to the first,
    /// which may also be named again at the end. It starts at a corner of the layout, which lies on the given triangulation or on the common
    /// subdivision of that and the metric's.
    ///
    /// # Errors
    /// [`Error::Argument`] for fewer than two vertices, a vertex that does not exist, and neighbours that no edge joins.
    pub fn lift_loop(&self, layout: &Layout, vertices: &[VertexId]) -> Result<LiftedLoop> {
        let mesh = layout.mesh();
        let closed = vertices.len() > 1 && vertices.first() == vertices.last();
        let around = &vertices[..vertices.len() - usize::from(closed)];
        if around.len() < 2 {
            return Err(Error::argument("loop to lift", format!("{} vertices", around.len()), "two or more"));
        }
        let mut path = Vec::new();
        for (k, &from) in around.iter().enumerate() {
            let to = around[(k + 1) % around.len()];
            check_vertex(mesh, from)?;
            check_vertex(mesh, to)?;
            path.extend(given_edge(layout, from, to).ok_or_else(|| {
                let value = format!("from vertex {from} to vertex {to}");
                let need =
                    "an edge of the surface between each vertex and the next, and from the last to the first";
                Error::Argument { what: "step of a loop to lift", value, need }
            })?);
        }
        let corner = mesh.outgoing(around[0]).find(|&h| !mesh.is_outside(h));
        let corner = corner.ok_or_else(|| Error::Layout(format!("vertex {} has no face", around[0])))?;
        let mut word = Word::identity();
        for h in crossed_halfedges(mesh, corner, &path)?.into_iter().filter(|&h| layout.side(h) != 0) {
            word = word.times(&self.pairing_word(&layout.neighbour(h))?);
        }
        self.lifted(layout, corner, &path, word)
    }

    /// The word of the side with this pairing.
    fn pairing_word(&self, pairing: &Motion<DoubleDouble>) -> Result<Word> {
        let off = |side: &&DeckElement| side.motion.inverse().compose(pairing).distance_from_identity();
        let nearest = self.sides.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let found = nearest.filter(|side| off(side) <= SAME_PAIRING);
        let none =
            || Error::Layout("the layout is not one of this deck group: no side has its pairing".into());
        found.map(|side| side.word.clone()).ok_or_else(none)
    }

    fn lifted(
        &self,
        layout: &Layout,
        corner: HalfedgeId,
        path: &[HalfedgeId],
        word: Word,
    ) -> Result<LiftedLoop> {
        let mesh = layout.mesh();
        let points = layout.lift(corner, path)?;
        let motion = self.motion(&word)?;
        let [first, last] = [points[0], points[points.len() - 1]];
        let image = motion.apply(precise_point(self.space, first)).map(f64::from);
        let norm = |p: [f64; 3]| p[0].hypot(p[1]).hypot(p[2]);
        let end_error = norm([0, 1, 2].map(|k| last[k] - image[k])) / norm(last);
        let vertices =
            std::iter::once(mesh.origin(corner)).chain(path.iter().map(|&h| mesh.tip(h))).collect();
        Ok(LiftedLoop { vertices, points, element: DeckElement { word, motion }, end_error })
    }
}

/// The half-edges of the layout's mesh along an edge of the given surface from one vertex to another.
fn given_edge(layout: &Layout, from: VertexId, to: VertexId) -> Option<Vec<HalfedgeId>> {
    let mesh = layout.mesh();
    let most = mesh.n_edges();
    let along = |first: HalfedgeId| -> Option<Vec<HalfedgeId>> {
        let given = layout.pieces.input_halfedge(first)?;
        let mut path = vec![first];
        while mesh.tip(path[path.len() - 1]) != to {
            let at = mesh.tip(path[path.len() - 1]);
            let next = onward(mesh, at, |h| layout.pieces.input_halfedge(h) == Some(given))?;
            if path.len() > most {
                return None;
            }
            path.push(next);
        }
        Some(path)
    };
    mesh.outgoing(from).find_map(along)
}

/// A half-edge at a vertex on the way.
fn onward(mesh: &Mesh, at: VertexId, is_along: impl Fn(HalfedgeId) -> bool) -> Option<HalfedgeId> {
    mesh.outgoing(at).find(|&h| is_along(h))
}

//! Lifts of edge paths to the universal cover.
//!
//! ```
//! use ricci::topology::homotopy_basis;
//! use ricci::{Control, mesh::shapes};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let basis = homotopy_basis(&mesh, &lengths, None, &Control::new())?;
//! let start = basis.tree_lift(basis.base);
//! let end = basis.lift(&mesh, &start, &basis.loops[0])?.last().unwrap();
//! assert_eq!((end.vertex, basis.group.text(&end.element)), (basis.base, "a1".into()));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::homotopy::HomotopyBasis;
use super::reduction::Reduction;
use super::word::Word;
use super::{check_path, check_vertex};
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Mesh, VertexId};

/// A vertex of the universal cover: the lift `γ ṽ` of the vertex v (see [`HomotopyBasis`]).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Lift {
    /// The vertex v below it.
    pub vertex: VertexId,
    /// The deck transformation γ that maps ṽ to it, reduced in the group. On a closed surface of genus ≥ 2 another word may be the same
    /// element: compare with [`super::SurfaceGroup::equal`].
    pub element: Word,
}
stored!(sections Lift { vertex, element });

/// The lifts along the lift of a path: its start, then the end of each of its edges. See [`HomotopyBasis::lift`].
pub struct LiftedPath<'a> {
    mesh: &'a Mesh,
    basis: &'a HomotopyBasis,
    reduction: Reduction,
    /// The vertex of the next item, and the edges from there on.
    at: Option<VertexId>,
    path: &'a [HalfedgeId],
}

impl HomotopyBasis {
    /// The lift of an edge path that starts at `start`, vertex by vertex. Steps cost O(g) and the length of
    /// the word.
    ///
    /// A loop's lift closes exactly if the loop is contractible; the lift from p̃ of a loop at the base ends
    /// at `γ p̃`, γ being the loop's element.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] for another mesh; [`Error::Argument`] for half-edges that form no path, or a path that does not start at the
    /// vertex below `start`.
    pub fn lift<'a>(
        &'a self,
        mesh: &'a Mesh,
        start: &Lift,
        path: &'a [HalfedgeId],
    ) -> Result<LiftedPath<'a>> {
        self.check_fits(mesh)?;
        check_path(mesh, path)?;
        check_vertex(mesh, start.vertex)?;
        if let Some(&h) = path.first().filter(|&&h| mesh.origin(h) != start.vertex) {
            let need = "its first half-edge must leave the vertex below the lift it starts at";
            return Err(Error::argument("path to lift", format!("a path from half-edge {h}"), need));
        }
        let mut reduction = Reduction::new(self.group);
        reduction.extend(start.element.letters().iter().copied());
        Ok(LiftedPath { mesh, basis: self, reduction, at: Some(start.vertex), path })
    }

    /// The lift ṽ at the end of the tree path to v.
    pub fn tree_lift(&self, v: VertexId) -> Lift {
        Lift { vertex: v, element: Word::identity() }
    }
}

impl Iterator for LiftedPath<'_> {
    type Item = Lift;

    fn next(&mut self) -> Option<Lift> {
        let lift = Lift { vertex: self.at?, element: self.reduction.word() };
        self.at = match self.path {
            [h, rest @ ..] => {
                self.basis.advance(self.mesh, &mut self.reduction, *h);
                self.path = rest;
                Some(self.mesh.tip(*h))
            }
            [] => None,
        };
        Some(lift)
    }
}

//! Closed 1-forms with integer values that are dual to the loops of a homotopy basis.
//!
//! ```
//! use ricci::harmonic::cohomology::{absolute, relative};
//! use ricci::{Control, mesh::shapes, topology::homotopy_basis};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let basis = homotopy_basis(&mesh, &lengths, None, &Control::new())?;
//! let classes = absolute(&mesh, &basis, &Control::new())?;
//! assert_eq!(classes.len(), 2);
//! assert_eq!(relative(&mesh, &basis, &Control::new())?.len(), 2); // no boundary: the same
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerVertex, VertexId};
use crate::topology::HomotopyBasis;

/// A 1-form with integer values: the edges e on which it is not 0, ascending, with its integrals over their half-edges 2e.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Cochain(pub Vec<(EdgeId, i32)>);
stored!(id Cochain);

/// Number of edges after which the control is asked again whether to stop.
const EDGES_PER_STEP: usize = 4096;

impl Cochain {
    /// The integral over a half-edge, in its direction.
    pub fn along(&self, h: HalfedgeId) -> i32 {
        let value = self.0.binary_search_by_key(&h.edge(), |&(e, _)| e).map_or(0, |k| self.0[k].1);
        if h.0 & 1 == 0 { value } else { -value }
    }

    /// The largest |value|.
    pub fn size(&self) -> i32 {
        self.0.iter().map(|(_, x)| x.abs()).max().unwrap_or(0)
    }

    /// The sum with the derivative of an integer function `u`, which is 0 outside the vertices of `support`.
    fn plus_exact(self, mesh: &Mesh, u: &PerVertex<i32>, support: &[VertexId]) -> Cochain {
        let mut values = self.0;
        let mut touched: Vec<EdgeId> =
            support.iter().flat_map(|&v| mesh.outgoing(v).map(HalfedgeId::edge)).collect();
        touched.sort_unstable();
        touched.dedup();
        values.extend(touched.into_iter().map(|e| {
            let [i, j] = mesh.ends(e).map(|v| u[v]);
            (e, j - i)
        }));
        values.sort_unstable_by_key(|&(e, _)| e);
        values.dedup_by(|next, kept| {
            let is_same_edge = next.0 == kept.0;
            kept.1 += if is_same_edge { next.1 } else { 0 };
            is_same_edge
        });
        values.retain(|&(_, x)| x != 0);
        Cochain(values)
    }
}

/// The closed forms dual to the loops a1, b1, …, ag, bg, c1, …, c(b−1), a basis of the cohomology of the surface: form k has the integral 1
/// over loop k and 0 over the other loops. Over the last boundary loop, which is homologous to minus the sum of the others, the forms of
/// boundary loops have the integral −1. The value on an edge is the exponent of its element in the abelianised fundamental group.
///
/// # Errors
/// [`crate::Error::Size`] for the basis of another mesh; [`crate::Error::Cancelled`].
pub fn absolute(mesh: &Mesh, basis: &HomotopyBasis, control: &Control) -> Result<Vec<Cochain>> {
    let group = &basis.group;
    let n = 2 * group.genus + group.boundaries.saturating_sub(1);
    check_size("base", usize::from(basis.base.index() < mesh.n_vertices()), 1)?;
    let mut classes = vec![Cochain::default(); n];
    let mut steps = 0;
    for e in mesh.edges() {
        control.check_every(EDGES_PER_STEP, &mut steps)?;
        let word = basis.halfedge_word(mesh, e.halfedge());
        if !word.is_empty() {
            for (class, exponent) in classes.iter_mut().zip(group.abelianisation(&word)) {
                if exponent != 0 {
                    class.0.push((e, exponent as i32));
                }
            }
        }
    }
    Ok(classes)
}

/// Closed forms that are 0 along the boundary, a basis of the cohomology of the surface relative to its boundary. The first 2g are dual to
/// the loops a1, b1, …, ag, bg and have the integral 0 over the arcs of the basis' tree from boundary loop to boundary loop. The other b −
/// 1 are dual to arcs from the last boundary loop to loop j and have the integral 0 over all loops: they are the derivatives of functions
/// that are 1 on boundary loop j and 0 elsewhere.
///
/// # Errors
/// As [`absolute`].
pub fn relative(mesh: &Mesh, basis: &HomotopyBasis, control: &Control) -> Result<Vec<Cochain>> {
    let mut classes = absolute(mesh, basis, control)?;
    let outside = |start: HalfedgeId| {
        let after = move |&h: &HalfedgeId| Some(mesh.next(h)).filter(|&next| next != start);
        std::iter::successors(Some(start), after)
    };
    let mut u = PerVertex::filled(mesh.n_vertices(), 0);
    let boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    for (k, class) in classes.iter_mut().enumerate() {
        control.check()?;
        let arc = k.checked_sub(2 * basis.group.genus);
        for (j, rim) in basis.rims.iter().enumerate() {
            // Minus the integral along the boundary, from the place where the tree reaches it.
            let mut sum = i32::from(arc == Some(j));
            for h in outside(rim.twin()) {
                u[mesh.origin(h)] = sum;
                sum -= if arc.is_none() { class.along(h) } else { 0 };
            }
        }
        let start = if arc.is_none() { std::mem::take(class) } else { Cochain::default() };
        *class = start.plus_exact(mesh, &u, &boundary);
    }
    Ok(classes)
}

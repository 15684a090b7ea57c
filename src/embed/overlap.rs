//! The share of a layout that lies on other parts of it.

use super::layout::Layout;
use crate::geometry::Space;
use crate::geometry::cover_share::covered_again;
use crate::mesh::HalfedgeId;

impl Layout {
    /// The share of the area of a layout in E² that is covered more than once ([`covered_again`]); `None` elsewhere. 0 for a layout that
    /// does not overlap itself, up to rounding where two sides of a cut lie on each other; it is found from the boundary of the opened
    /// surface, so faces that are [`Layout::flipped`] make it meaningless.
    pub fn overlap(&self) -> Option<f64> {
        let mesh = self.mesh();
        if self.space != Space::E2 {
            return None;
        }
        let is_open = |h: &HalfedgeId| mesh.is_outside(h.twin()) || self.cut.is_cut[h.edge()];
        let inside = mesh.halfedges().filter(|&h| !mesh.is_outside(h)).filter(is_open);
        let sides: Vec<_> = inside.map(|h| [self.uv(h), self.uv(mesh.next(h))]).collect();
        Some(covered_again(&sides))
    }
}

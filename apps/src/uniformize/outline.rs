//! The border of the opened surface: its sides in the layout, and the loops of the generators on the surface.

use super::quotient::Uniformized;
use ricci::Control;
use ricci::embed::cover::elements_reached;
use ricci::embed::{DeckElement, Layout};
use ricci::geometry::{DoubleDouble, Motion};
use ricci::mesh::{HalfedgeId, Mesh};
use ricci::topology::FundamentalDomain;

/// One side of the opened surface.
pub struct OutlineSide {
    /// The ambient points along it, both ends included, counterclockwise.
    pub points: Vec<[f64; 3]>,
    /// Sides with the same number are glued.
    pub pair: usize,
    /// The deck transformation onto the neighbour across it, in letters with spaces.
    pub word: String,
    /// True if it lies on the boundary of the surface, and has no neighbour.
    pub is_border: bool,
}

/// The sides of the opened surface, counterclockwise.
pub fn sides(u: &Uniformized) -> ricci::Result<Vec<OutlineSide>> {
    let whole = &u.layout;
    let mesh = whole.mesh();
    let domain = FundamentalDomain::new(mesh, &whole.cut.is_cut, &u.basis)?;
    let mut pair = vec![usize::MAX; domain.sides.len()];
    let mut n_pairs = 0;
    for k in 0..pair.len() {
        if pair[k] == usize::MAX {
            pair[k] = n_pairs;
            if let Some(partner) = domain.sides[k].partner {
                pair[partner] = n_pairs;
            }
            n_pairs += 1;
        }
    }
    let side = |(k, side): (usize, &ricci::topology::DomainSide)| OutlineSide {
        points: chain(mesh, whole, &side.halfedges),
        pair: pair[k],
        word: side.partner.map_or_else(String::new, |_| u.deck.group.text(&side.element)),
        is_border: side.partner.is_none(),
    };
    Ok(domain.sides.iter().enumerate().map(side).collect())
}

/// Distance below which corners of two copies are the same, relative to their distance from the base point: layouts agree to much less.
const SAME: f64 = 1e-6;

/// The deck elements whose copies of the opened surface, or of the Dirichlet domain, touch that itself, and the identity: those that
/// have a corner in common with it, which are reached over sides.
pub fn touching(u: &Uniformized, limit: usize, control: &Control) -> ricci::Result<Vec<DeckElement>> {
    let opened: Vec<[f64; 3]> = sides(u)?.iter().filter_map(|side| side.points.first().copied()).collect();
    let domain = u.domain().ok();
    let dirichlet = domain.map_or(&[][..], |domain| &domain.corners);
    // The third coordinate is 1 in the plane, where lengths are of the size of the surface.
    let scale = opened.iter().chain(dirichlet).map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    let meets = |g: &Motion<DoubleDouble>, corners: &[[f64; 3]]| {
        corners.iter().any(|p| {
            let p = g.apply(p.map(DoubleDouble::from)).map(f64::from);
            let same = |q: &[f64; 3]| (0..2).all(|k| (p[k] - q[k]).abs() <= SAME * scale.max(q[2]));
            corners.iter().any(same)
        })
    };
    let touches = |g: &Motion<DoubleDouble>| meets(g, &opened) || meets(g, dirichlet);
    let across: Vec<DeckElement> =
        u.deck.sides.iter().chain(domain.iter().flat_map(|d| d.neighbours())).cloned().collect();
    elements_reached(&u.deck, &across, touches, limit, control)
}

fn chain(mesh: &Mesh, whole: &Layout, halfedges: &[HalfedgeId]) -> Vec<[f64; 3]> {
    let last = halfedges.last().map(|&h| whole.corner(mesh.next(h)));
    halfedges.iter().map(|&h| whole.corner(h)).chain(last).collect()
}

/// The loops of the generators on the surface as it was given: edges of the common subdivision, with the loop's number.
pub fn loops_on_surface(u: &Uniformized) -> Vec<(u32, u32, usize)> {
    let subdivision = u.laid().ok().and_then(|laid| laid.common_subdivision());
    // The one loop around a disk is no generator.
    let Some(subdivision) = subdivision.filter(|_| !u.deck.sides.is_empty()) else { return Vec::new() };
    let mut of_edge = vec![None; u.layout.mesh().n_edges()];
    for (k, path) in u.basis.loops.iter().enumerate() {
        path.iter().for_each(|h| of_edge[h.edge().index()] = Some(k));
    }
    let (mesh, is_laid) = (&subdivision.mesh, u.layout.common_subdivision().is_some());
    let numbered = mesh.edges().filter_map(|e| {
        let laid = if is_laid { Some(e) } else { subdivision.edge(1, e) };
        let k = of_edge[laid?.index()]?;
        let [a, b] = mesh.ends(e);
        Some((a.0, b.0, k))
    });
    numbered.collect()
}

//! Fundamental domains: a surface opened along a cut, as a polygon whose sides are paired by deck transformations.
//!
//! ```
//! use ricci::topology::{FundamentalDomain, homotopy_basis};
//! use ricci::{Control, mesh::shapes};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let basis = homotopy_basis(&mesh, &lengths, None, &Control::new())?;
//! let domain = FundamentalDomain::new(&mesh, &basis.cut(&mesh), &basis)?;
//! let (side, partner) = (&domain.sides[0], domain.sides[0].partner.unwrap());
//! assert_eq!(side.element, domain.sides[partner].element.inverse());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::corner_walk::crossed_halfedges;
use super::cut::is_disk;
use super::homotopy::HomotopyBasis;
use super::lift::Lift;
use super::reduction::Reduction;
use super::word::Word;
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use std::collections::VecDeque;

/// A side of a fundamental domain.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DomainSide {
    /// Its half-edges in order, each of a face of the domain.
    pub halfedges: Vec<HalfedgeId>,
    /// The side with the same edges in the opposite direction; `None` on the boundary of the surface.
    pub partner: Option<usize>,
    /// The deck transformation that maps the partner to this side, and so the domain D to its neighbour across this side. The partner's
    /// is its inverse. Reduced; the identity on the boundary of the surface.
    pub element: Word,
}
stored!(sections DomainSide { halfedges, partner, element });

/// A surface opened into a disk D, lifted to the universal cover so that it has a corner at the base lift p̃.
#[derive(Debug, Clone)]
pub struct FundamentalDomain {
    /// The half-edge of a face whose origin, in D, is the base lift p̃.
    pub base_corner: HalfedgeId,
    /// The sides of D, counterclockwise: D lies on the left of their half-edges. They end where the cut branches, ends (at cones), or
    /// meets the boundary.
    pub sides: Vec<DomainSide>,
    /// `corners[k]`: the lift at which side k starts.
    pub corners: Vec<Lift>,
    side_of: PerHalfedge<Option<u32>>,
}
stored!(sections FundamentalDomain { base_corner, sides, corners, side_of });

impl FundamentalDomain {
    /// The domain of a cut that opens the surface into a disk, such as [`super::cut_graph`] and [`HomotopyBasis::cut`] make. Its elements
    /// are of the group of `basis`, which belongs to the same mesh.
    ///
    /// Of the lifts with a corner at p̃, D is the one with the same corner there as the polygon of the basis; for [`HomotopyBasis::cut`]
    /// D is that polygon. O(E + g · length of the cut).
    ///
    /// # Errors
    ///
    /// [`Error::Size`]; [`Error::Layout`] where the opened surface is not a disk.
    pub fn new(mesh: &Mesh, is_cut: &PerEdge<bool>, basis: &HomotopyBasis) -> Result<FundamentalDomain> {
        check_size("cut marks", is_cut.len(), mesh.n_edges())?;
        basis.check_fits(mesh)?;
        let wall = PerEdge::from_fn(mesh.n_edges(), |e| is_cut[e] || mesh.is_boundary_edge(e));
        let inner = PerEdge::from_fn(mesh.n_edges(), |e| is_cut[e] && !mesh.is_boundary_edge(e));
        if !is_disk(mesh, &inner) || !wall.contains(&true) {
            let message = "the cut does not open the surface into a disk: take one of `cut_graph`";
            return Err(Error::Layout(message.into()));
        }
        // Sides end at vertices that the cut does not just pass through.
        let is_node = |v: VertexId| {
            let degree = mesh.outgoing(v).filter(|h| inner[h.edge()]).count();
            degree > 0 && (degree != 2 || mesh.is_boundary_vertex(v))
        };
        let at_base = |h: &HalfedgeId| !mesh.is_outside(*h) && basis.corner_word(*h).is_empty();
        let ends = mesh.outgoing(basis.base).find(at_base).zip(first_side(mesh, &wall, is_node));
        let Some((base_corner, start)) = ends else {
            return Err(Error::Layout("the opened surface has no boundary".into()));
        };
        let mut reduction = Reduction::new(basis.group);
        path_within(mesh, &wall, base_corner, start)
            .into_iter()
            .for_each(|h| basis.advance(mesh, &mut reduction, h));
        let mut side_of = PerHalfedge::filled(mesh.n_halfedges(), None);
        let (mut chains, mut corners): (Vec<Vec<HalfedgeId>>, Vec<Lift>) = (Vec::new(), Vec::new());
        let mut h = start;
        loop {
            if h == start || is_node(mesh.origin(h)) {
                corners.push(Lift { vertex: mesh.origin(h), element: reduction.word() });
                chains.push(Vec::new());
            }
            side_of[h] = Some(chains.len() as u32 - 1);
            if let Some(chain) = chains.last_mut() {
                chain.push(h);
            }
            basis.advance(mesh, &mut reduction, h);
            h = next_side(mesh, &wall, h);
            if h == start {
                break;
            }
        }
        let n = chains.len();
        let pair = |(k, halfedges): (usize, Vec<HalfedgeId>)| {
            let partner = halfedges.last().and_then(|h| side_of[h.twin()]).map(|j| j as usize);
            // Side k starts at the end of its partner.
            let element = partner.map_or_else(Word::identity, |j| {
                let end = &corners[(j + 1) % n].element;
                basis.group.reduce(&corners[k].element.times(&end.inverse()))
            });
            DomainSide { halfedges, partner, element }
        };
        let sides = chains.into_iter().enumerate().map(pair).collect();
        Ok(FundamentalDomain { base_corner, sides, corners, side_of })
    }

    /// The sides through which an edge path leaves the copies of D that it visits, in order. The path starts at the corner of D at the
    /// origin of `corner` (a half-edge of a face); a closed path ends at the same corner of the copy `γ D`, where γ is the product of the
    /// crossed sides' elements, left to right. From `base_corner`, γ is the element of the loop. So the isometries of the side pairings
    /// of any layout of D, multiplied along the crossings of the loops of the basis, are the generators of its deck group.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for half-edges that form no path, or a path that does not start at that corner.
    pub fn crossings(&self, mesh: &Mesh, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<usize>> {
        let crossed = crossed_halfedges(mesh, corner, path)?;
        Ok(crossed.into_iter().filter_map(|h| self.side_of[h]).map(|k| k as usize).collect())
    }
}

/// The next wall after `h` around the opened surface.
fn next_side(mesh: &Mesh, wall: &PerEdge<bool>, h: HalfedgeId) -> HalfedgeId {
    let mut next = mesh.next(h);
    while !wall[next.edge()] {
        next = mesh.next(next.twin());
    }
    next
}

/// A half-edge of a face on a wall; it starts at a node if there is one.
fn first_side(mesh: &Mesh, wall: &PerEdge<bool>, is_node: impl Fn(VertexId) -> bool) -> Option<HalfedgeId> {
    let leaving = |v: VertexId| mesh.outgoing(v).find(|h| wall[h.edge()] && !mesh.is_outside(*h));
    mesh.vertices().filter(|&v| is_node(v)).chain(mesh.vertices()).find_map(leaving)
}

/// An edge path inside the opened surface from one of its corners to another, along the sides of a chain of faces.
fn path_within(mesh: &Mesh, wall: &PerEdge<bool>, from: HalfedgeId, to: HalfedgeId) -> Vec<HalfedgeId> {
    // For each face the half-edge that leads towards the face of `to`, by a search from that face.
    let mut exit = PerFace::filled(mesh.n_faces(), None);
    let goal = mesh.face(to);
    let mut waiting: VecDeque<_> = goal.into_iter().collect();
    while let Some(f) = waiting.pop_front() {
        for h in mesh.face_halfedges(f).into_iter().filter(|h| !wall[h.edge()]) {
            if let Some(g) = mesh.face(h.twin()).filter(|&g| Some(g) != goal && exit[g].is_none()) {
                exit[g] = Some(h.twin());
                waiting.push_back(g);
            }
        }
    }
    let (mut path, mut at) = (Vec::new(), from);
    loop {
        let leave = mesh.face(at).and_then(|f| exit[f]);
        while at != leave.unwrap_or(to) {
            path.push(at);
            at = mesh.next(at);
        }
        match leave {
            Some(h) => at = mesh.next(h.twin()),
            None => return path,
        }
    }
}

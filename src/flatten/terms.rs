//! The further terms of a descent together: their sum, the conditions among them, and the contacts of the border, which change on the way.

use super::options::{DistortionEnergy, FlattenOptions};
use super::rim::BorderRim;
use super::ring_distances::ring_distances;
use super::term::Term;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::norm;
use crate::metric::Surface;

/// The stiffness of conditions at first. Energies are means over a surface of area 1, so that their own is about 1.
const FIRST_STIFFNESS: f64 = 1.0;
/// The factor by which it grows where conditions come nearer by less than [`ENOUGH`], and the most that it becomes.
const STIFFER: f64 = 10.0;
const ENOUGH: f64 = 0.1;
const MOST_STIFFNESS: f64 = 1e6;
/// The distance at which sides of the border begin to feel each other, in mean lengths of the border's edges on the surface.
const REACH: f64 = 0.25;
/// The weight of a contact, in the mean weight of a triangle.
const CONTACT_WEIGHT: f64 = 0.1;

/// The further terms of an energy.
pub(super) struct Terms {
    /// Lengths, then conditions, then the contacts of the points that were looked at last.
    list: Vec<Term>,
    n_lengths: usize,
    n_standing: usize,
    stiffness: f64,
    /// The border, where the map is to be one to one.
    border: Option<Border>,
}

struct Border {
    rim: BorderRim,
    reach: f64,
    weight: f64,
}

impl Border {
    fn contacts(&self, points: &[[f64; 2]]) -> impl Iterator<Item = Term> + use<> {
        let (reach, weight) = (self.reach, self.weight);
        let near = self.rim.near(points, reach).into_iter();
        near.map(move |corners| Term::Contact { corners, reach, weight })
    }
}

impl Terms {
    /// The terms of the options; `unit` is the length on the surface that is 1 in the descent.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn new(surface: &Surface, options: &FlattenOptions, unit: f64, control: &Control) -> Result<Terms> {
        let mut list = Vec::new();
        if options.energy == DistortionEnergy::Distance {
            let pairs = ring_distances(surface, options.rings, control)?;
            let weight = (1.0 - options.conformal_share()) / pairs.len() as f64;
            list.extend(pairs.iter().map(|pair| Term::Length {
                ends: pair.ends,
                length: pair.length / unit,
                weight,
            }));
        }
        let n_lengths = list.len();
        list.extend(options.pins.iter().map(|&(v, at)| Term::Pin {
            vertex: v.0,
            at: at.map(|x| x / unit),
            multiplier: [0.0; 2],
        }));
        for piece in &options.straight {
            let length = length_of(surface, piece, unit);
            let ends = [piece[0].0, piece[piece.len() - 1].0];
            list.extend(piece[1..piece.len() - 1].iter().map(|v| Term::Straight {
                corners: [v.0, ends[0], ends[1]],
                length,
                multiplier: 0.0,
            }));
        }
        let n_standing = list.len();
        let border = options.injective.then(|| border_of(surface, unit));
        Ok(Terms { list, n_lengths, n_standing, stiffness: FIRST_STIFFNESS, border })
    }

    /// The terms at the points that were looked at last.
    pub fn list(&self) -> &[Term] {
        &self.list
    }

    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn conditions(&self) -> &[Term] {
        &self.list[self.n_lengths..self.n_standing]
    }

    pub fn has_conditions(&self) -> bool {
        self.n_standing > self.n_lengths
    }

    /// The pairs of vertices that a standing term joins.
    pub fn standing_pairs(&self) -> Vec<[u32; 2]> {
        self.list[..self.n_standing].iter().flat_map(pairs_of).collect()
    }

    /// The pairs of vertices that a contact joins.
    pub fn contact_pairs(&self) -> Vec<[u32; 2]> {
        self.list[self.n_standing..].iter().flat_map(pairs_of).collect()
    }

    /// The sum without the conditions.
    pub fn energy(&self, points: &[[f64; 2]]) -> f64 {
        let lengths: f64 = self.list[..self.n_lengths].iter().map(|term| term.value(points, 0.0)).sum();
        let near = self.border.iter().flat_map(|border| border.contacts(points));
        lengths + near.map(|term| term.value(points, 0.0)).sum::<f64>()
    }

    /// The sum of the conditions.
    pub fn conditions_value(&self, points: &[[f64; 2]]) -> f64 {
        self.conditions().iter().map(|term| term.value(points, self.stiffness)).sum()
    }

    /// Looks for the contacts at these points.
    pub fn find_contacts(&mut self, points: &[[f64; 2]]) {
        self.list.truncate(self.n_standing);
        if let Some(border) = &self.border {
            self.list.extend(border.contacts(points));
        }
    }

    /// The time until the border meets itself along a direction, if that is before `until`.
    pub fn time_to_meet(&self, points: &[[f64; 2]], direction: &[[f64; 2]], until: f64) -> f64 {
        let meet = |border: &Border| border.rim.time_to_meet(points, direction, until);
        self.border.as_ref().map_or(f64::INFINITY, meet)
    }

    /// False where the border crosses itself and is not to.
    pub fn allow(&self, points: &[[f64; 2]]) -> bool {
        self.border.as_ref().is_none_or(|border| !border.rim.crosses(points))
    }

    /// By how much the worst condition is missed, in the unit of the descent.
    pub fn misfit(&self, points: &[[f64; 2]]) -> f64 {
        self.conditions().iter().map(|term| norm(term.residual(points))).fold(0.0, f64::max)
    }

    /// Raises the multipliers after a descent, and the stiffness where the misfit was not much less than `before`.
    pub fn raise(&mut self, points: &[[f64; 2]], before: f64) {
        let (misfit, stiffness) = (self.misfit(points), self.stiffness);
        self.list[self.n_lengths..self.n_standing].iter_mut().for_each(|term| term.raise(points, stiffness));
        if misfit > ENOUGH * before {
            self.stiffness = (STIFFER * stiffness).min(MOST_STIFFNESS);
        }
    }
}

fn pairs_of(term: &Term) -> [[u32; 2]; 3] {
    let [a, b, c] = term.corners();
    [[a, b], [b, c], [c, a]]
}

/// The length of the shortest way along edges between the ends of a run, where its vertices are neighbours; else the unit.
fn length_of(surface: &Surface, piece: &[crate::mesh::VertexId], unit: f64) -> f64 {
    let mesh = surface.mesh();
    let side = |pair: &[crate::mesh::VertexId]| {
        mesh.outgoing(pair[0]).find(|&h| mesh.tip(h) == pair[1]).map(|h| surface.lengths()[h.edge()])
    };
    let sides: Option<Vec<f64>> = piece.windows(2).map(side).collect();
    sides.map_or(1.0, |sides| sides.into_iter().sum::<f64>() / unit)
}

fn border_of(surface: &Surface, unit: f64) -> Border {
    let mesh = surface.mesh();
    let rim = BorderRim::new(mesh);
    let whole: f64 = mesh.edges().filter(|&e| mesh.is_boundary_edge(e)).map(|e| surface.lengths()[e]).sum();
    let reach = REACH * whole / (unit * rim.n_sides() as f64);
    Border { rim, reach, weight: CONTACT_WEIGHT / mesh.n_faces() as f64 }
}

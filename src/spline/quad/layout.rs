//! Layouts of four-sided patches: how their sides meet, and the fans of patches around their nodes.

use crate::archive::{invalid, stored};
use crate::error::{Error, Result, check_size};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Angles of fans between creases that differ from π by less than this are taken for π: a smooth crease or border, as coarse quads show it.
const NEARLY_STRAIGHT: f64 = 0.35;
/// Angles between arcs that differ from a right one by less than this, radians, are right ones.
const RIGHT_ANGLE: f64 = 1e-9;

/// An arc between two nodes of a layout: a side of one patch or of two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchArc {
    /// The nodes at its start and its end.
    pub ends: [u32; 2],
    /// Its length in parameters, in any unit: opposite sides of a patch have the same.
    pub length: f64,
    /// True if the surface may have an edge there: its normal may jump.
    pub is_crease: bool,
}
stored!(row PatchArc { ends: [u32; 2], length: f64, is_crease: bool });

/// A side of a patch of a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArcSide {
    /// The number of its arc.
    pub arc: u32,
    /// True if the arc runs against the way around the patch.
    pub reversed: bool,
}
stored!(row ArcSide { arc: u32, reversed: bool });

/// A corner of a patch: corner k lies at the start of side k.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PatchCorner {
    /// The patch.
    pub patch: usize,
    /// The number of the corner, and of the side that starts there, along the way around (0, 0), (1, 0), (1, 1), (0, 1).
    pub corner: usize,
}
stored!(row PatchCorner { patch: usize, corner: usize });

/// The patches around a node between two creases or sides of the border, or all around it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeFan {
    /// Its corners, counterclockwise.
    pub corners: Vec<PatchCorner>,
    /// True if the fan goes all the way around.
    pub is_closed: bool,
}

/// The way in which an arc leaves a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ArcEnd {
    /// Neighbouring arcs do not lie at right angles: 2 cos of the angle between them.
    Irregular(f64),
    /// The node lies inside the surface and has four arcs.
    Regular,
    /// The arc leaves a smooth crease or border at a right angle.
    Across,
}

/// Four-sided patches that meet along whole sides.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchLayout {
    n_nodes: usize,
    arcs: Vec<PatchArc>,
    patches: Vec<[ArcSide; 4]>,
    /// For each arc the side to its left, and that to its right.
    beside: Vec<[Option<PatchCorner>; 2]>,
    /// For each corner of each patch the angle between neighbouring arcs in the fan around it.
    sectors: Vec<[f64; 4]>,
}
stored!(sections PatchLayout { n_nodes, arcs, patches, beside, sectors } check PatchLayout::check_parts);

impl PatchLayout {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let (arcs, patches) = (self.arcs.clone(), self.patches.clone());
        let again = PatchLayout::new(self.n_nodes, arcs, patches)?;
        check_size("corners", self.sectors.len(), again.sectors.len())?;
        if again.beside == self.beside {
            Ok(())
        } else {
            Err(invalid("patches beside arcs", "those with the arcs as sides"))
        }
    }

    /// True if every arc is a side of two patches: the surface has no boundary.
    pub fn is_closed(&self) -> bool {
        self.beside.iter().all(|sides| !sides.contains(&None))
    }

    /// The layout whose patches are the faces of a mesh of quadrilaterals, counterclockwise, all of the same lengths. `creases`: pairs of nodes that a side joins.
    ///
    /// # Errors
    /// [`Error::Spline`] for a pair that no side joins; those of [`PatchLayout::new`].
    pub fn from_quads(n_nodes: usize, quads: &[[u32; 4]], creases: &[[u32; 2]]) -> Result<PatchLayout> {
        let mut numbers: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let (mut arcs, mut patches) = (Vec::new(), Vec::with_capacity(quads.len()));
        for quad in quads {
            patches.push([0, 1, 2, 3].map(|k| {
                let ends = [quad[k], quad[(k + 1) % 4]];
                let arc = *numbers.entry(ascending(ends)).or_insert_with(|| {
                    arcs.push(PatchArc { ends, length: 1.0, is_crease: false });
                    arcs.len() as u32 - 1
                });
                ArcSide { arc, reversed: arcs[arc as usize].ends != ends }
            }));
        }
        for (index, &pair) in creases.iter().enumerate() {
            let Some(&arc) = numbers.get(&ascending(pair)) else {
                let message = format!("no side joins the nodes {} and {}", pair[0], pair[1]);
                return Err(Error::Spline { what: "crease", index, message });
            };
            arcs[arc as usize].is_crease = true;
        }
        PatchLayout::new(n_nodes, arcs, patches)
    }

    /// The layout of these patches, the sides of each along the way around.
    ///
    /// # Errors
    /// [`Error::Spline`] for numbers that do not exist, sides that do not follow each other, lengths that are not positive or differ on
    /// opposite sides of a patch, an arc with two patches on one side or with none, and a fan of one or two patches all around a node, over which a normal cannot be continuous.
    pub fn new(n_nodes: usize, arcs: Vec<PatchArc>, patches: Vec<[ArcSide; 4]>) -> Result<PatchLayout> {
        let refuse = |what, index, message: &str| Err(Error::Spline { what, index, message: message.into() });
        if let Some(at) = arcs.iter().position(|arc| arc.ends.iter().any(|&n| n as usize >= n_nodes)) {
            return refuse("arc", at, "a node at its ends does not exist");
        }
        if let Some(at) = arcs.iter().position(|arc| !(arc.length > 0.0 && arc.length.is_finite())) {
            return refuse("arc", at, "its length is no positive number");
        }
        let mut beside = vec![[None; 2]; arcs.len()];
        for (patch, sides) in patches.iter().enumerate() {
            for (corner, side) in sides.iter().enumerate() {
                let Some(places) = beside.get_mut(side.arc as usize) else {
                    return refuse("patch", patch, "an arc of its sides does not exist");
                };
                if places[usize::from(side.reversed)].replace(PatchCorner { patch, corner }).is_some() {
                    return refuse("arc", side.arc as usize, "two patches lie on the same side of it");
                }
            }
        }
        if let Some(at) = beside.iter().position(|sides| *sides == [None; 2]) {
            return refuse("arc", at, "no patch has it as a side");
        }
        let sectors = vec![[FRAC_PI_2; 4]; patches.len()];
        let mut layout = PatchLayout { n_nodes, arcs, patches, beside, sectors };
        layout.check_fans()?;
        layout.sectors = layout.divided_fans(|_| PI);
        Ok(layout)
    }

    /// The same layout for a surface on which the patches have these angles at their corners, radians. Fans between creases or sides of the border
    /// have the sum of their angles, or π where it is near to that; without angles all have π. Two fans between the same two creases have one
    /// angle, or that and its rest to 2π: tangents of creases that are opposite in one of them are opposite in the other.
    pub fn with_angles(mut self, angles: &[[f64; 4]]) -> PatchLayout {
        let corner = |at: &PatchCorner| angles.get(at.patch).map_or(FRAC_PI_2, |all| all[at.corner]);
        let sum = |fan: &[PatchCorner]| fan.iter().map(corner).sum::<f64>().min(TAU);
        let of_fan = |fan: &[PatchCorner]| {
            let own = sum(fan);
            let least = |angle: f64| angle.min(TAU - angle);
            let beyond = self.fan_beyond(fan).map_or(own, |other| sum(&other));
            let between = 0.5 * (least(own) + least(beyond));
            match own {
                _ if PI - between < NEARLY_STRAIGHT => PI,
                _ if own > PI => TAU - between,
                _ => between,
            }
        };
        self.sectors = self.divided_fans(of_fan);
        self
    }

    /// The other fan between the two creases that bound one, if these are all at its node.
    fn fan_beyond(&self, fan: &[PatchCorner]) -> Option<Vec<PatchCorner>> {
        let (first, last) = (fan[0], fan[fan.len() - 1]);
        let after = self.neighbour(first)?;
        let other = self.fan(PatchCorner { corner: (after.corner + 1) % 4, ..after }).corners;
        let before = PatchCorner { corner: (last.corner + 3) % 4, ..last };
        (self.neighbour(before) == Some(other[0])).then_some(other)
    }

    /// Per corner the angle of its fan, divided by the number of its patches. A fan all around a node has 2π, also where a crease ends there;
    /// `between`: that of one between two creases or sides of the border.
    fn divided_fans(&self, between: impl Fn(&[PatchCorner]) -> f64) -> Vec<[f64; 4]> {
        let mut sectors = self.sectors.clone();
        for at in self.corners() {
            let NodeFan { corners, is_closed } = self.fan(at);
            if !is_closed && corners[0] != at {
                continue;
            }
            let last = corners[corners.len() - 1];
            let before = self.patches[last.patch][(last.corner + 3) % 4];
            let after = self.patches[at.patch][at.corner];
            let ends_there = before.arc == after.arc && before.reversed != after.reversed;
            let angle = if is_closed || ends_there { TAU } else { between(&corners) };
            corners.iter().for_each(|on| sectors[on.patch][on.corner] = angle / corners.len() as f64);
        }
        sectors
    }

    fn check_fans(&self) -> Result<()> {
        for corner in self.corners() {
            let side = self.patches[corner.patch][corner.corner];
            let end = self.arcs[side.arc as usize].ends[usize::from(!side.reversed)];
            let next = PatchCorner { corner: (corner.corner + 1) % 4, ..corner };
            if end != self.node(next) {
                let message = "its sides do not follow each other".into();
                return Err(Error::Spline { what: "patch", index: corner.patch, message });
            }
            if self.length(corner) != self.length(PatchCorner { corner: (corner.corner + 2) % 4, ..corner }) {
                let message = "opposite sides of it have different lengths".into();
                return Err(Error::Spline { what: "patch", index: corner.patch, message });
            }
            let fan = self.fan(corner);
            if fan.is_closed && fan.corners.len() < 3 {
                let message = "one or two patches lie around it; three are needed".into();
                return Err(Error::Spline { what: "node", index: self.node(corner) as usize, message });
            }
        }
        Ok(())
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// The arcs.
    pub fn arcs(&self) -> &[PatchArc] {
        &self.arcs
    }

    /// The sides of the patches, along the way around (0, 0), (1, 0), (1, 1), (0, 1).
    pub fn patches(&self) -> &[[ArcSide; 4]] {
        &self.patches
    }

    /// The side of a patch to the left of an arc, and that to its right, each where there is one.
    pub fn beside(&self, arc: usize) -> [Option<PatchCorner>; 2] {
        self.beside[arc]
    }

    /// All corners.
    pub fn corners(&self) -> impl Iterator<Item = PatchCorner> + use<> {
        let n = self.patches.len();
        (0..n).flat_map(|patch| (0..4).map(move |corner| PatchCorner { patch, corner }))
    }

    /// The node at a corner.
    pub fn node(&self, at: PatchCorner) -> u32 {
        let side = self.patches[at.patch][at.corner];
        self.arcs[side.arc as usize].ends[usize::from(side.reversed)]
    }

    /// The length in parameters of the side that starts at a corner.
    pub(super) fn length(&self, at: PatchCorner) -> f64 {
        self.arcs[self.patches[at.patch][at.corner].arc as usize].length
    }

    /// The length in parameters of a patch across the side that starts at a corner.
    pub(super) fn depth(&self, at: PatchCorner) -> f64 {
        self.length(PatchCorner { corner: (at.corner + 1) % 4, ..at })
    }

    /// The side on the other side of one's arc; none at the border.
    fn neighbour(&self, at: PatchCorner) -> Option<PatchCorner> {
        let side = self.patches[at.patch][at.corner];
        self.beside[side.arc as usize][usize::from(!side.reversed)]
    }

    /// The side on the other side of one's arc; none at creases and the border.
    pub(super) fn smooth_neighbour(&self, at: PatchCorner) -> Option<PatchCorner> {
        let side = self.patches[at.patch][at.corner];
        self.neighbour(at).filter(|_| !self.arcs[side.arc as usize].is_crease)
    }

    /// The corner after one around its node, counterclockwise.
    fn next(&self, at: PatchCorner) -> Option<PatchCorner> {
        self.smooth_neighbour(PatchCorner { corner: (at.corner + 3) % 4, ..at })
    }

    /// The corner before one around its node.
    fn previous(&self, at: PatchCorner) -> Option<PatchCorner> {
        let beside = self.smooth_neighbour(at)?;
        Some(PatchCorner { corner: (beside.corner + 1) % 4, ..beside })
    }

    /// The fan that a corner belongs to. A closed one begins with that corner.
    pub(super) fn fan(&self, at: PatchCorner) -> NodeFan {
        let mut first = at;
        let mut is_closed = false;
        while let Some(before) = self.previous(first) {
            if before == at {
                (first, is_closed) = (at, true);
                break;
            }
            first = before;
        }
        let mut corners = vec![first];
        let mut last = first;
        while let Some(next) = self.next(last).filter(|&next| next != first) {
            corners.push(next);
            last = next;
        }
        NodeFan { corners, is_closed }
    }

    /// The way in which the arc of a side leaves the node at its start.
    pub(super) fn start_of(&self, at: PatchCorner) -> ArcEnd {
        let NodeFan { corners, is_closed } = self.fan(at);
        let sector = self.sectors[at.patch][at.corner];
        match is_closed {
            true if corners.len() == 4 => ArcEnd::Regular,
            false if (sector - FRAC_PI_2).abs() < RIGHT_ANGLE => ArcEnd::Across,
            _ => ArcEnd::Irregular(2.0 * sector.cos()),
        }
    }
}

/// Two numbers, the smaller one first.
pub(super) fn ascending([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

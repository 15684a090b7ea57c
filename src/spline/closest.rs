//! The nearest points of a spline surface to points in space.
//!
//! The surface is cut into cells: triangles of its patches, and of the disks around singular vertices, which have coordinates of their
//! own. Cells are divided until they are nearly flat, and lie in boxes that are wider than their corners by a multiple of what they
//! deviate from flat. In each cell whose box is nearer to a point than what has been found so far, the nearest point is looked for by a
//! descent.

use super::descent::{Reached, descend, is_convex};
use super::hole::Hole;
use super::patch::Parameter;
use super::point::SurfacePoint;
use super::recurrence::Scratch;
use super::surface::{LARGEST, Spline, in_batches};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{BoundsNode, BoundsTree};
use crate::geometry::complex::{Complex, add, scale};
use crate::geometry::vector::{self, Vector, distance};
use std::f64::consts::TAU;

/// How often a patch is halved: at least so that no bend is overlooked, at most so that a wild surface has not too many cells.
const HALVINGS: [usize; 2] = [2, 5];
/// A cell is flat where it deviates from its corners' plane piece by less than this share of its longest side.
const FLAT: f64 = 0.04;
/// Boxes are wider than the corners of their cells by this multiple of the deviations that were measured at the middles of the cell and its
/// sides. Of a surface of degree 2 the largest deviation is at most 4/3 of these.
const MARGIN: f64 = 3.0;
/// Sides of the regular polygon around the middle of a hole, where its filling is the surface: it is cut into so many pieces.
const SIDES: usize = 12;
/// Boxes are widened by this share of the control points' largest coordinate: rounding.
const SLACK: f64 = 1e-12;
/// Pieces that are cut, and points that are looked at, between two looks at whether the caller has cancelled.
const BATCH: usize = 1 << 12;

/// The nearest point of a surface to a point in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPoint {
    /// Its place.
    pub place: Parameter,
    /// The point of the surface.
    pub point: Vector,
    /// How far it is from the point in space.
    pub distance: f64,
    /// Cells that could not be excluded.
    pub cells: u32,
    /// Steps of Newton's method in all of them.
    pub steps: u32,
}

/// A triangle with coordinates of its own.
#[derive(Debug, Clone, Copy)]
enum Piece {
    Patch(u32),
    /// One of the triangles around the middle of a hole, in the coordinates w/ρ.
    Middle {
        hole: usize,
        side: usize,
    },
}

/// A small triangle of a piece.
#[derive(Debug, Clone, Copy)]
struct Cell {
    piece: Piece,
    corners: [Complex; 3],
}

/// Finds nearest points of one surface. See [`Spline::closest_points`].
#[derive(Clone)]
pub struct ClosestPoints<'a> {
    spline: &'a Spline,
    cells: Vec<Cell>,
    /// Around the cells.
    boxes: BoundsTree,
}

impl Spline {
    /// What finds nearest points of the surface, with the fillings of its holes.
    ///
    /// # Errors
    /// [`Error::Argument`] for a spline without patches; [`Error::Cancelled`].
    pub fn closest_points(&self, threads: usize, control: &Control) -> Result<ClosestPoints<'_>> {
        if self.space().patches().is_empty() {
            return Err(Error::argument("patches", 0, "1 or more"));
        }
        let largest = self.control_points().iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let patches = (0..self.space().patches().len()).map(|patch| Piece::Patch(patch as u32));
        let middle = |hole| (0..SIDES).map(move |side| Piece::Middle { hole, side });
        let pieces: Vec<Piece> = patches
            .chain((0..self.holes().len()).filter(|&hole| self.holes()[hole].fill.is_some()).flat_map(middle))
            .collect();
        let cut = in_batches((&pieces, BATCH), threads, control, |scratch, &piece| {
            let mut cutting = Cutting { spline: self, piece, scratch, cells: Vec::new(), boxes: Vec::new() };
            let corners = self.corners_of(piece);
            let points = cutting.points(corners)?;
            cutting.cut(corners, points, 0)?;
            Ok((cutting.cells, cutting.boxes))
        })?;
        let (mut cells, mut boxes) = (Vec::new(), Vec::new());
        for (some, of) in cut {
            cells.extend(some);
            boxes.extend(of.into_iter().map(|bounds| bounds.widened(SLACK * largest)));
        }
        Ok(ClosestPoints { spline: self, cells, boxes: BoundsTree::new(&boxes) })
    }

    /// The corners of a piece in its own coordinates, counterclockwise.
    fn corners_of(&self, piece: Piece) -> [Complex; 3] {
        match piece {
            Piece::Patch(patch) => self.space().patches()[patch as usize].corners(),
            Piece::Middle { hole, side } => {
                let turn = TAU / SIDES as f64;
                let radius = self.holes()[hole].inner / (0.5 * turn).cos();
                let corner = |k: usize| scale(radius, [(k as f64 * turn).cos(), (k as f64 * turn).sin()]);
                [[0.0; 2], corner(side), corner(side + 1)]
            }
        }
    }

    /// The surface at coordinates of a piece; of the middle of a hole its filling.
    fn on_piece(
        &self,
        piece: Piece,
        [x, y]: Complex,
        order: usize,
        scratch: &mut Scratch,
    ) -> Result<SurfacePoint> {
        match piece {
            Piece::Patch(patch) => self.at(Parameter { patch, x, y }, order, scratch),
            Piece::Middle { hole, .. } => {
                let message = "nothing fills it".into();
                let empty = || Error::Spline { what: "hole", index: hole, message };
                self.holes()[hole].filling([x, y]).ok_or_else(empty)
            }
        }
    }

    /// None where a hole reaches beyond its patches.
    fn place_on(&self, piece: Piece, [x, y]: Complex) -> Option<Parameter> {
        match piece {
            Piece::Patch(patch) => Some(Parameter { patch, x, y }),
            Piece::Middle { hole, .. } => self.holes()[hole].place_of(self.space(), [x, y]),
        }
    }
}

/// A piece that is being cut into cells.
struct Cutting<'a> {
    spline: &'a Spline,
    piece: Piece,
    scratch: &'a mut Scratch,
    cells: Vec<Cell>,
    boxes: Vec<Bounds>,
}

impl Cutting<'_> {
    fn points(&mut self, places: [Complex; 3]) -> Result<[Vector; 3]> {
        let mut points = [[0.0; 3]; 3];
        for (point, at) in points.iter_mut().zip(places) {
            *point = self.spline.on_piece(self.piece, at, 0, self.scratch)?.point;
        }
        Ok(points)
    }

    /// Add a triangle as a cell, or the four into which the middles of its sides divide it.
    fn cut(&mut self, corners: [Complex; 3], points: [Vector; 3], halvings: usize) -> Result<()> {
        let spline = self.spline;
        if let Piece::Patch(patch) = self.piece {
            let is_in =
                |hole: &Hole, [x, y]: Complex| hole.fill.is_some() && hole.is_core(Parameter { patch, x, y });
            if spline.holes().iter().any(|hole| corners.iter().all(|&corner| is_in(hole, corner))) {
                return Ok(());
            }
        }
        let middles = [0, 1, 2].map(|k| scale(0.5, add(corners[(k + 1) % 3], corners[(k + 2) % 3])));
        let between = self.points(middles)?;
        let centre = scale(1.0 / 3.0, add(corners[0], add(corners[1], corners[2])));
        let [inside, ..] = self.points([centre; 3])?;
        let flat = |k: usize| vector::lerp(points[(k + 1) % 3], points[(k + 2) % 3], 0.5);
        let mean = vector::scale(1.0 / 3.0, vector::add(points[0], vector::add(points[1], points[2])));
        let off = (0..3).map(|k| distance(between[k], flat(k))).fold(distance(inside, mean), f64::max);
        let longest = (0..3).map(|k| distance(points[k], points[(k + 1) % 3])).fold(0.0, f64::max);
        let [least, most] = HALVINGS;
        if halvings == most || halvings >= least && off <= FLAT * longest {
            let all = points.into_iter().chain(between).chain([inside]);
            self.cells.push(Cell { piece: self.piece, corners });
            self.boxes.push(Bounds::of(all).widened(MARGIN * off));
            return Ok(());
        }
        for k in 0..3 {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            self.cut(
                [corners[k], middles[j], middles[i]],
                [points[k], between[j], between[i]],
                halvings + 1,
            )?;
        }
        self.cut(middles, between, halvings + 1)
    }
}

impl ClosestPoints<'_> {
    /// For each point the nearest one of the surface, of several the first that is found; in parallel.
    ///
    /// # Errors
    /// [`Error::Argument`] for a point with a coordinate that is not finite, or above 1e150 in size; [`Error::Cancelled`].
    pub fn find(&self, points: &[Vector], threads: usize, control: &Control) -> Result<Vec<ClosestPoint>> {
        let is_good = |p: &Vector| p.iter().all(|x| x.abs() <= LARGEST);
        if let Some(at) = points.iter().position(|p| !is_good(p)) {
            return Err(Error::argument("point", at, "one with finite coordinates, of size 1e150 at most"));
        }
        in_batches((points, BATCH), threads, control, |scratch, &point| self.nearest(point, scratch))
    }

    fn nearest(&self, target: Vector, scratch: &mut Scratch) -> Result<ClosestPoint> {
        let far = |node: usize| self.boxes.distance(node, target);
        let (mut best, mut cells, mut steps) = (None, 0, 0);
        let mut open = vec![(far(0), 0)];
        while let Some((least, node)) = open.pop() {
            if best.is_some_and(|(_, Reached { distance, .. })| least >= distance) {
                continue;
            }
            let found = match self.boxes.node(node) {
                BoundsNode::Inner(children) => {
                    let mut children = children.map(|child| (far(child), child));
                    children.sort_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(children);
                    continue;
                }
                BoundsNode::Leaf(found) => found,
            };
            for &cell in found {
                let cell = &self.cells[cell as usize];
                let reached = self.descent(cell, target, scratch)?;
                (cells, steps) = (cells + 1, steps + reached.steps);
                if best.is_none_or(|(_, best): (_, Reached)| reached.distance < best.distance) {
                    best = Some((cell.piece, reached));
                }
            }
        }
        let place = best.and_then(|(piece, Reached { at, .. })| self.spline.place_on(piece, at));
        let Some(place) = place else {
            return Err(Error::argument("point", format!("{target:?}"), "at a finite distance"));
        };
        let point = self.spline.at(place, 0, scratch)?.point;
        Ok(ClosestPoint { place, point, distance: distance(point, target), cells, steps })
    }

    /// The nearest point of a cell: from its nearest corner where the squared distance is convex at all of them, else from each.
    fn descent(&self, cell: &Cell, target: Vector, scratch: &mut Scratch) -> Result<Reached> {
        let &Cell { piece, corners } = cell;
        let mut starts = Vec::with_capacity(3);
        for at in corners {
            starts.push((at, self.spline.on_piece(piece, at, 2, scratch)?));
        }
        starts.sort_by(|a, b| distance(a.1.point, target).total_cmp(&distance(b.1.point, target)));
        if starts.iter().all(|(_, point)| is_convex(point, target)) {
            starts.truncate(1);
        }
        let mut best = Reached { at: corners[0], distance: f64::INFINITY, steps: 0 };
        for start in starts {
            let surface = |at| self.spline.on_piece(piece, at, 2, scratch);
            let mut reached = descend(corners, start, target, surface)?;
            if let Piece::Middle { .. } = piece {
                // Corners of the polygon lie where the filling goes over into the spline.
                reached.distance = match self.spline.place_on(piece, reached.at) {
                    Some(place) => distance(self.spline.at(place, 0, scratch)?.point, target),
                    None => f64::INFINITY,
                };
            }
            reached.steps += best.steps;
            best = if reached.distance < best.distance {
                reached
            } else {
                Reached { steps: reached.steps, ..best }
            };
        }
        Ok(best)
    }
}

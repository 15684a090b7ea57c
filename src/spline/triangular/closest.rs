//! The nearest points of a spline surface to points in space.
//!
//! The surface is divided into cells: small triangles of its patches, and of the disks around singular vertices, which have coordinates of
//! their own. Cells are halved until they are nearly flat. Each has a box around its corners, widened by a multiple of its deviation from
//! flatness. For a point, cells are visited by the distance of their boxes, and [`super::descent`] finds the nearest point of each cell
//! whose box is nearer than the best point so far.

use super::descent::{DescentEnd, descend, is_convex};
use super::hole::Hole;
use super::patch::Parameter;
use super::point::SurfacePoint;
use super::recurrence::Scratch;
use super::surface::{LARGEST, Spline, in_batches_along};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{BoundsNode, BoundsTree};
use crate::geometry::complex::{Complex, add, scale};
use crate::geometry::vector::{self, Vector, distance};
use crate::geometry::z_order::z_order;
use crate::spline::batches::in_batches;
use std::f64::consts::TAU;

/// Least and most halvings of a triangle: enough that no bend is overlooked, and not too many cells of a wild surface.
const HALVINGS: [usize; 2] = [2, 5];
/// Largest deviation of a cell from the plane of its corners, over its longest side, at which it is not halved.
const FLAT: f64 = 0.04;
/// Factor by which boxes are widened of the deviations measured at the middles of a cell and its sides. For a surface of degree 2 the
/// largest deviation is at most 4/3 of these.
const MARGIN: f64 = 3.0;
/// Number of triangles around the middle of a hole: they form a regular polygon in which the filling is the surface.
const SIDES: usize = 12;
/// Share of the control points' largest coordinate by which boxes are widened against rounding.
const SLACK: f64 = 1e-12;
/// Number of triangles, or of points, between two checks for cancellation.
const BATCH: usize = 1 << 12;

/// The nearest point of a surface to a point in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPoint {
    /// The place of the point.
    pub place: Parameter,
    /// The point of the surface.
    pub point: Vector,
    /// The distance from the point in space.
    pub distance: f64,
    /// Number of cells that had to be searched.
    pub cells: u32,
    /// Number of Newton steps in all of them.
    pub steps: u32,
}

/// A triangle with coordinates of its own, which is divided into cells.
#[derive(Debug, Clone, Copy)]
enum CellRegion {
    Patch(u32),
    /// A triangle at the middle of a hole, in the coordinates w/ρ.
    Middle {
        hole: usize,
        side: usize,
    },
}

/// A small triangle of a patch or of the middle of a hole.
#[derive(Debug, Clone, Copy)]
struct SurfaceCell {
    piece: CellRegion,
    corners: [Complex; 3],
}

/// A search structure for the nearest points of one surface, see [`Spline::closest_points`].
#[derive(Clone)]
pub struct ClosestPoints<'a> {
    spline: &'a Spline,
    cells: Vec<SurfaceCell>,
    /// The tree of the boxes around the cells.
    boxes: BoundsTree,
}

impl Spline {
    /// The search structure for nearest points of the surface, the fillings of its holes included.
    ///
    /// # Errors
    /// [`Error::Argument`] for a spline without patches; [`Error::Cancelled`].
    pub fn closest_points(&self, threads: usize, control: &Control) -> Result<ClosestPoints<'_>> {
        if self.space().patches().is_empty() {
            return Err(Error::argument("patches", 0, "1 or more"));
        }
        let largest = self.control_points().iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let patches = (0..self.space().patches().len()).map(|patch| CellRegion::Patch(patch as u32));
        let middle = |hole| (0..SIDES).map(move |side| CellRegion::Middle { hole, side });
        let pieces: Vec<CellRegion> = patches
            .chain((0..self.holes().len()).filter(|&hole| self.holes()[hole].fill.is_some()).flat_map(middle))
            .collect();
        let cut = in_batches(&pieces, BATCH, threads, control, |scratch: &mut Scratch, &piece| {
            let mut cutting =
                CellDivision { spline: self, piece, scratch, cells: Vec::new(), boxes: Vec::new() };
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
    fn corners_of(&self, piece: CellRegion) -> [Complex; 3] {
        match piece {
            CellRegion::Patch(patch) => self.space().patches()[patch as usize].corners(),
            CellRegion::Middle { hole, side } => {
                let turn = TAU / SIDES as f64;
                let radius = self.holes()[hole].inner / (0.5 * turn).cos();
                let corner = |k: usize| scale(radius, [(k as f64 * turn).cos(), (k as f64 * turn).sin()]);
                [[0.0; 2], corner(side), corner(side + 1)]
            }
        }
    }

    /// The surface at coordinates of a piece; at the middle of a hole its filling.
    fn on_piece(
        &self,
        piece: CellRegion,
        [x, y]: Complex,
        order: usize,
        scratch: &mut Scratch,
    ) -> Result<SurfacePoint> {
        match piece {
            CellRegion::Patch(patch) => self.at(Parameter { patch, x, y }, order, scratch),
            CellRegion::Middle { hole, .. } => {
                let message = "nothing fills it".into();
                let empty = || Error::Spline { what: "hole", index: hole, message };
                self.holes()[hole].filling([x, y]).ok_or_else(empty)
            }
        }
    }

    /// The place with these coordinates of a piece; none if the hole reaches beyond its patches there.
    fn place_on(&self, piece: CellRegion, [x, y]: Complex) -> Option<Parameter> {
        match piece {
            CellRegion::Patch(patch) => Some(Parameter { patch, x, y }),
            CellRegion::Middle { hole, .. } => self.holes()[hole].place_of(self.space(), [x, y]),
        }
    }
}

/// The division of one piece into cells.
struct CellDivision<'a> {
    spline: &'a Spline,
    piece: CellRegion,
    scratch: &'a mut Scratch,
    cells: Vec<SurfaceCell>,
    boxes: Vec<Bounds>,
}

impl CellDivision<'_> {
    fn points(&mut self, places: [Complex; 3]) -> Result<[Vector; 3]> {
        let mut points = [[0.0; 3]; 3];
        for (point, at) in points.iter_mut().zip(places) {
            *point = self.spline.on_piece(self.piece, at, 0, self.scratch)?.point;
        }
        Ok(points)
    }

    /// Adds a triangle as a cell, or halves its sides and adds the four triangles.
    fn cut(&mut self, corners: [Complex; 3], points: [Vector; 3], halvings: usize) -> Result<()> {
        let spline = self.spline;
        if let CellRegion::Patch(patch) = self.piece {
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
            self.cells.push(SurfaceCell { piece: self.piece, corners });
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
    /// The nearest point of the surface to each point, found in parallel; of several nearest points the first one found.
    ///
    /// # Errors
    /// [`Error::Argument`] for a point with a coordinate that is not finite, or above 1e150 in size; [`Error::Cancelled`].
    pub fn find(&self, points: &[Vector], threads: usize, control: &Control) -> Result<Vec<ClosestPoint>> {
        let is_good = |p: &Vector| p.iter().all(|x| x.abs() <= LARGEST);
        if let Some(at) = points.iter().position(|p| !is_good(p)) {
            return Err(Error::argument("point", at, "one with finite coordinates, of size 1e150 at most"));
        }
        // Points that follow each other are near each other, so that the cells of one are at hand for the next.
        in_batches_along(&z_order(points), points, threads, control, |scratch, &point| {
            self.nearest(point, scratch)
        })
    }

    fn nearest(&self, target: Vector, scratch: &mut Scratch) -> Result<ClosestPoint> {
        let far = |node: usize| self.boxes.distance(node, target);
        let (mut best, mut cells, mut steps) = (None, 0, 0);
        let mut open = vec![(far(0), 0)];
        while let Some((least, node)) = open.pop() {
            if best.is_some_and(|(_, DescentEnd { distance, .. })| least >= distance) {
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
                if best.is_none_or(|(_, best): (_, DescentEnd)| reached.distance < best.distance) {
                    best = Some((cell.piece, reached));
                }
            }
        }
        let place = best.and_then(|(piece, DescentEnd { at, .. })| self.spline.place_on(piece, at));
        let Some(place) = place else {
            return Err(Error::argument("point", format!("{target:?}"), "at a finite distance"));
        };
        let point = self.spline.at(place, 0, scratch)?.point;
        Ok(ClosestPoint { place, point, distance: distance(point, target), cells, steps })
    }

    /// The nearest point of a cell: by descent from its nearest corner if the squared distance is convex at all corners, else from each
    /// corner.
    fn descent(&self, cell: &SurfaceCell, target: Vector, scratch: &mut Scratch) -> Result<DescentEnd> {
        let &SurfaceCell { piece, corners } = cell;
        let mut starts = Vec::with_capacity(3);
        for at in corners {
            starts.push((at, self.spline.on_piece(piece, at, 2, scratch)?));
        }
        starts.sort_by(|a, b| distance(a.1.point, target).total_cmp(&distance(b.1.point, target)));
        if starts.iter().all(|(_, point)| is_convex(point, target)) {
            starts.truncate(1);
        }
        let mut best = DescentEnd { at: corners[0], distance: f64::INFINITY, steps: 0 };
        for start in starts {
            let surface = |at| self.spline.on_piece(piece, at, 2, scratch);
            let mut reached = descend(corners, start, target, surface)?;
            if let CellRegion::Middle { .. } = piece {
                // Near the corners of the polygon the surface is a blend of filling and spline.
                reached.distance = match self.spline.place_on(piece, reached.at) {
                    Some(place) => distance(self.spline.at(place, 0, scratch)?.point, target),
                    None => f64::INFINITY,
                };
            }
            reached.steps += best.steps;
            best = if reached.distance < best.distance {
                reached
            } else {
                DescentEnd { steps: reached.steps, ..best }
            };
        }
        Ok(best)
    }
}

//! The places of a spline over four-sided patches that are nearest to points in space.
//!
//! Patches are divided into cells until these are nearly flat. A cell lies in the convex hull of its Bézier points, so the box around these
//! contains it. For a point, cells are visited by the distance of their boxes, those of neighbouring patches like others, and a descent
//! finds the nearest place of each cell whose box is nearer than the best place so far.

use super::bezier::{BezierNet, quarters};
use super::places::{BATCH, PatchPlace};
use super::quintic::QUINTIC;
use super::spline::QuadSpline;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{BoundsNode, BoundsTree};
use crate::geometry::triangle_tree::{combined, nearest_weights};
use crate::geometry::vector::{Vector, add, distance, dot, lerp, scale, triangle_normal};
use crate::geometry::z_order::z_order;
use crate::mesh::Point;
use crate::spline::batches::in_batches;
use crate::spline::triangular::{DescentEnd, descend, is_convex};

/// Least and most halvings of a span in each direction: enough that no bend is overlooked, and not too many cells of a wild surface.
const HALVINGS: [usize; 2] = [1, 5];
/// Largest distance of a cell from the triangles between its corners, over its longest side, at which it is not divided.
const FLAT: f64 = 0.04;
/// Share of the control points' largest coordinate by which boxes are widened against rounding.
const SLACK: f64 = 1e-12;
/// Coordinates of points are at most this in size, so that squares of distances are finite.
const LARGEST: f64 = 1e150;

/// The place of a spline that is nearest to a point in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPlace {
    /// The place.
    pub place: PatchPlace,
    /// The point there.
    pub point: Vector,
    /// Its distance from the point in space.
    pub distance: f64,
}

/// A rectangle of parameters of a patch.
#[derive(Debug, Clone, Copy)]
struct PatchCell {
    patch: u32,
    low: [f64; 2],
    high: [f64; 2],
    /// The points at its corners, counterclockwise.
    corners: [Vector; 4],
    /// No point of it is farther than this from the two triangles between its corners.
    off: f64,
}

/// A search structure for the nearest places of a spline, see [`QuadSpline::nearest_places`].
#[derive(Clone)]
pub struct NearestPlaces {
    spline: QuadSpline,
    cells: Vec<PatchCell>,
    /// The tree of the boxes around the cells.
    boxes: BoundsTree,
}

/// A point in space, and if it is one of a surface, the normal there: places that face the other way do not count.
#[derive(Debug, Clone, Copy)]
struct SoughtPoint {
    point: Vector,
    normal: Option<Vector>,
}

impl QuadSpline {
    /// The search structure for nearest places.
    ///
    /// # Errors
    /// [`Error::Argument`] for a spline without patches; [`Error::Cancelled`].
    pub fn nearest_places(&self, threads: usize, control: &Control) -> Result<NearestPlaces> {
        let n = self.space().layout().patches().len();
        if n == 0 {
            return Err(Error::argument("patches", 0, "1 or more"));
        }
        let numbers: Vec<usize> = (0..n).collect();
        let divided = in_batches(&numbers, BATCH, threads, control, |(): &mut (), &patch| {
            control.check().map(|()| self.divided(patch))
        })?;
        let largest = self.control_points().iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let (mut cells, mut boxes) = (Vec::new(), Vec::new());
        for division in divided {
            cells.extend(division.cells);
            boxes.extend(division.boxes.into_iter().map(|bounds| bounds.widened(SLACK * largest)));
        }
        Ok(NearestPlaces { spline: self.clone(), cells, boxes: BoundsTree::new(&boxes) })
    }

    /// The cells of a patch.
    fn divided(&self, patch: usize) -> PatchCells {
        let [m, n] = self.space().patch_spans(patch);
        let mut division = PatchCells { cells: Vec::new(), boxes: Vec::new() };
        for (k, net) in self.bezier_nets(patch).iter().enumerate() {
            let corner = |i: usize, j: usize| [i as f64 / m as f64, j as f64 / n as f64];
            let (low, high) = (corner(k / n, k % n), corner(k / n + 1, k % n + 1));
            division.add(PatchCell::new(patch as u32, [low, high], net), net, 0);
        }
        division
    }
}

/// The cells of a patch with their boxes.
struct PatchCells {
    cells: Vec<PatchCell>,
    boxes: Vec<Bounds>,
}

impl PatchCells {
    /// Adds a rectangle as a cell, or its four quarters.
    fn add(&mut self, cell: PatchCell, net: &BezierNet, halvings: usize) {
        let [least, most] = HALVINGS;
        if halvings == most || halvings >= least && cell.off <= FLAT * cell.longest_side() {
            self.cells.push(cell);
            self.boxes.push(Bounds::of(net.iter().flatten().copied()));
            return;
        }
        let middle = [0, 1].map(|x| 0.5 * (cell.low[x] + cell.high[x]));
        let u = [cell.low[0], middle[0], cell.high[0]];
        let v = [cell.low[1], middle[1], cell.high[1]];
        for (i, both) in quarters(net).iter().enumerate() {
            for (j, quarter) in both.iter().enumerate() {
                let range = [[u[i], v[j]], [u[i + 1], v[j + 1]]];
                self.add(PatchCell::new(cell.patch, range, quarter), quarter, halvings + 1);
            }
        }
    }
}

impl PatchCell {
    /// The cell of a patch between two places with these Bézier points.
    fn new(patch: u32, [low, high]: [[f64; 2]; 2], net: &BezierNet) -> PatchCell {
        let corners = [net[0][0], net[QUINTIC][0], net[QUINTIC][QUINTIC], net[0][QUINTIC]];
        let [a, b, c, d] = corners;
        // The bilinear map of the corners is at most so far from the triangles.
        let twist = 0.25 * distance(add(a, c), add(b, d));
        let mut bend = 0.0f64;
        for (k, row) in net.iter().enumerate() {
            for (l, &point) in row.iter().enumerate() {
                let [s, t] = [k, l].map(|k| k as f64 / QUINTIC as f64);
                bend = bend.max(distance(point, lerp(lerp(a, b, s), lerp(d, c, s), t)));
            }
        }
        PatchCell { patch, low, high, corners, off: bend + twist }
    }

    fn longest_side(&self) -> f64 {
        let side = |k: usize| distance(self.corners[k], self.corners[(k + 1) % 4]);
        (0..4).map(side).fold(0.0, f64::max)
    }

    /// A lower bound of its distance from a point.
    fn distance(&self, point: Vector) -> f64 {
        let [a, b, c, d] = self.corners;
        let both = [[a, b, c], [a, c, d]].map(|corners| triangle_distance(corners, point));
        if both.iter().any(|x| x.is_nan()) { 0.0 } else { both[0].min(both[1]) - self.off }
    }

    /// The parameters at the corners, counterclockwise.
    fn parameters(&self) -> [[f64; 2]; 4] {
        let ([a, b], [c, d]) = (self.low, self.high);
        [[a, b], [c, b], [c, d], [a, d]]
    }

    /// The parameters moved into the cell, which rounding may have left.
    fn inside(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|x| at[x].clamp(self.low[x], self.high[x]))
    }
}

impl NearestPlaces {
    /// The spline.
    pub fn spline(&self) -> &QuadSpline {
        &self.spline
    }

    /// The nearest place to each point, found in parallel; of several nearest places the first one found.
    ///
    /// # Errors
    /// [`Error::Argument`] for a point with a coordinate that is not finite, or above 1e150 in size; [`Error::Cancelled`].
    pub fn find(&self, points: &[Vector], threads: usize, control: &Control) -> Result<Vec<NearestPlace>> {
        let sought: Vec<SoughtPoint> =
            points.iter().map(|&point| SoughtPoint { point, normal: None }).collect();
        self.find_all(&sought, threads, control)
    }

    /// Per face of a mesh on which the spline lies, the patch nearest to its centroid of those that face the same way there.
    ///
    /// # Errors
    /// [`Error::Size`] for a corner that does not exist; those of [`NearestPlaces::find`].
    pub fn patches_of_faces(
        &self,
        positions: &[Point],
        faces: &[[u32; 3]],
        threads: usize,
        control: &Control,
    ) -> Result<Vec<u32>> {
        if let Some(&v) = faces.iter().flatten().find(|&&v| v as usize >= positions.len()) {
            return Err(Error::Size { what: "positions", expected: v as usize + 1, got: positions.len() });
        }
        let sought = |face: &[u32; 3]| {
            let corners = face.map(|v| positions[v as usize]);
            let centroid = scale(1.0 / 3.0, corners.into_iter().fold([0.0; 3], add));
            SoughtPoint { point: centroid, normal: Some(triangle_normal(corners)) }
        };
        let sought: Vec<SoughtPoint> = faces.iter().map(sought).collect();
        let found = self.find_all(&sought, threads, control)?;
        Ok(found.iter().map(|nearest| nearest.place.patch as u32).collect())
    }

    fn find_all(
        &self,
        sought: &[SoughtPoint],
        threads: usize,
        control: &Control,
    ) -> Result<Vec<NearestPlace>> {
        let is_good = |of: &SoughtPoint| of.point.iter().all(|x| x.abs() <= LARGEST);
        if let Some(at) = sought.iter().position(|of| !is_good(of)) {
            return Err(Error::argument("point", at, "one with finite coordinates, of size 1e150 at most"));
        }
        // Points that follow each other are near each other, so that the cells of one are at hand for the next.
        let points: Vec<Vector> = sought.iter().map(|of| of.point).collect();
        let order = z_order(&points);
        let found = in_batches(&order, BATCH, threads, control, |(): &mut (), &i| {
            Ok(self.nearest(sought[i as usize]))
        })?;
        let mut placed: Vec<Option<NearestPlace>> = vec![None; points.len()];
        order.iter().zip(found).for_each(|(&i, of)| placed[i as usize] = of);
        let missing =
            || Error::argument("points", points.len(), "some at a finite distance from the surface");
        placed.into_iter().collect::<Option<_>>().ok_or_else(missing)
    }

    /// The nearest place; where none faces the right way, that of all.
    fn nearest(&self, sought: SoughtPoint) -> Option<NearestPlace> {
        let found = self.search(sought);
        if found.is_some() || sought.normal.is_none() {
            return found;
        }
        self.search(SoughtPoint { normal: None, ..sought })
    }

    fn search(&self, sought: SoughtPoint) -> Option<NearestPlace> {
        let far = |node: usize| self.boxes.distance(node, sought.point);
        let mut best: Option<NearestPlace> = None;
        let mut open = vec![(far(0), 0)];
        while let Some((least, node)) = open.pop() {
            if best.is_some_and(|best| least >= best.distance) {
                continue;
            }
            match self.boxes.node(node) {
                BoundsNode::Inner(children) => {
                    let mut children = children.map(|child| (far(child), child));
                    children.sort_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(children);
                }
                BoundsNode::Leaf(found) => {
                    for cell in found.iter().map(|&cell| &self.cells[cell as usize]) {
                        if best.is_some_and(|best| cell.distance(sought.point) > best.distance) {
                            continue;
                        }
                        let reached = self.nearest_of_cell(cell, sought);
                        let is_nearer = |of: &NearestPlace| best.is_none_or(|b| of.distance < b.distance);
                        best = reached.filter(is_nearer).or(best);
                    }
                }
            }
        }
        best
    }

    /// The nearest place of a cell: by descent from its nearest corner if the squared distance is convex at all corners, else from each
    /// corner.
    fn nearest_of_cell(&self, cell: &PatchCell, sought: SoughtPoint) -> Option<NearestPlace> {
        let (patch, target) = (cell.patch as usize, sought.point);
        let surface = |at| self.spline.at(patch, cell.inside(at));
        let mut starts = cell.parameters().map(|at| (at, surface(at)));
        starts.sort_by(|a, b| distance(a.1.point, target).total_cmp(&distance(b.1.point, target)));
        let is_simple = starts.iter().all(|(_, point)| is_convex(point, target));
        let mut best: Option<DescentEnd> = None;
        for start in starts.into_iter().take(if is_simple { 1 } else { 4 }) {
            let end = descend(cell.parameters(), start, target, |at| Ok(surface(at))).ok()?;
            let faces = |at| {
                let own = self.spline.at(patch, cell.inside(at)).normal();
                sought.normal.is_none_or(|normal| own.is_some_and(|own| dot(own, normal) > 0.0))
            };
            if end.distance.is_finite()
                && best.is_none_or(|best| end.distance < best.distance)
                && faces(end.at)
            {
                best = Some(end);
            }
        }
        best.map(|DescentEnd { at, distance, .. }| {
            let parameters = cell.inside(at);
            let point = self.spline.at(patch, parameters).point;
            NearestPlace { place: PatchPlace { patch, parameters }, point, distance }
        })
    }
}

/// The distance of a point from a triangle; NaN if it has no area.
fn triangle_distance(corners: [Vector; 3], point: Vector) -> f64 {
    distance(combined(nearest_weights(corners, point), corners), point)
}

//! The space of all splines over a layout: their tangent planes are continuous across every arc that is no crease.

use super::elimination::{Combinations, ControlEquations, SparseRow};
use super::gluing::{Gluing, GluingLengths};
use super::layout::{ArcEnd, PatchCorner, PatchLayout};
use super::quintic::{MAX_SPANS, basis_size};
use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use crate::mesh::union_find::UnionFind;
use std::collections::BTreeMap;

/// Weights below this count as 0 where tangents are looked at.
const VANISHING: f64 = 1e-9;

/// Splines of degree 5 in both directions over a layout of four-sided patches, with one polynomial per span.
///
/// Tangent planes are continuous across all arcs but creases, curvatures also across arcs between regular nodes (but for one control point
/// near a node where an arc bends towards an irregular neighbour) and inside patches. All control points are combinations of free ones: the
/// same for x, y, and z, whatever the shape of the surface.
pub struct QuadSplineSpace {
    layout: PatchLayout,
    spans: usize,
    /// Per patch the numbers of its control points, those of i along u and j along v at i · side + j.
    control: Vec<Vec<u32>>,
    combinations: Combinations,
}

/// An arc across which the tangent plane is continuous.
struct SmoothArc {
    gluing: Gluing,
    /// The side to its left, which runs as the arc, and that to its right, which runs against it.
    sides: [PatchCorner; 2],
    ends: [ArcEnd; 2],
}

impl QuadSplineSpace {
    /// The space over a layout with a number of spans per patch and direction, from 1 to 32.
    ///
    /// # Errors
    /// [`Error::Argument`] for another number; [`Error::TooLarge`] for more control points than a u32 can number; [`Error::Spline`] where
    /// all splines of the space have a vanishing tangent at a node.
    pub fn new(layout: PatchLayout, spans: usize) -> Result<QuadSplineSpace> {
        if !(1..=MAX_SPANS).contains(&spans) {
            return Err(Error::argument("spans", spans, "a number from 1 to 32"));
        }
        let side = basis_size(spans);
        let count = layout.patches().len() * side * side;
        if count >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "control points", count });
        }
        let (control, n) = numbered(&layout, side);
        let smooth: Vec<Option<SmoothArc>> =
            (0..layout.arcs().len()).map(|arc| smooth_arc(&layout, arc)).collect();
        let nothing = Combinations { dimension: n, rows: Vec::new() };
        let mut space = QuadSplineSpace { layout, spans, control, combinations: nothing };
        let mut equations = ControlEquations::new(space.arcs_of_columns(&smooth, n));
        space.add_tangent_planes(&smooth, &mut equations);
        space.add_curvatures(&smooth, &mut equations);
        space.combinations = equations.finish();
        space.check_tangents()?;
        Ok(space)
    }

    /// The layout.
    pub fn layout(&self) -> &PatchLayout {
        &self.layout
    }

    /// Number of spans per patch and direction.
    pub fn spans(&self) -> usize {
        self.spans
    }

    /// Number of control points along a side of a patch: 3 × spans + 3.
    pub fn side(&self) -> usize {
        basis_size(self.spans)
    }

    /// Number of control points, those on common sides once.
    pub fn n_control_points(&self) -> usize {
        self.combinations.rows.len()
    }

    /// Number of free control points.
    pub fn dimension(&self) -> usize {
        self.combinations.dimension
    }

    /// The numbers of the control points of a patch: i along u and j along v at i × side + j.
    pub fn control(&self, patch: usize) -> &[u32] {
        &self.control[patch]
    }

    /// The free control points that a control point is a combination of, with their weights: a row of the extraction matrix.
    pub fn combination(&self, control_point: usize) -> &[(u32, f64)] {
        &self.combinations.rows[control_point]
    }

    /// All control points for free ones.
    ///
    /// # Errors
    /// [`Error::Size`] for another number of free points.
    pub fn control_points(&self, free: &[Vector]) -> Result<Vec<Vector>> {
        crate::error::check_size("free control points", free.len(), self.dimension())?;
        let point = |row: &SparseRow| {
            row.iter()
                .fold([0.0; 3], |sum: Vector, &(k, w)| [0, 1, 2].map(|x| sum[x] + w * free[k as usize][x]))
        };
        Ok(self.combinations.rows.iter().map(point).collect())
    }

    /// The number of the control point i along a side of a patch, in the direction around it, at a depth inside.
    pub(super) fn along(&self, at: PatchCorner, i: usize, depth: usize) -> u32 {
        self.control[at.patch][place_along(at.corner, i, depth, self.side())]
    }

    /// The numbers of the control points i of a smooth arc in the first row inside its left patch, in that of its right patch, and of its own.
    fn rows_of(&self, arc: &SmoothArc, i: usize) -> [u32; 3] {
        let [left, right] = arc.sides;
        [self.along(left, i, 1), self.along(right, self.side() - 1 - i, 1), self.along(left, i, 0)]
    }

    /// Per control point the number of smooth arcs in whose equations it is.
    fn arcs_of_columns(&self, smooth: &[Option<SmoothArc>], n: usize) -> Vec<u32> {
        let mut arcs = vec![0; n];
        for arc in smooth.iter().flatten() {
            let columns = (0..self.side()).flat_map(|i| self.rows_of(arc, i));
            columns.for_each(|c| arcs[c as usize] += 1);
        }
        arcs
    }

    fn add_tangent_planes(&self, smooth: &[Option<SmoothArc>], equations: &mut ControlEquations) {
        let n = self.side();
        let mut known: BTreeMap<[u64; 6], Vec<Vec<f64>>> = BTreeMap::new();
        for arc in smooth.iter().flatten() {
            let rows = known.entry(arc.gluing.key()).or_insert_with(|| arc.gluing.equations(self.spans));
            for row in rows.iter() {
                let entries = row.iter().enumerate().filter(|(_, w)| **w != 0.0);
                let entries: SparseRow =
                    entries.map(|(c, &w)| (self.rows_of(arc, c % n)[c / n], w)).collect();
                equations.add(&entries);
            }
        }
    }

    /// Adds equal second derivatives across arcs with γ = 0. Near a regular node whose crossing arc has γ ≠ 0 that would ask for γ'' = 0
    /// there: the equation of the control point next to the node is left out.
    fn add_curvatures(&self, smooth: &[Option<SmoothArc>], equations: &mut ControlEquations) {
        let arc_at = |at: PatchCorner, turn: usize| {
            let side = self.layout.patches()[at.patch][(at.corner + turn) % 4];
            smooth[side.arc as usize].as_ref()
        };
        for arc in smooth.iter().flatten().filter(|arc| arc.gluing.is_flat()) {
            let [left, right] = arc.sides;
            let is_bent = |crossing: [Option<&SmoothArc>; 2]| {
                crossing.into_iter().flatten().any(|arc| !arc.gluing.is_flat())
            };
            let at_start = arc.ends[0] == ArcEnd::Regular && is_bent([arc_at(left, 3), arc_at(right, 1)]);
            let at_end = arc.ends[1] == ArcEnd::Regular && is_bent([arc_at(left, 1), arc_at(right, 3)]);
            let last = self.side() - 1;
            let lengths = arc.gluing.lengths;
            let [p, q] = [lengths.left, lengths.right].map(|depth| (lengths.along / depth).powi(2));
            for i in (0..=last).filter(|&i| !(i == 1 && at_start || i + 1 == last && at_end)) {
                let [a, b, own] = self.rows_of(arc, i);
                let [c, d] = [self.along(left, i, 2), self.along(right, last - i, 2)];
                equations.add(&[(c, p), (a, -2.0 * p), (d, -q), (b, 2.0 * q), (own, p - q)]);
            }
        }
    }

    /// Checks that tangents along sides do not vanish at nodes for all splines of the space.
    fn check_tangents(&self) -> Result<()> {
        for at in self.layout.corners() {
            let [start, next] = [0, 1].map(|i| &self.combinations.rows[self.along(at, i, 0) as usize]);
            let mut sum: BTreeMap<u32, f64> = next.iter().copied().collect();
            start.iter().for_each(|&(c, w)| *sum.entry(c).or_default() -= w);
            if sum.values().all(|w| w.abs() < VANISHING) {
                let message = format!(
                    "tangents along side {} of patch {} vanish there for every spline: divide the patches around it",
                    at.corner, at.patch
                );
                return Err(Error::Spline { what: "node", index: self.layout.node(at) as usize, message });
            }
        }
        Ok(())
    }
}

/// The index in its patch of the control point i along side k, in the direction around the patch, at a depth inside.
fn place_along(k: usize, i: usize, depth: usize, side: usize) -> usize {
    let last = side - 1;
    let [a, b] = match k {
        0 => [i, depth],
        1 => [last - depth, i],
        2 => [last - i, last - depth],
        _ => [depth, last - i],
    };
    a * side + b
}

/// An arc with patches on both sides, unless it is a crease.
fn smooth_arc(layout: &PatchLayout, arc: usize) -> Option<SmoothArc> {
    let [Some(left), Some(right)] = layout.beside(arc) else { return None };
    if layout.arcs()[arc].is_crease {
        return None;
    }
    let ends = [layout.start_of(left), layout.start_of(right)];
    let [across_left, across_right] = [left, right].map(|side| layout.depth(side));
    let lengths = GluingLengths { along: layout.arcs()[arc].length, left: across_left, right: across_right };
    Some(SmoothArc { gluing: Gluing::between(ends, lengths), sides: [left, right], ends })
}

/// The numbers of the control points of each patch, those on common sides once, and how many there are.
fn numbered(layout: &PatchLayout, side: usize) -> (Vec<Vec<u32>>, usize) {
    let (n, of_patch) = (layout.patches().len(), side * side);
    let mut same = UnionFind::new(n * of_patch);
    for arc in 0..layout.arcs().len() {
        let [Some(left), Some(right)] = layout.beside(arc) else { continue };
        for i in 0..side {
            let at =
                |corner: PatchCorner, i| corner.patch * of_patch + place_along(corner.corner, i, 0, side);
            _ = same.join(at(left, i) as u32, at(right, side - 1 - i) as u32);
        }
    }
    let (mut number, mut count) = (BTreeMap::new(), 0);
    let mut number_of = |x: usize| {
        *number.entry(same.root(x as u32)).or_insert_with(|| {
            count += 1;
            count - 1
        })
    };
    let control = (0..n).map(|p| (0..of_patch).map(|i| number_of(p * of_patch + i)).collect()).collect();
    (control, count as usize)
}

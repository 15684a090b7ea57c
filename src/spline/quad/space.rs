//! The space of all splines over a layout: their tangent planes are continuous across every arc that is no crease.

use super::elimination::{Combinations, ControlEquations, SparseRow};
use super::gluing::{Gluing, GluingLength, GluingLengths};
use super::layout::{ArcEnd, ArcSide, PatchCorner, PatchLayout};
use super::quintic::{MAX_SPANS, basis_size};
use crate::archive::{in_range, stored};
use crate::error::{Error, Result, check_size};
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
    /// Per arc the number of spans along it.
    spans: Vec<usize>,
    /// Per patch the numbers of its control points, those of i along u and j along v at i · n + j, with n along v.
    control: Vec<Vec<u32>>,
    combinations: Combinations,
}
stored!(sections QuadSplineSpace { layout, spans, control, combinations } check QuadSplineSpace::check_parts);

/// An arc across which the tangent plane is continuous.
struct SmoothArc {
    gluing: Gluing,
    /// The side to its left, which runs as the arc, and that to its right, which runs against it.
    sides: [PatchCorner; 2],
    ends: [ArcEnd; 2],
}

impl QuadSplineSpace {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let n = self.combinations.rows.len();
        check_size("spans", self.spans.len(), self.layout.arcs().len())?;
        check_size("patches", self.control.len(), self.layout.patches().len())?;
        in_range("control point", self.control.iter().flatten().map(|&k| k as usize), n)?;
        let free = self.combinations.rows.iter().flatten().map(|&(k, _)| k as usize);
        in_range("free control point", free, self.combinations.dimension)
    }

    /// The space over a layout with a number of spans per patch and direction, from 1 to 32.
    ///
    /// # Errors
    /// Those of [`QuadSplineSpace::with_spans`].
    pub fn new(layout: PatchLayout, spans: usize) -> Result<QuadSplineSpace> {
        let spans = vec![spans; layout.arcs().len()];
        QuadSplineSpace::with_spans(layout, spans)
    }

    /// The space over a layout with a number of spans along each arc, from 1 to 32, the same on opposite sides of a patch.
    ///
    /// # Errors
    /// [`Error::Argument`] for another number; [`Error::Size`] for another number of arcs; [`Error::TooLarge`] for more control points than a
    /// u32 can number; [`Error::Spline`] where opposite sides have other numbers of spans, and where all splines of the space have a vanishing
    /// tangent at a node.
    pub fn with_spans(layout: PatchLayout, spans: Vec<usize>) -> Result<QuadSplineSpace> {
        check_size("spans of arcs", spans.len(), layout.arcs().len())?;
        if let Some(&other) = spans.iter().find(|spans| !(1..=MAX_SPANS).contains(*spans)) {
            return Err(Error::argument("spans", other, "a number from 1 to 32"));
        }
        let unequal = |sides: &[ArcSide; 4]| {
            let along = sides.map(|side| spans[side.arc as usize]);
            along[0] != along[2] || along[1] != along[3]
        };
        if let Some(index) = layout.patches().iter().position(unequal) {
            let message = "opposite sides of it have different numbers of spans".into();
            return Err(Error::Spline { what: "patch", index, message });
        }
        let of_patch = |sides: &[ArcSide; 4]| -> usize {
            [0, 1].map(|k| basis_size(spans[sides[k].arc as usize])).iter().product()
        };
        let count = layout.patches().iter().map(of_patch).sum::<usize>();
        if count >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "control points", count });
        }
        let nothing = Combinations { dimension: 0, rows: Vec::new() };
        let mut space = QuadSplineSpace { layout, spans, control: Vec::new(), combinations: nothing };
        let n = space.number();
        let smooth: Vec<Option<SmoothArc>> =
            (0..space.layout.arcs().len()).map(|arc| space.smooth_arc(arc)).collect();
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

    /// Number of spans along each arc.
    pub fn spans(&self) -> &[usize] {
        &self.spans
    }

    /// Number of spans of a patch along u and along v.
    pub fn patch_spans(&self, patch: usize) -> [usize; 2] {
        [0, 1].map(|corner| self.spans_along(PatchCorner { patch, corner }))
    }

    /// Number of control points of a patch along u and along v: 3 × spans + 3.
    pub fn sides(&self, patch: usize) -> [usize; 2] {
        self.patch_spans(patch).map(basis_size)
    }

    /// Number of spans along a side of a patch.
    fn spans_along(&self, at: PatchCorner) -> usize {
        self.spans[self.layout.patches()[at.patch][at.corner].arc as usize]
    }

    /// Number of spans of a patch across a side.
    fn spans_across(&self, at: PatchCorner) -> usize {
        self.spans_along(PatchCorner { corner: (at.corner + 1) % 4, ..at })
    }

    /// Number of control points along a side of a patch.
    pub(super) fn side(&self, at: PatchCorner) -> usize {
        basis_size(self.spans_along(at))
    }

    /// Number of control points, those on common sides once.
    pub fn n_control_points(&self) -> usize {
        self.combinations.rows.len()
    }

    /// Number of free control points.
    pub fn dimension(&self) -> usize {
        self.combinations.dimension
    }

    /// The numbers of the control points of a patch: i along u and j along v at i × n + j, with n of them
    /// along v.
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
        check_size("free control points", free.len(), self.dimension())?;
        let point = |row: &SparseRow| {
            row.iter()
                .fold([0.0; 3], |sum: Vector, &(k, w)| [0, 1, 2].map(|x| sum[x] + w * free[k as usize][x]))
        };
        Ok(self.combinations.rows.iter().map(point).collect())
    }

    /// The number of the control point i along a side of a patch, in the direction around it, at a depth inside.
    pub(super) fn along(&self, at: PatchCorner, i: usize, depth: usize) -> u32 {
        self.control[at.patch][place_along(at.corner, [i, depth], self.sides(at.patch))]
    }

    /// The numbers of the control points i of a smooth arc in the first row inside its left patch, in that of its right patch, and of its own.
    fn rows_of(&self, arc: &SmoothArc, i: usize) -> [u32; 3] {
        let [left, right] = arc.sides;
        [self.along(left, i, 1), self.along(right, self.side(right) - 1 - i, 1), self.along(left, i, 0)]
    }

    /// Per control point the number of smooth arcs in whose equations it is.
    fn arcs_of_columns(&self, smooth: &[Option<SmoothArc>], n: usize) -> Vec<u32> {
        let mut arcs = vec![0; n];
        for arc in smooth.iter().flatten() {
            let columns = (0..self.side(arc.sides[0])).flat_map(|i| self.rows_of(arc, i));
            columns.for_each(|c| arcs[c as usize] += 1);
        }
        arcs
    }

    fn add_tangent_planes(&self, smooth: &[Option<SmoothArc>], equations: &mut ControlEquations) {
        let mut known: BTreeMap<[u64; 9], Vec<Vec<f64>>> = BTreeMap::new();
        for arc in smooth.iter().flatten() {
            let n = self.side(arc.sides[0]);
            let rows = known.entry(arc.gluing.key()).or_insert_with(|| arc.gluing.equations());
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
            let last = self.side(left) - 1;
            let GluingLengths { along, left: to_left, right: to_right } = arc.gluing.lengths;
            let [p, q] = [to_left, to_right]
                .map(|across| (along.length / across.length * across.spans as f64).powi(2));
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

/// The index in its patch of the control point i along side k, in the direction around the patch, at a depth inside; `sides`: the numbers of
/// control points of the patch along u and v.
fn place_along(k: usize, [i, depth]: [usize; 2], sides: [usize; 2]) -> usize {
    let [last_u, last_v] = sides.map(|n| n - 1);
    let [a, b] = match k {
        0 => [i, depth],
        1 => [last_u - depth, i],
        2 => [last_u - i, last_v - depth],
        _ => [depth, last_v - i],
    };
    a * sides[1] + b
}

impl QuadSplineSpace {
    /// An arc with patches on both sides, unless it is a crease.
    fn smooth_arc(&self, arc: usize) -> Option<SmoothArc> {
        let layout = &self.layout;
        let [Some(left), Some(right)] = layout.beside(arc) else { return None };
        if layout.arcs()[arc].is_crease {
            return None;
        }
        let ends = [layout.start_of(left), layout.start_of(right)];
        let across = |side| GluingLength { length: layout.depth(side), spans: self.spans_across(side) };
        let along = GluingLength { length: layout.arcs()[arc].length, spans: self.spans[arc] };
        let lengths = GluingLengths { along, left: across(left), right: across(right) };
        Some(SmoothArc { gluing: Gluing::between(ends, lengths), sides: [left, right], ends })
    }

    /// Numbers the control points of each patch, those on common sides once; returns how many there are.
    fn number(&mut self) -> usize {
        let layout = &self.layout;
        let mut first = vec![0];
        for p in 0..layout.patches().len() {
            first.push(first[p] + self.sides(p).iter().product::<usize>());
        }
        let mut same = UnionFind::new(first[layout.patches().len()]);
        for arc in 0..layout.arcs().len() {
            let [Some(left), Some(right)] = layout.beside(arc) else { continue };
            let n = self.side(left);
            let at = |side: PatchCorner, i| {
                first[side.patch] + place_along(side.corner, [i, 0], self.sides(side.patch))
            };
            (0..n).for_each(|i| _ = same.join(at(left, i) as u32, at(right, n - 1 - i) as u32));
        }
        let (mut number, mut count) = (BTreeMap::new(), 0);
        let mut number_of = |x: usize| {
            *number.entry(same.root(x as u32)).or_insert_with(|| {
                count += 1;
                count - 1
            })
        };
        self.control =
            first.windows(2).map(|range| (range[0]..range[1]).map(&mut number_of).collect()).collect();
        count as usize
    }
}

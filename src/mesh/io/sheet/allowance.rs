//! Seam allowances: lines outside the border of a drawing, at a distance from it.
//!
//! Each side of the border is shifted outwards, and round its corners lie arcs. Where these cross each other they are divided, and of the
//! parts those stay that are nowhere nearer to the border than the distance.

use super::{CuttingSheet, SheetLayer, SheetLine};
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, cross, dot, norm, scale, sub};
use std::f64::consts::{PI, TAU};

/// The largest angle between two points of an arc, radians.
const ARC: f64 = PI / 18.0;
/// The part of the distance by which a part may be nearer to the border: the sagitta of an arc is 0.004 of it.
const NEARER: f64 = 0.005;
/// The part of the distance within which two points are one: where several sides cross at a corner of theirs, rounding tells them apart.
const SAME: f64 = 1e-9;

/// A straight piece of the shifted border, with the places at which others cross it: shares of its length and numbers of points.
struct ShiftedSide {
    ends: [u32; 2],
    crossings: Vec<(f64, u32)>,
}

impl CuttingSheet {
    /// The drawing with a line on the layer [`SheetLayer::Allowance`] outside the border and outside the sides of seams, at a distance from
    /// them. Lines of these layers have the surface on their left.
    ///
    /// # Errors
    /// [`Error::Argument`] for a distance that is not positive, and for points that do not exist.
    pub fn with_allowance(mut self, distance: f64) -> Result<CuttingSheet> {
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(Error::argument("allowance", distance, "a positive length"));
        }
        self.check()?;
        let border = self.border();
        let first = self.points.len() as u32;
        let (mut points, mut sides) = shifted(&border, distance);
        cross_all(&mut points, &mut sides);
        let far = |p: Complex| {
            border
                .iter()
                .flat_map(|corners| sides_of(corners))
                .all(|side| away(p, side) >= (1.0 - NEARER) * distance)
        };
        let same = same_places(&points, SAME * distance);
        let mut kept = std::collections::BTreeSet::new();
        for side in &mut sides {
            side.crossings.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let inner = side.crossings.iter().map(|(_, k)| *k);
            let along: Vec<u32> =
                std::iter::once(side.ends[0]).chain(inner).chain(std::iter::once(side.ends[1])).collect();
            let along: Vec<u32> = along.iter().map(|&k| same[k as usize]).collect();
            for pair in along.windows(2).filter(|pair| pair[0] != pair[1]) {
                let [p, q] = [pair[0], pair[1]].map(|k| points[k as usize]);
                if far(scale(0.5, add(p, q))) {
                    kept.insert([pair[0] + first, pair[1] + first]);
                }
            }
        }
        self.points.extend(points);
        self.lines.extend(chained(&kept.into_iter().collect::<Vec<_>>()));
        Ok(self)
    }

    /// The loops of the border and of seams, with the surface on their left.
    fn border(&self) -> Vec<Vec<Complex>> {
        let is_outline = |line: &&SheetLine| matches!(line.layer, SheetLayer::Boundary | SheetLayer::Seams);
        let lines: Vec<&SheetLine> = self.lines.iter().filter(is_outline).collect();
        let mut seen = vec![false; lines.len()];
        let mut loops = Vec::new();
        for begin in 0..lines.len() {
            if std::mem::replace(&mut seen[begin], true) {
                continue;
            }
            let mut points = lines[begin].points.clone();
            // Open lines go on in others that begin where they end.
            let mut is_closed = lines[begin].is_closed;
            while !is_closed && points.first() != points.last() {
                let goes_on = |k: &usize| !seen[*k] && lines[*k].points.first() == points.last();
                let Some(k) = (0..lines.len()).find(goes_on) else { break };
                seen[k] = true;
                points.extend(&lines[k].points[1..]);
            }
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
                is_closed = true;
            }
            if is_closed && points.len() > 2 {
                loops.push(points.iter().map(|&k| self.points[k as usize]).collect());
            }
        }
        loops
    }
}

fn sides_of(points: &[Complex]) -> impl Iterator<Item = [Complex; 2]> + '_ {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
}

/// The distance of a point from a segment.
fn away(p: Complex, [a, b]: [Complex; 2]) -> f64 {
    let (u, v) = (sub(p, a), sub(b, a));
    let whole = dot(v, v);
    let share = if whole > 0.0 { (dot(u, v) / whole).clamp(0.0, 1.0) } else { 0.0 };
    norm(sub(u, scale(share, v)))
}

/// The sides of loops shifted to their right, joined by arcs around corners that bulge outwards and by straight pieces at the others.
fn shifted(border: &[Vec<Complex>], distance: f64) -> (Vec<Complex>, Vec<ShiftedSide>) {
    let (mut points, mut sides) = (Vec::new(), Vec::new());
    for corners in border {
        let all: Vec<[Complex; 2]> = sides_of(corners).filter(|[a, b]| a != b).collect();
        let outer = |[a, b]: [Complex; 2]| {
            let [x, y] = sub(b, a);
            let length = x.hypot(y);
            [y / length, -x / length]
        };
        let begin = points.len() as u32;
        for (k, &side) in all.iter().enumerate() {
            let next = all[(k + 1) % all.len()];
            let [from, to] = [outer(side), outer(next)];
            points.extend(side.map(|p| add(p, scale(distance, from))));
            let turn = cross(from, to).atan2(dot(from, to));
            let turn = if turn < -PI + 1e-9 { turn + TAU } else { turn };
            if turn > 0.0 {
                let steps = (turn / ARC).ceil() as usize;
                let start = from[1].atan2(from[0]);
                for step in 1..steps {
                    let (sin, cos) = (start + turn * step as f64 / steps as f64).sin_cos();
                    points.push(add(side[1], scale(distance, [cos, sin])));
                }
            }
        }
        let end = points.len() as u32;
        let next = |k: u32| if k + 1 == end { begin } else { k + 1 };
        sides.extend((begin..end).map(|k| ShiftedSide { ends: [k, next(k)], crossings: Vec::new() }));
    }
    (points, sides)
}

/// Finds where sides cross, and adds the points.
fn cross_all(points: &mut Vec<Complex>, sides: &mut [ShiftedSide]) {
    let reach = |side: &ShiftedSide, points: &[Complex]| {
        let [a, b] = side.ends.map(|k| points[k as usize]);
        [a[0].min(b[0]), a[0].max(b[0]), a[1].min(b[1]), a[1].max(b[1])]
    };
    let boxes: Vec<[f64; 4]> = sides.iter().map(|side| reach(side, points)).collect();
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_by(|&i, &j| boxes[i][0].total_cmp(&boxes[j][0]).then(i.cmp(&j)));
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..].iter().take_while(|&&j| boxes[j][0] <= boxes[i][1]) {
            let meet = boxes[i][2] <= boxes[j][3] && boxes[j][2] <= boxes[i][3];
            let share_end = sides[i].ends.iter().any(|v| sides[j].ends.contains(v));
            if !meet || share_end {
                continue;
            }
            let [[a, b], [c, d]] = [i, j].map(|k| sides[k].ends.map(|v| points[v as usize]));
            let (u, v, w) = (sub(b, a), sub(d, c), sub(c, a));
            let area = cross(u, v);
            let (s, t) = (cross(w, v) / area, cross(w, u) / area);
            if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
                let number = points.len() as u32;
                points.push(add(a, scale(s, u)));
                sides[i].crossings.push((s, number));
                sides[j].crossings.push((t, number));
            }
        }
    }
}

/// Per point the first point at the same place.
fn same_places(points: &[Complex], within: f64) -> Vec<u32> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| points[i][0].total_cmp(&points[j][0]).then(i.cmp(&j)));
    let mut same: Vec<u32> = (0..points.len() as u32).collect();
    for (k, &i) in order.iter().enumerate() {
        let is_near = |j: &&usize| norm(sub(points[i], points[**j])) <= within;
        let before = order[..k].iter().rev().take_while(|&&j| points[j][0] >= points[i][0] - within);
        if let Some(&j) = before.filter(is_near).min_by_key(|&&j| same[j]) {
            same[i] = same[j];
        }
    }
    same
}

/// Pieces as lines, each going on as long as another begins where it ends.
fn chained(pieces: &[[u32; 2]]) -> Vec<SheetLine> {
    let mut starts: std::collections::BTreeMap<u32, Vec<usize>> = std::collections::BTreeMap::new();
    pieces.iter().enumerate().for_each(|(k, piece)| starts.entry(piece[0]).or_default().push(k));
    let is_end: std::collections::BTreeSet<u32> = pieces.iter().map(|piece| piece[1]).collect();
    let mut seen = vec![false; pieces.len()];
    // Open lines begin where none ends.
    let (open, closed): (Vec<usize>, Vec<usize>) =
        (0..pieces.len()).partition(|&k| !is_end.contains(&pieces[k][0]));
    let mut lines = Vec::new();
    for begin in open.into_iter().chain(closed) {
        if std::mem::replace(&mut seen[begin], true) {
            continue;
        }
        let mut points = pieces[begin].to_vec();
        while let Some(&k) =
            starts.get(&points[points.len() - 1]).and_then(|next| next.iter().find(|&&k| !seen[k]))
        {
            seen[k] = true;
            points.push(pieces[k][1]);
        }
        let is_closed = points.first() == points.last();
        if is_closed {
            points.pop();
        }
        lines.push(SheetLine { layer: SheetLayer::Allowance, seam: None, points, is_closed });
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(points: Vec<Complex>) -> CuttingSheet {
        let line = SheetLine {
            layer: SheetLayer::Boundary,
            seam: None,
            points: (0..points.len() as u32).collect(),
            is_closed: true,
        };
        CuttingSheet { points, lines: vec![line] }
    }

    fn allowance(sheet: &CuttingSheet) -> Vec<&SheetLine> {
        sheet.lines.iter().filter(|line| line.layer == SheetLayer::Allowance).collect()
    }

    #[test]
    fn around_a_square_it_is_four_sides_and_a_circle() {
        let square = drawn(vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]);
        let with = square.with_allowance(2.0).unwrap();
        let lines = allowance(&with);
        assert!(lines.len() == 1 && lines[0].is_closed);
        // The circle is a polygon of 36 sides.
        let known = 40.0 + 36.0 * 4.0 * (PI / 36.0).sin();
        assert!((with.length(lines[0]) - known).abs() < 1e-9);
    }

    #[test]
    fn into_a_corner_it_turns_at_the_crossing_and_a_narrow_bay_is_closed() {
        let corner = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [5.0, 5.0], [5.0, 10.0], [0.0, 10.0]];
        let with = drawn(corner).with_allowance(1.0).unwrap();
        let lines = allowance(&with);
        assert_eq!(lines.len(), 1);
        let places: Vec<Complex> = with.places(lines[0]).collect();
        assert!(places.iter().any(|p| (p[0] - 6.0).hypot(p[1] - 6.0) < 1e-12));
        // A bay of width 1 is narrower than twice the allowance: no line goes into it.
        let bay = vec![
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 9.0],
            [5.0, 9.0],
            [5.0, 1.0],
            [4.0, 1.0],
            [4.0, 9.0],
            [0.0, 9.0],
        ];
        let with = drawn(bay).with_allowance(1.0).unwrap();
        let lines = allowance(&with);
        assert_eq!(lines.len(), 1);
        assert!(with.places(lines[0]).all(|[x, y]| !(3.5..5.5).contains(&x) || !(0.0..9.5).contains(&y)));
        assert!(drawn(vec![[0.0; 2]; 3]).with_allowance(0.0).is_err());
    }

    #[test]
    fn holes_have_theirs_inside() {
        let mut ring = drawn(vec![[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]]);
        // Clockwise, with the surface on the left.
        ring.points.extend([[5.0, 5.0], [5.0, 15.0], [15.0, 15.0], [15.0, 5.0]]);
        ring.lines.push(SheetLine { points: vec![4, 5, 6, 7], ..ring.lines[0].clone() });
        let with = ring.with_allowance(1.0).unwrap();
        let mut lengths: Vec<f64> = allowance(&with).iter().map(|line| with.length(line)).collect();
        lengths.sort_by(f64::total_cmp);
        assert!(lengths.len() == 2 && (lengths[0] - 32.0).abs() < 1e-12, "{lengths:?}");
    }
}

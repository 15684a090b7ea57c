//! The polygons of a file, and their division into triangles.

use super::budget::Budget;
use super::scan::Location;
use super::soup::Soup;
use crate::error::{Error, Result};
use crate::geometry::predicates::orientation;
use crate::mesh::Point;
use std::cmp::Ordering;

/// The polygons of a file in its order, as flat lists: corner k of the file is `corners[k]`.
#[derive(Default)]
pub(super) struct Polygons {
    pub corners: Vec<u32>,
    /// The end of each polygon in `corners`.
    ends: Vec<usize>,
}

/// Bytes that a triangle may take: its corners, its vertices and their texture coordinates.
const PER_TRIANGLE: usize = size_of::<([usize; 3], [u32; 3], [[f64; 2]; 3])>();
/// Most corners of a polygon that is cut ear by ear. A larger one becomes a fan, since the time to find ears grows with the square of the
/// number of corners.
const MOST_CORNERS: usize = 1000;

impl Polygons {
    pub fn push(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.end();
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The end of each polygon in `corners`.
    pub fn ends(&self) -> impl Iterator<Item = usize> + '_ {
        self.ends.iter().copied()
    }

    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The vertices of each polygon.
    pub fn all(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends());
        starts.zip(self.ends()).map(|(start, end)| &self.corners[start..end])
    }

    /// The number of the polygon that each of its triangles is a part of.
    pub fn owners<'a>(&'a self, triangles: &'a [[usize; 3]]) -> impl Iterator<Item = usize> + 'a {
        let mut polygon = 0;
        triangles.iter().map(move |triangle| {
            while self.ends[polygon] <= triangle[0] {
                polygon += 1;
            }
            polygon
        })
    }

    /// Ends a polygon: its corners are those pushed to `corners` since the end of the last one.
    pub fn end(&mut self) {
        self.ends.push(self.corners.len());
    }

    /// Reserves memory for all of these.
    pub fn reserve<'a>(&mut self, all: impl Iterator<Item = &'a Polygons>) {
        let add = |[a, b]: [usize; 2], more: &Polygons| [a + more.corners.len(), b + more.ends.len()];
        let [corners, ends] = all.fold([0; 2], add);
        self.corners.reserve_exact(corners);
        self.ends.reserve_exact(ends);
    }

    /// Appends the polygons of another list.
    pub fn append(&mut self, more: &Polygons) {
        let before = self.corners.len();
        self.corners.extend_from_slice(&more.corners);
        self.ends.extend(more.ends.iter().map(|end| before + end));
    }

    /// The vertices of each polygon, if all are triangles.
    ///
    /// # Errors
    /// As [`Polygons::triangles`].
    pub fn all_triangles(&self, budget: &mut Budget, place: Location<'_>) -> Result<Option<Vec<[u32; 3]>>> {
        let (triangles, []) = self.corners.as_chunks() else { return Ok(None) };
        if (1..).zip(&self.ends).any(|(k, &end)| end != 3 * k) {
            return Ok(None);
        }
        budget.take(triangles.len(), PER_TRIANGLE, "faces", place)?;
        Ok(Some(triangles.to_vec()))
    }

    /// The triangles, as three flat corner numbers each. Faces of one or two corners occur in files and have no triangles.
    ///
    /// A convex polygon becomes a fan from its first corner; another one is cut ear by ear in the plane of its area vector. The triangles
    /// are charged to the budget first, since a corner that takes one byte of a file becomes a triangle of many bytes.
    pub fn triangles(
        &self,
        positions: &[Point],
        budget: &mut Budget,
        place: Location<'_>,
    ) -> Result<Vec<[usize; 3]>> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let count = starts.zip(&self.ends).map(|(start, end)| (end - start).saturating_sub(2)).sum();
        budget.take(count, PER_TRIANGLE, "faces", place)?;
        let mut triangles = Vec::with_capacity(count);
        let mut start = 0;
        for &end in &self.ends {
            match end - start {
                0..=2 => {}
                3 => triangles.push([start, start + 1, start + 2]),
                4..=MOST_CORNERS => polygon(&self.corners[start..end], start, positions, &mut triangles),
                _ => triangles.extend((start + 2..end).map(|k| [start, k - 1, k])),
            }
            start = end;
        }
        Ok(triangles)
    }

    /// The vertices of each of these triangles.
    pub fn faces(&self, triangles: &[[usize; 3]]) -> Vec<[u32; 3]> {
        triangles.iter().map(|&t| self.face(t)).collect()
    }

    /// The vertices of a triangle of [`Polygons::triangles`].
    pub fn face(&self, triangle: [usize; 3]) -> [u32; 3] {
        triangle.map(|k| self.corners[k])
    }
}

/// Polygons cut into triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonTriangles {
    /// The triangles, polygon after polygon.
    pub soup: Soup,
    /// Per triangle the number of its polygon.
    pub polygon: Vec<u32>,
}

/// The triangles of polygons as files have them: convex ones become fans from their first corner, others are cut ear by ear. Polygon k has
/// the corners from `starts[k]` to before `starts[k + 1]`, the last entry of `starts` is the number of corners. A polygon of one or two
/// corners has no triangle.
///
/// ```
/// use ricci::mesh::io::triangles_of_polygons;
/// let positions = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [2., 0., 0.]];
/// let found = triangles_of_polygons(positions, &[0, 1, 2, 3, 1, 4, 2], &[0, 4, 7])?;
/// assert_eq!(found.soup.faces, [[0, 1, 2], [0, 2, 3], [1, 4, 2]]);
/// assert_eq!(found.polygon, [0, 0, 1]);
/// # Ok::<(), ricci::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] if `starts` does not ascend from 0 to the number of corners.
pub fn triangles_of_polygons(
    positions: Vec<Point>,
    corners: &[u32],
    starts: &[usize],
) -> Result<PolygonTriangles> {
    let ends = starts.get(1..).unwrap_or_default();
    let ascends = starts.windows(2).all(|pair| pair[0] <= pair[1]);
    if starts.first().is_some_and(|&start| start != 0) {
        return Err(Error::argument("starts[0]", starts[0], "0"));
    }
    if !ascends || ends.last().copied().unwrap_or(0) != corners.len() {
        return Err(Error::argument(
            "starts",
            format!("{} offsets", starts.len()),
            "ascending, and the last is the number of corners",
        ));
    }
    let polygons = Polygons { corners: corners.to_vec(), ends: ends.to_vec() };
    // A corner becomes at most one triangle, so that memory is bounded by what the caller holds.
    let mut budget = Budget::of_size(usize::MAX);
    let triangles = polygons.triangles(&positions, &mut budget, Location::whole("polygons"))?;
    let polygon = polygons.owners(&triangles).map(|k| k as u32).collect();
    Ok(PolygonTriangles { soup: Soup::new(positions, polygons.faces(&triangles)), polygon })
}

/// The knowledge about a corner of a polygon while ears are cut off.
#[derive(Clone, Copy)]
enum EarState {
    /// Unknown, because a neighbour was cut off.
    New,
    /// The corner turns inwards.
    Reflex,
    /// The triangle with its neighbours contains this corner.
    Blocked(usize),
}

fn polygon(corners: &[u32], start: usize, positions: &[Point], triangles: &mut Vec<[usize; 3]>) {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    if let Some(plane) = in_plane(corners, positions) {
        let turn = |[a, b, c]: [usize; 3]| orientation(plane[a], plane[b], plane[c]);
        let around = |left: &[usize], k: usize| {
            let n = left.len();
            [left[(k + n - 1) % n], left[k], left[(k + 1) % n]]
        };
        let convex = (0..left.len()).all(|k| turn(around(&left, k)) != Ordering::Less);
        let mut known = vec![EarState::New; corners.len()];
        let mut gone = vec![false; corners.len()];
        while !convex && left.len() > 3 {
            // The first ear in the polygon's order. A corner stays blocked until the one that blocks it is cut off.
            let ear = (0..left.len()).find(|&k| {
                let ear = around(&left, k);
                match known[ear[1]] {
                    EarState::Reflex => return false,
                    EarState::Blocked(p) if !gone[p] => return false,
                    _ => {}
                }
                if turn(ear) != Ordering::Greater {
                    known[ear[1]] = EarState::Reflex;
                    return false;
                }
                let blocking = blocking(ear, &left, corners, &plane);
                blocking.inspect(|&p| known[ear[1]] = EarState::Blocked(p)).is_none()
            });
            // A polygon that crosses itself has no ears at some point: the rest becomes a fan.
            let Some(k) = ear else { break };
            let ear = around(&left, k);
            triangles.push(ear.map(|k| start + k));
            gone[ear[1]] = true;
            (known[ear[0]], known[ear[2]]) = (EarState::New, EarState::New);
            left.remove(k);
        }
    }
    let fan = left.windows(2).skip(1).map(|w| [left[0], w[0], w[1]].map(|k| start + k));
    triangles.extend(fan);
}

/// The first remaining corner in this counter-clockwise triangle, on its edges included, that is none of its vertices.
fn blocking(ear: [usize; 3], left: &[usize], corners: &[u32], plane: &[[f64; 2]]) -> Option<usize> {
    let [a, b, c] = ear.map(|k| plane[k]);
    let low: [f64; 2] = std::array::from_fn(|i| a[i].min(b[i]).min(c[i]));
    let high: [f64; 2] = std::array::from_fn(|i| a[i].max(b[i]).max(c[i]));
    left.iter().copied().find(|&k| {
        let p = plane[k];
        let near = (0..2).all(|i| low[i] <= p[i] && p[i] <= high[i]);
        near && !ear.iter().any(|&q| corners[k] == corners[q])
            && [[a, b], [b, c], [c, a]].into_iter().all(|[u, v]| orientation(u, v, p) != Ordering::Less)
    })
}

/// The corners in the coordinate plane on which the area vector is largest, counter-clockwise. `None` for corners without a finite
/// position.
fn in_plane(corners: &[u32], positions: &[Point]) -> Option<Vec<[f64; 2]>> {
    let points: Option<Vec<Point>> = corners.iter().map(|&v| positions.get(v as usize).copied()).collect();
    let points = points?;
    let origin = *points.first()?;
    let mut area = [0.0; 3];
    for (p, q) in points.iter().zip(points.iter().cycle().skip(1)) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            area[k] += (p[i] - origin[i]) * (q[j] - origin[j]) - (p[j] - origin[j]) * (q[i] - origin[i]);
        }
    }
    if !area.iter().all(|x: &f64| x.is_finite()) {
        return None;
    }
    let k = (0..3).max_by(|&i, &j| area[i].abs().total_cmp(&area[j].abs()))?;
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let project = |p: Point| if area[k] >= 0.0 { [p[i], p[j]] } else { [p[j], p[i]] };
    Some(points.into_iter().map(project).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(polygons: &Polygons, positions: &[Point]) -> Vec<[usize; 3]> {
        polygons.triangles(positions, &mut Budget::of(&[]), Location::whole("t")).unwrap()
    }

    fn area(p: [[f64; 2]; 3]) -> f64 {
        0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]))
    }

    fn check(outline: &[[f64; 2]], expected: f64) {
        // In three planes and both orientations of each.
        for lift in [
            |p: [f64; 2]| [p[0], p[1], 0.5],
            |p: [f64; 2]| [0.1, p[0], p[1]],
            |p: [f64; 2]| [p[0], -3.0, p[1]],
        ] {
            let positions: Vec<Point> = outline.iter().map(|&p| lift(p)).collect();
            let n = outline.len() as u32;
            for corners in [(0..n).collect::<Vec<_>>(), (0..n).rev().collect()] {
                let mut polygons = Polygons::default();
                polygons.push([7, 8]);
                polygons.push(corners.iter().copied());
                let triangles = triangles(&polygons, &positions);
                assert_eq!(triangles.len(), outline.len() - 2);
                let areas: Vec<f64> =
                    triangles.iter().map(|&t| area(polygons.face(t).map(|v| outline[v as usize]))).collect();
                let sign = if corners[0] == 0 { 1.0 } else { -1.0 };
                assert!(areas.iter().all(|a| sign * a > 0.0), "{areas:?}");
                assert!((sign * areas.iter().sum::<f64>() - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn convex_and_star_shaped_and_winding_polygons_keep_their_area() {
        check(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 2.0);
        check(&[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]], 1.5);
        // A comb, whose fan from the first corner would fold.
        check(
            &[
                [0.0, 3.0],
                [0.0, 0.0],
                [5.0, 0.0],
                [5.0, 3.0],
                [4.0, 3.0],
                [4.0, 1.0],
                [3.0, 1.0],
                [3.0, 3.0],
                [2.0, 3.0],
                [2.0, 1.0],
                [1.0, 1.0],
                [1.0, 3.0],
            ],
            11.0,
        );
    }

    #[test]
    fn polygons_without_a_plane_are_fans() {
        let mut polygons = Polygons::default();
        polygons.push([0, 1, 2, 9]);
        let positions = [[0.0; 3]; 3];
        assert_eq!(triangles(&polygons, &positions), [[0, 1, 2], [0, 2, 3]]);
        let mut bowtie = Polygons::default();
        bowtie.push([0, 1, 2, 3]);
        let crossing = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(triangles(&bowtie, &crossing).len(), 2);
    }
}

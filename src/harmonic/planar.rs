//! Harmonic maps of disks onto disks, convex polygons and rectangles.
//!
//! ```
//! use ricci::{Control, Surface, harmonic::{Domain, planar}, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(6)?)?;
//! let domain = Domain::new(&disk, &Control::new())?;
//! let map = planar::to_disk(&domain, &Control::new())?;
//! assert!(planar::flipped(&domain, &map.points).is_empty());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::map::{HarmonicMap, MapConstraints, harmonic_map};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, distance, scale, sub};
use crate::geometry::predicates::orientation;
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// The vertices of the boundary of a disk, once around with the surface on the left, each with the share of the boundary's length before
/// it.
///
/// # Errors
/// [`Error::Layout`] for a surface that is no disk.
fn boundary(domain: &Domain) -> Result<Vec<(VertexId, f64)>> {
    let mesh = domain.mesh();
    let loops = mesh.boundary_loops();
    let ([outside], 1) = (&loops[..], mesh.euler()) else {
        let (genus, n) = (mesh.genus(), loops.len());
        return Err(Error::Layout(format!(
            "the surface has genus {genus} and {n} boundary loops; a disk, with one loop, is needed: punch or fill it"
        )));
    };
    // The twins of the outside half-edges, in reverse order, have the surface on the left.
    let around: Vec<HalfedgeId> = outside.iter().rev().map(|h| h.twin()).collect();
    let lengths: Vec<f64> = around.iter().map(|h| domain.lengths()[h.edge()]).collect();
    let total: f64 = lengths.iter().sum();
    let mut before = 0.0;
    let place = |(h, l): (&HalfedgeId, &f64)| {
        let share = before / total;
        before += l;
        (mesh.origin(*h), share)
    };
    Ok(around.iter().zip(&lengths).map(place).collect())
}

fn with_values(
    domain: &Domain,
    values: Vec<(VertexId, Complex)>,
    control: &Control,
) -> Result<HarmonicMap<2>> {
    harmonic_map(domain, &MapConstraints { values, flux: None }, control)
}

/// The harmonic map of a disk onto the unit disk, with the boundary spread over the circle by its length. On a Delaunay triangulation,
/// where the weights are at least 0, it is injective by the theorem of Tutte and Floater \[Flo03\] if no two edges have the same ends
/// ([`super::simple_domain`]).
///
/// # Errors
/// [`Error::Layout`] for a surface that is no disk; those of [`harmonic_map`].
pub fn to_disk(domain: &Domain, control: &Control) -> Result<HarmonicMap<2>> {
    with_values(domain, disk_values(domain)?, control)
}

/// The images of the boundary vertices under [`to_disk`].
///
/// # Errors
/// [`Error::Layout`] for a surface that is no disk.
pub fn disk_values(domain: &Domain) -> Result<Vec<(VertexId, Complex)>> {
    let on_circle = |(v, share): (VertexId, f64)| (v, [(TAU * share).cos(), (TAU * share).sin()]);
    Ok(boundary(domain)?.into_iter().map(on_circle).collect())
}

/// The harmonic map of a disk onto a convex polygon, with the boundary spread over each side by its length. `corners`: the vertices that
/// are mapped to the polygon's corners, in the boundary's order with the surface on the left; without them the boundary is divided in
/// proportion to the polygon's sides.
///
/// # Errors
/// [`Error::Argument`] for a polygon that is not strictly convex and counterclockwise, and corners that do not follow each other on the
/// boundary; [`Error::Layout`] for a surface that is no disk; those of [`harmonic_map`].
pub fn to_polygon(
    domain: &Domain,
    polygon: &[Complex],
    corners: Option<&[VertexId]>,
    control: &Control,
) -> Result<HarmonicMap<2>> {
    with_values(domain, polygon_values(domain, polygon, corners)?, control)
}

/// The images of the boundary vertices under [`to_polygon`].
///
/// # Errors
/// As [`to_polygon`].
pub fn polygon_values(
    domain: &Domain,
    polygon: &[Complex],
    corners: Option<&[VertexId]>,
) -> Result<Vec<(VertexId, Complex)>> {
    let n = polygon.len();
    let turns =
        |k: usize| orientation(polygon[k], polygon[(k + 1) % n], polygon[(k + 2) % n]) == Ordering::Greater;
    let directions = (0..n).map(|k| sub(polygon[(k + 1) % n], polygon[k])).map(|d| d[1].atan2(d[0]));
    let angles: Vec<f64> = directions.collect();
    let turning: f64 = (0..n).map(|k| (angles[(k + 1) % n] - angles[k]).rem_euclid(TAU)).sum();
    if n < 3 || !(0..n).all(turns) || (turning - TAU).abs() > 1e-6 {
        return Err(Error::argument(
            "polygon",
            format!("{n} corners"),
            "strictly convex and counterclockwise",
        ));
    }
    let around = boundary(domain)?;
    let shares = match corners {
        Some(corners) => corner_shares(&around, corners, n)?,
        None => {
            let sides: Vec<f64> = (0..n).map(|k| distance(polygon[k], polygon[(k + 1) % n])).collect();
            let total: f64 = sides.iter().sum();
            let mut before = 0.0;
            let start = |side: f64| {
                let share = before / total;
                before += side;
                share
            };
            sides.into_iter().map(start).collect()
        }
    };
    let on_polygon = |(v, share): (VertexId, f64)| {
        // Shares are measured from the first corner, so that they ascend from corner to corner.
        let along = |x: f64| (x - shares[0]).rem_euclid(1.0);
        let k = (0..n).rfind(|&k| along(shares[k]) <= along(share)).unwrap_or(0);
        let end = if k + 1 < n { along(shares[k + 1]) } else { 1.0 };
        let t = (along(share) - along(shares[k])) / (end - along(shares[k]));
        (v, add(polygon[k], scale(t, sub(polygon[(k + 1) % n], polygon[k]))))
    };
    Ok(around.iter().copied().map(on_polygon).collect())
}

/// The boundary vertex whose share of the length is nearest to this one.
fn nearest(around: &[(VertexId, f64)], share: f64) -> VertexId {
    let off = |x: f64| (x - share).abs();
    around.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map_or(VertexId(0), |(v, _)| *v)
}

/// The boundary vertices nearest to the ends of n equal parts of a disk's boundary, from its first vertex on: corners for [`to_polygon`].
///
/// # Errors
/// [`Error::Layout`] for a surface that is no disk; [`Error::Argument`] if one vertex is nearest to two ends.
pub fn corners_by_length(domain: &Domain, n: usize) -> Result<Vec<VertexId>> {
    evenly(&boundary(domain)?, n)
}

fn evenly(around: &[(VertexId, f64)], n: usize) -> Result<Vec<VertexId>> {
    // The count is bounded, so that an absurd number of corners is refused without memory for them.
    let found: Vec<VertexId> =
        (0..n.min(around.len() + 1)).map(|k| nearest(around, k as f64 / n as f64)).collect();
    let distinct = found.iter().collect::<BTreeSet<_>>().len();
    if distinct < n {
        let need = "fewer, or named ones: one boundary vertex is nearest to two of them";
        return Err(Error::argument("number of corners", n, need));
    }
    Ok(found)
}

/// The regular polygon with n corners on the unit circle, counterclockwise from (1, 0).
pub fn regular_polygon(n: usize) -> Vec<Complex> {
    let corner = |k: usize| (TAU * k as f64 / n as f64).sin_cos();
    (0..n).map(corner).map(|(sin, cos)| [cos, sin]).collect()
}

/// The shares of the boundary's length at which these corners lie.
fn corner_shares(around: &[(VertexId, f64)], corners: &[VertexId], n: usize) -> Result<Vec<f64>> {
    let share = |c: &VertexId| around.iter().find(|(v, _)| v == c).map(|(_, share)| *share);
    let shares: Vec<f64> = corners.iter().filter_map(share).collect();
    let after = |k: usize| (shares[k] - shares[0]).rem_euclid(1.0);
    if shares.len() != n || corners.len() != n || (1..n).any(|k| after(k) <= after(k - 1)) {
        let named = corners.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        return Err(Error::argument(
            "corners",
            named,
            "one boundary vertex per corner, in order with the surface on the left",
        ));
    }
    Ok(shares)
}

/// The map of a disk with four corners onto the rectangle of its modulus.
#[derive(Debug, Clone, PartialEq)]
pub struct RectangleMap {
    /// The map onto `[0, modulus] × [0, 1]`.
    pub map: HarmonicMap<2>,
    /// The vertices that go to the rectangle's corners, from (0, 0) on, counterclockwise.
    pub corners: [VertexId; 4],
    /// The modulus: width over height of the rectangle that the disk is conformal to, up to O(h²). It is the geometric mean of its bounds.
    pub modulus: f64,
    /// A lower and an upper bound of the modulus of the triangulated surface itself, from the energies of both coordinates: each is at least
    /// that of the smooth harmonic function with its values (Dirichlet's principle).
    pub bounds: [f64; 2],
}

/// The map of a disk with four corners onto the rectangle of its modulus, `[0, width] × [0, 1]`, and the corners. Each coordinate is
/// harmonic with given values on two sides and no flux through the others, so the map is conformal up to O(h²). The first side, from corner
/// 0 to corner 1, is the bottom.
///
/// `corners`: four vertices of the boundary in its order with the surface on the left; default: [`corners_by_length`].
///
/// # Errors
/// As [`to_polygon`].
pub fn to_rectangle(
    domain: &Domain,
    corners: Option<[VertexId; 4]>,
    control: &Control,
) -> Result<RectangleMap> {
    let around = boundary(domain)?;
    let corners = match corners {
        Some(corners) => corners,
        None => {
            let found = evenly(&around, 4)?;
            [0, 1, 2, 3].map(|k| found[k])
        }
    };
    let shares = corner_shares(&around, &corners, 4)?;
    let along = |x: f64| (x - shares[0]).rem_euclid(1.0);
    let side = |k: usize| -> Vec<VertexId> {
        let end = if k < 3 { along(shares[k + 1]) } else { 1.0 };
        let is_on = |x: f64| (along(shares[k]) <= x && x <= end) || (k == 3 && x == 0.0);
        around.iter().filter(|(_, share)| is_on(along(*share))).map(|(v, _)| *v).collect()
    };
    let between = |low: usize, high: usize| {
        let low = side(low).into_iter().map(|v| (v, [0.0]));
        let values = low.chain(side(high).into_iter().map(|v| (v, [1.0]))).collect();
        harmonic_map(domain, &MapConstraints { values, flux: None }, control)
    };
    let (x, y) = (between(3, 1)?, between(0, 2)?);
    // The energy ½∫|∇x|² of x from 0 to 1 is half of height over width, and that of y is half of width over height.
    let width = (y.energy / x.energy).sqrt();
    let points: Vec<Complex> = x.points.iter().zip(&y.points).map(|([x], [y])| [width * x, *y]).collect();
    let energy = width * width * x.energy + y.energy;
    let mean_value_residual = x.mean_value_residual.max(y.mean_value_residual);
    let bounds = [0.5 / x.energy, 2.0 * y.energy];
    let map = HarmonicMap { points, energy, mean_value_residual };
    Ok(RectangleMap { map, corners, modulus: width, bounds })
}

/// The faces of the domain whose images under a map to the plane are not counterclockwise, by exact arithmetic.
pub fn flipped(domain: &Domain, points: &[Complex]) -> Vec<FaceId> {
    let mesh = domain.mesh();
    let is_left = |f: FaceId| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| points[v.index()]);
        orientation(a, b, c) == Ordering::Greater
    };
    mesh.faces().filter(|&f| !is_left(f)).collect()
}

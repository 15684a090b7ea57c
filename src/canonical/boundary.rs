//! The shape that the boundary of a surface is given: geodesic loops, or straight sides between corners.
//!
//! ```
//! use ricci::canonical::{Boundary, Corners, QuotientOptions, uniformize_quotient};
//! use ricci::{Control, Surface, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(8)?)?;
//! let boundary = Boundary::Straight(Corners::Default);
//! let options = QuotientOptions { boundary, ..QuotientOptions::default() };
//! let rectangle = uniformize_quotient(&disk, &options, &Control::new())?;
//! // By the symmetry of this disk, nearly a square.
//! assert!((rectangle.extremal_distance().unwrap() - 1.0).abs() < 0.05);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{HalfedgeId, Mesh, PerVertex, VertexId};
use crate::metric::target::TOTAL_TOLERANCE;
use crate::metric::{Surface, curvature};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// The shape that the boundary of an open surface is given.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Boundary {
    /// Every loop a closed geodesic: in H² where χ < 0, in E² on an annulus. A disk has none.
    #[default]
    Geodesic,
    /// Straight sides between corners, in E².
    Straight(Corners),
}

/// The corners of a straight boundary.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Corners {
    /// 4|χ| corners that turn by a quarter each: four right angles on a disk, none on an annulus; placed as [`Corners::Count`] does.
    #[default]
    Default,
    /// This number of corners with equal angles. They are the vertices where the boundary turns by more than π/4 if there are exactly so
    /// many, from that of the lowest number on; else they lie at equal distances along the longest boundary loop, from the vertex where
    /// that turns most.
    Count(usize),
    /// The corners that the caller names.
    At(Vec<BoundaryCorner>),
}

/// A corner of a straight boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryCorner {
    /// A vertex of the boundary.
    pub vertex: VertexId,
    /// The angle inside the corner, radians; `None` for the one that all such corners share, with which the total is right.
    pub angle: Option<f64>,
}

impl Boundary {
    /// The space of the metric in which a surface with boundary has this shape.
    ///
    /// # Errors
    /// [`Error::Layout`] for geodesic loops around a disk.
    pub fn space(&self, mesh: &Mesh) -> Result<Space> {
        match self {
            Boundary::Geodesic if mesh.euler() > 0 => Err(Error::Layout(
                "a disk has no metric of constant curvature with a geodesic boundary, unless as half of a sphere; give its \
                 boundary straight sides with corners, or make it a circle"
                    .into(),
            )),
            Boundary::Geodesic if mesh.euler() < 0 => Ok(Space::H2),
            _ => Ok(Space::E2),
        }
    }

    /// The corners with their angles in radians, in the order in which they were named.
    ///
    /// # Errors
    /// [`Error::Argument`] for a vertex that is not on the boundary, named twice, or an angle that is not positive; more corners than the
    /// boundary has vertices; [`Error::TargetTotal`] for angles that Gauss–Bonnet rules out.
    pub fn corners(&self, surface: &Surface) -> Result<Vec<(VertexId, f64)>> {
        let Boundary::Straight(corners) = self else { return Ok(Vec::new()) };
        let mesh = surface.mesh();
        let named = match corners {
            Corners::Default => placed(surface, 4 * mesh.euler().unsigned_abs() as usize)?,
            Corners::Count(n) => placed(surface, *n)?,
            Corners::At(corners) => corners.clone(),
        };
        with_angles(mesh, &named)
    }
}

/// The curvature of every vertex for corners with these angles.
pub(super) fn target(mesh: &Mesh, corners: &[(VertexId, f64)]) -> PerVertex<f64> {
    let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
    corners.iter().for_each(|&(v, angle)| target[v] = PI - angle);
    target
}

/// The corners, with values for the angles that were left open.
fn with_angles(mesh: &Mesh, corners: &[BoundaryCorner]) -> Result<Vec<(VertexId, f64)>> {
    for (k, corner) in corners.iter().enumerate() {
        let v = corner.vertex;
        if v.index() >= mesh.n_vertices() || !mesh.is_boundary_vertex(v) {
            return Err(Error::argument("corner", v, "a vertex of the boundary"));
        }
        if corners[..k].iter().any(|other| other.vertex == v) {
            return Err(Error::argument("corner", v, "named once"));
        }
        if let Some(angle) = corner.angle.filter(|angle| !(angle.is_finite() && *angle > 0.0)) {
            return Err(Error::argument("angle of a corner", angle, "positive, in radians"));
        }
    }
    // The angles inside of n corners add up to nπ − 2πχ.
    let needed = PI * corners.len() as f64 - TAU * mesh.euler() as f64;
    let given: f64 = corners.iter().filter_map(|corner| corner.angle).sum();
    let open = corners.iter().filter(|corner| corner.angle.is_none()).count();
    let share = (needed - given) / open as f64;
    let miss = given - needed;
    let wrong = match open {
        0 => miss.abs() > TOTAL_TOLERANCE * (TAU + given),
        _ => share <= 0.0,
    };
    if wrong {
        let [needed, given] = [needed, given].map(f64::to_degrees);
        let (sum, n) = (PI * corners.len() as f64 - given.to_radians(), corners.len());
        let left = if open == 0 { String::new() } else { format!(", and {open} of them are left to fit") };
        return Err(Error::TargetTotal {
            sum,
            need: format!(
                "exactly 2πχ: the angles inside {n} corners have to add up to {needed}° here, those given to {given}°{left}"
            ),
            miss: -miss,
        });
    }
    Ok(corners.iter().map(|corner| (corner.vertex, corner.angle.unwrap_or(share))).collect())
}

/// `n` corners, placed as [`Corners::Count`] says.
fn placed(surface: &Surface, n: usize) -> Result<Vec<BoundaryCorner>> {
    let (mesh, lengths) = (surface.mesh(), surface.lengths());
    let turns = curvature(mesh, surface.geometry(), lengths)?.at;
    let at = |v| BoundaryCorner { vertex: v, angle: None };
    let mut loops: Vec<Vec<HalfedgeId>> = mesh.boundary_loops();
    // Outside half-edges run backwards: the surface is on their right.
    loops.iter_mut().for_each(|walk| walk.reverse());
    let vertices = loops.iter().flatten().map(|&h| mesh.tip(h));
    let mut sharp: Vec<VertexId> = vertices.filter(|&v| turns[v].abs() > FRAC_PI_4).collect();
    if sharp.len() == n {
        let first = (0..n).min_by_key(|&k| sharp[k]);
        sharp.rotate_left(first.unwrap_or(0));
        return Ok(sharp.into_iter().map(at).collect());
    }
    let length = |walk: &Vec<HalfedgeId>| walk.iter().map(|h| lengths[h.edge()]).sum::<f64>();
    let longest = loops.into_iter().max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or_default();
    if longest.len() < n {
        let need = "at most the number of vertices of the longest boundary loop";
        return Err(Error::argument("number of corners", n, need));
    }
    let sharpest = (0..longest.len())
        .max_by(|&i, &j| turns[mesh.tip(longest[i])].total_cmp(&turns[mesh.tip(longest[j])]).then(j.cmp(&i)));
    let mut walk = longest.clone();
    walk.rotate_left(sharpest.unwrap_or(0));
    Ok(evenly(&walk.iter().map(|h| lengths[h.edge()]).collect::<Vec<_>>(), n)
        .into_iter()
        .map(|k| at(mesh.tip(walk[k])))
        .collect())
}

/// A choice of `n` places at nearly equal distances around a loop, the first one included, ascending. `steps`: the distance of each place
/// to the next one.
pub(crate) fn evenly(steps: &[f64], n: usize) -> Vec<usize> {
    let total: f64 = steps.iter().sum();
    let positions: Vec<f64> = steps
        .iter()
        .scan(0.0, |position, step| {
            *position += step;
            Some(*position - step)
        })
        .collect();
    let mut chosen = Vec::with_capacity(n);
    for k in 0..n {
        let wanted = total * k as f64 / n as f64;
        let first = chosen.last().map_or(0, |&last: &usize| last + 1);
        // The remaining ones have to fit behind it.
        let last = steps.len() - (n - k);
        let nearest = (first..=last)
            .min_by(|&i, &j| (positions[i] - wanted).abs().total_cmp(&(positions[j] - wanted).abs()));
        chosen.extend(nearest);
    }
    chosen
}

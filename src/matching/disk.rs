//! Corners for disks whose boundary nobody has marked: both go to the unit disk, and one is turned until the conformal factors fit best.

use super::density::{Factors, factors};
use crate::canonical::{CircleDomainOptions, circle_domain};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Options;
use crate::geometry::complex::{Complex, doubled_area, mul, norm2};
use crate::mesh::VertexId;
use crate::metric::Surface;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Corners of a disk.
const CORNERS: usize = 4;
/// Rings and sectors of the raster of the disk in which conformal factors are compared.
const RINGS: usize = 8;
/// Sectors of a ring.
const SECTORS: usize = 128;
/// A rotation by the moments of the area, which is exact for copies of one surface, is taken unless another one fits better by more than this share.
const BETTER: f64 = 0.9;

/// A surface in the unit disk.
struct Disk {
    points: Vec<Complex>,
    /// Share of the area around each vertex.
    weights: Vec<f64>,
    /// Per cell of the raster: mean conformal factor and share of the area.
    raster: Vec<Option<(f64, f64)>>,
}

/// Four corners on each boundary, in corresponding order: where the unit circles, to which the boundaries go conformally with the barycentre of the area at
/// the centre, meet two axes.
///
/// # Errors
/// [`Error::Matching`] for a boundary of fewer than four vertices; those of [`circle_domain`].
pub(super) fn corners(
    surfaces: [&Surface; 2],
    flow: &Options,
    control: &Control,
) -> Result<[Vec<VertexId>; 2]> {
    let disks = [disk(surfaces[0], flow, control)?, disk(surfaces[1], flow, control)?];
    let moment = |disk: &Disk| {
        let square = |(z, w): (&Complex, &f64)| mul(*z, *z).map(|x| w * x);
        disk.points.iter().zip(&disk.weights).map(square).fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y])
    };
    let axis = |disk: &Disk| {
        let [x, y] = moment(disk);
        0.5 * y.atan2(x)
    };
    let axes = [axis(&disks[0]), axis(&disks[1])];
    let by_axes = [axes[1] - axes[0], axes[1] - axes[0] + 0.5 * TAU];
    let off = |turn: f64| difference(&disks[0], &disks[1], turn);
    let least = |turns: &[f64]| turns.iter().map(|&t| (off(t), t)).min_by(|a, b| a.0.total_cmp(&b.0));
    let exact = least(&by_axes);
    let all: Vec<f64> = (0..2 * SECTORS).map(|k| TAU * k as f64 / (2 * SECTORS) as f64).collect();
    let turn = match (exact, least(&all)) {
        (Some(exact), Some(found)) if found.0 < BETTER * exact.0 => found.1,
        (Some(exact), _) => exact.1,
        _ => 0.0,
    };
    let of = |s: usize, start: f64| nearest(surfaces[s], &disks[s], start);
    Ok([of(0, axes[0])?, of(1, axes[0] + turn)?])
}

fn disk(surface: &Surface, flow: &Options, control: &Control) -> Result<Disk> {
    let options = CircleDomainOptions { flow: flow.clone(), ..CircleDomainOptions::default() };
    let domain = circle_domain(surface, &options, control)?;
    let (mesh, layout) = (surface.mesh(), &domain.layout);
    let mut points = vec![[0.0; 2]; mesh.n_vertices()];
    for f in layout.mesh().faces() {
        for (v, at) in layout.mesh().face_vertices(f).into_iter().zip(layout.face_uv(f)) {
            if let Some(point) = points.get_mut(v.index()) {
                *point = at;
            }
        }
    }
    let flat = |f| 0.5 * doubled_area(mesh.face_vertices(f).map(|v| points[v.index()])).abs();
    let Factors { values, weights } = factors(surface, flat);
    let mut sums = vec![[0.0; 2]; RINGS * SECTORS];
    for ((z, w), factor) in points.iter().zip(&weights).zip(&values) {
        let sum = &mut sums[cell(*z, 0.0)];
        (sum[0], sum[1]) = (sum[0] + w * factor, sum[1] + w);
    }
    let raster = sums.into_iter().map(|[sum, w]| (w > 0.0).then(|| (sum / w, w))).collect();
    Ok(Disk { points, weights, raster })
}

/// The cell of a point that is turned: rings of equal area.
fn cell(z: Complex, turn: f64) -> usize {
    let ring = ((norm2(z) * RINGS as f64) as usize).min(RINGS - 1);
    let angle = (z[1].atan2(z[0]) + turn).rem_euclid(TAU) / TAU;
    ring * SECTORS + ((angle * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// Mean square difference of the conformal factors, the first disk turned; cells that are empty in either do not count.
fn difference(from: &Disk, to: &Disk, turn: f64) -> f64 {
    let (mut sum, mut total) = (0.0, f64::MIN_POSITIVE);
    for (k, entry) in from.raster.iter().enumerate() {
        let Some((value, w)) = entry else { continue };
        let (ring, sector) = (k / SECTORS, k % SECTORS);
        let (r, angle) =
            (((ring as f64 + 0.5) / RINGS as f64).sqrt(), TAU * (sector as f64 + 0.5) / SECTORS as f64);
        if let Some((other, _)) = to.raster[cell([r * angle.cos(), r * angle.sin()], turn)] {
            (sum, total) = (sum + w * (value - other) * (value - other), total + w);
        }
    }
    sum / total
}

/// The vertices of the boundary nearest to four directions, a quarter of a turn apart.
fn nearest(surface: &Surface, disk: &Disk, start: f64) -> Result<Vec<VertexId>> {
    let mesh = surface.mesh();
    let boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let mut found: Vec<VertexId> = Vec::with_capacity(CORNERS);
    for k in 0..CORNERS {
        let direction = start + FRAC_PI_2 * k as f64;
        let off = |v: &VertexId| {
            let [x, y] = disk.points[v.index()];
            let turn = (y.atan2(x) - direction).rem_euclid(TAU);
            turn.min(TAU - turn)
        };
        found.extend(boundary.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)).then(a.cmp(b))));
    }
    let is_simple = (1..found.len()).all(|k| !found[..k].contains(&found[k]));
    if found.len() == CORNERS && is_simple {
        return Ok(found);
    }
    Err(Error::Matching(format!(
        "the boundary of {} vertices is too coarse for {CORNERS} corners: name pairs of vertices on it as landmarks, or refine it",
        boundary.len()
    )))
}

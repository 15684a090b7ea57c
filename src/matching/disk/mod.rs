//! Disks with few marks: corners are added on the boundary, after which the disk is an orbifold with a flat or hyperbolic metric.
//!
//! Both surfaces are mapped conformally onto the unit disk, a landmark inside to the centre, two marked corners to opposite points. The
//! rotation that remains free is chosen so that the conformal factors fit best, and corresponding corners have corresponding directions.

mod unit_disk;

use super::domain_pair::DomainPair;
use super::fit::best_turn;
use super::landmarks::{MarkedSurface, Marks};
use super::options::MatchOptions;
use super::orbifold::in_orbifold;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::VertexId;
use crate::metric::Surface;
use std::f64::consts::{FRAC_PI_2, TAU};
use unit_disk::{SECTORS, UnitDisk};

/// Corners of a disk.
const CORNERS: usize = 4;
/// Share of the difference that the rotations which align the axes of inertia leave, below which another rotation is taken instead: the
/// former are exact for two copies of one surface.
const BETTER: f64 = 0.9;

/// Both disks in the domain of the target with the corners that they lack.
///
/// # Errors
/// [`Error::Matching`] for a boundary of fewer than four vertices; those of [`crate::canonical::circle_domain()`] and [`in_orbifold`].
pub(super) fn with_corners(
    sides: [MarkedSurface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<DomainPair> {
    let [first, second] = corners(sides, options, control)?;
    let with = |s: usize, corners| Marks { corners, ..sides[s].marks.clone() };
    let marks = [with(0, first), with(1, second)];
    in_orbifold([0, 1].map(|s| MarkedSurface { marks: &marks[s], ..sides[s] }), options, control)
}

/// The corners of both surfaces in corresponding order: those that are marked, and those that are added.
///
/// Without marks the corners are where the boundary meets two axes through the barycentre of the area. With a landmark inside one corner is
/// enough: the pair of vertices whose directions differ least. Beside marked corners, corners are added a quarter of the circle from each
/// other.
fn corners(
    sides: [MarkedSurface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<[Vec<VertexId>; 2]> {
    let disk = |s: usize| UnitDisk::new(sides[s].surface, &options.flow, control);
    let mut disks = [disk(0)?, disk(1)?];
    for (disk, side) in disks.iter_mut().zip(sides) {
        disk.centre(side.marks)?;
    }
    let (surfaces, marks) = (sides.map(|side| side.surface), sides.map(|side| side.marks));
    let starts = match (marks[0].corners.first(), marks[0].landmarks.first()) {
        (Some(_), _) => [0, 1].map(|s| disks[s].angle(marks[s].corners[0])),
        (None, Some(_)) => {
            let [from, to] = [0, 1].map(|s| disks[s].around(marks[s].landmarks[0]));
            let turn = best_turn(&from, &to);
            return Ok(closest(surfaces, &disks, turn).map(|v| vec![v]));
        }
        (None, None) => by_factors(&disks),
    };
    let of = |s: usize| with_nearest(surfaces[s], &disks[s], starts[s], &marks[s].corners);
    Ok([of(0)?, of(1)?])
}

/// The vertices of the two boundaries whose directions differ least after the first disk is rotated.
fn closest(surfaces: [&Surface; 2], disks: &[UnitDisk; 2], turn: f64) -> [VertexId; 2] {
    let angles = |s: usize, turn: f64| -> Vec<(f64, VertexId)> {
        let mesh = surfaces[s].mesh();
        let boundary = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v));
        let mut all: Vec<_> = boundary.map(|v| ((disks[s].angle(v) + turn).rem_euclid(TAU), v)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all
    };
    let (from, to) = (angles(0, turn), angles(1, 0.0));
    let mut best = (f64::INFINITY, [VertexId(0); 2]);
    for (angle, v) in from {
        let after = to.partition_point(|other| other.0 < angle);
        for k in [after + to.len() - 1, after] {
            let (other, w) = to[k % to.len()];
            let off = (angle - other).rem_euclid(TAU);
            let off = off.min(TAU - off);
            if off < best.0 {
                best = (off, [v, w]);
            }
        }
    }
    best.1
}

/// The directions of corresponding axes of two disks without marks.
fn by_factors(disks: &[UnitDisk; 2]) -> [f64; 2] {
    let axes = [disks[0].axis(), disks[1].axis()];
    let by_axes = [axes[1] - axes[0], axes[1] - axes[0] + 0.5 * TAU];
    let off = |turn: f64| disks[0].difference(&disks[1], turn);
    let least = |turns: &[f64]| turns.iter().map(|&t| (off(t), t)).min_by(|a, b| a.0.total_cmp(&b.0));
    let exact = least(&by_axes);
    let all: Vec<f64> = (0..2 * SECTORS).map(|k| TAU * k as f64 / (2 * SECTORS) as f64).collect();
    let turn = match (exact, least(&all)) {
        (Some(exact), Some(found)) if found.0 < BETTER * exact.0 => found.1,
        (Some(exact), _) => exact.1,
        _ => 0.0,
    };
    [axes[0], axes[0] + turn]
}

/// The corners that are marked, and the vertices of the boundary nearest to the others of four directions, a quarter of the circle apart.
fn with_nearest(
    surface: &Surface,
    disk: &UnitDisk,
    start: f64,
    marked: &[VertexId],
) -> Result<Vec<VertexId>> {
    let mesh = surface.mesh();
    let boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let mut found: Vec<VertexId> = marked.to_vec();
    let quarters = match marked.len() {
        0 => 0..CORNERS,
        _ => 1..CORNERS,
    };
    // Two marked corners are opposite each other.
    for k in quarters.filter(|&k| !(marked.len() == 2 && k == 2)) {
        let direction = start + FRAC_PI_2 * k as f64;
        let off = |v: &VertexId| {
            let turn = (disk.angle(*v) - direction).rem_euclid(TAU);
            turn.min(TAU - turn)
        };
        found.extend(boundary.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)).then(a.cmp(b))));
    }
    let is_simple = (1..found.len()).all(|k| !found[..k].contains(&found[k]));
    if found.len() == CORNERS && is_simple {
        return Ok(found);
    }
    Err(Error::Matching(format!(
        "the boundary of {} vertices is too coarse for {CORNERS} corners: name pairs of vertices on it as landmarks, or refine it (`ricci refine --edge L`)",
        boundary.len()
    )))
}

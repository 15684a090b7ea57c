//! Corners for disks of whose boundary no more than two vertices are marked: both go to the unit disk, a landmark inside to its centre, two
//! marked corners to opposite points. What turn is left is chosen so that the conformal factors fit best.

use super::axis::{Around, best_turn, centre};
use super::density::{Factors, factors};
use super::route::Marks;
use crate::canonical::{CircleDomainOptions, circle_domain};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Options;
use crate::geometry::complex::{Complex, doubled_area, mul, norm2};
use crate::geometry::mobius::Mobius;
use crate::mesh::VertexId;
use crate::metric::Surface;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Corners of a disk.
const CORNERS: usize = 4;
/// Rings and sectors of the raster of the disk in which conformal factors are compared.
const RINGS: usize = 8;
/// Sectors of a ring.
const SECTORS: usize = 128;
/// A rotation by the moments of the area, which is exact for copies of one surface, is taken unless another one fits better by more than
/// this share.
const BETTER: f64 = 0.9;
/// Least distance from a corner, in the unit disk, that enters a barycentre.
const NEAR_CORNER: f64 = 1e-12;

/// A surface in the unit disk.
struct Disk {
    points: Vec<Complex>,
    /// Share of the area around each vertex.
    weights: Vec<f64>,
    /// Per cell of the raster: mean conformal factor and share of the area.
    raster: Vec<Option<(f64, f64)>>,
}

/// Both surfaces' corners, in corresponding order: those that are marked, and others that they lack. The boundaries go conformally to unit
/// circles. Without marks the corners are where these meet two axes through the barycentres of the area. With a landmark inside, which goes
/// to the centre, one corner is enough: the pair of vertices whose directions differ least. With marked corners they are a quarter of the
/// circle from each other, and between two marked ones lies the area in the middle.
///
/// # Errors
/// [`Error::Matching`] for a boundary of fewer than four vertices; those of [`circle_domain`].
pub(super) fn corners(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    flow: &Options,
    control: &Control,
) -> Result<[Vec<VertexId>; 2]> {
    let mut disks = [disk(surfaces[0], flow, control)?, disk(surfaces[1], flow, control)?];
    for (disk, marks) in disks.iter_mut().zip(marks) {
        disk.centre(marks)?;
    }
    let starts = match (marks[0].corners.first(), marks[0].landmarks.first()) {
        (Some(_), _) => [0, 1].map(|s| disks[s].angle(marks[s].corners[0])),
        (None, Some(_)) => {
            let [from, to] = [0, 1].map(|s| disks[s].around(marks[s].landmarks[0]));
            let turn = best_turn(&from, &to);
            return Ok(closest(surfaces, &disks, turn).map(|v| vec![v]));
        }
        (None, None) => by_factors(&disks),
    };
    let of = |s: usize| nearest(surfaces[s], &disks[s], (starts[s], &marks[s].corners));
    Ok([of(0)?, of(1)?])
}

/// The vertices of the two boundaries whose directions differ least after the turn of the first.
fn closest(surfaces: [&Surface; 2], disks: &[Disk; 2], turn: f64) -> [VertexId; 2] {
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
fn by_factors(disks: &[Disk; 2]) -> [f64; 2] {
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
    [axes[0], axes[0] + turn]
}

impl Disk {
    fn angle(&self, v: VertexId) -> f64 {
        let [x, y] = self.points[v.index()];
        y.atan2(x)
    }

    /// The vertices about the centre, but for the landmark there, which has no direction.
    fn around(&self, landmark: VertexId) -> Vec<Around> {
        let of = |(z, w): (&Complex, &f64)| (norm2(*z), z[1].atan2(z[0]), *w);
        let all = self.points.iter().zip(&self.weights).enumerate();
        all.filter(|(v, _)| *v != landmark.index()).map(|(_, zw)| of(zw)).collect()
    }

    /// Brings a landmark to the centre, or two corners to opposite points and the area between them to the middle.
    fn centre(&mut self, marks: &Marks) -> Result<()> {
        match (&marks.landmarks[..], &marks.corners[..]) {
            ([landmark, ..], []) => self.apply(&Mobius::to_origin(self.points[landmark.index()])),
            (_, &[first, second]) => {
                let [from, to] = [self.angle(first), self.angle(second)];
                let middle = from + 0.5 * (to - from).rem_euclid(TAU);
                let on = |angle: f64| [angle.cos(), angle.sin()];
                let opposite =
                    Mobius::of_triples([on(from), on(to), on(middle)], [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]]);
                let Some(opposite) = opposite else {
                    return Err(Error::Matching(format!(
                        "landmarks conflict: the vertices {first} and {second} of a boundary go to one point of the circle"
                    )));
                };
                self.apply(&opposite);
                // Möbius transformations that keep the corners are shifts of the real part of artanh z.
                let shares = |(z, w): (&Complex, &f64)| {
                    let [ahead, behind] = [1.0, -1.0].map(|c| (z[0] + c).hypot(z[1]).max(NEAR_CORNER));
                    (0.5 * (ahead / behind).ln(), *w)
                };
                let shift = centre(&self.points.iter().zip(&self.weights).map(shares).collect::<Vec<_>>());
                self.apply(&Mobius::to_origin([shift.tanh(), 0.0]));
            }
            _ => {}
        }
        Ok(())
    }

    fn apply(&mut self, by: &Mobius) {
        self.points.iter_mut().for_each(|z| *z = by.apply(*z));
    }
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

/// The corners that are marked, and the vertices of the boundary nearest to the other ones of four directions, a quarter of a turn apart.
fn nearest(surface: &Surface, disk: &Disk, (start, marked): (f64, &[VertexId])) -> Result<Vec<VertexId>> {
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
        "the boundary of {} vertices is too coarse for {CORNERS} corners: name pairs of vertices on it as landmarks, or refine it",
        boundary.len()
    )))
}

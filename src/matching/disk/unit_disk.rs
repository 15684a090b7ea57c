//! A disk on the unit disk, with the raster in which its conformal factor is compared with another one's.

use crate::canonical::{CircleDomainOptions, circle_domain};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Options;
use crate::geometry::complex::{Complex, doubled_area, mul, norm2};
use crate::geometry::mobius::Mobius;
use crate::matching::fit::{ConformalFactors, PolarSample, centre, factors};
use crate::matching::landmarks::Marks;
use crate::mesh::VertexId;
use crate::metric::Surface;
use std::f64::consts::TAU;

/// Number of rings, of equal area, of the raster of the disk.
const RINGS: usize = 8;
/// Number of sectors of a ring.
pub(super) const SECTORS: usize = 128;
/// Least distance from a corner, in the unit disk, that enters a barycentre.
const NEAR_CORNER: f64 = 1e-12;

/// A surface that is mapped conformally onto the unit disk.
pub(super) struct UnitDisk {
    points: Vec<Complex>,
    /// Share of the area around each vertex.
    weights: Vec<f64>,
    /// Per cell of the raster: the mean conformal factor and the share of the area; `None` without vertices.
    raster: Vec<Option<(f64, f64)>>,
}

impl UnitDisk {
    /// The image of a surface under its circle domain.
    ///
    /// # Errors
    /// Those of [`circle_domain`].
    pub fn new(surface: &Surface, flow: &Options, control: &Control) -> Result<UnitDisk> {
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
        let ConformalFactors { values, weights } = factors(surface, flat);
        let mut sums = vec![[0.0; 2]; RINGS * SECTORS];
        for ((z, w), factor) in points.iter().zip(&weights).zip(&values) {
            let sum = &mut sums[cell(*z, 0.0)];
            (sum[0], sum[1]) = (sum[0] + w * factor, sum[1] + w);
        }
        let raster = sums.into_iter().map(|[sum, w]| (w > 0.0).then(|| (sum / w, w))).collect();
        Ok(UnitDisk { points, weights, raster })
    }

    /// The direction of a vertex from the centre, radians.
    pub fn angle(&self, v: VertexId) -> f64 {
        let [x, y] = self.points[v.index()];
        y.atan2(x)
    }

    /// The direction of the axis of largest moment of the area, radians.
    pub fn axis(&self) -> f64 {
        let square = |(z, w): (&Complex, &f64)| mul(*z, *z).map(|x| w * x);
        let moments = self.points.iter().zip(&self.weights).map(square);
        let [x, y] = moments.fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
        0.5 * y.atan2(x)
    }

    /// The vertices about the centre, without the landmark there, which has no direction.
    pub fn around(&self, landmark: VertexId) -> Vec<PolarSample> {
        let of = |(z, w): (&Complex, &f64)| PolarSample {
            distance: norm2(*z),
            angle: z[1].atan2(z[0]),
            share: *w,
        };
        let all = self.points.iter().zip(&self.weights).enumerate();
        all.filter(|(v, _)| *v != landmark.index()).map(|(_, zw)| of(zw)).collect()
    }

    /// Brings a landmark to the centre, or two corners to opposite points and the area between them to the middle.
    pub fn centre(&mut self, marks: &Marks) -> Result<()> {
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
                // The Möbius transformations that keep the corners ± 1 are shifts of the real part of artanh z.
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

    /// The mean square difference of the conformal factors after this disk is rotated; cells that are empty in either disk do not count.
    pub fn difference(&self, to: &UnitDisk, turn: f64) -> f64 {
        let (mut sum, mut total) = (0.0, f64::MIN_POSITIVE);
        for (k, entry) in self.raster.iter().enumerate() {
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
}

/// The cell of a point after a rotation.
fn cell(z: Complex, turn: f64) -> usize {
    let ring = ((norm2(z) * RINGS as f64) as usize).min(RINGS - 1);
    let angle = (z[1].atan2(z[0]) + turn).rem_euclid(TAU) / TAU;
    ring * SECTORS + ((angle * SECTORS as f64) as usize).min(SECTORS - 1)
}

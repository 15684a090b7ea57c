//! Right-angled hexagons of the hyperbolic plane with given alternate sides, in double-double precision.
//!
//! ```text
//!     start 0  end 0              Counterclockwise: cuff 0 from its start to its end, a seam to the start of cuff 1, and so on. A pair of
//!        ●──────●                 pants is this front and its mirror image, the back, glued along the three seams. The elements of its
//!  end 2 ●      ● start 1         fundamental group that translate along the cuffs 0, 1, 2 with the pants on their left have the
//!        ●──────●                 product x₀ x₂ x₁ = 1: each is the product of the reflections in the seams beside its cuff.
//!   start 2    end 1
//! ```

use crate::geometry::{DoubleDouble, Motion, Space};

/// A point or vector [x, y, w] of Minkowski space.
pub(super) type HyperboloidPoint = [DoubleDouble; 3];

/// The hexagon of a pair of pants.
pub(super) struct Hexagon {
    /// Per cuff the motions that bring the x axis to it, in its direction, and the origin to its start and to its end.
    pub feet: [[Motion<DoubleDouble>; 2]; 3],
}

/// The translation along the x axis by a length.
pub(super) fn along(length: f64) -> Motion<DoubleDouble> {
    Motion::translation_of_chord(DoubleDouble::from((0.5 * length).sinh()), Space::H2)
}

/// The rotation by a right angle, counterclockwise.
fn right_angle() -> Motion<DoubleDouble> {
    let half = DoubleDouble::from(0.5).sqrt();
    Motion::rotation([half, half], Space::H2)
}

/// The rotation by π.
pub(super) fn half_turn() -> Motion<DoubleDouble> {
    Motion::rotation([DoubleDouble::from(0.0), DoubleDouble::from(1.0)], Space::H2)
}

impl Hexagon {
    /// The hexagon with these halves of cuffs, its middle near the origin.
    pub fn new(halves: [f64; 3]) -> Hexagon {
        let one = DoubleDouble::from(1.0);
        let chord = halves.map(|h| DoubleDouble::from((0.5 * h).sinh()));
        let cosh = chord.map(|q| one + (q * q + q * q));
        let sinh = chord.map(|q| (q + q) * (one + q * q).sqrt());
        // cosh s = (cosh a cosh b + cosh c) / (sinh a sinh b), by 2 sinh²(s/2) = cosh s − 1.
        let seam = |k: usize| {
            let (a, b, c) = (k, (k + 1) % 3, (k + 2) % 3);
            let difference = cosh[a] * cosh[b] - sinh[a] * sinh[b];
            let square = (difference + cosh[c]) / ((sinh[a] + sinh[a]) * sinh[b]);
            Motion::translation_of_chord(square.sqrt(), Space::H2)
        };
        let mut at = Motion::identity(Space::H2);
        let feet = [0, 1, 2].map(|k| {
            let start = at;
            let end = start.compose(&Motion::translation_of_chord(chord[k], Space::H2)).normalised();
            at = end.compose(&right_angle()).compose(&seam(k)).compose(&right_angle()).normalised();
            [start, end]
        });
        let mut sum = [DoubleDouble::from(0.0); 3];
        for point in feet.iter().flatten().map(Motion::origin) {
            sum = [0, 1, 2].map(|k| sum[k] + point[k]);
        }
        let home = Motion::to_origin(Space::H2, unit(sum));
        Hexagon { feet: feet.map(|both| both.map(|foot| home.compose(&foot).normalised())) }
    }

    /// The translation along a cuff by its length, with the pants on its left.
    pub fn around(&self, cuff: usize) -> Motion<DoubleDouble> {
        let [start, end] = &self.feet[cuff];
        let half = start.inverse().compose(end);
        half.compose(&half).conjugated_by(start).normalised()
    }
}

/// The point of the hyperboloid in the direction of a vector inside the cone.
pub(super) fn unit(sum: HyperboloidPoint) -> HyperboloidPoint {
    let size = (sum[2] * sum[2] - sum[0] * sum[0] - sum[1] * sum[1]).sqrt();
    sum.map(|x| x / size)
}

/// The determinant of three vectors: positive where the third lies to the left of the line from the first to the second.
pub(super) fn orientation([p, q, r]: [&HyperboloidPoint; 3]) -> f64 {
    let minor = |i: usize, j: usize| q[i] * r[j] - q[j] * r[i];
    (p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1)).high
}

/// The distance of two points.
pub(super) fn distance(p: &HyperboloidPoint, q: &HyperboloidPoint) -> f64 {
    let [x, y, w] = [0, 1, 2].map(|k| p[k] - q[k]);
    let square = x * x + y * y - w * w;
    2.0 * (DoubleDouble::from(0.25) * square).sqrt().high.asinh()
}

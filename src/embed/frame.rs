//! Where a half-edge lies: its origin and its direction there.

use crate::geometry::complex::{add, conj, mul, norm2, quick_norm, scale, sub};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};

/// The origin in ambient coordinates.
pub(super) const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];

/// The frame of a half-edge, by which its face is placed: the isometry that carries the half-edge from the origin, along the x axis, to its
/// place in the layout.
///
/// Frames of H² and S² are [`Motion`]s in double-double precision, since in H² their errors are magnified by e^distance. In E² a
/// [`PlaneFrame`] of f64s is enough, and takes a tenth of the time.
pub(super) trait HalfedgeFrame: MovingFrame {
    /// The frames in f64 by which the order is found in which faces are added.
    type Rough: MovingFrame<Side = Self::Side, Angle = Self::Angle>;
    /// True for frames in double-double precision.
    const IS_PRECISE: bool;

    /// The length of a side.
    fn length(space: Space, side: Self::Side) -> f64;
    /// The frame that a rough frame stands for; `None` if it has to be computed in double-double precision.
    fn of_rough(rough: Self::Rough) -> Option<Self>;
    /// The start of the half-edge, in ambient coordinates.
    fn origin(&self) -> [f64; 3];
    /// [`HalfedgeFrame::origin`], and the low parts of x and y in double-double precision.
    fn point(&self) -> ([f64; 3], [f64; 2]);
    /// The image of a point in ambient coordinates.
    fn apply(&self, p: [f64; 3]) -> [f64; 3];
    /// The difference between a point and the image of `local`: a vector of the plane in E², elsewhere a vector at the frame's origin.
    fn miss(&self, point: [f64; 3], local: [f64; 3]) -> [f64; 2];
    /// [`HalfedgeFrame::miss`] with the start of the half-edge as image, to first order.
    fn miss_of_origin(&self, point: [f64; 3]) -> [f64; 2];
    /// The frame as an isometry.
    fn motion(&self) -> Motion<DoubleDouble>;
}

/// A frame that moves from half-edge to half-edge, and so from face to face.
pub(super) trait MovingFrame: Copy + Send + Sync {
    /// The length of a side, in the form that steps along the side need.
    type Side: Copy + Send + Sync;
    /// The angle at a corner, in the form that turns by the angle need.
    type Angle: Copy + Send + Sync;

    /// A number that grows with the length of a side.
    fn size(side: Self::Side) -> f64;
    /// The frame at the origin, along the x axis.
    fn identity(space: Space) -> Self;
    /// The frame after a step along the half-edge: at its tip, in the same direction.
    fn forward(&self, side: Self::Side) -> Self;
    /// The frame after a turn by π minus the angle: from one side of a triangle, at its end, to the next side.
    fn turned_onwards(&self, angle: Self::Angle) -> Self;
    /// The frame after a turn by π.
    fn turned_round(&self) -> Self;
    /// The frame after a turn by the angle: from one side of a triangle, at its start, to the direction from which the side before it
    /// comes. `None` if this loses accuracy against a walk around the triangle.
    fn turned_inwards(&self, angle: Self::Angle) -> Option<Self>;
    /// The frame of the side before this one, which has this length and makes this angle with it. `None` if this loses accuracy against a
    /// walk around the triangle.
    fn backwards(&self, side: Self::Side, angle: Self::Angle) -> Option<Self>;
    /// The frame in the same direction, but moved so that the half-edge, of this length, ends at the place of another frame. A frame in
    /// double-double precision stays as it is, since it ends there to all digits that a layout has.
    fn ending_at(&self, end: &Self, side: Self::Side) -> Self;
    /// The distance of the half-edge's start from the origin, or a number that grows with it as in [`MovingFrame::distance_of_apex`].
    fn distance(&self) -> f64;
    /// The distance from the origin of the third corner of a triangle on this half-edge, or a number that grows with that distance.
    /// `angle`: the triangle's angle at the start of the half-edge; `last`: its side that ends there. It is computed in f64, since it only
    /// decides the order of faces.
    fn distance_of_apex(&self, angle: Self::Angle, last: Self::Side) -> f64;
}

/// A frame in the plane. The direction is passed on from face to face and is rounded each time; the place is summed in double-double
/// precision, so that faces that are small against their coordinates keep their shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneFrame {
    /// The unit vector in the direction of the half-edge.
    direction: [f64; 2],
    place: [DoubleDouble; 2],
}

impl MovingFrame for PlaneFrame {
    type Side = f64;
    /// `[cos, sin]`.
    type Angle = [f64; 2];

    fn size(side: f64) -> f64 {
        side
    }

    fn identity(_: Space) -> Self {
        PlaneFrame { direction: [1.0, 0.0], place: [DoubleDouble::default(); 2] }
    }

    fn forward(&self, side: f64) -> Self {
        let step = |k: usize| self.place[k].plus(side * self.direction[k]);
        PlaneFrame { direction: self.direction, place: [step(0), step(1)] }
    }

    fn turned_onwards(&self, [cos, sin]: [f64; 2]) -> Self {
        let direction = mul(self.direction, [-cos, sin]);
        // One step of Newton's method for 1/|direction| from 1, where the length is off by a few roundings.
        let correction = 1.5 - 0.5 * norm2(direction);
        PlaneFrame { direction: direction.map(|x| correction * x), place: self.place }
    }

    fn turned_round(&self) -> Self {
        PlaneFrame { direction: self.direction.map(|x| -x), place: self.place }
    }

    /// `None`, since steps are rounded, so that the result depends on the way to a corner ([`MovingFrame::ending_at`]).
    fn turned_inwards(&self, _: [f64; 2]) -> Option<Self> {
        None
    }

    fn backwards(&self, _: f64, _: [f64; 2]) -> Option<Self> {
        None
    }

    fn ending_at(&self, end: &Self, side: f64) -> Self {
        PlaneFrame { direction: self.direction, place: end.place }.forward(-side)
    }

    fn distance(&self) -> f64 {
        quick_norm(self.place.map(|x| x.high))
    }

    fn distance_of_apex(&self, angle: [f64; 2], last: f64) -> f64 {
        let way = mul(self.direction, angle);
        quick_norm([0, 1].map(|k| self.place[k].high + last * way[k]))
    }
}

impl HalfedgeFrame for PlaneFrame {
    type Rough = PlaneFrame;
    const IS_PRECISE: bool = false;

    fn length(_: Space, side: f64) -> f64 {
        side
    }

    fn of_rough(rough: PlaneFrame) -> Option<Self> {
        Some(rough)
    }

    fn origin(&self) -> [f64; 3] {
        [self.place[0].high, self.place[1].high, 1.0]
    }

    fn point(&self) -> ([f64; 3], [f64; 2]) {
        (self.origin(), self.place.map(|x| x.low))
    }

    fn apply(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let way = mul(self.direction, [x, y]);
        [self.place[0].plus(way[0]).high, self.place[1].plus(way[1]).high, 1.0]
    }

    fn miss(&self, [x, y, _]: [f64; 3], local: [f64; 3]) -> [f64; 2] {
        let from = [self.place[0].plus(-x), self.place[1].plus(-y)].map(|d| -d.high);
        sub(from, mul(self.direction, [local[0], local[1]]))
    }

    fn miss_of_origin(&self, [x, y, _]: [f64; 3]) -> [f64; 2] {
        [self.place[0].plus(-x), self.place[1].plus(-y)].map(|d| -d.high)
    }

    fn motion(&self) -> Motion<DoubleDouble> {
        Motion::in_plane(self.direction.map(DoubleDouble::from), self.place)
    }
}

/// A motion in f64. Its errors grow with each step, but it shows well enough which faces are near.
#[derive(Debug, Clone, Copy)]
pub(super) struct RoughMotion(Motion);

impl MovingFrame for RoughMotion {
    type Side = [DoubleDouble; 2];
    type Angle = [DoubleDouble; 2];

    fn size([_, half_chord]: [DoubleDouble; 2]) -> f64 {
        half_chord.high
    }

    fn identity(space: Space) -> Self {
        RoughMotion(Motion::identity(space))
    }

    fn forward(&self, side: [DoubleDouble; 2]) -> Self {
        RoughMotion(self.0.after_translation(side.map(f64::from)))
    }

    fn turned_onwards(&self, [cos, sin]: [DoubleDouble; 2]) -> Self {
        RoughMotion(self.0.after_rotation([sin.high, cos.high]))
    }

    fn turned_round(&self) -> Self {
        RoughMotion(self.0.after_half_turn())
    }

    fn turned_inwards(&self, angle: [DoubleDouble; 2]) -> Option<Self> {
        Some(RoughMotion(self.0.after_rotation(angle.map(f64::from))))
    }

    fn backwards(
        &self,
        [cos, chord]: [DoubleDouble; 2],
        [half_cos, half_sin]: [DoubleDouble; 2],
    ) -> Option<Self> {
        let turned = self.0.after_rotation([half_sin.high, -half_cos.high]);
        Some(RoughMotion(turned.after_translation([cos.high, -chord.high])))
    }

    fn ending_at(&self, _: &Self, _: [DoubleDouble; 2]) -> Self {
        *self
    }

    fn distance(&self) -> f64 {
        // |b| is half the distance in E², its hyperbolic sine in H², its sine in S².
        quick_norm(self.0.b)
    }

    fn distance_of_apex(&self, half_angle: [DoubleDouble; 2], last: [DoubleDouble; 2]) -> f64 {
        let turned = self.0.after_rotation(half_angle.map(f64::from));
        RoughMotion(turned.after_translation(last.map(f64::from))).distance()
    }
}

impl HalfedgeFrame for Motion<DoubleDouble> {
    type Rough = RoughMotion;
    const IS_PRECISE: bool = true;

    fn length(space: Space, [_, half_chord]: [DoubleDouble; 2]) -> f64 {
        2.0 * match space {
            Space::E2 => half_chord.high,
            Space::H2 => half_chord.high.asinh(),
            Space::S2 => half_chord.high.min(1.0).asin(),
        }
    }

    fn of_rough(_: RoughMotion) -> Option<Self> {
        None
    }

    fn origin(&self) -> [f64; 3] {
        Motion::origin(self).map(f64::from)
    }

    fn point(&self) -> ([f64; 3], [f64; 2]) {
        let [x, y, w] = Motion::origin(self);
        ([x.high, y.high, w.high], [x.low, y.low])
    }

    fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        Motion::apply(self, precise_point(self.space, p)).map(f64::from)
    }

    fn miss(&self, point: [f64; 3], local: [f64; 3]) -> [f64; 2] {
        let point = precise_point(self.space, point);
        if self.space == Space::E2 {
            let place = Motion::apply(self, precise_point(self.space, local));
            return [0, 1].map(|k| f64::from(point[k] - place[k]));
        }
        let [x, y, _] = Motion::apply(&self.inverse(), point).map(f64::from);
        sub([x, y], [local[0], local[1]])
    }

    fn miss_of_origin(&self, point: [f64; 3]) -> [f64; 2] {
        // The difference is small, so f64s are enough to apply the inverse to it: X ↦ ā² X − κ b² X̄ − 2 ā b w.
        let (near, [x, y]) = (self.rounded(), self.place());
        let [dx, dy] = [x.plus(-point[0]), y.plus(-point[1])].map(|d| -d.high);
        let [x, y] = [x.high, y.high];
        let dw = match self.space {
            Space::E2 => return [dx, dy],
            Space::H2 => {
                let [w, u] = [[x, y], [point[0], point[1]]].map(|z| (1.0 + norm2(z)).sqrt());
                ((x + point[0]) * dx + (y + point[1]) * dy) / (w + u)
            }
            Space::S2 => point[2] - (norm2(near.a) - norm2(near.b)),
        };
        let back = mul(conj(near.a), conj(near.a));
        let off =
            add(mul(back, [dx, dy]), scale(-self.space.curvature(), mul(mul(near.b, near.b), [dx, -dy])));
        sub(off, scale(2.0 * dw, mul(conj(near.a), near.b)))
    }

    fn motion(&self) -> Motion<DoubleDouble> {
        *self
    }
}

impl MovingFrame for Motion<DoubleDouble> {
    /// The coefficients a and b of the translation along the side ([`Motion::translation_of_chord`]).
    type Side = [DoubleDouble; 2];
    /// `[cos, sin]` of half the angle.
    type Angle = [DoubleDouble; 2];

    fn size([_, half_chord]: [DoubleDouble; 2]) -> f64 {
        half_chord.high
    }

    fn identity(space: Space) -> Self {
        Motion::identity(space)
    }

    fn forward(&self, side: [DoubleDouble; 2]) -> Self {
        self.after_translation(side)
    }

    fn turned_onwards(&self, [cos, sin]: [DoubleDouble; 2]) -> Self {
        self.after_rotation([sin, cos])
    }

    fn turned_round(&self) -> Self {
        self.after_half_turn()
    }

    fn turned_inwards(&self, angle: [DoubleDouble; 2]) -> Option<Self> {
        Some(self.after_rotation(angle))
    }

    fn backwards(
        &self,
        [cos, chord]: [DoubleDouble; 2],
        [half_cos, half_sin]: [DoubleDouble; 2],
    ) -> Option<Self> {
        Some(self.after_rotation([half_sin, -half_cos]).after_translation([cos, -chord]))
    }

    fn ending_at(&self, _: &Self, _: [DoubleDouble; 2]) -> Self {
        *self
    }

    fn distance(&self) -> f64 {
        RoughMotion(self.rounded()).distance()
    }

    fn distance_of_apex(&self, half_angle: [DoubleDouble; 2], last: [DoubleDouble; 2]) -> f64 {
        RoughMotion(self.rounded()).distance_of_apex(half_angle, last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both kinds of frames take the same walk, with sides of length k and turns by 0.1 k.
    #[test]
    fn plane_frames_walk_as_motions_do() {
        let (mut plane, mut motion) =
            (PlaneFrame::identity(Space::E2), <Motion<DoubleDouble>>::identity(Space::E2));
        for k in 1..60 {
            let (length, angle) = (f64::from(k), 0.1 * f64::from(k));
            let (half, full) = ((0.5 * angle).sin_cos(), angle.sin_cos());
            plane = plane.forward(length).turned_onwards([full.1, full.0]);
            let step = [1.0, 0.5 * length].map(DoubleDouble::from);
            motion = motion.forward(step).turned_onwards([half.1, half.0].map(DoubleDouble::from));
            if k % 7 == 0 {
                (plane, motion) = (plane.turned_round(), motion.turned_round());
            }
            let local = [0.3, -2.0, 1.0];
            let [p, q] = [plane.apply(local), HalfedgeFrame::apply(&motion, local)];
            let r = HalfedgeFrame::apply(&plane.motion(), local);
            for other in [q, r] {
                assert!((p[0] - other[0]).hypot(p[1] - other[1]) < 1e-12, "{k}: {p:?} {other:?}");
            }
            for off in [plane.miss(p, local), motion.miss(p, local)] {
                assert!(off[0].hypot(off[1]) < 1e-12, "{k}: {off:?}");
            }
            let other = [p[0] + 3.0, p[1] - 4.0, 1.0];
            for off in [plane.miss(other, local), motion.miss(other, local)] {
                assert!((off[0] - 3.0).hypot(off[1] + 4.0) < 1e-12, "{k}: {off:?}");
            }
        }
    }

    #[test]
    fn misses_of_an_origin_are_those_of_any_point_to_first_order() {
        for space in [Space::E2, Space::H2, Space::S2] {
            let mut motion = <Motion<DoubleDouble>>::identity(space);
            for k in 1..6 {
                let (half, chord) = ((0.3 * f64::from(k)).sin_cos(), DoubleDouble::from(0.9));
                let side = [Motion::translation_of_chord(chord, space).a[0], chord];
                motion = motion.forward(side).turned_onwards([half.1, half.0].map(DoubleDouble::from));
                let small = Motion::translation(1e-9, space).precise();
                let near = motion.turned_onwards([0.6, 0.8].map(DoubleDouble::from)).compose(&small);
                let point = HalfedgeFrame::origin(&near);
                let (known, off) = (motion.miss(point, ORIGIN), motion.miss_of_origin(point));
                let scale = point.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                let error = (known[0] - off[0]).hypot(known[1] - off[1]);
                assert!(known[0].hypot(known[1]) > 0.9e-9, "{space} {k}: {known:?}");
                assert!(error < 1e-15 * scale * scale, "{space} {k}: {known:?} {off:?}");
            }
        }
    }
}

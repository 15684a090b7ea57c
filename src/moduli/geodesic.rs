//! Closed geodesics of a hyperbolic surface as lines on its triangles.

use crate::canonical::Quotient;
use crate::control::Control;
use crate::embed::Layout;
use crate::error::{Error, Result};
use crate::geometry::bounding_line::BoundingLine;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Place};
use std::sync::Arc;

/// A closed geodesic, as the points where it crosses edges.
#[derive(Debug, Clone, PartialEq)]
pub struct GeodesicOnSurface {
    /// Along the geodesic, each half-edge that it crosses, a side of the face that it leaves there, and the share of the half-edge before the
    /// crossing, in chords of the hyperboloid. The first crossing is not repeated at the end.
    pub crossings: Vec<(HalfedgeId, f64)>,
    /// The sum of the distances between crossings.
    pub length: f64,
}

/// Largest difference of two shares that are one crossing, and of the length of the line, relative, from that of the isometry.
const SAME: f64 = 1e-5;
/// Largest hyperbolic sine of the distance of a corner that counts as on a line: far above the rounding of places, far below edges.
const ON_LINE: f64 = 1e-9;
/// Steps after which the control is asked again.
const STEPS_PER_CHECK: usize = 1024;

/// A line in the universal cover, seen from the copy of the layout that it is in.
struct LineInCover<'a> {
    layout: &'a Layout,
    form: Form,
    face: FaceId,
}

/// What a line is given by: the isometry that translates along it, or two points.
#[derive(Clone, Copy)]
enum Form {
    Axis(Motion<DoubleDouble>),
    Through([DoubleDouble; 3], [DoubleDouble; 3]),
}

impl Form {
    /// The line as it is seen after `motion` has moved the space.
    fn moved(&self, motion: &Motion<DoubleDouble>) -> Form {
        match *self {
            Form::Axis(along) => Form::Axis(along.conjugated_by(motion)),
            Form::Through(p, q) => Form::Through(motion.apply(p), motion.apply(q)),
        }
    }

    /// Per corner of a face the hyperbolic sine of its distance from the line, negative to the left; 0 for one that is on the line. So a
    /// line through corners or along edges crosses the edges that begin there on its left.
    fn sides(&self, corners: [[f64; 3]; 3]) -> [f64; 3] {
        let points = corners.map(|p| precise_point(Space::H2, p));
        let off = match self {
            Form::Axis(along) => {
                let line = BoundingLine::along(along, points[0]);
                points.map(|p| line.value(&p).high / line.norm)
            }
            Form::Through(p, q) => {
                let cosh = p[2] * q[2] - p[0] * q[0] - p[1] * q[1];
                let size = (cosh * cosh - 1.0.into()).high.max(f64::MIN_POSITIVE).sqrt();
                points.map(|x| -determinant([*p, *q, x]).high / size)
            }
        };
        off.map(|x| if x.abs() <= ON_LINE { 0.0 } else { x })
    }
}

fn determinant([p, q, r]: [[DoubleDouble; 3]; 3]) -> DoubleDouble {
    let minor = |i: usize, j: usize| q[i] * r[j] - q[j] * r[i];
    p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1)
}

impl LineInCover<'_> {
    /// The side through which the line leaves the face where it is, with the share before it, if it leaves to the left of the vertex that it
    /// comes from: a side from the right of the line to the left.
    fn exit(&self) -> Option<(HalfedgeId, f64)> {
        let side = self.form.sides(self.layout.face_points(self.face));
        let halfedges = self.layout.mesh().face_halfedges(self.face);
        (0..3).find_map(|k| {
            let (from, to) = (side[k], side[(k + 1) % 3]);
            (from >= 0.0 && to < 0.0).then(|| (halfedges[k], from / (from - to)))
        })
    }

    /// Step over a side of the face.
    fn cross(&mut self, h: HalfedgeId) -> Result<()> {
        let mesh = self.layout.mesh();
        let Some(next) = mesh.face(h.twin()) else {
            return Err(Error::Layout(format!("a geodesic leaves the surface at half-edge {h}")));
        };
        if self.layout.side(h) != 0 {
            self.form = self.form.moved(&self.layout.neighbour(h).normalised().inverse());
        }
        self.face = next;
        Ok(())
    }
}

/// The point of a crossing on the hyperboloid.
fn crossing_point(layout: &Layout, h: HalfedgeId, share: f64) -> [f64; 3] {
    let mesh = layout.mesh();
    let [p, q] = [h, mesh.next(h)].map(|h| layout.corner(h));
    let at = [0, 1, 2].map(|k| p[k] + share * (q[k] - p[k]));
    let size = (at[2] * at[2] - at[0] * at[0] - at[1] * at[1]).max(0.0).sqrt();
    at.map(|x| x / size)
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    let [x, y, w] = [0, 1, 2].map(|k| p[k] - q[k]);
    2.0 * (0.5 * (x * x + y * y - w * w).max(0.0).sqrt()).asinh()
}

/// The point of the axis of a translation that is nearest to the origin.
fn nearest_point(motion: &Motion<DoubleDouble>) -> [f64; 3] {
    // The axis is where x Im b − y Re b + w Im a = 0: the foot of the origin lies on the normal of this line.
    let Motion { a, b, .. } = motion.positive();
    let ([bx, by], height) = (b.map(|x| x.high), a[1].high);
    let size = bx.hypot(by);
    // tanh of the distance is Im a over |b|.
    let far = -height / size;
    let w = 1.0 / ((1.0 - far) * (1.0 + far)).sqrt();
    [far * w * by / size, -far * w * bx / size, w]
}

/// The closed geodesic of a deck transformation on the triangles of a layout in H², whose deck group is that of the transformation. Of a
/// power it is run through once.
///
/// # Errors
/// [`Error::Layout`] for a layout in another space, for an element that is no translation, or where rounding keeps the line from closing;
/// [`Error::Cancelled`].
pub fn closed_geodesic(
    layout: &Layout,
    motion: &Motion<DoubleDouble>,
    control: &Control,
) -> Result<GeodesicOnSurface> {
    let length = motion.translation_length();
    if layout.space != Space::H2 || length <= 0.0 || layout.mesh().n_faces() == 0 {
        return Err(Error::Layout("only a translation of the hyperbolic plane has a closed geodesic".into()));
    }
    let mut line = on_axis(layout, motion, control)?;
    let lost =
        || Error::Layout("the geodesic of a deck transformation does not close within rounding".into());
    let first = line.exit().ok_or_else(lost)?;
    let mut found = GeodesicOnSurface { crossings: vec![first], length: 0.0 };
    let mut steps = 0;
    loop {
        control.check_every(STEPS_PER_CHECK, &mut steps)?;
        let last = found.crossings[found.crossings.len() - 1];
        line.cross(last.0)?;
        let next = line.exit().ok_or_else(lost)?;
        // Both crossings are on the face of the next one: the last one is on the other side of its edge.
        let before = crossing_point(layout, last.0.twin(), 1.0 - last.1);
        found.length += distance(before, crossing_point(layout, next.0, next.1));
        // A geodesic that runs around several times has a part of its length.
        let times = (length / found.length).round();
        let is_whole = times >= 1.0 && (times * found.length - length).abs() <= SAME * length;
        if is_whole && next.0 == first.0 && (next.1 - first.1).abs() < SAME {
            return Ok(found);
        }
        if found.length > length * (1.0 + SAME) + SAME {
            return Err(lost());
        }
        found.crossings.push(next);
    }
}

/// The closed geodesics of deck transformations of a quotient in H², as points on the edges of the common subdivision of the given triangulation
/// and the metric's: each a face of the given surface and weights of its corners, in order; a closed line, whose first point is not repeated.
///
/// # Errors
/// Those of [`closed_geodesic`], [`crate::Solution::common_subdivision`] and [`Layout::on_subdivision`].
pub fn geodesics_on_surface<'a>(
    quotient: &Quotient,
    motions: impl IntoIterator<Item = &'a Motion<DoubleDouble>>,
    control: &Control,
) -> Result<Vec<Vec<Place>>> {
    let laid = match quotient.layout.common_subdivision() {
        Some(_) => quotient.layout.clone(),
        None => {
            let both = Arc::new(quotient.metric.common_subdivision(control)?);
            quotient.layout.on_subdivision(&both, quotient.metric.metric(), control)?
        }
    };
    let Some(both) = laid.common_subdivision() else {
        return Err(Error::Layout("the layout lies on no common subdivision".into()));
    };
    let place = |&(h, share): &(HalfedgeId, f64)| {
        let (piece, k) = laid.mesh().corner(h).unwrap_or((FaceId(0), 0));
        let corners = both.barycentric(0, piece);
        let weights = [0, 1, 2].map(|c| (1.0 - share) * corners[k][c] + share * corners[(k + 1) % 3][c]);
        Place { face: both.faces[0][piece], weights }
    };
    let line = |motion| Ok(closed_geodesic(&laid, motion, control)?.crossings.iter().map(place).collect());
    motions.into_iter().map(line).collect()
}

/// The axis of a translation in a face that it meets: found along the line from the middle of a face to a point of the axis.
fn on_axis<'a>(
    layout: &'a Layout,
    motion: &Motion<DoubleDouble>,
    control: &Control,
) -> Result<LineInCover<'a>> {
    let corners = layout.face_points(FaceId(0));
    let sum = [0, 1, 2].map(|k| corners[0][k] + corners[1][k] + corners[2][k]);
    let target = precise_point(Space::H2, nearest_point(motion));
    let form = Form::Through(precise_point(Space::H2, middle(sum)), target);
    let mut line = LineInCover { layout, form, face: FaceId(0) };
    let mut axis = Form::Axis(*motion);
    let mut steps = 0;
    loop {
        control.check_every(STEPS_PER_CHECK, &mut steps)?;
        let side = axis.sides(layout.face_points(line.face));
        if side.iter().any(|&x| x >= 0.0) && side.iter().any(|&x| x < 0.0) {
            return Ok(LineInCover { form: axis, ..line });
        }
        let Some((h, _)) = line.exit() else {
            return Err(Error::Layout("no face on the line of a deck transformation was found".into()));
        };
        if layout.side(h) != 0 {
            axis = axis.moved(&layout.neighbour(h).normalised().inverse());
        }
        line.cross(h)?;
        if steps > MOST_STEPS {
            return Err(Error::Layout("the way to the line of a deck transformation does not end".into()));
        }
    }
}

/// Most faces on the way to a line.
const MOST_STEPS: usize = 10_000_000;

/// A vector inside the cone as a point of the hyperboloid.
fn middle(sum: [f64; 3]) -> [f64; 3] {
    let size = (sum[2] * sum[2] - sum[0] * sum[0] - sum[1] * sum[1]).max(f64::MIN_POSITIVE).sqrt();
    sum.map(|x| x / size)
}

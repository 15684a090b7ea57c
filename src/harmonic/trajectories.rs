//! Horizontal and vertical trajectories of a form: the lines on the surface along which the imaginary or real part of its integral is
//! constant.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix, TrajectoryOptions, integrate, trajectories};
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! let soup = shapes::torus(2.0, 1.0, 24, 12)?;
//! let control = Control::new();
//! let forms = HarmonicForms::new(&Domain::new(&Surface::from_soup(&soup)?, &control)?, &FormsOptions::default(), &control)?;
//! let form = PeriodMatrix::new(&forms)?.basis_form(&forms, 0)?;
//! let cut = cut_graph(forms.domain.mesh(), forms.domain.lengths(), &[], &control)?;
//! let layout = integrate(&forms.domain, &form, &cut)?;
//! let lines = trajectories(&layout, forms.domain.face_areas(), &TrajectoryOptions::default(), &control)?;
//! assert!(lines.len() > 5);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::integrate::FormLayout;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, add, doubled_area, norm2, sub};
use crate::mesh::{FaceId, HalfedgeId, Mesh};
use std::collections::{HashSet, VecDeque};

/// The options of [`trajectories`].
#[derive(Debug, Clone, Copy)]
pub struct TrajectoryOptions {
    /// True for lines of constant real part, false for lines of constant imaginary part.
    pub vertical: bool,
    /// The distance between neighbouring lines on the surface, over the square root of its area; at least 1e-4.
    pub spacing: f64,
    /// The largest length of a line on the surface, over the square root of its area.
    pub longest: f64,
}

impl Default for TrajectoryOptions {
    fn default() -> Self {
        TrajectoryOptions { vertical: false, spacing: 0.04, longest: 6.0 }
    }
}

/// A point on a half-edge, with its share of the way from the origin to the tip.
pub type OnHalfedge = (HalfedgeId, f64);

/// Least [`TrajectoryOptions::spacing`], which gives some ten thousand lines, each with a point on every edge that it crosses.
const LEAST_SPACING: f64 = 1e-4;
/// Least distance of two lines, in spacings, before one of them ends \[JL97\].
const NEAREST: f64 = 0.55;
/// Least length of a line, in spacings; between other lines near zeros there are shorter ones, which are left out.
const SHORTEST: f64 = 1.5;
/// Length, in spacings, from a zero up to which the lines that run into it do not end near each other.
const ALONE: f64 = 1.0;
/// Largest difference of height, in units of a face's longest side, of two corners on one level: the two faces at an edge, each with its
/// own coordinates, have to agree on that.
const SAME_LEVEL: f64 = 1e-12;
/// Length, in spacings, after which a line is tested again for others nearby.
const LOOK: f64 = 0.25;

/// Evenly spaced trajectories of a form's drawing. Each is given by the points at which it crosses edges of [`FormLayout::mesh`], between
/// which it is straight. The lines through zeros come first. The others start in faces that are farther than the spacing from all lines;
/// they end at about half the spacing from another line or from themselves, at the boundary, or at their largest length \[JL97\]. `areas`:
/// of the faces on the surface (F entries, positive).
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for a spacing below 1e-4 or a length that is not positive; [`Error::Cancelled`].
pub fn trajectories(
    layout: &FormLayout,
    areas: &[f64],
    options: &TrajectoryOptions,
    control: &Control,
) -> Result<Vec<Vec<OnHalfedge>>> {
    let mesh = layout.mesh();
    check_size("areas of faces", areas.len(), mesh.n_faces())?;
    let TrajectoryOptions { spacing, longest, .. } = *options;
    if !(spacing >= LEAST_SPACING && spacing.is_finite()) {
        return Err(Error::argument("spacing of trajectories", spacing, "finite, and 1e-4 or more"));
    }
    if !(longest > 0.0 && longest.is_finite()) {
        return Err(Error::argument("longest trajectory", longest, "positive and finite"));
    }
    let unit = areas.iter().sum::<f64>().sqrt();
    let turned = |z: Complex| if options.vertical { [z[1], -z[0]] } else { z };
    let corners: Vec<[Complex; 3]> = mesh.faces().map(|f| layout.face(f).map(turned)).collect();
    let scale = |f: usize| (drawn_area(corners[f]) / areas[f]).sqrt();
    let scale: Vec<f64> = (0..corners.len()).map(scale).collect();
    let mut tracer = TrajectoryTracer {
        mesh,
        lines: vec![Vec::new(); corners.len()],
        corners,
        scale,
        spacing: options.spacing * unit,
        longest: options.longest * unit,
    };
    // The lines that run into zeros come first, since they separate the others.
    let mut found = Vec::new();
    for (k, (f, corner)) in tracer.prongs().into_iter().enumerate() {
        control.check()?;
        found.extend(tracer.prong(f, corner, mesh.n_faces() + k));
    }
    // A stride that is prime to the number of faces spreads the starts over the surface.
    let stride = (0.618 * mesh.n_faces() as f64) as usize | 1;
    let stride = (stride..).step_by(2).find(|&s| gcd(s, mesh.n_faces()) == 1).unwrap_or(1);
    for k in 0..mesh.n_faces() {
        control.check()?;
        let f = FaceId::from(k * stride % mesh.n_faces());
        let centre = tracer.centre(f);
        if doubled_area(tracer.corners[f.index()]) > 0.0 && !tracer.is_near(f, centre, 1.0, usize::MAX) {
            found.extend(tracer.trace(f, centre[1], k));
        }
    }
    Ok(found)
}

/// The area of a drawn face; for a face that a zero turns over, the area of an equilateral triangle with the same mean square of sides.
fn drawn_area(z: [Complex; 3]) -> f64 {
    let doubled = doubled_area(z);
    let squares: f64 = (0..3).map(|k| norm2(sub(z[(k + 1) % 3], z[k]))).sum();
    if doubled > 0.0 { 0.5 * doubled } else { squares / (4.0 * 3f64.sqrt()) }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The part of a line in a face: its level, its least and largest x in the face's own coordinates, and the number of the line.
#[derive(Clone, Copy)]
struct TrajectoryPart {
    level: f64,
    range: [f64; 2],
    line: usize,
}

/// The drawing in which trajectories are traced, with the lines found so far.
struct TrajectoryTracer<'a> {
    mesh: &'a Mesh,
    corners: Vec<[Complex; 3]>,
    /// Per face, the ratio of lengths in the drawing to lengths on the surface.
    scale: Vec<f64>,
    lines: Vec<Vec<TrajectoryPart>>,
    spacing: f64,
    longest: f64,
}

impl TrajectoryTracer<'_> {
    fn centre(&self, f: FaceId) -> Complex {
        let [a, b, c] = self.corners[f.index()];
        add(add(a, b), c).map(|x| x / 3.0)
    }

    /// The points at which the line of a level crosses the sides of a face: two, or none if it misses the face.
    fn crossings(&self, f: FaceId, level: f64) -> Vec<OnHalfedge> {
        let (z, halfedges) = (self.corners[f.index()], self.mesh.face_halfedges(f));
        let crossed = (0..3).filter(|&k| (z[k][1] >= level) != (z[(k + 1) % 3][1] >= level));
        let share = |k: usize| (level - z[k][1]) / (z[(k + 1) % 3][1] - z[k][1]);
        crossed.map(|k| (halfedges[k], share(k).clamp(0.0, 1.0))).collect()
    }

    /// The coordinates of a point on a half-edge, in the drawing of the half-edge's face.
    fn at(&self, (h, share): OnHalfedge) -> Option<Complex> {
        let (f, k) = self.mesh.corner(h)?;
        let (a, b) = (self.corners[f.index()][k], self.corners[f.index()][(k + 1) % 3]);
        Some([0, 1].map(|i| a[i] + share * (b[i] - a[i])))
    }

    /// The faces, with their corners, into which lines run from a zero: a vertex from which more than two lines of its level start.
    fn prongs(&self) -> Vec<(FaceId, usize)> {
        let inside = self.mesh.vertices().filter(|&v| !self.mesh.is_boundary_vertex(v));
        let around = |v| {
            let corners = self.mesh.outgoing(v).filter_map(|h| self.mesh.corner(h));
            corners.filter(|&(f, k)| self.opposite(f, k).is_some()).collect::<Vec<_>>()
        };
        inside.map(around).filter(|prongs| prongs.len() > 2).flatten().collect()
    }

    /// The point at which the line from a corner into its face leaves the face through the opposite side, if it does.
    fn opposite(&self, f: FaceId, k: usize) -> Option<OnHalfedge> {
        let (z, side) = (self.corners[f.index()], (k + 1) % 3);
        let [from, to] = [z[side][1], z[(side + 1) % 3][1]].map(|y| y - z[k][1]);
        let longest = (0..3).map(|j| norm2(sub(z[(j + 1) % 3], z[j]))).fold(0.0, f64::max).sqrt();
        let is_above = |height: f64| height >= -SAME_LEVEL * longest;
        let is_crossed = is_above(from) != is_above(to);
        is_crossed.then(|| (self.mesh.face_halfedges(f)[side], (from / (from - to)).clamp(0.0, 1.0)))
    }

    /// The line from a corner into its face and beyond. Near their common zero, lines are not tested for others nearby.
    fn prong(&mut self, f: FaceId, k: usize, line: usize) -> Option<Vec<OnHalfedge>> {
        let (start, level) = ((self.mesh.face_halfedges(f)[k], 0.0), self.corners[f.index()][k][1]);
        let first = self.opposite(f, k)?;
        self.mark(f, level, [start, first], line);
        let (ahead, _) = self.follow(first, line, ALONE * self.spacing);
        Some([start, first].into_iter().chain(ahead).collect())
    }

    /// The line of a level through a face, in both directions.
    fn trace(&mut self, f: FaceId, level: f64, line: usize) -> Option<Vec<OnHalfedge>> {
        let [first, last] = self.crossings(f, level).try_into().ok()?;
        self.mark(f, level, [first, last], line);
        let (mut points, back) = self.follow(first, line, 0.0);
        points.reverse();
        points.push(first);
        points.push(last);
        let (ahead, length) = self.follow(last, line, 0.0);
        points.extend(ahead);
        (back + length > SHORTEST * self.spacing).then_some(points)
    }

    /// The points of a line after `from`, where it leaves a face, and the length that they add. For the length `alone` the line is not
    /// tested for others nearby.
    fn follow(&mut self, from: OnHalfedge, line: usize, alone: f64) -> (Vec<OnHalfedge>, f64) {
        let (mut points, mut length, mut unseen) = (Vec::new(), 0.0, 0.0);
        let mut at = from;
        while length < 0.5 * self.longest {
            let (h, share) = (at.0.twin(), 1.0 - at.1);
            let (Some(f), Some(z)) = (self.mesh.face(h), self.at((h, share))) else { break };
            let Some(&next) = self.crossings(f, z[1]).iter().find(|(side, _)| *side != h) else { break };
            let Some(w) = self.at(next) else { break };
            let scale = self.scale[f.index()];
            let step = (w[0] - z[0]).abs() / scale;
            // A line ends where the form is nearly 0.
            if !step.is_finite() || self.returns(f, z[1], line) {
                break;
            }
            (length, unseen) = (length + step, unseen + step);
            if length > alone && unseen > LOOK * self.spacing {
                unseen = 0.0;
                if self.is_near(f, z, NEAREST, line) {
                    break;
                }
            }
            self.mark(f, z[1], [(h, share), next], line);
            points.push(next);
            at = next;
        }
        (points, length)
    }

    /// Notes the part of a line in a face.
    fn mark(&mut self, f: FaceId, level: f64, ends: [OnHalfedge; 2], line: usize) {
        if let [Some(a), Some(b)] = ends.map(|end| self.at(end)) {
            self.lines[f.index()].push(TrajectoryPart {
                level,
                range: [a[0].min(b[0]), a[0].max(b[0])],
                line,
            });
        }
    }

    /// True if a line comes back to a face too near to itself.
    fn returns(&self, f: FaceId, level: f64, line: usize) -> bool {
        let least = NEAREST * self.spacing * self.scale[f.index()];
        self.lines[f.index()].iter().any(|part| part.line == line && (part.level - level).abs() < least)
    }

    /// True if another line passes the point z of a face nearer than this share of the spacing, in a drawing of the faces around it.
    fn is_near(&self, f: FaceId, z: Complex, share: f64, line: usize) -> bool {
        let reach = share * self.spacing * self.scale[f.index()];
        let mut seen = HashSet::from([f]);
        let mut open = VecDeque::from([(f, z)]);
        // Each face is stored with the point in the face's own coordinates.
        while let Some((f, z)) = open.pop_front() {
            let passes = |part: &TrajectoryPart| {
                let beside = part.range[0] - 0.5 * reach <= z[0] && z[0] <= part.range[1] + 0.5 * reach;
                part.line != line && (part.level - z[1]).abs() < reach && beside
            };
            if self.lines[f.index()].iter().any(passes) {
                return true;
            }
            for (k, h) in self.mesh.face_halfedges(f).into_iter().enumerate() {
                let Some((next, j)) = self.mesh.corner(h.twin()) else { continue };
                let shift = sub(self.corners[next.index()][(j + 1) % 3], self.corners[f.index()][k]);
                let z = add(z, shift);
                let touches = |i: usize| {
                    let x = self.corners[next.index()].map(|c| c[i] - z[i]);
                    x.iter().any(|x| *x <= reach) && x.iter().any(|x| *x >= -reach)
                };
                if touches(0) && touches(1) && seen.insert(next) {
                    open.push_back((next, z));
                }
            }
        }
        false
    }
}

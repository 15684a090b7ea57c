//! Horizontal and vertical trajectories: the lines on the surface along which the imaginary, or the real, part of a form's integral stays
//! the same.
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

/// Which trajectories, and how many.
#[derive(Debug, Clone, Copy)]
pub struct TrajectoryOptions {
    /// Along constant real part, in place of constant imaginary part.
    pub vertical: bool,
    /// Distance between neighbouring lines on the surface, over the square root of its area; 1e-4 or more.
    pub spacing: f64,
    /// Length of a line on the surface at most, over the square root of its area.
    pub longest: f64,
}

impl Default for TrajectoryOptions {
    fn default() -> Self {
        TrajectoryOptions { vertical: false, spacing: 0.04, longest: 6.0 }
    }
}

/// A point on an edge: of the half-edge, in its face, this share of the way from its origin to its tip.
pub type OnHalfedge = (HalfedgeId, f64);

/// Least [`TrajectoryOptions::spacing`]: some ten thousand lines, with as many points each as there are edges on their way.
const LEAST_SPACING: f64 = 1e-4;
/// Share of the spacing down to which lines may approach each other before one of them ends [JL97].
const NEAREST: f64 = 0.55;
/// Lines shorter than this many spacings, as there are between others near zeros, are left out.
const SHORTEST: f64 = 1.5;
/// Spacings from a zero up to which the lines that run into it do not end near each other.
const ALONE: f64 = 1.0;
/// Share of a face's longest side by which a corner may lie below another one and count as on its level: the faces at an edge, each in
/// coordinates of its own, are to agree on it.
const SAME_LEVEL: f64 = 1e-12;
/// A line looks for others after each such share of the spacing.
const LOOK: f64 = 0.25;

/// Evenly placed trajectories of a form's drawing, each as the points where it crosses edges of [`FormLayout::mesh`], which it joins
/// straight. Lines through zeros come first. Others begin in faces from which no line is nearer than the spacing and end where they come
/// nearer than about half of it to another or to themselves, at the boundary, or at their longest \[JL97\]. `areas`: of the faces on the
/// surface (F entries, positive).
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
    let mut tracer = Tracer {
        mesh,
        lines: vec![Vec::new(); corners.len()],
        corners,
        scale,
        spacing: options.spacing * unit,
        longest: options.longest * unit,
    };
    // First the lines that run into zeros, which part the others.
    let mut found = Vec::new();
    for (k, (f, corner)) in tracer.prongs().into_iter().enumerate() {
        control.check()?;
        found.extend(tracer.prong(f, corner, mesh.n_faces() + k));
    }
    // A stride prime to the number of faces spreads the beginnings over the surface.
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

/// Area of a drawn face; of one that a zero turns over, that of an equilateral one with sides as long.
fn drawn_area(z: [Complex; 3]) -> f64 {
    let doubled = doubled_area(z);
    let squares: f64 = (0..3).map(|k| norm2(sub(z[(k + 1) % 3], z[k]))).sum();
    if doubled > 0.0 { 0.5 * doubled } else { squares / (4.0 * 3f64.sqrt()) }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// A line's part in a face: level, least and largest x in the face's own coordinates, and whose it is.
#[derive(Clone, Copy)]
struct Part {
    level: f64,
    range: [f64; 2],
    line: usize,
}

struct Tracer<'a> {
    mesh: &'a Mesh,
    corners: Vec<[Complex; 3]>,
    /// Per face, length in the drawing over length on the surface.
    scale: Vec<f64>,
    lines: Vec<Vec<Part>>,
    spacing: f64,
    longest: f64,
}

impl Tracer<'_> {
    fn centre(&self, f: FaceId) -> Complex {
        let [a, b, c] = self.corners[f.index()];
        add(add(a, b), c).map(|x| x / 3.0)
    }

    /// The points at which the line of a level leaves the face, as a share of each side; two, or none if it misses the face.
    fn crossings(&self, f: FaceId, level: f64) -> Vec<OnHalfedge> {
        let (z, halfedges) = (self.corners[f.index()], self.mesh.face_halfedges(f));
        let crossed = (0..3).filter(|&k| (z[k][1] >= level) != (z[(k + 1) % 3][1] >= level));
        let share = |k: usize| (level - z[k][1]) / (z[(k + 1) % 3][1] - z[k][1]);
        crossed.map(|k| (halfedges[k], share(k).clamp(0.0, 1.0))).collect()
    }

    fn at(&self, (h, share): OnHalfedge) -> Option<Complex> {
        let (f, k) = self.mesh.corner(h)?;
        let (a, b) = (self.corners[f.index()][k], self.corners[f.index()][(k + 1) % 3]);
        Some([0, 1].map(|i| a[i] + share * (b[i] - a[i])))
    }

    /// The faces, with their corners, into which lines of one level run from a vertex where more than two do.
    fn prongs(&self) -> Vec<(FaceId, usize)> {
        let inside = self.mesh.vertices().filter(|&v| !self.mesh.is_boundary_vertex(v));
        let around = |v| {
            let corners = self.mesh.outgoing(v).filter_map(|h| self.mesh.corner(h));
            corners.filter(|&(f, k)| self.opposite(f, k).is_some()).collect::<Vec<_>>()
        };
        inside.map(around).filter(|prongs| prongs.len() > 2).flatten().collect()
    }

    /// Where the line from a corner into its face leaves that through the opposite side, if it does.
    fn opposite(&self, f: FaceId, k: usize) -> Option<OnHalfedge> {
        let (z, side) = (self.corners[f.index()], (k + 1) % 3);
        let [from, to] = [z[side][1], z[(side + 1) % 3][1]].map(|y| y - z[k][1]);
        let longest = (0..3).map(|j| norm2(sub(z[(j + 1) % 3], z[j]))).fold(0.0, f64::max).sqrt();
        let is_above = |height: f64| height >= -SAME_LEVEL * longest;
        let is_crossed = is_above(from) != is_above(to);
        is_crossed.then(|| (self.mesh.face_halfedges(f)[side], (from / (from - to)).clamp(0.0, 1.0)))
    }

    /// The line from a corner into its face and beyond. Near their zero lines may be as near to each other as they are.
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

    /// The points after `from`, where the line leaves a face, and the length that they add. For the length `alone` the line does not look
    /// for others.
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
            // Where the form is nearly 0 a line has no way to go on.
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

    fn mark(&mut self, f: FaceId, level: f64, ends: [OnHalfedge; 2], line: usize) {
        if let [Some(a), Some(b)] = ends.map(|end| self.at(end)) {
            self.lines[f.index()].push(Part { level, range: [a[0].min(b[0]), a[0].max(b[0])], line });
        }
    }

    /// Whether the line comes back to a face nearer to itself than lines may approach.
    fn returns(&self, f: FaceId, level: f64, line: usize) -> bool {
        let least = NEAREST * self.spacing * self.scale[f.index()];
        self.lines[f.index()].iter().any(|part| part.line == line && (part.level - level).abs() < least)
    }

    /// Whether another line passes the point z of a face nearer than this share of the spacing, in a drawing of its surroundings.
    fn is_near(&self, f: FaceId, z: Complex, share: f64, line: usize) -> bool {
        let reach = share * self.spacing * self.scale[f.index()];
        let mut seen = HashSet::from([f]);
        let mut open = VecDeque::from([(f, z)]);
        // Each face comes with the point as its own coordinates have it.
        while let Some((f, z)) = open.pop_front() {
            let passes = |part: &Part| {
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

//! Diagnosis of triangle lists: all defects, with their elements and remedies.
//!
//! ```
//! use ricci::mesh::check::diagnose;
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! assert!(diagnose(&positions, &[[0, 1, 2]]).defects.is_empty());
//! let diagnosis = diagnose(&positions, &[[0, 1, 2], [0, 1, 1]]);
//! assert_eq!(diagnosis.counts(), [("degenerate_face", 1)]);
//! ```

mod defect;
mod features;
mod gluing;
mod hint;
mod lattice;
mod orientation;
mod seams;

pub use defect::Defect;
pub use features::{Features, SharpEdge};
pub(super) use gluing::diagnose_gluing;
pub use hint::{CoordinateLattice, Hint, OpenSeam, TJunction};
pub(super) use orientation::{Orientation, OrientedPiece};
pub(super) use seams::t_junctions;

use super::Point;
use super::incidence::{Incidence, boundary_loops, components, ends};
use crate::geometry::triangle::half_differences;
use crate::geometry::vector;
use crate::parallel;
use orientation::orientation;

/// Share of its longest side by which a face must satisfy the triangle inequality, with lengths computed in f64; below it the face counts
/// as zero-area. It is four roundings of a length, which decide whether the inequality holds.
pub const ZERO_AREA: f64 = 4.0 * f64::EPSILON;

/// All defects of a triangle list, or of a gluing, and its counts. No metric can be defined on an input with a defect, so an input is
/// admissible exactly when `defects` is empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagnosis {
    /// The number of vertices given.
    pub vertices: usize,
    /// The number of distinct edges of the faces that are triangles.
    pub edges: usize,
    /// The number of faces given.
    pub faces: usize,
    /// The number of connected pieces (faces that share a vertex are connected).
    pub components: usize,
    /// V − E + F over the used vertices.
    pub euler: i64,
    /// The number of boundary loops, counted as connected pieces of the edges with one face: loops that touch at a non-manifold vertex
    /// count as one.
    pub boundary_loops: usize,
    /// The genus of a connected, orientable manifold (its faces need not be oriented yet).
    pub genus: Option<usize>,
    /// The defects, grouped by kind: first those of the faces' indices, then those of the positions.
    pub defects: Vec<Defect>,
    /// What is no defect and still seldom meant, of a list with positions.
    pub hints: Vec<Hint>,
}

impl Diagnosis {
    /// Number of defects by kind, in order of first appearance.
    pub fn counts(&self) -> Vec<(&'static str, usize)> {
        let mut counts: Vec<(&'static str, usize)> = Vec::new();
        for defect in &self.defects {
            match counts.iter_mut().find(|(code, _)| *code == defect.code()) {
                Some((_, n)) => *n += 1,
                None => counts.push((defect.code(), 1)),
            }
        }
        counts
    }
}

impl std::fmt::Display for Diagnosis {
    /// Writes the hints, then the first defect of each kind, each with its remedy, and how many more there are; numbers count from 0.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for hint in &self.hints {
            write!(f, "{hint}: {}; ", hint.remedy())?;
        }
        let mut kinds: Vec<(&Defect, usize)> = Vec::new();
        for defect in &self.defects {
            let alike = |d: &Defect| (d.code(), d.remedy()) == (defect.code(), defect.remedy());
            match kinds.iter_mut().find(|(first, _)| alike(first)) {
                Some((_, more)) => *more += 1,
                None => kinds.push((defect, 0)),
            }
        }
        for (n, (defect, more)) in kinds.iter().enumerate() {
            let separator = if n > 0 { "; " } else { "" };
            let more = if *more > 0 { format!(" (and {more} more)") } else { String::new() };
            write!(f, "{separator}{defect}{more}: {}", defect.remedy())?;
        }
        let numbered = |(d, _): &(&Defect, usize)| !d.vertices().is_empty() || !d.faces().is_empty();
        if kinds.iter().any(numbered) { write!(f, " (elements are numbered from 0)") } else { Ok(()) }
    }
}

/// Diagnoses an indexed triangle list. O(F log F).
pub fn diagnose(positions: &[Point], faces: &[[u32; 3]]) -> Diagnosis {
    diagnose_positions(positions, faces, &Incidence::new(positions.len(), faces))
}

/// [`diagnose`] of a list that was cut open on purpose. `uncut`: its faces before, with the lists' vertices; seams are looked for in these, so
/// that no cut counts as one, nor takes memory for each of its vertices.
pub(super) fn diagnose_cut(positions: &[Point], faces: &[[u32; 3]], uncut: &[[u32; 3]]) -> Diagnosis {
    let hints = hints(positions, uncut);
    diagnose_with(positions, faces, &Incidence::new(positions.len(), faces), hints)
}

pub(super) fn diagnose_positions(
    positions: &[Point],
    faces: &[[u32; 3]],
    incidence: &Incidence,
) -> Diagnosis {
    diagnose_with(positions, faces, incidence, hints_of(positions, faces, incidence))
}

fn diagnose_with(
    positions: &[Point],
    faces: &[[u32; 3]],
    incidence: &Incidence,
    hints: Vec<Hint>,
) -> Diagnosis {
    let mut diagnosis = diagnose_incidence(faces, incidence);
    let finite = |v: usize| positions[v].iter().all(|x| x.is_finite());
    let coordinates = (0..positions.len()).filter(|&v| !finite(v));
    diagnosis.defects.extend(coordinates.map(|v| Defect::NonFiniteCoordinate { vertex: v as u32 }));
    for (face, corners) in faces.iter().enumerate().filter(|(f, _)| incidence.is_triangle(*f)) {
        let p = corners.map(|v| positions[v as usize]);
        if corners.iter().all(|&v| finite(v as usize)) && has_zero_area(p) {
            diagnosis.defects.push(Defect::ZeroAreaFace { face: face as u32 });
        }
    }
    diagnosis.hints = hints;
    let joins =
        |hint: &Hint| matches!(hint, Hint::OpenSeam(OpenSeam { components: [now, then], .. }) if then < now);
    let is_torn = diagnosis.hints.iter().any(joins);
    for defect in &mut diagnosis.defects {
        if let Defect::SeveralComponents { torn, .. } = defect {
            *torn = is_torn;
        }
    }
    diagnosis
}

/// What is no defect of a triangle list and still seldom meant. O(F log F).
pub fn hints(positions: &[Point], faces: &[[u32; 3]]) -> Vec<Hint> {
    hints_of(positions, faces, &Incidence::new(positions.len(), faces))
}

fn hints_of(positions: &[Point], faces: &[[u32; 3]], incidence: &Incidence) -> Vec<Hint> {
    let coarse = lattice::lattice(positions, faces);
    let step = coarse.map_or(0.0, |found| found.step);
    let mut hints = seams::seam_hints(positions, faces, incidence, step);
    hints.extend(coarse.map(Hint::CoarseCoordinates));
    hints
}

pub(super) fn diagnose_incidence(faces: &[[u32; 3]], incidence: &Incidence) -> Diagnosis {
    let n = incidence.n_vertices;
    let mut defects = Vec::new();
    if faces.is_empty() {
        defects.push(Defect::Empty { collapsed: 0 });
    }
    let in_range = |v: &u32| (*v as usize) < n;
    for (face, corners) in (0u32..).zip(faces) {
        let beyond = corners.iter().filter(|v| !in_range(v));
        defects.extend(beyond.map(|&index| Defect::IndexOutOfRange { face, index }));
    }
    let degenerate = |f: &usize| !incidence.is_triangle(*f) && faces[*f].iter().all(in_range);
    let degenerate = (0..faces.len()).filter(degenerate);
    defects.extend(degenerate.map(|f| Defect::DegenerateFace { face: f as u32 }));
    duplicates(faces, incidence, &mut defects);
    let mut pinched = vec![false; n];
    let mut manifold = defects.is_empty();
    for sides in incidence.edges().filter(|sides| sides.len() > 2) {
        let vertices = ends(faces, sides[0]);
        vertices.into_iter().for_each(|v| pinched[v as usize] = true);
        defects.push(Defect::NonManifoldEdge { vertices, faces: sides.iter().map(|s| s / 3).collect() });
    }
    let sheets = incidence.sheets(faces);
    for v in 0..n {
        if sheets[v] > 1 || pinched[v] {
            manifold = false;
            defects.push(Defect::NonManifoldVertex { vertex: v as u32, sheets: sheets[v] });
        }
    }
    let orientable = orientation(faces, incidence, &mut defects);
    defects.extend((0..n).filter(|&v| sheets[v] == 0).map(|v| Defect::IsolatedVertex { vertex: v as u32 }));
    let components = several_components(components(n, incidence.triangles(faces)), &mut defects);
    let edges = incidence.edges().count();
    let used = sheets.iter().filter(|&&s| s > 0).count();
    let euler = used as i64 - edges as i64 + incidence.triangles(faces).count() as i64;
    let boundary = incidence.edges().filter(|sides| sides.len() == 1).map(|sides| ends(faces, sides[0]));
    let boundary_loops = boundary_loops(n, boundary);
    let genus = (manifold && orientable && components == 1).then(|| genus(euler, boundary_loops)).flatten();
    let hints = Vec::new();
    Diagnosis {
        vertices: n,
        edges,
        faces: faces.len(),
        components,
        euler,
        boundary_loops,
        genus,
        defects,
        hints,
    }
}

/// The number of pieces; if there are several, this adds a defect.
fn several_components(pieces: Vec<(u32, u32)>, defects: &mut Vec<Defect>) -> usize {
    let n = pieces.len();
    if n > 1 {
        let (first_faces, sizes) = pieces.into_iter().unzip();
        defects.push(Defect::SeveralComponents { sizes, first_faces, torn: false });
    }
    n
}

/// The genus by χ = 2 − 2g − b.
fn genus(euler: i64, boundary_loops: usize) -> Option<usize> {
    usize::try_from((2 - euler - boundary_loops as i64) / 2).ok()
}

/// Adds the faces with the same set of vertices as an earlier one to the defects.
fn duplicates(faces: &[[u32; 3]], incidence: &Incidence, defects: &mut Vec<Defect>) {
    // Such faces meet in the edge of their two smaller vertices.
    let (mut beyond, mut found) = (Vec::new(), Vec::new());
    for sides in incidence.edges().filter(|sides| sides.len() > 1) {
        beyond.clear();
        for &side in sides {
            let (face, k) = (side / 3, side as usize % 3);
            let [start, end, third] = [k, k + 1, k + 2].map(|k| faces[face as usize][k % 3]);
            if third > start.max(end) {
                beyond.push((third, face));
            }
        }
        beyond.sort_unstable();
        for same in beyond.chunk_by(|a, b| a.0 == b.0) {
            found.extend(same[1..].iter().map(|&(_, face)| (face, same[0].1)));
        }
    }
    found.sort_unstable();
    defects.extend(found.into_iter().map(|(face, first)| Defect::DuplicateFace { face, first }));
}

/// Number of faces that one thread of [`is_sound`] takes at a time.
const FACES_PER_CHECK: usize = 1 << 14;

/// True if all positions are finite and no face, of three different existing vertices, has zero area.
pub(super) fn is_sound(positions: &[Point], faces: &[[u32; 3]]) -> bool {
    let is_plane = |corners: &[u32; 3]| {
        let p = corners.map(|v| positions[v as usize]);
        has_clear_area(p) || !has_zero_area(p)
    };
    let parts: Vec<_> = faces.chunks(FACES_PER_CHECK).collect();
    positions.as_flattened().iter().all(|x| x.is_finite())
        && parallel::map(parts.len(), |k| parts[k].iter().all(is_plane)).into_iter().all(|all| all)
}

/// Squared area over the fourth power of the longest edge from which on a triangle is far from zero area: its smallest half-perimeter
/// difference is then above 1e-9 of the longest edge.
const CLEAR: f64 = 1e-8;

/// True if a triangle certainly has an area, by a few products; false where these are not finite.
fn has_clear_area(p: [Point; 3]) -> bool {
    let [u, v, w] = [[0, 1], [0, 2], [1, 2]].map(|[i, j]| vector::sub(p[j], p[i]));
    let norm2 = |u| vector::dot(u, u);
    let longest = norm2(u).max(norm2(v)).max(norm2(w));
    norm2(vector::cross(u, v)) > 4.0 * CLEAR * longest * longest
}

/// True if the corners are collinear to working precision.
pub(super) fn has_zero_area(p: [Point; 3]) -> bool {
    let distance = |a: Point, b: Point| f64::hypot(f64::hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
    let l = [distance(p[1], p[2]), distance(p[2], p[0]), distance(p[0], p[1])];
    let r = half_differences(l);
    let longest = l.into_iter().fold(0.0, f64::max);
    r.into_iter().any(|r| r <= ZERO_AREA * longest)
}

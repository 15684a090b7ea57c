//! Filling of holes: each boundary loop gets a patch of least area, refined to the edges around it and faired.
//!
//! ```
//! use ricci::control::Control;
//! use ricci::mesh::holes::HoleChoice;
//! use ricci::mesh::repair::{Repair, repair};
//! use ricci::mesh::{Mesh, shapes};
//! let mut sphere = shapes::icosphere(4)?;
//! sphere.faces.retain(|face| !face.contains(&20));
//! let done = repair(&sphere, &Repair { holes: HoleChoice::All, ..Repair::default() }, &Control::new())?;
//! assert_eq!((done.filling.filled.len(), Mesh::from_soup(&done.soup)?.euler()), (1, 2));
//! # Ok::<(), ricci::Error>(())
//! ```
//!
//! The triangulation of least area is \[BS95\], refinement follows \[Lie03\]; the patch is faired by a discrete bi-Laplacian with cotangent
//! weights \[BS08\], whose boundary are the loop and the faces around it.

mod ears;
mod fair;
mod patch;
mod triangulate;

pub use triangulate::MOST_EXACT;

use super::Point;
use super::incidence::Incidence;
use super::io::{Attributes, Soup};
use super::rims::{Rim, rims_of};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector;
use fair::{RingCorner, RingFace};
use patch::HolePatch;
use std::collections::HashSet;
use std::ops::Range;

/// The boundary loops to fill.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum HoleChoice {
    /// None.
    #[default]
    Nothing,
    /// Those with at most this many edges.
    UpTo(usize),
    /// All of them.
    All,
    /// Those through these vertices.
    Through(Vec<u32>),
}

/// A loop that was filled.
#[derive(Debug, Clone, PartialEq)]
pub struct FilledHole {
    /// Number of its edges.
    pub edges: usize,
    /// Its length.
    pub length: f64,
    /// The vertex of the loop with the lowest number.
    pub vertex: u32,
    /// The faces of the patch.
    pub faces: Range<u32>,
    /// The vertices inside the patch.
    pub vertices: Range<u32>,
    /// Area of the patch.
    pub area: f64,
}

/// A chosen loop that was left open.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenHole {
    /// Number of its edges.
    pub edges: usize,
    /// The vertex of the loop with the lowest number.
    pub vertex: u32,
    /// Why.
    pub reason: &'static str,
}

/// What [`fill_holes`] did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Filling {
    /// The loops that are filled, in the order of [`super::rims::rims`].
    pub filled: Vec<FilledHole>,
    /// The chosen loops that are not.
    pub open: Vec<OpenHole>,
}

/// Fills boundary loops of a list. New vertices and faces come behind the others, loop by loop; no other element changes. Attributes of
/// vertices and corners are continued from the loop.
///
/// A planar hole in planar surroundings stays planar; elsewhere the patch continues the tangent planes around it. Memory is that of the
/// patch and, for a loop of n edges, 12 n² bytes for n up to [`MOST_EXACT`]; longer loops are triangulated ear by ear.
///
/// # Errors
/// [`Error::Argument`] for a vertex of [`HoleChoice::Through`] on no loop; [`Error::TooLarge`] for more vertices than can be numbered.
pub fn fill_holes(soup: &mut Soup, choice: &HoleChoice, control: &Control) -> Result<Filling> {
    let mut filling = Filling::default();
    if *choice == HoleChoice::Nothing {
        return Ok(filling);
    }
    let incidence = Incidence::new(soup.positions.len(), &soup.faces);
    let rims = rims_of(&soup.positions, &soup.faces, &incidence);
    let chosen = chosen(&rims, choice)?;
    let around = Surroundings::new(soup, &incidence, &chosen);
    for rim in chosen {
        control.check()?;
        let (edges, vertex) = (rim.vertices.len(), rim.vertex());
        match reason_to_leave(rim, soup).map_or_else(|| around.patch(rim, soup), Err) {
            Ok(patch) => filling.filled.push(append(soup, rim, &patch)?),
            Err(reason) => filling.open.push(OpenHole { edges, vertex, reason }),
        }
    }
    Ok(filling)
}

fn chosen<'a>(rims: &'a [Rim], choice: &HoleChoice) -> Result<Vec<&'a Rim>> {
    if let HoleChoice::Through(named) = choice {
        let on_loops: HashSet<u32> = rims.iter().flat_map(|rim| rim.vertices.iter().copied()).collect();
        if let Some(v) = named.iter().find(|v| !on_loops.contains(v)) {
            return Err(Error::argument(
                "hole",
                format!("vertex {v}"),
                "a vertex of a boundary loop (ricci info lists them)",
            ));
        }
    }
    let is_chosen = |rim: &&Rim| match choice {
        HoleChoice::Nothing => false,
        HoleChoice::UpTo(most) => rim.vertices.len() <= *most,
        HoleChoice::All => true,
        HoleChoice::Through(named) => named.iter().any(|v| rim.vertices.contains(v)),
    };
    Ok(rims.iter().filter(is_chosen).collect())
}

/// Why a loop cannot be filled, as far as the loop itself tells.
fn reason_to_leave(rim: &Rim, soup: &Soup) -> Option<&'static str> {
    let mut once = rim.vertices.clone();
    once.sort_unstable();
    once.dedup();
    let is_finite = rim.vertices.iter().all(|&v| soup.positions[v as usize].iter().all(|x| x.is_finite()));
    match () {
        () if !rim.is_oriented => Some(
            "the faces along it do not agree in direction: the surface there is one-sided or not oriented",
        ),
        () if once.len() < rim.vertices.len() => {
            Some("it runs through a vertex twice: ricci repair separates its sheets")
        }
        () if rim.vertices.len() < 3 => Some("it has fewer than three edges"),
        () if !is_finite => Some("a vertex of it has no finite place"),
        () => None,
    }
}

/// What the loops to fill need to know of the surface.
struct Surroundings {
    /// The edges of the surface with both ends on the loops.
    edges: HashSet<[u32; 2]>,
    /// The faces at each vertex of the loops, as ranges of `faces`.
    start: Vec<u32>,
    faces: Vec<u32>,
}

impl Surroundings {
    fn new(soup: &Soup, incidence: &Incidence, rims: &[&Rim]) -> Surroundings {
        let mut on_loop = vec![false; soup.positions.len()];
        rims.iter().flat_map(|rim| &rim.vertices).for_each(|&v| on_loop[v as usize] = true);
        let mut edges = HashSet::new();
        for sides in incidence.edges() {
            let [a, b] = super::incidence::ends(&soup.faces, sides[0]);
            if on_loop[a as usize] && on_loop[b as usize] {
                edges.insert([a.min(b), a.max(b)]);
            }
        }
        let mut corners: Vec<(u32, u32)> = Vec::new();
        for (f, face) in incidence.triangles(&soup.faces) {
            corners.extend(face.iter().filter(|v| on_loop[**v as usize]).map(|&v| (v, f)));
        }
        corners.sort_unstable();
        let mut start = vec![0u32; soup.positions.len() + 1];
        corners.iter().for_each(|&(v, _)| start[v as usize + 1] += 1);
        (0..soup.positions.len()).for_each(|v| start[v + 1] += start[v]);
        Surroundings { edges, start, faces: corners.into_iter().map(|(_, f)| f).collect() }
    }

    fn faces_at(&self, v: u32) -> &[u32] {
        &self.faces[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }

    /// The patch of a loop, whose corners 0 … n − 1 are those of the loop backwards.
    fn patch(&self, rim: &Rim, soup: &Soup) -> std::result::Result<HolePatch, &'static str> {
        let corners: Vec<u32> = rim.vertices.iter().rev().copied().collect();
        let points: Vec<Point> = corners.iter().map(|&v| soup.positions[v as usize]).collect();
        let is_taken = |i: usize, j: usize| {
            let (a, b) = (corners[i], corners[j]);
            self.edges.contains(&[a.min(b), a.max(b)])
        };
        let is_long = points.len() > MOST_EXACT;
        let method = if is_long { ears::cut_ears } else { triangulate::least_area };
        let Some(triangles) = method(&points, &is_taken) else {
            return Err(
                "no triangulation of it has an area everywhere and repeats no edge: its vertices lie on a line (weld them), or are joined already",
            );
        };
        if let [only] = triangles[..] {
            let is_same =
                |&f: &u32| only.iter().all(|&k| soup.faces[f as usize].contains(&corners[k as usize]));
            if self.faces_at(corners[0]).iter().any(is_same) {
                return Err("it is the boundary of a single triangle, which the patch would repeat");
            }
        }
        let mut patch = HolePatch::new(points, triangles, self.scales(&corners, soup));
        let ring = self.ring(&corners, soup);
        for _ in 0..ROUNDS {
            patch.refine(&is_taken);
            fair::fair(&mut patch, &ring);
        }
        Ok(patch)
    }

    /// The mean length of the surface's edges at each corner.
    fn scales(&self, corners: &[u32], soup: &Soup) -> Vec<f64> {
        let mean = |&v: &u32| {
            let mut others: Vec<u32> =
                self.faces_at(v).iter().flat_map(|&f| soup.faces[f as usize]).collect();
            others.sort_unstable();
            others.dedup();
            let lengths = others.iter().filter(|w| **w != v);
            let sum: f64 = lengths
                .map(|&w| vector::distance(soup.positions[v as usize], soup.positions[w as usize]))
                .sum();
            sum / (others.len() - 1) as f64
        };
        corners.iter().map(mean).collect()
    }

    /// The faces of the surface around the loop; corners of the loop have their numbers in the patch.
    fn ring(&self, corners: &[u32], soup: &Soup) -> Vec<RingFace> {
        let mut faces: Vec<u32> = corners.iter().flat_map(|&v| self.faces_at(v)).copied().collect();
        faces.sort_unstable();
        faces.dedup();
        let number: std::collections::HashMap<u32, u32> =
            (0u32..).zip(corners).map(|(k, &v)| (v, k)).collect();
        let corner =
            |v: u32| RingCorner { on_loop: number.get(&v).copied(), place: soup.positions[v as usize] };
        faces.into_iter().map(|f| RingFace(soup.faces[f as usize].map(corner))).collect()
    }
}

/// Rounds of refinement and fairing: the second divides the triangles that fairing has stretched.
const ROUNDS: usize = 2;

/// Adds a patch behind the other elements.
fn append(soup: &mut Soup, rim: &Rim, patch: &HolePatch) -> Result<FilledHole> {
    let (n, m, edges) = (soup.positions.len(), soup.faces.len(), rim.vertices.len());
    let n_new = patch.points.len() - edges;
    for (what, count) in [("vertices", n + n_new), ("sides of faces", 3 * (m + patch.triangles.len()))] {
        if count >= i32::MAX as usize {
            return Err(Error::TooLarge { what, count });
        }
    }
    let number = |k: u32| match (k as usize).checked_sub(edges) {
        None => rim.vertices[edges - 1 - k as usize],
        Some(new) => (n + new) as u32,
    };
    continue_attributes(&mut soup.attributes, &soup.faces, rim, patch);
    continue_names(&mut soup.attributes, rim, patch);
    soup.positions.extend(&patch.points[edges..]);
    soup.faces.extend(patch.triangles.iter().map(|t| t.map(number)));
    let areas = patch
        .triangles
        .iter()
        .map(|t| 0.5 * vector::norm(vector::triangle_normal(t.map(|k| patch.points[k as usize]))));
    Ok(FilledHole {
        edges,
        length: rim.length,
        vertex: rim.vertex(),
        faces: m as u32..soup.faces.len() as u32,
        vertices: n as u32..soup.positions.len() as u32,
        area: areas.sum(),
    })
}

/// Continues the attributes of a loop over its patch: each new vertex has the mean of the three between which it was put.
fn continue_attributes(attributes: &mut Attributes, faces: &[[u32; 3]], rim: &Rim, patch: &HolePatch) {
    let backwards = || rim.sides.iter().rev();
    // Side 3f + k of the loop starts at corner k of face f.
    if let Some(normals) = attributes.normals.as_mut().filter(|all| !all.is_empty()) {
        let known = rim.vertices.iter().rev().map(|&v| normals[v as usize]).collect();
        normals.extend(&patch.continued(known)[rim.vertices.len()..]);
    }
    if let Some(colors) = attributes.colors.as_mut().filter(|all| !all.is_empty()) {
        let known = rim.vertices.iter().rev().map(|&v| colors[v as usize]).collect();
        colors.extend(&patch.continued(known)[rim.vertices.len()..]);
    }
    if let Some(corner_normals) = attributes.corner_normals.as_mut().filter(|all| all.len() == faces.len()) {
        let known = backwards().map(|&s| corner_normals[s as usize / 3][s as usize % 3]).collect();
        let all = patch.continued(known);
        corner_normals.extend(patch.triangles.iter().map(|t| t.map(|k| all[k as usize])));
    }
    if let Some(uv) = attributes.uv.as_mut().filter(|all| all.len() == faces.len()) {
        let known = backwards().map(|&s| uv[s as usize / 3][s as usize % 3]).collect();
        let all = patch.continued(known);
        uv.extend(patch.triangles.iter().map(|t| t.map(|k| all[k as usize])));
    }
}

/// Continues names and further numbers over a patch: its faces have those of the face beside the first side of the loop, its new vertices
/// the mean as other attributes, or where numbers are integers, which may be labels, that of the first vertex of the loop.
fn continue_names(attributes: &mut Attributes, rim: &Rim, patch: &HolePatch) {
    let (Some(&side), Some(&first)) = (rim.sides.first(), rim.vertices.first()) else { return };
    let (beside, faces) = (side as usize / 3, patch.triangles.len());
    if let Some(labels) = &mut attributes.labels {
        let label = labels.of_face[beside];
        labels.of_face.extend(std::iter::repeat_n(label, faces));
    }
    for column in &mut attributes.face_numbers {
        let number = column.values[beside];
        column.values.extend(std::iter::repeat_n(number, faces));
    }
    for column in &mut attributes.vertex_numbers {
        let known = rim.vertices.iter().rev().map(|&v| [column.values[v as usize]]).collect();
        let label = column.values[first as usize];
        let means = patch.continued(known).into_iter().skip(rim.vertices.len());
        column.values.extend(means.map(|[mean]| if column.kind.is_integer() { label } else { mean }));
    }
}

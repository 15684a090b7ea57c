//! Intrinsic metrics as JSON files: what `--metric` writes, and what is read in place of a mesh.
//!
//! Per-face triples are ordered opposite the corners: `[bc, ca, ab]` for the face `[a, b, c]`. Numbers are written so that they read back
//! as the same floating-point numbers.

use crate::failure::Failure;
use ricci::Surface;
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::geometry::triangle::angles;
use ricci::mesh::check::Defect;
use ricci::mesh::io::text::{TextBuilder, write_blocks};
use ricci::mesh::{Mesh, PerEdge, PerVertex};
use ricci::metric::Measured;
use ricci::parallel::within;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};
use std::io::{self, Write};
use std::path::Path;

/// The scheme of a metric whose vertices are of several types.
pub const MIXED: &str = "mixed";

/// Largest relative difference of the two lengths that a file has for an edge, one for each of its faces: programs that compute lengths
/// per face round them differently.
const LENGTHS_AGREE: f64 = 1e-12;

/// A surface by its edge lengths, without a conformal class, as `ricci make` writes it.
#[derive(Serialize)]
pub struct LengthsFile {
    /// The geometry in which `lengths` are to be read.
    input_geometry: &'static str,
    faces: Vec<[u32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    face_edges: Option<Vec<[i32; 3]>>,
    lengths: Vec<[f64; 3]>,
}

impl LengthsFile {
    pub fn new(mesh: &Mesh, geometry: Space, lengths: &PerEdge<f64>) -> Self {
        LengthsFile {
            input_geometry: geometry.name(),
            faces: mesh.triangles(),
            face_edges: face_edges_of(mesh),
            lengths: per_face(mesh, lengths),
        }
    }

    /// With the numbers of the edges, so that a file that names edges fits it.
    pub fn with_numbered_edges(mut self, mesh: &Mesh) -> Self {
        self.face_edges = Some(mesh.faces().map(|f| mesh.face_edges(f)).collect());
        self
    }
}

/// A metric on its final triangulation, as `--metric` writes it.
#[derive(Serialize)]
pub struct MetricFile<'a> {
    space: &'static str,
    scheme: &'static str,
    #[serde(flatten)]
    surface: LengthsFile,
    eta: Vec<[f64; 3]>,
    /// The parts of the lengths that `lengths` loses by rounding; left out where all are 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    lengths_lo: Option<Vec<[f64; 3]>>,
    u: Cow<'a, [f64]>,
    conformal_factor: Vec<f64>,
    epsilon: Cow<'a, [i8]>,
    target: Cow<'a, [f64]>,
    boundary: Vec<bool>,
    /// Per vertex its mirror image, where the surface is the double of the input, whose vertices come first.
    #[serde(skip_serializing_if = "Option::is_none")]
    mirror: Option<Vec<u32>>,
}

impl<'a> MetricFile<'a> {
    /// `target`: the target curvature of each vertex of the solution's triangulation.
    pub fn new(solution: &'a Solution, target: &'a PerVertex<f64>) -> ricci::Result<Self> {
        within(solution.threads(), || {
            MetricFile::of(solution, &solution.metric().measured(solution.mesh())?, target)
        })
    }

    /// [`MetricFile::new`] for a solution whose metric has been measured.
    pub fn of(
        solution: &'a Solution,
        measured: &Measured,
        target: &'a PerVertex<f64>,
    ) -> ricci::Result<Self> {
        let (mesh, metric) = (solution.mesh(), solution.metric());
        let lengths = measured.lengths()?;
        let lost = measured.remainders(&lengths);
        Ok(MetricFile {
            space: metric.space.name(),
            scheme: solution.class().map_or(MIXED, |class| class.scheme.name()),
            surface: LengthsFile::new(mesh, metric.space, &lengths),
            eta: per_face(mesh, &metric.rounded_eta()),
            lengths_lo: lost.iter().any(|&lo| lo != 0.0).then(|| per_face(mesh, &lost)),
            u: Cow::Borrowed(&metric.u),
            conformal_factor: solution.initial().conformal_factor(metric)?.into_vec(),
            epsilon: Cow::Borrowed(&metric.epsilon),
            target: Cow::Borrowed(target),
            boundary: mesh.vertices().map(|v| mesh.is_boundary_vertex(v)).collect(),
            mirror: solution.double().map(|double| mesh.vertices().map(|v| double.mirror(v).0).collect()),
        })
    }
}

impl MetricFile<'_> {
    /// Write this as JSON on one line, the same text as by serde. Inside a pool its threads share the formatting of the numbers.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let LengthsFile { input_geometry, faces, face_edges, lengths } = &self.surface;
        let triples = |values: &[[f64; 3]], text: &mut TextBuilder, k: usize| triple(text, values[k], number);
        write!(out, "{{\"space\":\"{}\",\"scheme\":\"{}\"", self.space, self.scheme)?;
        write!(out, ",\"input_geometry\":\"{input_geometry}\"")?;
        array(out, "faces", faces.len(), |text, f| triple(text, faces[f], |text, v| text.count(v.into())))?;
        if let Some(edges) = face_edges {
            array(out, "face_edges", edges.len(), |text, f| triple(text, edges[f], signed))?;
        }
        array(out, "lengths", lengths.len(), |text, f| triples(lengths, text, f))?;
        array(out, "eta", self.eta.len(), |text, f| triples(&self.eta, text, f))?;
        if let Some(low) = &self.lengths_lo {
            array(out, "lengths_lo", low.len(), |text, f| triples(low, text, f))?;
        }
        array(out, "u", self.u.len(), |text, v| number(text, self.u[v]))?;
        let factor = &self.conformal_factor;
        array(out, "conformal_factor", factor.len(), |text, v| number(text, factor[v]))?;
        array(out, "epsilon", self.epsilon.len(), |text, v| signed(text, self.epsilon[v].into()))?;
        array(out, "target", self.target.len(), |text, v| number(text, self.target[v]))?;
        let boundary = &self.boundary;
        array(out, "boundary", boundary.len(), |text, v| {
            text.text(if boundary[v] { "true" } else { "false" });
        })?;
        if let Some(mirror) = &self.mirror {
            array(out, "mirror", mirror.len(), |text, v| text.count(mirror[v].into()))?;
        }
        writeln!(out, "}}")
    }

    /// The metric without a vertex and the faces at it. The other vertices of these faces are on the boundary then.
    pub fn without(mut self, vertex: usize) -> Self {
        let gone: Vec<bool> = self.surface.faces.iter().map(|f| f.contains(&(vertex as u32))).collect();
        for face in (0..gone.len()).filter(|&f| gone[f]) {
            self.surface.faces[face].into_iter().for_each(|v| self.boundary[v as usize] = true);
        }
        keep(&mut self.surface.faces, &gone);
        keep(&mut self.surface.lengths, &gone);
        keep(&mut self.eta, &gone);
        self.lengths_lo.iter_mut().for_each(|lo| keep(lo, &gone));
        self.surface.face_edges.iter_mut().for_each(|edges| keep(edges, &gone));
        let down = |v: u32| v - u32::from(v as usize > vertex);
        self.surface.faces.iter_mut().for_each(|f| *f = f.map(down));
        self.u.to_mut().remove(vertex);
        self.epsilon.to_mut().remove(vertex);
        self.target.to_mut().remove(vertex);
        self.conformal_factor.remove(vertex);
        self.boundary.remove(vertex);
        self
    }

    /// The metric with its own curvature as the target of boundary vertices; `curvature`: that of each vertex of the file.
    pub fn free_on_boundary(mut self, curvature: &[f64]) -> Self {
        let target = self.target.to_mut();
        for v in (0..target.len()).filter(|&v| self.boundary[v]) {
            target[v] = curvature[v];
        }
        self
    }

    /// K of the file's lengths: 2π, or π on the boundary, less the angles.
    pub fn curvature(&self) -> Vec<f64> {
        let around = |boundary: &bool| if *boundary { PI } else { TAU };
        let mut curvature: Vec<f64> = self.boundary.iter().map(around).collect();
        for (face, lengths) in self.surface.faces.iter().zip(&self.surface.lengths) {
            let angles = angles(Space::E2, *lengths).at;
            face.iter().zip(angles).for_each(|(&v, angle)| curvature[v as usize] -= angle);
        }
        curvature
    }
}

/// Write a field of a JSON object that follows another one and holds a list of n items.
fn array(
    out: &mut impl Write,
    name: &str,
    n: usize,
    item: impl Fn(&mut TextBuilder, usize) + Sync,
) -> io::Result<()> {
    write!(out, ",\"{name}\":[")?;
    write_blocks(out, n, |text, k| {
        if k > 0 {
            text.character(',');
        }
        item(text, k);
    })?;
    out.write_all(b"]")
}

fn triple<T: Copy>(text: &mut TextBuilder, values: [T; 3], item: impl Fn(&mut TextBuilder, T)) {
    for (before, value) in ['[', ',', ','].into_iter().zip(values) {
        text.character(before);
        item(text, value);
    }
    text.character(']');
}

/// Write a number; JSON has none that is not finite.
fn number(text: &mut TextBuilder, x: f64) {
    if x.is_finite() { text.number(x) } else { text.text("null") }
}

fn signed(text: &mut TextBuilder, n: i32) {
    if n < 0 {
        text.character('-');
    }
    text.count(n.unsigned_abs().into());
}

fn keep<T>(list: &mut Vec<T>, gone: &[bool]) {
    let mut at = 0;
    list.retain(|_| {
        at += 1;
        !gone[at - 1]
    });
}

/// Values of edges per face, opposite its corners.
fn per_face(mesh: &Mesh, values: &PerEdge<f64>) -> Vec<[f64; 3]> {
    mesh.faces().map(|f| mesh.opposite_edges(f).map(|e| values[e])).collect()
}

/// 1-based edge numbers with the direction as sign, where the faces' vertices alone do not give the surface: where edges
/// are not determined by their ends, or two faces have the same vertices.
fn face_edges_of(mesh: &Mesh) -> Option<Vec<[i32; 3]>> {
    (!mesh.is_given_by_faces()).then(|| mesh.faces().map(|f| mesh.face_edges(f)).collect())
}

/// The fields that are read: `faces` and `lengths` suffice. `input_geometry` (default e2) says how the lengths are read. A conformal
/// class in the file (`eta`, `u`, `epsilon`) is passed over: the lengths are the metric.
#[derive(Deserialize)]
struct MetricFields {
    faces: Vec<[u32; 3]>,
    lengths: Vec<[f64; 3]>,
    #[serde(default)]
    lengths_lo: Option<Vec<[f64; 3]>>,
    #[serde(default)]
    face_edges: Option<Vec<[i32; 3]>>,
    #[serde(default)]
    input_geometry: Option<String>,
}

/// Read the text of a metric file; `geometry` is to be taken in place of the one that it names.
pub fn parse(path: &Path, text: &str, geometry: Option<Space>) -> Result<Surface, Failure> {
    let refuse = |why: String| Failure::Input(format!("{}: {why}", path.display()));
    let given: MetricFields = serde_json::from_str(text).map_err(|e| refuse(e.to_string()))?;
    let n_faces = given.faces.len();
    let sizes = [
        ("lengths", Some(given.lengths.len())),
        ("lengths_lo", given.lengths_lo.as_ref().map(Vec::len)),
        ("face_edges", given.face_edges.as_ref().map(Vec::len)),
    ];
    if let Some((what, Some(n))) = sizes.into_iter().find(|(_, n)| n.is_some_and(|n| n != n_faces)) {
        return Err(refuse(format!(
            "`{what}` has {n} entries, one is needed for each of the {n_faces} faces"
        )));
    }
    let written = match given.input_geometry.as_deref() {
        None => Space::E2,
        Some(name) => name.parse().map_err(|e: ricci::Error| refuse(format!("input_geometry: {e}")))?,
    };
    let n_vertices = n_vertices(&given.faces).map_err(refuse)?;
    let mesh = match &given.face_edges {
        Some(edges) => Mesh::from_gluing(n_vertices, &given.faces, edges)?,
        None => Mesh::from_faces(n_vertices, &given.faces).map_err(|error| match error {
            ricci::Error::Defects(d) if d.defects.iter().any(may_be_glued) => Failure::Unglued(d),
            error => error.into(),
        })?,
    };
    let low = given.lengths_lo.into_iter().flatten().chain(std::iter::repeat([0.0; 3]));
    let sides = given.lengths.into_iter().zip(low);
    let sides: Vec<[f64; 3]> = sides.map(|(hi, lo)| [0, 1, 2].map(|k| hi[k] + lo[k])).collect();
    let lengths = edge_lengths(&mesh, &sides).map_err(refuse)?;
    Ok(Surface::intrinsic(mesh, lengths, geometry.unwrap_or(written))?)
}

/// True for a defect of faces that are given by their vertices, but not of faces that are glued.
fn may_be_glued(defect: &Defect) -> bool {
    matches!(
        defect,
        Defect::DuplicateFace { .. } | Defect::DegenerateFace { .. } | Defect::NonManifoldEdge { .. }
    )
}

/// One more than the largest vertex, which may not exceed the number of corners: the numbers in the file are not
/// trusted with memory.
fn n_vertices(faces: &[[u32; 3]]) -> Result<usize, String> {
    let largest = faces.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    if largest > 3 * faces.len() {
        return Err(format!(
            "vertex {} is named, but {} faces have at most {} vertices: number the vertices from 0 without gaps",
            largest - 1,
            faces.len(),
            3 * faces.len()
        ));
    }
    Ok(largest)
}

/// Lengths per edge from lengths per face.
fn edge_lengths(mesh: &Mesh, sides: &[[f64; 3]]) -> Result<PerEdge<f64>, String> {
    let mut lengths = PerEdge::filled(mesh.n_edges(), f64::NAN);
    for (f, sides) in mesh.faces().zip(sides) {
        let corners = mesh.face_vertices(f);
        for (k, (e, &side)) in mesh.opposite_edges(f).into_iter().zip(sides).enumerate() {
            let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            if !(side.is_finite() && side > 0.0) {
                return Err(format!("face {f}: side {a}–{b} has length {side}, it must be positive"));
            }
            let known = lengths[e];
            if known.is_nan() {
                lengths[e] = side;
            } else if (known - side).abs() > LENGTHS_AGREE * known {
                return Err(format!(
                    "face {f}: side {a}–{b} has length {side}, the face across it says {known}: \
                     the two sides of an edge must agree to {LENGTHS_AGREE:e}"
                ));
            }
        }
    }
    Ok(lengths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::mesh::shapes;
    use ricci::{Class, Surface};

    #[test]
    fn what_is_written_is_what_serde_makes_of_it() {
        let (mesh, lengths) = shapes::flat_torus([0.3, 1.0], 1, 1).unwrap().build().unwrap();
        let glued = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
        let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 90, 60).unwrap()).unwrap();
        for surface in [glued, torus] {
            let solution = Solution::initial_of(surface, Class::yamabe(Space::E2)).unwrap();
            let n = solution.mesh().n_vertices();
            let target =
                PerVertex::from_fn(n, |v: ricci::mesh::VertexId| if v.0 == 0 { f64::NAN } else { -1e-300 });
            let mut file = MetricFile::new(&solution, &target).unwrap();
            file.mirror = Some((0..n as u32).rev().collect());
            file.lengths_lo = Some(vec![[0.0, -1e-17, 1e22]; 5]);
            file.boundary[0] = true;
            let mut written = Vec::new();
            file.write(&mut written).unwrap();
            let expected = serde_json::to_string(&file).unwrap() + "\n";
            assert!(String::from_utf8(written).unwrap() == expected);
        }
    }
}

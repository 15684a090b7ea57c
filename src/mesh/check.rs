//! Diagnosis of triangle lists: every defect, its elements and its remedy.

use super::Point;
use super::incidence::{Incidence, UnionFind};
use crate::geometry::triangle::half_differences;
use std::collections::BTreeMap;

/// A face counts as zero-area when its lengths, as computed in doubles, satisfy the triangle inequality by less than
/// this fraction of the longest side: four roundings of a length, below which the inequality is an accident.
pub const ZERO_AREA: f64 = 4.0 * f64::EPSILON;

/// One defect with the elements it concerns (0-based input indices).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Defect {
    /// There is no face.
    Empty,
    /// A face names a vertex that does not exist.
    IndexOutOfRange {
        /// The face.
        face: u32,
        /// The index it uses.
        index: u32,
    },
    /// A coordinate is NaN or infinite.
    NonFiniteCoordinate {
        /// The vertex.
        vertex: u32,
    },
    /// A face uses a vertex twice.
    DegenerateFace {
        /// The face.
        face: u32,
    },
    /// Two faces have the same three vertices.
    DuplicateFace {
        /// The later face.
        face: u32,
        /// The first face with these vertices.
        first: u32,
    },
    /// More than two faces meet in an edge.
    NonManifoldEdge {
        /// Its ends.
        vertices: [u32; 2],
        /// All its faces.
        faces: Vec<u32>,
    },
    /// The faces at a vertex do not form one fan (several sheets touch there, or an edge there is non-manifold).
    NonManifoldVertex {
        /// The vertex.
        vertex: u32,
        /// Number of sheets.
        sheets: u32,
    },
    /// Two faces run along their common edge in the same direction, on a surface that could be oriented.
    InconsistentOrientation {
        /// The edge's ends.
        vertices: [u32; 2],
        /// The two faces.
        faces: [u32; 2],
    },
    /// A component is one-sided.
    NonOrientable {
        /// Ends of an edge at which going around the surface comes back reversed.
        vertices: [u32; 2],
        /// Number of faces of the component.
        faces: u32,
    },
    /// The corners of a face lie on a line to working precision.
    ZeroAreaFace {
        /// The face.
        face: u32,
    },
    /// A vertex belongs to no face.
    IsolatedVertex {
        /// The vertex.
        vertex: u32,
    },
    /// The surface is in several pieces.
    SeveralComponents {
        /// Number of faces of each, largest first.
        faces: Vec<u32>,
    },
}

impl Defect {
    /// Stable name of the kind.
    pub fn code(&self) -> &'static str {
        match self {
            Defect::Empty => "empty",
            Defect::IndexOutOfRange { .. } => "index_out_of_range",
            Defect::NonFiniteCoordinate { .. } => "non_finite_coordinate",
            Defect::DegenerateFace { .. } => "degenerate_face",
            Defect::DuplicateFace { .. } => "duplicate_face",
            Defect::NonManifoldEdge { .. } => "non_manifold_edge",
            Defect::NonManifoldVertex { .. } => "non_manifold_vertex",
            Defect::InconsistentOrientation { .. } => "inconsistent_orientation",
            Defect::NonOrientable { .. } => "non_orientable",
            Defect::ZeroAreaFace { .. } => "zero_area_face",
            Defect::IsolatedVertex { .. } => "isolated_vertex",
            Defect::SeveralComponents { .. } => "several_components",
        }
    }

    /// What can be done about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Defect::Empty => "give a file with triangles (a point cloud has no surface)",
            Defect::IndexOutOfRange { .. } => {
                "the file is cut short or its indices are wrong; export it again"
            }
            Defect::NonFiniteCoordinate { .. } => "export the file again with finite coordinates",
            Defect::DegenerateFace { .. } => "drop the face: ricci repair",
            Defect::DuplicateFace { .. } => "drop the later face: ricci repair",
            Defect::NonManifoldEdge { .. } => "remove the surplus faces, or cut the surface open there",
            Defect::NonManifoldVertex { .. } => "give each sheet a vertex of its own: ricci repair",
            Defect::InconsistentOrientation { .. } => "turn faces until neighbours agree: ricci repair",
            Defect::NonOrientable { .. } => {
                "one-sided surfaces have no conformal structure; use its double cover"
            }
            Defect::ZeroAreaFace { .. } => "collapse its shortest edge or flip its longest",
            Defect::IsolatedVertex { .. } => "drop the vertex: ricci repair",
            Defect::SeveralComponents { .. } => "take one: ricci repair --component K",
        }
    }

    /// The vertices it concerns.
    pub fn vertices(&self) -> Vec<u32> {
        match self {
            Defect::NonFiniteCoordinate { vertex }
            | Defect::NonManifoldVertex { vertex, .. }
            | Defect::IsolatedVertex { vertex } => vec![*vertex],
            Defect::NonManifoldEdge { vertices, .. }
            | Defect::InconsistentOrientation { vertices, .. }
            | Defect::NonOrientable { vertices, .. } => vertices.to_vec(),
            _ => Vec::new(),
        }
    }

    /// The faces it concerns.
    pub fn faces(&self) -> Vec<u32> {
        match self {
            Defect::IndexOutOfRange { face, .. }
            | Defect::DegenerateFace { face }
            | Defect::ZeroAreaFace { face } => vec![*face],
            Defect::DuplicateFace { face, first } => vec![*first, *face],
            Defect::NonManifoldEdge { faces, .. } => faces.clone(),
            Defect::InconsistentOrientation { faces, .. } => faces.to_vec(),
            _ => Vec::new(),
        }
    }
}

impl std::fmt::Display for Defect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Defect::Empty => write!(f, "there are no faces"),
            Defect::IndexOutOfRange { face, index } => {
                write!(f, "face {face} uses vertex {index}, which does not exist")
            }
            Defect::NonFiniteCoordinate { vertex } => {
                write!(f, "vertex {vertex} has a coordinate that is no number")
            }
            Defect::DegenerateFace { face } => write!(f, "face {face} uses a vertex twice"),
            Defect::DuplicateFace { face, first } => write!(f, "face {face} repeats face {first}"),
            Defect::NonManifoldEdge { vertices: [a, b], faces } => {
                write!(f, "{} faces meet in edge {a}–{b}: {faces:?}", faces.len())
            }
            Defect::NonManifoldVertex { vertex, sheets } => {
                write!(f, "vertex {vertex} is not the centre of one fan of faces ({sheets} sheets)")
            }
            Defect::InconsistentOrientation { vertices: [a, b], faces: [p, q] } => {
                write!(f, "faces {p} and {q} both run along edge {a}–{b} in the same direction")
            }
            Defect::NonOrientable { vertices: [a, b], faces } => {
                write!(
                    f,
                    "the surface is non-orientable: {faces} faces form a one-sided piece (seen at edge {a}–{b})"
                )
            }
            Defect::ZeroAreaFace { face } => write!(f, "face {face} has zero area"),
            Defect::IsolatedVertex { vertex } => write!(f, "vertex {vertex} belongs to no face"),
            Defect::SeveralComponents { faces } => {
                write!(f, "the surface has {} components (faces: {})", faces.len(), few(faces))
            }
        }
    }
}

fn few(counts: &[u32]) -> String {
    let mut text = counts.iter().take(6).map(u32::to_string).collect::<Vec<_>>().join(", ");
    if counts.len() > 6 {
        text.push_str(", …");
    }
    text
}

/// Every defect of a triangle list, and its counts. All defects keep a metric from being defined on it, so an input
/// is admissible exactly when `defects` is empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagnosis {
    /// Vertices given.
    pub vertices: usize,
    /// Distinct edges of the faces that are triangles.
    pub edges: usize,
    /// Faces given.
    pub faces: usize,
    /// Connected pieces (faces that share a vertex are connected).
    pub components: usize,
    /// V − E + F over the vertices in use.
    pub euler: i64,
    /// Boundary loops; `None` where the surface is not a manifold.
    pub boundary_loops: Option<usize>,
    /// Genus of a connected, orientable manifold.
    pub genus: Option<usize>,
    /// The defects, in the order of [`Defect`]'s variants.
    pub defects: Vec<Defect>,
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
    /// The first defect of each kind with its remedy, and how many more there are.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (n, (code, count)) in self.counts().into_iter().enumerate() {
            if let Some(defect) = self.defects.iter().find(|d| d.code() == code) {
                let separator = if n > 0 { "; " } else { "" };
                let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
                write!(f, "{separator}{defect}{more}: {}", defect.remedy())?;
            }
        }
        Ok(())
    }
}

/// Diagnose an indexed triangle list. O(F log F).
pub fn diagnose(positions: &[Point], faces: &[[u32; 3]]) -> Diagnosis {
    let incidence = Incidence::new(positions.len(), faces);
    let mut diagnosis = diagnose_incidence(faces, &incidence);
    let finite = |v: usize| positions[v].iter().all(|x| x.is_finite());
    let coordinates = (0..positions.len()).filter(|&v| !finite(v));
    diagnosis.defects.extend(coordinates.map(|v| Defect::NonFiniteCoordinate { vertex: v as u32 }));
    for (face, corners) in faces.iter().enumerate().filter(|(f, _)| incidence.is_triangle(*f)) {
        let p = corners.map(|v| positions[v as usize]);
        if corners.iter().all(|&v| finite(v as usize)) && zero_area(p) {
            diagnosis.defects.push(Defect::ZeroAreaFace { face: face as u32 });
        }
    }
    diagnosis
}

/// The combinatorial part of [`diagnose`].
pub fn diagnose_faces(n_vertices: usize, faces: &[[u32; 3]]) -> Diagnosis {
    diagnose_incidence(faces, &Incidence::new(n_vertices, faces))
}

pub(super) fn diagnose_incidence(faces: &[[u32; 3]], incidence: &Incidence) -> Diagnosis {
    let n = incidence.n_vertices;
    let mut defects = Vec::new();
    if faces.is_empty() {
        defects.push(Defect::Empty);
    }
    for (f, corners) in faces.iter().enumerate() {
        let face = f as u32;
        if let Some(&index) = corners.iter().find(|&&v| v as usize >= n) {
            defects.push(Defect::IndexOutOfRange { face, index });
        } else if !incidence.is_triangle(f) {
            defects.push(Defect::DegenerateFace { face });
        }
    }
    duplicates(faces, incidence, &mut defects);
    let edge = |sides: &[u32]| {
        let (f, k) = (sides[0] as usize / 3, sides[0] as usize % 3);
        [faces[f][k], faces[f][(k + 1) % 3]]
    };
    let mut pinched = vec![false; n];
    let mut manifold = defects.is_empty();
    for sides in incidence.edges().filter(|sides| sides.len() > 2) {
        let vertices = edge(sides);
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
    let orientable = orientation(faces, incidence, edge, &mut defects);
    defects.extend((0..n).filter(|&v| sheets[v] == 0).map(|v| Defect::IsolatedVertex { vertex: v as u32 }));
    let mut pieces = incidence.components(faces);
    pieces.sort_unstable_by(|a, b| b.cmp(a));
    let components = pieces.len();
    if components > 1 {
        defects.push(Defect::SeveralComponents { faces: pieces });
    }
    let edges = incidence.edges().count();
    let used = sheets.iter().filter(|&&s| s > 0).count();
    let triangles = (0..faces.len()).filter(|&f| incidence.is_triangle(f)).count();
    let euler = used as i64 - edges as i64 + triangles as i64;
    let boundary_loops = manifold.then(|| incidence.boundary_loops(faces));
    let genus = match boundary_loops {
        Some(loops) if components == 1 && orientable => usize::try_from((2 - euler - loops as i64) / 2).ok(),
        _ => None,
    };
    Diagnosis { vertices: n, edges, faces: faces.len(), components, euler, boundary_loops, genus, defects }
}

/// Faces with the same set of vertices as an earlier one.
fn duplicates(faces: &[[u32; 3]], incidence: &Incidence, defects: &mut Vec<Defect>) {
    let key = |f: u32| {
        let mut v = faces[f as usize];
        v.sort_unstable();
        v
    };
    let mut order: Vec<u32> =
        (0..faces.len() as u32).filter(|&f| incidence.is_triangle(f as usize)).collect();
    order.sort_unstable_by_key(|&f| (key(f), f));
    let mut found: Vec<(u32, u32)> = Vec::new();
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        found.extend(same[1..].iter().map(|&f| (f, same[0])));
    }
    found.sort_unstable();
    defects.extend(found.into_iter().map(|(face, first)| Defect::DuplicateFace { face, first }));
}

/// Orient each component across its two-sided edges; returns whether all are orientable.
fn orientation(
    faces: &[[u32; 3]],
    incidence: &Incidence,
    edge: impl Fn(&[u32]) -> [u32; 2],
    defects: &mut Vec<Defect>,
) -> bool {
    let pairs = || incidence.edges().filter(|sides| sides.len() == 2);
    let same_direction =
        |sides: &[u32]| incidence.is_forward(faces, sides[0]) == incidence.is_forward(faces, sides[1]);
    let mut turned = UnionFind::new(faces.len());
    let mut conflict: BTreeMap<u32, [u32; 2]> = BTreeMap::new();
    for sides in pairs() {
        if !turned.join(sides[0] / 3, sides[1] / 3, same_direction(sides)) {
            conflict.entry(sides[0] / 3).or_insert(edge(sides));
        }
    }
    let mut one_sided: BTreeMap<u32, [u32; 2]> = BTreeMap::new();
    for (face, vertices) in conflict {
        one_sided.entry(turned.root(face).0).or_insert(vertices);
    }
    for sides in pairs().filter(|sides| same_direction(sides)) {
        if !one_sided.contains_key(&turned.root(sides[0] / 3).0) {
            let faces = [sides[0] / 3, sides[1] / 3];
            defects.push(Defect::InconsistentOrientation { vertices: edge(sides), faces });
        }
    }
    let mut size: BTreeMap<u32, u32> = one_sided.keys().map(|&root| (root, 0)).collect();
    for f in 0..faces.len() as u32 {
        if let Some(size) = size.get_mut(&turned.root(f).0) {
            *size += 1;
        }
    }
    for (root, &vertices) in &one_sided {
        defects.push(Defect::NonOrientable { vertices, faces: size[root] });
    }
    one_sided.is_empty()
}

fn zero_area(p: [Point; 3]) -> bool {
    let distance = |a: Point, b: Point| f64::hypot(f64::hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
    let l = [distance(p[1], p[2]), distance(p[2], p[0]), distance(p[0], p[1])];
    let r = half_differences(l);
    let longest = l.into_iter().fold(0.0, f64::max);
    r.into_iter().any(|r| r <= ZERO_AREA * longest)
}

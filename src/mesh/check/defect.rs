//! The defects of a triangle list, with stable codes, the elements concerned, and remedies.

/// One defect with the elements it concerns (0-based input indices).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Defect {
    /// There is no face.
    Empty {
        /// The number of faces that were given to a repair and all collapsed; 0 where there were none.
        collapsed: usize,
    },
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
    /// The faces at a vertex do not form one fan: several sheets touch there, or an edge there is non-manifold.
    NonManifoldVertex {
        /// The vertex.
        vertex: u32,
        /// The number of sheets; 1 where the only fault is a non-manifold edge that ends there.
        sheets: u32,
    },
    /// Faces run along their common edge in the same direction. Two faces that meet in an edge of a one-sided piece are not listed, since
    /// turning faces cannot make all of them agree there.
    InconsistentOrientation {
        /// The start and the end of the edge in the direction of these faces.
        vertices: [u32; 2],
        /// The faces that run in this direction, two or more.
        faces: Vec<u32>,
        /// The number of faces in the edge, of either direction; with more than two it is also non-manifold.
        meeting: u32,
    },
    /// A piece of the surface is one-sided.
    NonOrientable {
        /// A Möbius band in it: faces each of which shares an edge with the next, and the last with the first.
        strip: Vec<u32>,
    },
    /// The corners of a face are collinear to working precision.
    ZeroAreaFace {
        /// The face.
        face: u32,
    },
    /// A vertex belongs to no face.
    IsolatedVertex {
        /// The vertex.
        vertex: u32,
    },
    /// The surface has several pieces.
    SeveralComponents {
        /// Number of faces of each, largest first.
        sizes: Vec<u32>,
        /// The first face of each, in the same order.
        first_faces: Vec<u32>,
        /// True if welding nearly coincident vertices of their boundaries joins some of them ([`super::Hint::OpenSeam`]).
        torn: bool,
    },
}

impl Defect {
    /// Stable name of the kind.
    pub fn code(&self) -> &'static str {
        match self {
            Defect::Empty { .. } => "empty",
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

    /// The advice how to mend it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Defect::Empty { collapsed: 0 } => "give a file with triangles (a point cloud has no surface)",
            Defect::Empty { .. } => "weld within a smaller distance: ricci repair --weld DISTANCE",
            Defect::IndexOutOfRange { .. } => {
                "the file is cut short or its indices are wrong; export it again"
            }
            Defect::NonFiniteCoordinate { .. } => {
                "drop its faces: ricci repair --drop-nonfinite; or export the file again with finite coordinates"
            }
            Defect::DegenerateFace { .. } => "drop the face: ricci repair",
            Defect::DuplicateFace { .. } => "drop the later face: ricci repair",
            Defect::NonManifoldEdge { .. } => {
                "cut the surface open there: ricci repair --cut-edges; or remove the surplus faces"
            }
            Defect::NonManifoldVertex { sheets: 0..=1, .. } => {
                "mend the non-manifold edge that ends there: ricci repair --cut-edges"
            }
            Defect::NonManifoldVertex { .. } => "give each sheet a vertex of its own: ricci repair",
            Defect::InconsistentOrientation { meeting: 0..=2, .. } => {
                "turn faces until neighbours agree: ricci repair"
            }
            Defect::InconsistentOrientation { .. } => {
                "turning faces cannot help where more than two meet; mend the non-manifold edge first: ricci repair --cut-edges"
            }
            Defect::NonOrientable { .. } => {
                "one-sided surfaces have no conformal structure and no command makes a two-sided one of it: remove the \
                 strip's faces, or another band across it, where the file was made"
            }
            Defect::ZeroAreaFace { .. } => {
                "collapse or flip its edges: ricci repair --degenerate; or join corners that nearly coincide: ricci repair \
                 --weld DISTANCE"
            }
            Defect::IsolatedVertex { .. } => "drop the vertex: ricci repair",
            Defect::SeveralComponents { torn: true, .. } => {
                "their boundaries nearly coincide, so weld first: ricci repair --weld DISTANCE; ricci repair --component K \
                 takes one and drops the faces of all others"
            }
            Defect::SeveralComponents { .. } => {
                "take one: ricci repair --component K; or flatten each: ricci flow --components all"
            }
        }
    }

    /// The vertices it concerns.
    pub fn vertices(&self) -> Vec<u32> {
        match self {
            Defect::NonFiniteCoordinate { vertex }
            | Defect::NonManifoldVertex { vertex, .. }
            | Defect::IsolatedVertex { vertex } => vec![*vertex],
            Defect::NonManifoldEdge { vertices, .. } | Defect::InconsistentOrientation { vertices, .. } => {
                vertices.to_vec()
            }
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
            Defect::NonManifoldEdge { faces, .. } | Defect::InconsistentOrientation { faces, .. } => {
                faces.clone()
            }
            Defect::NonOrientable { strip } => strip.clone(),
            Defect::SeveralComponents { first_faces, .. } => first_faces.clone(),
            _ => Vec::new(),
        }
    }
}

impl std::fmt::Display for Defect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Defect::Empty { collapsed: 0 } => write!(f, "there are no faces"),
            Defect::Empty { collapsed } => {
                write!(f, "no face is left: all {collapsed} use a vertex twice after welding")
            }
            Defect::IndexOutOfRange { face, index } => {
                write!(f, "face {face} uses vertex {index}, which does not exist")
            }
            Defect::NonFiniteCoordinate { vertex } => {
                write!(f, "vertex {vertex} has a coordinate that is not finite")
            }
            Defect::DegenerateFace { face } => write!(f, "face {face} uses a vertex twice"),
            Defect::DuplicateFace { face, first } => write!(f, "face {face} repeats face {first}"),
            Defect::NonManifoldEdge { vertices: [a, b], faces } => {
                write!(f, "{} faces meet in edge {a}–{b}: {}", faces.len(), few(faces))
            }
            Defect::NonManifoldVertex { vertex, sheets: 0..=1 } => {
                write!(f, "vertex {vertex} is an end of a non-manifold edge")
            }
            Defect::NonManifoldVertex { vertex, sheets } => {
                write!(f, "{sheets} separate fans of faces meet in vertex {vertex}")
            }
            Defect::InconsistentOrientation { vertices: [a, b], faces, meeting } => {
                write!(f, "faces {} run the same way along edge {a}–{b}", few(faces))?;
                if *meeting > 2 { write!(f, ", of {meeting} that meet there") } else { Ok(()) }
            }
            Defect::NonOrientable { strip } => {
                write!(f, "the surface is non-orientable: a Möbius band runs through faces {}", few(strip))
            }
            Defect::ZeroAreaFace { face } => write!(f, "face {face} has zero area"),
            Defect::IsolatedVertex { vertex } => write!(f, "vertex {vertex} belongs to no face"),
            Defect::SeveralComponents { sizes, .. } => {
                write!(f, "the surface has {} components; their faces: {}", sizes.len(), few(sizes))
            }
        }
    }
}

/// The first eight numbers of a list, and its length.
fn few(numbers: &[u32]) -> String {
    const SHOWN: usize = 8;
    let mut text = numbers.iter().take(SHOWN).map(u32::to_string).collect::<Vec<_>>().join(", ");
    if numbers.len() > SHOWN {
        text += &format!(", … ({} in all)", numbers.len());
    }
    text
}

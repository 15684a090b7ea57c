//! What is no defect of a triangle list and still seldom meant: seams that are open by a rounding, T-junctions, coarse coordinates.

/// A finding that makes no input inadmissible, with the elements it concerns (0-based input indices) and a remedy.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Hint {
    /// Boundary vertices nearly coincide, and welding them closes edges of the boundary.
    OpenSeam(OpenSeam),
    /// Boundary vertices lie on boundary edges of other faces.
    TJunctions(Vec<TJunction>),
    /// Coordinates lie on a lattice that is coarse for the edges: they were held in single precision far from the origin.
    CoarseCoordinates(CoordinateLattice),
}

/// A seam that is open because its vertices nearly coincide.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenSeam {
    /// Number of boundary vertices that have another one near.
    pub vertices: usize,
    /// Two of them, at the largest distance.
    pub pair: [u32; 2],
    /// The largest distance of a vertex from the next one.
    pub gap: f64,
    /// The gap as a share of the diagonal of the bounding box.
    pub share: f64,
    /// The smallest distance of welding, rounded up to two digits, that joins them all.
    pub weld: f64,
    /// Edges of the boundary before and after welding.
    pub boundary_edges: [usize; 2],
    /// Connected pieces before and after welding.
    pub components: [usize; 2],
    /// Faces that welding makes collapse.
    pub lost_faces: usize,
}

/// A vertex on a boundary edge that does not end there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TJunction {
    /// The vertex.
    pub vertex: u32,
    /// The ends of the edge, in the direction of its face.
    pub edge: [u32; 2],
    /// The face of the edge.
    pub face: u32,
    /// Where the vertex lies along the edge, between 0 and 1.
    pub share: f64,
    /// Its distance from the edge.
    pub distance: f64,
}

/// The lattice on which one coordinate of all vertices lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoordinateLattice {
    /// The coordinate: 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// The step, a power of 2.
    pub step: f64,
    /// The largest absolute value of the coordinate.
    pub size: f64,
    /// The step as a share of the mean length of the edges.
    pub share: f64,
}

impl Hint {
    /// Stable name of the kind.
    pub fn code(&self) -> &'static str {
        match self {
            Hint::OpenSeam(_) => "open_seam",
            Hint::TJunctions(_) => "t_junctions",
            Hint::CoarseCoordinates(_) => "coarse_coordinates",
        }
    }

    /// The advice what to do about it.
    pub fn remedy(&self) -> String {
        match self {
            Hint::OpenSeam(OpenSeam { weld: 0.0, .. }) => "join them: ricci repair".into(),
            Hint::OpenSeam(seam) => format!("join them: ricci repair --weld {:e}", seam.weld),
            Hint::TJunctions(_) => "split the edges there: ricci repair --t-junctions".into(),
            Hint::CoarseCoordinates(_) => "export the mesh again in double precision, or with coordinates \
                relative to a point near it; angles and curvatures are those of the lattice"
                .into(),
        }
    }

    /// The vertices it concerns.
    pub fn vertices(&self) -> Vec<u32> {
        match self {
            Hint::OpenSeam(seam) => seam.pair.to_vec(),
            Hint::TJunctions(all) => all.iter().map(|one| one.vertex).collect(),
            Hint::CoarseCoordinates(_) => Vec::new(),
        }
    }

    /// The faces it concerns.
    pub fn faces(&self) -> Vec<u32> {
        match self {
            Hint::TJunctions(all) => all.iter().map(|one| one.face).collect(),
            _ => Vec::new(),
        }
    }
}

impl std::fmt::Display for Hint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Hint::OpenSeam(seam) => seam.fmt(f),
            Hint::TJunctions(all) => {
                const SHOWN: usize = 4;
                let one = |t: &TJunction| {
                    format!(
                        "vertex {} on edge {}–{} ({:.1e} beside it)",
                        t.vertex, t.edge[0], t.edge[1], t.distance
                    )
                };
                let shown: Vec<String> = all.iter().take(SHOWN).map(one).collect();
                write!(f, "{} boundary vertices lie on boundary edges: {}", all.len(), shown.join(", "))?;
                if all.len() > SHOWN { write!(f, ", …") } else { Ok(()) }
            }
            Hint::CoarseCoordinates(lattice) => {
                let CoordinateLattice { axis, step, size, share } = lattice;
                let name = ["x", "y", "z"][*axis];
                write!(
                    f,
                    "the {name} coordinates are multiples of {step} (single precision at {size:.1e}): "
                )?;
                write!(f, "{:.2} % of the mean edge", 100.0 * share)
            }
        }
    }
}

impl std::fmt::Display for OpenSeam {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let OpenSeam { vertices, pair: [a, b], gap, share, weld, boundary_edges, components, lost_faces } =
            self;
        match *gap {
            0.0 => write!(f, "{vertices} boundary vertices lie exactly on another, such as {a} and {b}: ")?,
            _ => write!(
                f,
                "{vertices} boundary vertices lie within {gap:.2e} of another ({share:.1e} of the diagonal), such as {a} and {b}: "
            )?,
        }
        let [edges, left] = boundary_edges;
        write!(
            f,
            "welding within {weld:e} closes {} of {edges} boundary edges",
            edges.saturating_sub(*left)
        )?;
        let [before, after] = components;
        if after < before {
            write!(f, " and makes {after} of {before} components")?;
        }
        if *lost_faces > 0 { write!(f, "; {lost_faces} faces collapse") } else { Ok(()) }
    }
}

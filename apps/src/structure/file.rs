//! Atlases as a JSON file.

use ricci::structure::{Atlas, Element};
use serde::{Serialize, Serializer};

/// What the first entry of a unitary matrix is multiplied by in the file: four roundings more than 1. The entries on the diagonal are each
/// other's conjugates, and of products of such matrices the first one stays the larger one, so that readers who divide by the largest entry
/// never take the other.
const FIRST: f64 = 1.0 + 4.0 * f64::EPSILON;

/// `--atlas`.
#[derive(Serialize)]
pub struct AtlasFile<'a> {
    kind: &'static str,
    charts: Vec<ChartFile<'a>>,
    transitions: Vec<TransitionFile<'a>>,
    singular_vertices: Vec<u32>,
}

#[derive(Serialize)]
struct ChartFile<'a> {
    vertices: Vec<u32>,
    faces: Vec<u32>,
    /// Per face the places of its corners among the vertices, one of which may be there more than once.
    corners: &'a [[u32; 3]],
    coordinates: &'a [[f64; 2]],
}

#[derive(Serialize)]
struct TransitionFile<'a> {
    from: u32,
    to: u32,
    matrix: Matrix<'a>,
    pairs: &'a [[u32; 2]],
}

/// Rows of complex numbers `[re, im]`, or of real ones.
struct Matrix<'a>(&'a Element);

impl Serialize for Matrix<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut rows = self.0.rows();
        match self.0 {
            Element::Mobius(m) => {
                // Of a motion of the plane the last row is (0, 1).
                if m.m21.norm() > 0.0 {
                    rows[0][0] = rows[0][0].map(|x| FIRST * x);
                }
                rows.serialize(serializer)
            }
            Element::Projective(_) => {
                let real: Vec<Vec<f64>> =
                    rows.iter().map(|row| row.iter().map(|entry| entry[0]).collect()).collect();
                real.serialize(serializer)
            }
        }
    }
}

impl<'a> AtlasFile<'a> {
    pub fn new(atlas: &'a Atlas) -> AtlasFile<'a> {
        let charts = atlas.charts.iter().map(|chart| ChartFile {
            vertices: chart.vertices.iter().map(|v| v.0).collect(),
            faces: chart.faces.iter().map(|f| f.0).collect(),
            corners: &chart.corners,
            coordinates: &chart.coordinates,
        });
        let transitions = atlas.transitions.iter().map(|t| TransitionFile {
            from: t.from,
            to: t.to,
            matrix: Matrix(&t.element),
            pairs: &t.pairs,
        });
        AtlasFile {
            kind: atlas.structure.name(),
            charts: charts.collect(),
            transitions: transitions.collect(),
            singular_vertices: atlas.singular_vertices.iter().map(|v| v.0).collect(),
        }
    }
}

//! The JSON file of `ricci structure --atlas`.

use ricci::structure::{Atlas, GroupElement};
use serde::{Serialize, Serializer};

/// The factor that the first entry of a unitary matrix gets in the file: four roundings more than 1. The two entries on the diagonal are
/// conjugates of each other, so that rounding would decide which of them is larger. With this factor the first one is, also in products,
/// and readers who divide by the largest entry always divide by the same one.
const FIRST: f64 = 1.0 + 4.0 * f64::EPSILON;

#[derive(Serialize)]
pub struct AtlasFile<'a> {
    kind: &'static str,
    charts: Vec<ChartFile<'a>>,
    transitions: Vec<TransitionFile<'a>>,
    singular_vertices: Vec<u32>,
    /// Per vertex of an integer structure its place on the input: a face and barycentric coordinates in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    places: Option<Vec<(u32, [f64; 3])>>,
}

#[derive(Serialize)]
struct ChartFile<'a> {
    vertices: Vec<u32>,
    faces: Vec<u32>,
    /// Per face the indices of its corners in `vertices`, in which a vertex may stand more than once.
    corners: &'a [[u32; 3]],
    coordinates: &'a [[f64; 2]],
}

#[derive(Serialize)]
struct TransitionFile<'a> {
    from: u32,
    to: u32,
    matrix: ElementRows<'a>,
    pairs: &'a [[u32; 2]],
}

/// The matrix of a transition as rows of complex numbers `[re, im]`, or of real ones.
struct ElementRows<'a>(&'a GroupElement);

impl Serialize for ElementRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut rows = self.0.rows();
        match self.0 {
            GroupElement::Mobius(m) => {
                // The last row of a motion of the plane is (0, 1); it is not unitary.
                if m.m21.norm() > 0.0 {
                    rows[0][0] = rows[0][0].map(|x| FIRST * x);
                }
                rows.serialize(serializer)
            }
            GroupElement::Projective(_) => {
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
            matrix: ElementRows(&t.element),
            pairs: &t.pairs,
        });
        AtlasFile {
            kind: atlas.structure.name(),
            charts: charts.collect(),
            transitions: transitions.collect(),
            singular_vertices: atlas.singular_vertices.iter().map(|v| v.0).collect(),
            places: atlas
                .on_given
                .as_ref()
                .map(|places| places.iter().map(|place| (place.face.0, place.weights)).collect()),
        }
    }
}

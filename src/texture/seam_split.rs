//! The model as renderers take it: a vertex for each place that a vertex of the model has on the page.

use super::texture_atlas::TextureAtlas;
use std::collections::HashMap;

/// A model whose vertices are split along the seams of an atlas, so that each has one pair of texture coordinates. Faces without a place are
/// left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SeamSplitModel {
    /// Per face its corners, as numbers of the vertices below.
    pub faces: Vec<[u32; 3]>,
    /// Per face its number in the model, ascending.
    pub face_origin: Vec<u32>,
    /// Per vertex the model's vertex that it is a copy of.
    pub vertex_origin: Vec<u32>,
    /// Per vertex its texture coordinates.
    pub uv: Vec<[f64; 2]>,
}

impl TextureAtlas {
    /// The model, of whose faces these are the corners, with its vertices split along the seams; vertices in the order of the faces that use
    /// them first.
    pub fn split(&self, faces: &[[u32; 3]]) -> SeamSplitModel {
        let mut model = SeamSplitModel::default();
        let mut known: HashMap<(u32, [u64; 2], u32), u32> = HashMap::new();
        for (f, (corners, chart)) in (0u32..).zip(faces.iter().zip(&self.chart)) {
            if *chart == TextureAtlas::NO_CHART {
                continue;
            }
            let uv = self.corner_uv[f as usize];
            model.faces.push([0, 1, 2].map(|k| {
                let next = model.uv.len() as u32;
                let own = *known.entry((corners[k], uv[k].map(f64::to_bits), *chart)).or_insert(next);
                if own == next {
                    model.vertex_origin.push(corners[k]);
                    model.uv.push(uv[k]);
                }
                own
            }));
            model.face_origin.push(f);
        }
        model
    }
}

//! The vertices of a group of primitives, repeated where corners have other texture coordinates.

use super::scene_model::VertexGroup;
use std::collections::HashMap;

/// A group with one pair of texture coordinates for each vertex. Vertices keep their numbers, with the coordinates of their first corner;
/// those with further coordinates are repeated after all vertices.
pub(super) struct GroupSplit {
    /// The vertex that each further vertex repeats.
    pub further: Vec<u32>,
    /// For each vertex its coordinates with v downwards; 0 for one without a face.
    pub texcoords: Vec<[f32; 2]>,
    /// For each primitive of the group its faces.
    pub faces: Vec<Vec<[u32; 3]>>,
}

impl GroupSplit {
    /// `corner_uv` has the coordinates of the corners of all faces of the list, with v upwards.
    pub fn new(group: &VertexGroup, faces: &[[u32; 3]], corner_uv: &[[[f64; 2]; 3]]) -> GroupSplit {
        let mut split =
            GroupSplit { further: Vec::new(), texcoords: vec![[0.0; 2]; group.n], faces: Vec::new() };
        let mut has_corner = vec![false; group.n];
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        for primitive in &group.primitives {
            let own = primitive.faces.clone().map(|f| {
                let vertex = |k: usize| faces[f][k] - group.first as u32;
                [0, 1, 2].map(|k| {
                    let [s, t] = corner_uv[f][k];
                    split.corner(vertex(k), [s as f32, (1.0 - t) as f32], &mut has_corner, &mut known)
                })
            });
            let own = own.collect();
            split.faces.push(own);
        }
        split
    }

    /// The vertex for a corner.
    fn corner(
        &mut self,
        v: u32,
        uv: [f32; 2],
        has_corner: &mut [bool],
        known: &mut HashMap<(u32, [u32; 2]), u32>,
    ) -> u32 {
        if !std::mem::replace(&mut has_corner[v as usize], true) {
            self.texcoords[v as usize] = uv;
        }
        if self.texcoords[v as usize].map(f32::to_bits) == uv.map(f32::to_bits) {
            return v;
        }
        *known.entry((v, uv.map(f32::to_bits))).or_insert_with(|| {
            self.further.push(v);
            self.texcoords.push(uv);
            self.texcoords.len() as u32 - 1
        })
    }
}

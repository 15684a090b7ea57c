//! The materials of a glTF document: names, colours and roughness, which go with the faces.

use super::document::{GltfDocument, MaterialEntry};
use crate::mesh::io::labels::{FaceLabel, FaceLabels, PlainMaterial};
use serde_json::{Value, json};
use std::collections::HashSet;

/// The labels of faces with these materials, each its number and 1, or 0 for none; `None` where no face has one. The plain material of a file of
/// this library counts as none.
pub(super) fn labels_of(document: &GltfDocument, of_face: Vec<u32>) -> Option<FaceLabels> {
    let plain = |entry: &MaterialEntry| document.is_own() && entry.name.is_none();
    let is_plain: Vec<bool> = document.materials.iter().map(plain).collect();
    let of_face: Vec<u32> =
        of_face.into_iter().map(|k| if k > 0 && is_plain[k as usize - 1] { 0 } else { k }).collect();
    if of_face.iter().all(|&k| k == 0) {
        return None;
    }
    let mut taken = HashSet::new();
    let materials: Vec<PlainMaterial> = document
        .materials
        .iter()
        .enumerate()
        .map(|(k, entry)| {
            let named = entry.name.as_deref().unwrap_or_default().replace(['\n', '\r'], " ");
            let own =
                if named.is_empty() || taken.contains(&named) { format!("material {k}") } else { named };
            taken.insert(own.clone());
            entry.plain(own)
        })
        .collect();
    let label =
        |material: &PlainMaterial| FaceLabel { material: material.name.clone(), ..FaceLabel::default() };
    let labels = std::iter::once(FaceLabel::default()).chain(materials.iter().map(label)).collect();
    Some(FaceLabels { libraries: Vec::new(), labels, of_face, materials })
}

impl MaterialEntry {
    /// The colour and the roughness, with the defaults of glTF, under a name.
    fn plain(&self, name: String) -> PlainMaterial {
        let given = self.pbr_metallic_roughness.as_deref();
        PlainMaterial {
            name,
            base_color: given.and_then(|pbr| pbr.base_color_factor).unwrap_or([1.0; 4]),
            metallic: given.and_then(|pbr| pbr.metallic_factor).unwrap_or(1.0),
            roughness: given.and_then(|pbr| pbr.roughness_factor).unwrap_or(1.0),
        }
    }
}

/// A stretch of faces with one material, as a primitive.
pub(super) struct MaterialStretch {
    pub faces: std::ops::Range<usize>,
    /// The number of its material in the document.
    pub material: usize,
}

/// The stretches of `n` faces, and the materials of the document; without names one stretch of a plain one.
pub(super) fn stretches(labels: Option<&FaceLabels>, n: usize) -> (Vec<MaterialStretch>, Vec<Value>) {
    let mut names: Vec<&str> = Vec::new();
    let mut made = Vec::new();
    for (faces, name) in labels.and_then(FaceLabels::material_stretches).unwrap_or_default() {
        let known = names.iter().position(|known| *known == name);
        let material = known.unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        });
        made.push(MaterialStretch { faces, material });
    }
    if made.is_empty() {
        return (vec![MaterialStretch { faces: 0..n, material: 0 }], vec![written("", None)]);
    }
    let described = |name: &str| labels.and_then(|l| l.materials.iter().find(|m| m.name == name));
    (made, names.iter().map(|name| written(name, described(name))).collect())
}

/// A material as JSON: the plain one of this library where it is not described.
fn written(name: &str, described: Option<&PlainMaterial>) -> Value {
    let mut material = json!({"doubleSided": true});
    material["pbrMetallicRoughness"] = match described {
        Some(PlainMaterial { base_color, metallic, roughness, .. }) => {
            json!({"baseColorFactor": base_color, "metallicFactor": metallic, "roughnessFactor": roughness})
        }
        None => json!({"metallicFactor": 0.0, "roughnessFactor": 0.8}),
    };
    if !name.is_empty() {
        material["name"] = json!(name);
    }
    material
}

//! The sets of texture coordinates that the textures of a document use.

use serde_json::Value;

/// The textures of a material: the set of each, and that of the normal map.
#[derive(Default)]
pub(super) struct MaterialTextures {
    pub sets: Vec<u32>,
    pub normal: Option<u32>,
}

/// The textures of each material of a document, those of extensions too.
pub(super) fn textures(document: &Value) -> Vec<MaterialTextures> {
    let materials = document["materials"].as_array().map_or(&[][..], Vec::as_slice);
    materials
        .iter()
        .map(|material| {
            let mut sets = Vec::new();
            collect(material, &mut sets);
            MaterialTextures { sets, normal: material.get("normalTexture").map(set_of) }
        })
        .collect()
}

/// The name of a set of texture coordinates.
pub(super) fn set_name(set: u32) -> String {
    format!("TEXCOORD_{set}")
}

/// Adds the sets of all textures in a part of a material; their members end in "Texture" and have the number of a texture.
fn collect(part: &Value, sets: &mut Vec<u32>) {
    for (name, member) in part.as_object().into_iter().flatten() {
        if name.ends_with("Texture") && member.get("index").is_some() {
            sets.push(set_of(member));
        } else {
            collect(member, sets);
        }
    }
}

/// The set of a texture; its transform can name another one.
fn set_of(texture: &Value) -> u32 {
    let moved = &texture["extensions"]["KHR_texture_transform"]["texCoord"];
    let set = moved.as_u64().or_else(|| texture["texCoord"].as_u64());
    set.map_or(0, |set| u32::try_from(set).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn textures_of_extensions_and_transforms_count() {
        let material = json!({
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 1]},
            "normalTexture": {"index": 1, "texCoord": 2},
            "emissiveTexture": {"index": 2, "texCoord": 1, "extensions": {"KHR_texture_transform": {"texCoord": 3}}},
            "extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0, "texCoord": 4}}}
        });
        let found = textures(&json!({"materials": [material, {}]}));
        let mut sets = found[0].sets.clone();
        sets.sort_unstable();
        assert_eq!((sets, found[0].normal), (vec![0, 2, 3, 4], Some(2)));
        assert!(found[1].sets.is_empty() && found[1].normal.is_none() && textures(&json!({})).is_empty());
    }
}

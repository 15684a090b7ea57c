//! The meshes of a scene with the coordinates of an atlas: vertices are repeated along its seams, with all their attributes and morph
//! targets; nodes, materials, names and everything else stay.

use super::super::budget::Budget;
use super::accessor::{GltfFile, PackedElements};
use super::document::ElementShape;
use super::document_walk::each_attribute_list;
use super::kept_document::{KeptDocument, ViewTarget};
use super::scene_model::{GroupPrimitive, SceneModel, VertexGroup};
use super::scene_report::SceneReport;
use super::scene_split::GroupSplit;
use super::texture_sets::{MaterialTextures, set_name};
use crate::error::Result;
use crate::mesh::tangents::{TangentFrames, vertex_tangents};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Compression of primitives, of which the plain form is written.
const COMPRESSED_PRIMITIVES: &str = "KHR_draco_mesh_compression";
const TANGENT: &str = "TANGENT";
/// The most vertices that indices of 16 bits can name: the format keeps the last number free.
const MOST_SHORT: usize = u16::MAX as usize;
const FLOAT: u32 = 5126;
const ANY_SHAPE: [ElementShape; 7] = [
    ElementShape::Scalar,
    ElementShape::Vec2,
    ElementShape::Vec3,
    ElementShape::Vec4,
    ElementShape::Mat2,
    ElementShape::Mat3,
    ElementShape::Mat4,
];

/// A scene on its way to the file with an atlas.
pub(super) struct SceneEdit<'a> {
    pub file: &'a GltfFile<'a>,
    pub model: &'a SceneModel,
    /// Per face the coordinates of its corners, with v upwards.
    pub corner_uv: &'a [[[f64; 2]; 3]],
    /// The set that the atlas is written to.
    pub set: u32,
    /// True if tangents are asked for.
    pub tangents: bool,
    /// Per material its textures.
    pub textures: &'a [MaterialTextures],
    pub kept: KeptDocument,
    pub budget: Budget,
    pub report: SceneReport,
}

/// What the primitives of a group share.
struct GroupAccessors {
    split: GroupSplit,
    texcoords: usize,
    tangents: Option<usize>,
    /// For each accessor of an attribute the one with the repeated vertices.
    copies: BTreeMap<usize, usize>,
}

impl SceneEdit<'_> {
    /// Gives every primitive with faces its coordinates.
    pub fn edit(&mut self) -> Result<()> {
        let model = self.model;
        for group in &model.groups {
            self.group(group)?;
        }
        let mut compressed = false;
        for mesh in self.kept.document["meshes"].as_array().into_iter().flatten() {
            let primitives = mesh["primitives"].as_array().into_iter().flatten();
            compressed |= primitives.into_iter().any(|p| !p["extensions"][COMPRESSED_PRIMITIVES].is_null());
        }
        if !compressed {
            self.kept.forget_extension(COMPRESSED_PRIMITIVES);
        }
        Ok(())
    }

    fn group(&mut self, group: &VertexGroup) -> Result<()> {
        let split = GroupSplit::new(group, &self.model.soup.faces, self.corner_uv);
        let n = split.texcoords.len();
        let entry = json!({"componentType": FLOAT, "count": n, "type": "VEC2"});
        let texcoords = self.kept.add(entry, packed(&split.texcoords), ViewTarget::Vertices);
        self.report.n_vertices += group.n;
        self.report.n_split_vertices += n;
        let mut own = GroupAccessors { split, texcoords, tangents: None, copies: BTreeMap::new() };
        // A primitive without a face keeps its vertices: it draws nothing with them.
        let with_faces = group.primitives.iter().enumerate().filter(|(_, p)| !p.faces.is_empty());
        for (k, primitive) in with_faces {
            let mut text = self.kept.document["meshes"][group.mesh]["primitives"][primitive.index].take();
            let edited = self.attributes(&mut text, group, primitive, &mut own);
            self.indices(&mut text, primitive, &own.split, k);
            self.kept.document["meshes"][group.mesh]["primitives"][primitive.index] = text;
            edited?;
            self.report.n_primitives += 1;
        }
        Ok(())
    }

    fn attributes(
        &mut self,
        text: &mut Value,
        group: &VertexGroup,
        primitive: &GroupPrimitive,
        own: &mut GroupAccessors,
    ) -> Result<()> {
        if let Some(extensions) = text.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.remove(COMPRESSED_PRIMITIVES);
        }
        let has = |name: &str| text["attributes"].get(name).is_some();
        let textures = primitive.material.and_then(|k| self.textures.get(k));
        let of_tangents = textures.and_then(|textures| textures.normal).unwrap_or(self.set);
        let (name, is_ours) = (set_name(self.set), of_tangents == self.set);
        let (had_set, had_tangents, has_normals) = (has(&name), has(TANGENT), has("NORMAL"));
        self.report.n_replaced += usize::from(had_set);
        // Tangents follow the coordinates of the normal map; without one those that the atlas replaces.
        let drops_tangents = had_tangents && is_ours && (had_set || self.tangents);
        self.report.n_dropped_tangents += usize::from(drops_tangents && !(self.tangents && has_normals));
        let mut gone = BTreeSet::new();
        each_attribute_list(text, |members| {
            let leave = |key: &str| key == name || (drops_tangents && key == TANGENT);
            gone.extend(members.iter().filter(|(key, _)| leave(key)).filter_map(|(_, value)| value.as_u64()));
            members.retain(|key, _| !leave(key));
        });
        gone.into_iter().for_each(|accessor| self.kept.replace(accessor as usize));
        self.repeat(text, group, own)?;
        if self.tangents && is_ours && has_normals {
            let tangents = self.tangents_of(group, own)?;
            text["attributes"][TANGENT] = json!(tangents);
            self.report.n_tangents += 1;
        } else if self.tangents {
            self.report.n_without_tangents += 1;
        }
        // Sets are counted from 0 without gaps: where lower ones are missing, they hold the atlas too.
        for set in 0..=self.set {
            let place = &mut text["attributes"][set_name(set)];
            if place.is_null() {
                *place = json!(own.texcoords);
            }
        }
        Ok(())
    }

    /// Names accessors with the repeated vertices in place of those that a primitive had.
    fn repeat(&mut self, text: &mut Value, group: &VertexGroup, own: &mut GroupAccessors) -> Result<()> {
        if own.split.further.is_empty() {
            return Ok(());
        }
        let mut failed = Ok(());
        each_attribute_list(text, |members| {
            for value in members.values_mut() {
                let Some(accessor) = value.as_u64().map(|k| k as usize) else { continue };
                let copy = match own.copies.get(&accessor) {
                    Some(known) => *known,
                    None => match self.repeated(accessor, group, &own.split) {
                        Ok(new) => {
                            own.copies.insert(accessor, new);
                            new
                        }
                        Err(error) => {
                            failed = Err(error);
                            return;
                        }
                    },
                };
                *value = json!(copy);
            }
        });
        failed
    }

    /// An accessor with the repeated vertices of a group behind all others; the bytes of each are those of the vertex that it repeats.
    fn repeated(&mut self, accessor: usize, group: &VertexGroup, split: &GroupSplit) -> Result<usize> {
        let found = self.file.accessor(accessor as u32, "an attribute", &ANY_SHAPE)?;
        if found.count != group.n {
            let message = format!("an attribute has {} elements, POSITION {}", found.count, group.n);
            return found.place(self.file).error(message);
        }
        let PackedElements { mut bytes, stride } = found.packed(&mut self.budget, self.file)?;
        self.budget.take(split.further.len(), stride, "vertices", self.file.whole())?;
        for v in split.further.iter().map(|v| *v as usize * stride) {
            bytes.extend_from_within(v..v + stride);
        }
        let mut entry = self.kept.document["accessors"][accessor].clone();
        if let Some(members) = entry.as_object_mut() {
            members.retain(|key, _| !["bufferView", "byteOffset", "sparse"].contains(&key.as_str()));
            members.insert("count".into(), json!(split.texcoords.len()));
        }
        self.kept.replace(accessor);
        Ok(self.kept.add(entry, PackedElements { bytes, stride }, ViewTarget::Vertices))
    }

    /// Writes the indices of a primitive, number `k` of its group, where they change.
    fn indices(&mut self, text: &mut Value, primitive: &GroupPrimitive, split: &GroupSplit, k: usize) {
        let (n, faces) = (split.texcoords.len(), &split.faces[k]);
        let n_before = n - split.further.len();
        let is_same = faces.as_flattened().iter().all(|v| (*v as usize) < n_before);
        let is_counted = text.get("indices").is_some() || split.further.is_empty();
        if primitive.is_list && is_same && is_counted {
            return;
        }
        let corners = faces.as_flattened();
        let (bytes, component): (Vec<u8>, u32) = if n <= MOST_SHORT {
            (corners.iter().flat_map(|v| (*v as u16).to_le_bytes()).collect(), 5123)
        } else {
            (corners.iter().flat_map(|v| v.to_le_bytes()).collect(), 5125)
        };
        let entry = json!({"componentType": component, "count": corners.len(), "type": "SCALAR"});
        if let Some(accessor) = text["indices"].as_u64() {
            self.kept.replace(accessor as usize);
        }
        let stride = if n <= MOST_SHORT { 2 } else { 4 };
        text["indices"] = json!(self.kept.add(entry, PackedElements { bytes, stride }, ViewTarget::Indices));
        if !primitive.is_list
            && let Some(members) = text.as_object_mut()
        {
            members.remove("mode");
            self.report.n_unrolled += 1;
        }
    }

    /// The tangents of the vertices of a group. Their positions and normals are those of the mesh, not of the scene.
    fn tangents_of(&mut self, group: &VertexGroup, own: &mut GroupAccessors) -> Result<usize> {
        if let Some(known) = own.tangents {
            return Ok(known);
        }
        let file = self.file;
        let three = [ElementShape::Vec3];
        // The document that was read names the accessors without repeated vertices.
        let normal = file.document.meshes[group.mesh].primitives[group.primitives[0].index].attributes.normal;
        let Some(normal) = normal else {
            return file.whole().error(format!("mesh {} has no normals", group.mesh));
        };
        let mut positions =
            file.accessor(group.position, "POSITION", &three)?.numbers(0.0, &mut self.budget, file)?;
        let normals = file.accessor(normal, "NORMAL", &three)?;
        if normals.count != group.n {
            let message = format!("NORMAL has {} elements, POSITION {}", normals.count, group.n);
            return normals.place(file).error(message);
        }
        let mut normals = normals.numbers(0.0, &mut self.budget, file)?;
        for list in [&mut positions, &mut normals] {
            self.budget.take(own.split.further.len(), size_of::<[f64; 3]>(), "vertices", file.whole())?;
            own.split.further.iter().for_each(|v| list.push(list[*v as usize]));
        }
        // v points down in glTF.
        let uv: Vec<[f64; 2]> =
            own.split.texcoords.iter().map(|[s, t]| [f64::from(*s), -f64::from(*t)]).collect();
        let faces = own.split.faces.concat();
        let found = vertex_tangents(&TangentFrames {
            positions: &positions,
            normals: &normals,
            uv: &uv,
            faces: &faces,
        });
        let narrow: Vec<[f32; 4]> = found.into_iter().map(|t| t.map(|x| x as f32)).collect();
        let entry = json!({"componentType": FLOAT, "count": narrow.len(), "type": "VEC4"});
        let accessor = self.kept.add(entry, packed(&narrow), ViewTarget::Vertices);
        own.tangents = Some(accessor);
        Ok(accessor)
    }
}

/// Numbers of 32 bits as bytes.
fn packed<const N: usize>(values: &[[f32; N]]) -> PackedElements {
    let bytes = values.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    PackedElements { bytes, stride: N * size_of::<f32>() }
}

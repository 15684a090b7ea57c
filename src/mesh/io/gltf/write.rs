//! Writer of binary glTF 2.0 with textures.

use super::glb_chunks::GlbChunks;
use super::materials::{MaterialStretch, stretches};
use super::scene::unit;
use super::seams::first_alike;
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::io::TexturedMesh;
use crate::mesh::weld::place_key;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;

/// A picture over the texture coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Texture<'a> {
    /// The bytes of a PNG file.
    pub png: &'a [u8],
    /// The continuation of the picture outside the unit square.
    pub wrap: Wrap,
    /// The number of copies of the picture along a unit of the texture coordinates. Numbers other than 1 are written with the extension
    /// KHR_texture_transform.
    pub repeat: f64,
}

/// The continuation of a texture outside the unit square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Wrap {
    /// Periodic.
    #[default]
    Repeat,
    /// Periodic, every other copy mirrored.
    Mirror,
    /// The colours of its border.
    Clamp,
}

impl Wrap {
    fn code(self) -> u32 {
        match self {
            Wrap::Repeat => 10497,
            Wrap::Mirror => 33648,
            Wrap::Clamp => 33071,
        }
    }
}

/// Extents of meshes whose coordinates are stored unscaled. Others are scaled to about 1, since an `f32` ends at 2¹²⁸ = 3e38 and loses
/// digits below 2⁻¹²⁶ = 1e-38.
const PLAIN: std::ops::RangeInclusive<f64> = 1e-25..=1e30;

/// Writes binary glTF 2.0 (.glb), atomically: one mesh, its attributes as `f32`, normals of length 1, and a texture if there is one.
/// Texture coordinates have v upwards, as in OBJ.
///
/// Positions are exact if all of them are `f32` numbers. Others are stored relative to the centre of their bounding box, which is the
/// translation of the mesh's node in 64-bit numbers: each coordinate has an error of at most 2⁻²⁴ of its largest distance from the
/// centre, also far from the origin.
///
/// A vertex of glTF has one normal and one pair of texture coordinates. Vertices keep their numbers with those of their first corner; a
/// vertex with others is repeated for each of these after all vertices, in the order of the corners. Returned is the input's vertex for
/// each vertex of the file: 0, 1, …, V − 1 and those of the repeated ones. Faces keep order and corners. Where the positions do not tell
/// which vertices are repeated, the file says so in an attribute of this library, `_RICCI_VERTEX`: the number as two of 16 bits, the
/// lower one first.
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of range,
/// [`crate::Error::Size`], [`crate::Error::TooLarge`] for more than the 4 GB that glTF can count, [`crate::Error::Io`].
pub fn write_glb(path: &Path, data: &TexturedMesh<'_>, texture: Option<Texture<'_>>) -> Result<Vec<u32>> {
    data.check()?;
    let split = SplitVertices::new(data);
    let placed = NodePlacement::new(data.positions);
    let mut parts = GlbParts::default();
    let vertices = split.origin.iter().map(|&v| v as usize);
    if !data.positions.is_empty() {
        let stored: Vec<[f32; 3]> = vertices.clone().map(|v| placed.stored(data.positions[v])).collect();
        let places = |v: u32| place_key(placed.read(stored[v as usize]));
        let told = first_alike(0..stored.len() as u32, places) == split.origin;
        let position = parts.attribute("POSITION", stored);
        (position["min"], position["max"]) = placed.bounds();
        if !told {
            parts.vertex_numbers(&split.origin);
        }
        if !data.normals.is_empty() {
            parts.attribute("NORMAL", split.normals);
        }
        if !data.colors.is_empty() {
            let color = |v: usize| data.colors[v].map(|x| x.clamp(0.0, 1.0) as f32);
            parts.attribute("COLOR_0", vertices.map(color).collect());
        }
    }
    if !data.face_texcoords.is_empty() {
        parts.attribute("TEXCOORD_0", split.texcoords);
    }
    if !split.faces.is_empty() {
        let (stretches, materials) = stretches(data.labels, split.faces.len());
        parts.indices(&split.faces, &stretches);
        parts.materials = materials;
    }
    if let Some(texture) = texture {
        parts.texture(texture);
    }
    parts.chunks(placed.node()).write(path)?;
    Ok(split.origin)
}

/// Vertices with one normal and one pair of texture coordinates each.
struct SplitVertices {
    /// For each vertex the vertex of the input.
    origin: Vec<u32>,
    /// For each vertex the texture coordinates with v downwards.
    texcoords: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
}

impl SplitVertices {
    fn new(data: &TexturedMesh<'_>) -> SplitVertices {
        let n = data.positions.len();
        let texcoord = |corner: usize| match data.face_texcoords.as_flattened().get(corner) {
            Some(&t) => {
                let [s, t] = data.texcoords[t as usize];
                [s as f32, (1.0 - t) as f32]
            }
            None => [0.0; 2],
        };
        let corner_normal = |corner: usize| match data.face_normals.as_flattened().get(corner) {
            Some(&k) => normal(data.normals[k as usize]),
            None => [0.0; 3],
        };
        let at_vertices = data.face_normals.is_empty() && !data.normals.is_empty();
        let mut split = SplitVertices {
            origin: (0..n as u32).collect(),
            texcoords: vec![[0.0; 2]; n],
            normals: if at_vertices {
                data.normals.iter().map(|&x| normal(x)).collect()
            } else {
                vec![[0.0; 3]; n]
            },
            faces: data.faces.to_vec(),
        };
        let mut first = vec![None; n];
        let mut further = HashMap::new();
        for (corner, vertex) in split.faces.as_flattened_mut().iter_mut().enumerate() {
            let v = *vertex as usize;
            let texcoord = texcoord(corner);
            let normal = if at_vertices { split.normals[v] } else { corner_normal(corner) };
            let bits = (texcoord.map(f32::to_bits), normal.map(f32::to_bits));
            if first[v].is_none() {
                (split.texcoords[v], split.normals[v]) = (texcoord, normal);
            }
            if *first[v].get_or_insert(bits) != bits {
                *vertex = *further.entry((*vertex, bits)).or_insert_with(|| {
                    split.origin.push(v as u32);
                    split.texcoords.push(texcoord);
                    split.normals.push(normal);
                    split.origin.len() as u32 - 1
                });
            }
        }
        split
    }
}

/// The transform of the node: a stored number x stands for centre + scale · x.
struct NodePlacement {
    centre: Point,
    /// A power of two.
    scale: f64,
    low: Point,
    high: Point,
}

impl NodePlacement {
    fn new(positions: &[Point]) -> NodePlacement {
        let bound = |pick: fn(f64, f64) -> f64, start: f64| -> Point {
            std::array::from_fn(|k| positions.iter().map(|p| p[k]).fold(start, pick))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        let narrow = |x: &f64| f64::from(*x as f32) == *x;
        if positions.as_flattened().iter().all(narrow) {
            return NodePlacement { centre: [0.0; 3], scale: 1.0, low, high };
        }
        let centre = std::array::from_fn(|k| 0.5 * low[k] + 0.5 * high[k]);
        let extent = (0..3).map(|k| (high[k] - centre[k]).max(centre[k] - low[k])).fold(0.0, f64::max);
        let plain = extent == 0.0 || PLAIN.contains(&extent);
        let scale = if plain { 1.0 } else { extent.log2().floor().clamp(-1000.0, 1000.0).exp2() };
        NodePlacement { centre, scale, low, high }
    }

    fn stored(&self, p: Point) -> [f32; 3] {
        std::array::from_fn(|k| ((p[k] - self.centre[k]) / self.scale) as f32)
    }

    /// The point that is read back for stored numbers.
    fn read(&self, stored: [f32; 3]) -> Point {
        std::array::from_fn(|k| self.centre[k] + self.scale * f64::from(stored[k]))
    }

    fn bounds(&self) -> (Value, Value) {
        (json!(self.stored(self.low)), json!(self.stored(self.high)))
    }

    fn node(&self) -> Value {
        let mut node = json!({"mesh": 0});
        if self.centre != [0.0; 3] {
            node["translation"] = json!(self.centre);
        }
        if self.scale != 1.0 {
            node["scale"] = json!(vec![self.scale; 3]);
        }
        node
    }
}

/// The binary chunk, and the parts of the document that refer to its bytes.
#[derive(Default)]
struct GlbParts {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    attributes: serde_json::Map<String, Value>,
    /// Per primitive, the accessor of its indices and its material.
    primitives: Vec<[usize; 2]>,
    materials: Vec<Value>,
    /// Sampler and buffer view of the texture.
    texture: Option<(Value, usize, f64)>,
}

impl GlbParts {
    const VERTICES: u32 = 34962;
    const INDICES: u32 = 34963;
    const FLOAT: u32 = 5126;
    const UNSIGNED_SHORT: u32 = 5123;
    const UNSIGNED_INT: u32 = 5125;

    /// Adds a buffer view of these bytes; returns its number.
    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let start = self.binary.len();
        self.binary.extend(bytes);
        let mut view = json!({"buffer": 0, "byteOffset": start, "byteLength": self.binary.len() - start});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn attribute<const N: usize>(&mut self, name: &str, values: Vec<[f32; N]>) -> &mut Value {
        let bytes = values.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        let view = self.view(bytes, Some(GlbParts::VERTICES));
        self.attributes.insert(name.into(), json!(self.accessors.len()));
        let kind = format!("VEC{N}");
        self.accessors.push(
            json!({"bufferView": view, "componentType": GlbParts::FLOAT, "count": values.len(), "type": kind}),
        );
        let last = self.accessors.len() - 1;
        &mut self.accessors[last]
    }

    fn vertex_numbers(&mut self, numbers: &[u32]) {
        let view = self.view(numbers.iter().flat_map(|v| v.to_le_bytes()), Some(GlbParts::VERTICES));
        self.attributes.insert("_RICCI_VERTEX".into(), json!(self.accessors.len()));
        self.accessors.push(json!({
            "bufferView": view, "componentType": GlbParts::UNSIGNED_SHORT, "count": numbers.len(), "type": "VEC2"
        }));
    }

    fn indices(&mut self, faces: &[[u32; 3]], stretches: &[MaterialStretch]) {
        let corners = faces.as_flattened();
        let view = self.view(corners.iter().flat_map(|v| v.to_le_bytes()), Some(GlbParts::INDICES));
        for MaterialStretch { faces, material } in stretches {
            self.primitives.push([self.accessors.len(), *material]);
            let mut accessor = json!({
                "bufferView": view, "componentType": GlbParts::UNSIGNED_INT, "count": 3 * faces.len(), "type": "SCALAR"
            });
            if faces.start > 0 {
                accessor["byteOffset"] = json!(3 * size_of::<u32>() * faces.start);
            }
            self.accessors.push(accessor);
        }
    }

    fn texture(&mut self, texture: Texture<'_>) {
        let view = self.view(texture.png.iter().copied(), None);
        let wrap = texture.wrap.code();
        let sampler = json!({"magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap});
        self.texture = Some((sampler, view, texture.repeat));
    }

    /// The JSON and the binary chunk. Without faces the vertices are points; glTF has no mesh without vertices.
    fn chunks(self, node: Value) -> GlbChunks {
        let mut document = json!({
            "asset": {"version": "2.0", "generator": concat!("ricci ", env!("CARGO_PKG_VERSION"))},
            "scene": 0,
            "scenes": [{}]
        });
        let mut materials = self.materials;
        if materials.is_empty() {
            materials = stretches(None, 0).1;
        }
        if let Some((sampler, view, repeat)) = self.texture {
            let mut base = json!({"index": 0});
            if repeat != 1.0 {
                base["extensions"] = json!({"KHR_texture_transform": {"scale": [repeat, repeat]}});
                document["extensionsUsed"] = json!(["KHR_texture_transform"]);
            }
            for material in &mut materials {
                material["pbrMetallicRoughness"]["baseColorTexture"] = base.clone();
            }
            document["textures"] = json!([{"source": 0, "sampler": 0}]);
            document["samplers"] = json!([sampler]);
            document["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
        }
        if !self.attributes.is_empty() {
            let attributes = &self.attributes;
            let triangles = self.primitives.iter().map(|[indices, material]| {
                json!({"attributes": attributes, "material": material, "indices": indices})
            });
            let mut primitives: Vec<Value> = triangles.collect();
            if primitives.is_empty() {
                primitives.push(json!({"attributes": attributes, "material": 0, "mode": 0}));
            }
            document["scenes"][0]["nodes"] = json!([0]);
            document["nodes"] = json!([node]);
            document["meshes"] = json!([{"primitives": primitives}]);
            document["materials"] = json!(materials);
            document["accessors"] = json!(self.accessors);
        }
        if !self.binary.is_empty() {
            document["bufferViews"] = json!(self.views);
            document["buffers"] = json!([{"byteLength": self.binary.len()}]);
        }
        GlbChunks::new(&document, self.binary)
    }
}

/// A normal of length 1, as glTF requires.
fn normal(x: Point) -> [f32; 3] {
    unit(x).map(|x| x as f32)
}

//! The parts of a glTF 2.0 document that are read. All others are skipped without being stored, and those that are read take little more
//! memory than their text, so that a document cannot take many times its size.

use serde::Deserialize;
use serde::de::IgnoredAny;

/// The JSON document [glTF 2.0, section 5].
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfDocument {
    pub asset: Asset,
    #[serde(default)]
    pub extensions_required: Vec<String>,
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<GltfScene>,
    #[serde(default)]
    pub nodes: Vec<GltfNode>,
    #[serde(default)]
    pub meshes: Vec<GltfMesh>,
    #[serde(default)]
    pub accessors: Vec<AccessorEntry>,
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub materials: Vec<MaterialEntry>,
    // Lists of which the numbers alone are kept, which take no memory.
    #[serde(default)]
    pub images: Vec<IgnoredAny>,
    #[serde(default)]
    pub animations: Vec<IgnoredAny>,
    #[serde(default)]
    pub skins: Vec<IgnoredAny>,
}

impl GltfDocument {
    /// True for a file that this library wrote.
    pub fn is_own(&self) -> bool {
        self.asset.generator.as_deref().is_some_and(|name| name.starts_with("ricci "))
    }

    /// The parts of the document that are not read.
    pub fn unread(&self) -> Vec<String> {
        let further = self.materials.iter().filter(|material| material.has_more()).count();
        let primitives = || self.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let with = |has: fn(&Primitive) -> bool| primitives().filter(|primitive| has(primitive)).count();
        let counts = [
            (further, ["material's relief, glow or transparency", "materials' relief, glow or transparency"]),
            (self.images.len(), ["picture of textures", "pictures of textures"]),
            (self.animations.len(), ["animation", "animations"]),
            (self.skins.len(), ["skin", "skins"]),
            (with(|p| p.targets.is_some()), ["primitive's morph targets", "primitives' morph targets"]),
            (
                with(|p| p.attributes.texcoord_1.is_some()),
                ["second set of texture coordinates", "second sets of texture coordinates"],
            ),
            (with(|p| p.attributes.tangent.is_some()), ["primitive's tangents", "primitives' tangents"]),
        ];
        let told = |(n, [one, many]): (usize, [&str; 2])| {
            (n > 0).then(|| format!("{n} {}", if n == 1 { one } else { many }))
        };
        counts.into_iter().filter_map(told).collect()
    }
}

/// A material, of which the name, the colour and the roughness are read.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct MaterialEntry {
    pub name: Option<Box<str>>,
    pub pbr_metallic_roughness: Option<Box<MetalAndRoughness>>,
    normal_texture: Option<IgnoredAny>,
    occlusion_texture: Option<IgnoredAny>,
    emissive_texture: Option<IgnoredAny>,
    emissive_factor: Option<IgnoredAny>,
    alpha_mode: Option<IgnoredAny>,
    extensions: Option<IgnoredAny>,
}

impl MaterialEntry {
    /// True for a material with properties that are not read, beside pictures, which are counted by themselves.
    fn has_more(&self) -> bool {
        let MaterialEntry { normal_texture, occlusion_texture, emissive_texture, emissive_factor, .. } = self;
        let further = [normal_texture, occlusion_texture, emissive_texture, emissive_factor];
        further.into_iter().chain([&self.alpha_mode, &self.extensions]).any(Option::is_some)
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct MetalAndRoughness {
    pub base_color_factor: Option<[f64; 4]>,
    pub metallic_factor: Option<f64>,
    pub roughness_factor: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct Asset {
    pub version: String,
    pub generator: Option<String>,
}

/// The version of a document that is not one of version 2.
#[derive(Deserialize)]
pub(super) struct AssetAlone {
    pub asset: Option<AnyAsset>,
}

#[derive(Deserialize)]
pub(super) struct AnyAsset {
    pub version: Option<AnyVersion>,
}

/// Version 1 writes its number as text, early files as a number.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum AnyVersion {
    Text(String),
    Number(f64),
}

impl AnyVersion {
    pub fn is_before_2(&self) -> bool {
        match self {
            AnyVersion::Text(text) => text.starts_with(['0', '1']),
            AnyVersion::Number(number) => *number < 2.0,
        }
    }
}

#[derive(Deserialize)]
pub(super) struct GltfScene {
    #[serde(default)]
    pub nodes: Vec<u32>,
}

/// A node; its transform, if it has one, as an affine map.
#[derive(Deserialize)]
#[serde(from = "NodeText")]
pub(super) struct GltfNode {
    pub mesh: Option<u32>,
    /// True if the mesh has a skin: its position is then that of its joints, not of this node.
    pub skinned: bool,
    pub children: Box<[u32]>,
    pub transform: Option<Box<Affine>>,
}

#[derive(Deserialize)]
struct NodeText {
    mesh: Option<u32>,
    skin: Option<u32>,
    #[serde(default)]
    children: Box<[u32]>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

impl From<NodeText> for GltfNode {
    fn from(text: NodeText) -> GltfNode {
        let NodeText { mesh, skin, children, matrix, translation, rotation, scale } = text;
        let transform = match matrix {
            Some(m) => Some(Affine::from_columns(&m)),
            None if translation.is_none() && rotation.is_none() && scale.is_none() => None,
            None => Some(Affine::from_parts(
                translation.unwrap_or([0.0; 3]),
                rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
                scale.unwrap_or([1.0; 3]),
            )),
        };
        GltfNode { mesh, skinned: skin.is_some(), children, transform: transform.map(Box::new) }
    }
}

/// x ↦ linear · x + translation.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Affine {
    /// Rows.
    pub linear: [[f64; 3]; 3],
    pub translation: [f64; 3],
}

impl Affine {
    pub const IDENTITY: Affine =
        Affine { linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// A 4 × 4 matrix, column by column; its last row is (0, 0, 0, 1).
    fn from_columns(m: &[f64; 16]) -> Affine {
        Affine {
            linear: std::array::from_fn(|i| std::array::from_fn(|j| m[4 * j + i])),
            translation: [m[12], m[13], m[14]],
        }
    }

    /// The map that scales, then rotates by the quaternion (x, y, z, w), then translates.
    fn from_parts(translation: [f64; 3], [x, y, z, w]: [f64; 4], scale: [f64; 3]) -> Affine {
        let square = x * x + y * y + z * z + w * w;
        let s = if square > 0.0 { 2.0 / square } else { 0.0 };
        let rotation = [
            [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
        ];
        let linear = rotation.map(|row| std::array::from_fn(|j| row[j] * scale[j]));
        Affine { linear, translation }
    }

    /// The composition that applies `inner` first, then this map.
    pub fn after(&self, inner: &Affine) -> Affine {
        let column = |j: usize| self.turn(std::array::from_fn(|i| inner.linear[i][j]));
        let columns = [column(0), column(1), column(2)];
        Affine {
            linear: std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
            translation: self.apply(inner.translation),
        }
    }

    pub fn apply(&self, x: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(x);
        std::array::from_fn(|i| turned[i] + self.translation[i])
    }

    fn turn(&self, x: [f64; 3]) -> [f64; 3] {
        self.linear.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
    }

    /// The map of normals up to a positive factor, which consists of the cofactors of the linear part times the sign of its determinant;
    /// and true if that is negative.
    pub fn of_normals(&self) -> (Affine, bool) {
        // Scaled to size 1, so that no product leaves the range of f64.
        let size = self.linear.as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let m = if size > 0.0 { self.linear.map(|row| row.map(|x| x / size)) } else { self.linear };
        let cofactor = |i: usize, j: usize| {
            let [a, b, c, d] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let mirrors = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum::<f64>() < 0.0;
        let sign = if mirrors { -1.0 } else { 1.0 };
        let linear = std::array::from_fn(|i| std::array::from_fn(|j| sign * cofactor(i, j)));
        (Affine { linear, translation: [0.0; 3] }, mirrors)
    }
}

#[derive(Deserialize)]
pub(super) struct GltfMesh {
    pub primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub attributes: AttributeAccessors,
    pub indices: Option<u32>,
    pub mode: Option<u32>,
    pub material: Option<u32>,
    pub targets: Option<IgnoredAny>,
}

/// The accessors of the attributes that are read.
#[derive(Deserialize)]
pub(super) struct AttributeAccessors {
    #[serde(rename = "POSITION")]
    pub position: Option<u32>,
    #[serde(rename = "NORMAL")]
    pub normal: Option<u32>,
    #[serde(rename = "COLOR_0")]
    pub color: Option<u32>,
    #[serde(rename = "TEXCOORD_0")]
    pub texcoord: Option<u32>,
    #[serde(rename = "TEXCOORD_1")]
    pub texcoord_1: Option<IgnoredAny>,
    #[serde(rename = "TANGENT")]
    pub tangent: Option<IgnoredAny>,
    #[serde(rename = "_RICCI_VERTEX")]
    pub vertex: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct AccessorEntry {
    pub buffer_view: Option<u32>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub shape: ElementShape,
    pub sparse: Option<Box<Sparse>>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Debug)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum ElementShape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: u32,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: u32,
    #[serde(default)]
    pub byte_offset: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub buffer: u32,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub byte_length: usize,
    pub uri: Option<String>,
}

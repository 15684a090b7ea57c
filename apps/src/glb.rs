//! A surface with its layout as binary glTF 2.0: one mesh, texture coordinates and a checkerboard texture.

use crate::failure::Failure;
use serde_json::json;

/// Squares along the longer side of the layout.
const SQUARES: f64 = 24.0;
/// Pixels per side of the texture, which holds 2 × 2 squares and repeats.
const PIXELS: u32 = 64;
const LIGHT: u8 = 235;
const DARK: u8 = 70;

/// A triangle list with a texture coordinate per vertex; vertices along seams are given once per side.
pub struct Textured {
    pub positions: Vec<[f64; 3]>,
    pub texcoords: Vec<[f64; 2]>,
    pub faces: Vec<[u32; 3]>,
}

/// The file's bytes. Positions are centred; the texture repeats in squares of equal size in the layout.
pub fn encode(surface: &Textured) -> Result<Vec<u8>, Failure> {
    let bounds = bounds(&surface.positions);
    let plane = self::bounds(&surface.texcoords);
    let extent = (plane[1][0] - plane[0][0]).max(plane[1][1] - plane[0][1]).max(f64::MIN_POSITIVE);
    // The texture is two squares wide, and v points down in glTF.
    let texcoord = |p: &[f64; 2]| {
        let at = [p[0] - plane[0][0], plane[1][1] - p[1]];
        at.map(|x| (x * SQUARES / (2.0 * extent)) as f32)
    };
    let center: [f64; 3] = std::array::from_fn(|k| 0.5 * (bounds[0][k] + bounds[1][k]));
    let position = |p: &[f64; 3]| -> [f32; 3] { std::array::from_fn(|k| (p[k] - center[k]) as f32) };
    let positions: Vec<_> = surface.positions.iter().map(position).collect();
    let (min, max) = extremes(&positions);

    let mut binary = Vec::new();
    let mut views = Vec::new();
    let mut view = |bytes: Vec<u8>, target: Option<u32>| {
        views.push(match target {
            Some(target) => {
                json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len(), "target": target})
            }
            None => json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len()}),
        });
        binary.extend(bytes);
        binary.resize(binary.len().next_multiple_of(4), 0);
    };
    const VERTICES: Option<u32> = Some(34962);
    const INDICES: Option<u32> = Some(34963);
    view(positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect(), VERTICES);
    view(surface.texcoords.iter().flat_map(texcoord).flat_map(f32::to_le_bytes).collect(), VERTICES);
    view(surface.faces.iter().flatten().flat_map(|i| i.to_le_bytes()).collect(), INDICES);
    view(checkerboard()?, None);
    const FLOAT: u32 = 5126;
    const UNSIGNED_INT: u32 = 5125;
    let n = positions.len();
    let document = json!({
        "asset": {"version": "2.0", "generator": concat!("ricci ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{
            "doubleSided": true,
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0, "roughnessFactor": 0.8}
        }],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": FLOAT, "count": n, "type": "VEC3", "min": min, "max": max},
            {"bufferView": 1, "componentType": FLOAT, "count": n, "type": "VEC2"},
            {"bufferView": 2, "componentType": UNSIGNED_INT, "count": 3 * surface.faces.len(), "type": "SCALAR"}
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": binary.len()}]
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let size = |n: usize| {
        u32::try_from(n)
            .map(u32::to_le_bytes)
            .map_err(|_| Failure::Failed("the surface is too large for glTF".into()))
    };
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(size(total)?);
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        file.extend(size(chunk.len())?);
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}

fn bounds<const N: usize>(points: &[[f64; N]]) -> [[f64; N]; 2] {
    points.iter().fold([[f64::INFINITY; N], [f64::NEG_INFINITY; N]], |[lo, hi], p| {
        [std::array::from_fn(|k| lo[k].min(p[k])), std::array::from_fn(|k| hi[k].max(p[k]))]
    })
}

fn extremes(points: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    points.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(lo, hi), p| {
        (std::array::from_fn(|k| lo[k].min(p[k])), std::array::from_fn(|k| hi[k].max(p[k])))
    })
}

/// A PNG of 2 × 2 squares.
fn checkerboard() -> Result<Vec<u8>, Failure> {
    let shade = |i: u32| if (i % PIXELS < PIXELS / 2) ^ (i / PIXELS < PIXELS / 2) { DARK } else { LIGHT };
    let pixels: Vec<u8> = (0..PIXELS * PIXELS).map(shade).collect();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, PIXELS, PIXELS);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let failed = |e: png::EncodingError| Failure::Failed(format!("texture: {e}"));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(png)
}

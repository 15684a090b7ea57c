//! CoverCopies of the opened surface as binary glTF: a node each, named by its word; faces, texture coordinates and the checkerboard once, for
//! all, in the plane positions too; and a tint of its own for each of a few classes of copies.

use super::copies::CoverCopies;
use super::tiling::tint;
use crate::checkerboard;
use crate::picture::{TINTS, tint_color};
use ricci::geometry::{DoubleDouble, Motion, Space};
use serde_json::{Value, json};
use std::io::{self, Seek, SeekFrom, Write};

/// Characters of each bound of the positions: the bounds are filled in once the positions are written, and the longest floating-point
/// number has 24 characters.
const BOUND: usize = 26;
/// Most bytes of the file: glTF counts them in 32 bits.
const MOST: u64 = u32::MAX as u64;

/// Write the copies; coordinates are single precision, as glTF has them.
pub fn write_glb<W: Write + Seek>(out: &mut W, copies: &CoverCopies<'_>) -> io::Result<()> {
    let (shared, views) = shared(copies)?;
    // The nodes of glTF have affine maps. The isometries of the plane are such maps, those of the hyperbolic plane are not in any model.
    let instanced = copies.uniformized.deck.space == Space::E2;
    let n = if instanced { 1 } else { copies.elements.len() };
    let copy = 12 * copies.points.len();
    let binary = shared.len() as u64 + n as u64 * copy as u64;
    let none = vec![[[f64::MIN_POSITIVE; 3]; 2]; n];
    let document = GlbDocument { copies, views, offset: shared.len(), copy, binary, instanced };
    let json = document.text(&none);
    let total = 28 + json.len() as u64 + binary;
    if total > MOST {
        let why = format!("{total} bytes are more than binary glTF can count; write .obj, or fewer copies");
        return Err(io::Error::other(why));
    }
    let start = out.stream_position()?;
    out.write_all(b"glTF")?;
    out.write_all(&2u32.to_le_bytes())?;
    out.write_all(&(total as u32).to_le_bytes())?;
    out.write_all(&(json.len() as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    out.write_all(&(binary as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    out.write_all(&shared)?;
    let mut bounds = Vec::with_capacity(n);
    copies.each(
        n,
        |k| positions(copies, k),
        |(bound, bytes)| {
            bounds.push(bound);
            out.write_all(&bytes)
        },
    )?;
    // The bounds of the positions, which were left open.
    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(start + 20))?;
    out.write_all(document.text(&bounds).as_bytes())?;
    out.seek(SeekFrom::Start(end))?;
    Ok(())
}

/// The bytes that all copies share, indices, texture coordinates and the texture, each at a multiple of four bytes; and the buffer views
/// that say where they lie.
fn shared(copies: &CoverCopies<'_>) -> io::Result<(Vec<u8>, Vec<Value>)> {
    let png = checkerboard::png().map_err(|e| io::Error::other(e.to_string()))?;
    let indices: Vec<u8> = copies.faces.as_flattened().iter().flat_map(|i| i.to_le_bytes()).collect();
    // glTF counts v downwards.
    let st = copies.texcoords.iter().flat_map(|[s, t]| [*s as f32, (1.0 - t) as f32]);
    let texcoords: Vec<u8> = st.flat_map(f32::to_le_bytes).collect();
    let (mut shared, mut views) = (Vec::new(), Vec::new());
    for (bytes, target) in [(&indices, Some(34963)), (&texcoords, Some(34962)), (&png, None)] {
        let mut view = json!({"buffer": 0, "byteOffset": shared.len(), "byteLength": bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        views.push(view);
        shared.extend_from_slice(bytes);
        shared.resize(shared.len().next_multiple_of(4), 0);
    }
    Ok((shared, views))
}

/// The positions of a copy in single precision, and their least and largest coordinates.
fn positions(copies: &CoverCopies<'_>, k: usize) -> ([[f64; 3]; 2], Vec<u8>) {
    let points: Vec<[f32; 3]> = copies.points(k).into_iter().map(|p| p.map(|x| x as f32)).collect();
    let bound = |axis: usize, pick: fn(f32, f32) -> f32, start: f32| {
        f64::from(points.iter().map(|p| p[axis]).fold(start, pick))
    };
    let low = [0, 1, 2].map(|axis| bound(axis, f32::min, f32::INFINITY));
    let high = [0, 1, 2].map(|axis| bound(axis, f32::max, f32::NEG_INFINITY));
    ([low, high], points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect())
}

/// The JSON chunk of the file.
struct GlbDocument<'a> {
    copies: &'a CoverCopies<'a>,
    /// The buffer views of the indices, the texture coordinates and the texture.
    views: Vec<Value>,
    /// The offset in bytes of the positions of the first copy.
    offset: usize,
    /// The bytes of the positions of one copy.
    copy: usize,
    /// The bytes of the binary chunk.
    binary: u64,
    /// True if the file has the positions once for all copies.
    instanced: bool,
}

impl GlbDocument<'_> {
    /// The JSON chunk, whose length does not depend on the bounds.
    fn text(&self, bounds: &[[[f64; 3]; 2]]) -> String {
        let n = self.copies.points.len();
        let shared = [
            json!({"bufferView": 0, "componentType": 5125, "count": 3 * self.copies.faces.len(), "type": "SCALAR"}),
            json!({"bufferView": 1, "componentType": 5126, "count": n, "type": "VEC2"}),
        ];
        let mut views: Vec<String> = self.views.iter().map(Value::to_string).collect();
        let mut accessors: Vec<String> = shared.iter().map(Value::to_string).collect();
        for (k, [low, high]) in bounds.iter().enumerate() {
            let view = json!({
                "buffer": 0, "byteOffset": self.offset as u64 + (k * self.copy) as u64, "byteLength": self.copy, "target": 34962
            });
            views.push(view.to_string());
            let three = |p: &[f64; 3]| p.map(|x| format!("{x:>BOUND$?}")).join(",");
            accessors.push(format!(
                r#"{{"bufferView":{},"componentType":5126,"count":{n},"type":"VEC3","min":[{}],"max":[{}]}}"#,
                3 + k,
                three(low),
                three(high)
            ));
        }
        let deck = &self.copies.uniformized.deck;
        let mesh = |position: usize, tint: u8| {
            let attributes = json!({"POSITION": 2 + position, "TEXCOORD_0": 1});
            let primitive = json!({"attributes": attributes, "indices": 0, "material": tint});
            json!({"primitives": [primitive]}).to_string()
        };
        let copies = self.copies.elements.iter().enumerate();
        let (nodes, meshes): (Vec<String>, Vec<String>) = if self.instanced {
            (
                copies.map(|(k, g)| placed(&self.copies.name(k), tint(deck, g), &g.motion)).collect(),
                (0..=TINTS).map(|tint| mesh(0, tint)).collect(),
            )
        } else {
            let node = |k: usize| json!({"mesh": k, "name": self.copies.name(k)}).to_string();
            (
                copies.clone().map(|(k, _)| node(k)).collect(),
                copies.map(|(k, g)| mesh(k, tint(deck, g))).collect(),
            )
        };
        let list = |name: &str, items: &[String]| format!(",\"{name}\":[{}]", items.join(","));
        let mut text = self.head(nodes.len()).to_string();
        text.pop();
        for (name, items) in
            [("bufferViews", &views), ("accessors", &accessors), ("nodes", &nodes), ("meshes", &meshes)]
        {
            text += &list(name, items);
        }
        text.push('}');
        text.extend(std::iter::repeat_n(' ', text.len().next_multiple_of(4) - text.len()));
        text
    }

    /// The document without the lists that have an entry for each copy.
    fn head(&self, n_copies: usize) -> Value {
        let repeat = checkerboard::repeat(self.copies.texcoords);
        let transform = json!({"KHR_texture_transform": {"scale": [repeat, repeat]}});
        let texture = json!({"index": 0, "extensions": transform});
        let colors = (0..=TINTS).map(|t| {
            let [r, g, b] = tint_color(t);
            json!({
                "doubleSided": true,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [r, g, b, 1.0], "baseColorTexture": texture,
                    "metallicFactor": 0.0, "roughnessFactor": 0.8
                }
            })
        });
        json!({
            "asset": {"version": "2.0", "generator": concat!("ricci ", env!("CARGO_PKG_VERSION"))},
            "extensionsUsed": ["KHR_texture_transform"],
            "scene": 0,
            "scenes": [{"nodes": (0..n_copies).collect::<Vec<_>>()}],
            "materials": colors.collect::<Vec<_>>(),
            "textures": [{"source": 0, "sampler": 0}],
            "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
            "images": [{"bufferView": 2, "mimeType": "image/png"}],
            "buffers": [{"byteLength": self.binary}]
        })
    }
}

/// The node of a copy in the plane: the mesh of its tint, moved.
fn placed(name: &str, tint: u8, motion: &Motion<DoubleDouble>) -> String {
    let [[[cos, sin], [x, y]], _] = motion.mobius();
    let half = 0.5 * sin.atan2(cos);
    let (translation, rotation) = ([x, y, 0.0], [0.0, 0.0, half.sin(), half.cos()]);
    json!({"mesh": tint, "name": name, "translation": translation, "rotation": rotation}).to_string()
}

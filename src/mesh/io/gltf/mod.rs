//! glTF 2.0: binary files (.glb), and .gltf files that carry their buffers with them. The format is Khronos',
//! <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod document;
mod scene;
mod write;

pub use write::{Texture, Wrap, write_glb};

use super::budget::Budget;
use super::scan::Place;
use super::{Soup, base64};
use crate::error::Result;
use accessor::File;
use document::{Buffer, Document};
use std::borrow::Cow;

/// Extensions that may be required: those that change no triangle, and integers for positions.
const KNOWN_EXTENSIONS: [&str; 5] =
    ["KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_"];

/// Parse a glTF 2.0 file, binary or, if it begins with `{`, text: the meshes of its scene in space, one after the other.
///
/// Nodes are applied (mirrors turn faces around), vertices keep the order of the file: those that it gives twice, along seams of
/// normals or texture, stay two, and [`crate::mesh::repair`] welds them. Triangles, strips and fans are faces; the vertices of
/// points and lines have none. Attributes are `NORMAL`, `COLOR_0` (linear, as they stand) and `TEXCOORD_0`, with v upwards as
/// everywhere else here: glTF counts it downwards. Skins and morph targets are left as stored. Buffers are the binary chunk and
/// base64 data; other files are refused by name, and so is what an extension compresses. `path` is used in errors.
pub fn parse_glb(bytes: &[u8], path: &str) -> Result<Soup> {
    let place = Place { path, line: 0 };
    let (json, binary) = if bytes.trim_ascii_start().starts_with(b"{") || bytes.starts_with(b"\xef\xbb\xbf") {
        (bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None)
    } else {
        chunks(bytes, place)?
    };
    let document: Document = match serde_json::from_slice(json) {
        Ok(document) => document,
        Err(e) => return place.error(format!("the JSON of the file is not that of glTF: {e}")),
    };
    if !document.asset.version.starts_with("2.") {
        return place.error(format!("this is glTF {}; version 2 is read", document.asset.version));
    }
    let known = |name: &str| KNOWN_EXTENSIONS.iter().any(|known| name.starts_with(known));
    if let Some(name) = document.extensions_required.iter().find(|name| !known(name)) {
        return place.error(format!("the file needs the extension {name}; export it without"));
    }
    let buffers: Result<_> =
        document.buffers.iter().enumerate().map(|(i, b)| buffer(i, b, binary, place)).collect();
    let file = File { document: &document, buffers: buffers?, place };
    scene::soup(&file, Budget::of(bytes))
}

/// The JSON and the binary chunk of a GLB file [glTF 2.0, section 4.4].
fn chunks<'a>(bytes: &'a [u8], place: Place<'_>) -> Result<(&'a [u8], Option<&'a [u8]>)> {
    let word =
        |at: usize| bytes.get(at..at + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    let (true, Some(version), Some(length)) = (bytes.starts_with(b"glTF"), word(4), word(8)) else {
        return place
            .error("this is no GLB file: that begins with `glTF`, its version and its length".into());
    };
    if version != 2 {
        return place.error(format!("this is version {version} of GLB; version 2 is read"));
    }
    if length as usize > bytes.len() {
        return place.error(format!(
            "the file ends at byte {}, its header promises {length}; export it again",
            bytes.len()
        ));
    }
    let end = length as usize;
    let mut at = 12;
    let mut chunk = |kind: &[u8; 4]| -> Result<Option<&'a [u8]>> {
        let Some(size) = word(at).filter(|_| at + 8 <= end) else { return Ok(None) };
        if size as usize > end - at - 8 {
            return place
                .error(format!("the chunk at byte {at} promises {size} bytes, {} follow", end - at - 8));
        }
        let data = &bytes[at + 8..at + 8 + size as usize];
        let found = bytes[at + 4..at + 8] == *kind;
        at += 8 + size as usize;
        Ok(found.then_some(data))
    };
    match chunk(b"JSON")? {
        Some(json) => Ok((json, chunk(b"BIN\0")?)),
        None => place.error("the first chunk of the file is not JSON".into()),
    }
}

/// The bytes of buffer `i`.
fn buffer<'a>(
    i: usize,
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
    place: Place<'_>,
) -> Result<Cow<'a, [u8]>> {
    let bytes = match (&buffer.uri, binary) {
        (Some(uri), _) => match uri.strip_prefix("data:").and_then(|data| data.split_once(";base64,")) {
            Some((_, text)) => match base64::decode(text.as_bytes()) {
                Ok(bytes) => Cow::Owned(bytes),
                Err(message) => return place.error(format!("buffer {i}: {message}")),
            },
            None => {
                let name: String = uri.chars().take(80).collect();
                return place.error(format!(
                    "buffer {i} is in another file, `{name}`; export it as a single .glb file"
                ));
            }
        },
        (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
        (None, _) => return place.error(format!("buffer {i} has no data in the file")),
    };
    if bytes.len() < buffer.byte_length {
        return place.error(format!(
            "buffer {i} has {} bytes, {} are promised",
            bytes.len(),
            buffer.byte_length
        ));
    }
    Ok(bytes)
}

//! Reader and writer of glTF 2.0: binary files (.glb), and .gltf files that contain their buffers. The format is Khronos',
//! <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod document;
mod locate;
mod scene;
mod seams;
mod write;

pub use write::{Texture, Wrap, write_glb};

use super::budget::Budget;
use super::scan::{Location, Quoted};
use super::{Soup, base64};
use crate::error::Result;
use accessor::{GltfFile, StoredBytes};
use document::{Buffer, GltfDocument};
use locate::byte_of;
use std::borrow::Cow;

/// Prefixes of the extensions that a file may require: they change no triangle, or allow integers as positions.
const KNOWN_EXTENSIONS: [&str; 5] =
    ["KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_"];

/// Parses a glTF 2.0 file, binary or, if it begins with `{`, text: the meshes of its scene in space, one after the other.
///
/// The transforms of nodes are applied (mirrors turn faces around). A vertex of glTF has one normal and one pair of texture coordinates,
/// so files repeat vertices along seams and hard edges: vertices of a mesh with exactly the same position become one, which keeps the
/// number of the first, its colour, and the normals and texture coordinates of all at their corners. Files of this library mark vertices
/// that must not be joined by the attribute `_RICCI_VERTEX`. Triangles, strips and fans are faces; the vertices of points and lines have
/// none. Attributes are `NORMAL`, `COLOR_0` (linear, as stored) and `TEXCOORD_0`, whose v is turned upwards as everywhere in this
/// library. Attributes that only some primitives have are filled up with the defaults of [`super::Attributes`]. Skins and morph targets
/// are not applied. Buffers are the binary chunk and base64 data; other files are refused with their names, and so are compressed
/// buffers. `path` is used in errors.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the byte; [`crate::Error::TooLarge`] for more vertices than can be numbered.
pub fn parse_glb(bytes: &[u8], path: &str) -> Result<Soup> {
    let place = Location::whole(path);
    let bom = b"\xef\xbb\xbf";
    let (json, binary) = if bytes.trim_ascii_start().starts_with(b"{") || bytes.starts_with(bom) {
        (Chunk { start: if bytes.starts_with(bom) { bom.len() } else { 0 }, end: bytes.len() }, None)
    } else {
        chunks(bytes, path)?
    };
    let text = &bytes[json.start..json.end];
    let document: GltfDocument = match serde_json::from_slice(text) {
        Ok(document) => document,
        Err(e) => {
            let said = e.to_string();
            let said = said.rsplit_once(" at line ").map_or(said.as_str(), |(said, _)| said);
            let said: String = said.chars().take(200).collect();
            return Location::byte(path, json.start + byte_of(text, e.line(), e.column()))
                .error(format!("the JSON of the file is not that of glTF: {said}"));
        }
    };
    if !document.asset.version.starts_with("2.") {
        return place.error(format!("this is glTF {}; version 2 is read", document.asset.version));
    }
    let known = |name: &str| KNOWN_EXTENSIONS.iter().any(|known| name.starts_with(known));
    if let Some(name) = document.extensions_required.iter().find(|name| !known(name)) {
        return place.error(format!("the file needs the extension {name}; export it without"));
    }
    let mut file =
        GltfFile { document: &document, buffers: Vec::new(), path, json: text, json_start: json.start };
    for (i, text) in document.buffers.iter().enumerate() {
        match buffer(i, text, bytes, binary) {
            Ok(found) => file.buffers.push(found),
            Err(message) => return file.place_of("buffers", i).error(format!("buffer {i} {message}")),
        }
    }
    scene::soup(&file, Budget::of(bytes))
}

/// A range of bytes of the file.
#[derive(Clone, Copy)]
struct Chunk {
    start: usize,
    end: usize,
}

/// The JSON and the binary chunk of a GLB file [glTF 2.0, section 4.4].
fn chunks(bytes: &[u8], path: &str) -> Result<(Chunk, Option<Chunk>)> {
    let word =
        |at: usize| bytes.get(at..at + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    let (true, Some(version), Some(length)) = (bytes.starts_with(b"glTF"), word(4), word(8)) else {
        return Location::byte(path, 0)
            .error("this is no GLB file: that begins with `glTF`, its version and its length".into());
    };
    if version != 2 {
        return Location::byte(path, 4).error(format!("this is version {version} of GLB; version 2 is read"));
    }
    if length as usize > bytes.len() {
        return Location::byte(path, bytes.len())
            .error(format!("the file ends here, its header promises {length} bytes; export it again"));
    }
    let end = length as usize;
    let mut at = 12;
    let mut chunk = |kind: &[u8; 4]| -> Result<Option<Chunk>> {
        let Some(size) = word(at).filter(|_| at + 8 <= end) else { return Ok(None) };
        if size as usize > end - at - 8 {
            return Location::byte(path, at)
                .error(format!("this chunk promises {size} bytes, {} follow", end - at - 8));
        }
        let data = Chunk { start: at + 8, end: at + 8 + size as usize };
        let found = bytes[at + 4..at + 8] == *kind;
        at = data.end;
        Ok(found.then_some(data))
    };
    match chunk(b"JSON")? {
        Some(json) => Ok((json, chunk(b"BIN\0")?)),
        None => Location::byte(path, 12).error("the first chunk of the file is not JSON".into()),
    }
}

/// The bytes of buffer `i`; the error is a message.
fn buffer<'a>(
    i: usize,
    buffer: &Buffer,
    file: &'a [u8],
    binary: Option<Chunk>,
) -> std::result::Result<StoredBytes<'a>, String> {
    let stored = match (&buffer.uri, binary) {
        (Some(uri), _) => match uri.strip_prefix("data:").and_then(|data| data.split_once(";base64,")) {
            Some((_, text)) => {
                let bytes =
                    base64::decode(text.as_bytes()).map_err(|message| format!("is damaged: {message}"))?;
                StoredBytes { bytes: Cow::Owned(bytes), start: None }
            }
            None => {
                return Err(format!("is in another file, {}; export it as a single .glb file", Quoted(uri)));
            }
        },
        (None, Some(Chunk { start, end })) if i == 0 => {
            StoredBytes { bytes: Cow::Borrowed(&file[start..end]), start: Some(start) }
        }
        (None, _) => return Err("has no data in the file".into()),
    };
    if stored.bytes.len() < buffer.byte_length {
        return Err(format!("has {} bytes, {} are promised", stored.bytes.len(), buffer.byte_length));
    }
    Ok(stored)
}

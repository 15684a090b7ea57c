//! Reader and writer of glTF 2.0: binary files (.glb), and .gltf files with their buffers inside or beside them. The format is Khronos',
//! <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod buffers;
mod document;
mod document_walk;
mod glb_chunks;
mod kept_document;
mod locate;
mod materials;
mod pictures;
mod scene;
mod scene_edit;
mod scene_file;
mod scene_model;
mod scene_report;
mod scene_split;
mod seams;
mod texture_sets;
mod write;

pub use scene_file::SceneFile;
pub use scene_report::{SceneOptions, SceneReport};
pub use write::{Texture, Wrap, write_glb};

use super::Soup;
use super::budget::Budget;
use super::scan::Location;
use crate::error::Result;
use accessor::GltfFile;
use buffers::{BufferSources, Chunk, FileBeside, files_beside, stored};
use document::{AssetAlone, GltfDocument};
use locate::byte_of;
use std::path::Path;

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
/// are not applied. Buffers are the binary chunk and base64 data; those in other files are read by [`super::read`], which knows the
/// folder, and refused here with their names; compressed buffers are refused. `path` is used in errors.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the byte; [`crate::Error::TooLarge`] for more vertices than can be numbered.
pub fn parse_glb(bytes: &[u8], path: &str) -> Result<Soup> {
    parse_beside(bytes, path, None)
}

/// [`parse_glb`] for a file in a folder, in which the files of its buffers are.
pub(super) fn parse_beside(bytes: &[u8], path: &str, folder: Option<&Path>) -> Result<Soup> {
    with_file(bytes, path, folder, scene::soup)
}

/// What a function makes of a file: its document, its buffers, and the memory that they may unfold to.
fn with_file<T>(
    bytes: &[u8],
    path: &str,
    folder: Option<&Path>,
    read: impl FnOnce(&GltfFile<'_>, Budget) -> Result<T>,
) -> Result<T> {
    let place = Location::whole(path);
    let bom = b"\xef\xbb\xbf";
    let (json, binary) = if bytes.trim_ascii_start().starts_with(b"{") || bytes.starts_with(bom) {
        (Chunk { start: if bytes.starts_with(bom) { bom.len() } else { 0 }, end: bytes.len() }, None)
    } else {
        chunks(bytes, path)?
    };
    let text = &bytes[json.start..json.end];
    let document = document(text, path, json.start)?;
    if !document.asset.version.starts_with("2.") {
        return place
            .error(format!("this is glTF {}; version 2 is read: export it anew", document.asset.version));
    }
    let known = |name: &str| KNOWN_EXTENSIONS.iter().any(|known| name.starts_with(known));
    if let Some(name) = document.extensions_required.iter().find(|name| !known(name)) {
        return place.error(format!("the file needs the extension {name}; export it without"));
    }
    let beside = files_beside(&document.buffers, folder);
    let mut file =
        GltfFile { document: &document, buffers: Vec::new(), path, json: text, json_start: json.start };
    let refuse = |file: &GltfFile<'_>, i: usize, message: String| {
        file.place_of("buffers", i).error(format!("buffer {i} {message}"))
    };
    let beside = match &beside {
        Ok(files) => files,
        Err((i, message)) => return refuse(&file, *i, message.clone()),
    };
    let sources = BufferSources { file: bytes, binary, beside };
    for (i, buffer) in document.buffers.iter().enumerate() {
        match stored(i, buffer, &sources) {
            Ok(found) => file.buffers.push(found),
            Err(message) => return refuse(&file, i, message),
        }
    }
    let more = beside.iter().map(|FileBeside { bytes, .. }| bytes.len()).sum::<usize>();
    read(&file, Budget::of_size(bytes.len().saturating_add(more)))
}

/// The document of a file, whose text begins at byte `start`.
fn document(text: &[u8], path: &str, start: usize) -> Result<GltfDocument> {
    let error = match serde_json::from_slice(text) {
        Ok(document) => return Ok(document),
        Err(e) => e,
    };
    // A document of version 1 is not one of version 2: its lists are tables.
    if let Ok(AssetAlone { asset }) = serde_json::from_slice(text)
        && asset.is_some_and(|asset| asset.version.is_some_and(|version| version.is_before_2()))
    {
        return Location::whole(path).error(OLD.into());
    }
    let said = error.to_string();
    let said = said.rsplit_once(" at line ").map_or(said.as_str(), |(said, _)| said);
    let said: String = said.chars().take(200).collect();
    Location::byte(path, start + byte_of(text, error.line(), error.column()))
        .error(format!("the JSON of the file is not that of glTF: {said}"))
}

const OLD: &str = "this is glTF 1.0; version 2.0 is read: export it anew, or convert it (gltf-pipeline does)";

/// The JSON and the binary chunk of a GLB file [glTF 2.0, section 4.4].
fn chunks(bytes: &[u8], path: &str) -> Result<(Chunk, Option<Chunk>)> {
    let word =
        |at: usize| bytes.get(at..at + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    let (true, Some(version), Some(length)) = (bytes.starts_with(b"glTF"), word(4), word(8)) else {
        return Location::byte(path, 0)
            .error("this is no GLB file: that begins with `glTF`, its version and its length".into());
    };
    if version != 2 {
        return Location::byte(path, 4).error(format!(
            "this is version {version} of GLB; version 2 is read: export it anew as glTF 2.0"
        ));
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

//! Pictures of textures that are in files of their own beside a document: they move into its binary chunk.

use super::super::scan::Quoted;
use super::buffers::read_beside;
use super::kept_document::KeptDocument;
use std::path::Path;

/// The types of pictures by the bytes with which they begin.
const KINDS: [(&[u8], &str); 3] = [
    (b"\x89PNG\r\n\x1a\n", "image/png"),
    (b"\xff\xd8\xff", "image/jpeg"),
    (b"\xabKTX 20\xbb\r\n\x1a\n", "image/ktx2"),
];

fn kind(bytes: &[u8]) -> Option<&'static str> {
    let is_webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let known = KINDS.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, kind)| *kind);
    known.or(is_webp.then_some("image/webp"))
}

/// Moves the pictures of files into the document; returns what is said of those that stay.
pub(super) fn embed(kept: &mut KeptDocument, folder: Option<&Path>) -> Vec<String> {
    let mut notes = Vec::new();
    let count = kept.document["images"].as_array().map_or(0, Vec::len);
    for k in 0..count {
        let uri = kept.document["images"][k]["uri"].as_str().filter(|uri| !uri.starts_with("data:"));
        let Some(uri) = uri.map(String::from) else { continue };
        let said = match read_beside(&uri, folder) {
            Ok(bytes) => match kind(&bytes) {
                Some(kind) => {
                    kept.picture(k, kind, bytes);
                    continue;
                }
                None => "is of no kind that glTF holds".into(),
            },
            Err(why) => why,
        };
        notes.push(format!("picture {k} stays in its file, {}: {said}", Quoted(&uri)));
    }
    notes
}

//! The two chunks of a GLB file [glTF 2.0, section 4.4].

use crate::error::{Error, Result};
use crate::mesh::io::write_atomically;
use serde_json::Value;
use std::io::Write;
use std::path::Path;

/// The document as text and the binary chunk, each of whole words of 4 bytes.
pub(super) struct GlbChunks {
    json: Vec<u8>,
    binary: Vec<u8>,
}

impl GlbChunks {
    /// The chunks of a document; `binary` has whole words.
    pub fn new(document: &Value, binary: Vec<u8>) -> GlbChunks {
        let mut json = document.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        GlbChunks { json, binary }
    }

    /// Writes the file, atomically.
    pub fn write(&self, path: &Path) -> Result<()> {
        let total = 12 + 8 + self.json.len() + 8 + self.binary.len();
        let Ok(length) = u32::try_from(total) else {
            return Err(Error::TooLarge { what: "bytes of a GLB file", count: total });
        };
        write_atomically(path, |out| {
            out.write_all(b"glTF")?;
            out.write_all(&2u32.to_le_bytes())?;
            out.write_all(&length.to_le_bytes())?;
            for (kind, chunk) in [(b"JSON", &self.json), (b"BIN\0", &self.binary)] {
                out.write_all(&(chunk.len() as u32).to_le_bytes())?;
                out.write_all(kind)?;
                out.write_all(chunk)?;
            }
            Ok(())
        })
    }
}

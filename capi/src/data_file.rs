//! Files of data on surfaces, packed or not: their bytes read, and written whole or not at all.

use crate::arrays::path;
use crate::failure::Outcome;
use crate::memory;
use ricci::mesh::io::{file_bytes, packed_for, write_atomically};
use std::ffi::c_char;
use std::io::Write;
use std::path::Path;

/// Most bytes per byte of a file while it is packed: it and its packed form, which is longer where nothing repeats.
const PACKED: usize = 4;

/// The bytes of a file, unpacked, and its name in messages.
pub(crate) fn read(name: *const c_char) -> Outcome<(Vec<u8>, String)> {
    let path = path(name)?;
    let _reserve = memory::file(&path)?;
    Ok((file_bytes(&path)?, path.display().to_string()))
}

/// Writes bytes whole or not at all; packed where the name says so.
pub(crate) fn write(path: &Path, bytes: Vec<u8>) -> Outcome {
    // Packing takes a third of a megabyte and as much as it packs.
    let _reserve = memory::work(bytes.len(), PACKED)?;
    let bytes = packed_for(path, bytes)?;
    Ok(write_atomically(path, |out| out.write_all(&bytes))?)
}

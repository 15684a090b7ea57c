//! Files that gzip has packed, unpacked and packed.

use super::scan::Location;
use crate::error::Result;
use std::path::Path;

/// The first bytes of every gzip file.
const MAGIC: [u8; 2] = [0x1f, 0x8b];
/// Bytes that any packed file may unfold to, 64 MB, and further ones for each byte of the file. Meshes as text shrink to between a third
/// and a twentieth, where gzip could hold a thousand times its size; the bound is reached before more than it has been allocated.
#[cfg(feature = "gzip")]
const ANY_FILE: usize = 64 << 20;
#[cfg(feature = "gzip")]
const PER_BYTE: usize = 32;

/// True if the name of a file says that gzip packs it: `.gz` at its end.
pub fn is_packed(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"))
}

/// The bytes as gzip packs them, without a time.
///
/// # Errors
/// Those of the system, for lack of memory.
#[cfg(feature = "gzip")]
pub fn packed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    use std::io::Write;
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes)?;
    out.finish()
}

/// The bytes of a file as they were before gzip, if that has packed them.
///
/// # Errors
/// [`crate::Error::Io`]; [`crate::Error::Parse`] for damaged data, and in a build without the cargo feature `gzip` for packed ones.
pub fn file_bytes(path: &Path) -> Result<Vec<u8>> {
    unpacked(super::content::content(path)?, &path.display().to_string())
}

/// Bytes as they stand in a file of this name: packed if it ends in `.gz`.
///
/// # Errors
/// [`crate::Error::UnknownFormat`] in a build without the cargo feature `gzip`; [`crate::Error::Io`] for lack of memory.
pub fn packed_for(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>> {
    if !is_packed(path) {
        return Ok(bytes);
    }
    #[cfg(feature = "gzip")]
    return packed(&bytes)
        .map_err(|e| crate::Error::Io { path: path.display().to_string(), message: e.to_string() });
    #[cfg(not(feature = "gzip"))]
    Err(crate::Error::UnknownFormat {
        path: path.display().to_string(),
        message: ".gz files need the cargo feature `gzip`, without which this library was built".into(),
    })
}

/// The bytes of a file as they were before gzip, which may have packed it in several parts; other files are returned as they are.
///
/// # Errors
/// [`crate::Error::Parse`] for damaged data, for a file that was packed twice, and for one that unfolds to more than its size allows.
pub(super) fn unpacked(bytes: Vec<u8>, path: &str) -> Result<Vec<u8>> {
    if !bytes.starts_with(&MAGIC) {
        return Ok(bytes);
    }
    let out = gunzip(&bytes, path)?;
    if out.starts_with(&MAGIC) {
        return Location::whole(path)
            .error("gzip has packed this file twice; unpack it once with gunzip".into());
    }
    Ok(out)
}

#[cfg(feature = "gzip")]
fn gunzip(bytes: &[u8], path: &str) -> Result<Vec<u8>> {
    use std::io::Read;
    /// Bytes that are unfolded at a time.
    const PART: usize = 1 << 16;
    let place = Location::whole(path);
    let limit = ANY_FILE.saturating_add(PER_BYTE.saturating_mul(bytes.len()));
    let mut reader = flate2::read::MultiGzDecoder::new(bytes);
    let (mut out, mut part) = (Vec::new(), vec![0; PART]);
    loop {
        match reader.read(&mut part) {
            Ok(0) => return Ok(out),
            Ok(n) if n > limit - out.len() => {
                return place.error(format!(
                    "gzip unfolds this file to more than {limit} bytes, the most for its size; unpack it with gunzip"
                ));
            }
            Ok(n) => out.extend_from_slice(&part[..n]),
            Err(e) => {
                return place
                    .error(format!("the gzip data are damaged ({e}); pack the file again, or unpack it"));
            }
        }
    }
}

#[cfg(not(feature = "gzip"))]
fn gunzip(_: &[u8], path: &str) -> Result<Vec<u8>> {
    Location::whole(path).error(
        "the file is packed by gzip: that needs the cargo feature `gzip`, without which this library was built".into(),
    )
}

#[cfg(feature = "gzip")]
#[cfg(test)]
mod tests {
    use super::*;
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write;

    fn best(bytes: &[u8]) -> Vec<u8> {
        let mut out = GzEncoder::new(Vec::new(), Compression::best());
        out.write_all(bytes).and_then(|()| out.finish()).unwrap_or_default()
    }

    #[test]
    fn parts_are_joined_and_damage_is_told() {
        let message = |bytes: Vec<u8>| unpacked(bytes, "m.gz").unwrap_err().to_string();
        assert_eq!(unpacked(b"plain".to_vec(), "m").ok().as_deref(), Some(&b"plain"[..]));
        let two = [best(b"one "), best(b"two")].concat();
        assert_eq!(unpacked(two.clone(), "m.gz").ok().as_deref(), Some(&b"one two"[..]));
        assert!(message(two[..two.len() - 9].to_vec()).contains("the gzip data are damaged"));
        assert!(message(best(&best(b"x"))).contains("packed this file twice"));
    }

    /// 80 MB of zeros take 80 kB, from which 67 MB may unfold.
    #[test]
    fn a_file_that_unfolds_to_a_thousand_times_its_size_is_refused() {
        let bomb = best(&vec![0; 80 << 20]);
        assert!(bomb.len() < 1 << 20);
        let error = unpacked(bomb, "bomb.gz").unwrap_err().to_string();
        assert!(error.contains("the most for its size"), "{error}");
    }
}

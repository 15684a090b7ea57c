//! The bytes of a file.

use crate::error::{Error, Result};
use crate::parallel;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Bytes that a thread reads at a time: about 1 ms, most of which goes to memory that is touched for the first time.
const PART: usize = 1 << 20;

/// All bytes of a file. Inside a pool parts of a large one are read side by side.
///
/// # Errors
/// [`Error::Io`].
pub(super) fn content(path: &Path) -> Result<Vec<u8>> {
    let length = fs::metadata(path).ok().filter(|found| found.is_file()).map(|found| found.len());
    let large = length.and_then(|n| usize::try_from(n).ok()).filter(|&n| n > 2 * PART && is_room_for(n));
    let bytes = match large {
        // What has become shorter meanwhile is read as it is now.
        Some(n) => in_parts(path, n).or_else(|_| fs::read(path)),
        None => fs::read(path),
    };
    bytes.map_err(|e| Error::Io { path: path.display().to_string(), message: e.to_string() })
}

/// Whether there is memory for so many bytes, which would be missed as an error if they were asked for at once.
fn is_room_for(bytes: usize) -> bool {
    Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
}

/// The first bytes of a file that has as many.
fn in_parts(path: &Path, length: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; length];
    let failed = Mutex::new(None);
    let parts = bytes.chunks_mut(PART).enumerate().collect();
    parallel::each(parts, |(k, part): (usize, &mut [u8])| {
        if let Err(error) = read_part(path, (k * PART) as u64, part) {
            *failed.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        }
    });
    failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(bytes), Err)
}

fn read_part(path: &Path, start: u64, part: &mut [u8]) -> io::Result<()> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(start))?;
    file.read_exact(part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Pool;

    #[test]
    fn parts_are_the_whole_for_any_number_of_threads() {
        let directory = tempfile::tempdir().unwrap();
        for length in [0, 5, 2 * PART, 2 * PART + 1, 3 * PART + 17] {
            let path = directory.path().join("bytes");
            let written: Vec<u8> = (0..length).map(|k| (k % 251) as u8).collect();
            fs::write(&path, &written).unwrap();
            for threads in [1, 2, 8] {
                assert!(
                    Pool::new(threads).unwrap().run(|| content(&path)).unwrap() == written,
                    "{length} {threads}"
                );
            }
            assert!(in_parts(&path, length + 1).is_err());
        }
        assert!(matches!(content(&directory.path().join("missing")), Err(Error::Io { .. })));
    }
}

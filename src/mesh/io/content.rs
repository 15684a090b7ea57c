//! Reading the bytes of a file, by several threads where it is large.

use crate::error::{Error, Result};
use std::fs;
use std::path::Path;

/// All bytes of a file. Inside a pool, parts of a large one are read in parallel, if the system can read a file from a given position.
///
/// # Errors
/// [`Error::Io`].
pub(super) fn content(path: &Path) -> Result<Vec<u8>> {
    #[cfg(unix)]
    if let Some(bytes) = parts::content(path) {
        return Ok(bytes);
    }
    fs::read(path).map_err(|e| Error::Io { path: path.display().to_string(), message: e.to_string() })
}

#[cfg(unix)]
mod parts {
    use crate::parallel::{each, is_room_for, is_shared};
    use std::fs::File;
    use std::io;
    use std::os::unix::fs::FileExt;
    use std::path::Path;
    use std::sync::{Mutex, PoisonError};

    /// Bytes that a thread reads at a time: about 1 ms, most of it for memory that is touched for the first time.
    pub const PART: usize = 1 << 20;

    /// The bytes of a large file. `None` for others, and where the file has to be read by one thread: without a pool, with too little
    /// memory, and if its length changes meanwhile.
    pub fn content(path: &Path) -> Option<Vec<u8>> {
        if !is_shared() {
            return None;
        }
        let file = File::open(path).ok()?;
        let length = || file.metadata().ok().filter(|found| found.is_file()).map(|found| found.len());
        let before = length()?;
        let n = usize::try_from(before).ok().filter(|&n| n > 2 * PART && is_room_for(n))?;
        let bytes = first_bytes(&file, n).ok()?;
        (length()? == before).then_some(bytes)
    }

    /// The first n bytes of a file, which has as many.
    pub fn first_bytes(file: &File, n: usize) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; n];
        let failed = Mutex::new(None);
        let parts = bytes.chunks_mut(PART).enumerate().collect();
        each(parts, |(k, part): (usize, &mut [u8])| {
            if let Err(error) = file.read_exact_at(part, (k * PART) as u64) {
                *failed.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            }
        });
        failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(bytes), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Pool;

    #[cfg(unix)]
    #[test]
    fn parts_are_the_whole_for_any_number_of_threads() {
        use super::parts::{PART, first_bytes};
        let directory = tempfile::tempdir().unwrap();
        for length in [0, 5, 2 * PART, 2 * PART + 1, 3 * PART + 17] {
            let path = directory.path().join("bytes");
            let written: Vec<u8> = (0..length).map(|k| (k % 251) as u8).collect();
            fs::write(&path, &written).unwrap();
            for threads in [1, 2, 8] {
                let read = Pool::new(threads).unwrap().run(|| content(&path)).unwrap();
                assert!(read == written, "{length} {threads}");
            }
            assert!(first_bytes(&fs::File::open(&path).unwrap(), length + 1).is_err());
        }
        assert!(matches!(content(&directory.path().join("missing")), Err(Error::Io { .. })));
    }

    /// A length for which memory does not suffice is an error, as when the file is read by one thread.
    #[test]
    fn a_file_that_is_longer_than_memory_is_an_error() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("sparse");
        let file = fs::File::create(&path).unwrap();
        // Some file systems have no files of this length: then there is nothing to read.
        if file.set_len(1 << 46).is_ok() {
            let read = Pool::new(2).unwrap().run(|| content(&path));
            assert!(matches!(read, Err(Error::Io { .. })));
        }
    }
}

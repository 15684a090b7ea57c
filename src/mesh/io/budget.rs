//! How much a file may unfold to. Compression, instances and polygons are the ways in which a small file becomes a large mesh.

use super::scan::Location;
use crate::error::Result;

/// Bytes that any file may unfold to, and more for each of its own: honest files need less, and a reader that stays within them
/// takes at most 64 MB + 20 times its file, scratch included.
const ANY_FILE: usize = 32 << 20;
const PER_BYTE: usize = 8;

/// What is left of the bytes that a reader may hold for one file.
#[derive(Default)]
pub(super) struct Budget {
    left: usize,
}

impl Budget {
    pub fn of(file: &[u8]) -> Budget {
        Budget { left: ANY_FILE.saturating_add(PER_BYTE.saturating_mul(file.len())) }
    }

    /// Account for `count` items of `size` bytes, before they are allocated.
    pub fn take(&mut self, count: usize, size: usize, what: &str, place: Location<'_>) -> Result<()> {
        match count.checked_mul(size).and_then(|bytes| self.left.checked_sub(bytes)) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => place.error(format!(
                "{count} entries of {what} are more than a file of this size may unfold to; store them plainly, or in parts"
            )),
        }
    }
}

//! A bound on the memory that reading a file takes. Without it, compression, instances and polygons could turn a small file into a mesh
//! of any size.

use super::scan::Location;
use crate::error::Result;

/// Bytes of memory that the data of any file may take, 32 MB. With [`PER_BYTE`] more for each byte of the file, real files stay below the
/// bound, and a reader takes at most 64 MB and 20 times its file, temporary memory included.
const ANY_FILE: usize = 32 << 20;
/// Further bytes for each byte of the file.
const PER_BYTE: usize = 8;

/// The number of bytes that a reader may still allocate for one file.
#[derive(Default)]
pub(super) struct Budget {
    left: usize,
}

impl Budget {
    pub fn of(file: &[u8]) -> Budget {
        Budget::of_size(file.len())
    }

    /// The budget of so many bytes, those of a file and of others that belong to it.
    pub fn of_size(bytes: usize) -> Budget {
        Budget { left: ANY_FILE.saturating_add(PER_BYTE.saturating_mul(bytes)) }
    }

    /// Subtracts `count` items of `size` bytes, before they are allocated.
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

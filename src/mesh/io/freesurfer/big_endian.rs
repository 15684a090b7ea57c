//! Words of big-endian files, with errors that say at which byte something is wrong.

use crate::error::{Error, Result};
use crate::mesh::io::scan::Location;

/// A file from byte `at` on.
pub(super) struct BigEndianWords<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub path: &'a str,
}

impl<'a> BigEndianWords<'a> {
    pub fn new(bytes: &'a [u8], path: &'a str) -> BigEndianWords<'a> {
        BigEndianWords { bytes, at: 0, path }
    }

    /// The place of the next byte.
    pub fn place(&self) -> Location<'a> {
        Location::byte(self.path, self.at)
    }

    /// The next `N` bytes.
    pub fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let Some(&found) = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<N>) else {
            return Location::byte(self.path, self.bytes.len()).error(format!("the file ends in {what}"));
        };
        self.at += N;
        Ok(found)
    }

    pub fn integer(&mut self, what: &str) -> Result<i32> {
        self.array(what).map(i32::from_be_bytes)
    }

    /// An integer of three bytes.
    pub fn small(&mut self, what: &str) -> Result<u32> {
        let [a, b, c] = self.array(what)?;
        Ok(u32::from_be_bytes([0, a, b, c]))
    }

    pub fn real(&mut self, what: &str) -> Result<f64> {
        self.array(what).map(|word| f64::from(f32::from_be_bytes(word)))
    }

    pub fn point(&mut self, what: &str) -> Result<[f64; 3]> {
        Ok([self.real(what)?, self.real(what)?, self.real(what)?])
    }

    /// A number that is not negative.
    pub fn count(&mut self, what: &str) -> Result<usize> {
        let place = self.place();
        let number = self.integer(what)?;
        usize::try_from(number).or_else(|_| place.error(format!("{what} is {number}: it cannot be negative")))
    }

    /// Checks that the file has so many more entries of so many bytes: memory is asked for only then.
    pub fn holds(&self, count: usize, size: usize, what: &str) -> Result<()> {
        let left = self.bytes.len() - self.at;
        if count.checked_mul(size).is_some_and(|bytes| bytes <= left) {
            return Ok(());
        }
        let message = format!("{left} bytes follow, too few for {count} {what} of {size} bytes each");
        self.place().error(message)
    }

    /// A text of so many bytes, to its first 0.
    pub fn text(&mut self, length: usize, what: &str) -> Result<String> {
        self.holds(length, 1, what)?;
        let text = &self.bytes[self.at..self.at + length];
        self.at += length;
        let end = text.iter().position(|&b| b == 0).unwrap_or(length);
        Ok(String::from_utf8_lossy(&text[..end]).into_owned())
    }
}

/// A count as files of FreeSurfer have it.
///
/// # Errors
/// [`Error::TooLarge`].
pub(super) fn signed(count: usize, what: &'static str) -> Result<[u8; 4]> {
    let number = i32::try_from(count).map_err(|_| Error::TooLarge { what, count })?;
    Ok(number.to_be_bytes())
}

/// A number as files of FreeSurfer have it: rounded to 24 bits.
///
/// # Errors
/// [`Error::Argument`] for one that is not finite, or not in the range of single precision.
pub(super) fn single(x: f64, what: &'static str) -> Result<[u8; 4]> {
    let rounded = x as f32;
    if rounded.is_finite() {
        return Ok(rounded.to_be_bytes());
    }
    Err(Error::argument(what, x, "a finite number in the range of single precision"))
}

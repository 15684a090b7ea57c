//! Numbers, flags and texts in archives.

use super::content::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::Result;

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Stored for $number {
            const LEAST: usize = size_of::<$number>();

            #[inline]
            fn write(&self, to: &mut ArchiveWriter) {
                to.raw(&self.to_le_bytes());
            }

            #[inline]
            fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
                let mut bytes = [0; size_of::<$number>()];
                bytes.copy_from_slice(from.raw(size_of::<$number>())?);
                Ok(<$number>::from_le_bytes(bytes))
            }
        }
    )*};
}
numbers!(u8, i8, u32, i32, u64, i64, f64);

impl Stored for usize {
    const LEAST: usize = 8;

    fn write(&self, to: &mut ArchiveWriter) {
        (*self as u64).write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        let number = u64::read(from)?;
        usize::try_from(number).map_err(|_| from.wrong(format!("{number} is too large for this machine")))
    }
}

impl Stored for bool {
    const LEAST: usize = 1;

    fn write(&self, to: &mut ArchiveWriter) {
        u8::from(*self).write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        match u8::read(from)? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(from.wrong(format!("{other} is neither true nor false"))),
        }
    }
}

impl Stored for String {
    const LEAST: usize = 8;

    fn write(&self, to: &mut ArchiveWriter) {
        self.len().write(to);
        to.raw(self.as_bytes());
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        let length = from.count(1)?;
        let bytes = from.raw(length)?;
        String::from_utf8(bytes.to_vec()).map_err(|_| from.wrong("a text is not UTF-8"))
    }
}

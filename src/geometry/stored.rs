//! Numbers in double-double precision and motions in archives.

use super::double_double::DoubleDouble;
use super::motion::Motion;
use super::space::Space;
use crate::archive::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::Result;

impl Stored for DoubleDouble {
    const LEAST: usize = 16;

    fn write(&self, to: &mut ArchiveWriter) {
        [self.high, self.low].write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok(DoubleDouble { high: f64::read(from)?, low: f64::read(from)? })
    }
}

impl<T: Stored> Stored for Motion<T> {
    const LEAST: usize = 1 + 4 * T::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        self.space.write(to);
        self.a.write(to);
        self.b.write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok(Motion { space: Space::read(from)?, a: Stored::read(from)?, b: Stored::read(from)? })
    }
}

//! Lists, pairs, options and shared objects in archives.

use super::content::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::Result;
use num_complex::Complex64;
use std::sync::Arc;

impl<T: Stored> Stored for Vec<T> {
    const LEAST: usize = 8;

    fn write(&self, to: &mut ArchiveWriter) {
        self.len().write(to);
        to.reserve(self.len() * T::LEAST);
        self.iter().for_each(|value| value.write(to));
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        let count = from.count(T::LEAST)?;
        (0..count).map(|_| T::read(from)).collect()
    }
}

impl<T: Stored, const N: usize> Stored for [T; N] {
    const LEAST: usize = N * T::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        self.iter().for_each(|value| value.write(to));
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        let values: Vec<T> = (0..N).map(|_| T::read(from)).collect::<Result<_>>()?;
        values.try_into().map_err(|_| from.wrong("a row of another length"))
    }
}

impl<T: Stored> Stored for Option<T> {
    const LEAST: usize = 1;

    fn write(&self, to: &mut ArchiveWriter) {
        self.is_some().write(to);
        if let Some(value) = self {
            value.write(to);
        }
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        if bool::read(from)? { T::read(from).map(Some) } else { Ok(None) }
    }
}

impl<T: Stored> Stored for Box<T> {
    const LEAST: usize = T::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        T::write(self, to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        T::read(from).map(Box::new)
    }
}

impl<T: Stored + Send + Sync + 'static> Stored for Arc<T> {
    const LEAST: usize = 4;

    fn write(&self, to: &mut ArchiveWriter) {
        to.shared(self);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        from.shared()
    }
}

impl<A: Stored, B: Stored> Stored for (A, B) {
    const LEAST: usize = A::LEAST + B::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        self.0.write(to);
        self.1.write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok((A::read(from)?, B::read(from)?))
    }
}

impl Stored for Complex64 {
    const LEAST: usize = 16;

    fn write(&self, to: &mut ArchiveWriter) {
        [self.re, self.im].write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok(Complex64 { re: f64::read(from)?, im: f64::read(from)? })
    }
}

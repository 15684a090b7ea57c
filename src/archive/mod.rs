//! Results as bytes and files that read back bit for bit: one format for every kind of result.
//!
//! An archive starts with a magic number, the version of the format, the name of what it holds, the number of bytes of its content, and a checksum of
//! the content. The content is a row of sections, each with its name and its number of bytes, and sections may hold sections. All numbers are
//! little-endian, doubles are kept with every bit, and an object that several parts share is written once. What depends on the run alone, its seconds and
//! its number of threads, is not kept: equal results are equal bytes.
//!
//! ```
//! use ricci::{Class, Solution, Surface, archive, geometry::Space, mesh::shapes, records::MetricRecord};
//! # fn main() -> ricci::Result<()> {
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let metric = MetricRecord::from(Solution::initial_of(torus, Class::yamabe(Space::E2))?);
//! let bytes = archive::to_bytes(&metric);
//! let again: MetricRecord = archive::from_bytes(&bytes)?;
//! assert_eq!(again.solution.metric(), metric.solution.metric());
//! assert_eq!(archive::to_bytes(&again), bytes);
//! assert!(archive::from_bytes::<MetricRecord>(&bytes[..100]).is_err());
//! # Ok(())
//! # }
//! ```

mod atomic;
mod checksum;
mod collections;
mod content;
mod frame;
mod numbers;
mod stored;

pub use atomic::{destination, write_atomically};
pub use content::{ArchiveReader, ArchiveWriter, Stored};
pub use frame::{ArchiveFrame, FORMAT, Kept, framed, from_bytes, kind_of, load, save, to_bytes};
pub(crate) use stored::stored;
pub use stored::{in_range, invalid};

#[cfg(test)]
#[path = "archive_tests.rs"]
mod tests;

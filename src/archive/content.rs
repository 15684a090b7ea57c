//! The content of an archive: what can stand in it, its writer, and its reader. What is read may come from anywhere: every count is compared with the
//! bytes that are left.

use super::checksum::checksum;
use crate::error::{Error, FilePosition, Result};
use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::sync::Arc;

/// A type whose values can be written to an archive and read from it, bit for bit.
pub trait Stored: Sized {
    /// Least number of bytes that a value takes; a list with a count that its bytes cannot hold is refused before any memory is taken.
    const LEAST: usize;

    /// Appends the value.
    fn write(&self, to: &mut ArchiveWriter);

    /// The value that comes next.
    ///
    /// # Errors
    /// [`Error::Parse`] where the bytes are no such value.
    fn read(from: &mut ArchiveReader<'_>) -> Result<Self>;
}

/// The content of an archive that is being written.
#[derive(Debug, Default)]
pub struct ArchiveWriter {
    pub(super) bytes: Vec<u8>,
    /// The numbers of the shared objects that were written, by address and type.
    shared: HashMap<(usize, TypeId), u32>,
}

impl ArchiveWriter {
    /// A number by which what was written so far is told from other contents.
    pub fn fingerprint(&self) -> u64 {
        checksum(&self.bytes)
    }

    /// Appends bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Makes room for a list.
    pub(super) fn reserve(&mut self, bytes: usize) {
        self.bytes.reserve(bytes);
    }

    /// Appends a section: the length of its name, its name, its number of bytes, its content.
    pub fn section<T: Stored>(&mut self, name: &'static str, value: &T) {
        self.raw(&[name.len() as u8]);
        self.raw(name.as_bytes());
        let at = self.bytes.len();
        self.raw(&[0; 8]);
        value.write(self);
        let length = (self.bytes.len() - at - 8) as u64;
        self.bytes[at..at + 8].copy_from_slice(&length.to_le_bytes());
    }

    /// Appends the number of a shared object, and the object where its number comes for the first time.
    pub(super) fn shared<T: Stored + 'static>(&mut self, object: &Arc<T>) {
        let next = self.shared.len() as u32;
        let key = (Arc::as_ptr(object) as usize, TypeId::of::<T>());
        let number = *self.shared.entry(key).or_insert(next);
        number.write(self);
        if number == next {
            T::write(object, self);
        }
    }
}

/// The content of an archive that is being read.
pub struct ArchiveReader<'a> {
    bytes: &'a [u8],
    /// The position of the content in its file.
    start: usize,
    at: usize,
    /// The end of the section that is being read.
    end: usize,
    /// The name of the file, for errors.
    path: &'a str,
    /// The shared objects by their numbers; none for one whose content is being read.
    shared: Vec<Option<Arc<dyn Any + Send + Sync>>>,
}

impl<'a> ArchiveReader<'a> {
    /// Reads a content that starts at this byte of its file.
    pub(super) fn new(bytes: &'a [u8], start: usize, path: &'a str) -> ArchiveReader<'a> {
        ArchiveReader { bytes, start, at: 0, end: bytes.len(), path, shared: Vec::new() }
    }

    /// The error that the content is wrong at this place.
    pub fn wrong(&self, message: impl Into<String>) -> Error {
        let at = FilePosition::Byte(self.start + self.at);
        Error::Parse { path: self.path.into(), at, message: message.into() }
    }

    /// The outcome of the check of a value that was read, as an error of the file.
    ///
    /// # Errors
    /// [`Error::Parse`] if the check failed.
    pub fn checked(&self, outcome: Result<()>) -> Result<()> {
        outcome.map_err(|error| self.wrong(format!("no such result can be: {error}")))
    }

    /// The number of bytes that are left in this section.
    pub fn left(&self) -> usize {
        self.end - self.at
    }

    /// The next bytes as they are.
    ///
    /// # Errors
    /// [`Error::Parse`] if fewer are left.
    pub fn raw(&mut self, length: usize) -> Result<&'a [u8]> {
        if length > self.left() {
            return Err(self.wrong(format!("{length} bytes are needed, {} are left", self.left())));
        }
        let taken = &self.bytes[self.at..self.at + length];
        self.at += length;
        Ok(taken)
    }

    /// The next number of elements that take at least this many bytes each.
    ///
    /// # Errors
    /// [`Error::Parse`] if fewer bytes are left.
    pub(super) fn count(&mut self, least: usize) -> Result<usize> {
        let count = u64::read(self)?;
        match usize::try_from(count) {
            Ok(n) if n.checked_mul(least.max(1)).is_some_and(|bytes| bytes <= self.left()) => Ok(n),
            _ => Err(self
                .wrong(format!("{count} elements do not fit into the {} bytes that are left", self.left()))),
        }
    }

    /// The content of the next section, which must have this name.
    ///
    /// # Errors
    /// [`Error::Parse`] if it has another one, or another length than it says.
    pub fn section<T: Stored>(&mut self, name: &'static str) -> Result<T> {
        let length = usize::from(self.raw(1)?[0]);
        let found = self.raw(length)?;
        if found != name.as_bytes() {
            let found = String::from_utf8_lossy(found).into_owned();
            return Err(
                self.wrong(format!("section `{name}` is needed here, not `{}`", found.escape_default()))
            );
        }
        let length = self.count(1)?;
        let outer = std::mem::replace(&mut self.end, self.at + length);
        let value = T::read(self)?;
        if self.at != self.end {
            return Err(self.wrong(format!("section `{name}` has {} bytes too many", self.left())));
        }
        self.end = outer;
        Ok(value)
    }

    /// The name of the next section, which stays unread.
    ///
    /// # Errors
    /// [`Error::Parse`] if there is none.
    pub fn next_section(&mut self) -> Result<&'a [u8]> {
        let before = self.at;
        let length = usize::from(self.raw(1)?[0]);
        let name = self.raw(length)?;
        self.at = before;
        Ok(name)
    }

    /// The next shared object.
    pub(super) fn shared<T: Stored + Send + Sync + 'static>(&mut self) -> Result<Arc<T>> {
        let number = u32::read(self)? as usize;
        if number == self.shared.len() {
            self.shared.push(None);
            let object = Arc::new(T::read(self)?);
            self.shared[number] = Some(object.clone());
            return Ok(object);
        }
        let known = self.shared.get(number).cloned().flatten();
        known
            .and_then(|object| object.downcast().ok())
            .ok_or_else(|| self.wrong(format!("shared object {number} is no such object")))
    }
}

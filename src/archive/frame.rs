//! The frame of an archive: what stands before its content, and whole archives in memory and in files.

use super::atomic::write_atomically;
use super::checksum::checksum;
use super::content::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::{Error, FilePosition, Result};
use std::io::Write;
use std::path::Path;

/// The version of the format. It grows when a part of any kind is added, removed or changed; a library reads its own version alone.
pub const FORMAT: u32 = 1;
/// The first bytes of every archive: a name, and line ends that a transfer as text would change.
const MAGIC: [u8; 12] = *b"ricci\0\r\n\x1a\nAR";
/// Bytes before the content: magic number, version, the name of the kind (filled up with zeros), length and checksum of the content.
const HEAD: usize = MAGIC.len() + 4 + KIND_NAME + 16;
/// Most bytes of the name of a kind.
const KIND_NAME: usize = 24;
/// The name of an archive in memory, for errors.
const IN_MEMORY: &str = "archive";

/// What an archive can hold as its whole content.
pub trait Kept: Stored {
    /// The name of the kind in the file, at most 24 letters.
    const KIND: &'static str;
}

/// What stands before the content of an archive, and the content.
pub struct ArchiveFrame<'a> {
    /// The name of what it holds.
    pub kind: &'a str,
    content: &'a [u8],
    path: &'a str,
}

impl<'a> ArchiveFrame<'a> {
    /// The frame of these bytes, whose file has the name `path`.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`] for another format, or another version of it; [`Error::Parse`] for an archive that is cut off or damaged.
    pub fn open(bytes: &'a [u8], path: &'a str) -> Result<ArchiveFrame<'a>> {
        let wrong = |at: usize, message: &str| {
            Err(Error::Parse { path: path.into(), at: FilePosition::Byte(at), message: message.into() })
        };
        let foreign = |message: String| Err(Error::UnknownFormat { path: path.into(), message });
        if !bytes.starts_with(&MAGIC) {
            return match MAGIC.starts_with(bytes) {
                true => wrong(bytes.len(), "the archive is cut off"),
                false => foreign("no archive of this library: its first bytes are others".into()),
            };
        }
        if bytes.len() < HEAD {
            return wrong(bytes.len(), "the archive is cut off");
        }
        let mut head = ArchiveReader::new(&bytes[MAGIC.len()..HEAD], MAGIC.len(), path);
        let version = u32::read(&mut head)?;
        if version != FORMAT {
            return foreign(format!("an archive of format {version}; this library reads format {FORMAT}"));
        }
        let name = head.raw(KIND_NAME)?;
        let name = &name[..name.iter().position(|&byte| byte == 0).unwrap_or(KIND_NAME)];
        let (length, sum) = (u64::read(&mut head)?, u64::read(&mut head)?);
        let content = &bytes[HEAD..];
        if (content.len() as u64) < length {
            return wrong(bytes.len(), "the archive is cut off");
        }
        if content.len() as u64 != length || checksum(content) != sum {
            return wrong(HEAD, "the archive is damaged: its checksum is another one");
        }
        let Ok(kind) = std::str::from_utf8(name) else {
            return wrong(MAGIC.len() + 4, "the name of its kind is no text");
        };
        Ok(ArchiveFrame { kind, content, path })
    }

    /// The object in it.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`] if it holds one of another kind, [`Error::Parse`] if the content is not what the format says.
    pub fn object<T: Kept>(&self) -> Result<T> {
        if self.kind != T::KIND {
            let message = format!("holds a {}, not a {}", self.kind.escape_default(), T::KIND);
            return Err(Error::UnknownFormat { path: self.path.into(), message });
        }
        let mut reader = ArchiveReader::new(self.content, HEAD, self.path);
        let value = T::read(&mut reader)?;
        if reader.left() > 0 { Err(reader.wrong("the content goes on after its end")) } else { Ok(value) }
    }
}

/// An object as an archive in memory.
pub fn to_bytes<T: Kept>(object: &T) -> Vec<u8> {
    framed(T::KIND, |writer| object.write(writer))
}

/// An archive of a kind, whose content a function writes.
pub fn framed(kind: &str, content: impl FnOnce(&mut ArchiveWriter)) -> Vec<u8> {
    let mut writer = ArchiveWriter::default();
    writer.raw(&MAGIC);
    FORMAT.write(&mut writer);
    let mut name = [0; KIND_NAME];
    name.iter_mut().zip(kind.bytes()).for_each(|(place, byte)| *place = byte);
    writer.raw(&name);
    writer.raw(&[0; 16]);
    content(&mut writer);
    let mut bytes = writer.bytes;
    let (length, sum) = ((bytes.len() - HEAD) as u64, checksum(&bytes[HEAD..]));
    bytes[HEAD - 16..HEAD - 8].copy_from_slice(&length.to_le_bytes());
    bytes[HEAD - 8..HEAD].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// The object of an archive in memory.
///
/// # Errors
/// Those of [`ArchiveFrame::open`] and [`ArchiveFrame::object`].
pub fn from_bytes<T: Kept>(bytes: &[u8]) -> Result<T> {
    ArchiveFrame::open(bytes, IN_MEMORY)?.object()
}

/// The name of what an archive in memory holds.
///
/// # Errors
/// Those of [`ArchiveFrame::open`].
pub fn kind_of(bytes: &[u8]) -> Result<&str> {
    ArchiveFrame::open(bytes, IN_MEMORY).map(|frame| frame.kind)
}

/// Write an object as a file, whole or not at all.
///
/// # Errors
/// [`Error::Io`].
pub fn save<T: Kept>(object: &T, path: &Path) -> Result<()> {
    let bytes = to_bytes(object);
    write_atomically(path, |out| out.write_all(&bytes))
}

/// The object of a file.
///
/// # Errors
/// [`Error::Io`]; those of [`ArchiveFrame::open`] and [`ArchiveFrame::object`].
pub fn load<T: Kept>(path: &Path) -> Result<T> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| Error::Io { path: name.clone(), message: e.to_string() })?;
    ArchiveFrame::open(&bytes, &name)?.object()
}

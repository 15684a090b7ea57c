//! The buffers of a glTF file: its binary chunk, base64 data inside its text, and files beside it.

use super::super::base64;
use super::super::scan::Quoted;
use super::accessor::StoredBytes;
use super::document::Buffer;
use std::borrow::Cow;
use std::path::{Component, Path};

/// A range of bytes of the file.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub start: usize,
    pub end: usize,
}

/// The bytes that buffers may be made of.
pub(super) struct BufferSources<'a> {
    pub file: &'a [u8],
    pub binary: Option<Chunk>,
    /// The files beside this one that its buffers name, each once.
    pub beside: &'a [FileBeside],
}

/// A file that a buffer names, and its bytes.
pub(super) struct FileBeside {
    uri: String,
    pub bytes: Vec<u8>,
}

/// The files that buffers name, read from the folder of the document. The error is the number of the buffer and a message.
pub(super) fn files_beside(
    buffers: &[Buffer],
    folder: Option<&Path>,
) -> Result<Vec<FileBeside>, (usize, String)> {
    let mut files: Vec<FileBeside> = Vec::new();
    for (i, buffer) in buffers.iter().enumerate() {
        let Some(uri) = buffer.uri.as_deref().filter(|uri| !uri.starts_with("data:")) else { continue };
        if !files.iter().any(|file| file.uri == uri) {
            let bytes = read_beside(uri, folder).map_err(|message| (i, message))?;
            files.push(FileBeside { uri: uri.into(), bytes });
        }
    }
    Ok(files)
}

/// The bytes of a file with a name relative to a folder. Names that lead out of the folder are refused: a mesh from elsewhere must not
/// say which files of this machine are read.
pub(super) fn read_beside(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, String> {
    let Some(folder) = folder else {
        return Err(format!(
            "is in another file, {}, beside the document; give that by name, or export it as a single .glb file",
            Quoted(uri)
        ));
    };
    let name = unescaped(uri);
    let inside =
        Path::new(&name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !inside || name.is_empty() || name.contains("://") {
        return Err(format!(
            "is in {}, which is not in the folder of the document; export it as a single .glb file",
            Quoted(uri)
        ));
    }
    let path = folder.join(&name);
    let failed = |why: String| format!("is in another file, {}: {why}", Quoted(&path.display().to_string()));
    match std::fs::metadata(&path) {
        Ok(found) if found.is_file() => std::fs::read(&path).map_err(|e| failed(e.to_string())),
        Ok(_) => Err(failed("it is no regular file".into())),
        Err(e) => Err(failed(e.to_string())),
    }
}

/// A URI with its escapes (`%20`) as the bytes that they stand for.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let digits = after.get(..2).and_then(|pair| std::str::from_utf8(pair).ok());
        let escaped = digits.filter(|_| *first == b'%').and_then(|pair| u8::from_str_radix(pair, 16).ok());
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The bytes of buffer `i`; the error is a message.
pub(super) fn stored<'a>(
    i: usize,
    buffer: &Buffer,
    sources: &BufferSources<'a>,
) -> Result<StoredBytes<'a>, String> {
    let stored = match (&buffer.uri, sources.binary) {
        (Some(uri), _) => match uri.strip_prefix("data:").map(|data| data.split_once(";base64,")) {
            Some(Some((_, text))) => {
                let bytes =
                    base64::decode(text.as_bytes()).map_err(|message| format!("is damaged: {message}"))?;
                StoredBytes { bytes: Cow::Owned(bytes), start: None }
            }
            Some(None) => return Err("is damaged: its data are not in base64".into()),
            None => {
                let file = sources.beside.iter().find(|file| file.uri == *uri);
                let bytes = file.map_or(&[][..], |file| &file.bytes);
                StoredBytes { bytes: Cow::Borrowed(bytes), start: None }
            }
        },
        (None, Some(Chunk { start, end })) if i == 0 => {
            StoredBytes { bytes: Cow::Borrowed(&sources.file[start..end]), start: Some(start) }
        }
        (None, _) => return Err("has no data in the file".into()),
    };
    if stored.bytes.len() < buffer.byte_length {
        return Err(format!("has {} bytes, {} are promised", stored.bytes.len(), buffer.byte_length));
    }
    Ok(stored)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a b.bin"), b"12").unwrap();
        let read = |uri: &str| read_beside(uri, Some(folder.path()));
        assert_eq!(read("a%20b.bin"), Ok(b"12".to_vec()));
        assert_eq!(read("./a b.bin"), Ok(b"12".to_vec()));
        for uri in ["../x.bin", "/etc/hostname", "a/../../x", "https://host/x.bin", ""] {
            assert!(read(uri).unwrap_err().contains("not in the folder"), "{uri}");
        }
        assert!(read("missing.bin").unwrap_err().contains("missing.bin"));
        assert!(read(".").unwrap_err().contains("no regular file"));
        assert!(read_beside("a b.bin", None).unwrap_err().contains("give that by name"));
    }
}

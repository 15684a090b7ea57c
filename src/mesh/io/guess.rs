//! Recognition of a surface's file by its first bytes, with the same rules whether it comes by name or on stdin, and names for files that
//! hold no surface.

use super::off::split_header;
use super::scan::{BYTE_ORDER_MARK, Location};
use super::stl::{announces_its_size, is_text};
use super::{freesurfer, mz3};
use crate::error::Result;

/// The format of a file that holds a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceFormat {
    /// Wavefront OBJ, which has no mark of its own.
    Obj,
    /// OFF, text or binary.
    Off,
    /// PLY, text or binary.
    Ply,
    /// STL, text or binary.
    Stl,
    /// glTF, text or binary.
    Gltf,
    /// GIFTI.
    Gifti,
    /// VTK, legacy.
    Vtk,
    /// VTK in XML.
    Vtp,
    /// MZ3.
    Mz3,
    /// A surface of FreeSurfer, binary or text.
    FreeSurfer,
    /// The JSON of an intrinsic metric: lengths without positions.
    Metric,
}

/// The format of these bytes: by a mark at their beginning, else that which the file's name says (`named`), else by looks.
///
/// # Errors
/// [`crate::Error::Parse`] that names what the file is, where that is no surface.
pub(super) fn format(bytes: &[u8], named: Option<SurfaceFormat>, path: &str) -> Result<SurfaceFormat> {
    let text = bytes.strip_prefix(BOM.as_bytes()).unwrap_or(bytes).trim_ascii_start();
    if let Some(format) = marked(bytes, text) {
        return Ok(format);
    }
    if let Some(what) = stranger(bytes, text) {
        return Location::whole(path).error(what);
    }
    Ok(named.unwrap_or_else(|| match first_word(text) {
        [b'0'..=b'9', ..] => SurfaceFormat::Off,
        _ if !is_text(bytes) => SurfaceFormat::Stl,
        _ => SurfaceFormat::Obj,
    }))
}

/// The byte order mark of UTF-8.
const BOM: &str = "\u{feff}";
const _: () = assert!(BOM.len() == BYTE_ORDER_MARK.len_utf8());

/// The format of a file with a mark of its own. `text` is the file without byte order mark and blanks.
fn marked(bytes: &[u8], text: &[u8]) -> Option<SurfaceFormat> {
    let word = text.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    match word {
        _ if bytes.starts_with(b"glTF") => Some(SurfaceFormat::Gltf),
        _ if bytes.starts_with(freesurfer::BINARY_MARK) || text.starts_with(freesurfer::TEXT_MARK) => {
            Some(SurfaceFormat::FreeSurfer)
        }
        _ if text.starts_with(b"# vtk DataFile") => Some(SurfaceFormat::Vtk),
        _ if mz3::begins(bytes) => Some(SurfaceFormat::Mz3),
        b"ply" => Some(SurfaceFormat::Ply),
        _ if announces_its_size(bytes) => Some(SurfaceFormat::Stl),
        _ if word.eq_ignore_ascii_case(b"solid") || word.eq_ignore_ascii_case(b"facet") => {
            Some(SurfaceFormat::Stl)
        }
        [b'{', ..] if has(text, b"\"asset\"") => Some(SurfaceFormat::Gltf),
        [b'{', ..] => Some(SurfaceFormat::Metric),
        [b'<', ..] if has(&text[..text.len().min(HEAD)], b"<GIFTI") => Some(SurfaceFormat::Gifti),
        [b'<', ..] if has(&text[..text.len().min(HEAD)], b"<VTKFile") => Some(SurfaceFormat::Vtp),
        _ if begins_off(first_word(text)) => Some(SurfaceFormat::Off),
        _ => None,
    }
}

/// Bytes among which the first element of an XML file is looked for, after its declarations.
const HEAD: usize = 4096;

fn has(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|w| w == word)
}

/// The first word of a text that is in no comment.
fn first_word(text: &[u8]) -> &[u8] {
    let mut lines = text.split(|&b| b == b'\n' || b == b'\r').map(<[u8]>::trim_ascii);
    let line = lines.find(|line| !line.is_empty() && line[0] != b'#').unwrap_or_default();
    line.split(u8::is_ascii_whitespace).next().unwrap_or_default()
}

/// True for `OFF`, in capitals or not, with letters for columns before it; the first count may follow without a blank.
fn begins_off(word: &[u8]) -> bool {
    /// Longer words are none of OFF; this bounds what is looked at in a file without line ends.
    const LONGEST: usize = 32;
    let word = std::str::from_utf8(&word[..word.len().min(LONGEST)]).unwrap_or_default();
    split_header(word).is_some_and(|(prefix, rest)| {
        prefix.chars().all(|c| "STCN4n".contains(c)) && rest.bytes().all(|b| b.is_ascii_digit())
    })
}

/// Files that come under the name of a mesh, by their first bytes.
const STRANGERS: &[(&[u8], &str)] = &[
    (b"version https://git-lfs", "a pointer of Git LFS, not the file itself: `git lfs pull` fetches that"),
    (b"PK\x03\x04", "a ZIP archive; unpack it, and give the mesh inside"),
    (b"Rar!\x1a", "a RAR archive; unpack it, and give the mesh inside"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive; unpack it, and give the mesh inside"),
    (b"\xfd7zXZ\0", "packed by xz; unpack it (unxz), or pack it with gzip"),
    (b"BZh", "packed by bzip2; unpack it (bunzip2), or pack it with gzip"),
    (b"\x28\xb5\x2f\xfd", "packed by zstd; unpack it (unzstd), or pack it with gzip"),
    (b"Kaydara FBX", "an FBX file, which is not read; export it as glTF, OBJ or PLY"),
    (b"ISO-10303-21", "a STEP file, which is not read; export a mesh of it as OBJ, PLY or STL"),
    (b"#VRML", "a VRML file, which is not read; export it as OBJ, PLY or STL"),
    (b"$MeshFormat", "a Gmsh file, which is not read; export it as PLY, OBJ or STL"),
    (b"MeshVersionFormatted", "a Medit file, which is not read; export it as OBJ, OFF or PLY"),
    (b"BLENDER", "a file of Blender; export a mesh from it as OBJ, PLY or glTF"),
    (b"%PDF", "a PDF file, not a mesh"),
    (b"\x89PNG", "a PNG picture, not a mesh"),
    (b"\xff\xd8\xff", "a JPEG picture, not a mesh"),
    (b"\x89HDF", "an HDF5 file, which is not read; export the mesh as OBJ, PLY or STL"),
];

/// A sentence that says what a file is which holds no surface, as far as its beginning tells that.
fn stranger(bytes: &[u8], text: &[u8]) -> Option<String> {
    if let Some(encoding) = wide_encoding(bytes) {
        return Some(format!("the text of this file is in {encoding}; save it in UTF-8 or ASCII"));
    }
    if let Some((_, what)) = STRANGERS.iter().find(|(mark, _)| bytes.starts_with(mark)) {
        return Some(format!("this is {what}"));
    }
    if !text.starts_with(b"<") {
        return None;
    }
    let head = text[..text.len().min(HEAD)].to_ascii_lowercase();
    if has(&head, b"<html") || has(&head, b"<!doctype html") {
        let page = "this is an HTML page, such as servers send where a download has failed or needs a login";
        return Some(format!("{page}; download the mesh itself"));
    }
    let known: [(&[u8], &str); 3] = [(b"<collada", "Collada"), (b"<x3d", "X3D"), (b"<amf", "AMF")];
    let (_, name) = known.into_iter().find(|(element, _)| has(&head, element))?;
    Some(format!("this is a {name} file, which is not read; export it as OBJ, PLY or STL"))
}

/// The name of an encoding with more than one byte for every letter: by its byte order mark, or because every other byte of the beginning
/// is 0, as in ASCII text of 16 bits.
fn wide_encoding(bytes: &[u8]) -> Option<&'static str> {
    /// Bytes that are looked at: OBJ files with fewer hold no triangle.
    const LOOKED_AT: usize = 32;
    match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => return Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => return Some("UTF-16"),
        _ => {}
    }
    let pairs = bytes.get(..LOOKED_AT)?.as_chunks::<2>().0;
    let of_text = |b: u8| b.is_ascii_graphic() || b.is_ascii_whitespace();
    let wide = |low: usize| pairs.iter().all(|pair| of_text(pair[low]) && pair[1 - low] == 0);
    (wide(0) || wide(1)).then_some("UTF-16")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(bytes: &[u8]) -> SurfaceFormat {
        format(bytes, None, "t").unwrap()
    }

    #[test]
    fn formats_are_recognised_without_a_name() {
        for (text, expected) in [
            ("# by hand\nv 0 0 0\n", SurfaceFormat::Obj),
            ("", SurfaceFormat::Obj),
            ("OFF\n", SurfaceFormat::Off),
            ("off\n", SurfaceFormat::Off),
            ("# c\n\n NCSTOFF 4 1 0\n", SurfaceFormat::Off),
            ("\u{feff}OFF4 1 0\n", SurfaceFormat::Off),
            ("5 4 0\n0 0 0\n", SurfaceFormat::Off),
            ("ply\r\n", SurfaceFormat::Ply),
            ("\u{feff}solid a\n", SurfaceFormat::Stl),
            ("  SOLID A\n", SurfaceFormat::Stl),
            ("<?xml version=\"1.0\"?><GIFTI>", SurfaceFormat::Gifti),
            ("{\"asset\": {}}", SurfaceFormat::Gltf),
            ("{\"faces\": []}", SurfaceFormat::Metric),
            ("o OFFICE\n", SurfaceFormat::Obj),
            ("OFFICE\n", SurfaceFormat::Obj),
        ] {
            assert_eq!(found(text.as_bytes()), expected, "{text}");
        }
        // A binary file with bytes after its last triangle.
        let mut stl = vec![0; 84 + 50 + 7];
        stl[80] = 1;
        assert_eq!(found(&stl), SurfaceFormat::Stl);
        // What has no mark is what its name says; a mark is stronger.
        let named = |text: &str| format(text.as_bytes(), Some(SurfaceFormat::Obj), "t.obj").unwrap();
        assert_eq!((named("5 4 0\n"), named("ply\n")), (SurfaceFormat::Obj, SurfaceFormat::Ply));
    }

    #[test]
    fn files_that_hold_no_surface_are_named() {
        let utf16: Vec<u8> = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".bytes().flat_map(|b| [0, b]).collect();
        for (bytes, says) in [
            (&b"\xff\xfev\0 \0"[..], "UTF-16"),
            (&utf16, "UTF-16"),
            (&b"\xff\xfe\0\0v\0\0\0"[..], "UTF-32"),
            (&b"\n<!DOCTYPE html>\n<html>"[..], "HTML page"),
            (&b"PK\x03\x04.."[..], "ZIP archive"),
            (&b"version https://git-lfs.github.com/spec/v1\n"[..], "git lfs pull"),
            (&b"<?xml version=\"1.0\"?>\n<COLLADA>"[..], "Collada"),
        ] {
            for named in [None, Some(SurfaceFormat::Obj), Some(SurfaceFormat::Stl)] {
                let error = format(bytes, named, "t").unwrap_err().to_string();
                assert!(error.contains(says), "{error}");
            }
        }
    }
}

//! Writer of Wavefront OBJ.

use super::labels::{FaceLabels, KEYWORDS};
use super::text::{TextBuilder, write_blocks};
use super::{TexturedMesh, write_atomically};
use crate::error::{Error, Result};
use std::io::{self, Write};
use std::path::Path;

/// Writes an OBJ file, atomically, with the fewest digits that read back to the same numbers. With [`TexturedMesh::texcoord_weights`] a
/// comment on the first line says that the `vt` are homogeneous. Faces stand under their [`super::FaceLabels`].
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of
/// range, [`crate::Error::Size`], [`crate::Error::Io`].
pub fn write_obj(path: &Path, data: &TexturedMesh<'_>) -> Result<()> {
    data.check()?;
    write_atomically(path, |out| write_text(out, data))
}

/// [`write_obj`] to anything that can be written to, for callers who put files in place themselves. Lines are formatted in parallel
/// inside a pool.
///
/// # Errors
///
/// [`crate::Error::Argument`] and [`crate::Error::Size`] before anything is written; [`crate::Error::Io`].
pub fn write_obj_to(out: &mut impl Write, data: &TexturedMesh<'_>) -> Result<()> {
    data.check()?;
    write_text(out, data).map_err(|e| Error::Io { path: "OBJ".into(), message: e.to_string() })
}

fn write_text(out: &mut impl Write, data: &TexturedMesh<'_>) -> io::Result<()> {
    if !data.texcoord_weights.is_empty() {
        writeln!(
            out,
            "# vt are homogeneous: (q x, q y, q), linear within each face; the texture is at (x, y)"
        )?;
    }
    if let Some(labels) = data.labels {
        labels.libraries.iter().try_for_each(|library| writeln!(out, "mtllib {library}"))?;
    }
    write_blocks(out, data.positions.len(), |text, v| {
        line(text, "v", &data.positions[v]);
        if let Some([r, g, b, a]) = data.colors.get(v) {
            let alpha = if *a == 1.0 { String::new() } else { format!(" {a:.6}") };
            text.text(&format!(" {r:.6} {g:.6} {b:.6}{alpha}"));
        }
        text.character('\n');
    })?;
    write_blocks(out, data.texcoords.len(), |text, k| {
        let [s, t] = data.texcoords[k];
        match data.texcoord_weights.get(k) {
            Some(q) => line(text, "vt", &[q * s, q * t, *q]),
            None => line(text, "vt", &[s, t]),
        }
        text.character('\n');
    })?;
    write_blocks(out, data.normals.len(), |text, k| {
        line(text, "vn", &data.normals[k]);
        text.character('\n');
    })?;
    let has_normals = !data.normals.is_empty();
    write_blocks(out, data.faces.len(), |text, f| {
        let corners = data.faces[f];
        let normals = data.face_normals.get(f).unwrap_or(&corners);
        let texcoords = data.face_texcoords.get(f);
        if let Some(labels) = data.labels {
            label_lines(text, labels, f);
        }
        text.character('f');
        for k in 0..3 {
            text.character(' ');
            text.count(u64::from(corners[k]) + 1);
            if let Some(texcoords) = texcoords {
                text.character('/');
                text.count(u64::from(texcoords[k]) + 1);
            }
            if has_normals {
                text.text(if texcoords.is_some() { "/" } else { "//" });
                text.count(u64::from(normals[k]) + 1);
            }
        }
        text.character('\n');
    })
}

/// Appends the names that change before face `f`.
fn label_lines(text: &mut TextBuilder, labels: &FaceLabels, f: usize) {
    let names = |f: usize| labels.labels[labels.of_face[f] as usize].names();
    if f > 0 && labels.of_face[f] == labels.of_face[f - 1] {
        return;
    }
    let before = f.checked_sub(1).map_or([""; 4], names);
    for ((keyword, name), before) in KEYWORDS.into_iter().zip(names(f)).zip(before) {
        if name != before {
            text.text(keyword);
            text.text(if name.is_empty() { "" } else { " " });
            text.text(name);
            text.character('\n');
        }
    }
}

/// Appends a keyword and its numbers.
fn line(text: &mut TextBuilder, keyword: &str, numbers: &[f64]) {
    text.text(keyword);
    for x in numbers {
        text.character(' ');
        text.number(*x);
    }
}

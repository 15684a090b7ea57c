//! Writers of GIFTI: surfaces, values at their vertices, labels with their table; with metadata and the space that coordinates are in.
//! Numbers are those of single precision, compressed and in base64, as the format's other programs write them.

use super::base64::encode;
use super::gifti_notes::{GiftiNotes, GiftiTransform};
use super::{Format, Soup, write_atomically};
use crate::error::{Error, Result};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// A row of the table of labels.
#[derive(Debug, Clone, PartialEq)]
pub struct GiftiLabel {
    /// The number that stands at vertices.
    pub key: i32,
    /// The name.
    pub name: String,
    /// Red, green, blue and opacity from 0 to 1.
    pub color: [f64; 4],
}

/// An array with its attributes.
struct OutGifti<'a> {
    intent: &'static str,
    kind: &'static str,
    rows: usize,
    columns: usize,
    bytes: Vec<u8>,
    name: &'a str,
}

/// Writes a surface, atomically. Returns what was left out.
///
/// # Errors
/// With the file untouched: [`Error::Argument`] for numbers that are not finite or not in the range of single precision and corners out of
/// range, [`Error::Size`] for attributes of another size, [`Error::TooLarge`], [`Error::Io`].
pub fn write_gifti(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    let bytes = gifti_surface(soup, &GiftiNotes::default())?;
    write_atomically(path, |out| out.write_all(&bytes))?;
    Ok(soup.attributes.all_left_out(Format::Gifti))
}

/// The bytes of a surface (`.surf.gii`).
///
/// # Errors
/// Those of [`write_gifti`] but for [`Error::Io`]; [`Error::Argument`] for a matrix with a number that is not finite and for text with characters
/// that XML has not.
pub fn gifti_surface(soup: &Soup, notes: &GiftiNotes) -> Result<Vec<u8>> {
    soup.check_writable()?;
    let points = OutGifti {
        intent: "POINTSET",
        kind: "FLOAT32",
        rows: soup.positions.len(),
        columns: 3,
        bytes: singles(soup.positions.as_flattened())?,
        name: "",
    };
    let triangles = OutGifti {
        intent: "TRIANGLE",
        kind: "INT32",
        rows: soup.faces.len(),
        columns: 3,
        bytes: integers(soup.faces.as_flattened().iter().map(|&v| i64::from(v)))?,
        name: "",
    };
    file(&[points, triangles], &[], notes)
}

/// The bytes of values at the vertices of a surface (`.shape.gii`), in arrays with names.
///
/// # Errors
/// [`Error::Argument`] for numbers that are not in the range of single precision, and for notes as [`gifti_surface`] has it.
pub fn gifti_values(values: &[(&str, &[f64])], notes: &GiftiNotes) -> Result<Vec<u8>> {
    let array = |(name, values): &(&'_ str, &[f64])| {
        let bytes = singles(values)?;
        Ok(("SHAPE", "FLOAT32", values.len(), bytes, name.to_string()))
    };
    let arrays: Vec<_> = values.iter().map(array).collect::<Result<_>>()?;
    let arrays: Vec<OutGifti<'_>> = arrays
        .iter()
        .map(|(intent, kind, rows, bytes, name)| OutGifti {
            intent,
            kind,
            rows: *rows,
            columns: 1,
            bytes: bytes.clone(),
            name,
        })
        .collect();
    file(&arrays, &[], notes)
}

/// The bytes of labels at the vertices of a surface (`.label.gii`), with their table.
///
/// # Errors
/// [`Error::Argument`] for a label that the table has not, for a part of a colour that is not from 0 to 1, and for notes as [`gifti_surface`] has it.
pub fn gifti_labels(labels: &[i32], table: &[GiftiLabel], notes: &GiftiNotes) -> Result<Vec<u8>> {
    if let Some(label) = labels.iter().find(|label| table.iter().all(|row| row.key != **label)) {
        return Err(Error::argument("labels", label, "numbers of the table"));
    }
    let array = OutGifti {
        intent: "LABEL",
        kind: "INT32",
        rows: labels.len(),
        columns: 1,
        bytes: integers(labels.iter().map(|&label| i64::from(label)))?,
        name: "",
    };
    if let Some(part) = table.iter().flat_map(|row| row.color).find(|part| !(0.0..=1.0).contains(part)) {
        return Err(Error::argument("color", part, "from 0 to 1"));
    }
    file(&[array], table, notes)
}

/// The bytes of single-precision numbers; a NaN stays one.
fn singles(values: &[f64]) -> Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(4 * values.len());
    for &x in values {
        let single = x as f32;
        if single.is_infinite() {
            return Err(Error::argument(
                "number",
                x,
                "in the range of single precision, which the format has",
            ));
        }
        bytes.extend(single.to_le_bytes());
    }
    Ok(bytes)
}

fn integers(values: impl Iterator<Item = i64>) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    for value in values {
        let Ok(value) = i32::try_from(value) else {
            return Err(Error::TooLarge {
                what: "vertices of a GIFTI file",
                count: value.unsigned_abs() as usize,
            });
        };
        bytes.extend(value.to_le_bytes());
    }
    Ok(bytes)
}

/// Refuses what no reader takes: characters that XML has not, and numbers of a matrix that are none.
fn check_readable(arrays: &[OutGifti<'_>], table: &[GiftiLabel], notes: &GiftiNotes) -> Result<()> {
    let texts = notes.metadata.iter().flat_map(|(name, value)| [name.as_str(), value]);
    let texts = texts.chain(notes.transforms.iter().flat_map(|way| [way.from.as_str(), &way.to]));
    let texts =
        texts.chain(table.iter().map(|row| row.name.as_str())).chain(arrays.iter().map(|array| array.name));
    let foreign = |c: char| (c < ' ' && !"\t\n\r".contains(c)) || matches!(c, '\u{fffe}' | '\u{ffff}');
    for text in texts {
        if let Some(c) = text.chars().find(|c| foreign(*c)) {
            return Err(Error::argument("text", c.escape_default(), "of characters that XML has"));
        }
    }
    match notes.transforms.iter().flat_map(|way| way.matrix.as_flattened()).find(|x| !x.is_finite()) {
        Some(x) => Err(Error::argument("matrix", x, "of finite numbers")),
        None => Ok(()),
    }
}

fn file(arrays: &[OutGifti<'_>], table: &[GiftiLabel], notes: &GiftiNotes) -> Result<Vec<u8>> {
    check_readable(arrays, table, notes)?;
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE GIFTI SYSTEM \"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n",
    );
    let _ = writeln!(text, "<GIFTI Version=\"1.0\" NumberOfDataArrays=\"{}\">", arrays.len());
    let facts: Vec<_> = notes.metadata.iter().map(|(name, value)| (&name[..], &value[..])).collect();
    metadata(&mut text, &facts);
    text += "<LabelTable>\n";
    for GiftiLabel { key, name, color: [red, green, blue, alpha] } in table {
        let name = cdata(name);
        let _ = writeln!(
            text,
            "<Label Key=\"{key}\" Red=\"{red}\" Green=\"{green}\" Blue=\"{blue}\" Alpha=\"{alpha}\">{name}</Label>"
        );
    }
    text += "</LabelTable>\n";
    for (k, array) in arrays.iter().enumerate() {
        let OutGifti { intent, kind, rows, columns, .. } = array;
        let dims = if *columns == 1 { String::new() } else { format!(" Dim1=\"{columns}\"") };
        let _ = writeln!(
            text,
            "<DataArray Intent=\"NIFTI_INTENT_{intent}\" DataType=\"NIFTI_TYPE_{kind}\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"{}\" Dim0=\"{rows}\"{dims} Encoding=\"GZipBase64Binary\" Endian=\"LittleEndian\" ExternalFileName=\"\" ExternalFileOffset=\"\">",
            if *columns == 1 { 1 } else { 2 }
        );
        let named = [("Name", array.name)];
        match k {
            _ if !array.name.is_empty() => metadata(&mut text, &named),
            0 => metadata(&mut text, &facts),
            _ => metadata(&mut text, &[]),
        }
        if *intent == "POINTSET" {
            let unknown = [GiftiTransform::default()];
            let all = if notes.transforms.is_empty() { &unknown[..] } else { &notes.transforms[..] };
            all.iter().for_each(|one| transform(&mut text, one));
        }
        let _ = writeln!(text, "<Data>{}</Data>\n</DataArray>", encode(&compressed(&array.bytes)));
    }
    Ok((text + "</GIFTI>\n").into_bytes())
}

fn metadata(text: &mut String, facts: &[(&str, &str)]) {
    *text += "<MetaData>\n";
    for (name, value) in facts {
        let _ = writeln!(text, "<MD><Name>{}</Name><Value>{}</Value></MD>", cdata(name), cdata(value));
    }
    *text += "</MetaData>\n";
}

fn transform(text: &mut String, transform: &GiftiTransform) {
    *text += "<CoordinateSystemTransformMatrix>\n";
    let _ = writeln!(text, "<DataSpace>{}</DataSpace>", cdata(&transform.from));
    let _ = writeln!(text, "<TransformedSpace>{}</TransformedSpace>", cdata(&transform.to));
    let rows = transform.matrix.map(|row| row.map(|x| format!("{x:?}")).join(" "));
    let _ = writeln!(text, "<MatrixData>{}</MatrixData>", rows.join("\n"));
    *text += "</CoordinateSystemTransformMatrix>\n";
}

/// Text that markup in it does not end.
fn cdata(text: &str) -> String {
    format!("<![CDATA[{}]]>", text.replace("]]>", "]]]]><![CDATA[>"))
}

/// The bytes as zlib has them. Writing to memory does not fail.
fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::io::{parse_gifti, parse_gifti_notes};

    fn triangle() -> Soup {
        Soup::new(
            vec![[0.1, -2.5, 3e20], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    }

    #[test]
    fn a_surface_reads_back_in_single_precision() {
        let mni = GiftiTransform {
            to: "NIFTI_XFORM_MNI_152".into(),
            matrix: [
                [0.1, -2.0, 3e-7, 4.5],
                [0.0, 1.0, 0.0, -18.0],
                [0.0, 0.0, 1.0, 1e9],
                [0.0, 0.0, 0.0, 1.0],
            ],
            ..GiftiTransform::default()
        };
        let notes = GiftiNotes {
            metadata: vec![("AnatomicalStructurePrimary".into(), "Cortex]]>Left & <right>".into())],
            transforms: vec![mni, GiftiTransform { to: "a & b".into(), ..GiftiTransform::default() }],
        };
        let bytes = gifti_surface(&triangle(), &notes).unwrap();
        let back = parse_gifti(&bytes, "t.gii").unwrap();
        assert_eq!(back.faces, triangle().faces);
        let rounded: Vec<_> = triangle().positions.iter().map(|p| p.map(|x| f64::from(x as f32))).collect();
        assert_eq!(back.positions, rounded);
        assert_eq!(parse_gifti_notes(&bytes, "t.gii").unwrap(), notes);
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("NIFTI_XFORM_MNI_152") && text.contains("Cortex]]]]><![CDATA[>Left & <right>"));
    }

    #[test]
    fn notes_that_no_reader_takes_are_refused() {
        let mut wrong = GiftiTransform::default();
        wrong.matrix[1][3] = f64::NAN;
        let notes = GiftiNotes { transforms: vec![wrong], ..GiftiNotes::default() };
        let said = gifti_surface(&triangle(), &notes).unwrap_err().to_string();
        assert!(said.contains("matrix") && said.contains("NaN"), "{said}");
        let notes = GiftiNotes { metadata: vec![("a".into(), "b\u{1}".into())], ..GiftiNotes::default() };
        let said = gifti_values(&[], &notes).unwrap_err().to_string();
        assert!(said.contains("\\u{1}"), "{said}");
        assert!(gifti_values(&[("tab\tand line\n", &[1.0])], &GiftiNotes::default()).is_ok());
    }

    #[test]
    fn numbers_out_of_range_and_labels_without_a_row_are_refused() {
        let far = Soup::new(vec![[1e39, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]);
        assert!(gifti_surface(&far, &GiftiNotes::default()).is_err());
        let row = GiftiLabel { key: 1, name: "cortex".into(), color: [1.0, 0.0, 0.0, 1.0] };
        assert!(gifti_labels(&[1, 2], std::slice::from_ref(&row), &GiftiNotes::default()).is_err());
        let bright = GiftiLabel { color: [1.5, 0.0, 0.0, 1.0], ..row.clone() };
        assert!(gifti_labels(&[1], &[bright], &GiftiNotes::default()).is_err());
        let text = String::from_utf8(gifti_labels(&[1, 1], &[row], &GiftiNotes::default()).unwrap()).unwrap();
        assert!(text.contains("<Label Key=\"1\" Red=\"1\" Green=\"0\""));
    }
}

//! Tests of GIFTI: every encoding, byte order and array order gives the same surface; damaged files are refused with the line.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use ricci::mesh::Mesh;
use ricci::mesh::io::freesurfer::{AnnotationEntry, parse_annotation, parse_values};
use ricci::mesh::io::{self, Soup};
use ricci::{Error, FilePosition};
use std::io::Write;

const POINTS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -2.25, 0.0], [0.1, 0.0, 3e-3]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// The surface in 32 bits.
fn tetrahedron() -> Soup {
    Soup::new(POINTS.map(|p| p.map(|x| f64::from(x as f32))).to_vec(), FACES.to_vec())
}

/// One array with its attributes and data.
fn array(intent: &str, kind: &str, encoding: &str, more: &str, data: &str) -> String {
    format!(
        "<DataArray Intent=\"NIFTI_INTENT_{intent}\" DataType=\"NIFTI_TYPE_{kind}\" Encoding=\"{encoding}\" \
         Dimensionality=\"2\" Dim0=\"4\" Dim1=\"3\" {more}>\n<MetaData><MD><Name>n</Name><Value/></MD></MetaData>\n\
         <CoordinateSystemTransformMatrix><MatrixData>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</MatrixData>\
         </CoordinateSystemTransformMatrix>\n<Data>{data}</Data>\n</DataArray>\n"
    )
}

fn file(arrays: &[String]) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<!DOCTYPE GIFTI SYSTEM \"gifti.dtd\" [<!ENTITY a \"b\">]>\n<GIFTI Version=\"1.0\">\n{}</GIFTI>\n",
        arrays.concat()
    )
}

fn parse(text: &str) -> ricci::Result<Soup> {
    io::parse_gifti(text.as_bytes(), "t.surf.gii")
}

/// The entries of a 4 × 3 table row by row or column by column.
fn ordered<T: Copy>(table: [[T; 3]; 4], column_major: bool) -> Vec<T> {
    let at = |k: usize| if column_major { table[k % 4][k / 4] } else { table[k / 3][k % 3] };
    (0..12).map(at).collect()
}

fn ascii(soup: &Soup) -> String {
    let points: Vec<String> = soup.positions.iter().flatten().map(|x| format!("{x:e}")).collect();
    let faces: Vec<String> = soup.faces.iter().flatten().map(u32::to_string).collect();
    file(&[
        array("POINTSET", "FLOAT64", "ASCII", "", &points.join("\n ")),
        array("TRIANGLE", "INT32", "ASCII", "", &faces.join(" ")),
    ])
}

#[test]
fn all_encodings_and_orders_are_one_surface() {
    let zlib = |bytes: &[u8]| {
        let mut out = ZlibEncoder::new(Vec::new(), Compression::best());
        out.write_all(bytes).unwrap();
        out.finish().unwrap()
    };
    let gzip = |bytes: &[u8]| {
        let mut out = GzEncoder::new(Vec::new(), Compression::fast());
        out.write_all(bytes).unwrap();
        out.finish().unwrap()
    };
    let plain = |bytes: &[u8]| bytes.to_vec();
    let packers: [(&str, &dyn Fn(&[u8]) -> Vec<u8>); 3] =
        [("Base64Binary", &plain), ("GZipBase64Binary", &zlib), ("GZipBase64Binary", &gzip)];
    let mut seen = 0;
    for (encoding, pack) in packers {
        for (big, column_major, wide) in (0..8).map(|k| (k & 1 > 0, k & 2 > 0, k & 4 > 0)) {
            let turned = |mut word: Vec<u8>| {
                if big {
                    word.reverse();
                }
                word
            };
            let point =
                |x: f64| turned(if wide { x.to_le_bytes().into() } else { (x as f32).to_le_bytes().into() });
            let vertex = |v: u32| {
                turned(if wide { u64::from(v).to_le_bytes().into() } else { v.to_le_bytes().into() })
            };
            let points: Vec<u8> = ordered(POINTS, column_major).into_iter().flat_map(point).collect();
            let faces: Vec<u8> = ordered(FACES, column_major).into_iter().flat_map(vertex).collect();
            let more = format!(
                "Endian=\"{}Endian\" ArrayIndexingOrder=\"{}MajorOrder\"",
                if big { "Big" } else { "Little" },
                if column_major { "Column" } else { "Row" }
            );
            // Broken into lines, as some programs do.
            let text = |bytes: &[u8]| format!("\n{}\n", STANDARD.encode(pack(bytes)).replace('A', "A\r\n "));
            let (float, int) = if wide { ("FLOAT64", "INT64") } else { ("FLOAT32", "UINT32") };
            let soup = parse(&file(&[
                array("TRIANGLE", int, encoding, &more, &text(&faces)),
                array("SHAPE", "FLOAT32", encoding, &more, "not even data"),
                array("POINTSET", float, encoding, &more, &text(&points)),
            ]));
            let mut soup = soup.unwrap();
            assert_eq!(std::mem::take(&mut soup.attributes.unread), ["array `SHAPE`"]);
            let expected = if wide { Soup::new(POINTS.to_vec(), FACES.to_vec()) } else { tetrahedron() };
            assert_eq!(soup, expected, "{encoding} {more}");
            seen += 1;
        }
    }
    assert_eq!(seen, 24);
    assert_eq!(parse(&ascii(&tetrahedron())).unwrap(), tetrahedron());
    let small = array(
        "TRIANGLE",
        "UINT8",
        "Base64Binary",
        "",
        &STANDARD.encode(FACES.map(|f| f.map(|v| v as u8)).concat()),
    );
    let points = ascii(&tetrahedron());
    let points = &points
        [points.find("<DataArray").unwrap()..points.find("<DataArray Intent=\"NIFTI_INTENT_T").unwrap()];
    assert_eq!(parse(&file(&[points.into(), small])).unwrap(), tetrahedron());
}

/// A file written by nibabel 5.4.
const NIBABEL: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">
<GIFTI Version="1.0" NumberOfDataArrays="2"><MetaData /><LabelTable /><DataArray Intent="NIFTI_INTENT_POINTSET" DataType="NIFTI_TYPE_FLOAT32" ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" Encoding="GZipBase64Binary" Endian="LittleEndian" ExternalFileName="" ExternalFileOffset="0" Dim0="4" Dim1="3"><MetaData /><CoordinateSystemTransformMatrix><DataSpace>NIFTI_XFORM_UNKNOWN</DataSpace><TransformedSpace>NIFTI_XFORM_UNKNOWN</TransformedSpace><MatrixData>  1.000000   0.000000   0.000000   0.000000
  0.000000   1.000000   0.000000   0.000000
  0.000000   0.000000   1.000000   0.000000
  0.000000   0.000000   0.000000   1.000000</MatrixData></CoordinateSystemTransformMatrix><Data>eJxjYEAGB+xRuAwCB0Dk2TNnbEH0stku1gBRWAYy</Data></DataArray><DataArray Intent="NIFTI_INTENT_TRIANGLE" DataType="NIFTI_TYPE_INT32" ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" Encoding="GZipBase64Binary" Endian="LittleEndian" ExternalFileName="" ExternalFileOffset="0" Dim0="4" Dim1="3"><MetaData /><CoordinateSystemTransformMatrix><DataSpace>NIFTI_XFORM_UNKNOWN</DataSpace><TransformedSpace>NIFTI_XFORM_UNKNOWN</TransformedSpace><MatrixData>  1.000000   0.000000   0.000000   0.000000
  0.000000   1.000000   0.000000   0.000000
  0.000000   0.000000   1.000000   0.000000
  0.000000   0.000000   0.000000   1.000000</MatrixData></CoordinateSystemTransformMatrix><Data>eJxjYGBgYAJiRgYIANHMUJoJymaCyoHYAAG4ABM=</Data></DataArray></GIFTI>"#;

#[test]
fn what_nibabel_writes_is_read_by_name_and_is_a_sphere() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lh.surf.GII");
    std::fs::write(&path, NIBABEL).unwrap();
    let soup = io::read(&path).unwrap();
    assert_eq!(soup, tetrahedron());
    assert_eq!(Mesh::from_soup(&soup).unwrap().euler(), 2);
}

#[test]
fn vectors_at_the_vertices_are_normals() {
    let text = ascii(&tetrahedron());
    let normals = array("VECTOR", "FLOAT32", "ASCII", "", "0 0 1  0 0 2  0 1 0  1 0 0");
    let soup = parse(&text.replace("</GIFTI>", &(normals + "</GIFTI>"))).unwrap();
    assert_eq!(soup.attributes.normals.unwrap()[1..3], [[0.0, 0.0, 2.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn what_cannot_be_read_is_refused_by_line() {
    let text = ascii(&tetrahedron());
    let with = |from: &str, to: &str| text.replacen(from, to, 1);
    let base64 = |encoding: &str, data: &str| {
        file(&[array("POINTSET", "FLOAT32", encoding, "Endian=\"LittleEndian\"", data)])
    };
    for (text, line, says) in [
        (String::new(), 1, "no element"),
        ("solid x\n".into(), 2, "no element"),
        ("<html>\n</html>".into(), 1, "first element"),
        (with("</DataArray>", "</Data>"), 19, "no XML"),
        (text[..text.len() - 40].into(), 23, "XML"),
        (text.replace("</GIFTI>", ""), 26, "ends inside"),
        (text.replace("POINTSET", "SHAPE"), 0, "no NIFTI_INTENT_POINTSET"),
        (text.replace("TRIANGLE", "POINTSET"), 23, "a second NIFTI_INTENT_POINTSET"),
        (with("Dim0=\"4\"", "Dim0=\"-4\""), 4, "Dim0=\"-4\""),
        (with("Dim0=\"4\"", ""), 7, "no Dim0"),
        (with("Dim0=\"4\"", "Dim0=\"5\""), 18, "after 12 of 15"),
        (with("Dim0=\"4\"", "Dim0=\"3\""), 16, "after the last of 9"),
        (with("Dim0=\"4\"", "Dim0=\"4000000000\""), 7, "may unfold to"),
        (with("Dim0=\"4\"", "Dim0=\"4000000000000\""), 7, "can be numbered"),
        (with("Dim1=\"3\"", "Dim1=\"2\""), 7, "Dim1=\"3\""),
        (with("FLOAT64", "COMPLEX64"), 7, "COMPLEX64"),
        (with("INT32", "FLOAT32"), 23, "no integers"),
        (with("ASCII", "Base65"), 7, "Base65"),
        (with("ASCII\"", "ASCII\" Endian=\"Middle\""), 4, "Middle"),
        (with("ASCII\"", "ExternalFileBinary\" ExternalFileName=\"lh.dat\""), 7, "`lh.dat`"),
        (with("1.5e0", "one"), 10, "`one`"),
        (with("1.5e0", "&a;"), 7, "markup"),
        (with("0 2 1 0", "0 -2 1 0"), 23, "vertex -2"),
        (with("0 2 1 0", "0 0.5 1 0"), 23, "vertex 0.5"),
        (base64("Base64Binary", "eJx!"), 7, "base64"),
        (base64("Base64Binary", "AAAA"), 7, "have 3 bytes, the table has 48"),
        (base64("GZipBase64Binary", "AAAA"), 7, "damaged"),
        (base64("GZipBase64Binary", ""), 7, "cannot hold"),
    ] {
        // 0: the file as a whole.
        let place = if line == 0 { FilePosition::Whole } else { FilePosition::Line(line) };
        let Err(Error::Parse { at, message, .. }) = parse(&text) else { panic!("{says}: read\n{text}") };
        assert!(message.contains(says) && at == place, "{at}, not {place}: {message}");
    }
    // Truncated anywhere it is refused.
    for end in 0..text.trim_end().len() {
        assert!(parse(&text[..end]).is_err(), "cut at {end}");
    }
}

/// One array of one number per vertex.
fn column(intent: &str, kind: &str, dims: &str, data: &str) -> String {
    format!(
        "<DataArray Intent=\"NIFTI_INTENT_{intent}\" DataType=\"NIFTI_TYPE_{kind}\" Encoding=\"ASCII\" {dims}>\
         <MetaData><MD><Name>Units</Name><Value>mm</Value></MD><MD><Name><![CDATA[Name]]></Name><Value>deep &amp; wide</Value></MD></MetaData>\
         <Data>{data}</Data></DataArray>\n"
    )
}

#[test]
fn values_and_labels_read_back_and_are_known_by_their_content() {
    let notes = io::GiftiNotes::default();
    let bytes = io::gifti_values(&[("sulc", &[0.5, -1.25]), ("curv", &[2.0, f64::NAN])], &notes).unwrap();
    let found = io::parse_gifti_columns(&bytes, "t.shape.gii").unwrap();
    let told: Vec<_> =
        found.columns.iter().map(|c| (c.intent.as_str(), c.name.as_str(), c.values[0])).collect();
    assert_eq!(told, [("SHAPE", "sulc", 0.5), ("SHAPE", "curv", 2.0)]);
    assert!(found.columns[1].values[1].is_nan());
    let message = parse_values(&bytes, "t.shape.gii").unwrap_err().to_string();
    assert!(message.contains("2 arrays"), "{message}");
    let one = io::gifti_values(&[("", &[0.5, -1.25, 3.0])], &notes).unwrap();
    assert_eq!(parse_values(&one, "t.shape.gii").unwrap(), [0.5, -1.25, 3.0]);

    let label = |key, name: &str, color| io::GiftiLabel { key, name: name.into(), color };
    let table = [label(0, "???", [0.0, 0.0, 0.0, 0.0]), label(7, "left ]]> right", [1.0, 0.2, 0.4, 1.0])];
    let bytes = io::gifti_labels(&[7, 0, 7], &table, &notes).unwrap();
    let found = io::parse_gifti_columns(&bytes, "t.label.gii").unwrap();
    assert_eq!((found.table.as_slice(), found.labels()), (&table[..], Some(vec![Some(1), Some(0), Some(1)])));
    let annotation = parse_annotation(&bytes, "t.label.gii").unwrap();
    assert_eq!(annotation.regions, [Some(1), Some(0), Some(1)]);
    let AnnotationEntry { name, index, color } = &annotation.entries[1];
    assert_eq!((name.as_str(), *index, *color), ("left ]]> right", 7, [255, 51, 102, 0]));
}

#[test]
fn columns_of_other_programs_are_read_and_damaged_ones_are_refused_with_the_line() {
    let read = |arrays: &[String]| io::parse_gifti_columns(file(arrays).as_bytes(), "t.func.gii");
    let flat = "Dimensionality=\"1\" Dim0=\"3\"";
    let both = [
        column("TIME_SERIES", "FLOAT64", flat, "1 2.5 -3e2"),
        column("LABEL", "INT32", "Dimensionality=\"2\" Dim0=\"2\" Dim1=\"1\"", "4 5"),
        // A surface beside the values is no column.
        array("POINTSET", "FLOAT64", "ASCII", "", &"0 ".repeat(12)),
    ];
    let found = read(&both).unwrap();
    assert_eq!(found.columns.len(), 2);
    assert_eq!(
        (found.columns[0].name.as_str(), &found.columns[0].values[..]),
        ("deep & wide", &[1.0, 2.5, -300.0][..])
    );
    assert_eq!(found.labels(), Some(vec![None, None]));
    assert!(parse(&file(&both[..1])).unwrap_err().to_string().contains("no NIFTI_INTENT_POINTSET"));
    for (data, words) in [("1 2", "end after 2 of 3"), ("1 2 3 4", "after the last"), ("1 x 3", "`x`")] {
        let message = read(&[column("SHAPE", "FLOAT64", flat, data)]).unwrap_err().to_string();
        assert!(message.contains(words) && message.contains("t.func.gii:"), "{message}");
    }
    let table = |row: &str| {
        let text = file(&[]).replace("</GIFTI>", &format!("<LabelTable>{row}</LabelTable></GIFTI>"));
        io::parse_gifti_columns(text.as_bytes(), "t.label.gii").map(|found| found.table)
    };
    assert_eq!(table("<Label Index=\"3\">a</Label>").unwrap()[0].key, 3);
    for (row, words) in [
        ("<Label>a</Label>", "without Key"),
        ("<Label Key=\"1.5\">a</Label>", "whole number"),
        ("<Label Key=\"1\" Red=\"255\">a</Label>", "from 0 to 1"),
    ] {
        let message = table(row).unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    }
    let none = parse_values(file(&[]).as_bytes(), "t.shape.gii").unwrap_err().to_string();
    assert!(none.contains("no array of one value per vertex"), "{none}");
    assert!(parse_annotation(file(&both[..1]).as_bytes(), "t.label.gii").is_err());
}

#[test]
fn notes_are_those_of_the_file_and_of_its_first_array() {
    let text = ascii(&tetrahedron());
    let found = io::parse_gifti_notes(text.as_bytes(), "t.surf.gii").unwrap();
    assert_eq!(found.metadata, [("n".to_string(), String::new())]);
    let diagonal = [2.0, 2.0, 2.0, 1.0];
    let double = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| if i == j { diagonal[i] } else { 0.0 }));
    // Both arrays have one; that of the triangles does not count.
    assert_eq!(found.transforms.iter().map(|t| t.matrix).collect::<Vec<_>>(), [double]);
    for (from, to, words) in [
        ("2 0 0 0 0 2", "2 0 0 0 0 x", "`x` is no finite number"),
        ("2 0 0 0 0 2", "inf 0 0 0 0 2", "`inf` is no finite number"),
        ("2 0 0 0 0 2", "2 0 0 0 2", "fewer than 16"),
        ("2 0 0 0 0 2", "2 0 0 0 0 2 1", "more than 16"),
    ] {
        let text = text.replacen(from, to, 1);
        assert!(parse(&text).is_ok());
        let message = io::parse_gifti_notes(text.as_bytes(), "t.surf.gii").unwrap_err().to_string();
        assert!(message.contains(words) && message.starts_with("t.surf.gii:"), "{message}");
    }
}

//! Tests of the files of brain imaging and of VTK: every dialect gives the same surface, what is written reads back, damage is refused.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use ricci::mesh::io::freesurfer::{
    Annotation, AnnotationEntry, SurfacePatch, VertexLabel, annotation_bytes, label_text, parse_annotation,
    parse_label, parse_patch, parse_values, patch_bytes, values_bytes,
};
use ricci::mesh::io::{self, NumberColumn, NumberType, Soup, SurfaceFile};
use ricci::{Error, FilePosition};
use std::io::Write;
use std::path::Path;

const POINTS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -2.25, 0.0], [0.125, 0.0, 3.5]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn tetrahedron() -> Soup {
    Soup::new(POINTS.to_vec(), FACES.to_vec())
}

/// The surface of a file whose name says nothing.
fn read(bytes: &[u8]) -> ricci::Result<Soup> {
    SurfaceFile::of_bytes(bytes.to_vec(), "t")?.soup()
}

fn assert_same(soup: &Soup, what: &str) {
    assert_eq!((&soup.positions[..], &soup.faces[..]), (&POINTS[..], &FACES[..]), "{what}");
}

/// A number of every vertex or face.
fn column(name: &str, kind: NumberType, values: &[f64]) -> NumberColumn {
    NumberColumn { name: name.into(), kind, values: values.to_vec() }
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut out = GzEncoder::new(Vec::new(), Compression::default());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

/// A surface with every attribute that the formats hold.
fn dressed() -> Soup {
    let mut soup = tetrahedron();
    let attributes = &mut soup.attributes;
    attributes.normals = Some(POINTS.map(|[x, y, z]| [z, x, y]).to_vec());
    attributes.colors = Some((0..4).map(|k| [f64::from(k) / 255.0, 1.0, 0.0, 1.0]).collect());
    attributes.uv = Some(FACES.map(|f| f.map(|v| [f64::from(v) / 3.0, 0.1])).to_vec());
    attributes.vertex_numbers = vec![
        column("thickness", NumberType::F64, &[0.1, 0.2, f64::NAN, 4.0]),
        column("parcel", NumberType::I32, &[1.0, -2.0, 3.0, 4.0]),
    ];
    attributes.face_numbers = vec![column("flag", NumberType::U8, &[0.0, 1.0, 255.0, 7.0])];
    soup
}

/// As bits, so that NaN equals itself.
fn bits(columns: &[NumberColumn]) -> Vec<(String, Vec<u64>)> {
    columns.iter().map(|c| (c.name.clone(), c.values.iter().map(|x| x.to_bits()).collect())).collect()
}

#[test]
fn what_is_written_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["t.vtk", "t.vtp", "t.mz3", "t.asc", "lh.pial", "lh.sphere.reg", "rh.white"] {
        let path = folder.path().join(name);
        assert!(io::write(&path, &tetrahedron()).unwrap().is_empty(), "{name}");
        assert_same(&io::read(&path).unwrap(), name);
        // Also packed, and under the name of another format, since all have marks.
        let other = folder.path().join("t.obj.gz");
        std::fs::write(&other, packed(&std::fs::read(&path).unwrap())).unwrap();
        assert_same(&io::read(&other).unwrap(), name);
    }
    for name in ["d.vtk", "d.vtp"] {
        let (path, soup) = (folder.path().join(name), dressed());
        assert!(io::write(&path, &soup).unwrap().is_empty(), "{name}");
        let (found, given) = (io::read(&path).unwrap().attributes, &soup.attributes);
        assert_eq!((&found.normals, &found.uv), (&given.normals, &given.uv), "{name}");
        let near = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(found.colors.unwrap().iter().zip(given.colors.as_ref().unwrap()).all(|(a, b)| near(a, b)));
        assert_eq!(bits(&found.vertex_numbers), bits(&given.vertex_numbers), "{name}");
        assert_eq!(bits(&found.face_numbers), bits(&given.face_numbers), "{name}");
    }
    let path = folder.path().join("d.mz3");
    let left_out = io::write(&path, &dressed()).unwrap();
    assert!(
        ["normals", "texture coordinates", "`flag`", "name `parcel`"]
            .iter()
            .all(|what| left_out.iter().any(|l| l.contains(what))),
        "{left_out:?}"
    );
    let found = io::read(&path).unwrap().attributes;
    let names: Vec<&str> = found.vertex_numbers.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        (names, found.vertex_numbers[1].values.clone()),
        (vec!["scalar", "scalar_2"], vec![1.0, -2.0, 3.0, 4.0])
    );
    let left_out = io::write(&folder.path().join("lh.white"), &dressed()).unwrap();
    assert!(left_out.iter().any(|l| l.contains("colours")), "{left_out:?}");
}

fn big_endian(numbers: &[f64], kind: &str) -> Vec<u8> {
    let word = |x: &f64| match kind {
        "float" => (*x as f32).to_be_bytes().to_vec(),
        "double" => x.to_be_bytes().to_vec(),
        "int" => (*x as i32).to_be_bytes().to_vec(),
        _ => (*x as i64).to_be_bytes().to_vec(),
    };
    numbers.iter().flat_map(word).collect()
}

fn words(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

/// A legacy file, with the polygons as those of version 5.1 or before.
fn legacy(binary: bool, version: &str, more: &[(&str, &[f64], &str)]) -> Vec<u8> {
    let data = |numbers: &[f64], kind: &str| {
        if binary { big_endian(numbers, kind) } else { words(numbers).into_bytes() }
    };
    let mut out = format!(
        "# vtk DataFile Version {version}\nsurface\n{}\nDATASET POLYDATA\nPOINTS 4 float\n",
        if binary { "BINARY" } else { "ASCII" }
    )
    .into_bytes();
    out.extend(data(POINTS.as_flattened(), "float"));
    let corners: Vec<f64> = FACES.as_flattened().iter().map(|v| f64::from(*v)).collect();
    if version == "5.1" {
        out.extend(b"\nMETADATA\nINFORMATION 0\n\nPOLYGONS 5 12\nOFFSETS vtktypeint64\n");
        out.extend(data(&[0.0, 3.0, 6.0, 9.0, 12.0], "long"));
        out.extend(b"\nCONNECTIVITY vtktypeint64\n");
        out.extend(data(&corners, "long"));
    } else {
        out.extend(b"\nPOLYGONS 4 16\n");
        let counted: Vec<f64> = corners.chunks(3).flat_map(|f| [3.0, f[0], f[1], f[2]]).collect();
        out.extend(data(&counted, "int"));
    }
    for (head, numbers, kind) in more {
        out.extend(format!("\n{head}\n").bytes());
        out.extend(data(numbers, kind));
    }
    out.push(b'\n');
    out
}

#[test]
fn legacy_vtk_of_every_version_is_read() {
    let values = [0.5, 1.5, 2.5, 3.5];
    let more: [(&str, &[f64], &str); 3] = [
        ("CELL_DATA 4\nSCALARS part int 1\nLOOKUP_TABLE default", &[7.0, 8.0, 9.0, 10.0], "int"),
        ("POINT_DATA 4\nSCALARS sulc double\nLOOKUP_TABLE default", &values, "double"),
        ("FIELD FieldData 2\narea 1 4 float", &values, "float"),
    ];
    for binary in [false, true] {
        for version in ["1.0", "3.0", "4.2", "5.1"] {
            let mut bytes = legacy(binary, version, &more);
            bytes.extend(b"METADATA\nINFORMATION 0\n\npair 2 4 float\n");
            let pairs = [0.0; 8];
            bytes.extend(if binary { big_endian(&pairs, "float") } else { words(&pairs).into_bytes() });
            let soup = read(&bytes).unwrap();
            assert_same(&soup, version);
            let names: Vec<&str> = soup.attributes.vertex_numbers.iter().map(|c| c.name.as_str()).collect();
            assert_eq!(names, ["sulc", "area"]);
            assert!(soup.attributes.vertex_numbers.iter().all(|c| c.values == values));
            assert_eq!(
                soup.attributes.face_numbers,
                [column("part", NumberType::I32, &[7.0, 8.0, 9.0, 10.0])]
            );
            assert_eq!(soup.attributes.unread, ["array `pair` of points"]);
        }
    }
    // Polygons become triangles, strips turn every other one around, lines are left out.
    let text = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 1 0 0 1 1 0 0 1 0 2 2 0\n\
                LINES 1 3\n2 0 1\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n";
    let soup = read(text.as_bytes()).unwrap();
    assert_eq!(soup.faces, [[0, 1, 2], [0, 2, 3], [0, 1, 3], [3, 1, 2]]);
    assert_eq!(soup.attributes.unread, ["lines"]);
    let refused = |from: &str, to: &str| read(text.replace(from, to).as_bytes()).unwrap_err().to_string();
    assert!(refused("POLYDATA", "STRUCTURED_GRID").contains("POLYDATA is read"));
    assert!(refused("POINTS 5", "POINTS 4000000000").contains("too few"));
    assert!(refused("POLYGONS 1 5", "POLYGONS 2 5").contains("not complete"));
    assert!(refused("4 0 1 2 3", "4 0 1 2 -3").contains("vertex -3"));
    assert!(refused("LINES", "CURVES").contains("`CURVES`"));
}

/// How the arrays of a file in XML are stored.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Storage {
    Text,
    Inline,
    Raw,
    Appended,
}

/// The bytes of an array with its size before it, perhaps compressed in blocks of 40 bytes; base64 of the sizes and of the rest apart where they are.
fn stored(bytes: &[u8], wide: bool, compressed: bool, in_base64: bool) -> Vec<u8> {
    let size =
        |n: usize| if wide { (n as u64).to_le_bytes().to_vec() } else { (n as u32).to_le_bytes().to_vec() };
    let encoded = |bytes: &[u8]| if in_base64 { STANDARD.encode(bytes).into_bytes() } else { bytes.to_vec() };
    if !compressed {
        return encoded(&[size(bytes.len()), bytes.to_vec()].concat());
    }
    let blocks: Vec<Vec<u8>> = bytes
        .chunks(40)
        .map(|block| {
            let mut out = ZlibEncoder::new(Vec::new(), Compression::best());
            out.write_all(block).unwrap();
            out.finish().unwrap()
        })
        .collect();
    let mut head = [size(blocks.len()), size(40), size(bytes.len() % 40)].concat();
    blocks.iter().for_each(|block| head.extend(size(block.len())));
    [encoded(&head), encoded(&blocks.concat())].concat()
}

fn vtp(storage: Storage, wide: bool, compressed: bool) -> Vec<u8> {
    let mut appended = Vec::new();
    let mut array = |name: &str, kind: &str, components: usize, numbers: &[f64]| {
        let bytes: Vec<u8> = match kind {
            "Float32" => numbers.iter().flat_map(|x| (*x as f32).to_le_bytes()).collect(),
            "Int32" => numbers.iter().flat_map(|x| (*x as i32).to_le_bytes()).collect(),
            _ => numbers.iter().flat_map(|x| (*x as i64).to_le_bytes()).collect(),
        };
        let head = format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        match storage {
            Storage::Text => {
                let key = "<InformationKey name=\"UNITS_LABEL\">\n</InformationKey>";
                format!("{head} format=\"ascii\">\n {}\n{key}</DataArray>\n", words(numbers))
            }
            Storage::Inline => {
                let text = String::from_utf8(stored(&bytes, wide, compressed, true)).unwrap();
                format!("{head} format=\"binary\">\n {text}\n</DataArray>\n")
            }
            _ => {
                let offset = appended.len();
                appended.extend(stored(&bytes, wide, compressed, storage == Storage::Appended));
                format!("{head} format=\"appended\" offset=\"{offset}\"/>\n")
            }
        }
    };
    let corners: Vec<f64> = FACES.as_flattened().iter().map(|v| f64::from(*v)).collect();
    let parts = [
        array("sulcal depth", "Float32", 1, &[0.5, 1.5, 2.5, 3.5]),
        array("Points", "Float32", 3, POINTS.as_flattened()),
        array("connectivity", "Int64", 1, &corners),
        array("offsets", "Int32", 1, &[3.0, 6.0, 9.0, 12.0]),
    ];
    let [values, points, connectivity, offsets] = parts;
    let header = if wide { "UInt64" } else { "UInt32" };
    let compressor = if compressed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let mut out = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"{header}\"{compressor}>\n\
         <PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n<PointData>{values}</PointData>\n<Points>{points}</Points>\n\
         <Polys>{connectivity}{offsets}</Polys>\n</Piece></PolyData>\n"
    )
    .into_bytes();
    if !appended.is_empty() {
        let encoding = if storage == Storage::Raw { "raw" } else { "base64" };
        out.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").bytes());
        out.extend(appended);
        out.extend(b"\n</AppendedData>\n");
    }
    out.extend(b"</VTKFile>\n");
    out
}

#[test]
fn vtk_in_xml_is_read_however_its_arrays_are_stored() {
    for storage in [Storage::Text, Storage::Inline, Storage::Raw, Storage::Appended] {
        for (wide, compressed) in [(false, false), (true, false), (false, true), (true, true)] {
            let soup = read(&vtp(storage, wide, compressed))
                .unwrap_or_else(|e| panic!("{storage:?} {wide} {compressed}: {e}"));
            assert_same(&soup, &format!("{storage:?} {wide} {compressed}"));
            assert_eq!(
                soup.attributes.vertex_numbers,
                [column("sulcal_depth", NumberType::F32, &[0.5, 1.5, 2.5, 3.5])]
            );
        }
    }
    let text = String::from_utf8(vtp(Storage::Text, false, false)).unwrap();
    let refused = |from: &str, to: &str| read(text.replace(from, to).as_bytes()).unwrap_err().to_string();
    assert!(refused("\"PolyData\"", "\"ImageData\"").contains("PolyData is read"));
    assert!(
        refused(">\n<PolyData>", " compressor=\"vtkLZ4DataCompressor\">\n<PolyData>")
            .contains("vtkZLibDataCompressor")
    );
    assert!(refused("3 6 9 12", "3 6 9 13").contains("polygon 3"));
    assert!(refused("</Piece>", "</Piece><Piece/>").contains("several pieces"));
}

/// A binary surface of FreeSurfer.
fn freesurfer() -> Vec<u8> {
    let mut out = b"\xff\xff\xfecreated by someone on some day\n\n".to_vec();
    out.extend([4_i32, 4].map(i32::to_be_bytes).concat());
    out.extend(big_endian(POINTS.as_flattened(), "float"));
    FACES.as_flattened().iter().for_each(|v| out.extend(v.to_be_bytes()));
    out
}

#[test]
fn surfaces_of_freesurfer_are_read() {
    assert_same(&read(&freesurfer()).unwrap(), "binary");
    let more = [freesurfer(), vec![0, 0, 0, 2]].concat();
    assert!(read(&more).unwrap().attributes.unread[0].contains("geometry of the volume"));
    let text = "#!ascii version of lh.white\n4 4\n0 0 0 0\n1.5 0 0 0\n0 -2.25 0 0\n0.125 0 3.5 0\n0 2 1 0\n0 1 3 0\n1 2 3 0\n2 0 3 0\n";
    assert_same(&read(text.as_bytes()).unwrap(), "text");
    let cut = read(&freesurfer()[..100]).unwrap_err();
    assert!(matches!(&cut, Error::Parse { at: FilePosition::Byte(_), .. }), "{cut}");
    // The counts come before 4 vertices and 4 triangles of 12 bytes.
    let mut negative = freesurfer();
    let counts = negative.len() - 96 - 8;
    negative[counts] = 0x80;
    assert!(read(&negative).unwrap_err().to_string().contains("negative"));
    let quads = io::parse_freesurfer(&[0xff, 0xff, 0xfd, 0, 0, 0], "lh.orig").unwrap_err().to_string();
    assert!(quads.contains("quadrangles"), "{quads}");
}

#[test]
fn values_annotations_labels_and_patches_read_back() {
    assert_eq!(parse_values(&values_bytes(&[0.5, -1.25, 3.0], 2).unwrap(), "c").unwrap(), [0.5, -1.25, 3.0]);
    // The older format: counts of three bytes, hundredths of two.
    assert_eq!(parse_values(&[0, 0, 2, 0, 0, 1, 0, 150, 255, 156], "c").unwrap(), [1.5, -1.0]);
    assert!(values_bytes(&[f64::NAN], 0).is_err() && values_bytes(&[1e300], 0).is_err());
    let entry = |name: &str, index, color| AnnotationEntry { name: name.into(), index, color };
    let annotation = Annotation {
        regions: vec![Some(1), None, Some(0), Some(1)],
        entries: vec![entry("unknown", 0, [25, 5, 25, 0]), entry("motor", 3, [1, 2, 3, 0])],
        source: "colours.txt".into(),
    };
    assert_eq!(parse_annotation(&annotation_bytes(&annotation).unwrap(), "a").unwrap(), annotation);
    let mut twice = annotation.clone();
    twice.entries[1].color = [25, 5, 25, 9];
    assert!(annotation_bytes(&twice).is_err());
    // The older table: entries in order, without numbers.
    let ints = |list: &[i32]| list.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let older = [
        ints(&[2, 1, 0x03_0201, 0, 0, 1, 1, 2]),
        b"f\0".to_vec(),
        ints(&[2]),
        b"m\0".to_vec(),
        ints(&[1, 2, 3, 0]),
    ]
    .concat();
    let found = parse_annotation(&older, "a").unwrap();
    assert_eq!((found.regions, found.entries), (vec![None, Some(0)], vec![entry("m", 0, [1, 2, 3, 0])]));
    let label = VertexLabel {
        comment: "!ascii label, from subject x".into(),
        vertices: vec![Some(7), None],
        positions: vec![[1.0, -2.5, 0.1], [0.0; 3]],
        values: vec![0.25, 0.0],
    };
    assert_eq!(parse_label(&label_text(&label).unwrap(), "l").unwrap(), label);
    let cut = parse_label("#\n3\n1 0 0 0 0\n", "l").unwrap_err();
    assert!(cut.to_string().contains("after 1 of 3"), "{cut}");
    assert!(
        parse_label("#\n1\n1 0 0 0 0\n2 0 0 0 0\n", "l").is_err()
            && parse_label("#\n1\n1 0 x 0 0\n", "l").is_err()
    );
    let patch = SurfacePatch {
        vertices: vec![0, 9],
        positions: vec![[0.5, 1.0, 0.0], [2.0, 3.0, 0.0]],
        is_border: vec![true, false],
    };
    let bytes = patch_bytes(&patch).unwrap();
    assert_eq!((parse_patch(&bytes, "p").unwrap(), &bytes[8..12]), (patch, &(-1_i32).to_be_bytes()[..]));
}

/// Cut anywhere, and with any byte changed, a file is read or refused, and no size in it asks for memory that it does not fill.
#[test]
fn damaged_files_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str| {
        let path = folder.path().join(name);
        io::write(&path, &dressed()).unwrap();
        std::fs::read(Path::new(&path)).unwrap()
    };
    let annotation = Annotation {
        regions: vec![Some(0), None],
        entries: vec![AnnotationEntry { name: "a".into(), index: 0, color: [1, 2, 3, 0] }],
        source: String::new(),
    };
    let patch = SurfacePatch { vertices: vec![0], positions: vec![[0.5, 1.0, 0.0]], is_border: vec![true] };
    type Parser = fn(&[u8]) -> ricci::Result<usize>;
    let surface: Parser = |bytes| read(bytes).map(|soup| soup.faces.len());
    let files: Vec<(Vec<u8>, Parser)> = vec![
        (written("d.vtk"), surface),
        (written("d.vtp"), surface),
        (written("d.mz3"), surface),
        (freesurfer(), surface),
        (vtp(Storage::Raw, false, true), surface),
        (vtp(Storage::Appended, true, true), surface),
        (values_bytes(&[0.5, 1.0], 2).unwrap(), |bytes| parse_values(bytes, "v").map(|all| all.len())),
        (annotation_bytes(&annotation).unwrap(), |bytes| {
            parse_annotation(bytes, "a").map(|all| all.regions.len())
        }),
        (patch_bytes(&patch).unwrap(), |bytes| parse_patch(bytes, "p").map(|all| all.vertices.len())),
    ];
    for (k, (bytes, parse)) in files.iter().enumerate() {
        assert!(parse(bytes).is_ok(), "file {k}");
        for end in 0..bytes.len() {
            if let Ok(n) = parse(&bytes[..end]) {
                assert!(n <= 4, "file {k} cut at {end}");
            }
            for change in [0x01, 0x80, 0xff] {
                let mut changed = bytes.clone();
                changed[end] ^= change;
                if let Ok(n) = parse(&changed) {
                    assert!(n < 1000, "file {k}, byte {end}: {n}");
                }
            }
        }
    }
}

/// The bytes that digits of base 16 say.
fn hex(text: &str) -> Vec<u8> {
    (0..text.len() / 2).map(|k| u8::from_str_radix(&text[2 * k..2 * k + 2], 16).unwrap()).collect()
}

#[test]
fn bytes_are_those_of_nibabel() {
    // What nibabel 5.4.2 writes of the same values, regions and surface.
    assert_eq!(
        values_bytes(&[0.5, -1.25, 3.0], 2).unwrap(),
        hex("ffffff0000000300000002000000013f000000bfa0000040400000")
    );
    let entry = |name: &str, index, color| AnnotationEntry { name: name.into(), index, color };
    let annotation = Annotation {
        regions: vec![Some(1), None, Some(0), Some(1)],
        entries: vec![entry("unknown", 0, [25, 5, 25, 0]), entry("motor", 1, [1, 2, 3, 0])],
        source: "NOFILE".into(),
    };
    let bytes = hex(
        "00000004000000000003020100000001000000000000000200190519000000030003020100000001fffffffe00000002000000074e4f46\
         494c4500000000020000000000000008756e6b6e6f776e000000001900000005000000190000000000000001000000066d6f746f720000\
         000001000000020000000300000000",
    );
    assert_eq!(annotation_bytes(&annotation).unwrap(), bytes);
    let surface = "fffffe63726561746564206279206e69626162656c0a0a00000004000000040000000000000000000000003fc00000000000000000000000\
                   000000c0100000000000003e0000000000000040600000000000000000000200000001000000000000000100000003000000010000000200\
                   000003000000020000000000000003";
    assert_same(&read(&hex(surface)).unwrap(), "nibabel");
}

//! Tests of every format: files read back as written, dialects are understood, truncated and absurd files are refused.

use crate::common;
use crate::common::Random;
use proptest::prelude::{any, prop, proptest};
use ricci::control::Control;
use ricci::mesh::io::{self, Attributes, Soup};
use ricci::mesh::repair::{Repair, repair};
use ricci::mesh::{Mesh, shapes};
use ricci::{Error, FilePosition};
use std::path::Path;

/// A tetrahedron with an isolated vertex, and an attribute of each kind.
fn decorated() -> Soup {
    let mut random = Random::new(9);
    let mut number = || (random.symmetric() * 1e3).exp2().recip() + 0.1;
    let positions = (0..5).map(|_| [number(), -number(), number()]).collect();
    let mut soup = Soup::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    soup.attributes = Attributes {
        normals: Some((0..5).map(|v| [0.0, 0.6, if v == 4 { 0.0 } else { 0.8 }]).collect()),
        colors: Some((0..5).map(|v| [f64::from(v) / 5.0, 1.0, 0.0, 0.6]).collect()),
        uv: Some((0..4).map(|f| [[0.1, f64::from(f)], [0.2, 0.3], [1.0 / 3.0, 0.4]]).collect()),
        ..Attributes::default()
    };
    soup
}

#[test]
fn what_is_written_reads_back_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let soup = decorated();
    io::write_ply(&at("m.ply"), &soup).unwrap();
    assert_eq!(io::read(&at("m.ply")).unwrap(), soup);
    // OFF has texture coordinates per vertex only.
    let mut single = soup.clone();
    let at_vertex = |v: u32| [f64::from(v), 1.0 / 3.0];
    single.attributes.uv = Some(single.faces.iter().map(|f| f.map(at_vertex)).collect());
    io::write_off(&at("m.off"), &single).unwrap();
    assert_eq!(io::read(&at("m.off")).unwrap(), single);
    io::write_off(&at("m.off"), &soup).unwrap();
    assert_eq!(
        io::read(&at("m.off")).unwrap().attributes,
        Attributes { uv: None, ..soup.attributes.clone() }
    );
    // OBJ has colours of six decimals; the isolated vertex has no corner to name its normal.
    io::write(&at("m.obj"), &soup).unwrap();
    let back = io::read(&at("m.obj")).unwrap();
    assert!(back.positions == soup.positions && back.faces == soup.faces);
    assert!(back.attributes.uv == soup.attributes.uv && back.attributes.colors == soup.attributes.colors);
    assert_eq!(back.attributes.normals.unwrap()[..4], soup.attributes.normals.as_ref().unwrap()[..4]);
    // GLB has 32 bits, normals of length 1 and v downwards; here no vertex has two pairs of texture coordinates.
    io::write(&at("m.glb"), &single).unwrap();
    let back = io::read(&at("m.glb")).unwrap();
    let close =
        |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-7) && a.len() == b.len();
    assert_eq!(back.faces, single.faces);
    let (ours, theirs) = (&single.attributes, &back.attributes);
    let flat = |uv: &Option<Vec<[[f64; 2]; 3]>>| uv.as_ref().unwrap().as_flattened().as_flattened().to_vec();
    assert!(close(&flat(&theirs.uv), &flat(&ours.uv)));
    let flat = |colors: &Option<Vec<[f64; 4]>>| colors.as_ref().unwrap().as_flattened().to_vec();
    assert!(close(&flat(&theirs.colors), &flat(&ours.colors)));
    let (normals, unit) = (theirs.normals.as_ref().unwrap(), ours.normals.as_ref().unwrap());
    assert!(close(normals[..4].as_flattened(), unit[..4].as_flattened()));
    assert_eq!(normals[4], [0.0, 1.0, 0.0]);
    assert!(matches!(io::write(&at("m.stl"), &soup), Err(Error::UnknownFormat { .. })));
    for shape in [shapes::genus(2, 3).unwrap(), shapes::disk(3).unwrap()] {
        io::write_ply(&at("s.ply"), &shape).unwrap();
        io::write_off(&at("s.off"), &shape).unwrap();
        assert_eq!(io::read(&at("s.ply")).unwrap(), shape);
        assert_eq!(io::read(&at("s.off")).unwrap(), shape);
    }
}

#[test]
fn every_good_mesh_is_the_same_in_every_format() {
    let Some((folder, rows)) = common::index("good") else { return };
    let out = tempfile::tempdir().unwrap();
    for row in &rows {
        let soup = io::read(&folder.join(&row["file"])).unwrap();
        for name in ["m.ply", "m.off", "m.obj"] {
            let path = out.path().join(name);
            io::write(&path, &soup).unwrap();
            let back = io::read(&path).unwrap();
            assert!(
                back.positions == soup.positions && back.faces == soup.faces,
                "{} as {name}",
                row["name"]
            );
        }
        // GLB keeps 24 bits of the distance from the centre along each axis.
        let plain = Soup::new(soup.positions.clone(), soup.faces.clone());
        let path = out.path().join("m.glb");
        io::write(&path, &plain).unwrap();
        let back = io::read(&path).unwrap();
        assert!(back.faces == soup.faces && back.positions.len() == soup.positions.len(), "{}", row["name"]);
        for k in 0..3 {
            let coordinates = || soup.positions.iter().map(|p| p[k]);
            let (low, high) =
                (coordinates().fold(f64::MAX, f64::min), coordinates().fold(f64::MIN, f64::max));
            let allowed = 0.5 * (high - low) * 2f64.powi(-24) + low.abs().max(high.abs()) * 2f64.powi(-52);
            let off = back.positions.iter().map(|p| p[k]).zip(coordinates()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) <= allowed, "{}", row["name"]);
        }
    }
}

#[test]
fn what_cannot_be_written_is_refused_and_leaves_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut bad = vec![decorated(), decorated(), decorated(), decorated()];
    bad[0].positions[3][1] = f64::NAN;
    bad[1].faces[2][0] = 5;
    bad[2].attributes.normals.as_mut().unwrap().pop();
    bad[3].attributes.uv.as_mut().unwrap()[1][2][0] = f64::INFINITY;
    for (name, write) in [("m.ply", io::write_ply as fn(&Path, &Soup) -> _), ("m.off", io::write_off)] {
        let path = folder.path().join(name);
        write(&path, &decorated()).unwrap();
        let before = std::fs::read(&path).unwrap();
        for soup in &bad {
            assert!(matches!(write(&path, soup), Err(Error::Argument { .. } | Error::Size { .. })));
        }
        assert_eq!(std::fs::read(&path).unwrap(), before);
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().filter(|e| e.as_ref().unwrap().path() != path).count(),
            usize::from(name == "m.off")
        );
    }
}

/// A square as PLY in three encodings, with an unknown element in front and unknown properties around.
fn square_ply(encoding: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\r\nformat {encoding} 1.0 \r\ncomment by hand\r\nelement camera 1\r\nproperty float f\r\n\
         property list uchar short l\r\nelement vertex 4\r\nproperty double x\r\nproperty float y\r\n\
         property short z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n\
         property float quality\r\nelement face 1\r\nproperty uchar flags\r\nproperty list ushort int vertex_index\r\n\
         end_header\r\n"
    )
    .into_bytes();
    let corners: [[f64; 2]; 4] = [[0.1, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    if encoding == "ascii" {
        bytes.extend(b"0.5 2 7 8\r\n");
        for [x, y] in corners {
            bytes.extend(format!("{x} {y} -3 255 0 51 0.25\r\n").into_bytes());
        }
        bytes.extend(b"9 4 0 1 2 3\r\n");
        return bytes;
    }
    let little = encoding == "binary_little_endian";
    let mut put = |be: &[u8]| {
        let mut word = be.to_vec();
        if little {
            word.reverse();
        }
        bytes.extend(word);
    };
    put(&0.5f32.to_be_bytes());
    put(&[2]);
    put(&7i16.to_be_bytes());
    put(&8i16.to_be_bytes());
    for [x, y] in corners {
        put(&x.to_be_bytes());
        put(&(y as f32).to_be_bytes());
        put(&(-3i16).to_be_bytes());
        [255u8, 0, 51].iter().for_each(|c| put(&[*c]));
        put(&0.25f32.to_be_bytes());
    }
    put(&[9]);
    put(&4u16.to_be_bytes());
    (0..4i32).for_each(|v| put(&v.to_be_bytes()));
    bytes
}

#[test]
fn ply_is_read_in_all_its_encodings() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let bytes = square_ply(encoding);
        let soup = io::parse_ply(&bytes, "t.ply").unwrap();
        assert_eq!(soup.positions, [[0.1, 0.0, -3.0], [1.0, 0.0, -3.0], [1.0, 1.0, -3.0], [0.0, 1.0, -3.0]]);
        assert_eq!(soup.faces, [[0, 1, 2], [0, 2, 3]], "{encoding}");
        assert_eq!(soup.attributes.colors.unwrap()[2], [1.0, 0.0, 0.2, 1.0]);
        assert_eq!((soup.attributes.normals, soup.attributes.uv), (None, None));
        // Truncated anywhere it is an error, never a panic and never a smaller mesh.
        for end in 0..bytes.len() - 2 {
            assert!(io::parse_ply(&bytes[..end], "t.ply").is_err(), "{encoding} cut at {end}");
        }
    }
}

#[test]
fn ply_headers_are_not_trusted() {
    for (text, says) in [
        ("", "no PLY file"),
        ("solid\n", "no PLY file"),
        ("ply\nformat ascii 1.0\n", "end_header"),
        ("ply\nformat ascii 1.0\nend_header\n", "no element `vertex`"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
            "no property `z`",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
            "ends inside element `vertex` of 99999999999999 rows",
        ),
        (
            "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}",
            "ends inside element `face` of 1 rows",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 -1 0\n",
            "face 0 names vertex -1",
        ),
    ] {
        let Err(Error::Parse { message, .. }) = io::parse_ply(text.as_bytes(), "t.ply") else {
            panic!("{text}")
        };
        assert!(message.contains(says), "{message}");
    }
    // An empty element with 10¹⁸ rows.
    let empty = "ply\nformat binary_big_endian 1.0\nelement void 1000000000000000000\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    assert_eq!(io::parse_ply(empty.as_bytes(), "t.ply").unwrap(), Soup::default());
}

#[test]
fn triangle_strips_turn_every_other_triangle_around() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
               element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n10 0 1 2 3 -1 2 3 4 4 5\n";
    let soup = io::parse_ply(ply.as_bytes(), "t.ply").unwrap();
    assert_eq!(soup.faces, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

const ASCII_STL: &str = "solid two triangles\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n  endloop\n endfacet\n\
  FACET normal 0 0 1\n  OUTER LOOP\n   VERTEX 0 0 -0\n   vertex 1 1 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid two triangles\n";

fn binary_stl(header: &[u8], triangles: &[[[f32; 3]; 3]], count: u32) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for triangle in triangles {
        bytes.extend([0u8; 12]);
        bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    bytes
}

#[test]
fn stl_is_welded_where_corners_are_in_one_place() {
    let (a, b, c, d) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    let expected =
        Soup::new([a, b, c, d].map(|p: [f32; 3]| p.map(f64::from)).to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    assert_eq!(io::parse_stl(ASCII_STL.as_bytes(), "t.stl").unwrap(), expected);
    // A binary file may begin with `solid` too.
    for header in [&b"solid by some CAD program"[..], b"binary"] {
        let bytes = binary_stl(header, &[[a, b, c], [[-0.0, 0.0, 0.0], c, d]], 2);
        assert_eq!(io::parse_stl(&bytes, "t.stl").unwrap(), expected);
    }
}

#[test]
fn stl_is_welded_within_a_distance_on_request() {
    let (a, b, c, d) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    let near = |p: [f32; 3]| [p[0] + 1e-3, p[1], p[2]];
    // Two triangles with a slit between them, and one that is smaller than the slit.
    let bytes = binary_stl(b"x", &[[a, b, c], [near(a), near(c), d], [d, near(d), d]], 3);
    assert_eq!(io::parse_stl(&bytes, "t.stl").unwrap().positions.len(), 7);
    let welded = io::parse_stl_welded(&bytes, "t.stl", 2e-3).unwrap();
    assert_eq!(
        welded,
        Soup::new([a, b, c, d].map(|p| p.map(f64::from)).to_vec(), vec![[0, 1, 2], [0, 2, 3], [3, 3, 3]])
    );
    assert_eq!(io::parse_stl_welded(&bytes, "t.stl", 0.0), io::parse_stl(&bytes, "t.stl"));
    assert_eq!(io::SurfaceFile::of_bytes(bytes.clone(), "x").unwrap().welded(2e-3).unwrap(), welded);
    for weld in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            io::parse_stl_welded(&bytes, "t.stl", weld),
            Err(Error::Argument { what: "weld", .. })
        ));
    }
}

#[test]
fn stl_that_is_cut_off_or_garbled_names_the_place() {
    let triangle = [[0.0f32; 3]; 3];
    for (bytes, place, says) in [
        (Vec::new(), FilePosition::Whole, "no STL file"),
        (b"plain text".to_vec(), FilePosition::Line(1), "no STL file"),
        (binary_stl(b"x", &[triangle], 2), FilePosition::Byte(134), "in triangle 1 of the 2"),
        (binary_stl(b"x", &[triangle], u32::MAX), FilePosition::Byte(134), "in triangle 1 of the 4294967295"),
        (
            ASCII_STL.replace("1 1 0\n  endloop", "1 one 0\n  endloop").into_bytes(),
            FilePosition::Line(6),
            "`one` is not a number",
        ),
        (
            ASCII_STL.replacen("vertex", "vortex", 1).into_bytes(),
            FilePosition::Line(4),
            "`vortex` has no place",
        ),
        (
            ASCII_STL.split("  endloop").next().unwrap().as_bytes().to_vec(),
            FilePosition::Line(6),
            "ends inside a loop",
        ),
    ] {
        let Err(Error::Parse { message, at, .. }) = io::parse_stl(&bytes, "t.stl") else { panic!("{says}") };
        assert!(message.contains(says) && at == place, "{at}: {message}");
    }
}

#[test]
fn obj_and_off_attributes_are_kept() {
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nf 1/1/1 2/2/1 3/-1/-1\n";
    let soup = io::parse_obj(obj.as_bytes(), "t.obj").unwrap();
    let Attributes { normals, colors, uv, .. } = soup.attributes;
    assert_eq!(normals, Some(vec![[0.0, 0.0, 2.0]; 3]));
    assert_eq!(colors.unwrap()[1], [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(uv, Some(vec![[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]]));
    // Missing, invalid and out-of-range values get the default; the rest is kept.
    let poor = "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 nan 0 0\nvt 0 0\nvn 0 0 1\nvn 0 1 0\nf 1/1/1 2/7/1 3//1\nf 1//2 3//1 2//1\n";
    let soup = io::parse_obj(poor.as_bytes(), "t.obj").unwrap();
    let Attributes { normals, corner_normals, colors, uv, .. } = soup.attributes;
    assert_eq!(colors.unwrap(), [[1.0, 0.0, 0.0, 1.0], [1.0; 4], [1.0; 4]]);
    assert_eq!((normals, uv), (None, Some(vec![[[0.0; 2]; 3]; 2])));
    assert_eq!(
        corner_normals.unwrap(),
        [[[0.0, 0.0, 1.0]; 3], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]]
    );
    let off = "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 0.5 0.25\n1 0 0 0 0 1 0 255 0 1 0\n1 1 0 0 0 1 0 0 255 1 1\n3 0 1 2\n";
    let Attributes { normals, colors, uv, .. } = io::parse_off(off.as_bytes(), "t.off").unwrap().attributes;
    assert_eq!(normals, Some(vec![[0.0, 0.0, 1.0]; 3]));
    assert_eq!(colors.unwrap()[0], [1.0, 0.0, 0.2, 1.0]);
    assert_eq!(uv.unwrap()[0][0], [0.5, 0.25]);
}

/// A triangle as OpenMesh 9 writes `STCNOFF BINARY`: host order, colours as three integers, no colours of faces.
#[test]
fn binary_off_has_colours_of_bytes_too() {
    let vertex = |x: f32, y: f32| -> Vec<u32> {
        let floats = |list: &[f32]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        [floats(&[x, y, 0.5, 0.0, 0.0, 1.0]), vec![0, 51, 255], floats(&[x, 0.25])].concat()
    };
    let words =
        [vec![3, 1, 0], vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(0.0, 1.0), vec![3, 0, 1, 2]].concat();
    for order in [u32::to_le_bytes, u32::to_be_bytes] {
        let data: Vec<u8> = words.iter().flat_map(|&w| order(w)).collect();
        let soup = io::parse_off(&[b"STCNOFF BINARY\n", &data[..]].concat(), "t.off").unwrap();
        assert_eq!((soup.positions[1], soup.faces), ([1.0, 0.0, 0.5], vec![[0, 1, 2]]));
        let Attributes { normals, colors, uv, .. } = soup.attributes;
        assert_eq!(normals.unwrap()[2], [0.0, 0.0, 1.0]);
        assert_eq!(colors.unwrap()[2], [0.0, 0.2, 1.0, 1.0]);
        assert_eq!(uv.unwrap(), [[[0.0, 0.25], [1.0, 0.25], [0.0, 0.25]]]);
    }
}

/// An accepted file must be consistent: it builds a valid mesh or names its defects, it is repaired or refused, and it reads back as it
/// was written.
fn accepted(soup: &Soup) {
    if let Ok(mesh) = Mesh::from_soup(soup) {
        mesh.validate().unwrap();
    }
    if let Ok(done) = repair(soup, &Repair::default(), &Control::new()) {
        let sound = done.diagnosis.defects.is_empty();
        assert_eq!(Mesh::from_soup(&done.soup).is_ok(), sound);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.ply");
    if io::write(&path, soup).is_ok() {
        let back = io::read(&path).unwrap();
        assert!(back.positions == soup.positions && back.faces == soup.faces);
    }
}

/// A small file with attributes, made by this library's writer.
fn glb() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    io::write(&path, &decorated()).unwrap();
    std::fs::read(&path).unwrap()
}

fn gifti(encoding: &str, points: &str, triangle: &str) -> Vec<u8> {
    let array = |intent: &str, kind: &str, n: usize, data: &str| {
        format!(
            "<DataArray Intent=\"NIFTI_INTENT_{intent}\" DataType=\"NIFTI_TYPE_{kind}\" Encoding=\"{encoding}\" \
             Dimensionality=\"2\" Dim0=\"{n}\" Dim1=\"3\"><Data>{data}</Data></DataArray>"
        )
    };
    let arrays = array("POINTSET", "FLOAT32", 3, points) + &array("TRIANGLE", "INT32", 1, triangle);
    format!("<GIFTI>{arrays}</GIFTI>").into_bytes()
}

/// A valid file of each kind.
fn sample(which: usize) -> Vec<u8> {
    let (a, b, c) = ([0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]);
    match which {
        0 => square_ply("ascii"),
        1 => square_ply("binary_little_endian"),
        2 => square_ply("binary_big_endian"),
        3 => ASCII_STL.as_bytes().to_vec(),
        4 => binary_stl(b"solid", &[[a, b, c], [c, b, a]], 2),
        5 => glb(),
        6 => gifti("ASCII", "0 0 0 1 0 0 0 1 0", "0 1 2"),
        7 => gifti("GZipBase64Binary", "eJxjYEAGDfYMWPgAFIoBfw==", "eJxjYGBgYARiJiAGAAAcAAQ="),
        _ => b"STCNOFF\n3 2 0\n0 0 0 0 0 1 255 0 51 0.5 0.25\n1 0 0 0 0 1 0 255 0 1 0\n1 1 0 0 0 1 0 0 255 1 1\n3 0 1 2\n4 0 1 2 0\n".to_vec(),
    }
}

#[test]
fn the_samples_are_sound() {
    let parsers = [io::parse_ply, io::parse_stl, io::parse_off, io::parse_glb, io::parse_gifti];
    for which in 0..9 {
        let bytes = sample(which);
        let read = parsers.iter().find_map(|parse| parse(&bytes, "t").ok());
        assert!(read.is_some_and(|soup| !soup.faces.is_empty()), "sample {which}");
    }
}

proptest! {
    #[test]
    fn damaged_files_are_read_whole_or_refused(
        which in 0usize..9,
        damage in prop::collection::vec((0usize..2000, any::<u8>()), 0..6),
        cut in 0usize..4000,
    ) {
        let mut bytes = sample(which);
        for (at, byte) in damage {
            let n = bytes.len();
            bytes[at % n] = byte;
        }
        bytes.truncate(bytes.len().min(cut));
        let stl = |bytes: &[u8], path: &str| io::parse_stl_welded(bytes, path, 0.1);
        for parse in [io::parse_ply, io::parse_stl, stl, io::parse_off, io::parse_obj, io::parse_glb, io::parse_gifti] {
            if let Ok(soup) = parse(&bytes, "t") {
                accepted(&soup);
            }
        }
    }
}

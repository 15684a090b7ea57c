//! Tests of odd and ordinary files of other programs: they are read, or refused with the position of the fault.

use ricci::mesh::io::{self, Soup};
use ricci::{Error, FilePosition, Result};
use std::time::Instant;

const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]];

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const BODY: &str = "0 0 0\n1 0 0\n0 0.5 0\n3 0 1 2\n";

fn ply(text: &str) -> Result<Soup> {
    io::parse_ply(text.as_bytes(), "t.ply")
}

fn place(result: Result<Soup>) -> (FilePosition, String) {
    match result {
        Err(Error::Parse { at, message, .. }) => (at, message),
        other => panic!("{other:?}"),
    }
}

#[test]
fn ascii_ply_of_other_programs_is_read() {
    let plain = HEADER.to_string() + BODY;
    let column = |name: &str| {
        let header = HEADER.replace("float z\n", &format!("float z\nproperty float {name}\n"));
        header + "0 0 0 1\n1 0 0 nan\n0 0.5 0 .1\n3 0 1 2\n"
    };
    for text in [
        plain.clone(),
        plain.replace("0 0.5 0", "0 .5 0"),
        plain.replace("1 0 0", "1. +0 -0"),
        column("scalar_d(m)"),
        column("a.b"),
        column("2nd"),
        plain.replace("1 0 0\n", "\n1 0 0\n\n"),
        plain.replace("element face", "\n\nelement face"),
        plain.replace("property", "  property\t"),
        plain.replace('\n', "\r"),
        plain.replace('\n', "\r\n"),
        plain.replace("float x", "float X").replace("float y", "double Y"),
        plain.replace("0 1 2", "0 1.0 2"),
        plain.replace("1 0 0\n", "1 0 0 7 8 9\n"),
        plain.replace("comment", "comment \u{e9}"),
        format!("\u{feff}{plain}"),
    ] {
        let soup = ply(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!((&soup.positions[..], &soup.faces[..]), (&TRIANGLE[..], &[[0, 1, 2]][..]), "{text}");
    }
    // The reader accepts `nan` as a number; the diagnosis finds it.
    for word in ["nan", "inf", "-inf", "NaN"] {
        assert!(!ply(&plain.replace("1 0 0", &format!("1 {word} 0"))).unwrap().positions[1][1].is_finite());
    }
    // Colours under their other names.
    let header = HEADER.replace(
        "float z\n",
        "float z\nproperty uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n",
    );
    let soup = ply(&(header + "0 0 0 255 0 51\n1 0 0 0 0 0\n0 0.5 0 1 2 3\n3 0 1 2\n")).unwrap();
    assert_eq!(soup.attributes.colors.unwrap()[0], [1.0, 0.0, 0.2, 1.0]);
}

#[test]
fn ply_errors_name_the_line_or_the_byte_and_quote_little() {
    let plain = HEADER.to_string() + BODY;
    for (text, at, says) in [
        (
            plain.replace("1 0 0\n", "1 0\n"),
            FilePosition::Line(11),
            "row 1 of element `vertex` ends before `z`",
        ),
        (
            plain.replace("1 0 0\n", "1 0 x\n"),
            FilePosition::Line(11),
            "`z` of row 1 of element `vertex`: `x` is not",
        ),
        (plain.replace("3 0 1 2", "3 0 1 -2"), FilePosition::Line(13), "face 0 names vertex -2"),
        (plain.replace("3 0 1 2", "3 0 1 1.5"), FilePosition::Line(13), "face 0 names vertex 1.5"),
        (
            plain.replace("3 0 1 2", "-3 0 1 2"),
            FilePosition::Line(13),
            "list `vertex_indices` of row 0 has -3 entries",
        ),
        // Two vertices on one line are not two rows.
        (plain.replace("0 0 0\n1", "0 0 0 1"), FilePosition::Line(12), "ends inside element `face`"),
        (plain.replace("element face", "element vertex"), FilePosition::Line(7), "a second element `vertex`"),
        (
            plain.replace("property list uchar int vertex_indices\n", ""),
            FilePosition::Line(7),
            "no list property",
        ),
        (plain.replace("float y", "flout y"), FilePosition::Line(5), "`flout` is no type"),
        (plain.replace("format ascii 1.0\n", ""), FilePosition::Line(8), "no line `format`"),
        (
            plain.replace("element vertex 3", "element vertex -3"),
            FilePosition::Line(3),
            "`-3` is not a count",
        ),
    ] {
        let (found, message) = place(ply(&text));
        assert!(found == at && message.contains(says), "{found}: {message}");
    }
    let (at, message) = place(ply(&plain.replace("1 0 0\n", &format!("1 0 {}\n", "x".repeat(3_000_000)))));
    assert!(at == FilePosition::Line(11) && message.len() < 200, "{} bytes", message.len());
    // A binary file: corner 2 of face 1 is −7, and cut off in its second face.
    let header = HEADER.replace("ascii", "binary_little_endian").replace("face 1", "face 2");
    let mut bytes = header.clone().into_bytes();
    bytes.extend(TRIANGLE.as_flattened().iter().flat_map(|&x| (x as f32).to_le_bytes()));
    for corners in [[0i32, 1, 2], [0, 1, -7]] {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|v| v.to_le_bytes()));
    }
    let second = header.len() + 36 + 13;
    let error = io::parse_ply(&bytes, "t.ply").unwrap_err().to_string();
    assert_eq!(error, format!("t.ply, byte {second}: face 1 names vertex -7, which cannot be"));
    let (at, message) = place(io::parse_ply(&bytes[..second + 6], "t.ply"));
    assert!(
        at == FilePosition::Byte(second + 6) && message.contains("ends inside element `face` of 2"),
        "{message}"
    );
}

#[test]
fn elements_without_properties_take_no_time() {
    let header = HEADER.replace("ascii", "binary_little_endian").replace("vertex 3", "vertex 0");
    let header = header.replace("property list uchar int vertex_indices\n", "");
    let start = Instant::now();
    for (name, refused) in [("face", true), ("tristrips", true), ("void", false)] {
        for count in [1_000_000_000u64, 1_000_000_000_000_000] {
            let text = header.replace("face 1", &format!("{name} {count}"));
            assert_eq!(ply(&text).is_err(), refused, "{text}");
            assert_eq!(ply(&text.replace("binary_little_endian", "ascii")).is_err(), refused, "{text}");
        }
        assert_eq!(ply(&header.replace("face 1", &format!("{name} 0"))).unwrap(), Soup::default());
    }
    // The time of one such file would be minutes.
    assert!(start.elapsed().as_secs() < 5);
}

const FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0.5 0\nendloop\nendfacet\n";

fn stl(bytes: &[u8]) -> Result<Soup> {
    io::parse_stl(bytes, "t.stl")
}

#[test]
fn ascii_stl_is_read_by_its_words() {
    let plain = format!("solid a\n{FACET}endsolid a\n");
    for text in [
        plain.clone(),
        plain.replace('\n', " "),
        plain.replace("loop\nvertex", "loop vertex"),
        plain.replace("1\nouter", "1 outer"),
        plain.replace("0\nvertex", "0 vertex"),
        plain.replace("1 0 0", "1\n0\n0"),
        format!("\u{feff}{plain}"),
        plain.to_ascii_uppercase(),
        plain.replace("endsolid a\n", ""),
        plain.replace("solid a", "solid a facet of the moon"),
        plain.replace("normal 0 0 1", "normal -nan(ind) -1.#IND 0"),
        plain.replace("solid a", "solid"),
        FACET.into(),
        format!("\u{c}{}", plain.replace('\n', "\r")),
    ] {
        let soup = stl(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!((&soup.positions[..], &soup.faces[..]), (&TRIANGLE[..], &[[0, 1, 2]][..]), "{text}");
    }
    let two = format!("solid a\n{FACET}endsolid a\nsolid b\n{FACET}endsolid b\n");
    for text in [two.clone(), two.replace('\n', " ")] {
        assert_eq!(stl(text.as_bytes()).unwrap().faces, [[0, 1, 2]; 2]);
    }
    for empty in ["solid a\nendsolid a\n", "solid a endsolid a"] {
        assert_eq!(stl(empty.as_bytes()).unwrap(), Soup::default());
    }
    for (text, at, says) in [
        ("solid a\n".into(), FilePosition::Line(1), "neither a facet"),
        (format!("solid a\n{FACET}facet normal"), FilePosition::Line(9), "inside a facet"),
        (plain.replace("outer loop", "outer\nlop"), FilePosition::Line(4), "`lop` has no place"),
        (plain.replace("outer loop\n", ""), FilePosition::Line(8), "ends inside a facet"),
        (plain.replace("vertex 1 0 0", "vertex 1 0"), FilePosition::Line(6), "`vertex` is not a number"),
    ] {
        let (found, message) = place(stl(text.as_bytes()));
        assert!(found == at && message.contains(says), "{found}: {message}");
    }
}

#[test]
fn binary_stl_is_binary_whatever_its_header_says() {
    let file = |header: &str, triangles: u8, count: u32, more: usize| {
        let mut bytes = header.as_bytes().to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        for i in 0..triangles {
            let x = f32::from(i);
            let numbers = [0.0, 0.0, 1.0, x, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, 1.0, 0.0];
            bytes.extend(numbers.iter().flat_map(|x: &f32| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes.resize(bytes.len() + more, 0);
        bytes
    };
    for header in ["by hand", "solid x", "solid facet"] {
        // The announced number, with part of a triangle after it, and a number that was never filled in.
        for (count, more) in [(4, 0), (4, 2), (4, 49), (0, 0)] {
            assert_eq!(stl(&file(header, 4, count, more)).unwrap().faces.len(), 4, "{header} {count} {more}");
        }
        assert_eq!(stl(&file(header, 0, 0, 0)).unwrap(), Soup::default());
        for (count, more, at, says) in [
            (5, 0, 284, "ends in triangle 4 of the 5"),
            (5, 49, 333, "ends in triangle 4 of the 5"),
            (2, 0, 80, "promises 2 triangles, behind it are 4 and 0 bytes"),
            (0, 7, 80, "promises 0 triangles, behind it are 4 and 7 bytes"),
        ] {
            let (found, message) = place(stl(&file(header, 4, count, more)));
            assert!(found == FilePosition::Byte(at) && message.contains(says), "{found}: {message}");
        }
    }
}

#[test]
fn vertices_of_off_may_share_a_line_and_its_header_be_small() {
    let off = |text: &str| io::parse_off(text.as_bytes(), "t.off");
    let plain = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 0.5 0\n3 0 1 2\n";
    for text in [
        plain.into(),
        plain.replace("0 0 0\n1", "0 0 0  1"),
        plain.replace("0\n1 0 0\n0", "0 1 0 0 0"),
        plain.replace("OFF", "off"),
        plain.replace("OFF", "coff"),
        // Columns that the header does not announce.
        plain.replace("1 0 0", "1 0 0 255 0 0").replace("0 0.5 0", "0 0.5 0 0 255 0"),
    ] {
        let soup = off(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!((&soup.positions[..], &soup.faces[..]), (&TRIANGLE[..], &[[0, 1, 2]][..]), "{text}");
    }
    // The error of the first reading is reported.
    let (at, message) = place(off(&plain.replace("1 0 0\n", "1 0\n")));
    assert!(
        at == FilePosition::Line(6) && message.contains("size of face 0 (of 1) is missing"),
        "{at}: {message}"
    );
}

#[test]
fn a_coordinate_that_is_not_finite_is_one_in_every_text_format() {
    for word in ["nan", "-nan(ind)", "1.#IND", "-1.#IND", "1.#QNAN0", "#QNAN", "1.#INF", "-1.#INF00"] {
        let obj = format!("v 0 0 0\nv 1 0 0 # last\nv 0 {word} 0\nf 1 2 3\n");
        let off = format!("OFF\n3 1 0\n0 0 0\n1 0 0 # last\n0 {word} 0\n3 0 1 2\n");
        let ply = HEADER.to_string() + &BODY.replace("0 0.5 0", &format!("0 {word} 0"));
        let stl = FACET.replace("0 0.5 0", &format!("0 {word} 0"));
        for (name, soup) in [
            ("obj", io::parse_obj(obj.as_bytes(), "t")),
            ("off", io::parse_off(off.as_bytes(), "t")),
            ("ply", io::parse_ply(ply.as_bytes(), "t")),
            ("stl", io::parse_stl(stl.as_bytes(), "t")),
        ] {
            let soup = soup.unwrap_or_else(|e| panic!("{name} {word}: {e}"));
            let finite: Vec<bool> = soup.positions.iter().map(|p| p[1].is_finite()).collect();
            assert_eq!(finite, [true, true, false], "{name} {word}");
        }
    }
}

#[test]
fn attributes_that_are_not_finite_are_left_out_and_said() {
    let header =
        HEADER.replace("float z\n", "float z\nproperty float nx\nproperty float ny\nproperty float nz\n");
    let soup = ply(&(header + "0 0 0 nan nan nan\n1 0 0 0 0 1\n0 0.5 0 0 0 1\n3 0 1 2\n")).unwrap();
    assert_eq!(soup.positions, TRIANGLE);
    assert!(soup.attributes.normals.is_none());
    assert_eq!(soup.attributes.unread, ["normals: 1 of 3 are not finite, the first at vertex 0 (from 0)"]);
}

#[test]
fn a_file_by_name_and_its_bytes_are_read_alike() {
    let folder = tempfile::tempdir().unwrap();
    let facets = format!("SOLID A\n{}END SOLID\n", FACET.to_ascii_uppercase().replace("ENDLOOP", "END LOOP"));
    for (name, text) in [
        ("t.stl", facets),
        ("b.stl", format!("\u{feff}solid a\n{FACET}endsolid\n")),
        ("t.off", "3 1 0\n0 0 0\n1 0 0\n0 0.5 0\n3 0 1 2\n".into()),
        ("t.ply", HEADER.to_string() + BODY),
        // A mark is stronger than a name.
        ("ply.obj", HEADER.to_string() + BODY),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, &text).unwrap();
        let by_name = io::read(&path).unwrap();
        assert_eq!((&by_name.positions[..], &by_name.faces[..]), (&TRIANGLE[..], &[[0, 1, 2]][..]), "{name}");
        let file = io::SurfaceFile::of_bytes(text.into_bytes(), "bytes").unwrap();
        assert_eq!(file.soup().unwrap(), by_name, "{name}");
    }
    let metric = io::SurfaceFile::of_bytes(b" {\"faces\": []}".to_vec(), "m").unwrap();
    assert_eq!(metric.format(), io::SurfaceFormat::Metric);
    assert!(matches!(metric.soup(), Err(Error::UnknownFormat { .. })));
}

/// A star of `n` corners, every other of which turns inwards.
fn star(n: usize) -> String {
    let point = |i: usize| {
        let (t, r) = (i as f64 / n as f64 * std::f64::consts::TAU, [1.0, 0.9][i % 2]);
        format!("v {} {} 0\n", r * t.cos(), r * t.sin())
    };
    (0..n).map(point).collect()
}

#[test]
fn the_time_of_a_corner_grows_no_faster_than_its_polygon() {
    // As many corners in all, read together; the least of several times, which other work on the machine disturbs least.
    let read = |corners: usize| {
        let polygon: String = (1..=corners).map(|v| format!(" {v}")).collect();
        let text = star(corners) + &format!("f{polygon}\n").repeat(50_000 / corners);
        let once = || {
            let start = Instant::now();
            let soup = io::parse_obj(text.as_bytes(), "t.obj").unwrap();
            (start.elapsed().as_secs_f64(), soup)
        };
        let soup = once().1;
        assert_eq!(soup.faces.len(), 50_000 / corners * (corners - 2));
        let double_area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|v| soup.positions[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        assert!(soup.faces.iter().all(|&f| double_area(f) > 0.0));
        (0..5).map(|_| once().0).fold(f64::INFINITY, f64::min)
    };
    let ratio = read(1000) / read(100);
    // Polygons ten times as large: 6 to 7 when this was written. Where every corner is examined again for each ear, the large ones take twelve
    // times as long.
    assert!(ratio < 20.0, "{ratio}");
}

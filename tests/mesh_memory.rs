//! Tests that reading any file, however it is made, takes at most 64 MB and 20 times its size in memory.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use ricci::Result;
use ricci::mesh::io::{self, Attributes, Soup};
use ricci::mesh::shapes;
use serde_json::{Value, json};
use std::io::Write;
use std::process::Command;

const MB: usize = 1 << 20;

/// A line of /proc/self/status, in bytes.
fn status(name: &str) -> usize {
    let text = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = text.lines().find(|l| l.starts_with(name)).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<usize>().unwrap() << 10
}

type Parse = fn(&[u8], &str) -> Result<Soup>;

/// A file that is made when its turn comes.
struct Case {
    what: String,
    make: Box<dyn Fn() -> Vec<u8>>,
    parse: Parse,
    /// The expected result of reading; `None` where both are allowed.
    read: Option<bool>,
}

impl Case {
    fn new(
        what: impl Into<String>,
        parse: Parse,
        read: Option<bool>,
        make: impl Fn() -> Vec<u8> + 'static,
    ) -> Case {
        Case { what: what.into(), make: Box::new(make), parse, read }
    }

    /// Reads the file, and checks the memory that this takes.
    fn check(&self) {
        let bytes = (self.make)();
        // Resets the high-water mark to the memory that is used now.
        std::fs::write("/proc/self/clear_refs", "5").unwrap();
        let before = status("VmRSS:");
        let result = (self.parse)(&bytes, "t");
        let taken = status("VmHWM:").saturating_sub(before) + bytes.len();
        let allowed = 64 * MB + 20 * bytes.len();
        eprintln!(
            "{}: {:.1} MB file, {} MB taken, {} MB allowed, {}",
            self.what,
            bytes.len() as f64 / MB as f64,
            taken / MB,
            allowed / MB,
            if result.is_ok() { "read" } else { "refused" }
        );
        assert!(taken <= allowed, "{}", self.what);
        assert!(self.read.is_none_or(|read| read == result.is_ok()), "{}: {:?}", self.what, result.err());
    }
}

fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |n: usize| (n as u32).to_le_bytes();
    let total = 28 + text.len() + binary.len();
    let parts: [&[u8]; 8] = [
        b"glTF\x02\0\0\0",
        &word(total),
        &word(text.len()),
        b"JSON",
        &text,
        &word(binary.len()),
        b"BIN\0",
        binary,
    ];
    parts.concat()
}

/// A mesh of `count` vertices, `indices` bytes of strip over them with texture, and `nodes` nodes that show it.
fn strips(count: usize, indices: usize, nodes: usize) -> Vec<u8> {
    let vertices = 20 * count;
    let roots: Vec<usize> = (0..nodes).collect();
    let document = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": roots}],
        "nodes": vec![json!({"mesh": 0}); nodes],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "mode": 5}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": count, "type": "VEC2"},
            {"bufferView": 1, "componentType": 5121, "count": indices, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": vertices, "byteStride": 20},
            {"buffer": 0, "byteOffset": vertices, "byteLength": indices}
        ],
        "buffers": [{"byteLength": vertices + indices}]
    });
    let mut binary = vec![0; vertices];
    binary.extend((0..indices).map(|i| (i % 3) as u8));
    glb(&document, &binary)
}

fn gifti(rows: usize, inflated: usize) -> Vec<u8> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::best());
    out.write_all(&vec![0; inflated]).unwrap();
    let data = STANDARD.encode(out.finish().unwrap());
    let array = format!(
        "<DataArray Intent=\"NIFTI_INTENT_POINTSET\" DataType=\"NIFTI_TYPE_FLOAT32\" Encoding=\"GZipBase64Binary\" \
         Dimensionality=\"2\" Dim0=\"{rows}\" Dim1=\"3\"><Data>{data}</Data></DataArray>"
    );
    format!("<GIFTI>{array}</GIFTI>").into_bytes()
}

/// The same with one number per row.
fn gifti_column(rows: usize, inflated: usize) -> Vec<u8> {
    let text = String::from_utf8(gifti(rows, inflated)).unwrap();
    text.replace("POINTSET", "SHAPE").replace("Dim1=\"3\"", "Dim1=\"1\"").into_bytes()
}

/// The reader of values, as readers of surfaces are called.
fn gifti_values(bytes: &[u8], path: &str) -> Result<Soup> {
    io::parse_gifti_columns(bytes, path).map(|_| Soup::default())
}

/// A file whose points are one block of so many bytes that says that it unfolds to others.
fn vtp(told: usize, inflated: usize) -> Vec<u8> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::best());
    out.write_all(&vec![0; inflated]).unwrap();
    let block = out.finish().unwrap();
    let sizes = [1, told, 0, block.len()].map(|n| (n as u64).to_le_bytes()).concat();
    let head = "<VTKFile type=\"PolyData\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece><Points>\
                <DataArray type=\"UInt8\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>\
                <AppendedData encoding=\"raw\">_";
    [head.as_bytes(), &sizes, &block].concat()
}

fn ply(vertex: &str, vertices: usize, face: &str, faces: usize, body: &[u8]) -> Vec<u8> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n{vertex}element {face} {faces}\n\
         property list uchar uchar vertex_indices\nend_header\n"
    );
    [header.as_bytes(), body].concat()
}

fn list(head: &str, item: &str, count: usize, tail: &str) -> Vec<u8> {
    [head.as_bytes(), item.repeat(count).as_bytes(), tail.as_bytes()].concat()
}

const N: usize = 4 * MB;

/// Small files that would become large meshes.
fn bombs(cases: &mut Vec<Case>) {
    let mut bomb = |what: &str, parse: Parse, make: Box<dyn Fn() -> Vec<u8>>| {
        cases.push(Case::new(what, parse, Some(false), make));
    };
    bomb("glTF instances", io::parse_glb, Box::new(|| strips(10_000, 100, 20_000)));
    bomb("glTF strip of bytes", io::parse_glb, Box::new(|| strips(3, 2 * N, 1)));
    bomb("GIFTI of zeros", io::parse_gifti, Box::new(|| gifti(20 * MB, 240 * MB)));
    bomb("GIFTI values of zeros", gifti_values, Box::new(|| gifti_column(60 * MB, 240 * MB)));
    bomb("GIFTI that inflates to more", io::parse_gifti, Box::new(|| gifti(1, 240 * MB)));
    bomb("GIFTI that inflates to less", io::parse_gifti, Box::new(|| gifti(1_000_000_000, 240 * MB)));
    for (what, parse) in [
        ("VTK of zeros", io::parse_vtk as Parse),
        ("MZ3 of zeros", io::parse_mz3),
        ("FreeSurfer of zeros", io::parse_freesurfer),
    ] {
        let head: &'static [u8] = match what {
            "VTK of zeros" => {
                b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1000000000 char\n"
            }
            "MZ3 of zeros" => b"MZ\x03\0\0\xff\xff\xff\0\xff\xff\xff\0\0\0\0",
            _ => b"\xff\xff\xfe\n\n\x7f\xff\xff\xff\x7f\xff\xff\xff",
        };
        bomb(what, parse, Box::new(move || [head, &vec![0; N]].concat()));
    }
    bomb("VTP that inflates to more", io::parse_vtp, Box::new(|| vtp(1, 240 * MB)));
    bomb("VTP of zeros", io::parse_vtp, Box::new(|| vtp(240 * MB, 240 * MB)));
    bomb(
        "glTF of zeros",
        io::parse_glb,
        Box::new(|| {
            let document = json!({
                "asset": {"version": "2.0"},
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [{"componentType": 5126, "count": 4_000_000_000u32, "type": "VEC3"}]
            });
            glb(&document, &[])
        }),
    );
}

/// The smallest text for the most structure.
fn dense_texts(cases: &mut Vec<Case>) {
    const GLTF: &str = "{\"asset\":{\"version\":\"2.0\"},";
    for (key, item) in [
        ("nodes", "{}"),
        ("nodes", "{\"scale\":[1,1,1]}"),
        ("scenes", "{}"),
        ("extensionsRequired", "\"\""),
        ("meshes", "{\"primitives\":[]}"),
        ("unknown", "[]"),
    ] {
        cases.push(Case::new(format!("glTF {key} {item}"), io::parse_glb, None, move || {
            list(
                &format!("{GLTF}\"{key}\":["),
                &format!("{item},"),
                N / item.len() * 4,
                &format!("{item}]}}"),
            )
        }));
    }
    cases.push(Case::new("glTF nesting", io::parse_glb, Some(false), || {
        list(&format!("{GLTF}\"x\":"), "[", N, "")
    }));
    for item in [
        "<Label Key='1'/>",
        "<DataArray Dimensionality='1' Dim0='0' DataType='NIFTI_TYPE_FLOAT32' Encoding='ASCII'><Data/></DataArray>",
    ] {
        cases.push(Case::new(format!("GIFTI values {item}"), gifti_values, None, move || {
            list("<GIFTI>", item, 2 * N / item.len(), "</GIFTI>")
        }));
    }
    for item in ["<a>", "<a/>", "<DataArray/>", "<DataArray><Data/></DataArray>", "&a;"] {
        cases.push(Case::new(format!("GIFTI {item}"), io::parse_gifti, Some(false), move || {
            list("<GIFTI>", item, 2 * N / item.len(), "</GIFTI>")
        }));
    }
    cases.push(Case::new("GIFTI attributes", io::parse_gifti, Some(false), || {
        list("<GIFTI><DataArray ", "a=\"\" ", N / 5, "/></GIFTI>")
    }));
    for item in ["f 1 1 1\n", "f 1 1 1 1\n", "f\n", "v 0 0 0\n", "v 0 0 0 1 1 1\n", "vn\n", "f 1// 1// 1//\n"]
    {
        cases.push(Case::new(format!("OBJ {item:?}"), io::parse_obj, None, move || {
            list("v 0 0 0\n", item, 4 * N / item.len(), "")
        }));
    }
    for item in ["g a\nf\ng b\nf\n", "usemtl\nf 1 1 1\no a\nf 1 1 1\n", "l 1 1\n", "mtllib a\nmtllib b\n"] {
        cases.push(Case::new(format!("OBJ {item:?}"), io::parse_obj, None, move || {
            list("v 0 0 0\n", item, 4 * N / item.len(), "")
        }));
    }
    cases.push(Case::new("OBJ of different groups", io::parse_obj, None, || {
        let groups: String = (0..N / 4).map(|k| format!("g {k:x}\nf 1 1 1\n")).collect();
        list("v 0 0 0\n", &groups, 1, "")
    }));
    for (what, item) in [("polygon", " 1"), ("continued line", " 1\\\n")] {
        let make = move || list("v 0 0 0\nf", item, N, "\n");
        cases.push(Case::new(format!("OBJ {what}"), io::parse_obj, None, make));
    }
    for item in ["0\n", "3 0 0 0\n", "4 0 0 0 0\n"] {
        let count = 4 * N / item.len();
        cases.push(Case::new(format!("OFF {item:?}"), io::parse_off, None, move || {
            list(&format!("OFF\n1 {count} 0\n0 0 0\n"), item, count, "")
        }));
    }
    for item in ["1 ", "3 0 0 0\n"] {
        cases.push(Case::new(format!("VTK {item:?}"), io::parse_vtk, None, move || {
            let head = format!(
                "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOLYGONS {} {} ",
                N / 8,
                4 * (N / item.len())
            );
            list(&head, item, N / item.len(), "")
        }));
    }
    for item in ["<a/>", "<DataArray type=\"UInt8\"/>"] {
        cases.push(Case::new(format!("VTP {item}"), io::parse_vtp, Some(false), move || {
            list("<VTKFile type=\"PolyData\"><PointData>", item, 2 * N / item.len(), "</VTKFile>")
        }));
    }
    const LOOP: &str = "outer loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nendloop\n";
    cases.push(Case::new("STL loops", io::parse_stl, Some(true), || {
        list("solid\n", LOOP, N / LOOP.len(), "")
    }));
    cases.push(Case::new("STL of lone triangles", io::parse_stl, Some(true), || {
        let count = N as u32 / 10;
        let triangles = (0..count)
            .flat_map(|i| (0..50).map(move |k| i.wrapping_mul(2_654_435_761).rotate_left(7 * k) as u8))
            .collect::<Vec<_>>();
        [&[0; 80][..], &count.to_le_bytes(), &triangles].concat()
    }));
}

/// Rows of single bytes.
fn dense_ply(cases: &mut Vec<Case>) {
    const XYZ: &str = "property uchar x\nproperty uchar y\nproperty uchar z\n";
    const COLOR: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const UV: &str = "property uchar s\nproperty uchar t\n";
    let mut push = |what: &str, make: Box<dyn Fn() -> Vec<u8>>| {
        cases.push(Case::new(what, io::parse_ply, None, make));
    };
    let polygons = || [&[255u8][..], &[0; 255]].concat().repeat(4 * N / 256);
    push("PLY empty faces", Box::new(|| ply(XYZ, 1, "face", N, &vec![0; N + 3])));
    push(
        "PLY triangles",
        Box::new(|| ply(XYZ, 1, "face", N, &[&[0; 3][..], &[3, 0, 0, 0].repeat(N)].concat())),
    );
    push(
        "PLY polygons",
        Box::new(move || {
            ply(&format!("{XYZ}{UV}"), 1, "face", 4 * N / 256, &[&[0; 5][..], &polygons()].concat())
        }),
    );
    push(
        "PLY strips",
        Box::new(move || ply(XYZ, 1, "tristrips", 4 * N / 256, &[&[0; 3][..], &polygons()].concat())),
    );
    push("PLY vertices", Box::new(|| ply(XYZ, N, "face", 0, &vec![0; 3 * N])));
    push(
        "PLY vertices with further numbers",
        Box::new(|| {
            let own: String = (0..8).map(|k| format!("property uchar q{k}\n")).collect();
            ply(&format!("{XYZ}{own}"), N, "face", 0, &vec![0; 11 * N])
        }),
    );
    push(
        "PLY vertices with attributes",
        Box::new(|| ply(&format!("{XYZ}{COLOR}{UV}"), N, "face", 0, &vec![0; 8 * N])),
    );
}

/// A large mesh with all attributes in every format, and a dense GIFTI file.
fn honest(cases: &mut Vec<Case>) {
    let parsers: [(&str, Parse); 9] = [
        ("obj", io::parse_obj),
        ("off", io::parse_off),
        ("ply", io::parse_ply),
        ("glb", io::parse_glb),
        ("vtk", io::parse_vtk),
        ("vtp", io::parse_vtp),
        ("mz3", io::parse_mz3),
        ("pial", io::parse_freesurfer),
        ("asc", io::parse_freesurfer),
    ];
    for (extension, parse) in parsers {
        cases.push(Case::new(extension, parse, Some(true), move || {
            let mut soup = shapes::torus(2.0, 1.0, 600, 300).unwrap();
            let count = soup.positions.len();
            let place = |v: u32| [f64::from(v % 300), f64::from(v / 300)];
            soup.attributes = Attributes {
                normals: Some(soup.positions.clone()),
                colors: Some(vec![[0.1, 0.2, 0.3, 1.0]; count]),
                uv: Some(soup.faces.iter().map(|f| f.map(place)).collect()),
                ..Attributes::default()
            };
            written(&soup, extension)
        }));
        // Every edge hard: a normal for each corner.
        cases.push(Case::new(format!("{extension} with hard edges"), parse, Some(true), move || {
            let mut soup = shapes::torus(2.0, 1.0, 600, 300).unwrap();
            let normal = |(f, _): (usize, _)| [[1.0 / (1.0 + f as f64), 1.0, 0.0]; 3];
            soup.attributes.corner_normals = Some(soup.faces.iter().enumerate().map(normal).collect());
            written(&soup, extension)
        }));
    }
    cases.push(Case::new("GIFTI", io::parse_gifti, Some(true), || gifti(MB / 2, 6 * MB)));
}

fn written(soup: &Soup, extension: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("m.{extension}"));
    io::write(&path, soup).unwrap();
    std::fs::read(&path).unwrap()
}

/// Names the case to a process that reads only this one: memory freed by an earlier case would hide some.
const CASE: &str = "RICCI_MEMORY_CASE";

#[test]
fn memory_is_bounded_by_the_file() {
    if std::fs::write("/proc/self/clear_refs", "5").is_err() {
        eprintln!("no /proc/self/clear_refs here: memory is not measured");
        return;
    }
    let mut cases = Vec::new();
    bombs(&mut cases);
    dense_texts(&mut cases);
    dense_ply(&mut cases);
    honest(&mut cases);
    if let Some(number) = std::env::var_os(CASE) {
        return cases[number.to_str().unwrap().parse::<usize>().unwrap()].check();
    }
    for number in 0..cases.len() {
        let mut child = Command::new(std::env::current_exe().unwrap());
        child.args(["memory_is_bounded_by_the_file", "--exact", "--nocapture"]).env(CASE, number.to_string());
        let output = child.output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        eprint!("{text}");
        assert!(output.status.success() && text.contains(&cases[number].what), "{}", cases[number].what);
    }
}

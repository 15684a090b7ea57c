//! Tests of glTF: files built here byte by byte from the specification, and the output of the writer.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use ricci::mesh::io::{self, Attributes, Soup, Texture, TexturedMesh, Wrap};
use ricci::mesh::{Mesh, shapes};
use ricci::{Error, Result};
use serde_json::{Value, json};

fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    [
        &b"glTF\x02\0\0\0"[..],
        &word(28 + text.len() + binary.len()),
        &word(text.len()),
        b"JSON",
        &text,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ]
    .concat()
}

fn parse(document: &Value, binary: &[u8]) -> Result<Soup> {
    io::parse_glb(&glb(document, binary), "t.glb")
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The corners of a unit square, and four indices of 16 bits.
fn square() -> (Value, Vec<u8>) {
    let mut binary = floats(&[0.0, 0.0, 0.5, 1.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 1.0, 0.5]);
    binary.extend([0u16, 1, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let document = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 6}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 8}
        ],
        "buffers": [{"byteLength": 56}]
    });
    (document, binary)
}

fn corners() -> Vec<[f64; 3]> {
    vec![[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [1.0, 1.0, 0.5], [0.0, 1.0, 0.5]]
}

#[test]
fn modes_of_a_primitive_are_read_as_the_specification_draws_them() {
    let (mut document, binary) = square();
    for (mode, faces) in [
        (json!(6), vec![[0, 1, 2], [0, 2, 3]]),
        (json!(5), vec![[0, 1, 2], [2, 1, 3]]),
        (json!(4), vec![[0, 1, 2]]),
        (Value::Null, vec![[0, 1, 2]]),
        (json!(0), vec![]),
        (json!(3), vec![]),
    ] {
        document["meshes"][0]["primitives"][0]["mode"] = mode.clone();
        assert_eq!(parse(&document, &binary).unwrap(), Soup::new(corners(), faces), "{mode}");
    }
    // Without indices the vertices are numbered in order.
    document["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}, "mode": 6}]);
    assert_eq!(parse(&document, &binary).unwrap().faces, [[0, 1, 2], [0, 2, 3]]);
    // A strip that turns back by a repeated vertex.
    let (mut document, mut binary) = square();
    document["meshes"][0]["primitives"][0]["mode"] = json!(5);
    document["accessors"][1]["count"] = json!(5);
    document["bufferViews"][1]["byteLength"] = json!(10);
    document["buffers"][0]["byteLength"] = json!(58);
    binary.truncate(48);
    binary.extend([0u16, 1, 2, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    assert_eq!(parse(&document, &binary).unwrap().faces, [[0, 1, 2]]);
}

#[test]
fn buffers_may_be_data_uris_and_the_document_plain_text() {
    let (mut document, binary) = square();
    let expected = parse(&document, &binary).unwrap();
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&binary));
    document["buffers"][0]["uri"] = json!(uri);
    assert_eq!(parse(&document, &[]).unwrap(), expected);
    // Some escape the slashes, as JSON allows.
    let text = format!("\u{feff}{}", document.to_string().replace('/', "\\/"));
    assert_eq!(io::parse_glb(text.as_bytes(), "t.gltf").unwrap(), expected);
    document["buffers"][0]["uri"] = json!("square.bin");
    let error = parse(&document, &binary).unwrap_err().to_string();
    assert!(error.contains("`square.bin`"), "{error}");
}

#[test]
fn nodes_place_their_meshes() {
    let (mut document, binary) = square();
    let at = |document: &Value| parse(document, &binary).unwrap();
    // A quarter turn about z, then a scale of 2, then a translation: by parts, and by the corresponding matrix.
    let (h, s) = (0.5f64.sqrt(), 2.0);
    document["nodes"] = json!([
        {"children": [1], "translation": [10.0, 0.0, 0.0]},
        {"mesh": 0, "rotation": [0.0, 0.0, h, h], "scale": [s, s, s]}
    ]);
    let expected = [[10.0, 0.0, 1.0], [10.0, 2.0, 1.0], [8.0, 2.0, 1.0], [8.0, 0.0, 1.0]];
    let close = |soup: &Soup| {
        let off = soup.positions.iter().flatten().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max) < 1e-14
    };
    assert!(close(&at(&document)));
    document["nodes"] =
        json!([{"mesh": 0, "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1]}, {"mesh": 0}]);
    assert!(close(&at(&document)));
    assert_eq!(at(&document).faces, [[0, 1, 2], [0, 2, 3]]);
    // A mirror keeps the orientation outwards.
    document["nodes"] = json!([{"mesh": 0, "scale": [1, 1, -1]}]);
    assert_eq!(at(&document).faces, [[0, 2, 1], [0, 3, 2]]);
    // Normals stay normal to a surface that is stretched or mirrored, and keep length 1.
    let mut leaning = document.clone();
    let push = |list: &mut Value, item: Value| list.as_array_mut().unwrap().push(item);
    push(
        &mut leaning["accessors"],
        json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"}),
    );
    push(&mut leaning["bufferViews"], json!({"buffer": 1, "byteLength": 48}));
    let slope: Vec<u8> = floats(&[0.6, 0.0, 0.8].repeat(4));
    let data = format!("data:;base64,{}", STANDARD.encode(&slope));
    push(&mut leaning["buffers"], json!({"byteLength": 48, "uri": data}));
    leaning["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(2);
    for (scale, normal) in [([1, 1, 2], [0.6, 0.0, 0.4]), ([-1, 1, 1], [-0.6, 0.0, 0.8])] {
        leaning["nodes"] = json!([{"mesh": 0, "scale": scale}]);
        let found = at(&leaning).attributes.normals.unwrap()[0];
        let length = f64::hypot(normal[0], normal[2]);
        assert!((0..3).all(|k| (found[k] - normal[k] / length).abs() < 1e-7), "{found:?}");
    }
    // Two of a mesh, in the order of the scene; skinned meshes stay where they are.
    document["nodes"] =
        json!([{"children": [2, 1]}, {"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1], "skin": 0}]);
    let soup = at(&document);
    assert_eq!(soup.positions, [corners(), corners()].concat());
    assert_eq!(soup.faces[2..], [[4, 5, 6], [4, 6, 7]]);
    // The scene that is named; without scenes each mesh once.
    document["scenes"] = json!([{}, {"nodes": [1]}]);
    assert_eq!(at(&document).faces.len(), 0);
    document["scene"] = json!(1);
    assert_eq!(at(&document).faces.len(), 2);
    document["scenes"] = json!([]);
    assert!(parse(&document, &binary).is_err());
    document.as_object_mut().unwrap().remove("scene");
    assert_eq!(at(&document).faces.len(), 2);
    document["scenes"] = json!([{"nodes": [0]}]);
    for (nodes, says) in [
        (json!([{"children": [0]}]), "node 0 has two parents, or is below itself"),
        (json!([{"children": [1]}, {"children": [0]}]), "node 0"),
        (json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]), "node 2"),
        (json!([{"children": [7]}]), "node 7 does not exist"),
        (json!([{"mesh": 7}]), "mesh 7 does not exist"),
    ] {
        document["nodes"] = nodes;
        let error = parse(&document, &binary).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    // A long chain of nodes does not recurse.
    let mut chain: Vec<Value> = (1..100_000).map(|k| json!({"children": [k]})).collect();
    chain.push(json!({"mesh": 0}));
    document["nodes"] = json!(chain);
    assert_eq!(at(&document).faces.len(), 2);
}

#[test]
fn all_component_types_strides_and_sparse_accessors_are_read() {
    // One triangle over four vertices, interleaved: position i16 × 3 normalised, 2 bytes of nothing, colour u8 × 4, texture
    // u16 × 2 normalised, normal i8 × 3.
    let mut binary = Vec::new();
    for v in 0..4i16 {
        binary.extend([v * 8191, -32767, i16::MIN].iter().flat_map(|x| x.to_le_bytes()));
        binary.extend([9, 9, 255, 51, 0, 102]);
        binary.extend([65535u16, 13107 * v as u16].iter().flat_map(|x| x.to_le_bytes()));
        binary.extend([0, 0x81, 127, 0]);
    }
    let stride = binary.len() / 4;
    let vertices = binary.len();
    binary.extend([0, 1, 2]);
    binary.push(3); // the sparse index
    binary.extend([0u8; 2].iter().chain(&[1, 0, 0xff, 0x7f]));
    let view =
        |offset: usize, length: usize| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let mut interleaved = view(0, vertices);
    interleaved["byteStride"] = json!(stride);
    let document = json!({
        "asset": {"version": "2.0"},
        "extensionsRequired": ["KHR_mesh_quantization", "KHR_materials_unlit"],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "COLOR_0": 1, "TEXCOORD_0": 2, "NORMAL": 3}, "indices": 4
        }]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3", "sparse": {
                "count": 1,
                "indices": {"bufferView": 2, "componentType": 5121},
                "values": {"bufferView": 3}
            }},
            {"bufferView": 0, "byteOffset": 8, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"},
            {"bufferView": 0, "byteOffset": 12, "componentType": 5123, "normalized": true, "count": 4, "type": "VEC2"},
            {"bufferView": 0, "byteOffset": 16, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}
        ],
        "bufferViews": [interleaved, view(vertices, 3), view(vertices + 3, 1), view(vertices + 4, 6)],
        "buffers": [{"byteLength": vertices + 10}]
    });
    let soup = parse(&document, &binary).unwrap();
    assert_eq!(soup.positions[1], [8191.0 / 32767.0, -1.0, -1.0]);
    assert_eq!(soup.positions[3], [0.0, 1.0 / 32767.0, 1.0]);
    assert_eq!(soup.faces, [[0, 1, 2]]);
    let Attributes { normals, colors, uv, .. } = soup.attributes;
    assert_eq!(colors.unwrap()[2], [1.0, 0.2, 0.0, 0.4]);
    assert_eq!(normals.unwrap()[0], [0.0, -1.0, 1.0]);
    assert_eq!(uv.unwrap(), [[[1.0, 1.0], [1.0, 1.0 - 0.2], [1.0, 1.0 - 0.4]]]);
    // No buffer view: zeros except for the sparse ones. Colours without opacity are opaque.
    let mut zeros = document.clone();
    zeros["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    zeros["accessors"][1]["type"] = json!("VEC3");
    let soup = parse(&zeros, &binary).unwrap();
    // Three zeros are one vertex, with the colour of the first.
    assert_eq!(soup.positions, [[0.0; 3], [0.0, 1.0 / 32767.0, 1.0]]);
    assert_eq!(soup.attributes.colors.unwrap()[0], [1.0, 0.2, 0.0, 1.0]);
    // A second primitive without attributes: its own have the defaults; the vertices of both are the same.
    let mut two = document.clone();
    let first = two["meshes"][0]["primitives"][0].take();
    two["meshes"][0]["primitives"] = json!([first, {"attributes": {"POSITION": 0}, "indices": 4}]);
    let soup = parse(&two, &binary).unwrap();
    assert_eq!((soup.positions.len(), soup.faces.as_slice()), (4, &[[0, 1, 2]; 2][..]));
    assert_eq!(soup.attributes.colors.unwrap()[2], [1.0, 0.2, 0.0, 0.4]);
    assert_eq!(soup.attributes.uv.unwrap()[1], [[0.0; 2]; 3]);
    assert_eq!(soup.attributes.corner_normals.unwrap()[1], [[0.0; 3]; 3]);
}

#[test]
fn nothing_in_the_file_is_trusted() {
    let (document, binary) = square();
    let whole = glb(&document, &binary);
    for end in 0..whole.len() {
        assert!(io::parse_glb(&whole[..end], "t.glb").is_err(), "cut at {end}");
    }
    for (pointer, value, says) in [
        ("/asset/version", json!("1.0"), "glTF 1.0"),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression"),
        ("/extensionsRequired", json!(["EXT_meshopt_compression"]), "EXT_meshopt_compression"),
        ("/scene", json!(3), "scene 3"),
        ("/accessors/0/count", json!(5), "5 elements end behind buffer view 0 of 48 bytes"),
        ("/accessors/0/count", json!(u64::MAX), "end behind"),
        ("/accessors/0/byteOffset", json!(1), "end behind"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "end behind"),
        ("/accessors/0/componentType", json!(5124), "5124"),
        ("/accessors/0/type", json!("VEC2"), "Vec2"),
        ("/accessors/0/type", json!("VEC5"), "VEC5"),
        ("/accessors/0/bufferView", json!(9), "buffer view 9"),
        ("/accessors/0/bufferView", Value::Null, "names vertex"),
        ("/accessors/1/componentType", json!(5122), "unsigned"),
        ("/bufferViews/0/byteLength", json!(57), "behind its buffer"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "behind its buffer"),
        ("/bufferViews/0/byteStride", json!(0), "stride 0"),
        ("/bufferViews/0/byteStride", json!(u64::MAX), "end behind"),
        ("/bufferViews/0/buffer", json!(1), "buffer 1"),
        ("/buffers/0/byteLength", json!(60), "56 bytes, 60 are promised"),
        ("/meshes/0/primitives/0/indices", json!(2), "accessor 2"),
        ("/meshes/0/primitives/0/attributes/NORMAL", json!(0), ""),
        ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(1), "Scalar"),
        ("/nodes", json!({}), "JSON"),
    ] {
        let mut document = document.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Object(fields) => fields.insert(key.into(), value),
            list => Some(std::mem::replace(&mut list[key.parse::<usize>().unwrap()], value)),
        };
        if pointer.ends_with("bufferView") && says == "names vertex" {
            document["accessors"][0]["count"] = json!(3);
        }
        match parse(&document, &binary) {
            Err(Error::Parse { message, .. }) => {
                assert!(!says.is_empty() && message.contains(says), "{pointer}: {message}");
            }
            Ok(soup) => assert!(says.is_empty() && soup.attributes.normals.unwrap().len() == 4),
            Err(e) => panic!("{pointer}: {e}"),
        }
    }
    let mut beyond = binary.clone();
    beyond[54] = 4;
    let error = parse(&document, &beyond).unwrap_err().to_string();
    let index = whole.len() - binary.len() + 54;
    assert!(error.starts_with(&format!("t.glb, byte {index}: ")), "{error}");
    assert!(error.contains("index 3 of a mesh names vertex 4 of 4"), "{error}");
    for (at, byte, says) in
        [(0, b'G', "no GLB"), (4, 1, "version 1"), (8, 255, "the file ends here"), (16, b'j', "not JSON")]
    {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        let error = io::parse_glb(&bytes, "t.glb").unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// The JSON chunk and the binary chunk of a file, by the offsets of the specification.
fn taken_apart(bytes: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
    let binary = 20 + word(12);
    assert_eq!((&bytes[16..20], &bytes[binary + 4..binary + 8]), (&b"JSON"[..], &b"BIN\0"[..]));
    assert_eq!(binary + 8 + word(binary), bytes.len());
    (serde_json::from_slice(&bytes[20..binary]).unwrap(), bytes[binary + 8..].to_vec())
}

#[test]
fn a_vertex_is_given_again_for_each_further_pair_of_texture_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    let png = b"\x89PNG and so on".as_slice();
    let data = TexturedMesh {
        positions: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
        normals: &[[0.0, 0.0, 3.0]; 4],
        texcoords: &[[0.0, 0.0], [0.25, 0.0], [0.0, 0.25], [0.5, 0.5], [0.25, 0.0]],
        faces: &[[0, 1, 2], [1, 3, 2]],
        face_texcoords: &[[0, 1, 2], [4, 3, 3]],
        ..TexturedMesh::default()
    };
    let origin = io::write_glb(&path, &data, Some(Texture { png, wrap: Wrap::Clamp, repeat: 1.0 })).unwrap();
    // Vertex 2 has two places in the texture; entries 1 and 4 are the same place.
    assert_eq!(origin, [0, 1, 2, 3, 2]);
    let soup = io::read(&path).unwrap();
    assert_eq!((&soup.faces[..], &soup.positions[..]), (data.faces, data.positions));
    let Attributes { normals, uv, .. } = soup.attributes;
    assert_eq!(normals.unwrap(), [[0.0, 0.0, 1.0]; 4]);
    assert_eq!(
        uv.unwrap(),
        data.face_texcoords.iter().map(|f| f.map(|t| data.texcoords[t as usize])).collect::<Vec<_>>()
    );
    let (document, binary) = taken_apart(&std::fs::read(&path).unwrap());
    let image = &document["bufferViews"][document["images"][0]["bufferView"].as_u64().unwrap() as usize];
    let start = image["byteOffset"].as_u64().unwrap() as usize;
    assert_eq!(&binary[start..start + png.len()], png);
    assert_eq!(document["samplers"][0]["wrapS"], 33071);
    assert_eq!(document["accessors"][0]["max"], json!([1.0, 1.0, 0.0]));
}

#[test]
fn positions_keep_their_digits_far_from_the_origin_and_at_any_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    let sphere = shapes::icosphere(3).unwrap();
    for (size, away) in [(1.0, 0.0), (1e-3, 1e6), (1e200, 0.0), (1e-200, 0.0), (1e-40, 1e-39), (1e30, 1e31)] {
        let placed: Vec<[f64; 3]> =
            sphere.positions.iter().map(|p| [away + size * p[0], size * p[1], size * p[2]]).collect();
        io::write(&path, &Soup::new(placed.clone(), sphere.faces.clone())).unwrap();
        let back = io::read(&path).unwrap();
        assert_eq!(back.faces, sphere.faces);
        let off = back.positions.iter().flatten().zip(placed.as_flattened()).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        // Rounding to 24 bits in a box of half its size, and of the sum in f64.
        let allowed = size * 2f64.powi(-24) + away * 2f64.powi(-52);
        assert!(off <= allowed, "{size} at {away}: {off} > {allowed}");
        assert!(Mesh::from_soup(&back).is_ok());
    }
    // Numbers that fit in 32 bits come back bit for bit.
    let narrow = Soup::new(
        sphere.positions.iter().map(|p| p.map(|x| f64::from(x as f32 + 77.0))).collect(),
        sphere.faces,
    );
    io::write(&path, &narrow).unwrap();
    assert_eq!(io::read(&path).unwrap(), narrow);
}

#[test]
fn points_and_nothing_at_all_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    for soup in [Soup::default(), Soup::new(vec![[1.0, 2.0, 3.0], [-1.0, 0.5, 0.0]], Vec::new())] {
        io::write(&path, &soup).unwrap();
        assert_eq!(io::read(&path).unwrap(), soup);
    }
}

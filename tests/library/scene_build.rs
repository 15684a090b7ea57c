//! A glTF scene that tests build, and the numbers of one that is read, both by the specification alone.

use ricci::mesh::shapes;
use serde_json::{Value, json};
use std::path::Path;

/// A document with its binary chunk.
pub struct SceneBuilder {
    pub document: Value,
    pub binary: Vec<u8>,
}

const FLOAT: u32 = 5126;
const SHORT: u32 = 5123;
const BYTE: u32 = 5121;
/// A PNG of one pixel begins so; nothing reads further.
const PICTURE: &[u8] = b"\x89PNG\r\n\x1a\nand so on";

/// The corners of a square face of a cube, by the axis and the side.
fn side(axis: usize, far: bool) -> ([[f32; 3]; 4], [f32; 3]) {
    let turn = |x: f32, y: f32| {
        let mut p = [0.0; 3];
        p[axis] = f32::from(u8::from(far));
        (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (x, y);
        p
    };
    let mut corners = [turn(0.0, 0.0), turn(1.0, 0.0), turn(1.0, 1.0), turn(0.0, 1.0)];
    if !far {
        corners.reverse();
    }
    let mut normal = [0.0; 3];
    normal[axis] = if far { 1.0 } else { -1.0 };
    (corners, normal)
}

impl SceneBuilder {
    /// Five meshes with two materials: a box that two nodes show, a strip, a sphere of two primitives with common vertices, a tube with a skin
    /// and a morph target, and single triangles. `textured`: both materials have textures on TEXCOORD_0.
    pub fn five_meshes(textured: bool) -> SceneBuilder {
        let mut made = SceneBuilder { document: scene(textured), binary: Vec::new() };
        let meshes = json!([
            {"name": "box", "primitives": [made.cube()], "extras": {"weight": 2.5}},
            {"name": "strip", "primitives": [made.strip(), made.line()]},
            {"name": "ball", "primitives": made.ball()},
            {"name": "tube", "primitives": [made.tube()], "weights": [0.25]},
            {"name": "loose", "primitives": [made.loose()]}
        ]);
        made.document["meshes"] = meshes;
        let times = made.add(FLOAT, "SCALAR", &floats(&[0.0, 1.0]), 2);
        let moves = made.add(FLOAT, "VEC3", &floats(&[0.0, 0.0, 0.0, 0.5, 0.0, 0.0]), 2);
        made.document["animations"][0]["samplers"] = json!([{"input": times, "output": moves}]);
        let matrix: Vec<f32> = (0..16).map(|k| f32::from(u8::from(k % 5 == 0))).collect();
        let bind = made.add(FLOAT, "MAT4", &floats(&matrix), 1);
        made.document["skins"][0]["inverseBindMatrices"] = json!(bind);
        made
    }

    /// Adds an accessor of `count` elements and its buffer view; returns its number.
    fn add(&mut self, component: u32, shape: &str, bytes: &[u8], count: usize) -> usize {
        let view = self.view(bytes);
        let accessors = self.document["accessors"].as_array_mut().unwrap();
        accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": shape}));
        accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let start = self.binary.len();
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let views = self.document["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": bytes.len()}));
        views.len() - 1
    }

    fn points(&mut self, points: &[[f32; 3]]) -> usize {
        let accessor = self.add(FLOAT, "VEC3", &floats(points.as_flattened()), points.len());
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..3).map(|k| points.iter().map(|p| p[k]).reduce(pick).unwrap()).collect()
        };
        self.document["accessors"][accessor]["min"] = json!(bound(f32::min));
        self.document["accessors"][accessor]["max"] = json!(bound(f32::max));
        accessor
    }

    fn indices(&mut self, corners: &[u32]) -> usize {
        let bytes: Vec<u8> = corners.iter().flat_map(|v| (*v as u16).to_le_bytes()).collect();
        self.add(SHORT, "SCALAR", &bytes, corners.len())
    }

    /// A unit cube of 24 vertices in one interleaved buffer view: positions, normals, coordinates; and tangents.
    fn cube(&mut self) -> Value {
        let (mut rows, mut tangents, mut corners) = (Vec::new(), Vec::new(), Vec::new());
        for (axis, far) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
            let (points, normal) = side(axis, far);
            let first = (rows.len() / 8) as u32;
            for (k, p) in points.iter().enumerate() {
                rows.extend([&p[..], &normal, &[0.25 * k as f32, 0.5]].concat());
                let mut along = [0.0, 0.0, 0.0, -1.0];
                along[(axis + 1) % 3] = 1.0;
                tangents.extend(along);
            }
            corners.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
        }
        let view = self.view(&floats(&rows));
        self.document["bufferViews"][view]["byteStride"] = json!(32);
        let accessors = self.document["accessors"].as_array_mut().unwrap();
        let first = accessors.len();
        for (offset, shape) in [(0, "VEC3"), (12, "VEC3"), (24, "VEC2")] {
            accessors.push(json!({
                "bufferView": view, "byteOffset": offset, "componentType": FLOAT, "count": 24, "type": shape
            }));
        }
        (accessors[first]["min"], accessors[first]["max"]) = (json!([0, 0, 0]), json!([1, 1, 1]));
        let tangent = self.add(FLOAT, "VEC4", &floats(&tangents), 24);
        let attributes = json!({
            "POSITION": first, "NORMAL": first + 1, "TEXCOORD_0": first + 2, "TANGENT": tangent
        });
        json!({"attributes": attributes, "indices": self.indices(&corners), "material": 0, "extras": {"part": "A"}})
    }

    fn strip(&mut self) -> Value {
        let points: Vec<[f32; 3]> = (0..10).map(|k| [(k / 2) as f32, (k % 2) as f32, 0.0]).collect();
        let position = self.points(&points);
        json!({"attributes": {"POSITION": position}, "mode": 5, "material": 1})
    }

    fn line(&mut self) -> Value {
        let position = self.points(&[[0.0; 3], [0.0, 0.0, 3.0]]);
        json!({"attributes": {"POSITION": position}, "mode": 1, "material": 1})
    }

    /// A sphere whose halves are two primitives with the same vertices.
    fn ball(&mut self) -> Value {
        let ball = shapes::icosphere(1).unwrap();
        let points: Vec<[f32; 3]> = ball.positions.iter().map(|p| p.map(|x| x as f32)).collect();
        let (position, normal) = (self.points(&points), self.points(&points));
        let half = ball.faces.len() / 2;
        let parts = [&ball.faces[..half], &ball.faces[half..]];
        let primitives = parts.iter().enumerate().map(|(k, faces)| {
            let attributes = json!({"POSITION": position, "NORMAL": normal});
            json!({"attributes": attributes, "indices": self.indices(faces.as_flattened()), "material": k})
        });
        primitives.collect()
    }

    /// A closed tube with four joints at each vertex, and a sparse morph target.
    fn tube(&mut self) -> Value {
        let (n, m) = (8u32, 5u32);
        let point = |k: u32| {
            let angle = f64::from(k % n) * std::f64::consts::TAU / f64::from(n);
            [angle.cos() as f32, angle.sin() as f32, (k / n) as f32 * 0.5]
        };
        let points: Vec<[f32; 3]> = (0..n * m).map(point).collect();
        let position = self.points(&points);
        let joints: Vec<u8> = (0..n * m).flat_map(|k| [(k % 2) as u8, 1, 0, 0]).collect();
        let joints = self.add(BYTE, "VEC4", &joints, points.len());
        let weights: Vec<f32> =
            (0..n * m).flat_map(|k| [k as f32 / 40.0, 1.0 - k as f32 / 40.0, 0.0, 0.0]).collect();
        let weights = self.add(FLOAT, "VEC4", &floats(&weights), points.len());
        let at = self.view(&[3u16, 20].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>());
        let moved = self.view(&floats(&[0.5, 0.0, 0.0, 0.0, 0.25, 0.0]));
        let accessors = self.document["accessors"].as_array_mut().unwrap();
        accessors.push(json!({
            "componentType": FLOAT, "count": points.len(), "type": "VEC3",
            "min": [0, 0, 0], "max": [0.5, 0.25, 0],
            "sparse": {"count": 2, "indices": {"bufferView": at, "componentType": SHORT}, "values": {"bufferView": moved}}
        }));
        let target = accessors.len() - 1;
        let mut corners = Vec::new();
        for (i, j) in (0..m - 1).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let at = |i: u32, j: u32| i * n + j % n;
            corners.extend([
                at(i, j),
                at(i, j + 1),
                at(i + 1, j + 1),
                at(i, j),
                at(i + 1, j + 1),
                at(i + 1, j),
            ]);
        }
        let attributes = json!({"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights});
        let indices = self.indices(&corners);
        json!({"attributes": attributes, "indices": indices, "material": 1, "targets": [{"POSITION": target}]})
    }

    /// Three triangles without indices, with colours of 8 bits.
    fn loose(&mut self) -> Value {
        let points: Vec<[f32; 3]> =
            (0..9).map(|k| [(k / 3 * 2 + k % 3 % 2) as f32, (k % 3 / 2) as f32, k as f32 * 0.1]).collect();
        let position = self.points(&points);
        let colors: Vec<u8> = (0..36).map(|k| 7 * k).collect();
        let color = self.add(BYTE, "VEC4", &colors, 9);
        self.document["accessors"][color]["normalized"] = json!(true);
        json!({"attributes": {"POSITION": position, "COLOR_0": color}, "material": 0})
    }

    pub fn glb(&self) -> Vec<u8> {
        let mut document = self.document.clone();
        document["buffers"] = json!([{"byteLength": self.binary.len()}]);
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let word = |n: usize| (n as u32).to_le_bytes();
        let lengths = [28 + text.len() + self.binary.len(), text.len(), self.binary.len()].map(word);
        [b"glTF\x02\0\0\0", &lengths[0][..], &lengths[1], b"JSON", &text, &lengths[2], b"BIN\0", &self.binary]
            .concat()
    }

    /// Writes scene.gltf with its buffer and one of two pictures beside it.
    pub fn write_apart(&self, folder: &Path) {
        let mut document = self.document.clone();
        document["buffers"] = json!([{"byteLength": self.binary.len(), "uri": "a%20buffer.bin"}]);
        document["images"] = json!([{"uri": "one.png"}, {"uri": "missing.png"}]);
        std::fs::write(folder.join("scene.gltf"), document.to_string()).unwrap();
        std::fs::write(folder.join("a buffer.bin"), &self.binary).unwrap();
        std::fs::write(folder.join("one.png"), PICTURE).unwrap();
    }
}

/// The parts of the scene that hold no numbers of vertices.
fn scene(textured: bool) -> Value {
    let mut document = json!({
        "asset": {"version": "2.0", "generator": "a test", "extras": {"licence": "none"}},
        "scene": 0,
        "scenes": [{"name": "all", "nodes": [0, 6]}],
        "nodes": [
            {"name": "root", "children": [1, 2, 3, 4, 5], "scale": [2, 2, 2], "extras": {"tag": [1, 0.1, "x"]}},
            {"name": "large box", "mesh": 0, "scale": [2, 2, 2], "translation": [0.1, 0, 0]},
            {"name": "small box", "mesh": 0, "matrix": [0.5,0,0,0, 0,0.5,0,0, 0,0,0.5,0, 3,0,0,1]},
            {"name": "a strip", "mesh": 1, "rotation": [0, 0, 0.6, 0.8], "scale": [0.25, 0.25, 0.25]},
            {"name": "a tube", "mesh": 3, "skin": 0},
            {"name": "triangles", "mesh": 4, "translation": [0, 3, 0]},
            {"name": "a ball and an eye", "mesh": 2, "camera": 0}
        ],
        "materials": [
            {"name": "stone", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1]}},
            {"name": "glass", "alphaMode": "BLEND", "extensions": {"KHR_materials_ior": {"ior": 1.45}}}
        ],
        "extensionsUsed": ["KHR_materials_ior"],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
        "skins": [{"joints": [0, 1]}],
        "animations": [{"name": "slide", "channels": [{"sampler": 0, "target": {"node": 3, "path": "translation"}}]}],
        "accessors": [],
        "bufferViews": []
    });
    if textured {
        document["images"] = json!([{"uri": "data:image/png;base64,iVBORw0KGgo="}]);
        document["textures"] = json!([{"source": 0}]);
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
        document["materials"][1]["normalTexture"] = json!({"index": 0, "texCoord": 0});
    }
    document
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A GLB file that is read.
pub struct DecodedScene {
    pub document: Value,
    binary: Vec<u8>,
}

impl DecodedScene {
    pub fn new(bytes: &[u8]) -> DecodedScene {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
        let end = 20 + word(12);
        assert_eq!((&bytes[16..20], &bytes[end + 4..end + 8]), (&b"JSON"[..], &b"BIN\0"[..]));
        let document = serde_json::from_slice(&bytes[20..end]).unwrap();
        DecodedScene { document, binary: bytes[end + 8..end + 8 + word(end)].to_vec() }
    }

    /// The mesh, the number in it, and the text of each primitive.
    pub fn primitives(&self) -> Vec<(usize, usize, &Value)> {
        let meshes = self.document["meshes"].as_array().unwrap().iter().enumerate();
        let of = |(k, mesh): (usize, &'_ Value)| -> Vec<(usize, usize)> {
            (0..mesh["primitives"].as_array().unwrap().len()).map(|i| (k, i)).collect()
        };
        let all: Vec<(usize, usize)> = meshes.flat_map(of).collect();
        all.into_iter().map(|(k, i)| (k, i, &self.document["meshes"][k]["primitives"][i])).collect()
    }

    pub fn view(&self, view: &Value) -> &[u8] {
        let entry = &self.document["bufferViews"][view.as_u64().unwrap() as usize];
        let number = |name: &str| entry[name].as_u64().unwrap_or(0) as usize;
        &self.binary[number("byteOffset")..number("byteOffset") + number("byteLength")]
    }

    /// The bytes of the elements of an accessor, each by itself.
    fn all(&self, accessor: &Value) -> Vec<Vec<u8>> {
        let entry = &self.document["accessors"][accessor.as_u64().unwrap() as usize];
        let count = entry["count"].as_u64().unwrap() as usize;
        let width = match entry["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "MAT4" => 16,
            vector => vector[3..].parse().unwrap(),
        };
        let bytes = |component: &Value| match component.as_u64().unwrap() {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let size = width * bytes(&entry["componentType"]);
        let mut all = vec![vec![0; size]; count];
        if !entry["bufferView"].is_null() {
            let view = &self.document["bufferViews"][entry["bufferView"].as_u64().unwrap() as usize];
            let stride = view["byteStride"].as_u64().map_or(size, |stride| stride as usize);
            let data = &self.view(&entry["bufferView"])[entry["byteOffset"].as_u64().unwrap_or(0) as usize..];
            all = (0..count).map(|k| data[k * stride..k * stride + size].to_vec()).collect();
        }
        let sparse = &entry["sparse"];
        for k in 0..sparse["count"].as_u64().unwrap_or(0) as usize {
            let at = &self.view(&sparse["indices"]["bufferView"])[2 * k..2 * k + 2];
            let at = u16::from_le_bytes(at.try_into().unwrap()) as usize;
            all[at] = self.view(&sparse["values"]["bufferView"])[k * size..(k + 1) * size].to_vec();
        }
        all
    }

    /// The vertices of the corners of the triangles of a primitive.
    pub fn corners(&self, primitive: &Value) -> Vec<usize> {
        let number = |bytes: Vec<u8>| bytes.iter().rev().fold(0, |n, b| 256 * n + *b as usize);
        let all: Vec<usize> = match &primitive["indices"] {
            Value::Null => (0..self.all(&primitive["attributes"]["POSITION"]).len()).collect(),
            indices => self.all(indices).into_iter().map(number).collect(),
        };
        match primitive["mode"].as_u64().unwrap_or(4) {
            4 => all,
            5 => (0..all.len() - 2)
                .flat_map(|k| if k % 2 == 0 { [k, k + 1, k + 2] } else { [k + 1, k, k + 2] })
                .collect(),
            mode => panic!("mode {mode}"),
        }
    }

    /// The bytes of an attribute at corners.
    pub fn elements(&self, accessor: &Value, corners: &[usize]) -> Vec<Vec<u8>> {
        let all = self.all(accessor);
        corners.iter().map(|v| all[*v].clone()).collect()
    }

    pub fn floats(&self, accessor: &Value, corners: &[usize]) -> Vec<f32> {
        let bytes = self.elements(accessor, corners).concat();
        bytes.chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
    }

    /// The accessors of all morph targets of a primitive.
    pub fn targets(&self, primitive: &Value) -> Vec<Value> {
        let targets = primitive["targets"].as_array().into_iter().flatten();
        targets.flat_map(|target| target.as_object().unwrap().values().cloned()).collect()
    }
}

//! Colours and normals of the input on the mesh that `--uv` writes.

use crate::run::Place;
use crate::surfaces::{Surface, hill, torus};

/// What is linear in the position on every face stays so on every piece of it.
fn color([x, y, z]: [f64; 3]) -> [f64; 3] {
    [0.5 + 0.1 * x, 0.4 - 0.1 * y + 0.05 * z, 0.3 + 0.1 * z]
}

fn normal([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x - 2.0 * y, y + z, 3.0 + z]
}

fn face_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (p, q): ([f64; 3], [f64; 3]) =
        (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    n.map(|x| x / length)
}

/// A file with colours, normals (of vertices, or one per face) and texture coordinates.
fn obj(surface: &Surface, hard: bool) -> String {
    let mut text = String::new();
    for &[x, y, z] in &surface.positions {
        let [r, g, b] = color([x, y, z]);
        text += &format!("v {x} {y} {z} {r} {g} {b}\nvt {x} {y}\n");
    }
    let normals: Vec<[f64; 3]> = match hard {
        true => surface.faces.iter().map(|f| face_normal(f.map(|v| surface.positions[v]))).collect(),
        false => surface.positions.iter().map(|&p| normal(p)).collect(),
    };
    normals.iter().for_each(|[x, y, z]| text += &format!("vn {x} {y} {z}\n"));
    for (f, corners) in surface.faces.iter().enumerate() {
        let corner = |&v: &usize| format!(" {0}/{0}/{1}", v + 1, if hard { f + 1 } else { v + 1 });
        text += &format!("f{}\n", corners.iter().map(corner).collect::<String>());
    }
    text
}

struct Written {
    v: Vec<Vec<f64>>,
    vn: Vec<[f64; 3]>,
    /// Vertex and normal of each corner.
    faces: Vec<[[usize; 2]; 3]>,
}

fn read(text: &str) -> Written {
    let mut written = Written { v: Vec::new(), vn: Vec::new(), faces: Vec::new() };
    for line in text.lines() {
        let mut tokens = line.split_whitespace();
        let kind = tokens.next().unwrap();
        let rest: Vec<&str> = tokens.collect();
        let numbers = || -> Vec<f64> { rest.iter().map(|t| t.parse().unwrap()).collect() };
        match kind {
            "v" => written.v.push(numbers()),
            "vn" => written.vn.push(numbers().try_into().unwrap()),
            "f" => written.faces.push(std::array::from_fn(|k| {
                let part = |n: usize| rest[k].split('/').nth(n).unwrap().parse::<usize>().unwrap() - 1;
                [part(0), part(2)]
            })),
            _ => {}
        }
    }
    written
}

fn position(v: &[f64]) -> [f64; 3] {
    [v[0], v[1], v[2]]
}

fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

#[test]
fn colours_and_normals_go_with_the_layout() {
    for (name, surface) in [("torus", torus(18, 10)), ("hill", hill(8))] {
        for (flips, more) in [("auto", true), ("never", false)] {
            for hard in [false, true] {
                let place = Place::new();
                place.put("in.obj", &obj(&surface, hard));
                // Strong cones make edges of the torus flip.
                place.put("cones.csv", "3,2.5\n95,-2.5\n");
                let target = if name == "torus" { "cones:cones.csv" } else { "boundary" };
                let line =
                    format!("flow in.obj --flips {flips} --target {target} --uv out.obj --report r.json");
                let ended = place.expect(0, &line);
                let left_out = &place.json("r.json")["result"]["left_out"];
                assert_eq!(left_out.as_array().unwrap().len(), 1);
                assert!(left_out[0].as_str().unwrap().contains("texture coordinates"), "{left_out}");
                assert!(ended.out.contains("left out texture coordinates"), "{}", ended.out);
                let written = read(&place.text("out.obj"));
                let n = surface.positions.len();
                assert_eq!(written.v.len() > n, more, "{name} {flips}");
                for v in &written.v {
                    // Six decimals are written of a colour.
                    assert!(difference(color(position(v)), [v[3], v[4], v[5]]) < 1e-6, "{name} {v:?}");
                }
                assert!(written.faces.len() >= surface.faces.len());
                for corners in &written.faces {
                    let at = corners.map(|[v, _]| position(&written.v[v]));
                    for (p, [_, n]) in at.into_iter().zip(corners) {
                        let known = if hard { face_normal(at) } else { normal(p) };
                        // A thin piece leaves its own normal fewer digits.
                        let limit = if hard { 1e-4 } else { 1e-9 };
                        assert!(difference(known, written.vn[*n]) < limit, "{name} {flips} {known:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_file_without_attributes_leaves_nothing_out() {
    let place = Place::new();
    place.put("in.obj", &torus(10, 8).obj());
    place.expect(0, "flow in.obj --uv out.obj --report r.json");
    assert_eq!(place.json("r.json")["result"]["left_out"].as_array().unwrap().len(), 0);
    assert!(!place.text("out.obj").contains("vn "));
    assert!(place.text("out.obj").lines().all(|l| !l.starts_with("v ") || l.split_whitespace().count() == 4));
}

//! `ricci quads` and `ricci layout`: the files read back, with counts of our own.

use crate::run::{Place, numbers, triples};
use serde_json::Value;

/// Positions and faces of an OBJ file.
fn parse(text: &str) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let words = |line: &str| line.split_whitespace().map(str::to_string).collect::<Vec<_>>();
    let point = |line: &str| -> [f64; 3] {
        words(line).iter().map(|x| x.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap()
    };
    let corner = |word: &String| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
    let positions = text.lines().filter_map(|line| line.strip_prefix("v ")).map(point).collect();
    let faces = text.lines().filter_map(|line| line.strip_prefix("f "));
    (positions, faces.map(|line| words(line).iter().map(corner).collect()).collect())
}

#[test]
fn quads_lie_on_the_surface_and_are_irregular_at_cones_alone() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "quads two.obj -o q.obj --faces 400 --map on.csv --report r.json");
    let (positions, triangles) = parse(&place.text("two.obj"));
    let (vertices, quads) = parse(&place.text("q.obj"));
    assert!(quads.iter().all(|quad| quad.len() == 4) && quads.len() > 300);
    let mut valence = vec![0i64; vertices.len()];
    quads.iter().flatten().for_each(|&v| valence[v] += 1);
    assert_eq!(valence.iter().map(|k| 4 - k).sum::<i64>(), -8);
    let report = place.json("r.json");
    let irregular = valence.iter().filter(|k| **k != 4).count() as u64;
    assert_eq!(report["result"]["irregular"].as_u64(), Some(irregular));
    assert_eq!(report["result"]["cones"].as_u64(), Some(irregular));
    assert_eq!(report["result"]["quads"].as_u64(), Some(quads.len() as u64));
    let csv = place.text("on.csv");
    assert_eq!(csv.lines().next(), Some("quad_vertex,source_face,b0,b1,b2"));
    assert_eq!(csv.lines().count(), vertices.len() + 1);
    for line in csv.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let corners = &triangles[row[1] as usize];
        for i in 0..3 {
            let at: f64 = (0..3).map(|k| row[2 + k] * positions[corners[k]][i]).sum();
            assert!((at - vertices[row[0] as usize][i]).abs() < 1e-12, "{line}");
        }
    }
}

#[test]
fn patches_of_a_layout_are_rectangles_of_whole_size() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "layout two.obj -o L.json --quads p.obj --report r.json");
    let file = place.json("L.json");
    let list = |key: &str| file[key].as_array().unwrap().clone();
    let (nodes, arcs, patches) = (list("nodes"), list("arcs"), list("patches"));
    assert_eq!(nodes.len() as i64 - arcs.len() as i64 + patches.len() as i64, -2);
    let length = |side: &Value| -> f64 {
        let arc = |a: &f64| arcs[a.abs() as usize - 1]["length"].as_f64().unwrap();
        numbers(side).iter().map(arc).sum()
    };
    for patch in &patches {
        let sides: Vec<f64> = patch["arcs"].as_array().unwrap().iter().map(length).collect();
        let size = numbers(&patch["size"]);
        assert_eq!(sides, [size[0], size[1], size[0], size[1]]);
    }
    for arc in &arcs {
        assert_eq!(triples(&arc["points"]).len() as f64, 8.0 * arc["length"].as_f64().unwrap() + 1.0);
    }
    let excess: i64 = nodes.iter().map(|node| 4 - node["valence"].as_i64().unwrap()).sum();
    assert_eq!(excess, -8);
    assert_eq!(place.json("r.json")["result"]["patches"].as_u64(), Some(patches.len() as u64));
    assert!(parse(&place.text("p.obj")).1.len().is_multiple_of(64));
}

/// The texture coordinates of the corners of all faces, by group.
fn textures(text: &str) -> Vec<Vec<Vec<[i64; 2]>>> {
    let (mut points, mut groups) = (Vec::new(), vec![Vec::new()]);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[0] {
            "vt" => points.push([1, 2].map(|k| words[k].parse::<i64>().unwrap())),
            "g" => groups.push(Vec::new()),
            "f" => {
                let corner =
                    |word: &&str| points[word.split('/').nth(1).unwrap().parse::<usize>().unwrap() - 1];
                groups.last_mut().unwrap().push(words[1..].iter().map(corner).collect());
            }
            _ => {}
        }
    }
    groups
}

#[test]
fn texture_coordinates_are_whole_and_each_quad_is_a_unit_square() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "layout two.obj -o L.json --quads p.obj --texture");
    place.expect(0, "quads two.obj -o q.obj --faces 400 --texture");
    place.expect(2, "quads two.obj -o q.ply --texture");
    place.expect(2, "layout two.obj -o L.json --texture");
    let of_patches = textures(&place.text("p.obj"));
    for quad in of_patches.iter().chain(&textures(&place.text("q.obj"))).flatten() {
        for k in 0..4 {
            let side = |k: usize| [0, 1].map(|c| quad[(k + 1) % 4][c] - quad[k % 4][c]);
            let ([x, y], next) = (side(k), side(k + 1));
            assert!(x.abs() + y.abs() == 1 && next == [-y, x], "{quad:?}");
        }
    }
    let file = place.json("L.json");
    let patches = file["patches"].as_array().unwrap();
    assert_eq!(of_patches.len(), patches.len() + 1);
    for (patch, quads) in patches.iter().zip(&of_patches[1..]) {
        let most = [0, 1].map(|c| quads.iter().flatten().map(|p| p[c]).max().unwrap() as f64 / 8.0);
        assert_eq!(most.to_vec(), numbers(&patch["size"]));
        assert_eq!(quads.len() as f64, 64.0 * most[0] * most[1]);
    }
}

#[test]
fn one_size_of_quads_is_asked_for() {
    let place = Place::new();
    place.expect(0, "make torus -o t.obj");
    place.expect(2, "quads t.obj -o q.obj --faces 400 --edge 0.1");
    place.expect(2, "quads t.obj -o q.txt");
    place.expect(2, "layout t.obj -o L.obj");
    place.expect(2, "layout t.obj -o L.json --quads q.stl");
}

/// Positions, the corners of faces with four, and the numbers of their patches if they have them, of a binary PLY file.
fn parse_ply(bytes: &[u8], has_patches: bool) -> (Vec<[f64; 3]>, Vec<Vec<usize>>, Vec<u32>) {
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|part| part == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..start]).unwrap();
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"), "{header}");
    assert_eq!(header.contains("property uint patch\n"), has_patches, "{header}");
    let count = |what: &str| -> usize {
        header.lines().find_map(|line| line.strip_prefix(what)).unwrap().trim().parse().unwrap()
    };
    let (n_vertices, n_faces) = (count("element vertex"), count("element face"));
    let (vertices, faces) = bytes[start..].split_at(24 * n_vertices);
    let numbers: Vec<f64> =
        vertices.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    let row = if has_patches { 21 } else { 17 };
    assert_eq!(faces.len(), row * n_faces);
    let word = |b: &[u8]| u32::from_le_bytes(b.try_into().unwrap());
    let rows: Vec<Vec<u32>> =
        faces.chunks_exact(row).map(|b| b[1..].chunks_exact(4).map(word).collect()).collect();
    assert!(faces.chunks_exact(row).all(|b| b[0] == 4));
    let corners = rows.iter().map(|row| row[..4].iter().map(|&v| v as usize).collect());
    let patches = rows.iter().filter_map(|row| row.get(4).copied());
    (numbers.as_chunks().0.to_vec(), corners.collect(), patches.collect())
}

#[test]
fn other_formats_have_the_same_quads() {
    let place = Place::new();
    place.expect(0, "make torus -o t.obj");
    for extension in ["obj", "ply", "glb"] {
        place.expect(0, &format!("quads t.obj -o q.{extension} --faces 300"));
        place.expect(0, &format!("layout t.obj -o L.json --quads p.{extension}"));
        // What was written is read again, polygons as triangles.
        for name in ["q", "p"] {
            place.expect(0, &format!("info {name}.{extension} --report {name}_{extension}.json"));
        }
    }
    for name in ["q", "p"] {
        let (positions, quads) = parse(&place.text(&format!("{name}.obj")));
        let bytes = std::fs::read(place.path(&format!("{name}.ply"))).unwrap();
        let (same_positions, same_quads, patches) = parse_ply(&bytes, name == "p");
        assert_eq!(same_positions, positions);
        assert_eq!(
            (same_quads.len(), patches.len()),
            (quads.len(), if name == "p" { quads.len() } else { 0 })
        );
        if name == "q" {
            assert_eq!(same_quads, quads);
        }
        for extension in ["obj", "ply", "glb"] {
            let report = place.json(&format!("{name}_{extension}.json"));
            let faces = report["input"]["faces"].as_u64();
            assert_eq!(faces, Some(2 * quads.len() as u64), "{name}.{extension}: {report}");
        }
    }
}

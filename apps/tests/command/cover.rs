//! `ricci cover`: copies of the opened surface are moved images of it, meet, and do not overlap.

use crate::complex::{Group, apply, matrix, trace};
use crate::files::{Obj, parse_obj};
use crate::run::{Place, numbers};
use crate::surfaces::{genus_two, octahedron, torus};
use serde_json::Value;

fn place() -> Place {
    let place = Place::new();
    place.put("torus.obj", &torus(8, 6).obj()).put("two.obj", &genus_two(6).obj());
    place.put("ball.obj", &octahedron().obj());
    place
}

/// The copies of a cover file: names, and points of each.
struct Copies {
    names: Vec<String>,
    points: Vec<Vec<[f64; 3]>>,
    obj: Obj,
}

fn read(place: &Place, name: &str) -> Copies {
    let text = place.text(name);
    let obj = parse_obj(&text);
    let names: Vec<String> = text.lines().filter_map(|l| l.strip_prefix("o ").map(String::from)).collect();
    let n = obj.v.len() / names.len();
    Copies { points: obj.v.chunks(n).map(<[_]>::to_vec).collect(), names, obj }
}

#[test]
fn copies_are_images_under_the_isometries_of_their_words() {
    let place = place();
    for mesh in ["two", "torus"] {
        place.expect(
            0,
            &format!(
                "cover {mesh}.obj --depth 2 --cover c.obj --uv u.obj --generators g.json --report r.json"
            ),
        );
        let (copies, group) = (read(&place, "c.obj"), Group::read(&place.json("g.json")));
        let report = place.json("r.json");
        assert_eq!(report["result"]["copies"], copies.names.len());
        // 1 + 8 + 56 words of a group of genus 2, 1 + 4 + 8 of ℤ².
        assert_eq!(copies.names.len(), if mesh == "two" { 65 } else { 13 });
        let mut different = copies.names.clone();
        different.sort();
        different.dedup();
        assert_eq!(different.len(), copies.names.len());
        assert_eq!(copies.names[0], "1");
        let uv = parse_obj(&place.text("u.obj"));
        assert_eq!(uv.vt.len(), copies.points[0].len());
        for (p, q) in copies.points[0].iter().zip(&uv.vt) {
            assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-13);
        }
        assert_eq!(&copies.obj.corners[..uv.faces.len()], &uv.corners[..]);
        for (name, points) in copies.names.iter().zip(&copies.points).skip(1) {
            let g = group.element(name.split('.'));
            for (from, to) in copies.points[0].iter().zip(points) {
                let [x, y] = apply(&g, [from[0], from[1]]);
                assert!((x - to[0]).hypot(y - to[1]) < 1e-9 * x.hypot(y).max(1.0), "{mesh} {name}");
            }
        }
    }
}

#[test]
fn copies_around_a_point_cover_it_once_and_their_sides_coincide() {
    let place = place();
    place.expect(0, "cover two.obj --radius 5 --model klein --cover c.obj --report r.json --quiet");
    let copies = read(&place, "c.obj");
    let n_faces = copies.obj.faces.len() / copies.names.len();
    let v = &copies.obj.v;
    let inside = |p: [f64; 2], f: &[usize; 3]| {
        (0..3).all(|k| {
            let (a, b) = (v[f[k]], v[f[(k + 1) % 3]]);
            (b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0])
        })
    };
    // Points of the first copy, and points just outside it: each in one triangle of one copy.
    let centre = |f: &[usize; 3]| [0, 1].map(|k| f.iter().map(|i| v[*i][k]).sum::<f64>() / 3.0);
    for f in copies.obj.faces[..n_faces].iter().step_by(n_faces / 40) {
        let p = centre(f);
        for p in [p, p.map(|x| 1.02 * x + 1e-3)].into_iter().filter(|p| p[0].hypot(p[1]) < 0.9) {
            let count = copies.obj.faces.iter().filter(|f| inside(p, f)).count();
            assert_eq!(count, 1, "{p:?}");
        }
    }
    // Every edge of the first copy that has one face there has its equal in another copy.
    let mut border: Vec<[usize; 2]> = Vec::new();
    let first = &copies.obj.faces[..n_faces];
    for f in first {
        for k in 0..3 {
            let e = [f[k], f[(k + 1) % 3]];
            if !first.iter().any(|g| (0..3).any(|j| [g[j], g[(j + 1) % 3]] == [e[1], e[0]])) {
                border.push(e);
            }
        }
    }
    assert!(border.len() > 20);
    let near = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9;
    for [a, b] in border {
        let meets = |f: &[usize; 3]| (0..3).any(|k| near(v[f[k]], v[b]) && near(v[f[(k + 1) % 3]], v[a]));
        assert!(copies.obj.faces[n_faces..].iter().any(meets), "{:?} {:?}", v[a], v[b]);
    }
}

#[test]
fn models_show_the_same_points() {
    let place = place();
    for model in ["poincare", "klein", "half-plane", "hyperboloid"] {
        place.expect(0, &format!("cover two.obj --depth 1 --model {model} --cover {model}.obj --quiet"));
    }
    let [p, k, h, w] =
        ["poincare", "klein", "half-plane", "hyperboloid"].map(|m| read(&place, &format!("{m}.obj")).obj.v);
    for i in 0..p.len() {
        let ([x, y, _], [a, b, c]) = (p[i], w[i]);
        assert!((a * a + b * b + 1.0 - c * c).abs() < 1e-12 * c * c);
        assert!((x * (1.0 + c) - a).hypot(y * (1.0 + c) - b) < 1e-12 * c);
        let n = 1.0 + x * x + y * y;
        assert!((k[i][0] - 2.0 * x / n).hypot(k[i][1] - 2.0 * y / n) < 1e-14);
        assert!(h[i][1] > 0.0);
        // i (1 + z)/(1 − z)
        let d = (1.0 - x).powi(2) + y * y;
        let expected = [-2.0 * y / d, (1.0 - x * x - y * y) / d];
        assert!((h[i][0] - expected[0]).hypot(h[i][1] - expected[1]) < 1e-8 * expected[0].hypot(expected[1]));
    }
}

/// Copies lie on the hyperboloid; the picture, which that is none for, shows its projection.
#[test]
fn the_hyperboloid_is_drawn_as_the_poincare_disk() {
    let place = place();
    for model in ["poincare", "hyperboloid"] {
        let files = format!("--cover {model}.obj --picture {model}.png --size 128");
        place.expect(0, &format!("cover two.obj --depth 1 --model {model} {files} --quiet"));
    }
    let [p, w] = ["poincare.png", "hyperboloid.png"].map(|name| std::fs::read(place.path(name)).unwrap());
    assert!(p == w);
    assert!(read(&place, "hyperboloid.obj").obj.v.iter().all(|p| p[2] >= 1.0));
}

/// In the hyperbolic plane a mesh for each copy; in the plane the positions once, moved by the nodes.
#[test]
fn binary_gltf_has_a_node_for_each_copy() {
    let place = place();
    for mesh in ["two", "torus"] {
        place.expect(0, &format!("cover {mesh}.obj --depth 1 --cover c.obj --quiet"));
        place.expect(0, &format!("cover {mesh}.obj --depth 1 --cover c.glb --quiet"));
        let copies = read(&place, "c.obj");
        let bytes = std::fs::read(place.path("c.glb")).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], word(8)), (b"glTF".as_slice(), bytes.len()));
        let document: Value = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
        let binary = &bytes[28 + word(12)..];
        let nodes = document["nodes"].as_array().unwrap();
        assert_eq!(nodes.len(), copies.names.len());
        let stored = document["accessors"].as_array().unwrap().len() - 2;
        assert_eq!(stored, if mesh == "torus" { 1 } else { nodes.len() });
        for (k, (node, points)) in nodes.iter().zip(&copies.points).enumerate() {
            assert_eq!(node["name"], copies.names[k]);
            let moved = |k: usize| node["translation"][k].as_f64().unwrap_or(0.0);
            let primitive = &document["meshes"][node["mesh"].as_u64().unwrap() as usize]["primitives"][0];
            let position = primitive["attributes"]["POSITION"].as_u64().unwrap() as usize;
            let accessor = &document["accessors"][position];
            let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
            let start = view["byteOffset"].as_u64().unwrap() as usize;
            assert_eq!(accessor["count"], points.len());
            let mut low = [f64::INFINITY; 3];
            for (i, p) in points.iter().enumerate() {
                for axis in 0..3 {
                    let at = start + 12 * i + 4 * axis;
                    let x = f64::from(f32::from_le_bytes(binary[at..at + 4].try_into().unwrap()));
                    assert!((x + moved(axis) - p[axis]).abs() < 1e-5, "{mesh} {k}: {x} {}", p[axis]);
                    low[axis] = low[axis].min(x);
                }
            }
            assert_eq!(numbers(&accessor["min"]), low);
        }
    }
}

/// Without another wish every copy is there that touches the first one: around each point of its border faces close up. How much is
/// written is said before.
#[test]
fn the_usual_copies_leave_no_gap_around_the_first() {
    let place = place();
    for mesh in ["two", "torus"] {
        let ended = place.expect(0, &format!("cover {mesh}.obj --cover c.obj"));
        assert!(ended.err.is_empty(), "{}", ended.err);
        let copies = read(&place, "c.obj");
        let key = |p: [f64; 3]| [p[0], p[1]].map(|x| (x * 1e7).round() as i64);
        let first: Vec<[i64; 2]> = copies.points[0].iter().map(|&p| key(p)).collect();
        let mut links = std::collections::HashMap::new();
        for p in &first {
            links.insert(*p, std::collections::HashMap::<[i64; 2], usize>::new());
        }
        for face in &copies.obj.faces {
            let corners = face.map(|v| key(copies.obj.v[v]));
            for k in 0..3 {
                if let Some(link) = links.get_mut(&corners[k]) {
                    *link.entry(corners[(k + 1) % 3]).or_default() += 1;
                    *link.entry(corners[(k + 2) % 3]).or_default() += 1;
                }
            }
        }
        let open = links.values().filter(|link| link.values().any(|n| *n != 2)).count();
        assert_eq!(open, 0, "{mesh}: {open} of {} points", first.len());
        assert!(copies.names.len() < 60, "{mesh}: {} copies", copies.names.len());
    }
    place.expect(0, "make genus -n 3 -o three.obj --quiet");
    let ended = place.expect(0, "cover three.obj --depth 3 --cover c.obj");
    assert!(ended.err.contains("--cover c.obj: 457 copies, about"), "{}", ended.err);
}

#[test]
fn the_domains_sides_are_glued_by_their_matrices() {
    let place = place();
    place.expect(0, "make bolza --level 1 -o bolza.json --quiet");
    for (mesh, sides) in [("bolza.json --base 0", Some(8)), ("two.obj", None), ("torus.obj", None)] {
        place.expect(0, &format!("cover {mesh} --domain d.json --generators g.json --depth 1 --quiet"));
        let (domain, group) = (place.json("d.json"), Group::read(&place.json("g.json")));
        let corners: Vec<[f64; 2]> =
            domain["corners"].as_array().unwrap().iter().map(|p| numbers(p).try_into().unwrap()).collect();
        let n = corners.len();
        assert!(sides.is_none_or(|s| s == n), "{n}");
        let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-7;
        for (k, side) in domain["sides"].as_array().unwrap().iter().enumerate() {
            let partner = side["partner"].as_u64().unwrap() as usize;
            assert_eq!(domain["sides"][partner]["partner"], k);
            let m = matrix(&side["matrix"]);
            // The partner onto this side, run through the other way.
            assert!(close(apply(&m, corners[partner]), corners[(k + 1) % n]), "{mesh} {k}");
            assert!(close(apply(&m, corners[(partner + 1) % n]), corners[k]), "{mesh} {k}");
            let word = group.element(side["word"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()));
            assert!(close(apply(&m, [0.1, 0.2]), apply(&word, [0.1, 0.2])));
            if sides.is_some() {
                assert!((trace(&m) - 2.0 * (1.0 + 2f64.sqrt())).abs() < 1e-9);
            }
        }
        let polygon = &domain["canonical_polygon"];
        let corners = polygon["corners"].as_array().unwrap();
        assert_eq!(corners.len(), group.word.len());
        for k in 0..corners.len() {
            let image = apply(&group.element(group.word[..k].iter().map(String::as_str)), [0.0, 0.0]);
            assert!(close(image, numbers(&corners[k]).try_into().unwrap()));
        }
    }
}

#[test]
fn covers_are_the_same_for_any_number_of_threads_and_end_at_their_limit() {
    let place = place();
    for threads in [1, 3] {
        let files =
            format!("--cover c{threads}.obj --picture p{threads}.png --size 128 --domain d{threads}.json");
        place.expect(0, &format!("cover two.obj --depth 1 {files} --threads {threads} --quiet"));
    }
    for [a, b] in [["c1.obj", "c3.obj"], ["p1.png", "p3.png"], ["d1.json", "d3.json"]] {
        assert!(std::fs::read(place.path(a)).unwrap() == std::fs::read(place.path(b)).unwrap(), "{a} {b}");
    }
    let before = place.files();
    for (code, line, says) in [
        (2, "cover two.obj --depth 2 --radius 3", "cannot be used with"),
        (2, "cover two.obj --radius -1", "finite distance greater than 0"),
        (2, "cover two.obj --radius 0", "finite distance greater than 0"),
        (2, "cover two.obj --radius nan", "finite distance greater than 0"),
        (2, "cover two.obj --radius inf", "finite distance greater than 0"),
        (2, "cover two.obj --cover c.ply", ".obj or .glb"),
        (2, "cover ball.obj --domain d.json", "own universal cover"),
        (2, "cover torus.obj --model klein --cover c.obj", "plane"),
    ] {
        let ended = place.expect(code, line);
        assert!(ended.err.contains(says), "{line}: {}", ended.err);
    }
    assert_eq!(place.files(), before);
    place.expect(0, "cover two.obj --depth 0 --report r.json --quiet");
    assert_eq!(place.json("r.json")["result"]["copies"], 1);
    for show in ["copies", "tiles"] {
        place.expect(0, &format!("cover torus.obj --show {show} --picture {show}.svg --quiet"));
        assert!(place.text(&format!("{show}.svg")).ends_with("</svg>\n"));
    }
}

#[test]
fn what_shows_no_copies_is_written_where_there_are_too_many() {
    let place = place();
    for (how, limit, option) in [("--depth 3", 100, "depth"), ("--radius 8", 20, "radius")] {
        let others = "--uv u.obj --metric m.json --generators g.json --domain d.json --report r.json";
        let ended = place.expect(
            1,
            &format!("cover two.obj {how} --limit {limit} --cover c.obj --picture p.png {others}"),
        );
        let report = place.json("r.json");
        // The cause is told once, with all that failed for it.
        let mut wishes = [option, "cover", "picture"];
        wishes.sort_unstable();
        let why = format!("--{}: more than {limit} copies; lower --{option}", wishes.join(", --"));
        assert!(ended.out.contains(&why), "{}", ended.out);
        assert_eq!(ended.out.matches("copies; lower").count(), 1, "{}", ended.out);
        for wish in wishes {
            assert!(report["result"]["failed"][wish].as_str().unwrap().contains("raise --limit"));
        }
        assert!(report["result"]["copies"].is_null());
        for written in ["u.obj", "m.json", "g.json", "d.json"] {
            assert!(place.exists(written), "{written}");
            std::fs::remove_file(place.path(written)).unwrap();
        }
        assert!(!place.exists("c.obj") && !place.exists("p.png"));
    }
}

#[test]
fn without_a_dirichlet_domain_everything_else_is_written() {
    let place = Place::new();
    // So many handles in a row that the far ones run out of digits.
    place.expect(0, "make genus --genus 25 -n 3 -o m.obj --quiet");
    let wishes = "--cover c.obj --domain d.json --metric k.json --generators g.json --report r.json";
    let ended = place.run(&format!("cover m.obj --radius 1 {wishes}"));
    assert!(place.exists("k.json") && place.exists("g.json"), "{}", ended.err);
    let result = &place.json("r.json")["result"];
    let has_domain = !result["domain"].is_null();
    assert_eq!([place.exists("c.obj"), place.exists("d.json")], [has_domain; 2]);
    if !has_domain {
        assert_eq!(ended.code, Some(1));
        assert!(result["failed"]["radius"].as_str().unwrap().contains("use --depth"));
        assert!(ended.out.contains("FAILED   --cover") && ended.out.contains("FAILED   --domain"));
    }
}

#[test]
fn a_sphere_is_its_own_cover() {
    let place = Place::new();
    place.expect(0, "make ellipsoid --axes 2 1 0.7 -n 4 -o egg.obj --quiet");
    let ended = place.expect(0, "cover egg.obj --cover c.obj --report r.json");
    assert!(ended.out.contains("own universal cover"));
    assert_eq!(place.json("r.json")["result"]["copies"], 1);
    assert!(place.exists("c.obj"));
}

#[test]
fn loops_lift_to_paths_whose_ends_their_deck_transformation_relates() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "cover two.obj --depth 1 --word a1.b1^-1 --lift-out o.json --report r.json");
    let lift = &place.json("o.json")["lifts"][0];
    let points = lift["points"].as_array().unwrap();
    let place_of = |p: &Value| -> [f64; 2] { numbers(p).try_into().unwrap() };
    let (start, end) = (place_of(&points[0]), place_of(&points[points.len() - 1]));
    let image = apply(&matrix(&lift["matrix"]), start);
    assert!((image[0] - end[0]).hypot(image[1] - end[1]) < 1e-9);
    assert!((start[0] - end[0]).hypot(start[1] - end[1]) > 0.1);
    assert!(place.json("r.json")["checks"]["lift_end"]["value"].as_f64().unwrap() <= 1e-9);
    assert!(place.expect(2, "cover two.obj --word a3").err.contains("--word a3"));
    assert!(place.expect(2, "cover two.obj --lift-out o.json").err.contains("--word"));
}

//! `ricci flow`: what is written is a metric with the curvature asked for, and its layout.

use crate::files::{curvature_error, parse_obj};
use crate::run::{Place, numbers, triples};
use crate::surfaces::{genus_two, hill, octahedron, one_vertex_torus, torus};
use serde_json::Value;
use std::f64::consts::PI;

/// Angles by the law of cosines lose half the digits near 0 and π; these surfaces stay far from that.
const RECOMPUTED: f64 = 1e-9;

#[test]
fn the_written_metric_has_the_target_curvature_in_every_space_and_scheme() {
    let place = Place::new();
    place.put("torus.obj", &torus(16, 12).obj()).put("disk.obj", &hill(8).obj());
    place.put("two.obj", &genus_two(12).obj());
    place.expect(0, "make ellipsoid --axes 1.2 1 0.9 -n 4 -o ball.obj");
    for (mesh, space) in [("torus", "e2"), ("disk", "e2"), ("two", "h2"), ("two", "e2"), ("ball", "s2")] {
        for scheme in ["yamabe", "inversive", "tangential"] {
            let line =
                format!("flow {mesh}.obj --space {space} --scheme {scheme} --metric m.json --report r.json");
            let ended = place.run(&line);
            let (metric, report) = (place.json("m.json"), place.json("r.json"));
            assert_eq!(report["result"]["converged"], true, "{line}\n{}{}", ended.out, ended.err);
            assert_eq!(metric["space"], space);
            assert_eq!(metric["scheme"], scheme);
            let error = curvature_error(&metric);
            assert!(error <= RECOMPUTED, "{line}: recomputed |K − K̄| = {error:e}");
            assert_eq!(ended.code, Some(0), "{line}\n{}", ended.out);
        }
    }
}

fn reported() -> Value {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    place.expect(0, "flow torus.obj --report r.json --uv o.obj --quiet --threads 1");
    place.json("r.json")
}

#[test]
fn the_report_names_the_input_and_the_options() {
    let report = reported();
    assert!(report["ricci"].is_string());
    assert_eq!(report["command"], "flow");
    assert_eq!(report["input"]["path"], "torus.obj");
    for (key, value) in [
        ("vertices", 96),
        ("edges", 288),
        ("faces", 192),
        ("components", 1),
        ("euler", 0),
        ("genus", 1),
        ("boundary_loops", 0),
    ] {
        assert_eq!(report["input"][key], value, "{key}");
    }
    for (key, value) in [
        ("space", "e2"),
        ("scheme", "yamabe"),
        ("target", "uniform"),
        ("method", "newton"),
        ("flips", "auto"),
        ("input_geometry", "e2"),
    ] {
        assert_eq!(report["options"][key], value);
    }
    assert_eq!(report["options"]["tolerance"], 1e-10);
    assert_eq!(report["options"]["threads"], 1);
}

#[test]
fn the_report_has_the_fields_of_the_contract() {
    let report = reported();
    let number = |at: &Value| assert!(at.is_f64() || at.is_u64() || at.is_i64(), "{at}");
    let result = &report["result"];
    for (key, value) in [("space", "e2"), ("scheme", "yamabe"), ("stop_reason", "converged")] {
        assert_eq!(result[key], value);
    }
    assert_eq!(result["converged"], true);
    for key in [
        "iterations",
        "flips",
        "max_curvature_error",
        "flipped_triangles",
        "qc_mean",
        "qc_max",
        "area_ratio_min",
        "area_ratio_max",
        "area",
        "broken_triangles",
    ] {
        number(&result[key]);
    }
    assert_eq!(numbers(&result["modulus"]).len(), 2);
    for seam in result["seams"].as_array().unwrap() {
        number(&seam["rotation"]);
        number(&seam["residual"]);
        assert_eq!(numbers(&seam["translation"]).len(), 2);
    }
    for check in
        ["gauss_bonnet", "max_curvature_error", "layout_consistency", "flipped_triangles", "broken_triangles"]
    {
        let check = &report["checks"][check];
        assert_eq!(check["holds"], true);
        assert!(check["value"].as_f64().unwrap() <= check["limit"].as_f64().unwrap());
    }
    for phase in [
        "total", "read", "build", "assemble", "analyse", "factor", "solve", "flip", "refine", "layout",
        "write",
    ] {
        assert!(report["seconds"][phase].as_f64().unwrap() >= 0.0, "{phase}");
    }
    if cfg!(target_os = "linux") {
        assert!(report["peak_bytes"].as_u64().unwrap() > 1 << 20);
    }
}

#[test]
fn a_written_metric_read_back_is_a_fixed_point() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    place.expect(0, "make genus -n 4 -o two.obj");
    for (mesh, options) in [("torus", ""), ("two", ""), ("two", "--space e2 --target single:0")] {
        place.expect(0, &format!("flow {mesh}.obj {options} --metric first.json"));
        place.expect(0, &format!("flow first.json {options} --metric second.json --report r.json"));
        assert_eq!(place.json("r.json")["result"]["iterations"], 0, "{mesh} {options}");
        let (first, second) = (place.json("first.json"), place.json("second.json"));
        for (a, b) in
            triples(&first["lengths"]).iter().flatten().zip(triples(&second["lengths"]).iter().flatten())
        {
            assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}");
        }
        assert!(numbers(&second["conformal_factor"]).iter().all(|u| u.abs() < 1e-12));
        assert_eq!(first["faces"], second["faces"]);
        assert_eq!(first["target"], second["target"]);
    }
}

#[test]
fn euclidean_variables_have_mean_zero_and_rebuild_the_lengths() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    for scheme in ["yamabe", "inversive"] {
        place.expect(0, &format!("flow torus.obj --scheme {scheme} --metric m.json"));
        let metric = place.json("m.json");
        let (u, epsilon) = (numbers(&metric["u"]), numbers(&metric["epsilon"]));
        assert!(u.iter().sum::<f64>().abs() < 1e-12 * u.len() as f64);
        let (eta, lengths) = (triples(&metric["eta"]), triples(&metric["lengths"]));
        for (f, corners) in triples(&metric["faces"]).into_iter().enumerate() {
            for k in 0..3 {
                let (i, j) = (corners[(k + 1) % 3] as usize, corners[(k + 2) % 3] as usize);
                let (x, y) = (u[i].exp(), u[j].exp());
                let square = 2.0 * eta[f][k] * x * y + epsilon[i] * x * x + epsilon[j] * y * y;
                assert!((square.sqrt() / lengths[f][k] - 1.0).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn the_layout_is_the_metric_scaled_to_the_area_of_the_surface() {
    let place = Place::new();
    place.put("torus.obj", &torus(16, 12).obj()).put("disk.obj", &hill(10).obj());
    place.put("ball.obj", &octahedron().obj()).expect(0, "make genus -n 4 -o two.obj");
    for (mesh, options) in [
        ("torus", ""),
        ("disk", ""),
        ("ball", ""),
        ("two", "--space e2"),
        ("two", "--space e2 --target single:0"),
    ] {
        let files = "--uv o.obj --metric m.json --report r.json";
        place.expect(0, &format!("flow {mesh}.obj {options} --flips never {files}"));
        let (input, uv) = (place.text(&format!("{mesh}.obj")), parse_obj(&place.text("o.obj")));
        let lengths = triples(&place.json("m.json")["lengths"]);
        let positions = input.lines().filter_map(|l| l.strip_prefix("v "));
        for (given, written) in positions.zip(&uv.v) {
            let given: Vec<f64> = given.split_whitespace().map(|x| x.parse().unwrap()).collect();
            assert_eq!(given, written);
        }
        assert_eq!(uv.faces.len(), lengths.len());
        let areas: Vec<f64> = (0..uv.faces.len()).map(|f| uv.area(f)).collect();
        assert!(areas.iter().all(|&a| a > 0.0), "{mesh}: flipped");
        assert!((areas.iter().sum::<f64>() / uv.surface_area() - 1.0).abs() < 1e-9);
        let scale = uv.sides(0)[0] / lengths[0][0];
        for (f, lengths) in lengths.iter().enumerate() {
            for (side, length) in uv.sides(f).iter().zip(lengths) {
                assert!((side / (scale * length) - 1.0).abs() < 1e-7, "{mesh} face {f}: {side} {length}");
            }
        }
        // A texture coordinate belongs to one vertex.
        let mut owner = vec![None; uv.vt.len()];
        for (v, t) in uv.faces.iter().flatten().zip(uv.corners.iter().flatten()) {
            assert_eq!(*owner[*t].get_or_insert(*v), *v);
        }
        assert!(owner.iter().all(Option::is_some));
    }
}

#[test]
fn a_torus_of_revolution_has_nearly_its_known_modulus() {
    let place = Place::new();
    place.put("torus.obj", &torus(48, 32).obj());
    place.expect(0, "flow torus.obj --report r.json");
    let modulus = numbers(&place.json("r.json")["result"]["modulus"]);
    // Radii 2 and 1: i·1/√3, equivalent to i√3; the mesh is off by O(h²).
    assert!(modulus[0].abs() < 0.02 && (modulus[1] - 3f64.sqrt()).abs() < 0.02, "{modulus:?}");
}

#[test]
fn a_torus_of_one_vertex_is_its_own_flat_metric() {
    let place = Place::new();
    place.put("t.json", &one_vertex_torus(1.0, 1.0, 2f64.sqrt()));
    place.expect(0, "info t.json");
    place.expect(0, "flow t.json --metric m.json --report r.json");
    let (metric, report) = (place.json("m.json"), place.json("r.json"));
    assert_eq!(report["input"]["vertices"], 1);
    assert_eq!(report["input"]["genus"], 1);
    assert_eq!(report["result"]["iterations"], 0);
    let modulus = numbers(&report["result"]["modulus"]);
    assert!(modulus[0].abs() < 1e-14 && (modulus[1] - 1.0).abs() < 1e-14, "{modulus:?}");
    assert!(metric["face_edges"].is_array());
    place.expect(0, "flow m.json --metric again.json");
    assert_eq!(place.json("again.json")["lengths"], metric["lengths"]);
}

#[test]
fn cones_are_where_the_file_puts_them() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    place.put("cones.csv", &format!("vertex,curvature\n5,{}\n50,{}\n", PI / 2.0, -PI / 2.0));
    place.expect(0, "flow torus.obj --target cones:cones.csv --uv o.obj --metric m.json --report r.json");
    let target = numbers(&place.json("m.json")["target"]);
    assert_eq!((target[5], target[50]), (PI / 2.0, -PI / 2.0));
    assert_eq!(target.iter().filter(|k| **k != 0.0).count(), 2);
    assert!(curvature_error(&place.json("m.json")) <= RECOMPUTED);
    // A layout with cones has seams that turn, and no modulus.
    let result = &place.json("r.json")["result"];
    let turns = |s: &Value| s["rotation"].as_f64().unwrap().abs() > 0.1;
    assert!(result["seams"].as_array().unwrap().iter().any(turns));
    assert!(result.get("modulus").is_none());

    let all: String = target.iter().enumerate().map(|(v, k)| format!("{v},{k:?}\n")).collect();
    place.put("all.csv", &all);
    place.expect(0, "flow torus.obj --target file:all.csv --metric again.json");
    assert_eq!(place.json("again.json")["lengths"], place.json("m.json")["lengths"]);
}

#[test]
fn dual_circles_are_orthogonal_to_the_vertex_circles() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    for scheme in ["inversive", "tangential", "thurston"] {
        place.run(&format!("flow torus.obj --scheme {scheme} --circles c.json --uv o.obj"));
        let (circles, uv) = (place.json("c.json"), parse_obj(&place.text("o.obj")));
        let vertex_circles = circles["vertex_circles"].as_array().unwrap();
        assert_eq!(vertex_circles.len(), uv.vt.len());
        for (t, circle) in vertex_circles.iter().enumerate() {
            assert_eq!(circle["uv"], t);
            assert_eq!(numbers(&circle["center"]), uv.vt[t]);
            assert!(circle["radius"].as_f64().unwrap() > 0.0);
        }
        let dual = circles["dual_circles"].as_array().unwrap();
        assert_eq!(dual.len(), uv.faces.len());
        for circle in dual {
            let center = numbers(&circle["center"]);
            let power = circle["power"].as_f64().unwrap();
            for t in uv.corners[circle["face"].as_u64().unwrap() as usize] {
                let r = vertex_circles[t]["radius"].as_f64().unwrap();
                let d2 = (center[0] - uv.vt[t][0]).powi(2) + (center[1] - uv.vt[t][1]).powi(2);
                assert!((d2 - power - r * r).abs() < 1e-9 * d2);
            }
            match circle["radius"].as_f64() {
                Some(r) => assert!((r * r - power).abs() < 1e-12 * (1.0 + power)),
                None => assert!(power < 0.0),
            }
        }
    }
}

#[test]
fn the_gradient_flow_agrees_with_newton_and_leaves_a_trace() {
    let place = Place::new();
    place.put("disk.obj", &hill(6).obj());
    place.expect(0, "flow disk.obj --flips never --metric newton.json");
    place.expect(0, "flow disk.obj --method gradient --metric gradient.json --trace t.csv --report r.json");
    let (a, b) = (numbers(&place.json("newton.json")["u"]), numbers(&place.json("gradient.json")["u"]));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-8));
    let text = place.text("t.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("step,energy,max_curvature_error,area,step_size"));
    let rows: Vec<Vec<f64>> =
        lines.map(|l| l.split(',').map(|x| x.parse::<f64>().unwrap()).collect()).collect();
    let steps = place.json("r.json")["result"]["iterations"].as_u64().unwrap() as usize;
    assert_eq!(rows.len(), steps + 1);
    assert!(rows.iter().enumerate().all(|(i, r)| r.len() == 5 && r[0] == i as f64));
    assert!(rows[steps][2] <= 1e-10 && rows[steps][1] < 0.0);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let place = Place::new();
    place.put("torus.obj", &torus(40, 32).obj());
    for threads in [1, 2, 3] {
        place.expect(
            0,
            &format!("flow torus.obj --threads {threads} --metric m{threads}.json --uv o{threads}.obj"),
        );
    }
    for threads in [2, 3] {
        assert!(place.text("m1.json") == place.text(&format!("m{threads}.json")));
        assert!(place.text("o1.obj") == place.text(&format!("o{threads}.obj")));
    }
}

#[test]
fn gltf_holds_the_surface_its_layout_and_a_texture() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    place.expect(0, "flow torus.obj --uv o.obj");
    place.expect(0, "flow torus.obj --uv o.glb");
    let bytes = std::fs::read(place.path("o.glb")).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[..4], b"glTF");
    assert_eq!((word(4), word(8)), (2, bytes.len()));
    assert_eq!(&bytes[16..20], b"JSON");
    let document: Value = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
    let binary = 20 + word(12);
    assert_eq!(&bytes[binary + 4..binary + 8], b"BIN\0");
    assert_eq!(binary + 8 + word(binary), bytes.len());
    let uv = parse_obj(&place.text("o.obj"));
    let count = |k: usize| document["accessors"][k]["count"].as_u64().unwrap() as usize;
    assert_eq!((count(0), count(1), count(2)), (uv.vt.len(), uv.vt.len(), 3 * uv.faces.len()));
    let view = |k: usize| {
        let start = binary + 8 + document["bufferViews"][k]["byteOffset"].as_u64().unwrap() as usize;
        &bytes[start..start + document["bufferViews"][k]["byteLength"].as_u64().unwrap() as usize]
    };
    let indices: Vec<usize> =
        view(2).chunks(4).map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize).collect();
    let floats = |k: usize| -> Vec<f64> {
        view(k).chunks(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect()
    };
    // Corner by corner the position, and the layout's coordinates themselves, v downwards.
    let (stored, texcoords) = (floats(0), floats(1));
    let center = &document["nodes"][0]["translation"];
    for (k, &i) in indices.iter().enumerate() {
        let (v, t) = (uv.faces[k / 3][k % 3], uv.corners[k / 3][k % 3]);
        for j in 0..3 {
            assert!((stored[3 * i + j] + center[j].as_f64().unwrap_or(0.0) - uv.v[v][j]).abs() < 1e-6);
        }
        let expected = [uv.vt[t][0], 1.0 - uv.vt[t][1]];
        for j in 0..2 {
            assert!((texcoords[2 * i + j] - expected[j]).abs() < 1e-4, "corner {k}");
        }
    }
    // How dense the checks are is the texture's business.
    let base = &document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    assert!(base["extensions"]["KHR_texture_transform"]["scale"][0].as_f64().unwrap() > 0.0);
    assert!(view(3).starts_with(b"\x89PNG"));
}

#[test]
fn pinned_vertices_keep_their_scale_and_the_rest_become_flat() {
    let place = Place::new();
    place.put("disk.obj", &hill(8).obj());
    place.expect(0, "flow disk.obj --pin boundary --metric m.json --report r.json");
    let (metric, report) = (place.json("m.json"), place.json("r.json"));
    let (factor, target) = (numbers(&metric["conformal_factor"]), numbers(&metric["target"]));
    let boundary = metric["boundary"].as_array().unwrap();
    for (v, on_boundary) in boundary.iter().enumerate() {
        if on_boundary == true {
            assert!(factor[v] == 0.0);
        } else {
            assert!(target[v] == 0.0 && factor[v] != 0.0);
        }
    }
    assert_eq!(report["options"]["pin"].as_array().unwrap().len(), 32);
    assert!(curvature_error(&metric) < RECOMPUTED);
    // Curvature left the inside for the boundary, all of it.
    assert!((target.iter().sum::<f64>() - 2.0 * PI).abs() < 1e-10);
}

#[test]
fn the_area_normalised_gradient_flow_keeps_the_area() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    for (option, kept) in [("--area-normalised", true), ("", false)] {
        place.expect(0, &format!("flow torus.obj --method gradient {option} --trace t.csv --report r.json"));
        let text = place.text("t.csv");
        let area = |line: &str| line.split(',').nth(3).unwrap().parse::<f64>().unwrap();
        let mut lines = text.lines().skip(1);
        let (first, last) = (area(lines.next().unwrap()), area(lines.last().unwrap()));
        assert_eq!((last / first - 1.0).abs() < 1e-12, kept, "{first} {last}");
        assert_eq!(place.json("r.json")["options"]["area_normalised"], kept);
    }
}

#[test]
fn the_default_is_reached_where_shares_of_the_boundary_are_not() {
    // A square with two holes. A corner in a single triangle has an angle below π, so that its share of −2π is out of reach.
    let place = Place::new();
    let mut square = hill(7);
    let hole = |v: &[usize; 3], i: usize, j: usize| {
        v.iter().all(|v| (i..=i + 1).contains(&(v / 8)) && (j..=j + 1).contains(&(v % 8)))
    };
    square.faces.retain(|f| !hole(f, 2, 2) && !hole(f, 4, 4));
    place.put("holes.obj", &square.obj());
    place.expect(0, "flow holes.obj --scheme tangential");
    // That target by name is an input error: it says by how much and where.
    let ended = place.expect(3, "flow holes.obj --scheme tangential --target boundary");
    assert!(ended.err.contains("too small by"), "{}", ended.err);
}

/// The boundary of a surface with handles would have to bend by −2π for each of them and more: cones take that over, and the summary
/// says so.
#[test]
fn the_default_on_open_surfaces_with_handles_places_cones() {
    let place = Place::new();
    place.expect(0, "make genus --genus 3 -n 4 --holes 2 -o open.obj --quiet");
    let ended = place.expect(0, "flow open.obj --report r.json --uv o.obj");
    assert!(ended.out.contains("target auto:6 (the default of open surfaces with handles"), "{}", ended.out);
    let report = place.json("r.json");
    assert_eq!(report["result"]["cones"].as_array().unwrap().len(), 6);
    assert_eq!(report["result"]["flipped_triangles"], 0);
    // On request the boundary, and that is the default without handles.
    assert!(place.run("flow open.obj --target boundary").out.contains("target boundary"));
    // Too many handles for a short loop: that is found out soon, and said by name.
    place.expect(0, "make genus --genus 73 -n 2 --holes 1 -o many.obj --quiet");
    let ended = place.expect(1, "flow many.obj --target boundary --report r.json --metric m.json");
    assert!(ended.out.contains("lengths would differ by a factor of about e^"), "{}", ended.out);
    assert!(ended.out.contains("--target auto:N"), "{}", ended.out);
    let result = &place.json("r.json")["result"];
    assert_eq!((&result["stop_reason"], &result["iterations"]), (&"out_of_reach".into(), &20.into()));
    place.expect(0, "flow many.obj --report r.json");
    place.put("disk.obj", &hill(8).obj());
    assert!(place.expect(0, "flow disk.obj").out.contains("target outer"));
}

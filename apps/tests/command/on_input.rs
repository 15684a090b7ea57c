//! `--on input`: the layout on the input's own vertices and faces.

use crate::files::parse_obj;
use crate::run::Place;
use crate::surfaces::{genus_two, hill, pierced_plate, sheared_hill};

/// With `--on input` the file has the input's own vertices and faces, in order; the faces around an edge that is no seam share their
/// points.
#[test]
fn the_inputs_own_faces_are_written_on_request() {
    let place = Place::new();
    place.put("two.obj", &genus_two(12).obj()).put("disk.obj", &hill(8).obj());
    place.expect(0, "make ellipsoid --axes 1.2 1 0.9 -n 8 -o ball.obj");
    let lines = [
        ("ball", "flow ball.obj --target auto:8"),
        ("disk", "flow disk.obj"),
        ("two", "flow two.obj"),
        ("two", "flow two.obj --space e2 --target single:3"),
        ("two", "uniformize two.obj"),
    ];
    for (name, line) in lines {
        let ended = place.run(&format!("{line} --uv own.obj --on input --report r.json --quiet"));
        let own = parse_obj(&place.text("own.obj"));
        let (vertices, faces) = parse_plain(&place.text(&format!("{name}.obj")));
        assert_eq!(own.v, vertices, "{line}");
        assert_eq!(own.faces, faces, "{line}");
        let result = &place.json("r.json")["result"];
        let (seams, folds) = seams_and_folds(&own);
        assert_eq!(result["flipped_input_faces"].as_u64(), Some(folds), "{line}");
        assert_eq!(result["flipped_triangles"].as_u64(), Some(folds), "{line}");
        assert_eq!(ended.code, Some(i32::from(folds > 0)), "{line}");
        assert!(folds as usize * 50 < own.faces.len(), "{line}: {folds} faces fold");
        let most = own.faces.len() / 4;
        assert!(seams < most, "{line}: {seams} edges on seams");
    }
    place.expect(2, "flow two.obj --charts --space e2 --target single:3 --uv own.obj --on input");
}

/// With `--repair` edges are split until no face of the file is turned over; the first vertices are the input's, and figures and exit code
/// are those of the file.
#[test]
fn a_repair_leaves_no_face_turned_over() {
    let place = Place::new();
    place.put("two.obj", &genus_two(12).obj()).put("hill.obj", &sheared_hill(8).obj());
    for line in
        ["flow hill.obj --target boundary", "flow two.obj --space e2 --target single:3", "uniformize two.obj"]
    {
        let line = format!("{line} --uv own.obj --on input --report r.json");
        let said = place.run(&line);
        let (_, folds) = seams_and_folds(&parse_obj(&place.text("own.obj")));
        assert_eq!(said.code, Some(i32::from(folds > 0)), "{line}\n{}", said.out);
        assert_eq!(said.out.contains("flipped_triangles = "), folds > 0, "{line}\n{}", said.out);
        assert_eq!(said.out.contains("add --repair"), folds > 0, "{line}\n{}", said.out);

        let said = place.expect(0, &format!("{line} --repair --xref x.csv")).out;
        let own = parse_obj(&place.text("own.obj"));
        let (given, _) = parse_plain(&place.text(if line.contains("two") { "two.obj" } else { "hill.obj" }));
        let result = &place.json("r.json")["result"];
        assert_eq!(seams_and_folds(&own).1, 0, "{line}");
        assert_eq!(
            (&own.v[..given.len()], &result["flipped_input_faces"]),
            (&given[..], &folds.into()),
            "{line}"
        );
        assert_eq!(result["added_vertices"], own.v.len() - given.len(), "{line}");
        assert!(said.contains(&format!("repaired {folds} face")), "{line}\n{said}");
        let rows = place.text("x.csv").lines().count();
        assert_eq!(rows, own.faces.len() + own.v.len() + 2, "{line}");
    }
    let refused = place.expect(2, "flow hill.obj --uv own.obj --repair").err;
    assert!(refused.contains("--on input"), "{refused}");
}

/// Edges inside whose two faces have their ends in different places, and faces that are not counterclockwise.
fn seams_and_folds(mesh: &crate::files::Obj) -> (usize, u64) {
    let mut known = std::collections::HashMap::new();
    let (mut seams, mut folds) = (0, 0);
    for (face, uv) in mesh.faces.iter().zip(&mesh.corners) {
        let [a, b, c] = uv.map(|k| mesh.vt[k]);
        folds += u64::from((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0);
        for k in 0..3 {
            let next = (k + 1) % 3;
            known.insert((face[k], face[next]), (uv[k], uv[next]));
            let other = known.get(&(face[next], face[k]));
            seams += usize::from(other.is_some_and(|&(p, q)| (q, p) != (uv[k], uv[next])));
        }
    }
    (seams, folds)
}

/// `--xref` says where each face and vertex of `--uv` lies in the input's faces, and the summary how many are new.
#[test]
fn the_way_back_to_the_inputs_faces_is_written_on_request() {
    let place = Place::new();
    place.put("two.obj", &genus_two(12).obj());
    // Three faces of the input fold, which the exit code says.
    for (code, options) in [(0, ""), (1, "--on input")] {
        let line = "flow two.obj --space e2 --target single:3 --uv o.obj --xref x.csv";
        let ended = place.expect(code, &format!("{line} {options}"));
        let (given, own) = (parse_plain(&place.text("two.obj")), parse_obj(&place.text("o.obj")));
        let table = place.text("x.csv");
        let (faces, vertices) = table.split_once("output_vertex,source_face,b0,b1,b2\n").unwrap();
        let faces = faces.strip_prefix("output_face,source_face\n").unwrap();
        let row = |line: &str| -> Vec<f64> { line.split(',').map(|x| x.parse().unwrap()).collect() };
        assert_eq!((faces.lines().count(), vertices.lines().count()), (own.faces.len(), own.v.len()));
        let mut area = vec![0.0; given.1.len()];
        for (f, row) in faces.lines().map(row).enumerate() {
            assert_eq!(row[0], f as f64);
            area[row[1] as usize] += doubled_area(own.faces[f].map(|v| own.v[v]));
        }
        for (f, corners) in given.1.iter().enumerate() {
            let whole = doubled_area(corners.map(|v| given.0[v]));
            assert!((area[f] / whole - 1.0).abs() < 1e-9, "face {f}: {} of {whole}", area[f]);
        }
        for (v, row) in vertices.lines().map(row).enumerate() {
            let corners = given.1[row[1] as usize].map(|c| given.0[c]);
            for k in 0..3 {
                let x: f64 = (0..3).map(|c| row[2 + c] * corners[c][k]).sum();
                assert!((x - own.v[v][k]).abs() < 1e-9, "vertex {v}");
            }
        }
        let added = format!(
            "added    {} vertices and {} faces",
            own.v.len() - given.0.len(),
            own.faces.len() - given.1.len()
        );
        assert_eq!(ended.out.contains(&added), options.is_empty(), "{}", ended.out);
    }
    place.expect(2, "flow two.obj --xref x.csv");
}

fn parse_plain(text: &str) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let rows = |kind: &str| -> Vec<[f64; 3]> {
        let parse = |t: &str| t.parse::<f64>().unwrap();
        let row = |l: &str| l.split_whitespace().map(parse).collect::<Vec<_>>().try_into().unwrap();
        text.lines().filter_map(|l| l.strip_prefix(kind)).map(row).collect()
    };
    (rows("v "), rows("f ").into_iter().map(|f| f.map(|v| v as usize - 1)).collect())
}

fn doubled_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let (p, q) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    n.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Lines of H² are arcs in the Poincaré disk, and files draw straight lines: thin pieces between an arc and its chord would be turned over,
/// so edges are split there, and the way back knows the new vertices.
#[test]
fn straight_lines_turn_no_piece_of_a_hyperbolic_layout_over() {
    let place = Place::new();
    place.put("plate.obj", &pierced_plate().obj());
    // The second one would get more than four times as many pieces: it stays as it is, which is told.
    for (line, is_split) in [("flow plate.obj", true), ("uniformize plate.obj", false)] {
        let line = format!("{line} --uv u.obj --xref x.csv --report r.json");
        let ended = place.run(&line);
        let (uv, result) = (parse_obj(&place.text("u.obj")), &place.json("r.json")["result"]);
        assert_eq!((ended.code, &result["flipped_triangles"]), (Some(0), &0.into()), "{line}");
        let told = result["turned_by_straight_sides"].as_u64().unwrap_or(0);
        assert_eq!(result["straightened_edges"].as_u64() > Some(0), is_split, "{line}: {result}");
        let turned = (0..uv.faces.len()).filter(|&f| uv.area(f) <= 0.0).count() as u64;
        let flat = result["degenerate_pieces"].as_u64().unwrap();
        assert!(
            (told..=told + flat).contains(&turned) && (told == 0) == is_split,
            "{line}: {turned}, {told}"
        );
        let (given, xref) = (pierced_plate(), place.text("x.csv"));
        let rows = xref.split("output_vertex,source_face,b0,b1,b2\n").nth(1).unwrap().lines();
        assert_eq!(rows.clone().count(), uv.v.len());
        for row in rows {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            let corners = given.faces[cells[1] as usize].map(|v| given.positions[v]);
            for k in 0..3 {
                let at: f64 = (0..3).map(|i| cells[2 + i] * corners[i][k]).sum();
                assert!((at - uv.v[cells[0] as usize][k]).abs() < 1e-12, "{line}: {row}");
            }
        }
        let areas = uv.faces.iter().map(|f| area(f.map(|v| uv.v[v]))).sum::<f64>();
        let whole = given.faces.iter().map(|f| area(f.map(|v| given.positions[v]))).sum::<f64>();
        assert!((areas / whole - 1.0).abs() < 1e-12, "{line}: {areas} of {whole}");
    }
}

/// The area of a triangle in space.
fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let [p, q] = [b, c].map(|d| [0, 1, 2].map(|k| d[k] - a[k]));
    let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
}

//! `ricci match`: the file of a map read with formulas of its own, the report, refusals.

use crate::run::Place;

/// Rows of a map: the number of a vertex, a face and three weights.
fn rows(text: &str) -> Vec<(usize, usize, [f64; 3])> {
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        (number(0) as usize, number(1) as usize, [number(2), number(3), number(4)])
    };
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("source_vertex,target_face,b0,b1,b2"));
    lines.map(row).collect()
}

/// Vertices and faces of an OBJ file.
fn obj(text: &str) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["v", x, y, z, ..] => points.push([x, y, z].map(|c| c.parse().unwrap())),
            ["f", a, b, c] => {
                faces.push([a, b, c].map(|w| w.split('/').next().unwrap().parse::<usize>().unwrap() - 1));
            }
            _ => {}
        }
    }
    (points, faces)
}

#[test]
fn the_files_of_a_map_say_where_vertices_go_and_landmarks_are_met() {
    let place = Place::new();
    place.expect(0, "make sphere -n 5 -o ball.obj");
    place.expect(0, "make sphere -n 7 --noise 0.02 -o other.obj");
    // The corners of the icosahedron come first.
    place.put("L.csv", "source_vertex,target_vertex\n0,1\n3,4\n5,0\n8,11\n11,8\n");
    place.expect(
        0,
        "match ball.obj other.obj --landmarks L.csv --map M.csv --back B.csv -o shaped.obj --picture p.png --report R.json",
    );
    let report = place.json("R.json");
    assert_eq!(report["result"]["flipped_triangles"], 0);
    assert_eq!(report["input"]["target"]["genus"], 0);
    assert!(report["result"]["landmark_error"].as_f64().unwrap() < 1e-8);
    let [(_, _), (points, faces)] = ["ball.obj", "other.obj"].map(|name| obj(&place.text(name)));
    let (shaped, _) = obj(&place.text("shaped.obj"));
    let map = rows(&place.text("M.csv"));
    assert!(map.len() == shaped.len() && rows(&place.text("B.csv")).len() == points.len());
    for (v, (row, face, weights)) in map.into_iter().enumerate() {
        assert!(row == v && weights.iter().all(|w| *w >= 0.0));
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for i in 0..3 {
            let x: f64 = (0..3).map(|k| weights[k] * points[faces[face][k]][i]).sum();
            assert!((x - shaped[v][i]).abs() < 1e-9);
        }
    }
    for (from, to) in [(0, 1), (3, 4), (5, 0), (8, 11), (11, 8)] {
        assert!((0..3).all(|i| (shaped[from][i] - points[to][i]).abs() < 1e-8));
    }
}

#[test]
fn the_parts_of_an_overlay_lie_where_their_file_says() {
    let place = Place::new();
    place.expect(0, "make torus --big 1 --small 0.3 -o thin.obj");
    place.expect(0, "make torus --big 1 --small 0.5 -o thick.obj");
    place.expect(
        0,
        "match thin.obj thick.obj --overlay O.obj --overlay-places O.csv --domains D.png --heat H.png --picture P.png --show heat --size 100 --draft \
         --report R.json",
    );
    let report = place.json("R.json");
    assert!(report["checks"]["overlay_area"]["value"].as_f64().unwrap() < 1e-10);
    assert_eq!(std::fs::read(place.path("H.png")).unwrap(), std::fs::read(place.path("P.png")).unwrap());
    assert!(std::fs::read(place.path("D.png")).unwrap() != std::fs::read(place.path("P.png")).unwrap());
    let [source, target, parts] = ["thin.obj", "thick.obj", "O.obj"].map(|name| obj(&place.text(name)));
    assert_eq!(report["result"]["overlay_faces"], parts.1.len());
    let text = place.text("O.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("face,vertex,source_face,a0,a1,a2,target_face,b0,b1,b2,weight"));
    let at = |(points, faces): &(Vec<[f64; 3]>, Vec<[usize; 3]>), fields: &[f64]| -> [f64; 3] {
        let corners = faces[fields[0] as usize];
        std::array::from_fn(|i| (0..3).map(|k| fields[1 + k] * points[corners[k]][i]).sum())
    };
    // Where every vertex lies on the target, which all faces at it agree on.
    let mut there = vec![None; parts.0.len()];
    let mut count = 0;
    for (row, line) in lines.enumerate() {
        let fields: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let vertex = fields[1] as usize;
        assert!(fields[0] as usize == row / 3 && parts.1[row / 3][row % 3] == vertex);
        let [here, image] = [at(&source, &fields[2..]), at(&target, &fields[6..])];
        assert!((0..3).all(|i| (here[i] - parts.0[vertex][i]).abs() < 1e-9));
        let first = *there[vertex].get_or_insert(image);
        assert!((0..3).all(|i| (image[i] - first[i]).abs() < 1e-9));
        count += 1;
    }
    assert!(count == 3 * parts.1.len() && there.iter().all(Option::is_some));
}

#[test]
fn points_curves_and_soft_landmarks_come_from_files() {
    let place = Place::new();
    place.expect(0, "make torus --big 2 --small 0.8 -n 24 -m 12 -o torus.obj");
    place.put("P.csv", "source_face,s0,s1,s2,target_face,t0,t1,t2\n10,0.2,0.3,0.5,40,0.25,0.25,0.5\n");
    place.put("S.csv", "source_vertex,target_vertex,weight\n150,160,1\n");
    place.expect(0, "match torus.obj torus.obj --points P.csv --soft S.csv --report R.json");
    let report = place.json("R.json");
    assert_eq!(report["result"]["points"], 1);
    assert!(report["result"]["point_error"].as_f64().unwrap() < 1e-8);
    assert!(report["result"]["soft_left"][0].as_f64().unwrap() > 0.0);
    place.put("K.csv", "curve,surface,vertex\n0,source,0\n0,elsewhere,1\n");
    let said = place.expect(3, "match torus.obj torus.obj --curves K.csv");
    assert!(said.err.contains("K.csv:3") && said.err.contains("elsewhere"), "{}", said.err);
    place.put("K.csv", "0,source,0\n0,source,150\n0,target,0\n0,target,1\n");
    let said = place.expect(3, "match torus.obj torus.obj --curves K.csv");
    assert!(said.err.contains("curve 0") && said.err.contains("vertex 150"), "{}", said.err);
}

#[test]
fn loops_become_circles_and_the_report_says_how_round_they_are() {
    let place = Place::new();
    place.expect(0, "make torus --small 0.3 --holes 1 -o thin.obj");
    place.expect(0, "make torus --small 0.5 --holes 1 -o thick.obj");
    place.expect(0, "match thin.obj thick.obj --loop-shape circles --domains D.png --report R.json");
    let report = place.json("R.json");
    let circles = report["result"]["circles"].as_array().unwrap();
    assert!(circles.len() == 1 && circles[0]["loop"] == 0);
    assert!(circles[0]["deviation"].as_f64().unwrap() < 1e-9 && circles[0]["radius"].as_f64().unwrap() > 0.0);
    assert_eq!(
        (&report["result"]["space"], &report["result"]["flipped_triangles"]),
        (&"e2".into(), &0.into())
    );
    place.expect(0, "match thin.obj thick.obj --report R.json");
    assert!(place.json("R.json")["result"].get("circles").is_none());
}

#[test]
fn loops_name_the_class_of_a_map() {
    let place = Place::new();
    place.expect(0, "make torus --big 2 --small 0.8 -n 24 -m 12 -o torus.obj");
    // Around the tube, around the axis, and both one after the other.
    let tube: Vec<usize> = (0..12).map(|k| 24 * k).chain([0]).collect();
    let axis: Vec<usize> = (0..24).chain([0]).collect();
    let both: Vec<usize> = axis.iter().chain(&tube[1..]).copied().collect();
    let file = |loops: [[&Vec<usize>; 2]; 2]| {
        let mut text = String::from("loop,surface,vertex\n");
        for (k, pair) in loops.iter().enumerate() {
            for (name, path) in ["source", "target"].iter().zip(pair) {
                path.iter().for_each(|v| text += &format!("{k},{name},{v}\n"));
            }
        }
        text
    };
    let result = |loops| {
        place.put("G.csv", &file(loops));
        place.expect(0, "match torus.obj torus.obj --basis G.csv --same-numbering --report R.json");
        let result = place.json("R.json")["result"].clone();
        assert_eq!(result["markings"], 1);
        ["partner_max", "energy", "qc_mean"].map(|name| result[name].as_f64().unwrap())
    };
    let [off, energy, _] = result([[&tube, &tube], [&axis, &axis]]);
    assert!(off < 1e-8, "{off}");
    let [off, twisted, qc] = result([[&tube, &tube], [&axis, &both]]);
    assert!(off > 0.1 && twisted > 1.05 * energy && qc > 1.2, "{off} {energy} {twisted} {qc}");
    let refused = |loops, words: &[&str]| {
        place.put("G.csv", &file(loops));
        let said = place.expect(3, "match torus.obj torus.obj --basis G.csv");
        assert!(words.iter().all(|word| said.err.contains(word)), "{}", said.err);
    };
    refused([[&tube, &axis], [&axis, &tube]], &["loops 0 and 1", "intersection number"]);
    refused([[&tube, &tube], [&tube, &tube]], &["generate"]);
    let [open, jump] = [vec![0, 24], vec![0, 150, 0]];
    refused([[&tube, &tube], [&axis, &open]], &["loop 1", "not closed on the target"]);
    refused([[&tube, &tube], [&axis, &jump]], &["G.csv", "loop 1", "no edge joins vertices 0 and 150"]);
}

#[test]
fn a_map_is_judged_and_an_unlikely_one_is_exit_1() {
    let place = Place::new();
    place.expect(0, "make ellipsoid --axes 1 1 3 -n 5 -o long.obj");
    let said = place.expect(0, "match long.obj long.obj --report R.json");
    assert!(said.out.contains("verdict  good"), "{}", said.out);
    let result = &place.json("R.json")["result"];
    assert!(result["verdict"] == "good" && result["agreement"].as_f64().unwrap() > 0.9, "{result}");
    let search = &result["search"];
    for side in ["kept", "mirrored"] {
        let found = &search[side];
        assert!(found["misfit"].as_f64().unwrap() < 0.1, "{search}");
        assert!(found["pairs"].as_array().unwrap().iter().all(|pair| pair.as_array().unwrap().len() == 2));
    }
    assert!(search["candidates"]["signs"].as_u64().unwrap() > 0 && result["mirror"] == false, "{result}");
    // A needle has no parts that are like those of a lens.
    place.expect(0, "make ellipsoid --axes 1 1 6 -n 5 -o needle.obj");
    place.expect(0, "make ellipsoid --axes 1 3 3 -n 5 -o lens.obj");
    let said = place.expect(1, "match needle.obj lens.obj --report R.json");
    assert!(said.out.contains("verdict  unlikely"), "{}", said.out);
    assert_eq!(place.json("R.json")["checks"]["unlikely"]["holds"], false);
    // The poles go to the equator, as the landmarks ask: that is said, and no check.
    let (points, _) = obj(&place.text("long.obj"));
    let most = |k: usize| (0..points.len()).max_by(|&a, &b| points[a][k].total_cmp(&points[b][k])).unwrap();
    let [a, b, c] = [0, 1, 2].map(most);
    place.put("L.csv", &format!("{c},{a}\n{a},{b}\n{b},{c}\n"));
    let said = place.expect(0, "match long.obj long.obj --landmarks L.csv --report R.json");
    assert!(said.out.contains("verdict  unlikely"), "{}", said.out);
    assert!(place.json("R.json")["checks"]["unlikely"].is_null());
}

#[test]
fn what_cannot_be_matched_is_refused_by_name() {
    let place = Place::new();
    place.expect(0, "make sphere -n 3 -o ball.obj");
    place.expect(0, "make torus --big 2 --small 1 -o torus.obj");
    let said = place.expect(3, "match ball.obj torus.obj");
    assert!(said.err.contains("genus 0"), "{}", said.err);
    place.put("L.csv", "0,1\n3,1\n5,2\n");
    let said = place.expect(3, "match ball.obj ball.obj --landmarks L.csv");
    assert!(said.err.contains("landmarks 0 and 1 conflict"), "{}", said.err);
    place.expect(0, "make disk -n 5 -o disk.obj");
    place.expect(0, "make annulus --inner 0.4 -n 4 -m 24 -o annulus.obj");
    let said = place.expect(3, "match disk.obj annulus.obj");
    assert!(said.err.contains("1 boundary loops, the target 2"), "{}", said.err);
    let said = place.expect(3, "match annulus.obj annulus.obj --loops 1,1");
    assert!(said.err.contains("[1, 1]"), "{}", said.err);
    // The last vertex of a disk lies on its boundary, the first one inside.
    let (points, _) = obj(&place.text("disk.obj"));
    let rim = points.len() - 1;
    place.put("L.csv", &format!("{rim},0\n"));
    let said = place.expect(3, "match disk.obj disk.obj --landmarks L.csv");
    assert!(said.err.contains("landmark 0 lies on the boundary of the source"), "{}", said.err);
    let [a, b, c] = [rim, rim - 8, rim - 16];
    place.put("L.csv", &format!("{a},{a}\n{b},{c}\n{c},{b}\n"));
    let said = place.expect(3, "match disk.obj disk.obj --landmarks L.csv");
    assert!(said.err.contains("boundary loop 0 of the source conflict"), "{}", said.err);
    place.put("S.csv", &format!("0,{rim},1\n"));
    let said = place.expect(3, "match disk.obj disk.obj --soft S.csv");
    assert!(said.err.contains("soft landmark 0 lies on the boundary"), "{}", said.err);
    place.put("P.csv", "0,0.5,0.75,-0.25,0,0.5,0.25,0.25\n");
    let said = place.expect(2, "match disk.obj disk.obj --points P.csv");
    assert!(said.err.contains("weights of a point is [0.5, 0.75, -0.25]"), "{}", said.err);
    // Curves: across no edge, closed on one surface only, in conflict with a landmark.
    let curve = |rows: &[(&str, &str)]| -> String {
        let lines = rows.iter().map(|(surface, vertex)| format!("0,{surface},{vertex}\n"));
        format!("curve,surface,vertex\n{}", lines.collect::<String>())
    };
    let short = [("source", "0"), ("source", "1"), ("target", "0"), ("target", "2")];
    let far = rim.to_string();
    let jump = [("source", "0"), ("source", &far), ("target", "0"), ("target", "2")];
    place.put("K.csv", &curve(&jump));
    let said = place.expect(3, "match disk.obj disk.obj --curves K.csv");
    assert!(said.err.contains("curve 0"), "{}", said.err);
    let closed = [&short[..], &[("target", "1"), ("target", "0")]].concat();
    place.put("K.csv", &curve(&closed));
    let said = place.expect(3, "match disk.obj disk.obj --curves K.csv");
    assert!(said.err.contains("curve 0 closes on one surface"), "{}", said.err);
    place.put("K.csv", &curve(&short));
    place.put("L.csv", "3,2\n");
    let said = place.expect(3, "match disk.obj disk.obj --curves K.csv --landmarks L.csv");
    assert!(said.err.contains("conflict"), "{}", said.err);
    // Circles for a surface without handles.
    let said = place.expect(3, "match annulus.obj annulus.obj --loop-shape circles");
    assert!(said.err.contains("genus 0 and 2 boundary loops"), "{}", said.err);
    let said = place.expect(2, "match annulus.obj annulus.obj --loop-shape squares");
    assert!(said.err.contains("squares"), "{}", said.err);
    place.put("F.csv", "0,1\n3,100000\n");
    place.expect(3, "match ball.obj ball.obj --landmarks F.csv");
    place.expect(2, "match ball.obj torus.obj --same-numbering");
}

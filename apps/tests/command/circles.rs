//! `ricci circles`: loops on circles, found again from the files with formulas of our own.

use crate::files::{curvature_error, parse_obj};
use crate::run::{Place, numbers};
use crate::surfaces::sheet;
use std::collections::{HashMap, HashSet};

/// Texture coordinates on the boundary of a file's faces, and their corners.
fn boundary(place: &Place, name: &str) -> Vec<[f64; 2]> {
    let obj = parse_obj(&place.text(name));
    let sides = |k: usize| obj.corners.iter().map(move |c| (c[k], c[(k + 1) % 3]));
    let all: HashSet<(usize, usize)> = (0..3).flat_map(sides).collect();
    all.iter().filter(|(a, b)| !all.contains(&(*b, *a))).map(|(a, _)| obj.vt[*a]).collect()
}

/// Loop, centre and radius of the report's circles.
fn circles(place: &Place) -> Vec<([f64; 2], f64)> {
    let all = place.json("r.json")["result"]["circles"].as_array().unwrap().clone();
    let circle = |c: &serde_json::Value| {
        let center = numbers(&c["center"]).try_into().unwrap();
        assert!(c["deviation"].as_f64().unwrap() < 1e-10);
        (center, c["radius"].as_f64().unwrap())
    };
    all.iter().map(circle).collect()
}

fn is_on(p: &[f64; 2], (c, r): &([f64; 2], f64)) -> bool {
    ((p[0] - c[0]).hypot(p[1] - c[1]) - r).abs() < 1e-11 * r
}

#[test]
fn holes_of_a_sphere_are_round_in_every_file() {
    let place = Place::new();
    place.expect(0, "make sphere -n 8 --holes 5 -o holes.obj");
    let line = "circles holes.obj --uv uv.obj --xref x.csv --metric m.json --report r.json --outer 3 --picture p.svg";
    place.expect(0, line);
    let (circles, points) = (circles(&place), boundary(&place, "uv.obj"));
    assert_eq!((circles.len(), circles[3]), (5, ([0.0; 2], 1.0)));
    assert!(points.len() >= 60);
    for p in &points {
        assert_eq!(circles.iter().filter(|c| is_on(p, c)).count(), 1);
    }
    let report = place.json("r.json");
    assert_eq!((&report["options"]["outer"], &report["result"]["outer"]), (&3.into(), &3.into()));
    assert_eq!(report["result"]["flipped_triangles"], 0);
    assert!(curvature_error(&place.json("m.json")) < 1e-10);
    assert!(place.text("p.svg").contains("<svg"));
}

#[test]
fn the_way_back_leads_to_the_surface_as_it_was_given() {
    let place = Place::new();
    // Loops of six edges are halved.
    place.expect(0, "make annulus -n 2 -m 6 -o ring.obj");
    place.expect(0, "circles ring.obj --uv uv.obj --xref x.csv --report r.json");
    assert!(place.json("r.json")["result"]["halved_edges"].as_u64().unwrap() >= 12);
    // With the vertices as texture coordinates, which the parser asks for.
    let text = place.text("ring.obj");
    let given = text.lines().map(|line| {
        let numbers: Vec<&str> =
            line.split_whitespace().skip(1).map(|n| n.split('/').next().unwrap()).collect();
        let corners: Vec<String> = numbers.iter().map(|n| format!("{n}/{n}")).collect();
        if line.starts_with("f ") { format!("f {}", corners.join(" ")) } else { line.into() }
    });
    let given = parse_obj(&given.collect::<Vec<String>>().join("\n"));
    let finer = parse_obj(&place.text("uv.obj"));
    let text = place.text("x.csv");
    let (faces, vertices) = text.split_once("output_vertex,source_face,b0,b1,b2\n").unwrap();
    assert_eq!(faces.lines().count() - 1, finer.faces.len());
    let mut placed = HashMap::new();
    for line in vertices.lines() {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let corners = given.faces[row[1] as usize];
        let point = [0, 1, 2].map(|k| (0..3).map(|c| row[2 + c] * given.v[corners[c]][k]).sum::<f64>());
        placed.insert(row[0] as usize, point);
    }
    for (v, p) in finer.v.iter().enumerate() {
        assert!((0..3).all(|k| (p[k] - placed[&v][k]).abs() < 1e-12));
    }
    assert_eq!(&finer.v[..given.v.len()], &given.v[..]);
}

#[test]
fn tori_and_surfaces_of_higher_genus_have_round_holes_too() {
    let place = Place::new();
    for (shape, space) in [("torus", "e2"), ("genus", "h2")] {
        place.expect(0, &format!("make {shape} --holes 2 -o holes.obj"));
        place.expect(0, "circles holes.obj --uv uv.obj --report r.json --metric m.json");
        assert_eq!(place.json("r.json")["result"]["space"], space);
        assert!(curvature_error(&place.json("m.json")) < 1e-10);
        assert_eq!(circles(&place).len(), 2);
    }
}

#[test]
fn what_is_not_there_is_refused() {
    let place = Place::new();
    place.expect(0, "make disk -o disk.obj");
    place.expect(0, "make torus --holes 1 -o torus.obj");
    place.expect(0, "make sphere -o sphere.obj");
    for (code, line, word) in [
        (3, "circles sphere.obj", "closed"),
        (2, "circles disk.obj --outer 1", "no such loop"),
        (2, "circles torus.obj --outer 0", "unit disk"),
        (2, "circles torus.obj --center 0", "unit disk"),
        (2, "circles disk.obj --three 1,2", "three vertices"),
        (2, "circles disk.obj --three 0,1,2", "outer loop"),
        (2, "circles disk.obj --center 0 --three 1,2,3", "cannot be used with"),
    ] {
        let ended = place.expect(code, line);
        assert!(ended.err.contains(word), "{line}: {}", ended.err);
    }
}

/// A cylinder of radius 1 and this modulus, its height over its circumference, of n squares around.
fn cylinder(modulus: f64, n: usize) -> String {
    let rows = (modulus * n as f64).round() as usize;
    let mut text = String::new();
    for i in 0..=rows {
        for j in 0..n {
            let angle = std::f64::consts::TAU * j as f64 / n as f64;
            let height = std::f64::consts::TAU * modulus * i as f64 / rows as f64;
            text += &format!("v {:?} {:?} {height:?}\n", angle.cos(), angle.sin());
        }
    }
    let at = |i: usize, j: usize| i * n + j % n + 1;
    for i in 0..rows {
        for j in 0..n {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
        }
    }
    text
}

#[test]
fn a_long_cylinder_is_round_in_the_disk_and_straight_in_the_strip() {
    let place = Place::new();
    place.put("tube.obj", &cylinder(6.2, 16));
    for (frame, name) in [("", "disk"), ("--frame strip", "strip")] {
        place.expect(0, &format!("circles tube.obj {frame} --uv out.obj --metric m.json --report r.json"));
        let report = place.json("r.json");
        let result = &report["result"];
        assert_eq!((&result["frame"], &result["converged"]), (&name.into(), &true.into()));
        assert!(result["roundness"].as_f64().unwrap() < 1e-9);
        let outer = result["outer"].as_u64().unwrap() as usize;
        let inner = &result["circles"][1 - outer];
        let (radius, modulus) = (inner["radius"].as_f64().unwrap(), result["modulus"].as_f64().unwrap());
        assert!((6.1..6.4).contains(&modulus) && (1e-18..1e-16).contains(&radius), "{modulus} {radius}");
        assert!(
            (inner["log_radius"].as_f64().unwrap() / (-std::f64::consts::TAU * modulus) - 1.0).abs() < 1e-9
        );
        place.expect(0, "info m.json");
    }
    place.expect(0, "make disk -n 4 -o disk.obj");
    for line in ["disk.obj --frame strip", "tube.obj --frame strip --center 40"] {
        place.expect(2, &format!("circles {line}"));
    }
}

#[test]
fn a_domain_that_is_not_as_exact_as_asked_for_says_where_and_what_to_do() {
    let place = Place::new();
    place.put("tube.obj", &cylinder(3.0, 16));
    let said = place.expect(1, "circles tube.obj --frame disk --tolerance 1e-15 --report r.json").out;
    let report = place.json("r.json");
    assert_eq!(report["result"]["converged"], false);
    assert_eq!(report["result"]["stop_reason"], "rounding_floor");
    assert!(report["result"]["worst_vertex"].is_u64());
    for part in
        ["why      max |K|", "limit 1.0e-15", "--frame strip", "--tolerance", "FAILED: max_curvature_error"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn a_sheet_too_long_for_doubles_is_said_to_be_so() {
    let place = Place::new();
    place.put("long.obj", &sheet(300, 100, 1).obj());
    let ended = place.expect(1, "circles long.obj --report r.json");
    assert_eq!(place.json("r.json")["result"]["converged"], false);
    let said = ended.out + &ended.err;
    assert!(said.contains("times as long as wide, or more, too long") && !said.contains("refine"), "{said}");
    place.expect(0, "flow long.obj --uv u.obj");
}

#[test]
fn a_sheet_without_vertices_inside_is_advised_to_be_refined_which_helps() {
    let place = Place::new();
    place.put("sheet.obj", &sheet(50, 50, 1).obj());
    let said = place.expect(1, "circles sheet.obj --report r.json").out;
    let result = &place.json("r.json")["result"];
    assert_eq!(result["converged"], false);
    assert_ne!(result["stop_reason"], "converged");
    assert!(said.contains("why      triangles break or circles overlap: cut each triangle into four, `ricci refine --levels 1`"), "{said}");
    place.expect(0, "refine sheet.obj --levels 1 -o fine.obj");
    place.expect(0, "circles fine.obj");
}

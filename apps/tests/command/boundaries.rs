//! `ricci uniformize` and `ricci cover` of surfaces with boundary.

use crate::complex::{Group, trace};
use crate::files::{curvature_error, parse_obj};
use crate::run::{Place, numbers};
use serde_json::{Value, json};
use std::f64::consts::PI;

fn place() -> Place {
    let place = Place::new();
    place.expect(0, "make pants --lengths 1 2 3 --level 3 -o pants.json --quiet");
    place.expect(0, "make genus --genus 2 -n 3 --holes 2 -o holes.obj --quiet");
    place.expect(0, "make disk --height 0.3 --n 8 -o disk.obj --quiet");
    place.expect(0, "make annulus --height 0.3 -o ring.obj --quiet");
    place.expect(0, "make torus -o torus.obj --quiet");
    place
}

fn sorted(value: &Value) -> Vec<f64> {
    let mut list = numbers(value);
    list.sort_by(f64::total_cmp);
    list
}

#[test]
fn pants_keep_the_lengths_of_their_boundary() {
    let place = place();
    place.expect(
        0,
        "uniformize pants.json --generators c.json --lengths c1,c1.c2^-1 --picture p.svg --report r.json",
    );
    let (report, group) = (place.json("r.json"), Group::read(&place.json("c.json")));
    let result = &report["result"];
    let lengths = sorted(&result["boundary_lengths"]);
    assert!(lengths.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-8), "{lengths:?}");
    assert_eq!(
        (&report["options"]["boundary"], &report["options"]["model"]),
        (&"geodesic".into(), &"poincare".into())
    );
    assert_eq!(group.word.join(" "), "c1 c2 c3");
    assert!(group.residual() < 1e-12, "{}", group.residual());
    for around in result["boundary"].as_array().unwrap() {
        // 2 acosh(|tr|/2) of the loop's generator.
        let t = trace(&group.generators[around["generator"].as_str().unwrap()]);
        assert!((2.0 * (0.5 * t).acosh() - around["length"].as_f64().unwrap()).abs() < 1e-9);
        assert_eq!(around["sides"].as_array().unwrap().len(), 1);
    }
    let words: Vec<&str> =
        result["geodesics"].as_array().unwrap().iter().map(|g| g["word"].as_str().unwrap()).collect();
    assert_eq!(words, ["c1", "c1.c2^-1"]);
    assert!((result["area"].as_f64().unwrap() - 2.0 * PI).abs() < 1e-9);
    assert!(report["checks"]["boundary_straightness"]["holds"].as_bool().unwrap());
    assert!(place.text("p.svg").contains("<svg"));
}

#[test]
fn an_open_surface_in_the_disk_is_what_its_files_say() {
    let place = place();
    place.expect(0, "uniformize holes.obj --uv u.obj --xref x.csv --metric m.json --generators c.json --picture p.png --report r.json");
    let (metric, uv) = (place.json("m.json"), parse_obj(&place.text("u.obj")));
    assert!(curvature_error(&metric) < 1e-9);
    let klein = |[x, y]: [f64; 2]| [2.0 * x / (1.0 + x * x + y * y), 2.0 * y / (1.0 + x * x + y * y)];
    for corners in &uv.corners {
        let [a, b, c] = corners.map(|k| klein(uv.vt[k]));
        assert!((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > -1e-14);
    }
    let group = Group::read(&place.json("c.json"));
    assert_eq!(group.word.join(" "), "a1 b1 a1^-1 b1^-1 a2 b2 a2^-1 b2^-1 c1 c2");
    assert!(group.residual() < 1e-9, "{}", group.residual());
    let report = place.json("r.json");
    assert!((report["result"]["area"].as_f64().unwrap() - 8.0 * PI).abs() < 1e-8);
    assert_eq!(report["result"]["boundary_lengths"].as_array().unwrap().len(), 2);
    place.expect(0, "uniformize holes.obj --on input --uv on.obj --quiet");
    let said = place.expect(0, "uniformize holes.obj").out;
    assert!(said.contains("boundary 2 closed geodesics"), "{said}");
}

#[test]
fn copies_of_an_open_surface_are_its_cover() {
    let place = place();
    place.expect(
        0,
        "cover holes.obj --radius 4 --cover all.obj --domain d.json --picture p.png --report r.json",
    );
    let domain = place.json("d.json");
    let sides = domain["sides"].as_array().unwrap();
    let on_boundary = sides.iter().filter(|side| side["partner"].is_null()).count();
    assert!(on_boundary >= 2 && on_boundary < sides.len());
    let area = domain["area"].as_f64().unwrap();
    assert!((area - 8.0 * PI).abs() < 1e-6, "{area}");
    assert!(place.json("r.json")["result"]["copies"].as_u64().unwrap() > 1);
}

#[test]
fn a_disk_is_a_rectangle_and_an_annulus_a_cylinder() {
    let place = place();
    place.expect(0, "uniformize disk.obj --boundary straight --uv u.obj --picture p.png --report r.json");
    let (report, uv) = (place.json("r.json"), parse_obj(&place.text("u.obj")));
    let result = &report["result"];
    let sides: Vec<f64> = result["boundary"][0]["sides"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["length"].as_f64().unwrap())
        .collect();
    let modulus = result["modulus"].as_f64().unwrap();
    assert!(
        sides.len() == 4
            && (modulus - sides[1] / sides[0]).abs() < 1e-9
            && (sides[0] - sides[2]).abs() < 1e-9
    );
    assert!(
        uv.vt
            .iter()
            .all(|p| p[0] > -1e-9 && p[0] < sides[0] + 1e-9 && p[1] > -1e-9 && p[1] < sides[1] + 1e-9)
    );
    let corners = result["corners"].as_array().unwrap();
    assert!(corners.len() == 4 && corners.iter().all(|c| c["angle"] == json!(90.0)), "{corners:?}");
    let said = place.expect(0, "uniformize disk.obj --corners 3").out;
    assert!(said.contains("boundary 3 sides"), "{said}");
    place.expect(0, "uniformize ring.obj --report ring.json --picture ring.svg --on input --uv ring_uv.obj");
    let ring = place.json("ring.json");
    let lengths = numbers(&ring["result"]["boundary_lengths"]);
    let area = ring["result"]["area"].as_f64().unwrap();
    assert!((ring["result"]["modulus"].as_f64().unwrap() - area / (lengths[0] * lengths[1])).abs() < 1e-9);
    assert_eq!(ring["result"]["domain"]["sides"], 4);
}

#[test]
fn what_a_boundary_cannot_become_is_refused_by_name() {
    let place = place();
    for (code, line, named) in [
        (3, "uniformize disk.obj", "ricci circles"),
        (3, "uniformize disk.obj --boundary geodesic", "--boundary straight"),
        (2, "uniformize torus.obj --boundary geodesic", "no boundary"),
        (2, "uniformize torus.obj --corners 4", "no boundary"),
        (2, "uniformize holes.obj --boundary geodesic --corners 4", "--boundary straight"),
        (3, "uniformize disk.obj --corners 200:90,201:90,202:90", "180°"),
        (2, "uniformize disk.obj --corners 0,1,2,3", "boundary"),
        (2, "uniformize disk.obj --corners 4:x", "no angle in degrees"),
        (2, "uniformize pants.json --lengths c4", "--lengths c4"),
        (2, "uniformize disk.obj --corners 4 --model klein", "--model"),
        (2, "uniformize disk.obj --corners 4 --show dirichlet", "--show"),
        (2, "cover disk.obj --boundary straight", "tile"),
    ] {
        let ended = place.run(line);
        assert!(
            ended.code == Some(code) && ended.err.contains(named),
            "{line}: {:?} {}",
            ended.code,
            ended.err
        );
    }
}

//! `ricci make` and `ricci demo`.

use crate::files::curvature_error;
use crate::run::{Place, numbers};

#[test]
fn shapes_have_their_topology() {
    let place = Place::new();
    for (line, file, genus, loops) in [
        ("sphere -n 3", "m.obj", 0, 0),
        ("ellipsoid -n 3", "m.obj", 0, 0),
        ("torus -n 12", "m.obj", 1, 0),
        ("disk -n 4 --height 0.3", "m.obj", 0, 1),
        ("annulus -n 4", "m.obj", 0, 2),
        ("genus -g 3 -n 3", "m.obj", 3, 0),
        ("torus -n 12", "m.json", 1, 0),
        ("flat-torus", "m.json", 1, 0),
        ("bolza", "m.json", 2, 0),
        ("one-vertex", "m.json", 2, 0),
        ("two-vertex -g 3", "m.json", 3, 0),
        ("two-triangles", "m.json", 0, 0),
        ("fenchel-nielsen", "m.json", 2, 0),
        ("fenchel-nielsen -g 1 --lengths 2,3 --twists=-1,0.5 --boundaries 1,2 --level 1", "m.json", 1, 2),
    ] {
        place.expect(0, &format!("make {line} -o {file} --quiet --threads 1 --report made.json"));
        place.expect(0, &format!("info {file} --report r.json"));
        let report = place.json("r.json");
        assert_eq!(report["input"]["genus"], genus, "{line}");
        let made = place.json("made.json");
        assert_eq!((&made["command"], &made["input"]["genus"]), (&"make".into(), &genus.into()), "{line}");
        let area = |report: &serde_json::Value| {
            let quality = &report["result"];
            quality.get("quality").unwrap_or(quality)["area"].as_f64().unwrap()
        };
        assert!((area(&made) / area(&report) - 1.0).abs() < 1e-12, "{line}");
        assert_eq!(report["input"]["boundary_loops"], loops, "{line}");
        assert_eq!(report["result"]["admissible"], true, "{line}");
    }
}

#[test]
fn the_bolza_surface_stays_put() {
    let place = Place::new();
    place.expect(0, "make bolza -l 2 -o bolza.json");
    place.expect(0, "flow bolza.json --metric m.json --report r.json");
    let (metric, result) = (place.json("m.json"), place.json("r.json")["result"].clone());
    assert_eq!((&result["space"], &result["iterations"]), (&"h2".into(), &0.into()));
    assert!(numbers(&metric["conformal_factor"]).iter().all(|u| u.abs() < 1e-13));
    assert!(curvature_error(&metric) < 1e-10);
    assert!((result["area"].as_f64().unwrap() - 4.0 * std::f64::consts::PI).abs() < 1e-10);
}

#[test]
fn a_flat_torus_has_the_modulus_it_was_made_with() {
    let place = Place::new();
    place.expect(0, "make flat-torus --tau -0.3 1.2 -n 5 -m 4 -o t.json");
    place.expect(0, "flow t.json --report r.json");
    let modulus = numbers(&place.json("r.json")["result"]["modulus"]);
    assert!((modulus[0] + 0.3).abs() < 1e-12 && (modulus[1] - 1.2).abs() < 1e-12, "{modulus:?}");
}

#[test]
fn every_format_that_is_written_is_read_again() {
    let place = Place::new();
    for extension in ["obj", "off", "ply", "glb"] {
        place.expect(0, &format!("make torus -n 12 -o made.{extension} --quiet"));
        place.expect(0, &format!("repair made.{extension} -o again.{extension} --report r.json"));
        let report = place.json("r.json");
        assert_eq!((&report["input"]["genus"], &report["result"]["genus"]), (&1.into(), &1.into()));
        assert_eq!(report["result"]["welded_vertices"], 0, "{extension}");
    }
    place.expect(0, "flow again.glb --report r.json");
}

#[test]
fn noise_is_seeded() {
    let place = Place::new();
    for (seed, file) in [(1, "a.obj"), (1, "b.obj"), (2, "c.obj")] {
        place.expect(0, &format!("make torus --noise 0.2 --seed {seed} -o {file}"));
    }
    assert!(place.text("a.obj") == place.text("b.obj") && place.text("a.obj") != place.text("c.obj"));
}

#[test]
fn inversions_are_made_on_demand() {
    let place = Place::new();
    // About a point of its axis: a torus of revolution again, with the outside outside.
    place.expect(0, "make torus -n 24 -o t.obj");
    place.expect(0, "make torus -n 24 --invert -5,0,0,4 -o i.obj --report r.json");
    place.expect(0, "make torus -n 24 --invert -5,0,0,4 -o i.obj --quiet");
    assert_eq!(place.json("r.json")["input"]["genus"], 1);
    let modulus = |file: &str| {
        place.expect(0, &format!("flow {file} --report f.json"));
        numbers(&place.json("f.json")["result"]["modulus"])
    };
    // A conformal map of space: the same modulus, but for what a coarse mesh makes of it.
    let (before, after) = (modulus("t.obj"), modulus("i.obj"));
    assert!((before[1] - after[1]).abs() < 0.05 * before[1], "{before:?} {after:?}");
    for wrong in ["0,0,0", "0,0,0,0", "3,0,0,1", "0,0,0,x"] {
        place.expect(2, &format!("make torus -n 24 --invert {wrong} -o x.obj"));
    }
}

#[test]
fn holes_and_bad_triangles_are_made_on_demand() {
    let place = Place::new();
    for (line, genus, loops) in [
        ("sphere -n 8 --holes 3", 0, 3),
        ("disk -n 12 --holes 4", 0, 5),
        ("torus -n 40 --holes 2 --slivers 9 --sliver-angle 1e-5", 1, 2),
        ("genus -g 3 -n 3 --ratio 2", 3, 0),
        ("knot -n 120", 1, 0),
        ("disk -n 8 --holes 2", 0, 3),
        ("genus -n 2 --holes 3", 2, 3),
        ("sphere --grade 3,10 --slivers 5 --sliver-kind needle", 0, 0),
    ] {
        place.expect(0, &format!("make {line} -o m.ply --report r.json"));
        place.expect(0, "info m.ply --report i.json");
        let (made, read) = (place.json("r.json"), place.json("i.json"));
        for report in [&made, &read] {
            assert_eq!(
                (&report["input"]["genus"], &report["input"]["boundary_loops"]),
                (&genus.into(), &loops.into())
            );
        }
        assert!(read["result"]["defects"].as_array().unwrap().is_empty(), "{line}");
        if let Some(angle) = line.split("--sliver-angle ").nth(1) {
            let asked = angle.parse::<f64>().unwrap().to_degrees();
            let angle = made["result"]["min_angle_degrees"].as_f64().unwrap();
            assert!((angle / asked - 1.0).abs() < 0.1, "{angle} {asked}");
        }
    }
}

#[test]
fn curves_are_made_with_their_periods() {
    let place = Place::new();
    place.expect(0, "make hyperelliptic --at 0,0 --at 1,0 --at 2,0 -n 12 -o m.json --report r.json");
    let tau = place.json("r.json")["result"]["period_matrix"].clone();
    assert_eq!(tau.as_array().unwrap().len(), 1);
    // y² = x (x − 1) (x − 2): the square lattice, and so is the flat torus that the flow finds.
    place.expect(0, "flow m.json --report f.json");
    let modulus = place.json("f.json")["result"]["modulus"].clone();
    let [re, im] = [0, 1].map(|k| modulus[k].as_f64().unwrap());
    assert!(re.abs() < 0.01 && (im - 1.0).abs() < 0.01, "{modulus}");
    place.expect(0, "make pants --lengths 2 3 4 -l 2 -o p.json --report p.r.json");
    let report = place.json("p.r.json");
    assert_eq!((&report["input"]["genus"], &report["input"]["boundary_loops"]), (&0.into(), &3.into()));
    let area = report["result"]["area"].as_f64().unwrap();
    assert!((area - 2.0 * std::f64::consts::PI).abs() < 1e-12, "{area}");
}

#[test]
fn what_cannot_be_made_is_exit_2() {
    let place = Place::new();
    for line in [
        "make",
        "make cube -o m.obj",
        "make torus",
        "make torus -n 2 -o m.obj",
        "make torus --small 3 -o m.obj",
        "make genus -g 0 -o m.obj",
        "make sphere -n 1000000000 -o m.obj",
        "make disk --height nan -o m.obj",
        "make bolza -o m.obj",
        "make pants --lengths 1 0 1 -o m.json",
        "make hyperelliptic --at 0,0 --at 1,0 -o m.json",
        "make hyperelliptic --at 0 --at 1,0 --at 2,0 -o m.json",
        "make knot -p 2 -q 4 -o m.obj",
        "make genus -g 2 --ratio 50 -o m.obj",
        "make sphere -n 1 --holes 3 -o m.obj",
        "make knot -n 3 -o m.obj",
        "make sphere -n 4 --grade 0,50 -o m.obj",
        "make sphere --grade 3 -o m.obj",
        "make sphere --slivers 1 --sliver-angle 1 -o m.obj",
        "make bolza -l 40 -o m.json",
        "make torus -o m.stl",
        "make torus -o missing/m.obj",
        "make flat-torus --tau 0 -1 -o m.json",
    ] {
        place.expect(2, line);
    }
    assert!(place.files().is_empty());
}

#[test]
fn the_demo_flattens_surfaces_and_uniformizes_them() {
    let place = Place::new();
    let ended = place.expect(0, "demo out --report r.json");
    let report = place.json("r.json");
    assert_eq!((&report["command"], &report["input"]), (&"demo".into(), &serde_json::Value::Null));
    for (run, name) in
        report["result"]["runs"].as_array().unwrap().iter().zip(["torus", "genus2", "disk", "two", "plane"])
    {
        assert_eq!((&run["name"], &run["result"]["converged"]), (&name.into(), &true.into()));
        assert_eq!(report["checks"][name]["holds"], true);
    }
    for (name, genus) in [("torus", 1), ("genus2", 2), ("disk", 0), ("two", 2), ("plane", 1)] {
        assert!(ended.out.contains(name));
        for suffix in [".obj", ".png", "_uv.obj", "_metric.json", "_report.json"] {
            assert!(place.exists(&format!("out/{name}{suffix}")), "{name}{suffix}");
        }
        let report = place.json(&format!("out/{name}_report.json"));
        assert_eq!(report["input"]["genus"], genus);
        assert_eq!(report["result"]["flipped_triangles"], 0);
        assert!(curvature_error(&place.json(&format!("out/{name}_metric.json"))) < 1e-9);
    }
    place.put("file", "").expect(2, "demo file");
}

#[test]
fn pants_with_thin_cuffs_are_triangles_before_and_after_flips() {
    let place = Place::new();
    // Triangles so thin that their heights are the last digits of their sides.
    place.expect(0, "make pants --lengths 1e-4 1e-4 1e-4 --level 4 -o p.json --quiet");
    place.run("flow p.json --space h2 --flips never --report r.json --quiet");
    assert_eq!(place.json("r.json")["result"]["converged"], true);
    // Flips among them run out of digits, which is no fault of the input: the run ends with a report that says so.
    for space in ["h2", "e2"] {
        let ended =
            place.run(&format!("flow p.json --space {space} --max-iterations 20 --report f.json --quiet"));
        assert!(matches!(ended.code, Some(0 | 1)), "{space}: {}", ended.err);
        assert!(place.json("f.json")["result"]["stop_reason"].is_string());
    }
}

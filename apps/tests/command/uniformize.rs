//! `ricci uniformize`: metrics of constant curvature, layouts, groups, spheres.

use crate::complex::{Group, trace};
use crate::files::{curvature_error, parse_obj};
use crate::run::{Place, numbers};
use crate::surfaces::{genus_two, hill, octahedron, torus};
use serde_json::Value;
use std::f64::consts::PI;

fn place() -> Place {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj()).put("two.obj", &genus_two(10).obj());
    place.put("disk.obj", &hill(4).obj()).put("ball.obj", &octahedron().obj());
    place.expect(0, "make ellipsoid --axes 2 1 0.7 -n 5 -o egg.obj --quiet");
    place
}

#[test]
fn a_surface_of_genus_two_lies_in_the_disk_with_its_group() {
    let place = place();
    place.expect(0, "uniformize two.obj --uv u.obj --metric m.json --generators c.json --report r.json");
    let (metric, report, group) =
        (place.json("m.json"), place.json("r.json"), Group::read(&place.json("c.json")));
    assert!(curvature_error(&metric) < 1e-9, "{}", curvature_error(&metric));
    assert_eq!(metric["space"], "h2");
    assert_eq!(group.word.join(" "), "a1 b1 a1^-1 b1^-1 a2 b2 a2^-1 b2^-1");
    assert!(group.residual() < 1e-12, "{}", group.residual());
    // b_k crosses a_k once, from right to left; loops of different handles do not cross.
    assert_eq!(
        place.json("c.json")["intersections"],
        serde_json::json!([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1], [0, 0, -1, 0]])
    );
    let traces = numbers(&report["result"]["traces"]);
    for (g, told) in ["a1", "b1", "a2", "b2"].iter().zip(&traces) {
        let t = trace(&group.generators[*g]);
        assert!(t > 2.0 && (t - told).abs() < 1e-9 * t, "{g}: {t}, told {told}");
    }
    let lengths = numbers(&report["result"]["translation_lengths"]);
    for (t, l) in traces.iter().zip(&lengths) {
        assert!((2.0 * (0.5 * l).cosh() - t).abs() < 1e-9 * t);
    }
    // Gauss–Bonnet, by the area of hyperbolic triangles with the Poincaré disk's corners.
    assert!((report["result"]["area"].as_f64().unwrap() - 4.0 * PI).abs() < 1e-9);
    let (uv, given) = (parse_obj(&place.text("u.obj")), parse_obj_plain(&place.text("two.obj")));
    assert_eq!(&uv.v[..given.len()], &given[..]);
    let klein = |[x, y]: [f64; 2]| [2.0 * x / (1.0 + x * x + y * y), 2.0 * y / (1.0 + x * x + y * y)];
    for corners in &uv.corners {
        let [a, b, c] = corners.map(|k| klein(uv.vt[k]));
        assert!((b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]));
    }
    assert!(uv.vt.iter().all(|p| p[0].hypot(p[1]) < 1.0));
}

fn parse_obj_plain(text: &str) -> Vec<[f64; 3]> {
    let of = |line: &str| -> Option<[f64; 3]> {
        let rest = line.strip_prefix("v ")?;
        let x: Vec<f64> = rest.split_whitespace().map(|t| t.parse().unwrap()).collect();
        Some([x[0], x[1], x[2]])
    };
    text.lines().filter_map(of).collect()
}

#[test]
fn a_torus_lies_in_the_plane_with_translations_and_the_area_it_had() {
    let place = place();
    place.expect(0, "uniformize torus.obj --uv u.obj --generators c.json --report r.json");
    let (report, group) = (place.json("r.json"), Group::read(&place.json("c.json")));
    for g in group.generators.values() {
        assert!((g[0][0][0] - 1.0).abs() < 1e-12 && g[0][0][1].abs() < 1e-10, "{g:?}");
        assert_eq!((g[1][0], g[1][1]), ([0.0, 0.0], [1.0, 0.0]));
    }
    let [s, t] = ["a1", "b1"].map(|g| group.generators[g][0][1]);
    let uv = parse_obj(&place.text("u.obj"));
    let area: f64 = (0..uv.faces.len()).map(|f| uv.area(f)).sum();
    assert!((area - uv.surface_area()).abs() < 1e-9 * area);
    assert!(((s[0] * t[1] - s[1] * t[0]).abs() - area).abs() < 1e-9 * area);
    // The same shape as the flow finds.
    place.expect(0, "flow torus.obj --report f.json");
    let modulus = |r: &Value| numbers(&r["result"]["modulus"]);
    for (a, b) in modulus(&report).iter().zip(modulus(&place.json("f.json"))) {
        assert!((a.abs() - b.abs()).abs() < 1e-9);
    }
}

#[test]
fn a_sphere_is_a_convex_polyhedron_about_its_centre_of_mass() {
    let place = place();
    place.expect(0, "uniformize egg.obj --sphere s.obj --metric m.json --generators c.json --report r.json");
    assert!(curvature_error(&place.json("m.json")) < 1e-9);
    assert_eq!(place.json("c.json")["generators"], serde_json::json!({}));
    assert_eq!(place.json("c.json")["intersections"], serde_json::json!([]));
    let text = place.text("s.obj");
    let v = parse_obj_plain(&text);
    let face = |line: &str| -> Option<[usize; 3]> {
        let i: Vec<usize> =
            line.strip_prefix("f ")?.split_whitespace().map(|t| t.parse::<usize>().unwrap() - 1).collect();
        Some([i[0], i[1], i[2]])
    };
    let faces: Vec<[usize; 3]> = text.lines().filter_map(face).collect();
    assert!(v.iter().all(|p| (p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14));
    // All vertices on the inner side of every face.
    for f in &faces {
        let [a, b, c] = f.map(|i| v[i]);
        let [p, q] = [b, c].map(|x| [0, 1, 2].map(|k| x[k] - a[k]));
        let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        assert!((0..3).map(|k| n[k] * a[k]).sum::<f64>() > 0.0, "{f:?} faces inward");
        for x in &v {
            assert!((0..3).map(|k| n[k] * (x[k] - a[k])).sum::<f64>() < 1e-12);
        }
    }
    let report = place.json("r.json");
    assert!(report["result"]["centring"].as_f64().unwrap() < 1e-9);
    for key in ["u_range", "smallest_edge", "nonconvexity", "puncture", "qc_mean", "area_ratio_max"] {
        assert!(report["result"][key].is_number(), "{key}");
    }
    // The paper's flow, on the same surface.
    place.expect(0, "uniformize egg.obj --method gradient --sphere g.obj --report g.json");
    assert!(parse_obj_plain(&place.text("g.obj")).len() == v.len());
    assert_eq!(place.json("g.json")["result"]["flips"], 0);
}

#[test]
fn intrinsic_metrics_have_a_group_and_pictures_of_their_domain() {
    let place = Place::new();
    place.expect(0, "make bolza --level 2 -o b.json --quiet");
    place.expect(0, "uniformize b.json --base 0 --generators c.json --report r.json --picture p.svg");
    // Systoles of the Bolza surface: |tr| = 2(1 + √2), and every trace is 2(m + n√2).
    let group = Group::read(&place.json("c.json"));
    for g in group.generators.values() {
        let half = 0.5 * trace(g);
        assert!(half > 1.0 + 2f64.sqrt() - 1e-9);
        let near = |n: i32| {
            ((half - f64::from(n) * 2f64.sqrt()) - (half - f64::from(n) * 2f64.sqrt()).round()).abs()
        };
        assert!((0..40).any(|n| near(n) < 1e-8), "{half}");
    }
    assert!(place.text("p.svg").starts_with("<svg"));
    assert!(place.expect(2, "uniformize b.json --uv u.obj").err.contains("no positions"));
    assert!(place.expect(2, "uniformize b.json --show both --picture p.png").err.contains("use domain"));
}

#[test]
fn results_do_not_depend_on_threads() {
    let place = place();
    let files = "--metric m{}.json --uv u{}.glb --generators c{}.json --picture p{}.png --size 160";
    for mesh in ["two", "torus"] {
        for threads in ["1", "3"] {
            let files = files.replace("{}", threads);
            place.expect(0, &format!("uniformize {mesh}.obj {files} --threads {threads} --quiet"));
        }
        for [a, b] in
            [["m1.json", "m3.json"], ["u1.glb", "u3.glb"], ["c1.json", "c3.json"], ["p1.png", "p3.png"]]
        {
            let bytes = |name: &str| std::fs::read(place.path(name)).unwrap();
            assert!(bytes(a) == bytes(b), "{mesh}: {a} and {b}");
        }
    }
}

#[test]
fn every_picture_is_drawn() {
    let place = place();
    for mesh in ["two", "torus"] {
        for show in ["both", "surface", "domain", "polygon", "dirichlet"] {
            place.expect(
                0,
                &format!("uniformize {mesh}.obj --show {show} --picture {show}.png --size 128 --quiet"),
            );
            assert!(std::fs::metadata(place.path(&format!("{show}.png"))).unwrap().len() > 500);
        }
    }
    for model in ["poincare", "klein", "half-plane"] {
        place.expect(
            0,
            &format!("uniformize two.obj --show domain --model {model} --picture {model}.svg --quiet"),
        );
    }
    assert!(place.text("klein.svg") != place.text("poincare.svg"));
    place.expect(0, "uniformize egg.obj --picture egg.png --size 128 --quiet");
}

#[test]
fn surfaces_of_any_size_are_uniformized_and_lengths_beyond_name_the_range() {
    let place = place();
    for surface in ["torus", "two", "egg"] {
        let text = place.text(&format!("{surface}.obj"));
        let scaled = |power: i32| {
            let number = |word: &str| word.parse().map_or(word.into(), |x: f64| format!("{x}e{power}"));
            let line = |line: &str| match line.starts_with("v ") {
                true => line.split_whitespace().map(number).collect::<Vec<_>>().join(" "),
                false => line.to_string(),
            };
            text.lines().map(line).collect::<Vec<_>>().join("\n") + "\n"
        };
        let shape = |name: &str| {
            place.expect(0, &format!("uniformize {name} --report r.json --quiet"));
            let report = place.json("r.json");
            (report["result"]["space"].clone(), report["result"]["modulus"].clone())
        };
        let usual = shape(&format!("{surface}.obj"));
        for power in [140, 90, -90, -140] {
            place.put("scaled.obj", &scaled(power));
            if surface == "torus" && power.abs() > 100 {
                // Its layout has the size of the surface.
                let refused = place.expect(1, "uniformize scaled.obj").err;
                assert!(refused.contains("between 1e-100 and 1e100 (rescale)"), "{refused}");
                place.expect(0, "flow scaled.obj --quiet");
                continue;
            }
            let (space, modulus) = shape("scaled.obj");
            assert_eq!(space, usual.0);
            if surface == "torus" {
                let far = numbers(&modulus)
                    .iter()
                    .zip(numbers(&usual.1))
                    .map(|(a, b)| (a.abs() - b.abs()).abs())
                    .sum::<f64>();
                assert!(far < 1e-9, "{surface}, {power}: {modulus} {}", usual.1);
            }
            let out = place.expect(0, "uniformize scaled.obj").out;
            assert!(!out.contains("00000000000000") && !out.contains("area 0.0"), "{out}");
        }
        for power in [160, 250, -160, -250] {
            place.put("scaled.obj", &scaled(power));
            let refused = place.expect(3, "uniformize scaled.obj").err;
            assert!(refused.contains("between 1e-150 and 1e150") && refused.contains("rescale"), "{refused}");
            assert!(refused.len() < 200, "{refused}");
        }
    }
}

#[test]
fn where_a_check_fails_the_thinnest_face_is_named() {
    let place = place();
    for surface in ["torus", "two", "egg"] {
        // A vertex in face 0, nearly on one of its edges.
        let text = place.text(&format!("{surface}.obj"));
        let points: Vec<[f64; 3]> = parse_obj_plain(&text);
        let line = text.lines().find(|line| line.starts_with("f ")).unwrap();
        let face: Vec<usize> = line.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect();
        let [a, b, c] = [0, 1, 2].map(|k| points[face[k] - 1]);
        let p = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]) + 1e-6 * (c[k] - a[k]));
        let ([i, j, k], n) = ([face[0], face[1], face[2]], points.len() + 1);
        let parts = format!("v {} {} {}\nf {i} {j} {n}\nf {j} {k} {n}\nf {k} {i} {n}", p[0], p[1], p[2]);
        place.put("sliver.obj", &text.replacen(line, &parts, 1));
        let failed = place.expect(1, "uniformize sliver.obj --max-iterations 2").out;
        assert!(failed.contains("slivers  face 0 is the thinnest") && failed.contains("remesh"), "{failed}");
        // Flips see to it.
        let done = place.expect(0, "uniformize sliver.obj").out;
        assert!(!done.contains("slivers"), "{done}");
    }
    let failed = place.expect(1, "flow sliver.obj --max-iterations 1").out;
    assert!(failed.contains("slivers  face 0"), "{failed}");
    let coarse = place.expect(1, "uniformize two.obj --max-iterations 1").out;
    assert!(!coarse.contains("slivers"), "{coarse}");
}

#[test]
fn another_tolerance_than_the_usual_is_told() {
    let place = place();
    for surface in ["two.obj", "torus.obj", "egg.obj", "egg.obj --method gradient"] {
        let usual = place.expect(0, &format!("uniformize {surface} --report r.json"));
        assert!(!usual.out.contains("tolerance"), "{}", usual.out);
        assert_eq!(place.json("r.json")["result"]["tolerance"], 1e-10);
        let rough = place.expect(0, &format!("uniformize {surface} --tolerance 1e-4 --report r.json"));
        assert!(rough.out.contains("tolerance 1.0e-4"), "{}", rough.out);
        let report = place.json("r.json");
        for at in [&report["result"]["tolerance"], &report["options"]["tolerance"]] {
            assert_eq!(at, 1e-4);
        }
        assert_eq!(report["checks"]["max_curvature_error"]["limit"], 1e-4);
    }
    let flow = place.expect(0, "flow torus.obj --tolerance 1e-4");
    assert!(flow.out.contains("tolerance 1.0e-4"), "{}", flow.out);
}

#[test]
fn what_cannot_be_done_is_refused_with_what_to_do() {
    let place = place();
    let before = place.files();
    for (code, line, says) in [
        (3, "uniformize disk.obj", "--boundary straight"),
        (2, "uniformize egg.obj --uv u.obj", "--sphere"),
        (2, "uniformize egg.obj --model klein --picture p.png", "hyperbolic plane"),
        (2, "uniformize egg.obj --scheme inversive", "--method gradient"),
        (2, "uniformize egg.obj --flips never", "--method gradient"),
        (2, "uniformize egg.obj --show domain --picture p.png", "use both"),
        (2, "uniformize egg.obj --picture p.svg", ".png"),
        (2, "uniformize two.obj --sphere s.obj", "use --uv"),
        (2, "uniformize torus.obj --model klein --picture p.png", "plane"),
        (2, "uniformize two.obj --model klein", "--picture"),
        (2, "uniformize two.obj --show both --picture p.svg", "--show domain"),
        (2, "uniformize two.obj --model hyperboloid --picture p.png", "poincare"),
        (2, "uniformize two.obj --base 100000", "they are 0 to 195"),
        (2, "uniformize two.obj --uv u.ply", ".obj or .glb"),
        (2, "uniformize two.obj --uv o.obj --generators o.obj", "two outputs"),
    ] {
        let ended = place.expect(code, line);
        assert!(ended.err.contains(says), "{line}: {}", ended.err);
    }
    assert_eq!(place.files(), before);
    // Not converged: the files are there, the report says so.
    place.expect(1, "uniformize two.obj --max-iterations 1 --flips never --metric m.json --report r.json");
    assert_eq!(place.json("r.json")["result"]["converged"], false);
    assert!(place.exists("m.json"));
}

/// Sides are geodesics, few arcs each, unless the sides along edges are asked for.
#[test]
fn pictures_are_cut_along_geodesics_by_default() {
    let place = place();
    let draw = |options: &str| {
        place.expect(0, &format!("uniformize two.obj --quiet --picture p.svg {options}"));
        place.text("p.svg")
    };
    assert_eq!(draw(""), draw("--show dirichlet"));
    assert!(draw("") != draw("--show domain"));
    let cut = place.expect(0, "uniformize two.obj --picture p.png --size 100 --draft --show surface");
    assert!(cut.out.contains("\ndomain "), "{}", cut.out);
}

#[test]
fn the_dirichlet_domain_is_formed_for_what_shows_it() {
    let place = place();
    for (line, formed) in [
        ("uniformize two.obj --generators c.json", false),
        ("uniformize two.obj --show domain --picture p.svg", false),
        ("cover two.obj --depth 1 --cover c.obj", false),
        ("uniformize two.obj --report r.json", true),
        ("uniformize two.obj --show dirichlet --picture p.svg", true),
        ("uniformize two.obj --show polygon --picture p.svg", true),
        ("cover two.obj --depth 1 --show tiles --picture p.svg", true),
        ("cover two.obj --depth 1 --domain d.json", true),
        ("cover two.obj --radius 1", true),
    ] {
        let ended = place.expect(0, line);
        assert_eq!(ended.out.contains("\ndomain "), formed, "{line}: {}", ended.out);
    }
}

#[test]
fn the_common_subdivision_is_formed_for_what_holds_it() {
    let place = Place::new();
    // Slanted parallelograms: each given edge crosses the Delaunay triangulation thousands of times.
    place.expect(0, "make flat-torus --tau 5000.3 1 -n 4 -m 4 -o slanted.json --quiet");
    for command in ["uniformize", "flow"] {
        let plain = place.expect(0, &format!("{command} slanted.json --metric m.json"));
        assert!(!plain.out.contains("dilatation") && plain.out.contains("all hold"), "{}", plain.out);
        let told = place.run(&format!("{command} slanted.json --metric n.json --report r.json"));
        assert!(told.out.contains("dilatation"), "{}", told.out);
        assert!(place.json("r.json")["result"]["crossings"].as_u64().unwrap() > 10_000);
        assert_eq!(place.text("m.json"), place.text("n.json"));
    }
    // Where it is small it is formed for the summary.
    place.put("torus.obj", &torus(12, 8).obj());
    for command in ["uniformize", "flow"] {
        assert!(place.expect(0, &format!("{command} torus.obj")).out.contains("dilatation"));
    }
}

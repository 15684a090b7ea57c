//! Flows with edge flips, and their way back to the given triangulation.

use crate::files::{curvature_error, parse_obj};
use crate::run::{Place, numbers};
use crate::surfaces::{hill, sheared_hill};

/// Positions of an OBJ file.
fn positions(text: &str) -> Vec<[f64; 3]> {
    let numbers = |l: &str| l.split_whitespace().map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
    text.lines().filter_map(|l| l.strip_prefix("v ")).map(|l| numbers(l).try_into().unwrap()).collect()
}

#[test]
fn a_target_out_of_reach_without_flips_is_laid_out_on_the_given_surface() {
    let place = Place::new();
    place.expect(0, "make genus -g 2 -n 8 -o two.obj");
    let line = "flow two.obj --space e2 --target single:7";
    place.expect(1, &format!("{line} --flips never"));
    place.expect(0, &format!("{line} --uv uv.obj --metric m.json --report r.json --picture p.png"));
    let (report, metric) = (place.json("r.json"), place.json("m.json"));
    assert!(report["result"]["flips"].as_u64().unwrap() > 0);
    assert_eq!(report["result"]["flipped_triangles"], 0);
    assert!(curvature_error(&metric) <= 1e-10);
    // The given vertices come first; every further one lies on a given edge.
    let (given, text) = (place.text("two.obj"), place.text("uv.obj"));
    let (before, uv) = (positions(&given), parse_obj(&text));
    let after = positions(&text);
    assert_eq!(before, after[..before.len()]);
    let crossings = after.len() - before.len();
    assert_eq!(report["result"]["crossings"], crossings);
    assert!(crossings > 0);
    let faces = parse_faces(&given);
    let on_an_edge = |p: &[f64; 3]| {
        faces.iter().any(|f| {
            (0..3).any(|k| {
                let (a, b) = (before[f[k]], before[f[(k + 1) % 3]]);
                (distance(a, *p) + distance(*p, b) - distance(a, b)).abs() < 1e-12
            })
        })
    };
    assert!(after[before.len()..].iter().all(on_an_edge));
    // The pieces cover the surface, and none is turned over.
    let whole: f64 = faces.iter().map(|f| area(f.map(|v| before[v]))).sum();
    let pieces: f64 = uv.faces.iter().map(|f| area(f.map(|v| after[v]))).sum();
    assert!((pieces / whole - 1.0).abs() < 1e-10);
    let longest = |f| uv.sides(f).into_iter().fold(0.0, f64::max);
    assert!((0..uv.faces.len()).all(|f| uv.area(f) > -1e-12 * longest(f) * longest(f) - 1e-15 * longest(f)));
}

#[test]
fn an_open_surface_is_solved_on_its_double_and_laid_out_by_itself() {
    let place = Place::new();
    place.put("hill.obj", &sheared_hill(12).obj());
    for scheme in ["yamabe", "inversive"] {
        place.expect(
            0,
            &format!(
                "flow hill.obj --scheme {scheme} --target boundary --uv uv.obj --metric m.json --report r.json"
            ),
        );
        let (report, metric) = (place.json("r.json"), place.json("m.json"));
        assert!(curvature_error(&metric) <= 1e-10);
        let (mirror, u) = (numbers(&metric["mirror"]), numbers(&metric["u"]));
        let n = positions(&place.text("hill.obj")).len();
        assert!(metric["boundary"].as_array().unwrap().iter().all(|b| b == false));
        assert!(mirror.len() > n && mirror.len() == u.len());
        for (v, image) in mirror.iter().map(|&image| image as usize).enumerate() {
            assert_eq!(mirror[image] as usize, v);
            assert!((u[image] - u[v]).abs() < 1e-8);
        }
        assert_eq!(report["result"]["flipped_triangles"], 0);
        assert_eq!(report["checks"]["mirror_symmetry"]["holds"], true);
        let uv = parse_obj(&place.text("uv.obj"));
        let boundary_loops = report["input"]["boundary_loops"].as_u64().unwrap();
        assert_eq!((boundary_loops, uv.v.len() >= n), (1, true));
    }
}

#[test]
fn an_open_surface_with_no_flips_across_its_boundary_stays_one_copy() {
    let place = Place::new();
    place.put("hill.obj", &hill(12).obj());
    place.expect(0, "flow hill.obj --target boundary --uv uv.obj --metric m.json --report r.json");
    let (report, metric) = (place.json("r.json"), place.json("m.json"));
    assert!(curvature_error(&metric) <= 1e-10);
    let n = positions(&place.text("hill.obj")).len();
    assert!(metric["mirror"].is_null() && numbers(&metric["u"]).len() == n);
    let boundary = metric["boundary"].as_array().unwrap();
    assert_eq!(boundary.iter().filter(|b| **b == true).count(), 48);
    assert!(report["result"]["flips"].as_u64() > Some(0), "inside, where the hill is steep");
}

fn parse_faces(text: &str) -> Vec<[usize; 3]> {
    let corner = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
    let face = |l: &str| l.split_whitespace().map(corner).collect::<Vec<_>>().try_into().unwrap();
    text.lines().filter_map(|l| l.strip_prefix("f ")).map(face).collect()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let side = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
    let (x, y) = (side(b), side(c));
    let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    0.5 * cross.iter().map(|c| c * c).sum::<f64>().sqrt()
}

#[test]
fn homogeneous_coordinates_are_the_plain_ones_times_a_weight() {
    let place = Place::new();
    place.expect(0, "make genus -g 2 -n 6 -o two.obj");
    let line = "flow two.obj --space e2 --target single:0";
    place.expect(0, &format!("{line} --uv plain.obj"));
    place.expect(0, &format!("{line} --uv q.obj --homogeneous"));
    place.expect(2, &format!("{line} --uv q.glb --homogeneous"));
    let read = |name: &str| -> Vec<Vec<f64>> {
        let text = place.text(name);
        let lines = text.lines().filter_map(|l| l.strip_prefix("vt "));
        lines.map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect()).collect()
    };
    let (plain, weighted) = (read("plain.obj"), read("q.obj"));
    let first = |name: &str| place.text(name).lines().next().unwrap().to_string();
    assert!(
        first("q.obj").starts_with("# vt are homogeneous: (q x, q y, q)")
            && first("plain.obj").starts_with("v ")
    );
    assert_eq!(plain.len(), weighted.len());
    let size = plain.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for (p, w) in plain.iter().zip(&weighted) {
        assert!(w[2] > 0.0 && (0..2).all(|k| (w[k] / w[2] - p[k]).abs() < 1e-12 * size));
    }
    assert!(weighted.iter().any(|w| (w[2] / weighted[0][2] - 1.0).abs() > 0.1));
}

#[test]
fn edges_are_kept_on_demand() {
    let place = Place::new();
    place.put("hill.obj", &sheared_hill(8).obj());
    let faces = parse_faces(&place.text("hill.obj"));
    let rows = faces.iter().step_by(3).map(|f| format!("{},{}\n", f[0], f[1]));
    place.put("e.csv", &rows.clone().collect::<String>());
    place.expect(0, "flow hill.obj --target boundary --metric m.json");
    let has_all = |place: &Place| {
        let kept: Vec<[f64; 3]> = crate::run::triples(&place.json("m.json")["faces"]);
        faces.iter().step_by(3).all(|f| {
            let side = |g: &[f64; 3]| [f[0], f[1]].iter().all(|v| g.contains(&(*v as f64)));
            kept.iter().filter(|g| side(g)).count() >= 2
        })
    };
    assert!(!has_all(&place));
    place.run("flow hill.obj --target boundary --keep-edges e.csv --metric m.json --report r.json");
    assert!(has_all(&place));
    assert_eq!(place.json("r.json")["options"]["keep_edges"], "e.csv");
    place.put("bad.csv", "0,0\n");
    let ended = place.expect(3, "flow hill.obj --keep-edges bad.csv");
    assert!(ended.err.contains("bad.csv:1: there is no edge between"), "{}", ended.err);
}

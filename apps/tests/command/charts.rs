//! `ricci flow --target auto:N --charts`: what is written, looked at with formulas of our own.

use crate::files::parse_obj;
use crate::run::{Place, numbers};
use crate::surfaces::{hill, torus};
use std::f64::consts::PI;

#[test]
fn placed_cones_are_a_target_that_the_flow_reaches() {
    let place = Place::new();
    place.put("torus.obj", &torus(40, 24).obj());
    place.expect(0, "flow torus.obj --target auto:6 --flips never --report r.json --metric m.json");
    let report = place.json("r.json");
    assert_eq!(report["options"]["target"], "auto:6");
    assert_eq!(report["options"]["space"], "e2");
    assert_eq!(report["result"]["converged"], true);
    let cones = report["result"]["cones"].as_array().unwrap();
    assert_eq!(cones.len(), 6);
    let target = numbers(&place.json("m.json")["target"]);
    for cone in cones {
        let [v, k] = numbers(cone).try_into().unwrap();
        assert!((target[v as usize] - k).abs() < 1e-12 && k < 2.0 * PI && k != 0.0);
    }
    assert!(target.iter().sum::<f64>().abs() < 1e-12);
    assert_eq!(target.iter().filter(|k| **k != 0.0).count(), 6);
}

#[test]
fn open_surfaces_take_cones_too() {
    let place = Place::new();
    place.put("hill.obj", &hill(16).obj());
    place.expect(0, "flow hill.obj --target auto:3 --report r.json --metric m.json --charts --uv uv.obj");
    let report = place.json("r.json");
    assert_eq!(report["result"]["cones"].as_array().unwrap().len(), 3);
    let metric = place.json("m.json");
    let total: f64 = numbers(&metric["target"]).iter().sum();
    let copies = if metric["mirror"].is_null() { 1.0 } else { 2.0 };
    assert!((total - 2.0 * copies * PI).abs() < 1e-9, "{total}");
}

#[test]
fn charts_fill_the_unit_square_and_do_not_overlap() {
    let place = Place::new();
    place.expect(0, "make genus -g 2 -n 6 -o two.obj");
    place.expect(
        0,
        "flow two.obj --space e2 --target auto:5 --flips never --charts --uv uv.obj --picture p.svg --report r.json",
    );
    let report = place.json("r.json");
    let (count, packing) =
        (report["result"]["charts"].as_u64().unwrap(), report["result"]["packing"].as_f64().unwrap());
    assert!(count >= 1 && packing > 0.05 && packing < 1.0);
    assert_eq!(report["checks"]["overlapping_in_charts"]["value"], 0.0);
    let obj = parse_obj(&place.text("uv.obj"));
    assert!(obj.vt.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    let triangles: Vec<[[f64; 2]; 3]> = obj.corners.iter().map(|c| c.map(|k| obj.vt[k])).collect();
    let area =
        |[a, b, c]: &[[f64; 2]; 3]| 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    let total: f64 = triangles.iter().map(area).sum();
    assert!((total - packing).abs() < 1e-9);
    // No point of a grid lies in two faces.
    for k in 0..400 {
        let p = [(k % 20) as f64 / 20.0 + 0.0257, (k / 20) as f64 / 20.0 + 0.0263];
        let inside = |t: &&[[f64; 2]; 3]| (0..3).all(|i| area(&[t[i], t[(i + 1) % 3], p]) > 1e-12);
        assert!(triangles.iter().filter(inside).count() <= 1);
    }
    assert!(place.text("p.svg").contains("<svg"));
}

#[test]
fn a_single_cone_of_high_genus_gives_charts_that_do_not_overlap_as_written() {
    let place = Place::new();
    place.expect(0, "make genus -g 4 -n 8 -o four.obj");
    for target in ["auto:1", "single:0"] {
        let line = format!("flow four.obj --space e2 --target {target} --charts --uv uv.obj --report r.json");
        place.expect(0, &line);
        let report = place.json("r.json");
        assert_eq!(report["checks"]["overlapping_in_charts"]["value"], 0.0);
        let count = report["result"]["charts"].as_u64().unwrap();
        assert!((2..20).contains(&count), "{count}");
        let obj = parse_obj(&place.text("uv.obj"));
        let on_grid = |x: &f64| (0.0..=1.0).contains(x) && (x * 2f64.powi(53)).fract() == 0.0;
        assert!(obj.vt.iter().flatten().all(on_grid));
    }
}

#[test]
fn charts_that_fail_take_no_output_with_them() {
    let place = Place::new();
    place.expect(0, "make genus -g 4 -n 8 -o four.obj");
    let line = "flow four.obj --space e2 --target single:0 --charts --margin 0.9";
    let ended =
        place.expect(1, &format!("{line} --uv uv.obj --metric m.json --picture p.png --report r.json"));
    assert!(ended.out.contains("FAILED   --charts: ") && ended.out.contains("margin"), "{}", ended.out);
    let report = place.json("r.json");
    assert_eq!(report["result"]["converged"], true);
    assert!(report["result"]["failed"]["charts"].as_str().unwrap().contains("margin"));
    assert!(report["result"]["charts"].is_null());
    // What is written is the layout as a whole, and the metric.
    assert!(parse_obj(&place.text("uv.obj")).vt.iter().flatten().any(|x| !(0.0..=1.0).contains(x)));
    assert!(place.json("m.json")["lengths"].as_array().unwrap().len() > 100 && place.exists("p.png"));
}

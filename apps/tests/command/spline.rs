//! `ricci spline`.

use crate::run::Place;
use ricci::mesh::shapes;
use ricci::spline::{FlatMetric, FlatMetricOptions, Parameter, SurfaceFitOptions, fit_surface};
use ricci::{Control, Surface};
use serde_json::Value;

#[test]
fn a_spline_is_fitted_written_evaluated_and_drawn_as_triangles() {
    let place = Place::new();
    place.expect(0, "make disk --height 0.4 -n 10 -o hill.obj --quiet");
    place.expect(0, "spline fit hill.obj --planar --degree 2 -o s.json --report r.json --quiet");
    let report = place.json("r.json");
    let result = &report["result"];
    assert_eq!((&report["command"], &result["degree"]), (&Value::from("spline"), &2.into()));
    assert!(
        result["rms"].as_f64().unwrap() < 5e-4 && result["max"].as_f64() > result["rms"].as_f64(),
        "{result}"
    );
    let checks = report["checks"].as_object().unwrap();
    assert!(checks.len() == 3 && checks.values().all(|check| check["holds"] == true), "{checks:?}");
    let spline = place.json("s.json");
    assert_eq!(spline["format"], "ricci-spline 1");
    assert_eq!(
        spline["control_points"].as_array().unwrap().len(),
        result["control_points"].as_u64().unwrap() as usize
    );
    // The middle of the first patch: x and y of the surface are the parameters.
    let knots = &spline["patches"][0]["knots"];
    let middle = |x: usize| (0..3).map(|k| knots[k][0][x].as_f64().unwrap()).sum::<f64>() / 3.0;
    let (x, y) = (middle(0), middle(1));
    place.put("q.csv", &format!("patch,x,y\n0,{x},{y}\n"));
    place.expect(0, "spline eval s.json --at q.csv -o v.csv --derivatives --quiet");
    let rows = place.text("v.csv");
    let row: Vec<f64> = rows.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!(row.len(), rows.lines().next().unwrap().split(',').count());
    assert!((row[3] - x).abs() < 1e-3 && (row[4] - y).abs() < 1e-3, "{row:?}");
    let normal = row[21].hypot(row[22]).hypot(row[23]);
    assert!((normal - 1.0).abs() < 1e-12 && row[24] >= row[25], "{row:?}");
    place.expect(0, "spline eval s.json --tessellate 3 -o fine.obj --quiet");
    place.expect(0, "info fine.obj --report i.json --quiet");
    let fine = place.json("i.json");
    assert_eq!((&fine["input"]["components"], &fine["input"]["boundary_loops"]), (&1.into(), &1.into()));
    assert_eq!(fine["input"]["faces"].as_u64(), result["patches"].as_u64().map(|n| 9 * n));
}

#[test]
fn surfaces_are_drawn_with_their_patches_net_curvature_and_reflections() {
    let place = Place::new();
    place.expect(0, "make disk --height 0.4 -n 8 -o hill.obj --quiet");
    place.expect(0, "spline fit hill.obj --planar --edge 0.6 -o s.json --quiet");
    let mut pictures = Vec::new();
    for options in ["", "--wire", "--wire --net", "--color curvature", "--color reflection", "--tessellate 1"]
    {
        let line = format!("spline eval s.json {options} --picture p.png --size 96 --draft --quiet");
        place.expect(0, &line);
        let bytes = std::fs::read(place.path("p.png")).unwrap();
        assert!(bytes.starts_with(b"\x89PNG"));
        assert!(!pictures.contains(&bytes), "{options} draws nothing new");
        pictures.push(bytes);
    }
    // Points and a picture in one run; nothing to write, or not said what.
    place.put("q.csv", "patch,x,y\n");
    place
        .expect(0, "spline eval s.json --tessellate 2 -o fine.obj --picture p.png --size 96 --draft --quiet");
    for line in [
        "spline eval s.json",
        "spline eval s.json -o fine.obj",
        "spline eval s.json --at q.csv --picture p.png",
    ] {
        place.expect(2, line);
    }
    place.expect(2, "spline eval s.json --net -o fine.obj --tessellate 1");
}

#[test]
fn what_no_spline_can_be_made_of_is_refused() {
    let place = Place::new();
    place.expect(0, "make sphere -n 2 -o ball.obj --quiet");
    let closed = place.expect(3, "spline fit ball.obj --planar -o s.json");
    assert!(closed.err.contains("closed surface"), "{}", closed.err);
    let formless = place.expect(2, "spline fit ball.obj --atlas form -o s.json");
    assert!(formless.err.contains("genus 0"), "{}", formless.err);
    // Of 42 vertices ten control points are too few to come near: the spline is written, and the check says so.
    let coarse = place.expect(1, "spline fit ball.obj -o s.json");
    assert!(coarse.out.contains("FAILED") && place.exists("s.json"), "{}", coarse.out);
    place.put("upright.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    let upright = place.expect(3, "spline fit upright.obj --planar -o s.json");
    assert!(upright.err.contains("face 0"), "{}", upright.err);
    place.put("s.json", "{\"format\": \"ricci-spline 1\"");
    let broken = place.expect(3, "spline eval s.json --tessellate 2 -o t.obj");
    assert!(broken.err.contains("s.json:1"), "{}", broken.err);
    place.expect(2, "spline eval s.json -o t.obj");
    assert!(!place.exists("t.obj"));
}

#[test]
fn nearest_points_are_rows() {
    let place = Place::new();
    place.expect(0, "make disk -n 8 --height 0.3 -o hill.obj --quiet");
    place.expect(0, "spline fit hill.obj --planar --edge 0.6 -o s.json --quiet");
    place.put("p.csv", "x,y,z\n0.1,0.2,5\n-3,0,0\n");
    place.expect(0, "spline eval s.json --closest p.csv -o n.csv --quiet");
    let text = place.text("n.csv");
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!((rows[0], rows.len()), ("x,y,z,patch,u,v,X,Y,Z,distance", 3));
    for row in &rows[1..] {
        let numbers: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
        let far = (0..3).map(|k| (numbers[k] - numbers[6 + k]).powi(2)).sum::<f64>().sqrt();
        assert!((far - numbers[9]).abs() < 1e-14, "{row}");
        // Over the plane, places are x and y.
        assert!((numbers[4] - numbers[6]).hypot(numbers[5] - numbers[7]) < 1e-6, "{row}");
    }
    place.put("p.csv", "x,y,z\n0.1,nan,5\n");
    let refused = place.expect(2, "spline eval s.json --closest p.csv -o n.csv");
    assert!(refused.err.contains("point is 0"), "{}", refused.err);
    place.expect(2, "spline eval s.json --closest p.csv --at p.csv -o n.csv");
    place.expect(2, "spline eval s.json --closest p.csv");
}

#[test]
fn rows_say_where_a_hole_is_filled() {
    let place = Place::new();
    let control = Control::new();
    let surface = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &control).unwrap();
    let options = SurfaceFitOptions { rounds: 1, ..SurfaceFitOptions::default() };
    let spline = fit_surface(&surface, &flat, &options, &control).unwrap().spline;
    spline.write(&place.path("s.json")).unwrap();
    let (hole, space) = (&spline.holes()[0], spline.space());
    let inside = hole.place(space, 0.3 * hole.radius, 0.5).unwrap();
    let outside = (0..space.patches().len() as u32)
        .map(|patch| {
            let corners = space.patches()[patch as usize].corners();
            let [x, y] = [0, 1].map(|x| (corners[0][x] + corners[1][x] + corners[2][x]) / 3.0);
            Parameter { patch, x, y }
        })
        .find(|&at| !spline.is_in_hole(at))
        .unwrap();
    let row = |at: Parameter| format!("{},{},{}\n", at.patch, at.x, at.y);
    place.put("q.csv", &format!("patch,x,y\n{}{}", row(inside), row(outside)));
    let points = |options: &str| -> Vec<Vec<f64>> {
        place.expect(0, &format!("spline eval s.json --at q.csv {options} -o v.csv --quiet"));
        let text = place.text("v.csv");
        assert!(text.starts_with("patch,x,y,X,Y,Z,hole\n"), "{text}");
        text.lines().skip(1).map(|row| row.split(',').map(|x| x.parse().unwrap()).collect()).collect()
    };
    let (sums, filled) = (points(""), points("--filled"));
    assert_eq!((sums[0][6], sums[1][6]), (1.0, 0.0));
    assert_eq!(filled[0][3..6], spline.point(inside).unwrap());
    assert!(sums[1] == filled[1] && sums[0] != filled[0]);
}

#[test]
fn patches_for_cad_are_written_with_their_checks() {
    let place = Place::new();
    let vertex = |i: u32| (f64::from(i % 4) / 3.0, f64::from(i / 4) / 3.0);
    let mut mesh: String = (0..16).map(vertex).map(|(x, y)| format!("v {x} {y} {}\n", 0.1 * x * y)).collect();
    for i in [1, 2, 3, 5, 6, 7, 9, 10, 11] {
        mesh += &format!("f {i} {} {}\nf {i} {} {}\n", i + 1, i + 5, i + 5, i + 4);
    }
    place.put("square.obj", &mesh);
    place.expect(0, "spline fit square.obj --planar --edge 1 -o s.json --quiet");
    place.expect(0, "spline export s.json -o s.step --report r.json");
    let report = place.json("r.json");
    assert_eq!(report["result"]["closed"], false);
    for check in ["distance", "normal_jump", "open_sides"] {
        assert_eq!(report["checks"][check]["holds"], true, "{check}");
    }
    let first = place.text("s.step");
    assert!(
        first.starts_with("ISO-10303-21;")
            && first.contains("OPEN_SHELL")
            && first.contains(".MILLI.,.METRE.")
    );
    place.expect(0, "spline export s.json -o s.step --quiet");
    assert_eq!(first, place.text("s.step"));
    place.expect(0, "spline export s.json -o metres.stp --unit m --quiet");
    assert!(!place.text("metres.stp").contains(".MILLI."));
    place.expect(0, "spline export s.json -o s_patches.json --quiet");
    assert!(place.text("s_patches.json").starts_with("{\"format\":\"ricci-patches 1\""));
    // Not reached, not known, not a spline.
    let far = place.expect(3, "spline export s.json -o far.step --tolerance 1e-10");
    assert!(far.err.contains("spans per side") && !place.exists("far.step"), "{}", far.err);
    place.expect(2, "spline export s.json -o s.iges");
    place.expect(3, "spline export square.obj -o t.step");
}

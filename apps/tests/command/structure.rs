//! `ricci structure`: the file read with formulas of our own, the report, refusals.

use crate::run::{Place, numbers};
use serde_json::Value;

type Complex = [f64; 2];

fn mul(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// A matrix of the file as complex numbers.
fn matrix(value: &Value) -> Vec<Vec<Complex>> {
    let entry = |z: &Value| z.as_f64().map_or_else(|| [numbers(z)[0], numbers(z)[1]], |x| [x, 0.0]);
    value.as_array().unwrap().iter().map(|row| row.as_array().unwrap().iter().map(entry).collect()).collect()
}

/// Where a transition carries a point: a 3×3 matrix acts on (x, y, 1), a 2×2 matrix on (x + iy, 1).
fn image(m: &[Vec<Complex>], [x, y]: [f64; 2]) -> [f64; 2] {
    let point: Vec<Complex> = match m.len() {
        3 => vec![[x, 0.0], [y, 0.0], [1.0, 0.0]],
        _ => vec![[x, y], [1.0, 0.0]],
    };
    let image: Vec<Complex> = m
        .iter()
        .map(|row| {
            row.iter().zip(&point).map(|(a, p)| mul(*a, *p)).fold([0.0; 2], |s, z| [s[0] + z[0], s[1] + z[1]])
        })
        .collect();
    let (last, first) = (image[m.len() - 1], image[0]);
    let n = last[0] * last[0] + last[1] * last[1];
    let over = |z: Complex| mul(z, [last[0] / n, -last[1] / n]);
    if m.len() == 3 { [over(first)[0], over(image[1])[0]] } else { over(first) }
}

/// The largest distance of the image of a shared vertex from its place; shared vertices are the same vertices.
fn miss(file: &Value) -> f64 {
    let charts = file["charts"].as_array().unwrap();
    let at = |chart: &Value, i: &Value| {
        let (chart, i) = (&charts[chart.as_u64().unwrap() as usize], i.as_u64().unwrap() as usize);
        let [x, y] = [0, 1].map(|k| numbers(&chart["coordinates"][i])[k]);
        ([x, y], chart["vertices"][i].as_u64().unwrap())
    };
    let mut most: f64 = 0.0;
    for t in file["transitions"].as_array().unwrap() {
        let m = matrix(&t["matrix"]);
        for pair in t["pairs"].as_array().unwrap() {
            let ((p, v), (q, w)) = (at(&t["from"], &pair[0]), at(&t["to"], &pair[1]));
            assert_eq!(v, w);
            let r = image(&m, p);
            most = most.max((r[0] - q[0]).hypot(r[1] - q[1]));
        }
    }
    most
}

/// Corners of the faces of every chart name vertices of that face, where the atlas keeps the triangles of the mesh.
fn corners_are_those_of(file: &Value, triangles: &[[u64; 3]]) -> bool {
    file["charts"].as_array().unwrap().iter().all(|chart| {
        let rows = chart["faces"].as_array().unwrap().iter().zip(chart["corners"].as_array().unwrap());
        rows.into_iter().all(|(face, corners)| {
            let vertex =
                |k: usize| chart["vertices"][corners[k].as_u64().unwrap() as usize].as_u64().unwrap();
            triangles[face.as_u64().unwrap() as usize] == [0, 1, 2].map(vertex)
        })
    })
}

#[test]
fn without_flips_the_faces_of_an_atlas_are_those_of_the_mesh() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    let text = std::fs::read_to_string(place.path("two.obj")).unwrap();
    let corner = |word: &str| word.split('/').next().unwrap().parse::<u64>().unwrap() - 1;
    let triangles: Vec<[u64; 3]> = text
        .lines()
        .filter_map(|line| line.strip_prefix("f "))
        .map(|line| line.split_whitespace().map(corner).collect::<Vec<_>>().try_into().unwrap())
        .collect();
    place.expect(0, "structure two.obj --kind hyperbolic --flips never --atlas A.json");
    assert!(corners_are_those_of(&place.json("A.json"), &triangles));
    place.expect(0, "structure two.obj --kind hyperbolic --atlas A.json");
    assert!(!corners_are_those_of(&place.json("A.json"), &triangles), "the flow flips edges");
}

#[test]
fn files_hold_atlases_of_every_kind_and_reports_their_figures() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "make sphere -o ball.obj");
    let cases = [
        ("two.obj --kind affine --singular 3", 3, 1),
        ("two.obj --kind affine --charts patches --picture p.png", 3, 1),
        ("two.obj --kind affine --from form", 3, 2),
        ("two.obj --kind hyperbolic --charts patches --radius 0.7", 2, 0),
        ("two.obj --kind projective", 3, 0),
        ("two.obj --kind conformal", 2, 0),
        ("ball.obj --kind spherical", 2, 0),
        ("ball.obj --kind integer --charts patches --picture p.png", 3, 8),
        ("two.obj --kind integer --faces 500", 3, 16),
    ];
    for (asked, size, singular) in cases {
        place.expect(0, &format!("structure {asked} --atlas A.json --report r.json"));
        let (file, report) = (place.json("A.json"), place.json("r.json"));
        assert!(miss(&file) < 1e-11, "{asked}: {:e}", miss(&file));
        let (charts, transitions) = (&file["charts"], file["transitions"].as_array().unwrap());
        assert_eq!(matrix(&transitions[0]["matrix"]).len(), size, "{asked}");
        let result = &report["result"];
        assert_eq!(result["charts"].as_u64(), Some(charts.as_array().unwrap().len() as u64));
        assert_eq!(result["transitions"].as_u64(), Some(transitions.len() as u64));
        assert!(result["cocycle_residual"].as_f64().unwrap() < 1e-9);
        assert_eq!(result["singular_vertices"], file["singular_vertices"]);
        assert_eq!(file["singular_vertices"].as_array().unwrap().len(), singular, "{asked}");
        for check in ["cocycle_residual", "relation_residual", "folded_charts", "max_curvature_error"] {
            assert_eq!(report["checks"][check]["holds"], true, "{asked}: {check}");
        }
    }
    let picture = std::fs::read(place.path("p.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
}

#[test]
fn structures_that_a_surface_has_not_are_refused() {
    let place = Place::new();
    place.expect(0, "make torus -o torus.obj");
    place.expect(0, "make bolza -o bolza.json");
    for (asked, why) in [
        ("torus.obj --kind spherical", "genus 0"),
        ("torus.obj --kind projective", "negative Euler characteristic"),
        ("torus.obj --kind affine --singular 7", "genus other than 1"),
        ("torus.obj --kind affine --faces 100", "left out for structures other than integer"),
        ("torus.obj --kind integer --faces 0", "positive"),
        ("bolza.json --kind affine --singular 100000", "no such vertex"),
        ("bolza.json --kind hyperbolic --from form", "affine"),
        ("bolza.json --kind affine --from form --flips never", "leave it out"),
        ("bolza.json --kind hyperbolic --radius 0", "positive"),
        ("bolza.json --kind hyperbolic --picture p.png", "no positions"),
        ("bolza.json", "--kind"),
    ] {
        let ended = place.expect(2, &format!("structure {asked} --atlas A.json"));
        assert!(ended.err.contains(why), "{asked}: {}", ended.err);
        assert!(!place.path("A.json").exists());
    }
    place.expect(0, "structure bolza.json --kind hyperbolic --atlas A.json");
}

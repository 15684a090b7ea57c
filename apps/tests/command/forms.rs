//! `ricci forms`: the file read with formulas of our own, the report, pictures, refusals.

use crate::run::{Place, numbers, triples};
use serde_json::Value;

/// Largest |dω| and |d*ω| over the largest |ω|, of every form in the file.
fn residuals(file: &Value) -> [f64; 2] {
    let lengths = triples(&file["lengths"]);
    let sides: Vec<[i64; 3]> = triples(&file["face_edges"]).iter().map(|t| t.map(|x| x as i64)).collect();
    let edges: Vec<[usize; 2]> = file["edges"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| {
            let ends = numbers(e);
            [ends[0] as usize, ends[1] as usize]
        })
        .collect();
    let mut weight = vec![0.0; edges.len()];
    for (l, e) in lengths.iter().zip(&sides) {
        for k in 0..3 {
            let [a, b, c] = [l[(k + 1) % 3], l[(k + 2) % 3], l[k]];
            let cos = (a * a + b * b - c * c) / (2.0 * a * b);
            weight[e[k].unsigned_abs() as usize - 1] += 0.5 * cos / (1.0 - cos * cos).sqrt();
        }
    }
    let n = edges.iter().flatten().max().unwrap() + 1;
    let mut worst = [0.0f64; 2];
    for form in file["harmonic"].as_array().unwrap() {
        let form = numbers(form);
        let size = form.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let around = |e: &[i64; 3]| -> f64 {
            e.iter().map(|&e| form[e.unsigned_abs() as usize - 1] * e.signum() as f64).sum()
        };
        let mut flux = vec![0.0; n];
        for (e, [i, j]) in edges.iter().enumerate() {
            flux[*i] += weight[e] * form[e];
            flux[*j] -= weight[e] * form[e];
        }
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |m, x| m.max(x.abs())) / size;
        worst[0] = worst[0].max(largest(&mut sides.iter().map(around)));
        worst[1] = worst[1].max(largest(&mut flux.into_iter()));
    }
    worst
}

#[test]
fn the_file_holds_closed_and_coclosed_forms_and_the_report_their_periods() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "forms two.obj --forms F.json --uv uv.obj --report r.json");
    let [closed, coclosed] = residuals(&place.json("F.json"));
    assert!(closed < 1e-12 && coclosed < 1e-9, "{closed:e} {coclosed:e}");
    let result = &place.json("r.json")["result"];
    assert_eq!((result["forms"].as_u64(), result["zeros"].as_array().unwrap().len()), (Some(4), 2));
    let matrix = result["period_matrix"].as_array().unwrap();
    assert_eq!(matrix.len(), 2);
    let im = |i: usize, j: usize| numbers(&matrix[i][j])[1];
    assert!(im(0, 0) > 0.0 && im(0, 0) * im(1, 1) > im(0, 1) * im(1, 0));
    assert!(result["riemann_min_eigenvalue"].as_f64().unwrap() > 0.0);
    for zeros in result["zeros"].as_array().unwrap() {
        let total: i64 = zeros.as_array().unwrap().iter().map(|z| z["multiplicity"].as_i64().unwrap()).sum();
        assert_eq!(total, 2);
    }
    assert!(place.text("uv.obj").lines().any(|l| l.starts_with("vt ")));
}

#[test]
fn a_torus_has_a_modulus_and_the_combination_that_is_asked_for() {
    let place = Place::new();
    place.expect(0, "make torus -o t.obj");
    place.expect(0, "forms t.obj --combination 1,-0.5 --report r.json --picture p.png --draft --size 64 --show trajectories");
    let report = place.json("r.json");
    assert_eq!(numbers(&report["result"]["combination"]), [1.0, -0.5]);
    assert_eq!(report["result"]["combination_zeros"].as_array().unwrap().len(), 0);
    assert!(numbers(&report["result"]["modulus"])[1] >= 0.75f64.sqrt());
    assert!(place.exists("p.png"));
    let refused = place.expect(2, "forms t.obj --combination 1,2,3");
    assert!(refused.err.contains("3 coefficients for 2 forms"), "{}", refused.err);
    assert!(place.expect(2, "forms t.obj --combination 0,-0").err.contains("not 0"));
    for size in ["nan", "1e200", "1e-200"] {
        assert!(place.expect(2, &format!("forms t.obj --combination {size},1")).err.contains("1e-100"));
    }
}

#[test]
fn surfaces_without_forms_and_open_ones_say_so() {
    let place = Place::new();
    place.expect(0, "make sphere -o s.obj");
    let ended = place.expect(1, "forms s.obj --uv uv.obj");
    assert!(ended.out.contains("no harmonic form") && !place.exists("uv.obj"), "{}", ended.out);
    place.expect(0, "make annulus -o a.obj");
    for classes in ["absolute", "relative"] {
        place.expect(
            0,
            &format!(
                "forms a.obj --classes {classes} --forms F.json --uv uv.obj --picture p.svg --report r.json"
            ),
        );
        assert!(place.json("r.json")["result"]["period_matrix"].is_null());
        assert_eq!(place.json("F.json")["holomorphic"].as_array().unwrap().len(), 1);
    }
    place.expect(0, "make bolza -o b.json");
    place.expect(0, "forms b.json --forms F.json");
    assert!(place.expect(2, "forms b.json --uv uv.obj").err.contains("no positions"));
    assert!(place.expect(2, "forms b.json --base 999999").err.contains("no such vertex"));
}

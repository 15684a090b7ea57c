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

/// The energies of the forms in a file of `--bounds`, from its lengths and values, at the midpoints of the sides of every face.
fn energies(file: &Value) -> Vec<Vec<f64>> {
    let (high, low) = (triples(&file["lengths"]), triples(&file["lengths_lo"]));
    let sides: Vec<[i64; 3]> = triples(&file["face_edges"]).iter().map(|t| t.map(|x| x as i64)).collect();
    let lists = |name: &str| file[name].as_array().unwrap().iter().map(numbers).collect::<Vec<_>>();
    let (values, curves) = (lists("harmonic"), lists("curve"));
    let n = values.len();
    let mut total = vec![vec![0.0; n]; n];
    for (f, e) in sides.iter().enumerate() {
        let l = [0, 1, 2].map(|k| high[f][k] + low[f][k]);
        let cot = [0, 1, 2].map(|k| {
            let [a, b, c] = [l[(k + 1) % 3], l[(k + 2) % 3], l[k]];
            let cos = (a * a + b * b - c * c) / (2.0 * a * b);
            cos / (1.0 - cos * cos).sqrt()
        });
        let of = |list: &[f64], k: usize| list[e[k].unsigned_abs() as usize - 1];
        for m in 0..3 {
            let at: Vec<[f64; 3]> = (0..n)
                .map(|form| {
                    let mut at = [0, 1, 2].map(|k| of(&values[form], k) * e[k].signum() as f64);
                    let b = [0, 1, 2].map(|k| of(&curves[form], k));
                    let turn = 2.0 * (b[(m + 1) % 3] + b[(m + 2) % 3] - b[m]);
                    at[(m + 1) % 3] += turn;
                    at[(m + 2) % 3] -= turn;
                    at
                })
                .collect();
            for i in 0..n {
                for j in 0..n {
                    total[i][j] += (0..3).map(|k| cot[k] * at[i][k] * at[j][k]).sum::<f64>() / 6.0;
                }
            }
        }
    }
    total
}

#[test]
fn the_file_of_bounds_proves_what_the_report_tells() {
    let place = Place::new();
    place.expect(0, "make genus -o two.obj");
    let told = place.expect(0, "forms two.obj --width 1e-4 --bounds B.json --report r.json");
    assert!(told.out.contains("Π is known to"), "{}", told.out);
    let report = place.json("r.json");
    let (gap, bounds) = (report["result"]["gap"].as_f64().unwrap(), &report["result"]["bounds"]);
    assert!(gap <= 1e-4 && bounds["first_gap"].as_f64().unwrap() > gap);
    assert_eq!((&bounds["reached"], &report["checks"]["width"]["holds"]), (&true.into(), &true.into()));
    // Trace of Ĝ⁻¹ M: between 2g and 2g d, with Ĝ⁻¹ = S Ĝ Sᵀ.
    let file = place.json("B.json");
    let pi: Vec<Vec<Vec<f64>>> = file["period_matrix"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row.as_array().unwrap().iter().map(numbers).collect())
        .collect();
    let [x, y] = [0, 1].map(|k| [0, 1].map(|i| [0, 1].map(|j| pi[i][j][k])));
    let det = y[0][0] * y[1][1] - y[0][1] * y[1][0];
    let inverse = [[y[1][1] / det, -y[0][1] / det], [-y[1][0] / det, y[0][0] / det]];
    let times = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
        [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
    };
    let slope = times(x, inverse);
    let square = times(slope, x);
    // Ĝ⁻¹ in the order a1, b1, a2, b2.
    let entry = |i: usize, j: usize| match (i % 2, j % 2) {
        (0, 0) => inverse[i / 2][j / 2],
        (0, _) => slope[j / 2][i / 2],
        (_, 0) => slope[i / 2][j / 2],
        _ => y[i / 2][j / 2] + square[i / 2][j / 2],
    };
    let upper = energies(&file);
    let trace: f64 =
        (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| entry(i, j) * upper[j][i]).sum();
    assert!(trace >= 4.0 - 1e-9 && trace <= 4.0 * (1.0 + gap) + 1e-9, "{trace} {gap}");
    let [wide, radius] = ["period_matrix", "radius"].map(|name| &bounds[name]);
    assert_eq!(wide, &file["period_matrix"]);
    let expected = gap * (y[0][0] * y[1][1]).sqrt();
    assert!((radius[0][1].as_f64().unwrap() / expected - 1.0).abs() < 1e-12);
}

#[test]
fn widths_that_are_not_reached_are_told() {
    let place = Place::new();
    place.expect(0, "make flat-torus --tau 0.25 1.5 -n 4 -m 4 -o t.json");
    let told = place.expect(0, "forms t.json --report r.json");
    assert!(told.out.contains("modulus 0.250000 + 1.500000 i, off by at most"), "{}", told.out);
    let bounds = &place.json("r.json")["result"]["bounds"];
    assert!(bounds["modulus_radius"].as_f64().unwrap() < 1e-11 && bounds["vertices_added"] == 0);
    // Rounding keeps the proven gap above 0.
    let ended = place.expect(1, "forms t.json --width 0");
    assert!(
        ended.out.contains("not as narrow as asked for") && ended.out.contains("a larger --width"),
        "{}",
        ended.out
    );
    assert!(place.expect(2, "forms t.json --width=-1").err.contains("at least 0"));
    place.expect(0, "make annulus -o a.obj");
    assert!(place.expect(1, "forms a.obj --bounds B.json").out.contains("no period matrix"));
}

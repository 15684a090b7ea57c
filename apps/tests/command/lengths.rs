//! `ricci lengths`: the Bolza surface, lines on a surface in space, refusals.

use crate::run::{Place, numbers};

#[test]
fn the_bolza_surface_has_its_lengths() {
    let place = Place::new();
    place.expect(0, "make bolza -o b.json");
    let told =
        place.expect(0, "lengths b.json --below 6.2 --word a1 --word a1.a1 --spectrum L.csv --report r.json");
    assert!(told.out.contains("3.057141838962 × 12"), "{}", told.out);
    let report = place.json("r.json");
    let lengths: Vec<[f64; 2]> = report["result"]["lengths"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| numbers(row).try_into().unwrap())
        .collect();
    let ring = [(1.0, 1.0), (3.0, 2.0), (5.0, 3.0), (5.0, 4.0)];
    assert_eq!(lengths.len(), ring.len());
    for (found, (m, n)) in lengths.iter().zip(ring) {
        let exact = 2.0 * f64::acosh(m + n * 2f64.sqrt());
        assert!((found[0] - exact).abs() < 1e-10, "{found:?} {exact}");
    }
    assert!(report["result"].get("fenchel_nielsen").is_none());
    place.expect(0, "lengths b.json --below 4 --pants --report p.json");
    let pants = place.json("p.json")["result"]["fenchel_nielsen"].as_array().unwrap().clone();
    let names: Vec<&str> = pants.iter().map(|c| c["curve"].as_str().unwrap()).collect();
    assert_eq!(names, ["a1", "a2", "c1"]);
    assert!(pants.iter().all(|c| c["length"].as_f64().unwrap() > 3.05 && c["twist"].is_f64()));
    let words = &report["result"]["words"];
    assert!((words["a1.a1"].as_f64().unwrap() - 2.0 * words["a1"].as_f64().unwrap()).abs() < 1e-10);
    let table = place.text("L.csv");
    assert!(table.starts_with("length,power,word\n"));
    assert_eq!(table.lines().count() - 1, lengths.iter().map(|row| row[1] as usize).sum::<usize>());
    assert_eq!(table.lines().filter(|line| line.split(',').nth(1) == Some("2")).count(), 12);
}

#[test]
fn the_shortest_geodesics_are_closed_lines_on_the_surface() {
    let place = Place::new();
    place.expect(0, "make genus -n 6 -o two.obj");
    place.expect(0, "lengths two.obj --below 4 --systole S.obj --curves C.obj --picture p.png --draft --size 64 --report r.json");
    let result = &place.json("r.json")["result"];
    let systole = result["systole"].as_f64().unwrap();
    assert!(systole > 0.5 && systole < 4.0, "{systole}");
    let text = place.text("S.obj");
    let points: Vec<[f64; 3]> = text
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| {
            let row: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
            row.try_into().unwrap()
        })
        .collect();
    let lines: Vec<Vec<usize>> = text
        .lines()
        .filter_map(|line| line.strip_prefix("l "))
        .map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(lines.len() as u64, result["lengths"][0][1].as_u64().unwrap());
    for line in &lines {
        assert_eq!(line.first(), line.last());
        // Points follow one another closely, within an edge of the mesh.
        for pair in line.windows(2) {
            let [a, b] = [points[pair[0] - 1], points[pair[1] - 1]];
            let step = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
            assert!(step < 1.0, "{step}");
        }
    }
    let all = place.text("C.obj").lines().filter(|line| line.starts_with("l ")).count();
    assert!(all >= lines.len(), "{all}");
}

#[test]
fn what_has_no_lengths_or_lines_is_refused() {
    let place = Place::new();
    place.expect(0, "make sphere -o s.obj");
    assert!(place.expect(1, "lengths s.obj").err.contains("sphere"));
    place.expect(0, "make bolza -o b.json");
    assert!(place.expect(2, "lengths b.json --systole S.obj").err.contains("no positions"));
    assert!(place.expect(2, "lengths b.json --word q1").err.contains("a1"));
    assert!(place.expect(2, "lengths b.json --below 0").err.contains("positive"));
    assert!(place.expect(2, "lengths b.json --spectrum L.txt").err.contains("csv"));
    place.expect(0, "make torus -o t.obj");
    place.expect(0, "lengths t.obj --below 10");
    assert!(place.expect(2, "lengths t.obj --systole S.obj").err.contains("flat"));
}

#[test]
fn lengths_and_twists_lead_to_a_surface_and_back() {
    let place = Place::new();
    place.expect(0, "make fenchel-nielsen --lengths 2,3,2.5 --twists=0.4,-1,0.7 -o fn.json --loops L.csv");
    assert!(place.text("L.csv").starts_with("loop,edge\n0,"));
    place.expect(0, "lengths fn.json --below 2 --loops L.csv --report r.json");
    let found = place.json("r.json")["result"]["fenchel_nielsen"].as_array().unwrap().clone();
    let given = [("a1", 2.0, 0.4), ("a2", 3.0, -1.0), ("c1", 2.5, 0.7)];
    assert_eq!(found.len(), 3);
    for (curve, (name, length, twist)) in found.iter().zip(given) {
        assert_eq!(curve["curve"], name);
        let off = |key: &str, x: f64| (curve[key].as_f64().unwrap() - x).abs();
        assert!(off("length", length) < 1e-10 && off("twist", twist) < 1e-10, "{curve}");
    }
    let refused = place.expect(2, "make fenchel-nielsen --lengths 2,3,2.5 --twists=100,0,0 -o x.json");
    assert!(refused.err.contains("twist"), "{}", refused.err);
}

#[test]
fn curves_named_by_words_are_checked() {
    let place = Place::new();
    place.expect(0, "make genus -n 3 -o two.obj");
    place.expect(0, "lengths two.obj --below 1 --pants --report p.json");
    place.expect(
        0,
        "lengths two.obj --below 1 --curve a1 --curve a2 --curve a1.b1.a1^-1.b1^-1 --report w.json",
    );
    let lengths = |name: &str| -> Vec<f64> {
        let result = &place.json(name)["result"];
        result["fenchel_nielsen"].as_array().unwrap().iter().map(|c| c["length"].as_f64().unwrap()).collect()
    };
    for (x, y) in lengths("p.json").iter().zip(lengths("w.json")) {
        assert!((x - y).abs() < 1e-10, "{x} {y}");
    }
    let crossing = place.expect(1, "lengths two.obj --below 1 --curve a1 --curve b1 --curve a2");
    assert!(crossing.err.contains("a1 and b1 cross"), "{}", crossing.err);
}

#[test]
fn moduli_and_distances_lie_between_their_bounds() {
    let place = Place::new();
    place.expect(0, "make annulus --inner 0.5 -n 12 -o ring.obj");
    let told = place.expect(0, "uniformize ring.obj --width 1e-5 --bounds B.json --report r.json");
    assert!(told.out.contains("modulus  between 0."), "{}", told.out);
    let result = place.json("r.json")["result"].clone();
    let bounds = numbers(&result["modulus_bounds"]);
    assert!(bounds[0] < bounds[1] && bounds[1] < bounds[0] * 1.00003, "{bounds:?}");
    assert!((result["modulus"].as_f64().unwrap() / bounds[0] - 1.0).abs() < 0.01, "{result}");
    assert_eq!(place.json("B.json")["gap"], result["modulus_gap"]);
    place.expect(0, "circles ring.obj --report c.json");
    let circles = numbers(&place.json("c.json")["result"]["modulus_bounds"]);
    assert!(circles[0] <= bounds[1] && bounds[0] <= circles[1], "{circles:?} {bounds:?}");
    place.expect(0, "make annulus --inner 0.3 -n 14 -o other.obj");
    let told = place.expect(0, "match ring.obj other.obj --distance --report m.json");
    assert!(told.out.contains("in Teichmüller's metric"), "{}", told.out);
    let bracket = place.json("m.json")["result"]["teichmueller"].clone();
    let dilatation = numbers(&bracket["dilatation"]);
    assert_eq!(bracket["lower_by"], "moduli");
    let truth = 0.3f64.ln() / 0.5f64.ln();
    assert!((dilatation[0] / truth - 1.0).abs() < 0.02 && dilatation[1] >= dilatation[0], "{bracket}");
}

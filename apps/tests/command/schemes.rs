//! Schemes and step rules of `ricci flow`: how far a packing starts from the surface, and the energy along the gradient flow.

use crate::run::Place;
use crate::surfaces::torus;

#[test]
fn the_energy_falls_along_the_trace_by_every_rule_but_barzilai_borwein() {
    let place = Place::new();
    place.put("torus.obj", &torus(16, 10).obj());
    for (rule, falls) in
        [("", true), ("--steps armijo", true), ("--steps stable", true), ("--steps barzilai-borwein", false)]
    {
        let tolerance = if rule.contains("stable") { "1e-4" } else { "1e-10" };
        let line = format!(
            "flow torus.obj --method gradient {rule} --tolerance {tolerance} --trace t.csv --report r.json"
        );
        place.expect(0, &line);
        let text = place.text("t.csv");
        let energy: Vec<f64> =
            text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert!(energy.len() > 3 && energy[energy.len() - 1] < 0.0);
        assert!(!falls || energy.windows(2).all(|w| w[1] <= w[0]), "{rule}");
        let named = rule.strip_prefix("--steps ").unwrap_or("armijo");
        assert_eq!(place.json("r.json")["options"]["steps"], named);
    }
    place.expect(2, "flow torus.obj --steps armijo");
    place.expect(2, "flow torus.obj --method gradient --steps fixed:0");
}

#[test]
fn a_circle_packing_tells_how_far_it_starts_from_the_surface() {
    let place = Place::new();
    place.put("torus.obj", &torus(24, 12).obj());
    for scheme in ["thurston", "tangential"] {
        let said = place.expect(0, &format!("flow torus.obj --scheme {scheme} --report r.json")).out;
        let distance = &place.json("r.json")["result"]["scheme_distance"];
        let [mean, max] = ["mean_dilatation", "max_dilatation"].map(|name| distance[name].as_f64().unwrap());
        assert!(1.02 < mean && mean <= max && distance["far"] == true, "{distance}");
        assert!(distance["mean_log_length"].as_f64() <= distance["max_log_length"].as_f64());
        assert!(distance["face"].is_u64() && distance["edge"].is_u64());
        assert!(
            said.contains("start    |log|") && said.contains("WARNING") && said.contains("--scheme yamabe"),
            "{said}"
        );
    }
    let said = place.expect(0, "flow torus.obj --report r.json").out;
    assert!(place.json("r.json")["result"]["scheme_distance"].is_null() && !said.contains("start    "));
}

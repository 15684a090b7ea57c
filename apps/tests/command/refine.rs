//! `ricci refine`: finer triangles with the way back, metrics with a least angle, and what is refused.

use crate::run::{Place, numbers};

#[test]
fn surfaces_are_refined_where_they_are_and_the_way_back_says_so() {
    let place = Place::new();
    place.expect(0, "make torus -o t.obj");
    place.expect(0, "refine t.obj --levels 1 -o fine.ply --xref back.csv --report r.json");
    let report = place.json("r.json");
    let (input, result) = (&report["input"], &report["result"]);
    assert_eq!(result["faces"].as_u64().unwrap(), 4 * input["faces"].as_u64().unwrap());
    assert!(report["checks"]["area_change"]["value"].as_f64().unwrap() < 1e-12);
    let rows = place.text("back.csv");
    let places = rows.lines().skip_while(|line| !line.starts_with("output_vertex")).skip(1);
    assert_eq!(places.count() as u64, result["vertices"].as_u64().unwrap());
    let longest = result["longest_edge"].as_f64().unwrap();
    place.expect(0, &format!("refine t.obj --edge {} -o short.obj --report r.json", 0.5 * longest));
    assert!(place.json("r.json")["result"]["longest_edge"].as_f64().unwrap() <= 0.5 * longest);
    // The same bytes again, and for any number of threads.
    place.expect(0, &format!("refine t.obj --edge {} -o again.obj --threads 1", 0.5 * longest));
    assert_eq!(place.text("short.obj"), place.text("again.obj"));
}

#[test]
fn metrics_are_refined_to_an_angle_and_flow() {
    let place = Place::new();
    place.expect(0, "make torus --big 3 --small 0.2 -n 8 -m 30 -o t.obj");
    place.expect(0, "refine t.obj --intrinsic -o m.json --xref back.csv --report r.json");
    let report = place.json("r.json");
    let excess = &report["checks"]["line_excess"];
    assert!(excess["holds"] == true && excess["value"].as_f64().unwrap() < 1e-9, "{excess}");
    // A row for each vertex, the given ones at corners of their faces.
    let back = place.text("back.csv");
    let rows: Vec<&str> = back.lines().collect();
    assert_eq!(rows[0], "output_vertex,source_face,b0,b1,b2");
    assert_eq!(rows.len() as u64 - 1, report["result"]["vertices"].as_u64().unwrap());
    let corner = |row: &&&str| row.split(',').skip(2).filter(|w| *w == "1").count() == 1;
    assert_eq!(rows[1..].iter().filter(corner).count(), 240);
    assert!(report["result"]["min_angle_degrees"].as_f64().unwrap() >= 25.0);
    assert!(report["result"]["min_angle_degrees_before"].as_f64().unwrap() < 25.0);
    place.expect(0, "uniformize m.json --report r.json");
    assert_eq!(numbers(&place.json("r.json")["result"]["modulus"]).len(), 2);
    let few = place.expect(1, "refine t.obj --intrinsic --most-added 3 -o few.json");
    assert!(few.out.contains("--most-added"), "{}", few.out);
}

#[test]
fn what_says_nothing_or_too_much_is_refused() {
    let place = Place::new();
    place.expect(0, "make disk -o d.obj");
    for (words, why) in [
        ("-o e.obj", "--levels"),
        ("--levels 1 -o e.json", ".json"),
        ("--intrinsic -o e.obj", "json"),
        ("--intrinsic --angle 31 -o e.json", "30"),
        ("--intrinsic --levels 1 -o e.json", "--levels"),
        ("--edge 0 -o e.obj", "positive"),
    ] {
        let refused = place.expect(2, &format!("refine d.obj {words}"));
        assert!(refused.err.contains(why), "{words}: {}", refused.err);
    }
    place.expect(0, "make bolza -o b.json");
    assert!(place.expect(3, "refine b.json --levels 1 -o e.obj").err.contains("--intrinsic"));
    assert!(place.expect(2, "refine d.obj --edge 1e-9 -o e.obj").err.contains("67 million"));
}

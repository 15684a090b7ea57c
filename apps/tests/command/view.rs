//! `ricci view`: pages with what the files hold, and refusals that name the file and what to do.

use crate::run::Place;
use base64::Engine;
use serde_json::Value;

/// The data of a page's views.
fn views(page: &str) -> Value {
    let text = page.split_once("id=\"views\">").unwrap().1.split_once("</script>").unwrap().0;
    serde_json::from_str(text).unwrap()
}

fn shorts(text: &Value) -> Vec<u16> {
    let bytes = base64::engine::general_purpose::STANDARD.decode(text.as_str().unwrap()).unwrap();
    bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
}

const SQUARE: &str =
    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

#[test]
fn a_layout_is_shown_beside_its_surface_with_its_distortion() {
    let place = Place::new();
    place.expect(0, "make genus --genus 2 -o g.obj --quiet");
    place.expect(0, "flow g.obj --target auto:6 --uv flat.obj --quiet");
    let ended = place.expect(0, "view flat.obj -o page.html --report r.json");
    assert!(ended.out.contains("beside its texture coordinates"), "{}", ended.out);
    let page = place.text("page.html");
    assert!(page.contains("<title>flat.obj</title>") && page.contains("default-src 'none'"));
    assert!(!page.contains("http://") && !page.contains("https://"), "the page names an address");
    let view = &views(&page)["view"];
    assert!(view["flat"] == true && view["cut"] == true && view["wide"] == false);
    let (n, m) = (view["vertices"].as_u64().unwrap(), view["faces"].as_u64().unwrap());
    assert_eq!(shorts(&view["corners"]).len() as u64, 3 * m);
    assert_eq!(shorts(&view["corners"]).into_iter().max().unwrap() as u64, n - 1);
    for side in ["surface", "image"] {
        assert_eq!(shorts(&view[side]["data"]).len() as u64, 3 * n, "{side}");
    }
    let names: Vec<&str> =
        view["quantities"].as_array().unwrap().iter().map(|q| q["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["logarithm of the change of area", "quasi-conformal dilatation"]);
    // The map is conformal: nine tenths of the vertices have a dilatation near 1.
    assert!(view["quantities"][1]["low"].as_f64().unwrap() < 1.01);
    let told = &place.json("r.json")["result"]["views"][0];
    assert_eq!((told["path"].as_str(), told["beside"].as_str()), (Some("flat.obj"), Some("texture")));
    assert_eq!((told["vertices"].as_u64(), told["faces"].as_u64()), (Some(n), Some(m)));
}

#[test]
fn an_isometry_keeps_areas_and_angles() {
    let place = Place::new();
    place.put("square.obj", SQUARE).expect(0, "view square.obj -o page.html --quiet");
    let view = &views(&place.text("page.html"))["view"];
    for (k, value) in [(0, 0.0), (1, 1.0)] {
        let quantity = &view["quantities"][k];
        assert!((quantity["low"].as_f64().unwrap() - value).abs() < 1e-12, "{quantity}");
        assert!((quantity["high"].as_f64().unwrap() - value).abs() < 1e-12, "{quantity}");
    }
    assert_eq!(view["surface"]["step"], 2.0 / 65535.0);
    assert_eq!(shorts(&view["image"]["data"])[3..6], [65535, 0, 0]);
}

#[test]
fn several_files_stand_below_each_other_and_names_are_no_code() {
    let place = Place::new();
    place
        .put("a&b.obj", SQUARE)
        .put("c.obj", &SQUARE.replace("/1", "").replace("/2", "").replace("/3", "").replace("/4", ""));
    place.expect(0, "view a&b.obj c.obj -o page.html --quiet --title </title><script>");
    let page = place.text("page.html");
    assert_eq!((page.matches("<canvas").count(), page.matches("<script").count()), (2, 2));
    assert!(page.contains("<h2>a&amp;b.obj</h2>") && page.contains("<h1>&lt;/title&gt;&lt;script&gt;</h1>"));
    let views = views(&page);
    assert!(views["view"]["flat"] == true && views["view-2"]["image"].is_null());
}

#[test]
fn numbers_of_vertices_are_quantities() {
    let place = Place::new();
    place.put("square.obj", SQUARE).put("t.csv", "vertex;thickness\n0;1,5\n1;2\n2;nan\n");
    place.put("plain.csv", "3,4\n0,1\n");
    place.expect(0, "view square.obj -o page.html --values t.csv --values plain.csv --quiet");
    let view = &views(&place.text("page.html"))["view"];
    assert_eq!(view["quantities"][0]["name"], "thickness");
    assert_eq!(view["quantities"][1]["name"], "plain");
    // Vertices without a number are grey.
    assert_eq!(shorts(&view["quantities"][0]["data"]), [0, 65534, 65535, 65535]);
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
               property float heat\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n";
    place.put("m.ply", ply).expect(0, "view m.ply -o ply.html --quiet");
    assert_eq!(views(&place.text("ply.html"))["view"]["quantities"][0]["name"], "heat");
}

#[test]
fn an_image_has_the_vertices_of_the_surface() {
    let place = Place::new();
    place.expect(0, "make ellipsoid -o e.obj --quiet");
    place.expect(0, "uniformize e.obj --sphere s.obj --quiet");
    place.expect(0, "view e.obj --image s.obj -o page.html --up z --quiet");
    let view = &views(&place.text("page.html"))["view"];
    assert!(view["flat"] == false && view["cut"] == false && view["lies"] == false);
    assert_eq!(view["up"], serde_json::json!([0.0, 0.0, 1.0]));
    assert_eq!(
        view["image"]["data"].as_str().unwrap().len(),
        view["surface"]["data"].as_str().unwrap().len()
    );
    place.put("square.obj", SQUARE);
    let ended = place.expect(3, "view e.obj --image square.obj -o other.html");
    assert!(ended.err.contains("square.obj: 4 vertices, and e.obj has"), "{}", ended.err);
    place.expect(2, "view e.obj square.obj --image s.obj -o other.html");
    assert!(!place.exists("other.html"));
}

#[test]
fn what_cannot_be_shown_is_named_with_what_to_do_and_nothing_is_written() {
    let place = Place::new();
    place.expect(0, "make bolza -o bolza.json --quiet");
    place.expect(0, "make disk --height 0.3 -o d.obj --quiet");
    place.expect(0, "spline fit d.obj --planar -o d.json --quiet");
    place.put("square.obj", SQUARE).put("bad.csv", "9,1\n").put("word.csv", "0,much\n").put("empty.csv", "");
    place.put("hollow.obj", "v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n");
    for (line, words) in [
        ("bolza.json", "bolza.json: a metric has no triangles in space; `ricci flow FILE --flat"),
        ("d.json", "d.json: a spline has no triangles; `ricci spline eval"),
        ("nothing.obj", "nothing.obj"),
        ("square.obj nothing.obj", "nothing.obj"),
        ("hollow.obj", "hollow.obj: no face could be shown; `ricci info`"),
        ("square.obj --values bad.csv", "bad.csv:1: vertex 9 does not exist"),
        ("square.obj --values word.csv", "word.csv:1: `much` is no number"),
        ("square.obj --values empty.csv", "empty.csv: no vertex has a number; rows are vertex,number"),
    ] {
        let ended = place.expect(3, &format!("view {line} -o page.html"));
        assert!(ended.err.contains(words), "{line}: {}", ended.err);
        assert!(!place.exists("page.html"), "{line}");
    }
    for line in [
        "square.obj -o page.txt",
        "square.obj -o square.obj",
        "- - -o page.html",
        "-o page.html",
        "square.obj",
    ] {
        place.expect(2, &format!("view {line}"));
    }
    assert!(!place.files().iter().any(|name| name.contains("page")));
}

#[test]
fn faces_that_are_not_finite_are_left_out_and_told() {
    let place = Place::new();
    place.put("part.obj", &format!("{SQUARE}v 0 inf 0\nf 1/1 2/2 5/3\n"));
    let ended = place.expect(0, "view part.obj -o page.html");
    assert!(ended.out.contains("left out 1 face of part.obj"), "{}", ended.out);
    let view = &views(&place.text("page.html"))["view"];
    assert_eq!(view["faces"], 2);
    assert!(
        (view["quantities"][1]["high"].as_f64().unwrap() - 1.0).abs() < 1e-12,
        "they count in the distortion"
    );
}

#[test]
fn large_surfaces_have_wide_corners() {
    let place = Place::new();
    place.expect(0, "make torus -n 420 -m 200 -o t.ply --quiet");
    place.expect(0, "view t.ply -o - --quiet");
    place.expect(0, "view t.ply -o page.html --quiet");
    let view = &views(&place.text("page.html"))["view"];
    assert!(view["wide"] == true && view["vertices"].as_u64() > Some(65535));
    assert_eq!(shorts(&view["corners"]).len() as u64, 6 * view["faces"].as_u64().unwrap());
}

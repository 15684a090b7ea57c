//! The gallery in small files, and its page: nothing missing, nothing from elsewhere, data that can be read.

use crate::run::Place;
use serde_json::Value;

/// What stands between two texts, after the first place where the first one stands.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).unwrap().1.split_once(to).unwrap().0
}

/// The places that a tag names, but for those on the page and those that hold their data.
fn elsewhere(page: &str) -> Vec<String> {
    let named = ["src=\"", "href=\"", "url(", "@import", "import(", "fetch("];
    let places = named.iter().flat_map(|name| page.split(name).skip(1));
    let starts = places.map(|text| text.chars().take(40).collect::<String>());
    starts.filter(|text| !text.starts_with("data:image/png;base64,") && !text.starts_with('#')).collect()
}

/// Both pages of one run, for a run takes its time.
#[test]
fn the_gallery_has_every_generator_in_small_files_and_in_a_page_that_needs_nothing_beside_it() {
    let place = Place::new();
    place.expect(0, "gallery out --quiet");
    every_picture_is_small(&place);
    let page = place.text("out/index.html");
    assert!(!page.contains("Left out"), "a picture is left out");
    assert_eq!(elsewhere(&page), Vec::<String>::new());
    assert!(!page.contains("http://") && !page.contains("https://"), "the page names an address");
    assert_eq!(elsewhere("<img src=\"a.png\">").len(), 1);
    assert!(page.contains("default-src 'none'"));
    every_figure_and_row_is_there(&page, &place.text("out/README.md"));
    every_view_is_whole(&page);
}

#[test]
fn a_gallery_needs_a_directory_and_a_corpus_that_is_there() {
    let place = Place::new();
    place.put("file", "").expect(2, "gallery file");
    place.expect(3, "gallery out nowhere --quiet");
}

fn every_picture_is_small(place: &Place) {
    let page = place.text("out/README.md");
    assert!(!page.contains("left out"), "{page}");
    let names: Vec<&str> = page.split("](").skip(1).map(|s| s.split(')').next().unwrap()).collect();
    assert!(names.len() >= 15, "{names:?}");
    for name in names {
        let bytes = std::fs::metadata(place.path(&format!("out/{name}"))).unwrap().len();
        assert!((1000..90_000).contains(&bytes), "{name}: {bytes} bytes");
    }
}

fn views(page: &str) -> Value {
    serde_json::from_str(between(page, "id=\"views\">", "</script>")).unwrap()
}

fn every_figure_and_row_is_there(page: &str, listed: &str) {
    for number in 1..=15 {
        assert!(page.contains(&format!(">Figure {number}. ")), "figure {number}");
    }
    let names: Vec<&str> = listed.split("![").skip(1).map(|s| s.split(']').next().unwrap()).collect();
    assert!(names.len() > 40, "{names:?}");
    let views = views(page);
    for name in names {
        let start = format!("<article id=\"{name}\">");
        assert_eq!(page.matches(&start).count(), 1, "{name}");
        let article = between(page, &start, "</article>");
        assert!(article.contains("<code>ricci "), "{name} has no command");
        let has_view = article.contains("<canvas");
        assert!(has_view || article.contains("class=\"note\">"), "{name} does not say why it has no view");
        assert_eq!(has_view, views.get(name).is_some(), "{name}");
        let only_made = article.matches("<code>").count() == 1;
        assert!(
            only_made || article.contains("<table>") && article.contains("<td>"),
            "{name} has no numbers"
        );
    }
}

fn every_view_is_whole(page: &str) {
    let views = views(page);
    for (name, view) in views.as_object().unwrap() {
        // Four characters of base64 for three bytes, two bytes a number, three numbers a vertex or face.
        let characters = |n: u64| (6 * n).div_ceil(3) * 4;
        let length = |text: &Value| text.as_str().unwrap().len() as u64;
        let n = view["vertices"].as_u64().unwrap();
        assert!(n > 2 && n <= 20_000, "{name}: {n} vertices");
        assert_eq!(length(&view["surface"]["data"]), characters(n), "{name}");
        assert_eq!(length(&view["corners"]), characters(view["faces"].as_u64().unwrap()), "{name}");
        if !view["image"].is_null() {
            assert_eq!(length(&view["image"]["data"]), characters(n), "{name}");
        }
    }
    let (flat, solid) = (&views["torus"], &views["ball"]);
    assert!(flat["flat"] == true && !flat["image"].is_null());
    assert!(solid["flat"] == false && !solid["image"].is_null());
}

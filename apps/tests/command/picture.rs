//! Pictures.

use crate::run::Place;
use crate::surfaces::{hill, torus};

fn pixels(place: &Place, name: &str) -> (u32, u32, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(place.path(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    (frame.width, frame.height, bytes)
}

fn place() -> Place {
    let place = Place::new();
    place.put("torus.obj", &torus(24, 16).obj()).put("disk.obj", &hill(8).obj());
    place
}

/// Where the layout's scale varies much the pattern changes its size on request alone.
#[test]
fn bands_are_drawn_on_request() {
    let place = place();
    place.expect(0, "make ellipsoid --axes 6 1 1 -n 10 -o long.obj --quiet");
    let draw = |options: &str| {
        place.expect(0, &format!("flow long.obj --quiet --size 120 --draft --picture p.png {options}"));
        pixels(&place, "p.png")
    };
    assert!(draw("") != draw("--bands"));
}

/// Charts are framed by their unit square.
#[test]
fn charts_lie_in_a_frame() {
    let place = place();
    place.expect(0, "flow torus.obj --target auto:4 --charts --quiet --size 100 --picture p.svg");
    let svg = place.text("p.svg");
    let frame = svg.lines().find(|line| line.contains("stroke=\"#9a9a9a\"")).unwrap();
    // One line around the square, a margin from the sides of the picture.
    assert!(frame.contains("d=\"M3 97l94 0 0 -94 -94 0 0 94\""), "{frame}");
}

#[test]
fn patterns_colours_wire_and_views_change_the_picture_and_threads_do_not() {
    let place = place();
    let draw = |options: &str| {
        place.expect(0, &format!("flow torus.obj --quiet --size 120 --picture p.png {options}"));
        pixels(&place, "p.png")
    };
    let usual = draw("");
    assert!(usual == draw("--threads 1") && usual == draw("--threads 3"));
    // Below the panels is a row that says what the lines are.
    assert!(usual.0 > 120 && usual.1 < 160, "{} by {}", usual.0, usual.1);
    let options = [
        "--texture circles",
        "--texture none",
        "--wire",
        "--draft",
        "--view 10,50",
        "--view -80,-10",
        "--up x",
        "--color u",
        "--color curvature",
        "--color qc",
        "--color area",
        "--color u --texture checker",
        "--color pieces",
        "--zoom 5,3",
        "--zoom 5,6",
        "--zoom 6,6 --color pieces",
    ];
    let mut seen = vec![usual];
    for option in options {
        let picture = draw(option);
        assert!(!seen.contains(&picture), "{option}");
        seen.push(picture);
    }
    draw("--palette");
    // A part is as wide as high, on both sides.
    let part = draw("--zoom 5,3 --threads 3");
    assert!(seen.contains(&part) && (120..160).contains(&part.1) && part.0 > 240, "{} by {}", part.0, part.1);
    place.expect(0, "info torus.obj --quiet --size 100 --picture i.png --color curvature --wire");
    place.expect(0, "repair disk.obj -o d.obj --quiet --size 100 --picture r.png");
    place.expect(
        0,
        "make sphere -n 4 -o s.obj --quiet --size 100 --picture s.png --view 0,20 --report s.json",
    );
    assert_eq!(place.json("s.json")["options"]["sphere"]["to"]["view"], serde_json::json!([0.0, 20.0]));
}

#[test]
fn drawings_are_vectors_with_a_legend() {
    let place = place();
    for (options, has) in [
        ("", "#3a6ea5"),
        ("--texture circles", "#3a6ea5"),
        ("--color u", "log conformal factor"),
        ("--scheme tangential --wire", "circles of the vertices"),
        ("--color pieces --zoom 4,3", "shade by face of the input"),
    ] {
        place.expect(0, &format!("flow disk.obj --quiet --picture p.svg {options}"));
        let svg = place.text("p.svg");
        let whole = svg.starts_with("<svg ") && svg.ends_with("</svg>\n");
        assert!(whole && svg.contains(has), "{options}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        // The first thing drawn is a white ground.
        assert!(svg.lines().nth(1).unwrap().starts_with(r#"<path fill="white""#), "{options}");
    }
}

#[test]
fn the_seconds_of_a_picture_are_its_own() {
    let place = place();
    for line in ["flow torus.obj", "flow torus.obj --draft", "uniformize torus.obj", "info torus.obj"] {
        place.expect(0, &format!("{line} --quiet --threads 1 --picture p.png --report r.json"));
        let seconds = &place.json("r.json")["seconds"];
        let of = |phase: &str| seconds[phase].as_f64().unwrap();
        assert!(of("picture") > 0.0 && of("picture") + of("write") <= of("total"), "{line}: {seconds}");
    }
}

/// A draft is drawn without the shadows, which take most of the time of a picture: the ground around the surface stays white.
#[test]
fn a_draft_has_no_shadow_on_the_ground() {
    let place = place();
    let drawn = |options: &str| {
        place.expect(0, &format!("info torus.obj --quiet --size 200 --picture p.png {options}"));
        let (_, _, bytes) = pixels(&place, "p.png");
        bytes.chunks_exact(3).filter(|pixel| **pixel != [255; 3]).count()
    };
    let (draft, full) = (drawn("--draft"), drawn(""));
    assert!(draft + 200 < full, "{draft} pixels of a draft, {full} with shadows");
}

#[test]
fn wishes_that_cannot_be_met_are_exit_2() {
    let place = place();
    for line in [
        "flow torus.obj --wire",
        "flow torus.obj --size 300",
        "flow torus.obj --picture p.png --size 20",
        "flow torus.obj --picture p.png --view 10",
        "flow torus.obj --picture p.png --view 10,100",
        "flow torus.obj --picture p.png --up w",
        "flow torus.obj --picture p.png --color speed",
        "flow torus.obj --zoom 3,2",
        "flow torus.obj --picture p.png --zoom 3",
        "flow torus.obj --picture p.png --zoom 3,0.5",
        "flow torus.obj --picture p.png --zoom 3,inf",
        "flow torus.obj --picture p.png --zoom 384,2",
        "flow torus.obj --picture p.png --space s2 --zoom 3,2",
        "flow torus.obj --picture p.png --space s2 --color pieces",
        "flow torus.obj --picture p.png --space s2 --color qc",
        "info torus.obj --picture p.png --color qc",
        "info torus.obj --picture p.svg",
    ] {
        place.expect(2, line);
    }
    assert!(!place.exists("p.png") && !place.exists("p.svg"));
}

/// The pixels of an SVG file, drawn by a program of its own.
fn drawn(place: &Place, name: &str) -> (u32, u32, Vec<u8>) {
    use resvg::{tiny_skia, usvg};
    let tree = usvg::Tree::from_str(&place.text(name), &usvg::Options::default()).unwrap();
    let size = tree.size().to_int_size();
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height()).unwrap();
    resvg::render(&tree, tiny_skia::Transform::identity(), &mut pixels.as_mut());
    assert!(pixels.data().chunks_exact(4).all(|p| p[3] == 255), "{name} has no ground of its own");
    let rgb = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    (size.width(), size.height(), rgb)
}

/// What has no positions in space is drawn as the same flat picture in both formats.
#[test]
fn vector_and_pixel_pictures_agree() {
    let place = Place::new();
    place.expect(0, "make bolza -o b.json --quiet");
    place.expect(0, "make flat-torus -o f.json --quiet");
    for line in [
        "uniformize b.json --size 200",
        "uniformize b.json --size 200 --texture circles --model half-plane",
        "cover f.json --size 200 --wire",
        "flow f.json --size 200 --color area",
        "flow f.json --size 200 --wire --texture circles",
        "flow f.json --scheme tangential --size 200",
    ] {
        for format in ["svg", "png"] {
            place.expect(0, &format!("{line} --quiet --picture p.{format}"));
        }
        let (vectors, image) = (drawn(&place, "p.svg"), pixels(&place, "p.png"));
        assert_eq!((vectors.0, vectors.1), (image.0, image.1), "{line}");
        let off = vectors.2.iter().zip(&image.2).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(2), "{line}: {off:?}");
        assert!(image.2.chunks_exact(3).filter(|p| **p != [255; 3]).count() > 4000, "{line}");
    }
}

/// Circles have a key that says which are which; layouts without circles have none.
#[test]
fn circles_have_a_key() {
    let place = place();
    let key = "circles of the vertices";
    place.expect(0, "flow disk.obj --scheme tangential --quiet --picture c.svg");
    assert!(place.text("c.svg").contains(key) && place.text("c.svg").contains("circles of the faces"));
    place.expect(0, "flow disk.obj --quiet --picture p.svg");
    assert!(!place.text("p.svg").contains(key));
}

/// Letters are outlines, which need no font, and are as large in a small picture as can be read.
#[test]
fn letters_are_outlines_of_a_readable_size() {
    let place = place();
    place.expect(0, "make bolza -o b.json --quiet");
    for (size, least) in [(160, 6.0), (320, 6.0), (900, 12.0)] {
        let draw = "uniformize b.json --quiet --show dirichlet";
        place.expect(0, &format!("{draw} --size {size} --picture p.svg"));
        let svg = place.text("p.svg");
        assert!(!svg.contains("<text") && !svg.contains("font"));
        let mut labels = svg.split("aria-label=\"").skip(1).peekable();
        assert!(size < 320 || labels.peek().is_some(), "no labels at {size}");
        for label in labels {
            // The last path of a label is its letters.
            let letters = label.split("</g>").next().unwrap().rsplit("d=\"").next().unwrap();
            let letters = letters.split('"').next().unwrap();
            let ends = letters.split(['M', 'L', 'Q', 'Z']).filter(|c| !c.is_empty());
            let y: Vec<f64> = ends.filter_map(|c| c.rsplit(' ').next()?.parse().ok()).collect();
            let height = y.iter().fold(0.0f64, |h, y| h.max(*y)) - y.iter().fold(0.0f64, |h, y| h.min(*y));
            assert!(height >= least, "{height} at {size}");
        }
    }
}

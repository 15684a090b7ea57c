//! `--flat`: the layout as a mesh in the plane, and as drawings for cutting, which are read back here.

use crate::run::Place;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Digits that the flow and the layout of a developable surface keep.
const EXACT: f64 = 1e-9;

/// A polyline of a drawing: its layer, its points, and whether it is closed.
struct Drawn {
    layer: String,
    points: Vec<[f64; 2]>,
    is_closed: bool,
}

impl Drawn {
    fn length(&self) -> f64 {
        let n = self.points.len();
        let side = |k: usize| {
            let (p, q) = (self.points[k], self.points[(k + 1) % n]);
            (q[0] - p[0]).hypot(q[1] - p[1])
        };
        (0..if self.is_closed { n } else { n - 1 }).map(side).sum()
    }
}

/// The polylines of a DXF file, from its pairs of a group code and a value.
fn read_dxf(text: &str) -> Vec<Drawn> {
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len().is_multiple_of(2), "a pair is not complete");
    let pairs: Vec<(i32, &str)> =
        lines.chunks(2).map(|pair| (pair[0].trim().parse().unwrap(), pair[1])).collect();
    assert_eq!(pairs.last(), Some(&(0, "EOF")));
    let at = |name: &str| pairs.iter().position(|pair| *pair == (2, name)).unwrap();
    let layers: Vec<&str> = pairs[at("TABLES")..at("ENTITIES")]
        .windows(2)
        .filter(|w| w[0] == (0, "LAYER") && w[1].0 == 2)
        .map(|w| w[1].1)
        .collect();
    assert_eq!(layers, ["BOUNDARY", "SEAMS", "FOLDS", "ALLOWANCE"]);
    let (mut drawn, mut entity) = (Vec::<Drawn>::new(), "");
    for &(code, value) in &pairs[at("ENTITIES")..] {
        if code == 0 {
            entity = value;
            if entity == "POLYLINE" {
                drawn.push(Drawn { layer: String::new(), points: Vec::new(), is_closed: false });
            } else if entity == "VERTEX" {
                drawn.last_mut().unwrap().points.push([f64::NAN; 2]);
            }
            continue;
        }
        let Some(line) = drawn.last_mut() else { continue };
        match (entity, code) {
            ("POLYLINE", 8) => line.layer = value.into(),
            ("POLYLINE", 70) => line.is_closed = value == "1",
            ("VERTEX", 8) => assert_eq!(value, line.layer),
            ("VERTEX", 10 | 20) => {
                line.points.last_mut().unwrap()[usize::from(code == 20)] = value.parse().unwrap();
            }
            _ => {}
        }
    }
    drawn
}

/// The value of an attribute of the first element of this name.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    element.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap()
}

/// The paths of an SVG file with y turned up again, and its width and view box.
fn read_svg(text: &str) -> (Vec<Drawn>, String, [f64; 4]) {
    let head = text.lines().next().unwrap();
    let numbers = |text: &str| text.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
    let (mut drawn, mut layer) = (Vec::new(), String::new());
    for line in text.lines() {
        if line.starts_with("<g") {
            layer = attribute(line, "id").into();
        } else if line.starts_with("<path") {
            let path = attribute(line, "d").strip_prefix('M').unwrap();
            let open = path.strip_suffix('Z');
            let points = open.unwrap_or(path).split('L').map(|p| {
                let [x, y] = numbers(p)[..] else { panic!("{p}") };
                [x, -y]
            });
            drawn.push(Drawn { layer: layer.clone(), points: points.collect(), is_closed: open.is_some() });
        }
    }
    let view = numbers(attribute(head, "viewBox")).try_into().unwrap();
    (drawn, attribute(head, "width").into(), view)
}

/// The sum of the lengths on each layer.
fn lengths(drawn: &[Drawn]) -> BTreeMap<&str, f64> {
    let mut sums = BTreeMap::new();
    drawn.iter().for_each(|line| *sums.entry(line.layer.as_str()).or_insert(0.0) += line.length());
    sums
}

/// A plate of unit squares as an OBJ, `at(i, j)` the place of a node; without the squares of `holes`.
fn plate(n: [usize; 2], holes: &[[usize; 2]], at: impl Fn(f64, f64) -> [f64; 3]) -> String {
    let mut text = String::new();
    let mut number = BTreeMap::new();
    let squares: Vec<[usize; 2]> = (0..n[0]).flat_map(|i| (0..n[1]).map(move |j| [i, j])).collect();
    for [i, j] in squares.into_iter().filter(|s| !holes.contains(s)) {
        let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|corner| {
            let next = number.len() + 1;
            *number.entry(corner).or_insert_with(|| {
                let [x, y, z] = at(corner[0] as f64, corner[1] as f64);
                writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
                next
            })
        });
        let [a, b, c, d] = corners;
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    text
}

/// A strip of 7 by 2 that is bent at a right angle after 3.
fn bent() -> String {
    plate([7, 2], &[], |x, y| if x <= 3.0 { [x, y, 0.0] } else { [3.0, y, x - 3.0] })
}

#[test]
fn a_bent_strip_is_cut_as_one_closed_line_of_its_own_length_and_folded_along_another() {
    let place = Place::new();
    place.put("bent.obj", &bent());
    place.expect(0, "flow bent.obj --pin boundary --flat bent.dxf");
    let drawn = read_dxf(&place.text("bent.dxf"));
    let of_layer: Vec<(&str, bool)> = drawn.iter().map(|l| (l.layer.as_str(), l.is_closed)).collect();
    assert_eq!(of_layer, [("BOUNDARY", true), ("FOLDS", false)]);
    assert_eq!([drawn[0].points.len(), drawn[1].points.len()], [18, 3]);
    for (line, length) in drawn.iter().zip([18.0, 2.0]) {
        assert!((line.length() - length).abs() < EXACT, "{} {}", line.layer, line.length());
    }
    // An angle of 90 degrees is no fold where only larger ones are.
    place.expect(0, "flow bent.obj --pin boundary --flat bent.dxf --fold-angle 100");
    assert_eq!(read_dxf(&place.text("bent.dxf")).len(), 1);
}

#[test]
fn an_svg_is_true_to_size_in_its_unit() {
    let place = Place::new();
    place.put("bent.obj", &bent());
    place.expect(0, "flow bent.obj --pin boundary --flat bent.dxf");
    let expected = read_dxf(&place.text("bent.dxf"));
    for (unit, symbol, scale) in
        [("mm", "mm", 1.0), ("cm", "cm", 1.0), ("m", "mm", 1000.0), ("in", "in", 1.0)]
    {
        place.expect(0, &format!("flow bent.obj --pin boundary --flat bent.svg --flat-unit {unit}"));
        let (drawn, width, view) = read_svg(&place.text("bent.svg"));
        let width: f64 = width.strip_suffix(symbol).unwrap().parse().unwrap();
        assert!((width - scale * view[2]).abs() < EXACT * scale, "{unit}: {width} for {view:?}");
        for (line, same) in drawn.iter().zip(&expected) {
            assert_eq!((&line.layer, line.is_closed), (&same.layer, same.is_closed));
            assert_eq!(line.points, same.points, "{unit}");
        }
        assert_eq!(drawn.len(), expected.len());
        let inside = |p: &[f64; 2]| {
            (view[0]..=view[0] + view[2]).contains(&p[0]) && (view[1]..=view[1] + view[3]).contains(&-p[1])
        };
        assert!(drawn.iter().all(|line| line.points.iter().all(inside)), "{view:?}");
    }
}

#[test]
fn a_plate_with_a_hole_has_its_boundary_and_both_sides_of_each_seam() {
    let place = Place::new();
    let (sin, cos) = 0.7f64.sin_cos();
    place.put(
        "plate.obj",
        &plate([6, 5], &[[2, 2], [3, 2]], |x, y| [cos * x - sin * y, 4.0, sin * x + cos * y]),
    );
    place.expect(0, "flow plate.obj --pin boundary --flat plate.dxf");
    let drawn = read_dxf(&place.text("plate.dxf"));
    let sums = lengths(&drawn);
    assert!((sums["BOUNDARY"] - 28.0).abs() < EXACT, "{sums:?}");
    assert!(!sums.contains_key("FOLDS"), "{sums:?}");
    let seams: Vec<f64> = drawn.iter().filter(|l| l.layer == "SEAMS").map(Drawn::length).collect();
    for pair in seams.chunks(2) {
        assert!(pair.len() == 2 && (pair[0] - pair[1]).abs() < EXACT, "{seams:?}");
    }
}

#[test]
fn a_metric_that_is_given_by_lengths_alone_is_written_as_a_flat_mesh() {
    let place = Place::new();
    place.put(
        "square.json",
        r#"{"faces": [[0,1,2],[0,2,3]], "lengths": [[1,1.4142135623730951,1],[1,1,1.4142135623730951]]}"#,
    );
    for name in ["flat.obj", "flat.off", "flat.ply", "flat.glb", "flat.dxf", "flat.svg"] {
        place.expect(0, &format!("flow square.json --pin boundary --flat {name}"));
        assert!(place.exists(name));
    }
    let text = place.text("flat.obj");
    let rows = |key: &str| -> Vec<Vec<f64>> {
        let of_line = |line: &str| line[2..].split(' ').map(|x| x.parse().unwrap()).collect();
        text.lines().filter(|line| line.starts_with(key)).map(of_line).collect()
    };
    let (v, f) = (rows("v "), rows("f "));
    assert_eq!((v.len(), f.len()), (4, 2));
    for face in &f {
        let mut sides = [0, 1, 2].map(|k| {
            let (p, q) = (&v[face[k] as usize - 1], &v[face[(k + 1) % 3] as usize - 1]);
            assert_eq!(p[2], 0.0);
            (q[0] - p[0]).hypot(q[1] - p[1])
        });
        sides.sort_by(f64::total_cmp);
        for (side, length) in sides.iter().zip([1.0, 1.0, 2f64.sqrt()]) {
            assert!((side - length).abs() < EXACT, "{sides:?}");
        }
    }
    let refused = place.expect(2, "flow square.json --uv out.obj");
    assert!(refused.err.contains("--flat OUT.obj"), "{}", refused.err);
    place.expect(2, "flow square.json --flat out.dxf --fold-angle 30");
}

#[test]
fn every_command_with_a_layout_in_the_plane_writes_it() {
    let place = Place::new();
    place.put("plate.obj", &plate([6, 5], &[[2, 2], [3, 2]], |x, y| [x, y, 0.1 * x * y]));
    place.put("bent.obj", &bent());
    place.expect(0, "make torus -o torus.obj");
    let closed = |line: &str, name: &str, layer: &str| {
        place.expect(0, &format!("{line} --flat {name}"));
        let drawn = read_dxf(&place.text(name));
        drawn.iter().filter(|l| l.is_closed && l.layer == layer).map(Drawn::length).collect::<Vec<f64>>()
    };
    // The disk and the square have one closed boundary, that of the unit disk by its 18 corners.
    let disk = closed("harmonic bent.obj --to disk", "disk.dxf", "BOUNDARY");
    assert!(disk.len() == 1 && disk[0] < std::f64::consts::TAU && disk[0] > 5.9, "{disk:?}");
    assert_eq!(closed("harmonic bent.obj --to polygon:4", "polygon.dxf", "BOUNDARY").len(), 1);
    assert_eq!(closed("uniformize bent.obj --boundary straight", "straight.dxf", "BOUNDARY").len(), 1);
    place.expect(0, "circles plate.obj --flat circles.dxf");
    assert!(lengths(&read_dxf(&place.text("circles.dxf")))["BOUNDARY"] > 6.0);
    // The torus is a parallelogram whose sides are sides of seams.
    place.expect(0, "uniformize torus.obj --flat torus.dxf --on input");
    let torus = read_dxf(&place.text("torus.dxf"));
    assert!(!torus.is_empty() && torus.iter().all(|l| l.layer != "BOUNDARY"));
}

#[test]
fn what_has_no_flat_layout_is_refused_with_a_way_out() {
    let place = Place::new();
    place.put("plate.obj", &plate([6, 5], &[[1, 2], [4, 2]], |x, y| [x, y, 0.0]));
    place.expect(0, "make genus -o two.obj");
    place.expect(0, "make sphere -o ball.obj");
    for (code, line, words) in [
        (2, "flow two.obj --flat out.dxf", "--space e2"),
        (2, "uniformize two.obj --flat out.obj", "ricci flow"),
        (2, "uniformize ball.obj --flat out.obj", "--sphere"),
        (2, "harmonic ball.obj --flat out.obj", "--sphere"),
        (2, "flow plate.obj --flat out.stl", ".dxf"),
        (3, "harmonic plate.obj --to disk --flat out.obj", "ricci circles"),
        (3, "harmonic plate.obj --to disk --flat out.obj", "ricci uniformize"),
    ] {
        let refused = place.expect(code, line);
        assert!(refused.err.contains(words), "ricci {line}: {}", refused.err);
    }
    assert!(!place.exists("out.obj"));
}

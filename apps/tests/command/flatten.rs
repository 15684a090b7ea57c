//! `ricci flatten`: what unrolls, what is stretched, its files, and what is refused.

use crate::run::{Place, numbers};

/// Twice the signed areas of the triangles of a texture.
fn doubled_areas(text: &str) -> Vec<f64> {
    let words = |line: &str| line.split(' ').skip(1).map(str::to_string).collect::<Vec<_>>();
    let at: Vec<Vec<f64>> = text
        .lines()
        .filter(|l| l.starts_with("vt "))
        .map(|l| words(l).iter().map(|x| x.parse().unwrap()).collect())
        .collect();
    let corner = |word: &String| word.split('/').nth(1).unwrap().parse::<usize>().unwrap() - 1;
    let area = |line: &str| {
        let [a, b, c] = [0, 1, 2].map(|k| &at[corner(&words(line)[k])]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    text.lines().filter(|l| l.starts_with("f ")).map(area).collect()
}

#[test]
fn a_bowl_is_stretched_as_little_as_possible() {
    let place = Place::new();
    place.expect(0, "make disk -n 12 --height 0.5 -o bowl.obj");
    let said = place.expect(
        0,
        "flatten bowl.obj --uv flat.obj --picture flat.png --flat flat.svg --trace t.csv --report r.json",
    );
    assert!(
        said.out.contains("converged after") && said.out.contains("by the Hessian itself"),
        "{}",
        said.out
    );
    let report = place.json("r.json");
    let result = &report["result"];
    assert_eq!(result["turned_triangles_in_file"].as_u64(), Some(0));
    assert_eq!(report["checks"]["turned_triangles_in_file"]["holds"].as_bool(), Some(true));
    assert!(doubled_areas(&place.text("flat.obj")).iter().all(|area| *area > 0.0));
    let energies = numbers(&result["energies"]);
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-14)), "{energies:?}");
    assert_eq!(place.text("t.csv").lines().count(), energies.len() + 1);
    let [before, after] = ["before", "after"].map(|when| result[when]["energy"].as_f64().unwrap());
    assert!(4.0 < after && after < before);
    assert_eq!(report["options"]["conformal"].as_f64(), Some(0.0));
    // Areas are kept better where they are asked for.
    place.expect(0, "flatten bowl.obj --energy area --report a.json");
    let areas = &place.json("a.json");
    assert_eq!(areas["options"]["conformal"].as_f64(), Some(0.1));
    let error = |report: &serde_json::Value| report["result"]["after"]["mean_area_error"].as_f64().unwrap();
    assert!(error(areas) < error(&report));
    place.expect(0, "flatten bowl.obj --uv flat.glb --patch lh.patch.flat");
    // A patch: its mark, its count, then 16 bytes per vertex, those of the border with negative numbers.
    let patch = std::fs::read(place.path("lh.patch.flat")).unwrap();
    let words: Vec<i32> = patch.chunks(4).map(|w| i32::from_be_bytes(w.try_into().unwrap())).collect();
    let n = words[1] as usize;
    assert_eq!((words[0], words.len()), (-1, 2 + 4 * n));
    assert_eq!((0..n).filter(|k| words[2 + 4 * k] < 0).count(), 6 * 12);
}

#[test]
fn the_part_in_a_label_keeps_its_numbers() {
    let place = Place::new();
    place.expect(0, "make sphere -n 8 -o lh.white");
    // The vertices above a plane, by the file as OBJ.
    place.expect(0, "repair lh.white -o s.obj");
    let text = place.text("s.obj");
    let heights: Vec<f64> = text
        .lines()
        .filter(|l| l.starts_with("v "))
        .map(|l| l.split(' ').nth(3).unwrap().parse().unwrap())
        .collect();
    let named: Vec<usize> = (0..heights.len()).filter(|&v| heights[v] > -0.3).collect();
    let rows: String = named.iter().map(|v| format!("{v} 0 0 0 0\n")).collect();
    place.put("lh.cortex.label", &format!("#!ascii label\n{}\n{rows}", named.len()));
    let files = "--patch lh.patch.flat --areal lh.areal --shape lh.shape --picture flat.svg --report r.json";
    place.expect(0, &format!("flatten lh.white --label lh.cortex.label {files}"));
    let report = place.json("r.json");
    assert_eq!(report["result"]["whole_vertices"].as_u64(), Some(heights.len() as u64));
    let words = |name: &str| std::fs::read(place.path(name)).unwrap();
    let patch = words("lh.patch.flat");
    let integer = |bytes: &[u8]| i32::from_be_bytes(bytes.try_into().unwrap());
    let vertices: Vec<usize> =
        patch[8..].chunks(16).map(|row| integer(&row[..4]).unsigned_abs() as usize - 1).collect();
    assert!(vertices.iter().all(|v| named.contains(v)) && vertices.len() > named.len() / 2);
    for name in ["lh.areal", "lh.shape"] {
        let bytes = words(name);
        assert_eq!((&bytes[..3], integer(&bytes[3..7]) as usize), (&[255_u8; 3][..], heights.len()));
        let values: Vec<f32> =
            bytes[15..].chunks(4).map(|w| f32::from_be_bytes(w.try_into().unwrap())).collect();
        let is_outside = |v: usize| !vertices.contains(&v);
        assert!(
            values.iter().enumerate().all(|(v, x)| x.is_finite() && (!is_outside(v) || *x == 0.0)),
            "{name}"
        );
        assert!(values.iter().any(|x| *x != 0.0), "{name}");
    }
    place.put("far.label", "#\n1\n99999 0 0 0 0\n");
    assert!(place.expect(3, "flatten lh.white --label far.label").err.contains("vertex 99999"));
    place.put("none.label", "#\n0\n");
    assert!(place.expect(3, "flatten lh.white --label none.label").err.contains("no face"));
}

#[test]
fn the_conformal_map_itself_is_not_converged() {
    let place = Place::new();
    place.expect(0, "make disk -n 6 --height 0.5 -o bowl.obj");
    let said = place.expect(1, "flatten bowl.obj --max-iterations 0 --report r.json");
    assert!(said.out.contains("--max-iterations"), "{}", said.out);
    let report = place.json("r.json");
    assert_eq!(report["result"]["stop_reason"].as_str(), Some("max-iterations"));
    assert_eq!(report["result"]["before"], report["result"]["after"]);
}

#[test]
fn conditions_come_from_files_and_are_checked() {
    let place = Place::new();
    place.expect(0, "make disk -n 6 --height 0.5 -o bowl.obj");
    place.put("pin.csv", "vertex,x,y\n0,10,20\n1,10.25,20\n");
    let first = 1 + 6 * (1 + 2 + 3 + 4 + 5);
    let piece: String = (first..first + 6).map(|v| format!("a,{v}\n")).collect();
    place.put("straight.csv", &format!("piece,vertex\n{piece}"));
    place.put("weights.csv", "face,weight\n0,5\n3,0.5\n");
    let conditions = "--pin pin.csv --straight straight.csv --weights weights.csv --injective";
    let said = place.expect(0, &format!("flatten bowl.obj {conditions} --uv flat.obj --report r.json"));
    assert!(said.out.contains("overlap  none") && said.out.contains("misfit"), "{}", said.out);
    let report = place.json("r.json");
    assert_eq!(report["result"]["one_to_one"].as_bool(), Some(true));
    for check in ["misfit", "overlaps"] {
        assert_eq!(report["checks"][check]["holds"].as_bool(), Some(true), "{check}");
    }
    assert!(place.text("flat.obj").contains("\nvt 10.0 20.0\nvt 10.25 20.0\n"));
    place.expect(0, "flatten bowl.obj --energy distance --rings 3 --report d.json");
    place.expect(0, "flatten bowl.obj --report i.json");
    let error = |name: &str| place.json(name)["result"]["after"]["mean_length_error"].as_f64().unwrap();
    assert!(error("d.json") < error("i.json"));
    place.put("short.csv", "piece,vertex\na,1\na,2\n");
    assert!(place.expect(3, "flatten bowl.obj --straight short.csv").err.contains("give 3 or more"));
    place.put("none.csv", "face,weight\n0,0\n");
    assert!(place.expect(3, "flatten bowl.obj --weights none.csv").err.contains("no weight above 0"));
    place.put("far.csv", "face,weight\n99999,1\n");
    assert!(place.expect(3, "flatten bowl.obj --weights far.csv").err.contains("face 99999"));
}

#[test]
fn darts_are_suggested_where_a_material_bears_less_and_drawings_have_allowances() {
    let place = Place::new();
    place.expect(0, "make disk -n 10 --height 0.6 -o bowl.obj");
    let files = "--flat flat.dxf --allowance 0.02 --uv cut.obj --report r.json";
    let said = place.expect(0, &format!("flatten bowl.obj --strain 0.2,0.2 --shear 30 {files}"));
    assert!(
        said.out.contains("strain   along the warp") && said.out.contains("dart     from vertex"),
        "{}",
        said.out
    );
    let report = place.json("r.json");
    let sheet = &report["result"]["sheet"];
    assert!(sheet["of_limit_without_darts"].as_f64().unwrap() > 1.0);
    assert!(sheet["of_limit"].as_f64().unwrap() <= 1.0 && sheet["share_over_limit"].as_f64() == Some(0.0));
    let darts = sheet["darts"].as_array().unwrap();
    assert!(!darts.is_empty());
    let count = |text: &str, begin: &str| text.lines().filter(|l| l.starts_with(begin)).count();
    let opened: usize = darts.iter().map(|dart| dart["path"].as_array().unwrap().len() - 1).sum();
    let [before, after] = ["bowl.obj", "cut.obj"].map(|name| count(&place.text(name), "v "));
    assert_eq!(after, before + opened);
    assert!(place.text("flat.dxf").contains("ALLOWANCE"));
    // A budget that no dart fits in leaves the limits passed, which is told.
    let said = place.expect(1, "flatten bowl.obj --strain 0.08,0.08 --open 0.001");
    assert!(
        said.out.contains("strain_over_limit") || said.err.contains("strain_over_limit"),
        "{} {}",
        said.out,
        said.err
    );
    assert!(place.expect(2, "flatten bowl.obj --flat f.obj --allowance 1").err.contains("is drawn"));
    assert!(place.expect(2, "flatten bowl.obj --strain 0.1").err.contains("two numbers"));
}

#[test]
fn what_cannot_be_flattened_is_refused_with_the_way_out() {
    let place = Place::new();
    place.expect(0, "make torus -o t.obj");
    for option in ["--injective", "--strain 0.1,0.1", "--energy distance", "--areal lh.areal"] {
        let said = place.expect(2, &format!("flatten t.obj {option}")).err;
        assert!(said.contains(" is for "), "{option}: {said}");
    }
    place.expect(0, "make torus -n 12 --holes 1 -o h.obj");
    assert!(place.expect(0, "flatten h.obj").out.contains("seams"));
    place.expect(0, "make sphere -n 3 -o s.obj");
    assert!(place.expect(2, "flatten s.obj --uv u.obj").err.contains("--sphere S.obj"));
    assert!(place.expect(2, "flatten s.obj --energy arap").err.contains("isometric or area"));
    place.expect(0, "make disk -n 3 -o d.obj");
    assert!(place.expect(2, "flatten d.obj --sphere s.obj").err.contains("closed surfaces"));
    assert!(place.expect(2, "flatten d.obj --conformal 1.5").err.contains("share from 0 to 1"));
    assert!(place.expect(2, "flatten d.obj --energy area --conformal 0").err.contains("above 0"));
    assert!(place.expect(2, "flatten d.obj --uv flat.ply").err.contains(".obj or .glb"));
}

#[test]
fn an_ellipsoid_comes_to_the_sphere() {
    let place = Place::new();
    place.expect(0, "make ellipsoid -n 6 -o e.obj");
    place.expect(
        0,
        "flatten e.obj --sphere s.obj --trace t.csv --areal e.areal --shape e.shape --picture s.png --report r.json",
    );
    let report = place.json("r.json");
    let result = &report["result"];
    assert_eq!(result["turned_triangles_in_file"].as_u64(), Some(0));
    assert_eq!(report["checks"]["turned_triangles_in_file"]["holds"].as_bool(), Some(true));
    assert!(result["after"]["energy"].as_f64() < result["before"]["energy"].as_f64());
    assert_eq!(result["energy"], result["after"]["energy"]);
    let (before, after) = (place.text("e.obj"), place.text("s.obj"));
    let faces =
        |text: &str| text.lines().filter(|l| l.starts_with("f ")).map(str::to_string).collect::<Vec<_>>();
    assert_eq!(faces(&before), faces(&after));
    for line in after.lines().filter(|l| l.starts_with("v ")) {
        let square: f64 = numbers_after(line).iter().map(|x| x * x).sum();
        assert!((square - 1.0).abs() < 1e-14, "{line}");
    }
    assert_eq!(place.text("t.csv").lines().count(), numbers(&result["energies"]).len() + 1);
    // The long ends of the surface come to small parts of the sphere.
    place.expect(0, "flatten e.obj --energy area --sphere lh.sphere --report a.json");
    let error = |report: &serde_json::Value| report["result"]["after"]["mean_area_error"].as_f64();
    assert!(error(&place.json("a.json")) < error(&report));
}

/// Per directed edge its vector in a texture.
fn sides(text: &str) -> std::collections::HashMap<[usize; 2], [f64; 2]> {
    let at: Vec<Vec<f64>> = text.lines().filter(|l| l.starts_with("vt ")).map(numbers_after).collect();
    let mut sides = std::collections::HashMap::new();
    for line in text.lines().filter(|l| l.starts_with("f ")) {
        let corners: Vec<Vec<usize>> = line
            .split(' ')
            .skip(1)
            .map(|word| word.split('/').map(|part| part.parse::<usize>().unwrap() - 1).collect())
            .collect();
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (&corners[a], &corners[b])) {
            let (from, to) = (&at[a[1]], &at[b[1]]);
            sides.insert([a[0], b[0]], [to[0] - from[0], to[1] - from[1]]);
        }
    }
    sides
}

fn numbers_after(line: &str) -> Vec<f64> {
    line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect()
}

#[test]
fn a_torus_is_cut_open_along_seams_that_are_rotations() {
    let place = Place::new();
    place.expect(0, "make torus -n 12 -o t.obj");
    let said = place
        .expect(0, "flatten t.obj --cones auto:4 --uv flat.obj --flat f.svg --picture p.png --report r.json");
    assert!(said.out.contains("exact rotations by multiples of 90° between"), "{}", said.out);
    let text = place.text("flat.obj");
    assert!(doubled_areas(&text).iter().all(|area| *area > 0.0));
    let sides = sides(&text);
    let mut n_turned = 0;
    for (&[a, b], &[x, y]) in &sides {
        let [z, w] = sides[&[b, a]].map(|part| -part);
        assert!([[x, y], [-y, x], [-x, -y], [y, -x]].contains(&[z, w]), "{a} {b}: {x} {y} and {z} {w}");
        n_turned += usize::from([z, w] != [x, y]);
    }
    assert!(n_turned > 0);
    let result = &place.json("r.json")["result"];
    assert_eq!(result["start"].as_str(), Some("seamless"));
    assert!(!result["seams"]["cones"].as_array().unwrap().is_empty());
    let [before, after] = ["before", "after"].map(|when| result[when]["energy"].as_f64().unwrap());
    assert!(4.0 < after && after < before, "{before} to {after}");
    // A ball has no seams of its own; corners of a cube give it some.
    place.expect(0, "make sphere -n 4 -o s.obj");
    place.expect(0, "flatten s.obj --cones auto:8 --uv ball.obj");
    assert!(doubled_areas(&place.text("ball.obj")).iter().all(|area| *area > 0.0));
}

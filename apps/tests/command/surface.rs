//! `ricci surface`: solids of few faces from meshes.

use crate::run::Place;

/// A sphere-like surface and a torus become solids, with every check held and a face for each patch.
#[test]
fn closed_surfaces_become_solids_of_few_faces() {
    let place = Place::new();
    let pi = std::f64::consts::PI;
    for (shape, tolerance, most, inside) in
        [("ellipsoid", 1e-3, 6, 8.0 * pi), ("torus", 1e-3, 16, 4.0 * pi * pi)]
    {
        place.expect(0, &format!("make {shape} -o in.obj"));
        place.expect(
            0,
            &format!("surface in.obj -o out.step --tolerance {tolerance} --report r.json --patches p.json --triangles m.obj"),
        );
        let (report, text) = (place.json("r.json"), place.text("out.step"));
        let result = &report["result"];
        let faces = result["faces"].as_u64().unwrap() as usize;
        assert!(faces <= most, "{shape}: {result}");
        assert_eq!(text.matches("ADVANCED_FACE(").count(), faces, "{shape}");
        assert_eq!(text.matches("CLOSED_SHELL(").count(), 1, "{shape}");
        assert_eq!(result["bytes"].as_u64(), Some(text.len() as u64), "{shape}");
        assert!(result["max"].as_f64().unwrap() <= tolerance, "{shape}: {result}");
        assert!(result["normal_jump"].as_f64().unwrap() < 1e-6, "{shape}: {result}");
        // The mesh, whose vertices lie on the smooth surface, has less inside.
        assert!((result["volume"].as_f64().unwrap() / inside - 1.0).abs() < 1e-3, "{shape}: {result}");
        assert!((0.0..1e-2).contains(&result["volume_error"].as_f64().unwrap()), "{shape}: {result}");
        let of_triangles = volume(&place.text("m.obj"));
        assert!(
            (result["volume"].as_f64().unwrap() / of_triangles - 1.0).abs() < 4e-3,
            "{shape}: {of_triangles}"
        );
        assert_patches(&place.json("p.json"), faces);
    }
}

/// The volume inside the triangles of an OBJ file.
fn volume(text: &str) -> f64 {
    let rows = |key: &str| text.lines().filter_map(move |l| l.strip_prefix(key)).collect::<Vec<_>>();
    let points: Vec<Vec<f64>> =
        rows("v ").iter().map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect()).collect();
    let sixfold = |l: &&str| {
        let number = |corner: &str| corner.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
        let [a, b, c] = <[_; 3]>::try_from(l.split_whitespace().map(number).collect::<Vec<_>>()).unwrap();
        let (a, b, c) = (&points[a], &points[b], &points[c]);
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    rows("f ").iter().map(sixfold).sum::<f64>() / 6.0
}

/// Every patch has as many control points as its knots say, all control points are there, and none belongs to no patch.
fn assert_patches(file: &serde_json::Value, count: usize) {
    assert_eq!(file["format"], "ricci-quad-spline 1");
    let (degree, points) = (file["degree"].as_u64().unwrap(), file["control_points"].as_array().unwrap());
    let patches = file["patches"].as_array().unwrap();
    assert_eq!(patches.len(), count);
    let mut is_used = vec![false; points.len()];
    for patch in patches {
        let control = patch["control"].as_array().unwrap();
        let knots = |key: &str| patch[key].as_array().unwrap().len() as u64;
        assert_eq!(control.len() as u64 + degree + 1, knots("knots_u"));
        for row in control {
            let row = row.as_array().unwrap();
            assert_eq!(row.len() as u64 + degree + 1, knots("knots_v"));
            row.iter().for_each(|k| is_used[k.as_u64().unwrap() as usize] = true);
        }
    }
    assert!(is_used.iter().all(|&is_used| is_used));
    assert_eq!(file["creases"].as_array().unwrap().len(), 0);
}

/// Pictures of every kind are drawn, and differ.
#[test]
fn pictures_show_patches_distances_curvature_and_reflections() {
    let place = Place::new();
    place.expect(0, "make torus -n 24 -o in.obj");
    let mut known = Vec::new();
    for how in ["patches", "patches --combs", "distance", "curvature", "reflection"] {
        let line = format!(
            "surface in.obj -o out.step --tolerance 0.01 --picture p.png --draft --size 200 --color {how}"
        );
        place.expect(0, &line);
        let bytes = std::fs::read(place.path("p.png")).unwrap();
        assert!(!known.contains(&bytes), "{how}");
        known.push(bytes);
    }
}

/// Where no fit reaches the tolerance the file is written, and the check says by how much it is missed.
#[test]
fn a_tolerance_that_is_missed_is_told() {
    let place = Place::new();
    place.expect(0, "make torus -n 16 -o in.obj");
    let ended = place.expect(1, "surface in.obj -o out.step --tolerance 1e-9 --spans 1 --report r.json");
    assert!(ended.out.contains("max = ") || ended.err.contains("max = "), "{} {}", ended.out, ended.err);
    let report = place.json("r.json");
    assert_eq!(report["checks"]["max"]["holds"], false);
    assert!(place.exists("out.step"));
}

/// The Catmull–Clark surface of a cube is a solid of six faces, with the symmetries of the cube; what is no control mesh is named.
#[test]
fn control_meshes_become_solids() {
    let place = Place::new();
    let cube = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
        f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
    place.put("cube.obj", cube);
    place.expect(
        0,
        "surface cube.obj --from-quads -o out.step --tolerance 0.01 --report r.json --triangles m.obj",
    );
    let result = &place.json("r.json")["result"];
    assert_eq!((result["faces"].as_u64(), result["cones"].is_null()), (Some(6), true), "{result}");
    assert_eq!(place.text("out.step").matches("CLOSED_SHELL(").count(), 1);
    // It reaches as far to one side as to the other.
    let text = place.text("m.obj");
    let points: Vec<Vec<f64>> = text
        .lines()
        .filter_map(|l| l.strip_prefix("v "))
        .map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect())
        .collect();
    for k in 0..3 {
        let reach = points.iter().map(|p| p[k]).fold(0.0, f64::max);
        let back = points.iter().map(|p| -p[k]).fold(0.0, f64::max);
        assert!((reach - back).abs() < 1e-5, "{reach} {back}");
    }
    place.put("open.obj", &cube.replace("f 3 1 5 7\n", "f 3 1 5\nf 3 1 7\n"));
    let ended = place.expect(3, "surface open.obj --from-quads -o no.step");
    assert!(ended.err.contains("same direction"), "{}", ended.err);
    assert!(!place.exists("no.step"));
    place.expect(2, "surface cube.obj --from-quads --cones auto:8 -o no.step");
}

//! `--on input`: the layout on the input's own vertices and faces.

use crate::files::parse_obj;
use crate::run::Place;
use crate::surfaces::{genus_two, hill};

/// With `--on input` the file has the input's own vertices and faces, in order; the faces around an edge that is no seam share their points.
#[test]
fn the_inputs_own_faces_are_written_on_request() {
    let place = Place::new();
    place.put("two.obj", &genus_two(12).obj()).put("disk.obj", &hill(8).obj());
    place.expect(0, "make ellipsoid --axes 1.2 1 0.9 -n 8 -o ball.obj");
    let lines = [
        ("ball", "flow ball.obj --target auto:8"),
        ("disk", "flow disk.obj"),
        ("two", "flow two.obj"),
        ("two", "flow two.obj --space e2 --target single:3"),
        ("two", "uniformize two.obj"),
    ];
    for (name, line) in lines {
        place.expect(0, &format!("{line} --uv own.obj --on input --report r.json --quiet"));
        let own = parse_obj(&place.text("own.obj"));
        let given = place.text(&format!("{name}.obj"));
        let numbers = |kind: &str| -> Vec<[f64; 3]> {
            let lines = given.lines().filter_map(|l| l.strip_prefix(kind));
            let parse = |t: &str| t.parse::<f64>().unwrap();
            lines.map(|l| l.split_whitespace().map(parse).collect::<Vec<_>>().try_into().unwrap()).collect()
        };
        assert_eq!(own.v, numbers("v "), "{line}");
        let faces: Vec<[f64; 3]> = own.faces.iter().map(|f| f.map(|v| v as f64 + 1.0)).collect();
        assert_eq!(faces, numbers("f "), "{line}");
        let result = &place.json("r.json")["result"];
        let (seams, folds) = seams_and_folds(&own);
        assert_eq!(result["flipped_input_faces"].as_u64(), Some(folds), "{line}");
        assert!(folds as usize * 50 < own.faces.len(), "{line}: {folds} faces fold");
        let most = own.faces.len() / 4;
        assert!(seams < most, "{line}: {seams} edges on seams");
    }
    place.expect(2, "flow two.obj --charts --space e2 --target single:3 --uv own.obj --on input");
}

/// Edges inside whose two faces have their ends in different places, and faces that are not counterclockwise.
fn seams_and_folds(mesh: &crate::files::Obj) -> (usize, u64) {
    let mut known = std::collections::HashMap::new();
    let (mut seams, mut folds) = (0, 0);
    for (face, uv) in mesh.faces.iter().zip(&mesh.corners) {
        let [a, b, c] = uv.map(|k| mesh.vt[k]);
        folds += u64::from((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0);
        for k in 0..3 {
            let next = (k + 1) % 3;
            known.insert((face[k], face[next]), (uv[k], uv[next]));
            let other = known.get(&(face[next], face[k]));
            seams += usize::from(other.is_some_and(|&(p, q)| (q, p) != (uv[k], uv[next])));
        }
    }
    (seams, folds)
}

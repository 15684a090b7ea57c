//! Exit codes, refusals that say why, and that nothing half-done is left behind.

use crate::run::Place;
use crate::surfaces::{genus_two, hill, moebius, octahedron, torus};
use std::process::Stdio;
use std::time::Duration;

fn surfaces() -> Place {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj()).put("disk.obj", &hill(6).obj());
    place.put("two.obj", &genus_two(12).obj()).put("ball.obj", &octahedron().obj());
    place
}

#[test]
fn requests_that_do_not_exist_are_exit_2() {
    let place = surfaces();
    let before = place.files();
    for (line, says) in [
        ("", "Usage"),
        ("unknown", "unrecognized"),
        ("flow", "required"),
        ("flow torus.obj --space e3", "invalid value"),
        ("flow torus.obj --tolerance 0", "positive"),
        ("flow torus.obj --threads 100000", "1024"),
        ("flow torus.obj --target auto:x", "not a number of cones"),
        ("flow torus.obj --target auto:1", "torus"),
        ("flow ball.obj --target auto:2", "3 cones"),
        ("flow torus.obj --target auto:97", "96 interior"),
        ("flow torus.obj --target auto:4 --pin 3", "leave one out"),
        ("flow two.obj --target auto:4 --space h2", "e2 only"),
        ("flow ball.obj --space s2 --picture p.svg", "layout alone"),
        ("flow torus.obj --picture p.jpg", ".png or .svg"),
        ("flow torus.obj --charts --scheme tangential --circles c.json", "leave --charts or --circles out"),
        ("flow torus.obj --margin 0.1", "--charts"),
        ("flow torus.obj --charts --margin 1", "in [0, 1)"),
        ("flow two.obj --charts", "--space e2"),
        ("flow torus.obj --target boundary", "uniform"),
        ("flow disk.obj --target uniform", "boundary"),
        ("flow torus.obj --target single:96", "0 to 95"),
        ("flow torus.obj --picture p.png --zoom 96,2", "0 to 95"),
        ("flow ball.obj --space s2 --uv o.obj", "ricci uniformize"),
        ("flow torus.obj --circles c.json", "yamabe has no circles"),
        ("flow torus.obj --trace t.csv", "--method gradient"),
        ("flow torus.obj --area-normalised", "--method gradient"),
        ("flow torus.obj --pin 3,x", "not a vertex number"),
        ("flow torus.obj --pin 96", "existing vertex"),
        ("info torus.obj --threads 100000", "1024"),
        ("make torus -o m.obj --report missing/r.json", "missing does not exist"),
        ("flow torus.obj --uv o.stl", ".obj or .glb"),
        ("flow torus.obj --uv o.obj --report o.obj", "two outputs"),
        ("flow torus.obj --uv missing/o.obj --report r.json", "missing does not exist"),
        ("flow torus.obj --report .", "directory"),
        ("completions klingon", "invalid value"),
    ] {
        let ended = place.expect(2, line);
        assert!((ended.err + &ended.out).contains(says), "{line}");
    }
    assert_eq!(place.files(), before);
}

#[test]
fn surfaces_that_cannot_be_are_exit_3() {
    let place = surfaces();
    place.put("pair.obj", &octahedron().beside(torus(6, 6)).obj()).put("band.obj", &moebius(12).obj());
    place.put("none.obj", "").put("torn.off", "OFF\n3 1 0\n0 0 0\n");
    place.put("far.csv", "200,1\n").put("total.csv", "0,0.5\n").put("steep.csv", "0,6.5\n1,-6.5\n");
    for (line, says) in [
        ("flow pair.obj", "repair --component"),
        ("flow band.obj", "non-orientable"),
        ("flow none.obj", "no faces"),
        ("flow torn.off", "torn.off:"),
        ("flow missing.obj", "missing.obj"),
        ("flow disk.step", "unknown format"),
        ("flow torus.obj --target cones:missing.csv", "missing.csv"),
        ("flow torus.obj --target cones:far.csv", "far.csv:1: vertex 200"),
        ("flow torus.obj --target file:total.csv", "vertex 1 is missing"),
        ("flow torus.obj --target cones:total.csv", "off by 5.0000e-1"),
        ("flow torus.obj --target cones:steep.csv", "too large by 2.16"),
        ("flow ball.obj --target single:3", "vertex 3"),
    ] {
        let ended = place.expect(3, line);
        assert!(ended.err.contains(says), "{line}: {}", ended.err);
    }
}

#[test]
fn metric_files_are_not_trusted() {
    let place = Place::new();
    let tetrahedron = "[[0,1,2],[0,3,1],[0,2,3],[1,3,2]]";
    let unit = "[[1,1,1],[1,1,1],[1,1,1],[1,1,1]]";
    let file = |faces: &str, lengths: &str, more: &str| {
        format!(r#"{{"faces": {faces}, "lengths": {lengths}{more}}}"#)
    };
    place.put("m.json", &file(tetrahedron, unit, ""));
    place.expect(0, "flow m.json");
    // Two triangles on the same vertices: with their gluing they are a sphere.
    let gluing = r#", "face_edges": [[1,2,3],[-1,-3,-2]]"#;
    place.put("m.json", &file("[[0,1,2],[0,2,1]]", "[[1,1,1],[1,1,1]]", gluing));
    place.expect(0, "info m.json");
    for (text, says) in [
        ("{".to_string(), "EOF"),
        (file(tetrahedron, "[[1,1,1]]", ""), "1 entries"),
        (file("[[0,1,-2]]", "[[1,1,1]]", ""), "invalid value"),
        (file("[[0,1,4294967296]]", "[[1,1,1]]", ""), "4294967296"),
        (file("[[0,1,4294967294]]", "[[1,1,1]]", ""), "at most 3 vertices"),
        (file("[[0,1]]", "[[1,1,1]]", ""), "invalid length"),
        (file(tetrahedron, "[[1,1,1],[1,1,1],[1,1,1],[1,1,1.5]]", ""), "face 3: side 1–3"),
        (file(tetrahedron, "[[1,1,1],[1,1,0],[1,1,1],[1,1,1]]", ""), "face 1: side 0–3"),
        (file("[[0,1,2]]", "[[1,1,5]]", ""), "face 0 breaks the triangle inequality"),
        (file("[[0,1,2]]", "[[1,1,null]]", ""), "invalid type"),
        (file("[[0,1,2]]", "[[1,1,1e999]]", ""), "out of range"),
        (file("[]", "[]", ""), "no faces"),
        (file("[[0,1,2],[0,2,1]]", "[[1,1,1],[1,1,1]]", ""), "face 1 repeats face 0"),
        (file("[[0,1,2],[0,2,1]]", "[[1,1,1],[1,1,1]]", ""), "need `face_edges`"),
        (file("[[0,0,0]]", "[[1,1,1]]", ""), "need `face_edges`"),
        (file(tetrahedron, unit, r#", "input_geometry": "e4""#), "input_geometry"),
        (file(tetrahedron, unit, r#", "face_edges": [[1,2,3]]"#), "face_edges"),
        (file("[[0,0,0]]", "[[1,1,1]]", r#", "face_edges": [[1,1,1]]"#), "face 0"),
        (file("[[0,1,2]]", "[[1,1,1]]", r#", "face_edges": [[1,2,2147483647]]"#), "face 0"),
        (file("[[0,1,2]]", "[[1,1,1]]", r#", "face_edges": [[1,2,-2147483648]]"#), "face 0"),
    ] {
        place.put("m.json", &text);
        let ended = place.expect(3, "flow m.json");
        assert!(ended.err.contains(says), "{text}: {}", ended.err);
    }
}

#[test]
fn a_flow_that_breaks_is_exit_1_and_says_so() {
    let place = Place::new();
    // The six angles at vertex 40 would have to add up to 6π.
    place.put("two.obj", &genus_two(12).obj());
    let ended = place.expect(
        1,
        "flow two.obj --flips never --space e2 --target single:40 --report r.json --metric m.json --uv o.obj",
    );
    assert!(ended.out.contains("FAILED"), "{}", ended.out);
    let report = place.json("r.json");
    assert_eq!(report["result"]["converged"], false);
    assert_ne!(report["result"]["stop_reason"], "converged");
    assert!(report["result"]["broken_triangles"].as_u64().unwrap() > 0);
    assert_eq!(report["checks"]["broken_triangles"]["holds"], false);
    assert!(report["result"]["no_layout"].as_str().unwrap().contains("break"));
    assert!(place.exists("m.json") && !place.exists("o.obj"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_is_exit_4_and_leaves_nothing() {
    let place = surfaces();
    let before = place.files();
    // Out of reach: the flow ends only when it is told to.
    let line = "flow torus.obj --method gradient --tolerance 1e-300 --trace t.csv --report r.json";
    let child = place.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(500));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(4), "{}", String::from_utf8_lossy(&ended.stderr));
    assert_eq!(place.files(), before);
}

#[test]
fn every_command_has_help_with_an_example_and_completions_exist() {
    let place = Place::new();
    let help = place.expect(0, "help").out;
    for command in ["info", "repair", "flow", "uniformize", "cover", "make", "demo", "completions"] {
        assert!(help.contains(&format!("\n  {command} ")), "{command}");
        let one = place.expect(0, &format!("help {command}")).out;
        assert!(one.contains("Example") && one.contains(&format!("ricci {command}")), "{command}");
    }
    for later in ["harmonic", "forms", "match", "structure", "spline"] {
        assert!(!help.contains(&format!("\n  {later}")), "{later}");
        place.expect(2, later);
    }
    for shell in ["bash", "zsh", "fish"] {
        assert!(place.expect(0, &format!("completions {shell}")).out.contains("tolerance"));
    }
}

#[test]
fn quiet_says_nothing() {
    let place = surfaces();
    let ended = place.expect(0, "flow torus.obj --quiet --metric m.json");
    assert!(ended.out.is_empty() && ended.err.is_empty());
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_permissions_and_its_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = surfaces();
    let at = |name: &str| place.path(name);
    for name in ["real.obj", "real.json"] {
        std::fs::write(at(name), "old").unwrap();
        std::fs::set_permissions(at(name), std::fs::Permissions::from_mode(0o600)).unwrap();
        symlink(name, at(&format!("link-{name}"))).unwrap();
    }
    place.expect(0, "repair torus.obj -o link-real.obj --report link-real.json");
    for name in ["real.obj", "real.json"] {
        assert!(std::fs::symlink_metadata(at(&format!("link-{name}"))).unwrap().is_symlink(), "{name}");
        let file = std::fs::metadata(at(name)).unwrap();
        assert!(file.len() > 100 && file.permissions().mode() & 0o777 == 0o600, "{name}");
    }
}

#[test]
fn no_output_takes_the_place_of_an_input_or_of_another_output() {
    let place = surfaces();
    place.put("soup.obj", &place.text("torus.obj")).put("cones.csv", "0,0\n").put("edges.csv", "0,1\n");
    place.expect(0, "make bolza --level 1 -o b.json --quiet");
    let before: Vec<_> = place.files().iter().map(|name| place.text(name)).collect();
    for (line, says) in [
        ("flow torus.obj --uv torus.obj", "the output torus.obj is the input torus.obj"),
        ("flow torus.obj --uv ./torus.obj", "the output ./torus.obj is the input torus.obj"),
        (
            "flow torus.obj --target cones:cones.csv --method gradient --trace cones.csv",
            "the input cones.csv",
        ),
        ("flow torus.obj --keep-edges edges.csv --method gradient --trace edges.csv", "the input edges.csv"),
        ("flow b.json --metric b.json", "the input b.json"),
        ("uniformize b.json --generators b.json", "the input b.json"),
        ("uniformize two.obj --uv two.obj", "the input two.obj"),
        ("cover two.obj --cover two.obj", "the input two.obj"),
        ("repair soup.obj -o soup.obj", "the input soup.obj"),
        ("info b.json --report b.json", "the input b.json"),
        ("flow torus.obj --metric m.json --report ./m.json", "two outputs"),
        ("repair soup.obj -o s.ply --map m.json --report m.json", "two outputs"),
        ("make torus -o t.obj --report t.obj", "two outputs"),
    ] {
        let ended = place.expect(2, line);
        assert!(ended.err.contains(says), "{line}: {}", ended.err);
    }
    let after: Vec<_> = place.files().iter().map(|name| place.text(name)).collect();
    assert!(before == after);
}

#[cfg(unix)]
#[test]
fn a_link_to_an_input_is_that_input() {
    let place = surfaces();
    std::os::unix::fs::symlink("torus.obj", place.path("link.obj")).unwrap();
    let ended = place.expect(2, "flow torus.obj --uv link.obj");
    assert!(ended.err.contains("link.obj is the input torus.obj"), "{}", ended.err);
}

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

/// Start a command, interrupt it once it catches Ctrl-C and `is_ready` of its directory, and insist that it is cancelled without a trace.
/// Nothing is timed: a command that does not end hangs the test.
#[cfg(target_os = "linux")]
fn interrupt(place: &Place, line: &str, is_ready: impl Fn(&Place) -> bool) {
    let before = place.files();
    let mut command = place.command(line);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Signal 2 is the second bit of the mask of caught signals.
    let catches = |status: &str| {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap().trim();
        u64::from_str_radix(mask, 16).unwrap() & 0b10 != 0
    };
    let status = format!("/proc/{}/status", child.id());
    while !(catches(&std::fs::read_to_string(&status).unwrap()) && is_ready(place)) {
        assert!(child.try_wait().unwrap().is_none(), "ricci {line} has ended by itself");
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    // Its stdin stays open until it has ended.
    let stdin = child.stdin.take();
    let ended = child.wait_with_output().unwrap();
    drop(stdin);
    assert_eq!(ended.status.code(), Some(4), "ricci {line}");
    // The work and the handler of Ctrl-C may both have come to say so.
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(
        !said.is_empty() && said.lines().all(|line| line == "ricci: cancelled; nothing was written"),
        "{said}"
    );
    assert_eq!(place.files(), before);
}

/// A flow whose tolerance is out of reach ends only when it is told to, by looking at its control.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_is_exit_4_and_leaves_nothing() {
    let line = "flow torus.obj --method gradient --tolerance 1e-300 --trace t.csv --report r.json";
    interrupt(&surfaces(), line, |_| true);
}

/// Work that never looks at its control, as reading from a pipe on which nothing comes, is left where it is.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_ends_work_that_does_not_look() {
    interrupt(&surfaces(), "flow - --uv o.obj --report r.json", |_| true);
}

/// A picture of 4096 pixels takes many seconds, in which the drafts of the other files lie beside their destinations.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_removes_the_drafts_of_files() {
    let line = "flow torus.obj --size 4096 --threads 1 --uv o.obj --picture p.png";
    let has_drafts = |place: &Place| place.files().iter().any(|name| name.starts_with(".ricci-"));
    interrupt(&surfaces(), line, has_drafts);
}

#[test]
fn what_cannot_be_made_is_named_and_the_rest_is_written() {
    let place = surfaces();
    let files = "--uv o.obj --xref x.csv --metric m.json --picture p.svg --report r.json";
    let broken = "flow two.obj --flips never --space e2 --target single:40";
    let ended = place.expect(1, &format!("{broken} {files}"));
    let failed = &place.json("r.json")["result"]["failed"];
    for wish in ["uv", "xref", "picture"] {
        assert!(failed[wish].as_str().unwrap().contains("triangle inequality"), "{wish}: {failed}");
        assert!(ended.out.contains(&format!("--{wish}")), "{}", ended.out);
    }
    assert!(
        place.exists("m.json") && !place.exists("o.obj") && !place.exists("x.csv") && !place.exists("p.svg")
    );
    // Only where they were off is it advised to allow flips.
    place.put("thin.obj", "v 0 0 0\nv 1 0 0\nv 0.5 1e-6 0\nv 0.5 1 0\nf 1 2 3\nf 2 4 3\nf 4 1 3\n");
    let flips = |flips: &str| {
        place.run(&format!("flow thin.obj --target boundary --max-iterations 1 --flips {flips}")).out
    };
    assert!(flips("never").contains("or allow flips"), "{}", flips("never"));
    assert!(!flips("auto").contains("or allow flips"), "{}", flips("auto"));
}

#[test]
fn bad_input_is_reported_too() {
    let place = surfaces();
    place.put("pair.obj", &octahedron().beside(torus(6, 6)).obj()).put("torn.off", "OFF\n3 1 0\n0 0 0\n");
    for command in ["flow", "uniformize", "cover"] {
        place.expect(3, &format!("{command} pair.obj --report r.json"));
        let report = place.json("r.json");
        assert_eq!(report["command"], command);
        assert_eq!(report["input"]["components"], 2);
        assert_eq!(report["result"]["error"]["exit_code"], 3);
        assert_eq!(report["result"]["error"]["defects"][0]["code"], "several_components");
        std::fs::remove_file(place.path("r.json")).unwrap();
    }
    place.expect(3, "flow torn.off --report r.json");
    assert!(place.json("r.json")["result"]["error"]["message"].as_str().unwrap().contains("torn.off"));
    place.expect(2, "flow torus.obj --target boundary --report none.json");
    assert!(!place.exists("none.json"));
}

#[test]
fn numbers_are_those_that_people_write() {
    let place = surfaces();
    // A byte order mark.
    place.put("cones.csv", "\u{feff}vertex,curvature\n3,0.5\n9,-0.5\n");
    place.expect(0, "flow torus.obj --target cones:cones.csv --quiet");
    let ended = place.expect(2, "flow torus.obj --pin boundary");
    assert!(ended.err.contains("closed surface"), "{}", ended.err);
    assert!(place.expect(0, "flow torus.obj --target auto:4").out.contains("target auto:4"));
    for line in ["flow torus.obj --view 10,20", "flow torus.obj --up x", "uniformize two.obj --view 10,20"] {
        let ended = place.expect(2, &format!("{line} --picture p.svg"));
        assert!(ended.err.contains("--view"), "{}", ended.err);
    }
    place.put("far.obj", &place.text("ball.obj").replacen("v 1 0 0", "v 1e300 0 0", 1));
    let ended = place.expect(3, "flow far.obj");
    assert!(ended.err.contains("1e300 is outside the range") && !ended.err.contains("area"), "{}", ended.err);
    let out = place.expect(0, "info far.obj").out;
    assert!(out.contains("outside the range") && !out.contains("zero area"), "{out}");
    let out = place.expect(0, "info torus.obj").out;
    let area = out.lines().find_map(|line| line.strip_prefix("area ")).unwrap();
    assert!(!area.split(',').next().unwrap().contains('e'), "{area}");
    place.put("empty.obj", "");
    assert!(place.expect(1, "repair empty.obj -o o.obj").out.contains("is empty"));
    for (line, says) in [("help flow", "numbered from 0"), ("help uniformize", "numbered from 0")] {
        assert!(place.expect(0, line).out.contains(says), "{line}");
    }
    place.put("cones.csv", "96,0.5\n");
    let ended = place.expect(3, "flow torus.obj --target cones:cones.csv");
    assert!(ended.err.contains("numbered from 0"), "{}", ended.err);
}

#[test]
fn every_command_has_help_with_an_example_and_completions_exist() {
    let place = Place::new();
    let help = place.expect(0, "help").out;
    let commands = [
        "info",
        "repair",
        "flow",
        "uniformize",
        "cover",
        "circles",
        "harmonic",
        "forms",
        "lengths",
        "match",
        "structure",
        "spline",
        "view",
        "make",
        "demo",
        "completions",
    ];
    for command in commands {
        assert!(help.contains(&format!("\n  {command} ")), "{command}");
        let one = place.expect(0, &format!("help {command}")).out;
        assert!(one.contains("Example") && one.contains(&format!("ricci {command}")), "{command}");
    }
    place.expect(2, "match");
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

//! Spline files come back bit for bit; truncated and tampered ones are refused by name.

use crate::spline::{random_surface, space};
use ricci::Error;
use ricci::spline::{Parameter, Spline};

#[test]
fn files_come_back_bit_for_bit_and_bad_ones_have_names() {
    let surface = random_surface(&space(3, 3));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    surface.write(&path).unwrap();
    let again = Spline::read(&path).unwrap();
    assert_eq!(again.to_json(), surface.to_json());
    let at = Parameter { patch: 3, x: 0.5, y: 0.2 };
    assert_eq!(again.point(at), surface.point(at));
    let text = surface.to_json();
    let refused = |text: &str| Spline::from_json(text, "s.json").unwrap_err().to_string();
    assert!(
        refused(&text[..text.len() / 2]).starts_with("s.json:1: "),
        "{}",
        refused(&text[..text.len() / 2])
    );
    assert!(refused(&text.replace("ricci-spline 1", "ricci-spline 9")).contains("ricci-spline 9"));
    assert!(refused(&text.replacen("\"degree\":3", "\"degree\":4", 1)).contains("knots"));
    assert!(
        refused(&text.replacen("\"control\":[0,", "\"control\":[4000000000,", 1)).contains("control point")
    );
    assert!(refused(&text.replacen("\"patch\":0,", "\"patch\":77,", 1)).contains("patch 77"));
    assert!(refused(&text.replacen("[1.0,0.0,0.0]", "[-1.0, 0.0, 0.0]", 1)).contains("turns the plane over"));
    assert!(refused("{}").contains("format"));
}

fn refusal(text: &str) -> Error {
    match Spline::from_json(text, "s.json") {
        Err(error) => error,
        Ok(_) => panic!("accepted: {}", &text[..text.len().min(300)]),
    }
}

#[test]
fn every_end_of_a_file_is_missed() {
    let text = random_surface(&space(1, 2)).to_json();
    for end in 0..text.trim_end().len() {
        assert!(matches!(refusal(&text[..end]), Error::Parse { .. }), "{end}");
    }
}

#[test]
fn tampered_numbers_are_refused_by_name() {
    let text = random_surface(&space(2, 2)).to_json();
    let with = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        refusal(&text.replacen(from, to, 1))
    };
    let first = text.split("\"knots\":[[[").nth(1).unwrap().split(']').next().unwrap().to_string();
    let knot = |to: &str| with(&format!("\"knots\":[[[{first}]"), &format!("\"knots\":[[[{to}]"));
    assert!(matches!(knot("1e999, 0.0"), Error::Parse { .. }));
    assert!(matches!(knot("NaN, 0.0"), Error::Parse { .. }));
    for far in ["1e300, 0.0", "1e80, -1e80", "0.5, 0.9"] {
        assert!(matches!(knot(far), Error::Spline { what: "patch", index: 0, .. }), "{far}");
    }
    let is_patch = |error: Error| matches!(error, Error::Spline { what: "patch", .. });
    // Numbers that do not exist, and counts that do not fit.
    assert!(is_patch(with("\"supports\":[[{\"patch\":0", "\"supports\":[[{\"patch\":8")));
    assert!(matches!(with("\"control\":[0,", "\"control\":["), Error::Size { .. }));
    assert!(matches!(with("\"control\":[0,", "\"control\":[0, 0, "), Error::Size { .. }));
    assert!(matches!(with("\"control\":[0,", "\"control\":[25, "), Error::Size { expected: 26, .. }));
    assert!(matches!(with("\"control\":[0,", "\"control\":[4294967295, "), Error::Argument { .. }));
    assert!(matches!(with("\"supports\":[[", "\"supports\":[[],["), Error::Size { what: "supports", .. }));
    assert!(matches!(with("\"control_points\":[", "\"control_points\":[[0, 0, 0], "), Error::Size { .. }));
    for huge in ["99999999999999999999", &"9".repeat(4000), "-3", "2.5", "1e9"] {
        assert!(matches!(with("\"degree\":2", &format!("\"degree\":{huge}")), Error::Parse { .. }));
        assert!(matches!(with("\"chart\":0", &format!("\"chart\":{huge}")), Error::Parse { .. }));
    }
    for degree in [0, 6, 4_000_000_000u32] {
        assert!(matches!(
            with("\"degree\":2", &format!("\"degree\":{degree}")),
            Error::Argument { what: "degree", .. }
        ));
    }
    // Maps that turn over, collapse, or leave the range of f64.
    for map in [
        "1.0, 0.0, 0.0], [0.0, -1.0, 0.0",
        "0.0, 0.0, 0.0], [0.0, 0.0, 0.0",
        "1e-320, 0.0, 1e300], [0.0, 1.0, 0.0",
    ] {
        assert!(is_patch(with("1.0,0.0,0.0],[0.0,1.0,0.0", map)), "{map}");
    }
    let point = text.split("\"control_points\":[[").nth(1).unwrap().split(',').next().unwrap().to_string();
    assert!(matches!(
        with(&format!("\"control_points\":[[{point},"), "\"control_points\":[[1e200,"),
        Error::Spline { what: "control point", index: 0, .. }
    ));
    // Nesting without end.
    assert!(matches!(refusal(&"[".repeat(100_000)), Error::Parse { .. }));
    // All knots in one place.
    let one = "[[0.0, 0.0], [0.0, 0.0]]";
    let control = "[0, 1, 2]";
    let flat = format!(
        "{{\"format\":\"ricci-spline 1\",\"degree\":1,\"patches\":[{{\"chart\":0,\"knots\":[{one},{one},{one}],\"control\":{control}}}],\
         \"supports\":[[]],\"control_points\":[[0,0,0],[0,0,0],[0,0,0]],\"hole\":null}}"
    );
    assert!(is_patch(refusal(&flat)));
}

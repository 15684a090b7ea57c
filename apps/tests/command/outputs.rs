//! Outputs that are no regular files, `-`, and what becomes of a file that is there already.

#![cfg(unix)]

use crate::run::Place;
use crate::surfaces::torus;
use std::fs;
use std::io::Write;
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::process::Stdio;

fn place() -> Place {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj());
    place
}

#[test]
fn pipes_and_devices_are_written_to_and_stay_what_they_are() {
    let place = place();
    let fifo = place.path("fifo");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let reader = std::thread::spawn(move || fs::read_to_string(fifo).unwrap());
    place.expect(0, "flow torus.obj --report fifo --quiet");
    let report: serde_json::Value = serde_json::from_str(&reader.join().unwrap()).unwrap();
    assert_eq!(report["result"]["converged"], true);
    assert!(fs::metadata(place.path("fifo")).unwrap().file_type().is_fifo());
    place.expect(0, "flow torus.obj --report /dev/null --quiet");
    let ended = place.expect(1, "flow torus.obj --report /dev/full --quiet");
    assert!(ended.err.contains("/dev/full"), "{}", ended.err);
    for device in ["/dev/null", "/dev/full"] {
        assert!(fs::metadata(device).unwrap().file_type().is_char_device(), "{device}");
    }
}

#[test]
fn standard_input_and_output_have_a_name() {
    let place = place();
    let given = place.text("torus.obj");
    place.expect(0, "flow torus.obj --uv own.obj --quiet");
    place.expect(0, "repair torus.obj -o torus.off --quiet");
    place.expect(0, "repair torus.obj -o torus.ply --quiet");
    let through = |line: &str, input: &[u8]| {
        let mut child = place
            .command(line)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(input).unwrap();
        let ended = child.wait_with_output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        assert_eq!(ended.status.code(), Some(0), "{line}: {}", text(ended.stderr));
        (text(ended.stdout), text(ended.stderr))
    };
    // Where a file goes to stdout the summary does not.
    for output in ["-", "/dev/stdout"] {
        let (out, err) = through(&format!("flow - --uv {output}"), given.as_bytes());
        assert!(out == place.text("own.obj") && err.contains("checks   all hold"), "{output}: {err}");
    }
    for name in ["torus.obj", "torus.off", "torus.ply"] {
        let (out, _) = through("info - --report -", &fs::read(place.path(name)).unwrap());
        let report: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!(report["input"]["vertices"], 96, "{name}");
    }
    let (metric, _) = through("flow torus.obj --metric - --quiet", b"");
    let (again, _) = through("flow - --metric - --quiet", metric.as_bytes());
    assert!(again.contains("\"scheme\":\"yamabe\""));
    let (mesh, _) = through("make torus -n 6 -o - --quiet", b"");
    assert!(mesh.starts_with("v ") || mesh.starts_with('#'), "{mesh}");
    let ended = place.expect(2, "flow torus.obj --uv - --report -");
    assert!(ended.err.contains("two outputs"), "{}", ended.err);
}

#[test]
fn a_write_protected_file_is_not_replaced() {
    let place = place();
    place.put("kept.json", "old");
    fs::set_permissions(place.path("kept.json"), fs::Permissions::from_mode(0o400)).unwrap();
    let ended = place.expect(2, "flow torus.obj --report kept.json");
    assert!(ended.err.contains("write-protected"), "{}", ended.err);
    assert_eq!(place.text("kept.json"), "old");
}

#[test]
fn errors_of_stdout_are_exit_1_and_a_reader_that_goes_away_is_none() {
    let place = place();
    for line in ["info torus.obj", "flow torus.obj", "completions bash"] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let ended = place.command(line).stdout(full).output().unwrap();
        assert_eq!(ended.status.code(), Some(1), "{line}");
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        assert_eq!(place.command(line).stdout(writer).status().unwrap().code(), Some(0), "{line}");
    }
}

//! The rules of ARCHITECTURE.md, read off the tree.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Floors from the ground up; those of one line are siblings that do not import each other.
const FLOORS: &[&[&str]] = &[
    &["error", "control", "parallel"],
    &["geometry", "linalg"],
    &["mesh"],
    &["topology"],
    &["metric"],
    &["flow"],
    &["embed", "harmonic"],
    &["canonical"],
    &["matching"],
    &["structure"],
    &["spline"],
];
/// The one arrow that points up: the error type carries a mesh's diagnosis.
const EXCEPTION: (&str, &str) = ("error", "mesh");
/// Longest file that may still hold one idea.
const MOST_LINES: usize = 450;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap()
}

/// Files below a folder, as paths from the root.
fn files(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(path.strip_prefix(root()).unwrap().to_string_lossy().into_owned());
            }
        }
    }
    found.sort();
    found
}

fn rust_files(folder: &str) -> Vec<String> {
    files(folder).into_iter().filter(|f| f.ends_with(".rs")).collect()
}

fn level(floor: &str) -> Option<usize> {
    FLOORS.iter().position(|names| names.contains(&floor))
}

/// Floors that a source text names as `crate::floor` (also inside braces), comments aside.
fn imports(source: &str) -> BTreeSet<String> {
    let code: String =
        source.lines().map(|l| l.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
    let mut found = BTreeSet::new();
    for part in code.split("crate::").skip(1) {
        let part = part.trim_start();
        let list = match part.strip_prefix('{') {
            Some(inner) => inner.split('}').next().unwrap_or("").split(',').map(str::trim).collect(),
            None => vec![part],
        };
        for name in list {
            let name: String = name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if level(&name).is_some() {
                found.insert(name);
            }
        }
    }
    found
}

/// The floors among `names` that `floor` may not import.
fn upward(floor: &str, names: &BTreeSet<String>) -> Vec<String> {
    let own = level(floor).unwrap();
    let allowed = |name: &String| {
        name == floor
            || (floor, name.as_str()) == EXCEPTION
            || level(name).unwrap() < own
            || own == 0 && level(name) == Some(0)
    };
    names.iter().filter(|n| !allowed(n)).cloned().collect()
}

#[test]
fn imports_point_down() {
    for file in rust_files("src").iter().filter(|f| *f != "src/lib.rs") {
        let floor = file.split('/').nth(1).unwrap().trim_end_matches(".rs");
        assert!(level(floor).is_some(), "{file} is on no floor");
        let wrong = upward(floor, &imports(&text(file)));
        assert!(wrong.is_empty(), "{file} on floor {floor} imports {wrong:?}");
    }
}

#[test]
fn an_arrow_that_points_up_is_seen() {
    let source = "use crate::mesh::Mesh;\nuse crate::{error::Error, flow};\n// use crate::embed;\n";
    let names = imports(source);
    assert_eq!(names, ["error", "flow", "mesh"].map(String::from).into());
    assert_eq!(upward("topology", &names), ["flow"]);
    assert_eq!(upward("linalg", &["geometry".to_string()].into()), ["geometry"]);
    assert!(upward("error", &["mesh".to_string()].into()).is_empty());
}

#[test]
fn the_c_face_and_the_command_are_siblings() {
    for (folder, other) in [("capi", "ricci_apps"), ("apps", "ricci_c")] {
        for file in rust_files(folder) {
            assert!(!text(&file).contains(&format!("{other}::")), "{file} imports {other}");
        }
        assert!(
            !text(&format!("{folder}/Cargo.toml")).contains(&format!("{}.path", other.replace('_', "-")))
        );
    }
}

#[test]
fn unsafe_and_printing_stay_out_of_the_library() {
    for file in rust_files("src").into_iter().chain(rust_files("apps/src")) {
        let source = text(&file);
        let code = source.lines().map(|l| l.split("//").next().unwrap_or(""));
        assert!(!code.clone().any(|l| l.contains("unsafe ")), "{file} has unsafe code; it belongs to capi");
    }
    for file in rust_files("src").into_iter().chain(rust_files("capi/src")) {
        let source = text(&file);
        let code = source.split("#[cfg(test)]").next().unwrap_or("");
        for word in ["println!", "print!(", "dbg!", "process::exit", ".unwrap()", "panic!(", "todo!"] {
            let debug = file == "capi/src/debug.rs" && word == "panic!(";
            let found = code.lines().any(|l| !l.trim_start().starts_with("//") && l.contains(word));
            assert!(debug || !found, "{file} uses {word}");
        }
    }
}

#[test]
fn files_hold_one_idea() {
    for folder in ["src", "capi", "apps", "tests", "benches", "examples"] {
        for file in
            files(folder).into_iter().filter(|f| [".rs", ".c", ".cpp", ".py"].iter().any(|e| f.ends_with(e)))
        {
            let lines = text(&file).lines().count();
            assert!(lines <= MOST_LINES, "{file} has {lines} lines");
        }
    }
}

#[test]
fn the_map_lists_every_file_and_no_other() {
    let map = text("ARCHITECTURE.md");
    let listed: BTreeSet<&str> =
        map.lines().filter_map(|l| l.strip_prefix("- `")?.split('`').next()).collect();
    for folder in ["src", "capi", "apps", "include", "cmake", "tests", "benches", "examples", "docs"] {
        for file in files(folder) {
            let made = file.ends_with(".png")
                || file.contains("__pycache__")
                || file.contains("proptest-regressions");
            assert!(made || listed.contains(file.as_str()), "{file} is missing in ARCHITECTURE.md");
        }
    }
    for file in listed {
        assert!(Path::new(&root().join(file)).exists(), "ARCHITECTURE.md lists {file}, which does not exist");
    }
}

#[test]
fn readme_shows_the_example_that_is_compiled() {
    let example = text("examples/c/readme.c");
    assert!(example.lines().count() <= 25);
    assert!(text("README.md").contains(&example));
}

/// Licences that may ship; an SPDX expression passes if one of its alternatives is made of these.
const PERMISSIVE: &[&str] = &[
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Zlib",
    "ISC",
    "Unicode-3.0",
    "CC0-1.0",
    "BSL-1.0",
    "0BSD",
    "Unlicense",
    "MIT-0",
];

fn permissive(licence: &str) -> bool {
    let licence = licence.replace('/', " OR ").replace(['(', ')'], " ");
    // `A AND B` needs both; exceptions (`WITH`) only add permissions.
    let word = |w: &str| PERMISSIVE.contains(&w.split(" WITH ").next().unwrap_or("").trim());
    licence.split(" OR ").any(|side| side.split(" AND ").all(word))
        || licence.split(" AND ").all(|side| side.split(" OR ").any(word))
}

#[test]
fn everything_that_ships_is_permissive_and_every_direct_dependency_is_explained() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let tree = |arguments: &[&str]| {
        let output = Command::new(&cargo).current_dir(root()).arg("tree").args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let shipped =
        tree(&["--workspace", "--edges", "normal", "--prefix", "none", "--format", "{p}|{l}", "--locked"]);
    let mut count = 0;
    for line in shipped.lines().filter(|l| l.contains('|')) {
        let (package, licence) = line.rsplit_once('|').unwrap();
        assert!(permissive(licence.trim_end_matches(" (*)").trim()), "{package} is under {licence}");
        count += 1;
    }
    assert!(count > 30, "only {count} packages seen");
    assert!(
        !permissive("GPL-3.0") && !permissive("MPL-2.0") && permissive("(MIT OR GPL-2.0) AND Unicode-3.0")
    );
    let page = text("docs/dependencies.md");
    for name in
        tree(&["--workspace", "--depth", "1", "--prefix", "none", "--format", "{p}", "--locked"]).lines()
    {
        let name = name.split(' ').next().unwrap_or("");
        assert!(
            name.is_empty()
                || name.starts_with("ricci")
                || name.starts_with('[')
                || page.contains(&format!("**{name}**")),
            "{name} is not in docs/dependencies.md"
        );
    }
}

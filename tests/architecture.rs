//! Checks the rules of ARCHITECTURE.md against the files of the repository.
#![allow(clippy::unwrap_used)]

#[path = "architecture/modules.rs"]
mod modules;
#[path = "architecture/names.rs"]
mod names;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Command;

/// The floors from the lowest up. Floors of one line do not import each other.
const FLOORS: &[&[&str]] = &[
    &["error", "control", "parallel"],
    &["archive"],
    &["geometry", "linalg"],
    &["mesh"],
    &["topology"],
    &["metric"],
    &["flow"],
    &["embed", "harmonic"],
    &["canonical", "seamless"],
    &["flatten", "moduli", "quads"],
    &["matching", "texture"],
    &["structure"],
    &["spline"],
    &["records"],
];
/// The one import that points up: the error type contains a mesh's diagnosis.
const EXCEPTION: (&str, &str) = ("error", "mesh::check::Diagnosis");
/// Most lines of a file.
const MOST_LINES: usize = 450;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap()
}

/// The files below a folder, as paths from the root.
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

/// Adds the paths at the head of `text` to `found`, with `prefix` in front, groups expanded: `a::{B, c::D}` gives `a::B` and
/// `a::c::D`. Returns the rest of the text.
fn open<'a>(text: &'a str, prefix: &str, found: &mut BTreeSet<String>) -> &'a str {
    let text = text.trim_start();
    if let Some(mut inside) = text.strip_prefix('{') {
        loop {
            let rest = open(inside, prefix, found);
            match rest.find([',', '}']) {
                Some(end) if rest[end..].starts_with(',') => inside = &rest[end + 1..],
                Some(end) => return &rest[end + 1..],
                None => return "",
            }
        }
    }
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    let (name, rest) = text.split_at(end);
    let path = if prefix.is_empty() { name.to_string() } else { format!("{prefix}::{name}") };
    match rest.trim_start().strip_prefix("::") {
        Some(more) if !name.is_empty() => open(more, &path, found),
        _ => {
            found.insert(path);
            rest
        }
    }
}

/// The paths into floors that a source text names from the crate's root, comments left out: by `crate::`, by `ricci::`, or by as
/// many `super::` as lead out of a module `depth` below the root.
fn imports(source: &str, depth: usize) -> BTreeSet<String> {
    let code: String =
        source.lines().map(|l| l.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
    let mut found = BTreeSet::new();
    for root in ["crate::", "ricci::", "super::"] {
        for (at, _) in code.match_indices(root) {
            if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let mut rest = &code[at + root.len()..];
            let mut up = 1;
            while let Some(more) = rest.strip_prefix("super::") {
                (rest, up) = (more, up + 1);
            }
            if root != "super::" || up >= depth {
                open(rest, "", &mut found);
            }
        }
    }
    found.retain(|path| level(floor_of(path)).is_some());
    found
}

/// The first name of a path.
fn floor_of(path: &str) -> &str {
    path.split("::").next().unwrap_or("")
}

/// The paths among `names` that `floor` may not import.
fn upward(floor: &str, names: &BTreeSet<String>) -> Vec<String> {
    let own = level(floor).unwrap();
    let allowed = |path: &String| {
        let to = floor_of(path);
        to == floor
            || (floor, path.as_str()) == EXCEPTION
            || level(to).unwrap() < own
            || own == 0 && level(to) == Some(0)
    };
    names.iter().filter(|n| !allowed(n)).cloned().collect()
}

#[test]
fn imports_point_down() {
    for file in rust_files("src").iter().filter(|f| *f != "src/lib.rs") {
        let floor = file.split('/').nth(1).unwrap().trim_end_matches(".rs");
        assert!(level(floor).is_some(), "{file} is on no floor");
        let module = file.trim_end_matches(".rs").trim_end_matches("/mod");
        let wrong = upward(floor, &imports(&text(file), module.split('/').count() - 1));
        assert!(wrong.is_empty(), "{file} on floor {floor} imports {wrong:?}");
    }
}

#[test]
fn an_arrow_that_points_up_is_seen() {
    let up = |floor: &str, source: &str| upward(floor, &imports(source, 2));
    assert_eq!(up("topology", "use crate::mesh::Mesh;\nuse crate::{error::Error, flow};\n"), ["flow"]);
    assert_eq!(
        up("topology", "use crate::{\n    mesh::{Mesh, io::{self, Soup}}, flow::{Solver},\n};"),
        ["flow::Solver"]
    );
    assert_eq!(up("topology", "use super::super::flow::Solver;"), ["flow::Solver"]);
    assert_eq!(up("metric", "fn f(x: ricci::embed::Layout) {}"), ["embed::Layout"]);
    assert_eq!(up("linalg", "use crate::geometry;"), ["geometry"]);
    assert!(up("topology", "// use crate::embed;\nuse super::flow;\nuse not_ricci::flow;").is_empty());
    assert!(up("error", "use crate::mesh::check::Diagnosis;").is_empty());
    assert_eq!(up("error", "use crate::mesh::{Mesh, check::Diagnosis};"), ["mesh::Mesh"]);
}

#[test]
fn modules_import_in_one_direction() {
    let found = ["src", "capi/src", "apps/src"]
        .map(|folder| (folder, modules::Modules::read(folder, EXCEPTION).circles()));
    assert!(found.iter().all(|(_, circles)| circles.is_empty()), "modules import one another: {found:#?}");
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
        let mut code = source.lines().map(|l| l.split("//").next().unwrap_or(""));
        let is_unsafe = |l: &str| l.split(|c: char| !c.is_alphanumeric() && c != '_').any(|w| w == "unsafe");
        assert!(!code.any(is_unsafe), "{file} has unsafe code; it belongs to capi");
    }
    let is_tests = |file: &String| file.ends_with("_tests.rs");
    for file in rust_files("src").into_iter().chain(rust_files("capi/src")).filter(|file| !is_tests(file)) {
        let source = text(&file);
        let code = source.split("#[cfg(test)]").next().unwrap_or("");
        for word in ["println!", "print!(", "dbg!", "process::exit", ".unwrap()", "panic!(", "todo!"] {
            let found = code.lines().any(|l| !l.trim_start().starts_with("//") && l.contains(word));
            assert!(!found, "{file} uses {word}");
        }
    }
}

#[test]
fn files_hold_one_idea() {
    for folder in ["src", "capi", "apps", "python", "tests", "benches", "examples"] {
        for file in
            files(folder).into_iter().filter(|f| [".rs", ".c", ".cpp", ".py"].iter().any(|e| f.ends_with(e)))
        {
            let lines = text(&file).lines().count();
            assert!(lines <= MOST_LINES, "{file} has {lines} lines");
        }
    }
}

#[test]
fn a_file_says_in_its_first_line_what_it_is_for() {
    for file in ["src", "capi/src", "apps/src"].iter().flat_map(|folder| rust_files(folder)) {
        let source = text(&file);
        let first = source.lines().next().unwrap_or("");
        assert!(first.starts_with("//! ") && first.len() > 4, "{file} does not begin with a `//!` line");
    }
}

/// The C face turns a panic into a status, which it could not where panics abort; `capi/src/guard.rs` does not compile there.
#[test]
fn panics_unwind_in_every_profile() {
    for (manifest, profiles) in [("Cargo.toml", &["dev", "release"][..]), ("fuzz/Cargo.toml", &["release"])] {
        let text = text(manifest);
        for profile in profiles {
            let section = text.split_once(&format!("[profile.{profile}]\n")).unwrap().1;
            let section = section.split("\n[").next().unwrap();
            assert!(section.lines().any(|l| l == "panic = \"unwind\""), "{manifest}: {profile}");
        }
        assert!(!text.contains("panic = \"abort\""), "{manifest}");
    }
    let guard = text("capi/src/guard.rs");
    assert!(guard.contains("#[cfg(not(panic = \"unwind\"))]\ncompile_error!"));
    assert!(guard.contains("fn a_panic_is_a_status_and_poisons_what_was_changed"));
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

/// True if an SPDX expression can be met by permissive licences alone. An exception (`WITH`) only adds permissions.
fn permissive(licence: &str) -> bool {
    let spaced = licence.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    any_of(&mut rest) && rest.is_empty()
}

/// True if an alternative of `A OR B …` is permissive. Each alternative is `a AND b …`, because AND binds closer.
fn any_of(words: &mut &[&str]) -> bool {
    let mut any = all_of(words);
    while let ["OR", rest @ ..] = *words {
        *words = rest;
        any |= all_of(words);
    }
    any
}

fn all_of(words: &mut &[&str]) -> bool {
    let mut all = one(words);
    while let ["AND", rest @ ..] = *words {
        *words = rest;
        all &= one(words);
    }
    all
}

/// True if a single licence, with or without an exception, or an expression in brackets is permissive.
fn one(words: &mut &[&str]) -> bool {
    match *words {
        ["(", rest @ ..] => {
            *words = rest;
            let inside = any_of(words);
            let closed = words.first() == Some(&")");
            *words = words.get(1..).unwrap_or(&[]);
            inside && closed
        }
        [name, "WITH", _, rest @ ..] | [name, rest @ ..] => {
            *words = rest;
            PERMISSIVE.contains(name)
        }
        [] => false,
    }
}

#[test]
fn licences_are_read_as_spdx() {
    for good in ["MIT", "MIT/Apache-2.0", "GPL-3.0 OR MIT", "(MIT OR GPL-2.0) AND Unicode-3.0"] {
        assert!(permissive(good), "{good}");
    }
    assert!(permissive("Apache-2.0 WITH LLVM-exception OR MPL-2.0"));
    for bad in ["", "MPL-2.0", "MIT AND GPL-3.0", "(MIT OR Apache-2.0) AND GPL-3.0", "(MIT", "MIT ISC"] {
        assert!(!permissive(bad), "{bad}");
    }
}

#[test]
fn every_key_that_is_cited_is_in_the_bibliography() {
    let page = text("docs/bibliography.md");
    let mut cited = BTreeSet::new();
    for folder in ["src", "capi/src", "apps/src", "tests", "docs"] {
        for file in files(folder).into_iter().filter(|f| f.ends_with(".rs") || f.ends_with(".md")) {
            // In code a bracket holds types and indices.
            let code = file.ends_with(".rs");
            let text = text(&file);
            let prose = text.lines().filter(|line| !code || line.trim_start().starts_with("//"));
            for part in prose.flat_map(|line| line.split('[').skip(1)) {
                let key = part.split([']', ',', '\\']).next().unwrap_or("");
                let name = key.trim_end_matches(|c: char| c.is_ascii_digit());
                let is_key = key.len() == name.len() + 2
                    && name.len() >= 2
                    && name.starts_with(|c: char| c.is_ascii_uppercase())
                    && name.chars().all(|c| c.is_ascii_alphabetic());
                if is_key {
                    cited.insert(key.to_string());
                }
            }
        }
    }
    assert!(cited.contains("JKLLG08") && cited.len() > 10, "{cited:?}");
    for key in cited {
        assert!(page.contains(&format!("| [{key}] |")), "[{key}] is not in docs/bibliography.md");
    }
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

//! The headers of `include/ricci`, which are written by hand, say what `capi/src` does: declarations, structs, constants; every
//! function has its comment in the fixed order, and is called by a test.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The headers, with the most functions that each may have.
const HEADERS: &[(&str, usize)] = &[
    ("ricci", 66),
    ("archive", 10),
    ("charts", 20),
    ("homotopy", 20),
    ("uniformize", 20),
    ("deck", 20),
    ("circles", 10),
    ("flatten", 10),
    ("freesurfer", 10),
    ("gifti", 20),
    ("harmonic", 20),
    ("match", 20),
    ("moduli", 10),
    ("seamless", 10),
    ("quads", 20),
    ("spline", 20),
    ("surface_spline", 10),
    ("bicubic", 10),
    ("quad_spline", 20),
    ("control_mesh", 10),
    ("structure", 20),
    ("repair", 25),
    ("labels", 10),
    ("refine", 10),
    ("shapes", 10),
    ("texture", 12),
    ("scene", 10),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn header(name: &str) -> String {
    std::fs::read_to_string(root().join(format!("include/ricci/{name}.h"))).unwrap()
}

/// The texts of the files with one of these endings below a folder.
fn texts(folder: &Path, endings: &[&str], found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            texts(&path, endings, found);
        } else if endings.iter().any(|e| path.to_string_lossy().ends_with(e)) {
            found.push(std::fs::read_to_string(&path).unwrap());
        }
    }
}

/// Without comments, directives and bodies of inline functions; blanks only where words would run together.
fn declarations(text: &str) -> Vec<String> {
    let mut code = String::new();
    for (i, part) in text.split("/*").enumerate() {
        code += if i == 0 { part } else { part.split_once("*/").unwrap().1 };
    }
    let lines = code.lines().filter(|l| !l.starts_with('#') && !l.starts_with("extern"));
    let code = lines.collect::<Vec<_>>().join(" ");
    let (mut all, mut now, mut depth) = (Vec::new(), String::new(), 0);
    for c in code.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        now.push(c);
        let inline = now.trim_start().starts_with("static inline");
        if depth <= 0 && (c == ';' || (c == '}' && inline)) {
            if !inline {
                all.push(normal(&now));
            }
            now.clear();
        }
        depth = depth.max(0);
    }
    all
}

fn normal(text: &str) -> String {
    let mut out =
        text.trim_start_matches([' ', '}']).replace("RICCI_API_VOID ", "").replace("RICCI_API ", "");
    out = out.replace("RICCI_EXPERIMENTAL ", "");
    out = out.replace("struct ", "");
    out = out.split_whitespace().collect::<Vec<_>>().join(" ");
    for mark in ["*", "(", ")", ",", ";", "{", "}"] {
        out = out.replace(&format!(" {mark}"), mark).replace(&format!("{mark} "), mark);
    }
    out
}

/// The name that a declaration declares.
fn name_of(declaration: &str) -> String {
    let word = |text: &str| {
        text.rsplit(|c: char| !c.is_alphanumeric() && c != '_').find(|w| !w.is_empty()).unwrap().to_string()
    };
    match declaration.split_once("(*") {
        Some((_, callback)) if declaration.starts_with("typedef") => {
            word(callback.split(')').next().unwrap())
        }
        _ if declaration.starts_with("typedef") => word(declaration),
        _ => word(declaration.split('(').next().unwrap()),
    }
}

fn functions(name: &str) -> Vec<String> {
    let all = declarations(&header(name)).into_iter();
    all.filter(|d| d.contains('(') && !d.starts_with("typedef")).map(|d| name_of(&d)).collect()
}

/// The list above has every header of C, each of which names the papers that its theme rests on.
#[test]
fn every_header_is_listed_with_its_papers() {
    let listed: std::collections::BTreeSet<&str> = HEADERS.iter().map(|(name, _)| *name).collect();
    let works = std::fs::read_to_string(root().join("docs/bibliography.md")).unwrap();
    for entry in std::fs::read_dir(root().join("include/ricci")).unwrap().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|e| e == "h") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(listed.contains(&*name), "{name}.h");
            let text = header(&name);
            let comment = text.split("*/").next().unwrap().replace("\n *", "");
            let (_, sources) = comment.split_once("Sources, by the keys of docs/bibliography.md:").unwrap();
            let keys = sources.split('[').skip(1).flat_map(|s| s.split(']').next().unwrap().split("; "));
            let missing: Vec<&str> =
                keys.filter(|k| !works.contains(&format!("| [{}] |", k.trim()))).collect();
            assert!(missing.is_empty() && sources.contains('['), "{name}.h: {missing:?}");
        }
    }
}

#[test]
fn headers_declare_what_the_source_defines() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(here.join("cbindgen.toml")).unwrap();
    let mut text = Vec::new();
    let builder = cbindgen::Builder::new().with_crate(here).with_config(config);
    builder.generate().expect("cbindgen reads the crate").write(&mut text);
    let by_name = |text: &str| -> BTreeMap<String, String> {
        let all = declarations(text).into_iter().filter(|d| !d.starts_with("enum"));
        all.map(|d| (name_of(&d), d)).collect()
    };
    let source = by_name(&String::from_utf8(text).unwrap());
    let headers: Vec<String> = HEADERS.iter().map(|(name, _)| header(name)).collect();
    let headers = by_name(&headers.join("\n"));
    assert!(source.len() > 150, "{}", source.len());
    for name in source.keys().chain(headers.keys()) {
        assert_eq!(headers.get(name), source.get(name), "{name}: headers (left), capi/src (right)");
    }
}

/// Fields without a meaning yet are named where structs are read, so that a caller's other values are refused.
#[test]
fn reserved_fields_are_named() {
    let mut sources = Vec::new();
    texts(&root().join("capi/src"), &[".rs"], &mut sources);
    let mut count = 0;
    for text in &sources {
        for body in text.split("pub struct ").skip(1) {
            let Some((name, fields)) = body.split_once('{') else { continue };
            let fields = fields.split('}').next().unwrap();
            let reserved = fields.matches("pub reserved").count();
            let Some((_, at)) = text.split_once(&format!("sized!({},", name.trim())) else { continue };
            let named = at.split(')').next().unwrap().matches(", reserved").count();
            assert_eq!(named, reserved, "{name}");
            count += reserved;
        }
    }
    assert!(count > 15, "{count}");
}

/// The functions that a build without a feature has in place of those of some headers take the same arguments.
#[test]
fn functions_that_are_left_out_are_those_of_the_headers() {
    let source = std::fs::read_to_string(root().join("capi/src/functions_left_out.rs")).unwrap();
    let source = source.split("#[cfg(test)]").next().unwrap();
    for (feature, names) in [
        ("splines", &["spline", "surface_spline", "bicubic"][..]),
        ("quads", &["seamless", "quads"]),
        ("quad_splines", &["quad_spline", "control_mesh"]),
        ("gifti", &["gifti"]),
    ] {
        let list = source.split(&format!("left_out!({feature}, ")).nth(1).unwrap();
        let list = list.split("]);").next().unwrap();
        let entries = list.split(';').filter_map(|entry| entry.split("ricci_").nth(1));
        let entries: BTreeMap<String, String> = entries
            .map(|entry| entry.split_once('(').unwrap_or((entry, "Address)")))
            .map(|(name, kinds)| (format!("ricci_{name}"), kinds.trim_end_matches(')').to_string()))
            .collect();
        let all = names.iter().flat_map(|name| declarations(&header(name)));
        let all = all.filter(|d| d.contains('(') && !d.starts_with("typedef"));
        let kind = |argument: &str| match argument.rsplit_once(' ').map(|(kind, _)| kind) {
            _ if argument.contains('*') => "Address",
            Some("size_t") => "usize",
            Some("uint32_t") => "u32",
            Some("double") => "f64",
            _ => panic!("{argument}"),
        };
        let wanted = all.map(|d| {
            let arguments = d.split_once('(').unwrap().1.trim_end_matches(';').trim_end_matches(')');
            (name_of(&d), arguments.split(',').map(kind).collect::<Vec<_>>().join(", "))
        });
        let wanted: BTreeMap<String, String> = wanted.collect();
        assert!(wanted.len() > 15, "{feature}");
        assert_eq!(entries, wanted, "capi/src/functions_left_out.rs (left), headers (right)");
    }
}

#[test]
fn constants_have_the_numbers_of_the_source() {
    let mut in_source = BTreeMap::new();
    let mut files = Vec::new();
    texts(&root().join("capi/src"), &[".rs"], &mut files);
    for file in &files {
        for table in file.split("choices!(").skip(1).filter(|table| table.contains("RICCI_")) {
            let names =
                table.split("\n]").next().unwrap().lines().filter_map(|l| l.trim().split_once(" => "));
            in_source.extend(names.zip(0u32..).map(|((name, _), number)| (name.to_string(), number)));
        }
        for line in file.split("statuses! {\n").skip(1).flat_map(|s| s.split("\n}").next().unwrap().lines()) {
            let (name, rest) = line.trim().split_once(" = ").unwrap();
            in_source.insert(name.to_string(), rest.split(' ').next().unwrap().parse().unwrap());
        }
    }
    let mut in_headers = BTreeMap::new();
    for (name, _) in HEADERS {
        for list in declarations(&header(name)).iter().filter_map(|d| d.strip_prefix("enum{")) {
            for constant in list.trim_end_matches("};").split(',') {
                let (name, number) = constant.split_once(" = ").unwrap();
                in_headers.insert(name.to_string(), number.parse::<u32>().unwrap());
            }
        }
    }
    assert!(in_source.len() > 100);
    assert_eq!(in_headers, in_source, "headers (left), capi/src (right)");
}

#[test]
fn the_version_of_the_header_is_that_of_the_package() {
    let text = header("ricci");
    let part = |what: &str| {
        text.split(&format!("#define RICCI_VERSION_{what} ")).nth(1).unwrap().lines().next().unwrap()
    };
    let version = ["MAJOR", "MINOR", "PATCH"].map(part).join(".");
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
}

/// What it does; `@return` where there is an answer; a blank line; a `@param` line for each argument, in order.
#[test]
fn every_function_has_its_comment() {
    for (header_name, most) in HEADERS {
        let text = header(header_name);
        let mut n = 0;
        for (before, declaration) in text
            .match_indices("\nRICCI_API")
            .map(|(at, _)| text.split_at(at))
            .map(|(b, d)| (b, d.trim_start()))
        {
            let declaration = normal(declaration.split(';').next().unwrap());
            let name = name_of(&declaration);
            let comment = before.rsplit("/**").next().unwrap().strip_suffix("*/").unwrap_or_else(|| {
                panic!("{name} has no comment right before it");
            });
            let lines: Vec<&str> =
                comment.lines().map(|l| l.trim().trim_start_matches("* ").trim()).collect();
            let place = |word: &str| lines.iter().position(|l| l.starts_with(word));
            let (answers, first) = (place("@return"), place("@param"));
            assert!(lines[1].ends_with(['.', ',', ':']) || lines[1].len() > 60, "{name}: {}", lines[1]);
            assert_eq!(answers.is_some(), !declaration.starts_with("void "), "{name}: @return");
            if let (Some(answers), Some(first)) = (answers, first) {
                assert!(answers < first && lines[first - 1] == "*", "{name}: @return, a blank line, @param");
            }
            let arguments = declaration.split_once('(').unwrap().1.trim_end_matches(')');
            let arguments = arguments.split(',').filter(|a| *a != "void");
            let wanted: Vec<&str> = arguments.map(|a| a.rsplit([' ', '*']).next().unwrap()).collect();
            let told = lines.iter().filter_map(|l| l.strip_prefix("@param "));
            let told: Vec<&str> = told.map(|l| l.split_whitespace().next().unwrap()).collect();
            assert_eq!(told, wanted, "{name}: its arguments");
            n += 1;
        }
        println!("ricci/{header_name}.h: {n} functions");
        assert_eq!(n, functions(header_name).len());
        assert!(n > 0 && n <= *most, "{header_name}.h has {n} functions");
    }
}

/// Each field of a struct of options says what it is, and in a further sentence what suits whom.
#[test]
fn every_option_has_its_advice() {
    let mut count = 0;
    for (header_name, _) in HEADERS {
        let text = header(header_name);
        for body in text.split("typedef struct ").skip(1) {
            let Some((name, rest)) = body.split_once(" {\n") else { continue };
            let fields = rest.split("\n}").next().unwrap();
            for field in fields.split("/**").skip(1).filter(|_| name.ends_with("_options")) {
                let (comment, declaration) = field.split_once("*/").unwrap();
                let field = name_of(declaration.trim());
                if field == "size" || field.starts_with("reserved") {
                    continue;
                }
                let words = comment.split_whitespace().filter(|w| *w != "*").collect::<Vec<_>>().join(" ");
                assert!(words.contains(". "), "{name}.{field}: {words}");
                count += 1;
            }
        }
    }
    assert!(count > 80, "{count}");
}

/// The table of docs/results/fuzz.md names every function and the targets that call it, which exist; no target is left out.
#[test]
fn every_function_has_its_fuzz_target() {
    let page = std::fs::read_to_string(root().join("docs/results/fuzz.md")).unwrap();
    let (_, table) = page.split_once("| function | targets |\n").unwrap();
    let rows: BTreeMap<&str, &str> = table
        .lines()
        .skip(1)
        .map_while(|line| line.strip_prefix("| `")?.strip_suffix(" |")?.split_once("` | "))
        .collect();
    let all: Vec<String> = HEADERS.iter().flat_map(|(name, _)| functions(name)).collect();
    let missing: Vec<&String> = all.iter().filter(|f| !rows.contains_key(f.as_str())).collect();
    assert!(missing.is_empty(), "docs/results/fuzz.md has no row for {missing:#?}");
    assert_eq!(rows.len(), all.len(), "docs/results/fuzz.md has rows for functions that do not exist");
    let run = std::fs::read_to_string(root().join("fuzz/run")).unwrap();
    let targets = run.split("targets=(").nth(2).unwrap().split(')').next().unwrap();
    let targets: Vec<&str> = targets.split_whitespace().collect();
    for (function, of) in rows {
        let named: Vec<&str> = of.split(", ").collect();
        assert!(named.contains(&"calls"), "{function}: {of}");
        assert!(named.iter().all(|target| targets.contains(target)), "{function}: {of}");
    }
    for entry in std::fs::read_dir(root().join("fuzz/targets")).unwrap().flatten() {
        let path = entry.path();
        let name = path.file_stem().unwrap().to_string_lossy();
        assert!(targets.contains(&&*name) && page.contains(&format!("| {name} |")), "{name}");
    }
}

#[test]
fn every_function_is_called_by_a_test() {
    let mut tests = Vec::new();
    texts(&root().join("tests/cpp"), &[".c", ".cpp", ".h", ".hpp"], &mut tests);
    let words: std::collections::BTreeSet<&str> =
        tests.iter().flat_map(|t| t.split(|c: char| !c.is_alphanumeric() && c != '_')).collect();
    let all = HEADERS.iter().flat_map(|(name, _)| functions(name));
    let missing: Vec<String> = all.filter(|f| !words.contains(f.as_str())).collect();
    assert!(missing.is_empty(), "no test calls {missing:#?}");
}

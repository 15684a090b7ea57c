//! One word per idea: every type of the library, the C face and the command has a name of its own, and no parameter
//! is a tuple that is taken apart in the signature.

use super::{files, open, rust_files, text};
use std::collections::{BTreeMap, BTreeSet};

/// The crates whose types share one vocabulary.
const CRATES: &[&str] = &["src", "capi/src", "apps/src"];

/// Names that more than one type bears on purpose, each with its reason.
const SHARED: &[(&str, &str)] = &[(
    "Failure",
    "the reason why a call of the C face fails, and why the command fails: neither crate knows the other",
)];

/// Parameters with a tuple as pattern that remain in signatures.
const TUPLE_PARAMETERS: usize = 12;

/// The name of the type that a line declares. An alias counts only where it begins the line: further in it is the
/// associated type of a trait.
fn declared(line: &str) -> Option<&str> {
    // The C face declares enums by a macro.
    let item = line.trim_start().trim_start_matches("choices!(");
    let item = match item.strip_prefix("pub") {
        Some(rest) => match rest.strip_prefix('(') {
            Some(path) => path.split_once(')')?.1.trim_start(),
            None => rest.trim_start(),
        },
        None => item,
    };
    let (keyword, rest) = item.split_once(' ')?;
    let declares = ["struct", "enum", "union", "trait"].contains(&keyword)
        || keyword == "type" && !line.starts_with(char::is_whitespace);
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    (declares && rest.starts_with(char::is_alphabetic)).then(|| &rest[..end])
}

/// The parameters of the functions that `code` declares, each with the name of its function.
fn parameters(code: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ") {
        let rest = &code[at + 3..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let name = &rest[..end];
        if name.is_empty() || code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        // The list opens at the first bracket outside the generic parameters, and commas part it at depth one.
        let (mut generic, mut depth, mut start, mut before) = (0, 0, 0, ' ');
        for (i, c) in rest[end..].char_indices().map(|(i, c)| (end + i, c)) {
            match c {
                '<' => generic += 1,
                '>' if !"-=".contains(before) => generic -= 1,
                '(' | '[' | '{' if depth > 0 || generic == 0 => {
                    depth += 1;
                    start = if depth == 1 { i + 1 } else { start };
                }
                ')' | ']' | '}' if depth > 0 => depth -= 1,
                _ => {}
            }
            let parts = depth == 1 && generic == 0 && c == ',';
            let closes = depth == 0 && c == ')' && generic == 0;
            if parts || closes {
                found.push((name, rest[start..i].trim()));
                start = i + 1;
            }
            before = c;
            if closes || depth == 0 && c == ';' {
                break;
            }
        }
    }
    found
}

fn is_tuple(parameter: &str) -> bool {
    parameter.trim_start_matches('&').trim_start_matches("mut ").starts_with('(')
}

#[test]
fn a_name_is_borne_by_one_type() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in CRATES.iter().flat_map(|folder| rust_files(folder)) {
        for (number, line) in text(&file).lines().enumerate() {
            if let Some(name) = declared(line) {
                places.entry(name.to_string()).or_default().push(format!("{file}:{}", number + 1));
            }
        }
    }
    places.retain(|_, at| at.len() > 1);
    let listed = |name: &str| SHARED.iter().any(|(shared, _)| *shared == name);
    let wrong: Vec<_> = places.iter().filter(|(name, _)| !listed(name)).collect();
    assert!(wrong.is_empty(), "names that several types bear: {wrong:#?}");
    let gone: Vec<_> = SHARED.iter().filter(|(name, _)| !places.contains_key(*name)).collect();
    assert!(gone.is_empty(), "names that are shared no longer: {gone:?}");
}

#[test]
fn no_parameter_is_a_tuple() {
    let mut wrong = Vec::new();
    for file in CRATES.iter().flat_map(|folder| rust_files(folder)) {
        let code: Vec<String> =
            text(&file).lines().map(|line| line.split("//").next().unwrap_or("").to_string()).collect();
        let code = code.join("\n");
        let tuples = parameters(&code).into_iter().filter(|(_, parameter)| is_tuple(parameter));
        wrong.extend(tuples.map(|(name, parameter)| format!("{file}: {name}: {parameter}")));
    }
    assert!(wrong.len() <= TUPLE_PARAMETERS, "{} parameters are tuples: {wrong:#?}", wrong.len());
}

/// The words of a folder's files.
fn words(folder: &str) -> BTreeSet<String> {
    let texts: String = files(folder).iter().map(|file| text(file)).collect();
    texts.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_string).collect()
}

/// The tables of docs/c-conventions.md name what exists: items of Rust in the second column, symbols of C in any one.
#[test]
fn the_tables_of_names_name_what_exists() {
    let (rust, c) = (words("src"), words("include"));
    let page = text("docs/c-conventions.md");
    let (mut count, mut missing) = (0, Vec::new());
    for row in page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| **")) {
        for (column, cell) in row.trim_matches('|').split(" | ").enumerate() {
            for span in cell.split('`').skip(1).step_by(2) {
                let mut names = BTreeSet::new();
                if column == 1 && span != "log" {
                    open(span, "", &mut names);
                }
                for name in names.iter().map(|path| path.rsplit("::").next().unwrap()) {
                    count += 1;
                    if !rust.contains(name) {
                        missing.push(format!("{name} in src, of {row}"));
                    }
                }
                let symbol = span.starts_with("ricci_") || span.starts_with("RICCI_");
                if symbol && !span.ends_with('*') && !c.contains(span) {
                    missing.push(format!("{span} in the headers"));
                }
            }
        }
    }
    assert!(count > 100, "only {count} names of Rust were found");
    assert!(missing.is_empty(), "docs/c-conventions.md names what does not exist: {missing:#?}");
}

#[test]
fn declarations_and_tuples_are_seen() {
    assert_eq!(declared("    pub(in crate::flow) struct Step<'a> {"), Some("Step"));
    assert_eq!(declared("pub type Pair = (u32, u32);"), Some("Pair"));
    assert_eq!(declared("    type Output = f64;"), None);
    assert_eq!(declared("union(a, b);"), None);
    assert_eq!(declared("choices!(pub(crate) enum Kind, KINDS = \"kind\", ["), Some("Kind"));
    let code = "fn f<T: Fn(u8) -> u8, const N: usize>(&self, (a, b): (A, B), c: [(u8, u8); 2]) -> (A, B) {\n g((1, 2)) }";
    let found = parameters(code);
    assert_eq!(found, [("f", "&self"), ("f", "(a, b): (A, B)"), ("f", "c: [(u8, u8); 2]")]);
    assert_eq!(found.iter().filter(|(_, parameter)| is_tuple(parameter)).count(), 1);
    assert_eq!(parameters("fn f(g: impl Fn(A, B) -> C, x: &mut Vec<(A, B)>)").len(), 2);
}

//! The functions and structs of `include/ricci/*.h` as tables, and calls of each function by its C declaration.

use std::fmt::Write;
use std::path::Path;

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../include/ricci");
    println!("cargo:rerun-if-changed={}", folder.display());
    let mut headers: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    headers.retain(|path| path.extension().is_some_and(|extension| extension == "h"));
    headers.sort();
    let text: String = headers.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let text = without_comments(&text);
    let (mut outside, mut calls) = (String::new(), String::new());
    for declaration in text.split("RICCI_API").filter_map(|rest| rest.split_once(';')).map(|(d, _)| d) {
        let declaration = declaration.trim_start_matches("_VOID").trim_start();
        function(declaration.trim_start_matches("RICCI_EXPERIMENTAL"), &mut outside, &mut calls);
    }
    let mut structs = String::new();
    for body in text.split("typedef struct ").skip(1).filter_map(|rest| rest.split_once('}')) {
        structure(body, &mut structs);
    }
    let page = format!(
        "mod c {{ use super::*; unsafe extern \"C\" {{ {outside} }} }}\n\
         pub const CALLS: &[Call] = &[{calls}];\npub const STRUCTS: &[Struct] = &[{structs}];\n"
    );
    let out = std::env::var("OUT_DIR").unwrap();
    std::fs::write(Path::new(&out).join("face.rs"), page).unwrap();
}

fn without_comments(text: &str) -> String {
    let mut code = String::new();
    for (i, part) in text.split("/*").enumerate() {
        code += if i == 0 { part } else { part.split_once("*/").unwrap().1 };
    }
    let lines = code.lines().filter(|line| !line.trim_start().starts_with('#'));
    lines.collect::<Vec<_>>().join(" ")
}

/// The C type and the name of a parameter or field.
fn named(declaration: &str) -> (String, String) {
    let declaration = declaration.split('[').next().unwrap().trim();
    let end = declaration.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_').len();
    let (of, name) = declaration.split_at(end);
    (of.split_whitespace().collect::<Vec<_>>().join(" "), name.to_string())
}

/// A C type in Rust, as far as a call needs to know.
fn rust(of: &str) -> &'static str {
    match of {
        "size_t" => "usize",
        "uint32_t" | "ricci_status" => "u32",
        "double" => "f64",
        _ => "*mut c_void",
    }
}

/// `ricci_status ricci_mesh_read(const char *path, ricci_mesh **mesh)` and its like.
fn function(declaration: &str, outside: &mut String, calls: &mut String) {
    let Some((head, rest)) = declaration.split_once('(') else { return };
    let parameters = rest.trim_end().trim_end_matches(')');
    let (answer, name) = named(head);
    let Some(answer) = answer.strip_suffix(' ').or(Some(answer.as_str())) else { return };
    let parameters: Vec<_> =
        parameters.split(',').map(str::trim).filter(|p| *p != "void").map(named).collect();
    let (mut declared, mut passed, mut listed) = (String::new(), String::new(), String::new());
    for (i, (of, parameter)) in parameters.iter().enumerate() {
        write!(declared, "a{i}: {}, ", rust(of)).unwrap();
        passed += &match rust(of) {
            "f64" => format!("f64::from_bits(a[{i}]), "),
            "*mut c_void" => format!("a[{i}] as *mut c_void, "),
            number => format!("a[{i}] as {number}, "),
        };
        write!(listed, "({of:?}, {parameter:?}), ").unwrap();
    }
    let (returned, made) = match answer {
        "void" => ("", "Answer::Nothing"),
        "ricci_status" => ("-> u32", "Answer::Status(answer)"),
        "uint32_t" => ("-> u32", "Answer::Number(answer)"),
        _ => ("-> *mut c_void", "Answer::Text(answer.cast_const().cast())"),
    };
    writeln!(outside, "pub fn {name}({declared}) {returned};").unwrap();
    writeln!(
        calls,
        "Call {{ name: {name:?}, parameters: &[{listed}], run: |a| unsafe {{ let _ = a; \
         #[allow(clippy::let_unit_value)] let answer = c::{name}({passed}); let _ = answer; {made} }} }},"
    )
    .unwrap();
}

/// `ricci_target { size_t size; … ` and its like.
fn structure((head, _): (&str, &str), structs: &mut String) {
    let Some((name, fields)) = head.split_once('{').filter(|(name, _)| !name.contains(';')) else { return };
    let mut listed = String::new();
    for field in fields.split(';').map(str::trim).filter(|field| !field.is_empty()) {
        let field = field.strip_prefix("struct ").unwrap_or(field);
        let (of, name) = named(field);
        let count: usize =
            field.split_once('[').map_or(1, |(_, rest)| rest.trim_end_matches(']').parse().unwrap());
        write!(listed, "({of:?}, {name:?}, {count}), ").unwrap();
    }
    writeln!(structs, "Struct {{ name: {:?}, fields: &[{listed}] }},", name.trim()).unwrap();
}

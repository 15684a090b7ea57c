//! The committed header is the one the source gives. `RICCI_BLESS=1` writes it anew.

use std::path::Path;

#[test]
fn committed_header_is_what_the_source_gives() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(here.join("cbindgen.toml")).unwrap();
    let mut text = Vec::new();
    cbindgen::Builder::new()
        .with_crate(here)
        .with_config(config)
        .generate()
        .expect("cbindgen reads the crate")
        .write(&mut text);
    let text = compact(&String::from_utf8(text).unwrap());
    let committed = here.join("../include/ricci/ricci.h");
    if std::env::var_os("RICCI_BLESS").is_some() {
        std::fs::create_dir_all(committed.parent().unwrap()).unwrap();
        std::fs::write(&committed, &text).unwrap();
    }
    let have = std::fs::read_to_string(&committed).unwrap_or_default();
    assert!(
        have == text,
        "include/ricci/ricci.h is not what capi/src gives; run \
         RICCI_BLESS=1 cargo test -p ricci-capi --test header and commit it"
    );
}

/// A comment of one line on one line.
fn compact(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut out = String::new();
    let mut i = 0;
    while i < lines.len() {
        let body = lines.get(i + 1).and_then(|line| line.trim_start().strip_prefix("* "));
        match body {
            Some(body) if lines[i].trim() == "/**" && lines.get(i + 2).is_some_and(|l| l.trim() == "*/") => {
                out += &format!("{} {body} */\n", lines[i]);
                i += 3;
            }
            _ => {
                out += lines[i];
                out.push('\n');
                i += 1;
            }
        }
    }
    out
}

//! The words of the C face: the library's messages advise commands of the shell, and a program that calls functions is told of functions.

use std::borrow::Cow;

/// Words of messages and the words of the C face for them. An entry that begins as another one does stands before it.
const WORDS: [(&str, &str); 18] = [
    (" (--loops)", ""),
    ("--loops K,K,…", "the field loops"),
    ("ricci refine --intrinsic", "ricci_mesh_refine_angle"),
    ("no command makes", "no function makes"),
    ("ricci info lists them", "ricci_soup_loops lists them"),
    ("ricci flow --components all", "ricci_flow after ricci_soup_repair with component"),
    ("ricci flow", "ricci_flow"),
    ("ricci repair --weld DISTANCE", "ricci_soup_repair with weld"),
    ("ricci repair --weld ", "ricci_soup_repair with weld = "),
    ("ricci repair --drop-nonfinite", "ricci_soup_repair with drop_non_finite"),
    ("ricci repair --cut-edges", "ricci_soup_repair with cut_non_manifold_edges"),
    ("ricci repair --degenerate", "ricci_soup_repair with mend_zero_area"),
    ("ricci repair --t-junctions", "ricci_soup_repair with split_t_junctions"),
    ("ricci repair --component K", "ricci_soup_repair with component"),
    ("ricci repair", "ricci_soup_repair"),
    ("ricci refine --levels 1", "ricci_soup_refine with levels = 1"),
    ("ricci refine --edge L", "ricci_soup_refine with longest_edge"),
    ("ricci refine", "ricci_soup_refine"),
];

/// A message of the library in the words of the C face.
pub fn in_functions(message: &str) -> Cow<'_, str> {
    let mut told = Cow::Borrowed(message);
    for (command, function) in WORDS {
        if told.contains(command) {
            told = Cow::Owned(told.replace(command, function));
        }
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    /// The literals of a source, lines that end with a backslash joined.
    fn literals(source: &str, found: &mut Vec<String>) {
        let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
        let mut text = String::new();
        for line in code {
            match line.strip_suffix('\\') {
                Some(part) => text.push_str(if text.is_empty() { part } else { part.trim_start() }),
                None => {
                    text.push_str(if text.is_empty() { line } else { line.trim_start() });
                    found.extend(text.split('"').skip(1).step_by(2).map(String::from));
                    text.clear();
                }
            }
        }
    }

    /// The literals of all sources below a folder but of tests, whose words reach no caller.
    fn all_below(folder: &Path, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let is_test = path.to_str().is_some_and(|name| name.ends_with("_tests.rs"));
            match path.extension() {
                None => all_below(&path, found),
                Some(_) if is_test => {}
                Some(_) => literals(&fs::read_to_string(&path).unwrap(), found),
            }
        }
    }

    /// True for text that tells of a command or of an option of one.
    fn is_of_the_shell(text: &str) -> bool {
        let is_option = |at: usize| text[at + 2..].starts_with(|c: char| c.is_ascii_lowercase());
        let commands =
            ["ricci flow", "ricci info", "ricci repair", "ricci refine", "ricci uniformize", "ricci make"];
        commands.iter().any(|command| text.contains(command))
            || text.match_indices("--").any(|(at, _)| is_option(at))
    }

    #[test]
    fn no_message_that_reaches_c_tells_of_commands() {
        let mut found = Vec::new();
        for folder in ["../src", "src"] {
            all_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut found);
        }
        let of_the_shell: Vec<&String> = found.iter().filter(|text| is_of_the_shell(text)).collect();
        assert!(of_the_shell.len() > 20, "only {} messages tell of commands", of_the_shell.len());
        for text in of_the_shell {
            // The table above consists of such words.
            if WORDS.iter().all(|(command, _)| command != text) && !text.starts_with("ricci ") {
                assert!(!is_of_the_shell(&in_functions(text)), "{text}");
            }
        }
    }
}

//! The graph of the modules of a crate, which is read from its source, and the cycles of the graph.

use super::{open, root, rust_files, text};
use std::collections::{BTreeMap, BTreeSet};

/// A module as the names that lead to it from the crate's root.
type Path = Vec<String>;

/// The beginnings of statements by which a module re-exports items of another one.
const GIVING_ON: &[&str] = &["pub use ", "pub(crate) use ", "pub(super) use "];

/// The modules of one crate.
pub struct Modules {
    /// Source of each module without comments, strings of `use` in order, and without unit tests.
    code: BTreeMap<Path, String>,
    /// The items that each module imports by `use`, as (name, path).
    used: BTreeMap<Path, Vec<(String, Path)>>,
    /// Those of them that it re-exports by `pub use`.
    given_on: BTreeMap<Path, Vec<(String, Path)>>,
}

/// Names as a path.
fn path(names: &str) -> Path {
    names.split("::").filter(|name| !name.is_empty()).map(String::from).collect()
}

/// The module that a source file is: `a/mod.rs` is `a`, `lib.rs` and `main.rs` the root.
fn module_of(file: &str, folder: &str) -> Path {
    let name = file.trim_start_matches(folder).trim_end_matches(".rs");
    path(&name.trim_start_matches('/').replace('/', "::"))
        .into_iter()
        .filter(|name| !["mod", "lib", "main"].contains(&name.as_str()))
        .collect()
}

/// The source without comments and without its unit tests.
fn code_of(source: &str) -> String {
    let code: Vec<&str> = source.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
    let code = code.join("\n");
    code.split("#[cfg(test)]\nmod tests {").next().unwrap_or("").to_string()
}

/// The statements of `code` that begin with one of these words: the text between the words and the semicolon.
fn statements<'a>(code: &'a str, words: &[&str]) -> Vec<&'a str> {
    let starts = words.iter().flat_map(|word| code.match_indices(word));
    let alone = |at: usize| code[..at].ends_with(['\n', '{', '}', ';']) || at == 0;
    starts
        .filter(|&(at, _)| alone(at - (code[..at].len() - code[..at].trim_end_matches(' ').len())))
        .map(|(at, word)| code[at + word.len()..].split(';').next().unwrap_or(""))
        .collect()
}

impl Modules {
    /// The modules in the files below `folder`, without the arrow from the module `allowed.0` to what `allowed.1` names.
    pub fn read(folder: &str, allowed: (&str, &str)) -> Modules {
        let files = rust_files(folder);
        assert!(files.len() > 10, "{folder} is not below {}", root().display());
        Modules::of(files.iter().map(|file| {
            let (module, source) = (module_of(file, folder), text(file));
            let is_allowed = module == path(allowed.0);
            (module, if is_allowed { source.replace(&format!("crate::{}", allowed.1), "") } else { source })
        }))
    }

    fn of(sources: impl Iterator<Item = (Path, String)>) -> Modules {
        let code: BTreeMap<Path, String> = sources.map(|(module, text)| (module, code_of(&text))).collect();
        let items = |words: &[&str]| -> BTreeMap<Path, Vec<(String, Path)>> {
            let named = |statement| {
                let mut found = BTreeSet::new();
                open(statement, "", &mut found);
                found.into_iter().map(|item| {
                    let item = path(item.trim_end_matches("::self"));
                    (item.last().cloned().unwrap_or_default(), item)
                })
            };
            let of = |code| statements(code, words).into_iter().flat_map(named).collect();
            code.iter().map(|(module, code)| (module.clone(), of(code))).collect()
        };
        let used = items(&["use ", "pub use ", "pub(crate) use ", "pub(super) use "]);
        Modules { used, given_on: items(GIVING_ON), code }
    }

    /// The module that holds the item of the path `names`, as written in the module `from`; none if it is of another crate.
    fn holder(&self, from: &Path, names: &[String]) -> Option<Path> {
        let (mut at, mut names) = match names.first()?.as_str() {
            "crate" => (Path::new(), &names[1..]),
            "self" => (from.clone(), &names[1..]),
            "super" => (from[..from.len().checked_sub(1)?].to_vec(), &names[1..]),
            child if self.code.contains_key(&below(from, child)) => (from.clone(), names),
            _ => return None,
        };
        while names.first().is_some_and(|name| name == "super") {
            at.pop()?;
            names = &names[1..];
        }
        while let Some((name, rest)) = names.split_first() {
            let inside = below(&at, name);
            if self.code.contains_key(&inside) {
                (at, names) = (inside, rest);
                continue;
            }
            let used = self.used[&at].iter().find(|(item, path)| item == name && *path != names);
            return match used.and_then(|(_, item)| self.holder(&at, item)) {
                Some(holder) if !rest.is_empty() && self.code.contains_key(&below(&holder, name)) => {
                    self.holder(&below(&holder, name), &[&["self".to_string()], rest].concat())
                }
                Some(holder) => Some(holder),
                None => Some(at),
            };
        }
        Some(at)
    }

    /// The modules that each module names. A `pub use` by itself is no arrow: modules that use the name, among them possibly the one
    /// that re-exports it, have an arrow to the module that holds the item.
    pub fn arrows(&self) -> BTreeMap<Path, BTreeSet<Path>> {
        let mut arrows = BTreeMap::new();
        for (module, code) in &self.code {
            let mut code = code.clone();
            for words in GIVING_ON {
                for statement in statements(&code.clone(), &[words]) {
                    code = code.replace(&format!("{words}{statement};"), "");
                }
            }
            let own: Vec<&str> =
                code.lines().filter(|line| !line.contains("mod ") || !line.ends_with(';')).collect();
            let code = own.join("\n");
            let children = self.code.keys().filter(|m| m.len() == module.len() + 1 && m.starts_with(module));
            let heads = children.filter_map(|m| m.last()).map(String::as_str);
            let mut to = BTreeSet::new();
            for head in heads.chain(["crate", "super", "self"]) {
                for (at, _) in code.match_indices(&format!("{head}::")) {
                    if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                        continue;
                    }
                    let mut found = BTreeSet::new();
                    open(&code[at..], "", &mut found);
                    let holders = found.iter().filter_map(|names| self.holder(module, &path(names)));
                    to.extend(holders.filter(|holder| holder != module));
                }
            }
            for (name, item) in &self.given_on[module] {
                let is_word = |c: char| c.is_alphanumeric() || c == '_';
                let used = |(at, _): (usize, &str)| {
                    !code[..at].ends_with(|c| is_word(c) || c == ':')
                        && !code[at + name.len()..].starts_with(is_word)
                };
                if code.match_indices(name.as_str()).any(used) {
                    to.extend(self.holder(module, item).filter(|holder| holder != module));
                }
            }
            arrows.insert(module.clone(), to);
        }
        arrows
    }

    /// Sets of modules that reach one another, each named by `a, b, c`; none in a tree without cycles.
    pub fn circles(&self) -> Vec<String> {
        let arrows = self.arrows();
        let reach: BTreeMap<&Path, BTreeSet<&Path>> = arrows
            .keys()
            .map(|from| {
                let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
                while let Some(module) = open.pop() {
                    open.extend(arrows[module].iter().filter(|to| seen.insert(*to)));
                }
                (from, seen)
            })
            .collect();
        let mut circles = BTreeSet::new();
        for (module, reached) in reach.iter().filter(|(module, reached)| reached.contains(*module)) {
            let name = |m: &&Path| if m.is_empty() { "the crate's root".into() } else { m.join("::") };
            let circle: Vec<String> =
                reached.iter().filter(|m| reach[**m].contains(module)).map(name).collect();
            circles.insert(circle.join(", "));
        }
        circles.into_iter().collect()
    }
}

/// The module `name` inside `module`.
fn below(module: &Path, name: &str) -> Path {
    [module.as_slice(), &[name.to_string()]].concat()
}

#[test]
fn cycles_are_seen() {
    let circles = |sources: &[(&str, &str)]| {
        Modules::of(sources.iter().map(|(module, source)| (path(module), source.to_string()))).circles()
    };
    assert_eq!(
        circles(&[("", "mod a; mod b;"), ("a", "use crate::b::B;"), ("b", "use super::a;")]),
        ["a, b"]
    );
    // A re-export leads to where the item stands, also through another re-export and inside groups.
    let re_export = [("", ""), ("r", "mod a;\nmod b;\npub use a::{A, C};"), ("r::b", "use super::A;")];
    assert!(circles(&[&re_export[..], &[("r::a", "fn f() {}")]].concat()).is_empty());
    assert_eq!(circles(&[&re_export[..], &[("r::a", "fn f() { super::b::g() }")]].concat()), ["r::a, r::b"]);
    let used_here =
        [("", ""), ("r", "mod a;\npub use a::{a, g};\nstruct S;\nfn f() { g() }"), ("r::a", "use super::S;")];
    assert_eq!(circles(&used_here), ["r, r::a"]);
    let given_on = [("", ""), ("r", "mod a;\npub use a::{a, g};\nstruct S;"), ("r::a", "use super::S;")];
    assert!(circles(&given_on).is_empty());
    // A module that uses what its parent holds is in a circle if the parent uses it.
    let parent = "mod a;\nstruct S;\nfn f() { a::g() }";
    assert_eq!(circles(&[("", ""), ("r", parent), ("r::a", "use super::S;")]), ["r, r::a"]);
    assert!(circles(&[("", ""), ("r", "mod a;\nstruct S;"), ("r::a", "use super::S;")]).is_empty());
    // Neither comments nor unit tests are arrows.
    let tests = "// crate::a\nfn f() {}\n#[cfg(test)]\nmod tests {\n    use crate::a;\n}";
    assert!(circles(&[("", ""), ("a", "use crate::b;"), ("b", tests)]).is_empty());
}

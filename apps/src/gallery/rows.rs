//! The list of the gallery's pictures: a row for each, and the figures of the paper with their rows.

use super::view::Companion;
use RowSource::{Corpus, Made};
use ricci::mesh::io;
use std::path::Path;

/// The pictures, a line each.
const PICTURES: &str = include_str!("rows.txt");

/// The figures of the paper, a line each.
const FIGURES: &str = include_str!("figures.txt");

/// One picture. In the command lines `{}` stands for the surface's file, `{spline}` for a spline's, `{other}` for a second surface's and
/// `{=NAME}` for that of a mesh of the corpus.
pub struct GalleryRow {
    pub name: &'static str,
    pub source: RowSource,
    /// `flow …`, `uniformize …`, `cover …`, `circles …`, `harmonic …`, `forms …`, `structure …`, `match …`, `spline …` or `info …`, or such
    /// commands with ` && ` between them, of which the last one draws; for what `make` draws itself nothing.
    pub draw: &'static str,
    pub about: &'static str,
}

/// The surface of a picture.
pub enum RowSource {
    /// The arguments of `ricci make`, and the extension of the file that it writes.
    Made(&'static str, &'static str),
    /// The name of a mesh of the corpus.
    Corpus(&'static str),
}

/// The rows of [`PICTURES`] under their titles.
pub fn sections() -> Vec<(&'static str, Vec<GalleryRow>)> {
    let row = |line: &'static str| {
        let mut fields = line.split('|').map(str::trim);
        let [name, source, draw, about] = [(); 4].map(|()| fields.next().unwrap_or_default());
        let source = match source.split_once(' ') {
            Some(("make", line)) => Made(line, "obj"),
            Some(("lengths", line)) => Made(line, "json"),
            _ => Corpus(source),
        };
        GalleryRow { name, source, draw, about }
    };
    let section = |text: &'static str| {
        let (title, rows) = text.split_once('\n').unwrap_or((text, ""));
        (title, rows.lines().filter(|line| !line.is_empty()).map(row).collect())
    };
    PICTURES.split("\n## ").skip(1).map(section).collect()
}

/// Number, what is shown, and the rows that show it.
pub fn figures() -> Vec<(&'static str, &'static str, Vec<&'static str>)> {
    let figure = |line: &'static str| {
        let mut fields = line.split('|').map(str::trim);
        let [number, about, rows] = [(); 3].map(|()| fields.next().unwrap_or_default());
        (number, about, rows.split_whitespace().collect())
    };
    FIGURES.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).map(figure).collect()
}

impl GalleryRow {
    /// The surface's file.
    pub fn file(&self) -> String {
        match self.source {
            Made(_, extension) => format!("{}.{extension}", self.name),
            Corpus(name) => format!("{name}.obj"),
        }
    }

    /// The command lines as a reader would type them.
    pub fn shown(&self) -> Vec<String> {
        let (file, picture) = (self.file(), format!(" --picture {}.png", self.name));
        let make = match self.source {
            Made(line, _) => {
                let own = if self.draw.is_empty() { picture.as_str() } else { "" };
                Some(format!("ricci make {line} -o {file}{own}"))
            }
            Corpus(_) => None,
        };
        let draw = self.draw.replace("{}", &file).replace("{spline}", &format!("{}.json", self.name));
        let draw = draw.replace("{other}", &format!("{}-other.obj", self.name));
        let draw = draw.replace("{=", "").replace('}', ".obj");
        let last = draw.split(" && ").count() - 1;
        let picture_of = |k: usize| if k == last { picture.as_str() } else { "" };
        let lines = draw.split(" && ").enumerate().filter(|(_, line)| !line.is_empty());
        make.into_iter().chain(lines.map(|(k, line)| format!("ricci {line}{}", picture_of(k)))).collect()
    }

    /// The second side of the view, and the option by which the last command writes it; or why there is no view.
    pub fn beside(&self, surface: &Path) -> Result<(Companion, &'static str), String> {
        if let Made(_, "json") = self.source {
            return Err("Given by its edge lengths: there is no surface in space to be turned.".into());
        }
        let last = self.draw.rsplit(" && ").next().unwrap_or_default();
        Ok(match last.split(' ').next().unwrap_or_default() {
            "uniformize" | "cover" if is_sphere(surface) => (Companion::Image, "--sphere"),
            "flow" | "uniformize" | "cover" | "circles" | "harmonic" | "forms" => {
                (Companion::Texture, "--uv")
            }
            "match" => (Companion::Image, "--output"),
            _ => (Companion::Alone, ""),
        })
    }

    /// The direction that the picture is asked to have up.
    pub fn up(&self) -> Option<[f64; 3]> {
        let words: Vec<&str> = self.draw.split([' ', '=']).collect();
        let axis = words.windows(2).rfind(|pair| pair[0] == "--up")?[1];
        let sign = if axis.starts_with('-') { -1.0 } else { 1.0 };
        let k = ["x", "y", "z"].iter().position(|name| axis.ends_with(name))?;
        Some([0, 1, 2].map(|j| if j == k { sign } else { 0.0 }))
    }
}

/// True if a file's triangles form a closed surface of genus 0, of all surfaces in one piece the one with the most faces for its vertices.
fn is_sphere(file: &Path) -> bool {
    io::read(file).is_ok_and(|soup| soup.faces.len() + 4 == 2 * soup.positions.len())
}

/// The origin of a mesh, by the second and third column after its name in the corpus's index.
pub fn credit(index: &str, mesh: &str) -> Option<String> {
    let line = index.lines().find_map(|l| l.strip_prefix(mesh)?.strip_prefix(','))?;
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match (c, fields.last_mut()) {
            ('"', _) => quoted = !quoted,
            (',', _) if !quoted => fields.push(String::new()),
            (c, Some(field)) => field.push(c),
            _ => {}
        }
    }
    Some(format!(" (mesh: {}; {})", fields.get(1)?, fields.get(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Cli;
    use clap::Parser;
    use std::collections::{HashMap, HashSet};

    #[test]
    fn every_row_is_a_command_line_and_has_a_name_of_its_own() {
        let mut names = HashSet::new();
        for row in sections().into_iter().flat_map(|(_, rows)| rows) {
            assert!(names.insert(row.name), "{} is there twice", row.name);
            assert!(!row.about.is_empty(), "{} is not described", row.name);
            let words = |line: &str| -> Vec<String> {
                format!("ricci {line}").replace("{}", "m.obj").split(' ').map(String::from).collect()
            };
            if let Made(line, _) = row.source {
                Cli::try_parse_from(words(&format!("make {line} -o {{}}"))).unwrap();
            }
            let (first, last) = row.draw.rsplit_once(" && ").unwrap_or(("", row.draw));
            for line in first.split(" && ").filter(|line| !line.is_empty()) {
                Cli::try_parse_from(words(line)).unwrap();
            }
            if !last.is_empty() {
                Cli::try_parse_from(words(&format!("{last} --picture p.png"))).unwrap();
            }
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/pictures");
        let drawn: HashSet<String> = std::fs::read_dir(folder)
            .unwrap()
            .filter_map(|entry| entry.unwrap().file_name().to_str()?.strip_suffix(".png").map(String::from))
            .collect();
        // Scripts beside the pages of results draw the others.
        let page = include_str!("../../../docs/results/teichmuller.md");
        let (on_the_page, rest): (HashSet<_>, HashSet<_>) =
            drawn.into_iter().partition(|name| page.contains(&format!("(../pictures/{name}.png)")));
        assert_eq!(on_the_page.len(), 2, "{on_the_page:?}");
        assert_eq!(names.into_iter().map(String::from).collect::<HashSet<_>>(), rest);
    }

    #[test]
    fn each_figure_of_the_paper_has_rows_and_one_on_a_generated_surface() {
        let rows: HashMap<_, _> =
            sections().into_iter().flat_map(|(_, rows)| rows).map(|row| (row.name, row)).collect();
        let figures = figures();
        let numbers: Vec<_> = figures.iter().map(|figure| figure.0.to_string()).collect();
        assert_eq!(numbers, (1..=15).map(|n| n.to_string()).collect::<Vec<_>>());
        let page = include_str!("../../../docs/results/gallery.md");
        for (number, about, names) in figures {
            assert!(!about.is_empty(), "{number}");
            assert!(matches!(rows[names[0]].source, Made(..)), "figure {number} needs a corpus");
            let line = page.lines().find(|line| line.starts_with(&format!("| {number} |"))).unwrap();
            for name in names {
                assert!(rows.contains_key(name), "{name}");
                assert!(
                    line.contains(&format!("`{name}`")),
                    "docs/results/gallery.md lacks {name} in figure {number}"
                );
            }
        }
    }

    #[test]
    fn what_is_up_is_read_from_the_command() {
        let up = |draw| GalleryRow { name: "m", source: Corpus("m"), draw, about: "" }.up();
        assert_eq!(up("info {} --up=-z --view 1,2"), Some([0.0, 0.0, -1.0]));
        assert_eq!(up("flow {} --up x"), Some([1.0, 0.0, 0.0]));
        assert_eq!(up("flow {}"), None);
    }

    #[test]
    fn credits_are_read_from_quoted_columns() {
        let index = "name,file,source,licence\nbob,bob.obj,a/b,\"MIT (repo); x, y\",7\n";
        assert_eq!(credit(index, "bob").unwrap(), " (mesh: a/b; MIT (repo); x, y)");
        assert!(credit(index, "bo").is_none());
    }
}

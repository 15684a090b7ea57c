//! `ricci gallery`: one picture per kind of surface and of picture, each by the command line that is written beside it.

use crate::cli::{Command, GalleryArgs};
use crate::csv::read_text;
use crate::demo::{execute, make_directory, parse};
use crate::failure::Failure;
use crate::output::Outputs;
use crate::report::path_text;
use crate::{info, make, say, spline};
use ricci::Control;
use std::path::Path;

/// The pictures, a line each.
const PICTURES: &str = include_str!("gallery.txt");

/// What other programs' pictures of the same layouts look like; it ends the page where the corpus is at hand.
const BESIDE: &str = include_str!("gallery_beside.md");

/// One picture. In the command lines `{}` stands for the surface's file, `{spline}` for a spline's, `{other}` for a second surface's and `{=NAME}` for that of a
/// mesh of the corpus.
struct Row {
    name: &'static str,
    source: Source,
    /// `flow …`, `uniformize …`, `cover …`, `circles …`, `harmonic …`, `forms …`, `structure …`, `match …`, `spline …` or `info …`, or such commands with ` && ` between them, of which the last one draws; for
    /// what `make` draws itself nothing.
    draw: &'static str,
    about: &'static str,
}

enum Source {
    /// What `ricci make` is given, and the extension of the file that it writes.
    Made(&'static str, &'static str),
    /// The name of a mesh of the corpus.
    Corpus(&'static str),
}

use Source::{Corpus, Made};

/// The rows of [`PICTURES`] under their titles.
fn sections() -> Vec<(&'static str, Vec<Row>)> {
    let row = |line: &'static str| {
        let mut fields = line.split('|').map(str::trim);
        let [name, source, draw, about] = [(); 4].map(|()| fields.next().unwrap_or_default());
        let source = match source.split_once(' ') {
            Some(("make", line)) => Made(line, "obj"),
            Some(("lengths", line)) => Made(line, "json"),
            _ => Corpus(source),
        };
        Row { name, source, draw, about }
    };
    let section = |text: &'static str| {
        let (title, rows) = text.split_once('\n').unwrap_or((text, ""));
        (title, rows.lines().filter(|line| !line.is_empty()).map(row).collect())
    };
    PICTURES.split("\n## ").skip(1).map(section).collect()
}

/// Pixels of the longer side of each panel.
const SIZE: u32 = 320;

/// Run the command; a picture that cannot be made is left out, with the reason in the table, and gives exit code 1.
pub fn run(args: &GalleryArgs, control: &Control) -> Result<u8, Failure> {
    make_directory(&args.out)?;
    let meshes = args.meshes.as_deref();
    let index = meshes.map_or(Ok(String::new()), |folder| read_text(&folder.join("good/INDEX.csv")))?;
    let mut page = PREFACE.to_string();
    let mut exit_code = 0;
    let scratch = tempfile::tempdir().map_err(|e| Failure::Failed(format!("no temporary directory: {e}")))?;
    let studio = Studio { args, scratch: scratch.path(), control };
    for (title, mut rows) in sections() {
        rows.retain(|row| meshes.is_some() || !matches!(row.source, Corpus(_)));
        if rows.is_empty() {
            continue;
        }
        page += &format!("\n## {title}\n\n| picture | what it is | by |\n|---|---|---|\n");
        for row in &rows {
            control.check()?;
            let (Row { name, about, .. }, shown) = (row, row.shown());
            let image = match studio.draw(row) {
                Ok(()) => format!("![{name}]({name}.png)"),
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                Err(failure) => {
                    exit_code = 1;
                    format!("left out: {}", failure.to_string().replace(['\n', '|'], " "))
                }
            };
            let credit = match row.source {
                Corpus(mesh) => credit(&index, mesh).unwrap_or_default(),
                _ => String::new(),
            };
            page += &format!("| {image} | **{name}**: {about}{credit} | {shown} |\n");
            if !args.common.quiet {
                say::lines(&format!("{name}: {shown}\n"), say::NO_FILES)?;
            }
        }
    }
    if meshes.is_some() {
        page += BESIDE;
    }
    let mut outputs = Outputs::default();
    outputs.add_bytes(&args.out.join("README.md"), page.as_bytes())?;
    outputs.commit()?;
    Ok(exit_code)
}

/// Where a mesh comes from, by the second and third column after its name.
fn credit(index: &str, mesh: &str) -> Option<String> {
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

const PREFACE: &str = "\
# Gallery

Written by `ricci gallery docs/pictures MESHES`, MESHES being a folder of meshes with `good/INDEX.csv`. On the left of a picture the
surface, on the right its layout; seams have one colour on both of their sides, cones are red where curvature is positive and blue where
it is negative. Checks and circles have one size in the layout; with `--bands` they are drawn 8 times as large or small where the
layout's scale varies by more than that. With `--zoom` both sides show the
surroundings of one vertex, as much of the surface as of its layout. Copies of a surface in its universal cover carry the same pattern; the
copy that the others are moved images of is blue. Every picture is made by the commands
beside it (with `--size 320 --palette`).
";

impl Row {
    /// The surface's file.
    fn file(&self) -> String {
        match self.source {
            Made(_, extension) => format!("{}.{extension}", self.name),
            Corpus(name) => format!("{name}.obj"),
        }
    }

    /// The command lines as a reader would type them.
    fn shown(&self) -> String {
        let (file, picture) = (self.file(), format!(" --picture {}.png", self.name));
        let make = match self.source {
            Made(line, _) => {
                let own = if self.draw.is_empty() { picture.as_str() } else { "" };
                Some(format!("`ricci make {line} -o {file}{own}`"))
            }
            Corpus(_) => None,
        };
        let draw = self.draw.replace("{}", &file).replace("{spline}", &format!("{}.json", self.name));
        let draw = draw.replace("{other}", &format!("{}-other.obj", self.name));
        let draw = draw.replace("{=", "").replace('}', ".obj");
        let draw =
            (!draw.is_empty()).then(|| format!("`ricci {}{picture}`", draw.replace(" && ", "`<br>`ricci ")));
        make.into_iter().chain(draw).collect::<Vec<_>>().join("<br>")
    }
}

/// Where pictures are made.
struct Studio<'a> {
    args: &'a GalleryArgs,
    /// A directory for surfaces.
    scratch: &'a Path,
    control: &'a Control,
}

impl Studio<'_> {
    /// Make the picture of a row.
    fn draw(&self, row: &Row) -> Result<(), Failure> {
        let GalleryArgs { out, meshes, common } = self.args;
        let surface = match (&row.source, meshes) {
            (Corpus(_), Some(folder)) => folder.join("good").join(row.file()),
            _ => self.scratch.join(row.file()),
        };
        let words = |line: String| -> Vec<String> {
            let to = |word: &str| match word {
                "{}" => path_text(&surface),
                "{spline}" => path_text(&self.scratch.join(format!("{}.json", row.name))),
                "{other}" => path_text(&self.scratch.join(format!("{}-other.obj", row.name))),
                "PICTURE" => path_text(&out.join(format!("{}.png", row.name))),
                word => match (word.strip_prefix("{="), meshes) {
                    (Some(name), Some(folder)) => {
                        path_text(&folder.join("good").join(name.replace('}', ".obj")))
                    }
                    _ => word.into(),
                },
            };
            line.split_whitespace().map(to).collect()
        };
        let quiet = format!("--quiet --threads={}", common.threads);
        let drawing = format!("--picture PICTURE --size={SIZE} --palette {quiet}");
        if let Made(line, _) = row.source {
            let own = if row.draw.is_empty() { &drawing } else { &quiet };
            if let Command::Make(args) = parse(words(format!("make {line} -o {{}} {own}")))? {
                make::run(&args)?;
            }
        }
        if row.draw.is_empty() {
            return Ok(());
        }
        let commands: Vec<&str> = row.draw.split(" && ").collect();
        for (i, line) in commands.iter().enumerate() {
            let options = if i + 1 == commands.len() { &drawing } else { &quiet };
            self.run(parse(words(format!("{line} {options}")))?)?;
        }
        Ok(())
    }

    /// Run a command, whose checks must hold.
    fn run(&self, command: Command) -> Result<(), Failure> {
        let failed = |checks: String| Err(Failure::Failed(format!("these checks fail: {checks}")));
        match command {
            Command::Make(args) => make::run(&args).map(|_| ()),
            Command::Info(args) => info::run(&args, self.control).map(|_| ()),
            Command::Spline(args) => match spline::run(&args, self.control)? {
                0 => Ok(()),
                _ => failed("those of the spline".into()),
            },
            command => match execute(command, self.control)?.checks.failed().as_slice() {
                [] => Ok(()),
                checks => failed(format!("{checks:?}")),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Cli;
    use clap::Parser;
    use std::collections::HashSet;

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
        assert_eq!(names.into_iter().map(String::from).collect::<HashSet<_>>(), drawn);
    }

    #[test]
    fn credits_are_read_from_quoted_columns() {
        let index = "name,file,source,licence\nbob,bob.obj,a/b,\"MIT (repo); x, y\",7\n";
        assert_eq!(credit(index, "bob").unwrap(), " (mesh: a/b; MIT (repo); x, y)");
        assert!(credit(index, "bo").is_none());
    }
}

//! `ricci gallery`: one picture per kind of surface and of picture, each by the command line that is written beside it.

use crate::cli::{Command, GalleryArgs};
use crate::demo::parse;
use crate::failure::Failure;
use crate::input::read_text;
use crate::output::Outputs;
use crate::report::Checks;
use crate::{flow, info, make, say, uniform};
use ricci::Control;
use std::io::Write;
use std::path::Path;

/// The pictures, a line each.
const PICTURES: &str = include_str!("gallery.txt");

/// One picture. In the command lines `{}` stands for the surface's file.
struct Row {
    name: &'static str,
    source: Source,
    /// `flow …`, `uniformize …`, `cover …` or `info …`; for what `make` draws itself nothing.
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
    let out = &args.out;
    std::fs::create_dir_all(out)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", out.display())))?;
    let meshes = args.meshes.as_deref();
    let index = meshes.map_or(Ok(String::new()), |folder| read_text(&folder.join("good/INDEX.csv")))?;
    let mut page = PREFACE.to_string();
    let mut exit_code = 0;
    let scratch = tempfile::tempdir().map_err(|e| Failure::Failed(format!("no temporary directory: {e}")))?;
    for (title, mut rows) in sections() {
        rows.retain(|row| meshes.is_some() || !matches!(row.source, Corpus(_)));
        if rows.is_empty() {
            continue;
        }
        page += &format!("\n## {title}\n\n| picture | what it is | by |\n|---|---|---|\n");
        for row in &rows {
            control.check()?;
            let (shown, result) = draw(row, out, scratch.path(), meshes, args, control);
            let Row { name, about, .. } = row;
            let image = match result {
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
                say::lines(&format!("{name}: {shown}\n"));
            }
        }
    }
    let mut outputs = Outputs::default();
    outputs.add(&out.join("README.md"), |file| file.write_all(page.as_bytes()))?;
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
it is negative. Where the layout's scale varies by more than a factor of 8, checks and circles are drawn 8 times as large or small, on
both sides alike, so that they stay visible: along the line where that happens they are cut off. With `--zoom` both sides show the
surroundings of one vertex, as much of the surface as of its layout. Copies of a surface in its universal cover carry the same pattern; the
copy that the others are moved images of is blue. Every picture is made by the commands
beside it (with `--size 320 --palette`).
";

/// Draw a row; returns the command lines as a reader would type them.
fn draw(
    row: &Row,
    out: &Path,
    scratch: &Path,
    meshes: Option<&Path>,
    args: &GalleryArgs,
    control: &Control,
) -> (String, Result<(), Failure>) {
    let mut shown = Vec::new();
    let (make, file) = match row.source {
        Made(line, extension) => (Some(line), format!("{}.{extension}", row.name)),
        Corpus(name) => (None, format!("{name}.obj")),
    };
    let path = match meshes {
        Some(folder) if make.is_none() => folder.join("good").join(&file),
        _ => scratch.join(&file),
    };
    let picture = out.join(format!("{}.png", row.name));
    let small = format!("--size={SIZE} --palette");
    let quiet = format!("--quiet --threads={}", args.common.threads());
    let words = |line: &str| -> Vec<String> {
        let to = |word: &str| match word {
            "{}" => path.to_string_lossy().into_owned(),
            "PICTURE" => picture.to_string_lossy().into_owned(),
            word => word.into(),
        };
        line.split_whitespace().map(to).collect()
    };
    let drawing = format!("--picture PICTURE {small} {quiet}");
    let run = || -> Result<(), Failure> {
        if let Some(line) = make {
            let own = if row.draw.is_empty() { drawing.as_str() } else { quiet.as_str() };
            if let Command::Make(args) = parse(words(&format!("make {line} -o {{}} {own}")))? {
                make::run(&args)?;
            }
        }
        match row.draw {
            "" => Ok(()),
            line => match parse(words(&format!("{line} {drawing}")))? {
                Command::Flow(args) => held(&flow::execute(&args, control)?.checks),
                Command::Uniformize(args) => held(&uniform::execute_uniformize(&args, control)?.checks),
                Command::Cover(args) => held(&uniform::execute_cover(&args, control)?.checks),
                Command::Info(args) => info::run(&args, control).map(|_| ()),
                other => Err(Failure::Failed(format!("{other:?} draws nothing"))),
            },
        }
    };
    let result = run();
    let name = format!("--picture {}.png", row.name);
    if let Some(line) = make {
        let own = if row.draw.is_empty() { format!(" {name}") } else { String::new() };
        shown.push(format!("`ricci make {line} -o {file}{own}`"));
    }
    if !row.draw.is_empty() {
        shown.push(format!("`ricci {} {name}`", row.draw.replace("{}", &file)));
    }
    (shown.join("<br>"), result)
}

/// A failure if a check does not hold.
fn held(checks: &Checks) -> Result<(), Failure> {
    match checks.failed().as_slice() {
        [] => Ok(()),
        failed => Err(Failure::Failed(format!("these checks fail: {failed:?}"))),
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
            if !row.draw.is_empty() {
                Cli::try_parse_from(words(&format!("{} --picture p.png", row.draw))).unwrap();
            }
        }
        assert_eq!((sections().len(), names.len()), (5, 61));
    }

    #[test]
    fn credits_are_read_from_quoted_columns() {
        let index = "name,file,source,licence\nbob,bob.obj,a/b,\"MIT (repo); x, y\",7\n";
        assert_eq!(credit(index, "bob").unwrap(), " (mesh: a/b; MIT (repo); x, y)");
        assert!(credit(index, "bo").is_none());
    }
}

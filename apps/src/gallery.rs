//! `ricci gallery`: one picture per kind of surface and of picture, each made by the command line that is written beside it; and a page with
//! all of them, under the figures of the paper, with views that turn.

mod page;
mod rows;
mod view;

use crate::cli::{Command, GalleryArgs};
use crate::csv::read_text;
use crate::demo::{execute, make_directory, parse};
use crate::failure::Failure;
use crate::output::Outputs;
use crate::page::PageView;
use crate::report::path_text;
use crate::{runner, say, spline};
use page::{Exhibit, PageSection};
use ricci::Control;
use rows::RowSource::{Corpus, Made};
use rows::{GalleryRow, credit, figures, sections};
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use view::Companion;

/// A description of other programs' pictures of the same layouts; it ends the page where the corpus is at hand.
const BESIDE: &str = include_str!("gallery/beside.md");

/// The options of `ricci spline eval` that write a spline for its view.
const TESSELLATED: &str = "--tessellate 8 --out VIEW";

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
    let studio = GalleryMaker { args, scratch: scratch.path(), control };
    let mut shown_parts = Vec::new();
    for (title, mut rows) in sections() {
        rows.retain(|row| meshes.is_some() || !matches!(row.source, Corpus(_)));
        if rows.is_empty() {
            continue;
        }
        page += &format!("\n## {title}\n\n| picture | what it is | by |\n|---|---|---|\n");
        let mut exhibits = Vec::new();
        for row in &rows {
            control.check()?;
            let exhibit = studio.exhibit(row, &index)?;
            let Exhibit { name, about, commands, picture, .. } = &exhibit;
            let image = match picture {
                Ok(_) => format!("![{name}]({name}.png)"),
                Err(why) => {
                    exit_code = 1;
                    format!("left out: {}", why.replace(['\n', '|'], " "))
                }
            };
            let shown = commands.iter().map(|line| format!("`{line}`")).collect::<Vec<_>>().join("<br>");
            page += &format!("| {image} | **{name}**: {about} | {shown} |\n");
            if !args.common.quiet {
                say::lines(&format!("{name}: {shown}\n"), say::NO_FILES)?;
            }
            exhibits.push(exhibit);
        }
        shown_parts.push((title, exhibits));
    }
    if meshes.is_some() {
        page += BESIDE;
    }
    let mut outputs = Outputs::default();
    outputs.add_bytes(&args.out.join("README.md"), page.as_bytes())?;
    outputs.add_bytes(&args.out.join("index.html"), page::write(&by_figure(shown_parts))?.as_bytes())?;
    outputs.commit()?;
    Ok(exit_code)
}

/// The sections of the page: first the figures of the paper, then all pictures that are in none of them, under their own titles. No picture
/// stands there twice.
fn by_figure(sections: Vec<(&'static str, Vec<Exhibit>)>) -> Vec<PageSection> {
    let mut order = Vec::new();
    let mut open = HashMap::new();
    let mut known = HashSet::new();
    for (title, exhibits) in sections {
        for exhibit in exhibits {
            order.push((title, exhibit.name));
            known.insert(exhibit.name);
            open.insert(exhibit.name, exhibit);
        }
    }
    let mut parts = Vec::new();
    for (number, about, rows) in figures() {
        let mut part = PageSection {
            title: format!("Figure {number}. {about}"),
            exhibits: Vec::new(),
            earlier: Vec::new(),
        };
        for name in rows.into_iter().filter(|name| known.contains(name)) {
            match open.remove(name) {
                Some(exhibit) => part.exhibits.push(exhibit),
                None => part.earlier.push(name),
            }
        }
        parts.push(part);
    }
    for (title, name) in order {
        let Some(exhibit) = open.remove(name) else { continue };
        match parts.last_mut().filter(|part| part.title == title) {
            Some(part) => part.exhibits.push(exhibit),
            None => {
                parts.push(PageSection { title: title.into(), exhibits: vec![exhibit], earlier: Vec::new() })
            }
        }
    }
    parts
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

/// The maker of the pictures.
struct GalleryMaker<'a> {
    args: &'a GalleryArgs,
    /// A directory for surfaces.
    scratch: &'a Path,
    control: &'a Control,
}

impl GalleryMaker<'_> {
    /// Make the picture of a row, with its commands, its report and its view.
    fn exhibit(&self, row: &GalleryRow, index: &str) -> Result<Exhibit, Failure> {
        let told = |why: String| why.replace(&path_text(self.scratch), "…");
        let (picture, report, view) = match self.draw(row) {
            Ok((report, view)) => (self.picture(row), report, view),
            Err(Failure::Cancelled) => return Err(Failure::Cancelled),
            Err(failure) => (Err(told(failure.to_string())), None, Err(String::new())),
        };
        let credit = match row.source {
            Corpus(mesh) => credit(index, mesh).unwrap_or_default(),
            _ => String::new(),
        };
        let about = format!("{}{credit}", row.about);
        Ok(Exhibit {
            name: row.name,
            about,
            commands: row.shown(),
            picture,
            report,
            view: view.map_err(told),
        })
    }

    /// The bytes of a row's picture.
    fn picture(&self, row: &GalleryRow) -> Result<Vec<u8>, String> {
        let file = self.args.out.join(format!("{}.png", row.name));
        std::fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))
    }

    /// The file with a row's surface.
    fn surface(&self, row: &GalleryRow) -> PathBuf {
        match (&row.source, &self.args.meshes) {
            (Corpus(_), Some(folder)) => folder.join("good").join(row.file()),
            _ => self.scratch.join(row.file()),
        }
    }

    /// The words of a command line of a row.
    fn words(&self, row: &GalleryRow, line: &str) -> Vec<String> {
        let own = |suffix: &str| path_text(&self.scratch.join(format!("{}{suffix}", row.name)));
        let to = |word: &str| match word {
            "{}" => path_text(&self.surface(row)),
            "{spline}" => own(".json"),
            "{other}" => own("-other.obj"),
            "REPORT" => own("-report.json"),
            "VIEW" => own("-view.obj"),
            "PICTURE" => path_text(&self.args.out.join(format!("{}.png", row.name))),
            word => match (word.strip_prefix("{="), &self.args.meshes) {
                (Some(name), Some(folder)) => path_text(&folder.join("good").join(name.replace('}', ".obj"))),
                _ => word.into(),
            },
        };
        line.split_whitespace().map(to).collect()
    }

    /// Make the picture of a row; returned are the report of its last command, and its view or why there is none.
    fn draw(&self, row: &GalleryRow) -> Result<(Option<Value>, Result<PageView, String>), Failure> {
        let quiet = format!("--quiet --threads={}", self.args.common.threads);
        let drawing = format!("--picture PICTURE --size={SIZE} --palette {quiet}");
        if let Made(line, _) = row.source {
            let own = if row.draw.is_empty() { &drawing } else { &quiet };
            if let Command::Make(args) = parse(self.words(row, &format!("make {line} -o {{}} {own}")))? {
                runner::run(&args, self.control)?;
            }
        }
        let (surface, written) = (self.surface(row), self.scratch.join(format!("{}-view.obj", row.name)));
        let beside = row.beside(&surface);
        if !row.draw.is_empty() {
            let view = match &beside {
                Ok((_, option)) if !option.is_empty() => format!("{option} VIEW"),
                _ => String::new(),
            };
            let commands: Vec<&str> = row.draw.split(" && ").collect();
            for (i, line) in commands.iter().enumerate() {
                let options = if i + 1 == commands.len() {
                    format!("{drawing} {view} --report REPORT")
                } else {
                    quiet.clone()
                };
                self.run(parse(self.words(row, &format!("{line} {options}")))?)?;
            }
        }
        let report = std::fs::read(self.scratch.join(format!("{}-report.json", row.name)));
        let report = report.ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let view = match beside {
            Err(why) => Err(why),
            Ok((beside @ Companion::Texture, _)) => view::read(&written, beside, &written, row.up())?,
            Ok((Companion::Alone, _)) if row.draw.contains("{spline}") => {
                self.run(parse(self.words(row, &format!("spline eval {{spline}} {TESSELLATED} {quiet}")))?)?;
                view::read(&written, Companion::Alone, &written, row.up())?
            }
            Ok((beside, _)) => view::read(&surface, beside, &written, row.up())?,
        };
        Ok((report, view))
    }

    /// Run a command, whose checks must hold.
    fn run(&self, command: Command) -> Result<(), Failure> {
        let failed = |checks: String| Err(Failure::Failed(format!("these checks fail: {checks}")));
        match command {
            Command::Make(args) => runner::run(&args, self.control).map(drop),
            Command::Info(args) => runner::run(&args, self.control).map(drop),
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

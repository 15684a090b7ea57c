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

/// One picture. In the command lines `{}` stands for the surface's file.
struct Row {
    name: &'static str,
    /// What `ricci make` is given, or the name of a mesh of the corpus.
    source: Source,
    /// `flow …`, `uniformize …`, `cover …` or `info …`; for what `make` draws itself nothing.
    draw: &'static str,
    about: &'static str,
}

enum Source {
    /// A surface in space.
    Made(&'static str),
    /// A surface given by its edge lengths.
    Lengths(&'static str),
    Corpus(&'static str),
}

use Source::{Corpus, Lengths, Made};

const fn row(name: &'static str, source: Source, draw: &'static str, about: &'static str) -> Row {
    Row { name, source, draw, about }
}

/// One row per generator.
const GENERATORS: &[Row] = &[
    row("sphere", Made("sphere"), "flow {}", "four cones of π, flat elsewhere"),
    row("ellipsoid", Made("ellipsoid"), "flow {} --texture circles", "circles stay circles"),
    row("torus", Made("torus"), "flow {}", "flat: a parallelogram up to its seams"),
    row("disk", Made("disk --height 0.4"), "flow {}", "a bumpy disk, its curvature spread over the boundary"),
    row("annulus", Made("annulus --height 0.4"), "flow {}", "a bumpy ring"),
    row(
        "genus2",
        Made("genus"),
        "flow {} --space e2 --target single:0",
        "all of −4π at one vertex, flat elsewhere",
    ),
    row("genus4", Made("genus --genus 4 --ratio 2"), "", "handles in a row, the first hole twice as wide"),
    row("holes", Made("sphere --n 24 --holes 5"), "flow {}", "a sphere with five round holes"),
    row(
        "disk-holes",
        Made("disk --n 16 --height 0.4 --holes 4"),
        "flow {} --color u",
        "a bumpy disk with four holes: its conformal factor",
    ),
    row(
        "handlebody-holes",
        Made("genus --n 5 --holes 3"),
        "info {} --up=-z --view 180,35",
        "genus 2 with three boundary loops, seen from below",
    ),
    row("knot", Made("knot"), "flow {} --color u", "a knotted torus is a torus: its conformal factor"),
    row("noise", Made("torus --noise 0.25 --seed 1"), "flow {}", "vertices moved by a quarter of an edge"),
    row(
        "graded",
        Made("sphere --n 1 --grade 0,7"),
        "info {} --wire --view 20,30",
        "an icosahedron, edges halved around a vertex, seven times",
    ),
    row(
        "slivers",
        Made("disk --n 4 --slivers 24 --sliver-angle 0.08"),
        "info {} --wire --view 0,90",
        "24 faces cut into three, one of them a cap with angles of 0.08",
    ),
    row(
        "flat-torus",
        Lengths("flat-torus --tau 0.3 0.9"),
        "flow {} --wire",
        "given by its edge lengths alone",
    ),
    row(
        "bolza",
        Lengths("bolza --level 4"),
        "flow {} --space e2 --target single:0",
        "the Bolza surface, flat but for one vertex",
    ),
    row("hyperelliptic", Lengths("hyperelliptic"), "flow {} --space e2 --target single:0", "y² = x⁶ − 1"),
    row("one-vertex", Lengths("one-vertex"), "flow {} --space e2 --wire", "genus 2 with a single vertex"),
    row(
        "two-vertex",
        Lengths("two-vertex"),
        "flow {} --space e2 --target single:0 --wire",
        "genus 2 with two vertices",
    ),
    row("two-triangles", Lengths("two-triangles"), "flow {} --wire", "a sphere of two triangles"),
    row("pants", Lengths("pants"), "flow {}", "a pair of pants, flat but for its boundary"),
];

/// One real surface per topological class; closed ones of genus 2 and more in their hyperbolic metric.
const CLASSES: &[Row] = &[
    row("spot", Corpus("spot_low"), "flow {}", "genus 0, closed: four cones"),
    row("face", Corpus("face_1180"), "flow {} --up x", "a disk"),
    row("station", Corpus("train_station"), "flow {}", "an annulus"),
    row("eight-open", Corpus("eight_open"), "flow {}", "genus 0 with four boundary loops"),
    row("bob", Corpus("bob"), "flow {}", "genus 1"),
    row("punctured-torus", Corpus("punctured_torus"), "flow {}", "genus 1 with a boundary"),
    row("eight", Corpus("eight_766"), "flow {} --color u", "genus 2: factor of its hyperbolic metric"),
    row("eight-hole", Corpus("eight_hole"), "flow {} --scheme inversive", "genus 2 with a boundary"),
    row("pretzel", Corpus("pretzel"), "flow {} --color u", "genus 3: factor of its hyperbolic metric"),
    row(
        "bamboo",
        Corpus("bamboo_pen"),
        "flow {} --color u --wire",
        "genus 8: factor of its hyperbolic metric",
    ),
];

/// Closed surfaces in the sphere, the plane and the hyperbolic plane, and what tiles these.
const CANONICAL: &[Row] = &[
    row(
        "two-surface",
        Made("genus -n 8"),
        "uniformize {}",
        "genus 2: the loops of its four generators, and the surface opened in the Poincaré disk",
    ),
    row(
        "two-domain",
        Made("genus -n 8"),
        "uniformize {} --show domain",
        "its fundamental domain; sides of one colour are glued, by the deck transformation that is named",
    ),
    row(
        "two-dirichlet",
        Made("genus -n 8"),
        "uniformize {} --show dirichlet",
        "the Dirichlet domain of the base point, with geodesic sides",
    ),
    row(
        "two-polygon",
        Made("genus -n 8"),
        "uniformize {} --show polygon",
        "the canonical polygon a1 b1 a1⁻¹ b1⁻¹ a2 b2 a2⁻¹ b2⁻¹",
    ),
    row("two-cover", Made("genus -n 8"), "cover {} --radius 7", "its universal cover in the Poincaré disk"),
    row(
        "two-tiles",
        Made("genus -n 8"),
        "cover {} --radius 7 --show tiles",
        "the same, tiled by Dirichlet domains",
    ),
    row(
        "two-klein",
        Made("genus -n 8"),
        "cover {} --radius 7 --show tiles --model klein",
        "in the Klein disk, where geodesics are straight",
    ),
    row(
        "two-half-plane",
        Made("genus -n 8"),
        "cover {} --radius 7 --model half-plane",
        "in the upper half-plane",
    ),
    row(
        "bolza-tiles",
        Lengths("bolza --level 3"),
        "cover {} --radius 6 --show tiles --base 0",
        "the Bolza surface: regular octagons",
    ),
    row("torus-cover", Made("torus --noise 0.2"), "cover {} --radius 20", "a torus tiles the plane"),
    row("ball", Made("ellipsoid"), "uniformize {}", "an ellipsoid on the sphere"),
    row("spot-sphere", Corpus("spot_low"), "uniformize {}", "genus 0 on the sphere"),
    row("bob-plane", Corpus("bob"), "uniformize {}", "genus 1 in the plane"),
    row("eight-disk", Corpus("eight_766"), "uniformize {}", "genus 2 in the hyperbolic plane"),
    row("eight-cover", Corpus("eight_766"), "cover {} --radius 6.5", "and its universal cover"),
    row("pretzel-disk", Corpus("pretzel"), "uniformize {}", "genus 3"),
];

/// Cones that the library places, charts of what overlaps itself, and the pieces of common refinements.
const ATLASES: &[Row] = &[
    row(
        "bunny-cones",
        Corpus("bunny_libigl"),
        "flow {} --target auto:8",
        "eight cones placed by the library",
    ),
    row(
        "bunny-charts",
        Corpus("bunny_libigl"),
        "flow {} --target auto:20 --charts",
        "twenty cones: a layout that overlaps itself, in charts that do not",
    ),
    row(
        "planck-cones",
        Corpus("max_planck_25k"),
        "flow {} --target auto:8 --charts --up y --view 205,8",
        "another scan with eight cones, in one chart",
    ),
    row(
        "face-cones",
        Corpus("face_bff"),
        "flow {} --target auto:6 --charts",
        "an open scan with six cones, its boundary free, in charts",
    ),
    row(
        "pretzel-charts",
        Corpus("pretzel"),
        "flow {} --space e2 --target auto:16 --charts",
        "genus 3, flat but for sixteen cones, in charts",
    ),
    row(
        "pieces",
        Made("torus --noise 0.25 --seed 1"),
        "flow {} --color pieces --zoom 300,5",
        "pieces of the common refinement: the input's faces, of one shade each, are triangles on the left, the final ones, of one hue each, on the right",
    ),
    row(
        "pieces-slivers",
        Corpus("plate_holes"),
        "flow {} --space e2 --target auto:8 --color pieces --zoom 100,3",
        "the same where slivers of the input cross many final faces",
    ),
];

/// One picture for each pattern and each colour map.
const LOOKS: &[Row] = &[
    row("bob-circles", Corpus("bob"), "flow {} --texture circles", "circles of the layout"),
    row("bob-u", Corpus("bob"), "flow {} --color u", "conformal factor"),
    row("bob-area", Corpus("bob"), "flow {} --color area", "area in the layout over area on the surface"),
    row("bob-qc", Corpus("bob"), "flow {} --color qc", "quasi-conformal dilatation"),
    row("bob-curvature", Corpus("bob"), "info {} --color curvature", "Gaussian curvature"),
    row("wire", Corpus("eight_open"), "flow {} --texture none --wire", "the mesh on both sides"),
    row(
        "packing",
        Corpus("eight_open"),
        "flow {} --scheme tangential",
        "a circle packing and its dual circles",
    ),
];

/// Pixels of a panel.
const SIZE: u32 = 320;

/// Run the command; a picture that cannot be made is left out, with the reason in the table, and gives exit code 1.
pub fn run(args: &GalleryArgs, control: &Control) -> Result<u8, Failure> {
    let out = &args.out;
    std::fs::create_dir_all(out)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", out.display())))?;
    let meshes = args.meshes.as_deref();
    let index = meshes.map_or(Ok(String::new()), |folder| read_text(&folder.join("good/INDEX.csv")))?;
    let sections: [(&str, &[Row]); 5] = [
        ("Generators", GENERATORS),
        ("Real surfaces, one per topological class", CLASSES),
        ("Sphere, plane and hyperbolic plane", CANONICAL),
        ("Cones, charts and pieces", ATLASES),
        ("Patterns and colour maps", LOOKS),
    ];
    let mut page = PREFACE.to_string();
    let mut exit_code = 0;
    let scratch = tempfile::tempdir().map_err(|e| Failure::Failed(format!("no temporary directory: {e}")))?;
    for (title, rows) in sections {
        let wanted = |row: &&Row| meshes.is_some() || !matches!(row.source, Corpus(_));
        let rows: Vec<&Row> = rows.iter().filter(wanted).collect();
        if rows.is_empty() {
            continue;
        }
        page += &format!("\n## {title}\n\n| picture | what it is | by |\n|---|---|---|\n");
        for row in rows {
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
    let (make, file, place) = match (&row.source, meshes) {
        (Made(line), _) => (Some(*line), format!("{}.obj", row.name), scratch),
        (Lengths(line), _) => (Some(*line), format!("{}.json", row.name), scratch),
        (Corpus(name), folder) => (None, format!("{name}.obj"), folder.unwrap_or(scratch)),
    };
    let path = match row.source {
        Corpus(_) => place.join("good").join(&file),
        _ => place.join(&file),
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
        for row in GENERATORS.iter().chain(CLASSES).chain(CANONICAL).chain(ATLASES).chain(LOOKS) {
            assert!(names.insert(row.name), "{} is there twice", row.name);
            let words = |line: &str| {
                format!("ricci {line}")
                    .replace("{}", "m.obj")
                    .split(' ')
                    .map(String::from)
                    .collect::<Vec<_>>()
            };
            if let Made(line) | Lengths(line) = row.source {
                Cli::try_parse_from(words(&format!("make {line} -o {{}}"))).unwrap();
            }
            if !row.draw.is_empty() {
                Cli::try_parse_from(words(&format!("{} --picture p.png", row.draw))).unwrap();
            }
        }
    }

    #[test]
    fn credits_are_read_from_quoted_columns() {
        let index = "name,file,source,licence\nbob,bob.obj,a/b,\"MIT (repo); x, y\",7\n";
        assert_eq!(credit(index, "bob").unwrap(), " (mesh: a/b; MIT (repo); x, y)");
        assert!(credit(index, "bo").is_none());
    }
}

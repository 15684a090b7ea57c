//! `ricci repair`.

use crate::failure::Failure;
use crate::info::{DefectFigures, Defects};
use crate::input::read_triangles;
use crate::options::{Common, FileName, distance};
use crate::output::{Outputs, check_extension, check_outputs, extension, format_of};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Counts, Figures, InputSummary, Report, Seconds, timed};
use crate::say::{self, count};
use crate::show;
use clap::Args;
use ricci::Control;
use ricci::control::Stage;
use ricci::mesh::check::diagnose;
use ricci::mesh::io;
use ricci::mesh::repair::{RefusedWeld, Repair, Repaired, repair};
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

pub const HELP: &str = "\
Example: the largest piece of a scan, welded within 1e-6, and where its vertices and faces came from
    ricci repair scan.stl -o clean.ply --weld 1e-6 --component 0 --map origin.json

Always: weld vertices in the same place (but not in edges in which more than two faces would meet: these are told), drop faces
that use a vertex twice or repeat a face, give every fan of faces a vertex of its own, turn faces until neighbours agree, drop
isolated vertices.
The exit code is 1 if a defect is left that needs a guess; the file is written all the same.";

#[derive(Args, Serialize, Debug)]
pub struct RepairArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii)
    #[serde(skip)]
    pub mesh: PathBuf,
    /// Repaired mesh (.obj, .off, .ply, .glb)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: FileName,
    /// Weld vertices within this distance; 0 welds those in exactly the same place
    #[arg(long, value_name = "DISTANCE", default_value_t = 0.0, value_parser = distance)]
    #[serde(skip)]
    pub weld: f64,
    /// Weld nothing
    #[arg(long, conflicts_with = "weld")]
    #[serde(skip)]
    pub no_weld: bool,
    /// Cut the surface open along edges in which more than two faces meet
    #[arg(long)]
    pub cut_edges: bool,
    /// Keep one connected piece: 0 is that with the most faces
    #[arg(long, value_name = "K")]
    pub component: Option<usize>,
    /// Write the input's vertex of each vertex and the input's face of each face, numbered from 0
    #[arg(long, value_name = "MAP.json")]
    pub map: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// What was asked, with the distance of welding; null for none.
#[derive(Serialize)]
struct Asked<'a> {
    weld: Option<f64>,
    #[serde(flatten)]
    args: &'a RepairArgs,
}

/// `--map`: for each vertex and face of the result its number in the input, from 0.
#[derive(Serialize)]
struct MapFile<'a> {
    vertex_origin: &'a [u32],
    face_origin: &'a [u32],
}

/// Run the command: 0 if the result is a surface that the other commands accept, 1 if a defect is left.
pub fn run(args: &RepairArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    check_extension("-o", Some(&args.out), &["obj", "off", "ply", "glb"])?;
    let picture = args.picture.base.picture.as_deref();
    check_extension("--picture", picture, &["png"])?;
    let files = [Some(&*args.out), args.map.as_deref(), picture, args.common.report.as_deref()];
    check_outputs(&[Some(&args.mesh)], &files)?;
    let mut seconds = Seconds::default();
    control.step(Stage::Read, 0.0)?;
    let soup = timed(&mut seconds.read, || read_triangles(&args.mesh))?;
    control.step(Stage::Build, 0.0)?;
    let weld = (!args.no_weld).then_some(args.weld);
    let options = Repair { weld, cut_non_manifold_edges: args.cut_edges, component: args.component };
    let done = timed(&mut seconds.build, || repair(&soup, &options))?;
    control.step(Stage::Write, 0.0)?;
    let mut outputs = Outputs::default();
    let left_out = timed(&mut seconds.write, || write(args, &done, &mut outputs))?;
    let defects = Defects::of(&done.soup, &done.diagnosis);
    let (text, is_left) = (text(args, &done, &defects, &left_out), !defects.list.is_empty());
    if let Some(path) = &args.common.report {
        let input = InputSummary::new(&args.mesh, &diagnose(&soup.positions, &soup.faces));
        let mut checks = Checks::default();
        checks.add("defects", defects.list.len() as f64, 0.0);
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("repair", input, Asked { weld, args }, figures(&done, left_out, &defects));
        outputs.add_report(path, &report.finished(checks, seconds))?;
    }
    control.check()?;
    let files = outputs.commit()?;
    if !args.common.quiet {
        say::lines(&text, &files)?;
    }
    Ok(u8::from(is_left))
}

/// Write the surface, the map back and the picture; returns what the surface's format leaves out.
fn write(args: &RepairArgs, done: &Repaired, outputs: &mut Outputs) -> Result<Vec<&'static str>, Failure> {
    let (format, soup) = (format_of(&args.out)?, &done.soup);
    let left_out = outputs.add_named(&args.out, |path| io::write_as(path, format, soup))?;
    if let Some(path) = &args.map {
        let map = MapFile { vertex_origin: &done.vertex_origin, face_origin: &done.face_origin };
        outputs.add_json(path, &map)?;
    }
    if let Some(path) = &args.picture.base.picture {
        outputs.add_bytes(path, &show::draw_surface(soup, &args.picture, args.common.threads)?)?;
    }
    Ok(left_out)
}

/// What was done, what the result is, and what is left.
fn figures(done: &Repaired, left_out: Vec<&'static str>, defects: &Defects) -> Figures {
    let (steps, diagnosis) = (&done.steps, &done.diagnosis);
    // Edges in which welding would have made more than two faces meet; numbers of the input.
    let refused = |edge: &RefusedWeld| json!({"vertices": edge.vertices, "faces": edge.faces});
    Figures::default()
        // Whether the other commands accept the result.
        .with("admissible", defects.list.is_empty())
        .counts(Counts::from(diagnosis))
        .with("welded_vertices", steps.welded_vertices)
        .with("degenerate_faces", steps.degenerate_faces)
        .with("duplicate_faces", steps.duplicate_faces)
        .with("cut_edges", steps.cut_edges)
        .with("split_vertices", steps.split_vertices)
        .with("turned_faces", steps.turned_faces)
        .with("faces_of_other_components", steps.faces_of_other_components)
        .with("isolated_vertices", steps.isolated_vertices)
        .with("weld_refused", done.weld_refused.iter().map(refused).collect::<Vec<_>>())
        // Attributes that the format of the output has no place for.
        .with("left_out", left_out)
        .with("defect_counts", json!(defects.counts))
        .with("defects", json!(defects.list))
}

fn text(args: &RepairArgs, repaired: &Repaired, defects: &Defects, left_out: &[&str]) -> String {
    let (steps, result) = (&repaired.steps, &repaired.diagnosis);
    let vertex = |n, what: &str| (n, count(n, "vertex", "vertices") + what);
    let face = |n, what: &str| (n, count(n, "face", "faces") + what);
    let done: Vec<String> = [
        vertex(steps.welded_vertices, " welded"),
        face(steps.degenerate_faces, " with a repeated vertex dropped"),
        face(steps.duplicate_faces, " that repeat another dropped"),
        (steps.cut_edges, count(steps.cut_edges, "edge", "edges") + " cut open"),
        vertex(steps.split_vertices, " added where fans of faces met"),
        face(steps.turned_faces, " turned"),
        face(steps.faces_of_other_components, " of other components left out"),
        vertex(steps.isolated_vertices, " without faces dropped"),
    ]
    .into_iter()
    .filter(|(n, _)| *n > 0)
    .map(|(_, text)| text)
    .collect();
    let mut text = format!(
        "{}: {}\n{}: {}, {}, {}, {}\n",
        args.mesh.display(),
        match done.is_empty() {
            true if result.vertices == 0 => "the file is empty: it has neither vertices nor faces".into(),
            true => "nothing to mend".into(),
            false => done.join(", "),
        },
        args.out.display(),
        count(result.vertices, "vertex", "vertices"),
        count(result.faces, "face", "faces"),
        count(result.components, "component", "components"),
        count(result.boundary_loops, "boundary loop", "boundary loops"),
    );
    if let Some(RefusedWeld { vertices: [a, b], faces }) = repaired.weld_refused.first() {
        text += &format!(
            "not welded throughout: {} in which more than two faces would meet, such as {} faces between vertices {a} and \
             {b} of the input: --weld DISTANCE joins them all the same\n",
            count(repaired.weld_refused.len(), "edge", "edges"),
            faces.len(),
        );
    }
    for what in left_out {
        text += &format!("left out: {what} (.{} has no place for them)\n", extension(&args.out));
    }
    let mut told: Vec<&str> = Vec::new();
    for DefectFigures { message, remedy, .. } in &defects.list {
        if !told.contains(remedy) {
            told.push(remedy);
            text += &format!("left: {message}: {remedy}\n");
        }
    }
    text
}

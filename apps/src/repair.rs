//! `ricci repair`.

use crate::failure::Failure;
use crate::info::{DefectCount, DefectFigures, summary_of};
use crate::options::{Common, distance};
use crate::output::{Outputs, check_extension, check_outputs, extension};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Report, Seconds, path_text, timed};
use crate::say::{self, count};
use crate::show;
use clap::Args;
use ricci::Control;
use ricci::control::Stage;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::{self, Format};
use ricci::mesh::repair::{Repair, Repaired, Steps, repair};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

pub const HELP: &str = "\
Example: the largest piece of a scan, welded within 1e-6, and where its vertices and faces came from
    ricci repair scan.stl -o clean.ply --weld 1e-6 --component 0 --map origin.json

Always: weld vertices in the same place (but not in edges in which more than two faces would meet: these are told), drop faces
that use a vertex twice or repeat a face, give every fan of faces a vertex of its own, turn faces until neighbours agree, drop
isolated vertices.
The exit code is 1 if a defect is left that needs a guess; the file is written all the same.";

#[derive(Args, Debug)]
pub struct RepairArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii)
    pub mesh: PathBuf,
    /// Repaired mesh (.obj, .off, .ply, .glb)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: PathBuf,
    /// Weld vertices within this distance; 0 welds those in exactly the same place
    #[arg(long, value_name = "DISTANCE", default_value_t = 0.0, value_parser = distance)]
    pub weld: f64,
    /// Weld nothing
    #[arg(long, conflicts_with = "weld")]
    pub no_weld: bool,
    /// Cut the surface open along edges in which more than two faces meet
    #[arg(long)]
    pub cut_edges: bool,
    /// Keep one connected piece: 0 is that with the most faces
    #[arg(long, value_name = "K")]
    pub component: Option<usize>,
    /// Write the input's vertex of each vertex and the input's face of each face
    #[arg(long, value_name = "MAP.json")]
    pub map: Option<PathBuf>,
    #[command(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    pub common: Common,
}

/// What was done, what the result is, and what is left.
#[derive(Serialize)]
struct RepairResult {
    /// The other commands accept the result.
    admissible: bool,
    vertices: usize,
    edges: usize,
    faces: usize,
    components: usize,
    euler: i64,
    genus: Option<usize>,
    boundary_loops: usize,
    welded_vertices: usize,
    degenerate_faces: usize,
    duplicate_faces: usize,
    cut_edges: usize,
    split_vertices: usize,
    turned_faces: usize,
    faces_of_other_components: usize,
    isolated_vertices: usize,
    /// Edges in which welding would have made more than two faces meet; numbers of the input.
    weld_refused: Vec<RefusedFigures>,
    /// Attributes that the format of the output has no place for.
    left_out: Vec<&'static str>,
    defect_counts: Vec<DefectCount>,
    defects: Vec<DefectFigures>,
}

#[derive(Serialize)]
struct RefusedFigures {
    vertices: [u32; 2],
    faces: Vec<u32>,
}

#[derive(Serialize)]
struct Asked {
    out: String,
    weld: Option<f64>,
    cut_edges: bool,
    component: Option<usize>,
    map: Option<String>,
    #[serde(flatten)]
    picture: SurfacePictureArgs,
    threads: usize,
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
    check_extension("--picture", args.picture.base.picture.as_deref(), &["png"])?;
    let files =
        [Some(&args.out), args.map.as_ref(), args.picture.base.picture.as_ref(), args.common.report.as_ref()];
    check_outputs(&[Some(&args.mesh)], &files.map(|path| path.map(|path| path.as_path())))?;
    let mut seconds = Seconds::default();
    control.step(Stage::Read, 0.0)?;
    let soup = timed(&mut seconds.read, || io::read(&args.mesh))?;
    control.step(Stage::Build, 0.0)?;
    let weld = (!args.no_weld).then_some(args.weld);
    let options = Repair { weld, cut_non_manifold_edges: args.cut_edges, component: args.component };
    let done = timed(&mut seconds.build, || repair(&soup, &options))?;
    control.step(Stage::Write, 0.0)?;
    let mut outputs = Outputs::default();
    let left_out = timed(&mut seconds.write, || write(args, &done, &mut outputs))?;
    let result = RepairResult::new(&done, left_out);
    let exit_code = u8::from(!result.admissible);
    if !args.common.quiet {
        say::lines(&text(args, &done.steps, &result));
    }
    if let Some(path) = &args.common.report {
        let input = summary_of(&diagnose(&soup.positions, &soup.faces), path_text(&args.mesh));
        let mut checks = Checks::default();
        checks.add("defects", result.defects.len() as f64, 0.0);
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("repair", input, Asked::new(args, weld), result).finished(checks, seconds);
        outputs.add_report(path, &report)?;
    }
    control.check()?;
    outputs.commit()?;
    Ok(exit_code)
}

/// Write the surface, the map back and the picture; returns what the surface's format leaves out.
fn write(args: &RepairArgs, done: &Repaired, outputs: &mut Outputs) -> Result<Vec<&'static str>, Failure> {
    let (format, soup) = (Format::of(&args.out)?, &done.soup);
    let left_out = outputs.add_named(&args.out, |path| io::write_as(path, format, soup))?;
    if let Some(path) = &args.map {
        let map = MapFile { vertex_origin: &done.vertex_origin, face_origin: &done.face_origin };
        outputs.add_json(path, &map)?;
    }
    if let Some(path) = &args.picture.base.picture {
        let threads = args.common.threads();
        outputs
            .add(path, |out| show::draw_surface(out, &soup.positions, &soup.faces, &args.picture, threads))?;
    }
    Ok(left_out)
}

impl Asked {
    fn new(args: &RepairArgs, weld: Option<f64>) -> Asked {
        Asked {
            out: path_text(&args.out),
            weld,
            cut_edges: args.cut_edges,
            component: args.component,
            map: args.map.as_deref().map(path_text),
            picture: args.picture.clone(),
            threads: args.common.threads(),
        }
    }
}

impl RepairResult {
    fn new(done: &Repaired, left_out: Vec<&'static str>) -> Self {
        let (diagnosis, steps) = (&done.diagnosis, &done.steps);
        RepairResult {
            admissible: diagnosis.defects.is_empty(),
            vertices: diagnosis.vertices,
            edges: diagnosis.edges,
            faces: diagnosis.faces,
            components: diagnosis.components,
            euler: diagnosis.euler,
            genus: diagnosis.genus,
            boundary_loops: diagnosis.boundary_loops,
            welded_vertices: steps.welded_vertices,
            degenerate_faces: steps.degenerate_faces,
            duplicate_faces: steps.duplicate_faces,
            cut_edges: steps.cut_edges,
            split_vertices: steps.split_vertices,
            turned_faces: steps.turned_faces,
            faces_of_other_components: steps.faces_of_other_components,
            isolated_vertices: steps.isolated_vertices,
            weld_refused: done
                .weld_refused
                .iter()
                .map(|refused| RefusedFigures { vertices: refused.vertices, faces: refused.faces.clone() })
                .collect(),
            left_out,
            defect_counts: DefectCount::of(diagnosis),
            defects: diagnosis.defects.iter().map(DefectFigures::from).collect(),
        }
    }
}

fn text(args: &RepairArgs, steps: &Steps, result: &RepairResult) -> String {
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
        if done.is_empty() { "nothing to mend".into() } else { done.join(", ") },
        args.out.display(),
        count(result.vertices, "vertex", "vertices"),
        count(result.faces, "face", "faces"),
        count(result.components, "component", "components"),
        count(result.boundary_loops, "boundary loop", "boundary loops"),
    );
    if let Some(RefusedFigures { vertices: [a, b], faces }) = result.weld_refused.first() {
        text += &format!(
            "not welded throughout: {} in which more than two faces would meet, such as {} faces between vertices {a} and \
             {b} of the input: --weld DISTANCE joins them all the same\n",
            count(result.weld_refused.len(), "edge", "edges"),
            faces.len(),
        );
    }
    for what in &result.left_out {
        text += &format!("left out: {what} (.{} has no place for them)\n", extension(&args.out));
    }
    let mut told: Vec<&str> = Vec::new();
    for defect in &result.defects {
        if !told.contains(&defect.remedy) {
            told.push(defect.remedy);
            text += &format!("left: {}: {}\n", defect.message, defect.remedy);
        }
    }
    text
}

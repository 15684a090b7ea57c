//! `ricci repair`: mends what can be mended without a guess, and says which defects are left.

use crate::carry::stays_behind;
use crate::defects::{DefectFigures, DefectList};
use crate::failure::Failure;
use crate::input::read_triangles;
use crate::options::{Common, FileName, distance};
use crate::output::{check_extension, check_outputs, format_of};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Counts, Done, Figures, InputSummary, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::count;
use crate::show;
use clap::Args;
use ricci::control::Stage;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::repair::{RefusedWeld, Repair, Repaired, repair};
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: the largest piece of a scan, welded within 1e-6, and where its vertices and faces came from
    ricci repair scan.stl -o clean.ply --weld 1e-6 --component 0 --map origin.json

Always: weld vertices in the same place (but not in edges in which more than two faces would meet: these are told), drop faces
that use a vertex twice or repeat a face, give every fan of faces a vertex of its own, turn faces until neighbours agree, drop
isolated vertices.
The exit code is 1 if a defect is left that needs a guess; the file is written all the same.";

#[derive(Args, Serialize, Debug)]
pub struct RepairArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii; also .gz)
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

/// The options of a run as its report has them.
#[derive(Serialize)]
struct RepairSettings<'a> {
    /// The distance of welding; null for no welding.
    weld: Option<f64>,
    #[serde(flatten)]
    args: &'a RepairArgs,
}

/// The file of `--map`: for each vertex and face of the result its number in the input, from 0.
#[derive(Serialize)]
struct OriginFile<'a> {
    vertex_origin: &'a [u32],
    face_origin: &'a [u32],
}

/// The mesh as it was read and as it is repaired, with the defects that are left.
pub struct RepairOutcome {
    path: PathBuf,
    /// The name of the repaired file.
    out: FileName,
    soup: Soup,
    repaired: Repaired,
    defects: DefectList,
}

impl RepairArgs {
    /// The distance of welding; none for no welding.
    fn weld(&self) -> Option<f64> {
        (!self.no_weld).then_some(self.weld)
    }
}

impl Job for RepairArgs {
    type Outcome = RepairOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "repair", common: &self.common, mesh: Some(&self.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["obj", "off", "ply", "glb"])?;
        let picture = self.picture.base.picture.as_deref();
        check_extension("--picture", picture, &["png"])?;
        let files = [Some(&*self.out), self.map.as_deref(), picture, self.common.report.as_deref()];
        check_outputs(&[Some(&self.mesh)], &files)
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<RepairOutcome, Failure> {
        run.control.step(Stage::Read, 0.0)?;
        let soup = timed(&mut run.seconds.read, || read_triangles(&self.mesh))?;
        run.control.step(Stage::Build, 0.0)?;
        let (weld, component) = (self.weld(), self.component);
        let options = Repair { weld, cut_non_manifold_edges: self.cut_edges, component };
        let repaired = timed(&mut run.seconds.build, || repair(&soup, &options))?;
        let defects = DefectList::of(&repaired.soup, &repaired.diagnosis);
        let (path, out) = (self.mesh.clone(), self.out.clone());
        Ok(RepairOutcome { path, out, soup, repaired, defects })
    }

    fn write(&self, outcome: &RepairOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (format, repaired) = (format_of(&self.out)?, &outcome.repaired);
        let soup = &repaired.soup;
        let left_out = run.outputs.add_named(&self.out, |path| io::write_as(path, format, soup))?;
        run.outputs.leave_out(left_out);
        run.outputs.leave_out(stays_behind(soup.attributes.labels.as_ref(), &self.mesh, &self.out));
        if let Some(path) = &self.map {
            let Repaired { vertex_origin, face_origin, .. } = repaired;
            run.outputs.add_json(path, &OriginFile { vertex_origin, face_origin })?;
        }
        let draw = || show::draw_surface(soup, &self.picture, self.common.threads);
        run.draw(self.picture.base.picture.as_deref(), draw)
    }

    fn settings<'a>(&'a self, _: &'a RepairOutcome) -> impl Serialize + 'a {
        RepairSettings { weld: self.weld(), args: self }
    }
}

impl JobOutcome for RepairOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("defects", self.defects.list.len() as f64, 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::new(&self.path, &diagnose(&self.soup.positions, &self.soup.faces)))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        figures(&self.repaired, run.outputs.left_out(), &self.defects)
    }

    fn summary(&self, done: &Done) -> String {
        text(self, &done.left_out)
    }
}

/// The steps that were taken, the counts of the result, and the defects that are left.
fn figures(repaired: &Repaired, left_out: &[String], defects: &DefectList) -> Figures {
    let (steps, diagnosis) = (&repaired.steps, &repaired.diagnosis);
    // An edge in which welding would have made more than two faces meet, with numbers of the input.
    let refused = |edge: &RefusedWeld| json!({"vertices": edge.vertices, "faces": edge.faces});
    Figures::default()
        // True if the other commands accept the result.
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
        .with("weld_refused", repaired.weld_refused.iter().map(refused).collect::<Vec<_>>())
        // The attributes that the format of the output has no place for.
        .with("left_out", left_out)
        .with("defect_counts", json!(defects.counts))
        .with("defects", json!(defects.list))
}

fn text(outcome: &RepairOutcome, left_out: &[String]) -> String {
    let RepairOutcome { path, out, repaired, defects, .. } = outcome;
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
        path.display(),
        match done.len() {
            0 if result.vertices == 0 => "the file is empty: it has neither vertices nor faces".into(),
            0 => "nothing to mend".into(),
            _ => done.join(", "),
        },
        out.display(),
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
        text += &format!("left out: {what}\n");
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

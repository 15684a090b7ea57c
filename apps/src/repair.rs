//! `ricci repair`: mends what can be mended without a guess, and says which defects are left.

use crate::carry::stays_behind;
use crate::defects::DefectList;
use crate::failure::Failure;
use crate::input::read_triangles;
use crate::options::{Common, FileName, distance};
use crate::output::{check_extension, check_mesh_extension, check_outputs, format_of};
use crate::picture::SurfacePictureArgs;
use crate::repair_summary::RepairOutcome;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::show;
use clap::Args;
use ricci::control::Stage;
use ricci::mesh::holes::HoleChoice;
use ricci::mesh::io;
use ricci::mesh::repair::{NEW, Repair, Repaired, repair};
use serde::Serialize;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: the largest piece of a scan, welded within 1e-6, and where its vertices and faces came from
    ricci repair scan.stl -o clean.ply --weld 1e-6 --component 0 --map origin.json

Example: a published cortical surface with vertices that are not finite, made whole
    ricci repair lh.gii -o lh.ply --drop-nonfinite --fill-holes all --map origin.json

Always: weld vertices in the same place (but not in edges in which more than two faces would meet: these are told), drop faces
that use a vertex twice or repeat a face, give every fan of faces a vertex of its own, turn faces until neighbours agree, drop
isolated vertices.
On request, in this order: --drop-nonfinite, --t-junctions, welding within a distance, --cut-edges, --component, --degenerate, --fill-holes.
--degenerate collapses an edge whose ends nearly coincide; a face whose third corner lies on its edge goes, and the face beyond that
edge is divided there. --fill-holes puts a patch of least area into a loop, refines it to the edges around and fairs it; `ricci info`
lists the loops. In the map, elements of patches have null.
The exit code is 1 if a defect is left that needs a guess; the file is written all the same.";

#[derive(Args, Serialize, Debug)]
pub struct RepairArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, FreeSurfer's; also .gz)
    #[serde(skip)]
    pub mesh: PathBuf,
    /// Repaired mesh (.obj, .off, .ply, .glb, .vtk, .vtp, .mz3, .gii, FreeSurfer's; also .gz)
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
    /// Drop the faces of vertices whose coordinates are not finite
    #[arg(long)]
    pub drop_nonfinite: bool,
    /// Divide faces at vertices that lie on their boundary edges, so that the seam can be welded
    #[arg(long)]
    pub t_junctions: bool,
    /// Mend faces without area by collapses and flips; vertices keep their places
    #[arg(long)]
    pub degenerate: bool,
    /// Fill the boundary loops of at most N edges, or all
    #[arg(long, value_name = "N|all", value_parser = hole_size)]
    #[serde(serialize_with = "hole_size_text")]
    pub fill_holes: Option<usize>,
    /// Fill only the loops through these vertices of the input (numbered from 0)
    #[arg(long, value_name = "V,V,…", value_delimiter = ',', conflicts_with = "fill_holes")]
    pub fill_hole: Vec<u32>,
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

/// The most edges of a loop to fill; all loops have fewer than `usize::MAX`.
fn hole_size(text: &str) -> Result<usize, String> {
    match text {
        "all" => Ok(usize::MAX),
        _ => text
            .parse()
            .ok()
            .filter(|n| *n > 2)
            .ok_or_else(|| "must be a number of edges from 3 on, or all".into()),
    }
}

fn hole_size_text<S: serde::Serializer>(size: &Option<usize>, serializer: S) -> Result<S::Ok, S::Error> {
    match size {
        Some(usize::MAX) => serializer.serialize_str("all"),
        size => size.serialize(serializer),
    }
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct RepairSettings<'a> {
    /// The distance of welding; null for no welding.
    weld: Option<f64>,
    #[serde(flatten)]
    args: &'a RepairArgs,
}

/// The file of `--map`: for each vertex and face of the result its number in the input, from 0; null for those of filled holes.
#[derive(Serialize)]
struct OriginFile {
    vertex_origin: Vec<Option<u32>>,
    face_origin: Vec<Option<u32>>,
}

impl OriginFile {
    fn new(repaired: &Repaired) -> Self {
        let numbers = |list: &[u32]| list.iter().map(|&origin| (origin != NEW).then_some(origin)).collect();
        OriginFile {
            vertex_origin: numbers(&repaired.vertex_origin),
            face_origin: numbers(&repaired.face_origin),
        }
    }
}

impl RepairArgs {
    /// The distance of welding; none for no welding.
    fn weld(&self) -> Option<f64> {
        (!self.no_weld).then_some(self.weld)
    }

    fn options(&self) -> Repair {
        let holes = match self.fill_holes {
            Some(usize::MAX) => HoleChoice::All,
            Some(most) => HoleChoice::UpTo(most),
            None if !self.fill_hole.is_empty() => HoleChoice::Through(self.fill_hole.clone()),
            None => HoleChoice::Nothing,
        };
        Repair {
            weld: self.weld(),
            cut_non_manifold_edges: self.cut_edges,
            component: self.component,
            drop_non_finite: self.drop_nonfinite,
            split_t_junctions: self.t_junctions,
            mend_zero_area: self.degenerate,
            holes,
        }
    }
}

impl Job for RepairArgs {
    type Outcome = RepairOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "repair", common: &self.common, mesh: Some(&self.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_mesh_extension("-o", Some(&self.out), &[])?;
        let picture = self.picture.base.picture.as_deref();
        check_extension("--picture", picture, &["png"])?;
        let files = [Some(&*self.out), self.map.as_deref(), picture, self.common.report.as_deref()];
        check_outputs(&[Some(&self.mesh)], &files)
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<RepairOutcome, Failure> {
        run.control.step(Stage::Read, 0.0)?;
        let soup = timed(&mut run.seconds.read, || read_triangles(&self.mesh))?;
        run.control.step(Stage::Build, 0.0)?;
        let repaired = timed(&mut run.seconds.build, || repair(&soup, &self.options(), run.control))?;
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
            run.outputs.add_json(path, &OriginFile::new(repaired))?;
        }
        let draw = || show::draw_surface(soup, &self.picture, self.common.threads);
        run.draw(self.picture.base.picture.as_deref(), draw)
    }

    fn settings<'a>(&'a self, _: &'a RepairOutcome) -> impl Serialize + 'a {
        RepairSettings { weld: self.weld(), args: self }
    }
}

//! `ricci info`: the counts, the topology, the quality and the defects of a mesh or metric file.

use crate::defects::{DefectCount, DefectFigures, DefectList};
use crate::failure::{Failure, NO_POSITIONS};
use crate::info_lists::InfoLists;
use crate::input::{self, FileContent};
use crate::metric_file;
use crate::options::{Common, MeshArgs, sharp_angle};
use crate::output::{check_extension, check_outputs};
use crate::picture::SurfacePictureArgs;
use crate::report::{Counts, Done, InputSummary, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::{count, size};
use crate::shape_quality::QualityFigures;
use crate::show;
use clap::Args;
use ricci::Surface;
use ricci::control::Stage;
use ricci::geometry::triangle;
use ricci::mesh::FaceId;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::Soup;
use ricci::metric::ShapeQuality;
use serde::Serialize;
use std::path::Path;

pub const HELP: &str = "\
Example: every defect of a scan, machine-readable
    ricci info scan.obj --report scan.json

The boundary loops are listed with their numbers, lengths and a vertex, as other commands name them; sharp edges and corners for
cuts, landmarks and --corners. Hints tell what is no defect and seldom meant: vertices that nearly coincide along an open seam, with
the smallest --weld that closes it, vertices on boundary edges (T-junctions), coordinates in single precision far from the origin.";

#[derive(Args, Serialize, Debug)]
pub struct InfoArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub file: MeshArgs,
    /// Least angle in degrees between the normals of its faces at a sharp edge, and of turning at a corner
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0, value_parser = sharp_angle)]
    pub sharp: f64,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The result of the command, as its report has it.
#[derive(Serialize, Clone)]
pub struct Info {
    /// True if the other commands accept the file as it is.
    admissible: bool,
    quality: QualityFigures,
    /// The parts of the file that are not read, with the reasons.
    left_out: Vec<String>,
    #[serde(flatten)]
    lists: InfoLists,
    #[serde(flatten)]
    defects: DefectList,
}

/// The file of a mesh or a metric, and what it is.
pub struct InfoOutcome {
    summary: InputSummary,
    info: Info,
    content: FileContent,
}

impl Job for InfoArgs {
    type Outcome = InfoOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "info", common: &self.common, mesh: Some(&self.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        let picture = self.picture.base.picture.as_deref();
        check_outputs(&[Some(&self.file.mesh)], &[self.common.report.as_deref(), picture])?;
        check_extension("--picture", picture, &["png"])
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<InfoOutcome, Failure> {
        run.control.step(Stage::Read, 0.0)?;
        let content = timed(&mut run.seconds.read, || input::content(&self.file))?;
        run.control.step(Stage::Build, 0.0)?;
        let (counts, info) = match &content {
            FileContent::Lengths(_) if self.picture.base.picture.is_some() => {
                return Err(Failure::Usage(format!("--picture: {NO_POSITIONS}")));
            }
            FileContent::Lengths(text) => timed(&mut run.seconds.build, || of_metric(&self.file.mesh, text))?,
            FileContent::Triangles(soup) => timed(&mut run.seconds.build, || of_soup(soup, self.sharp)),
        };
        Ok(InfoOutcome { summary: InputSummary::new(&self.file.mesh, counts), info, content })
    }

    fn write(&self, outcome: &InfoOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let FileContent::Triangles(soup) = &outcome.content else { return Ok(()) };
        let draw = || show::draw_surface(soup, &self.picture, self.common.threads);
        run.draw(self.picture.base.picture.as_deref(), draw)
    }
}

impl JobOutcome for InfoOutcome {
    type Figures = Info;

    fn input(&self) -> Option<InputSummary> {
        Some(self.summary.clone())
    }

    fn figures(&self, _: &CommandRun<'_>) -> Info {
        self.info.clone()
    }

    fn summary(&self, _: &Done) -> String {
        text(&self.summary, &self.info)
    }
}

fn of_soup(soup: &Soup, sharp: f64) -> (Counts, Info) {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    let quality = match input::out_of_range(soup) {
        // Angles and areas of faces with such a vertex are meaningless.
        Some(_) => ShapeQuality::of_soup(&Soup::default()),
        None => ShapeQuality::of_soup(soup),
    };
    let lists = InfoLists::of_soup(soup, &diagnosis, sharp);
    let info = Info::new(DefectList::of(soup, &diagnosis), quality);
    (Counts::from(&diagnosis), Info { lists, left_out: soup.attributes.unread.clone(), ..info })
}

fn of_metric(path: &Path, text: &str) -> Result<(Counts, Info), Failure> {
    match metric_file::parse(path, text, None) {
        Ok(surface) => Ok((Counts::from(&**surface.mesh()), Info::of_metric(&surface))),
        Err(Failure::Defects(diagnosis) | Failure::Unglued(diagnosis)) => {
            let quality = ShapeQuality::of_soup(&Soup::default());
            Ok((Counts::from(&*diagnosis), Info::new(DefectList::from(&*diagnosis), quality)))
        }
        Err(failure) => Err(failure),
    }
}

impl Info {
    /// An intrinsic metric whose faces form a surface; its lengths can still break the triangle inequality.
    fn of_metric(surface: &Surface) -> Self {
        let (mesh, lengths, geometry) = (surface.mesh(), surface.lengths(), surface.geometry());
        let broken =
            |f: &FaceId| triangle::angles(geometry, mesh.opposite_edges(*f).map(|e| lengths[e])).broken();
        let defect = |f: FaceId| DefectFigures {
            code: "triangle_inequality",
            message: format!("face {f} breaks the triangle inequality of {geometry}").into(),
            vertices: mesh.face_vertices(f).map(|v| v.0).to_vec(),
            faces: vec![f.0],
            remedy: "give the face three lengths of which none reaches the sum of the others (S²: nor all together 2π)",
        };
        let list: Vec<_> = mesh.faces().filter(broken).map(defect).collect();
        let count = DefectCount { code: "triangle_inequality", count: list.len() };
        let counts = if list.is_empty() { Vec::new() } else { vec![count] };
        let lists = InfoLists::of_surface(surface);
        Info { lists, ..Info::new(DefectList { counts, list }, ShapeQuality::of_surface(surface)) }
    }

    fn new(defects: DefectList, quality: ShapeQuality) -> Self {
        Info {
            admissible: defects.list.is_empty(),
            quality: quality.into(),
            left_out: Vec::new(),
            lists: InfoLists::default(),
            defects,
        }
    }
}

/// Most defects of one kind that are printed one by one; the report has them all.
const PRINTED: usize = 8;

fn text(summary: &InputSummary, info: &Info) -> String {
    let Counts { vertices, edges, faces, components, euler, genus, boundary_loops } = summary.counts;
    let mut text = format!(
        "{}\n{}, {}, {}, {}\nEuler characteristic {euler}, genus {}, boundary loops {boundary_loops}\n",
        summary.path,
        count(vertices, "vertex", "vertices"),
        count(edges, "edge", "edges"),
        count(faces, "face", "faces"),
        count(components, "component", "components"),
        genus.map_or("undefined".into(), |n| n.to_string()),
    );
    let q = &info.quality;
    text += &format!(
        "area {}, smallest angle {}, longest over shortest edge {}\nobtuse faces {}, non-Delaunay edges {}\n",
        q.min_angle_degrees.map_or("undefined".into(), |_| size(q.area, 6)),
        q.min_angle_degrees.map_or("undefined".into(), |x| format!("{x:.4}°")),
        q.edge_ratio.map_or("undefined".into(), |x| size(x, 4)),
        percent(q.obtuse_fraction),
        percent(q.non_delaunay_fraction),
    );
    for what in &info.left_out {
        text += &format!("left out {what}\n");
    }
    text += &info.lists.lines();
    text += &info.lists.hint_lines();
    text +=
        if info.admissible { "no defects\n" } else { "defects (vertices and faces are numbered from 0):\n" };
    for DefectCount { code, count } in &info.defects.counts {
        let of_kind = || info.defects.list.iter().filter(|d| d.code == *code);
        text += &format!("\n{code}: {count}\n");
        for defect in of_kind().take(PRINTED) {
            text += &format!("  {}\n", defect.message);
        }
        if *count > PRINTED {
            text += &format!("  … and {} more (all are in the report)\n", count - PRINTED);
        }
        let mut remedies: Vec<_> = of_kind().map(|defect| defect.remedy).collect();
        remedies.sort_unstable();
        remedies.dedup();
        for remedy in remedies {
            text += &format!("  remedy: {remedy}\n");
        }
    }
    text
}

fn percent(x: Option<f64>) -> String {
    x.map_or("undefined".into(), |x| format!("{:.2} %", 100.0 * x))
}

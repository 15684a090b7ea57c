//! `ricci info`.

use crate::failure::Failure;
use crate::input::{self, Content};
use crate::metric_file;
use crate::options::{Common, MeshArgs};
use crate::output::{Outputs, check_extension, check_outputs};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Counts, InputSummary, Report, Seconds, timed};
use crate::say::{self, count, size};
use crate::shape_quality::QualityFigures;
use crate::show;
use clap::Args;
use ricci::Control;
use ricci::Surface;
use ricci::control::Stage;
use ricci::geometry::triangle;
use ricci::mesh::FaceId;
use ricci::mesh::check::{Defect, Diagnosis, diagnose};
use ricci::mesh::io::Soup;
use ricci::metric::ShapeQuality;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

pub const HELP: &str = "\
Example: every defect of a scan, machine-readable
    ricci info scan.obj --report scan.json";

#[derive(Args, Serialize, Debug)]
pub struct InfoArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub file: MeshArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// What a surface is.
#[derive(Serialize)]
struct Info {
    /// The other commands accept the file as it is.
    admissible: bool,
    quality: QualityFigures,
    #[serde(flatten)]
    defects: Defects,
}

/// Number of defects by kind, and all of them.
#[derive(Serialize)]
pub struct Defects {
    #[serde(rename = "defect_counts")]
    pub counts: Vec<DefectCount>,
    #[serde(rename = "defects")]
    pub list: Vec<DefectFigures>,
}

#[derive(Serialize)]
pub struct DefectCount {
    code: &'static str,
    count: usize,
}

impl From<&Diagnosis> for Defects {
    fn from(diagnosis: &Diagnosis) -> Self {
        let counts =
            diagnosis.counts().into_iter().map(|(code, count)| DefectCount { code, count }).collect();
        Defects { counts, list: diagnosis.defects.iter().map(DefectFigures::from).collect() }
    }
}

impl Defects {
    /// Those of a diagnosis, and a coordinate too large to compute with: then no area is told from 0.
    pub fn of(soup: &Soup, diagnosis: &Diagnosis) -> Self {
        let mut defects = Defects::from(diagnosis);
        if let Some(message) = input::out_of_range(soup) {
            let (code, remedy) = ("coordinate_out_of_range", "scale the mesh, or give the vertex its place");
            defects.list.retain(|defect| defect.code != "zero_area_face");
            defects.counts.retain(|kind| kind.code != "zero_area_face");
            defects.list.push(DefectFigures {
                code,
                message,
                vertices: Vec::new(),
                faces: Vec::new(),
                remedy,
            });
            defects.counts.push(DefectCount { code, count: 1 });
        }
        defects
    }
}

/// One defect; vertices and faces as the file numbers them, from 0.
#[derive(Serialize)]
pub struct DefectFigures {
    code: &'static str,
    pub message: String,
    vertices: Vec<u32>,
    faces: Vec<u32>,
    pub remedy: &'static str,
}

impl From<&Defect> for DefectFigures {
    fn from(defect: &Defect) -> Self {
        DefectFigures {
            code: defect.code(),
            message: defect.to_string(),
            vertices: defect.vertices(),
            faces: defect.faces(),
            remedy: defect.remedy(),
        }
    }
}

/// Run the command: 0 on every file that can be read, whatever its defects.
pub fn run(args: &InfoArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let picture = args.picture.base.picture.as_deref();
    check_outputs(&[Some(&args.file.mesh)], &[args.common.report.as_deref(), picture])?;
    check_extension("--picture", picture, &["png"])?;
    let (mut outputs, mut seconds) = (Outputs::default(), Seconds::default());
    control.step(Stage::Read, 0.0)?;
    let content = timed(&mut seconds.read, || input::content(&args.file))?;
    control.step(Stage::Build, 0.0)?;
    let (counts, info) = match &content {
        Content::Lengths(_) if picture.is_some() => {
            return Err(Failure::Usage("--picture: an intrinsic metric has no positions in space".into()));
        }
        Content::Lengths(text) => timed(&mut seconds.build, || of_metric(&args.file.mesh, text))?,
        Content::Triangles(soup) => timed(&mut seconds.build, || of_soup(soup)),
    };
    if let (Content::Triangles(soup), Some(path)) = (&content, picture) {
        let draw = || show::draw_surface(soup, &args.picture, args.common.threads);
        outputs.add_bytes(path, &timed(&mut seconds.picture, draw)?)?;
    }
    let summary = InputSummary::new(&args.file.mesh, counts);
    let text = text(&summary, &info);
    if let Some(path) = &args.common.report {
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("info", summary, args, info).finished(Checks::default(), seconds);
        outputs.add_report(path, &report)?;
    }
    let files = outputs.commit()?;
    if !args.common.quiet {
        say::lines(&text, &files)?;
    }
    Ok(0)
}

/// What a list of triangles is.
fn of_soup(soup: &Soup) -> (Counts, Info) {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    let quality = match input::out_of_range(soup) {
        // Angles and areas of such faces say nothing.
        Some(_) => ShapeQuality::of_soup(&Soup::default()),
        None => ShapeQuality::of_soup(soup),
    };
    (Counts::from(&diagnosis), Info::new(Defects::of(soup, &diagnosis), quality))
}

/// What an intrinsic metric is.
fn of_metric(path: &Path, text: &str) -> Result<(Counts, Info), Failure> {
    match metric_file::parse(path, text, None) {
        Ok(surface) => Ok((Counts::from(&**surface.mesh()), Info::of_metric(&surface))),
        Err(Failure::Defects(diagnosis) | Failure::Unglued(diagnosis)) => {
            let quality = ShapeQuality::of_soup(&Soup::default());
            Ok((Counts::from(&*diagnosis), Info::new(Defects::from(&*diagnosis), quality)))
        }
        Err(failure) => Err(failure),
    }
}

impl Info {
    /// An intrinsic metric is a surface already; its lengths may still form no triangles.
    fn of_metric(surface: &Surface) -> Self {
        let (mesh, lengths, geometry) = (surface.mesh(), surface.lengths(), surface.geometry());
        let broken =
            |f: &FaceId| triangle::angles(geometry, mesh.opposite_edges(*f).map(|e| lengths[e])).broken();
        let defect = |f: FaceId| DefectFigures {
            code: "triangle_inequality",
            message: format!("face {f} breaks the triangle inequality of {geometry}"),
            vertices: mesh.face_vertices(f).map(|v| v.0).to_vec(),
            faces: vec![f.0],
            remedy: "give the face three lengths of which none reaches the sum of the others (S²: nor all together 2π)",
        };
        let list: Vec<_> = mesh.faces().filter(broken).map(defect).collect();
        let count = DefectCount { code: "triangle_inequality", count: list.len() };
        let counts = if list.is_empty() { Vec::new() } else { vec![count] };
        Info::new(Defects { counts, list }, ShapeQuality::of_surface(surface))
    }

    fn new(defects: Defects, quality: ShapeQuality) -> Self {
        Info { admissible: defects.list.is_empty(), quality: quality.into(), defects }
    }
}

/// Defects of one kind that are printed one by one; the report has them all.
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

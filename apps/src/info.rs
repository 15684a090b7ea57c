//! `ricci info`.

use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::{Common, MeshArgs};
use crate::output::{Outputs, check_extension, check_outputs};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Counts, InputSummary, Report, Seconds, timed};
use crate::say::{self, count};
use crate::shape_quality::{self, ShapeQuality};
use crate::show;
use clap::Args;
use ricci::Control;
use ricci::Surface;
use ricci::geometry::triangle;
use ricci::mesh::check::{Defect, Diagnosis, diagnose};
use ricci::mesh::io::Soup;
use ricci::mesh::{FaceId, Mesh};
use serde::Serialize;
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
    quality: ShapeQuality,
    /// Number of defects by kind.
    defect_counts: Vec<DefectCount>,
    defects: Vec<DefectFigures>,
}

#[derive(Serialize)]
pub struct DefectCount {
    pub code: &'static str,
    pub count: usize,
}

impl DefectCount {
    pub fn of(diagnosis: &Diagnosis) -> Vec<DefectCount> {
        diagnosis.counts().into_iter().map(|(code, count)| DefectCount { code, count }).collect()
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
    if picture.is_some() && args.file.is_intrinsic() {
        return Err(Failure::Usage("--picture: an intrinsic metric has no positions in space".into()));
    }
    let (mut outputs, mut seconds) = (Outputs::default(), Seconds::default());
    let (counts, info) = if args.file.is_intrinsic() {
        of_metric(args, &mut seconds, control)?
    } else {
        let soup = timed(&mut seconds.read, || input::read_soup(&args.file))?;
        if let Some(path) = picture {
            let draw = || show::draw_surface(&soup, &args.picture, args.common.threads);
            outputs.add_bytes(path, &timed(&mut seconds.write, draw)?)?;
        }
        timed(&mut seconds.build, || of_soup(&soup))
    };
    let summary = InputSummary::new(&args.file.mesh, counts);
    if !args.common.quiet {
        say::lines(&text(&summary, &info));
    }
    if let Some(path) = &args.common.report {
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("info", summary, args, info).finished(Checks::default(), seconds);
        outputs.add_report(path, &report)?;
    }
    outputs.commit()?;
    Ok(0)
}

/// What a list of triangles is.
fn of_soup(soup: &Soup) -> (Counts, Info) {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    let quality = || shape_quality::of_triangles(&soup.positions, &soup.faces);
    (Counts::from(&diagnosis), Info::new(&diagnosis, shape_of(soup).unwrap_or_else(quality)))
}

/// What an intrinsic metric is.
fn of_metric(args: &InfoArgs, seconds: &mut Seconds, control: &Control) -> Result<(Counts, Info), Failure> {
    match input::read(&args.file, None, control) {
        Ok(input) => {
            *seconds = input.seconds;
            Ok((Counts::from(input.mesh()), Info::of_metric(&input)))
        }
        Err(Failure::Defects(diagnosis) | Failure::Unglued(diagnosis)) => {
            let quality = shape_quality::of_triangles(&[], &[]);
            Ok((Counts::from(&*diagnosis), Info::new(&diagnosis, quality)))
        }
        Err(failure) => Err(failure),
    }
}

impl Info {
    /// An intrinsic metric is a surface already; its lengths may still form no triangles.
    fn of_metric(surface: &Input) -> Self {
        let surface = &surface.surface;
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
        let defects: Vec<_> = mesh.faces().filter(broken).map(defect).collect();
        let counted = (!defects.is_empty())
            .then_some(DefectCount { code: "triangle_inequality", count: defects.len() });
        Info {
            admissible: defects.is_empty(),
            quality: shape_quality::of_surface(surface),
            defect_counts: counted.into_iter().collect(),
            defects,
        }
    }

    fn new(diagnosis: &Diagnosis, quality: ShapeQuality) -> Self {
        Info {
            admissible: diagnosis.defects.is_empty(),
            quality,
            defect_counts: DefectCount::of(diagnosis),
            defects: diagnosis.defects.iter().map(DefectFigures::from).collect(),
        }
    }
}

/// Quality of a triangle list that is a surface.
fn shape_of(soup: &Soup) -> Option<ShapeQuality> {
    let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces).ok()?;
    Some(shape_quality::of_surface(&Surface::in_space(mesh, soup.positions.clone()).ok()?))
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
        "area {:.6e}, smallest angle {}, longest over shortest edge {}\nobtuse faces {}, non-Delaunay edges {}\n",
        q.area,
        q.min_angle_degrees.map_or("undefined".into(), |x| format!("{x:.4}°")),
        q.edge_ratio.map_or("undefined".into(), |x| format!("{x:.4}")),
        percent(q.obtuse_fraction),
        percent(q.non_delaunay_fraction),
    );
    text +=
        if info.admissible { "no defects\n" } else { "defects (vertices and faces are numbered from 0):\n" };
    for DefectCount { code, count } in &info.defect_counts {
        let of_kind = || info.defects.iter().filter(|d| d.code == *code);
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

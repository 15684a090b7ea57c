//! `ricci info`.

use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::{Common, SurfaceArgs, distance};
use crate::output::{Outputs, check_extension, check_outputs, extension};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, InputSummary, Report, Seconds, path_text, timed};
use crate::say::{self, count};
use crate::shape_quality::{self, ShapeQuality};
use crate::show;
use clap::Args;
use ricci::Control;
use ricci::geometry::{Space, triangle};
use ricci::mesh::check::{Defect, Diagnosis, diagnose};
use ricci::mesh::io::Soup;
use ricci::mesh::{FaceId, Mesh};
use ricci::metric::lengths_from_positions;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

pub const HELP: &str = "\
Example: every defect of a scan, machine-readable
    ricci info scan.obj --report scan.json";

#[derive(Args, Debug)]
pub struct InfoArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii) or intrinsic metric (.json)
    pub mesh: PathBuf,
    /// STL: corners within this distance are one vertex; 0: those in exactly the same place
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub weld: Option<f64>,
    #[command(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
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

#[derive(Serialize)]
struct Asked {
    weld: Option<f64>,
    #[serde(flatten)]
    picture: SurfacePictureArgs,
    threads: usize,
}

/// Run the command: 0 on every file that can be read, whatever its defects.
pub fn run(args: &InfoArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let files = [&args.common.report, &args.picture.base.picture];
    check_outputs(&[Some(&args.mesh)], &files.map(|path| path.as_deref()))?;
    let picture = args.picture.base.picture.as_deref();
    check_extension("--picture", picture, &["png"])?;
    let intrinsic = extension(&args.mesh) == "json" && args.weld.is_none();
    if picture.is_some() && intrinsic {
        return Err(Failure::Usage("--picture: an intrinsic metric has no positions in space".into()));
    }
    let mut outputs = Outputs::default();
    let mut seconds = Seconds::default();
    let (summary, info) = if intrinsic {
        let surface = SurfaceArgs { mesh: args.mesh.clone(), weld: None, input_geometry: None };
        match input::read(&surface, control) {
            Ok(surface) => {
                (seconds.read, seconds.build) = (surface.seconds_read, surface.seconds_build);
                (InputSummary::of(&surface), Info::of_metric(&surface))
            }
            Err(Failure::Defects(diagnosis) | Failure::Unglued(diagnosis)) => {
                let quality = shape_quality::of_triangles(&[], &[]);
                (summary_of(&diagnosis, path_text(&args.mesh)), Info::new(&diagnosis, quality))
            }
            Err(failure) => return Err(failure),
        }
    } else {
        let soup = timed(&mut seconds.read, || input::read_soup(&args.mesh, args.weld))?;
        let (diagnosis, quality) = timed(&mut seconds.build, || {
            let quality =
                shape_of(&soup).unwrap_or_else(|| shape_quality::of_triangles(&soup.positions, &soup.faces));
            (diagnose(&soup.positions, &soup.faces), quality)
        });
        if let Some(path) = picture {
            let draw = || {
                outputs.add(path, |out| {
                    let threads = args.common.threads();
                    show::draw_surface(out, &soup.positions, &soup.faces, &args.picture, threads)
                })
            };
            timed(&mut seconds.write, draw)?;
        }
        (summary_of(&diagnosis, path_text(&args.mesh)), Info::new(&diagnosis, quality))
    };
    if !args.common.quiet {
        say::lines(&text(&summary, &info));
    }
    if let Some(path) = &args.common.report {
        let picture = args.picture.clone();
        let asked = Asked { weld: args.weld, picture, threads: args.common.threads() };
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("info", summary, asked, info).finished(Checks::default(), seconds);
        outputs.add_report(path, &report)?;
    }
    outputs.commit()?;
    Ok(0)
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
            quality: shape_quality::of_surface(mesh, geometry, lengths),
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
    let lengths = lengths_from_positions(&mesh, &soup.positions).ok()?;
    Some(shape_quality::of_surface(&mesh, Space::E2, &lengths))
}

pub fn summary_of(diagnosis: &Diagnosis, path: String) -> InputSummary {
    InputSummary {
        path,
        vertices: diagnosis.vertices,
        edges: diagnosis.edges,
        faces: diagnosis.faces,
        components: diagnosis.components,
        euler: diagnosis.euler,
        genus: diagnosis.genus,
        boundary_loops: diagnosis.boundary_loops,
    }
}

/// Defects of one kind that are printed one by one; the report has them all.
const PRINTED: usize = 8;

fn text(summary: &InputSummary, info: &Info) -> String {
    let mut text = format!(
        "{}\n{}, {}, {}, {}\nEuler characteristic {}, genus {}, boundary loops {}\n",
        summary.path,
        count(summary.vertices, "vertex", "vertices"),
        count(summary.edges, "edge", "edges"),
        count(summary.faces, "face", "faces"),
        count(summary.components, "component", "components"),
        summary.euler,
        summary.genus.map_or("undefined".into(), |n| n.to_string()),
        summary.boundary_loops,
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

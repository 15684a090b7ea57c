//! `ricci harmonic`: harmonic maps to a disk, a rectangle, the sphere, or with given boundary values.

use crate::csv;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::{Common, FileName, GeometryChoice, MeshArgs};
use crate::output::{Outputs, check_extension, check_outputs, extension};
use crate::picture::{self, Flat, Picture, PictureArgs, Surface, Texture};
use crate::progress::{Progress, doing};
use crate::report::{Attempts, Checks, Done, Figures, InputSummary, Report, Seconds, path_text, timed};
use crate::say;
use crate::uv::Drawn;
use clap::Args;
use ricci::Control;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::harmonic::{
    Domain, HarmonicMap, Prescribed, SphereMap, SphereMapOptions, harmonic_map, planar, sphere_map,
};
use ricci::mesh::io::{self, Textured};
use ricci::mesh::{FaceId, PerHalfedge, VertexId};
use ricci::metric::Refinement;
use serde::Serialize;
use std::time::Instant;

pub const HELP: &str = "\
Example: a disk onto the unit disk, without a flipped triangle
    ricci make disk --bump -o d.obj
    ricci harmonic d.obj --to disk --uv flat.obj --picture flat.png

Maps are linear on the intrinsic Delaunay triangulation of the surface, where the weights of the Laplacian are at least 0: maps of disks onto
convex regions then flip no triangle.

--to
    disk             a disk onto the unit disk, the boundary by its length
    rectangle        a disk onto the rectangle of its modulus, four boundary vertices (--corners) at the corners
    sphere           a closed surface of genus 0 onto the unit sphere, centred
    file:F.csv       rows vertex,x,y: where these vertices go; the others are free

Files
    --uv OUT.obj | OUT.glb     the surface with the map to the plane as texture coordinates
    --sphere S.obj | S.glb     the input's vertices on the unit sphere, with the faces of the intrinsic Delaunay triangulation";

#[derive(Args, Serialize, Debug)]
pub struct HarmonicArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub file: MeshArgs,
    /// Geometry in which the input's lengths are read [default: the file's, e2 for mesh files]
    #[arg(long, value_enum, value_name = "GEOMETRY")]
    #[serde(skip)]
    pub input_geometry: Option<GeometryChoice>,
    /// Where to: disk, rectangle, sphere or file:F.csv [default: sphere for closed surfaces, else disk]
    #[arg(long, value_name = "TARGET", value_parser = target)]
    #[serde(skip)]
    pub to: Option<Target>,
    /// Corners of the rectangle: four boundary vertices (numbered from 0), in order with the surface on the left [default: at the
    /// quarters of the boundary]
    #[arg(long, value_name = "V,V,V,V", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<u32>,
    /// Write the surface with its map to the plane as texture coordinates, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Write the map to the sphere, .obj or .glb
    #[arg(long, value_name = "S.obj")]
    pub sphere: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// Where a surface is mapped to.
#[derive(Serialize, Debug, Clone, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum Target {
    Disk,
    Rectangle,
    Sphere,
    File(FileName),
}

fn target(text: &str) -> Result<Target, String> {
    match text {
        "disk" => Ok(Target::Disk),
        "rectangle" => Ok(Target::Rectangle),
        "sphere" => Ok(Target::Sphere),
        _ => match text.strip_prefix("file:") {
            Some(path) if !path.is_empty() => Ok(Target::File(std::ffi::OsString::from(path).into())),
            _ => Err("must be disk, rectangle, sphere or file:F.csv".into()),
        },
    }
}

/// A map with what is said of it.
enum Map {
    Plane(HarmonicMap<2>, Vec<FaceId>),
    Sphere(SphereMap),
}

struct Found {
    domain: Domain,
    map: Map,
    corners: Option<[VertexId; 4]>,
    failed: Attempts,
    seconds: Seconds,
}

/// Run the command and say what came out; the exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn run(args: &HarmonicArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::read(&args.file, args.input_geometry.map(Space::from), control)?;
    let usual = if input.mesh().is_closed() { Target::Sphere } else { Target::Disk };
    let to = args.to.clone().unwrap_or(usual);
    check_surface(args, &input, &to)?;
    let mut found = find(&input, args, &to, control)?;
    let (files, figures) = write(args, (&input, &to), &mut found, control, start)?;
    drop(progress);
    let checks = found.checks();
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let done = Done {
        input,
        result: found,
        figures,
        checks,
        files,
        seconds: start.elapsed().as_secs_f64(),
        exit_code,
    };
    if !args.common.quiet {
        let text = say::surface(&done.input) + &done.result.text() + &say::finish(&done, &done.result.failed);
        say::lines(&text, &done.files)?;
    }
    Ok(done.exit_code)
}

/// What can be refused before anything is read.
fn check_request(args: &HarmonicArgs) -> Result<(), Failure> {
    check_extension("--uv", args.uv.as_deref(), &["obj", "glb"])?;
    check_extension("--sphere", args.sphere.as_deref(), &["obj", "glb"])?;
    check_extension("--picture", args.picture.picture.as_deref(), &["png", "svg"])?;
    let corners = args.corners.len();
    if corners > 0 && (corners != 4 || args.to != Some(Target::Rectangle)) {
        return Err(Failure::Usage("--corners: four boundary vertices, for --to rectangle".into()));
    }
    let values = match &args.to {
        Some(Target::File(path)) => Some(&**path),
        _ => None,
    };
    let files = [
        args.uv.as_deref(),
        args.sphere.as_deref(),
        args.picture.picture.as_deref(),
        args.common.report.as_deref(),
    ];
    check_outputs(&[Some(&args.file.mesh), values], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &HarmonicArgs, input: &Input, to: &Target) -> Result<(), Failure> {
    let is_sphere = *to == Target::Sphere;
    let n = input.mesh().n_vertices();
    if let Some(v) = args.corners.iter().find(|v| **v as usize >= n) {
        return Err(Failure::Usage(format!("--corners: there is no vertex {v}, they are 0 to {}", n - 1)));
    }
    let mesh = input.mesh();
    let (loops, genus) = (mesh.boundary_loops().len(), mesh.genus());
    let needed = match to {
        Target::Sphere if loops > 0 || genus > 0 => Some("a closed surface of genus 0"),
        Target::Disk | Target::Rectangle if loops != 1 || genus > 0 => {
            Some("a disk, of genus 0 with one boundary loop")
        }
        _ => None,
    };
    if let Some(needed) = needed {
        let path = input.path.display();
        let why = format!("the surface has genus {genus} and {loops} boundary loops; {needed} is needed");
        return Err(Failure::Input(format!("{path}: {why}")));
    }
    let in_space = input.positions().is_some();
    let drawn = args.picture.picture.is_some();
    let refused = [
        (is_sphere && args.uv.is_some(), "--uv: a sphere lies in no plane; use --sphere S.obj"),
        (!is_sphere && args.sphere.is_some(), "--sphere: the map is to the plane; use --uv, or --to sphere"),
        (is_sphere && args.picture.is_svg(), "--picture: an SVG shows no surface in space; use .png"),
        (args.uv.is_some() && !in_space, "--uv: an intrinsic metric has no positions in space"),
        (
            drawn && !in_space && !args.picture.is_svg() && !is_sphere,
            "--picture: an intrinsic metric has no positions in space; use .svg",
        ),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why.into())),
        None => Ok(()),
    }
}

fn find(input: &Input, args: &HarmonicArgs, to: &Target, control: &Control) -> Result<Found, Failure> {
    let mut seconds = input.seconds;
    let domain = timed(&mut seconds.flip, || Domain::new(&input.surface, control))?;
    let given: Option<[VertexId; 4]> = match args.corners[..] {
        [a, b, c, d] => Some([a, b, c, d].map(VertexId)),
        _ => None,
    };
    let mut corners = None;
    let map = timed(&mut seconds.solve, || -> Result<Map, Failure> {
        let plane = match to {
            Target::Sphere => {
                let map = doing("sphere", || sphere_map(&domain, &SphereMapOptions::default(), control));
                return Ok(Map::Sphere(map?));
            }
            Target::Disk => planar::to_disk(&domain, control)?,
            Target::Rectangle => {
                let (map, at) = planar::to_rectangle(&domain, given, control)?;
                corners = Some(at);
                map
            }
            Target::File(path) => {
                let values = csv::read_places(path, input.mesh().n_vertices())?;
                harmonic_map(&domain, &Prescribed { values, flux: None }, control)?
            }
        };
        let flipped = planar::flipped(&domain, &plane.points);
        Ok(Map::Plane(plane, flipped))
    })?;
    Ok(Found { domain, map, corners, failed: Attempts::default(), seconds })
}

/// What the mean-value property must hold to, relative to the size of the image.
const MEAN_VALUE: f64 = 1e-10;

impl Found {
    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        match &self.map {
            Map::Plane(map, _) => checks.add("mean_value_residual", map.mean_value_residual, MEAN_VALUE),
            Map::Sphere(map) => {
                checks.add("flipped_triangles", map.flipped.len() as f64, 0.0);
                let rise = map.energies.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
                checks.add("energy_rise", rise, 0.0);
                checks.add("not_converged", f64::from(u8::from(!map.converged)), 0.0);
            }
        }
        checks
    }

    fn figures(&self) -> Figures {
        let figures = Figures::default().with("flips", self.domain.metric().start_flips());
        match &self.map {
            Map::Plane(map, flipped) => figures
                .with("energy", map.energy)
                .with("mean_value_residual", map.mean_value_residual)
                .with("flipped_triangles", flipped.len())
                .if_some("corners", self.corners.map(|corners| corners.map(|v| v.0).to_vec())),
            Map::Sphere(map) => figures
                .with("energy", map.energies.last().copied())
                .with("energies", map.energies.clone())
                .with("iterations", map.energies.len() - 1)
                .with("converged", map.converged)
                .with("flipped_triangles", map.flipped.len()),
        }
    }

    fn text(&self) -> String {
        match &self.map {
            Map::Plane(map, flipped) => format!(
                "map      energy {}, off the means of neighbours by {:.1e}, {}\n",
                say::size(map.energy, 6),
                map.mean_value_residual,
                say::count(flipped.len(), "triangle flipped", "triangles flipped")
            ),
            Map::Sphere(map) => format!(
                "map      energy {:.6} from {:.6} after {}, {}\n",
                map.energies.last().copied().unwrap_or(f64::NAN),
                map.energies.first().copied().unwrap_or(f64::NAN),
                say::count(map.energies.len() - 1, "step", "steps"),
                say::count(map.flipped.len(), "triangle flipped", "triangles flipped")
            ),
        }
    }
}

/// A map to the plane on the refinement that carries it back to the input.
struct Carried {
    refinement: Option<Refinement>,
    positions: Option<Vec<[f64; 3]>>,
    points: Vec<[f64; 2]>,
    index: PerHalfedge<u32>,
}

impl Carried {
    fn new(
        input: &Input,
        domain: &Domain,
        map: &HarmonicMap<2>,
        control: &Control,
    ) -> ricci::Result<Carried> {
        let refinement = domain.refinement(control)?;
        let given = input.positions();
        let (positions, points) = match &refinement {
            Some(r) => {
                (given.map(|p| r.from_input_vertices(p)).transpose()?, r.from_final_vertices(&map.points)?)
            }
            None => (given.map(<[_]>::to_vec), map.points.clone()),
        };
        let mesh = refinement.as_ref().map_or(input.mesh(), |r| &r.mesh);
        let index = PerHalfedge::from_fn(mesh.n_halfedges(), |h| mesh.origin(h).0);
        Ok(Carried { positions, points, index, refinement })
    }

    fn write(&self, outputs: &mut Outputs, path: &std::path::Path, input: &Input) -> Result<(), Failure> {
        let Some(positions) = &self.positions else {
            return Err(Failure::Failed("an intrinsic metric has no positions in space".into()));
        };
        let refinement = self.refinement.as_ref();
        let mesh = refinement.map_or(input.mesh(), |r| &r.mesh);
        let drawn =
            Drawn { mesh, positions, index: &self.index, texcoords: &self.points, weights: &[], refinement };
        drawn.write(outputs, path, input)
    }

    fn draw(&self, input: &Input, args: &HarmonicArgs) -> Result<Vec<u8>, Failure> {
        let mesh = self.refinement.as_ref().map_or(input.mesh(), |r| &r.mesh);
        let style = args.picture.style(Texture::Checker, args.common.threads);
        let faces = mesh.triangles();
        let corner_uv: Vec<_> = faces.iter().map(|f| f.map(|v| self.points[v as usize])).collect();
        let outer = mesh.halfedges().filter(|&h| mesh.is_outside(h.twin()));
        let at = |v: VertexId| self.points[v.index()];
        let boundary: Vec<_> = outer.map(|h| (at(mesh.origin(h)), at(mesh.tip(h)))).collect();
        let flat = Some(Flat { corner_uv: &corner_uv, boundary: &boundary, ..Flat::default() });
        if args.picture.is_svg() {
            return picture::svg(&Picture { flat, ..Picture::default() }, &style);
        }
        let surface = self.positions.as_ref().map(|positions| Surface {
            positions,
            faces: &faces,
            corner_uv: Some(&corner_uv),
            seams: &[],
            cones: &[],
            is_closed: false,
        });
        picture::png(&Picture { surface, flat, ..Picture::default() }, &style)
    }
}

/// The sphere as a mesh file, with the faces of the domain.
fn write_sphere(
    outputs: &mut Outputs,
    path: &std::path::Path,
    found: &Found,
    map: &SphereMap,
) -> Result<(), Failure> {
    let faces = found.domain.mesh().triangles();
    let data = Textured { positions: &map.points, faces: &faces, ..Textured::default() };
    match extension(path).as_str() {
        "glb" => outputs.add_named(path, |path| io::write_glb(path, &data, None).map(drop)),
        _ => outputs.add_named(path, |path| io::write_obj(path, &data)),
    }
}

fn draw_sphere(found: &Found, map: &SphereMap, args: &HarmonicArgs) -> Result<Vec<u8>, Failure> {
    let faces = found.domain.mesh().triangles();
    let surface = Surface {
        positions: &map.points,
        faces: &faces,
        corner_uv: None,
        seams: &[],
        cones: &[],
        is_closed: true,
    };
    let style = picture::Style { wire: true, ..args.picture.style(Texture::None, args.common.threads) };
    picture::png(&Picture { surface: Some(surface), ..Picture::default() }, &style)
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    input_geometry: &'static str,
    #[serde(flatten)]
    args: &'a HarmonicArgs,
    to: &'a Target,
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &HarmonicArgs,
    (input, to): (&Input, &Target),
    found: &mut Found,
    control: &Control,
    start: Instant,
) -> Result<(Vec<String>, Figures), Failure> {
    control.step(Stage::Write, 0.0)?;
    let (mut outputs, mut seconds, mut failed) = (Outputs::default(), found.seconds, Attempts::default());
    match &found.map {
        Map::Plane(map, _) if args.uv.is_some() || args.picture.picture.is_some() => {
            let carried = timed(&mut seconds.refine, || Carried::new(input, &found.domain, map, control))?;
            if let Some(path) = &args.uv {
                failed.attempt("uv", carried.write(&mut outputs, path, input))?;
            }
            if let Some(path) = &args.picture.picture {
                let drawn = timed(&mut seconds.picture, || carried.draw(input, args));
                failed.attempt("picture", drawn.and_then(|bytes| outputs.add_bytes(path, &bytes)))?;
            }
        }
        Map::Sphere(map) => {
            if let Some(path) = &args.sphere {
                failed.attempt("sphere", write_sphere(&mut outputs, path, found, map))?;
            }
            if let Some(path) = &args.picture.picture {
                let drawn = timed(&mut seconds.picture, || draw_sphere(found, map, args));
                failed.attempt("picture", drawn.and_then(|bytes| outputs.add_bytes(path, &bytes)))?;
            }
        }
        Map::Plane(..) => {}
    }
    seconds.total = start.elapsed().as_secs_f64();
    (found.seconds, found.failed) = (seconds, failed);
    let figures = found.figures();
    let mut report_failed = Ok(());
    if let Some(path) = &args.common.report {
        let asked = Asked { input_geometry: input.surface.geometry().name(), args, to };
        let report = Report::new("harmonic", InputSummary::of(input), asked, figures.clone());
        report_failed = outputs.add_report(path, &report.finished(found.checks(), seconds));
    }
    control.check()?;
    let files = outputs.commit()?.iter().map(|p| path_text(p)).collect();
    report_failed.map(|()| (files, figures))
}

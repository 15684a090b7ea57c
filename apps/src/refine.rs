//! `ricci refine`: finer triangles of the same surface, in space with the way back to the input, or of its metric.

use crate::failure::Failure;
use crate::input::{self, FileContent};
use crate::metric_file::LengthsFile;
use crate::options::{Common, FileName, SurfaceArgs, positive};
use crate::output::{check_extension, check_mesh_extension, check_outputs, extension, format_of};
use crate::picture::SurfacePictureArgs;
use crate::report::{Checks, Counts, Done, Figures, InputSummary, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::{self, count};
use crate::show;
use clap::Args;
use ricci::control::Stage;
use ricci::mesh::Place;
use ricci::mesh::check::{Diagnosis, diagnose};
use ricci::mesh::io::{self, Soup};
use ricci::mesh::refine::{Refine, RefinedSoup, refine};
use ricci::metric::ShapeQuality;
use ricci::metric::angle_refinement::{AngleRefinement, AngleReport, FinerMetric, refine_to_angle};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: every face cut into four, with the way back to the input; no edge longer than 0.02; triangles without thin ones
    ricci refine scan.obj -o fine.obj --levels 1 --xref back.csv
    ricci refine scan.obj -o even.ply --edge 0.02
    ricci refine scan.obj --intrinsic --angle 25 -o metric.json --xref back.csv && ricci uniformize metric.json

In space, edges are halved at their midpoints and faces are cut by straight lines: the surface stays the same set of points, the
input's vertices come first and keep their numbers, colours, normals and texture coordinates are interpolated. Any list of
triangles is taken, with several components or edges of more than two faces too.

With --intrinsic the metric is refined, not the shape: vertices are added where they make no thin triangle, and edges are
geodesics of the surface. Triangles with a small angle are left only where the surface itself has an angle below 60°.";

#[derive(Args, Serialize, Debug)]
pub struct RefineArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// Refined mesh (.obj, .off, .ply, .glb, .vtk, .vtp, .mz3, .gii, FreeSurfer's; also .gz), or with --intrinsic its metric (.json)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: FileName,
    /// Cut every face into four, this many times
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=12))]
    pub levels: u8,
    /// Halve edges until none is longer than this
    #[arg(long, value_name = "L", value_parser = positive)]
    pub edge: Option<f64>,
    /// Write where the faces and vertices of the result lie in the input's, numbered from 0: rows output_face,source_face, then
    /// output_vertex,source_face,b0,b1,b2; with --intrinsic, whose faces lie in no face of the input, the vertices alone
    #[arg(long, value_name = "X.csv")]
    pub xref: Option<FileName>,
    /// Refine the metric: vertices and geodesic edges, of which lengths alone are written
    #[arg(long, conflicts_with_all = ["edge", "levels"])]
    pub intrinsic: bool,
    /// Least angle of the triangles of --intrinsic, degrees, at most 30
    #[arg(long, value_name = "DEGREES", default_value_t = 25.0, value_parser = positive)]
    pub angle: f64,
    /// Most vertices that --intrinsic adds [default: ten per face and 100000]
    #[arg(long, value_name = "N", requires = "intrinsic")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_added: Option<usize>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// Largest relative change of the area by a refinement: midpoints and lengths are rounded, at coordinates far from the origin most.
const AREA_CHANGE: f64 = 1e-9;

/// Largest excess of the straight line in space between the places of two neighbours over the length of their edge, as a share of that: the
/// edge is a geodesic, and places are rounded.
const LINE_EXCESS: f64 = 1e-6;

/// A surface before and after it was refined.
pub struct RefineOutcome {
    path: PathBuf,
    out: FileName,
    given: Counts,
    /// The areas before and after.
    area: [f64; 2],
    result: FinerSurface,
}

/// What was refined: the triangles in space, or the metric.
enum FinerSurface {
    Triangles { soup: Box<RefinedSoup>, diagnosis: Box<Diagnosis>, asked_edge: Option<f64> },
    Metric { finer: Box<FinerMetric>, line_excess: Option<f64>, asked_angle: f64 },
}

impl Job for RefineArgs {
    type Outcome = RefineOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "refine", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        let picture = self.picture.base.picture.as_deref();
        check_extension("--picture", picture, &["png"])?;
        let usage = |why: &str| Err(Failure::Usage(why.into()));
        if self.intrinsic {
            check_extension("-o (--intrinsic writes lengths)", Some(&self.out), &["json"])?;
            if picture.is_some() {
                return usage("--picture: a metric has no triangles in space; leave --intrinsic out");
            }
            if self.angle > 30.0 {
                return usage("--angle: at most 30 degrees, above which a refinement need not end");
            }
        } else {
            check_mesh_extension("-o", Some(&self.out), &[])?;
            if self.levels == 0 && self.edge.is_none() {
                return usage("say how far to refine: --levels N, --edge L, or --intrinsic --angle DEGREES");
            }
        }
        let files = [Some(&*self.out), self.xref.as_deref(), picture, self.common.report.as_deref()];
        check_outputs(&[Some(&self.surface.file.mesh)], &files)
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<RefineOutcome, Failure> {
        if self.intrinsic { self.refine_metric(run) } else { self.refine_triangles(run) }
    }

    fn write(&self, outcome: &RefineOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        match &outcome.result {
            FinerSurface::Triangles { soup, .. } => {
                let format = format_of(&self.out)?;
                let left_out =
                    run.outputs.add_named(&self.out, |path| io::write_as(path, format, &soup.soup))?;
                run.outputs.leave_out(left_out);
                self.write_xref(run, Some(&soup.face_origin), &soup.vertex_place)?;
                let draw = || show::draw_surface(&soup.soup, &self.picture, self.common.threads);
                run.draw(self.picture.base.picture.as_deref(), draw)
            }
            FinerSurface::Metric { finer, .. } => {
                let FinerMetric { surface, places, .. } = &**finer;
                let (mesh, geometry, lengths) = (surface.mesh(), surface.geometry(), surface.lengths());
                run.outputs.add_json(&self.out, &LengthsFile::new(mesh, geometry, lengths))?;
                let places: Vec<Option<Place>> = places.iter().copied().map(Some).collect();
                self.write_xref(run, None, &places)
            }
        }
    }
}

impl RefineArgs {
    /// The file of --xref. `face_origin`: per face of the result the input's face that it is a part of, where it is one.
    fn write_xref(
        &self,
        run: &mut CommandRun<'_>,
        face_origin: Option<&[u32]>,
        places: &[Option<Place>],
    ) -> Result<(), Failure> {
        run.file("xref", self.xref.as_deref(), |outputs, path| {
            outputs.add(path, |out| write_places(out, face_origin, places))
        })
    }

    fn refine_triangles(&self, run: &mut CommandRun<'_>) -> Result<RefineOutcome, Failure> {
        let path = self.surface.file.mesh.clone();
        run.control.step(Stage::Read, 0.0)?;
        let soup = match timed(&mut run.seconds.read, || input::content(&self.surface.file))? {
            FileContent::Triangles(soup) => soup,
            FileContent::Lengths(_) => {
                let why = "an intrinsic metric has no triangles in space: --intrinsic refines it";
                return Err(Failure::Input(format!("{}: {why}", path.display())));
            }
        };
        run.control.step(Stage::Build, 0.0)?;
        let options = Refine { levels: self.levels.into(), longest_edge: self.edge };
        let finer = timed(&mut run.seconds.build, || refine(&soup, &options, run.control))?;
        let of = |soup: &Soup| diagnose(&soup.positions, &soup.faces);
        let area = [&soup, &finer.soup].map(|soup| ShapeQuality::of_soup(soup).area);
        let (given, diagnosis) = (Counts::from(&of(&soup)), Box::new(of(&finer.soup)));
        let result = FinerSurface::Triangles { soup: Box::new(finer), diagnosis, asked_edge: self.edge };
        Ok(RefineOutcome { path, out: self.out.clone(), given, area, result })
    }

    fn refine_metric(&self, run: &mut CommandRun<'_>) -> Result<RefineOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        let asked_angle = self.angle.to_radians();
        let most_added = self.most_added.unwrap_or(0);
        let options = AngleRefinement { least_angle: asked_angle, most_added };
        let refined = || refine_to_angle(&input.surface, &options, run.control);
        let finer = Box::new(timed(&mut run.seconds.solve, refined)?);
        let area = [input.surface.area()?, finer.surface.area()?];
        let (path, out, given) = (input.path.clone(), self.out.clone(), Counts::from(input.mesh()));
        let line_excess = finer.line_excess(&input.surface);
        let result = FinerSurface::Metric { finer, line_excess, asked_angle };
        Ok(RefineOutcome { path, out, given, area, result })
    }
}

/// The way back: the input's face of each face, and the place of each vertex in a face of the input.
fn write_places(
    out: &mut impl Write,
    face_origin: Option<&[u32]>,
    places: &[Option<Place>],
) -> std::io::Result<()> {
    if let Some(face_origin) = face_origin {
        writeln!(out, "output_face,source_face")?;
        for (f, source) in face_origin.iter().enumerate() {
            writeln!(out, "{f},{source}")?;
        }
    }
    writeln!(out, "output_vertex,source_face,b0,b1,b2")?;
    for (v, place) in places.iter().enumerate() {
        if let Some(place) = place {
            let [a, b, c] = place.weights;
            writeln!(out, "{v},{},{a},{b},{c}", place.face)?;
        }
    }
    Ok(())
}

impl RefineOutcome {
    fn counts(&self) -> Counts {
        match &self.result {
            FinerSurface::Triangles { diagnosis, .. } => Counts::from(&**diagnosis),
            FinerSurface::Metric { finer, .. } => Counts::from(&**finer.surface.mesh()),
        }
    }

    /// The relative change of the area.
    fn area_change(&self) -> f64 {
        let [before, after] = self.area;
        if before > 0.0 { (after / before - 1.0).abs() } else { after }
    }
}

impl JobOutcome for RefineOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("area_change", self.area_change(), AREA_CHANGE);
        checks.add("euler_change", (self.counts().euler - self.given.euler).abs() as f64, 0.0);
        match &self.result {
            FinerSurface::Triangles { soup, asked_edge: Some(asked), .. } => {
                checks.add("longest_edge", soup.longest_edge(), *asked);
            }
            FinerSurface::Triangles { .. } => {}
            FinerSurface::Metric { finer, line_excess, .. } => {
                checks.add("faces_below_angle", finer.report.below as f64, 0.0);
                if let Some(excess) = line_excess {
                    checks.add("line_excess", *excess, LINE_EXCESS);
                }
            }
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::new(&self.path, self.given.clone()))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let counts = self.counts();
        let figures = Figures::default()
            .with("added_vertices", counts.vertices - self.given.vertices)
            .counts(counts)
            .with("area", self.area[1])
            .with("area_before", self.area[0]);
        match &self.result {
            FinerSurface::Triangles { soup, .. } => {
                figures.with("longest_edge", soup.longest_edge()).with("left_out", run.outputs.left_out())
            }
            FinerSurface::Metric { finer, .. } => metric_figures(figures, &finer.report),
        }
    }

    fn summary(&self, done: &Done) -> String {
        let counts = self.counts();
        let what = match &self.result {
            FinerSurface::Triangles { soup, .. } => {
                format!("longest edge {}", say::size(soup.longest_edge(), 6))
            }
            FinerSurface::Metric { finer, asked_angle, .. } => {
                let report = &finer.report;
                let mut text = format!(
                    "smallest angle {:.2}°, before {:.2}°",
                    report.least_angle.to_degrees(),
                    report.given_angle.to_degrees()
                );
                if report.below > 0 {
                    text += &format!(
                        "; {} still below {}°: --most-added N lets more vertices be added",
                        count(report.below, "face is", "faces are"),
                        asked_angle.to_degrees()
                    );
                }
                if report.forced > 0 {
                    text += &format!(
                        "; {} below it at corners where the surface has an angle below 60°",
                        count(report.forced, "face stays", "faces stay")
                    );
                }
                text
            }
        };
        let left_out = done
            .left_out
            .iter()
            .map(|what| format!("left out: {what} (.{} has no place for them)\n", extension(&self.out)));
        format!(
            "{}: {}, {}\n{}: {}, {}, {what}\n",
            self.path.display(),
            count(self.given.vertices, "vertex", "vertices"),
            count(self.given.faces, "face", "faces"),
            self.out.display(),
            count(counts.vertices, "vertex", "vertices"),
            count(counts.faces, "face", "faces"),
        ) + &left_out.collect::<String>()
            + &say::finish(done)
    }
}

/// The figures of a refined metric.
fn metric_figures(figures: Figures, report: &AngleReport) -> Figures {
    figures
        .with("added_inside", report.inside)
        .with("added_on_boundary", report.on_boundary)
        .with("flips", report.flips)
        .with("min_angle_degrees_before", report.given_angle.to_degrees())
        .with("min_angle_degrees", report.least_angle.to_degrees())
        .with("faces_below_angle", report.below)
        .with("faces_forced_below", report.forced)
}

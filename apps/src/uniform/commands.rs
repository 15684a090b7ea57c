//! Both commands: what they refuse, what they write, what they report.

use super::args::{CanonicalArgs, CoverArgs, ModelChoice, ShowChoice, TilesChoice, UniformizeArgs};
use super::figures::UniformFigures;
use super::group_file::{DomainFile, GroupFile};
use super::model_place::ModelPlace;
use super::pictures::{self, Canvas, Shown};
use super::quotient::{Uniformized, uniformized};
use super::{cover_file, summary};
use crate::carry;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::metric_file::MetricFile;
use crate::options::{FlipsChoice, MethodChoice, SchemeChoice};
use crate::output::{Outputs, check_extension, check_outputs};
use crate::picture::{PictureArgs, Texture};
use crate::progress::Progress;
use crate::report::{Checks, InputSummary, Report, Seconds, path_text, peak_bytes};
use crate::show::is_svg;
use crate::uv;
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::cover::{elements_to_depth, elements_within};
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A finished run.
pub struct Done {
    pub input: Input,
    pub uniformized: Uniformized,
    pub checks: Checks,
    /// Files written.
    pub files: Vec<String>,
    pub seconds: f64,
    pub exit_code: u8,
}

/// Copies to make, and where they are written.
#[derive(Clone, Copy)]
struct CoverWish<'a> {
    depth: usize,
    radius: Option<f64>,
    limit: usize,
    cover: Option<&'a Path>,
    domain: Option<&'a Path>,
}

/// What is common to both commands.
struct Wish<'a> {
    args: &'a CanonicalArgs,
    command: &'static str,
    shown: Option<Shown>,
    model: Option<ModelChoice>,
    cover: Option<CoverWish<'a>>,
}

/// Run `ricci uniformize` and say what came out.
pub fn uniformize(args: &UniformizeArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_uniformize(args, control)?;
    if !args.canonical.common.quiet {
        summary::say(&done, false);
    }
    Ok(done.exit_code)
}

/// Run `ricci cover` and say what came out.
pub fn cover(args: &CoverArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_cover(args, control)?;
    if !args.canonical.common.quiet {
        summary::say(&done, true);
    }
    Ok(done.exit_code)
}

pub fn execute_uniformize(args: &UniformizeArgs, control: &Control) -> Result<Done, Failure> {
    let shown = args.show.map(Shown::Uniform);
    execute(
        &Wish { args: &args.canonical, command: "uniformize", shown, model: args.model, cover: None },
        control,
    )
}

pub fn execute_cover(args: &CoverArgs, control: &Control) -> Result<Done, Failure> {
    let cover = CoverWish {
        depth: args.depth.map_or(2, usize::from),
        radius: args.radius,
        limit: args.limit as usize,
        cover: args.cover.as_deref(),
        domain: args.domain.as_deref(),
    };
    let shown = Some(Shown::Cover(args.show.unwrap_or(TilesChoice::Copies)));
    execute(
        &Wish { args: &args.canonical, command: "cover", shown, model: args.model, cover: Some(cover) },
        control,
    )
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
fn execute(wish: &Wish<'_>, control: &Control) -> Result<Done, Failure> {
    let (start, args) = (Instant::now(), wish.args);
    wish.check_request()?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::read(&args.surface, control)?;
    let shown = wish.check_surface(&input)?;
    let mut u = uniformized(&input, args, control)?;
    if let Some(cover) = &wish.cover {
        u.elements = cover.elements(&u, control)?;
    }
    let checks = u.checks();
    let files = wish.write(&input, &mut u, &checks, shown, control, start)?;
    drop(progress);
    let exit_code = if u.failed.0.is_empty() { checks.exit_code() } else { 1 };
    Ok(Done { input, uniformized: u, checks, files, seconds: start.elapsed().as_secs_f64(), exit_code })
}

impl CoverWish<'_> {
    fn elements(
        &self,
        u: &Uniformized,
        control: &Control,
    ) -> Result<Vec<ricci::embed::DeckElement>, Failure> {
        let found = match (self.radius, &u.domain) {
            (None, _) => elements_to_depth(&u.deck, self.depth, self.limit, control),
            (Some(radius), Ok(domain)) => elements_within(&u.deck, domain, radius, self.limit, control),
            (Some(_), Err(why)) => return Err(Failure::Failed(format!("--radius: {why}; use --depth"))),
        };
        found.map_err(|error| match error {
            ricci::Error::TooLarge { .. } => {
                let option = if self.radius.is_some() { "--radius" } else { "--depth" };
                Failure::Usage(format!(
                    "{option}: more than {} copies; lower it or raise --limit",
                    self.limit
                ))
            }
            error => error.into(),
        })
    }
}

impl Wish<'_> {
    /// What can be refused before anything is read.
    fn check_request(&self) -> Result<(), Failure> {
        let args = self.args;
        let cover = self.cover.as_ref();
        let [copies, domain] = [cover.and_then(|c| c.cover), cover.and_then(|c| c.domain)];
        for (option, path) in [("--uv", args.uv.as_deref()), ("--cover", copies)] {
            path.map_or(Ok(()), |path| check_extension(option, path, &["obj", "glb"]))?;
        }
        if let Some(path) = &args.picture.picture {
            check_extension("--picture", path, &["png", "svg"])?;
            if is_svg(path)
                && matches!(self.shown, Some(Shown::Uniform(ShowChoice::Both | ShowChoice::Surface)))
            {
                return Err(Failure::Usage(
                    "--picture: an SVG shows no surface in space; use .png, or --show domain".into(),
                ));
            }
            if self.model == Some(ModelChoice::Hyperboloid) {
                return Err(Failure::Usage(
                    "--picture: the hyperboloid is no plane; use --model poincare, klein or half-plane"
                        .into(),
                ));
            }
        }
        let files = [
            args.metric.as_deref(),
            args.uv.as_deref(),
            args.generators.as_deref(),
            args.picture.picture.as_deref(),
            args.common.report.as_deref(),
            copies,
            domain,
        ];
        check_outputs(&files)
    }

    /// What can be refused once the surface is known; what the picture shows.
    fn check_surface(&self, input: &Input) -> Result<Shown, Failure> {
        let mesh = &input.mesh;
        let refuse = |why: &str| Err(Failure::Input(format!("{}: {why}", input.path.display())));
        if !mesh.is_closed() {
            return refuse(
                "the surface has a boundary, and closed surfaces only are uniformized so far; ricci flow lays out \
                 surfaces with boundary",
            );
        }
        if mesh.euler() > 0 {
            return refuse("spheres are not uniformized yet; ricci flow lays them out with cones");
        }
        if self.model.is_some() && mesh.euler() == 0 {
            return Err(Failure::Usage(
                "--model: a torus lies in the plane, which has no other model".into(),
            ));
        }
        let usual = match (&input.positions, &self.args.picture.picture) {
            (Some(_), Some(path)) if !is_svg(path) => ShowChoice::Both,
            _ => ShowChoice::Domain,
        };
        let shown = self.shown.unwrap_or(Shown::Uniform(usual));
        if input.positions.is_none() {
            let nothing = "an intrinsic metric has no positions in space";
            if self.args.uv.is_some() {
                return Err(Failure::Usage(format!("--uv: {nothing}")));
            }
            if let Shown::Uniform(ShowChoice::Both | ShowChoice::Surface) = shown {
                return Err(Failure::Usage(format!("--show: {nothing}; use domain")));
            }
        }
        Ok(shown)
    }

    /// Where pictures and copies lie.
    fn place(&self, space: Space) -> ModelPlace {
        ModelPlace::new(space, self.model.map_or(Model::Poincare, Model::from))
    }

    /// Write every file that was asked for, the report last; one that cannot be made keeps none of the others back.
    fn write(
        &self,
        input: &Input,
        u: &mut Uniformized,
        checks: &Checks,
        shown: Shown,
        control: &Control,
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        control.step(Stage::Write, 0.0)?;
        let (args, begin) = (self.args, Instant::now());
        let (at, threads) = (self.place(u.deck.space), args.common.threads());
        let mut outputs = Outputs::default();
        if let Some(path) = &args.metric {
            let written = write_metric(&mut outputs, path, u);
            u.failed.attempt("metric", written)?;
        }
        if let Some(path) = &args.uv {
            let written = uv::write(&mut outputs, path, input, &u.laid, false);
            if u.failed.attempt("uv", written)?.is_some() {
                u.left_out = carry::left_out(input);
            }
        }
        if let Some(path) = &args.generators {
            let written = outputs.add_json(path, &GroupFile::new(&u.deck));
            u.failed.attempt("generators", written)?;
        }
        control.check()?;
        if let Some(path) = self.cover.and_then(|c| c.domain) {
            let written = match &u.domain {
                Ok(domain) => outputs.add_json(path, &DomainFile::new(u, domain, at)),
                Err(why) => Err(Failure::Failed(why.clone())),
            };
            u.failed.attempt("domain", written)?;
        }
        if let Some(path) = &args.picture.picture {
            let texture = args.texture.unwrap_or(Texture::Checker);
            let canvas = Canvas { path, at, style: args.picture.style(texture), threads };
            let ready = pictures::prepare(u, shown, &canvas, control);
            let written = ready.and_then(|ready| outputs.add(path, |out| ready.write(out, u, &canvas)));
            u.failed.attempt("picture", written)?;
        }
        control.step(Stage::Write, 0.3)?;
        if let Some(path) = self.cover.and_then(|c| c.cover) {
            let written = cover_file::write(&mut outputs, path, u, at, threads, control);
            u.failed.attempt("cover", written)?;
        }
        u.seconds.write += begin.elapsed().as_secs_f64();
        let mut report_failed = Ok(());
        if let Some(path) = &args.common.report {
            let figures = UniformFigures::new(u, self.cover.is_some());
            let mut report =
                Report::new(self.command, InputSummary::of(input), self.asked(input, u, shown), figures);
            report.checks = checks.clone();
            report.seconds = Seconds { total: start.elapsed().as_secs_f64(), ..u.seconds };
            report.peak_bytes = peak_bytes();
            report_failed = outputs.add_report(path, &report);
        }
        control.check()?;
        let files = outputs.commit()?.iter().map(|p| path_text(p)).collect();
        report_failed.map(|()| files)
    }

    /// What was asked, defaults put in: a run with these options is this run.
    fn asked(&self, input: &Input, u: &Uniformized, shown: Shown) -> Asked {
        let args = self.args;
        let text = |path: &Option<PathBuf>| path.as_deref().map(path_text);
        let options = args.solve.options(args.common.threads());
        let drawn = args.picture.picture.is_some();
        Asked {
            weld: args.surface.weld,
            input_geometry: input.geometry.name(),
            scheme: args.solve.scheme,
            method: args.solve.method,
            flips: args.solve.flips,
            tolerance: args.solve.tolerance,
            max_iterations: options.iteration_limit(),
            threads: args.common.threads(),
            base: u.basis.base.0,
            model: (u.deck.space == Space::H2).then(|| self.place(u.deck.space).name()),
            metric: text(&args.metric),
            uv: text(&args.uv),
            generators: text(&args.generators),
            picture: args.picture.clone(),
            texture: args.texture.or(drawn.then_some(Texture::Checker)),
            show: drawn.then_some(match shown {
                Shown::Uniform(show) => Show::Uniform(show),
                Shown::Cover(show) => Show::Cover(show),
            }),
            cover: self.cover.map(|c| CoverAsked {
                depth: c.radius.is_none().then_some(c.depth),
                radius: c.radius,
                limit: c.limit,
                cover: c.cover.map(path_text),
                domain: c.domain.map(path_text),
            }),
        }
    }
}

fn write_metric(outputs: &mut Outputs, path: &Path, u: &Uniformized) -> Result<(), Failure> {
    let (mesh, metric) = (u.metric.mesh(), u.metric.metric());
    let lost = metric.length_remainders(mesh)?;
    let factor = u.metric.conformal_factor()?;
    let lengths = [&u.lengths, &lost];
    outputs
        .add_json(path, &MetricFile::new(mesh, u.metric.scheme(), metric, lengths, &factor, &u.target, None))
}

#[derive(Serialize)]
struct Asked {
    weld: Option<f64>,
    input_geometry: &'static str,
    scheme: SchemeChoice,
    method: MethodChoice,
    flips: FlipsChoice,
    tolerance: f64,
    max_iterations: usize,
    threads: usize,
    base: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    metric: Option<String>,
    uv: Option<String>,
    generators: Option<String>,
    #[serde(flatten)]
    picture: PictureArgs,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<Texture>,
    #[serde(skip_serializing_if = "Option::is_none")]
    show: Option<Show>,
    #[serde(flatten)]
    cover: Option<CoverAsked>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Show {
    Uniform(ShowChoice),
    Cover(TilesChoice),
}

#[derive(Serialize)]
struct CoverAsked {
    depth: Option<usize>,
    radius: Option<f64>,
    limit: usize,
    cover: Option<String>,
    domain: Option<String>,
}

//! The files of both commands.

use super::args::{ShowChoice, Shown};
use super::cover_file;
use super::figures::UniformFigures;
use super::group_file::{DomainFile, GroupFile};
use super::pictures::{self, Canvas};
use super::quotient::Uniformized;
use super::request::Wish;
use super::shape::Shape;
use super::sphere::Round;
use super::sphere_figures::SphereFigures;
use super::sphere_picture;
use crate::carry;
use crate::failure::Failure;
use crate::input::Input;
use crate::metric_file::MetricFile;
use crate::output::{Outputs, extension};
use crate::picture::Texture;
use crate::report::{Checks, InputSummary, Report, Seconds, path_text};
use crate::uv;
use ricci::Control;
use ricci::control::Stage;
use ricci::flow::Solution;
use ricci::mesh::io::{self, Textured};
use ricci::mesh::{PerEdge, PerVertex};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

impl Wish<'_> {
    /// Write every file that was asked for, the report last; one that cannot be made keeps none of the others back.
    pub fn write(
        &self,
        input: &Input,
        shape: &mut Shape,
        checks: &Checks,
        shown: Shown,
        control: &Control,
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        control.step(Stage::Write, 0.0)?;
        let begin = Instant::now();
        let mut outputs = Outputs::default();
        match shape {
            Shape::Quotient(u) => self.write_quotient(&mut outputs, input, u, shown, control)?,
            Shape::Sphere(s) => self.write_sphere(&mut outputs, input, s, shown, control)?,
        }
        let seconds = match shape {
            Shape::Quotient(u) => &mut u.seconds,
            Shape::Sphere(s) => &mut s.seconds,
        };
        seconds.write += begin.elapsed().as_secs_f64();
        seconds.total = start.elapsed().as_secs_f64();
        let (seconds, copies) = (*seconds, self.cover.is_some());
        let mut report_failed = Ok(());
        if let Some(path) = &self.args.common.report {
            report_failed = match shape {
                Shape::Quotient(u) => {
                    let asked = self.asked(input, Some(u.basis.base.0), shown);
                    let figures = UniformFigures::new(u, copies);
                    let report = self.report(input, asked, figures, checks, seconds);
                    outputs.add_report(path, &report)
                }
                Shape::Sphere(s) => {
                    let asked = self.asked(input, self.args.base, shown);
                    let figures = SphereFigures::new(input, s, copies);
                    let report = self.report(input, asked, figures, checks, seconds);
                    outputs.add_report(path, &report)
                }
            };
        }
        control.check()?;
        let files = outputs.commit()?.iter().map(|p| path_text(p)).collect();
        report_failed.map(|()| files)
    }

    fn report<O: Serialize, R: Serialize>(
        &self,
        input: &Input,
        asked: O,
        figures: R,
        checks: &Checks,
        seconds: Seconds,
    ) -> Report<O, R> {
        Report::new(self.command, InputSummary::of(input), asked, figures).finished(checks.clone(), seconds)
    }

    fn write_quotient(
        &self,
        outputs: &mut Outputs,
        input: &Input,
        u: &mut Uniformized,
        shown: Shown,
        control: &Control,
    ) -> Result<(), Failure> {
        let args = self.args;
        let (at, threads) = (self.place(u.deck.space), args.common.threads());
        if let Some(path) = &args.metric {
            let written = write_metric(outputs, path, &u.metric, &u.lengths, &u.target);
            u.failed.attempt("metric", written)?;
        }
        if let Some(path) = &args.uv {
            let written = u.laid().and_then(|laid| uv::write(outputs, path, input, laid, (args.on, false)));
            if u.failed.attempt("uv", written)?.is_some() {
                u.left_out = carry::left_out(input);
            }
        }
        if let Some(path) = &args.generators {
            let file = GroupFile::new(u).map_err(Failure::from);
            let written = file.and_then(|file| outputs.add_json(path, &file));
            u.failed.attempt("generators", written)?;
        }
        control.check()?;
        if let Some(path) = self.cover.and_then(|c| c.domain) {
            let file = u.domain().and_then(|domain| Ok(DomainFile::new(u, domain, at)?));
            let written = file.and_then(|file| outputs.add_json(path, &file));
            u.failed.attempt("domain", written)?;
        }
        if let Some(path) = &args.picture.picture {
            let texture = args.texture.unwrap_or(Texture::Checker);
            let (at, style) = (self.drawn_place(u.deck.space), args.picture.style(texture));
            let canvas = Canvas { path, at, style, threads };
            let ready = pictures::prepare(u, shown, &canvas);
            let written = ready.and_then(|ready| outputs.add(path, |out| ready.write(out, u, &canvas)));
            u.failed.attempt("picture", written)?;
        }
        control.step(Stage::Write, 0.3)?;
        if let Some(path) = self.cover.and_then(|c| c.cover) {
            let written = cover_file::write(outputs, path, u, at, threads, control);
            u.failed.attempt("cover", written)?;
        }
        Ok(())
    }

    fn write_sphere(
        &self,
        outputs: &mut Outputs,
        input: &Input,
        s: &mut Round,
        shown: Shown,
        control: &Control,
    ) -> Result<(), Failure> {
        let args = self.args;
        if let Some(path) = &args.metric {
            let written = write_metric(outputs, path, &s.metric, &s.lengths, &s.target);
            s.failed.attempt("metric", written)?;
        }
        for (wish, path) in [("sphere", args.sphere.as_deref()), ("cover", self.cover.and_then(|c| c.cover))]
        {
            if let Some(path) = path {
                let written = write_on_sphere(outputs, path, input, s);
                s.failed.attempt(wish, written)?;
            }
        }
        if let Some(path) = &args.generators {
            let written = outputs.add_json(path, &GroupFile::trivial("s2"));
            s.failed.attempt("generators", written)?;
        }
        control.check()?;
        if let Some(path) = &args.picture.picture {
            let style = args.picture.style(args.texture.unwrap_or(Texture::Checker));
            let beside = matches!(shown, Shown::Uniform(ShowChoice::Both));
            let threads = args.common.threads();
            let written = s.refinement().and_then(|r| {
                let given = input.positions();
                let positions = given.map(|p| r.from_input_vertices(p)).transpose()?;
                outputs.add(path, |out| {
                    sphere_picture::write(out, s, r, positions.as_deref(), &style, beside, threads)
                })
            });
            s.failed.attempt("picture", written)?;
        }
        Ok(())
    }
}

fn write_metric(
    outputs: &mut Outputs,
    path: &Path,
    surface: &Solution,
    lengths: &PerEdge<f64>,
    target: &PerVertex<f64>,
) -> Result<(), Failure> {
    let (mesh, metric) = (surface.mesh(), surface.metric());
    let lost = metric.length_remainders(mesh)?;
    let factor = surface.conformal_factor()?;
    let file = MetricFile::new(mesh, surface.scheme()?, metric, [lengths, &lost], &factor, target, None);
    outputs.add_json(path, &file)
}

/// The final triangulation on the unit sphere, with the input's colours.
fn write_on_sphere(outputs: &mut Outputs, path: &Path, input: &Input, s: &Round) -> Result<(), Failure> {
    let mesh = s.metric.mesh();
    let faces = mesh.triangles();
    let data = Textured {
        positions: &s.positions,
        colors: input.attributes.colors.as_deref().unwrap_or_default(),
        faces: &faces,
        ..Textured::default()
    };
    match extension(path).as_str() {
        "glb" => outputs.add_named(path, |path| io::write_glb(path, &data, None).map(drop)),
        _ => outputs.add_named(path, |path| io::write_obj(path, &data)),
    }
}

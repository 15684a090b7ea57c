//! The files of both commands.

use super::args::{ShowChoice, Shown};
use super::copies::Copies;
use super::cover_glb::write_glb;
use super::figures::of_quotient;
use super::group_file::{DomainFile, GroupFile};
use super::needs::Task;
use super::pictures;
use super::quotient::Uniformized;
use super::request::Wish;
use super::shape::Shape;
use super::sphere::Round;
use super::sphere_figures::of_sphere;
use super::sphere_picture;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::Input;
use crate::output::{Outputs, extension, write_textured};
use crate::picture::{Style, TextureChoice};
use crate::report::{Figures, InputSummary, Report};
use crate::uv;
use ricci::control::Stage;
use ricci::mesh::io::TexturedMesh;
use std::io::Write;
use std::path::Path;

impl Wish<'_> {
    /// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of
    /// the others back.
    pub fn write(
        &self,
        task: &Task<'_>,
        shape: &mut Shape,
        shown: Shown,
        mut delivery: Delivery,
    ) -> Result<(Vec<String>, Figures), Failure> {
        shape.solved_mut().write_metric(&mut delivery.outputs, self.args.to.metric.as_deref())?;
        match shape {
            Shape::Quotient(u) => self.write_quotient(&mut delivery, task, u, shown)?,
            Shape::Sphere(s) => self.write_sphere(&mut delivery, task.input, s, shown)?,
        }
        delivery.close(&mut shape.solved_mut().seconds);
        let copies = self.cover.is_some();
        let (base, figures) = match shape {
            Shape::Quotient(u) => (Some(u.basis.base.0), of_quotient(u, copies)),
            Shape::Sphere(s) => (self.args.base, of_sphere(task.input, s, copies)),
        };
        let files = delivery.commit(self.args.to.common.report.as_deref(), || {
            let asked = self.asked(task.input, base, shown);
            let report = Report::new(self.command, InputSummary::of(task.input), asked, figures.clone());
            report.finished(shape.checks(), shape.solved().seconds)
        })?;
        Ok((files, figures))
    }

    /// How the picture is drawn.
    fn style(&self) -> Style {
        let texture = self.args.texture.unwrap_or(TextureChoice::Checker);
        self.args.picture.style(texture, self.args.to.common.threads)
    }

    fn write_quotient(
        &self,
        delivery: &mut Delivery,
        task: &Task<'_>,
        u: &mut Uniformized,
        shown: Shown,
    ) -> Result<(), Failure> {
        let (args, at) = (self.args, self.place(u.deck.space));
        match &u.laid {
            Some(Ok(laid)) => {
                uv::write_asked(&mut delivery.outputs, task.input, laid, (&args.to, false), &mut u.solved)?;
            }
            Some(Err(why)) => {
                let of_layout = [("uv", args.to.uv.is_some()), ("xref", args.to.xref.is_some())];
                let missing = of_layout.into_iter().filter(|(_, asked)| *asked);
                u.solved.failed.0.extend(missing.map(|(wish, _)| (wish, why.clone())));
            }
            None => {}
        }
        if let Some(path) = &args.generators {
            let file = GroupFile::new(u).map_err(Failure::from);
            let written = file.and_then(|file| delivery.outputs.add_json(path, &file));
            u.solved.failed.attempt("generators", written)?;
        }
        task.control.check()?;
        if let Some(path) = self.cover.and_then(|c| c.domain) {
            let file = u.domain().and_then(|domain| Ok(DomainFile::new(u, domain, at)?));
            let written = file.and_then(|file| delivery.outputs.add_json(path, &file));
            u.solved.failed.attempt("domain", written)?;
        }
        let canvas = pictures::Canvas { at: self.drawn_place(u.deck.space), style: self.style() };
        let draw = || pictures::draw(u, shown, &canvas, args.picture.is_svg());
        let drawn = delivery.picture(args.picture.picture.as_deref(), draw);
        u.solved.failed.attempt("picture", drawn)?;
        task.control.step(Stage::Write, 0.3)?;
        if let Some(path) = self.cover.and_then(|c| c.cover) {
            let copies = Copies::new(u, at, &args.to.common, task.control);
            let written = copies.and_then(|copies| write_copies(&mut delivery.outputs, path, &copies));
            u.solved.failed.attempt("cover", written)?;
        }
        Ok(())
    }

    fn write_sphere(
        &self,
        delivery: &mut Delivery,
        input: &Input,
        s: &mut Round,
        shown: Shown,
    ) -> Result<(), Failure> {
        let args = self.args;
        for (wish, path) in [("sphere", args.sphere.as_ref()), ("cover", self.cover.and_then(|c| c.cover))] {
            if let Some(path) = path {
                let written = write_on_sphere(&mut delivery.outputs, path, input, s);
                s.solved.failed.attempt(wish, written)?;
            }
        }
        if let Some(path) = &args.generators {
            let written = delivery.outputs.add_json(path, &GroupFile::trivial("s2"));
            s.solved.failed.attempt("generators", written)?;
        }
        let beside = matches!(shown, Shown::Uniform(ShowChoice::Both));
        let draw = || sphere_picture::draw(input, s, &self.style(), beside);
        let drawn = delivery.picture(args.picture.picture.as_deref(), draw);
        s.solved.failed.attempt("picture", drawn)?;
        Ok(())
    }
}

/// Size in megabytes from which on a file of copies is announced.
const LARGE: usize = 20;

/// All copies of a cover, as OBJ or, from a name that ends in `.glb`, binary glTF.
fn write_copies(outputs: &mut Outputs, path: &Path, copies: &Copies<'_>) -> Result<(), Failure> {
    let binary = extension(path) == "glb";
    let megabytes = copies.bytes(binary) / 1_000_000;
    if megabytes >= LARGE && !copies.quiet {
        let (path, n) = (path.display(), copies.elements.len());
        let _ = writeln!(std::io::stderr(), "ricci: --cover {path}: {n} copies, about {megabytes} MB");
    }
    let written = match extension(path).as_str() {
        "glb" => outputs.add(path, |out| write_glb(out, copies)),
        _ => outputs.add(path, |out| copies.write_obj(out)),
    };
    // A file that was given up halfway is no failure of its own.
    copies.control.check()?;
    written
}

/// The final triangulation on the unit sphere, with the input's colours.
fn write_on_sphere(outputs: &mut Outputs, path: &Path, input: &Input, s: &Round) -> Result<(), Failure> {
    let faces = s.mesh().triangles();
    let data = TexturedMesh {
        positions: &s.positions,
        colors: input.attributes.colors.as_deref().unwrap_or_default(),
        faces: &faces,
        ..TexturedMesh::default()
    };
    write_textured(outputs, path, &data)
}

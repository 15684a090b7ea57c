//! The files of `ricci uniformize` and `ricci cover`.

use super::args::{CanonicalPictureChoice, UniformPictureChoice};
use super::copies::CoverCopies;
use super::cover_glb::write_glb;
use super::group_file::{DomainFile, GroupFile};
use super::lifts::LiftFile;
use super::pictures;
use super::quotient::Uniformized;
use super::request::CanonicalJob;
use super::shape::{CanonicalOutcome, UniformShape};
use super::sphere::SphereSurface;
use super::sphere_picture;
use crate::failure::Failure;
use crate::flat::FlatLayout;
use crate::input::Input;
use crate::output::{Outputs, extension, write_textured};
use crate::picture::{Style, TextureChoice};
use crate::runner::CommandRun;
use crate::uv;
use ricci::control::Stage;
use ricci::mesh::io::{FaceLabels, TexturedMesh};
use std::io::Write;
use std::path::Path;

impl CanonicalJob<'_> {
    /// Write every file that was asked for but the report.
    pub fn write_files(&self, outcome: &CanonicalOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let solved = outcome.shape.solved();
        run.file("metric", self.args.to.metric.as_deref(), |outputs, path| {
            solved.write_metric(outputs, path)
        })?;
        match &outcome.shape {
            UniformShape::Quotient(u) => self.write_quotient(run, &outcome.input, u, outcome.shown),
            UniformShape::Sphere(s) => self.write_sphere(run, &outcome.input, s, outcome.shown),
        }
    }

    fn style(&self) -> Style {
        let texture = self.args.texture.unwrap_or(TextureChoice::Checker);
        self.args.picture.style(texture, self.args.to.common.threads)
    }

    fn write_quotient(
        &self,
        run: &mut CommandRun<'_>,
        input: &Input,
        u: &Uniformized,
        shown: CanonicalPictureChoice,
    ) -> Result<(), Failure> {
        let (args, at, control) = (self.args, self.place(u.deck.space), run.control);
        match &u.laid {
            Some(Ok(laid)) => {
                uv::write_asked(run, input, laid, &args.to, false)?;
                run.file("flat", args.to.flat.flat.as_deref(), |outputs, path| {
                    FlatLayout::new(input, laid, args.to.on)?.write(outputs, path, &args.to.flat)
                })?;
            }
            Some(Err(why)) => {
                let asked = [
                    ("uv", args.to.uv.is_some()),
                    ("flat", args.to.flat.flat.is_some()),
                    ("xref", args.to.xref.is_some()),
                ];
                run.failed.refuse(why, &asked);
            }
            None => {}
        }
        run.file("generators", args.generators.as_deref(), |outputs, path| {
            outputs.add_json(path, &GroupFile::new(u)?)
        })?;
        control.check()?;
        let domain = self.cover.and_then(|c| c.domain);
        run.file("domain", domain.map(|path| &**path), |outputs, path| {
            outputs.add_json(path, &DomainFile::new(u, u.domain()?, at)?)
        })?;
        let lifted = self.cover.and_then(|c| c.lift_out);
        run.file("lift-out", lifted.map(|path| &**path), |outputs, path| {
            outputs.add_json(path, &LiftFile::new(u, at))
        })?;
        let canvas = pictures::ModelCanvas { at: self.drawn_place(u.deck.space), style: self.style() };
        let draw = || pictures::draw(u, shown, &canvas, args.picture.is_svg());
        run.picture("picture", args.picture.picture.as_deref(), draw)?;
        control.step(Stage::Write, 0.3)?;
        let copies = self.cover.and_then(|c| c.cover);
        run.file("cover", copies.map(|path| &**path), |outputs, path| {
            write_copies(outputs, path, &CoverCopies::new(u, at, &args.to.common, control)?)
        })
    }

    fn write_sphere(
        &self,
        run: &mut CommandRun<'_>,
        input: &Input,
        s: &SphereSurface,
        shown: CanonicalPictureChoice,
    ) -> Result<(), Failure> {
        let args = self.args;
        for (option, path) in [("sphere", args.sphere.as_ref()), ("cover", self.cover.and_then(|c| c.cover))]
        {
            let write = |outputs: &mut _, path: &_| write_on_sphere(outputs, path, input, s);
            run.file(option, path.map(|path| &**path), write)?;
        }
        run.file("generators", args.generators.as_deref(), |outputs, path| {
            outputs.add_json(path, &GroupFile::trivial("s2"))
        })?;
        let beside = matches!(shown, CanonicalPictureChoice::Uniform(UniformPictureChoice::Both));
        let draw = || sphere_picture::draw(input, s, &self.style(), beside);
        run.picture("picture", args.picture.picture.as_deref(), draw)
    }
}

/// Least size in megabytes of a file of copies that is announced on stderr.
const LARGE: usize = 20;

/// Write all copies of a cover, as OBJ or, for a name that ends in `.glb`, binary glTF.
fn write_copies(outputs: &mut Outputs, path: &Path, copies: &CoverCopies<'_>) -> Result<(), Failure> {
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
    // A file that was given up halfway because the run was cancelled is no failure of its own.
    copies.control.check()?;
    written
}

/// Write the final triangulation on the unit sphere, with the input's colours.
fn write_on_sphere(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    s: &SphereSurface,
) -> Result<(), Failure> {
    let faces = s.mesh().triangles();
    let data = TexturedMesh {
        positions: &s.positions,
        colors: input.attributes.colors.as_deref().unwrap_or_default(),
        faces: &faces,
        ..TexturedMesh::default()
    };
    write_textured(outputs, path, &data)?;
    let given = &input.attributes;
    let names = given.labels.as_ref().and_then(FaceLabels::told);
    let names = names.map(|names| format!("{names}: the faces are those after flips, not the input's"));
    let normals = (given.normals.is_some() || given.corner_normals.is_some())
        .then(|| "normals of the input: the sphere has its own".to_string());
    outputs.leave_out(names.into_iter().chain(normals).chain(given.unread.iter().cloned()));
    Ok(())
}

//! `ricci atlas` as a job: what it refuses, computes and writes.

use super::args::TextureArgs;
use super::files;
use super::outcome::TextureOutcome;
use super::scene::KeptScene;
use crate::carry::stays_behind;
use crate::failure::Failure;
use crate::input::{out_of_range, read_triangles};
use crate::output::{check_extension, check_outputs, format_of};
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use ricci::control::Stage;
use ricci::mesh::io::{self, Format, SceneFile};
use ricci::texture::{texture_atlas, texture_atlas_of_parts};

impl Job for TextureArgs {
    type Outcome = TextureOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "atlas", common: &self.common, mesh: Some(&self.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["obj", "glb"])?;
        let picture = self.picture.picture.as_deref();
        check_extension("--picture", picture, &["png", "svg"])?;
        let files = [Some(&*self.out), self.xref.as_deref(), picture, self.common.report.as_deref()];
        check_outputs(&[Some(&self.mesh)], &files)?;
        if self.texcoord.is_some() && !self.is_scene() {
            return Err(Failure::Usage("--texcoord: for a scene, from .glb or .gltf to .glb".into()));
        }
        if self.tangents && format_of(&self.out)? != Format::Glb {
            return Err(Failure::Usage("--tangents: .glb files alone have tangents".into()));
        }
        Ok(())
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<TextureOutcome, Failure> {
        run.control.step(Stage::Read, 0.0)?;
        let scene = match self.is_scene() {
            true => Some(timed(&mut run.seconds.read, || SceneFile::open(&self.mesh))?),
            false => None,
        };
        let mut soup = match &scene {
            Some(scene) => scene.soup().clone(),
            None => timed(&mut run.seconds.read, || read_triangles(&self.mesh))?,
        };
        if let Some(why) = out_of_range(&soup) {
            return Err(Failure::Input(format!("{}: {why}", self.mesh.display())));
        }
        let had_coordinates = soup.attributes.uv.take().is_some();
        let make = || match &scene {
            Some(scene) => texture_atlas_of_parts(&soup, scene.meshes(), &self.options(), run.control),
            None => texture_atlas(&soup, &self.options(), run.control),
        };
        let atlas = timed(&mut run.seconds.layout, make).map_err(|error| match error {
            // It is the model that has nothing to lay out.
            ricci::Error::Layout(why) => Failure::Input(format!("{}: {why}", self.mesh.display())),
            error => error.into(),
        })?;
        soup.attributes.uv = Some(atlas.corner_uv.clone());
        let scene = scene.map(KeptScene::new);
        Ok(TextureOutcome {
            path: self.mesh.clone(),
            soup,
            atlas,
            stretch: self.stretch,
            had_coordinates,
            scene,
        })
    }

    fn write(&self, outcome: &TextureOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (format, soup) = (format_of(&self.out)?, &outcome.soup);
        if let Some(scene) = &outcome.scene {
            let (uv, options) = (&outcome.atlas.corner_uv, self.scene_options());
            let report = run.outputs.add_named(&self.out, |path| scene.file.write(path, uv, &options))?;
            scene.keep(report);
        } else {
            let left_out = run.outputs.add_named(&self.out, |path| match self.tangents {
                true => io::write_glb_with_tangents(path, soup),
                false => io::write_as(path, format, soup),
            })?;
            run.outputs.leave_out(left_out);
            run.outputs.leave_out(stays_behind(soup.attributes.labels.as_ref(), &self.mesh, &self.out));
        }
        run.file("xref", self.xref.as_deref(), |outputs, path| {
            outputs.add(path, |out| files::write_origins(out, outcome))
        })?;
        run.picture("picture", self.picture.picture.as_deref(), || files::draw(outcome, self))
    }
}

//! `ricci layout` as a job: the patches of a coarse quad mesh, and their file.

use super::args::LayoutArgs;
use super::command::solved;
use super::files::{EXTENSIONS, QuadFile};
use super::picture::ShownQuads;
use super::texture::{PatchPoint, PatchQuads, patch_coordinates};
use crate::failure::Failure;
use crate::input::Input;
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::{Checks, Done, Figures, InputSummary, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say;
use ricci::mesh::{FaceId, Point};
use ricci::quads::{LayoutPatch, QuadLayout, QuadOptions, QuadSize, quad_layout};
use ricci::seamless::Seamless;
use serde_json::{Value, json};

pub struct LayoutOutcome {
    input: Input,
    found: Seamless,
    layout: QuadLayout,
    /// The places of the vertices of the layout's quad mesh in space.
    positions: Vec<Point>,
}

impl Job for LayoutArgs {
    type Outcome = LayoutOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "layout", common: &self.common, mesh: Some(&self.source.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["json"])?;
        check_extension("--quads", self.quads.as_deref(), &EXTENSIONS)?;
        if self.texture {
            check_extension("--quads with --texture", self.quads.as_deref(), &["obj"])?;
        }
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files = [
            Some(&self.out),
            self.quads.as_ref(),
            self.picture.picture.as_ref(),
            self.common.report.as_ref(),
        ];
        check_outputs(&self.source.files(), &files.map(|file| file.map(|f| &**f)))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<LayoutOutcome, Failure> {
        let (input, found) = solved(&self.source, self.common.threads, run)?;
        let size = self.patches.map_or(QuadSize::Coarse, |most| QuadSize::AtMost(most as usize));
        let options = QuadOptions { size, threads: self.common.threads };
        let divide = || doing("dividing", || quad_layout(&found, &options, run.control));
        let layout = timed(&mut run.seconds.layout, divide)?;
        let positions = layout.mesh.positions(&found.solution).ok_or_else(Failure::no_positions)?;
        Ok(LayoutOutcome { input, found, layout, positions })
    }

    fn write(&self, outcome: &LayoutOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        run.file("out", Some(&self.out), |outputs, path| outputs.add_json(path, &outcome.file()))?;
        let LayoutOutcome { layout, positions, .. } = outcome;
        let patches = layout.patches.iter().map(|patch| &*patch.quads).collect();
        let texture = self.texture.then(|| side_coordinates(layout));
        let file = QuadFile { positions, quads: &layout.mesh.quads, patches, texture };
        run.file("quads", self.quads.as_deref(), |outputs, path| file.write(outputs, path))?;
        let shown = ShownQuads { mesh: &layout.mesh, positions, layout: Some(layout) };
        run.picture("picture", self.picture.picture.as_deref(), || {
            shown.draw(&self.picture, self.common.threads)
        })
    }
}

/// The coordinates of the corners of quads in their patches: the first side runs along the first axis.
fn side_coordinates(layout: &QuadLayout) -> Vec<[PatchPoint; 4]> {
    let first = |side: i32| {
        let vertices = &layout.arcs[side.unsigned_abs() as usize - 1].vertices;
        let n = vertices.len();
        if side > 0 { [vertices[0], vertices[1]] } else { [vertices[n - 1], vertices[n - 2]] }
    };
    let of = |patch: &LayoutPatch| patch.sides[0].first().map(|&side| first(side));
    let patches: Vec<PatchQuads<'_>> =
        layout.patches.iter().map(|patch| PatchQuads { quads: &patch.quads, first: of(patch) }).collect();
    patch_coordinates(&layout.mesh.quads, &patches)
}

impl LayoutOutcome {
    /// The file of the layout.
    fn file(&self) -> Value {
        let QuadLayout { mesh, nodes, arcs, patches, .. } = &self.layout;
        let given = self.found.solution.given();
        let place = |(f, weights): &(FaceId, [f64; 3])| match weights.iter().position(|w| *w == 1.0) {
            Some(k) => json!({"vertex": given.face_vertices(*f)[k].0}),
            None => json!({"face": f.0, "weights": weights}),
        };
        let node = |node: &ricci::quads::LayoutNode| {
            let mut entry = place(&mesh.places[node.vertex as usize]);
            entry["valence"] = node.valence.into();
            entry["crease"] = node.is_crease.into();
            entry
        };
        let arc = |arc: &ricci::quads::LayoutArc| {
            let points: Vec<Point> = arc.vertices.iter().map(|&v| self.positions[v as usize]).collect();
            let [from, to] = arc.ends;
            json!({"from": from, "to": to, "length": arc.length, "crease": arc.is_crease, "points": points})
        };
        let patch = |patch: &LayoutPatch| json!({"arcs": patch.sides, "size": patch.size});
        json!({
            "nodes": nodes.iter().map(node).collect::<Vec<_>>(),
            "arcs": arcs.iter().map(arc).collect::<Vec<_>>(),
            "patches": patches.iter().map(patch).collect::<Vec<_>>(),
        })
    }

    /// The least number of patches of a layout with these cones on a closed surface: the number of cones less the Euler characteristic.
    fn least(&self) -> i64 {
        self.found.cones.len() as i64 - self.input.mesh().euler()
    }

    fn units(&self) -> u32 {
        self.layout.patches.iter().map(|patch| patch.size[0] * patch.size[1]).sum()
    }
}

impl JobOutcome for LayoutOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        let layout = &self.layout;
        checks.add("holonomy_error", self.found.error, self.found.tolerance);
        let counts = [layout.nodes.len(), layout.arcs.len(), layout.patches.len()].map(|n| n as i64);
        let euler = counts[0] - counts[1] + counts[2];
        checks.add("euler_error", (euler - self.input.mesh().euler()).abs() as f64, 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        Figures::default()
            .with("nodes", self.layout.nodes.len())
            .with("arcs", self.layout.arcs.len())
            .with("patches", self.layout.patches.len())
            .with("units", self.units())
            .with("cones", self.found.cones.len())
            .with("least_patches", self.input.mesh().is_closed().then(|| self.least()))
            .with("features_left_out", self.found.left_out.len())
            .with("features_off_axis", self.layout.mesh.off_axis.len())
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        format!(
            "{}layout   {}, {}, {} of {} in all\n{}",
            say::surface(&self.input),
            say::count(self.layout.nodes.len(), "node", "nodes"),
            say::count(self.layout.arcs.len(), "arc", "arcs"),
            say::count(self.layout.patches.len(), "patch", "patches"),
            say::count(self.units() as usize, "unit square", "unit squares"),
            say::ending(&self.input, done, false)
        )
    }
}

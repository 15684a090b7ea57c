//! The checks, figures and summary of `ricci atlas`.

use super::scene::KeptScene;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::{count, finish};
use ricci::mesh::check::diagnose;
use ricci::mesh::io::Soup;
use ricci::texture::TextureAtlas;
use std::path::PathBuf;

/// A model with its atlas.
pub struct TextureOutcome {
    pub path: PathBuf,
    /// The model, with the coordinates of the atlas.
    pub soup: Soup,
    pub atlas: TextureAtlas,
    /// The bound of the stretch.
    pub stretch: f64,
    /// True if the model had texture coordinates, which the atlas replaces.
    pub had_coordinates: bool,
    /// The scene that the model is, if it stays one.
    pub scene: Option<KeptScene>,
}

impl JobOutcome for TextureOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let atlas = &self.atlas;
        let mut checks = Checks::default();
        let thinner =
            "faces that are much thinner than a texel lose their area to rounding: ricci repair --degenerate";
        checks.add_none("folded_faces", ["face", "faces"], &atlas.folded, Some(thinner));
        checks.add_none("overlapping_faces", ["face", "faces"], &atlas.overlapping, Some(thinner));
        let longer = "each face alone stretches less: ask for a larger --stretch, or refine the model";
        checks.add_with_remedy("stretch_99", atlas.quality.stretch_99, self.limit(), longer);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::new(&self.path, &diagnose(&self.soup.positions, &self.soup.faces)))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let (atlas, quality) = (&self.atlas, &self.atlas.quality);
        let figures = Figures::default();
        let figures = match &self.scene {
            Some(scene) => scene.figures(figures),
            None => figures,
        };
        figures
            .with("charts", atlas.charts)
            .with("sheets", atlas.sheets)
            .with("opened_edges", atlas.opened_edges)
            .with("turned_faces", atlas.turned.clone())
            .with("placeless_faces", atlas.placeless.clone())
            .with("stretch_l2", quality.stretch_l2)
            .with("stretch_max", quality.stretch_max)
            .with("stretch_99", quality.stretch_99)
            .with("angle_mean", quality.angle_mean)
            .with("angle_99", quality.angle_99)
            .with("log_area_deviation", quality.log_area_deviation)
            .with("seam_length", quality.seam_length)
            .with("fill", quality.fill)
            .with("texel_density", quality.texel_density)
            .with("pages", atlas.pages)
            .with("left_out", run.outputs.left_out())
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        let (atlas, quality) = (&self.atlas, &self.atlas.quality);
        let mut text = format!(
            "model    {}: {}, {}\n",
            self.path.display(),
            count(self.soup.faces.len(), "face", "faces"),
            count(atlas.sheets, "sheet", "sheets"),
        );
        if atlas.opened_edges > 0 {
            let edges = count(atlas.opened_edges, "edge", "edges");
            text += &format!("opened   {edges} at which the model is no surface\n");
        }
        if !atlas.turned.is_empty() {
            let faces = count(atlas.turned.len(), "face runs", "faces run");
            text += &format!("turned   {faces} against their neighbours, and so does their image\n");
        }
        if !atlas.placeless.is_empty() {
            let faces = count(atlas.placeless.len(), "face", "faces");
            text += &format!(
                "no place {faces} with two corners in one place or too thin for the page; the first is {}\n",
                atlas.placeless[0]
            );
        }
        if let Some(scene) = &self.scene {
            text += &scene.summary();
        }
        if self.had_coordinates {
            text += "replaced the texture coordinates of the model\n";
        }
        text += &format!(
            "atlas    {}, {:.1} % of {} filled, seams {:.3} roots of the area long\n",
            count(atlas.charts, "chart", "charts"),
            100.0 * quality.fill,
            if atlas.pages == 1 { "the page".into() } else { format!("{} pages", atlas.pages) },
            quality.seam_length
        );
        text += &format!(
            "stretch  L2 {:.4}, 99 % below {:.3}, largest {:.3}; angles {:.2}° on average, 99 % below {:.1}°; σ of log area {:.3}\n",
            quality.stretch_l2,
            quality.stretch_99,
            quality.stretch_max,
            quality.angle_mean,
            quality.angle_99,
            quality.log_area_deviation
        );
        text + &finish(done)
    }
}

impl TextureOutcome {
    /// The bound of the stretch of all charts together: each keeps it at the scale of its own area, and so do all at theirs, but for the
    /// areas of thin faces.
    fn limit(&self) -> f64 {
        const OF_SCALE: f64 = 1.02;
        OF_SCALE * self.stretch
    }
}

//! What `ricci atlas` says of a scene that stays one.

use crate::report::Figures;
use crate::say::count;
use ricci::mesh::io::{SceneFile, SceneReport};
use std::sync::OnceLock;

/// A scene, and once it is written what became of it.
pub struct KeptScene {
    pub file: SceneFile,
    written: OnceLock<SceneReport>,
}

impl KeptScene {
    pub fn new(file: SceneFile) -> KeptScene {
        KeptScene { file, written: OnceLock::new() }
    }

    pub fn keep(&self, report: SceneReport) {
        let _ = self.written.set(report);
    }

    /// Adds the figures of the scene.
    pub fn figures(&self, figures: Figures) -> Figures {
        let [nodes, meshes, primitives, materials] = self.file.counts();
        let figures = figures
            .with("nodes", nodes)
            .with("meshes", meshes)
            .with("primitives", primitives)
            .with("materials", materials);
        let Some(report) = self.written.get() else { return figures };
        figures
            .with("texcoord", report.texcoord)
            .with("vertices", report.n_vertices)
            .with("split_vertices", report.n_split_vertices)
            .with("replaced_coordinates", report.n_replaced)
            .with("kept_textures", report.n_kept_textures)
            .with("misplaced_textures", report.n_misplaced_textures)
            .with("primitives_with_tangents", report.n_tangents)
            .with("dropped_tangents", report.n_dropped_tangents)
            .with("shared_meshes", report.n_shared_meshes)
            .with("notes", report.notes.clone())
    }

    /// The lines of the summary.
    pub fn summary(&self) -> String {
        let [nodes, meshes, primitives, materials] = self.file.counts();
        let mut text = format!(
            "scene    {}, {} of {}, {}\n",
            count(nodes, "node", "nodes"),
            count(meshes, "mesh", "meshes"),
            count(primitives, "primitive", "primitives"),
            count(materials, "material", "materials")
        );
        let Some(report) = self.written.get() else { return text };
        let set = report.texcoord;
        text += &format!(
            "written  TEXCOORD_{set}, {} where there were {}\n",
            count(report.n_split_vertices, "vertex", "vertices"),
            report.n_vertices
        );
        let mut say = |n: usize, words: [&str; 2], rest: &str| {
            if n > 0 {
                text += &format!("         {}{rest}\n", count(n, words[0], words[1]));
            }
        };
        let primitives = ["primitive", "primitives"];
        let textures = ["texture", "textures"];
        say(
            report.n_shared_meshes,
            ["mesh", "meshes"],
            " shown by several nodes: one set of charts, in the largest size",
        );
        say(report.n_kept_textures, textures, " on other sets, as before");
        say(report.n_replaced, primitives, &format!(" had TEXCOORD_{set} before, which is gone"));
        let misplaced = format!(" on TEXCOORD_{set}: bake the pictures anew, or leave --texcoord out");
        say(report.n_misplaced_textures, textures, &misplaced);
        say(report.n_tangents, primitives, " with tangents of the atlas");
        say(report.n_without_tangents, primitives, " without: no normals, or a normal map on another set");
        say(report.n_dropped_tangents, primitives, " lost the tangents of the coordinates before");
        say(report.n_unrolled, primitives, " of strips or fans, now of triangles");
        for note in &report.notes {
            text += &format!("         {note}\n");
        }
        text
    }
}

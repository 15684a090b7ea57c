//! What `ricci repair` reports and says: the steps, what they cost, and what is left.

use crate::defects::{DefectFigures, DefectList};
use crate::info_lists::HintFigures;
use crate::options::FileName;
use crate::report::{Checks, Counts, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::count;
use ricci::mesh::check::{Hint, diagnose};
use ricci::mesh::holes::{FilledHole, OpenHole};
use ricci::mesh::io::Soup;
use ricci::mesh::repair::{RefusedWeld, Repaired};
use serde_json::{Value, json};
use std::path::PathBuf;

/// The mesh as it was read and as it is repaired, with the defects that are left.
pub struct RepairOutcome {
    pub path: PathBuf,
    /// The name of the repaired file.
    pub out: FileName,
    pub soup: Soup,
    pub repaired: Repaired,
    pub defects: DefectList,
}

impl JobOutcome for RepairOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("defects", self.defects.list.len() as f64, 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::new(&self.path, &diagnose(&self.soup.positions, &self.soup.faces)))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        figures(&self.repaired, run.outputs.left_out(), &self.defects)
    }

    fn summary(&self, done: &Done) -> String {
        text(self, &done.left_out)
    }
}

/// The steps that were taken, the counts of the result, and the defects that are left.
fn figures(repaired: &Repaired, left_out: &[String], defects: &DefectList) -> Figures {
    let (steps, diagnosis) = (&repaired.steps, &repaired.diagnosis);
    // An edge in which welding would have made more than two faces meet, with numbers of the input.
    let refused = |edge: &RefusedWeld| json!({"vertices": edge.vertices, "faces": edge.faces});
    Figures::default()
        // True if the other commands accept the result.
        .with("admissible", defects.list.is_empty())
        .counts(Counts::from(diagnosis))
        .with("welded_vertices", steps.welded_vertices)
        .with("degenerate_faces", steps.degenerate_faces)
        .with("duplicate_faces", steps.duplicate_faces)
        .with("cut_edges", steps.cut_edges)
        .with("split_vertices", steps.split_vertices)
        .with("turned_faces", steps.turned_faces)
        .with("faces_of_other_components", steps.faces_of_other_components)
        .with("isolated_vertices", steps.isolated_vertices)
        .with("non_finite_faces", steps.non_finite_faces)
        .with("joined_t_junctions", steps.joined_t_junctions)
        .with("collapsed_edges", steps.collapsed_edges)
        .with("flipped_edges", steps.flipped_edges)
        .with("opened_faces", steps.opened_faces)
        .with(
            "filled_holes",
            repaired.filling.filled.iter().map(|hole| hole_figures(hole, repaired)).collect::<Vec<_>>(),
        )
        .with(
            "open_holes",
            repaired.filling.open.iter().map(|hole| open_figures(hole, repaired)).collect::<Vec<_>>(),
        )
        .with("weld_refused", repaired.weld_refused.iter().map(refused).collect::<Vec<_>>())
        // The attributes that the format of the output has no place for.
        .with("left_out", left_out)
        .with("defect_counts", json!(defects.counts))
        .with("defects", json!(defects.list))
        // What is no defect of the result.
        .with("hints", json!(diagnosis.hints.iter().map(HintFigures::from).collect::<Vec<_>>()))
        // Before one component was taken.
        .with("torn", json!(repaired.torn.iter().map(HintFigures::from).collect::<Vec<_>>()))
}

/// A filled hole, with its vertex in the numbers of the input, and its new elements in those of the result.
fn hole_figures(hole: &FilledHole, repaired: &Repaired) -> Value {
    let FilledHole { edges, length, vertex, faces, vertices, area } = hole;
    let vertex = repaired.vertex_origin[*vertex as usize];
    json!({
        "edges": edges,
        "length": length,
        "vertex": vertex,
        "area": area,
        "faces": [faces.start, faces.end],
        "vertices": [vertices.start, vertices.end],
    })
}

fn open_figures(hole: &OpenHole, repaired: &Repaired) -> Value {
    let vertex = repaired.vertex_origin[hole.vertex as usize];
    json!({"edges": hole.edges, "vertex": vertex, "reason": hole.reason})
}

fn text(outcome: &RepairOutcome, left_out: &[String]) -> String {
    let RepairOutcome { path, out, repaired, defects, .. } = outcome;
    let result = &repaired.diagnosis;
    let done = steps_taken(repaired);
    let mut text = format!(
        "{}: {}\n{}: {}, {}, {}, {}\n",
        path.display(),
        match done.len() {
            0 if result.vertices == 0 => "the file is empty: it has neither vertices nor faces".into(),
            0 => "nothing to mend".into(),
            _ => done.join(", "),
        },
        out.display(),
        count(result.vertices, "vertex", "vertices"),
        count(result.faces, "face", "faces"),
        count(result.components, "component", "components"),
        count(result.boundary_loops, "boundary loop", "boundary loops"),
    );
    if let Some(RefusedWeld { vertices: [a, b], faces }) = repaired.weld_refused.first() {
        text += &format!(
            "not welded throughout: {} in which more than two faces would meet, such as {} faces between vertices {a} and \
             {b} of the input: --weld DISTANCE joins them all the same\n",
            count(repaired.weld_refused.len(), "edge", "edges"),
            faces.len(),
        );
    }
    text += &warnings(repaired);
    for what in left_out {
        text += &format!("left out: {what}\n");
    }
    let mut told: Vec<&str> = Vec::new();
    for DefectFigures { message, remedy, .. } in &defects.list {
        if !told.contains(remedy) {
            told.push(remedy);
            text += &format!("left: {message}: {remedy}\n");
        }
    }
    text
}

/// The steps that were taken, in words.
fn steps_taken(repaired: &Repaired) -> Vec<String> {
    let steps = &repaired.steps;
    let vertex = |n, what: &str| (n, count(n, "vertex", "vertices") + what);
    let face = |n, what: &str| (n, count(n, "face", "faces") + what);
    let edge = |n, what: &str| (n, count(n, "edge", "edges") + what);
    let holes = repaired.filling.filled.len();
    let patches: usize = repaired.filling.filled.iter().map(|hole| hole.faces.len()).sum();
    let all = [
        face(steps.non_finite_faces, " with a corner that is not finite dropped"),
        vertex(steps.joined_t_junctions, " joined to the edges on which they lie"),
        vertex(steps.welded_vertices, " welded"),
        face(steps.degenerate_faces, " with a repeated vertex dropped"),
        face(steps.duplicate_faces, " that repeat another dropped"),
        edge(steps.cut_edges, " cut open"),
        vertex(steps.split_vertices, " added where fans of faces met"),
        face(steps.turned_faces, " turned"),
        face(steps.faces_of_other_components, " of other components left out"),
        edge(steps.collapsed_edges, " of faces without area collapsed"),
        edge(steps.flipped_edges, " of faces without area flipped"),
        face(steps.opened_faces, " without area dropped at the boundary"),
        vertex(steps.isolated_vertices, " without faces dropped"),
        (holes, format!("{} filled with {}", count(holes, "hole", "holes"), count(patches, "face", "faces"))),
    ];
    all.into_iter().filter(|(n, _)| *n > 0).map(|(_, text)| text).collect()
}

/// What people can take for done and is not, or have lost without wanting to.
fn warnings(repaired: &Repaired) -> String {
    let Repaired { steps, torn, filling, .. } = repaired;
    let mut text = String::new();
    let (dropped, kept) = (steps.faces_of_other_components, repaired.soup.faces.len());
    if dropped > kept {
        text += &format!(
            "warning: {dropped} of {} faces are left out, for they belong to other components\n",
            dropped + kept
        );
    }
    let joins =
        |hint: &&Hint| matches!(hint, Hint::OpenSeam(seam) if seam.components[1] < seam.components[0]);
    for hint in torn.iter().filter(joins) {
        text += &format!("warning: the components may be torn pieces of one: {hint}: {}\n", hint.remedy());
    }
    for hint in &repaired.diagnosis.hints {
        text += &format!("hint: {hint}: {}\n", hint.remedy());
    }
    for OpenHole { edges, vertex, reason } in &filling.open {
        let vertex = repaired.vertex_origin[*vertex as usize];
        text += &format!(
            "not filled: the loop of {edges} edges through vertex {vertex} of the input: {reason}\n"
        );
    }
    text
}

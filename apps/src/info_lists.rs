//! What `ricci info` lists beside defects: hints, the boundary loops, sharp edges and corners.

use crate::say::{count, size};
use ricci::Surface;
use ricci::mesh::check::{Diagnosis, Features, Hint};
use ricci::mesh::io::Soup;
use ricci::mesh::rims::rims;
use serde::Serialize;

/// Most loops and corners that are printed one by one; the report has them all.
const PRINTED: usize = 8;

/// The lists, as the report has them.
#[derive(Serialize, Clone, Default)]
pub struct InfoLists {
    hints: Vec<HintFigures>,
    /// In the order in which options of other commands number the loops.
    loops: Vec<LoopFigures>,
    /// Null for an intrinsic metric, which has no angles between faces.
    features: Option<FeatureFigures>,
}

/// A finding that is no defect; vertices and faces as the file numbers them, from 0.
#[derive(Serialize, Clone)]
pub struct HintFigures {
    code: &'static str,
    message: String,
    vertices: Vec<u32>,
    faces: Vec<u32>,
    /// The distance of welding that closes an open seam.
    weld: Option<f64>,
    remedy: String,
}

impl From<&Hint> for HintFigures {
    fn from(hint: &Hint) -> Self {
        HintFigures {
            code: hint.code(),
            message: hint.to_string(),
            vertices: hint.vertices(),
            faces: hint.faces(),
            weld: if let Hint::OpenSeam(seam) = hint { Some(seam.weld) } else { None },
            remedy: hint.remedy(),
        }
    }
}

/// A boundary loop.
#[derive(Serialize, Clone)]
struct LoopFigures {
    edges: usize,
    length: f64,
    /// Its vertex with the lowest number.
    vertex: u32,
}

/// Sharp edges and corners.
#[derive(Serialize, Clone)]
struct FeatureFigures {
    /// The least angle of `--sharp`.
    sharp_degrees: f64,
    sharp_edges: Vec<SharpEdgeFigures>,
    corners: Vec<u32>,
}

#[derive(Serialize, Clone)]
struct SharpEdgeFigures {
    vertices: [u32; 2],
    angle_degrees: f64,
    length: f64,
}

impl InfoLists {
    /// The lists of a mesh file, with edges sharp from `degrees` on.
    pub fn of_soup(soup: &Soup, diagnosis: &Diagnosis, degrees: f64) -> InfoLists {
        let Features { edges, corners } = Features::new(&soup.positions, &soup.faces, degrees.to_radians());
        let sharp_edges = edges.iter().map(|edge| SharpEdgeFigures {
            vertices: edge.vertices,
            angle_degrees: edge.angle.to_degrees(),
            length: edge.length,
        });
        let loops = rims(&soup.positions, &soup.faces).into_iter().map(|rim| LoopFigures {
            edges: rim.vertices.len(),
            length: rim.length,
            vertex: rim.vertex(),
        });
        InfoLists {
            hints: diagnosis.hints.iter().map(HintFigures::from).collect(),
            loops: loops.collect(),
            features: Some(FeatureFigures {
                sharp_degrees: degrees,
                sharp_edges: sharp_edges.collect(),
                corners,
            }),
        }
    }

    /// The boundary loops of a surface.
    pub fn of_surface(surface: &Surface) -> InfoLists {
        let (mesh, lengths) = (surface.mesh(), surface.lengths());
        let figures = |rim: Vec<ricci::mesh::HalfedgeId>| LoopFigures {
            edges: rim.len(),
            length: rim.iter().map(|h| lengths[h.edge()]).sum(),
            vertex: rim.iter().map(|&h| mesh.origin(h).0).min().unwrap_or_default(),
        };
        InfoLists { loops: mesh.boundary_loops().into_iter().map(figures).collect(), ..InfoLists::default() }
    }

    /// The lines of the hints, which come before those of the defects.
    pub fn hint_lines(&self) -> String {
        let line = |hint: &HintFigures| format!("hint: {}\n  remedy: {}\n", hint.message, hint.remedy);
        self.hints.iter().map(line).collect()
    }

    /// The lines of the loops, the longest first, and of the features.
    pub fn lines(&self) -> String {
        let mut longest: Vec<(usize, &LoopFigures)> = self.loops.iter().enumerate().collect();
        longest.sort_by(|a, b| b.1.length.total_cmp(&a.1.length));
        let mut text = String::new();
        for (k, LoopFigures { edges, length, vertex }) in longest.iter().take(PRINTED) {
            text += &format!(
                "loop {k}: {}, length {}, vertex {vertex}\n",
                count(*edges, "edge", "edges"),
                if length.is_finite() { size(*length, 6) } else { "undefined".into() }
            );
        }
        if longest.len() > PRINTED {
            text += &format!("… and {} shorter loops (all are in the report)\n", longest.len() - PRINTED);
        }
        if let Some(FeatureFigures { sharp_degrees, sharp_edges, corners }) = &self.features {
            let sharp = sharp_edges.len();
            text += &format!("sharp edges ({sharp_degrees}° or more) {sharp}, corners {}", corners.len());
            let shown: Vec<String> = corners.iter().take(PRINTED).map(u32::to_string).collect();
            if !shown.is_empty() {
                let more = if corners.len() > PRINTED { ", …" } else { "" };
                text += &format!(": vertices {}{more}", shown.join(", "));
            }
            text.push('\n');
        }
        text
    }
}

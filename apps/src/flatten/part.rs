//! The part of a surface that a label of FreeSurfer names, such as a cortex without its medial wall.

use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::SurfaceArgs;
use crate::runner::CommandRun;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::io::freesurfer::parse_label;
use ricci::mesh::repair::{Repair, repair};
use std::path::Path;

/// A part of a surface.
pub struct Part {
    pub input: Input,
    /// Per vertex of the part its number in the whole surface; none where the part is all of it.
    pub origins: Option<Vec<u32>>,
    /// The number of vertices of the whole surface.
    pub n_whole: usize,
}

/// The surface of a command, or the largest piece of it whose faces have all three vertices in a label.
pub fn read(args: &SurfaceArgs, label: Option<&Path>, run: &mut CommandRun<'_>) -> Result<Part, Failure> {
    let Some(label) = label else {
        let input = input::surface(args, &mut run.seconds, run.control)?;
        let n_whole = input.mesh().n_vertices();
        return Ok(Part { input, origins: None, n_whole });
    };
    run.control.step(Stage::Read, 0.0)?;
    let path = args.file.mesh.clone();
    let whole = input::read_triangles(&path)?;
    let n_whole = whole.positions.len();
    let is_named = named_vertices(label, n_whole)?;
    let inside: Vec<u32> = (0u32..)
        .zip(&whole.faces)
        .filter(|(_, face)| face.iter().all(|&v| is_named.get(v as usize) == Some(&true)))
        .map(|(f, _)| f)
        .collect();
    if inside.is_empty() {
        let why = format!("{}: no face of the surface has all its vertices in the label", label.display());
        return Err(Failure::Input(why));
    }
    let vertices: Vec<u32> = (0..n_whole as u32).collect();
    let soup = Soup {
        faces: inside.iter().map(|&f| whole.faces[f as usize]).collect(),
        attributes: whole.attributes.of_origins(&vertices, &inside),
        positions: whole.positions,
    };
    let one = Repair { weld: None, component: Some(0), ..Repair::default() };
    let part = repair(&soup, &one, &run.control.still())?;
    if let Some(why) = input::out_of_range(&part.soup) {
        return Err(Failure::Input(format!("{}: {why}", path.display())));
    }
    let (surface, attributes) = input::in_space(part.soup, args.input_geometry.map(Space::from))?;
    let input = Input { path, surface, attributes, split: None };
    Ok(Part { input, origins: Some(part.vertex_origin), n_whole })
}

/// For each of `n` vertices, true if the label names it.
pub fn named_vertices(path: &Path, n: usize) -> Result<Vec<bool>, Failure> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| Failure::Input(format!("{name}: {e}")))?;
    let label = parse_label(&String::from_utf8_lossy(&bytes), &name)?;
    let mut is_named = vec![false; n];
    for v in label.vertices.into_iter().flatten() {
        match is_named.get_mut(v as usize) {
            Some(named) => *named = true,
            None => {
                let why = format!("{name}: the label names vertex {v}, the surface has {n}");
                return Err(Failure::Input(why));
            }
        }
    }
    Ok(is_named)
}

//! The surface with its layout as texture coordinates.

use crate::carry::carry;
use crate::checkerboard;
use crate::failure::Failure;
use crate::input::Input;
use crate::laid::Laid;
use crate::options::OnChoice;
use crate::output::{Outputs, extension};
use ricci::mesh::io::{self, Texture, Textured, Wrap};
use ricci::mesh::{Mesh, PerHalfedge};
use std::path::Path;

/// Add OBJ or, from a name that ends in `.glb`, binary glTF with a checkerboard; with the input's colours and normals.
///
/// OBJ: `v` of the input, `vt` of the layout, `f v/vt`. The faces are the layout's (then the crossings of the input's edges with
/// flipped ones follow its vertices), or the input's own.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    laid: &Laid,
    (on, homogeneous): (OnChoice, bool),
) -> Result<(), Failure> {
    // Without positions `--uv` is refused before the flow.
    let (Some(positions), Some(own_positions)) = (laid.positions.as_deref(), input.positions()) else {
        return Ok(());
    };
    let (mesh, positions, index, texcoords, refinement) = match (on, &laid.on_input) {
        (OnChoice::Refined, _) => {
            (laid.mesh(), positions, laid.corner_index(), laid.coordinates(), laid.refinement())
        }
        (OnChoice::Input, Some(on_input)) => {
            (input.mesh(), own_positions, &on_input.corner_index, &on_input.coordinates[..], None)
        }
        (OnChoice::Input, None) => {
            return Err(Failure::Failed("--on input: the layout is not cut along the input's edges".into()));
        }
    };
    let faces = mesh.triangles();
    let weights = if homogeneous { laid.weights() } else { Vec::new() };
    let carried = carry(input, refinement)?;
    let data = Textured {
        positions,
        colors: &carried.colors,
        normals: &carried.normals,
        face_normals: &carried.face_normals,
        texcoords,
        texcoord_weights: &weights,
        faces: &faces,
        face_texcoords: &corners(mesh, index),
    };
    if extension(path) == "glb" {
        let (texcoords, png) = (checkerboard::coordinates(texcoords), checkerboard::png()?);
        let texture = Texture { png: &png, wrap: Wrap::Repeat };
        let data = Textured { texcoords: &texcoords, ..data };
        return outputs.add_named(path, |path| io::write_glb(path, &data, Some(texture)).map(drop));
    }
    outputs.add_named(path, |path| io::write_obj(path, &data))
}

/// The point of every corner of every face.
pub fn corners(mesh: &Mesh, index: &PerHalfedge<u32>) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
}

//! The surface with its layout as texture coordinates.

use crate::carry::carry;
use crate::checkerboard;
use crate::failure::Failure;
use crate::input::Input;
use crate::laid::Laid;
use crate::output::{Outputs, extension};
use ricci::mesh::io::{self, Texture, Textured, Wrap};
use std::path::Path;

/// Add OBJ (`v` of the input, then the crossings of its edges with flipped ones, `vt` of the layout, `f v/vt`) or, from a name that
/// ends in `.glb`, binary glTF with a checkerboard; with the input's colours and normals.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    laid: &Laid,
    homogeneous: bool,
) -> Result<(), Failure> {
    // Without positions `--uv` is refused before the flow.
    let Some(positions) = &laid.positions else { return Ok(()) };
    let mesh = &laid.mesh;
    let corners: Vec<[u32; 3]> =
        mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| laid.corner_index()[h])).collect();
    let faces = mesh.triangles();
    let weights = if homogeneous { laid.weights() } else { Vec::new() };
    let carried = carry(input, laid)?;
    let data = Textured {
        positions,
        colors: &carried.colors,
        normals: &carried.normals,
        face_normals: &carried.face_normals,
        texcoords: laid.coordinates(),
        texcoord_weights: &weights,
        faces: &faces,
        face_texcoords: &corners,
    };
    if extension(path) == "glb" {
        let (texcoords, png) = (checkerboard::coordinates(laid.coordinates()), checkerboard::png()?);
        let texture = Texture { png: &png, wrap: Wrap::Repeat };
        let data = Textured { texcoords: &texcoords, ..data };
        return outputs.add_named(path, |path| io::write_glb(path, &data, Some(texture)).map(drop));
    }
    outputs.add_named(path, |path| io::write_obj(path, &data))
}

//! The surface with its layout as texture coordinates.

use crate::failure::Failure;
use crate::glb::{self, Textured};
use crate::output::{Outputs, extension};
use ricci::embed::Layout;
use ricci::mesh::{Mesh, Point, io};
use std::io::Write;
use std::path::Path;

/// Add OBJ (`v` of the input, `vt` of the layout, `f v/vt`) or, from a name that ends in `.glb`, binary glTF.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    positions: &[Point],
    mesh: &Mesh,
    layout: &Layout,
) -> Result<(), Failure> {
    let corners: Vec<[u32; 3]> =
        mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| layout.corner_index[h])).collect();
    if extension(path) == "glb" {
        let mut at = vec![[0.0; 3]; layout.coordinates.len()];
        for h in mesh.halfedges() {
            at[layout.corner_index[h] as usize] = positions[mesh.origin(h).index()];
        }
        let bytes =
            glb::encode(&Textured { positions: at, texcoords: layout.coordinates.clone(), faces: corners })?;
        return outputs.add(path, |out| out.write_all(&bytes));
    }
    let faces: Vec<[u32; 3]> = mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect();
    let data = io::Textured {
        positions,
        texcoords: &layout.coordinates,
        faces: &faces,
        face_texcoords: &corners,
        ..io::Textured::default()
    };
    outputs.add_named(path, |path| io::write_obj(path, &data))
}

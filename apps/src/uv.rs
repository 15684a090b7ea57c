//! The surface with its layout as texture coordinates.

use crate::carry::{carry, left_out};
use crate::checkerboard;
use crate::failure::Failure;
use crate::input::Input;
use crate::laid::Laid;
use crate::options::{MetricArgs, OnChoice};
use crate::output::{Outputs, extension};
use crate::solved::Solved;
use ricci::mesh::io::{self, Texture, TexturedMesh, Wrap};
use ricci::mesh::{Mesh, PerHalfedge, Point};
use ricci::metric::Refinement;
use std::io::Write;
use std::path::Path;

/// Add OBJ or, from a name that ends in `.glb`, binary glTF with a checkerboard; with the input's colours and normals.
///
/// OBJ: `v` of the input, `vt` of the layout, `f v/vt`. The faces are the layout's (then the crossings of the input's edges with
/// flipped ones follow its vertices), or the input's own. Returned is how many vertices and faces the file has beyond the input's.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    laid: &Laid,
    (on, homogeneous): (OnChoice, bool),
) -> Result<[usize; 2], Failure> {
    // Without positions `--uv` is refused before the flow.
    let (Some(positions), Some(own_positions)) = (laid.positions.as_deref(), input.positions()) else {
        return Err(Failure::Failed("an intrinsic metric has no positions in space".into()));
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
    let weights = if homogeneous { laid.weights() } else { Vec::new() };
    Drawn { mesh, positions, index, texcoords, weights: &weights, refinement }.write(outputs, path, input)?;
    Ok([positions.len() - own_positions.len(), mesh.n_faces() - input.mesh().n_faces()])
}

/// A mesh in space with a drawing of it in the plane.
pub struct Drawn<'a> {
    pub mesh: &'a Mesh,
    pub positions: &'a [Point],
    /// Per half-edge, which of the coordinates the corner at its origin has.
    pub index: &'a PerHalfedge<u32>,
    pub texcoords: &'a [[f64; 2]],
    /// Homogeneous weights of the coordinates; none for 1.
    pub weights: &'a [f64],
    /// Where the mesh is a refinement of the input.
    pub refinement: Option<&'a Refinement>,
}

impl Drawn<'_> {
    /// Add OBJ or, from a name that ends in `.glb`, binary glTF with a checkerboard; with the input's colours and normals.
    pub fn write(&self, outputs: &mut Outputs, path: &Path, input: &Input) -> Result<(), Failure> {
        let faces = self.mesh.triangles();
        let carried = carry(input, self.refinement)?;
        let data = TexturedMesh {
            positions: self.positions,
            colors: &carried.colors,
            normals: &carried.normals,
            face_normals: &carried.face_normals,
            texcoords: self.texcoords,
            texcoord_weights: self.weights,
            faces: &faces,
            face_texcoords: &corners(self.mesh, self.index),
        };
        if extension(path) == "glb" {
            let png = checkerboard::png()?;
            let repeat = checkerboard::repeat(self.texcoords);
            let texture = Texture { png: &png, wrap: Wrap::Repeat, repeat };
            outputs.add_named(path, |path| io::write_glb(path, &data, Some(texture)).map(drop))
        } else {
            outputs.add(path, |out| io::write_obj_to(out, &data).map_err(std::io::Error::other))
        }
    }
}

/// Write `--uv` and `--xref`, as far as they are asked for; what cannot be made is remembered with its reason.
pub fn write_asked(
    outputs: &mut Outputs,
    input: &Input,
    laid: &Laid,
    (args, homogeneous): (&MetricArgs, bool),
    solved: &mut Solved,
) -> Result<(), Failure> {
    if let Some(path) = &args.uv {
        let written = write(outputs, path, input, laid, (args.on, homogeneous));
        if let Some(added) = solved.failed.attempt("uv", written)? {
            (solved.added, solved.left_out) = (added, left_out(input));
        }
    }
    if let Some(path) = &args.xref {
        let written = outputs.add(path, |out| write_origins(out, input, laid, args.on));
        solved.failed.attempt("xref", written)?;
    }
    Ok(())
}

/// The way back from the vertices and faces that `--uv` has to those of the input: a face for each face, and for each vertex a face
/// with barycentric coordinates in it.
pub fn write_origins(out: &mut impl Write, input: &Input, laid: &Laid, on: OnChoice) -> std::io::Result<()> {
    let refinement = laid.refinement().filter(|_| on == OnChoice::Refined);
    let mesh = refinement.map_or(input.mesh(), |r| &r.mesh);
    let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let source = |f| {
        let (face, corners) = refinement.map_or((f, whole), |r| (r.input_face[f], r.input_barycentric(f)));
        input.split.as_ref().map_or((face, corners), |split| split.carried(face, corners))
    };
    let mut place = vec![None; mesh.n_vertices()];
    for f in mesh.faces() {
        let (face, corners) = source(f);
        for (v, weights) in mesh.face_vertices(f).into_iter().zip(corners) {
            place[v.index()].get_or_insert((face, weights));
        }
    }
    writeln!(out, "output_face,source_face")?;
    io::text::write_blocks(out, mesh.n_faces(), |text, f| {
        text.count(f as u64);
        text.character(',');
        text.count(source(f.into()).0.0.into());
        text.character('\n');
    })?;
    writeln!(out, "output_vertex,source_face,b0,b1,b2")?;
    for (v, (face, [a, b, c])) in place.into_iter().enumerate().filter_map(|(v, p)| Some((v, p?))) {
        writeln!(out, "{v},{face},{a},{b},{c}")?;
    }
    Ok(())
}

/// The point of every corner of every face.
pub fn corners(mesh: &Mesh, index: &PerHalfedge<u32>) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
}

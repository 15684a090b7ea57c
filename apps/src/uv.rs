//! The files of `--uv` and `--xref`: the surface with its layout as texture coordinates, and the way back to the input.

use crate::carry::{carry, left_out};
use crate::checkerboard;
use crate::failure::Failure;
use crate::input::Input;
use crate::options::{MetricArgs, OnChoice};
use crate::output::{Outputs, extension};
use crate::runner::CommandRun;
use crate::surface_layout::SurfaceLayout;
use ricci::mesh::io::{self, Texture, TexturedMesh, Wrap};
use ricci::mesh::{Mesh, PerHalfedge, Point};
use ricci::metric::CommonSubdivision;
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// The faces of `--uv`, and whether its texture coordinates are homogeneous.
#[derive(Default)]
pub struct UvOptions {
    pub on: OnChoice,
    pub homogeneous: bool,
}

/// Write OBJ or, for a name that ends in `.glb`, binary glTF with a checkerboard; with the input's colours, normals and, in OBJ, names of faces.
///
/// OBJ: `v` of the input, `vt` of the layout, `f v/vt`. The faces are the layout's (then the crossings of the input's edges with
/// flipped ones follow its vertices), or the input's own, with edges split where that was asked for. Returns the numbers of vertices and
/// faces that the subdivision has beyond the input.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    laid: &SurfaceLayout,
    options: UvOptions,
) -> Result<[usize; 2], Failure> {
    let own = faces_of(input, laid, options.on)?;
    let weights = if options.homogeneous { laid.weights() } else { Vec::new() };
    let added =
        [own.positions.len() - input.mesh().n_vertices(), own.mesh.n_faces() - input.mesh().n_faces()];
    UvMesh { weights: &weights, ..own }.write(outputs, path, input)?;
    // The summary tells those of split edges on a line of their own.
    Ok(if options.on == OnChoice::Refined { added } else { [0; 2] })
}

/// The mesh of `--uv`: the layout's faces, or the input's own, with edges split where that was asked for.
pub fn faces_of<'a>(input: &'a Input, laid: &'a SurfaceLayout, on: OnChoice) -> Result<UvMesh<'a>, Failure> {
    // Without positions `--uv` is refused before the flow.
    let (Some(positions), Some(own_positions)) = (laid.positions.as_deref(), input.positions()) else {
        return Err(Failure::no_positions());
    };
    match (on, &laid.on_input, laid.repaired()) {
        (OnChoice::Refined, ..) => Ok(UvMesh {
            mesh: laid.mesh(),
            positions: positions.into(),
            index: laid.corner_index(),
            texcoords: laid.coordinates(),
            weights: &[],
            subdivision: laid.common_subdivision(),
        }),
        (OnChoice::Input, _, Some(repaired)) => Ok(UvMesh {
            mesh: repaired.mesh(),
            positions: repaired.refinement.from_vertices(0, own_positions)?.into(),
            index: &repaired.corner_index,
            texcoords: &repaired.coordinates,
            weights: &[],
            subdivision: Some(&*repaired.refinement),
        }),
        (OnChoice::Input, Some(on_input), None) => Ok(UvMesh {
            mesh: input.mesh(),
            positions: own_positions.into(),
            index: &on_input.corner_index,
            texcoords: &on_input.coordinates,
            weights: &[],
            subdivision: None,
        }),
        (OnChoice::Input, None, None) => {
            Err(Failure::Failed("--on input: the layout is not cut along the input's edges".into()))
        }
    }
}

/// A mesh in space with texture coordinates.
pub struct UvMesh<'a> {
    pub mesh: &'a Mesh,
    pub positions: Cow<'a, [Point]>,
    /// Per half-edge the index of the texture coordinates of the corner at its origin.
    pub index: &'a PerHalfedge<u32>,
    pub texcoords: &'a [[f64; 2]],
    /// The homogeneous weights of the coordinates; empty where all are 1.
    pub weights: &'a [f64],
    /// The subdivision of the input that the mesh is, if it is one.
    pub subdivision: Option<&'a CommonSubdivision>,
}

impl UvMesh<'_> {
    /// Write OBJ or, for a name that ends in `.glb`, binary glTF with a checkerboard; with the input's colours, normals and, in OBJ, names of faces.
    pub fn write(&self, outputs: &mut Outputs, path: &Path, input: &Input) -> Result<(), Failure> {
        let faces = self.mesh.triangles();
        let carried = carry(input, self.subdivision)?;
        let data = TexturedMesh {
            positions: &self.positions,
            colors: &carried.colors,
            normals: &carried.normals,
            face_normals: &carried.face_normals,
            texcoords: self.texcoords,
            texcoord_weights: self.weights,
            faces: &faces,
            face_texcoords: &corners(self.mesh, self.index),
            labels: carried.labels.as_ref(),
        };
        let left_out = left_out(input, path)?;
        if extension(path) == "glb" {
            let png = checkerboard::png()?;
            let repeat = checkerboard::repeat(self.texcoords);
            let texture = Texture { png: &png, wrap: Wrap::Repeat, repeat };
            outputs.add_named(path, |path| io::write_glb(path, &data, Some(texture)).map(drop))?;
        } else {
            outputs.add(path, |out| io::write_obj_to(out, &data).map_err(std::io::Error::other))?;
        }
        outputs.leave_out(left_out);
        Ok(())
    }
}

/// Write `--uv` and `--xref`, as far as they are asked for.
///
/// # Errors
/// [`Failure::Cancelled`] alone.
pub fn write_asked(
    run: &mut CommandRun<'_>,
    input: &Input,
    laid: &SurfaceLayout,
    args: &MetricArgs,
    homogeneous: bool,
) -> Result<(), Failure> {
    if let Some(path) = &args.uv {
        let written = write(&mut run.outputs, path, input, laid, UvOptions { on: args.on, homogeneous });
        if let Some(added) = run.failed.attempt("uv", written)? {
            run.added = added;
        }
    }
    run.file("xref", args.xref.as_deref(), |outputs, path| {
        outputs.add(path, |out| write_origins(out, input, laid, args.on))
    })
}

/// The way back from the vertices and faces that `--uv` has to those of the input: a face for each face, and for each vertex a face
/// with barycentric coordinates in it.
pub fn write_origins(
    out: &mut impl Write,
    input: &Input,
    laid: &SurfaceLayout,
    on: OnChoice,
) -> std::io::Result<()> {
    let subdivision = match on {
        OnChoice::Refined => laid.common_subdivision(),
        OnChoice::Input => laid.repaired().map(|repaired| &*repaired.refinement),
    };
    let mesh = subdivision.map_or(input.mesh(), |r| &r.mesh);
    let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let source = |f| {
        let (face, corners) = subdivision.map_or((f, whole), |r| (r.faces[0][f], r.barycentric(0, f)));
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

/// The index of the point of every corner of every face.
pub fn corners(mesh: &Mesh, index: &PerHalfedge<u32>) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
}

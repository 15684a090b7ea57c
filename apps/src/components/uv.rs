//! The file of `--uv` with the layouts of all components, side by side.

use super::outcome::{ComponentFlow, ComponentsOutcome};
use crate::carry::carry;
use crate::failure::Failure;
use crate::options::OnChoice;
use crate::output::{Outputs, write_textured};
use crate::surface_layout::SurfaceLayout;
use crate::uv::{UvMesh, corners, faces_of};
use ricci::geometry::row_packing::in_rows;
use ricci::mesh::Point;
use ricci::mesh::io::TexturedMesh;
use std::path::Path;

/// Write the layouts; returns the numbers of vertices and faces that the file has beyond the input's. The vertices of the input keep their
/// numbers and are followed by those where edges cross others; with `on` the input's own faces, these keep their numbers too.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    all: &ComponentsOutcome,
    on: OnChoice,
) -> Result<[usize; 2], Failure> {
    let laid = all.flows.iter().enumerate().map(|(k, flow)| {
        let why = |why: &String| Failure::Failed(format!("component {k} has no layout: {why}"));
        flow.outcome.layout.as_ref().map_err(why)
    });
    let laid: Vec<&SurfaceLayout> = laid.collect::<Result<_, _>>()?;
    let meshes: Vec<UvMesh<'_>> = all
        .flows
        .iter()
        .zip(&laid)
        .map(|(flow, laid)| faces_of(&flow.outcome.input, laid, on))
        .collect::<Result<_, _>>()?;
    let moved = moves(&meshes);
    let mut file = JoinedUv::new(all);
    for ((flow, mesh), by) in all.flows.iter().zip(&meshes).zip(moved) {
        file.add(flow, mesh, by)?;
    }
    let [added, faces] = [file.positions.len() - all.soup.positions.len(), file.faces.len()];
    let colors = if file.is_colored { &file.colors[..] } else { &[] };
    let data = TexturedMesh {
        positions: &file.positions,
        colors,
        normals: &[],
        face_normals: &[],
        texcoords: &file.texcoords,
        texcoord_weights: &[],
        faces: &file.faces,
        face_texcoords: &file.face_texcoords,
        labels: None,
    };
    write_textured(outputs, path, &data)?;
    let holds_more = |flow: &ComponentFlow| {
        let given = &flow.outcome.input.attributes;
        let numbers = given.vertex_numbers.len() + given.face_numbers.len();
        given.normals.is_some() || given.corner_normals.is_some() || given.labels.is_some() || numbers > 0
    };
    if all.flows.iter().any(holds_more) {
        let what =
            "normals, groups, materials and further numbers: a file of several components has colours alone";
        outputs.leave_out([what.to_string()]);
    }
    Ok([added, faces - all.soup.faces.len()])
}

/// The way that each layout is moved, so that none lies on another one.
fn moves(meshes: &[UvMesh<'_>]) -> Vec<[f64; 2]> {
    let corner = |mesh: &UvMesh<'_>, pick: fn(f64, f64) -> f64, start: f64| {
        mesh.texcoords.iter().fold([start; 2], |m, p| [pick(m[0], p[0]), pick(m[1], p[1])])
    };
    let low: Vec<[f64; 2]> = meshes.iter().map(|mesh| corner(mesh, f64::min, f64::INFINITY)).collect();
    let high = meshes.iter().map(|mesh| corner(mesh, f64::max, f64::NEG_INFINITY));
    let sizes: Vec<[f64; 2]> = high.zip(&low).map(|(h, l)| [h[0] - l[0], h[1] - l[1]]).collect();
    in_rows(&sizes).iter().zip(&low).map(|(at, low)| [at[0] - low[0], at[1] - low[1]]).collect()
}

/// The arrays of the file while components are added.
struct JoinedUv {
    positions: Vec<Point>,
    colors: Vec<[f64; 4]>,
    is_colored: bool,
    texcoords: Vec<[f64; 2]>,
    faces: Vec<[u32; 3]>,
    face_texcoords: Vec<[u32; 3]>,
}

impl JoinedUv {
    fn new(all: &ComponentsOutcome) -> JoinedUv {
        // The faces of the input stand at their own places; those beyond follow.
        let n_faces = all.soup.faces.len();
        JoinedUv {
            positions: all.soup.positions.clone(),
            colors: vec![[1.0; 4]; all.soup.positions.len()],
            is_colored: false,
            texcoords: Vec::new(),
            faces: vec![[0; 3]; n_faces],
            face_texcoords: vec![[0; 3]; n_faces],
        }
    }

    fn add(&mut self, flow: &ComponentFlow, mesh: &UvMesh<'_>, by: [f64; 2]) -> Result<(), Failure> {
        let first = self.texcoords.len() as u32;
        self.texcoords.extend(mesh.texcoords.iter().map(|p| [p[0] + by[0], p[1] + by[1]]));
        let mut vertices = flow.vertices.clone();
        for position in &mesh.positions[vertices.len()..] {
            vertices.push(self.positions.len() as u32);
            self.positions.push(*position);
            self.colors.push([1.0; 4]);
        }
        let carried = carry(&flow.outcome.input, mesh.subdivision)?;
        for (&v, color) in vertices.iter().zip(&carried.colors) {
            (self.colors[v as usize], self.is_colored) = (*color, true);
        }
        let all = mesh.mesh.triangles().into_iter().zip(corners(mesh.mesh, mesh.index));
        for (k, (face, uv)) in all.enumerate() {
            let (face, uv) = (face.map(|v| vertices[v as usize]), uv.map(|i| first + i));
            match flow.faces.get(k) {
                Some(&f) => (self.faces[f as usize], self.face_texcoords[f as usize]) = (face, uv),
                None => {
                    self.faces.push(face);
                    self.face_texcoords.push(uv);
                }
            }
        }
        Ok(())
    }
}

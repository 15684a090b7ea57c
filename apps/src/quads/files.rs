//! Files of quads: OBJ and PLY with faces of four corners, binary glTF with two triangles for each quad.

use super::texture::PatchPoint;
use crate::failure::Failure;
use crate::output::{Outputs, extension, write_textured};
use ricci::mesh::Point;
use ricci::mesh::io::TexturedMesh;
use ricci::quads::QuadMesh;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::Path;

/// The extensions of the formats.
pub const EXTENSIONS: [&str; 3] = ["obj", "ply", "glb"];

/// Quads in space, which may be those of patches.
pub struct QuadFile<'a> {
    pub positions: &'a [Point],
    pub quads: &'a [[u32; 4]],
    /// The quads of each patch; none for quads without patches.
    pub patches: Vec<&'a [u32]>,
    /// Per quad the texture coordinates of its corners, for OBJ; none to leave them out.
    pub texture: Option<Vec<[PatchPoint; 4]>>,
}

impl QuadFile<'_> {
    /// Writes the file in the format of its name: OBJ where the name does not say it.
    pub fn write(&self, outputs: &mut Outputs, path: &Path) -> Result<(), Failure> {
        match extension(path).as_str() {
            "ply" => outputs.add(path, |out| self.write_ply(out)),
            "glb" => {
                let faces: Vec<[u32; 3]> =
                    self.quads.iter().flat_map(|&quad| QuadMesh::halves(quad)).collect();
                let data =
                    TexturedMesh { positions: self.positions, faces: &faces, ..TexturedMesh::default() };
                write_textured(outputs, path, &data)
            }
            _ => outputs.add(path, |out| self.write_obj(out)),
        }
    }

    /// OBJ, each patch as a group.
    fn write_obj(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for [x, y, z] in self.positions {
            writeln!(out, "v {x} {y} {z}")?;
        }
        let numbers = self.write_texture(out)?;
        if self.patches.is_empty() {
            return (0..self.quads.len()).try_for_each(|q| self.write_face(out, q, &numbers));
        }
        for (k, patch) in self.patches.iter().enumerate() {
            writeln!(out, "g patch_{k}")?;
            patch.iter().try_for_each(|&q| self.write_face(out, q as usize, &numbers))?;
        }
        Ok(())
    }

    /// The texture coordinates, each once; returns their numbers, from 1.
    fn write_texture(&self, out: &mut dyn Write) -> std::io::Result<BTreeMap<PatchPoint, usize>> {
        let points: BTreeSet<PatchPoint> = self.texture.iter().flatten().flatten().copied().collect();
        points.iter().try_for_each(|[x, y]| writeln!(out, "vt {x} {y}"))?;
        Ok(points.into_iter().zip(1..).collect())
    }

    /// A face of OBJ.
    fn write_face(
        &self,
        out: &mut dyn Write,
        q: usize,
        numbers: &BTreeMap<PatchPoint, usize>,
    ) -> std::io::Result<()> {
        let [a, b, c, d] = self.quads[q].map(|v| v + 1);
        let Some(texture) = &self.texture else { return writeln!(out, "f {a} {b} {c} {d}") };
        let [s, t, u, v] = texture[q].map(|point| numbers[&point]);
        writeln!(out, "f {a}/{s} {b}/{t} {c}/{u} {d}/{v}")
    }

    /// Binary PLY, the patch of each quad as a number of it.
    fn write_ply(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let version = env!("CARGO_PKG_VERSION");
        write!(out, "ply\nformat binary_little_endian 1.0\ncomment ricci {version}\n")?;
        writeln!(out, "element vertex {}", self.positions.len())?;
        ["x", "y", "z"].iter().try_for_each(|x| writeln!(out, "property double {x}"))?;
        write!(out, "element face {}\nproperty list uchar uint vertex_indices\n", self.quads.len())?;
        let mut patch_of = vec![0u32; self.quads.len()];
        for (k, patch) in (0..).zip(&self.patches) {
            patch.iter().for_each(|&q| patch_of[q as usize] = k);
        }
        if !self.patches.is_empty() {
            writeln!(out, "property uint patch")?;
        }
        writeln!(out, "end_header")?;
        for x in self.positions.iter().flatten() {
            out.write_all(&x.to_le_bytes())?;
        }
        for (quad, patch) in self.quads.iter().zip(patch_of) {
            out.write_all(&[4])?;
            quad.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
            if !self.patches.is_empty() {
                out.write_all(&patch.to_le_bytes())?;
            }
        }
        Ok(())
    }
}

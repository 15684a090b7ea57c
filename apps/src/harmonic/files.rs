//! Harmonic maps as files and in pictures.

use super::args::HarmonicArgs;
use super::outcome::{HarmonicOutcome, PlaneMap};
use crate::failure::Failure;
use crate::flat::FlatLayout;
use crate::input::Input;
use crate::options::FlatArgs;
use crate::output::{Outputs, write_textured};
use crate::picture::{self, Picture, ShownLayout, ShownSurface, TextureChoice};
use crate::uv::UvMesh;
use ricci::embed::FlatSurface;
use ricci::harmonic::SphereMap;
use ricci::mesh::io::TexturedMesh;
use ricci::mesh::{Mesh, PerHalfedge, VertexId};
use std::borrow::Cow;
use std::path::Path;

impl PlaneMap {
    fn mesh<'a>(&'a self, input: &'a Input) -> &'a Mesh {
        self.subdivision.as_ref().map_or(input.mesh(), |r| &r.mesh)
    }

    /// The surface with the map as texture coordinates.
    pub fn write(&self, outputs: &mut Outputs, path: &Path, input: &Input) -> Result<(), Failure> {
        let mesh = self.mesh(input);
        let index = PerHalfedge::from_fn(mesh.n_halfedges(), |h| mesh.origin(h).0);
        let drawn = UvMesh {
            mesh,
            positions: input.positions_on(self.subdivision.as_ref())?.into(),
            index: &index,
            texcoords: &self.points,
            weights: &[],
            subdivision: self.subdivision.as_ref(),
        };
        drawn.write(outputs, path, input)
    }

    /// The image in the plane as geometry.
    pub fn write_flat(
        &self,
        outputs: &mut Outputs,
        path: &Path,
        input: &Input,
        args: &FlatArgs,
    ) -> Result<(), Failure> {
        let mesh = self.mesh(input);
        let index = PerHalfedge::from_fn(mesh.n_halfedges(), |h| mesh.origin(h).0);
        let points = Cow::Borrowed(&self.points[..]);
        let surface = FlatSurface { mesh, corner_index: &index, points, seams: Vec::new() };
        FlatLayout { surface, input, subdivision: self.subdivision.as_ref() }.write(outputs, path, args)
    }

    /// The surface beside its image, or as SVG the image alone.
    pub fn draw(&self, input: &Input, args: &HarmonicArgs) -> Result<Vec<u8>, Failure> {
        let mesh = self.mesh(input);
        let style = args.picture.style(TextureChoice::Checker, args.common.threads);
        let faces = mesh.triangles();
        let corner_uv: Vec<_> = faces.iter().map(|f| f.map(|v| self.points[v as usize])).collect();
        let outer = mesh.halfedges().filter(|&h| mesh.is_outside(h.twin()));
        let at = |v: VertexId| self.points[v.index()];
        let boundary: Vec<_> = outer.map(|h| (at(mesh.origin(h)), at(mesh.tip(h)))).collect();
        let flat = Some(ShownLayout { corner_uv: &corner_uv, boundary: &boundary, ..ShownLayout::default() });
        if args.picture.is_svg() {
            return picture::svg(&Picture { flat, ..Picture::default() }, &style);
        }
        let positions = input.positions_on(self.subdivision.as_ref())?;
        let surface = ShownSurface {
            positions: &positions,
            faces: &faces,
            corner_uv: Some(&corner_uv),
            seams: &[],
            cones: &[],
            is_closed: false,
        };
        picture::png(&Picture { surface: Some(surface), flat, ..Picture::default() }, &style)
    }
}

/// The sphere as a mesh file, with the faces of the domain.
pub fn write_sphere(
    outputs: &mut Outputs,
    path: &Path,
    outcome: &HarmonicOutcome,
    map: &SphereMap,
) -> Result<(), Failure> {
    let faces = outcome.domain.mesh().triangles();
    let data = TexturedMesh { positions: &map.points, faces: &faces, ..TexturedMesh::default() };
    write_textured(outputs, path, &data)
}

/// The sphere with the edges of the domain.
pub fn draw_sphere(
    outcome: &HarmonicOutcome,
    map: &SphereMap,
    args: &HarmonicArgs,
) -> Result<Vec<u8>, Failure> {
    let faces = outcome.domain.mesh().triangles();
    let surface = ShownSurface {
        positions: &map.points,
        faces: &faces,
        corner_uv: None,
        seams: &[],
        cones: &[],
        is_closed: true,
    };
    let style = picture::Style { wire: true, ..args.picture.style(TextureChoice::None, args.common.threads) };
    picture::png(&Picture { surface: Some(surface), ..Picture::default() }, &style)
}

//! A flat map as files and in pictures.

use super::args::FlattenArgs;
use super::outcome::PlaneOutcome;
use super::seamed::SeamedMap;
use crate::failure::Failure;
use crate::flat::FlatLayout;
use crate::options::FlatArgs;
use crate::output::Outputs;
use crate::picture::{self, Picture, ShownLayout, ShownSurface, TextureChoice};
use crate::uv::UvMesh;
use ricci::embed::FlatSurface;
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::SurfaceFile;
use ricci::mesh::io::freesurfer::{SurfacePatch, patch_bytes};
use ricci::mesh::{HalfedgeId, Mesh, PerHalfedge, Point};
use ricci::metric::CommonSubdivision;
use std::borrow::Cow;
use std::cmp::Ordering;
use std::path::Path;

impl PlaneOutcome {
    fn mesh(&self) -> &Mesh {
        self.seamed.as_ref().map_or(self.input.mesh(), |seamed| seamed.map.surface.mesh())
    }

    /// The subdivision of a surface with seams some of whose edges were split.
    fn subdivision(&self) -> Option<&CommonSubdivision> {
        self.seamed.as_ref()?.map.refinement.as_deref()
    }

    fn positions(&self) -> Result<&[Point], Failure> {
        let own = match &self.seamed {
            Some(seamed) => seamed.map.surface.positions().map(|all| &all[..]),
            None => self.input.positions(),
        };
        own.ok_or_else(Failure::no_positions)
    }

    /// Per half-edge the number of the point of the corner at its origin.
    fn corner_index(&self) -> PerHalfedge<u32> {
        if let Some(seamed) = &self.seamed {
            return seamed.map.layout.corner_index.clone();
        }
        PerHalfedge::from_fn(self.mesh().n_halfedges(), |h| self.mesh().origin(h).0)
    }

    /// The half-edges on the left side of seams, with their numbers.
    fn seams(&self) -> Vec<(HalfedgeId, usize)> {
        let Some(seamed) = &self.seamed else { return Vec::new() };
        let segments = seamed.map.layout.cut.segments.iter().enumerate();
        segments.flat_map(|(k, segment)| segment.iter().map(move |&h| (h, k))).collect()
    }

    /// The surface with the map as texture coordinates. The file is read again, and the triangles are counted that its numbers turn over.
    pub fn write_uv(&self, outputs: &mut Outputs, path: &Path) -> Result<(), Failure> {
        let positions = self.positions()?;
        let index = self.corner_index();
        let drawn = UvMesh {
            mesh: self.mesh(),
            positions: positions.into(),
            index: &index,
            texcoords: &self.flat.points,
            weights: &[],
            subdivision: self.subdivision(),
        };
        drawn.write(outputs, path, &self.input)?;
        let told = |why: &dyn std::fmt::Display| Failure::Failed(format!("{}: {why}", path.display()));
        let bytes = outputs.last_bytes().map_err(|why| told(&why))?;
        let soup = SurfaceFile::of_bytes(bytes, &path.display().to_string())?.soup()?;
        let Some(uv) = soup.attributes.uv.filter(|uv| uv.len() == self.mesh().n_faces()) else {
            return Err(told(&"the file does not read back with texture coordinates for all faces"));
        };
        let turned = uv.iter().filter(|&&[a, b, c]| orientation(a, b, c) != Ordering::Greater).count();
        self.written_turned.get_or_init(|| turned);
        Ok(())
    }

    /// The image in the plane as geometry.
    pub fn write_flat(&self, outputs: &mut Outputs, path: &Path, args: &FlatArgs) -> Result<(), Failure> {
        let index = self.corner_index();
        let points = Cow::Borrowed(&self.flat.points[..]);
        let surface = FlatSurface { mesh: self.mesh(), corner_index: &index, points, seams: self.seams() };
        FlatLayout { surface, input: &self.input, subdivision: self.subdivision() }.write(outputs, path, args)
    }

    /// The bytes of the map as a patch of FreeSurfer.
    pub fn patch(&self) -> Result<Vec<u8>, Failure> {
        let mesh = self.mesh();
        let vertices: Vec<u32> = mesh.vertices().map(|v| self.origin(v)).collect();
        let mut seen = std::collections::HashSet::new();
        if let Some(v) = vertices.iter().find(|v| !seen.insert(**v)) {
            let why = format!(
                "the part touches itself at vertex {v} alone, which a patch has once: leave it out of the label"
            );
            return Err(Failure::Failed(why));
        }
        let patch = SurfacePatch {
            vertices,
            positions: self.flat.points.iter().map(|[x, y]| [*x, *y, 0.0]).collect(),
            is_border: mesh.vertices().map(|v| mesh.is_boundary_vertex(v)).collect(),
        };
        Ok(patch_bytes(&patch)?)
    }

    /// The surface beside its image, or as SVG the image alone.
    pub fn draw(&self, args: &FlattenArgs) -> Result<Vec<u8>, Failure> {
        let mesh = self.mesh();
        let style = args.picture.style(TextureChoice::Checker, args.common.threads);
        let faces = mesh.triangles();
        let index = self.corner_index();
        let at = |h: HalfedgeId| self.flat.points[index[h] as usize];
        let corner_uv: Vec<_> = mesh.faces().map(|f| mesh.face_halfedges(f).map(at)).collect();
        let is_side = |h: &HalfedgeId| {
            let is_cut = |seamed: &SeamedMap| seamed.map.layout.side(*h) != 0;
            mesh.is_outside(h.twin()) || self.seamed.as_ref().is_some_and(is_cut)
        };
        let sides = mesh.halfedges().filter(is_side);
        let boundary: Vec<_> = sides.map(|h| (at(h), at(mesh.next(h)))).collect();
        let flat = Some(ShownLayout { corner_uv: &corner_uv, boundary: &boundary, ..ShownLayout::default() });
        if args.picture.is_svg() {
            return picture::svg(&Picture { flat, ..Picture::default() }, &style);
        }
        let positions = self.positions()?;
        let surface = ShownSurface {
            positions,
            faces: &faces,
            corner_uv: Some(&corner_uv),
            seams: &[],
            cones: &[],
            is_closed: false,
        };
        picture::png(&Picture { surface: Some(surface), flat, ..Picture::default() }, &style)
    }
}

//! Pictures of quad meshes and layouts on their surface.

use crate::failure::Failure;
use crate::picture::{
    self, ColorField, ColorScale, LineMeaning, Picture, PictureArgs, ShownSurface, TextureChoice,
};
use crate::quantity::hues;
use ricci::mesh::{FaceId, Mesh, Point, VertexId};
use ricci::quads::{QuadLayout, QuadMesh};

/// What is drawn of a quad mesh.
pub struct ShownQuads<'a> {
    pub mesh: &'a QuadMesh,
    pub positions: &'a [Point],
    /// The layout whose patches are coloured and whose arcs are drawn, in place of all edges.
    pub layout: Option<&'a QuadLayout>,
}

impl ShownQuads<'_> {
    /// The quads, or the patches of the layout in colours, with the irregular vertices as dots.
    pub fn draw(&self, args: &PictureArgs, threads: usize) -> Result<Vec<u8>, Failure> {
        let quads = &self.mesh.quads;
        let faces: Vec<[u32; 3]> = quads.iter().flat_map(|&quad| QuadMesh::halves(quad)).collect();
        let mesh = Mesh::from_faces(self.positions.len(), &faces)?;
        let field = self.layout.map(|layout| patch_colours(layout, &mesh));
        let (lines, dots) = (self.lines(), self.irregular(&mesh));
        let surface = ShownSurface {
            positions: self.positions,
            faces: &faces,
            corner_uv: None,
            seams: &lines,
            cones: &dots,
            is_closed: mesh.is_closed(),
        };
        let meaning = if self.layout.is_some() { LineMeaning::Arcs } else { LineMeaning::Quads };
        let drawn =
            Picture { surface: Some(surface), field: field.as_ref(), lines: meaning, ..Picture::default() };
        picture::png(&drawn, &args.style(TextureChoice::None, threads))
    }

    /// The arcs of the layout, those on features in a colour of their own, or all edges.
    fn lines(&self) -> Vec<(u32, u32, usize)> {
        if let Some(layout) = self.layout {
            let pieces = |arc: &ricci::quads::LayoutArc| {
                let kind = usize::from(arc.is_crease);
                arc.vertices.windows(2).map(|pair| (pair[0], pair[1], kind)).collect::<Vec<_>>()
            };
            return layout.arcs.iter().flat_map(pieces).collect();
        }
        let sides = self.mesh.quads.iter().flat_map(|quad| (0..4).map(|i| [quad[i], quad[(i + 1) % 4]]));
        let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges.into_iter().map(|[a, b]| (a, b, 0)).collect()
    }

    /// The vertices without four quads, or two on the boundary, with the sign of their curvature.
    fn irregular(&self, mesh: &Mesh) -> Vec<(u32, f64)> {
        let valence = self.mesh.valences();
        let turn = |v: u32| {
            let regular = if mesh.is_boundary_vertex(VertexId(v)) { 2.0 } else { 4.0 };
            (v, regular - f64::from(valence[v as usize]))
        };
        (0..valence.len() as u32).map(turn).filter(|(_, turn)| *turn != 0.0).collect()
    }
}

/// Colours of the patches, other ones for neighbours.
fn patch_colours(layout: &QuadLayout, mesh: &Mesh) -> ColorField {
    let mut patch = vec![None; layout.mesh.quads.len()];
    for (k, of) in (0..).zip(&layout.patches) {
        of.quads.iter().for_each(|&q| patch[q as usize] = Some(k));
    }
    let owner = |f: FaceId| patch[f.index() / 2];
    let colour = hues(mesh, owner, layout.patches.len());
    let value = |f: FaceId| owner(f).map_or(f64::NAN, |k: u32| colour[k as usize] as f64);
    ColorField {
        corners: mesh.faces().map(|f| [value(f); 3]).collect(),
        scale: ColorScale::of_hues("patches", "neighbours have different colours"),
    }
}

//! The picture of a hemisphere: inflated view, sphere and flat map, in the colours of the sulci.

use super::args::BrainArgs;
use super::outcome::Hemisphere;
use crate::failure::Failure;
use crate::picture::{
    self, ColorField, ColorScale, Picture, ShownLayout, ShownSurface, Style, TextureChoice, Viewpoint,
};
use ricci::mesh::VertexId;

impl BrainArgs {
    pub fn draw(&self, of: &Hemisphere) -> Result<Vec<u8>, Failure> {
        // Cortices lie in space with z up; they are seen from the side that is away from the other hemisphere.
        let lateral = of.side.medial().map(|x| -x);
        let view = Viewpoint { up: Some([0.0, 0.0, 1.0]), from: Some(lateral), angles: None };
        let style = Style { view, ..self.picture().style(TextureChoice::None, self.common.threads) };
        let faces = of.surface.mesh().triangles();
        let on_sphere = of.on_sphere(1.0);
        let shown = |positions| ShownSurface {
            positions,
            faces: &faces,
            corner_uv: None,
            seams: &[],
            cones: &[],
            is_closed: true,
        };
        // Faces outside the cortex come together in one of its points.
        let whole = of.whole_flat();
        let [x, y] = of.cortex.flat.points.first().copied().unwrap_or_default();
        let corner_uv: Vec<[[f64; 2]; 3]> = faces
            .iter()
            .map(|f| {
                let inside = f.iter().all(|&v| of.is_cortex[v as usize]);
                f.map(|v| if inside { [whole[v as usize][0], whole[v as usize][1]] } else { [x, y] })
            })
            .collect();
        let mesh = of.cortex.surface.mesh();
        let at = |v: VertexId| of.cortex.flat.points[v.index()];
        let outer = mesh.halfedges().filter(|&h| mesh.is_outside(h.twin()));
        let boundary: Vec<_> = outer.map(|h| (at(mesh.origin(h)), at(mesh.tip(h)))).collect();
        let corners = faces.iter().map(|f| f.map(|v| of.sulc[v as usize])).collect();
        let scale = ColorScale::of_signed("way outwards while inflated, less the mean", &of.sulc);
        let field = ColorField { corners, scale };
        let flat = ShownLayout { corner_uv: &corner_uv, boundary: &boundary, ..ShownLayout::default() };
        picture::png(
            &Picture {
                surface: Some(shown(&of.inflated)),
                beside: Some(shown(&on_sphere)),
                flat: Some(flat),
                field: Some(&field),
                ..Picture::default()
            },
            &style,
        )
    }
}

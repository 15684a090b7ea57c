//! The picture of an atlas: the surface with its charts in colours.

use super::args::StructureArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::picture::{self, ColorField, ColorScale, LineMeaning, Picture, ShownSurface, TextureChoice};
use crate::quantity::hues;
use ricci::Control;
use ricci::mesh::{FaceId, PerFace};
use ricci::structure::Atlas;
use std::sync::Arc;

/// Per face the chart in whose colour it is drawn: the first chart whose core it belongs to; none for an excluded face.
fn owners(atlas: &Atlas) -> PerFace<Option<u32>> {
    let mut owner = PerFace::filled(atlas.mesh.n_faces(), None);
    for (k, chart) in (0..).zip(&atlas.charts) {
        for &f in &chart.faces[..chart.n_core] {
            owner[f].get_or_insert(k);
        }
    }
    owner
}

pub fn draw(
    input: &Input,
    atlas: &Atlas,
    args: &StructureArgs,
    control: &Control,
) -> Result<Vec<u8>, Failure> {
    let owner = owners(atlas);
    let colour = hues(&atlas.mesh, |f| owner[f], atlas.charts.len());
    // The given surface, cut along the edges of the atlas's triangulation; for an integer structure its quads.
    let subdivision = match &atlas.subdivision {
        _ if atlas.on_given.is_some() => None,
        Some(subdivision) => Some(subdivision.clone()),
        None if atlas.metric.is_unflipped() => None,
        None => Some(Arc::new(atlas.metric.common_subdivision(control)?)),
    };
    let mesh = subdivision.as_ref().map_or(&*atlas.mesh, |r| &r.mesh);
    let face = |f: FaceId| match &subdivision {
        Some(r) if atlas.subdivision.is_none() => r.faces[1][f],
        _ => f,
    };
    let positions = match (&atlas.on_given, input.positions()) {
        (Some(places), Some(positions)) => {
            places.iter().map(|place| place.point(input.surface.mesh(), positions)).collect()
        }
        _ => input.positions_on(subdivision.as_deref())?,
    };
    let value = |f: FaceId| owner[face(f)].map_or(f64::NAN, |chart| colour[chart as usize] as f64);
    let field = ColorField {
        corners: mesh.faces().map(|f| [value(f); 3]).collect(),
        scale: ColorScale::of_hues("cores of charts", "neighbours have different colours; grey lies in none"),
    };
    let border = mesh.edges().filter(|e| {
        let [f, g] = [e.halfedge(), e.halfedge().twin()].map(|h| mesh.face(h).map(|f| owner[face(f)]));
        f.is_some() && g.is_some() && f != g
    });
    let seams: Vec<_> = border.map(|e| (mesh.ends(e)[0].0, mesh.ends(e)[1].0, 0)).collect();
    let cones: Vec<_> = atlas.singular_vertices.iter().map(|v| (v.0, -1.0)).collect();
    let faces = mesh.triangles();
    let surface = ShownSurface {
        positions: &positions,
        faces: &faces,
        corner_uv: None,
        seams: &seams,
        cones: &cones,
        is_closed: mesh.is_closed(),
    };
    let style = args.picture.style(TextureChoice::None, args.common.threads);
    let drawn = Picture {
        surface: Some(surface),
        field: Some(&field),
        lines: LineMeaning::Charts,
        ..Picture::default()
    };
    picture::png(&drawn, &style)
}

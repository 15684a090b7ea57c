//! The picture of a seamless map: the surface with squares that go on across the seams, beside the map.

use super::args::SeamlessArgs;
use super::figures::{SeamlessOutcome, WrittenMap};
use crate::failure::Failure;
use crate::picture::{self, Picture, ShownSurface, TextureChoice};
use crate::show::LayoutDrawing;
use std::f64::consts::FRAC_PI_2;

pub fn draw(outcome: &SeamlessOutcome, map: &WrittenMap, args: &SeamlessArgs) -> Result<Vec<u8>, Failure> {
    let curvature = |valence: u32| (4.0 - f64::from(valence)) * FRAC_PI_2;
    let cones: Vec<_> =
        outcome.found.cones.iter().map(|cone| (cone.vertex.0, curvature(cone.valence))).collect();
    let drawing = LayoutDrawing::new(&map.laid, &cones);
    let faces = map.laid.mesh().triangles();
    let is_svg = args.picture.is_svg();
    let surface = map.laid.positions.as_deref().filter(|_| !is_svg).map(|positions| ShownSurface {
        positions,
        faces: &faces,
        corner_uv: Some(&drawing.corner_uv),
        seams: &drawing.edges,
        cones: &cones,
        is_closed: false,
    });
    let style = args.picture.style(TextureChoice::Checker, args.common.threads);
    let drawn = Picture { surface, flat: Some(drawing.flat()), ..Picture::default() };
    if is_svg { picture::svg(&drawn, &style) } else { picture::png(&drawn, &style) }
}

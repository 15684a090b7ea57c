//! The pictures of `ricci spline eval`.

use super::args::{EvalArgs, SurfaceColor};
use crate::failure::Failure;
use crate::picture::{
    Camera, ColorField, ColorScale, LineMeaning, Picture, ShownSurface, Style, TextureChoice, png,
};
use ricci::Control;
use ricci::mesh::io::Soup;
use ricci::spline::{Parameter, Spline, SurfacePoint, multi_indices};
use std::collections::HashSet;

/// Triangles per side of a patch, where `--tessellate` does not say it: a cubic patch looks smooth at the usual size.
const SIDES: usize = 12;
/// The colours of the sides of patches and of the control net, as numbers of seams.
const SIDE: usize = 0;
const NET: usize = 2;

/// The surface, with the sides of its patches, its control net and a quantity in colours where these are asked for.
pub fn draw(spline: &Spline, args: &EvalArgs, control: &Control) -> Result<Vec<u8>, Failure> {
    let sides = args.tessellate.map_or(SIDES, usize::from);
    let threads = args.common.threads;
    let soup = spline.tessellate(sides, threads, control)?;
    let mut lines = if args.picture.wire { outlines(&soup, sides) } else { Vec::new() };
    let mut positions = soup.positions.clone();
    if args.net {
        let first = positions.len() as u32;
        lines.extend(net(spline).into_iter().map(|[a, b]| (first + a, first + b, NET)));
        positions.extend(spline.control_points());
    }
    let surface = ShownSurface {
        positions: &positions,
        faces: &soup.faces,
        corner_uv: None,
        seams: &lines,
        cones: &[],
        is_closed: false,
    };
    let style = Style { wire: false, ..args.picture.style(TextureChoice::None, threads) };
    let evaluate = |order| spline.evaluate(&corners(spline, &soup, sides), order, threads, control);
    let field = match args.color {
        Some(SurfaceColor::Curvature) => Some(curvature(&evaluate(2)?)),
        Some(SurfaceColor::Reflection) => {
            let camera = Camera::choose(&positions, &soup.faces, &style.view);
            Some(reflection(&evaluate(1)?, &camera))
        }
        Some(SurfaceColor::None) | None => None,
    };
    let lines = LineMeaning::Untold;
    let drawn = Picture { surface: Some(surface), field: field.as_ref(), lines, ..Picture::default() };
    png(&drawn, &style)
}

/// The places of the corners of the triangles, of which there are `sides` × `sides` per patch.
fn corners(spline: &Spline, soup: &Soup, sides: usize) -> Vec<Parameter> {
    let patches = spline.space().patches().len();
    // The triangles after those of the patches lie in the chart of the hole at infinity.
    let cap = spline.holes().iter().find(|hole| hole.is_at_infinity()).map(|hole| hole.chart);
    let patch = |f: usize| cap.filter(|_| f / sides.pow(2) >= patches).unwrap_or((f / sides.pow(2)) as u32);
    let corners = soup.attributes.uv.iter().flatten().enumerate();
    corners.flat_map(|(f, uv)| uv.map(|[x, y]| Parameter { patch: patch(f), x, y })).collect()
}

/// The Gaussian curvature.
pub fn curvature(corners: &[SurfacePoint]) -> ColorField {
    let gauss = |at: &SurfacePoint| at.principal_curvatures().map_or(f64::NAN, |[a, b]| a * b);
    let values: Vec<f64> = corners.iter().map(gauss).collect();
    let scale = ColorScale::of_signed("Gaussian curvature", &values);
    ColorField { corners: values.as_chunks().0.to_vec(), scale }
}

/// Reflection lines of light lines at infinity, circles around the horizontal axis of the picture.
pub fn reflection(corners: &[SurfacePoint], camera: &Camera) -> ColorField {
    let angle = |at: &SurfacePoint| at.normal().map_or(f64::NAN, |normal| reflected(camera.apply(normal)));
    let values: Vec<f64> = corners.iter().map(angle).collect();
    let scale = ColorScale::of_stripes(
        "reflected view from the horizontal, degrees",
        [0.0, 180.0],
        "stripes of 10 degrees",
    );
    ColorField { corners: values.as_chunks().0.to_vec(), scale }
}

/// The angle in degrees between the horizontal axis and the view reflected at a surface with this unit normal, in the axes of the
/// camera (right, up, towards the viewer). Both unit normals of a surface have the same.
fn reflected(normal: [f64; 3]) -> f64 {
    let [right, _, towards] = normal;
    (2.0 * towards * right).clamp(-1.0, 1.0).acos().to_degrees()
}

/// The edges along the sides of patches, each once.
fn outlines(soup: &Soup, sides: usize) -> Vec<(u32, u32, usize)> {
    let mut known = HashSet::new();
    let mut lines = Vec::new();
    for patch in soup.faces.chunks_exact(sides * sides) {
        let mut inner: HashSet<[u32; 2]> = HashSet::new();
        let edges = || patch.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        inner.extend(edges());
        let outer = edges().filter(|&[a, b]| !inner.contains(&[b, a]));
        lines.extend(outer.filter(|&[a, b]| known.insert([a.min(b), a.max(b)])).map(|[a, b]| (a, b, SIDE)));
    }
    lines
}

/// Pairs of control points of a patch whose indices β differ by one step, each once.
fn net(spline: &Spline) -> Vec<[u32; 2]> {
    let indices: Vec<[usize; 3]> = multi_indices(spline.space().degree()).collect();
    let is_step = |a: [usize; 3], b: [usize; 3]| (0..3).map(|k| a[k].abs_diff(b[k])).sum::<usize>() == 2;
    let pairs = (0..indices.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
    let pairs: Vec<[usize; 2]> = pairs.filter(|&[i, j]| is_step(indices[i], indices[j])).collect();
    let mut known = HashSet::new();
    let patches = spline.space().patches().iter();
    let all = patches.flat_map(|patch| pairs.iter().map(|pair| pair.map(|i| patch.control[i])));
    all.filter(|&[a, b]| known.insert([a.min(b), a.max(b)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_is_reflected_by_either_normal() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        for (normal, angle) in [
            ([0.0, 0.0, 1.0], 90.0),
            ([half, 0.0, half], 0.0),
            ([-half, 0.0, half], 180.0),
            ([0.0, half, half], 90.0),
            ([0.5, half, 0.5], 60.0),
        ] {
            let opposite = normal.map(|x| -x);
            assert!((reflected(normal) - angle).abs() < 1e-5, "{normal:?}");
            assert_eq!(reflected(normal), reflected(opposite));
        }
    }
}

//! Pictures of `ricci surface`.

use super::args::{ScanArgs, ScanColor};
use super::figures::ScanOutcome;
use crate::failure::Failure;
use crate::picture::{
    Camera, ColorField, ColorScale, LineMeaning, Picture, ShownSurface, Style, TextureChoice, png,
};
use crate::quantity::{at_vertices, hues};
use crate::spline::{curvature, reflection};
use ricci::Control;
use ricci::geometry::vector::{add, diagonal, dot, scale, sub};
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, Point};
use ricci::spline::{QuadSpline, SurfacePoint, TessellationSize};
use std::collections::HashSet;

/// Parts of a side of a patch.
pub const PARTS: usize = 24;
/// Teeth of a comb, less one.
const TEETH: usize = 48;
/// The parameters of a patch at which combs stand along both directions.
const COMBED: [f64; 3] = [0.0, 0.5, 1.0];
/// The length of the teeth, over the diagonal, for a curvature of ten over the diagonal.
const TOOTH: f64 = 0.02;
const CURVATURE_OF_TOOTH: f64 = 10.0;
/// The colours of lines, as numbers of seams: sides of patches, creases, combs.
const SIDE: usize = 0;
const CREASE: usize = 1;
const COMB: usize = 2;

/// A line between two positions, in a colour.
type ColoredLine = (u32, u32, usize);

/// The surface with the sides of its patches, a quantity in colours, and combs where they are asked for; for distances the mesh.
pub fn draw(outcome: &ScanOutcome, args: &ScanArgs, control: &Control) -> Result<Vec<u8>, Failure> {
    let threads = args.common.threads;
    let spline = &outcome.fit.spline;
    let style = args.picture.style(TextureChoice::None, threads);
    if args.color == ScanColor::Distance {
        return draw_distances(outcome, threads, &style, control);
    }
    let soup = spline.tessellate(TessellationSize::Parts(PARTS), threads, control)?;
    let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces)?;
    let field = match args.color {
        ScanColor::Curvature => curvature(&corners(spline, &soup)?),
        ScanColor::Reflection => {
            let camera = Camera::choose(&soup.positions, &soup.faces, &style.view);
            reflection(&corners(spline, &soup)?, &camera)
        }
        ScanColor::Patches | ScanColor::Distance => patches(&soup, &mesh),
    };
    let mut lines = sides(spline, &soup);
    let mut positions = soup.positions.clone();
    if args.combs {
        add_combs(spline, &mut positions, &mut lines)?;
    }
    let surface = ShownSurface {
        positions: &positions,
        faces: &soup.faces,
        corner_uv: None,
        seams: &lines,
        cones: &[],
        is_closed: mesh.is_closed(),
    };
    let lines = LineMeaning::Untold;
    png(&Picture { surface: Some(surface), field: Some(&field), lines, ..Picture::default() }, &style)
}

/// The mesh with the distances of its vertices from the surface in colours.
fn draw_distances(
    outcome: &ScanOutcome,
    threads: usize,
    style: &Style,
    control: &Control,
) -> Result<Vec<u8>, Failure> {
    let field = distances(outcome, threads, control)?;
    let mesh = outcome.input.mesh();
    let faces = mesh.triangles();
    let surface = ShownSurface {
        positions: outcome.input.positions().ok_or_else(Failure::no_positions)?,
        faces: &faces,
        corner_uv: None,
        seams: &[],
        cones: &[],
        is_closed: mesh.is_closed(),
    };
    png(&Picture { surface: Some(surface), field: Some(&field), ..Picture::default() }, style)
}

/// The patch of each triangle.
fn patch_of(soup: &Soup) -> impl Fn(usize) -> usize + '_ {
    |f| soup.attributes.face_numbers[0].values[f] as usize
}

/// The points of the corners of the triangles with their derivatives.
fn corners(spline: &QuadSpline, soup: &Soup) -> Result<Vec<SurfacePoint>, Failure> {
    let patch = patch_of(soup);
    let uv = soup.attributes.uv.iter().flatten().enumerate();
    let points = uv.flat_map(|(f, corners)| corners.map(|uv| spline.evaluate(patch(f), uv)));
    Ok(points.collect::<ricci::Result<_>>()?)
}

/// Colours of the patches, other ones for neighbours.
fn patches(soup: &Soup, mesh: &Mesh) -> ColorField {
    let patch = patch_of(soup);
    let count = (0..soup.faces.len()).map(|f| patch(f) + 1).max().unwrap_or(0);
    let colour = hues(mesh, |f| Some(patch(f.index()) as u32), count);
    ColorField {
        corners: (0..soup.faces.len()).map(|f| [colour[patch(f)] as f64; 3]).collect(),
        scale: ColorScale::of_hues("patches", "neighbours have different colours"),
    }
}

/// The distances of the vertices of the mesh from the surface, positive outside of it.
fn distances(outcome: &ScanOutcome, threads: usize, control: &Control) -> Result<ColorField, Failure> {
    let points = outcome.input.positions().ok_or_else(Failure::no_positions)?;
    let spline = &outcome.fit.spline;
    let nearest = spline.nearest_places(threads, control)?.find(points, threads, control)?;
    let unit = diagonal(points);
    let mut heights = Vec::with_capacity(points.len());
    for (point, found) in points.iter().zip(&nearest) {
        let at = spline.evaluate(found.place.patch, found.place.parameters)?;
        let normal = at.normal().unwrap_or_default();
        heights.push(found.distance / unit * dot(sub(*point, found.point), normal).signum());
    }
    let scale = ColorScale::of_signed("distance of the mesh from the surface, over the diagonal", &heights);
    Ok(at_vertices(outcome.input.mesh(), &heights.into(), scale))
}

/// The edges along sides of patches, each once, those of creases in a colour of their own.
fn sides(spline: &QuadSpline, soup: &Soup) -> Vec<ColoredLine> {
    let layout = spline.space().layout();
    let patch = patch_of(soup);
    let (mut known, mut lines) = (HashSet::new(), Vec::new());
    for (f, (face, uv)) in soup.faces.iter().zip(soup.attributes.uv.iter().flatten()).enumerate() {
        for k in 0..3 {
            let [from, to] = [uv[k], uv[(k + 1) % 3]];
            let on = [
                from[1] + to[1] == 0.0,
                from[0] + to[0] == 2.0,
                from[1] + to[1] == 2.0,
                from[0] + to[0] == 0.0,
            ];
            let Some(side) = on.iter().position(|&is_on| is_on) else { continue };
            let (a, b) = (face[k], face[(k + 1) % 3]);
            if known.insert([a.min(b), a.max(b)]) {
                let arc = layout.patches()[patch(f)][side].arc as usize;
                lines.push((a, b, if layout.arcs()[arc].is_crease { CREASE } else { SIDE }));
            }
        }
    }
    lines
}

/// Adds combs along the sides and the middle of every patch: teeth along the normal, as long as the normal curvature along the line is large, with
/// a line through their ends. Where the ends of two patches do not meet, curvature jumps.
fn add_combs(
    spline: &QuadSpline,
    positions: &mut Vec<Point>,
    lines: &mut Vec<ColoredLine>,
) -> Result<(), Failure> {
    let unit = diagonal(positions);
    for patch in 0..spline.space().layout().patches().len() {
        for (along, fixed) in [0, 1].into_iter().flat_map(|along| COMBED.map(|fixed| (along, fixed))) {
            let first = positions.len() as u32;
            for k in 0..=TEETH {
                let running = k as f64 / TEETH as f64;
                let at =
                    spline.evaluate(patch, if along == 0 { [running, fixed] } else { [fixed, running] })?;
                let normal = at.normal().unwrap_or_default();
                let bend = dot(at.second[2 * along], normal) / dot(at.first[along], at.first[along]);
                let length = -bend * unit / CURVATURE_OF_TOOTH * TOOTH * unit;
                let end = if length.is_finite() { add(at.point, scale(length, normal)) } else { at.point };
                positions.extend([at.point, end]);
                let foot = first + 2 * k as u32;
                lines.push((foot, foot + 1, COMB));
                if k > 0 {
                    lines.push((foot - 1, foot + 1, COMB));
                }
            }
        }
    }
    Ok(())
}

//! The integral of a form as texture coordinates and in pictures, and the trajectories of the form.

use super::args::{FormPictureChoice, FormsArgs};
use super::outcome::ChosenForm;
use crate::failure::Failure;
use crate::input::Input;
use crate::output::Outputs;
use crate::picture::{self, LineMeaning, Picture, ShownLayout, ShownSurface, Style, TextureChoice};
use crate::show::surroundings;
use crate::uv;
use ricci::Control;
use ricci::harmonic::trajectories::OnHalfedge;
use ricci::harmonic::{FormLayout, TrajectoryOptions, trajectories};
use ricci::mesh::{Mesh, Point};
use std::path::Path;

/// Write the surface with its texture coordinates.
pub fn write_uv(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    layout: &FormLayout,
) -> Result<(), Failure> {
    let subdivision = layout.common_subdivision().map(|r| &**r);
    let positions = input.positions_on(subdivision)?;
    let drawn = uv::UvMesh {
        mesh: layout.mesh(),
        positions: positions.into(),
        index: &layout.corner_index,
        texcoords: &layout.points,
        weights: &[],
        subdivision,
    };
    drawn.write(outputs, path, input)
}

/// The picture that was asked for, as PNG, or as SVG of the integral alone.
pub fn draw(
    input: &Input,
    chosen: &ChosenForm,
    args: &FormsArgs,
    control: &Control,
) -> Result<Vec<u8>, Failure> {
    let layout = &chosen.layout;
    let mesh = layout.mesh();
    let show = args.show.unwrap_or(FormPictureChoice::Texture);
    let usual =
        if show == FormPictureChoice::Trajectories { TextureChoice::None } else { TextureChoice::Checker };
    let style = args.picture.style(args.texture.unwrap_or(usual), args.common.threads);
    let corner_uv: Vec<[[f64; 2]; 3]> = mesh.faces().map(|f| layout.face(f)).collect();
    let cut: Vec<_> = mesh.edges().filter(|&e| layout.is_cut[e]).collect();
    let line = |h| (layout.point(h), layout.point(mesh.next(h)), 0);
    let seams: Vec<_> = cut.iter().flat_map(|e| [e.halfedge(), e.halfedge().twin()]).map(line).collect();
    let outer = mesh.halfedges().filter(|&h| mesh.is_outside(h.twin()));
    let boundary: Vec<_> = outer.map(line).map(|(a, b, _)| (a, b)).collect();
    let flat =
        ShownLayout { corner_uv: &corner_uv, seams: &seams, boundary: &boundary, ..ShownLayout::default() };
    if args.picture.is_svg() {
        let drawn = Picture { flat: Some(flat), lines: LineMeaning::Cut, ..Picture::default() };
        return picture::svg(&drawn, &style);
    }
    let mut positions = input.positions_on(layout.common_subdivision().map(|r| &**r))?;
    let focus = args.zoom.and_then(|zoom| surroundings(mesh, &positions, &zoom, |f| layout.face(f)));
    let style = Style { focus, ..style };
    let faces = mesh.triangles();
    let strokes = match show {
        FormPictureChoice::Trajectories => lines_in_space(layout, &mut positions, args, control)?,
        _ => cut.iter().map(|&e| (mesh.ends(e)[0].0, mesh.ends(e)[1].0, 0)).collect(),
    };
    let surface = ShownSurface {
        positions: &positions,
        faces: &faces,
        corner_uv: Some(&corner_uv),
        seams: &strokes,
        cones: &[],
        is_closed: mesh.is_closed(),
    };
    let flat = (show == FormPictureChoice::Both).then_some(flat);
    let lines = match show {
        FormPictureChoice::Trajectories => LineMeaning::Trajectories,
        _ => LineMeaning::Cut,
    };
    picture::png(&Picture { surface: Some(surface), flat, lines, ..Picture::default() }, &style)
}

/// Trajectories in both directions as strokes between points that are added to `positions`.
fn lines_in_space(
    layout: &FormLayout,
    positions: &mut Vec<Point>,
    args: &FormsArgs,
    control: &Control,
) -> Result<Vec<(u32, u32, usize)>, Failure> {
    let mesh = layout.mesh();
    let area = |f| {
        let normal = picture::normal(mesh.face_vertices(f).map(|v| positions[v.index()]));
        0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    // The area of a piece of a subdivision may be rounded to 0.
    let areas: Vec<f64> = mesh.faces().map(|f| area(f).max(f64::MIN_POSITIVE)).collect();
    let mut strokes = Vec::new();
    for (color, vertical) in [false, true].into_iter().enumerate() {
        let fallback = TrajectoryOptions { vertical, ..TrajectoryOptions::default() };
        let options = TrajectoryOptions { spacing: args.spacing.unwrap_or(fallback.spacing), ..fallback };
        for line in trajectories(layout, &areas, &options, control)? {
            let first = positions.len() as u32;
            let points: Vec<Point> = line.iter().map(|&at| point(mesh, positions, at)).collect();
            strokes.extend((1..points.len() as u32).map(|k| (first + k - 1, first + k, color)));
            positions.extend(points);
        }
    }
    Ok(strokes)
}

fn point(mesh: &Mesh, positions: &[Point], (h, share): OnHalfedge) -> Point {
    let [a, b] = [mesh.origin(h), mesh.tip(h)].map(|v| positions[v.index()]);
    [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]))
}

//! The pictures of `ricci match`: one texture on both surfaces, both triangulations in the domain, and the source coloured by the errors
//! or the distortion of the map.

use super::args::{MatchArgs, MatchPictureChoice};
use super::outcome::MatchOutcome;
use crate::failure::Failure;
use crate::picture::{
    self, Circle, ColorField, ColorScale, Picture, ShownLayout, ShownSurface, Style, TextureChoice, Tiles,
};
use ricci::geometry::motion::precise_point;
use ricci::geometry::{Motion, Space, model};
use ricci::matching::{DomainTriangle, dilatations};
use ricci::mesh::{Point, VertexId};

/// The number of checks of the texture along the longest direction of the target.
const CHECKS: f64 = 24.0;
/// The curvature in whose colour landmarks are drawn.
const LANDMARK: f64 = 1.0;

pub fn draw(show: MatchPictureChoice, outcome: &MatchOutcome, args: &MatchArgs) -> Result<Vec<u8>, Failure> {
    match show {
        MatchPictureChoice::Carried => carried(outcome, args),
        MatchPictureChoice::Domains => domains(outcome, args),
        MatchPictureChoice::Heat => heat(outcome, args),
    }
}

/// Both surfaces with one texture: on the target along its two longest directions, on the source carried over by the map.
fn carried(outcome: &MatchOutcome, args: &MatchArgs) -> Result<Vec<u8>, Failure> {
    let (Some(from), Some(to)) = (outcome.source.positions(), outcome.target.positions()) else {
        return Err(Failure::no_positions());
    };
    let uv = projected(to);
    let carried = outcome.matching.forward.carry(outcome.target.mesh(), &uv)?;
    let faces = [outcome.source.mesh().triangles(), outcome.target.mesh().triangles()];
    let corners = |faces: &[[u32; 3]], uv: &[[f64; 2]]| -> Vec<[[f64; 2]; 3]> {
        faces.iter().map(|f| f.map(|v| uv[v as usize])).collect()
    };
    let corner_uv = [corners(&faces[0], &carried), corners(&faces[1], &uv)];
    let marks =
        [0, 1].map(|s| outcome.landmarks.iter().map(|pair| (pair[s].0, LANDMARK)).collect::<Vec<_>>());
    let surface = |k: usize, positions, is_closed| ShownSurface {
        positions,
        faces: &faces[k],
        corner_uv: Some(&corner_uv[k]),
        seams: &[],
        cones: &marks[k],
        is_closed,
    };
    let style = args.picture.style(TextureChoice::Checker, args.common.threads);
    let pattern = Tiles::even(1.0 / CHECKS, faces[0].len().max(faces[1].len()));
    let both = Picture {
        pattern: Some(&pattern),
        surface: Some(surface(0, from, outcome.source.mesh().is_closed())),
        beside: Some(surface(1, to, outcome.target.mesh().is_closed())),
        ..Picture::default()
    };
    picture::png(&both, &style)
}

/// The coordinates along which points spread farthest, the largest spread 1.
fn projected(points: &[Point]) -> Vec<[f64; 2]> {
    let spread = |k: usize| {
        let ends =
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p[k]), b.max(p[k])]);
        ends[1] - ends[0]
    };
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| spread(j).total_cmp(&spread(i)));
    let size = spread(axes[0]).max(f64::MIN_POSITIVE);
    points.iter().map(|p| [p[axes[0]] / size, p[axes[1]] / size]).collect()
}

/// Both triangulations in the domain: on the sphere, in the plane or in the Poincaré disk, where lines between vertices are drawn straight.
fn domains(outcome: &MatchOutcome, args: &MatchArgs) -> Result<Vec<u8>, Failure> {
    let style = Style { wire: true, ..args.picture.style(TextureChoice::None, args.common.threads) };
    let domain = &outcome.matching.domain;
    let triangles = [0, 1].map(|side| domain.triangles(side));
    let marks = [0, 1].map(|s| outcome.landmarks.iter().map(|pair| pair[s]).collect::<Vec<_>>());
    if domain.space() == Space::S2 {
        let points =
            triangles.each_ref().map(|all| all.iter().flat_map(|t| t.corners).collect::<Vec<Point>>());
        let faces = points
            .each_ref()
            .map(|p| (0..p.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect::<Vec<_>>());
        let sphere = |s: usize| ShownSurface {
            positions: &points[s],
            faces: &faces[s],
            corner_uv: None,
            seams: &[],
            cones: &[],
            is_closed: true,
        };
        let both = Picture { surface: Some(sphere(0)), beside: Some(sphere(1)), ..Picture::default() };
        return picture::png(&both, &style);
    }
    let uv = triangles.each_ref().map(|all| in_plane(domain.space(), all));
    let dots = [0, 1].map(|s| {
        let corners = triangles[s].iter().zip(&uv[s]).flat_map(|(t, uv)| t.vertices.into_iter().zip(*uv));
        let marked = corners.filter(|(v, _): &(VertexId, _)| marks[s].contains(v));
        marked.map(|(_, at)| (at, LANDMARK)).collect::<Vec<_>>()
    });
    let rim = [Circle { centre: [0.0; 2], radius: 1.0 }];
    let rims: &[Circle] = if domain.space() == Space::H2 { &rim } else { &[] };
    let flat = |s: usize| ShownLayout { corner_uv: &uv[s], cones: &dots[s], rims, ..ShownLayout::default() };
    // No pattern is drawn, but the two panels share one, which must have an entry for every face of either.
    let pattern = Tiles::even(1.0, uv[0].len().max(uv[1].len()));
    let both = Picture {
        pattern: Some(&pattern),
        flat: Some(flat(0)),
        flat_beside: Some(flat(1)),
        ..Picture::default()
    };
    picture::png(&both, &style)
}

/// Triangles in the plane; of the hyperbolic plane in the Poincaré disk with their mean at its centre.
fn in_plane(space: Space, triangles: &[DomainTriangle]) -> Vec<[[f64; 2]; 3]> {
    let home = match space {
        Space::H2 => {
            // Weighted by area: most triangles lie far out, and are small there.
            let middle = triangles.iter().map(|t| {
                let [a, b, c] = t.corners.map(model::poincare);
                let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
                let p = [0, 1, 2].map(|k| t.corners[0][k] + t.corners[1][k] + t.corners[2][k]);
                p.map(|x| x * area)
            });
            let sum = middle.fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k]));
            let size = (sum[2] * sum[2] - sum[0] * sum[0] - sum[1] * sum[1]).max(f64::MIN_POSITIVE).sqrt();
            Motion::to_origin(Space::H2, precise_point(Space::H2, sum.map(|x| x / size))).rounded()
        }
        space => Motion::identity(space),
    };
    let plane = |p: Point| match space {
        Space::H2 => model::poincare(home.apply(p)),
        _ => [p[0], p[1]],
    };
    triangles.iter().map(|t| t.corners.map(plane)).collect()
}

/// The source in colours: where numbers correspond, the distance of the image of every vertex from the vertex of the same number; else
/// the distortion of every face by the map.
fn heat(outcome: &MatchOutcome, args: &MatchArgs) -> Result<Vec<u8>, Failure> {
    let Some(positions) = outcome.source.positions() else { return Err(Failure::no_positions()) };
    let mesh = outcome.source.mesh();
    let field = match &outcome.partners {
        Some(off) => ColorField {
            corners: mesh.faces().map(|f| mesh.face_vertices(f).map(|v| off[v.index()])).collect(),
            scale: ColorScale::of_amounts("distance from the partner, over the diagonal", off),
        },
        None => {
            let all =
                dilatations([&outcome.source.surface, &outcome.target.surface], &outcome.matching.forward)?;
            ColorField {
                corners: all.iter().map(|k| [*k; 3]).collect(),
                scale: ColorScale::of_amounts("quasi-conformal dilatation K", &all),
            }
        }
    };
    let faces = mesh.triangles();
    let marks: Vec<_> = outcome.landmarks.iter().map(|pair| (pair[0].0, LANDMARK)).collect();
    let surface = ShownSurface {
        positions,
        faces: &faces,
        corner_uv: None,
        seams: &[],
        cones: &marks,
        is_closed: mesh.is_closed(),
    };
    let style = args.picture.style(TextureChoice::None, args.common.threads);
    picture::png(&Picture { surface: Some(surface), field: Some(&field), ..Picture::default() }, &style)
}

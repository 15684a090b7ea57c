//! The pictures of uniformized surfaces and of their covers.

use super::args::{CanonicalPictureChoice, CoverPictureChoice, UniformPictureChoice};
use super::model_place::ModelPlace;
use super::opened::{CutOpenSurface, pairs};
use super::outline::{OutlineSide, sides};
use super::pieces::middle;
use super::quotient::{ORIGIN, Uniformized};
use super::tiling::{Prototype, Stamp, Tiling, tint};
use crate::failure::Failure;
use crate::picture::{
    self, DrawingFrame, DrawingPattern, FINEST, LineMeaning, PALE, Picture, ShownSurface, Style, Tiles,
};
use ricci::embed::layout::distance_from_origin;
use ricci::embed::{DeckElement, DirichletDomain};
use ricci::geometry::model::Model;
use ricci::geometry::motion::precise_point;
use ricci::geometry::{DoubleDouble, Motion, Space};
use ricci::topology::word::Word;
use std::f64::consts::PI;

/// Most copies in the background of a polygon.
const BACKGROUND: usize = 250;
/// Distance below which two images of the base point are the same, relative to their third coordinate.
const SAME: f64 = 1e-6;
/// Width of the borders of copies, in widths of a seam.
const THIN: f64 = 0.45;
/// Width of the sides of a domain, in widths of a seam.
const BOLD: f64 = 1.8;
/// Width of the boundary of the surface in copies, in widths of a seam.
const EDGE: f64 = 1.2;
/// Height of the shown part of the half-plane, in heights of the domain.
const HEADROOM: f64 = 1.12;

/// The model of the space in which a picture is drawn, and its style.
pub struct ModelCanvas {
    pub at: ModelPlace,
    pub style: Style,
}

/// The picture as PNG, or the drawing beside the surface alone as SVG.
pub fn draw(
    u: &Uniformized,
    shown: CanonicalPictureChoice,
    canvas: &ModelCanvas,
    svg: bool,
) -> Result<Vec<u8>, Failure> {
    let (laid, sides) = (u.laid()?, sides(u)?);
    let along_edges = matches!(
        shown,
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Domain)
            | CanonicalPictureChoice::Cover(CoverPictureChoice::Copies)
    );
    let opened = match u.domain().ok().filter(|_| !along_edges) {
        Some(domain) => CutOpenSurface::along_geodesics(laid, domain, canvas.at),
        None => CutOpenSurface::along_edges(u, laid, &sides),
    };
    let (uv, tiles) = pattern(&opened.shape, u.deck.space);
    // Checks that are too small to be seen would give one grey.
    let scale = frame(canvas.at, &opened.shape.border).fit(canvas.style.size).scale;
    let bands = canvas.style.bands || tiles.size * scale < FINEST;
    let tiles = tiles.banded(bands);
    let pattern = DrawingPattern { uv: &uv, tiles: &tiles };
    let stamp = &Stamp::new(&opened.shape, u.deck.space, &pattern, &canvas.style);
    let tiling = match shown {
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Surface) => None,
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Both) => {
            Some(dirichlet(u, canvas, stamp).or_else(|_| domain(u, canvas, stamp, sides))?)
        }
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Domain) => {
            Some(domain(u, canvas, stamp, sides)?)
        }
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Polygon) => Some(polygon(u, canvas, stamp)?),
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Dirichlet) => {
            Some(dirichlet(u, canvas, stamp)?)
        }
        CanonicalPictureChoice::Cover(choice) => Some(cover(u, choice, canvas, stamp)?),
    };
    let drawing = tiling.as_ref().map(Tiling::drawing);
    let cones: Vec<(u32, f64)> = u.corners.iter().map(|(v, angle)| (v.0, PI - angle)).collect();
    if svg {
        return picture::svg(&Picture { drawing: drawing.as_ref(), ..Picture::default() }, &canvas.style);
    }
    let with_surface = matches!(
        shown,
        CanonicalPictureChoice::Uniform(UniformPictureChoice::Both | UniformPictureChoice::Surface)
    );
    let surface = opened.in_space.as_ref().filter(|_| with_surface).map(|surface| ShownSurface {
        positions: &surface.points,
        faces: &surface.triangles,
        corner_uv: Some(&uv),
        seams: &surface.cut,
        cones: &cones,
        is_closed: u.boundary.is_empty(),
    });
    let drawn = Picture {
        surface,
        drawing: drawing.as_ref(),
        pattern: Some(&tiles),
        lines: LineMeaning::Sides,
        ..Picture::default()
    };
    picture::png(&drawn, &canvas.style)
}

/// A piece of the universal cover with the lifted loop in it.
fn cover(
    u: &Uniformized,
    choice: CoverPictureChoice,
    canvas: &ModelCanvas,
    stamp: &Stamp,
) -> Result<Tiling, Failure> {
    let mut tiling = match choice {
        CoverPictureChoice::Copies => copies(u, canvas, stamp)?,
        CoverPictureChoice::Tiles => tiled(u, canvas, stamp)?,
    };
    lifted(u, &mut tiling);
    Ok(tiling)
}

/// The pattern: checks of one size in the plane or the Poincaré disk, with bands in the metric as far as octaves reach.
fn pattern(shape: &Prototype, space: Space) -> (Vec<[[f64; 2]; 3]>, Tiles) {
    let at = ModelPlace::new(space, Model::Poincare);
    let places: Vec<[f64; 2]> = shape.points.iter().map(|p| at.flat(*p)).collect();
    let uv: Vec<[[f64; 2]; 3]> = shape.triangles.iter().map(|t| t.map(|i| places[i as usize])).collect();
    let flat: Vec<f64> = uv.iter().map(|uv| 0.5 * picture::doubled_area(*uv).abs()).collect();
    let stretch = |uv: &[[f64; 2]; 3]| {
        let [x, y] = [0, 1].map(|k| (uv[0][k] + uv[1][k] + uv[2][k]) / 3.0);
        let lambda = if space == Space::H2 { 2.0 / (1.0 - x * x - y * y) } else { 1.0 };
        lambda * lambda
    };
    let metric: Vec<f64> = uv.iter().zip(&flat).map(|(uv, area)| area * stretch(uv)).collect();
    let tiles = Tiles::new(&metric, &flat, &shape.triangles, places.len());
    (uv, tiles)
}

fn frame(at: ModelPlace, around: &[[f64; 3]]) -> DrawingFrame {
    match at {
        ModelPlace::Hyperbolic(Model::HalfPlane) => {
            let high = around.iter().map(|p| at.flat(*p)[1]).fold(1.0, f64::max);
            DrawingFrame::HalfPlane(HEADROOM * high)
        }
        ModelPlace::Hyperbolic(_) => DrawingFrame::Disk,
        ModelPlace::Plane => {
            let bound =
                |k: usize, pick: fn(f64, f64) -> f64, start| around.iter().map(|p| p[k]).fold(start, pick);
            let [low, high] =
                [(f64::min as fn(f64, f64) -> f64, f64::INFINITY), (f64::max, f64::NEG_INFINITY)]
                    .map(|(pick, start)| [0, 1].map(|k| bound(k, pick, start)));
            let room = 0.06 * (high[0] - low[0]).max(high[1] - low[1]);
            DrawingFrame::Rectangle([low.map(|x| x - room), high.map(|x| x + room)])
        }
    }
}

/// The layout, with its sides in pairs.
fn domain(
    u: &Uniformized,
    canvas: &ModelCanvas,
    shape: &Stamp,
    sides: Vec<OutlineSide>,
) -> Result<Tiling, Failure> {
    let mut tiling = Tiling::new(canvas.at, frame(canvas.at, &shape.border), canvas.style.size);
    tiling.copy(shape, &Motion::identity(u.deck.space), 0, None);
    for side in sides {
        tiling.line(&side.points, Some(side.pair).filter(|_| !side.is_border), BOLD);
        if !side.is_border {
            tiling.name_line(side.word, ORIGIN);
        }
    }
    if u.corners.is_empty() {
        tiling.dots.push(canvas.at.flat(ORIGIN));
    } else {
        tiling.dots.extend(u.corner_places().map(|p| canvas.at.flat(p)));
    }
    Ok(tiling)
}

/// The canonical polygon over copies of the opened surface, moved to the middle of the picture.
fn polygon(u: &Uniformized, canvas: &ModelCanvas, shape: &Stamp) -> Result<Tiling, Failure> {
    let given = u.deck.canonical_polygon(ORIGIN)?;
    let middle = middle(u.deck.space, &given);
    let home = translation_to(u.deck.space, middle).inverse();
    let moved = |p: &[f64; 3]| home.apply(p.map(DoubleDouble::from)).map(f64::from);
    let corners: Vec<[f64; 3]> = given.iter().map(moved).collect();
    let around = if canvas.at == ModelPlace::Plane { corners.clone() } else { shape.border.clone() };
    let mut tiling = Tiling::new(canvas.at, frame(canvas.at, &around), canvas.style.size);
    let far = |k: &usize| distance_from_origin(u.deck.space, corners[*k]);
    let nearest = (0..corners.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
    let start: Word = u.deck.group.relator().letters()[..nearest].iter().copied().collect();
    for motion in background(u, &home, &start)? {
        tiling.copy(shape, &motion, PALE, Some(THIN));
    }
    let relator = u.deck.group.relator();
    for (k, letter) in relator.letters().iter().enumerate() {
        tiling.line(&[corners[k], corners[(k + 1) % corners.len()]], Some(letter.index()), BOLD);
        tiling.name_line(u.deck.group.text(&std::iter::once(*letter).collect()), ORIGIN);
    }
    tiling.dots.extend(corners.iter().map(|p| canvas.at.flat(*p)));
    Ok(tiling)
}

/// The translation that carries the origin to a point.
fn translation_to(space: Space, p: [f64; 3]) -> Motion<DoubleDouble> {
    let half = 0.5 * p[1].atan2(p[0]);
    let turn: Motion = Motion::rotation([half.cos(), half.sin()], space);
    let along = Motion::translation(distance_from_origin(space, p), space);
    turn.compose(&along).compose(&turn.inverse()).precise()
}

/// The motions of the copies of the layout that are nearest to the origin, once the group has been moved by `home`; as many as a picture
/// shows. `start`: a word that leads near the origin.
fn background(
    u: &Uniformized,
    home: &Motion<DoubleDouble>,
    start: &Word,
) -> ricci::Result<Vec<Motion<DoubleDouble>>> {
    let Ok(domain) = u.domain() else { return Ok(Vec::new()) };
    let place = |g: &Motion<DoubleDouble>| g.origin().map(f64::from);
    let mut waiting = vec![home.compose(&u.deck.motion(start)?)];
    let mut known: Vec<[f64; 3]> = waiting.iter().map(place).collect();
    let mut found = Vec::new();
    while found.len() < BACKGROUND {
        let nearest = (0..waiting.len())
            .min_by(|&a, &b| waiting[a].displacement().total_cmp(&waiting[b].displacement()));
        let Some(nearest) = nearest else { break };
        let g = waiting.swap_remove(nearest);
        for side in domain.neighbours() {
            let next = g.compose(&side.motion);
            let at = place(&next);
            // Images of the base point lie apart, but the rounding of their coordinates grows with these.
            let same = |p: &[f64; 3]| (0..2).all(|k| (p[k] - at[k]).abs() <= SAME * at[2]);
            if !known.iter().any(same) {
                known.push(at);
                waiting.push(next);
            }
        }
        found.push(g);
    }
    Ok(found)
}

/// The Dirichlet domain among its neighbours.
fn dirichlet(u: &Uniformized, canvas: &ModelCanvas, shape: &Stamp) -> Result<Tiling, Failure> {
    let domain = u.domain()?;
    let mut tiling = Tiling::new(canvas.at, frame(canvas.at, &shape.border), canvas.style.size);
    tiling.copy(shape, &Motion::identity(u.deck.space), 0, None);
    for g in domain.neighbours() {
        tiling.copy(shape, &g.motion, PALE, Some(THIN));
    }
    for g in domain.neighbours() {
        borders(&mut tiling, domain, &g.motion);
    }
    outline(u, &mut tiling, domain, true);
    tiling.dots.push(canvas.at.flat(domain.centre));
    Ok(tiling)
}

/// The sides of the Dirichlet domain, coloured in pairs.
fn outline(u: &Uniformized, tiling: &mut Tiling, domain: &DirichletDomain, named: bool) {
    let n = domain.sides.len();
    for (k, color) in pairs(domain).into_iter().enumerate() {
        let is_border = domain.partner[k].is_none();
        let color = Some(color).filter(|_| !is_border);
        tiling.line(&[domain.corners[k], domain.corners[(k + 1) % n]], color, BOLD);
        if named && !is_border {
            tiling.name_line(u.deck.group.text(&domain.sides[k].word), domain.centre);
        }
    }
}

/// The sides of a copy of the Dirichlet domain that lie on the boundary.
fn borders(tiling: &mut Tiling, domain: &DirichletDomain, motion: &Motion<DoubleDouble>) {
    let n = domain.sides.len();
    let moved = |k: usize| motion.apply(precise_point(motion.space, domain.corners[k])).map(f64::from);
    for k in (0..n).filter(|&k| domain.partner[k].is_none()) {
        tiling.line_if_seen([moved(k), moved((k + 1) % n)], EDGE);
    }
}

/// The copies of the layout.
fn copies(u: &Uniformized, canvas: &ModelCanvas, shape: &Stamp) -> Result<Tiling, Failure> {
    let elements = u.copies()?;
    let mut tiling = Tiling::new(canvas.at, first_frame(u, elements, canvas.at, shape), canvas.style.size);
    for g in elements {
        tiling.copy(shape, &g.motion, tint(&u.deck, g), Some(THIN));
    }
    tiling.dots.push(canvas.at.flat(shape.centre));
    Ok(tiling)
}

/// The loops lifted to the cover, each in a colour of its own, with dots at its ends.
fn lifted(u: &Uniformized, tiling: &mut Tiling) {
    for (k, named) in u.lifts.iter().enumerate() {
        let points = &named.lift.points;
        tiling.line(points, Some(k), BOLD);
        let ends = [points.first(), points.last()].into_iter().flatten();
        let dots: Vec<[f64; 2]> = ends.map(|p| tiling.at.flat(*p)).collect();
        tiling.dots.extend(dots);
    }
}

/// The copies of the Dirichlet domain.
fn tiled(u: &Uniformized, canvas: &ModelCanvas, shape: &Stamp) -> Result<Tiling, Failure> {
    let domain = u.domain()?;
    let mut tiling = copies(u, canvas, shape)?;
    u.copies()?.iter().for_each(|g| borders(&mut tiling, domain, &g.motion));
    outline(u, &mut tiling, domain, false);
    Ok(tiling)
}

/// The frame of a picture of copies: in the plane around all of them and the lifts, elsewhere around the first.
fn first_frame(u: &Uniformized, elements: &[DeckElement], at: ModelPlace, shape: &Stamp) -> DrawingFrame {
    if at != ModelPlace::Plane {
        return frame(at, &shape.border);
    }
    let moved =
        |g: &DeckElement| shape.border.iter().map(|p| g.motion.rounded().apply(*p)).collect::<Vec<_>>();
    let lifts = u.lifts.iter().flat_map(|named| named.lift.points.iter().copied());
    let all: Vec<[f64; 3]> = elements.iter().flat_map(moved).chain(lifts).collect();
    frame(at, &all)
}

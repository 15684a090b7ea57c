//! A sheet, opened by seams and laid flat: one chart, or several where it overlaps itself.

use super::cross_cut::overlap_cut;
use super::flat_chart::{ChartFaces, FlatChart};
use super::options::TextureOptions;
use super::quality::largest_stretch;
use super::seam_points::SeamSearch;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flatten::rim::BorderRim;
use crate::flatten::{FlattenOptions, cut_open, flatten};
use crate::geometry::Space;
use crate::geometry::predicates::orientation;
use crate::geometry::vector::distance;
use crate::mesh::{EdgeId, PerEdge, Point, VertexId};
use crate::metric::Surface;
use std::cmp::Ordering;

/// The steps of a descent: most of the stretch is gone after a few.
const STEPS: usize = 30;
/// The decrement at which a descent ends: the rest of the energy is not seen in a texture.
const TOLERANCE: f64 = 1e-2;
/// The bound of |u| for a bound of the stretch, in its logarithm: least stretch divides what a conformal map puts into sizes.
const OF_LOGARITHM: f64 = 1.2;
/// The share of a sheet's area on which |u| may exceed the bound in the first attempt.
const MAY_EXCEED: f64 = 0.01;
/// The bound of |u| in the next attempt, if the stretch is above its bound; the share falls by its square.
const SMALLER: f64 = 0.6;
/// The most attempts.
const ATTEMPTS: usize = 6;
/// Least excess of two sides of a triangle over the third, in mean lengths of edges: thinner triangles get longer sides.
const LEAST_EXCESS: f64 = 1e-8;

/// Least height of a triangle alone, in its first side.
const THINNEST: f64 = 1e-4;

/// The flat charts of connected faces.
///
/// # Errors
/// [`Error::Cancelled`] alone: faces that cannot be laid flat together are taken apart.
pub(super) fn laid_flat(
    part: ChartFaces,
    options: &TextureOptions,
    control: &Control,
) -> Result<Vec<FlatChart>> {
    let (mut waiting, mut done) = (vec![part], Vec::new());
    while let Some(part) = waiting.pop() {
        control.check()?;
        if part.faces.len() == 1 {
            done.push(single(part));
            continue;
        }
        match opened(&part, options, control) {
            Ok(chart) => done.extend(without_overlap(chart, control)?),
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(_) => waiting.extend(halves(&part)),
        }
    }
    Ok(done)
}

/// The chart of a single face.
fn single(part: ChartFaces) -> FlatChart {
    alone(part, [0.0, THINNEST])
}

/// The chart of a single face, whose longest side and whose height over it have at least these lengths, the height in longest sides.
pub(super) fn alone(part: ChartFaces, [least, thinnest]: [f64; 2]) -> FlatChart {
    let [a, b, c] = part.triangle(0);
    let lengths = match widened([distance(a, b), distance(b, c), distance(c, a)]) {
        // Corners whose distances are too small for numbers.
        [0.0, ..] => [least; 3],
        lengths => lengths,
    };
    // The longest side comes first: over a shorter one the height says nothing of how thin the face is.
    let first = (0..3).fold(0, |most, k| if lengths[k] > lengths[most] { k } else { most });
    let [ab, bc, ca] = [0, 1, 2].map(|k| lengths[(first + k) % 3]);
    if ab == 0.0 {
        return FlatChart { part, points: vec![[0.0; 2]; 3] };
    }
    let x = (ab * ab + ca * ca - bc * bc) / (2.0 * ab);
    let y = (ca * ca - x * x).max(0.0).sqrt().max(thinnest * ab);
    let factor = f64::max(1.0, least / ab);
    let mut points = vec![[0.0; 2]; 3];
    for (k, p) in [[0.0, 0.0], [ab, 0.0], [x, y]].into_iter().enumerate() {
        points[part.corners[0][(first + k) % 3] as usize] = p.map(|x| factor * x);
    }
    FlatChart { part, points }
}

/// Lengths of the sides of a triangle that is not thinner than [`LEAST_EXCESS`].
fn widened(lengths: [f64; 3]) -> [f64; 3] {
    let longest = lengths.iter().fold(0.0, |a: f64, b| a.max(*b));
    let excess = lengths.iter().sum::<f64>() - 2.0 * longest;
    let missing = (LEAST_EXCESS * longest - excess).max(0.0);
    lengths.map(|l| l + missing)
}

/// The surface of some faces; its triangles have an area: where some are too thin, all edges are longer by the same length.
fn surface_of(part: &ChartFaces) -> Result<Surface> {
    let mesh = part.mesh()?;
    let length = |v: VertexId, w: VertexId| distance(part.positions[v.index()], part.positions[w.index()]);
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| {
        let [v, w] = mesh.ends(e);
        length(v, w)
    });
    let mean = lengths.iter().sum::<f64>() / mesh.n_edges() as f64;
    let missing = mesh.faces().fold(0.0, |most: f64, f| {
        let sides = mesh.opposite_edges(f).map(|e| lengths[e]);
        let longest = sides.iter().fold(0.0, |a: f64, b| a.max(*b));
        most.max(LEAST_EXCESS * mean - (sides.iter().sum::<f64>() - 2.0 * longest))
    });
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| lengths[e] + missing);
    Surface::intrinsic(mesh, lengths, Space::E2)
}

/// The faces as one flat chart whose stretch is within the bound.
///
/// # Errors
/// Those of [`SeamSearch::seams`] and [`flatten`]; [`Error::Layout`] where the bound is not reached.
fn opened(part: &ChartFaces, options: &TextureOptions, control: &Control) -> Result<FlatChart> {
    let surface = surface_of(part)?;
    let search = SeamSearch::new(&surface, &part.positions, &control.still())?;
    let mut points = Vec::new();
    let mut before = None;
    let mut may_exceed = MAY_EXCEED;
    let mut bound = OF_LOGARITHM * options.stretch.ln();
    let to_flat = FlattenOptions { tolerance: TOLERANCE, max_iterations: STEPS, ..FlattenOptions::default() };
    for _ in 0..ATTEMPTS {
        let cut = search.seams([bound, may_exceed], &mut points, &control.still())?;
        (bound, may_exceed) = (SMALLER * bound, SMALLER * SMALLER * may_exceed);
        if before.replace(points.len()) == Some(points.len()) {
            continue;
        }
        let (open, origins) = cut_open(&surface, &cut.is_cut)?;
        let flat = flatten(&open, &to_flat, &control.still())?;
        let chart = FlatChart {
            part: ChartFaces {
                faces: part.faces.clone(),
                corners: open.mesh().triangles(),
                positions: origins.iter().map(|v| part.positions[v.index()]).collect(),
            },
            points: flat.points,
        };
        if largest_stretch(&chart) <= options.stretch {
            return Ok(chart);
        }
    }
    Err(Error::Layout("the stretch is above its bound".into()))
}

/// The chart, divided until no part overlaps itself; its parts have the size of their faces.
fn without_overlap(chart: FlatChart, control: &Control) -> Result<Vec<FlatChart>> {
    let (mut waiting, mut done) = (vec![chart], Vec::new());
    while let Some(chart) = waiting.pop() {
        control.check()?;
        if chart.part.faces.len() == 1 {
            done.push(if is_upright(&chart) { chart } else { single(chart.part) });
            continue;
        }
        let mesh = match chart.part.mesh() {
            Ok(mesh) => mesh,
            // Parts that a cut leaves on one vertex are taken apart there.
            Err(_) => {
                waiting.extend(face_by_face(&chart));
                continue;
            }
        };
        let rim = BorderRim::new(&mesh);
        let crossings = rim.crossings(&chart.points);
        if crossings.is_empty() && is_upright(&chart) {
            done.push(at_size(chart));
            continue;
        }
        match overlap_cut(&chart, &mesh, &rim, &crossings) {
            Some(is_cut) => waiting.extend(chart.apart(&mesh, |e| is_cut[e])),
            None => waiting.extend(halves_of_flat(&chart)),
        }
    }
    Ok(done)
}

fn is_upright(chart: &FlatChart) -> bool {
    chart.part.corners.iter().all(|c| {
        let [p, q, r] = c.map(|v| chart.points[v as usize]);
        orientation(p, q, r) == Ordering::Greater
    })
}

fn face_by_face(chart: &FlatChart) -> Vec<FlatChart> {
    let number: Vec<u32> = (0..chart.part.faces.len() as u32).collect();
    chart.part.parts(&number).into_iter().map(|(part, _)| single(part)).collect()
}

/// The chart scaled to the area that its faces have in space.
fn at_size(mut chart: FlatChart) -> FlatChart {
    let (flat, given) = (chart.area(), chart.part.area());
    let factor = (given / flat).sqrt();
    if factor.is_finite() && factor > 0.0 {
        chart.points.iter_mut().for_each(|p| *p = p.map(|x| factor * x));
    }
    chart
}

/// The faces as the connected parts of two halves, on both sides of the middle along the longest side of the box around them.
fn halves(part: &ChartFaces) -> Vec<ChartFaces> {
    let centre = |f: usize| {
        let [a, b, c] = part.triangle(f);
        [0, 1, 2].map(|k| a[k] + b[k] + c[k])
    };
    divided(part, &(0..part.faces.len()).map(centre).collect::<Vec<_>>())
        .into_iter()
        .map(|(part, _)| part)
        .collect()
}

/// The chart as the connected parts of two halves.
fn halves_of_flat(chart: &FlatChart) -> Vec<FlatChart> {
    let centre = |c: &[u32; 3]| {
        let [p, q, r] = c.map(|v| chart.points[v as usize]);
        [p[0] + q[0] + r[0], p[1] + q[1] + r[1], 0.0]
    };
    let centres: Vec<Point> = chart.part.corners.iter().map(centre).collect();
    let placed = |(part, origins): (ChartFaces, Vec<u32>)| FlatChart {
        points: origins.iter().map(|&v| chart.points[v as usize]).collect(),
        part,
    };
    divided(&chart.part, &centres).into_iter().map(placed).collect()
}

/// The connected parts of the faces whose centres are before the middle one along an axis, and of the others.
fn divided(part: &ChartFaces, centres: &[Point]) -> Vec<(ChartFaces, Vec<u32>)> {
    let span = |k: usize| {
        let of = |pick: fn(f64, f64) -> f64| centres.iter().map(|c| c[k]).reduce(pick).unwrap_or(0.0);
        of(f64::max) - of(f64::min)
    };
    let axis = (0..3).fold(0, |best, k| if span(k) > span(best) { k } else { best });
    let mut order: Vec<usize> = (0..centres.len()).collect();
    order.sort_by(|&f, &g| centres[f][axis].total_cmp(&centres[g][axis]).then(f.cmp(&g)));
    let mut is_late = vec![false; centres.len()];
    order[order.len() / 2..].iter().for_each(|&f| is_late[f] = true);
    match part.mesh() {
        Ok(mesh) => {
            let side = |h| mesh.face(h).map(|f| is_late[f.index()]);
            let is_open = |e: EdgeId| side(e.halfedge()) != side(e.halfedge().twin());
            part.parts(&ChartFaces::pieces(&mesh, is_open))
        }
        Err(_) => part.parts(&(0..centres.len() as u32).collect::<Vec<_>>()),
    }
}

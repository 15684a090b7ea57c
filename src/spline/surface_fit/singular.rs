//! Where the curvature of a flat metric is: singular vertices inside a surface, and corners of its boundary.

use crate::canonical::{Boundary, Corners, evenly};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::{self, AutoCones, ConeLimits, cones_at, cones_within};
use crate::geometry::complex::{cross, dot};
use crate::harmonic::ComplexForm;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::metric::{Surface, curvature};
use crate::structure::{AffineSource, singular_vertex};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, TAU};

/// Least total angle of a singular vertex that is chosen, radians.
const LEAST_ANGLE: f64 = FRAC_PI_3;
/// Number of vertices of the surface for each singular vertex at most: the triangles around one, and the filling of its hole, need some.
const VERTICES_EACH: usize = 500;
/// Most singular vertices that are chosen.
const MOST: usize = 32;
/// Curvature, in radians, of a boundary loop below which it gets no corner if another one has some.
const NO_CORNER: f64 = 0.25 * std::f64::consts::PI;
/// Largest error of a sum of curvatures that counts as rounding, radians.
const ROUNDING: f64 = 1e-9;

/// Default of [`FlatMetricOptions::range`].
const RANGE: f64 = 30.0;
/// Number of vertices around each singular one that [`super::FlatMetric::factor_range`] leaves out.
pub(super) const NEAR_CONE: usize = 60;

/// Options of [`super::FlatMetric::new`].
#[derive(Debug, Clone, PartialEq)]
pub struct FlatMetricOptions {
    /// The flow, with all curvature at singular vertices and on the boundary, or a holomorphic 1-form with its 2g − 2 zeros. Default: the
    /// flow.
    pub source: AffineSource,
    /// The vertices with the curvature inside the surface. Default: as few as bring the factor between lengths within `range`.
    pub singular: SingularVertices,
    /// Largest ratio of two factors between flat lengths and lengths on the surface, outside the neighbourhoods of singular vertices, for
    /// which no more of them are taken. Default 30.
    pub range: f64,
    /// The corners of the boundary, which then has all curvature of the surface. Default: on a disk four right angles, on other surfaces
    /// as many as the boundary has quarters of a turn.
    pub corners: Corners,
    /// Tolerance, threads and further options of the flow.
    pub flow: flow::Options,
}

impl Default for FlatMetricOptions {
    fn default() -> Self {
        FlatMetricOptions {
            source: AffineSource::default(),
            singular: SingularVertices::default(),
            range: RANGE,
            corners: Corners::default(),
            flow: flow::Options::default(),
        }
    }
}

/// The singular vertices of a flat metric inside the surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum SingularVertices {
    /// As few as bring the factor between flat lengths and lengths on the surface within [`FlatMetricOptions::range`]; none where none is
    /// needed. A sphere with too few vertices for three holes becomes a plane with one vertex at infinity. Default.
    #[default]
    Auto,
    /// This number, at the places, and with the curvatures, that distort areas least. One has all curvature; on a sphere it lies at infinity
    /// of a plane. With none, the boundary has all curvature.
    Count(usize),
    /// These vertices, with the curvatures that distort areas least; one as for [`SingularVertices::Count`].
    At(Vec<VertexId>),
}

/// Where the curvature of a flat metric is.
pub(super) enum Curvatures {
    /// At this vertex of a sphere, or one that is to be chosen, which lies at infinity of a plane.
    Infinity(Option<VertexId>),
    /// The curvature of each vertex, radians.
    At(PerVertex<f64>),
}

/// The curvatures that the options ask for: several to choose from, those with more singular vertices later.
pub(super) fn curvatures(
    surface: &Surface,
    options: &FlatMetricOptions,
    control: &Control,
) -> Result<Vec<Curvatures>> {
    if options.range.is_nan() || options.range <= 1.0 {
        return Err(Error::argument("range of factors", options.range, "above 1"));
    }
    let mesh = surface.mesh();
    let is_sphere = mesh.is_closed() && mesh.euler() > 0;
    if options.corners != Corners::Default {
        return Ok(vec![Curvatures::At(by_given_corners(surface, options)?)]);
    }
    let placed = match &options.singular {
        SingularVertices::Auto => return auto(surface, options, control),
        SingularVertices::Count(1) if is_sphere => return Ok(vec![Curvatures::Infinity(None)]),
        SingularVertices::At(given) if is_sphere && given.len() == 1 => {
            check_vertex(mesh, given[0])?;
            return Ok(vec![Curvatures::Infinity(Some(given[0]))]);
        }
        SingularVertices::Count(1) if mesh.euler() < 0 => {
            return Ok(vec![Curvatures::At(at_one(surface, None, options, control)?)]);
        }
        SingularVertices::At(given) if given.len() == 1 && mesh.euler() < 0 => {
            check_vertex(mesh, given[0])?;
            return Ok(vec![Curvatures::At(at_one(surface, Some(given[0]), options, control)?)]);
        }
        SingularVertices::At(given) if given.len() == 1 && (mesh.is_closed() || mesh.euler() > 0) => {
            let need = "left out: this surface has none, or two and more";
            return Err(Error::argument("singular vertex", given[0], need));
        }
        SingularVertices::Count(n) => place(surface, [*n, *n], options, control)?.0,
        SingularVertices::At(given) => cones_at(mesh, surface.lengths(), given, LEAST_ANGLE, control)?,
    };
    Ok(vec![Curvatures::At(with_corners(surface, &placed)?)])
}

fn check_vertex(mesh: &Mesh, v: VertexId) -> Result<()> {
    let why = match () {
        _ if v.index() >= mesh.n_vertices() => "a vertex of the surface, numbered from 0",
        _ if mesh.is_boundary_vertex(v) => "inside the surface",
        _ => return Ok(()),
    };
    Err(Error::argument("singular vertex", v, why))
}

/// All curvature at the corners that are given.
fn by_given_corners(surface: &Surface, options: &FlatMetricOptions) -> Result<PerVertex<f64>> {
    let mesh = surface.mesh();
    if mesh.is_closed() {
        let need = "left out: this surface has no boundary";
        return Err(Error::argument("corners", format!("{:?}", options.corners), need));
    }
    if !matches!(options.singular, SingularVertices::Auto | SingularVertices::Count(0)) {
        let need = "left out beside corners: they have all curvature";
        return Err(Error::argument("singular vertices", format!("{:?}", options.singular), need));
    }
    at_corners(surface, &options.corners)
}

fn at_corners(surface: &Surface, corners: &Corners) -> Result<PerVertex<f64>> {
    let mut target = PerVertex::filled(surface.mesh().n_vertices(), 0.0);
    let corners = Boundary::Straight(corners.clone()).corners(surface)?;
    corners.into_iter().for_each(|(v, angle)| target[v] = std::f64::consts::PI - angle);
    Ok(target)
}

/// All curvature 2πχ at one vertex, and a boundary without corners.
fn at_one(
    surface: &Surface,
    given: Option<VertexId>,
    options: &FlatMetricOptions,
    control: &Control,
) -> Result<PerVertex<f64>> {
    let mesh = surface.mesh();
    let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
    let v = singular_vertex(surface, given, options.flow.threads, control)?;
    target[v] = TAU * mesh.euler() as f64;
    Ok(target)
}

/// Cones within the range, of which there are at least and at most so many.
fn place(
    surface: &Surface,
    number: [usize; 2],
    options: &FlatMetricOptions,
    control: &Control,
) -> Result<(AutoCones, f64)> {
    let limits = ConeLimits { range: options.range, inside: NEAR_CONE, number, least_angle: LEAST_ANGLE };
    cones_within(surface.mesh(), surface.lengths(), &limits, control)
}

/// As few singular vertices as bring the factor within the range: none, or one where the surface needs one, if that is enough.
fn auto(surface: &Surface, options: &FlatMetricOptions, control: &Control) -> Result<Vec<Curvatures>> {
    let mesh = surface.mesh();
    let most = (mesh.n_vertices() / VERTICES_EACH).min(MOST);
    let least = match (mesh.is_closed(), mesh.euler()) {
        (true, 2) if most < 3 => return Ok(vec![Curvatures::Infinity(None)]),
        (true, 2) => 3,
        (true, euler) if euler < 0 => 1,
        _ => 0,
    };
    let (placed, _) = place(surface, [least, most.max(least)], options, control)?;
    let is_usual = placed.cones.len() == usize::from(mesh.is_closed() && mesh.euler() < 0);
    let cones = Curvatures::At(with_corners(surface, &placed)?);
    let mut all = vec![match (mesh.is_closed(), mesh.euler()) {
        (true, 2) => Curvatures::Infinity(None),
        (true, 0) => Curvatures::At(PerVertex::filled(mesh.n_vertices(), 0.0)),
        (true, _) => Curvatures::At(at_one(surface, None, options, control)?),
        (false, euler) if euler >= 0 => Curvatures::At(at_corners(surface, &Corners::Default)?),
        _ => {
            let (without, _) = place(surface, [0, 0], options, control)?;
            Curvatures::At(with_corners(surface, &without)?)
        }
    }];
    if !mesh.is_closed() && mesh.euler() < 0 {
        all.push(Curvatures::At(at_one(surface, None, options, control)?));
        if placed.cones.len() < 2 {
            let (two, _) = place(surface, [2, 2], options, control)?;
            all.push(Curvatures::At(with_corners(surface, &two)?));
        }
    }
    if !is_usual {
        all.push(cones);
    }
    Ok(all)
}

/// The curvatures of cones, and the rest at few corners of each boundary loop.
fn with_corners(surface: &Surface, placed: &AutoCones) -> Result<PerVertex<f64>> {
    let mesh = surface.mesh();
    let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
    placed.cones.iter().for_each(|&(v, curvature)| target[v] = curvature);
    // Outside half-edges run backwards: the surface is on their right.
    let loops: Vec<Vec<VertexId>> = mesh
        .boundary_loops()
        .into_iter()
        .map(|walk| walk.into_iter().rev().map(|h| mesh.tip(h)).collect())
        .collect();
    if loops.is_empty() {
        return Ok(target);
    }
    let total = |walk: &Vec<VertexId>| walk.iter().map(|&v| placed.target[v]).sum::<f64>();
    let totals: Vec<f64> = loops.iter().map(total).collect();
    let turns = curvature(mesh, surface.geometry(), surface.lengths())?.at;
    for (walk, total) in loops.iter().zip(rounded(&totals)) {
        let corners = ((total.abs() / FRAC_PI_2).round() as usize).max(usize::from(total.abs() > ROUNDING));
        let corners = corners.min(walk.len());
        let sharpest = (0..walk.len())
            .max_by(|&i, &j| (total * turns[walk[i]]).total_cmp(&(total * turns[walk[j]])).then(j.cmp(&i)));
        let mut walk = walk.clone();
        walk.rotate_left(sharpest.unwrap_or(0));
        let steps =
            (0..walk.len()).map(|k| step(surface, walk[k], walk[(k + 1) % walk.len()])).collect::<Vec<_>>();
        for k in evenly(&steps, corners) {
            target[walk[k]] += total / corners as f64;
        }
    }
    Ok(target)
}

/// The length of the boundary edge between two vertices.
fn step(surface: &Surface, from: VertexId, to: VertexId) -> f64 {
    let mesh = surface.mesh();
    let along = mesh.outgoing(from).filter(|h| mesh.tip(*h) == to && mesh.is_boundary_edge(h.edge()));
    along.map(|h| surface.lengths()[h.edge()]).fold(f64::INFINITY, f64::min)
}

/// The curvatures of boundary loops, of which small ones are 0, and that of the largest has them.
fn rounded(totals: &[f64]) -> Vec<f64> {
    let largest =
        (0..totals.len()).max_by(|&i, &j| totals[i].abs().total_cmp(&totals[j].abs()).then(j.cmp(&i)));
    let mut rounded = totals.to_vec();
    let Some(largest) = largest else { return rounded };
    for k in (0..totals.len()).filter(|&k| k != largest) {
        if totals[k].abs() < NO_CORNER {
            rounded[largest] += rounded[k];
            rounded[k] = 0.0;
        }
    }
    rounded
}

/// The curvatures −2πk of zeros of a holomorphic 1-form that turns triangles over; none if it turns none over. A zero in a triangle that is
/// turned over moves to that of its vertices with the largest curvature.
pub(super) fn zeros(mesh: &Mesh, form: &ComplexForm) -> Option<PerVertex<f64>> {
    let mut turns = PerVertex::filled(mesh.n_vertices(), TAU);
    let mut turned = Vec::new();
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f).map(|h| form.along(h));
        for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
            let (next, last) = (sides[k], sides[(k + 2) % 3].map(|x| -x));
            turns[v] -= cross(next, last).atan2(dot(next, last));
        }
        if cross(sides[0], sides[1]) <= 0.0 {
            turned.push(f);
        }
    }
    if turned.is_empty() {
        return None;
    }
    let mut orders = PerVertex::from_fn(turns.len(), |v| (turns[v] / TAU).round() as i32);
    for f in turned {
        let corners = mesh.face_vertices(f);
        let highest = corners.into_iter().max_by(|&u, &v| orders[u].cmp(&orders[v]).then(v.cmp(&u)))?;
        orders[highest] -= 1;
    }
    // A vertex around which the form turns the wrong way takes a zero of the nearest one that has some.
    for v in mesh.vertices() {
        while orders[v] > 0 {
            let zero = nearest(mesh, v, |u| orders[u] < 0)?;
            orders[v] -= 1;
            orders[zero] += 1;
        }
    }
    let total: i64 = orders.iter().map(|&order| i64::from(order)).sum();
    (total == mesh.euler()).then(|| PerVertex::from_fn(orders.len(), |v| TAU * f64::from(orders[v])))
}

/// A vertex with a property that is fewest edges away.
fn nearest(mesh: &Mesh, from: VertexId, has: impl Fn(VertexId) -> bool) -> Option<VertexId> {
    let mut seen = PerVertex::filled(mesh.n_vertices(), false);
    let mut queue = std::collections::VecDeque::from([from]);
    seen[from] = true;
    while let Some(v) = queue.pop_front() {
        if has(v) {
            return Some(v);
        }
        for h in mesh.outgoing(v) {
            let w = mesh.tip(h);
            if !std::mem::replace(&mut seen[w], true) {
                queue.push_back(w);
            }
        }
    }
    None
}

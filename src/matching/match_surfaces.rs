//! One call for two surfaces.

use super::balance::BalanceReport;
use super::handles::with_handles;
use super::marks::{loop_orders, marks};
use super::options::{LoopShape, MatchOptions};
use super::orbifold::{Pair, in_orbifold, shape};
use super::overlay::CommonDomain;
use super::place::SurfaceMap;
use super::pushed::pushed;
use super::round::{InRound, RoundHole, in_round};
use super::route::Marks;
use super::same::{cones_of_same, in_frames_of_faces};
use super::soft::{self, Approach, SoftLandmark};
use super::sphere::on_sphere;
use super::walk::locate;
use super::{curves, disk};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Place, VertexId};
use crate::metric::{Split, Surface};
use crate::parallel::Pool;
use std::collections::HashSet;

/// A map between two surfaces, with what certifies it.
#[derive(Debug, Clone, PartialEq)]
pub struct Matching {
    /// From the vertices of the source to the target.
    pub forward: SurfaceMap,
    /// From the vertices of the target to the source: the inverse of the map that is linear, in the domain, on the faces of the source.
    pub backward: SurfaceMap,
    /// Where the source's points of [`MatchOptions::points`], and after them the vertices of its curves that are no landmarks, go on the
    /// target, and where they should go.
    pub points: Vec<[Place; 2]>,
    /// Per soft landmark the length that is left of its way on the target to its partner.
    pub soft_left: Vec<f64>,
    /// Where the domain of the target lies.
    pub space: Space,
    /// The boundary loops as circles of the domain, in the order of the source's; empty where they are none.
    pub holes: Vec<RoundHole>,
    /// Faces of the source that are not counterclockwise in the domain of the target, from positions with twice the digits of doubles.
    /// Without any, and with [`Matching::target_flipped`] empty, the map is a homeomorphism. Both are empty in what [`match_surfaces`]
    /// returns: where it finds such faces, that is its error. They stand here so that reports say what was counted.
    pub flipped: Vec<FaceId>,
    /// Faces of the target that are not counterclockwise in its own domain: as [`Matching::flipped`].
    pub target_flipped: Vec<FaceId>,
    /// Largest distance by which a vertex lies outside the other surface's domain, or by which two ways to it across a cut differ, as a
    /// share of the nearest triangle: rounding.
    pub outside: f64,
    /// How the source, and the target, came into the domain.
    pub balance: [BalanceReport; 2],
    /// Steps of the flows to the canonical metrics of source and target.
    pub flow_iterations: [usize; 2],
    /// Isotopy classes of maps, as paths between the marks name them, whose energies were compared.
    pub markings: usize,
    /// Both triangulations in the domain: for their overlay, and for pictures.
    pub domain: CommonDomain,
}

/// The map from one surface to another of the same topology, landmarks to landmarks.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Matching`] for surfaces of different topology, landmarks that are no pairs of different vertices inside the surfaces, loops
/// that are no permutation, and where no map is found, with the reason; those of [`crate::flow::Flow::new`]; [`Error::Cancelled`].
pub fn match_surfaces(
    source: &Surface,
    target: &Surface,
    options: &MatchOptions,
    control: &Control,
) -> Result<Matching> {
    control.check()?;
    check_topology(source, target)?;
    check_loop_shape(source, options)?;
    if options.soft.is_empty() {
        return match_hard([source, target], options, control);
    }
    soft::check([source, target], &options.soft)?;
    let hard = MatchOptions { soft: Vec::new(), ..options.clone() };
    let first = match_hard([source, target], &hard, control)?;
    let approach =
        |s: &SoftLandmark| Approach::new(target, first.forward.places[s.pair[0].index()], s.pair[1], control);
    let ways: Vec<Approach> = options.soft.iter().map(approach).collect::<Result<_>>()?;
    let mut part = 1.0;
    for last in (0..=MOST_HALVINGS).rev() {
        let shares = options.soft.iter().map(|soft| part * soft.weight / (1.0 + soft.weight));
        let shares: Vec<f64> = shares.collect();
        let goal = |(k, soft): (usize, &SoftLandmark)| {
            Ok([Place::at_vertex(source.mesh(), soft.pair[0])?, ways[k].at(target, shares[k])?])
        };
        let goals: Vec<[Place; 2]> = options.soft.iter().enumerate().map(goal).collect::<Result<_>>()?;
        let points = options.points.iter().copied().chain(goals).collect();
        match match_hard([source, target], &MatchOptions { points, ..hard.clone() }, control) {
            Ok(mut matching) => {
                let soft = options.points.len()..options.points.len() + ways.len();
                matching.points.drain(soft);
                let left = ways.iter().zip(&shares).map(|(way, share)| (1.0 - share) * way.length);
                matching.soft_left = left.collect();
                return Ok(matching);
            }
            Err(why @ Error::Matching(_)) if last == 0 => return Err(why),
            Err(Error::Matching(_)) => part *= 0.5,
            Err(other) => return Err(other),
        }
    }
    Ok(first)
}

/// Share of a triangle by which a vertex may lie outside a domain with round holes: rounding.
const OUTSIDE: f64 = 1e-6;
/// Times that the ways of soft landmarks are halved where they are in conflict.
const MOST_HALVINGS: usize = 4;

/// [`match_surfaces`] without soft landmarks.
fn match_hard(
    [source, target]: [&Surface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Matching> {
    let mut points = curves::points([source, target], &options.curves, &options.landmarks)?;
    points.splice(0..0, options.points.iter().copied());
    let asked = (&options.landmarks[..], &points[..]);
    let [(first, from), (second, to)] = [split(source, asked, 0)?, split(target, asked, 1)?];
    let splits = [first, second];
    let surfaces = [splits[0].surface()?, splits[1].surface()?];
    let surfaces = [&surfaces[0], &surfaces[1]];
    let landmarks: Vec<[VertexId; 2]> = from.into_iter().zip(to).map(|(a, b)| [a, b]).collect();
    let options =
        &MatchOptions { basis: basis([&splits[0], &splits[1]], &options.basis)?, ..options.clone() };
    let added = landmarks[options.landmarks.len()..].iter().map(|pair| pair[0]);
    let points: Vec<(VertexId, Place)> = added.zip(points.iter().map(|pair| pair[1])).collect();
    Pool::new(options.flow.threads)?.run(|| {
        let (marks, pair) = in_best_order(surfaces, &landmarks, options, control)?;
        let (marks, splits) = ([&marks[0], &marks[1]], [&splits[0], &splits[1]]);
        if options.loop_shape == LoopShape::Geodesics {
            return matching(pair, splits, &points, control);
        }
        let InRound { pair, splits, holes } = in_round(&pair, (surfaces, marks), splits, options, control)?;
        let matching = matching(pair, [&splits[0], &splits[1]], &points, control)?;
        if matching.outside > OUTSIDE {
            return Err(Error::Matching(format!(
                "a vertex lies outside the other surface's domain with round holes by {:.1e} of a triangle",
                matching.outside
            )));
        }
        Ok(Matching { holes, ..matching })
    })
}

/// A surface with its landmarks, those inside faces as vertices that are added, and a vertex added on every inner edge that joins two
/// vertices of the boundary: where that is straight, such an edge would lie on it. On surfaces with handles, also on every edge that joins
/// two landmarks, which hold it.
fn split(
    surface: &Surface,
    (landmarks, points): (&[[VertexId; 2]], &[[Place; 2]]),
    s: usize,
) -> Result<(Split, Vec<VertexId>)> {
    let mut split = Split::new(surface);
    let mut landmarks: Vec<VertexId> = landmarks.iter().map(|pair| pair[s]).collect();
    for pair in points {
        landmarks.push(split.insert(pair[s].face, pair[s].weights)?);
    }
    let finer = split.surface()?;
    let (mesh, marked) = (finer.mesh(), landmarks.iter().collect::<HashSet<_>>());
    let has_handles = mesh.genus() > 0;
    let is_chord = |e: &EdgeId| {
        let ends = mesh.ends(*e);
        !mesh.is_boundary_edge(*e)
            && (ends.iter().all(|&v| mesh.is_boundary_vertex(v))
                || (has_handles && ends.iter().all(|v| marked.contains(v))))
    };
    for e in mesh.edges().filter(is_chord) {
        split.halve(e)?;
    }
    Ok((split, landmarks))
}

/// The loops of a basis along the edges of the finer triangulations.
fn basis(splits: [&Split; 2], pairs: &[[Vec<HalfedgeId>; 2]]) -> Result<Vec<[Vec<HalfedgeId>; 2]>> {
    let along = |s: usize, path: &[HalfedgeId]| -> Result<Vec<HalfedgeId>> {
        let parts: Vec<Vec<HalfedgeId>> = path.iter().map(|&h| splits[s].path(h)).collect::<Result<_>>()?;
        Ok(parts.concat())
    };
    if !pairs.is_empty() && splits[0].given().mesh().genus() == 0 {
        return Err(Error::Matching(
            "surfaces of genus 0 have no handles whose loops name a class: landmarks do".into(),
        ));
    }
    pairs.iter().map(|pair| Ok([along(0, &pair[0])?, along(1, &pair[1])?])).collect()
}

/// A place in a face of a finer triangulation, in the given face.
fn on_given(place: Place, to: &Split) -> Place {
    let (face, corners) = to.place(place.face);
    let weights = std::array::from_fn(|c| (0..3).map(|k| place.weights[k] * corners[k][c]).sum());
    Place { face, weights }
}

/// Energy of the source in the target's domain over that of the target itself, below which no other order of loops is looked for.
const UNTWISTED: f64 = 1.05;

/// What corresponds, and both surfaces in one domain: of the orders of loops that are left open, on surfaces with handles, with the one of
/// least energy.
fn in_best_order(
    surfaces: [&Surface; 2],
    landmarks: &[[VertexId; 2]],
    options: &MatchOptions,
    control: &Control,
) -> Result<([Marks; 2], Pair)> {
    check_landmarks_beside_circles(surfaces[0], landmarks, options)?;
    let is_open = options.loops.is_none() && options.basis.is_empty() && surfaces[0].mesh().genus() > 0;
    let orders = if is_open {
        loop_orders(surfaces).into_iter().map(Some).collect()
    } else {
        vec![options.loops.clone()]
    };
    let (mut best, mut failure, mut tried) = (None::<([Marks; 2], Pair)>, None, 0);
    for order in orders {
        let found = marks(surfaces, landmarks, order.as_deref()).and_then(|marks| {
            let pair = in_one_domain(surfaces, [&marks[0], &marks[1]], options, control)?;
            Ok((marks, pair))
        });
        match found {
            Ok((marks, pair)) => {
                tried += pair.markings;
                if best.as_ref().is_none_or(|(_, least)| pair.twist() < least.twist()) {
                    best = Some((marks, pair));
                }
            }
            Err(why @ Error::Matching(_)) => failure = failure.or(Some(why)),
            Err(other) => return Err(other),
        }
        if best.as_ref().is_some_and(|(_, pair)| pair.twist() < UNTWISTED) {
            break;
        }
    }
    match (best, failure) {
        (Some((marks, pair)), _) => Ok((marks, Pair { markings: tried, ..pair })),
        (None, Some(why)) => Err(why),
        (None, None) => Err(Error::Matching("no order of the boundary loops".into())),
    }
}

fn in_one_domain(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let genus = surfaces[0].mesh().genus();
    let of = |marks: &Marks| (marks.loops.len(), marks.landmarks.len(), marks.corners.len());
    let (loops, landmarks, corners) = of(marks[0]);
    if let Some(order) = cones_of_same(surfaces, marks, options) {
        match in_frames_of_faces(surfaces, (&marks[0].landmarks, order), options, control) {
            // Of another class there may be one.
            Err(Error::Matching(why)) => log::debug!("in the class of the vertices' numbers: {why}"),
            found => return found,
        }
    }
    if genus > 0 {
        // One landmark of a torus without boundary is met by a shift; all others are pushed to their goals.
        let is_flat = surfaces[0].mesh().euler() == 0;
        let few = |marks: &Marks| Marks {
            landmarks: marks.landmarks.iter().take(usize::from(is_flat)).copied().collect(),
            loops: marks.loops.clone(),
            corners: Vec::new(),
        };
        let bare = [few(marks[0]), few(marks[1])];
        let rest = landmarks - bare[0].landmarks.len() + corners;
        let (pair, others) = with_handles(surfaces, ([&bare[0], &bare[1]], rest > 0), options, control)?;
        return if rest == 0 {
            Ok(pair)
        } else {
            pushed((&pair, &others), surfaces, marks, options, control)
        };
    }
    if shape(loops, landmarks, corners).is_some() {
        return in_orbifold(surfaces, marks, options, control);
    }
    match (loops, landmarks, corners) {
        (0, 0..=2, 0) => on_sphere(surfaces, marks, options, control),
        (1, 0 | 1, 0) | (1, 0, 1 | 2) => {
            let [first, second] = disk::corners(surfaces, marks, &options.flow, control)?;
            let with = |s: usize, corners| Marks { corners, ..marks[s].clone() };
            let marks = [with(0, first), with(1, second)];
            in_orbifold(surfaces, [&marks[0], &marks[1]], options, control)
        }
        _ => Err(Error::Matching(format!(
            "{landmarks} landmarks inside and {corners} on the boundary leave the map open on a surface of genus 0 with {loops} boundary loops"
        ))),
    }
}

/// The maps both ways of two triangulations in one domain.
fn matching(
    pair: Pair,
    splits: [&Split; 2],
    points: &[(VertexId, Place)],
    control: &Control,
) -> Result<Matching> {
    let (flipped, target_flipped) = (pair.source.flipped(), pair.target.flipped());
    if !(flipped.is_empty() && target_flipped.is_empty()) {
        return Err(Error::Matching(format!(
            "{} faces of the source and {} of the target fold in the domain, the first face {}: positions have too few digits there",
            flipped.len(),
            target_flipped.len(),
            flipped.first().or(target_flipped.first()).map_or(0, |f| f.index())
        )));
    }
    let (forward, ahead) = locate(&pair.source, &pair.target, pair.seeds[0], control)?;
    let (backward, back) = locate(&pair.target, &pair.source, pair.seeds[1], control)?;
    let images = points.iter().map(|(v, goal)| [on_given(forward[v.index()], splits[1]), *goal]).collect();
    let map = |places: Vec<Place>, from: usize| {
        let n = splits[from].given().mesh().n_vertices();
        SurfaceMap { places: places.into_iter().take(n).map(|p| on_given(p, splits[1 - from])).collect() }
    };
    Ok(Matching {
        forward: map(forward, 0),
        backward: map(backward, 1),
        points: images,
        soft_left: Vec::new(),
        space: pair.source.cover.space,
        holes: Vec::new(),
        flipped,
        target_flipped,
        outside: ahead.max(back),
        balance: pair.reports,
        flow_iterations: pair.flow_iterations,
        markings: pair.markings,
        domain: CommonDomain::new([pair.source, pair.target], pair.seeds, splits),
    })
}

fn check_landmarks_beside_circles(
    source: &Surface,
    landmarks: &[[VertexId; 2]],
    options: &MatchOptions,
) -> Result<()> {
    let mesh = source.mesh();
    let is_inside =
        |pair: &&[VertexId; 2]| pair[0].index() < mesh.n_vertices() && !mesh.is_boundary_vertex(pair[0]);
    let inside = landmarks.iter().filter(is_inside).count();
    if options.loop_shape == LoopShape::Circles && inside > 0 {
        return Err(Error::Matching(format!(
            "{inside} landmarks inside the surfaces and round holes: landmarks inside are met where loops become geodesics"
        )));
    }
    Ok(())
}

fn check_loop_shape(source: &Surface, options: &MatchOptions) -> Result<()> {
    let (mesh, loops) = (source.mesh(), source.mesh().boundary_loops().len());
    if options.loop_shape == LoopShape::Circles && (mesh.genus() == 0 || loops == 0) {
        return Err(Error::Matching(format!(
            "loops become circles on surfaces with handles and boundary; these have genus {} and {loops} boundary loops",
            mesh.genus()
        )));
    }
    Ok(())
}

fn check_topology(source: &Surface, target: &Surface) -> Result<()> {
    let [(genus, loops), (other_genus, other_loops)] =
        [source, target].map(|s| (s.mesh().genus(), s.mesh().boundary_loops().len()));
    if genus != other_genus {
        return Err(Error::Matching(format!(
            "the source has genus {genus}, the target {other_genus}: no homeomorphism exists"
        )));
    }
    if loops != other_loops {
        return Err(Error::Matching(format!(
            "the source has {loops} boundary loops, the target {other_loops}: fill those that have no partner"
        )));
    }
    Ok(())
}

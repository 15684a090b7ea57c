//! The one call that finds a map between two surfaces: what was asked becomes marks at vertices, a strategy brings both surfaces into one
//! domain, and the map is read off there.

use super::landmarks::{MarkedSurface, curves, soft};
use super::options::{LoopShape, MatchOptions};
use super::result::Matching;
use super::round::{RoundMatching, in_round};
use super::strategy::in_best_order;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Place, VertexId};
use crate::metric::{Split, Surface};
use crate::parallel::Pool;
use std::collections::HashSet;

/// The map from one surface to another of the same topology, landmarks to landmarks.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Matching`] for surfaces of different topology, landmarks that are no pairs of different vertices inside the surfaces, loops
/// that are no permutation, and if no map is found, with the reason; those of [`crate::flow::Flow::new`]; [`Error::Cancelled`].
pub fn match_surfaces(
    source: &Surface,
    target: &Surface,
    options: &MatchOptions,
    control: &Control,
) -> Result<Matching> {
    control.check()?;
    check_topology(source, target)?;
    check_loop_shape(source, options)?;
    let surfaces = [source, target];
    if options.soft.is_empty() {
        return match_hard(surfaces, options, control);
    }
    soft::match_near(surfaces, options, control, |options| match_hard(surfaces, options, control))
}

/// Share of a triangle by which a vertex may lie outside a domain with round holes: rounding.
const OUTSIDE: f64 = 1e-6;

/// The map that meets all landmarks; soft ones are not looked at.
fn match_hard(
    [source, target]: [&Surface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Matching> {
    let mut points = options.points.clone();
    points.extend(curves::points([source, target], &options.curves, &options.landmarks)?);
    let marked = |surface, s: usize| {
        let landmarks = options.landmarks.iter().map(|pair| pair[s]).collect();
        split(surface, landmarks, points.iter().map(|pair| pair[s]))
    };
    let [(first, from), (second, to)] = [marked(source, 0)?, marked(target, 1)?];
    let splits = [&first, &second];
    let surfaces = [first.surface()?, second.surface()?];
    let surfaces = [&surfaces[0], &surfaces[1]];
    let landmarks: Vec<[VertexId; 2]> = from.into_iter().zip(to).map(|(a, b)| [a, b]).collect();
    let options = &MatchOptions { basis: basis(splits, &options.basis)?, ..options.clone() };
    let added = landmarks[options.landmarks.len()..].iter().map(|pair| pair[0]);
    let points: Vec<(VertexId, Place)> = added.zip(points.iter().map(|pair| pair[1])).collect();
    Pool::new(options.flow.threads)?.run(|| {
        let (marks, pair) = in_best_order(surfaces, &landmarks, options, &control.part(0.0, 0.7))?;
        if options.loop_shape == LoopShape::Geodesics {
            return Matching::new(pair, splits, &points, &control.part(0.7, 1.0));
        }
        let sides = [0, 1].map(|s| MarkedSurface { surface: surfaces[s], marks: &marks[s] });
        let RoundMatching { pair, splits, holes } =
            in_round(&pair, sides, splits, options, &control.part(0.7, 0.8))?;
        let matching = Matching::new(pair, [&splits[0], &splits[1]], &points, &control.part(0.8, 1.0))?;
        if matching.outside > OUTSIDE {
            return Err(Error::Matching(format!(
                "a vertex lies outside the other surface's domain with round holes by {:.1e} of a triangle",
                matching.outside
            )));
        }
        Ok(Matching { holes, ..matching })
    })
}

/// A surface with these points as additional vertices, and the landmarks followed by these vertices.
///
/// A vertex is also added on every inner edge that joins two vertices of the boundary: if the boundary is straight there, the edge would
/// lie on it. On surfaces with handles one is added on every edge that joins two landmarks, because both its ends would be held.
fn split(
    surface: &Surface,
    mut landmarks: Vec<VertexId>,
    points: impl Iterator<Item = Place>,
) -> Result<(Split, Vec<VertexId>)> {
    let mut split = Split::new(surface);
    for point in points {
        landmarks.push(split.insert(point.face, point.weights)?);
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

/// The loops of a basis along the edges of the refined triangulations.
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

/// Checks that a homeomorphism exists.
///
/// # Errors
/// [`Error::Matching`].
pub(super) fn check_topology(source: &Surface, target: &Surface) -> Result<()> {
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

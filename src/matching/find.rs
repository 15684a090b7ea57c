//! One call for two surfaces.

use super::balance::BalanceReport;
use super::disk;
use super::handles::with_handles;
use super::options::MatchOptions;
use super::orbifold::{Pair, in_orbifold, shape};
use super::place::{Place, SurfaceMap};
use super::route::Marks;
use super::sphere::on_sphere;
use super::walk::locate;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::metric::{Split, Surface};
use crate::parallel::Pool;
use crate::topology::check_vertex;

/// A map between two surfaces, with what certifies it.
#[derive(Debug, Clone, PartialEq)]
pub struct Matching {
    /// From the vertices of the source to the target.
    pub forward: SurfaceMap,
    /// From the vertices of the target to the source: the inverse of the map that is linear, in the domain, on the faces of the source.
    pub backward: SurfaceMap,
    /// Where the domain of the target lies.
    pub space: Space,
    /// Faces of the source that are not counterclockwise in the domain of the target, from positions with twice the digits of doubles. Without any,
    /// and with [`Matching::target_flipped`] empty, the map is a homeomorphism.
    pub flipped: Vec<FaceId>,
    /// Faces of the target that are not counterclockwise in its own domain.
    pub target_flipped: Vec<FaceId>,
    /// Largest distance by which a vertex lies outside the other surface's domain, or by which two ways to it across a cut differ, as a share of the nearest
    /// triangle: rounding.
    pub outside: f64,
    /// How the source, and the target, came into the domain.
    pub balance: [BalanceReport; 2],
    /// Steps of the flows to the canonical metrics of source and target.
    pub flow_iterations: [usize; 2],
    /// Isotopy classes of maps, as paths between the marks name them, whose energies were compared.
    pub markings: usize,
}

/// The map from one surface to another of the same topology, landmarks to landmarks.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Matching`] for surfaces of different topology, landmarks that are no pairs of different vertices inside the surfaces, loops that are no
/// permutation, and where no map is found, with the reason; those of [`crate::flow::Flow::new`]; [`Error::Cancelled`].
pub fn match_surfaces(
    source: &Surface,
    target: &Surface,
    options: &MatchOptions,
    control: &Control,
) -> Result<Matching> {
    control.check()?;
    check_topology(source, target)?;
    let splits = [without_chords(source)?, without_chords(target)?];
    let surfaces = [splits[0].surface()?, splits[1].surface()?];
    let surfaces = [&surfaces[0], &surfaces[1]];
    let marks = marks(surfaces, options)?;
    Pool::new(options.flow.threads)?.run(|| {
        let pair = in_one_domain(surfaces, [&marks[0], &marks[1]], options, control)?;
        matching(&pair, [&splits[0], &splits[1]], control)
    })
}

/// A surface with a vertex added on every inner edge that joins two vertices of the boundary: where that is straight, such an edge would lie on it.
fn without_chords(surface: &Surface) -> Result<Split> {
    let mesh = surface.mesh();
    let mut split = Split::new(surface);
    let is_chord =
        |e: &EdgeId| !mesh.is_boundary_edge(*e) && mesh.ends(*e).iter().all(|&v| mesh.is_boundary_vertex(v));
    for e in mesh.edges().filter(is_chord) {
        split.halve(e)?;
    }
    Ok(split)
}

/// Places in the faces of a finer triangulation, of the first vertices, in the faces of the given one.
fn on_given(places: Vec<Place>, from: &Split, to: &Split) -> SurfaceMap {
    let n = from.given().mesh().n_vertices();
    let back = |place: Place| {
        let (face, corners) = to.place(place.face);
        let weights = std::array::from_fn(|c| (0..3).map(|k| place.weights[k] * corners[k][c]).sum());
        Place { face, weights }
    };
    SurfaceMap { places: places.into_iter().take(n).map(back).collect() }
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
    if genus > 0 {
        return with_handles(surfaces, marks, options, control);
    }
    if shape(loops, landmarks, corners).is_some() {
        return in_orbifold(surfaces, marks, options, control);
    }
    match (loops, landmarks, corners) {
        (0, 0, 0) => on_sphere(surfaces, options, control),
        (1, 0 | 1, 0) => {
            let [first, second] = disk::corners(surfaces, &options.flow, control)?;
            let with = |s: usize, corners| Marks { corners, ..marks[s].clone() };
            let marks = [with(0, first), with(1, second)];
            in_orbifold(surfaces, [&marks[0], &marks[1]], options, control)
        }
        _ => Err(Error::Matching(format!(
            "{landmarks} landmarks inside and {corners} on the boundary leave the map open on a surface of genus 0 with {loops} boundary loops: \
             name none or at least three"
        ))),
    }
}

/// The maps both ways of two triangulations in one domain.
fn matching(pair: &Pair, splits: [&Split; 2], control: &Control) -> Result<Matching> {
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
    Ok(Matching {
        forward: on_given(forward, splits[0], splits[1]),
        backward: on_given(backward, splits[1], splits[0]),
        space: pair.source.cover.space,
        flipped,
        target_flipped,
        outside: ahead.max(back),
        balance: pair.reports,
        flow_iterations: pair.flow_iterations,
        markings: pair.markings,
    })
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

/// Landmarks, corners and loops of both surfaces, in the same order.
fn marks(surfaces: [&Surface; 2], options: &MatchOptions) -> Result<[Marks; 2]> {
    check_landmarks(surfaces, &options.landmarks)?;
    let loops = [0, 1].map(|s| loops(surfaces[s]));
    let order = match &options.loops {
        None => by_length(&loops),
        Some(order) => {
            let n = loops[0].len();
            let mut seen = vec![false; n];
            let is_permutation =
                order.len() == n && order.iter().all(|&k| k < n && !std::mem::replace(&mut seen[k], true));
            if !is_permutation {
                return Err(Error::Matching(format!(
                    "loops {order:?} do not name each of the {n} boundary loops of the target once"
                )));
            }
            order.clone()
        }
    };
    let [source, target] = loops.map(|all| all.into_iter().map(|(around, _)| around).collect::<Vec<_>>());
    let target = order.into_iter().map(|k| target[k].clone()).collect();
    let on_boundary = |s: usize, pair: &[VertexId; 2]| surfaces[s].mesh().is_boundary_vertex(pair[s]);
    let of = |s: usize, outside: bool| -> Vec<VertexId> {
        options.landmarks.iter().filter(|pair| on_boundary(s, pair) == outside).map(|pair| pair[s]).collect()
    };
    let marks = |s: usize, loops| Marks { landmarks: of(s, false), loops, corners: of(s, true) };
    let marks = [marks(0, source), marks(1, target)];
    check_corners(surfaces, &marks)?;
    Ok(marks)
}

fn check_landmarks(surfaces: [&Surface; 2], landmarks: &[[VertexId; 2]]) -> Result<()> {
    for (k, pair) in landmarks.iter().enumerate() {
        for (s, name) in ["source", "target"].into_iter().enumerate() {
            let v = pair[s];
            check_vertex(surfaces[s].mesh(), v)?;
            if let Some(j) = landmarks[..k].iter().position(|other| other[s] == v) {
                return Err(Error::Matching(format!(
                    "landmarks {j} and {k} conflict: both are vertex {v} of the {name}"
                )));
            }
        }
        let outside = [0, 1].map(|s| surfaces[s].mesh().is_boundary_vertex(pair[s]));
        if outside[0] != outside[1] {
            let [on, inside] = if outside[0] { ["source", "target"] } else { ["target", "source"] };
            return Err(Error::Matching(format!(
                "landmark {k} lies on the boundary of the {on} and inside the {inside}"
            )));
        }
    }
    Ok(())
}

/// Corners lie on corresponding loops, in the same order around them.
fn check_corners(surfaces: [&Surface; 2], marks: &[Marks; 2]) -> Result<()> {
    for k in 0..marks[0].loops.len() {
        let along = |s: usize| -> Vec<usize> {
            let mesh = surfaces[s].mesh();
            let number = |h: &HalfedgeId| marks[s].corners.iter().position(|&v| v == mesh.origin(*h));
            let mut found: Vec<usize> = marks[s].loops[k].iter().filter_map(number).collect();
            if let Some(least) = (0..found.len()).min_by_key(|&i| found[i]) {
                found.rotate_left(least);
            }
            found
        };
        let [first, second] = [along(0), along(1)];
        if first != second {
            let name = |numbers: &[usize]| {
                numbers.iter().map(|&n| marks[0].corners[n].to_string()).collect::<Vec<_>>().join(", ")
            };
            return Err(Error::Matching(format!(
                "landmarks on boundary loop {k} of the source conflict: around it come those at vertices {} of the source, around the loop of the \
                 target that it goes to their partners come in the order of {}",
                name(&first),
                name(&second)
            )));
        }
    }
    Ok(())
}

/// The boundary loops with the surface on their left, and their lengths.
fn loops(surface: &Surface) -> Vec<(Vec<HalfedgeId>, f64)> {
    let (mesh, lengths) = (surface.mesh(), surface.lengths());
    let of = |around: Vec<HalfedgeId>| {
        let length = around.iter().map(|h| lengths[h.edge()]).sum();
        (around.first().map_or(Vec::new(), |h| mesh.boundary_from(h.twin())), length)
    };
    mesh.boundary_loops().into_iter().map(of).collect()
}

/// The target's loop for each of the source's: by descending length.
fn by_length(loops: &[Vec<(Vec<HalfedgeId>, f64)>; 2]) -> Vec<usize> {
    let [first, second] = [0, 1].map(|s| {
        let mut order: Vec<usize> = (0..loops[s].len()).collect();
        order.sort_by(|&i, &j| loops[s][j].1.total_cmp(&loops[s][i].1).then(i.cmp(&j)));
        order
    });
    let mut of = vec![0; first.len()];
    first.into_iter().zip(second).for_each(|(i, j)| of[i] = j);
    of
}

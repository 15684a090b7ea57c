//! One call for two surfaces.

use super::balance::BalanceReport;
use super::options::MatchOptions;
use super::orbifold::{Pair, in_orbifold, shape};
use super::place::SurfaceMap;
use super::route::Marks;
use super::sphere::on_sphere;
use super::walk::locate;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use crate::metric::Surface;
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
    /// Largest distance by which a vertex lies outside the other surface's domain, as a share of the nearest triangle: rounding at the boundary.
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
    let marks = marks([source, target], options)?;
    Pool::new(options.flow.threads)?.run(|| {
        let pair = in_one_domain([source, target], [&marks[0], &marks[1]], options, control)?;
        matching(&pair, control)
    })
}

fn in_one_domain(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let (genus, loops, landmarks) = (surfaces[0].mesh().genus(), marks[0].loops.len(), marks[0].landmarks.len());
    if genus == 0 && shape(loops, landmarks, marks[0].corners.len()).is_some() {
        return in_orbifold(surfaces, marks, options, control);
    }
    if (genus, loops, landmarks) == (0, 0, 0) {
        return on_sphere(surfaces, options, control);
    }
    Err(Error::Matching(format!(
        "surfaces of genus {genus} with {loops} boundary loops and {landmarks} landmarks are not matched yet"
    )))
}

/// The maps both ways of two triangulations in one domain.
fn matching(pair: &Pair, control: &Control) -> Result<Matching> {
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
        forward: SurfaceMap { places: forward },
        backward: SurfaceMap { places: backward },
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

/// Landmarks and loops of both surfaces, in the same order.
fn marks(surfaces: [&Surface; 2], options: &MatchOptions) -> Result<[Marks; 2]> {
    for (s, name) in ["source", "target"].into_iter().enumerate() {
        let mesh = surfaces[s].mesh();
        for (k, pair) in options.landmarks.iter().enumerate() {
            let v = pair[s];
            check_vertex(mesh, v)?;
            if mesh.is_boundary_vertex(v) {
                return Err(Error::Matching(format!(
                    "landmark {k} is vertex {v} on the boundary of the {name}: landmarks have to lie inside"
                )));
            }
            if let Some(j) = options.landmarks[..k].iter().position(|other| other[s] == v) {
                return Err(Error::Matching(format!(
                    "landmarks {j} and {k} conflict: both are vertex {v} of the {name}"
                )));
            }
        }
    }
    let loops = [0, 1].map(|s| loops(surfaces[s]));
    let n = loops[0].len();
    let order = match &options.loops {
        None => by_length(&loops),
        Some(order) => {
            let mut seen = vec![false; n];
            let is_permutation = order.len() == n
                && order.iter().all(|&k| k < n && !std::mem::replace(&mut seen[k], true));
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
    let landmarks = [0, 1].map(|s| options.landmarks.iter().map(|pair| pair[s]).collect::<Vec<VertexId>>());
    let [first, second] = landmarks;
    let none = Vec::new;
    Ok([
        Marks { landmarks: first, loops: source, corners: none() },
        Marks { landmarks: second, loops: target, corners: none() },
    ])
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

//! Cones for a conformal factor within a range, and the curvatures of cones at given vertices.

use super::cones::{AutoCones, ConePlacement, check_number};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use std::collections::{HashSet, VecDeque};

/// What [`cones_within`] is to reach, and by what.
#[derive(Debug, Clone, PartialEq)]
pub struct ConeLimits {
    /// Largest ratio of two conformal factors e^u, outside the neighbourhoods of the cones.
    pub range: f64,
    /// The number of vertices in the neighbourhood of a cone.
    pub inside: usize,
    /// Least and largest number of cones.
    pub number: [usize; 2],
    /// Least total angle of a cone, radians.
    pub least_angle: f64,
}

/// As few cones as bring the conformal factor within a range, with the ratio of its largest to its least value that is left; if none do,
/// those with the least ratio. `lengths`: E entries, read in E². The rest is as [`super::auto_cones`] has it.
///
/// The ratio is that of the linear model, which is exact for smooth surfaces.
///
/// # Errors
/// [`Error::TargetKind`] for more cones than there are vertices inside the surface; those of [`super::auto_cones`].
pub fn cones_within(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    limits: &ConeLimits,
    control: &Control,
) -> Result<(AutoCones, f64)> {
    let [least, most] = limits.number;
    check_number(mesh, least)?;
    let mut place = ConePlacement::new(mesh, lengths, limits.least_angle, control)?;
    let mut distortion = vec![2.0 * place.energy];
    let mut best = (f64::INFINITY, 0);
    for n in 0..=most.max(least) {
        control.step(Stage::Flow, n as f64 / (most + 1) as f64)?;
        // One cone on a surface of total curvature 0 has none.
        if n >= least && !(n == 1 && mesh.euler() == 0 && mesh.is_closed()) {
            let range = range(&mut place, limits.inside)?;
            best = if range < best.0 { (range, n) } else { best };
            if best.0 <= limits.range {
                break;
            }
        }
        if n < most.max(least) {
            place.add_best()?;
            distortion.push(2.0 * place.energy);
        }
    }
    place.truncate(best.1)?;
    distortion.truncate(best.1 + 1);
    place.sweep()?;
    let range = range(&mut place, limits.inside)?;
    Ok((place.finish(mesh, lengths, distortion)?, range))
}

/// The curvatures of cones at given vertices with which areas change least. `lengths`: E entries, read in E².
///
/// # Errors
/// [`Error::Argument`] for a vertex that there is not, on the boundary, or named twice; those of [`super::auto_cones`].
pub fn cones_at(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    vertices: &[VertexId],
    least_angle: f64,
    control: &Control,
) -> Result<AutoCones> {
    for (k, &v) in vertices.iter().enumerate() {
        let why = match () {
            _ if v.index() >= mesh.n_vertices() => "a vertex of the surface, numbered from 0",
            _ if mesh.is_boundary_vertex(v) => "inside the surface",
            _ if vertices[..k].contains(&v) => "named once",
            _ => continue,
        };
        return Err(Error::argument("singular vertex", v, why));
    }
    check_number(mesh, vertices.len())?;
    let mut place = ConePlacement::new(mesh, lengths, least_angle, control)?;
    let mut distortion = vec![2.0 * place.energy];
    for &v in vertices {
        place.add(v)?;
        distortion.push(2.0 * place.energy);
    }
    place.finish(mesh, lengths, distortion)
}

/// The ratio of the largest conformal factor to the least, outside the neighbourhoods of the cones.
fn range(place: &mut ConePlacement<'_>, inside: usize) -> Result<f64> {
    let u = place.factor()?;
    let cones = place.cones.iter().map(|cone| cone.vertex);
    let outside = outside_neighbourhoods(&place.mesh, cones, inside);
    let counted = u.iter().zip(outside.iter()).filter(|(_, counts)| **counts).map(|(u, _)| *u);
    let [low, high] =
        counted.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| [low.min(u), high.max(u)]);
    Ok(if high >= low { (high - low).exp() } else { 1.0 })
}

/// For each vertex, true unless it is among the `inside` vertices that are fewest edges away from one of the given ones.
pub(crate) fn outside_neighbourhoods(
    mesh: &Mesh,
    centres: impl Iterator<Item = VertexId>,
    inside: usize,
) -> PerVertex<bool> {
    let mut outside = PerVertex::filled(mesh.n_vertices(), true);
    for centre in centres {
        let mut seen = HashSet::from([centre]);
        let mut queue = VecDeque::from([centre]);
        let mut left = inside;
        while let Some(v) = queue.pop_front().filter(|_| left > 0) {
            left -= 1;
            outside[v] = false;
            queue.extend(mesh.outgoing(v).map(|h| mesh.tip(h)).filter(|&w| seen.insert(w)));
        }
    }
    outside
}

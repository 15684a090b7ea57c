//! The signature of a seamless metric: angles around cones and turning along loops, in quarter turns; and which signatures no metric has.

use super::dual_loops::DualLoops;
use super::sectors::Sectors;
use super::spin::arf_invariant;
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, PerVertex, VertexId};

/// The largest curvature of a cone in quarter turns: an angle of 90° is left.
pub(super) const MOST_CURVED: i32 = 3;

/// A cone of a seamless metric.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConeValence {
    /// The vertex.
    pub vertex: VertexId,
    /// The number of right angles around it, which is that of squares that meet there, at least 1. Vertices that are no cones have 4, on the
    /// boundary 2.
    pub valence: u32,
}
stored!(row ConeValence { vertex: VertexId, valence: u32 });

/// The vertices at which the right angles of the sectors do not add up to the regular number. A sector is the part of the angle at a vertex
/// between two features or boundary edges.
pub(super) fn cones_of_sectors(mesh: &Mesh, sectors: &Sectors, right_angles: &[i32]) -> Vec<ConeValence> {
    let mut valence = PerVertex::filled(mesh.n_vertices(), 0);
    sectors.vertex.iter().zip(right_angles).for_each(|(&v, k)| valence[v] += k);
    let is_cone = |&v: &VertexId| valence[v] != regular(mesh, v);
    let cone = |vertex| ConeValence { vertex, valence: valence[vertex].max(0) as u32 };
    mesh.vertices().filter(is_cone).map(cone).collect()
}

/// The right angles around a vertex that is no cone or corner.
fn regular(mesh: &Mesh, v: VertexId) -> i32 {
    if mesh.is_boundary_vertex(v) { 2 } else { 4 }
}

/// The right angles of the sectors around vertices with these valences.
///
/// # Errors
/// [`Error::TargetKind`] for a vertex that does not exist or is named twice, and a valence of 0; [`Error::Argument`] where features inside the
/// surface divide the angles around a vertex.
pub(super) fn given_right_angles(mesh: &Mesh, sectors: &Sectors, cones: &[ConeValence]) -> Result<Vec<i32>> {
    let refused = |message: String| Error::TargetKind { target: "cones", message };
    let is_divided = |s: usize| sectors.is_bounded(s) && !mesh.is_boundary_vertex(sectors.vertex[s]);
    if sectors.len() != mesh.n_vertices() || (0..sectors.len()).any(is_divided) {
        let need = "the cones of the field where features divide the angle at a vertex, or pieces of the surface meet at one";
        return Err(Error::argument("cones", "given valences", need));
    }
    let mut right_angles: Vec<i32> = mesh.vertices().map(|v| regular(mesh, v)).collect();
    let mut is_named = PerVertex::filled(mesh.n_vertices(), false);
    for &ConeValence { vertex, valence } in cones {
        if vertex.index() >= mesh.n_vertices() {
            return Err(refused(format!(
                "vertex {vertex} does not exist; the last is {}",
                mesh.n_vertices() - 1
            )));
        }
        if std::mem::replace(&mut is_named[vertex], true) {
            return Err(refused(format!("vertex {vertex} is named twice")));
        }
        if valence == 0 {
            return Err(refused(format!("vertex {vertex} has valence 0; a cone has 1 or more")));
        }
        let too_many = |_| refused(format!("vertex {vertex} has valence {valence}, which is too large"));
        right_angles[vertex.index()] = i32::try_from(valence).map_err(too_many)?;
    }
    Ok(right_angles)
}

/// Refuses signatures that no metric has. Those of this list are known to be impossible; of all others nothing is claimed.
///
/// - Genus 1 without cones: on a flat torus no loop turns.
/// - Genus 1, two cones with curvatures of −a and a quarter turns, a dividing the turning of every loop \[IKRSS13\].
/// - Genus 2, one cone with a curvature of −8 or two of −6 and −2 quarter turns, all loops turning by half turns but not all by whole ones: the strata of
///   quadratic differentials with one zero of order 4, or two of 3 and 1, are empty \[MS93\].
/// - Genus 2, one cone with a curvature of −8 quarter turns, all loops turning by whole turns, with an Arf invariant of 0: Abelian differentials with one zero
///   of order 2 have odd spin \[KZ03\].
///
/// # Errors
/// [`Error::TargetKind`], with the theorem.
pub(super) fn check_existence(
    mesh: &Mesh,
    loops: &DualLoops,
    right_angles: &[i32],
    quarter_turns: &[i32],
) -> Result<()> {
    let refused = |message: String| Err(Error::TargetKind { target: "seamless", message });
    let mut curvatures: Vec<i32> = right_angles.iter().map(|k| 4 - k).filter(|&k| k != 0).collect();
    curvatures.sort_unstable();
    let all = |n: i32| quarter_turns.iter().all(|k| k % n == 0);
    match (mesh.genus(), &curvatures[..]) {
        (1, []) if quarter_turns.iter().any(|&k| k != 0) => {
            refused("a flat torus without cones turns along no loop; ask for no turning, or for cones".into())
        }
        (1, [_, a]) if all(*a) => refused(format!(
            "no torus has two cones of {a} quarter turns, one of each sign, along whose loops all turning is a multiple of {a} [IKRSS13]; add cones, or another turning"
        )),
        (2, [-8] | [-6, -2]) if all(2) && !all(4) => refused(
            "no surface of genus 2 has these cones with loops that turn by half turns, since no quadratic differential has such zeros [MS93]; ask for other cones".into(),
        ),
        (2, [-8]) if all(4) && !arf_invariant(mesh, loops, quarter_turns) => refused(
            "no surface of genus 2 has one cone of valence 12 with these whole turns of its loops, whose Arf invariant is 0, since Abelian differentials with a double zero have odd spin [KZ03]; ask for other turning".into(),
        ),
        _ => Ok(()),
    }
}

//! The signature of a seamless metric: angles around cones and turning along loops, in quarter turns; and which signatures no metric has.

use crate::error::{Error, Result};
use crate::mesh::{Mesh, PerVertex, VertexId};

/// The largest curvature of a cone in quarter turns: an angle of 90° is left.
pub(super) const MOST_CURVED: i32 = 3;

/// A cone of a seamless metric.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConeValence {
    /// The vertex.
    pub vertex: VertexId,
    /// The number of right angles around it: of squares that meet there, 1 or more; 4 at any other vertex.
    pub valence: u32,
}

/// The cones of a curvature in quarter turns (V entries), by vertex.
pub(super) fn cones_of_curvature(curvature: &PerVertex<i32>) -> Vec<ConeValence> {
    let cones = (0..curvature.len()).map(VertexId::from).filter(|&v| curvature[v] != 0);
    cones.map(|vertex| ConeValence { vertex, valence: (4 - curvature[vertex]).max(0) as u32 }).collect()
}

/// The curvature of cones in quarter turns, per vertex.
///
/// # Errors
/// [`Error::TargetKind`] for a vertex that does not exist or is named twice, a valence of 0, and a total other than 4χ.
pub(super) fn curvature_of_cones(mesh: &Mesh, cones: &[ConeValence]) -> Result<PerVertex<i32>> {
    let refused = |message: String| Error::TargetKind { target: "cones", message };
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0);
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
        let quarters = 4 - i64::from(valence);
        if quarters > i64::from(MOST_CURVED) {
            return Err(refused(format!("vertex {vertex} has valence 0; a cone has 1 or more")));
        }
        curvature[vertex] = quarters as i32;
    }
    let total: i64 = curvature.iter().map(|&k| i64::from(k)).sum();
    if total != 4 * mesh.euler() {
        let wanted = 4 * mesh.euler();
        return Err(refused(format!("the sum of 4 − valence is {total}; this surface has {wanted}")));
    }
    Ok(curvature)
}

/// Refuses signatures that no metric has. Those of this list are known to be impossible; of all others nothing is claimed.
///
/// - Genus 1 without cones: a flat torus turns nothing.
/// - Genus 1, two cones of −a and a quarter turns, a dividing the turning of every loop \[IKRSS13\].
/// - Genus 2, one cone of −8 or two of −6 and −2 quarter turns, all loops turning by half turns but not all by whole ones: the strata of
///   quadratic differentials with one zero of order 4, or two of 3 and 1, are empty \[MS93\].
///
/// # Errors
/// [`Error::TargetKind`], with the theorem.
pub(super) fn check_existence(genus: usize, curvature: &PerVertex<i32>, quarter_turns: &[i32]) -> Result<()> {
    let refused = |message: String| Err(Error::TargetKind { target: "seamless", message });
    let mut cones: Vec<i32> = curvature.iter().copied().filter(|&k| k != 0).collect();
    cones.sort_unstable();
    let all = |n: i32| quarter_turns.iter().all(|k| k % n == 0);
    match (genus, &cones[..]) {
        (1, []) if quarter_turns.iter().any(|&k| k != 0) => {
            refused("a flat torus without cones turns along no loop; ask for no turning, or for cones".into())
        }
        (1, [_, a]) if all(*a) => refused(format!(
            "no torus has two cones of {a} quarter turns, one of each sign, along whose loops all turning is a multiple of {a} [IKRSS13]; add cones, or another turning"
        )),
        (2, [-8] | [-6, -2]) if all(2) && !all(4) => refused(
            "no surface of genus 2 has these cones with loops that turn by half turns, since no quadratic differential has such zeros [MS93]; ask for other cones".into(),
        ),
        _ => Ok(()),
    }
}

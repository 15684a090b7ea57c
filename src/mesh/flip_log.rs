//! A log of flips, from which they can be undone.
//!
//! A solve that fails must leave its surface as it was. A log takes 16 bytes per flip of a length, 24 per flip of an η, and 24 for each
//! set of curves that follows the flips; a copy of the surface would take as much for every edge, flipped or not.

use super::attribute::PerEdge;
use super::flip::{Flip, FlipUndo};
use super::halfedge::Mesh;
use super::ids::EdgeId;
use super::normal::{EdgeCoordinates, NormalCoordinates};
use crate::error::{Result, check_size};

/// The flips since some state of a triangulation, in order, with all values that they have changed.
///
/// ```
/// # use ricci::mesh::{EdgeId, Flip, FlipLog, Mesh, PerEdge, shapes};
/// # fn main() -> ricci::Result<()> {
/// let mut mesh = Mesh::from_soup(&shapes::icosphere(1)?)?;
/// let mut lengths = PerEdge::filled(mesh.n_edges(), 1.0);
/// let (before, mut log) = (mesh.clone(), FlipLog::default());
/// let edge = EdgeId(7);
/// log.record(&mesh, Flip { edge, value: lengths[edge] }, &mut []);
/// mesh.flip(edge);
/// lengths[edge] = 1.5;
/// log.undo(&mut mesh, &mut lengths, &mut [])?;
/// assert!(mesh == before && lengths[edge] == 1.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct FlipLog<T = f64> {
    flips: Vec<LoggedFlip<T>>,
    /// For each flip in order, the coordinates of its edge in all sets of curves that follow the flips.
    coordinates: Vec<EdgeCoordinates>,
}

/// The state of an edge before its flip.
#[derive(Debug, Clone, Copy)]
struct LoggedFlip<T> {
    value: T,
    edge: EdgeId,
    names: FlipUndo,
}

impl<T> Default for FlipLog<T> {
    fn default() -> FlipLog<T> {
        FlipLog { flips: Vec::new(), coordinates: Vec::new() }
    }
}

impl<T: Copy> FlipLog<T> {
    /// Records a flip, also in the sets of curves that follow the flips ([`NormalCoordinates::record`]), which must always be the same
    /// ones. To be called just before the flip with the mesh of that moment, and only for an edge that will be flipped.
    pub fn record(&mut self, mesh: &Mesh, flip: Flip<T>, followed: &mut [NormalCoordinates]) {
        let Flip { edge, value } = flip;
        self.flips.push(LoggedFlip { value, edge, names: mesh.before_flip(edge) });
        for normal in followed {
            self.coordinates.push(normal.coordinates(edge));
            normal.record(mesh, edge);
        }
    }

    /// Number of flips that [`FlipLog::undo`] would undo.
    pub fn len(&self) -> usize {
        self.flips.len()
    }

    /// True if there is nothing to undo.
    pub fn is_empty(&self) -> bool {
        self.flips.is_empty()
    }

    /// Forgets all flips, so that [`FlipLog::undo`] returns to the present state.
    pub fn clear(&mut self) {
        self.flips.clear();
        self.coordinates.clear();
    }

    /// Undoes all flips, the last one first: mesh, edge values and curves are then bit for bit what they were, and the log is empty.
    ///
    /// # Errors
    /// [`crate::Error::Size`] if `values` does not have one entry per edge, or if the number of sets of curves is not the one recorded;
    /// nothing is changed then.
    pub fn undo(
        &mut self,
        mesh: &mut Mesh,
        values: &mut PerEdge<T>,
        followed: &mut [NormalCoordinates],
    ) -> Result<()> {
        check_size("values of the edges", values.len(), mesh.n_edges())?;
        check_size("followed coordinates", followed.len() * self.flips.len(), self.coordinates.len())?;
        while let Some(LoggedFlip { value, edge, names }) = self.flips.pop() {
            mesh.unflip(edge, names);
            values[edge] = value;
            let last = self.coordinates.len() - followed.len();
            for (normal, before) in followed.iter_mut().zip(self.coordinates.drain(last..)) {
                normal.restore(edge, before);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::{self, SplitMix64};

    /// A value that no other flip has.
    fn value(k: u64) -> f64 {
        1.0 + k as f64 / 1024.0
    }

    #[test]
    fn random_flips_undone_leave_every_bit() {
        let mut random = SplitMix64::new(11);
        let surfaces = [
            shapes::one_vertex(2).unwrap().build().unwrap().0,
            shapes::two_triangle_sphere().build().unwrap().0,
            shapes::two_vertex(1).unwrap().build().unwrap().0,
            Mesh::from_soup(&shapes::disk(3).unwrap()).unwrap(),
            Mesh::from_soup(&shapes::genus(2, 3).unwrap()).unwrap(),
        ];
        for mut mesh in surfaces {
            // Two triangulations are followed, and there are flips before the log begins.
            let mut values = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| value(u64::from(e.0)));
            let mut followed = vec![NormalCoordinates::new(&mesh)];
            let mut log = FlipLog::default();
            for round in 0..6 {
                let before = (mesh.clone(), values.clone(), followed.clone());
                let wanted = 1 + 40 * round;
                let (mut flips, mut tries) = (0, 0u64);
                while flips < wanted && tries < 50 * wanted as u64 {
                    tries += 1;
                    let edge = EdgeId((random.bits() % mesh.n_edges() as u64) as u32);
                    let h = edge.halfedge();
                    if mesh.is_boundary_edge(edge) || mesh.face(h) == mesh.face(h.twin()) {
                        continue;
                    }
                    log.record(&mesh, Flip { edge, value: values[edge] }, &mut followed);
                    assert!(mesh.flip(edge));
                    values[edge] = value(random.bits() % 4096);
                    flips += 1;
                }
                assert_eq!(log.len(), flips);
                assert!(mesh != before.0 && followed != before.2);
                if round % 2 == 0 {
                    log.undo(&mut mesh, &mut values, &mut followed).unwrap();
                    assert!(mesh == before.0 && values == before.1 && followed == before.2);
                } else {
                    followed.push(NormalCoordinates::new(&mesh));
                    log.clear();
                }
                assert!(log.is_empty());
                mesh.validate().unwrap();
            }
        }
    }

    #[test]
    fn a_log_is_not_undone_on_something_else() {
        let mut mesh = Mesh::from_soup(&shapes::icosphere(1).unwrap()).unwrap();
        let (mut values, mut log) = (PerEdge::filled(mesh.n_edges(), 1.0), FlipLog::default());
        let mut followed = [NormalCoordinates::new(&mesh)];
        log.record(&mesh, Flip { edge: EdgeId(3), value: 1.0 }, &mut followed);
        mesh.flip(EdgeId(3));
        let flipped = mesh.clone();
        assert!(log.undo(&mut mesh, &mut values, &mut []).is_err());
        assert!(log.undo(&mut mesh, &mut PerEdge::filled(2, 1.0), &mut followed).is_err());
        assert!(mesh == flipped && log.len() == 1);
    }
}

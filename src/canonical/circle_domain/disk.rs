//! The Möbius transformation that puts a planar domain into the unit disk.

use super::options::Normalisation;
use crate::error::{Error, Result};
use crate::geometry::Mobius;
use crate::geometry::complex::{Complex, conj, norm};
use crate::geometry::disk_barycentre::disk_barycentre;
use crate::geometry::mobius::PlaneCircle;
use crate::mesh::{PerVertex, VertexId};

/// A planar domain in the unit disk, its outer loop on the unit circle, before it is normalised.
pub(super) struct DomainInDisk<'a> {
    /// Places of the vertices, and of hubs, which have no weight.
    pub points: &'a PerVertex<Complex>,
    /// The area of the given faces at each vertex.
    pub weights: &'a PerVertex<f64>,
    /// The circles of the other loops.
    pub inner: &'a [PlaneCircle],
    /// The vertices of the outer loop, counterclockwise.
    pub rim: &'a [VertexId],
}

impl DomainInDisk<'_> {
    /// The transformation of the disk onto itself that a normalisation names.
    ///
    /// # Errors
    /// [`Error::Argument`] for vertices that are not where the normalisation needs them.
    pub fn normalised(&self, how: &Normalisation) -> Result<Mobius> {
        let centred = match how {
            Normalisation::Three(vertices, angles) => return self.three(*vertices, *angles),
            Normalisation::Vertex(v) if self.rim.contains(v) => {
                return Err(Error::argument("vertex at the centre", v, "one that is not on the outer loop"));
            }
            Normalisation::Vertex(v) => Mobius::to_origin(self.points[*v]),
            Normalisation::Centred => match self.inner {
                [only] => only.to_centre(),
                // If most of the area lies within rounding of one point of the circle, the vertex that was sent to infinity stays at 0.
                _ => disk_barycentre(self.points, self.weights).unwrap_or(Mobius::IDENTITY),
            },
        };
        let first = self.rim.first().map_or([1.0, 0.0], |&v| centred.apply(self.points[v]));
        Ok(Mobius::rotation(conj(first).map(|x| x / norm(first))).after(&centred))
    }

    fn three(&self, vertices: [VertexId; 3], angles: [f64; 3]) -> Result<Mobius> {
        let mut at = [0; 3];
        for (at, v) in at.iter_mut().zip(vertices) {
            let place = self.rim.iter().position(|&w| w == v);
            *at = place.ok_or(Error::argument("vertex of the normalisation", v, "one of the outer loop"))?;
        }
        // Counterclockwise: with the first one at the start the others come in this order.
        let rises = |a: f64, b: f64, c: f64, turn: f64| (b - a).rem_euclid(turn) < (c - a).rem_euclid(turn);
        let [a, b, c] = at.map(|i| i as f64);
        let to = angles;
        let distinct = at[0] != at[1] && at[1] != at[2] && at[2] != at[0];
        let turn = std::f64::consts::TAU;
        if !(distinct && rises(a, b, c, self.rim.len() as f64) && rises(to[0], to[1], to[2], turn)) {
            let value = format!("vertices {vertices:?} at the angles {angles:?}");
            let need = "three different vertices and angles, both counterclockwise around the domain";
            return Err(Error::argument("normalisation", value, need));
        }
        let places = to.map(|angle| [angle.cos(), angle.sin()]);
        let from = vertices.map(|v| self.points[v]);
        Mobius::of_triples(from, places).ok_or(Error::argument(
            "normalisation",
            format!("vertices {vertices:?}"),
            "three different places on the circle",
        ))
    }
}

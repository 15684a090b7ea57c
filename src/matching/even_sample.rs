//! Vertices of a surface that lie evenly, and how remote each vertex is by its distances from them.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{norm, triangle_normal};
use crate::mesh::{PerEdge, PerVertex, Point, VertexId};
use crate::metric::Surface;
use crate::topology::OutgoingEdges;

/// Vertices of a surface that lie evenly. Lengths are those of the surface scaled to the area 1, along edges.
pub(super) struct EvenSample<'a> {
    pub surface: &'a Surface,
    /// Positions of the vertices.
    pub points: Vec<Point>,
    /// Per vertex its share of the area.
    pub areas: PerVertex<f64>,
    lengths: PerEdge<f64>,
    /// Vertices, each farthest from those before it.
    pub samples: Vec<VertexId>,
    /// Distances between samples.
    pub distances: Vec<Vec<f64>>,
    /// Per sample the share of the area that is nearer to it than to others.
    pub shares: Vec<f64>,
    /// Per vertex the place of the nearest sample.
    pub nearest: PerVertex<u32>,
    /// Per vertex the mean of its distances from the first [`REMOTE`] samples, over the mean of that by area.
    pub remoteness: PerVertex<f64>,
    /// Per one of these samples the share of the area that is nearer to it than to the others of them.
    first_shares: Vec<f64>,
}

/// Number of vertices whose distances say how remote others are.
pub(super) const REMOTE: usize = 100;

impl<'a> EvenSample<'a> {
    /// At most so many vertices, from the one that is farthest from vertex 0 on.
    ///
    /// # Errors
    /// [`Error::Argument`] for a surface without positions; [`Error::Cancelled`].
    pub fn new(surface: &'a Surface, count: usize, control: &Control) -> Result<EvenSample<'a>> {
        let mesh = surface.mesh();
        let Some(given) = surface.positions() else {
            return Err(Error::argument("surface", "intrinsic", "one with positions in space"));
        };
        let mut areas: PerVertex<f64> = vec![0.0; mesh.n_vertices()].into();
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f);
            let area = 0.5 * norm(triangle_normal(corners.map(|v| given[v.index()])));
            corners.into_iter().for_each(|v| areas[v] += area / 3.0);
        }
        let total = areas.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        areas.iter_mut().for_each(|area| *area /= total);
        let unit = total.sqrt();
        let mut sample = EvenSample {
            surface,
            points: given.iter().map(|p| p.map(|x| x / unit)).collect(),
            lengths: surface.lengths().iter().map(|l| l / unit).collect::<Vec<_>>().into(),
            samples: Vec::new(),
            distances: Vec::new(),
            shares: Vec::new(),
            nearest: vec![0; mesh.n_vertices()].into(),
            remoteness: vec![0.0; mesh.n_vertices()].into(),
            first_shares: Vec::new(),
            areas,
        };
        sample.choose(count.min(mesh.n_vertices()), control)?;
        Ok(sample)
    }

    fn choose(&mut self, count: usize, control: &Control) -> Result<()> {
        let mesh = self.surface.mesh();
        let outgoing = OutgoingEdges::new(mesh, &self.lengths)?;
        let farthest = |distance: &PerVertex<f64>| {
            mesh.vertices().fold(VertexId(0), |far, v| if distance[v] > distance[far] { v } else { far })
        };
        let mut next = farthest(&outgoing.shortest_paths(&[VertexId(0)], control)?.distance);
        let mut least: PerVertex<f64> = vec![f64::INFINITY; mesh.n_vertices()].into();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for k in 0..count {
            let distance = outgoing.shortest_paths(&[next], control)?.distance;
            if k == REMOTE {
                self.first_shares = self.shares_of(k);
            }
            for v in mesh.vertices() {
                if k < REMOTE {
                    self.remoteness[v] += distance[v];
                }
                if distance[v] < least[v] {
                    (least[v], self.nearest[v]) = (distance[v], k as u32);
                }
            }
            // Distances from the samples before this one are known already.
            let own: Vec<f64> = self.samples.iter().map(|&v| distance[v]).collect();
            rows.iter_mut().zip(&own).for_each(|(row, d)| row.push(*d));
            rows.push(own.into_iter().chain([0.0]).collect());
            self.samples.push(next);
            next = farthest(&least);
        }
        self.distances = rows;
        self.shares = self.shares_of(count);
        if count <= REMOTE {
            self.first_shares = self.shares.clone();
        }
        let mean: f64 = self.remoteness.iter().zip(self.areas.iter()).map(|(r, a)| r * a).sum();
        self.remoteness.iter_mut().for_each(|r| *r /= mean.max(f64::MIN_POSITIVE));
        Ok(())
    }

    /// Per sample of so many the share of the area that is nearest to it.
    fn shares_of(&self, count: usize) -> Vec<f64> {
        let mut shares = vec![0.0; count];
        self.surface.mesh().vertices().for_each(|v| shares[self.nearest[v] as usize] += self.areas[v]);
        shares
    }

    /// The mean difference of how remote two points are that are chosen blindly, by area, on this surface.
    pub fn spread(&self) -> f64 {
        self.blind_difference(self)
    }

    /// The mean difference of how remote two points are that are chosen blindly, by area, one on each surface.
    pub fn blind_difference(&self, other: &EvenSample<'_>) -> f64 {
        let of = |even: &EvenSample<'_>| -> Vec<(f64, f64)> {
            even.samples
                .iter()
                .zip(&even.first_shares)
                .map(|(&v, &share)| (even.remoteness[v], share))
                .collect()
        };
        let to = of(other);
        of(self).iter().map(|(a, s)| s * to.iter().map(|(b, t)| t * (a - b).abs()).sum::<f64>()).sum()
    }

    /// Distances from a vertex to all.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn distances_from(&self, v: VertexId, control: &Control) -> Result<PerVertex<f64>> {
        let outgoing = OutgoingEdges::new(self.surface.mesh(), &self.lengths)?;
        Ok(outgoing.shortest_paths(&[v], control)?.distance)
    }
}

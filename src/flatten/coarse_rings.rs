//! The neighbours of the vertices of a triangulated sphere, from which vertices are taken away and to which they come back.

use crate::geometry::vector::{Vector, normalised};
use crate::mesh::Mesh;

/// Vertices of up to so many neighbours are taken away; there are always some of at most five.
const MOST_NEIGHBOURS: usize = 6;

/// Per vertex its neighbours, counterclockwise; none of a vertex that is away.
pub(super) struct NeighbourRings {
    rings: Vec<Vec<u32>>,
}

/// A vertex that was pulled into a neighbour.
pub(super) struct TakenVertex {
    pub vertex: u32,
    /// Its neighbours, counterclockwise, first that one, which has edges to all others in its place.
    pub ring: Vec<u32>,
}

impl NeighbourRings {
    /// The rings of a closed surface; `None` where two edges have the same ends or an edge has one.
    pub fn new(mesh: &Mesh) -> Option<NeighbourRings> {
        let mut rings = Vec::with_capacity(mesh.n_vertices());
        for v in mesh.vertices() {
            let first = mesh.outgoing(v).next()?;
            let (mut ring, mut h) = (Vec::new(), first);
            loop {
                ring.push(mesh.tip(h).0);
                h = mesh.prev(h).twin();
                if h == first {
                    break;
                }
            }
            let mut sorted = ring.clone();
            sorted.sort_unstable();
            sorted.dedup();
            if ring.len() < 3 || sorted.len() < ring.len() || sorted.binary_search(&v.0).is_ok() {
                return None;
            }
            rings.push(ring);
        }
        (rings.len() >= 4).then_some(NeighbourRings { rings })
    }

    /// Takes vertices away until four are left.
    pub fn coarsened(&mut self) -> Vec<TakenVertex> {
        let mut taken = Vec::new();
        let mut present: Vec<u32> = (0..self.rings.len() as u32).collect();
        while present.len() > 4 {
            let mut left = present.len();
            // Of vertices that are neighbours one stays in each round, so that gaps do not grow into each other.
            let mut stays = vec![false; self.rings.len()];
            for &v in &present {
                if left > 4 && !stays[v as usize] && self.rings[v as usize].len() <= MOST_NEIGHBOURS {
                    let vertex = self.take(v);
                    vertex.ring.iter().for_each(|&r| stays[r as usize] = true);
                    taken.push(vertex);
                    left -= 1;
                }
            }
            if left == present.len() {
                break;
            }
            present.retain(|&v| !self.rings[v as usize].is_empty());
        }
        taken
    }

    /// Pulls a vertex into the neighbour with the fewest edges of those that have no edge yet to another one but the two beside it. Sides of
    /// the gap that are joined outside of it lie around others, so that there is such a neighbour.
    fn take(&mut self, v: u32) -> TakenVertex {
        let ring = std::mem::take(&mut self.rings[v as usize]);
        let n = ring.len();
        let is_free = |&i: &usize| {
            let others = (2..n.saturating_sub(1)).map(|j| ring[(i + j) % n]);
            let own = &self.rings[ring[i] as usize];
            others.into_iter().all(|r| !own.contains(&r))
        };
        let free = (0..n).filter(is_free).min_by_key(|&i| (self.rings[ring[i] as usize].len(), ring[i]));
        let mut ring = ring;
        ring.rotate_left(free.unwrap_or(0));
        let taken = TakenVertex { vertex: v, ring };
        self.remove(&taken);
        taken
    }

    fn position(&self, of: u32, at: u32) -> usize {
        self.rings[at as usize].iter().position(|&w| w == of).unwrap_or(0)
    }

    fn remove(&mut self, TakenVertex { vertex, ring }: &TakenVertex) {
        let (n, into) = (ring.len(), ring[0]);
        let at = self.position(*vertex, into);
        self.rings[into as usize].splice(at..=at, ring[2..n - 1].iter().copied());
        for (k, &r) in ring.iter().enumerate().skip(1) {
            let at = self.position(*vertex, r);
            if k == 1 || k == n - 1 {
                self.rings[r as usize].remove(at);
            } else {
                self.rings[r as usize][at] = into;
            }
        }
    }

    /// Undoes the last removal that was not undone.
    pub fn put_back(&mut self, TakenVertex { vertex, ring }: &TakenVertex) {
        let (n, into) = (ring.len(), ring[0]);
        // The ring of the neighbour can start anywhere between those that come out.
        let at = self.position(ring[1], into);
        let own = &mut self.rings[into as usize];
        own.rotate_left(at);
        own.splice(1..n - 2, [*vertex]);
        for (k, &r) in ring.iter().enumerate().skip(1) {
            let at = self.position(into, r);
            match k {
                1 => self.rings[r as usize].insert(at, *vertex),
                _ if k == n - 1 => self.rings[r as usize].insert(at + 1, *vertex),
                _ => self.rings[r as usize][at] = *vertex,
            }
        }
        self.rings[*vertex as usize].clone_from(ring);
    }

    /// Puts the four vertices that are left at the corners of a regular tetrahedron.
    pub fn place_tetrahedron(&self, points: &mut [Vector]) {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let Some(first) = self.rings.iter().position(|ring| !ring.is_empty()) else { return };
        let mut four = vec![first as u32];
        four.extend(&self.rings[first]);
        four.iter().zip(corners).for_each(|(&v, at)| points[v as usize] = normalised(at));
    }

    /// The vertices that are there, and the faces with their numbers among these.
    pub fn triangles(&self) -> (Vec<u32>, Vec<[u32; 3]>) {
        let vertices: Vec<u32> =
            (0..).zip(&self.rings).filter(|(_, ring)| !ring.is_empty()).map(|(v, _)| v).collect();
        let mut number = vec![0; self.rings.len()];
        (0..).zip(&vertices).for_each(|(k, &v)| number[v as usize] = k);
        let mut faces = Vec::with_capacity(2 * vertices.len());
        for &v in &vertices {
            let ring = &self.rings[v as usize];
            for (k, &a) in ring.iter().enumerate() {
                let b = ring[(k + 1) % ring.len()];
                if v < a && v < b {
                    faces.push([v, a, b].map(|w| number[w as usize]));
                }
            }
        }
        (vertices, faces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn vertices_that_come_back_leave_the_triangles_as_they_were() {
        let ball = shapes::ellipsoid([1.0; 3], 5).unwrap();
        let mesh = Mesh::from_faces(ball.positions.len(), &ball.faces).unwrap();
        let sorted = |mut faces: Vec<[u32; 3]>| {
            let least = |f: &[u32; 3]| (0..3).fold(0, |k, i| if f[i] < f[k] { i } else { k });
            for face in &mut faces {
                let first = least(face);
                face.rotate_left(first);
            }
            faces.sort_unstable();
            faces
        };
        let mut rings = NeighbourRings::new(&mesh).unwrap();
        let taken = rings.coarsened();
        assert_eq!(taken.len() + 4, mesh.n_vertices());
        let (vertices, faces) = rings.triangles();
        assert_eq!([vertices.len(), faces.len()], [4, 4]);
        for (k, vertex) in taken.iter().rev().enumerate() {
            rings.put_back(vertex);
            let (vertices, faces) = rings.triangles();
            assert_eq!([vertices.len(), faces.len()], [k + 5, 2 * k + 6]);
        }
        assert_eq!(sorted(rings.triangles().1), sorted(mesh.triangles()));
    }
}

//! A map to the sphere that turns no triangle over, whatever the surface: of the sphere's triangulation alone, from coarse to fine.
//!
//! Vertices are taken away one after the other, each by pulling it into a neighbour, until four are left, which lie on the sphere as a
//! tetrahedron. They come back in the reverse order, each to where it sees all sides of the gap that it left [PH03]. Now and then the map is
//! spread, as evenly as the triangulation lets it, so that the gaps stay wide.

use super::coarse_rings::NeighbourRings;
use super::descent::MapDescent;
use super::descent_matrix::DescentMatrix;
use super::energy::EnergyShares;
use super::rest_triangle::RestTriangle;
use super::sphere_moves::SphereMoves;
use super::sphere_triangle::SoftDet;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::predicates::winding;
use crate::geometry::vector::{Vector, add, cross, dot, norm, normalised, scale, sub};
use crate::mesh::Mesh;
use std::cmp::Ordering;
use std::f64::consts::PI;

/// The factor by which the number of vertices grows from one spreading to the next.
const GROWTH: f64 = 1.5;
/// Newton steps of a spreading, and the decrement at which it ends.
const MOST_SPREADING: usize = 30;
const SPREAD: f64 = 0.05;
/// Most halvings of the way from the vertex that a gap is seen from.
const MOST_HALVINGS: usize = 60;
/// Steps towards the middle of a gap.
const MIDDLE_STEPS: usize = 40;

/// Places of the vertices of a sphere on the unit sphere that turn no triangle over, by exact arithmetic; `None` where two edges have the
/// same ends, or doubles do not suffice.
///
/// # Errors
/// Those of [`DescentMatrix::new`]; [`crate::Error::Cancelled`].
pub(super) fn coarse_to_fine(mesh: &Mesh, control: &Control) -> Result<Option<Vec<Vector>>> {
    let Some(mut rings) = NeighbourRings::new(mesh) else { return Ok(None) };
    let taken = rings.coarsened();
    let mut points = vec![[0.0; 3]; mesh.n_vertices()];
    rings.place_tetrahedron(&mut points);
    let (mut present, mut spread_at) = (4, 8.0);
    for (k, vertex) in taken.iter().rev().enumerate() {
        let Some(place) = place_in_gap(&vertex.ring, &points) else { return Ok(None) };
        points[vertex.vertex as usize] = place;
        rings.put_back(vertex);
        present += 1;
        let is_last = k + 1 == taken.len();
        if is_last || present as f64 >= spread_at {
            let share = present as f64 / mesh.n_vertices() as f64;
            spread(&rings, &mut points, &control.part(share / GROWTH, share))?;
            spread_at = GROWTH * present as f64;
        }
    }
    Ok(Some(points))
}

/// A point that sees every side of a gap; the first corner of the gap sees all of them.
fn place_in_gap(ring: &[u32], points: &[Vector]) -> Option<Vector> {
    let corners: Vec<Vector> = ring.iter().map(|&v| points[v as usize]).collect();
    let n = corners.len();
    let normals: Vec<Vector> =
        (0..n).map(|k| normalised(cross(corners[k], sub(corners[(k + 1) % n], corners[k])))).collect();
    let sees_all =
        |x: Vector| (0..n).all(|k| winding(x, corners[k], corners[(k + 1) % n]) == Ordering::Greater);
    // Between the two sides at the first corner, as near to it as is needed.
    let inward = normalised(add(normals[0], normals[n - 1]));
    let span = norm(sub(corners[1], corners[0])).min(norm(sub(corners[n - 1], corners[0])));
    let near = |k: i32| normalised(add(corners[0], scale(span * f64::powi(0.5, k), inward)));
    let mut place = (1..MOST_HALVINGS as i32).map(near).find(|&x| sees_all(x))?;
    // Away from the side that is nearest, as long as that is less near then.
    let least = |x: Vector| {
        let height = |k: &usize| dot(normals[*k], x);
        (0..n).min_by(|a, b| height(a).total_cmp(&height(b))).map(|k| (k, height(&k)))
    };
    let mut step = span;
    for _ in 0..MIDDLE_STEPS {
        let (nearest, height) = least(place)?;
        let moved = normalised(add(place, scale(step, normals[nearest])));
        if least(moved)?.1 > height && sees_all(moved) {
            place = moved;
        } else {
            step *= 0.5;
        }
    }
    Some(place)
}

/// Spreads the vertices that are there, towards triangles of one size and shape.
fn spread(rings: &NeighbourRings, points: &mut [Vector], control: &Control) -> Result<()> {
    let (vertices, faces) = rings.triangles();
    let mesh = Mesh::from_faces(vertices.len(), &faces)?;
    // The side of a regular triangle whose area is the mean one.
    let side = (4.0 * PI / faces.len() as f64 * 4.0 / 3f64.sqrt()).sqrt();
    let share = 1.0 / faces.len() as f64;
    let Some(regular) = RestTriangle::new([side; 3]) else { return Ok(()) };
    let rest = vec![RestTriangle { share, weight: share, ..regular }; faces.len()];
    let corners = mesh.triangles();
    let shares = EnergyShares { isometric: 1.0, ..EnergyShares::default() };
    let map = SphereMoves { corners: &corners, rest: &rest, shares, soft: SoftDet { softness: 0.0 } };
    let mut system = DescentMatrix::new(&mesh, Vec::new(), None, control)?;
    let places = vertices.iter().map(|&v| points[v as usize]).collect();
    let mut descent = MapDescent::new(map, places);
    descent.run(&mut system, SPREAD, MOST_SPREADING, control)?;
    vertices.iter().zip(descent.points).for_each(|(&v, place)| points[v as usize] = place);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn every_triangulation_of_a_sphere_without_double_edges_has_a_map_that_covers_it_once() {
        let four = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).unwrap();
        let long = shapes::ellipsoid([1.0, 1.0, 9.0], 4).unwrap();
        let many = Mesh::from_faces(long.positions.len(), &long.faces).unwrap();
        for mesh in [four, many] {
            let points = coarse_to_fine(&mesh, &Control::new()).unwrap().unwrap();
            let mut angles = 0.0;
            for [a, b, c] in mesh.triangles().iter().map(|f| f.map(|v| points[v as usize])) {
                assert_eq!(winding(a, b, c), Ordering::Greater);
                let volume = dot(a, cross(sub(b, a), sub(c, a)));
                angles += 2.0 * volume.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
            }
            assert!((angles - 4.0 * PI).abs() < 1e-9, "{angles}");
        }
        // Edges with the same ends bound no triangle on the sphere.
        let (double, _) = shapes::flat_torus([0.0, 1.0], 2, 2).unwrap().build().unwrap();
        assert!(coarse_to_fine(&double, &Control::new()).unwrap().is_none());
    }
}

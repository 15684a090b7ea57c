//! The shape that the boundary of a surface is given: closed geodesics, or straight sides with corners.

use crate::arrays::array;
use crate::choice::choices;
use crate::failure::Outcome;
use ricci::canonical::{Boundary, BoundaryCorner, Corners};
use ricci::mesh::VertexId;

choices!(enum BoundaryKind, KINDS = "boundary", [
    RICCI_BOUNDARY_GEODESIC => Geodesic,
    RICCI_BOUNDARY_STRAIGHT => Straight,
]);

/// The boundary of this kind with `n` corners, given by their vertices and their angles, either of which may be NULL.
pub fn read(kind: u32, corners: *const u32, angles: *const f64, n: usize) -> Outcome<Boundary> {
    if KINDS.choose(kind)? == BoundaryKind::Geodesic {
        return Ok(Boundary::Geodesic);
    }
    if corners.is_null() {
        return Ok(Boundary::Straight(if n == 0 { Corners::Default } else { Corners::Count(n) }));
    }
    let angles: Vec<f64> = if angles.is_null() { vec![0.0; n] } else { array("corner_angles", angles, n)? };
    let corner = |(v, angle): (u32, f64)| BoundaryCorner {
        vertex: VertexId(v),
        angle: Some(angle).filter(|angle| *angle != 0.0),
    };
    let vertices: Vec<u32> = array("corners", corners, n)?;
    Ok(Boundary::Straight(Corners::At(vertices.into_iter().zip(angles).map(corner).collect())))
}

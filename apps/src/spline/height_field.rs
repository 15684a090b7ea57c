//! Meshes that lie over the plane without folds.

use crate::failure::Failure;
use crate::input::Input;
use ricci::geometry::predicates::orientation;
use std::cmp::Ordering;

/// A mesh over the plane.
pub struct HeightField<'a> {
    pub points: &'a [[f64; 3]],
    /// The closed polygons in x and y below its boundary loops.
    pub outline: Vec<Vec<[f64; 2]>>,
}

/// The mesh as a height field.
///
/// # Errors
/// [`Failure::Input`] for a mesh without boundary, and for one whose faces do not all have the same orientation seen from above.
pub fn height_field(input: &Input) -> Result<HeightField<'_>, Failure> {
    let refuse = |why: String| Err(Failure::Input(format!("{}: {why}", input.path.display())));
    let mesh = input.mesh();
    let Some(points) = input.positions() else {
        return refuse("an intrinsic metric has no heights".into());
    };
    if mesh.is_closed() {
        return refuse("a closed surface does not lie over a plane without folds".into());
    }
    let place = |v: ricci::mesh::VertexId| [points[v.index()][0], points[v.index()][1]];
    let turn = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(place);
        orientation(a, b, c)
    };
    let first = mesh.faces().next().map_or(Ordering::Equal, turn);
    if let Some(f) = mesh.faces().find(|&f| turn(f) != first || first == Ordering::Equal) {
        return refuse(format!(
            "face {f} is upright, or turned over against face 0, seen along z: the mesh does not lie over the plane without folds \
             (turn it, or flatten it with ricci flow)"
        ));
    }
    let polygon =
        |around: &Vec<ricci::mesh::HalfedgeId>| around.iter().map(|&h| place(mesh.origin(h))).collect();
    Ok(HeightField { points, outline: mesh.boundary_loops().iter().map(polygon).collect() })
}

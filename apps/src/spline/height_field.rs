//! Meshes that lie over the plane without folds.

use crate::failure::Failure;
use crate::input::Input;
use ricci::geometry::predicates::orientation;
use std::cmp::Ordering;

/// Closed polygons over which a mesh lies: its boundary loops, in x and y. Errors: [`Failure::Input`] for a mesh without boundary, or one
/// whose faces, seen from above, do not all turn the same way.
pub fn outline(input: &Input) -> Result<Vec<Vec<[f64; 2]>>, Failure> {
    let refuse = |why: String| Err(Failure::Input(format!("{}: {why}", input.path.display())));
    let mesh = input.mesh();
    let Some(positions) = input.positions() else {
        return refuse("an intrinsic metric has no heights".into());
    };
    if mesh.is_closed() {
        return refuse("a closed surface does not lie over a plane without folds".into());
    }
    let place = |v: ricci::mesh::VertexId| [positions[v.index()][0], positions[v.index()][1]];
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
    let loops = mesh.boundary_loops();
    Ok(loops.iter().map(|around| around.iter().map(|&h| place(mesh.origin(h))).collect()).collect())
}

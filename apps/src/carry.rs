//! Colours and normals of the input on the mesh that is written with the layout.

use crate::input::Input;
use ricci::mesh::Point;
use ricci::metric::CommonSubdivision;
use std::collections::HashMap;

/// The colours and normals of the written mesh; empty for none.
#[derive(Default)]
pub struct CarriedAttributes {
    pub colors: Vec<[f64; 4]>,
    pub normals: Vec<Point>,
    /// The indices of the normals of the corners, where vertices have more than one.
    pub face_normals: Vec<[u32; 3]>,
}

/// The colours and normals for the input's own mesh or a `subdivision` of it. Values at crossings are interpolated along the input's edge,
/// those at corners in the input's face, so that both look as in the input. Normals are not made unit vectors, which keeps the direction
/// of the interpolated ones.
pub fn carry(input: &Input, subdivision: Option<&CommonSubdivision>) -> ricci::Result<CarriedAttributes> {
    let given = &input.attributes;
    let mut carried = CarriedAttributes::default();
    if let Some(colors) = &given.colors {
        carried.colors = at_vertices(subdivision, colors)?;
    }
    match (&given.corner_normals, &given.normals) {
        (Some(corners), _) => {
            let corners = match subdivision {
                Some(r) => &r.from_corners(0, corners)?,
                None => corners,
            };
            (carried.normals, carried.face_normals) = numbered(corners);
        }
        (None, Some(normals)) => carried.normals = at_vertices(subdivision, normals)?,
        (None, None) => {}
    }
    Ok(carried)
}

fn at_vertices<const N: usize>(
    subdivision: Option<&CommonSubdivision>,
    values: &[[f64; N]],
) -> ricci::Result<Vec<[f64; N]>> {
    subdivision.map_or_else(|| Ok(values.to_vec()), |r| r.from_vertices(0, values))
}

/// The attributes of the input that the written file has no place for.
pub fn left_out(input: &Input) -> Vec<String> {
    let given = &input.attributes;
    let uv = given
        .uv
        .as_ref()
        .map(|_| "texture coordinates of the input: the layout takes their place".to_string());
    uv.into_iter().chain(given.unread.iter().cloned()).collect()
}

/// The different values in order of appearance, and the indices of the corners' values.
fn numbered(corners: &[[Point; 3]]) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (mut values, mut known) = (Vec::new(), HashMap::new());
    let mut number = |value: Point| {
        *known.entry(value.map(f64::to_bits)).or_insert_with(|| {
            values.push(value);
            values.len() as u32 - 1
        })
    };
    let numbers = corners.iter().map(|corners| corners.map(&mut number)).collect();
    (values, numbers)
}

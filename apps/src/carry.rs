//! Colours, normals and names of the input on the mesh that is written with the layout, and what there is no room for.

use crate::failure::Failure;
use crate::input::Input;
use crate::output::{extension, format_of};
use ricci::mesh::Point;
use ricci::mesh::io::FaceLabels;
use ricci::metric::CommonSubdivision;
use std::collections::HashMap;
use std::path::Path;

/// The attributes of the written mesh; empty for none.
#[derive(Default)]
pub struct CarriedAttributes {
    pub colors: Vec<[f64; 4]>,
    pub normals: Vec<Point>,
    /// The indices of the normals of the corners, where vertices have more than one.
    pub face_normals: Vec<[u32; 3]>,
    /// The objects, groups and materials of the faces.
    pub labels: Option<FaceLabels>,
}

/// The colours, normals and names for the input's own mesh or a `subdivision` of it. Values at crossings are interpolated along the input's edge,
/// those at corners in the input's face, so that both look as in the input. Normals are not made unit vectors, which keeps the direction
/// of the interpolated ones.
pub fn carry(input: &Input, subdivision: Option<&CommonSubdivision>) -> ricci::Result<CarriedAttributes> {
    let given = &input.attributes;
    let labels = given.labels.as_ref().map(|labels| match subdivision {
        Some(r) => labels.of_origins(r.faces[0].iter().map(|f| f.0)),
        None => labels.clone(),
    });
    let mut carried = CarriedAttributes { labels, ..CarriedAttributes::default() };
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

/// What the input's file holds and the file with its layout, of this name, has no room for.
pub fn left_out(input: &Input, path: &Path) -> Result<Vec<String>, Failure> {
    let given = &input.attributes;
    let uv = given
        .uv
        .as_ref()
        .map(|_| "texture coordinates of the input: the layout takes their place".to_string());
    let unheld = given.unheld(format_of(path)?);
    let behind = stays_behind(given.labels.as_ref(), &input.path, path);
    Ok(uv.into_iter().chain(unheld).chain(behind).collect())
}

/// The material libraries that a written OBJ file names and that are not in its folder, as they stay beside the input.
pub fn stays_behind(labels: Option<&FaceLabels>, input: &Path, output: &Path) -> Option<String> {
    let libraries = &labels?.libraries;
    let folder = |path: &Path| {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    let elsewhere = extension(output) == "obj" && !libraries.is_empty() && folder(input) != folder(output);
    elsewhere.then(|| {
        format!("{}: the file names it, and it stays in the folder of the input", libraries.join(", "))
    })
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

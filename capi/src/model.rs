//! Models of the hyperbolic plane.

use crate::arrays::{ambient, array, copy_out};
use crate::choice::{choice, choose};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::status::ricci_status;
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use std::mem::MaybeUninit;

/// Coordinates of the hyperbolic plane.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_model {
    /// The unit disk, conformal: (x + i y)/(1 + w).
    RICCI_MODEL_POINCARE = 0,
    /// The unit disk in which geodesics are straight: (x + i y)/w.
    RICCI_MODEL_KLEIN = 1,
    /// The upper half-plane, conformal: (-y + i)/(w - x); the disk's centre is i.
    RICCI_MODEL_HALF_PLANE = 2,
    /// The hyperboloid x^2 + y^2 - w^2 = -1, w > 0, in three coordinates: keeps its digits however far out.
    RICCI_MODEL_HYPERBOLOID = 3,
}

choice!(ricci_model, "model", Model, [
    RICCI_MODEL_POINCARE => Poincare,
    RICCI_MODEL_KLEIN => Klein,
    RICCI_MODEL_HALF_PLANE => HalfPlane,
    RICCI_MODEL_HYPERBOLOID => Hyperboloid,
]);

/// Points of the plane (w = 1), which has one model, or of the hyperboloid, row by row: two coordinates, three for
/// ambient ones.
pub(crate) fn coordinates(space: Space, model: Model, points: &[[f64; 3]]) -> Vec<f64> {
    match (space, model) {
        (_, Model::Hyperboloid) => points.as_flattened().to_vec(),
        (Space::E2, _) => points.iter().flat_map(|&[x, y, _]| [x, y]).collect(),
        _ => plane_points(model, points).into_flattened(),
    }
}

pub(crate) fn plane_points(model: Model, points: &[[f64; 3]]) -> Vec<[f64; 2]> {
    points.iter().map(|&p| model.plane(p)).collect()
}

/// Coordinates of points of the hyperboloid in a model.
///
/// Beyond distance 36 (Poincare) or 18 (Klein) from the origin, coordinates in the disks round to the circle.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a row is not finite, or w < 1).
///
/// @param model        the model.
/// @param points       n_points x 3: x, y, w.
/// @param n_points     number of points.
/// @param coordinates  out: n_points x 2; n_points x 3 for RICCI_MODEL_HYPERBOLOID. May be `points`.
/// @param capacity     entries of `coordinates`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_model_from_hyperboloid(
    model: MaybeUninit<ricci_model>,
    points: *const f64,
    n_points: usize,
    coordinates: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|_| {
        let model = choose(model)?;
        let points = ambient("points", points, n_points)?;
        if let Some(i) = points.iter().position(|p| p[2] < 1.0) {
            let message =
                format!("points: row {i} has w = {}: on the hyperboloid w is at least 1", points[i][2]);
            return Err(Failure::argument(message));
        }
        copy_out("coordinates", &self::coordinates(Space::H2, model, &points), coordinates, capacity)
    })
}

/// Points of the hyperboloid from their coordinates in a model.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a row is no point of the model).
///
/// @param model        the model.
/// @param coordinates  n_points x 2, inside the unit circle or over the real axis; n_points x 3 for RICCI_MODEL_HYPERBOLOID, of which
///                     x and y count.
/// @param n_points     number of points.
/// @param points       out: n_points x 3: x, y, w. May be `coordinates`.
/// @param capacity     entries of `points`, at least 3 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_model_to_hyperboloid(
    model: MaybeUninit<ricci_model>,
    coordinates: *const f64,
    n_points: usize,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|_| {
        let model = choose(model)?;
        let rows: Vec<[f64; 2]> = match model {
            Model::Hyperboloid => {
                let rows: Vec<[f64; 3]> = array("coordinates", coordinates.cast(), n_points)?;
                rows.into_iter().map(|[x, y, _]| [x, y]).collect()
            }
            _ => array("coordinates", coordinates.cast(), n_points)?,
        };
        let lifted = rows.iter().enumerate().map(|(i, &[x, y])| {
            let none =
                || format!("coordinates: row {i}, ({x}, {y}), is no point of the {} model", model.name());
            model.to_hyperboloid([x, y]).ok_or_else(|| Failure::argument(none()))
        });
        copy_out("points", &lifted.collect::<Outcome<Vec<_>>>()?, points, capacity)
    })
}

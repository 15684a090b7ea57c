//! The unit sphere and the plane.

use crate::arrays::{ambient, array, copy_out};
use crate::failure::Failure;
use crate::guard;
use crate::status::ricci_status;
use ricci::geometry::sphere::{lift, project};
use ricci::mesh::Point;

/// Points of the unit sphere in the plane, seen from the south pole: (x + i y)/(1 + w).
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a row is not finite, or w is not between -1 and 1).
///
/// @param points    n_points x 3: x, y, w.
/// @param n_points  number of points.
/// @param plane     out: n_points x 2; infinite for the south pole (0, 0, -1). May be `points`.
/// @param capacity  entries of `plane`, at least 2 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_stereographic_project(
    points: *const f64,
    n_points: usize,
    plane: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|_| {
        let points = ambient("points", points, n_points)?;
        if let Some(i) = points.iter().position(|p| p[2].abs() > 1.0) {
            let w = points[i][2];
            return Err(Failure::argument(format!(
                "points: row {i} has w = {w}: it is not on the unit sphere"
            )));
        }
        let flat: Vec<[f64; 2]> = points.iter().map(|&p| project(p).unwrap_or([f64::INFINITY; 2])).collect();
        copy_out("plane", &flat, plane, capacity)
    })
}

/// Points of the plane on the unit sphere, the inverse of ricci_stereographic_project: 0 goes to (0, 0, 1), infinity to (0, 0, -1).
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a coordinate is NaN).
///
/// @param plane     n_points x 2.
/// @param n_points  number of points.
/// @param points    out: n_points x 3. May be `plane`.
/// @param capacity  entries of `points`, at least 3 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_stereographic_lift(
    plane: *const f64,
    n_points: usize,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|_| {
        let plane: Vec<[f64; 2]> = array("plane", plane.cast(), n_points)?;
        if let Some(i) = plane.iter().position(|p| p.iter().any(|x| x.is_nan())) {
            return Err(Failure::argument(format!("plane: row {i} is not a number")));
        }
        let lifted: Vec<Point> = plane.into_iter().map(lift).collect();
        copy_out("points", &lifted, points, capacity)
    })
}

//! Sample surfaces given by edge lengths alone.

use crate::arrays;
use crate::failure::Outcome;
use crate::guard::{self, output};
use crate::mesh::{Shape, ricci_mesh};
use crate::status::ricci_status;
use num_complex::Complex64;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::mesh::shapes::{self, Intrinsic};
use std::sync::Arc;

fn intrinsic(mesh: *mut *mut ricci_mesh, make: impl FnOnce() -> ricci::Result<Intrinsic>) -> Outcome {
    let mesh = output("mesh", mesh)?;
    let surface = make()?;
    let (connectivity, lengths) = surface.build()?;
    mesh.hand_over(ricci_mesh::new(
        Arc::new(connectivity),
        Shape::Lengths(Arc::new(lengths), surface.geometry),
    ));
    Ok(())
}

/// The flat torus with periods 1 and tau. n m vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param re    real part of tau.
/// @param im    imaginary part of tau, positive.
/// @param n     parallelograms along 1, at least 1.
/// @param m     parallelograms along tau, at least 1.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_flat_torus(
    re: f64,
    im: f64,
    n: usize,
    m: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || shapes::flat_torus([re, im], n, m)))
}

/// The Bolza surface: a regular hyperbolic octagon with opposite sides glued; curvature 0.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param level  times that every triangle is cut into four.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_bolza(level: usize, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || shapes::bolza(level)))
}

/// A regular polygon with sides a1 b1 a1^-1 b1^-1 ... glued, cut by diagonals: one vertex; curvature 0.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param genus  at least 1 (1: the flat square torus).
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_one_vertex(genus: usize, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || shapes::one_vertex(genus)))
}

/// The polygon of ricci_shape_one_vertex, cut from its centre: two vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param genus  at least 1.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_two_vertex(genus: usize, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || shapes::two_vertex(genus)))
}

/// Two equilateral triangles glued along their sides: a sphere of three cones.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_two_triangles(mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || Ok(shapes::two_triangle_sphere())))
}

/// The hyperbolic pair of pants with geodesic boundaries of given lengths; curvature 0, also on the boundary.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_TRIANGLE_INEQUALITY (triangles too thin for doubles).
///
/// @param l1     length of the first boundary, 1e-6 to 200.
/// @param l2     of the second.
/// @param l3     of the third.
/// @param level  times that every triangle is cut into four.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_pants(
    l1: f64,
    l2: f64,
    l3: f64,
    level: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| intrinsic(mesh, || shapes::pants([l1, l2, l3], level)))
}

fn branch_points(points: *const f64, n_points: usize) -> Outcome<Vec<Complex64>> {
    let points: Vec<[f64; 2]> = arrays::array("points", points.cast(), n_points)?;
    Ok(points.into_iter().map(|[re, im]| Complex64::new(re, im)).collect())
}

/// The curve y^2 = (x - e_1) (x - e_2) ... as the double cover of the round sphere branched over the points e_j:
/// spherical edge lengths, angle 4 pi over the points. Vertex j lies over e_j.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param points    n_points x 2: real and imaginary parts of the finite branch points, all different.
/// @param n_points  2 g + 1 (infinity is one more) or 2 g + 2, at least 3.
/// @param n         frequency of the sphere below; 40 n^2 faces.
/// @param mesh      out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_hyperelliptic(
    points: *const f64,
    n_points: usize,
    n: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| {
        let points = branch_points(points, n_points)?;
        intrinsic(mesh, || shapes::hyperelliptic(&points, n))
    })
}

/// The period matrix of that curve, with respect to some symplectic basis of cycles.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
///
/// @param points    n_points x 2: real and imaginary parts of the finite branch points, all different.
/// @param n_points  2 g + 1 (infinity is one more) or 2 g + 2, at least 3.
/// @param periods   out: g x g x 2, real and imaginary parts of the symmetric matrix.
/// @param capacity  entries of `periods`, at least 2 g^2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_hyperelliptic_periods(
    points: *const f64,
    n_points: usize,
    periods: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|_| {
        let tau = period_matrix(&branch_points(points, n_points)?)?;
        let entries: Vec<f64> = tau.iter().flatten().flat_map(|z| [z.re, z.im]).collect();
        arrays::copy_out("periods", &entries, periods, capacity)
    })
}

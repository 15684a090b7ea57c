//! Sample surfaces in space, and what can be done to a surface in space.

use crate::arrays;
use crate::choice::{choice, choose};
use crate::failure::Outcome;
use crate::guard::{self, output};
use crate::mesh::ricci_mesh;
use crate::status::ricci_status;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, Sliver, TorusKnot};
use std::mem::MaybeUninit;

fn in_space(mesh: *mut *mut ricci_mesh, make: impl FnOnce() -> ricci::Result<Soup>) -> Outcome {
    let mesh = output("mesh", mesh)?;
    mesh.hand_over(ricci_mesh::from_soup(make()?)?);
    Ok(())
}

/// The unit sphere: an icosahedron with each edge cut into n. 10 n^2 + 2 vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param n     at least 1.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_sphere(n: usize, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::icosphere(n)))
}

/// An ellipsoid: the sphere scaled along x, y, z.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param a     half axis along x.
/// @param b     half axis along y.
/// @param c     half axis along z.
/// @param n     as for ricci_shape_sphere.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_ellipsoid(
    a: f64,
    b: f64,
    c: f64,
    n: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::ellipsoid([a, b, c], n)))
}

/// The unit disk in the plane z = 0: a centre and n rings. 3 n (n + 1) + 1 vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param n     at least 1.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_disk(n: usize, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::disk(n)))
}

/// A plane ring, radii in geometric progression. (n + 1) m vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param inner  inner radius.
/// @param outer  outer radius, larger.
/// @param n      steps from inside to outside, at least 1.
/// @param m      vertices around, at least 3.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_annulus(
    inner: f64,
    outer: f64,
    n: usize,
    m: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::annulus(inner, outer, n, m)))
}

/// A torus of revolution about z. n m vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param big    radius of the centre circle.
/// @param small  radius of the tube, smaller.
/// @param n      vertices around the axis, at least 3.
/// @param m      vertices around the tube, at least 3.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_torus(
    big: f64,
    small: f64,
    n: usize,
    m: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::torus(big, small, n, m)))
}

/// A smooth closed surface of any genus: handles in a row, the first hole `ratio` times as wide as the last.
/// 8 (5 genus + 1) n^2 + 2 - 2 genus vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param genus  number of handles, at least 1.
/// @param n      layers over a quarter of the tube, at least 1.
/// @param ratio  1 for equal handles; larger ones have a limit, which the message names.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_genus(
    genus: usize,
    n: usize,
    ratio: f64,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| in_space(mesh, || shapes::tapered_genus(genus, n, ratio)))
}

/// A knotted torus: a tube around the curve that goes p times around the axis and q times around the tube of a
/// torus of revolution. n m vertices.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT.
///
/// @param p      times around the axis; coprime with q.
/// @param q      times around the tube.
/// @param big    radius of that torus's centre circle.
/// @param small  radius of its tube, smaller.
/// @param tube   radius of the tube around the curve; where it would meet itself is an error.
/// @param n      cross-sections, at least 3.
/// @param m      vertices around the tube, at least 3.
/// @param mesh   out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_shape_knot(
    p: u32,
    q: u32,
    big: f64,
    small: f64,
    tube: f64,
    n: usize,
    m: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|_| in_space(mesh, || TorusKnot { p, q, big, small }.torus(tube, n, m)))
}

/// Which bad triangles.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_sliver {
    /// A vertex near the middle of a side: one angle near pi.
    RICCI_SLIVER_CAP = 0,
    /// A vertex near a corner: a short edge.
    RICCI_SLIVER_NEEDLE = 1,
}

choice!(ricci_sliver, "sliver", Sliver, [
    RICCI_SLIVER_CAP => Cap,
    RICCI_SLIVER_NEEDLE => Needle,
]);

/// A changed copy of a surface in space.
fn changed(
    mesh: *const ricci_mesh,
    result: *mut *mut ricci_mesh,
    change: impl FnOnce(&mut Soup) -> Outcome,
) -> ricci_status {
    guard::make("result", result, |door| {
        let mesh = door.shared(mesh)?;
        let mut soup = Soup::new(mesh.positions()?.to_vec(), mesh.connectivity.triangles());
        change(&mut soup)?;
        ricci_mesh::from_soup(soup)
    })
}

/// Cut round holes out of a surface, as far from each other and from the boundary as its vertices allow. Vertices and
/// faces keep their order, those cut out are dropped.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (also: the mesh is intrinsic).
///
/// @param mesh    the surface.
/// @param count   number of holes; no room for one is an error.
/// @param result  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_punch(
    mesh: *const ricci_mesh,
    count: usize,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    changed(mesh, result, |soup| {
        *soup = shapes::punch(soup, count)?;
        Ok(())
    })
}

/// Halve the edges around a vertex, then those of the smaller triangles around it, and so on. The new vertices come
/// last; the surface keeps its shape.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (also: the mesh is intrinsic).
///
/// @param mesh    the surface.
/// @param vertex  the vertex.
/// @param levels  number of times, at most 100.
/// @param result  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_grade(
    mesh: *const ricci_mesh,
    vertex: u32,
    levels: usize,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    changed(mesh, result, |soup| Ok(shapes::grade(soup, vertex, levels)?))
}

/// Cut faces into three by a vertex that leaves one of them with a small angle. The new vertices come last; the surface
/// keeps its shape.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (also: the mesh is intrinsic).
///
/// @param mesh    the surface.
/// @param kind    which slivers.
/// @param count   number of faces to cut, at most n_faces.
/// @param angle   their smallest angle, radians, 1e-7 to 0.1.
/// @param seed    chooses the faces.
/// @param result  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_slivers(
    mesh: *const ricci_mesh,
    kind: MaybeUninit<ricci_sliver>,
    count: usize,
    angle: f64,
    seed: u64,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    changed(mesh, result, |soup| {
        let kind = choose(kind)?;
        Ok(shapes::slivers(soup, kind, count, angle, seed)?)
    })
}

/// Move every vertex by up to a fraction of the mean edge length in each coordinate.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (also: the mesh is intrinsic).
///
/// @param mesh       the surface.
/// @param amplitude  the fraction, 0 to 1000.
/// @param seed       the same seed gives the same noise on every machine.
/// @param result     out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_noise(
    mesh: *const ricci_mesh,
    amplitude: f64,
    seed: u64,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    changed(mesh, result, |soup| Ok(shapes::noise(soup, amplitude, seed)?))
}

/// Map a surface by the inversion in a sphere, a conformal map; faces keep their outside.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (also: the mesh is intrinsic).
///
/// @param mesh    the surface.
/// @param centre  3 entries: the centre of the sphere, away from every vertex.
/// @param radius  its radius.
/// @param result  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_invert(
    mesh: *const ricci_mesh,
    centre: *const f64,
    radius: f64,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    changed(mesh, result, |soup| {
        let centre: Vec<[f64; 3]> = arrays::array("centre", centre.cast(), 1)?;
        Ok(shapes::invert(soup, centre[0], radius)?)
    })
}

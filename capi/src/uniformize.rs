//! Uniformization: one call for every closed surface.

use crate::control::{self, ricci_control};
use crate::guard::{self, output};
use crate::mesh::ricci_mesh;
use crate::quotient::ricci_quotient;
use crate::sphere::ricci_sphere;
use crate::status::ricci_status;
use crate::uniformize_options::{read_options, ricci_uniformize_options};
use ricci::canonical::{Uniformization, uniformize};

/// The metric of constant curvature in the conformal class of a closed surface: on the sphere, or as a quotient of the plane or the
/// hyperbolic plane, by its Euler characteristic.
///
/// Of the options a sphere takes base, tolerance, steps and threads; its scheme is RICCI_SCHEME_YAMABE. Deterministic.
/// @return as ricci_sphere_new and ricci_quotient_new; RICCI_LAYOUT for a surface with boundary.
///
/// @param mesh      the mesh; lengths are measured in space, or those of an intrinsic mesh.
/// @param options   how; NULL for the defaults.
/// @param control   progress and cancellation; NULL for neither.
/// @param sphere    out: for genus 0 the new handle, to be released by ricci_sphere_free; else NULL.
/// @param quotient  out: for genus 1 and more the new handle, to be released by ricci_quotient_free; else NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniformize(
    mesh: *const ricci_mesh,
    options: *const ricci_uniformize_options,
    control: *const ricci_control,
    sphere: *mut *mut ricci_sphere,
    quotient: *mut *mut ricci_quotient,
) -> ricci_status {
    guard::call(|door| {
        let (sphere, quotient) = (output("sphere", sphere)?, output("quotient", quotient)?);
        let mesh = door.shared(mesh)?;
        let (options, control) = (read_options(options)?, control::of(control));
        match uniformize(&mesh.surface()?, &options, &control)? {
            Uniformization::Sphere(found) => {
                sphere.hand_over(ricci_sphere::new(*found));
                quotient.set(std::ptr::null_mut());
            }
            Uniformization::Quotient(found) => {
                quotient.hand_over(ricci_quotient::new(*found));
                sphere.set(std::ptr::null_mut());
            }
        }
        Ok(())
    })
}

//! For tests of a host's error handling.
use crate::guard;
use crate::mesh::ricci_mesh;
use crate::status::ricci_status;
use ricci::parallel::Pool;

/// For tests: an internal error inside the library, on one of its threads, while it uses this mesh.
///
/// @return RICCI_PANIC, and RICCI_POISONED from every later call on the mesh; RICCI_NULL_POINTER.
///
/// @param mesh  the mesh that is poisoned.
#[unsafe(no_mangle)]
#[allow(clippy::panic)]
pub unsafe extern "C" fn ricci_debug_panic(mesh: *mut ricci_mesh) -> ricci_status {
    guard::call(|door| {
        let mesh = door.exclusive(mesh)?;
        let faces = mesh.connectivity.n_faces();
        Pool::new(2)?.run(|| panic!("ricci_debug_panic was called on a mesh of {faces} faces"))
    })
}

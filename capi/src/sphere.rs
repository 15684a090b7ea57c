//! The points and the polyhedron of a uniformized sphere.

use crate::arrays::copy_out;
use crate::control::{self, ricci_control};
use crate::failure::Failure;
use crate::guard::{self, shared};
use crate::layout::MODELS;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::{ON, Triangulation};
use crate::status::*;
use crate::uniformize::{CanonicalShape, ricci_uniform};
use ricci::geometry::Model;
use std::sync::Arc;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_points(
    uniform: *const ricci_uniform,
    model: u32,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let positions = uniform.sphere_positions()?;
        match (MODELS.choose(model)?, &uniform.shape) {
            (Model::Hyperboloid, _) => copy_out("points", positions, points, capacity),
            (_, CanonicalShape::Sphere(sphere)) => copy_out("points", &sphere.plane, points, capacity),
            _ => Err(Failure::new(RICCI_LAYOUT, "no plane lies under this sphere: take RICCI_MODEL_AMBIENT")),
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_mesh(
    uniform: *const ricci_uniform,
    on: u32,
    control: *const ricci_control,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let uniform = shared(uniform)?;
        let (positions, state) = (uniform.sphere_positions()?, &uniform.metric.0);
        let on = ON.choose(on)?;
        let _reserve = memory::work(positions.len(), memory::LAYOUT)?;
        let own = || ricci_mesh::in_space(state.solution.mesh().clone(), Arc::new(positions.to_vec()));
        if on == Triangulation::Input {
            return Err(Failure::new(
                RICCI_LAYOUT,
                "the polyhedron has the metric's faces: take RICCI_ON_METRIC",
            ));
        }
        Ok(
            match state
                .subdivision_if_flipped(&control::of(control)?)?
                .filter(|_| on == Triangulation::Subdivision)
            {
                Some(subdivision) => {
                    // A combination of the ends of an edge, as vectors, has the direction of its point on the arc between them.
                    let mut points = subdivision.from_vertices(1, positions)?;
                    for p in points.iter_mut().skip(subdivision.n_vertices[0]) {
                        let norm = p[0].hypot(p[1]).hypot(p[2]);
                        *p = p.map(|x| x / norm);
                    }
                    ricci_mesh::in_space(Arc::new(subdivision.mesh.clone()), Arc::new(points))
                }
                None => own(),
            },
        )
    })
}

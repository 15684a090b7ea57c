//! Harmonic maps to the plane, to space and to the sphere.

use crate::arrays::{array, copy_out, room};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Control;
use ricci::harmonic::{Domain, Prescribed, SphereMapOptions, harmonic_map, planar, sphere_map};
use ricci::mesh::VertexId;

#[derive(Clone, Copy, PartialEq)]
enum Target {
    Disk,
    Rectangle,
    Sphere,
    Values,
}

choices!(TARGETS: Target = "target of a harmonic map", [
    RICCI_HARMONIC_DISK => Target::Disk,
    RICCI_HARMONIC_RECTANGLE => Target::Rectangle,
    RICCI_HARMONIC_SPHERE => Target::Sphere,
    RICCI_HARMONIC_VALUES => Target::Values,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_harmonic_spec {
    pub size: usize,
    pub vertices: *const u32,
    pub values: *const f64,
    pub n: usize,
    pub target: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_harmonic_spec, "spec");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_harmonic(
    mesh: *const ricci_mesh,
    spec: *const ricci_harmonic_spec,
    control: *const ricci_control,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let (spec, control) = (structs::read(spec)?, control::of(control));
        let target = TARGETS.choose(spec.target)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let domain = Domain::new(mesh.surface()?, &control)?;
        let place = |p: [f64; 2]| [p[0], p[1], 0.0];
        let found: Vec<[f64; 3]> = match target {
            Target::Sphere => sphere_map(&domain, &SphereMapOptions::default(), &control)?.points,
            Target::Disk => planar::to_disk(&domain, &control)?.points.into_iter().map(place).collect(),
            Target::Rectangle => {
                let map = planar::to_rectangle(&domain, corners(&spec)?, &control)?.0;
                map.points.into_iter().map(place).collect()
            }
            Target::Values => given(&domain, &spec, &control)?,
        };
        copy_out("points", &found, points, capacity)
    })
}

fn vertices(spec: &ricci_harmonic_spec) -> Outcome<Vec<VertexId>> {
    Ok(array("vertices", spec.vertices, spec.n)?.into_iter().map(VertexId).collect())
}

fn corners(spec: &ricci_harmonic_spec) -> Outcome<Option<[VertexId; 4]>> {
    if spec.n == 0 {
        return Ok(None);
    }
    let need = |_| Failure::argument(format!("{} corners: a rectangle has four", spec.n));
    vertices(spec)?.try_into().map(Some).map_err(need)
}

fn given(domain: &Domain, spec: &ricci_harmonic_spec, control: &Control) -> Outcome<Vec<[f64; 3]>> {
    let places: Vec<[f64; 3]> = array("values", spec.values.cast(), spec.n)?;
    let mut values = room("values", spec.n)?;
    values.extend(vertices(spec)?.into_iter().zip(places));
    Ok(harmonic_map(domain, &Prescribed { values, flux: None }, control)?.points)
}

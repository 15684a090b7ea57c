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
use ricci::harmonic::{
    Domain, HarmonicMap, MapConstraints, SphereMapOptions, harmonic_map, planar, simple_domain, sphere_map,
};
use ricci::mesh::VertexId;

choices!(enum HarmonicTarget, TARGETS = "target of a harmonic map", [
    RICCI_HARMONIC_DISK => Disk,
    RICCI_HARMONIC_RECTANGLE => Rectangle,
    RICCI_HARMONIC_SPHERE => Sphere,
    RICCI_HARMONIC_VALUES => Values,
    RICCI_HARMONIC_POLYGON => Polygon,
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
        let surface = mesh.surface()?;
        let found: Vec<[f64; 3]> = match target {
            HarmonicTarget::Sphere => {
                let domain = Domain::new(surface, &control)?;
                sphere_map(&domain, &SphereMapOptions::default(), &control)?.points
            }
            HarmonicTarget::Values => given(&Domain::new(surface, &control)?, &spec, &control)?,
            HarmonicTarget::Disk | HarmonicTarget::Polygon | HarmonicTarget::Rectangle => {
                let (_, domain) = simple_domain(surface, target == HarmonicTarget::Polygon, &control)?;
                let map = plane(&domain, target, &spec, &control)?;
                // Vertices that were added to make the domain simple come after those of the mesh.
                let own = map.points.into_iter().take(mesh.connectivity.n_vertices());
                own.map(|[x, y]| [x, y, 0.0]).collect()
            }
        };
        copy_out("points", &found, points, capacity)
    })
}

fn plane(
    domain: &Domain,
    target: HarmonicTarget,
    spec: &ricci_harmonic_spec,
    control: &Control,
) -> Outcome<HarmonicMap<2>> {
    Ok(match target {
        HarmonicTarget::Polygon => {
            let corners = if spec.vertices.is_null() {
                planar::corners_by_length(domain, spec.n)?
            } else {
                vertices(spec)?
            };
            planar::to_polygon(domain, &planar::regular_polygon(spec.n), Some(&corners), control)?
        }
        HarmonicTarget::Rectangle => planar::to_rectangle(domain, corners(spec)?, control)?.map,
        _ => planar::to_disk(domain, control)?,
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
    Ok(harmonic_map(domain, &MapConstraints { values, flux: None }, control)?.points)
}

//! Harmonic maps to the plane, to space and to the sphere.

use crate::arrays::{array, check_buffer, copy_out, room};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::*;
use crate::structs::{self, or, sized};
use ricci::Control;
use ricci::harmonic::{
    Domain, HarmonicMap, HeatOptions, MapConstraints, SphereMapOptions, SphereMethod, harmonic_map,
    heat_flow, planar, simple_domain, sphere_map,
};
use ricci::mesh::VertexId;

choices!(enum HarmonicTarget, TARGETS = "target of a harmonic map", [
    RICCI_HARMONIC_DISK => Disk,
    RICCI_HARMONIC_RECTANGLE => Rectangle,
    RICCI_HARMONIC_SPHERE => Sphere,
    RICCI_HARMONIC_VALUES => Values,
    RICCI_HARMONIC_POLYGON => Polygon,
]);

choices!(enum HarmonicMethod, METHODS = "method of a harmonic map", [
    RICCI_HARMONIC_SOLVE => Solve,
    RICCI_HARMONIC_HEAT => Heat,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_harmonic_spec {
    pub size: usize,
    pub vertices: *const u32,
    pub values: *const f64,
    pub n: usize,
    pub target: u32,
    pub method: u32,
    pub step: f64,
    pub max_iterations: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_harmonic_spec, "spec");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_harmonic_summary {
    pub size: usize,
    pub energy: f64,
    pub mean_value_residual: f64,
    pub modulus: f64,
    pub modulus_low: f64,
    pub modulus_high: f64,
    pub n_energies: usize,
    pub converged: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_harmonic_summary, "summary", reserved);

/// The images of the mesh's vertices, and what is known of the map; fields without a meaning are NaN.
struct FoundMap {
    points: Vec<[f64; 3]>,
    summary: ricci_harmonic_summary,
    energies: Vec<f64>,
}

impl FoundMap {
    fn new(points: Vec<[f64; 3]>, energy: f64, mean_value_residual: f64) -> FoundMap {
        let summary = ricci_harmonic_summary {
            size: 0,
            energy,
            mean_value_residual,
            modulus: f64::NAN,
            modulus_low: f64::NAN,
            modulus_high: f64::NAN,
            n_energies: 0,
            converged: 1,
            reserved: 0,
        };
        FoundMap { points, summary, energies: Vec::new() }
    }

    fn of<const N: usize>(map: HarmonicMap<N>) -> FoundMap {
        let place = |p: [f64; N]| std::array::from_fn(|k| p.get(k).copied().unwrap_or(0.0));
        FoundMap::new(map.points.into_iter().map(place).collect(), map.energy, map.mean_value_residual)
    }

    /// The map with the energies of the steps that led to it.
    fn after(mut self, energies: Vec<f64>, converged: bool) -> FoundMap {
        (self.summary.n_energies, self.summary.converged) = (energies.len(), u32::from(converged));
        self.energies = energies;
        self
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_harmonic(
    mesh: *const ricci_mesh,
    spec: *const ricci_harmonic_spec,
    control: *const ricci_control,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let found = found_map(mesh, &structs::read(spec)?, &control::of(control)?)?;
        copy_out("points", &found.points, points, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_harmonic_map(
    mesh: *const ricci_mesh,
    spec: *const ricci_harmonic_spec,
    control: *const ricci_control,
    points: *mut f64,
    capacity: usize,
    energies: *mut f64,
    energies_capacity: usize,
    summary: *mut ricci_harmonic_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        structs::check_place(summary, size)?;
        let found = found_map(mesh, &structs::read(spec)?, &control::of(control)?)?;
        let told = found.energies.len().min(energies_capacity);
        check_buffer("energies", told, energies, energies_capacity)?;
        copy_out("points", &found.points, points, capacity)?;
        copy_out("energies", &found.energies[..told], energies, energies_capacity)?;
        structs::write(found.summary, summary, size)
    })
}

fn found_map(mesh: &ricci_mesh, spec: &ricci_harmonic_spec, control: &Control) -> Outcome<FoundMap> {
    let (target, method) = (TARGETS.choose(spec.target)?, METHODS.choose(spec.method)?);
    let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
    let surface = mesh.surface()?;
    match target {
        HarmonicTarget::Sphere => {
            let domain = Domain::new(surface, control)?;
            let usual = SphereMapOptions::default();
            let max_iterations = or(spec.max_iterations, usual.max_iterations);
            let options = SphereMapOptions { method: sphere_method(method), max_iterations, ..usual };
            let map = sphere_map(&domain, &options, control)?;
            let energy = map.energies.last().copied().unwrap_or(f64::NAN);
            Ok(FoundMap::new(map.points, energy, f64::NAN).after(map.energies, map.converged))
        }
        HarmonicTarget::Values => {
            let data = MapConstraints { values: given(spec)?, flux: None };
            along(&Domain::new(surface, control)?, &data, spec, control)
        }
        HarmonicTarget::Disk | HarmonicTarget::Polygon | HarmonicTarget::Rectangle => {
            let (_, domain) = simple_domain(surface, target == HarmonicTarget::Polygon, control)?;
            let mut map = plane(&domain, target, spec, control)?;
            // Vertices that were added to make the domain simple come after those of the mesh.
            map.points.truncate(mesh.connectivity.n_vertices());
            Ok(map)
        }
    }
}

fn sphere_method(method: HarmonicMethod) -> SphereMethod {
    match method {
        HarmonicMethod::Solve => SphereMethod::Implicit,
        HarmonicMethod::Heat => SphereMethod::HeatFlow,
    }
}

/// The map with given values, by the method that is asked for.
fn along<const N: usize>(
    domain: &Domain,
    data: &MapConstraints<N>,
    spec: &ricci_harmonic_spec,
    control: &Control,
) -> Outcome<FoundMap> {
    if METHODS.choose(spec.method)? == HarmonicMethod::Solve {
        return Ok(FoundMap::of(harmonic_map(domain, data, control)?));
    }
    let usual = HeatOptions::default();
    let max_iterations = or(spec.max_iterations, usual.max_iterations);
    let flow = heat_flow(domain, data, &HeatOptions { step: spec.step, max_iterations, ..usual }, control)?;
    Ok(FoundMap::of(flow.map).after(flow.energies, flow.converged))
}

fn plane(
    domain: &Domain,
    target: HarmonicTarget,
    spec: &ricci_harmonic_spec,
    control: &Control,
) -> Outcome<FoundMap> {
    let values = match target {
        HarmonicTarget::Rectangle if METHODS.choose(spec.method)? == HarmonicMethod::Heat => {
            let why = "the modulus of a rectangle comes from two linear solves: take RICCI_HARMONIC_SOLVE";
            return Err(Failure::argument(why));
        }
        HarmonicTarget::Rectangle => {
            let found = planar::to_rectangle(domain, corners(spec)?, control)?;
            let mut map = FoundMap::of(found.map);
            map.summary.modulus = found.modulus;
            [map.summary.modulus_low, map.summary.modulus_high] = found.bounds;
            return Ok(map);
        }
        HarmonicTarget::Polygon => {
            let corners = if spec.vertices.is_null() {
                planar::corners_by_length(domain, spec.n)?
            } else {
                vertices(spec)?
            };
            planar::polygon_values(domain, &planar::regular_polygon(spec.n), Some(&corners))?
        }
        _ => planar::disk_values(domain)?,
    };
    along(domain, &MapConstraints { values, flux: None }, spec, control)
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

fn given(spec: &ricci_harmonic_spec) -> Outcome<Vec<(VertexId, [f64; 3])>> {
    let places: Vec<[f64; 3]> = array("values", spec.values.cast(), spec.n)?;
    let mut values = room("values", spec.n)?;
    values.extend(vertices(spec)?.into_iter().zip(places));
    Ok(values)
}

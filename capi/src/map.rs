//! The common subdivision of a mesh and the metric's triangulation, or of two surfaces: a map between the two, and values carried over it.

use crate::arrays::{array, check_buffer, copy_each, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::{MetricState, ON, Triangulation, ricci_metric};
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Surface;
use ricci::mesh::io::Attributes;
use ricci::mesh::{FaceId, PerVertex};
use ricci::metric::CommonSubdivision;
use ricci::metric::common_subdivision::Crossing;
use ricci::records::MeshRecord;
use std::sync::Arc;

// The elements that carried values belong to.
choices!(enum CarriedAt, AT = "at", [
    RICCI_AT_VERTICES => Vertices,
    RICCI_AT_CORNERS => Corners,
]);

pub struct ricci_map {
    /// The surface that is mapped.
    pub(crate) first: Surface,
    /// The triangulation of the metric, or the target.
    pub(crate) second: MeshRecord,
    pub(crate) subdivision: Arc<CommonSubdivision>,
}
handle!(ricci_map, "map", |map| map.subdivision.mesh.n_vertices());

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_map_summary {
    pub size: usize,
    pub n_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub n_crossings: usize,
    pub n_pieces: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_map_summary, "summary");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_carried {
    pub size: usize,
    pub on: u32,
    pub at: u32,
    pub values: *const f64,
    pub n_values: usize,
    pub n_components: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_carried, "carried");

/// Homogeneous weight of every vertex of a subdivision, or of the mesh where that is none.
pub(crate) fn weights(
    state: &MetricState,
    subdivision: Option<&Arc<CommonSubdivision>>,
) -> Outcome<PerVertex<f64>> {
    match subdivision {
        Some(subdivision) => Ok(subdivision.weight.clone()),
        None => Ok(state.subdivision(&control::of_thread()?)?.weight.clone()),
    }
}

/// The number of a side of the map in the common subdivision: 0 for the mesh or the source, 1 for the metric or the target.
fn side(on: u32) -> Outcome<usize> {
    match ON.choose(on)? {
        Triangulation::Input => Ok(0),
        Triangulation::Metric => Ok(1),
        Triangulation::Subdivision => {
            Err(Failure::argument("on is RICCI_ON_REFINEMENT: known are the input and the metric"))
        }
    }
}

impl ricci_map {
    /// The map of two surfaces that were matched.
    pub(crate) fn of_surfaces([source, target]: [&Surface; 2], subdivision: CommonSubdivision) -> ricci_map {
        ricci_map { first: source.clone(), second: target.into(), subdivision: Arc::new(subdivision) }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_new(
    metric: *const ricci_metric,
    control: *const ricci_control,
    map: *mut *mut ricci_map,
) -> ricci_status {
    guard::make(map, || {
        let state = &shared(metric)?.0;
        let solution = &state.solution;
        let _reserve = memory::work(solution.mesh().n_vertices(), memory::LAYOUT)?;
        let subdivision = state.subdivision(&control::of(control)?)?.clone();
        let second = MeshRecord {
            mesh: solution.mesh().clone(),
            positions: None,
            lengths: Some((state.lengths.clone(), solution.metric().space)),
            attributes: Attributes::default(),
            places: None,
        };
        Ok(ricci_map { first: solution.surface().clone(), second, subdivision })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_free(map: *mut ricci_map) {
    guard::free(map);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_summarise(
    map: *const ricci_map,
    summary: *mut ricci_map_summary,
    size: usize,
) -> ricci_status {
    guard::with(map, |map| {
        let CommonSubdivision { mesh, crossings, polygon_of, .. } = &*map.subdivision;
        let figures = ricci_map_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_crossings: crossings.len(),
            n_pieces: polygon_of.last().map_or(0, |&last| last as usize + 1),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_mesh(map: *const ricci_map, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make(mesh, || {
        let map = shared(map)?;
        let positions = map.first.positions().ok_or_else(|| {
            Failure::argument(
                "the given mesh is intrinsic: ricci_layout_mesh has the refinement with lengths",
            )
        })?;
        let positions = Arc::new(map.subdivision.from_vertices(0, positions)?);
        Ok(ricci_mesh::in_space(Arc::new(map.subdivision.mesh.clone()), positions))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_faces(
    map: *const ricci_map,
    on: u32,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(map, |map| {
        let subdivision = &map.subdivision;
        let of = match ON.choose(on)? {
            Triangulation::Subdivision => None,
            _ => Some(&subdivision.faces[side(on)?]),
        };
        let number = |f: FaceId| of.map_or(subdivision.polygon_of[f], |of| of[f].0);
        copy_each("faces", subdivision.mesh.n_faces(), subdivision.mesh.faces().map(number), faces, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_barycentric(
    map: *const ricci_map,
    on: u32,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(map, |map| {
        let (side, mesh) = (side(on)?, &map.subdivision.mesh);
        let all = mesh.faces().map(|f| map.subdivision.barycentric(side, f));
        copy_each("weights", mesh.n_faces(), all, weights, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_crossings(
    map: *const ricci_map,
    on: u32,
    edges: *mut u32,
    fractions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(map, |map| {
        let side = side(on)?;
        let of = |crossing: &Crossing| (crossing[side].edge.0, crossing[side].weights[1]);
        let (names, values): (Vec<u32>, Vec<f64>) = map.subdivision.crossings.iter().map(of).unzip();
        check_buffer("fractions", values.len(), fractions, capacity)?;
        copy_out("edges", &names, edges, capacity)?;
        copy_out("fractions", &values, fractions, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_weights(
    map: *const ricci_map,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(map, |map| copy_out("weights", &map.subdivision.weight, weights, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_carry(
    map: *const ricci_map,
    values: *const ricci_carried,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(map, |map| {
        if values.is_null() {
            return Err(Failure::null("values"));
        }
        let given = structs::read(values)?;
        let side = side(given.on)?;
        let (mesh, subdivision) = ([map.first.mesh(), &map.second.mesh][side], &map.subdivision);
        let all = match AT.choose(given.at)? {
            CarriedAt::Vertices => {
                let values = CarriedValues::<1>::read(&given, mesh.n_vertices())?;
                values.carry(|column| subdivision.from_vertices(side, column))
            }
            CarriedAt::Corners => {
                let values = CarriedValues::<3>::read(&given, mesh.n_faces())?;
                values.carry(|column| {
                    let column: Vec<_> = column.iter().map(|face| face.map(|x| [x])).collect();
                    Ok(subdivision
                        .from_corners(side, &column)?
                        .iter()
                        .map(|face| face.map(|[x]| x))
                        .collect())
                })
            }
        }?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// The caller's values: K places (a vertex, or the corners of a face) per element, with any number of components.
struct CarriedValues<const K: usize> {
    all: Vec<f64>,
    n_components: usize,
}

impl<const K: usize> CarriedValues<K> {
    fn read(given: &ricci_carried, needed: usize) -> Outcome<CarriedValues<K>> {
        let &ricci_carried { values, n_values: n, n_components, .. } = given;
        if n != needed {
            let message = format!("values has {n} rows, {needed} are needed");
            return Err(Failure::new(RICCI_WRONG_SIZE, message).needs(needed));
        }
        let entries = n_components.checked_mul(K).and_then(|row| row.checked_mul(n)).ok_or_else(|| {
            let message = format!("values: no array of {n} rows of {n_components} components can exist");
            Failure::new(RICCI_TOO_LARGE, message)
        })?;
        let all = array("values", values, entries)?;
        match all.iter().position(|x| !x.is_finite()) {
            Some(i) => {
                let message = format!("values[{i}] is {}: values must be finite", all[i]);
                Err(Failure::argument(message).at(FailureElement::Entry, i))
            }
            None => Ok(CarriedValues { all, n_components }),
        }
    }

    /// The values at the places of the subdivision, component after component carried by `carry`.
    fn carry(self, carry: impl Fn(&[[f64; K]]) -> ricci::Result<Vec<[f64; K]>>) -> Outcome<Vec<f64>> {
        let n = self.n_components;
        let mut carried = Vec::new();
        for component in 0..n {
            let row = |row: &[f64]| std::array::from_fn(|k| row[k * n + component]);
            let column: Vec<[f64; K]> = self.all.chunks_exact(K * n).map(row).collect();
            let result = carry(&column)?;
            carried.resize(result.len() * K * n, 0.0);
            for (place, value) in result.as_flattened().iter().enumerate() {
                carried[place * n + component] = *value;
            }
        }
        Ok(carried)
    }
}

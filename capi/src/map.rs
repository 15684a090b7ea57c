//! The common refinement of a mesh and the metric's triangulation: a map between the two, and what is carried over it.

use crate::arrays::{array, check_buffer, copy_each, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Element, Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::{ON, On, State, ricci_metric};
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Control;
use ricci::mesh::{FaceId, Mesh, PerVertex};
use ricci::metric::Refinement;
use ricci::metric::refinement::Crossing;
use std::sync::Arc;

#[derive(Debug, Clone, Copy, PartialEq)]
enum At {
    Vertices,
    Corners,
}

choices!(AT: At = "at", [
    RICCI_AT_VERTICES => At::Vertices,
    RICCI_AT_CORNERS => At::Corners,
]);

pub struct ricci_map {
    state: Arc<State>,
    /// None where both triangulations are one.
    refinement: Option<Arc<Refinement>>,
}
handle!(ricci_map, "map");

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

/// Homogeneous weight of every vertex of a refinement, or of the mesh where that is none.
pub(crate) fn weights(state: &State, refinement: Option<&Arc<Refinement>>) -> Outcome<PerVertex<f64>> {
    Ok(match refinement {
        Some(refinement) => refinement.weight.clone(),
        None => state.solution.refinement(&Control::new())?.weight,
    })
}

/// A side of the map: the input or the metric's triangulation.
fn side(on: u32) -> Outcome<On> {
    match ON.choose(on)? {
        On::Refinement => {
            Err(Failure::argument("on is RICCI_ON_REFINEMENT: known are the input and the metric"))
        }
        side => Ok(side),
    }
}

impl ricci_map {
    fn mesh(&self) -> &Mesh {
        self.refinement.as_ref().map_or(self.state.solution.mesh(), |r| &r.mesh)
    }

    fn crossings(&self) -> &[Crossing] {
        self.refinement.as_ref().map_or(&[], |r| &r.crossings)
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_new(
    metric: *const ricci_metric,
    control: *const ricci_control,
    map: *mut *mut ricci_map,
) -> ricci_status {
    guard::make(map, || {
        let state = shared(metric)?.0.clone();
        let _reserve = memory::work(state.solution.mesh().n_vertices(), memory::LAYOUT)?;
        let refinement = state.refinement(&control::of(control))?.cloned();
        Ok(ricci_map { state, refinement })
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
        let (mesh, pieces) = (map.mesh(), map.refinement.as_ref().map(|r| r.piece.last()));
        let figures = ricci_map_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_crossings: map.crossings().len(),
            n_pieces: pieces.map_or(mesh.n_faces(), |last| last.map_or(0, |&last| last as usize + 1)),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_mesh(map: *const ricci_map, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make(mesh, || {
        let map = shared(map)?;
        let positions = map.state.solution.surface().positions();
        let positions = positions.ok_or_else(|| {
            Failure::argument(
                "the given mesh is intrinsic: ricci_layout_mesh has the refinement with lengths",
            )
        })?;
        Ok(match &map.refinement {
            Some(r) => {
                ricci_mesh::in_space(Arc::new(r.mesh.clone()), Arc::new(r.from_input_vertices(positions)?))
            }
            None => ricci_mesh::in_space(map.state.solution.mesh().clone(), positions.clone()),
        })
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
        let on = ON.choose(on)?;
        let of = |f: FaceId| match (&map.refinement, on) {
            (Some(refinement), On::Input) => refinement.input_face[f].0,
            (Some(refinement), On::Metric) => refinement.final_face[f].0,
            (Some(refinement), On::Refinement) => refinement.piece[f],
            (None, _) => f.0,
        };
        copy_each("faces", map.mesh().n_faces(), map.mesh().faces().map(of), faces, capacity)
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
        let on = side(on)?;
        let of = |f: FaceId| match (&map.refinement, on) {
            (Some(refinement), On::Input) => refinement.input_barycentric(f),
            (Some(refinement), _) => refinement.final_barycentric(f),
            (None, _) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        copy_each("weights", map.mesh().n_faces(), map.mesh().faces().map(of), weights, capacity)
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
        let on = side(on)?;
        let of = |c: &Crossing| match on {
            On::Input => (c.input_edge.0, c.input_weights[1]),
            _ => (c.final_edge.0, c.final_weights[1]),
        };
        let (names, values): (Vec<u32>, Vec<f64>) = map.crossings().iter().map(of).unzip();
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
    guard::with(map, |map| {
        check_buffer("weights", map.mesh().n_vertices(), weights, capacity)?;
        copy_out("weights", &self::weights(&map.state, map.refinement.as_ref())?, weights, capacity)
    })
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
        let (on, solution) = (side(given.on)?, &map.state.solution);
        let mesh = if on == On::Input { solution.given() } else { solution.mesh() };
        let refinement = map.refinement.as_ref();
        let all = match AT.choose(given.at)? {
            At::Vertices => {
                let values = Values::<1>::read(&given, mesh.n_vertices())?;
                values.carry(refinement, |r, column| match on {
                    On::Input => r.from_input_vertices(column),
                    _ => r.from_final_vertices(column),
                })
            }
            At::Corners => {
                let values = Values::<3>::read(&given, mesh.n_faces())?;
                values.carry(refinement, |r, column| {
                    let column: Vec<_> = column.iter().map(|face| face.map(|x| [x])).collect();
                    let carried = match on {
                        On::Input => r.from_input_corners(&column),
                        _ => r.from_final_corners(&column),
                    };
                    Ok(carried?.iter().map(|face| face.map(|[x]| x)).collect())
                })
            }
        }?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// The caller's values: K places (a vertex, or the corners of a face) per element, with any number of components.
struct Values<const K: usize> {
    all: Vec<f64>,
    n_components: usize,
}

impl<const K: usize> Values<K> {
    fn read(given: &ricci_carried, needed: usize) -> Outcome<Values<K>> {
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
                Err(Failure::argument(message).at(Element::Entry, i))
            }
            None => Ok(Values { all, n_components }),
        }
    }

    /// The values at the places of the refinement, component after component carried by `carry`.
    fn carry(
        self,
        refinement: Option<&Arc<Refinement>>,
        carry: impl Fn(&Refinement, &[[f64; K]]) -> ricci::Result<Vec<[f64; K]>>,
    ) -> Outcome<Vec<f64>> {
        let n = self.n_components;
        let Some(refinement) = refinement.filter(|_| n > 0) else { return Ok(self.all) };
        let mut carried = Vec::new();
        for component in 0..n {
            let row = |row: &[f64]| std::array::from_fn(|k| row[k * n + component]);
            let column: Vec<[f64; K]> = self.all.chunks_exact(K * n).map(row).collect();
            let result = carry(refinement, &column)?;
            carried.resize(result.len() * K * n, 0.0);
            for (place, value) in result.as_flattened().iter().enumerate() {
                carried[place * n + component] = *value;
            }
        }
        Ok(carried)
    }
}

//! The common refinement of a mesh and the metric's triangulation, or of two surfaces: a map between the two, and what is carried over it.

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
use ricci::mesh::{FaceId, Mesh, PerVertex};
use ricci::metric::refinement::Crossing;
use ricci::metric::{Overlay, Refinement};
use ricci::{Control, Surface};
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

pub struct ricci_map(Kind);

/// Which two triangulations a map is between.
enum Kind {
    /// Of a metric: no refinement where both are one.
    Flow(Arc<MetricState>, Option<Arc<Refinement>>),
    /// Of two surfaces.
    Matching(Box<([Surface; 2], Overlay)>),
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
pub(crate) fn weights(state: &MetricState, refinement: Option<&Arc<Refinement>>) -> Outcome<PerVertex<f64>> {
    Ok(match refinement {
        Some(refinement) => refinement.weight.clone(),
        None => state.solution.refinement(&Control::new())?.weight,
    })
}

/// A side of the map: the input or the metric's triangulation.
fn side(on: u32) -> Outcome<Triangulation> {
    match ON.choose(on)? {
        Triangulation::Refinement => {
            Err(Failure::argument("on is RICCI_ON_REFINEMENT: known are the input and the metric"))
        }
        side => Ok(side),
    }
}

impl ricci_map {
    /// The map of two surfaces that are laid over each other.
    pub(crate) fn of_overlay(surfaces: [Surface; 2], overlay: Overlay) -> ricci_map {
        ricci_map(Kind::Matching(Box::new((surfaces, overlay))))
    }

    fn mesh(&self) -> &Mesh {
        match &self.0 {
            Kind::Flow(state, refinement) => refinement.as_ref().map_or(state.solution.mesh(), |r| &r.mesh),
            Kind::Matching(both) => &both.1.mesh,
        }
    }

    /// Per crossing, its edge on a side and the weight of that edge's second end.
    fn crossings(&self, on: Triangulation) -> Vec<(u32, f64)> {
        let of = |c: &Crossing| match on {
            Triangulation::Input => (c.input_edge.0, c.input_weights[1]),
            _ => (c.final_edge.0, c.final_weights[1]),
        };
        match &self.0 {
            Kind::Flow(_, refinement) => {
                refinement.as_ref().map_or(Vec::new(), |r| r.crossings.iter().map(of).collect())
            }
            Kind::Matching(both) => {
                both.1.crossings.iter().map(|c| (c[number(on)].0.0, c[number(on)].1)).collect()
            }
        }
    }

    /// Triangulations as they were given on a side.
    fn given(&self, on: Triangulation) -> &Mesh {
        match (&self.0, on) {
            (Kind::Flow(state, _), Triangulation::Input) => state.solution.given(),
            (Kind::Flow(state, _), _) => state.solution.mesh(),
            (Kind::Matching(both), on) => both.0[number(on)].mesh(),
        }
    }

    /// Values at the vertices of a side, at those of the refinement.
    fn at_vertices(&self, on: Triangulation, column: &[[f64; 1]]) -> ricci::Result<Vec<[f64; 1]>> {
        match &self.0 {
            Kind::Flow(_, None) => Ok(column.to_vec()),
            Kind::Flow(_, Some(r)) if on == Triangulation::Input => r.from_input_vertices(column),
            Kind::Flow(_, Some(r)) => r.from_final_vertices(column),
            Kind::Matching(both) => both.1.from_vertices(number(on), self.given(on), column),
        }
    }

    /// Values at the corners of a side's faces, at those of the refinement.
    fn at_corners(&self, on: Triangulation, column: &[[[f64; 1]; 3]]) -> ricci::Result<Vec<[[f64; 1]; 3]>> {
        match &self.0 {
            Kind::Flow(_, None) => Ok(column.to_vec()),
            Kind::Flow(_, Some(r)) if on == Triangulation::Input => r.from_input_corners(column),
            Kind::Flow(_, Some(r)) => r.from_final_corners(column),
            Kind::Matching(both) => both.1.from_corners(number(on), column),
        }
    }
}

/// The number of a side of an overlay: the source, or the target.
fn number(on: Triangulation) -> usize {
    usize::from(on != Triangulation::Input)
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
        Ok(ricci_map(Kind::Flow(state, refinement)))
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
        let mesh = map.mesh();
        let pieces = match &map.0 {
            Kind::Flow(_, refinement) => refinement.as_ref().map(|r| r.piece.last()),
            Kind::Matching(both) => Some(both.1.piece.last()),
        };
        let figures = ricci_map_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_crossings: map.crossings(Triangulation::Input).len(),
            n_pieces: pieces.map_or(mesh.n_faces(), |last| last.map_or(0, |&last| last as usize + 1)),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_map_mesh(map: *const ricci_map, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make(mesh, || {
        let map = shared(map)?;
        let surface = match &map.0 {
            Kind::Flow(state, _) => state.solution.surface(),
            Kind::Matching(both) => &both.0[0],
        };
        let positions = surface.positions().ok_or_else(|| {
            Failure::argument(
                "the given mesh is intrinsic: ricci_layout_mesh has the refinement with lengths",
            )
        })?;
        let (mesh, positions) = match &map.0 {
            Kind::Flow(_, Some(r)) => (Arc::new(r.mesh.clone()), Arc::new(r.from_input_vertices(positions)?)),
            Kind::Flow(state, None) => (state.solution.mesh().clone(), positions.clone()),
            Kind::Matching(both) => {
                let there = both.1.from_vertices(0, surface.mesh(), positions)?;
                (Arc::new(both.1.mesh.clone()), Arc::new(there))
            }
        };
        Ok(ricci_mesh::in_space(mesh, positions))
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
        let of = |f: FaceId| match (&map.0, on) {
            (Kind::Flow(_, None), _) => f.0,
            (Kind::Flow(_, Some(refinement)), Triangulation::Input) => refinement.input_face[f].0,
            (Kind::Flow(_, Some(refinement)), Triangulation::Metric) => refinement.final_face[f].0,
            (Kind::Flow(_, Some(refinement)), Triangulation::Refinement) => refinement.piece[f],
            (Kind::Matching(both), Triangulation::Refinement) => both.1.piece[f],
            (Kind::Matching(both), on) => both.1.faces[number(on)][f].0,
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
        let of = |f: FaceId| match (&map.0, on) {
            (Kind::Flow(_, Some(refinement)), Triangulation::Input) => refinement.input_barycentric(f),
            (Kind::Flow(_, Some(refinement)), _) => refinement.final_barycentric(f),
            (Kind::Flow(_, None), _) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            (Kind::Matching(both), on) => both.1.barycentric[number(on)][f],
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
        let (names, values): (Vec<u32>, Vec<f64>) = map.crossings(on).into_iter().unzip();
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
        let all = match &map.0 {
            Kind::Flow(state, refinement) => self::weights(state, refinement.as_ref())?,
            Kind::Matching(both) => both.1.weight.clone(),
        };
        copy_out("weights", &all, weights, capacity)
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
        let on = side(given.on)?;
        let mesh = map.given(on);
        let all = match AT.choose(given.at)? {
            At::Vertices => {
                let values = Values::<1>::read(&given, mesh.n_vertices())?;
                values.carry(|column| map.at_vertices(on, column))
            }
            At::Corners => {
                let values = Values::<3>::read(&given, mesh.n_faces())?;
                values.carry(|column| {
                    let column: Vec<_> = column.iter().map(|face| face.map(|x| [x])).collect();
                    Ok(map.at_corners(on, &column)?.iter().map(|face| face.map(|[x]| x)).collect())
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
                Err(Failure::argument(message).at(FailureElement::Entry, i))
            }
            None => Ok(Values { all, n_components }),
        }
    }

    /// The values at the places of the refinement, component after component carried by `carry`.
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

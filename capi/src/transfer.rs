//! Attributes carried to a layout: values at vertices or corners of the given mesh or of the metric's triangulation.

use crate::arrays::{array_of, copy_out};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::layout::ricci_layout;
use crate::status::ricci_status;
use ricci::metric::Refinement;

/// Carry values at the vertices of the given mesh to those of the layout: linear along the edges of the given
/// mesh. At the given vertices they stay as they are.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a value is not finite),
/// RICCI_BUFFER_TOO_SMALL.
///
/// @param layout        the layout.
/// @param values        n_values x n_components, row by row.
/// @param n_values      number of vertices of the mesh that the metric was made from.
/// @param n_components  numbers per vertex, such as 3 of a normal.
/// @param carried       out: n_vertices x n_components.
/// @param capacity      entries of `carried`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_from_input_vertices(
    layout: *const ricci_layout,
    values: *const f64,
    n_values: usize,
    n_components: usize,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let values = Values::<1>::read(values, n_values, n_components, layout.surface.given().n_vertices())?;
        let all = values.carry(layout, |r, column| r.from_input_vertices(column))?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// Carry values at the vertices of the metric's triangulation to those of the layout: linear along its edges,
/// with its lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a value is not finite),
/// RICCI_BUFFER_TOO_SMALL.
///
/// @param layout        the layout.
/// @param values        n_values x n_components, row by row.
/// @param n_values      number of vertices of ricci_metric_mesh.
/// @param n_components  numbers per vertex.
/// @param carried       out: n_vertices x n_components.
/// @param capacity      entries of `carried`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_from_final_vertices(
    layout: *const ricci_layout,
    values: *const f64,
    n_values: usize,
    n_components: usize,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let values = Values::<1>::read(values, n_values, n_components, layout.surface.mesh().n_vertices())?;
        let all = values.carry(layout, |r, column| r.from_final_vertices(column))?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// Carry values at the corners of the given mesh's faces to the corners of the layout's: linear in every face
/// of the given mesh, such as texture coordinates or normals with creases.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a value is not finite),
/// RICCI_BUFFER_TOO_SMALL.
///
/// @param layout        the layout.
/// @param values        n_values x 3 x n_components [face, corner, component].
/// @param n_values      number of faces of the mesh that the metric was made from.
/// @param n_components  numbers per corner.
/// @param carried       out: n_faces x 3 x n_components.
/// @param capacity      entries of `carried`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_from_input_corners(
    layout: *const ricci_layout,
    values: *const f64,
    n_values: usize,
    n_components: usize,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let values = Values::<3>::read(values, n_values, n_components, layout.surface.given().n_faces())?;
        let all = values.carry(layout, |r, column| Ok(rows(&r.from_input_corners(&columns(column))?)))?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// Carry values at the corners of the faces of the metric's triangulation to the corners of the layout's:
/// linear in every face of that triangulation, with its lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a value is not finite),
/// RICCI_BUFFER_TOO_SMALL.
///
/// @param layout        the layout.
/// @param values        n_values x 3 x n_components [face, corner, component].
/// @param n_values      number of faces of ricci_metric_mesh.
/// @param n_components  numbers per corner.
/// @param carried       out: n_faces x 3 x n_components.
/// @param capacity      entries of `carried`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_from_final_corners(
    layout: *const ricci_layout,
    values: *const f64,
    n_values: usize,
    n_components: usize,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let values = Values::<3>::read(values, n_values, n_components, layout.surface.mesh().n_faces())?;
        let all = values.carry(layout, |r, column| Ok(rows(&r.from_final_corners(&columns(column))?)))?;
        copy_out("carried", &all, carried, capacity)
    })
}

/// Corners with one component.
fn columns(values: &[[f64; 3]]) -> Vec<[[f64; 1]; 3]> {
    values.iter().map(|face| face.map(|x| [x])).collect()
}

fn rows(values: &[[[f64; 1]; 3]]) -> Vec<[f64; 3]> {
    values.iter().map(|face| face.map(|[x]| x)).collect()
}

/// The caller's values: K places (a vertex, or the corners of a face) per element, with any number of components.
struct Values<const K: usize> {
    all: Vec<f64>,
    n_components: usize,
}

impl<const K: usize> Values<K> {
    fn read(values: *const f64, n: usize, n_components: usize, needed: usize) -> Outcome<Values<K>> {
        if n != needed {
            let message = format!("values has {n} rows, {needed} are needed");
            return Err(Failure::new(ricci_status::RICCI_WRONG_SIZE, message));
        }
        let entries = n_components.checked_mul(K).and_then(|row| row.checked_mul(n)).ok_or_else(|| {
            let message = format!("values: no array of {n} rows of {n_components} components can exist");
            Failure::new(ricci_status::RICCI_TOO_LARGE, message)
        })?;
        let all = array_of("values", values, entries, entries)?;
        match all.iter().position(|x| !x.is_finite()) {
            Some(i) => Err(Failure::argument(format!("values[{i}] is {}: values must be finite", all[i]))),
            None => Ok(Values { all, n_components }),
        }
    }

    /// The values at the places of the layout, component after component carried by `carry`.
    fn carry(
        self,
        layout: &ricci_layout,
        carry: impl Fn(&Refinement, &[[f64; K]]) -> ricci::Result<Vec<[f64; K]>>,
    ) -> Outcome<Vec<f64>> {
        let n = self.n_components;
        let Some(refinement) = layout.layout.refinement().filter(|_| n > 0) else { return Ok(self.all) };
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

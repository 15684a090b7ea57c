//! The closed forms of least energy among those with quadratic terms on some edges: one factorisation, one solve per class.

use super::elements::{ClosedForm, quantised};
use super::finer::BisectedSurface;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::Enclosure;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, PerVertex};

/// The row of a number that is held at 0.
const HELD: u32 = u32::MAX;
/// Number of classes in one solve, which reads the factor once for all of them.
const COLUMNS: usize = 8;

/// The rows of the vertices, all but the first, and of the edges with quadratic terms.
pub(super) struct Unknowns {
    of_vertex: PerVertex<u32>,
    of_edge: PerEdge<u32>,
    /// Their number.
    pub count: usize,
}

impl Unknowns {
    pub fn new(surface: &BisectedSurface) -> Unknowns {
        let mesh = &surface.mesh;
        let mut count = 0u32;
        let mut next = |is_free: bool| {
            if !is_free {
                return HELD;
            }
            count += 1;
            count - 1
        };
        let of_vertex = PerVertex::from_fn(mesh.n_vertices(), |v| next(v.index() > 0));
        let of_edge = PerEdge::from_fn(mesh.n_edges(), |e| next(surface.is_curved[e]));
        Unknowns { of_vertex, of_edge, count: count as usize }
    }

    /// The exact part of the form of class k for a solution, whose numbers are rounded to those of exact sums.
    fn form(&self, surface: &BisectedSurface, k: usize, column: &[f64]) -> ClosedForm {
        let mut numbers = column.to_vec();
        let integers = surface.cochains[k].iter().map(|x| x.unsigned_abs()).max().unwrap_or(0);
        quantised(&mut numbers, f64::from(integers));
        let at = |row: &u32| if *row == HELD { 0.0 } else { numbers[*row as usize] };
        ClosedForm {
            potential: self.of_vertex.iter().map(at).collect::<Vec<_>>().into(),
            curve: self.of_edge.iter().map(at).collect::<Vec<_>>().into(),
        }
    }

    /// The rows of the corners of a face, then those of the sides opposite them.
    fn rows(&self, mesh: &Mesh, f: FaceId) -> [u32; 6] {
        let (v, e) = (mesh.face_vertices(f), mesh.opposite_edges(f));
        std::array::from_fn(|k| if k < 3 { self.of_vertex[v[k]] } else { self.of_edge[e[k - 3]] })
    }
}

/// The energy of the functions of a face: rows and columns as in [`Unknowns::rows`].
fn face_matrix(cot: [f64; 3]) -> [[f64; 6]; 6] {
    let linear = |i: usize, j: usize| {
        if i == j { 0.5 * (cot[(i + 1) % 3] + cot[(i + 2) % 3]) } else { -0.5 * cot[3 - i - j] }
    };
    let total = cot[0] + cot[1] + cot[2];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i < 3, j < 3) {
            (true, true) => linear(i, j),
            (false, false) if i == j => 4.0 / 3.0 * total,
            (false, false) => 8.0 / 3.0 * linear(i - 3, j - 3),
            _ => -4.0 / 3.0 * linear(i % 3, j % 3),
        })
    })
}

/// The closed form of least energy in every class, and the number of unknowns of each.
///
/// # Errors
/// [`Error::Factorisation`]; [`Error::TooLarge`]; [`Error::Cancelled`].
pub(super) fn least_forms(
    surface: &BisectedSurface,
    cotangents: &PerFace<[Enclosure; 3]>,
    control: &Control,
) -> Result<(Vec<ClosedForm>, usize)> {
    let unknowns = Unknowns::new(surface);
    control.step(Stage::Flow, 0.0)?;
    let factor =
        if unknowns.count > 0 { Some(factorised(surface, cotangents, &unknowns, control)?) } else { None };
    let n = surface.cochains.len();
    let mut forms = Vec::with_capacity(n);
    for first in (0..n).step_by(COLUMNS) {
        control.step(Stage::Flow, 0.5 + 0.5 * first as f64 / n as f64)?;
        let classes = first..n.min(first + COLUMNS);
        let mut columns = vec![0.0; classes.len() * unknowns.count];
        if let Some(factor) = &factor {
            for (column, k) in columns.chunks_mut(unknowns.count).zip(classes.clone()) {
                load(surface, cotangents, &unknowns, k, column);
            }
            factor.solve_columns(&mut columns)?;
        }
        for k in classes {
            let column = &columns[(k - first) * unknowns.count..(k + 1 - first) * unknowns.count];
            forms.push(unknowns.form(surface, k, column));
        }
    }
    Ok((forms, unknowns.count))
}

fn factorised(
    surface: &BisectedSurface,
    cotangents: &PerFace<[Enclosure; 3]>,
    unknowns: &Unknowns,
    control: &Control,
) -> Result<Cholesky> {
    let mesh = &surface.mesh;
    let mut pairs = Vec::with_capacity(6 * mesh.n_faces());
    for f in mesh.faces() {
        let rows = unknowns.rows(mesh, f);
        let upper = |i: usize| rows[..i].iter().map(move |&j| (rows[i], j));
        pairs.extend((1..6).flat_map(upper).filter(|&(i, j)| i != HELD && j != HELD));
    }
    let pattern = Pattern::new(unknowns.count, &pairs)?;
    drop(pairs);
    control.step(Stage::Flow, 0.1)?;
    let mut cholesky = Cholesky::analyse(&pattern)?;
    control.step(Stage::Flow, 0.3)?;
    let mut values = vec![0.0; pattern.entries()];
    for f in mesh.faces() {
        let (rows, matrix) = (unknowns.rows(mesh, f), face_matrix(cotangents[f].map(Enclosure::nearest)));
        for i in (0..6).filter(|&i| rows[i] != HELD) {
            for j in (0..6).filter(|&j| rows[j] != HELD) {
                // The lower triangle; where corners of a face are one vertex, both orders of a pair count on the diagonal.
                let (row, column) = (rows[i] as usize, rows[j] as usize);
                if row >= column
                    && let Some(k) = pattern.position(row, column)
                {
                    values[k] += matrix[i][j];
                }
            }
        }
    }
    let matrix = Symmetric { pattern: &pattern, values: &values };
    cholesky.factor(matrix).map_err(|_| Error::Factorisation {
        size: unknowns.count,
        message: "the energy of forms on the finer triangulation is not positive definite".into(),
    })?;
    Ok(cholesky)
}

/// Minus the derivative of the energy of integer form k by every unknown.
fn load(
    surface: &BisectedSurface,
    cotangents: &PerFace<[Enclosure; 3]>,
    unknowns: &Unknowns,
    k: usize,
    column: &mut [f64],
) {
    let mesh = &surface.mesh;
    for f in mesh.faces() {
        let halfedges = mesh.face_halfedges(f);
        let integers = [0, 1, 2].map(|s| surface.along(k, halfedges[(s + 1) % 3]));
        if integers == [0; 3] {
            continue;
        }
        let flow = [0, 1, 2].map(|s| cotangents[f][s].nearest() * f64::from(integers[s]));
        let rows = unknowns.rows(mesh, f);
        for a in 0..3 {
            let slope = 0.5 * (flow[(a + 1) % 3] - flow[(a + 2) % 3]);
            for (row, value) in [(rows[a], -slope), (rows[a + 3], 4.0 / 3.0 * slope)] {
                if row != HELD {
                    column[row as usize] += value;
                }
            }
        }
    }
}

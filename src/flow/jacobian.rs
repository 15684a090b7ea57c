//! The derivative ∂K/∂u on a fixed pattern, filled from per-face weights.
//!
//! With the edge weights `W_e = Σ w` over the two triangles at e and `c = 1, cosh l, cos l`
//!
//! ```text
//! (∂K/∂u)_ij = −Σ W_e over the edges e from i to j,     (∂K/∂u)_ii = Σ W_e c(l_e) over the half-edges leaving i
//! ```
//!
//! (a loop adds `2 W (c − 1)` to its vertex). Symmetric; semidefinite in E², definite in H², indefinite in S².

use super::evaluate::FlowState;
use crate::error::{Error, Result};
use crate::linalg::{Pattern, Symmetric};
use crate::mesh::{EdgeId, Mesh, VertexId};
use crate::metric::Metric;
use crate::parallel::fill;

/// Marks a vertex without an unknown, or an edge without an entry.
const NONE: u32 = u32::MAX;

/// The matrix over the vertices that are not fixed.
pub(super) struct Jacobian {
    pub pattern: Pattern,
    /// Per vertex: its unknown, or `NONE`.
    unknown: Vec<u32>,
    /// Per edge: the position of its off-diagonal entry, or `NONE`.
    entry: Vec<u32>,
    values: Vec<f64>,
}

impl Jacobian {
    /// Pattern and scatter positions for the unknowns {v : !fixed[v]}; with a `mirror` (per vertex, its image) a vertex and its
    /// image share one, and the matrix is `PᵀHP`: the derivative along symmetric variations.
    pub fn new(mesh: &Mesh, fixed: &[bool], mirror: Option<&[u32]>) -> Result<Jacobian> {
        let mut unknown = vec![NONE; mesh.n_vertices()];
        let mut n = 0u32;
        for v in 0..unknown.len() {
            let image = mirror.map_or(v, |mirror| mirror[v] as usize);
            if image < v {
                unknown[v] = unknown[image];
            } else if !fixed[v] {
                unknown[v] = n;
                n += 1;
            }
        }
        let ends = |e: EdgeId| mesh.ends(e).map(|v| unknown[v.index()]);
        let pair = |[i, j]: [u32; 2]| (i != NONE && j != NONE && i != j).then_some((i, j));
        let pairs: Vec<(u32, u32)> = mesh.edges().map(ends).filter_map(pair).collect();
        let pattern = Pattern::new(n as usize, &pairs)?;
        let position = |(i, j): (u32, u32)| pattern.position(i as usize, j as usize);
        let mut entry = vec![NONE; mesh.n_edges()];
        fill(&mut entry, |e| pair(ends(e.into())).and_then(position).map_or(NONE, |p| p as u32));
        Ok(Jacobian { entry, values: vec![0.0; pattern.entries()], unknown, pattern })
    }

    /// Release the memory of all but the pattern, which is kept for comparing it with that of another matrix.
    pub fn keep_pattern_alone(&mut self) {
        (self.unknown, self.entry, self.values) = (Vec::new(), Vec::new(), Vec::new());
    }

    /// Fill the matrix with the derivative at a state.
    pub fn assemble(&mut self, mesh: &Mesh, class: &Metric, state: &FlowState) {
        self.values.fill(0.0);
        for f in mesh.faces() {
            let opposite = mesh.opposite_edges(f);
            let rows = mesh.face_vertices(f).map(|v| self.unknown[v.index()]);
            for k in 0..3 {
                let (e, w) = (opposite[k].index(), state.weights[f.index()][k]);
                let (i, j) = (rows[(k + 1) % 3], rows[(k + 2) % 3]);
                // c(l) = 1 − 2 λ q²
                let diagonal = w * (1.0 - 2.0 * class.space.curvature() * state.squared_chord(opposite[k]));
                for row in [i, j].into_iter().filter(|&row| row != NONE) {
                    self.values[self.pattern.diagonal(row as usize)] += diagonal;
                }
                if self.entry[e] != NONE {
                    self.values[self.entry[e] as usize] -= w;
                } else if i == j && i != NONE {
                    self.values[self.pattern.diagonal(i as usize)] -= 2.0 * w;
                }
            }
        }
    }

    /// Make the rows and columns of vertices that are `held` those of the identity.
    pub fn hold(&mut self, mesh: &Mesh, held: &[bool]) {
        for e in mesh.edges().filter(|&e| mesh.ends(e).iter().any(|v| held[v.index()])) {
            if let Some(value) = self.values.get_mut(self.entry[e.index()] as usize) {
                *value = 0.0;
            }
        }
        for (_, &row) in self.unknown.iter().enumerate().filter(|&(v, &row)| held[v] && row != NONE) {
            self.values[self.pattern.diagonal(row as usize)] = 1.0;
        }
    }

    /// The number of edges of a mesh whose entry has another position than here.
    pub fn changed_edges(&self, mesh: &Mesh) -> usize {
        let is_changed = |e: &EdgeId| {
            let ([i, j], entry) = (mesh.ends(*e).map(|v| self.unknown[v.index()]), self.entry[e.index()]);
            if i == j || i == NONE || j == NONE {
                entry != NONE
            } else {
                self.pattern.position(i as usize, j as usize) != Some(entry as usize)
            }
        };
        mesh.edges().filter(is_changed).count()
    }

    /// Add `mass[v]` to the diagonal.
    pub fn add_diagonal(&mut self, mass: impl Fn(usize) -> f64) {
        for (v, &row) in self.unknown.iter().enumerate().filter(|(_, row)| **row != NONE) {
            self.values[self.pattern.diagonal(row as usize)] += mass(v);
        }
    }

    /// The change of the curvature of each vertex that rounding can cause, at the state that this was assembled at.
    ///
    /// `Σ |∂K_i/∂u_j| δ`, term by term, for the rounding of e^u and of the lengths, where δ is an ulp of 1, or its square if these are in
    /// double-double precision ([`Metric::is_precise`]); and two ulp of π for every angle, which is an f64.
    pub fn rounding_floor(&self, mesh: &Mesh, class: &Metric, state: &FlowState) -> Vec<f64> {
        let precise = class.is_precise();
        let moved = if precise { f64::EPSILON * f64::EPSILON } else { f64::EPSILON };
        let mut floor = vec![0.0; mesh.n_vertices()];
        for f in mesh.faces() {
            let (corners, edges) = (mesh.face_vertices(f), mesh.opposite_edges(f));
            for k in 0..3 {
                let (i, j) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let w = state.weights[f.index()][k].abs();
                let c = (1.0 - 2.0 * class.space.curvature() * state.squared_chord(edges[k])).abs();
                floor[i.index()] += w * (1.0 + c) * moved + 2.0 * f64::EPSILON;
                floor[j.index()] += w * (1.0 + c) * moved + 2.0 * f64::EPSILON;
            }
        }
        floor
    }

    /// The mean size of the entries on the diagonal.
    pub fn mean_diagonal(&self) -> f64 {
        let n = self.pattern.size();
        (0..n).map(|j| self.values[self.pattern.diagonal(j)].abs()).sum::<f64>() / n.max(1) as f64
    }

    /// The matrix as it was last assembled.
    pub fn matrix(&self) -> Symmetric<'_> {
        Symmetric { pattern: &self.pattern, values: &self.values }
    }

    /// The vertices with an unknown, ascending, with their row.
    pub fn rows(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let row = |(v, &row): (usize, &u32)| (row != NONE).then_some((v, row as usize));
        self.unknown.iter().enumerate().filter_map(row)
    }
}

/// ∂K/∂u at `metric`: V×V, symmetric, entries (i, j, value) with i ≥ j, the diagonal included; (i, j) once.
///
/// Off-diagonal entries are minus the edge weights ([`crate::geometry::weights::weights`]). A broken triangle
/// contributes nothing.
///
/// # Errors
/// Those of [`Metric::check_domain`].
pub fn curvature_derivative(mesh: &Mesh, metric: &Metric) -> Result<Vec<(VertexId, VertexId, f64)>> {
    metric.check(mesh)?;
    let mut state = FlowState::new(&metric.u, &metric.u_low);
    if !state.evaluate(mesh, metric) {
        // This call returns the error that names the first edge without a length.
        metric.check_domain(mesh)?;
        return Err(Error::Argument { what: "metric", value: "u".into(), need: "inside its domain" });
    }
    let mut jacobian = Jacobian::new(mesh, &vec![false; mesh.n_vertices()], None)?;
    jacobian.assemble(mesh, metric, &state);
    Ok(jacobian.matrix().entries().map(|(i, j, x)| (i.into(), j.into(), x)).collect())
}

//! Crossings of the edges of the input with those of the final triangulation.
//!
//! An edge a → b of the input runs through a strip of final triangles. Laid out in Lorentz space, where a vertex is a vector of
//! square ε and an edge has the product −η ([`crate::geometry::flip`]), it becomes the straight line from v_a to v_b:
//!
//! ```text
//!         i₁————i₂————i₄            An edge ij that is crossed, with v_a on its left and v_b on its right, is a hinge. The products
//!       / ·\    ·\   · \            of v_a and v_b with v_i and v_j determine the crossing. Products of v_a are carried forward from
//!      a ——·\———·—\——·—— b          edge to edge by the flip rule, those of v_b backward. Every term is positive (ε = 0, 1), so
//!       \ ·  \ ·   \·  /            strips of any length keep the relative accuracy of f64.
//!         i₀———i₃———i₅
//! ```

use super::triangulations::FinalTriangulation;
use crate::error::{Error, Result};
use crate::geometry::flip::{DiagonalCrossing, Hinge};
use crate::mesh::normal_trace::CurveCrossing;
use crate::mesh::{Curves, HalfedgeId, PerEdge, VertexId};
use crate::parallel;

/// Least η − 1 of two circles in a strip. Across two circles that touch (η = 1) a straight line has no direction, and all lines would
/// meet where they touch. A larger η may be used, since it only decides where along its edge a crossing lies; 1e-6 leaves half of the
/// digits to the differences from 1.
const LEAST_GAP: f64 = 1e-6;
/// Products above this, or below its inverse, are brought near 1 by a power of 2, which rounds nothing. Formulas multiply up to three of
/// them, so that 1e90 stays far inside the range of f64.
const LARGE: f64 = 1e30;

/// An end of the line, and the products of its vector with those of the ends of one edge of the strip, multiplied by 2^exponent.
#[derive(Debug, Clone, Copy)]
struct LineEnd {
    vertex: VertexId,
    products: [f64; 2],
    exponent: i32,
}

/// A crossing as a combination of vectors: weights of the ends of the input's edge, each times 2 to its exponent, and weights of the
/// ends of the final edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct RawCrossing {
    pub meeting: DiagonalCrossing,
    pub exponent: [i32; 2],
}

/// The final triangulation with weights η under which no two circles touch.
pub(super) struct Strips<'a> {
    result: &'a FinalTriangulation<'a>,
    eta: PerEdge<f64>,
}

impl<'a> Strips<'a> {
    pub fn new(result: &'a FinalTriangulation<'a>) -> Strips<'a> {
        let metric = result.metric;
        // Without circles (ε = 0) all vectors may be made longer or shorter alike: a power of 2 brings their products near 1.
        let scaling = metric.epsilon.iter().all(|&e| e == 0);
        let most = metric.eta.iter().map(|eta| eta.high).fold(0.0, f64::max);
        let unit = if scaling && most.is_normal() { power(-(most.log2() as i32)) } else { 1.0 };
        let eta = PerEdge::from_fn(metric.eta.len(), |e| {
            let [i, j] = result.mesh.ends(e).map(|v| metric.epsilon[v]);
            let eta = metric.eta[e].high;
            if i * j == 1 { eta.max(1.0 + LEAST_GAP) } else { unit * eta }
        });
        Strips { result, eta }
    }

    /// All crossings, in the order of `curves`.
    ///
    /// # Errors
    /// [`Error::EdgeWeight`] at a final edge where an imaginary circle leaves no straight line.
    pub fn crossings(&self, input_ends: &[[VertexId; 2]], curves: &Curves) -> Result<Vec<RawCrossing>> {
        let crossing = curves.that_cross();
        let mut found = vec![Ok(Vec::new()); crossing.len()];
        parallel::fill(&mut found, |k| {
            let e = crossing[k];
            self.along(input_ends[e.index()], curves.crossings(e))
        });
        let mut all = Vec::with_capacity(curves.n_crossings());
        for crossings in found {
            all.extend(crossings?);
        }
        Ok(all)
    }

    /// The crossings of one edge a → b with its strip.
    fn along(&self, [a, b]: [VertexId; 2], strip: &[CurveCrossing]) -> Result<Vec<RawCrossing>> {
        let (Some(first), Some(last)) = (strip.first(), strip.last()) else { return Ok(Vec::new()) };
        let mesh = self.result.mesh;
        let eta = |h: HalfedgeId| self.eta[h.edge()];
        // The products with the ends of `side`, the next edge of the strip, from those with the ends i, j of this one and with the
        // third vertex of the face between them, `far`.
        let turned = |seen: LineEnd, far: f64, side: HalfedgeId, entry: HalfedgeId| {
            let [i, j] = seen.products;
            LineEnd { products: if side == mesh.next(entry) { [i, far] } else { [far, j] }, ..seen }.scaled()
        };
        let entry = last.halfedge.twin();
        let start =
            LineEnd { vertex: b, products: [eta(mesh.next(entry)), eta(mesh.prev(entry))], exponent: 0 };
        let mut from_b = vec![start.scaled(); strip.len()];
        for k in (1..strip.len()).rev() {
            let (at, entry) = (strip[k].halfedge, strip[k - 1].halfedge.twin());
            let far = self.far(from_b[k], at, at)?;
            from_b[k - 1] = turned(from_b[k], far, at, entry);
        }
        let at = first.halfedge;
        let start = LineEnd { vertex: a, products: [eta(mesh.prev(at)), eta(mesh.next(at))], exponent: 0 };
        let mut from_a = start.scaled();
        let mut all = Vec::with_capacity(strip.len());
        for (k, crossing) in strip.iter().enumerate() {
            let at = crossing.halfedge;
            let meeting = self.hinge(at, from_a, from_b[k]).meeting().ok_or_else(|| self.refusal(at))?;
            all.push(RawCrossing { meeting, exponent: [from_a.exponent, from_b[k].exponent] });
            if let Some(next) = strip.get(k + 1) {
                let far = self.far(from_a, at, at.twin())?;
                from_a = turned(from_a, far, next.halfedge, at.twin());
            }
        }
        Ok(all)
    }

    /// The product of `seen` with the third vertex of the face of `side`, which is `at` or its twin and has `seen` on its other side.
    fn far(&self, seen: LineEnd, at: HalfedgeId, side: HalfedgeId) -> Result<f64> {
        let mesh = self.result.mesh;
        let [next, prev] = [mesh.next(side), mesh.prev(side)];
        let [il, jl] = if side == at { [prev, next] } else { [next, prev] }.map(|h| self.eta[h.edge()]);
        let third = LineEnd { vertex: mesh.origin(prev), products: [il, jl], exponent: 0 };
        self.hinge(at, seen, third).flipped().ok_or_else(|| self.refusal(at))
    }

    /// The hinge of the edge of `at` with the vertices on its two sides.
    fn hinge(&self, at: HalfedgeId, left: LineEnd, right: LineEnd) -> Hinge {
        let mesh = self.result.mesh;
        let epsilon = |v: VertexId| f64::from(self.result.metric.epsilon[v]);
        let own = |seen: LineEnd| epsilon(seen.vertex) * power(2 * seen.exponent);
        let square = [epsilon(mesh.origin(at)), epsilon(mesh.tip(at)), own(left), own(right)];
        let [[ik, jk], [il, jl]] = [left.products, right.products];
        Hinge::from_products(square, [self.eta[at.edge()], ik, jk, il, jl])
    }

    fn refusal(&self, at: HalfedgeId) -> Error {
        let need = "one across which the edges of the input can be drawn straight (imaginary circles may leave none)";
        Error::EdgeWeight { edge: at.edge().index(), eta: self.eta[at.edge()], need }
    }
}

impl LineEnd {
    /// The same, with products near 1 and the exponent that makes up for it.
    fn scaled(self) -> LineEnd {
        let size = self.products[0].max(self.products[1]);
        if !(size > 0.0 && size < f64::INFINITY) || (1.0 / LARGE..LARGE).contains(&size) {
            return self;
        }
        let shift = -(size.log2() as i32);
        let exponent = self.exponent.saturating_add(shift);
        LineEnd { products: self.products.map(|x| x * power(shift)), exponent, ..self }
    }
}

/// 2^n; 0 or infinite beyond the range of f64.
fn power(n: i32) -> f64 {
    f64::from(n).exp2()
}

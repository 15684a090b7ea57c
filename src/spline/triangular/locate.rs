//! Point location in a plane domain.

use super::knots::PlaneDomain;
use super::overlap::bounds;
use super::patch::{OUTSIDE, Parameter};
use super::space::SplineSpace;
use crate::error::Result;
use crate::geometry::complex::doubled_area;

impl SplineSpace {
    /// The triangles of the patches as a domain; each has vertices of its own, and triangle k is patch k.
    ///
    /// # Errors
    /// [`crate::Error::Argument`] where patches lie in several charts: a point of the plane is a place in one chart.
    pub fn domain(&self) -> Result<PlaneDomain> {
        self.check_one_chart()?;
        let corners = self.patches().iter().flat_map(|patch| [0, 1, 2].map(|k| patch.knots[k][0]));
        let triangles = (0..self.patches().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        Ok(PlaneDomain { vertices: corners.collect(), triangles: triangles.collect() })
    }
}

/// A grid over a plane domain, with the triangles that meet each cell.
#[derive(Debug, Clone)]
pub struct Locator<'a> {
    domain: &'a PlaneDomain,
    lower: [f64; 2],
    /// The side of a cell.
    cell: f64,
    columns: usize,
    rows: usize,
    /// The index in `triangles` at which those of each cell begin (cells + 1 entries).
    begins: Vec<u32>,
    triangles: Vec<u32>,
}

impl<'a> Locator<'a> {
    /// The grid for a domain that passes [`PlaneDomain::check`]; it has about as many cells as the domain has triangles.
    pub fn new(domain: &'a PlaneDomain) -> Locator<'a> {
        let [lower, upper] = bounds(domain.vertices.iter());
        let [width, height] = [0, 1].map(|x| (upper[x] - lower[x]).max(f64::MIN_POSITIVE));
        let cell =
            (width * height / domain.triangles.len().max(1) as f64).sqrt().max(width.max(height) * 1e-6);
        let [columns, rows] = [width, height].map(|size| (size / cell) as usize + 1);
        let mut grid =
            Locator { domain, lower, cell, columns, rows, begins: Vec::new(), triangles: Vec::new() };
        let mut counts = vec![0u32; columns * rows + 1];
        let each = |t: usize, grid: &Locator, found: &mut dyn FnMut(usize)| {
            let corners = domain.triangles[t].map(|v| grid.cell_of(domain.vertices[v as usize]));
            let low = corners.iter().fold([usize::MAX; 2], |m, c| [m[0].min(c[0]), m[1].min(c[1])]);
            let high = corners.iter().fold([0; 2], |m, c| [m[0].max(c[0]), m[1].max(c[1])]);
            for row in low[1]..=high[1] {
                (low[0]..=high[0]).for_each(|column| found(row * columns + column));
            }
        };
        for t in 0..domain.triangles.len() {
            each(t, &grid, &mut |cell| counts[cell + 1] += 1);
        }
        for cell in 0..columns * rows {
            counts[cell + 1] += counts[cell];
        }
        let mut triangles = vec![0; counts[columns * rows] as usize];
        let mut next = counts.clone();
        for t in 0..domain.triangles.len() {
            each(t, &grid, &mut |cell| {
                triangles[next[cell] as usize] = t as u32;
                next[cell] += 1;
            });
        }
        (grid.begins, grid.triangles) = (counts, triangles);
        grid
    }

    fn cell_of(&self, p: [f64; 2]) -> [usize; 2] {
        let along = |x: usize, most: usize| (((p[x] - self.lower[x]) / self.cell) as usize).min(most - 1);
        [along(0, self.columns), along(1, self.rows)]
    }

    /// The place of a point in the triangle that contains it, of several the one with the largest least weight; none if the point is
    /// outside the domain by more than rounding.
    pub fn locate(&self, [x, y]: [f64; 2]) -> Option<Parameter> {
        let [column, row] = self.cell_of([x, y]);
        let cell = row * self.columns + column;
        let here = &self.triangles[self.begins[cell] as usize..self.begins[cell + 1] as usize];
        let depth = |t: u32| {
            let [a, b, c] = self.domain.triangles[t as usize].map(|v| self.domain.vertices[v as usize]);
            let whole = doubled_area([a, b, c]);
            let weights = [(b, c), (c, a), (a, b)].map(|(p, q)| doubled_area([[x, y], p, q]) / whole);
            weights.into_iter().fold(f64::INFINITY, f64::min)
        };
        let best = here.iter().map(|&t| (depth(t), t)).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        best.filter(|(depth, _)| *depth >= -OUTSIDE).map(|(_, patch)| Parameter { patch, x, y })
    }
}

//! The refinement of bicubic patches: they are made, measured, and made again with more spans where they miss the spline.

use super::angles::{self, CurveFigures, NormalAngles};
use super::cubic::{DEGREE, interpolate, uniform};

use super::net::TriangleNet;
use super::outcome::{BicubicFit, BicubicOptions};
use super::quad::SurfaceQuad;
use super::sample::{PARTS, QuadPlace, QuadSample, WITHIN, grid, within};
use super::surface::{BicubicPatch, BicubicSurface, PatchCurve, PatchSide};
use super::tangents::with_common_planes;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, distance};
use crate::spline::triangular::{Parameter, Spline, SurfacePoint};

/// Most spans along a side: a spline that needs more is rough, or the tolerance is near its rounding errors. If a distance needs more, that
/// is an error; an angle is only reported.
const MOST_SPANS: usize = 128;
/// Share of the tolerance that is allowed at the places of measurement: between them distances were up to 15 % larger.
const SHARE: f64 = 0.8;
/// Number of places evaluated at a time: 10 MB of points.
const BATCH: usize = 1 << 16;

/// The state of the refinement.
pub(super) struct BicubicRefinement<'a> {
    spline: &'a Spline,
    options: BicubicOptions,
    control: &'a Control,
    net: TriangleNet,
    /// The quadrilaterals; number 3 f + k is at corner k of triangle f.
    quads: Vec<SurfaceQuad>,
    /// For each vertex the number of spans of all halves of sides that lie across from it.
    spans: Vec<usize>,
    samples: Vec<QuadSample>,
    surface: BicubicSurface,
    diagonal: f64,
    /// For each quadrilateral its largest distance from the spline.
    misses: Vec<f64>,
    /// For each curve its measured figures.
    figures: Vec<CurveFigures>,
    rounds: usize,
}

impl<'a> BicubicRefinement<'a> {
    /// The start: points, quadrilaterals and curves with one span, without control points.
    pub fn new(
        spline: &'a Spline,
        options: BicubicOptions,
        control: &'a Control,
    ) -> Result<BicubicRefinement<'a>> {
        let triangles = spline.triangles();
        let n = triangles.len();
        if n == 0 {
            return Err(Error::argument("patches of the spline", 0, "1 or more"));
        }
        let net = TriangleNet::new(spline)?;
        let quads = SurfaceQuad::all(spline, &triangles);
        let place = |&(f, k): &(u32, usize), at: [f64; 2]| quads[3 * f as usize + k].place(at);
        let places: Vec<Parameter> = (net.corners.iter().map(|at| place(at, [0.0, 0.0])))
            .chain(net.owners.iter().map(|at| place(at, [1.0, 0.0])))
            .chain((0..n as u32).map(|f| place(&(f, 0), [1.0, 1.0])))
            .collect();
        let found = spline.evaluate(&places, 0, options.threads, &control.still())?;
        let points: Vec<Vector> = found.iter().map(|at| at.point).collect();
        let surface = skeleton(&net, points);
        let (spans, misses) = (vec![1; net.corners.len()], vec![0.0; quads.len()]);
        let figures = vec![CurveFigures::default(); surface.curves.len()];
        let samples = vec![QuadSample::default(); quads.len()];
        let (diagonal, rounds) = (surface.diagonal(), 0);
        Ok(BicubicRefinement {
            spline,
            options,
            control,
            net,
            quads,
            spans,
            samples,
            surface,
            diagonal,
            misses,
            figures,
            rounds,
        })
    }

    /// Makes the patches; those that miss the spline, or fold against their neighbours, are made again with twice the spans.
    ///
    /// # Errors
    /// Those of [`Spline::to_bicubic`].
    pub fn refine(&mut self) -> Result<()> {
        let mut stale: Vec<usize> = (0..self.quads.len()).collect();
        let mut done = 0.0f64;
        while !stale.is_empty() {
            self.check_size()?;
            self.rounds += 1;
            self.sample(&stale)?;
            let changed = self.set_patches();
            self.measure(&changed)?;
            let failing = self.failing();
            done = done.max(1.0 - failing.len() as f64 / self.quads.len() as f64);
            self.control.step(Stage::Build, done)?;
            let mut grown = vec![false; self.spans.len()];
            for &q in &failing {
                self.across(q).iter().for_each(|&v| grown[v] = true);
            }
            for (spans, _) in self.spans.iter_mut().zip(&grown).filter(|(_, grown)| **grown) {
                *spans *= 2;
            }
            if let Some(&q) = failing.iter().find(|&&q| self.spans_of(q).iter().any(|&k| k > MOST_SPANS)) {
                return Err(self.not_reached(q));
            }
            stale = (0..self.quads.len()).filter(|&q| self.across(q).iter().any(|&v| grown[v])).collect();
        }
        Ok(())
    }

    /// Refuses to make more control points than are allowed.
    fn check_size(&self) -> Result<()> {
        let Some(most) = self.options.control_points else { return Ok(()) };
        let of = |q: usize| self.spans_of(q).iter().map(|spans| spans + DEGREE).product::<usize>();
        let needed: usize = (0..self.quads.len()).map(of).sum();
        if needed <= most {
            return Ok(());
        }
        let value = format!("{most} where {needed} or more are needed");
        Err(Error::argument("control points", value, "as many as needed; or take a larger tolerance"))
    }

    /// Checks the patches and returns them with their figures.
    pub fn finish(self) -> Result<BicubicFit> {
        self.surface.check()?;
        let least = self.spans.iter().copied().min().unwrap_or(0);
        let most = self.spans.iter().copied().max().unwrap_or(0);
        Ok(BicubicFit {
            distance: self.misses.iter().copied().fold(0.0, f64::max) / self.diagonal,
            angles: NormalAngles::of(&self.figures),
            surface: self.surface,
            diagonal: self.diagonal,
            spans: [least, most],
            rounds: self.rounds,
        })
    }

    /// The vertices whose numbers of spans a quadrilateral has along s and along t.
    fn across(&self, q: usize) -> [usize; 2] {
        [1, 2].map(|k| self.net.vertices[q / 3][(q + k) % 3] as usize)
    }

    fn spans_of(&self, q: usize) -> [usize; 2] {
        self.across(q).map(|v| self.spans[v])
    }

    /// The quadrilaterals that need more spans.
    fn failing(&self) -> Vec<usize> {
        // A distance that is NaN fails too.
        let is_near = |&miss: &f64| miss <= SHARE * self.options.tolerance * self.diagonal;
        let mut fails: Vec<bool> = self.misses.iter().map(|miss| !is_near(miss)).collect();
        for (of, figures) in self.surface.uses().iter().zip(&self.figures) {
            let is_coarse = |q: usize| self.spans_of(q).iter().all(|&k| k < MOST_SPANS);
            if figures.excess > self.options.angle {
                of.iter().filter(|&&(q, _)| is_coarse(q)).for_each(|&(q, _)| fails[q] = true);
            }
        }
        (0..fails.len()).filter(|&q| fails[q]).collect()
    }

    fn not_reached(&self, q: usize) -> Error {
        let message = format!(
            "with {MOST_SPANS} spans per side it is {:.1e} of the diagonal from the spline, {:.1e} were asked for: ask for less, or fit a \
             smoother spline",
            self.misses[q] / self.diagonal,
            self.options.tolerance,
        );
        Error::Spline { what: "patch", index: self.quads[q].patch(), message }
    }

    /// The spline at places of quadrilaterals, with derivatives up to `order`.
    fn evaluate(&self, at: &[QuadPlace], order: usize) -> Result<Vec<SurfacePoint>> {
        let places: Vec<Parameter> = at.iter().map(|&(q, place)| self.quads[q].place(place)).collect();
        self.spline.evaluate(&places, order, self.options.threads, &self.control.still())
    }

    fn sample(&mut self, quads: &[usize]) -> Result<()> {
        for batch in self.batches(quads) {
            let places = |&q: &usize| grid(self.spans_of(q)).map(move |place| (q, place));
            let at: Vec<QuadPlace> = batch.iter().flat_map(places).collect();
            let points: Vec<Vector> = self.evaluate(&at, 0)?.iter().map(|found| found.point).collect();
            let mut rest = &points[..];
            for &q in batch {
                let [m, n] = self.spans_of(q);
                let (here, later) = rest.split_at((PARTS * m + 1) * (PARTS * n + 1));
                rest = later;
                self.samples[q] = QuadSample::new(here, [m, n]);
            }
        }
        Ok(())
    }

    /// Makes curves and patches from the samples; returns the patches that have changed.
    fn set_patches(&mut self) -> Vec<usize> {
        let across = with_common_planes(&mut self.surface, &self.samples);
        let mut changed = Vec::new();
        for (q, (sample, across)) in self.samples.iter().zip(&across).enumerate() {
            let patch = &mut self.surface.patches[q];
            patch.knots = [uniform(sample.points[0].len() - 1), uniform(sample.points.len() - 1)];
            let before = std::mem::replace(&mut patch.control, tensor(sample, across));
            for k in 0..4 {
                patch.set_side(k, &self.surface.curves[patch.sides[k].curve as usize]);
            }
            if patch.control != before {
                changed.push(q);
            }
        }
        changed
    }

    /// Measures distances between the interpolated points, and the figures of curves.
    fn measure(&mut self, quads: &[usize]) -> Result<()> {
        for batch in self.batches(quads) {
            let cells = |&q: &usize| {
                let [m, n] = self.spans_of(q);
                within(n).flat_map(move |t| within(m).map(move |s| (q, [s, t]))).collect::<Vec<QuadPlace>>()
            };
            let at: Vec<QuadPlace> = batch.iter().flat_map(cells).collect();
            let found = self.evaluate(&at, 0)?;
            batch.iter().for_each(|&q| self.misses[q] = 0.0);
            for ((q, place), found) in at.into_iter().zip(&found) {
                let miss = distance(self.surface.patches[q].evaluate(place).point, found.point);
                // A NaN stays, and fails.
                self.misses[q] = if miss > self.misses[q] || miss.is_nan() { miss } else { self.misses[q] };
            }
        }
        let mut curves: Vec<usize> = quads
            .iter()
            .flat_map(|&q| self.surface.patches[q].sides.map(|side| side.curve as usize))
            .collect();
        curves.sort_unstable();
        curves.dedup();
        let uses = self.surface.uses();
        for batch in curves.chunks(BATCH / (2 * WITHIN.len() * MOST_SPANS)) {
            for (&curve, figures) in
                batch.iter().zip(angles::measure(&self.surface, batch, &uses, |at| self.evaluate(at, 1))?)
            {
                uses[curve].iter().for_each(|&(q, _)| self.misses[q] = self.misses[q].max(figures.miss));
                self.figures[curve] = figures;
            }
        }
        Ok(())
    }

    /// The quadrilaterals in groups with about [`BATCH`] places.
    fn batches<'q>(&self, quads: &'q [usize]) -> std::slice::Chunks<'q, usize> {
        let largest = quads.iter().flat_map(|&q| self.spans_of(q)).max().unwrap_or(1);
        quads.chunks((BATCH / (PARTS * largest + 1).pow(2)).max(1))
    }
}

/// The points, curves and patches of a net, without control points. Points are corners, middles of sides, centroids. Curves are the halves
/// 2 e and 2 e + 1 of each side e, from its begin and its end to its middle; then three for each triangle, from the middles to the
/// centroid.
fn skeleton(net: &TriangleNet, points: Vec<Vector>) -> BicubicSurface {
    let [corners, edges] = [net.corners.len() as u32, net.owners.len() as u32];
    let halves = net.owners.iter().enumerate().flat_map(|(e, &(f, k))| {
        let of = net.vertices[f as usize];
        [of[k], of[(k + 1) % 3]].map(|corner| [corner, corners + e as u32])
    });
    let spokes = net
        .sides
        .iter()
        .enumerate()
        .flat_map(|(f, sides)| sides.map(|side| [corners + side.edge, corners + edges + f as u32]));
    let curve = |ends| PatchCurve { ends, knots: Vec::new(), control: Vec::new() };
    let curves = halves.chain(spokes).map(curve).collect();
    let patch = |q: usize| {
        let (f, k) = (q / 3, q % 3);
        let [here, before] = [k, (k + 2) % 3].map(|k| net.sides[f][k]);
        let spoke = |k: usize| 2 * edges + (3 * f + k) as u32;
        let sides = [
            (2 * here.edge + u32::from(here.reversed), false),
            (spoke(k), false),
            (spoke((k + 2) % 3), true),
            (2 * before.edge + u32::from(!before.reversed), true),
        ];
        let sides = sides.map(|(curve, reversed)| PatchSide { curve, reversed });
        BicubicPatch { source: (f as u32, k), knots: [Vec::new(), Vec::new()], control: Vec::new(), sides }
    };
    BicubicSurface { points, curves, patches: (0..3 * net.sides.len()).map(patch).collect() }
}

/// The control points of the bicubic that interpolates the points and derivatives of a sample: first along s, then along t.
fn tensor(QuadSample { points, twists, .. }: &QuadSample, across: &[Vec<Vector>; 4]) -> Vec<Vec<Vector>> {
    let row = |j: usize| interpolate(&points[j], [across[3][j], across[1][j]]);
    let rows: Vec<Vec<Vector>> = (0..points.len()).map(row).collect();
    let ends =
        [interpolate(&across[0], [twists[0], twists[1]]), interpolate(&across[2], [twists[2], twists[3]])];
    let column = |i: usize| {
        let values: Vec<Vector> = rows.iter().map(|row| row[i]).collect();
        interpolate(&values, [ends[0][i], ends[1][i]])
    };
    (0..rows[0].len()).map(column).collect()
}

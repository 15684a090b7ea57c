//! The vertices of a layout's quads moved along the surface, so that quads become about as large as those around them and none turns over.

use super::fitted_surface::FittedSurface;
use super::piece_form::FootPoint;
use super::target::SplineTarget;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{Vector, add, cross, dot, lerp, normalised, scale, sub};
use crate::parallel;
use crate::quads::QuadLayout;

/// Rounds in which the vertices move, those after which patches are given the part of the surface on which they now lie, and the share of the way
/// to the mean of their neighbours.
const ROUNDS: usize = 120;
const ROUNDS_TO_TARGET: usize = 20;
const TOWARDS_MEAN: f64 = 0.7;
/// Sine of the angle of a quad at a corner, counterclockwise as seen from outside, which does not fall where it is less than this: means of
/// neighbours are not on the surface, and where it is thin their feet may pass each other.
const LEAST_SINE: f64 = 0.2;

/// The moved vertices, and the target of the patches where they now lie.
pub(super) struct RelaxedQuads {
    pub points: Vec<Vector>,
    pub target: SplineTarget,
}

impl RelaxedQuads {
    /// Moves the vertices of the quads along the surface towards the means of their neighbours, so that quads around cones, where the flat metric
    /// has no tangent plane, become as large as those around them; those on creases and the boundary stay. Patches move along the surface with
    /// their vertices. No quad is turned over that was not before.
    ///
    /// # Errors
    /// Those of [`FittedSurface::target`]; [`crate::Error::Cancelled`].
    pub fn new(
        layout: &QuadLayout,
        vertices: Vec<Vector>,
        surface: &FittedSurface<'_>,
        control: &Control,
    ) -> Result<RelaxedQuads> {
        let quads = QuadsOnSurface::new(layout, vertices.len());
        let mut target = surface.target(&surface.faces_at_first(layout, &quads.corners))?;
        let foot = |v: usize, point: Vector| target.foot(quads.patch[v], point);
        let mut at =
            parallel::map(vertices.len(), |v| FootPoint { point: vertices[v], ..foot(v, vertices[v]) });
        for round in 1..=ROUNDS {
            control.check()?;
            at = quads.moved(&at, &target);
            if round % ROUNDS_TO_TARGET == 0 {
                let faces = parallel::map(quads.corners.len(), |p| quads.faces_of(p, &at, &target));
                target = surface.target(&faces)?;
            }
        }
        Ok(RelaxedQuads { points: at.into_iter().map(|foot| foot.point).collect(), target })
    }
}

/// The quads of a layout.
struct QuadsOnSurface<'a> {
    layout: &'a QuadLayout,
    /// Per vertex those with which it shares an edge, once per quad.
    neighbours: Vec<Vec<u32>>,
    /// Per vertex true on creases and the boundary.
    is_fixed: Vec<bool>,
    /// Per vertex a patch in which it is, and per patch its vertices, once per quad.
    patch: Vec<usize>,
    corners: Vec<Vec<u32>>,
}

impl<'a> QuadsOnSurface<'a> {
    fn new(layout: &'a QuadLayout, n_vertices: usize) -> QuadsOnSurface<'a> {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); n_vertices];
        for quad in &layout.mesh.quads {
            for k in 0..4 {
                neighbours[quad[k] as usize].extend([quad[(k + 1) % 4], quad[(k + 3) % 4]]);
            }
        }
        let mut is_fixed = vec![false; n_vertices];
        let on_creases = layout.arcs.iter().filter(|arc| arc.is_crease).flat_map(|arc| &arc.vertices);
        on_creases.for_each(|&v| is_fixed[v as usize] = true);
        neighbours.iter().zip(&mut is_fixed).for_each(|(around, fixed)| *fixed |= around.is_empty());
        let (mut corners, mut patch): (Vec<Vec<u32>>, Vec<usize>) = (Vec::new(), vec![0; n_vertices]);
        for (p, of) in layout.patches.iter().enumerate() {
            corners.push(of.quads.iter().flat_map(|&q| layout.mesh.quads[q as usize]).collect());
            corners[p].iter().for_each(|&v| patch[v as usize] = p);
        }
        QuadsOnSurface { layout, neighbours, is_fixed, patch, corners }
    }

    /// The vertices after a round; those around which a quad would turn over stay.
    fn moved(&self, at: &[FootPoint], target: &SplineTarget) -> Vec<FootPoint> {
        let towards_mean = |v: usize| {
            let around = self.neighbours[v].iter().map(|&w| at[w as usize].point);
            let mean = scale(1.0 / self.neighbours[v].len() as f64, around.fold([0.0; 3], add));
            target.foot(self.patch[v], lerp(at[v].point, mean, TOWARDS_MEAN))
        };
        let mut next = parallel::map(at.len(), |v| if self.is_fixed[v] { at[v] } else { towards_mean(v) });
        let before = self.least_sines(at);
        loop {
            let sines = self.least_sines(&next);
            let is_worse = |q: &usize| sines[*q] < LEAST_SINE && sines[*q] < before[*q];
            let mut is_settled = true;
            for v in (0..sines.len()).filter(is_worse).flat_map(|q| self.layout.mesh.quads[q]) {
                is_settled &= next[v as usize] == at[v as usize];
                next[v as usize] = at[v as usize];
            }
            if is_settled {
                return next;
            }
        }
    }

    /// Per quad the least sine of its angles, as seen along the mean normal at its vertices that are not fixed: at others the surface may have
    /// several normals. 1 where all are fixed.
    fn least_sines(&self, at: &[FootPoint]) -> Vec<f64> {
        let quads = &self.layout.mesh.quads;
        parallel::map(quads.len(), |q| {
            let free = quads[q].iter().map(|&v| v as usize).filter(|&v| !self.is_fixed[v]);
            let sum = free.map(|v| at[v].normal).fold([0.0; 3], add);
            if sum == [0.0; 3] {
                return 1.0;
            }
            let normal = normalised(sum);
            let side = |k: usize| {
                let [a, b] = [k, k + 1].map(|k| at[quads[q][k % 4] as usize].point);
                normalised(sub(b, a))
            };
            let sine = |k: usize| dot(cross(side(k + 3), side(k)), normal);
            (0..4).map(sine).fold(1.0, f64::min)
        })
    }

    /// The faces on which the free vertices of a patch lie; where there are none, that of one of its corners.
    fn faces_of(&self, patch: usize, at: &[FootPoint], target: &SplineTarget) -> Vec<u32> {
        let face = |v: u32| target.face_near(self.patch[v as usize], at[v as usize].point);
        let corners = &self.corners[patch];
        let free: Vec<u32> =
            corners.iter().filter(|&&v| !self.is_fixed[v as usize]).map(|&v| face(v)).collect();
        if free.is_empty() { vec![target.face_near(patch, at[corners[0] as usize].point)] } else { free }
    }
}

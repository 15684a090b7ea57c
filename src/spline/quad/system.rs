//! The normal equations of a fit: squared distances of places of the patches from their feet, and the bending of the patches.

use super::layout::PatchCorner;
use super::nearest::NearestToVertex;
use super::patch_sum::{PatchSum, bending, tensor};
use super::patch_unknowns::{PatchEquations, PatchUnknowns};
use super::piece_form::{FootPoint, PieceForm};
use super::quintic::QuinticBasis;
use super::space::QuadSplineSpace;
use super::span_direction::SpanDirection;
use super::spline::QuadSpline;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, dot, sub};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::parallel;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The weight of distances from flat pieces of the target against those from others, so that their patches are flat too.
const OF_FLAT: f64 = 1e6;
/// That of distances from pieces on cylinders, near which polynomials come but on which they do not lie.
const OF_ROUND: f64 = 1e3;
/// The weight of the squared way from where places were, over that of its gradient.
const OF_WAY: f64 = 1e-3;
/// The weight of all vertices of the target against that of all places of the patches.
const VERTICES: f64 = 1.0;

/// The weights of the terms of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct FitWeights {
    /// That of the squared distance from the tangent plane at the foot.
    pub normal: f64,
    /// That of ∫ S_uu² + 2 S_uv² + S_vv² over the rectangles of the parameters.
    pub bending: f64,
}

/// A place of a patch.
pub(super) struct FitPlace {
    pub basis: [QuinticBasis; 2],
    pub parameters: [f64; 2],
    /// The share of the patch that it stands for.
    weight: f64,
}

/// What a fit comes near: a foot for every place of a patch, and for every patch the vertices of the target that are nearest to it.
pub(super) struct FitGoal<'a> {
    pub weights: FitWeights,
    /// Per patch the weight of the squared distance from the foot or, where patches keep their shape, of the squared gradient of the way from the spline
    /// before.
    pub tangential: &'a [f64],
    /// The spline before, and per patch true if it keeps its shape; none at the start.
    pub shape: Option<(&'a QuadSpline, &'a [bool])>,
    /// Those of the places of a patch, in order.
    pub feet: &'a (dyn Fn(usize) -> &'a [FootPoint] + Sync),
    pub vertices: &'a (dyn Fn(usize) -> &'a [NearestToVertex] + Sync),
}

/// The normal equations of fits over a space. Unknown 3 k + c is coordinate c of the free control point k.
pub(super) struct QuadSystem {
    space: Arc<QuadSplineSpace>,
    /// By numbers of spans the directions of patches.
    along: BTreeMap<usize, SpanDirection>,
    /// The area of all patches in parameters.
    area: f64,
    /// Per patch the weight of the distances of its places.
    of_places: Vec<f64>,
    patches: Vec<PatchUnknowns>,
    /// Which free control points are coupled.
    blocks: Pattern,
    pattern: Pattern,
    cholesky: Cholesky,
}

impl QuadSystem {
    /// `forms`: per patch the plane or cylinder on which its piece of the target lies.
    pub fn new(space: Arc<QuadSplineSpace>, forms: &[Option<PieceForm>]) -> Result<QuadSystem> {
        let patches = parallel::map(space.layout().patches().len(), |p| PatchUnknowns::new(&space, p));
        let pairs: Vec<(u32, u32)> = patches.iter().flat_map(PatchUnknowns::pairs).collect();
        let blocks = Pattern::new(space.dimension(), &pairs)?;
        let (pattern, cholesky) = Cholesky::analyse_blocks(&blocks, 3)?;
        let along = space.spans().iter().map(|&spans| (spans, SpanDirection::new(spans))).collect();
        let of_patch = |p: usize| lengths(&space, p).iter().product::<f64>();
        let area = (0..space.layout().patches().len()).map(of_patch).sum();
        let of_places = |form: &Option<PieceForm>| match form {
            Some(PieceForm::Plane(_)) => OF_FLAT,
            Some(PieceForm::Cylinder(..)) => OF_ROUND,
            None => 1.0,
        };
        let of_places = forms.iter().map(of_places).collect();
        Ok(QuadSystem { space, along, area, of_places, patches, blocks, pattern, cholesky })
    }

    /// The space of the splines.
    pub fn space(&self) -> &Arc<QuadSplineSpace> {
        &self.space
    }

    /// The free control points at which the weighted sum of squares is least.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where the places do not determine the spline.
    pub fn solve(&mut self, goal: &FitGoal<'_>) -> Result<Vec<Vector>> {
        let found = parallel::map(self.patches.len(), |p| self.of_patch(p, goal));
        let mut values = vec![0.0; self.pattern.entries()];
        let mut right = vec![0.0; 3 * self.space.dimension()];
        for (patch, equations) in self.patches.iter().zip(&found) {
            patch.add(equations, [&self.blocks, &self.pattern], &mut values, &mut right);
        }
        self.cholesky.factor(Symmetric { pattern: &self.pattern, values: &values }).map_err(|_| {
            let message = "the equations of the fit are not positive definite: ask for more bending";
            Error::Factorisation { size: self.pattern.size(), message: message.into() }
        })?;
        self.cholesky.solve(&mut right);
        Ok(right.as_chunks::<3>().0.to_vec())
    }

    /// The places of a patch: those of Gauss in every span and direction.
    pub fn places(&self, p: usize) -> impl Iterator<Item = FitPlace> + '_ {
        let [of_u, of_v] = self.space.patch_spans(p).map(|spans| &self.along[&spans].places);
        of_u.iter().flat_map(move |u| {
            of_v.iter().map(move |v| FitPlace {
                basis: [u.basis, v.basis],
                parameters: [u.parameter, v.parameter],
                weight: u.weight * v.weight,
            })
        })
    }

    /// The places within a patch at which a fit is measured, each with the number of the nearest of [`QuadSystem::places`].
    pub fn measured(&self, p: usize) -> impl Iterator<Item = ([&QuinticBasis; 2], usize)> + '_ {
        let [of_u, of_v] = self.space.patch_spans(p).map(|spans| &self.along[&spans]);
        let n = of_v.places.len();
        of_u.measured
            .iter()
            .flat_map(move |(u, i)| of_v.measured.iter().map(move |(v, j)| ([u, v], i * n + j)))
    }

    /// The squared distances of the places of a patch from their feet and of vertices from theirs, with the weights that [`QuadSystem::solve`]
    /// gives them.
    pub fn squares(
        &self,
        spline: &QuadSpline,
        p: usize,
        feet: &[FootPoint],
        vertices: &[NearestToVertex],
    ) -> f64 {
        let square = |a: Vector, b: Vector| sub(a, b).map(|x| x * x).iter().sum::<f64>();
        let [a, b] = lengths(&self.space, p);
        let of_place = |(place, foot): (FitPlace, &FootPoint)| {
            self.of_places[p]
                * a
                * b
                * place.weight
                * square(spline.point(p, [&place.basis[0], &place.basis[1]]), foot.point)
        };
        let of_vertex = |NearestToVertex { vertex, parameters, .. }: &NearestToVertex| {
            VERTICES * self.area * vertex.share * square(spline.point_at(p, *parameters), vertex.point)
        };
        self.places(p).zip(feet).map(of_place).sum::<f64>() + vertices.iter().map(of_vertex).sum::<f64>()
    }

    /// ∫ S_uu² + 2 S_uv² + S_vv² over the rectangles of the parameters.
    pub fn bending_of(&self, spline: &QuadSpline) -> f64 {
        let of_patch = |p: usize| {
            let net: Vec<Vector> = spline.net(p).into_iter().flatten().collect();
            let along = self.space.patch_spans(p).map(|spans| &self.along[&spans]);
            let bent = bending(lengths(&self.space, p), along);
            let of_pair = |i: usize, j: usize| {
                let twice = if i == j { 1.0 } else { 2.0 };
                twice * bent(i, j) * dot(net[i], net[j])
            };
            let overlaps = self.patches[p].overlaps;
            let of_point = |i: usize| overlaps.up_to(i).map(|j| of_pair(i, j)).sum::<f64>();
            (0..net.len()).map(of_point).sum::<f64>()
        };
        parallel::map(self.patches.len(), of_patch).into_iter().sum()
    }

    /// The equations of a patch on the free control points.
    fn of_patch(&self, p: usize, goal: &FitGoal<'_>) -> PatchEquations {
        let weights = goal.weights;
        let along = self.space.patch_spans(p).map(|spans| &self.along[&spans]);
        let tangential = goal.tangential[p];
        // Sides move, and the places between go with them: what is kept is the shape, and next to nothing of where it was.
        let shape = goal.shape.filter(|(_, is_kept)| is_kept[p]).map(|(before, _)| before);
        let along_surface = if shape.is_some() { OF_WAY * tangential } else { tangential };
        let of_distance = [weights.normal, along_surface];
        let [a, b] = lengths(&self.space, p);
        let mut sum = PatchSum::new(self.patches[p].overlaps, [a, b]);
        for (place, &FootPoint { point, normal }) in self.places(p).zip((goal.feet)(p)) {
            let [along_normal, tangential] = of_distance;
            let tensor = tensor(normal, [self.of_places[p] * along_normal, tangential], a * b * place.weight);
            sum.add(&place.basis, &tensor, point);
        }
        sum.bend(weights.bending, along);
        if let Some(before) = shape {
            sum.keep_shape(tangential, along, &before.net(p).concat());
        }
        let spans = self.space.patch_spans(p);
        for NearestToVertex { vertex, normal, parameters } in (goal.vertices)(p) {
            let basis = [0, 1].map(|k| QuinticBasis::at(spans[k], parameters[k]));
            let weight = VERTICES * self.area * vertex.share;
            let tensor = tensor(*normal, of_distance, weight);
            sum.add(&basis, &tensor, vertex.point);
        }
        self.patches[p].extracted(&sum)
    }
}

/// The lengths in parameters of the first two sides of a patch.
fn lengths(space: &QuadSplineSpace, patch: usize) -> [f64; 2] {
    [0, 1].map(|corner| space.layout().length(PatchCorner { patch, corner }))
}

//! The Newton system of a map: two unknowns per vertex, one sparse pattern for all steps.

use super::rest_triangle::TriangleModel;
use super::seam_ties::SeamTies;
use super::term::Term;
use super::tied_matrix::TiedMatrix;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::Mesh;
use crate::parallel;

/// Share of the mean diagonal entry that is added to the diagonal: the energy does not change with shifts and turns of the map, so that the
/// matrix alone is singular.
const SHIFT: f64 = 1e-10;
/// Factor of that share where the clamped matrix has lost its definiteness to rounding, and the most times that it is applied.
const MORE_SHIFT: f64 = 1e3;
const MOST_SHIFTS: i32 = 3;

/// Further terms whose parts of the matrix are found before they are added.
const BLOCK: usize = 1 << 16;

/// The matrix and the right-hand side of Newton steps.
pub(super) struct DescentMatrix<'a> {
    mesh: &'a Mesh,
    /// The pairs of vertices beside those of edges whose unknowns share an entry.
    pairs: Vec<[u32; 2]>,
    pattern: Pattern,
    /// Per face the places of the 21 entries of its Hessian among the stored values.
    places: Vec<[u32; 21]>,
    corners: Vec<[u32; 3]>,
    models: Vec<TriangleModel>,
    values: Vec<f64>,
    /// The matrix in the unknowns of points that are tied along seams; none where every point is free.
    tied: Option<TiedMatrix<'a>>,
    tied_values: Vec<f64>,
    ties: Option<&'a SeamTies>,
    cholesky: Cholesky,
    gradient: Vec<f64>,
}

impl<'a> DescentMatrix<'a> {
    /// `pairs`: the vertices that further terms join, beside those of edges. `ties`: of vertices along seams, if there are any.
    ///
    /// # Errors
    /// Those of [`Pattern::new`] and [`Cholesky::analyse`]; [`Error::Cancelled`].
    pub fn new(
        mesh: &'a Mesh,
        pairs: Vec<[u32; 2]>,
        ties: Option<&'a SeamTies>,
        control: &Control,
    ) -> Result<DescentMatrix<'a>> {
        let n = 2 * mesh.n_vertices();
        let within = mesh.vertices().map(|v| (2 * v.0 + 1, 2 * v.0));
        let apart = pairs.iter().copied().filter(|[a, b]| a != b);
        let across = mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).chain(apart).flat_map(|ends| {
            let [a, b] = ends.map(|v| 2 * v);
            [(a, b), (a, b + 1), (a + 1, b), (a + 1, b + 1)]
        });
        if n >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "coordinates of a flat map", count: n });
        }
        let pattern = Pattern::new(n, &within.chain(across).collect::<Vec<_>>())?;
        control.check()?;
        let corners = mesh.triangles();
        let mut places = vec![[0; 21]; corners.len()];
        parallel::fill(&mut places, |f| places_of(&pattern, corners[f]));
        let tied = ties.map(|ties| TiedMatrix::new(ties, &pattern)).transpose()?;
        let tied_values = vec![0.0; tied.as_ref().map_or(0, |tied| tied.pattern.entries())];
        let cholesky = Cholesky::analyse(tied.as_ref().map_or(&pattern, |tied| &tied.pattern))?;
        let models = vec![TriangleModel { gradient: [0.0; 6], hessian: [0.0; 21] }; corners.len()];
        let (values, gradient) = (vec![0.0; pattern.entries()], vec![0.0; n]);
        Ok(DescentMatrix {
            mesh,
            pairs,
            pattern,
            places,
            corners,
            models,
            values,
            tied,
            tied_values,
            ties,
            cholesky,
            gradient,
        })
    }

    /// Makes room for the entries that these pairs of vertices share.
    ///
    /// # Errors
    /// Those of [`DescentMatrix::new`].
    pub fn hold(&mut self, pairs: Vec<[u32; 2]>, control: &Control) -> Result<()> {
        let has = |[a, b]: &[u32; 2]| self.pattern.position(2 * *a as usize, 2 * *b as usize).is_some();
        if pairs.iter().all(has) {
            return Ok(());
        }
        let mut all = [std::mem::take(&mut self.pairs), pairs].concat();
        all.iter_mut().for_each(|pair| pair.sort_unstable());
        all.sort_unstable();
        all.dedup();
        *self = DescentMatrix::new(self.mesh, all, self.ties, control)?;
        Ok(())
    }

    /// Fills in the gradient and the Hessian of the triangles.
    pub fn assemble(&mut self, model: impl Fn(usize) -> TriangleModel + Sync) {
        parallel::fill(&mut self.models, model);
        self.values.fill(0.0);
        self.gradient.fill(0.0);
        for ((model, places), corners) in self.models.iter().zip(&self.places).zip(&self.corners) {
            PlacedModel { model, places, corners }.add_to(&mut self.values, &mut self.gradient);
        }
    }

    /// Adds the gradient and the Hessian of further terms.
    pub fn add_terms(&mut self, terms: &[Term], model: impl Fn(&Term) -> TriangleModel + Sync) {
        let parts = |term: &Term| {
            let corners = term.corners();
            (model(term), places_of(&self.pattern, corners), corners)
        };
        for block in terms.chunks(BLOCK) {
            for (model, places, corners) in parallel::map(block.len(), |k| parts(&block[k])) {
                let placed = PlacedModel { model: &model, places: &places, corners: &corners };
                placed.add_to(&mut self.values, &mut self.gradient);
            }
        }
    }

    /// The Newton step from the points of the last assembly; `None` where the Hessian is not positive definite, or the step does not lead
    /// down. A clamped Hessian is only not definite by rounding, and gets a larger share of the mean diagonal.
    pub fn step(&mut self, clamped: bool) -> Option<NewtonStep> {
        let (pattern, values) = match &self.tied {
            Some(tied) => {
                tied.fill(&self.values, &mut self.tied_values);
                (&tied.pattern, &mut self.tied_values)
            }
            None => (&self.pattern, &mut self.values),
        };
        let n = pattern.size();
        let mean = (0..n).map(|i| values[pattern.diagonal(i)]).sum::<f64>() / n as f64;
        let (most, mut added) = (if clamped { MOST_SHIFTS } else { 0 }, 0.0);
        for k in 0..=most {
            let shift = SHIFT * MORE_SHIFT.powi(k) * mean;
            for i in 0..n {
                values[pattern.diagonal(i)] += shift - added;
            }
            added = shift;
            if self.cholesky.factor(Symmetric { pattern, values }).is_ok()
                && let Some(step) = solved(&mut self.cholesky, &self.gradient, self.tied.as_ref())
            {
                return Some(step);
            }
        }
        None
    }

    /// The largest slope of the last assembly in an unknown.
    pub fn steepest(&self) -> f64 {
        let most = |slopes: &[f64]| slopes.iter().fold(0.0, |most, g| f64::max(most, g.abs()));
        match &self.tied {
            Some(tied) => most(&tied.slopes(&self.gradient)),
            None => most(&self.gradient),
        }
    }
}

/// The Newton step with a matrix that is factored, if it does not lead up.
fn solved(cholesky: &mut Cholesky, gradient: &[f64], tied: Option<&TiedMatrix<'_>>) -> Option<NewtonStep> {
    let slopes = tied.map(|tied| tied.slopes(gradient));
    let slopes = slopes.as_deref().unwrap_or(gradient);
    let mut x: Vec<f64> = slopes.iter().map(|g| -g).collect();
    cholesky.solve(&mut x);
    let slope: f64 = slopes.iter().zip(&x).map(|(g, d)| g * d).sum();
    let direction = match tied {
        Some(tied) => tied.steps(&x),
        None => x.as_chunks::<2>().0.to_vec(),
    };
    (slope <= 0.0).then_some(NewtonStep { direction, slope })
}

/// A model with the places of its entries and its corners.
struct PlacedModel<'a> {
    model: &'a TriangleModel,
    places: &'a [u32; 21],
    corners: &'a [u32; 3],
}

impl PlacedModel<'_> {
    fn add_to(&self, values: &mut [f64], gradient: &mut [f64]) {
        for (value, &place) in self.model.hessian.iter().zip(self.places) {
            values[place as usize] += value;
        }
        for (k, &v) in self.corners.iter().enumerate() {
            gradient[2 * v as usize] += self.model.gradient[2 * k];
            gradient[2 * v as usize + 1] += self.model.gradient[2 * k + 1];
        }
    }
}

/// A Newton step, and the slope of the energy along it, which is not positive.
pub(super) struct NewtonStep {
    pub direction: Vec<[f64; 2]>,
    pub slope: f64,
}

/// The places of the lower triangle of the 6 × 6 Hessian of these corners. They are in the pattern, since corners are ends of edges or of
/// pairs that it was made for.
fn places_of(pattern: &Pattern, corners: [u32; 3]) -> [u32; 21] {
    let unknown = |i: usize| 2 * corners[i / 2] as usize + i % 2;
    let pairs = (0..6).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let mut places = [0; 21];
    for (place, (i, j)) in places.iter_mut().zip(pairs) {
        *place = pattern.position(unknown(i), unknown(j)).unwrap_or_default() as u32;
    }
    places
}

//! Dilatations from below by energies: a map of dilatation K changes the energies of classes of forms at most by the factor K, so K is at least the
//! largest ratio of energies of classes that correspond, the largest eigenvalue of one energy matrix against the other.
//!
//! Surfaces with boundary are doubled. A map between them and its mirror image are a map between the doubles, of the same dilatation.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::harmonic::{Domain, FormsOptions, HarmonicForms};
use crate::linalg::dense::{cholesky, symmetric_eigenvalues};
use crate::mesh::{Double, EdgeId, HalfedgeId, PerEdge, PerFace};
use crate::metric::Surface;
use crate::metric::common_subdivision::CommonSubdivision;
use crate::moduli::{BoundsOptions, PeriodBounds, parts_of_edges, period_bounds};

/// Largest distance of an integral from a whole number.
const WHOLE: f64 = 1e-3;
/// Relative rounding of eigenvalues.
pub(super) const ROUNDING: f64 = 1e-12;

/// What energies of both surfaces prove.
pub(super) struct EnergyRatio {
    /// No map of the class has a smaller dilatation.
    pub ratio: f64,
    pub gaps: [f64; 2],
    /// True if both have one triangulation, and the map brings loops to homologous ones of the same edges.
    pub keeps_loops: bool,
}

/// A surface without boundary: the given one, or its double, with the half-edges of the given one.
struct ClosedSurface {
    domain: Domain,
    /// Per edge the given one that it is or mirrors.
    origin: Vec<EdgeId>,
    /// Per copy, 0 or 1, and given edge the edge there.
    copies: [Vec<EdgeId>; 2],
}

impl ClosedSurface {
    fn new(surface: &Surface) -> Result<ClosedSurface> {
        let mesh = surface.mesh();
        let given: Vec<EdgeId> = mesh.edges().collect();
        if mesh.is_closed() {
            let copies = [given.clone(), given.clone()];
            return Ok(ClosedSurface { domain: Domain::rigid(surface)?, origin: given, copies });
        }
        let double = Double::new(mesh)?;
        let lengths: Vec<f64> = surface.lengths().iter().copied().collect();
        let lengths = PerEdge::from(double.spread_edges(&lengths)?);
        let origin = double.spread_edges(&given)?;
        let mut images = given.clone();
        origin.iter().enumerate().skip(given.len()).for_each(|(k, e)| images[e.index()] = EdgeId::from(k));
        let closed = Surface::intrinsic(double.mesh, lengths, surface.geometry())?;
        Ok(ClosedSurface { domain: Domain::rigid(&closed)?, origin, copies: [given, images] })
    }

    /// The given half-edge that a half-edge is or mirrors, in its direction, and the copy that it is in.
    fn given(&self, h: HalfedgeId) -> (HalfedgeId, usize) {
        let e = self.origin[h.edge().index()];
        let copy = usize::from(self.copies[0][e.index()] != h.edge());
        (HalfedgeId(2 * e.0 + (h.0 & 1)), copy)
    }

    /// The half-edge of a copy that a given one is or that mirrors it, in its direction.
    fn copy(&self, h: HalfedgeId, copy: usize) -> HalfedgeId {
        HalfedgeId(2 * self.copies[copy][h.edge().index()].0 + (h.0 & 1))
    }
}

/// The values of a cochain on oriented edges.
struct CochainValues(PerEdge<i32>);

impl CochainValues {
    fn new(n_edges: usize, cells: &[(EdgeId, i32)]) -> CochainValues {
        let mut values = PerEdge::filled(n_edges, 0);
        cells.iter().for_each(|&(e, x)| values[e] = x);
        CochainValues(values)
    }

    fn on(&self, h: HalfedgeId) -> i32 {
        if h.0 & 1 == 0 { self.0[h.edge()] } else { -self.0[h.edge()] }
    }
}

/// The largest ratio, of either surface to the other, that energies of classes which correspond certainly have, and the gaps.
///
/// # Errors
/// [`Error::Matching`] for a subdivision through which loops do not close; those of [`HarmonicForms::new`] and [`period_bounds`].
pub(super) fn ratio_of_energies(
    surfaces: [&Surface; 2],
    overlay: &CommonSubdivision,
    options: &BoundsOptions,
    control: &Control,
) -> Result<EnergyRatio> {
    let closed = [ClosedSurface::new(surfaces[0])?, ClosedSurface::new(surfaces[1])?];
    let of = |s: usize| -> Result<(HarmonicForms, PeriodBounds)> {
        let control = control.part(0.5 * s as f64, 0.5 * s as f64 + 0.5);
        let forms = HarmonicForms::new(&closed[s].domain, &FormsOptions::default(), &control.part(0.0, 0.3))?;
        let bounds = period_bounds(&forms, options, &control.part(0.3, 1.0))?;
        Ok((forms, bounds))
    };
    let [(forms, bounds), (others, other)] = [of(0)?, of(1)?];
    let pullback = ClassPullback { surfaces, closed: &closed, overlay };
    let classes = pullback.integrals([&forms, &others])?;
    // The energies of the classes on the source that those of the target's basis are pulled back to.
    let own = bounds.energies();
    let n = own.len();
    let through = |i: usize, j: usize| -> f64 {
        let row = |i: usize, l: usize| (0..n).map(|k| classes[i][k] * own[k][l]).sum::<f64>();
        (0..n).map(|l| row(i, l) * classes[j][l]).sum()
    };
    let source: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| through(i, j)).collect()).collect();
    let ratios = relative_eigenvalues(&source, &other.energies())?;
    let (least, largest) = (ratios[0], ratios[n - 1]);
    let blur = (1.0 + bounds.gap) * (1.0 + other.gap);
    let ratio = largest.max(1.0 / least) / blur * (1.0 - ROUNDING);
    let keeps_loops = surfaces[0].mesh() == surfaces[1].mesh() && classes == by_edges(&forms, &others);
    Ok(EnergyRatio { ratio, gaps: [bounds.gap, other.gap], keeps_loops })
}

/// Per class of the target its integrals over the edges of the loops of the source's basis, on one triangulation.
fn by_edges(forms: &HarmonicForms, others: &HarmonicForms) -> Vec<Vec<f64>> {
    let class = |cells: &[(EdgeId, i32)]| -> Vec<f64> {
        let values = CochainValues::new(forms.domain.mesh().n_edges(), cells);
        let around = |path: &Vec<HalfedgeId>| f64::from(path.iter().map(|&h| values.on(h)).sum::<i32>());
        forms.basis.loops.iter().map(around).collect()
    };
    others.cochains.iter().map(|cochain| class(&cochain.0)).collect()
}

/// The eigenvalues of `a⁻¹ b`, ascending.
fn relative_eigenvalues(a: &[Vec<f64>], b: &[Vec<f64>]) -> Result<Vec<f64>> {
    let (lower, n) = (cholesky(a)?, a.len());
    // L⁻¹ b L⁻ᵀ, by forward substitution from both sides.
    let solve = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let mut x = rows;
        for i in 0..n {
            for j in 0..n {
                let sum: f64 = (0..i).map(|k| lower[i][k] * x[k][j]).sum();
                x[i][j] = (x[i][j] - sum) / lower[i][i];
            }
        }
        (0..n).map(|j| x.iter().map(|row| row[j]).collect()).collect()
    };
    symmetric_eigenvalues(&solve(solve(b.to_vec())))
}

/// A map, and its mirror image on doubles, that classes are pulled back by.
struct ClassPullback<'a> {
    surfaces: [&'a Surface; 2],
    closed: &'a [ClosedSurface; 2],
    overlay: &'a CommonSubdivision,
}

impl ClassPullback<'_> {
    /// Per class of the target the integrals of its pullback over the loops of the source's basis, whole numbers.
    fn integrals(&self, [forms, others]: [&HarmonicForms; 2]) -> Result<Vec<Vec<f64>>> {
        let [source, target] = self.closed;
        let paths: Vec<Vec<(HalfedgeId, usize)>> =
            forms.basis.loops.iter().map(|path| path.iter().map(|&h| source.given(h)).collect()).collect();
        let given: Vec<Vec<HalfedgeId>> =
            paths.iter().map(|path| path.iter().map(|step| step.0).collect()).collect();
        let parts = parts_of_edges(self.overlay, &self.overlay.mesh, &given);
        let (mesh, n_edges) = (self.surfaces[1].mesh(), target.domain.mesh().n_edges());
        let torn = || Error::Matching("loops of the source do not go to closed loops of the target".into());
        let class = |cells: &[(EdgeId, i32)]| -> Result<Vec<f64>> {
            let values = CochainValues::new(n_edges, cells);
            // Per copy the functions on the faces whose derivative the class is.
            let potentials = [0, 1].map(|copy| {
                let on = |h: HalfedgeId| f64::from(values.on(target.copy(h, copy)));
                PerFace::from_fn(mesh.n_faces(), |f| {
                    let [ab, bc, _] = mesh.face_halfedges(f);
                    [0.0, on(ab), on(ab) + on(bc)]
                })
            });
            let integral = |path: &Vec<(HalfedgeId, usize)>| -> Result<f64> {
                let step = |(h, copy): &(HalfedgeId, usize)| -> f64 {
                    parts[h].iter().map(|&part| integral_along(self.overlay, &potentials[*copy], part)).sum()
                };
                let sum: f64 = path.iter().map(step).sum();
                if (sum - sum.round()).abs() <= WHOLE { Ok(sum.round()) } else { Err(torn()) }
            };
            paths.iter().map(integral).collect()
        };
        others.cochains.iter().map(|cochain| class(&cochain.0)).collect()
    }
}

/// The integral over a half-edge of the subdivision of the form that is the derivative of a linear function on every face of the target.
fn integral_along(overlay: &CommonSubdivision, potential: &PerFace<[f64; 3]>, part: HalfedgeId) -> f64 {
    let (mesh, sign, h) = match overlay.mesh.face(part) {
        Some(_) => (&overlay.mesh, 1.0, part),
        None => (&overlay.mesh, -1.0, part.twin()),
    };
    let Some(f) = mesh.face(h) else { return 0.0 };
    let k = mesh.face_halfedges(f).iter().position(|&side| side == h).unwrap_or(0);
    let places = overlay.barycentric(1, f);
    let at = |w: [f64; 3]| -> f64 { w.iter().zip(potential[overlay.faces[1][f]]).map(|(w, u)| w * u).sum() };
    sign * (at(places[(k + 1) % 3]) - at(places[k]))
}

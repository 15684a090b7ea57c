//! Places cones, with their curvatures, such that the distortion of area is low.
//!
//! To first order the conformal factor u between a surface and the metric with curvature K̄ solves `L u = K̄ − K`, L being the
//! cotangent Laplacian (∂K/∂u at u = 0), exact for smooth surfaces with K̄ = 0 off the cones. The distortion of area is
//! `E = ½ ∫ (u − ū)² dA` \[SSC18, §3\]. Cones are placed one by one \[SSP08, §5\], here by the gradient of E itself: with
//! `L w = (u − ū) dA`, `∂E/∂K̄_v = w_v`. At the best curvatures of given cones w has one value at all of them, and the next cone
//! goes where w differs most from it. Then each cone in turn is taken away and placed anew, as long as that lowers E.
//!
//! Each place that is tried costs two solutions with one factorisation: `H_v = L⁻¹ M L⁻¹ δ_v`. All other quantities follow from these:
//! E is a quadratic form in the curvatures with the matrix `H_v(v')`, and `w = w₀ + Σ K̄_v H_v`.

use super::cone_angles::{ConeAngles, angles};
use super::evaluate::FlowState;
use super::system::NewtonSystem;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::delaunay::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
use crate::metric::target::boundary_lengths;
use crate::metric::{Class, Metric, Surface, Target, initial_metric};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Largest number of cones that are placed: the dense equations of more would take longer than the sparse ones of the surface.
pub const MAX_AUTO_CONES: usize = 256;
/// The least angle around a cone that is placed (half of it at the boundary): near a cone of angle θ lengths grow like the power
/// θ/2π of the distance, so narrower ones squeeze a whole neighbourhood into nothing. Three such cones still close a sphere.
pub const LEAST_ANGLE: f64 = PI / 6.0;
/// How many times each cone is taken away and placed anew. Few move in the second round.
const SWEEPS: usize = 2;
/// Least relative decrease of E by which a cone is moved: smaller changes may be rounding, which must not decide between equal places.
const WORTH_MOVING: f64 = 1e-6;
/// Residual that a linear solution may leave, for right-hand sides of order 1.
const ENOUGH: f64 = 1e-11;
/// Shift of the Laplacian, relative to its mean diagonal, if rounding leaves it without a factor.
const SHIFT: f64 = 1e-12;

/// Cones that [`auto_cones`] placed.
#[derive(Debug, Clone, PartialEq)]
pub struct AutoCones {
    /// Interior vertices with their curvature (radians), in the order of the vertices.
    pub cones: Vec<(VertexId, f64)>,
    /// The curvature of every vertex: the cones, on the boundary what follows from u = 0 there, 0 elsewhere. Admissible in E²,
    /// total 2πχ.
    pub target: PerVertex<f64>,
    /// `∫ (u − ū)² dA / ∫ dA` that the linear model expects with 0, 1, … cones; on closed surfaces (χ ≠ 0) that with none has the
    /// curvature 2πχ spread evenly over the area. The last is that of the result.
    pub distortion: Vec<f64>,
}

/// Place `n` cones, and choose their curvatures, so that a conformal map that is flat elsewhere changes areas little.
///
/// `lengths`: E entries, read in E². Open surfaces keep u = 0 on the boundary (the free boundary of least distortion), and the
/// boundary's curvature is the one that follows. The cones depend on the surface alone, not on its triangulation (intrinsic
/// Delaunay), up to the vertices there are; ties go to the smallest index. The same for any number of threads.
///
/// One factorisation and about 6n solutions: O(V^1.5 + n V log V) in practice, and n·V numbers of memory.
///
/// # Errors
/// - [`Error::TargetKind`] for an n that the surface cannot have. Closed of genus 0: 3 at least; genus 1: not 1; genus ≥ 2: 1 at
///   least; [`MAX_AUTO_CONES`] and the number of interior vertices at most.
/// - [`Error::EdgeLength`], [`Error::TriangleInequality`], [`Error::Factorisation`], [`Error::Cancelled`].
///
/// ```
/// # use ricci::{Control, Surface, flow::auto_cones, mesh::shapes};
/// let sphere = Surface::from_soup(&shapes::icosphere(4)?)?;
/// let placed = auto_cones(sphere.mesh(), sphere.lengths(), 4, &Control::new())?;
/// let total: f64 = placed.cones.iter().map(|cone| cone.1).sum();
/// assert!(placed.cones.len() == 4 && (total - 4.0 * std::f64::consts::PI).abs() < 1e-12);
/// # Ok::<(), ricci::Error>(())
/// ```
pub fn auto_cones(mesh: &Mesh, lengths: &PerEdge<f64>, n: usize, control: &Control) -> Result<AutoCones> {
    check_number(mesh, n)?;
    let mut place = ConePlacement::new(mesh, lengths, LEAST_ANGLE, control)?;
    let mut distortion = vec![2.0 * place.energy];
    for k in 0..n {
        control.step(Stage::Flow, k as f64 / (n + SWEEPS * n) as f64)?;
        place.add_best()?;
        distortion.push(2.0 * place.energy);
    }
    place.sweep()?;
    place.finish(mesh, lengths, distortion)
}

/// A target on a surface with the cones of [`Target::Auto`] placed by [`auto_cones`]: a list of all vertices with curvature. Any other
/// target as it is.
///
/// # Errors
/// [`Error::TargetKind`] for [`Target::Auto`] in another space than E², or by lengths of another geometry; those of [`auto_cones`].
pub fn with_cones_placed<'a>(
    target: &'a Target,
    surface: &Surface,
    space: Space,
    control: &Control,
) -> Result<Cow<'a, Target>> {
    let &Target::Auto(n) = target else { return Ok(Cow::Borrowed(target)) };
    if [space, surface.geometry()] != [Space::E2; 2] {
        let message = "cones are placed in e2, by Euclidean lengths".into();
        return Err(Error::TargetKind { target: "auto", message });
    }
    let placed = auto_cones(surface.mesh(), surface.lengths(), n, control)?.target;
    let curved = surface.mesh().vertices().filter(|&v| placed[v] != 0.0);
    Ok(Cow::Owned(Target::Cones(curved.map(|v| (v, placed[v])).collect())))
}

/// Checks that the surface can have `n` cones.
pub(super) fn check_number(mesh: &Mesh, n: usize) -> Result<()> {
    let interior = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)).count();
    let message = match (mesh.is_closed(), mesh.euler()) {
        (true, 2) if n < 3 => {
            "a closed surface of genus 0 needs 3 cones or more: each takes less than 2π of 4π".into()
        }
        (true, 0) if n == 1 => {
            "one cone on a torus would have curvature 0: ask for none, or 2 or more".into()
        }
        (true, euler) if euler < 0 && n == 0 => "a closed surface of genus 2 or more needs a cone".into(),
        _ if n > interior => format!("{n} cones, but only {interior} interior vertices"),
        _ if n > MAX_AUTO_CONES => format!("{n} cones; {MAX_AUTO_CONES} at most are placed"),
        _ => return Ok(()),
    };
    Err(Error::TargetKind { target: "auto", message })
}

/// A vertex with `H = L⁻¹ M L⁻¹ δ`, M the mass matrix with the mean projected out.
pub(super) struct CandidateCone {
    pub vertex: VertexId,
    h: Vec<f64>,
}

/// The placement of cones on a surface.
pub(super) struct ConePlacement<'a> {
    /// The surface on its intrinsic Delaunay triangulation, the measurements there at u = 0, and the Laplacian.
    pub mesh: Mesh,
    state: FlowState,
    system: NewtonSystem,
    /// True at vertices whose u is held: the boundary, or one vertex of a closed surface.
    fixed: Vec<bool>,
    /// A third of the area around each vertex; the total is 1.
    mass: Vec<f64>,
    control: &'a Control,
    /// On closed surfaces, the sum of the curvatures of the cones.
    sum: Option<f64>,
    /// w without a cone: u₀ solves `L u₀ = −K`, and `L w₀ = M u₀`.
    w0: Vec<f64>,
    /// E without a cone.
    energy0: f64,
    pub cones: Vec<CandidateCone>,
    /// The least total angle of a cone.
    least_angle: f64,
    angles: ConeAngles,
    /// E with the present cones.
    pub energy: f64,
}

impl<'a> ConePlacement<'a> {
    pub fn new(mesh: &Mesh, lengths: &PerEdge<f64>, least_angle: f64, control: &'a Control) -> Result<Self> {
        let (mesh, metric, state) = measured(mesh, lengths, control)?;
        let mass = state.vertex_areas(&mesh, &metric, state.area(&mesh, &metric));
        let closed = mesh.is_closed();
        let fixed: Vec<bool> = mesh
            .vertices()
            .map(|v| if closed { v.index() == 0 } else { mesh.is_boundary_vertex(v) })
            .collect();
        control.check()?;
        let mut system = NewtonSystem::new(&mesh, &fixed, None)?;
        control.check()?;
        system.jacobian.assemble(&mesh, &metric, &state);
        control.check()?;
        if system.factor().is_err() {
            let (size, shift) = (system.unknowns(), SHIFT * system.jacobian.mean_diagonal());
            system.jacobian.add_diagonal(|_| shift);
            system.factor().map_err(|_| factorisation(size, "the Laplacian is not positive definite"))?;
        }
        control.check()?;
        let sum = closed.then(|| 2.0 * PI * mesh.euler() as f64);
        let mut place = ConePlacement {
            sum,
            mesh,
            state,
            system,
            fixed,
            mass,
            control,
            w0: Vec::new(),
            energy0: 0.0,
            cones: Vec::new(),
            least_angle,
            angles: ConeAngles { t: Vec::new(), level: 0.0, energy: 0.0 },
            energy: 0.0,
        };
        let minus: Vec<f64> = place.state.curvature.iter().map(|k| -k).collect();
        (place.w0, place.energy0) = place.gradient(&minus)?;
        place.energy = place.energy0;
        if sum.is_some() {
            // Without cones the curvature that they must take is spread over the area.
            place.energy = place.gradient(&place.spread())?.1;
        }
        Ok(place)
    }

    /// K̄ − K with K̄ spread evenly over the area.
    fn spread(&self) -> Vec<f64> {
        let total = self.sum.unwrap_or(0.0);
        self.mass.iter().zip(self.state.curvature.iter()).map(|(m, k)| total * m - k).collect()
    }

    /// Adds the cone that lowers E fastest.
    pub fn add_best(&mut self) -> Result<()> {
        let v = self.best()?;
        self.add(v)
    }

    /// Adds a cone at a vertex.
    pub fn add(&mut self, v: VertexId) -> Result<()> {
        let cone = self.cone(v)?;
        self.cones.push(cone);
        self.settle()
    }

    /// Keeps the first `n` cones.
    pub fn truncate(&mut self, n: usize) -> Result<()> {
        self.cones.truncate(n);
        if n > 0 {
            return self.settle();
        }
        self.angles = ConeAngles { t: Vec::new(), level: 0.0, energy: 0.0 };
        self.energy = self.energy0;
        Ok(())
    }

    /// Takes each cone away and places it anew, twice.
    pub fn sweep(&mut self) -> Result<()> {
        let n = self.cones.len();
        for k in 0..SWEEPS * n {
            self.control.step(Stage::Flow, (n + k) as f64 / (n + SWEEPS * n) as f64)?;
            self.place_anew(k % n)?;
        }
        Ok(())
    }

    /// The conformal factor u that the present cones lead to by the linear model, up to a constant on closed surfaces.
    pub fn factor(&mut self) -> Result<Vec<f64>> {
        let change = self.change(&self.curvatures());
        self.solve(&change)
    }

    /// The curvature of the cones, and 0 elsewhere.
    fn curvatures(&self) -> PerVertex<f64> {
        let mut target = PerVertex::filled(self.mass.len(), 0.0);
        self.cones.iter().zip(&self.angles.t).for_each(|(cone, t)| target[cone.vertex] = *t);
        target
    }

    /// The result; `distortion`: that with 0, 1, … cones, by the quadratic form.
    pub fn finish(
        mut self,
        mesh: &Mesh,
        lengths: &PerEdge<f64>,
        mut distortion: Vec<f64>,
    ) -> Result<AutoCones> {
        let mut target = self.curvatures();
        let mut cones: Vec<_> =
            self.cones.iter().map(|c| c.vertex).zip(self.angles.t.iter().copied()).collect();
        cones.sort_unstable_by_key(|c| c.0);
        if let Some(last) = distortion.last_mut().filter(|_| !cones.is_empty()) {
            // In the quadratic form a small distortion would be the difference of large numbers, so it is measured anew.
            let change = self.change(&target);
            *last = 2.0 * self.gradient(&change)?.1;
        }
        if !mesh.is_closed() {
            self.boundary(lengths, mesh, &mut target)?;
        }
        Ok(AutoCones { cones, target, distortion })
    }

    /// K̄ − K.
    fn change(&self, target: &PerVertex<f64>) -> Vec<f64> {
        target.iter().zip(self.state.curvature.iter()).map(|(wanted, k)| wanted - k).collect()
    }

    /// `u = L⁻¹ rhs`, 0 where it is held.
    fn solve(&mut self, rhs: &[f64]) -> Result<Vec<f64>> {
        self.control.check()?;
        let mut u = vec![0.0; rhs.len()];
        if self.system.unknowns() > 0 && !self.system.solve(rhs, ENOUGH, &mut u) {
            return Err(factorisation(
                self.system.unknowns(),
                "the Laplacian is singular to working precision",
            ));
        }
        Ok(u)
    }

    /// With `L u = rhs`: w of `L w = M u`, and `½ uᵀM u`.
    fn gradient(&mut self, rhs: &[f64]) -> Result<(Vec<f64>, f64)> {
        let u = self.solve(rhs)?;
        let mean: f64 = u.iter().zip(&self.mass).map(|(u, m)| u * m).sum();
        let weighted: Vec<f64> = u.iter().zip(&self.mass).map(|(u, m)| (u - mean) * m).collect();
        let energy = 0.5 * weighted.iter().zip(&u).map(|(w, u)| w * (u - mean)).sum::<f64>();
        Ok((self.solve(&weighted)?, energy))
    }

    fn cone(&mut self, vertex: VertexId) -> Result<CandidateCone> {
        let mut delta = vec![0.0; self.mass.len()];
        delta[vertex.index()] = 1.0;
        Ok(CandidateCone { vertex, h: self.gradient(&delta)?.0 })
    }

    /// The best curvatures of the present cones.
    fn settle(&mut self) -> Result<()> {
        let k = self.cones.len();
        let at = |i: usize, j: usize| self.cones[i].h[self.cones[j].vertex.index()];
        let b: Vec<Vec<f64>> =
            (0..k).map(|i| (0..k).map(|j| 0.5 * (at(i, j) + at(j, i))).collect()).collect();
        let g: Vec<f64> = self.cones.iter().map(|c| self.w0[c.vertex.index()]).collect();
        // A sphere's first one or two cones take more than the bound, until others share it.
        let bound = (2.0 * PI - self.least_angle).max(self.sum.unwrap_or(0.0) / k.max(1) as f64);
        self.angles = angles(&b, &g, self.sum, bound)
            .ok_or_else(|| factorisation(k, "the curvatures of the cones are not determined"))?;
        self.energy = self.energy0 + self.angles.energy;
        Ok(())
    }

    /// The vertex where a further cone lowers E fastest.
    fn best(&mut self) -> Result<VertexId> {
        let taken: Vec<VertexId> = self.cones.iter().map(|c| c.vertex).collect();
        let candidates =
            self.mesh.vertices().filter(|v| !self.mesh.is_boundary_vertex(*v) && !taken.contains(v));
        let candidates: Vec<VertexId> = candidates.collect();
        let gain: Vec<f64> = match self.sum {
            Some(sum) if taken.is_empty() => {
                // The first cone of a closed surface takes all curvature; it goes where the gradient is lowest if that is positive.
                let w = self.gradient(&self.spread())?.0;
                if sum > 0.0 { w.iter().map(|w| -w).collect() } else { w }
            }
            _ => {
                let mut w = self.w0.clone();
                for (cone, t) in self.cones.iter().zip(&self.angles.t) {
                    w.iter_mut().zip(&cone.h).for_each(|(w, h)| *w += t * h);
                }
                w.iter().map(|w| (w - self.angles.level).abs()).collect()
            }
        };
        let better =
            |best: VertexId, v: VertexId| if gain[v.index()] > gain[best.index()] { v } else { best };
        let best = candidates.into_iter().reduce(better);
        best.ok_or_else(|| Error::TargetKind {
            target: "auto",
            message: "no vertex is left for a cone".into(),
        })
    }

    /// Take a cone away and place it at the best vertex for the others, if that lowers E.
    fn place_anew(&mut self, k: usize) -> Result<()> {
        let (before, kept) = (self.energy, self.angles.clone());
        let old = self.cones.remove(k);
        if !self.cones.is_empty() {
            self.settle()?;
        }
        let v = self.best()?;
        if v == old.vertex {
            self.cones.insert(k, old);
            (self.energy, self.angles) = (before, kept);
            return Ok(());
        }
        let new = self.cone(v)?;
        self.cones.insert(k, new);
        self.settle()?;
        if self.energy > before - WORTH_MOVING * before.abs() {
            self.cones[k] = old;
            (self.energy, self.angles) = (before, kept);
        }
        Ok(())
    }

    /// Set the curvature of boundary vertices to the one that u = 0 there leads to, bounded by π − LEAST_ANGLE/2 and with the total of
    /// Gauss–Bonnet: curvature beyond the bound goes to the other vertices in proportion to the boundary's length at each.
    fn boundary(&mut self, lengths: &PerEdge<f64>, mesh: &Mesh, target: &mut PerVertex<f64>) -> Result<()> {
        let change = self.change(target);
        let u = self.solve(&change)?;
        let share = boundary_lengths(mesh, lengths);
        let boundary: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
        boundary.iter().for_each(|&v| target[v] = self.state.curvature[v]);
        for f in self.mesh.faces() {
            let weights = self.state.weights[f.index()];
            let corners = self.mesh.face_vertices(f);
            for k in 0..3 {
                let (i, j) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let flux = weights[k] * (u[i.index()] - u[j.index()]);
                for (v, flux) in [(i, flux), (j, -flux)] {
                    if self.fixed[v.index()] {
                        target[v] += flux;
                    }
                }
            }
        }
        let limit = PI - 0.5 * LEAST_ANGLE;
        let total = 2.0 * PI * mesh.euler() as f64;
        // Each round brings one vertex at least to its bound, or is the last.
        for _ in 0..=boundary.len() {
            boundary.iter().for_each(|&v| target[v] = target[v].min(limit));
            let missing = total - target.iter().sum::<f64>();
            let room = |v: &&VertexId| target[**v] < limit;
            let length: f64 = boundary.iter().filter(room).map(|&v| share[v]).sum();
            if missing.abs() <= 1e-13 * (1.0 + boundary.len() as f64) {
                return Ok(());
            }
            if length == 0.0 {
                break;
            }
            let open: Vec<VertexId> = boundary.iter().filter(room).copied().collect();
            open.iter().for_each(|&v| target[v] += missing * share[v] / length);
        }
        let message = "the boundary has too few vertices to take the curvature that the cones leave".into();
        Err(Error::TargetKind { target: "auto", message })
    }
}

/// A surface on its intrinsic Delaunay triangulation, measured at u = 0.
fn measured(mesh: &Mesh, lengths: &PerEdge<f64>, control: &Control) -> Result<(Mesh, Metric, FlowState)> {
    // Errors of the input are found here, before flips, so that they name its own elements.
    initial_metric(mesh, lengths, Space::E2, Class::yamabe(Space::E2))?;
    control.check()?;
    let mut surface = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry: Space::E2 };
    intrinsic_delaunay(&mut surface, IntrinsicOptions::default(), &mut |_, _| {}, control)?;
    let Triangulated { mesh, lengths, .. } = surface;
    let metric = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2))?.metric;
    let mut state = FlowState::new(&metric.u, &metric.u_low);
    if !state.evaluate(&mesh, &metric) {
        return Err(factorisation(0, "an edge without length"));
    }
    Ok((mesh, metric, state))
}

fn factorisation(size: usize, message: &str) -> Error {
    Error::Factorisation { size, message: message.into() }
}

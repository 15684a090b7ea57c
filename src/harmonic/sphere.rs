//! Harmonic maps of closed surfaces of genus 0 to the unit sphere.
//!
//! ```
//! use ricci::{Control, Surface, harmonic::{Domain, SphereMapOptions, sphere_map}, mesh::shapes};
//! let ellipsoid = Surface::from_soup(&shapes::ellipsoid([1.0, 1.2, 0.8], 6)?)?;
//! let domain = Domain::new(&ellipsoid, &Control::new())?;
//! let map = sphere_map(&domain, &SphereMapOptions::default(), &Control::new())?;
//! assert!(map.flipped.is_empty() && map.energies.windows(2).all(|pair| pair[1] <= pair[0]));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::laplace::Laplace;
use super::map::{MapConstraints, energy, harmonic_map};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::barycentre::conformal_barycentre;
use crate::geometry::sphere::{lift, project};
use crate::geometry::vector::{Vector, add, cross, dot, norm, normalised, scale, sub};
use crate::mesh::{FaceId, VertexId};

/// The method by which the energy is lowered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SphereMethod {
    /// Implicit steps in the metric of the image, in which all modes fall fast: few steps.
    #[default]
    Implicit,
    /// The paper's flow `df/dt = −(Δf)^∥` \[JKLLG08, Eqn 7, with Δ ≥ 0\], explicit in time: many steps.
    HeatFlow,
}

/// The options of [`sphere_map`].
#[derive(Debug, Clone, Copy)]
pub struct SphereMapOptions {
    /// The method.
    pub method: SphereMethod,
    /// The relative decrease of the energy by one step up to which the map counts as harmonic.
    pub tolerance: f64,
    /// Most steps.
    pub max_iterations: usize,
}

impl Default for SphereMapOptions {
    fn default() -> Self {
        SphereMapOptions { method: SphereMethod::Implicit, tolerance: 1e-10, max_iterations: 2000 }
    }
}

/// A map to the unit sphere.
#[derive(Debug, Clone, PartialEq)]
pub struct SphereMap {
    /// Per vertex, its image on the unit sphere. The mean of the images, weighted by the vertices' areas, is 0.
    pub points: Vec<Vector>,
    /// The energy `½ Σ w |f_i − f_j|²` at the start and after every step, which never grows. For smooth surfaces the energy of a map onto
    /// the sphere is at least 4π.
    pub energies: Vec<f64>,
    /// True if the last step was within the tolerance.
    pub converged: bool,
    /// The faces whose images do not face outwards.
    pub flipped: Vec<FaceId>,
}

/// The harmonic map of degree 1 of a closed surface of genus 0 to the unit sphere. Harmonic maps to the sphere are conformal; the result is
/// the one whose mean is 0. The iteration starts from the harmonic map onto a triangle in the plane, lifted to the sphere.
///
/// A step moves the images along the tangential part of the Laplacian and back to the sphere, and then applies the Möbius transformation
/// that centres them. It is halved until the energy falls.
///
/// # Errors
/// [`Error::Layout`] for another surface; [`Error::Argument`] for a tolerance that is not positive; those of [`harmonic_map`] and
/// [`conformal_barycentre`].
pub fn sphere_map(domain: &Domain, options: &SphereMapOptions, control: &Control) -> Result<SphereMap> {
    let mesh = domain.mesh();
    if !mesh.is_closed() || mesh.euler() != 2 {
        let (genus, loops) = (mesh.genus(), mesh.boundary_loops().len());
        return Err(Error::Layout(format!(
            "the surface has genus {genus} and {loops} boundary loops; only a closed surface of genus 0 maps onto the sphere"
        )));
    }
    if options.tolerance.is_nan() || options.tolerance <= 0.0 {
        return Err(Error::argument("tolerance", options.tolerance, "positive"));
    }
    let mut points = start(domain, control)?;
    let mut energies = vec![energy(domain, &points)];
    let mut flow = SphereFlow::new(domain, options.method, &points, control)?;
    let mut converged = false;
    while energies.len() <= options.max_iterations && !converged {
        control.step(Stage::Flow, energies.len() as f64 / options.max_iterations as f64)?;
        let before = energies[energies.len() - 1];
        match flow.step(&points, before)? {
            Some((next, after)) => {
                points = next;
                energies.push(after);
                converged = before - after <= options.tolerance * before;
            }
            None => converged = true,
        }
    }
    let outward = |f: &FaceId| {
        let [a, b, c] = mesh.face_vertices(*f).map(|v| points[v.index()]);
        dot(cross(sub(b, a), sub(c, a)), a) > 0.0
    };
    let flipped = mesh.faces().filter(|f| !outward(f)).collect();
    Ok(SphereMap { points, energies, converged, flipped })
}

/// The first map: the largest face is mapped to an equilateral triangle in the plane and the rest harmonically into it; then the plane is
/// lifted to the sphere and centred.
fn start(domain: &Domain, control: &Control) -> Result<Vec<Vector>> {
    let (mesh, areas) = (domain.mesh(), domain.face_areas());
    let is_triangle = |f: &FaceId| {
        let [a, b, c] = mesh.face_vertices(*f);
        a != b && b != c && c != a
    };
    let outer = mesh.faces().filter(is_triangle).max_by(|&f, &g| areas[f].total_cmp(&areas[g]));
    let outer =
        outer.ok_or_else(|| Error::Layout("no face of the surface has three different corners".into()))?;
    // The outer triangle is seen from behind, so its corners are clockwise.
    let corner = |k: usize| {
        let (sin, cos) = (-std::f64::consts::TAU * k as f64 / 3.0).sin_cos();
        [cos, sin]
    };
    let values = mesh.face_vertices(outer).into_iter().enumerate().map(|(k, v)| (v, corner(k))).collect();
    let plane = harmonic_map(domain, &MapConstraints { values, flux: None }, control)?.points;
    let centred = conformal_barycentre(&plane, domain.vertex_areas(), 0.0)?;
    Ok(plane.into_iter().map(|z| lift(centred.apply(z))).collect())
}

/// The iteration that lowers the energy of a map to the sphere.
struct SphereFlow<'a> {
    domain: &'a Domain,
    control: &'a Control,
    implicit: Option<Laplace<'a>>,
    /// The length of the next step; for implicit steps in units of the sphere's radius squared.
    length: f64,
}

/// Length of the first implicit step, by which the second harmonics of the sphere, the slowest modes beside the Möbius transformations,
/// fall by half.
const FIRST: f64 = 0.5;
/// Length, in units of the first step tried, below which no step lowers the energy.
const SHORTEST: f64 = 1e-12;
/// Least mass of a vertex in implicit steps, in units of the sphere's area over the number of vertices, since images of vertices may nearly
/// coincide.
const LEAST_MASS: f64 = 1e-9;

impl<'a> SphereFlow<'a> {
    fn new(
        domain: &'a Domain,
        method: SphereMethod,
        points: &[Vector],
        control: &'a Control,
    ) -> Result<SphereFlow<'a>> {
        let mut flow = SphereFlow { domain, control, implicit: None, length: FIRST };
        match method {
            SphereMethod::Implicit => {
                flow.implicit = Some(Laplace::with_mass(domain, &flow.masses(points), control)?);
            }
            // An explicit step of length 1 moves every vertex to the mean of its neighbours.
            SphereMethod::HeatFlow => flow.length = 1.0,
        }
        Ok(flow)
    }

    /// The areas of the vertices' images over the length of the step.
    fn masses(&self, points: &[Vector]) -> Vec<f64> {
        let mesh = self.domain.mesh();
        let least = LEAST_MASS * 4.0 * std::f64::consts::PI / points.len() as f64;
        let mut area = vec![least; points.len()];
        for f in mesh.faces() {
            let vertices = mesh.face_vertices(f);
            let [a, b, c] = vertices.map(|v| points[v.index()]);
            let third = norm(cross(sub(b, a), sub(c, a))) / 6.0;
            vertices.into_iter().for_each(|v| area[v.index()] += third);
        }
        area.iter_mut().for_each(|x| *x /= self.length);
        area
    }

    /// The images after a step, and their energy; `None` if no step lowers it.
    fn step(&mut self, points: &[Vector], before: f64) -> Result<Option<(Vec<Vector>, f64)>> {
        let first = self.length;
        while self.length > SHORTEST * first {
            let moved = self.moved(points)?;
            let centred = centre(self.domain, moved)?;
            let after = energy(self.domain, &centred);
            if after < before {
                self.length = (2.0 * self.length).min(self.longest());
                return Ok(Some((centred, after)));
            }
            self.length *= 0.5;
        }
        Ok(None)
    }

    fn longest(&self) -> f64 {
        if self.implicit.is_some() { FIRST } else { 1.0 }
    }

    /// The points after a move along their tangent planes and back to the sphere.
    fn moved(&mut self, points: &[Vector]) -> Result<Vec<Vector>> {
        self.control.check()?;
        let mut target = points.to_vec();
        let masses = self.masses(points);
        match &mut self.implicit {
            Some(laplace) => {
                laplace.set_mass(&masses)?;
                laplace.step(&mut target)?;
            }
            None => {
                let mesh = self.domain.mesh();
                let mut pull = vec![([0.0; 3], 0.0); points.len()];
                for e in mesh.edges() {
                    let [i, j] = mesh.ends(e).map(|v: VertexId| v.index());
                    let weight = self.domain.weights()[e];
                    let across = scale(weight, sub(points[j], points[i]));
                    pull[i] = (add(pull[i].0, across), pull[i].1 + weight);
                    pull[j] = (sub(pull[j].0, across), pull[j].1 + weight);
                }
                // The mass of a vertex in this flow is the sum of its weights, so that a full step leads to the mean of its neighbours.
                for (p, (pull, total)) in target.iter_mut().zip(pull) {
                    *p = add(*p, scale(self.length / total, pull));
                }
            }
        }
        let along = |(p, q): (&Vector, Vector)| {
            let step = sub(q, *p);
            normalised(add(*p, sub(step, scale(dot(step, *p), *p))))
        };
        Ok(points.iter().zip(target).map(along).collect())
    }
}

/// The image centred by a Möbius transformation.
fn centre(domain: &Domain, points: Vec<Vector>) -> Result<Vec<Vector>> {
    // If a point is the pole of the projection, it is moved by a small amount.
    let plane: Vec<[f64; 2]> = points
        .iter()
        .map(|&p| project(p).or_else(|| project(normalised([1e-9, 0.0, p[2]]))).unwrap_or([0.0; 2]))
        .collect();
    let centred = conformal_barycentre(&plane, domain.vertex_areas(), 0.0)?;
    Ok(plane.into_iter().map(|z| lift(centred.apply(z))).collect())
}

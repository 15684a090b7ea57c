//! One call for every closed surface.

use super::quotient::{Quotient, QuotientOptions, uniformize_quotient};
use super::sphere::{Sphere, SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::Space;
use crate::metric::{Scheme, Surface};

/// A closed surface in its canonical shape.
#[derive(Debug, Clone)]
pub enum Uniformization {
    /// Genus 0: a convex polyhedron inscribed in the unit sphere.
    Sphere(Box<Sphere>),
    /// Genus 1 and more: the quotient of the plane or the hyperbolic plane by a group of isometries.
    Quotient(Box<Quotient>),
}

impl Uniformization {
    /// The metric of constant curvature, with its triangulation and the way back to the given one.
    pub fn metric(&self) -> &Solution {
        match self {
            Uniformization::Sphere(sphere) => &sphere.metric,
            Uniformization::Quotient(quotient) => &quotient.metric,
        }
    }

    /// S², E² or H², by the sign of the Euler characteristic.
    pub fn space(&self) -> Space {
        self.metric().metric().space
    }

    /// Whether the flow came to its target, within its tolerance.
    pub fn converged(&self) -> bool {
        match self {
            Uniformization::Sphere(sphere) => sphere.report.converged,
            Uniformization::Quotient(quotient) => quotient.report.converged(),
        }
    }
}

/// The metric of constant curvature in the conformal class of a closed surface: on the sphere, in the plane or in the hyperbolic plane, by its
/// Euler characteristic.
///
/// Of the options a sphere takes the base as its puncture, tolerance, steps and threads; its
/// scheme is [`Scheme::Yamabe`].
///
/// Errors: [`Error::Layout`] for a surface with boundary; [`Error::Argument`] for a sphere in another scheme; those of
/// [`uniformize_sphere`] and [`uniformize_quotient`].
pub fn uniformize(surface: &Surface, options: &QuotientOptions, control: &Control) -> Result<Uniformization> {
    let mesh = surface.mesh();
    if !mesh.is_closed() || mesh.euler() <= 0 {
        let quotient = uniformize_quotient(surface, options, control)?;
        return Ok(Uniformization::Quotient(Box::new(quotient)));
    }
    if options.scheme != Scheme::Yamabe {
        let need = "yamabe: spheres are uniformized by vertex scaling";
        return Err(Error::Argument { what: "scheme", value: options.scheme.to_string(), need });
    }
    let flow = &options.flow;
    let sphere = SphereOptions {
        tolerance: flow.tolerance,
        max_iterations: flow.max_iterations,
        puncture: options.base,
        threads: flow.threads,
    };
    Ok(Uniformization::Sphere(Box::new(uniformize_sphere(surface, &sphere, control)?)))
}

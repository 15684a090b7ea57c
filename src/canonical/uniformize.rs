//! Uniformizes any surface by one call: to a sphere or to a quotient.
//!
//! ```
//! use ricci::canonical::{QuotientOptions, uniformize};
//! use ricci::{Control, Surface, geometry::Space, mesh::shapes};
//! let surface = Surface::from_soup(&shapes::icosphere(3)?)?;
//! let sphere = uniformize(&surface, &QuotientOptions::default(), &Control::new())?;
//! assert!(sphere.converged() && sphere.space() == Space::S2);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::quotient::{Quotient, QuotientOptions, uniformize_quotient};
use super::sphere::{Sphere, SphereOptions, uniformize_sphere};
use super::spherical_flow::{FlowedSphere, flow_to_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::{Method, Solution};
use crate::geometry::Space;
use crate::metric::{Scheme, Surface};

/// A surface in its canonical shape.
#[derive(Debug, Clone)]
pub enum Uniformization {
    /// Closed of genus 0: a convex polyhedron inscribed in the unit sphere.
    Sphere(Box<Sphere>),
    /// Closed of genus 0, by the gradient flow in S².
    FlowedSphere(Box<FlowedSphere>),
    /// All others: the quotient of the plane, the hyperbolic plane or a part with straight boundary by a group of isometries.
    Quotient(Box<Quotient>),
}

impl Uniformization {
    /// The metric of constant curvature, with its triangulation and the way back to the given one.
    pub fn metric(&self) -> &Solution {
        match self {
            Uniformization::Sphere(sphere) => &sphere.metric,
            Uniformization::FlowedSphere(sphere) => &sphere.metric,
            Uniformization::Quotient(quotient) => &quotient.metric,
        }
    }

    /// S², E² or H², by the sign of the Euler characteristic.
    pub fn space(&self) -> Space {
        self.metric().metric().space
    }

    /// True if the flow came to its target, within its tolerance.
    pub fn converged(&self) -> bool {
        match self {
            Uniformization::Sphere(sphere) => sphere.report.converged,
            Uniformization::FlowedSphere(sphere) => sphere.report.converged(),
            Uniformization::Quotient(quotient) => quotient.report.converged(),
        }
    }
}

/// The metric of constant curvature in the conformal class of a surface. Its Euler characteristic decides whether it lies on the sphere, in
/// the plane or in the hyperbolic plane; of a surface with boundary, that and what its boundary is to become.
///
/// For a surface of genus 0 the base is the puncture, the tolerance, the step limit and the threads of the flow are used, and the
/// scheme must be [`Scheme::Yamabe`]. With [`Method::Gradient`] it flows in S², in any scheme with all options of the flow, and the base
/// is the vertex that the layout starts at.
///
/// # Errors
///
/// [`Error::Argument`] for a sphere in another scheme; those of [`uniformize_sphere`], [`flow_to_sphere`] and
/// [`uniformize_quotient`].
pub fn uniformize(surface: &Surface, options: &QuotientOptions, control: &Control) -> Result<Uniformization> {
    let mesh = surface.mesh();
    if !mesh.is_closed() || mesh.euler() <= 0 {
        let quotient = uniformize_quotient(surface, options, control)?;
        return Ok(Uniformization::Quotient(Box::new(quotient)));
    }
    if options.flow.method == Method::Gradient {
        let sphere = flow_to_sphere(surface, options.scheme, options.base, &options.flow, control)?;
        return Ok(Uniformization::FlowedSphere(Box::new(sphere)));
    }
    if options.scheme != Scheme::Yamabe {
        return Err(Error::argument(
            "scheme",
            options.scheme,
            "yamabe: spheres are uniformized by vertex scaling",
        ));
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

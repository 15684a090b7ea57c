//! Circle domains: surfaces with boundary in a metric of constant curvature whose boundary loops are circles [BPS15; BL23].
//!
//! Every loop is filled by a hub ([`crate::flow`]), and the closed surface is brought to its constant curvature: the vertices of a
//! loop then lie on a circle about its hub. Where the triangulation of the class wants an edge of a loop flipped it is flipped. The edge then
//! crosses edges at the hub, and the points where it does are vertices of the loop too, on its circle.
//!
//! ```
//! use ricci::canonical::{CircleDomainOptions, circle_domain};
//! use ricci::{Control, Surface, mesh::shapes};
//! let annulus = Surface::from_soup(&shapes::annulus(0.5, 1.0, 48, 5)?)?;
//! let domain = circle_domain(&annulus, &CircleDomainOptions::default(), &Control::new())?;
//! assert!(domain.report.converged && domain.circles.len() == 2);
//! assert!((domain.modulus.unwrap() - 2f64.ln() / std::f64::consts::TAU).abs() < 1e-3);
//! # Ok::<(), ricci::Error>(())
//! ```

mod anchors;
mod closed;
mod disk;
mod place;
mod planar;
mod prepare;

use crate::control::Control;
use crate::embed::Layout;
use crate::error::{Error, Result};
use crate::flow::{Options, Seconds, Solution, StopReason};
use crate::mesh::{Filled, PerEdge, VertexId};
use crate::metric::{Split, Surface};
use crate::parallel::Pool;
use prepare::Prepared;

/// Edges that a loop has at least, unless the caller asks for fewer: a polygon of this many corners on a circle looks like a circle.
pub const LEAST_LOOP: usize = 12;
/// How often loops whose circles overlap are halved edge by edge.
const ROUNDS: usize = 4;

/// How the unit disk of a planar domain is moved onto itself at the end.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Normalisation {
    /// Two loops: both circles about 0. Else, the barycentre of the area at 0 ([`crate::geometry::disk_barycentre`]), in weights of one third of
    /// the area of the given faces at each vertex. The first vertex of the outer loop lies at 1.
    #[default]
    Centred,
    /// This vertex of the given surface at 0, and the first vertex of the outer loop at 1; a vertex of the outer loop cannot lie at 0.
    Vertex(VertexId),
    /// Three vertices of the outer loop at these angles (radians) of the unit circle, in the order of the loop: counterclockwise.
    Three([VertexId; 3], [f64; 3]),
}

/// Options of [`circle_domain`].
#[derive(Debug, Clone, PartialEq)]
pub struct CircleDomainOptions {
    /// Of a surface of genus 0, the loop that becomes the unit circle, by its place in [`crate::mesh::Mesh::boundary_loops`]. Default: the longest.
    pub outer: Option<usize>,
    /// Of a surface of genus 0.
    pub normalisation: Normalisation,
    /// Edges of a loop with fewer than this are halved, the longest first. Default [`LEAST_LOOP`].
    pub least_loop: usize,
    /// Tolerance, steps and threads of the flows; nothing else of it is used.
    pub flow: Options,
}

impl Default for CircleDomainOptions {
    fn default() -> Self {
        CircleDomainOptions {
            outer: None,
            normalisation: Normalisation::Centred,
            least_loop: LEAST_LOOP,
            flow: Options::default(),
        }
    }
}

/// A boundary loop as a circle.
#[derive(Debug, Clone, PartialEq)]
pub struct DomainCircle {
    /// The loop, by its place in [`crate::mesh::Mesh::boundary_loops`] of the surface.
    pub boundary_loop: usize,
    /// Centre in the coordinates of the layout: of the plane, of the Poincaré disk (one lift).
    pub center: [f64; 2],
    /// Radius in the metric of the space: in E² in the units of the layout, in H² hyperbolic.
    pub radius: f64,
    /// Largest difference between the radius and the distance of a vertex of the loop from the centre, as a share of the radius.
    pub deviation: f64,
    /// Vertices on the circle: those of the loop, and those that were added to it.
    pub vertices: usize,
}

/// The points of a loop.
struct LoopPoints {
    boundary_loop: usize,
    n: usize,
}

/// What became of a circle domain.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleReport {
    /// Whether K = 0 to the tolerance, no two circles overlap, and no triangle is flipped.
    pub converged: bool,
    /// Why the flow stopped.
    pub stop_reason: StopReason,
    /// Newton steps of the whole call.
    pub iterations: usize,
    /// Flips on the way to the result, isometric ones before the flow included.
    pub flips: usize,
    /// Largest |K| over hubs and vertices of the flow's last metric, radians; in the plane seen from the puncture without that and its link.
    pub max_curvature_error: f64,
    /// Largest |K| of [`CircleDomain::metric`], measured from its variables, at all vertices but those of the outer loop, radians.
    pub domain_curvature_error: f64,
    /// Vertices that were added to loops before the flow, by halving edges.
    pub halved_edges: usize,
    /// Vertices that were added to loops where flips crossed their edges.
    pub crossed_edges: usize,
    /// Least `η − 1` over the edges between two hubs, negative where two circles overlap; infinite where no hubs are neighbours.
    pub least_gap: f64,
    /// The vertex that was sent to infinity on the way, of a surface of genus 0.
    pub puncture: Option<VertexId>,
    /// What the flows took; the rest of the call is neither in its phases nor in its `total`.
    pub seconds: Seconds,
}

/// A surface whose boundary loops are circles.
#[derive(Debug, Clone)]
pub struct CircleDomain {
    /// The given surface, with the vertices that were added to its loops before the flow.
    pub split: Split,
    /// That surface with a hub in each loop.
    pub filled: Filled,
    /// The metric on the filled surface, flat or hyperbolic, and the way back. Of a planar domain in the unit disk, that of the disk: the outer
    /// hub has its circle from outside, so that the faces at it do not lie in the plane as they should, and K at its loop means nothing.
    pub metric: Solution,
    /// The surface without its holes, on the common refinement of the surface of `split` and the metric's triangulation. In E² of a torus it has the area of the
    /// given surface.
    pub layout: Layout,
    /// The circles, loop by loop.
    pub circles: Vec<DomainCircle>,
    /// Of a planar domain, the loop on the unit circle.
    pub outer: Option<usize>,
    /// Of an annulus: log of the ratio of the radii over 2π, height over circumference of the cylinder.
    pub modulus: Option<f64>,
    /// Of a torus with holes: the modulus of the torus, `[Re τ, Im τ]` reduced.
    pub torus_modulus: Option<[f64; 2]>,
    /// How it went.
    pub report: CircleReport,
}

/// A surface with boundary as a circle domain: of genus 0 in the unit disk, whose circle is one of the loops; of genus 1 in a flat torus; of
/// more in a hyperbolic surface.
///
/// Where circles overlap, because loops with few edges lie close together, the edges of these loops are halved and all is done again.
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] for a closed surface, a loop or vertex that does not exist, a normalisation that does not fit the surface;
/// [`Error::Layout`] where no plane was found, and where circles overlap however fine the loops are, which it names; those of
/// [`crate::flow::Flow::new`]; [`Error::Cancelled`].
pub fn circle_domain(
    surface: &Surface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    control.check()?;
    options.check(surface)?;
    Pool::new(options.flow.threads)?.run(|| {
        let mut split = Split::new(surface);
        prepare::refine(&mut split, options)?;
        for round in 1.. {
            let domain = Prepared::new(split, options, control)?.solve(options, control)?;
            let overlapping = domain.overlapping();
            if overlapping.is_empty() {
                return Ok(domain);
            }
            if round > ROUNDS {
                return Err(crowded(&overlapping));
            }
            log::debug!("circles of loops {overlapping:?} overlap: their edges are halved");
            split = domain.split;
            prepare::halve_loops(&mut split, &overlapping)?;
        }
        Err(crowded(&[]))
    })
}

/// The error of loops whose circles overlap.
fn crowded(loops: &[usize]) -> Error {
    Error::Layout(format!(
        "the circles of boundary loops {loops:?} overlap, also with their edges halved {ROUNDS} times: refine the surface between these loops"
    ))
}

impl CircleDomainOptions {
    fn check(&self, surface: &Surface) -> Result<()> {
        let mesh = surface.mesh();
        let n = mesh.boundary_loops().len();
        if n == 0 {
            return Err(Error::argument(
                "surface",
                "closed",
                "one with boundary: a circle domain has a circle per boundary loop",
            ));
        }
        let is_planar = mesh.genus() == 0;
        match self.outer {
            Some(k) if k >= n => {
                return Err(Error::argument("outer loop", k, "the number of a boundary loop, from 0"));
            }
            Some(k) if !is_planar => {
                return Err(Error::argument(
                    "outer loop",
                    k,
                    "none: only surfaces of genus 0 lie inside a circle",
                ));
            }
            _ => {}
        }
        let vertices: &[VertexId] = match &self.normalisation {
            Normalisation::Centred => &[],
            Normalisation::Vertex(v) => std::slice::from_ref(v),
            Normalisation::Three(v, angles) => {
                if angles.iter().any(|a| !a.is_finite()) {
                    return Err(Error::argument(
                        "angles of the normalisation",
                        format!("{angles:?}"),
                        "finite",
                    ));
                }
                v
            }
        };
        if !is_planar && !vertices.is_empty() {
            return Err(Error::argument(
                "normalisation",
                "of the unit disk",
                "centred: only surfaces of genus 0 lie in the unit disk",
            ));
        }
        vertices.iter().try_for_each(|&v| crate::topology::check_vertex(mesh, v))?;
        self.flow.check()
    }
}

impl CircleDomain {
    /// The loops whose circles overlap another one, ascending: between two hubs of the triangulation η is 1 or less. Where two disks overlap there is such
    /// an edge, because the union of the disks has the shape of the part of the triangulation whose disks meet.
    pub fn overlapping(&self) -> Vec<usize> {
        let (mesh, eta) = (self.metric.mesh(), &self.metric.metric().eta);
        let mut all: Vec<usize> = place::hub_pairs(mesh, &self.filled)
            .filter(|&(e, _)| eta[e].high <= 1.0)
            .flat_map(|(_, loops)| loops)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Lengths of the edges of the surface of [`CircleDomain::split`].
    pub fn split_lengths(&self) -> Result<PerEdge<f64>> {
        Ok(PerEdge::clone(self.split.surface()?.lengths()))
    }
}

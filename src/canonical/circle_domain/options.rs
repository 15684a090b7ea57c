//! Options of circle domains.

use crate::archive::stored;
use crate::error::{Error, Result};
use crate::flow::Options;
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::topology::check_vertex;

/// Default for the least number of edges of a loop: a polygon of this many corners on a circle looks like a circle.
pub const LEAST_LOOP: usize = 12;
/// The normalisation of a planar domain: the way in which the unit disk is moved onto itself at the end.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Normalisation {
    /// Two loops: both circles about 0. Else, the barycentre of the area at 0 ([`crate::geometry::disk_barycentre`]), in weights of one
    /// third of the area of the given faces at each vertex. The first vertex of the outer loop lies at 1.
    #[default]
    Centred,
    /// This vertex of the given surface at 0, and the first vertex of the outer loop at 1; a vertex of the outer loop cannot lie at 0.
    Vertex(VertexId),
    /// Three vertices of the outer loop at these angles (radians) of the unit circle, in the order of the loop: counterclockwise.
    Three([VertexId; 3], [f64; 3]),
}

/// The shape in which a surface of genus 0 is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DomainFrame {
    /// The unit disk; an annulus lies in a strip instead where f64s do not hold its inner circle in the disk.
    #[default]
    Auto,
    /// The unit disk.
    Disk,
    /// An annulus in log coordinates, `[0, 2π] × [0, 2π m]` with the sides x = 0 and x = 2π identified, m the modulus, the outer loop at y = 0:
    /// (x, y) is the point of the disk with the angle x and the radius e^(−y). Both loops are straight there, and circles in the disk, whatever
    /// the modulus.
    Strip,
}
stored!(variants DomainFrame {
        Auto = 0,
        Disk = 1,
        Strip = 2,
    }
);

/// Largest deviation of a loop from its circle, as a share of the radius, of a converged domain.
pub const ROUND: f64 = 1e-9;

/// Options of [`super::circle_domain()`].
#[derive(Debug, Clone, PartialEq)]
pub struct CircleDomainOptions {
    /// The loop of a surface of genus 0 that becomes the unit circle, by its place in [`crate::mesh::Mesh::boundary_loops`]. Default: the
    /// longest.
    pub outer: Option<usize>,
    /// The normalisation of a surface of genus 0 in the unit disk.
    pub normalisation: Normalisation,
    /// The shape in which a surface of genus 0 is laid out.
    pub frame: DomainFrame,
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
            frame: DomainFrame::Auto,
            least_loop: LEAST_LOOP,
            flow: Options::default(),
        }
    }
}

impl CircleDomainOptions {
    pub(super) fn check(&self, surface: &Surface) -> Result<()> {
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
        let is_annulus = is_planar && n == 2;
        match self.frame {
            DomainFrame::Strip if !is_annulus || self.normalisation != Normalisation::Centred => {
                let need = "an annulus (genus 0, two loops), and no vertex at a place of the unit disk";
                return Err(Error::argument("frame", "strip", need));
            }
            DomainFrame::Disk if !is_planar => {
                return Err(Error::argument("frame", "disk", "a surface of genus 0"));
            }
            _ => {}
        }
        vertices.iter().try_for_each(|&v| check_vertex(mesh, v))?;
        self.flow.check()
    }

    /// The options of the flow.
    pub(super) fn of_flow(&self) -> Options {
        let Options { tolerance, max_iterations, threads, .. } = self.flow;
        Options { tolerance, max_iterations, threads, ..Options::default() }
    }
}

//! Target curvatures and their admissibility.
//!
//! ```
//! # use ricci::{Class, Surface, Target, geometry::Space, mesh::{VertexId, shapes}};
//! let sphere = Surface::from_soup(&shapes::icosphere(4)?)?;
//! let cones = Target::Cones((0..8).map(|v| (VertexId(v), std::f64::consts::FRAC_PI_2)).collect());
//! let target = cones.resolve(&sphere, Class::yamabe(Space::E2))?;
//! assert_eq!(target.iter().filter(|k| **k != 0.0).count(), 8);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::class::Class;
use super::scheme::Scheme;
use super::surface::Surface;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use crate::topology;
use std::collections::HashSet;
use std::f64::consts::PI;

/// Largest error of Gauss–Bonnet that a given target may have, relative to `2π + Σ|K̄|`: targets written with ten digits
/// pass. The error is then shared out ([`settle_total`]).
pub const TOTAL_TOLERANCE: f64 = 1e-10;

/// Least and largest number of cones that are placed by default: each costs a few solutions of a linear system.
const DEFAULT_CONES: [usize; 2] = [4, 64];

/// A prescribed curvature (radians per vertex), by rule or by value.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// E² closed: 2πχ/V everywhere. H², S²: 0 everywhere, boundary included.
    Uniform,
    /// E² open: 0 inside, 2πχ shared over the boundary in proportion to the adjacent boundary length (in equal
    /// shares where a share would reach π).
    Boundary,
    /// E², genus 0 with boundary: 0 inside, while the outer loop keeps its lengths and is free to bend. That is this loop of
    /// [`Mesh::boundary_loops`], by default the longest. The other loops bend so that the surface unrolls around each of them to where it
    /// began, as if the holes were filled: the layout is one piece without a seam, and isometric if the surface can be unrolled. The flow
    /// finds the curvature of the boundary ([`crate::Flow::solve`]). Where a triangle would break, edges of the loops are flipped like
    /// others: they bend in the layout, first those of holes, then those of the outer loop, whose vertices still keep u = 0.
    Outer(Option<usize>),
    /// E²: all of 2πχ at one vertex, 0 elsewhere.
    Single(VertexId),
    /// E²: this many cones inside, placed with their curvatures so that a map that is flat elsewhere changes areas little. The flow
    /// places them ([`crate::flow::with_cones_placed`]).
    Auto(usize),
    /// The given curvatures, 0 at every other vertex.
    Cones(Vec<(VertexId, f64)>),
    /// The curvature of every vertex (V entries).
    All(PerVertex<f64>),
}

impl Target {
    /// The target of a surface for which none is asked for. In E²: `Outer` on open surfaces of genus 0; `Auto` on open surfaces
    /// with handles, |χ| cones from 4 to 64 (at most one per interior vertex; `Boundary` where there is none, or where the lengths
    /// are not Euclidean), since few boundaries can bend by 2πχ alone; four cones of π on closed surfaces of genus 0 (V ≥ 4:
    /// vertex 0 and then, three times, the vertex farthest from those chosen, along edges). `Uniform` otherwise.
    ///
    /// # Errors
    /// Those of [`topology::farthest_vertices`].
    pub fn default_for(surface: &Surface, space: Space) -> Result<Target> {
        let mesh = surface.mesh();
        Ok(match space {
            Space::H2 | Space::S2 => Target::Uniform,
            Space::E2 if !mesh.is_closed() && mesh.genus() == 0 => Target::Outer(None),
            Space::E2 if !mesh.is_closed() => match default_cones(surface) {
                0 => Target::Boundary,
                n => Target::Auto(n),
            },
            Space::E2 if mesh.euler() == 2 && mesh.n_vertices() >= 4 => {
                let free = Control::new();
                let cones = topology::farthest_vertices(mesh, surface.lengths(), VertexId(0), 4, &free)?;
                Target::Cones(cones.into_iter().map(|v| (v, PI)).collect())
            }
            Space::E2 => Target::Uniform,
        })
    }

    /// The rule's name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Target::Uniform => "uniform",
            Target::Boundary => "boundary",
            Target::Outer(_) => "outer",
            Target::Single(_) => "single",
            Target::Auto(_) => "auto",
            Target::Cones(_) => "cones",
            Target::All(_) => "file",
        }
    }

    /// Checks what can be checked before a flow: [`Target::values`] with [`check_admissible`]; of `Outer`, whose values are found by the flow,
    /// that the surface has this loop.
    ///
    /// # Errors
    /// Those of [`Target::values`] and [`check_admissible`].
    pub fn check(&self, surface: &Surface, class: Class) -> Result<()> {
        match self {
            Target::Outer(outer) => check_outer(surface.mesh(), class.space, *outer),
            _ => self.resolve(surface, class).map(|_| ()),
        }
    }

    /// The curvature of every vertex, checked to be admissible ([`check_admissible`]) and with an exact total
    /// ([`settle_total`]).
    ///
    /// # Errors
    /// Those of [`Target::values`] and [`check_admissible`].
    pub fn resolve(&self, surface: &Surface, class: Class) -> Result<PerVertex<f64>> {
        let mut target = self.values(surface, class.space)?;
        check_admissible(surface.mesh(), class, &target)?;
        settle_total(surface.mesh(), class.space, &mut target);
        Ok(target)
    }

    /// The vertices that the target names as cones.
    pub fn named(&self) -> Vec<VertexId> {
        match self {
            Target::Single(v) => vec![*v],
            Target::Cones(cones) => cones.iter().map(|cone| cone.0).collect(),
            _ => Vec::new(),
        }
    }

    /// The curvature of every vertex by this rule alone.
    ///
    /// # Errors
    /// [`Error::TargetKind`] for a rule that does not exist on this surface in this space, a vertex or loop that does not exist, `Auto`,
    /// whose cones are not placed yet, and `Outer`, whose curvature the flow finds; [`Error::Size`].
    pub fn values(&self, surface: &Surface, space: Space) -> Result<PerVertex<f64>> {
        let mesh = surface.mesh();
        let n = mesh.n_vertices();
        let kind = |message: &str| Error::TargetKind { target: self.name(), message: message.into() };
        let vertex = |v: VertexId| {
            if v.index() < n {
                return Ok(v);
            }
            Err(kind(&format!("vertex {v} does not exist, the surface has vertices 0 to {}", n - 1)))
        };
        let total = 2.0 * PI * mesh.euler() as f64;
        Ok(match self {
            Target::Uniform if space != Space::E2 => PerVertex::filled(n, 0.0),
            Target::Uniform if !mesh.is_closed() => {
                return Err(kind("exists in E² on closed surfaces only; use `boundary`"));
            }
            Target::Uniform => PerVertex::filled(n, total / n as f64),
            Target::Boundary if space != Space::E2 || mesh.is_closed() => {
                return Err(kind("exists in E² on surfaces with boundary only; use `uniform`"));
            }
            Target::Boundary => boundary_target(mesh, surface.lengths()),
            Target::Outer(outer) => {
                check_outer(mesh, space, *outer)?;
                return Err(kind("the flow finds the curvature of the boundary; its result has it"));
            }
            Target::Single(_) if space != Space::E2 => return Err(kind("exists in E² only; use `cones`")),
            Target::Single(v) => {
                let mut target = PerVertex::filled(n, 0.0);
                target[vertex(*v)?] = total;
                target
            }
            Target::Auto(_) => return Err(kind("its cones are still to be placed")),
            Target::Cones(cones) => {
                let mut target = PerVertex::filled(n, 0.0);
                let mut named = HashSet::new();
                for &(v, curvature) in cones {
                    target[vertex(v)?] = curvature;
                    if !named.insert(v) {
                        return Err(kind(&format!("vertex {v} is named twice")));
                    }
                }
                target
            }
            Target::All(values) => {
                check_size("target", values.len(), n)?;
                values.clone()
            }
        })
    }
}

/// Checks that a surface has an outer loop to hold, and this one if it is named.
fn check_outer(mesh: &Mesh, space: Space, outer: Option<usize>) -> Result<()> {
    let kind = |message: String| Error::TargetKind { target: Target::Outer(outer).name(), message };
    if space != Space::E2 || mesh.is_closed() || mesh.genus() != 0 {
        return Err(kind(
            "exists in E² on surfaces of genus 0 with boundary only; use `boundary` or `auto`".into(),
        ));
    }
    let n = mesh.boundary_loops().len();
    match outer {
        Some(k) if k >= n => {
            Err(kind(format!("loop {k} does not exist, the surface has loops 0 to {}", n - 1)))
        }
        _ => Ok(()),
    }
}

/// The longest boundary loop, by its place in [`Mesh::boundary_loops`]; 0 for a closed surface.
pub(crate) fn longest_loop(surface: &Surface) -> usize {
    let loops = surface.mesh().boundary_loops();
    let length = |rim: &Vec<_>| rim.iter().map(|h: &HalfedgeId| surface.lengths()[h.edge()]).sum::<f64>();
    let longest = loops.iter().map(length).enumerate();
    longest.fold((0, 0.0), |best, (k, length)| if length > best.1 { (k, length) } else { best }).0
}

/// The number of cones of the default target of an open surface in E²; 0 where it has none.
fn default_cones(surface: &Surface) -> usize {
    let mesh = surface.mesh();
    if mesh.genus() == 0 || surface.geometry() != Space::E2 {
        return 0;
    }
    let inside = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)).count();
    let [least, most] = DEFAULT_CONES;
    (mesh.euler().unsigned_abs() as usize).clamp(least, most).min(inside)
}

/// Necessary conditions on a target: [`check_vertices`] and [`check_total`]; for vertex scaling and inversive distance with
/// flips they are sufficient.
///
/// # Errors
/// Those of [`check_vertices`] and [`check_total`].
pub fn check_admissible(mesh: &Mesh, class: Class, target: &PerVertex<f64>) -> Result<()> {
    check_vertices(mesh, class.scheme, target)?;
    check_total(mesh, class.space, target)
}

/// Bounds on the curvature of each vertex: [`check_upper`], and for Thurston's and tangential packings, which never flip, a lower bound
/// too. Each of the d angles at a vertex is below π there, so `K̄ > (2 − d)π` inside, `(1 − d)π` on the boundary. (Conditions on larger vertex
/// sets are found by the flow that runs into them: [`crate::flow::Obstruction`].)
///
/// # Errors
/// Those of [`check_upper`]; [`Error::TargetBelow`].
pub fn check_vertices(mesh: &Mesh, scheme: Scheme, target: &PerVertex<f64>) -> Result<()> {
    check_upper(mesh, target)?;
    if !scheme.is_packing() {
        return Ok(());
    }
    for v in mesh.vertices() {
        let corners = mesh.outgoing(v).filter(|&h| !mesh.is_outside(h)).count();
        let limit = full_angle(mesh, v) - PI * corners as f64;
        if target[v] <= limit {
            let (curvature, excess) = (target[v], limit - target[v]);
            return Err(Error::TargetBelow { vertex: v.index(), curvature, limit, excess });
        }
    }
    Ok(())
}

/// Angles are positive: `K̄ < 2π` inside, `K̄ < π` on the boundary, on every triangulation.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for a number that is not finite; [`Error::TargetAtVertex`].
pub fn check_upper(mesh: &Mesh, target: &PerVertex<f64>) -> Result<()> {
    check_size("target", target.len(), mesh.n_vertices())?;
    for v in mesh.vertices() {
        let (curvature, limit) = (target[v], full_angle(mesh, v));
        if !curvature.is_finite() {
            let value = format!("{curvature} at vertex {v}");
            return Err(Error::Argument { what: "target curvature", value, need: "finite everywhere" });
        }
        if curvature >= limit {
            let excess = curvature - limit;
            return Err(Error::TargetAtVertex { vertex: v.index(), curvature, limit, excess });
        }
    }
    Ok(())
}

/// Least upper bound of the curvature of a vertex: 2π inside, π on the boundary.
pub(crate) fn full_angle(mesh: &Mesh, v: VertexId) -> f64 {
    if mesh.is_boundary_vertex(v) { PI } else { 2.0 * PI }
}

/// Gauss–Bonnet: `Σ K̄ = 2πχ` in E², `> 2πχ` in H², `< 2πχ` in S² (to [`TOTAL_TOLERANCE`]).
///
/// # Errors
/// [`Error::TargetTotal`].
pub fn check_total(mesh: &Mesh, space: Space, target: &PerVertex<f64>) -> Result<()> {
    let sum: f64 = target.iter().sum();
    let scale = 2.0 * PI + target.iter().map(|k| k.abs()).sum::<f64>();
    let miss = sum - 2.0 * PI * mesh.euler() as f64;
    let (holds, relation) = match space {
        Space::E2 => (miss.abs() <= TOTAL_TOLERANCE * scale, "exactly"),
        Space::H2 => (miss > TOTAL_TOLERANCE * scale, "more than"),
        Space::S2 => (miss < -TOTAL_TOLERANCE * scale, "less than"),
    };
    if holds {
        return Ok(());
    }
    let need = format!("{relation} 2πχ = {} in {space}", 2.0 * PI * mesh.euler() as f64);
    Err(Error::TargetTotal { sum, need, miss })
}

/// Correct a target in E² whose total misses 2πχ by no more than rounding: the difference is shared equally over the vertices that are
/// not flat. Without that all of it would remain at the one vertex whose u the solver holds. Other targets stay as they are.
pub fn settle_total(mesh: &Mesh, space: Space, target: &mut PerVertex<f64>) {
    let miss = target.iter().sum::<f64>() - 2.0 * PI * mesh.euler() as f64;
    if space == Space::E2 && check_total(mesh, space, target).is_ok() {
        let curved = target.iter().filter(|k| **k != 0.0).count();
        target.iter_mut().filter(|k| **k != 0.0).for_each(|k| *k -= miss / curved as f64);
    }
}

/// Length of the boundary edges at each vertex.
pub(crate) fn boundary_lengths(mesh: &Mesh, lengths: &PerEdge<f64>) -> PerVertex<f64> {
    let mut sum = PerVertex::filled(mesh.n_vertices(), 0.0);
    for h in mesh.boundary_loops().into_iter().flatten() {
        sum[mesh.origin(h)] += lengths[h.edge()];
        sum[mesh.tip(h)] += lengths[h.edge()];
    }
    sum
}

/// 2πχ over the boundary vertices in proportion to the boundary length adjacent to each.
fn boundary_target(mesh: &Mesh, lengths: &PerEdge<f64>) -> PerVertex<f64> {
    let total = 2.0 * PI * mesh.euler() as f64;
    let mut share = boundary_lengths(mesh, lengths);
    let boundary: Vec<VertexId> =
        mesh.boundary_loops().into_iter().flatten().map(|h| mesh.origin(h)).collect();
    let length: f64 = boundary.iter().map(|&v| share[v]).sum();
    let largest = boundary.iter().map(|&v| share[v]).fold(0.0, f64::max);
    let equal = total * largest / length >= PI;
    for &v in &boundary {
        share[v] = if equal { total / boundary.len() as f64 } else { total * share[v] / length };
    }
    share
}

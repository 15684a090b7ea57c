//! The initial metric of a scheme from the edge lengths of the input surface.
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let initial = torus.initial(Class::inversive(Space::E2))?;
//! let lengths = initial.metric.lengths(torus.mesh())?;
//! assert!(lengths.iter().zip(torus.lengths().iter()).all(|(a, b)| (a / b - 1.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::class::Class;
use super::curvature::area;
use super::lengths::{Metric, face_lengths};
use super::scheme::Scheme;
use super::scheme_distance::SchemeDistance;
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::geometry::conformal::{Vertex, radius};
use crate::geometry::scaled::scaled;
use crate::geometry::{DoubleDouble, Space, triangle, worse};
use crate::mesh::{EdgeId, Mesh, PerEdge, PerVertex};
use crate::parallel;
use crate::topology::check_lengths;
use std::f64::consts::PI;
use std::sync::Arc;

/// The initial metric, with the radii and u of the input against which the result of a flow is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// (ε, η, u) in the target space.
    pub metric: Metric,
    /// Geometry in which the input lengths were read.
    pub input_geometry: Space,
    /// Radii γ(0) in the input geometry ([`crate::geometry::conformal::radius`] of `input_u`); 1 at vertices with ε = 0.
    pub radii: PerVertex<f64>,
    /// `u` of those radii in the input geometry (0 at vertices with ε = 0).
    pub input_u: PerVertex<f64>,
    /// Edges whose η was moved into the scheme's range.
    pub clamped_edges: usize,
    /// Largest relative change of an edge length by that.
    pub max_length_change: f64,
    /// The distance of this metric from that of the surface, by that.
    pub distance: SchemeDistance,
}
stored!(sections Initial { metric, input_geometry, radii, input_u, clamped_edges, max_length_change,
    distance });

/// The initial metric of a class for input `lengths` (E entries, read in `input_geometry`), carried into the space of the class.
///
/// η is computed once, in the geometry of the input. Radii come from the corners' tangent lengths
/// `γ_i^{jk} = (l_ij + l_ki − l_jk)/2` \[JKLLG08, §4.1\]: their mean for Thurston's and tangential packings, their
/// minimum for inversive distance and virtual radius (then η ≥ 1 and nothing is clamped). When the
/// target space differs from the input geometry, u is shifted by one constant that brings the area near the one
/// Gauss–Bonnet asks for; a shift stays in the class.
///
/// # Errors
/// - [`Error::Size`]: lengths are not one per edge.
/// - [`Error::EdgeLength`]: a length out of range.
/// - [`Error::TriangleInequality`]: a face that is no triangle of the input geometry.
pub fn initial_metric(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    input_geometry: Space,
    class: Class,
) -> Result<Initial> {
    let Class { scheme, space } = class;
    check_triangles(mesh, lengths, input_geometry)?;
    let epsilon = PerVertex::filled(mesh.n_vertices(), scheme.epsilon());
    let radii = match scheme {
        Scheme::Yamabe => PerVertex::filled(mesh.n_vertices(), 1.0),
        _ => {
            let [mean, min] = corner_radii(mesh, lengths);
            if scheme.is_packing() { mean } else { min }
        }
    };
    let bounds = match scheme {
        Scheme::Thurston => EtaBounds::Clamp(0.0, 1.0),
        Scheme::Tangential => EtaBounds::Clamp(1.0, 1.0),
        _ => EtaBounds::Refuse,
    };
    let circles = MixedClass { epsilon, radii, space };
    represented(mesh, lengths, input_geometry, circles, bounds)
}

/// A conformal class of vertices of several types, with the radii that a metric is to be represented with.
#[derive(Debug, Clone, PartialEq)]
pub struct MixedClass {
    /// Types ε ∈ {−1, 0, 1} (V entries).
    pub epsilon: PerVertex<i8>,
    /// Radii γ in the geometry of the input (V entries, positive; unused where ε = 0).
    pub radii: PerVertex<f64>,
    /// The space of the class.
    pub space: Space,
}

/// Like [`initial_metric`] with given types and radii: the input lengths are represented exactly.
///
/// # Errors
/// Those of [`initial_metric`]; [`Error::Size`]; [`Error::EdgeWeight`] where two circles of ε = 1 would need η ≤ −1, or two of
/// ε = −1 η ≤ 1; [`Error::Domain`] for a radius that is not positive.
pub fn initial_mixed(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    input_geometry: Space,
    circles: MixedClass,
) -> Result<Initial> {
    check_triangles(mesh, lengths, input_geometry)?;
    check_size("epsilon", circles.epsilon.len(), mesh.n_vertices())?;
    check_size("radii", circles.radii.len(), mesh.n_vertices())?;
    represented(mesh, lengths, input_geometry, circles, EtaBounds::Refuse)
}

/// The treatment of an η that the scheme does not allow.
#[derive(Clone, Copy)]
enum EtaBounds {
    /// It is an error.
    Refuse,
    /// It is moved to the nearest end of this interval, which changes the length.
    Clamp(f64, f64),
}

/// The metric of a class whose edges have these lengths in the geometry of the input, up to the clamping of η to `bounds`.
fn represented(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    input_geometry: Space,
    circles: MixedClass,
    bounds: EtaBounds,
) -> Result<Initial> {
    let MixedClass { epsilon, radii, space } = circles;
    let n = mesh.n_vertices();
    let log = |v| if epsilon[v] == 0 { 0.0 } else { log_radius(input_geometry, radii[v]) };
    let input_u = PerVertex::from_fn(n, log);
    if let Some(v) = mesh.vertices().find(|&v| !input_u[v].is_finite()) {
        return Err(Error::Domain { vertex: v.index(), u: input_u[v], need: "a positive radius" });
    }
    let mut metric = Metric {
        space: input_geometry,
        epsilon,
        eta: Arc::new(Vec::new().into()),
        u: input_u.clone(),
        u_low: PerVertex::filled(n, 0.0),
    };
    let radii = metric.radii()?;
    let vertices = metric.vertices();
    let mut weights = vec![DoubleDouble::default(); mesh.n_edges()];
    parallel::fill(&mut weights, |e| {
        let e = EdgeId::from(e);
        weight_of_length(input_geometry, lengths[e], mesh.ends(e).map(|v| vertices[v]))
    });
    let mut clamped_edges = 0;
    match bounds {
        EtaBounds::Refuse => mesh
            .edges()
            .try_for_each(|e| check_weight(mesh.ends(e).map(|v| metric.epsilon[v]), e, weights[e.index()]))?,
        EtaBounds::Clamp(low, high) => {
            for eta in &mut weights {
                let clamped = match *eta {
                    x if (x - low.into()).high < 0.0 => low.into(),
                    x if (x - high.into()).high > 0.0 => high.into(),
                    x => x,
                };
                clamped_edges += usize::from(clamped != *eta);
                *eta = clamped;
            }
        }
    }
    metric.eta = Arc::new(weights.into());
    let clamped = if clamped_edges > 0 { Some(metric.lengths(mesh)?) } else { None };
    let start = clamped.as_ref().unwrap_or(lengths);
    let change = |e: EdgeId| (start[e] / lengths[e] - 1.0).abs();
    let max_length_change = if clamped.is_some() { mesh.edges().map(change).fold(0.0, worse) } else { 0.0 };
    let distance =
        clamped.as_ref().map_or_else(SchemeDistance::default, |c| SchemeDistance::between(mesh, lengths, c));
    let shift = start_shift(mesh, start, &metric, space)?;
    metric.space = space;
    metric.u.iter_mut().for_each(|u| *u += shift);
    Ok(Initial { metric, input_geometry, radii, input_u, clamped_edges, max_length_change, distance })
}

/// Checks that two vertices of these types can have this η.
#[inline]
fn check_weight(epsilon: [i8; 2], edge: EdgeId, eta: DoubleDouble) -> Result<()> {
    let need = match epsilon {
        [1, 1] if eta.high <= -1.0 => "above −1: the circles would contain each other; use smaller radii",
        [-1, -1] if eta.high <= 1.0 => "above 1 between imaginary circles",
        _ if !eta.high.is_finite() => "finite",
        _ => return Ok(()),
    };
    Err(Error::EdgeWeight { edge: edge.index(), eta: eta.high, need })
}

impl Initial {
    /// The initial metric of a flow that starts from a metric as it is, read in its own space.
    ///
    /// # Errors
    /// Those of [`Metric::radii`].
    pub(crate) fn of_metric(metric: Metric) -> Result<Initial> {
        Ok(Initial {
            input_geometry: metric.space,
            radii: metric.radii()?,
            input_u: metric.u.clone(),
            clamped_edges: 0,
            max_length_change: 0.0,
            distance: SchemeDistance::default(),
            metric,
        })
    }

    /// The conformal factor λ of [JKLLG08, Eqns 2–5] between the input and `metric`, per vertex: `u − u(0)` where
    /// ε = 0, `log(γ/γ(0))` elsewhere.
    ///
    /// # Errors
    /// [`Error::Size`] for a metric with another number of vertices.
    pub fn conformal_factor(&self, metric: &Metric) -> Result<PerVertex<f64>> {
        check_size("u", metric.u.len(), self.radii.len())?;
        check_size("epsilon", metric.epsilon.len(), self.radii.len())?;
        Ok(PerVertex::from_fn(metric.u.len(), |v| match metric.epsilon[v] {
            0 => metric.u[v] - self.input_u[v],
            // log γ is u: the radius itself may be beyond the range of f64.
            _ if metric.space == Space::E2 => metric.u[v] - self.radii[v].ln(),
            epsilon => (radius(metric.space, epsilon, metric.u[v]) / self.radii[v]).ln(),
        }))
    }
}

/// u of a circle of this radius: `log γ`, `log tanh(γ/2)`, `log tan(γ/2)`.
fn log_radius(space: Space, radius: f64) -> f64 {
    match space {
        Space::E2 => radius.ln(),
        Space::H2 => (0.5 * radius).tanh().ln(),
        Space::S2 => (0.5 * radius).tan().ln(),
    }
}

/// η from a length: the length formulas solved for it. In E² the length that η gives back is the given one, in double-double precision.
pub(crate) fn weight_of_length(space: Space, length: f64, [a, b]: [Vertex; 2]) -> DoubleDouble {
    // The unit of length is 2 to the larger exponent of the two circles.
    let unit = a.exponent.max(b.exponent);
    let n = match space {
        Space::E2 => {
            let length = DoubleDouble::from(scaled(length, -unit));
            length * length
        }
        Space::H2 => ((0.5 * length).sinh().powi(2) * a.d * b.d).into(),
        Space::S2 => ((0.5 * length).sin().powi(2) * a.d * b.d).into(),
    };
    let [x, y] = [a, b].map(|v| v.precise_scale().scaled(v.exponent - unit));
    let own = |v: Vertex, x: DoubleDouble| x * x * v.epsilon.into();
    (n - own(a, x) - own(b, y)) / (x * y * 2.0.into())
}

/// Mean and minimum, in this order, over the corners of each vertex of the tangent length `(l_ij + l_ki − l_jk)/2`.
pub(super) fn corner_radii(mesh: &Mesh, lengths: &PerEdge<f64>) -> [PerVertex<f64>; 2] {
    let n = mesh.n_vertices();
    let (mut mean, mut min) = (PerVertex::filled(n, 0.0), PerVertex::filled(n, f64::INFINITY));
    let mut corners = PerVertex::filled(n, 0u32);
    for f in mesh.faces() {
        let r = triangle::half_differences(face_lengths(mesh, lengths, f));
        for (v, r) in mesh.face_vertices(f).into_iter().zip(r) {
            mean[v] += r;
            min[v] = min[v].min(r);
            corners[v] += 1;
        }
    }
    for v in mesh.vertices() {
        mean[v] /= f64::from(corners[v]);
    }
    [mean, min]
}

/// Largest half chord, of the longest edge, that a flow starts with in a curved space, so that it starts from a moderate metric (in S²
/// half chords end at 1).
const MAX_START_HALF_CHORD: f64 = 0.5;
/// Largest u that a vertex of ε = 1 starts with in H². The domain is u < 0, and the radius log coth(−u/2) is 3 here.
const MAX_START_U: f64 = -0.1;

/// The constant by which u is shifted to carry a metric (with edge `lengths`) from the input geometry to `space`: the area comes near
/// the one that Gauss–Bonnet asks for, and no edge becomes longer than [`MAX_START_HALF_CHORD`].
fn start_shift(mesh: &Mesh, lengths: &PerEdge<f64>, input: &Metric, space: Space) -> Result<f64> {
    if input.space == space || space == Space::E2 {
        return Ok(0.0);
    }
    // N is l² in E², and nearly (l/2)² for short edges in the curved spaces. Hence the factor 1/4 = (1/2)² beside the wanted area.
    let wanted = match space {
        Space::H2 if mesh.euler() < 0 => -2.0 * PI * mesh.euler() as f64,
        Space::H2 => 1.0,
        _ => 4.0 * PI,
    };
    let area = area(mesh, input.space, lengths)?;
    let longest = lengths.iter().fold(0.0f64, |m, &l| m.max(l));
    let mut shift = (0.25 * wanted / area).sqrt().ln();
    shift = shift.min((MAX_START_HALF_CHORD / longest).ln());
    if space == Space::H2 {
        for v in mesh.vertices().filter(|&v| input.epsilon[v] == 1) {
            shift = shift.min(MAX_START_U - input.u[v]);
        }
    }
    Ok(shift)
}

/// Checks that every length is positive and every face a triangle of the input geometry.
pub(super) fn check_triangles(mesh: &Mesh, lengths: &PerEdge<f64>, geometry: Space) -> Result<()> {
    check_lengths(mesh, lengths)?;
    for f in mesh.faces() {
        let l = face_lengths(mesh, lengths, f);
        let r = triangle::half_differences(l);
        if triangle::is_broken(geometry, r) {
            let s: f64 = r.iter().sum();
            let worst = r.into_iter().fold(f64::INFINITY, f64::min);
            let longest = l.into_iter().fold(0.0, f64::max);
            let excess = if worst <= 0.0 { (-2.0 * worst / longest).max(0.0) } else { 2.0 * s - 2.0 * PI };
            return Err(Error::TriangleInequality { face: f.index(), excess });
        }
    }
    Ok(())
}

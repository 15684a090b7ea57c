//! The metric that a flow with flips starts from: its triangulation and its circles depend on the surface alone.
//!
//! ```
//! use ricci::{Class, Control, geometry::Space, mesh::{Mesh, PerEdge}, metric::{Triangulated, delaunay_start}};
//!
//! // A regular tetrahedron is Delaunay as it is.
//! let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])?;
//! let lengths = PerEdge::filled(mesh.n_edges(), 1.0);
//! let mut surface = Triangulated { mesh, lengths, geometry: Space::E2 };
//! let class = Class::yamabe(Space::E2).into();
//! let initial = delaunay_start(&mut surface, class, &mut |_, _| {}, &Control::new())?;
//! assert!(initial.metric.lengths(&surface.mesh)?.iter().all(|l| (l - 1.0).abs() < 1e-15));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::class::Class;
use super::initial::{Initial, MixedClass, check_triangles, corner_radii, initial_metric, initial_mixed};
use super::isometric::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
use super::scheme::Scheme;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::mesh::{Double, FixedEdges, Flip, Mesh, PerVertex};

/// Radii of the circles of inversive distance, as a share of the largest that do not overlap at any corner. With a share of 1 circles
/// would touch. Circles that touch lock their edge: it is Delaunay at every u and never flips, and its two radii bound the angles
/// there, so that targets beyond that bound are out of reach. A half keeps η well above 1 without making the circles small.
const SHARE_OF_LARGEST: f64 = 0.5;

/// Options of [`delaunay_start`].
#[derive(Debug, Clone, Copy)]
pub struct StartOptions<'a> {
    /// The conformal class.
    pub class: Class,
    /// The double, if the surface is that of another one: mirror images then get the same radii.
    pub double: Option<&'a Double>,
    /// Edges that are not flipped.
    pub fixed: &'a FixedEdges,
}

impl From<Class> for StartOptions<'_> {
    /// No double, no fixed edges.
    fn from(class: Class) -> Self {
        StartOptions { class, double: None, fixed: IntrinsicOptions::default().fixed }
    }
}

/// The initial metric of a class on the (weighted) Delaunay triangulation of the surface. Flips edges of `surface`, which stays the
/// same surface, and so makes the conformal class independent of the triangulation that the surface came with, up to ties.
///
/// - Vertex scaling: on the intrinsic Delaunay triangulation.
/// - Virtual radii: there too, with the radii from its corners; of two mirror images in a double the smaller one.
/// - Inversive distance: half of those radii, on the Delaunay triangulation weighted by the circles.
/// - Thurston's and tangential packings are Delaunay on any triangulation and stay on the given one.
///
/// `record` is called with each flip (the edge with its length) just before it is made.
///
/// # Errors
/// Those of [`initial_metric`] and [`intrinsic_delaunay`], with the surface as it was, maybe on another triangulation;
/// [`crate::Error::Size`] for the double of something else.
pub fn delaunay_start(
    surface: &mut Triangulated,
    options: StartOptions,
    record: &mut dyn FnMut(&Mesh, Flip),
    control: &Control,
) -> Result<Initial> {
    let radii = make_delaunay(surface, options, record, control)?;
    initial_on(surface, options.class, radii)
}

/// The flips of [`delaunay_start`]; returns the radii of virtual circles and of inversive distance.
///
/// # Errors
/// As there.
pub(crate) fn make_delaunay(
    surface: &mut Triangulated,
    options: StartOptions,
    record: &mut dyn FnMut(&Mesh, Flip),
    control: &Control,
) -> Result<Option<PerVertex<f64>>> {
    let StartOptions { class: Class { scheme, .. }, double, fixed } = options;
    if !scheme.is_packing() {
        let plain = IntrinsicOptions { circles: None, fixed };
        intrinsic_delaunay(surface, plain, record, control)?;
    }
    if scheme.is_packing() || scheme == Scheme::Yamabe {
        return Ok(None);
    }
    check_triangles(&surface.mesh, &surface.lengths, surface.geometry)?;
    let [_, mut radii] = corner_radii(&surface.mesh, &surface.lengths);
    if let Some(double) = double {
        check_size("vertices of the double", double.mesh.n_vertices(), radii.len())?;
        radii = PerVertex::from_fn(radii.len(), |v| radii[v].min(radii[double.mirror(v)]));
    }
    if scheme == Scheme::Inversive {
        radii.iter_mut().for_each(|r| *r *= SHARE_OF_LARGEST);
        let weighted = IntrinsicOptions { circles: Some(&radii), fixed };
        intrinsic_delaunay(surface, weighted, record, control)?;
    }
    Ok(Some(radii))
}

/// The metric of [`delaunay_start`] on the triangulation, with the radii that [`make_delaunay`] has led to.
///
/// # Errors
/// As there.
pub(crate) fn initial_on(
    surface: &Triangulated,
    class: Class,
    radii: Option<PerVertex<f64>>,
) -> Result<Initial> {
    let Triangulated { mesh, lengths, geometry } = surface;
    let Some(radii) = radii else { return initial_metric(mesh, lengths, *geometry, class) };
    let epsilon = PerVertex::filled(mesh.n_vertices(), class.scheme.epsilon());
    initial_mixed(mesh, lengths, *geometry, MixedClass { epsilon, radii, space: class.space })
}

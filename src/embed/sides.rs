//! The straight sides of a surface's boundary: their lengths, and how straight they are.

use super::cover_walk::CoverWalks;
use super::layout::{Layout, distance_from_origin};
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::complex::{cross, norm2};
use crate::geometry::{DoubleDouble, Motion, Space, worse};
use crate::mesh::{HalfedgeId, VertexId};
use crate::topology::HomotopyBasis;

/// A boundary loop of the surface as it came.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryLoop {
    /// The number of its generator c_j among the generators of the group, counted from 0.
    pub generator: usize,
    /// The half-edge of [`Layout::mesh`], of a face, with which its first side starts.
    pub start: HalfedgeId,
    /// Its straight sides, one after the other, the surface on their left; a loop without corners has one, all around.
    pub sides: Vec<BoundarySide>,
}
stored!(sections BoundaryLoop { generator, start, sides });

/// A straight side of the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundarySide {
    /// The vertex of the given surface at which it starts: a corner, or on a loop without corners the vertex of the lowest number.
    pub from: VertexId,
    /// The distance of its ends in the universal cover, in the scale of the layout.
    pub length: f64,
    /// The largest distance of a vertex of the boundary from the line through the ends of the side: in H² a length, in E² in units of the
    /// side's length.
    pub straightness: f64,
}
stored!(sections BoundarySide { from, length, straightness });

impl BoundaryLoop {
    /// The sum of the lengths of its sides.
    pub fn length(&self) -> f64 {
        self.sides.iter().map(|side| side.length).sum()
    }
}

/// The boundary loops of a surface, in the order of [`crate::mesh::Mesh::boundary_loops`] on the surface as it came, with sides from corner
/// to corner.
///
/// `layout`, `basis`: of this metric ([`super::LayoutOpening::MetricEdges`]). `corners`: in the order in which loops are to start with them.
///
/// # Errors
/// [`Error::Layout`] for a layout or basis of another surface; [`Error::Cancelled`].
pub fn boundary_sides(
    metric: &Solution,
    layout: &Layout,
    basis: &HomotopyBasis,
    corners: &[VertexId],
    control: &Control,
) -> Result<Vec<BoundaryLoop>> {
    let (given, mesh) = (metric.given(), layout.mesh());
    let walks = CoverWalks::new(metric, layout)?;
    // The boundary loops of the triangulation that is laid out, each from the edge of its generator on.
    let rims: Vec<Vec<HalfedgeId>> = basis.rims.iter().map(|&rim| mesh.boundary_from(rim)).collect();
    let mut of_vertex = vec![None; mesh.n_vertices()];
    for (generator, path) in rims.iter().enumerate() {
        path.iter().for_each(|&h| of_vertex[mesh.origin(h).index()] = Some((generator, h)));
    }
    let torn = || Error::Layout("the boundary of the layout is not that of the surface".into());
    let measured = |outside: Vec<HalfedgeId>| {
        control.check()?;
        let on_loop: Vec<VertexId> = outside.iter().map(|&h| given.origin(h)).collect();
        let corner = corners.iter().copied().find(|v| on_loop.contains(v));
        let first = corner.or_else(|| on_loop.iter().copied().min()).ok_or_else(torn)?;
        let (generator, start) = of_vertex[first.index()].ok_or_else(torn)?;
        let path = mesh.boundary_from(start);
        let points = walks.points(start, &path)?;
        let is_corner = |k: &usize| *k == 0 || corners.contains(&mesh.origin(path[*k]));
        let mut ends: Vec<usize> = (0..path.len()).filter(is_corner).collect();
        ends.push(path.len());
        let side = |k: &[usize]| {
            let from = mesh.origin(path[k[0]]);
            side_through(layout, from, &points[k[0]..=k[1]])
        };
        let generator = 2 * basis.group.genus + generator;
        Ok(BoundaryLoop { generator, start, sides: ends.windows(2).map(side).collect() })
    };
    given.boundary_loops().into_iter().map(measured).collect()
}

/// The side from the vertex `from` through these points, which are in the metric's own lengths.
fn side_through(layout: &Layout, from: VertexId, points: &[[DoubleDouble; 3]]) -> BoundarySide {
    let to_origin = Motion::to_origin(layout.space, points[0]);
    let moved: Vec<[DoubleDouble; 3]> = points.iter().map(|&p| to_origin.apply(p)).collect();
    let [x, y, w] = moved[moved.len() - 1];
    let along = [x, y];
    let length = distance_from_origin(layout.space, [x, y, w].map(f64::from));
    let unit = f64::from(norm2(along).sqrt());
    // The distance of a point from the line through the origin, in H² its hyperbolic sine.
    let off = |p: &[DoubleDouble; 3]| f64::from(cross(along, [p[0], p[1]])).abs() / unit;
    let farthest = moved.iter().map(off).fold(0.0, worse);
    let (length, straightness) = match layout.space {
        Space::H2 => (length, farthest.asinh()),
        _ => (layout.scale * length, farthest / length),
    };
    BoundarySide { from, length, straightness }
}

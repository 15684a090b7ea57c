//! Charts: a layout that overlaps itself is cut into charts that do not, and these are packed into the unit square.
//!
//! A chart grows face by face around a seed, in the order of the distance from it; a face whose image would overlap the chart stays
//! outside. Overlap is decided exactly ([`crate::geometry::triangle_overlap`]). Each seed is the largest face that has no chart yet. An
//! injective layout grows into one chart. At the end charts that fit together are joined.
//!
//! Packed charts are tested for overlap again: scaling and moving rounds coordinates to those of the unit square, and a vertex that nearly
//! touched another face may then lie inside it. Such charts are cut once more and all are packed anew, until none overlaps itself. Charts
//! are never joined again on the way, so this ends.
//!
//! Faces that are smaller than f64s resolve do not keep others out: if the scales span more than 1e16, as around a single cone on a surface
//! of high genus, whole regions shrink to a point. Such faces stay in the chart around them.
//!
//! ```
//! use ricci::embed::{ChartOptions, Layout, charts};
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! # fn main() -> ricci::Result<()> {
//! let disk = Surface::from_soup(&shapes::disk(4)?)?;
//! let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
//! let flat = Layout::of_lengths(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
//! let charts = charts(disk.mesh(), |h| flat.uv(h), &ChartOptions::default(), &Control::new())?;
//! assert!(charts.count() == 1 && charts.efficiency > 0.7);
//! # Ok(())
//! # }
//! ```

use super::chart_growth::{ChartPartition, PlaneLayout, partition};
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::PlaneIsometry;
use crate::geometry::complex::{distance, doubled_area};
use crate::geometry::packing::{least_rectangle, least_square, pack};
use crate::geometry::predicates::orientation;
use crate::geometry::triangle_flatness::{TriangleFlatness, TriangleOrientation, largest_coordinate};
use crate::geometry::triangle_overlap::TriangleCorners;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::topology::number_corners;
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

/// The coordinates in the unit square are multiples of the inverse of this number, the spacing of f64s between 1/2 and 1, so that no
/// difference of two coordinates is rounded.
const GRID: f64 = (1u64 << 53) as f64;
/// Least distance of two charts, in sides of the unit square: enough steps of the grid that rounding lets no chart touch another.
const ROOM: f64 = 64.0 / GRID;

/// The options of [`charts`].
#[derive(Debug, Clone, PartialEq)]
pub struct ChartOptions {
    /// Least distance of two charts, in sides of the unit square; half of it is left at the border. Default 1/256.
    pub margin: f64,
}

impl Default for ChartOptions {
    fn default() -> Self {
        ChartOptions { margin: 1.0 / 256.0 }
    }
}

/// The charts of a layout, packed into the unit square.
#[derive(Debug, Clone, PartialEq)]
pub struct Charts {
    /// The chart of each face. Charts are numbered by their area in the layout, the largest first.
    pub chart: PerFace<u32>,
    /// Per half-edge, the index into `coordinates` of the corner at its origin, in its face; outside the surface, in the face across the
    /// edge. Corners share an index where no seam or boundary separates them.
    pub corner_index: PerHalfedge<u32>,
    /// The points in the unit square, multiples of 2⁻⁵³.
    pub coordinates: Vec<[f64; 2]>,
    /// Per chart, the motion that follows the scaling by `scale`: `uv = motion(scale · layout)`.
    pub motions: Vec<PlaneIsometry>,
    /// The ratio of lengths in the unit square to lengths in the layout, the same for all charts.
    pub scale: f64,
    /// The share of the unit square that is covered.
    pub efficiency: f64,
    /// Per edge, true if it is an interior edge along which the charts are cut: the seams of the layout, and more.
    pub is_seam: PerEdge<bool>,
    /// The total length of the layout's own seams, and of those of the charts, in units of the layout.
    pub seam_length: [f64; 2],
    /// The faces whose image is clockwise and not degenerate. Each is a chart of its own, since no motion of the plane can turn it over.
    pub flipped: Vec<FaceId>,
    /// The faces with an area that rounding can explain, in the layout or in the unit square: at most
    /// [`crate::geometry::triangle_flatness::LEAST_RELATIVE_AREA`] · longest edge², or with a height of at most two steps of the
    /// coordinates. They lie in the charts of their neighbours, and may overlap the faces around them by as much as their own size.
    pub degenerate: Vec<FaceId>,
}
stored!(sections Charts { chart, corner_index, coordinates, motions, scale, efficiency, is_seam,
    seam_length, flipped, degenerate });

impl Charts {
    /// The number of charts.
    pub fn count(&self) -> usize {
        self.motions.len()
    }

    /// The coordinates of the corner at the origin of `h`, in its face.
    pub fn corner_uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates[self.corner_index[h] as usize]
    }

    /// The coordinates of a face's corners, in its corner order.
    pub fn face_uv(&self, mesh: &Mesh, f: FaceId) -> TriangleCorners {
        mesh.face_halfedges(f).map(|h| self.corner_uv(h))
    }
}

/// Cuts a layout into charts that do not overlap themselves, and packs them.
///
/// `uv(h)`: the plane coordinates of the corner at the origin of h, in its face (h inside the surface). Two faces are joined across an edge
/// if both give its ends exactly the same coordinates. Every chart is connected by joined faces. In the layout and, exactly, in the
/// returned [`Charts::coordinates`], the faces of a chart that are not [`Charts::degenerate`] have disjoint interiors.
///
/// The result is deterministic. O(F log F) for layouts of bounded overlap, each time that rounding makes it necessary to cut again.
///
/// # Errors
/// [`Error::Layout`] for coordinates that are not finite or a layout without area; [`Error::Argument`] for a margin that is
/// negative or leaves no room; [`Error::Cancelled`].
pub fn charts(
    mesh: &Mesh,
    uv: impl Fn(HalfedgeId) -> [f64; 2],
    options: &ChartOptions,
    control: &Control,
) -> Result<Charts> {
    let margin = options.margin;
    if !(0.0..1.0).contains(&margin) {
        return Err(Error::Argument { what: "margin", value: margin.to_string(), need: "in [0, 1)" });
    }
    let triangles: Vec<TriangleCorners> = mesh.faces().map(|f| mesh.face_halfedges(f).map(&uv)).collect();
    if let Some(f) = triangles.iter().position(|t| !t.as_flattened().iter().all(|x| x.is_finite())) {
        return Err(Error::Layout(format!("face {f} has coordinates that are not finite")));
    }
    let area: f64 = triangles.iter().map(|&t| doubled_area(t).abs()).sum::<f64>() * 0.5;
    if !(area > 0.0 && area.is_finite()) {
        return Err(Error::Layout("the layout has no area, or more than floating-point numbers hold".into()));
    }
    let mut layout = PlaneLayout::new(mesh, triangles);
    let layout_seams = layout.seams();
    let mut cut = partition(&layout, &layout.triangles, [0.0, 0.4], control)?;
    let charts = loop {
        layout.separate(&cut.chart);
        let charts = layout.pack(cut, margin, control)?;
        let placed: Vec<TriangleCorners> = mesh.faces().map(|f| charts.face_uv(mesh, f)).collect();
        layout.mark_degenerate(&placed);
        // Rounding may have made charts overlap themselves: then they are cut once more.
        cut = partition(&layout, &placed, [0.5, 0.4], control)?;
        if cut.count == charts.count() {
            break charts;
        }
    };
    Ok(Charts {
        efficiency: area * charts.scale * charts.scale,
        seam_length: [&layout_seams, &charts.is_seam].map(|seams| layout.length(seams)),
        flipped: layout.faces_with(TriangleOrientation::Flipped),
        degenerate: layout.faces_with(TriangleOrientation::Degenerate),
        ..charts
    })
}

impl<'a> PlaneLayout<'a> {
    /// The layout with these finite corners of its faces. Two faces are joined across an edge if both give its ends the same coordinates.
    fn new(mesh: &'a Mesh, triangles: Vec<TriangleCorners>) -> Self {
        let extent = largest_coordinate(triangles.as_flattened());
        let orientation = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
            TriangleFlatness::of(triangles[f.index()]).orientation(extent)
        });
        let area = PerFace::from_fn(mesh.n_faces(), |f: FaceId| doubled_area(triangles[f.index()]).abs());
        let joined = PerEdge::filled(mesh.n_edges(), false);
        let mut layout = PlaneLayout { mesh, triangles, orientation, joined, area };
        layout.joined = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| {
            let is_unflipped = |f| layout.orientation[f] != TriangleOrientation::Flipped;
            let [left, right] = [e.halfedge(), e.halfedge().twin()];
            match (layout.side(left), layout.side(right)) {
                (Some((f, [p, q])), Some((g, [r, s]))) => {
                    is_unflipped(f) && is_unflipped(g) && p == s && q == r
                }
                _ => false,
            }
        });
        layout
    }

    /// The face of a half-edge, and the ends of the half-edge in the layout of this face; none outside the surface.
    fn side(&self, h: HalfedgeId) -> Option<(FaceId, [[f64; 2]; 2])> {
        let (f, k) = self.mesh.corner(h)?;
        let corners = self.triangles[f.index()];
        Some((f, [corners[k], corners[(k + 1) % 3]]))
    }

    /// Per edge, true if it lies inside the surface and its faces are not joined.
    fn seams(&self) -> PerEdge<bool> {
        PerEdge::from_fn(self.mesh.n_edges(), |e| !self.mesh.is_boundary_edge(e) && !self.joined[e])
    }

    /// The total length of some edges inside the surface; if the two faces of an edge differ, the mean of both counts.
    fn length(&self, edges: &PerEdge<bool>) -> f64 {
        let length = |h| self.side(h).map_or(0.0, |(_, [p, q])| distance(p, q));
        let seams = self.mesh.edges().filter(|&e| edges[e]).map(EdgeId::halfedge);
        seams.map(|h| 0.5 * (length(h) + length(h.twin()))).sum()
    }

    /// Lets faces of different charts not be joined any more.
    fn separate(&mut self, chart: &PerFace<u32>) {
        for e in self.mesh.edges() {
            let [f, g] = [e.halfedge(), e.halfedge().twin()].map(|h| self.mesh.face(h).map(|f| chart[f]));
            self.joined[e] &= f == g;
        }
    }

    /// The charts of a partition, opened along the seams and moved into the unit square. Their efficiency, seam lengths and lists of faces
    /// are not computed yet.
    fn pack(&self, cut: ChartPartition, margin: f64, control: &Control) -> Result<Charts> {
        let is_seam = self.seams();
        let (corner_index, n_points) = number_corners(self.mesh, &is_seam);
        let (mut coordinates, mut chart) = (vec![[0.0; 2]; n_points], vec![0; n_points]);
        for f in self.mesh.faces() {
            for (h, p) in self.mesh.face_halfedges(f).into_iter().zip(self.triangles[f.index()]) {
                let k = corner_index[h] as usize;
                (coordinates[k], chart[k]) = (p, cut.chart[f]);
            }
        }
        let (scale, motions) = arrange(&mut coordinates, &chart, cut.count, margin, control)?;
        let (chart, efficiency, seam_length) = (cut.chart, 0.0, [0.0; 2]);
        let (flipped, degenerate) = (Vec::new(), Vec::new());
        Ok(Charts {
            chart,
            corner_index,
            coordinates,
            motions,
            scale,
            efficiency,
            is_seam,
            seam_length,
            flipped,
            degenerate,
        })
    }

    /// Marks as degenerate the upright faces that have no area left after rounding to the unit square. `packed`: their corners there.
    fn mark_degenerate(&mut self, packed: &[TriangleCorners]) {
        for (known, &[a, b, c]) in self.orientation.iter_mut().zip(packed) {
            let is_flat = || {
                orientation(a, b, c) != Ordering::Greater
                    || TriangleFlatness::of([a, b, c]).is_degenerate(1.0)
            };
            if *known == TriangleOrientation::Upright && is_flat() {
                *known = TriangleOrientation::Degenerate;
            }
        }
    }

    fn faces_with(&self, wanted: TriangleOrientation) -> Vec<FaceId> {
        self.mesh.faces().filter(|&f| self.orientation[f] == wanted).collect()
    }
}

/// Turns, scales and moves the points of all charts into the unit square; the result is the scale and, per chart, the motion that follows
/// it. `chart`: the chart of each point.
fn arrange(
    points: &mut [[f64; 2]],
    chart: &[u32],
    count: usize,
    margin: f64,
    control: &Control,
) -> Result<(f64, Vec<PlaneIsometry>)> {
    let mut of_chart: Vec<Vec<[f64; 2]>> = vec![Vec::new(); count];
    points.iter().zip(chart).for_each(|(&p, &c)| of_chart[c as usize].push(p));
    let margin = margin.max(ROOM);
    let rectangle = |points: &Vec<[f64; 2]>| control.check().map(|()| least_rectangle(points));
    let mut rectangles: Vec<(f64, [f64; 2])> = of_chart.iter().map(rectangle).collect::<Result<_>>()?;
    let sides =
        |rectangles: &[(f64, [f64; 2])]| -> Vec<[f64; 2]> { rectangles.iter().map(|r| r.1).collect() };
    let (mut scale, mut places) = pack(&sides(&rectangles), margin, control)?.ok_or_else(|| {
        let need = "small enough to leave room between the charts";
        Error::Argument { what: "margin", value: format!("{margin} with {count} charts"), need }
    })?;
    // If the largest chart alone limits the scale, its least square may allow a larger scale than its least rectangle.
    let square = least_square(&of_chart[0]);
    let first = std::mem::replace(&mut rectangles[0], square);
    match pack(&sides(&rectangles), margin, control)? {
        Some(better) if better.0 > scale => (scale, places) = better,
        _ => rectangles[0] = first,
    }
    drop(of_chart);
    control.check()?;
    let angle = |c: usize| rectangles[c].0 + if places[c].turned { FRAC_PI_2 } else { 0.0 };
    let turns: Vec<PlaneIsometry> = (0..count).map(|c| PlaneIsometry::new(angle(c), [0.0; 2])).collect();
    let mut low = vec![[f64::INFINITY; 2]; count];
    for (p, &c) in points.iter_mut().zip(chart) {
        // A turn by nothing leaves the coordinates as they are.
        let turned = turns[c as usize].apply_vector(*p);
        *p = turned.map(|x| scale * x);
        let low = &mut low[c as usize];
        *low = [low[0].min(p[0]), low[1].min(p[1])];
    }
    for (p, &c) in points.iter_mut().zip(chart) {
        let (low, at) = (low[c as usize], places[c as usize].at);
        *p = [0, 1].map(|k| ((p[k] - low[k] + at[k]) * GRID).round() / GRID);
    }
    let motion = |c: usize| PlaneIsometry::new(angle(c), [0, 1].map(|k| places[c].at[k] - low[c][k]));
    Ok((scale, (0..count).map(motion).collect()))
}

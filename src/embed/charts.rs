//! Charts: a layout that overlaps itself, cut into pieces that do not and packed into the unit square.
//!
//! Charts grow face by face around a seed, in the order of the distance from it; a face whose image would overlap the chart stays
//! outside. Overlap is decided exactly ([`super::overlap`]). Seeds are the largest faces that are left. A layout that is injective
//! grows into one chart. At the end charts that fit together are joined.

use super::corner::number_corners;
use super::overlap::{BoxTree, Triangle};
use super::pack::{least_rectangle, least_square, pack};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::PlaneIsometry;
use crate::geometry::predicates::orientation;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::topology::spanning::Key;
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeSet, BinaryHeap};
use std::f64::consts::FRAC_PI_2;

/// Faces between two looks at the control.
const FACES_PER_STEP: usize = 4096;
/// No chart.
const NONE: u32 = u32::MAX;

/// Options of [`charts`].
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

/// Charts in the unit square.
#[derive(Debug, Clone, PartialEq)]
pub struct Charts {
    /// The chart of each face. Charts are numbered by their area in the layout, the largest first.
    pub chart: PerFace<u32>,
    /// Per half-edge, the index into `coordinates` of the corner at its origin, in its face; outside the surface that of the face
    /// across the edge. Corners share an index where no seam or boundary separates them.
    pub corner_index: PerHalfedge<u32>,
    /// Points in the unit square.
    pub coordinates: Vec<[f64; 2]>,
    /// Per chart the motion, after scaling by `scale`: `uv = motion(scale · layout)`.
    pub motions: Vec<PlaneIsometry>,
    /// Lengths in the unit square over lengths in the layout, the same for all charts.
    pub scale: f64,
    /// Share of the unit square that is covered.
    pub efficiency: f64,
    /// Interior edges along which the charts are cut: the seams of the layout, and more.
    pub is_seam: PerEdge<bool>,
    /// Total length of the layout's own seams, and of those of the charts, in units of the layout.
    pub seam_length: [f64; 2],
    /// Faces whose image is clockwise or has no area. Each is a chart of its own: no motion of the plane mends it.
    pub flipped: Vec<FaceId>,
}

impl Charts {
    /// Number of charts.
    pub fn count(&self) -> usize {
        self.motions.len()
    }

    /// Coordinates of the corner at the origin of `h`, in its face.
    pub fn corner_uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates[self.corner_index[h] as usize]
    }

    /// Coordinates of a face's corners, in its corner order.
    pub fn face_uv(&self, mesh: &Mesh, f: FaceId) -> Triangle {
        mesh.face_halfedges(f).map(|h| self.corner_uv(h))
    }
}

/// Cut a layout into charts that do not overlap themselves, and pack them.
///
/// `uv(h)`: plane coordinates of the corner at the origin of h, in its face (h inside the surface). Faces hang together across an
/// edge where both give its ends exactly the same coordinates. Every chart is connected, and its counterclockwise faces have
/// disjoint interiors in the layout, exactly; moving and scaling it rounds its coordinates to doubles of the unit square.
///
/// Deterministic. O(F log F) for layouts of bounded overlap.
///
/// Errors: [`Error::Layout`] for coordinates that are not finite or a layout without area; [`Error::Argument`] for a margin that is
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
    let triangles: Vec<Triangle> = mesh.faces().map(|f| mesh.face_halfedges(f).map(&uv)).collect();
    if let Some(f) = triangles.iter().position(|t| !t.as_flattened().iter().all(|x| x.is_finite())) {
        return Err(Error::Layout(format!("face {f} has coordinates that are not finite")));
    }
    let area: f64 = triangles.iter().map(|t| doubled_area(t).abs()).sum::<f64>() * 0.5;
    if !(area > 0.0 && area.is_finite()) {
        return Err(Error::Layout("the layout has no area, or more than doubles hold".into()));
    }
    let (mut growth, flipped) = Growth::new(mesh, &triangles, &uv);
    growth.grow(control)?;
    growth.join(control)?;
    let (chart, count) = growth.numbered();

    let own_seam = |e: EdgeId| !mesh.is_boundary_edge(e) && !growth.joined[e];
    let between = |e: EdgeId| {
        let [f, g] = [e.halfedge(), e.halfedge().twin()].map(|h| mesh.face(h).map(|f| chart[f]));
        own_seam(e) || (!mesh.is_boundary_edge(e) && f != g)
    };
    let is_seam = PerEdge::from_fn(mesh.n_edges(), between);
    let length = |h: HalfedgeId| {
        let (p, q) = (uv(h), uv(mesh.next(h)));
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    let total = |seam: &dyn Fn(EdgeId) -> bool| -> f64 {
        let sides = mesh.edges().filter(|&e| seam(e)).map(|e| [e.halfedge(), e.halfedge().twin()]);
        sides.map(|[h, t]| 0.5 * (length(h) + length(t))).sum()
    };
    let seam_length = [total(&own_seam), total(&|e| is_seam[e])];

    let (corner_index, n_points) = number_corners(mesh, &is_seam);
    let mut points = vec![[0.0; 2]; n_points];
    let mut point_chart = vec![0u32; n_points];
    for f in mesh.faces() {
        for h in mesh.face_halfedges(f) {
            let k = corner_index[h] as usize;
            (points[k], point_chart[k]) = (uv(h), chart[f]);
        }
    }
    let (scale, motions) = arrange(&mut points, &point_chart, count, margin, control)?;
    Ok(Charts {
        chart,
        corner_index,
        coordinates: points,
        motions,
        scale,
        efficiency: area * scale * scale,
        is_seam,
        seam_length,
        flipped,
    })
}

/// Turn, scale and move the points of all charts into the unit square.
fn arrange(
    points: &mut [[f64; 2]],
    chart: &[u32],
    count: usize,
    margin: f64,
    control: &Control,
) -> Result<(f64, Vec<PlaneIsometry>)> {
    let mut of_chart: Vec<Vec<[f64; 2]>> = vec![Vec::new(); count];
    points.iter().zip(chart).for_each(|(&p, &c)| of_chart[c as usize].push(p));
    control.step(Stage::Layout, 0.9)?;
    let mut rectangles: Vec<(f64, [f64; 2])> =
        of_chart.iter().map(|points| least_rectangle(points)).collect();
    let sides =
        |rectangles: &[(f64, [f64; 2])]| -> Vec<[f64; 2]> { rectangles.iter().map(|r| r.1).collect() };
    let (mut scale, mut places) = pack(&sides(&rectangles), margin).ok_or_else(|| {
        let need = "small enough to leave room between the charts";
        Error::Argument { what: "margin", value: format!("{margin} with {count} charts"), need }
    })?;
    // Where the largest chart alone sets the scale, its least square counts, not its least rectangle.
    let square = least_square(&of_chart[0]);
    let first = std::mem::replace(&mut rectangles[0], square);
    match pack(&sides(&rectangles), margin) {
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
        *p = [0, 1].map(|k| (p[k] - low[k] + at[k]).clamp(0.0, 1.0));
    }
    let motion = |c: usize| PlaneIsometry::new(angle(c), [0, 1].map(|k| places[c].at[k] - low[c][k]));
    Ok((scale, (0..count).map(motion).collect()))
}

/// Charts in the making.
struct Growth<'a> {
    mesh: &'a Mesh,
    triangles: &'a [Triangle],
    /// Interior edges across which the layout is continuous and both faces counterclockwise.
    joined: PerEdge<bool>,
    chart: PerFace<u32>,
    /// The faces of each chart.
    members: Vec<Vec<FaceId>>,
    tree: BoxTree<'a>,
    /// Per face: twice its area in the layout.
    area: Vec<f64>,
}

impl<'a> Growth<'a> {
    /// Every flipped face is a chart, the others are in none yet.
    fn new(
        mesh: &'a Mesh,
        triangles: &'a [Triangle],
        uv: &impl Fn(HalfedgeId) -> [f64; 2],
    ) -> (Growth<'a>, Vec<FaceId>) {
        let left = |f: FaceId| {
            let [a, b, c] = triangles[f.index()];
            orientation(a, b, c) == Ordering::Greater
        };
        let sound = PerFace::from_fn(mesh.n_faces(), left);
        let joined = PerEdge::from_fn(mesh.n_edges(), |e| {
            let (h, t) = (e.halfedge(), e.halfedge().twin());
            let faces = [h, t].map(|h| mesh.face(h).is_some_and(|f| sound[f]));
            faces == [true; 2] && uv(h) == uv(mesh.next(t)) && uv(mesh.next(h)) == uv(t)
        });
        let flipped: Vec<FaceId> = mesh.faces().filter(|&f| !sound[f]).collect();
        let mut chart = PerFace::filled(mesh.n_faces(), NONE);
        flipped.iter().enumerate().for_each(|(k, &f)| chart[f] = k as u32);
        let members = flipped.iter().map(|&f| vec![f]).collect();
        let area = triangles.iter().map(|t| doubled_area(t).abs()).collect();
        (Growth { mesh, triangles, joined, chart, members, tree: BoxTree::new(triangles), area }, flipped)
    }

    /// Faces across the joined edges of f.
    fn neighbours(&self, f: FaceId) -> impl Iterator<Item = FaceId> + '_ {
        let sides = self.mesh.face_halfedges(f).into_iter();
        sides.filter(|h| self.joined[h.edge()]).filter_map(|h| self.mesh.face(h.twin()))
    }

    fn centre(&self, f: FaceId) -> [f64; 2] {
        let [a, b, c] = self.triangles[f.index()];
        [0, 1].map(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0)
    }

    /// Grow charts until every face is in one.
    fn grow(&mut self, control: &Control) -> Result<()> {
        let mut seeds: Vec<FaceId> = self.mesh.faces().filter(|&f| self.chart[f] == NONE).collect();
        seeds.sort_by(|f, g| self.area[g.index()].total_cmp(&self.area[f.index()]).then(f.cmp(g)));
        let mut refused = PerFace::filled(self.mesh.n_faces(), NONE);
        let mut done = 0;
        for seed in seeds {
            if self.chart[seed] != NONE {
                continue;
            }
            let number = self.members.len() as u32;
            let mut members = Vec::new();
            let mut queue = BinaryHeap::from([Reverse((Key(0.0), seed))]);
            while let Some(Reverse((Key(distance), f))) = queue.pop() {
                if self.chart[f] != NONE || refused[f] == number {
                    continue;
                }
                if usize::is_multiple_of(done, FACES_PER_STEP) {
                    control.step(Stage::Layout, 0.8 * done as f64 / self.mesh.n_faces() as f64)?;
                }
                if self.tree.meeting(f.index()).is_some() {
                    // The chart only grows: what overlaps it now always will.
                    refused[f] = number;
                    continue;
                }
                self.tree.insert(f.index());
                self.chart[f] = number;
                members.push(f);
                done += 1;
                let here = self.centre(f);
                for g in self.neighbours(f).filter(|&g| self.chart[g] == NONE && refused[g] != number) {
                    let there = self.centre(g);
                    let step = (there[0] - here[0]).hypot(there[1] - here[1]);
                    queue.push(Reverse((Key(distance + step), g)));
                }
            }
            members.iter().for_each(|f| self.tree.remove(f.index()));
            self.members.push(members);
        }
        Ok(())
    }

    /// Join charts that hang together and do not overlap: each, from the largest down, with its neighbours, the largest first.
    fn join(&mut self, control: &Control) -> Result<()> {
        let size =
            |g: &Self, c: u32| -> f64 { g.members[c as usize].iter().map(|f| g.area[f.index()]).sum() };
        let mut order: Vec<(Key, Reverse<u32>)> =
            (0..self.members.len() as u32).map(|c| (Key(size(self, c)), Reverse(c))).collect();
        order.sort_unstable_by(|a, b| b.cmp(a));
        let rank: Vec<u32> = {
            let mut rank = vec![0; order.len()];
            order.iter().enumerate().for_each(|(k, c)| rank[c.1.0 as usize] = k as u32);
            rank
        };
        for &(_, Reverse(host)) in &order {
            control.check()?;
            if self.members[host as usize].is_empty() {
                continue;
            }
            let mut waiting: BTreeSet<u32> = self.around(host).map(|c| rank[c as usize]).collect();
            if waiting.is_empty() {
                continue;
            }
            self.members[host as usize].iter().for_each(|f| self.tree.insert(f.index()));
            let mut tried = BTreeSet::new();
            while let Some(next) = waiting.pop_first() {
                let guest = order[next as usize].1.0;
                if !tried.insert(next) {
                    continue;
                }
                if self.members[guest as usize].iter().any(|f| self.tree.meeting(f.index()).is_some()) {
                    continue;
                }
                let further: Vec<u32> = self.around(guest).filter(|&c| c != host).collect();
                waiting.extend(further.into_iter().map(|c| rank[c as usize]).filter(|r| !tried.contains(r)));
                for f in std::mem::take(&mut self.members[guest as usize]) {
                    self.tree.insert(f.index());
                    self.chart[f] = host;
                    self.members[host as usize].push(f);
                }
            }
            self.members[host as usize].iter().for_each(|f| self.tree.remove(f.index()));
        }
        Ok(())
    }

    /// Charts across the joined edges of a chart; some more than once.
    fn around(&self, c: u32) -> impl Iterator<Item = u32> + '_ {
        let faces = self.members[c as usize].iter();
        faces.flat_map(|&f| self.neighbours(f)).map(|g| self.chart[g]).filter(move |&other| other != c)
    }

    /// Chart numbers by area, the largest first, and how many there are.
    fn numbered(&self) -> (PerFace<u32>, usize) {
        let area = |c: &usize| -> f64 { self.members[*c].iter().map(|f| self.area[f.index()]).sum() };
        let mut order: Vec<usize> =
            (0..self.members.len()).filter(|&c| !self.members[c].is_empty()).collect();
        order.sort_by_cached_key(|c| (Reverse(Key(area(c))), *c));
        let mut chart = PerFace::filled(self.mesh.n_faces(), 0);
        for (number, &c) in order.iter().enumerate() {
            self.members[c].iter().for_each(|&f| chart[f] = number as u32);
        }
        (chart, order.len())
    }
}

fn doubled_area(&[a, b, c]: &Triangle) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

//! Short paths across a chart, from one stretch of its border to another.

use super::flat_chart::{ChartFaces, FlatChart};
use super::seam_points::seam_weights;
use crate::flatten::rim::BorderRim;
use crate::geometry::complex::doubled_area;
use crate::geometry::vector::distance;
use crate::mesh::{EdgeId, Mesh, PerEdge, VertexId};
use crate::topology::nearest::NearestQueue;

/// The shares of a stretch of the border, at each of its ends, at which a path across does not end, of the paths that are tried.
const INSETS: [f64; 6] = [0.0, 0.05, 0.12, 0.2, 0.3, 0.4];
/// The number of starts of four equal stretches of the border between which paths are tried.
const QUARTER_STARTS: usize = 8;

/// A path across a chart.
pub(super) struct CrossCut {
    pub is_cut: PerEdge<bool>,
    /// Its length over the root of the smaller area beside it: small where a chart has a waist.
    pub cost: f64,
    /// Its length as seams count it.
    pub length: f64,
}

/// A chart, its border and what its edges count in seams.
struct Crossed<'a> {
    chart: &'a FlatChart,
    mesh: &'a Mesh,
    weights: PerEdge<f64>,
    border: &'a [u32],
}

/// A path that separates two sides of the border that cross each other, as short as may be for what it cuts off; none if there is no path.
pub(super) fn overlap_cut(
    chart: &FlatChart,
    mesh: &Mesh,
    rim: &BorderRim,
    crossings: &[[usize; 2]],
) -> Option<PerEdge<bool>> {
    let [border] = rim.loops() else { return None };
    let n = border.len();
    let apart = |[i, j]: &[usize; 2]| (j - i).min(n + i - j);
    let [i, j] = *crossings.iter().reduce(|a, b| if apart(b) > apart(a) { b } else { a })?;
    let crossed = Crossed::new(chart, mesh, border);
    let [first, second] = [j - i, n + i - j];
    let tries = INSETS.iter().filter_map(|share| {
        let inset = |count: usize| (share * count as f64) as usize;
        let one = stretch(border, i + 1 + inset(first), j - inset(first));
        let other = stretch(border, j + 1 + inset(second), n + i - inset(second));
        crossed.path(&one, &other)
    });
    tries.reduce(|a, b| if b.cost < a.cost { b } else { a }).map(|cut| cut.is_cut)
}

/// The path between opposite quarters of the border that is shortest for what it cuts off; none without a path.
pub(super) fn waist(chart: &FlatChart, mesh: &Mesh) -> Option<CrossCut> {
    let rim = BorderRim::new(mesh);
    let [border] = rim.loops() else { return None };
    let crossed = Crossed::new(chart, mesh, border);
    let ends = crossed.quarters()?;
    let tries = ends
        .into_iter()
        .filter_map(|[a, b, c, d]| crossed.path(&stretch(border, a, b), &stretch(border, c, d)));
    tries.reduce(|a, b| if b.cost < a.cost { b } else { a })
}

/// The vertices of a border from one place to another, both included, places counted around.
fn stretch(border: &[u32], from: usize, to: usize) -> Vec<VertexId> {
    (from..=to).map(|k| VertexId(border[k % border.len()])).collect()
}

impl<'a> Crossed<'a> {
    fn new(chart: &'a FlatChart, mesh: &'a Mesh, border: &'a [u32]) -> Crossed<'a> {
        let positions = &chart.part.positions;
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| {
            let [v, w] = mesh.ends(e);
            distance(positions[v.index()], positions[w.index()])
        });
        let weights = seam_weights(mesh, &lengths, positions);
        Crossed { chart, mesh, weights, border }
    }

    /// Places on the border between which its length is divided into four, for several starts: the first quarter from the first to the
    /// second place, the third quarter from the third to the fourth.
    fn quarters(&self) -> Option<Vec<[usize; 4]>> {
        let n = self.border.len();
        if n < 8 {
            return None;
        }
        let at = |k: usize| self.chart.points[self.border[k % n] as usize];
        let mut along = vec![0.0; n + 1];
        for k in 0..n {
            let ([a, b], [c, d]) = (at(k), at(k + 1));
            along[k + 1] = along[k] + (a - c).hypot(b - d);
        }
        let place = |share: f64| {
            let turns = share.floor();
            let wanted = (share - turns) * along[n];
            along.partition_point(|x| *x < wanted).min(n - 1) + turns as usize * n
        };
        let start = |k: usize| 0.5 * k as f64 / QUARTER_STARTS as f64;
        Some(
            (0..QUARTER_STARTS)
                .map(|k| [0.0, 0.25, 0.5, 0.75].map(|quarter| place(start(k) + quarter)))
                .collect(),
        )
    }

    /// The shortest path inside between two stretches of the border.
    fn path(&self, from: &[VertexId], to: &[VertexId]) -> Option<CrossCut> {
        let mesh = self.mesh;
        let n = mesh.n_vertices();
        let (mut is_start, mut is_end) = (vec![false; n], vec![false; n]);
        from.iter().for_each(|v| is_start[v.index()] = true);
        to.iter().for_each(|v| is_end[v.index()] = !is_start[v.index()]);
        let mut least = vec![f64::INFINITY; n];
        let mut before: Vec<Option<EdgeId>> = vec![None; n];
        let unit = self.weights.iter().sum::<f64>() / mesh.n_edges() as f64;
        let mut queue = NearestQueue::new(unit);
        for v in mesh.vertices().filter(|v| is_start[v.index()]) {
            least[v.index()] = 0.0;
            queue.push(0.0, v);
        }
        while let Some((length, v)) = queue.pop() {
            if length > least[v.index()] {
                continue;
            }
            if is_end[v.index()] {
                return self.cut(v, length, &before);
            }
            if mesh.is_boundary_vertex(v) && !is_start[v.index()] {
                continue;
            }
            for h in mesh.outgoing(v).filter(|h| !mesh.is_boundary_edge(h.edge())) {
                let (w, further) = (mesh.tip(h), length + self.weights[h.edge()]);
                if further < least[w.index()] {
                    (least[w.index()], before[w.index()]) = (further, Some(h.edge()));
                    queue.push(further, w);
                }
            }
        }
        None
    }

    /// The path that ends at a vertex.
    fn cut(&self, end: VertexId, length: f64, before: &[Option<EdgeId>]) -> Option<CrossCut> {
        let mesh = self.mesh;
        let mut is_cut = PerEdge::filled(mesh.n_edges(), false);
        let mut at = end;
        while let Some(e) = before[at.index()] {
            is_cut[e] = true;
            let [v, w] = mesh.ends(e);
            at = if v == at { w } else { v };
        }
        let number = ChartFaces::pieces(mesh, |e| is_cut[e]);
        let (mut first, mut whole) = (0.0, 0.0);
        for (f, corners) in self.chart.part.corners.iter().enumerate() {
            let area = doubled_area(corners.map(|v| self.chart.points[v as usize])).abs();
            whole += area;
            first += if number[f] == number[0] { area } else { 0.0 };
        }
        let smaller = f64::min(first, whole - first);
        (smaller > 0.0).then(|| CrossCut { is_cut, cost: length / smaller.sqrt(), length })
    }
}

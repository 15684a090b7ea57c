//! The hexagons of glued pairs of pants as polygons with numbered vertices and edges.
//!
//! Along a curve of length 2 h the feet of the seams on its right are at 0 and h, those on its left at the twist τ and τ + h: with the remainder σ of τ
//! by h four vertices 0, σ, h, h + σ, or two where σ = 0. A hexagon meets half of the curve, from foot to foot.

use super::decomposition::{CurveSide, Decomposition, GluedCurve};
use super::hexagon::{HyperboloidPoint, along, distance};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::shapes::intrinsic::IntrinsicSurface;

/// Share of half a length below which a remainder of the twist counts as 0: feet so near each other would be corners of triangles too thin
/// for f64.
const SAME_FOOT: f64 = 1e-11;

/// A hexagon, counterclockwise from its first cuff; the back of a pair of pants as the mirror image.
pub(super) struct Tile {
    pub vertices: Vec<u32>,
    /// Places of the vertices, the middle at the origin.
    pub points: Vec<HyperboloidPoint>,
    /// Per vertex the edge to the next one, numbered from 1, negative against its direction.
    pub sides: Vec<i32>,
    /// Per vertex the edge from the middle to it.
    pub spokes: Vec<i32>,
}

/// The hexagons of a decomposition: those of pants p are 2p, the front, and 2p + 1.
pub(super) struct HexagonTiles {
    pub tiles: Vec<Tile>,
    /// The front of the root, whose middle is vertex 0.
    pub base: usize,
    n_vertices: usize,
    lengths: Vec<f64>,
}

/// The vertices and edges of a curve, in its direction from the first foot on its right.
struct Ring {
    vertices: Vec<u32>,
    edges: Vec<i32>,
    /// Half of the length, the remainder of the twist by it, and how often it fits into that.
    half: f64,
    rest: f64,
    times: i64,
}

/// A way once around a curve with the pants on the left, from the start of the hexagon's side.
struct CuffWalk {
    vertices: Vec<u32>,
    sides: Vec<i32>,
    /// Distance from the first to the second vertex.
    first: f64,
    half: f64,
}

impl Ring {
    /// The ring of a curve. Its vertices and edges get the next numbers.
    fn new(curve: &GluedCurve, n_vertices: &mut usize, lengths: &mut Vec<f64>) -> Ring {
        let half = 0.5 * curve.length;
        let mut times = (curve.twist / half).floor();
        let mut rest = curve.twist - times * half;
        if half - rest < SAME_FOOT * half {
            (times, rest) = (times + 1.0, 0.0);
        }
        let is_met = curve.right.is_some() && rest >= SAME_FOOT * half;
        let steps = if is_met { vec![rest, half - rest, rest, half - rest] } else { vec![half; 2] };
        let vertices = (0..steps.len()).map(|k| (*n_vertices + k) as u32).collect();
        let edges = (0..steps.len()).map(|k| (lengths.len() + k + 1) as i32).collect();
        *n_vertices += steps.len();
        lengths.extend(steps);
        Ring { vertices, edges, half, rest, times: times as i64 }
    }

    /// The way around the curve on one of its sides.
    fn walk(&self, side: CurveSide, is_left: bool) -> CuffWalk {
        let n = self.vertices.len();
        let turns = if is_left { (self.times + side.foot as i64).rem_euclid(2) as usize } else { side.foot };
        let start = n / 2 * turns + if is_left { n / 2 - 1 } else { 0 };
        let at = |k: usize| if is_left { (start + k) % n } else { (start + n - k % n) % n };
        let vertices = (0..n).map(|k| self.vertices[at(k)]).collect();
        let step = |k: usize| if is_left { self.edges[at(k)] } else { -self.edges[at(k + 1)] };
        let first = if n == 4 { self.half - self.rest } else { self.half };
        CuffWalk { vertices, sides: (0..n).map(step).collect(), first, half: self.half }
    }
}

impl HexagonTiles {
    pub fn new(all: &Decomposition) -> Result<HexagonTiles> {
        let n_pants = all.hexagons.len();
        let (mut n_vertices, mut lengths) = (2 * n_pants, Vec::new());
        let mut walks: Vec<[Option<CuffWalk>; 3]> = (0..n_pants).map(|_| [None, None, None]).collect();
        for curve in &all.curves {
            let ring = Ring::new(curve, &mut n_vertices, &mut lengths);
            walks[curve.left.pants][curve.left.cuff] = Some(ring.walk(curve.left, true));
            if let Some(right) = curve.right {
                walks[right.pants][right.cuff] = Some(ring.walk(right, false));
            }
        }
        let mut tiles = HexagonTiles { tiles: Vec::new(), base: 2 * all.root, n_vertices, lengths };
        for (p, walks) in walks.into_iter().enumerate() {
            let [Some(a), Some(b), Some(c)] = walks else {
                return Err(Error::Layout(format!("a cuff of the pair of pants {p} is glued to nothing")));
            };
            tiles.add(all, p, [a, b, c]);
        }
        Ok(tiles)
    }

    /// Adds both hexagons of a pair of pants.
    fn add(&mut self, all: &Decomposition, p: usize, walks: [CuffWalk; 3]) {
        let hexagon = &all.hexagons[p];
        let at = |k: usize, far: f64| hexagon.feet[k][0].compose(&along(far)).origin();
        let foot = |k: usize, end: usize| hexagon.feet[k][end].origin();
        let seam = |k: usize| (self.lengths.len() + k + 1) as i32;
        let mut front = Tile { vertices: vec![], points: vec![], sides: vec![], spokes: vec![] };
        let mut back = Tile { vertices: vec![], points: vec![], sides: vec![], spokes: vec![] };
        for (k, walk) in walks.iter().enumerate() {
            let half = walk.vertices.len() / 2;
            front.vertices.extend(&walk.vertices[..=half]);
            front.sides.extend(walk.sides[..half].iter().chain([&seam(k)]));
            front.points.push(foot(k, 0));
            front.points.extend((half == 2).then(|| at(k, walk.first)));
            front.points.push(foot(k, 1));
        }
        for k in [0, 2, 1] {
            let walk = &walks[k];
            let half = walk.vertices.len() / 2;
            back.vertices.extend(walk.vertices[half..].iter().chain([&walk.vertices[0]]));
            back.sides.extend(walk.sides[half..].iter().chain([&-seam((k + 2) % 3)]));
            // Seen from the end, the vertex between is as far as in the front from the start.
            let middle = (half == 2).then(|| at(k, walk.half - walk.first));
            let points = [Some(foot(k, 1)), middle, Some(foot(k, 0))];
            back.points.extend(points.into_iter().flatten().map(|[x, y, w]| [x, -y, w]));
        }
        let seams = [0, 1, 2].map(|k| distance(&foot(k, 1), &foot((k + 1) % 3, 0)));
        self.lengths.extend(seams);
        let middle = [DoubleDouble::from(0.0), DoubleDouble::from(0.0), DoubleDouble::from(1.0)];
        for mut tile in [front, back] {
            for point in &tile.points {
                self.lengths.push(distance(&middle, point));
                tile.spokes.push(self.lengths.len() as i32);
            }
            self.tiles.push(tile);
        }
    }

    /// The vertex in the middle of a hexagon.
    fn middle(&self, tile: usize) -> u32 {
        let base = self.base;
        (if tile == base {
            0
        } else if tile == 0 {
            base
        } else {
            tile
        }) as u32
    }

    /// The triangles between the middles and the sides.
    pub fn surface(&self) -> IntrinsicSurface {
        let (mut faces, mut face_edges) = (Vec::new(), Vec::new());
        for (t, tile) in self.tiles.iter().enumerate() {
            let n = tile.vertices.len();
            for k in 0..n {
                let next = (k + 1) % n;
                faces.push([self.middle(t), tile.vertices[k], tile.vertices[next]]);
                face_edges.push([tile.sides[k], -tile.spokes[next], tile.spokes[k]]);
            }
        }
        let (n_vertices, lengths) = (self.n_vertices, self.lengths.clone());
        IntrinsicSurface { n_vertices, faces, face_edges, lengths, geometry: Space::H2 }
    }
}

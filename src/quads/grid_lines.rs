//! Squares of rectangles whose arcs all have a length: grid lines are straight between points on opposite sides. Lines of one direction do not
//! meet, and each meets each of the other direction once, so that all squares become convex quadrilaterals and none folds.

use super::grid_charts::GridCharts;
use super::grid_map::{GridMap, PlaneVector};
use super::t_mesh::{HalfArc, TMesh, TRectangle};

/// The places at time 1 with straight grid lines.
pub(super) fn straight_lines(t_mesh: &TMesh, charts: &GridCharts<'_>, map: &GridMap) -> Vec<PlaneVector> {
    let mut places = map.whole_places.clone();
    let mut square = 0;
    for (r, rectangle) in t_mesh.rectangles.iter().enumerate() {
        let [m, n] = charts.size(r);
        let lines = GridLines::new(t_mesh, charts, rectangle);
        for (j, i) in (0..n).flat_map(|j| (0..m).map(move |i| (j, i))) {
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            for (corner, at) in map.squares[square].iter().zip(corners) {
                places[corner.vertex] = corner.own_place(lines.crossing(at).map(|x| x * map.unit), 1.0);
            }
            square += 1;
        }
    }
    places
}

/// The grid lines of a rectangle: places along its sides, in units of the grid from its first corner.
struct GridLines {
    bottom: Vec<f64>,
    right: Vec<f64>,
    top: Vec<f64>,
    left: Vec<f64>,
    size: [f64; 2],
}

impl GridLines {
    fn new(t_mesh: &TMesh, charts: &GridCharts<'_>, rectangle: &TRectangle) -> GridLines {
        let along = |side: &[HalfArc]| {
            let (mut places, mut begin) = (vec![0.0], 0);
            for &h in side {
                let (n, length) = (charts.number(h), t_mesh.arcs[h / 2].length);
                places.extend((1..=n).map(|k| begin as f64 + length as f64 * (k as f64 / n as f64)));
                begin += length;
            }
            places
        };
        let backwards = |side: &[HalfArc], length: f64| {
            let mut places: Vec<f64> = along(side).into_iter().map(|x| length - x).collect();
            places.reverse();
            places
        };
        let size = rectangle.size.map(|x| x as f64);
        let [bottom, right] = [0, 1].map(|k| along(&rectangle.sides[k]));
        let (top, left) = (backwards(&rectangle.sides[2], size[0]), backwards(&rectangle.sides[3], size[1]));
        GridLines { bottom, right, top, left, size }
    }

    /// The crossing of column i and row j.
    fn crossing(&self, [i, j]: [usize; 2]) -> PlaneVector {
        let [w, h] = self.size;
        let (a, lean) = (self.bottom[i], (self.top[i] - self.bottom[i]) / h);
        let (b, rise) = (self.left[j], (self.right[j] - self.left[j]) / w);
        // x = a + lean y, y = b + rise x; lean · rise < 1 inside.
        let x = (a + lean * b) / (1.0 - lean * rise);
        [x.clamp(0.0, w), (b + rise * x).clamp(0.0, h)]
    }
}

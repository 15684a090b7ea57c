//! Copies of a fundamental domain as areas, lines and labels of a drawing, each with as much detail as its size shows.

use super::model_place::ModelPlace;
use crate::picture::{
    Area, Drawing, DrawingFrame, DrawingPattern, DrawnLine, FINEST, Label, OCTAVE, Style, TINTS,
    TextureChoice, cells, doubled_area, in_pieces, outline,
};
use ricci::embed::{DeckElement, DeckGroup};
use ricci::geometry::model::{Model, from_poincare};
use ricci::geometry::{DoubleDouble, Motion, Space};
use std::f64::consts::PI;

/// Radius in pixels below which a copy is left out.
const LEAST: f64 = 0.35;
/// Radius in pixels below which few points of a copy's border are drawn.
const PLAIN: f64 = 7.0;
/// Side in pixels below which a check is drawn with the light ones around it in their mean colour.
const CLEAR: f64 = 1.8;
/// Radius in pixels above which a copy is drawn with its border.
const BORDERED: f64 = 3.0;
/// Area of a face in square pixels above which a copy is drawn with the edges of the mesh.
const WIRED: f64 = 6.0;
/// Points of the border of a small copy.
const COARSE: usize = 32;
/// Share of the dark colour in the ground without a pattern.
const GROUND: f64 = 0.25;

/// A fundamental domain that is copied: the ambient coordinates of the corners of its triangles, and its border as a closed polygon.
pub struct Prototype {
    pub points: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub border: Vec<[f64; 3]>,
    pub centre: [f64; 3],
}

/// A fundamental domain with its pattern, in ambient coordinates.
pub struct Stamp {
    pub border: Vec<[f64; 3]>,
    pub centre: [f64; 3],
    cells: Vec<Vec<[f64; 3]>>,
    wire: Vec<[[f64; 3]; 2]>,
    /// The side of a check over the radius.
    check: f64,
    /// The share of the dark colour where checks are too small to be seen, and where they are drawn.
    dark: [f64; 2],
}

impl Stamp {
    /// A prototype with the pattern that is drawn in these plane coordinates of its triangles.
    pub fn new(shape: &Prototype, space: Space, pattern: &DrawingPattern<'_>, style: &Style) -> Stamp {
        let place = ModelPlace::new(space, Model::Poincare);
        let flat = |points: &[[f64; 3]]| points.iter().map(|p| place.flat(*p)).collect::<Vec<_>>();
        let (border, centre) = (flat(&shape.border), place.flat(shape.centre));
        let radius = border.iter().map(|p| (p[0] - centre[0]).hypot(p[1] - centre[1])).fold(0.0, f64::max);
        let ambient = |[x, y]: [f64; 2]| if space == Space::H2 { from_poincare([x, y]) } else { [x, y, 1.0] };
        let levels = pattern.tiles.levels(pattern.uv);
        let banded = levels.len() > 1;
        let part = |(level, triangles): (i32, Vec<[[f64; 2]; 3]>)| {
            let region = if banded { outline(triangles.into_iter()) } else { vec![border.clone()] };
            let check = pattern.tiles.size * OCTAVE.powi(level);
            let parts = cells(&region, style.texture, check);
            parts
                .into_iter()
                .map(|cell| in_pieces(&cell, check).into_iter().map(ambient).collect())
                .collect::<Vec<_>>()
        };
        let sides =
            |t: &[u32; 3]| [0, 1, 2].map(|k| [t[k], t[(k + 1) % 3]].map(|v| shape.points[v as usize]));
        let wired = shape.triangles.iter().filter(|_| style.wire);
        let none = style.texture == TextureChoice::None;
        Stamp {
            cells: levels.into_iter().flat_map(part).collect(),
            wire: wired.flat_map(sides).filter(|[p, q]| p < q).collect(),
            border: shape.border.clone(),
            centre: shape.centre,
            check: pattern.tiles.size / radius,
            dark: if none { [GROUND; 2] } else { [style.texture.mean(), 0.0] },
        }
    }
}

/// A drawing in the making.
pub struct Tiling {
    pub at: ModelPlace,
    pub frame: DrawingFrame,
    scale: f64,
    areas: Vec<Area>,
    pub lines: Vec<DrawnLine>,
    pub dots: Vec<[f64; 2]>,
    pub labels: Vec<Label>,
}

impl Tiling {
    /// `size`: the pixels of the longer side of the panel.
    pub fn new(at: ModelPlace, frame: DrawingFrame, size: usize) -> Tiling {
        let scale = frame.fit(size).scale;
        let (areas, lines, dots, labels) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Tiling { at, frame, scale, areas, lines, dots, labels }
    }

    pub fn drawing(&self) -> Drawing<'_> {
        let Tiling { frame, areas, lines, dots, labels, .. } = self;
        Drawing { frame: *frame, areas, lines, dots, labels }
    }

    /// Add a copy in one tint; `border`: draw that too, in this width.
    pub fn copy(&mut self, stamp: &Stamp, motion: &Motion<DoubleDouble>, tint: u8, border: Option<f64>) {
        let moved = |p: &[f64; 3]| self.at.flat(motion.apply(p.map(DoubleDouble::from)).map(f64::from));
        let middle = moved(&stamp.centre);
        let coarse: Vec<[f64; 2]> =
            stamp.border.iter().step_by(stamp.border.len().div_ceil(COARSE).max(1)).map(moved).collect();
        let far = |p: &[f64; 2]| (p[0] - middle[0]).hypot(p[1] - middle[1]);
        let radius = self.scale * coarse.iter().map(far).fold(0.0, f64::max);
        if radius.is_nan() || radius < LEAST {
            return;
        }
        let outline =
            if radius < PLAIN { coarse } else { stamp.border.iter().map(moved).collect::<Vec<_>>() };
        let fine = radius * stamp.check < FINEST;
        // A motion makes the checks of one copy small at one end: there they give way to their mean colour.
        let moved_cells =
            stamp.cells.iter().filter(|_| !fine).map(|cell| cell.iter().map(moved).collect::<Vec<_>>());
        let side = |cell: &Vec<[f64; 2]>| self.scale * (0.5 * area(cell).abs()).sqrt();
        let (small, cells): (Vec<Vec<[f64; 2]>>, Vec<_>) = moved_cells.partition(|cell| side(cell) < CLEAR);
        let blurred = small.iter().filter(|cell| area(cell) != 0.0).map(|cell| doubled(cell)).collect();
        // A triangulation has about two thirds as many faces as edges.
        let face = 1.5 * PI * radius * radius / stamp.wire.len().max(1) as f64;
        let wire = stamp.wire.iter().filter(|_| face > WIRED).map(|side| [0, 1].map(|k| moved(&side[k])));
        if let (Some(width), true) = (border, radius > BORDERED) {
            let points = outline.iter().chain(outline.first()).copied().collect();
            self.lines.push(DrawnLine { points, color: None, width });
        }
        let dark = stamp.dark[usize::from(!fine)];
        let blur = (blurred, stamp.dark[0]);
        self.areas.push(Area { border: outline, tint, cells, blur, wire: wire.collect(), face, dark });
    }

    /// Add a line through ambient points, geodesic between them.
    pub fn line(&mut self, points: &[[f64; 3]], color: Option<usize>, width: f64) {
        let mut drawn: Vec<[f64; 2]> = Vec::new();
        for ends in points.windows(2) {
            let geodesic = self.at.geodesic(ends[0], ends[1]);
            let skip = usize::from(!drawn.is_empty());
            drawn.extend(geodesic.into_iter().skip(skip).map(|p| self.at.flat(p)));
        }
        self.lines.push(DrawnLine { points: drawn, color, width });
    }

    /// Add a geodesic, unless it is too short to be seen.
    pub fn line_if_seen(&mut self, ends: [[f64; 3]; 2], width: f64) {
        let [p, q] = ends.map(|p| self.at.flat(p));
        if self.scale * (p[0] - q[0]).hypot(p[1] - q[1]) > BORDERED {
            self.line(&ends, None, width);
        }
    }

    /// Name the last line beside its middle, away from a point.
    pub fn name_line(&mut self, text: String, from: [f64; 3]) {
        let Some(line) = self.lines.last() else { return };
        let step = |w: &[[f64; 2]]| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
        let length: f64 = line.points.windows(2).map(step).sum();
        let (mut rest, mut at) = (0.5 * length, line.points.first().copied().unwrap_or_default());
        for w in line.points.windows(2) {
            let l = step(w);
            if rest <= l && l > 0.0 {
                at = [0, 1].map(|k| w[0][k] + rest / l * (w[1][k] - w[0][k]));
                break;
            }
            rest -= l;
        }
        // The direction of the line from end to end: the border of a layout is jagged.
        let ends = [line.points.first(), line.points.last()].map(|p| p.copied().unwrap_or_default());
        let along = [0, 1].map(|k| ends[1][k] - ends[0][k]);
        // Across the line, on the side that is away.
        let from = self.at.flat(from);
        let across = [along[1], -along[0]];
        let side = across[0] * (at[0] - from[0]) + across[1] * (at[1] - from[1]);
        let away = if side < 0.0 { across.map(|x| -x) } else { across };
        let color = line.color.unwrap_or(0);
        self.labels.push(Label { at, away, text, room: 1.1 * length, color });
    }
}

/// Twice the area of a polygon, negative for one that runs clockwise.
fn area(polygon: &[[f64; 2]]) -> f64 {
    (2..polygon.len()).map(|k| doubled_area([polygon[0], polygon[k - 1], polygon[k]])).sum()
}

/// A check drawn twice as large about its middle, counterclockwise: it covers its half of the light checks around it, and those of its
/// neighbours the rest.
fn doubled(cell: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = cell.len() as f64;
    let middle = [0, 1].map(|k| cell.iter().map(|p| p[k]).sum::<f64>() / n);
    let mut larger: Vec<[f64; 2]> = cell.iter().map(|p| [0, 1].map(|k| 2.0 * p[k] - middle[k])).collect();
    if area(&larger) < 0.0 {
        larger.reverse();
    }
    larger
}

/// The tint of a copy, by the action of its deck transformation on homology, so that the tints of neighbours mostly differ.
pub fn tint(deck: &DeckGroup, g: &DeckElement) -> u8 {
    if g.word.is_empty() {
        return 0;
    }
    let n = i64::from(TINTS);
    let sums = deck.group.abelianisation(&g.word);
    let class: i64 = sums.iter().zip(0..).map(|(sum, k)| sum * (1 + 2 * k % (n - 1))).sum();
    1 + class.rem_euclid(n) as u8
}

//! Copies of a fundamental domain as cells, outlines and lines of a drawing: as much of each as its size shows.

use super::model_place::ModelPlace;
use crate::picture::{Cell, Drawing, Frame, Label, Line, Pattern, TINTS};
use ricci::embed::{DeckElement, DeckGroup};
use ricci::geometry::{Motion, Twofold};

/// Radius in pixels below which a copy is left out.
const LEAST: f64 = 0.35;
/// Radius in pixels below which a copy is drawn in one colour, without its pattern.
const PLAIN: f64 = 7.0;
/// Radius in pixels above which a copy is drawn with its border.
const BORDERED: f64 = 3.0;
/// Triangles of pattern in one drawing; copies beyond that many are drawn in one colour, so that memory stays bounded.
const MOST_CELLS: usize = 1_500_000;
/// Points of the outline of a copy that is drawn in one colour.
const COARSE: usize = 32;
/// Rings of triangles between the centre and the border of a tile with a radius above [`LARGE`]; smaller tiles have one.
const STEPS: usize = 8;
/// Radius in pixels above which straight edges from the centre to the border would show.
const LARGE: f64 = 30.0;

/// What is copied: ambient coordinates of the corners of triangles, and the border as a closed polygon.
pub struct Prototype {
    pub points: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub border: Vec<[f64; 3]>,
    pub centre: [f64; 3],
}

/// A drawing in the making.
pub struct Tiling {
    pub at: ModelPlace,
    pub frame: Frame,
    scale: f64,
    cells: Vec<Cell>,
    outlines: Vec<(Vec<[f64; 2]>, u8)>,
    pub lines: Vec<Line>,
    pub dots: Vec<[f64; 2]>,
    pub labels: Vec<Label>,
}

impl Tiling {
    /// `size`: pixels of the panel.
    pub fn new(at: ModelPlace, frame: Frame, size: usize) -> Tiling {
        Tiling {
            at,
            frame,
            scale: frame.fit(size).scale,
            cells: Vec::new(),
            outlines: Vec::new(),
            lines: Vec::new(),
            dots: Vec::new(),
            labels: Vec::new(),
        }
    }

    pub fn drawing<'a>(&'a self, pattern: Option<Pattern<'a>>) -> Drawing<'a> {
        let Tiling { frame, cells, outlines, lines, dots, labels, .. } = self;
        Drawing { frame: *frame, pattern, cells, outlines, lines, dots, labels }
    }

    /// Add a copy in one tint; `border`: draw that too, in this width.
    pub fn copy(&mut self, shape: &Prototype, motion: &Motion<Twofold>, tint: u8, border: Option<f64>) {
        let moved = |p: &[f64; 3]| motion.apply(p.map(Twofold::from)).map(f64::from);
        let (radius, coarse) = self.extent(shape, motion);
        if radius.is_nan() || radius < LEAST {
            return;
        }
        let fine: Vec<[f64; 3]> = shape.border.iter().map(moved).collect();
        let outline = if radius < PLAIN { &coarse } else { &fine };
        if radius < PLAIN || shape.triangles.is_empty() || self.cells.len() > MOST_CELLS {
            self.fan(moved(&shape.centre), outline, tint, if radius > LARGE { STEPS } else { 1 });
        } else {
            self.cells_of(shape, motion, |_| Some(tint));
        }
        let flat = |points: &[[f64; 3]]| points.iter().map(|p| self.at.flat(*p)).collect::<Vec<_>>();
        self.outlines.push((flat(outline), tint));
        if let (Some(width), true) = (border, radius > BORDERED) {
            let mut points = flat(&fine);
            points.extend(points.first().copied());
            self.lines.push(Line { points, color: None, width });
        }
    }

    /// The radius of a copy in pixels, and some points of its border.
    fn extent(&self, shape: &Prototype, motion: &Motion<Twofold>) -> (f64, Vec<[f64; 3]>) {
        let moved = |p: &[f64; 3]| motion.apply(p.map(Twofold::from)).map(f64::from);
        let middle = self.at.flat(moved(&shape.centre));
        let coarse: Vec<[f64; 3]> = coarse(&shape.border).map(moved).collect();
        let off = |p: &[f64; 3]| {
            let [x, y] = self.at.flat(*p);
            (x - middle[0]).hypot(y - middle[1])
        };
        (self.scale * coarse.iter().map(off).fold(0.0, f64::max), coarse)
    }

    /// Add the triangles of a copy that have a tint; whether it is large enough for its pattern to be seen.
    pub fn cells_of(
        &mut self,
        shape: &Prototype,
        motion: &Motion<Twofold>,
        tint: impl Fn(usize) -> Option<u8>,
    ) -> bool {
        let (radius, _) = self.extent(shape, motion);
        let seen = radius >= PLAIN && self.cells.len() <= MOST_CELLS;
        if seen {
            let place = |p: &[f64; 3]| self.at.flat(motion.apply(p.map(Twofold::from)).map(f64::from));
            let places: Vec<[f64; 2]> = shape.points.iter().map(place).collect();
            let cell = |(f, corners): (usize, &[u32; 3])| {
                let corners = corners.map(|c| places[c as usize]);
                Some(Cell { corners, face: Some(f as u32), tint: tint(f)? })
            };
            self.cells.extend(shape.triangles.iter().enumerate().filter_map(cell));
        }
        seen
    }

    /// Cells between a centre and a closed polygon around it, along geodesics from the one to the other.
    fn fan(&mut self, centre: [f64; 3], outline: &[[f64; 3]], tint: u8, steps: usize) {
        let ray = |p: &[f64; 3]| -> Vec<[f64; 2]> {
            let share = |k: usize| k as f64 / steps as f64;
            (0..=steps).map(|k| self.at.flat(self.at.between(centre, *p, share(k)))).collect()
        };
        let rays: Vec<Vec<[f64; 2]>> = outline.iter().map(ray).collect();
        for (k, ray) in rays.iter().enumerate() {
            let next = &rays[(k + 1) % rays.len()];
            let mut cell = |corners| self.cells.push(Cell { corners, face: None, tint });
            for i in 0..steps {
                cell([ray[i], ray[i + 1], next[i + 1]]);
                if i > 0 {
                    cell([ray[i], next[i + 1], next[i]]);
                }
            }
        }
    }

    /// Add a line through ambient points, geodesic between them.
    pub fn line(&mut self, points: &[[f64; 3]], color: Option<usize>, width: f64) {
        let mut drawn: Vec<[f64; 2]> = Vec::new();
        for ends in points.windows(2) {
            let geodesic = self.at.geodesic(ends[0], ends[1]);
            let skip = usize::from(!drawn.is_empty());
            drawn.extend(geodesic.into_iter().skip(skip).map(|p| self.at.flat(p)));
        }
        self.lines.push(Line { points: drawn, color, width });
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
        // Its direction as a whole: the border of a layout is jagged.
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

/// A few points of a long polygon.
fn coarse(points: &[[f64; 3]]) -> impl Iterator<Item = &[f64; 3]> {
    points.iter().step_by(points.len().div_ceil(COARSE).max(1))
}

/// The tint of a copy: that of what it does to homology, so that neighbours mostly differ.
pub fn tint(deck: &DeckGroup, g: &DeckElement) -> u8 {
    if g.word.is_empty() {
        return 0;
    }
    let n = i64::from(TINTS);
    let sums = deck.group.abelianisation(&g.word);
    let class: i64 = sums.iter().zip(0..).map(|(sum, k)| sum * (1 + 2 * k % (n - 1))).sum();
    1 + class.rem_euclid(n) as u8
}

//! The vertical of a surface that stands, such as an animal on its feet: the coordinate axis along which it is supported best from below.
//!
//! What is weighed: whether the centroid lies over the convex hull of the lowest points, and how far inside it; the area of that hull; the
//! area that lies flat on the ground; that animals are the same left and right, but not above and below; that the hole of a bust is below;
//! and that files have y up mostly, and z more often than the rest.

use super::vector::{V3, add, complement, dot, ends, norm, normal, scaled, sphere_point, unit};
use ricci::geometry::complex::doubled_area;
use ricci::geometry::packing::convex_hull;
use std::f64::consts::FRAC_PI_4;

/// The candidates with what counts for each before the surface is looked at.
const CANDIDATES: [(V3, f64); 6] = [
    ([0.0, 1.0, 0.0], 0.24),
    ([0.0, 0.0, 1.0], 0.13),
    ([0.0, -1.0, 0.0], 0.0),
    ([0.0, 0.0, -1.0], 0.0),
    ([1.0, 0.0, 0.0], 0.0),
    ([-1.0, 0.0, 0.0], 0.0),
];
/// Score below which a candidate other than y and z is not believed. On the meshes of animals and statues with which these numbers were
/// found, those that stood on their feet had 0.5 and more, heads that lay on their crown 0.45 and less.
const CONVINCING: f64 = 0.48;
/// Heights above the lowest point, as shares of the whole, up to which points count as support; of both, the one that supports better.
const SOLES: [f64; 2] = [0.02, 0.04];
/// Largest distance of the centroid from the border of the support that counts, over the root of the area of the footprint.
const MOST_MARGIN: f64 = 0.4;
/// The weight of the root of the share of the footprint that the support takes.
const SUPPORT: f64 = 0.6;
/// The weight of the share of the area that faces down at the bottom, and the largest share that counts.
const FLAT: f64 = 2.0;
const MOST_FLAT: f64 = 0.1;
/// Faces that face down: their normal within this cosine.
const LEVEL: f64 = 0.95;
/// The weight of the area of holes that face down, as a share of the area of the surface, and the largest share that counts.
const HOLES: f64 = 2.0;
const MOST_HOLES: f64 = 0.2;
/// What an axis loses about which the surface is much more symmetric than about the others: its asymmetry is below this share of theirs.
const SIDEWAYS: f64 = 0.3;
const MORE_SYMMETRIC: f64 = 0.5;
/// Cells along the longest side of the grid in which symmetry is measured.
const CELLS: usize = 16;

/// A surface with the areas and centres of its faces.
struct WeighedSurface<'a> {
    points: &'a [V3],
    /// Per face its vector area and its centre.
    faces: Vec<(V3, V3)>,
    area: f64,
    centroid: V3,
    /// The sum of the vector areas: that of the holes, turned around.
    outside: V3,
}

/// Score of the best axis below which slanted directions are looked at too: an animal whose file has its principal axes along the
/// coordinates stands on its feet on none of them.
const DOUBTFUL: f64 = 0.36;
/// Score that a slanted direction needs, of support alone: an elephant on its feet has 0.83, the best sides of bodies without any 0.65.
const SLANTED: f64 = 0.75;
/// Number of slanted directions that are scored, of those that are then turned to the best one near them, and of the points that are looked at
/// meanwhile.
const DIRECTIONS: usize = 600;
const TURNED: usize = 8;
const MOST_POINTS: usize = 3000;
/// Radians by which directions are turned at first, and at last.
const TURNS: [f64; 2] = [0.08, 0.005];

/// The axis along which a surface stands, or a slanted direction where none is one, and whether it does so convincingly.
pub fn standing(points: &[V3], faces: &[[u32; 3]]) -> (V3, bool) {
    let surface = WeighedSurface::new(points, faces);
    let asymmetry = surface.asymmetry();
    let scored = CANDIDATES.map(|(up, usual)| {
        let axis = axis_of(up);
        let others = (0..3).filter(|k| *k != axis).map(|k| asymmetry[k]).fold(f64::INFINITY, f64::min);
        let sideways = if asymmetry[axis] < MORE_SYMMETRIC * others { SIDEWAYS } else { 0.0 };
        (up, surface.support(up) - sideways + usual)
    });
    let best = scored.iter().fold(scored[0], |best, c| if c.1 > best.1 { *c } else { best });
    if best.1 < DOUBTFUL
        && let Some(up) = surface.slanted(points)
    {
        return (up, true);
    }
    let is_usual = [CANDIDATES[0].0, CANDIDATES[1].0].contains(&best.0);
    let is_sure = best.1 >= CONVINCING;
    (if is_usual || is_sure { best.0 } else { CANDIDATES[0].0 }, is_sure)
}

/// The coordinate that an axis runs along.
fn axis_of(up: V3) -> usize {
    (0..3).fold(0, |most, k| if up[k].abs() > up[most].abs() { k } else { most })
}

impl<'a> WeighedSurface<'a> {
    fn new(points: &'a [V3], faces: &[[u32; 3]]) -> WeighedSurface<'a> {
        let face = |f: &[u32; 3]| {
            let corners = f.map(|v| points[v as usize]);
            let centre = corners.into_iter().fold([0.0; 3], |sum, p| add(sum, scaled(p, 1.0 / 3.0)));
            (scaled(normal(corners), 0.5), centre)
        };
        let faces: Vec<(V3, V3)> = faces.iter().map(face).collect();
        let area = faces.iter().map(|(n, _)| norm(*n)).sum::<f64>().max(f64::MIN_POSITIVE);
        let middle = faces.iter().fold([0.0; 3], |sum, (n, c)| add(sum, scaled(*c, norm(*n) / area)));
        let outside = faces.iter().fold([0.0; 3], |sum, (n, _)| add(sum, *n));
        WeighedSurface { points, faces, area, centroid: middle, outside }
    }

    /// The direction, of any, along which the surface stands best, if that is convincing.
    fn slanted(&self, points: &[V3]) -> Option<V3> {
        let some: Vec<V3> =
            points.iter().step_by(points.len().div_ceil(MOST_POINTS).max(1)).copied().collect();
        let rough = WeighedSurface { points: &some, faces: Vec::new(), ..*self };
        let scored = |up: V3| (rough.support(up), up);
        let mut starts: Vec<(f64, V3)> =
            (0..DIRECTIONS).map(|k| scored(sphere_point(k, DIRECTIONS))).collect();
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        let turned = starts.into_iter().take(TURNED).map(|(_, up)| scored(rough.turned(up)));
        let (_, up) = turned.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
        (self.support(up) >= SLANTED).then_some(up)
    }

    /// A direction turned to the best one near it.
    fn turned(&self, mut up: V3) -> V3 {
        let (mut by, mut score) = (TURNS[0], self.support(up));
        while by > TURNS[1] {
            let [e, f] = complement(up);
            let around = (0..8)
                .map(|k| f64::from(k) * FRAC_PI_4)
                .map(|angle| add(up, add(scaled(e, by * angle.cos()), scaled(f, by * angle.sin()))));
            let best = around.filter_map(unit).map(|up| (self.support(up), up));
            match best.reduce(|a, b| if b.0 > a.0 { b } else { a }).filter(|best| best.0 > score) {
                Some(better) => (score, up) = better,
                None => by *= 0.5,
            }
        }
        up
    }

    /// The score of a direction by the support from below.
    fn support(&self, up: V3) -> f64 {
        let [e, f] = complement(up);
        let across = |p: &V3| [dot(e, *p), dot(f, *p)];
        let [low, high] = ends(self.points.iter().map(|p| dot(up, *p)));
        let height = (high - low).max(f64::MIN_POSITIVE);
        let footprint = area(&convex_hull(&self.points.iter().map(across).collect::<Vec<_>>()));
        if footprint <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let centre = across(&self.centroid);
        let [thin, thick] = SOLES.map(|share| {
            let sole = self.points.iter().filter(|p| dot(up, **p) <= low + share * height);
            let hull = convex_hull(&sole.map(across).collect::<Vec<_>>());
            (margin(&hull, centre) / footprint.sqrt(), area(&hull) / footprint)
        });
        let is_flat =
            |(n, c): &&(V3, V3)| dot(up, *n) < -LEVEL * norm(*n) && dot(up, *c) < low + SOLES[1] * height;
        let flat = self.faces.iter().filter(is_flat).map(|(n, _)| norm(*n)).sum::<f64>() / self.area;
        let holes = dot(up, self.outside) / self.area;
        thin.0.max(thick.0).clamp(-MOST_MARGIN, MOST_MARGIN)
            + SUPPORT * thick.1.sqrt()
            + FLAT * flat.min(MOST_FLAT)
            + HOLES * holes.clamp(-MOST_HOLES, MOST_HOLES)
    }

    /// Per coordinate, the share of the area that has no partner in the mirror image along it: 0 for a symmetric surface, 1 at most.
    fn asymmetry(&self) -> V3 {
        // The centroid is amid the grid, which reaches as far on both sides of it as the longest side is long.
        let side = 2 * CELLS + 4;
        let extent = |k: usize| {
            let [low, high] = ends(self.points.iter().map(|p| p[k]));
            high - low
        };
        let cell = [0, 1, 2].map(extent).into_iter().fold(f64::MIN_POSITIVE, f64::max) / CELLS as f64;
        let mut weight = vec![0.0; side * side * side];
        let number = |at: [usize; 3]| (at[0] * side + at[1]) * side + at[2];
        for (n, centre) in &self.faces {
            let at = [0, 1, 2].map(|k| (centre[k] - self.centroid[k]) / cell + (CELLS + 1) as f64);
            let first = at.map(|x| (x.max(0.0) as usize).min(side - 2));
            // Each face counts for the eight nodes around its centre.
            for corner in 0..8 {
                let node = [0, 1, 2].map(|k| first[k] + (corner >> k & 1));
                let share = [0, 1, 2].map(|k| 1.0 - (at[k] - node[k] as f64).abs().min(1.0));
                weight[number(node)] += norm(*n) * share[0] * share[1] * share[2];
            }
        }
        let all = || (0..side).flat_map(|i| (0..side).flat_map(move |j| (0..side).map(move |k| [i, j, k])));
        [0, 1, 2].map(|axis| {
            let mirrored = |mut at: [usize; 3]| {
                // The node of the centroid is number CELLS + 1.
                at[axis] = (2 * (CELLS + 1)).checked_sub(at[axis])?;
                Some(weight[number(at)])
            };
            let differs = |at: [usize; 3]| (weight[number(at)] - mirrored(at).unwrap_or(0.0)).abs();
            0.5 * all().map(differs).sum::<f64>() / self.area
        })
    }
}

/// The area of a polygon.
fn area(polygon: &[[f64; 2]]) -> f64 {
    (2..polygon.len()).map(|k| 0.5 * doubled_area([polygon[0], polygon[k - 1], polygon[k]]).abs()).sum()
}

/// The distance of a point from the lines along the sides of a convex polygon: the least of a point inside, and less than 0 outside; very far
/// outside of a polygon without area.
fn margin(hull: &[[f64; 2]], at: [f64; 2]) -> f64 {
    if hull.len() < 3 {
        return f64::NEG_INFINITY;
    }
    let sides = (0..hull.len()).map(|k| (hull[k], hull[(k + 1) % hull.len()]));
    let inside = |(p, q): ([f64; 2], [f64; 2])| {
        doubled_area([p, q, at]) / (q[0] - p[0]).hypot(q[1] - p[1]).max(f64::MIN_POSITIVE)
    };
    sides.map(inside).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::mesh::io::Soup;
    use ricci::mesh::shapes;

    /// A body on four legs with a head at one end, as separate balls: its length runs along z, its height along y.
    fn animal() -> Soup {
        let ball = shapes::icosphere(4).unwrap();
        let parts = [
            ([0.0, 2.0, 0.0], [0.6, 0.6, 1.5]),
            ([0.0, 2.9, 1.7], [0.4, 0.5, 0.5]),
            ([0.5, 0.8, 1.2], [0.15, 0.9, 0.15]),
            ([-0.5, 0.8, 1.2], [0.15, 0.9, 0.15]),
            ([0.5, 0.8, -1.2], [0.15, 0.9, 0.15]),
            ([-0.5, 0.8, -1.2], [0.15, 0.9, 0.15]),
        ];
        let mut soup = Soup::default();
        for (centre, radii) in parts {
            let first = soup.positions.len() as u32;
            soup.positions
                .extend(ball.positions.iter().map(|p| [0, 1, 2].map(|k| centre[k] + radii[k] * p[k])));
            soup.faces.extend(ball.faces.iter().map(|f| f.map(|v| v + first)));
        }
        soup
    }

    #[test]
    fn an_animal_stands_on_its_feet_whichever_axis_is_up_in_its_file() {
        let soup = animal();
        let turned: [(fn(&V3) -> V3, V3); 5] = [
            (|p| *p, [0.0, 1.0, 0.0]),
            (|&[x, y, z]| [x, -z, y], [0.0, 0.0, 1.0]),
            (|&[x, y, z]| [x, -y, -z], [0.0, -1.0, 0.0]),
            (|&[x, y, z]| [x, z, -y], [0.0, 0.0, -1.0]),
            (|&[x, y, z]| [y, z, x], [1.0, 0.0, 0.0]),
        ];
        for (turn, up) in turned {
            let points: Vec<V3> = soup.positions.iter().map(turn).collect();
            assert_eq!(standing(&points, &soup.faces), (up, true));
        }
    }

    #[test]
    fn an_animal_stands_on_its_feet_however_it_is_turned() {
        let soup = animal();
        for turn in [0.6, 0.9] {
            let (sin, cos) = f64::sin_cos(turn);
            let slanted = |&[x, y, z]: &V3| [x, cos * y - sin * z, sin * y + cos * z];
            let points: Vec<V3> = soup.positions.iter().map(slanted).collect();
            let (up, is_sure) = standing(&points, &soup.faces);
            assert!(is_sure && dot(up, [0.0, cos, sin]) > 0.995, "{up:?}");
        }
    }

    #[test]
    fn what_has_no_side_to_stand_on_has_y_up() {
        let ball = shapes::icosphere(6).unwrap();
        assert_eq!(standing(&ball.positions, &ball.faces).0, [0.0, 1.0, 0.0]);
    }
}

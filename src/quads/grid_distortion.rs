//! The distortion of the squares of a grid map, and its descent. At each corner of a square the sides span a triangle, of the unit right
//! triangle's image; the symmetric Dirichlet energy \[SS15\] of these four affine maps grows without bound before a triangle is turned over.

use super::grid_map::{GridMap, PlaneVector, TimedPlaces, add, corner_sides, cross};
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::parallel;
use std::collections::VecDeque;

/// Steps and gradients that the descent remembers.
const MEMORY: usize = 6;
/// Share of the decrease along the tangent that a step is to reach.
const SUFFICIENT: f64 = 1e-4;
/// Least step of a line search.
const LEAST_STEP: f64 = 1e-9;
/// Relative decrease per step at which the descent ends.
const SETTLED: f64 = 1e-5;
/// Least share of its area that a triangle keeps in one step of time.
const KEPT_AREA: f64 = 0.2;
/// The first and the least step of time, and the most steps.
const FIRST_STEP: f64 = 0.25;
const LEAST_STEP_OF_TIME: f64 = 1.0 / 1024.0;
const MOST_STEPS: usize = 60;
/// Area of a triangle, over that of the unit square, from which on it is not near to folding.
const SOUND_AREA: f64 = 0.1;
/// Descents per step of time, and at its end.
const STEPS_ON_THE_WAY: usize = 8;
const STEPS_AT_THE_END: usize = 60;

/// How far squares came on the way to time 1.
pub(super) struct Advance {
    /// The last places in which no triangle was near to folding.
    pub reached: TimedPlaces,
    /// The squares that would fold beyond them; none at time 1.
    pub stuck: Vec<usize>,
}

/// Goes from places without folds to ones at time 1. Where squares with straight sides do not get there without folding, squares that are divided
/// go on from there.
pub(super) fn advanced(map: &mut GridMap, from: TimedPlaces, control: &Control) -> Result<Advance> {
    let (first, last) = (map.whole_places.clone(), map.harmonic());
    if map.is_embedded(&last, 1.0) {
        return Ok(Advance { reached: TimedPlaces { time: 1.0, places: last }, stuck: Vec::new() });
    }
    let TimedPlaces { mut time, mut places } = from;
    let mut sound = TimedPlaces { time, places: places.clone() };
    let (mut step, mut taken) = (FIRST_STEP, 0);
    let later = |places: &[PlaneVector], by: f64| {
        let mut next = places.to_vec();
        for (k, place) in next.iter_mut().enumerate() {
            add(place, [0, 1].map(|c| by * (last[k][c] - first[k][c])));
        }
        next
    };
    while time < 1.0 && taken < MOST_STEPS && step >= LEAST_STEP_OF_TIME {
        control.step(Stage::Layout, time)?;
        let by = f64::min(step, 1.0 - time);
        let next = later(&places, by);
        let then = if by < step { 1.0 } else { time + by };
        if !keeps_areas(map, [&places, &next], [time, then]) {
            step = by / 2.0;
            continue;
        }
        let part = control.part(time, then);
        places = descended(map, TimedPlaces { time: then, places: next }, STEPS_ON_THE_WAY, &part)?;
        (time, step, taken) = (then, 2.0 * step, taken + 1);
        if time == 1.0 || least_area(map, &places, time) > SOUND_AREA {
            sound = TimedPlaces { time, places: places.clone() };
        }
    }
    let mut stuck = Vec::new();
    if sound.time < 1.0 {
        let by = f64::min(2.0 * LEAST_STEP_OF_TIME, 1.0 - time);
        let next = later(&places, by);
        let loses = |&k: &usize| !square_keeps_areas(map, [&places, &next], [time, time + by], k);
        stuck = (0..map.squares.len()).filter(loses).collect();
        if stuck.is_empty() {
            let is_thin = |&k: &usize| square_area(map, &places, time, k) <= SOUND_AREA;
            stuck = (0..map.squares.len()).filter(is_thin).collect();
        }
    }
    Ok(Advance { reached: sound, stuck })
}

/// The smallest area that the sides at a corner of this square span.
fn square_area(map: &GridMap, places: &[PlaneVector], time: f64, square: usize) -> f64 {
    let at = map.corners(square, places, time);
    (0..4).map(|i| corner_sides(&at, i)).fold(f64::INFINITY, |least, [u, v]| least.min(cross(u, v)))
}

/// The smallest area that the sides at a corner of a square span.
fn least_area(map: &GridMap, places: &[PlaneVector], time: f64) -> f64 {
    (0..map.squares.len()).map(|k| square_area(map, places, time, k)).fold(f64::INFINITY, f64::min)
}

/// The places of little distortion at time 1, from places without folds.
pub(super) fn least_distorted(
    map: &mut GridMap,
    places: Vec<PlaneVector>,
    control: &Control,
) -> Result<Vec<PlaneVector>> {
    descended(map, TimedPlaces { time: 1.0, places }, STEPS_AT_THE_END, control)
}

/// True if no triangle loses much of its area between two times.
fn keeps_areas(map: &GridMap, places: [&[PlaneVector]; 2], times: [f64; 2]) -> bool {
    (0..map.squares.len()).all(|k| square_keeps_areas(map, places, times, k))
}

/// True if no triangle of this square loses much of its area between two times.
fn square_keeps_areas(map: &GridMap, places: [&[PlaneVector]; 2], times: [f64; 2], square: usize) -> bool {
    let [before, after] = [0, 1].map(|t| map.corners(square, places[t], times[t]));
    (0..4).all(|i| {
        let [a, b] = [&before, &after].map(|at| {
            let [u, v] = corner_sides(at, i);
            cross(u, v)
        });
        b > KEPT_AREA * f64::min(a, 1.0)
    })
}

/// The energy, infinite if a triangle is turned over.
fn energy(map: &GridMap, places: &[PlaneVector], time: f64) -> f64 {
    let of_square = |k: usize| {
        let at = map.corners(k, places, time);
        let of_corner = |i: usize| {
            let [u, v] = corner_sides(&at, i);
            let area = cross(u, v);
            if area > 0.0 { squared(u, v) * (1.0 + 1.0 / (area * area)) } else { f64::INFINITY }
        };
        (0..4).map(of_corner).sum::<f64>()
    };
    parallel::map(map.squares.len(), of_square).into_iter().sum::<f64>() / 4.0
}

fn squared(u: PlaneVector, v: PlaneVector) -> f64 {
    u[0] * u[0] + u[1] * u[1] + v[0] * v[0] + v[1] * v[1]
}

/// The gradient of the energy, 0 where coordinates are held.
fn gradient(map: &GridMap, places: &[PlaneVector], time: f64) -> Vec<PlaneVector> {
    let of_square = |k: usize| {
        let corners = &map.squares[k];
        let at = map.corners(k, places, time);
        let mut slope = [[0.0; 2]; 4];
        for i in 0..4 {
            let [u, v] = corner_sides(&at, i);
            let area = cross(u, v);
            let (a, b) = (0.5 * (1.0 + 1.0 / (area * area)), 0.5 * squared(u, v) / area.powi(3));
            let by_u = [a * u[0] - b * v[1], a * u[1] + b * v[0]];
            let by_v = [a * v[0] + b * u[1], a * v[1] - b * u[0]];
            add(&mut slope[(i + 1) % 4], by_u);
            add(&mut slope[(i + 3) % 4], by_v);
            add(&mut slope[i], [-by_u[0] - by_v[0], -by_u[1] - by_v[1]]);
        }
        [0, 1, 2, 3].map(|i| corners[i].back(slope[i]))
    };
    let mut sum = vec![[0.0; 2]; places.len()];
    for (corners, slope) in map.squares.iter().zip(parallel::map(map.squares.len(), of_square)) {
        (0..4).for_each(|i| add(&mut sum[corners[i].vertex], slope[i]));
    }
    map.project(&mut sum);
    sum
}

fn dot(a: &[PlaneVector], b: &[PlaneVector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
}

/// a + t b.
fn moved(a: &[PlaneVector], t: f64, b: &[PlaneVector]) -> Vec<PlaneVector> {
    a.iter().zip(b).map(|(a, b)| [a[0] + t * b[0], a[1] + t * b[1]]).collect()
}

/// A step of the descent and the change of the gradient along it.
struct PastStep {
    step: Vec<PlaneVector>,
    change: Vec<PlaneVector>,
    product: f64,
}

/// Descends the energy by at most so many steps of the method of Broyden, Fletcher, Goldfarb and Shanno with limited memory [LN89], from the
/// Laplacian as the first matrix.
fn descended(
    map: &mut GridMap,
    from: TimedPlaces,
    steps: usize,
    control: &Control,
) -> Result<Vec<PlaneVector>> {
    let TimedPlaces { time, mut places } = from;
    let mut past: VecDeque<PastStep> = VecDeque::with_capacity(MEMORY);
    let mut value = energy(map, &places, time);
    let mut slope = gradient(map, &places, time);
    for k in 0..steps {
        control.step(Stage::Layout, k as f64 / steps as f64)?;
        let mut direction = descent_direction(map, &slope, &past);
        let mut decrease = -dot(&slope, &direction);
        if decrease.is_nan() || decrease <= 0.0 {
            past.clear();
            direction = descent_direction(map, &slope, &past);
            decrease = -dot(&slope, &direction);
        }
        let mut t = 1.0;
        let next = loop {
            let next = moved(&places, t, &direction);
            let found = energy(map, &next, time);
            if found <= value - SUFFICIENT * t * decrease {
                break Some((next, found));
            }
            t /= 2.0;
            if t < LEAST_STEP {
                break None;
            }
        };
        let Some((next, found)) = next else { break };
        let new_slope = gradient(map, &next, time);
        let (step, change) = (moved(&next, -1.0, &places), moved(&new_slope, -1.0, &slope));
        let product = dot(&step, &change);
        if product > 0.0 {
            if past.len() == MEMORY {
                past.pop_front();
            }
            past.push_back(PastStep { step, change, product });
        }
        let is_settled = value - found < SETTLED * value;
        (places, value, slope) = (next, found, new_slope);
        if is_settled {
            break;
        }
    }
    Ok(places)
}

/// The negative gradient times the inverse of the matrix that the past steps make of the Laplacian.
fn descent_direction(
    map: &mut GridMap,
    slope: &[PlaneVector],
    past: &VecDeque<PastStep>,
) -> Vec<PlaneVector> {
    let mut q = slope.to_vec();
    let mut shares = Vec::with_capacity(past.len());
    for known in past.iter().rev() {
        let share = dot(&known.step, &q) / known.product;
        q = moved(&q, -share, &known.change);
        shares.push(share);
    }
    let mut direction = map.preconditioned(&q);
    for (known, share) in past.iter().zip(shares.into_iter().rev()) {
        let back = dot(&known.change, &direction) / known.product;
        direction = moved(&direction, share - back, &known.step);
    }
    direction.iter().map(|d| d.map(|x| -x)).collect()
}

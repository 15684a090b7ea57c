//! Candidates: rough maps between the samples of two surfaces, refined and judged by the distances that they keep.

use super::assignment::assignments;
use super::extremities::Extremity;
use super::sampled::SampledSurface;
use super::spectral_map::{SpectralSides, nearest_rows};
use crate::control::Control;
use crate::error::Result;
use crate::parallel;

/// A map between samples.
pub(super) struct MapCandidate {
    /// Its number in the order of the starts.
    pub start: usize,
    /// Per sample of the source the place of its image.
    pub map: Vec<usize>,
    /// The mean difference of distances, and the mean distance of the target's samples from images.
    pub misfit: f64,
    /// The share of the area that keeps its side, less the share that is turned over.
    pub side: f64,
}

/// Number of functions from which candidates are refined: those of the rough shape, whose signs are tried.
const ROUGH: usize = 6;
/// Numbers of functions up to which candidates are refined before they are judged: all of them, and the best of these once more.
const JUDGED: [usize; 2] = [14, 40];
/// Number of candidates of each side of the surface that are judged once more.
const KEPT: usize = 5;
/// Numbers of functions that are added at once, up to the first number of [`JUDGED`] and up to the second.
const STEPS: [usize; 2] = [2, 4];
/// Number of neighbours from which the side of an image is found.
const NEIGHBOURS: usize = 8;

/// The best of all candidates, and the numbers of those that start from assignments of extremities and from signs of the first functions.
///
/// # Errors
/// Those of [`SpectralSides::refined`]; [`crate::Error::Cancelled`].
pub(super) fn candidates(
    [source, target]: &[SampledSurface<'_>; 2],
    ends: &[Vec<Extremity>; 2],
    control: &Control,
) -> Result<(Vec<MapCandidate>, [usize; 2])> {
    let mut starts = Vec::new();
    for pairs in assignments(&ends[0], &ends[1]) {
        let rows = |s: usize, sampled: &SampledSurface<'_>| -> Vec<Vec<f64>> {
            let row = |&v| pairs.iter().map(|pair| ends[s][pair[s]].distance[v]).collect();
            sampled.even.samples.iter().map(row).collect()
        };
        starts.push(nearest_rows(&rows(0, source), &rows(1, target)));
    }
    let assigned = starts.len();
    let (from, to) = (source.at_samples(), target.at_samples());
    let rough = ROUGH.min(from.first().map_or(0, |row| row.len())).min(to.first().map_or(0, |row| row.len()));
    let own: Vec<Vec<f64>> = from.iter().map(|row| row[..rough].to_vec()).collect();
    for signs in 0..1usize << rough.saturating_sub(1) {
        // The first function is constant.
        let sign = |k: usize| if k > 0 && signs >> (k - 1) & 1 == 1 { -1.0 } else { 1.0 };
        let turned = |row: &&[f64]| (0..rough).map(|k| sign(k) * row[k]).collect();
        starts.push(nearest_rows(&own, &to.iter().map(turned).collect::<Vec<Vec<f64>>>()));
    }
    let numbers = [assigned, starts.len() - assigned];
    let sides = SpectralSides { from: &from, shares: &source.even.shares, to: &to };
    let around = neighbours(source);
    let judged =
        |starts: &[(usize, Vec<usize>)], sizes: [usize; 2], step: usize| -> Result<Vec<MapCandidate>> {
            let judged = parallel::map(starts.len(), |k| {
                control.check()?;
                let (start, map) = (starts[k].0, starts[k].1.clone());
                let map = sides.refined(map, (sizes[0]..=sizes[1]).step_by(step))?;
                let (misfit, side) = (misfit(source, target, &map), side(source, target, &map, &around));
                Ok(MapCandidate { start, map, misfit, side })
            });
            judged.into_iter().collect()
        };
    let [rough_last, last] = JUDGED;
    let starts: Vec<(usize, Vec<usize>)> = starts.into_iter().enumerate().collect();
    let kept = best_of_each_side(judged(&starts, [ROUGH, rough_last], STEPS[0])?);
    Ok((judged(&kept, [rough_last + STEPS[0], last], STEPS[1])?, numbers))
}

/// The maps of the candidates of least misfit with their numbers, as many that keep the sides of the surface as that turn it over, if there
/// are.
fn best_of_each_side(mut all: Vec<MapCandidate>) -> Vec<(usize, Vec<usize>)> {
    all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let (turned, kept): (Vec<MapCandidate>, Vec<MapCandidate>) = all.into_iter().partition(|c| c.side < 0.0);
    let best = [kept, turned].into_iter().flat_map(|side| side.into_iter().take(KEPT));
    best.map(|c| (c.start, c.map)).collect()
}

/// Per sample those around it, the nearest first.
fn neighbours(sampled: &SampledSurface<'_>) -> Vec<Vec<usize>> {
    let distances = &sampled.even.distances;
    parallel::map(distances.len(), |i| {
        let mut around: Vec<usize> = (0..distances.len()).filter(|&j| j != i).collect();
        around.sort_by(|&a, &b| distances[i][a].total_cmp(&distances[i][b]));
        around.truncate(NEIGHBOURS);
        around
    })
}

fn misfit(source: &SampledSurface<'_>, target: &SampledSurface<'_>, map: &[usize]) -> f64 {
    let mut off = 0.0;
    for (i, row) in source.even.distances.iter().enumerate() {
        let images = &target.even.distances[map[i]];
        let differences =
            row.iter().zip(map).zip(&source.even.shares).map(|((d, &j), s)| s * (d - images[j]).abs());
        off += source.even.shares[i] * differences.sum::<f64>();
    }
    let missed = |row: &Vec<f64>| map.iter().map(|&j| row[j]).fold(f64::INFINITY, f64::min);
    off + target.even.distances.iter().zip(&target.even.shares).map(|(row, s)| s * missed(row)).sum::<f64>()
}

/// The share of the area that keeps its side, less that which is turned over: around each sample the map is linear by least squares, and
/// the determinant has the sign of that of Σ x yᵀ over neighbours x with their images y.
fn side(
    source: &SampledSurface<'_>,
    target: &SampledSurface<'_>,
    map: &[usize],
    around: &[Vec<usize>],
) -> f64 {
    let mut sum = 0.0;
    for i in 0..map.len() {
        let mut matrix = [[0.0; 2]; 2];
        for &j in &around[i] {
            let (own, image) = (source.step(i, j), target.step(map[i], map[j]));
            (0..2).for_each(|k| (0..2).for_each(|l| matrix[k][l] += own[k] * image[l]));
        }
        let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
        if determinant != 0.0 {
            sum += source.even.shares[i] * determinant.signum();
        }
    }
    sum
}

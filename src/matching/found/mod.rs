//! Landmarks that are found: pairs of vertices that correspond by the shapes of two surfaces alone.
//!
//! Extremities of both surfaces are paired in all ways in which their distances and descriptors agree, and the first eigenfunctions of the
//! Laplacian with all signs: each way is a rough map (*candidate*) between vertices that lie evenly. Every one is refined from few
//! eigenfunctions to many \[MRRSWO19\]. The map that keeps distances best is taken, among those that do not turn the surface over;
//! landmarks are read off it at extremities first, then far from each other.

mod assignment;
mod by_shape;
mod candidate;
mod extremities;
mod sampled;
mod spectral_map;

use crate::control::Control;
use crate::error::Result;
use crate::matching::even_sample::EvenSample;
use crate::mesh::{PerVertex, VertexId};
use crate::metric::Surface;
use crate::parallel;
pub use by_shape::{ShapeMatching, match_by_shape};
use candidate::{MapCandidate, candidates};
use extremities::{Extremity, extremities};
use sampled::{FUNCTIONS, SampledSurface};
use spectral_map::SpectralSides;

/// Options of [`find_landmarks`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LandmarkSearch {
    /// Most pairs. Default 8: of cats in two poses the error of the map is 0.016 of the diagonal with 8, 0.013 with 16, at twice the time.
    pub most: usize,
}

impl Default for LandmarkSearch {
    fn default() -> Self {
        LandmarkSearch { most: 8 }
    }
}

/// Pairs of vertices that correspond by one candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundPairs {
    /// Vertices inside the source and the target; extremities first, then each far from those before it.
    pub pairs: Vec<[VertexId; 2]>,
    /// How far the map between samples, from which the pairs are read off, is from an isometry: the mean difference of distances, and the mean
    /// distance of the target's samples from images, on surfaces of area 1. 0.03 to 0.04 for animals in other poses, 0.06 from a cat to
    /// a lion.
    pub misfit: f64,
    /// The number of the candidate, in the order of [`FoundLandmarks::candidates`].
    pub candidate: usize,
}

/// Pairs of vertices that correspond by the shapes of two surfaces. A surface with a plane of symmetry has two maps that fit equally well,
/// one of which turns it over: both are told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FoundLandmarks {
    /// By the best candidate that keeps the sides of the surface. There is none where no candidate does, and where a surface is as round as
    /// a ball.
    pub kept: Option<FoundPairs>,
    /// By the best candidate that turns the surface over: landmarks of a map from the mirror image of the source.
    pub mirrored: Option<FoundPairs>,
    /// Numbers of candidates that begin with pairs of extremities, those of least cost first, and with signs of eigenfunctions.
    pub candidates: [usize; 2],
}

/// Factor below which the misfit of maps that turn the surface over says that one surface is like a mirror image of the other. Of surfaces
/// with a plane of symmetry both are equal but for small differences.
const MIRRORED: f64 = 0.8;

impl FoundLandmarks {
    /// True if one surface is like a mirror image of the other: maps that turn it over fit clearly better.
    pub fn is_mirrored(&self) -> bool {
        match (&self.kept, &self.mirrored) {
            (kept, Some(mirrored)) => {
                kept.as_ref().is_none_or(|kept| mirrored.misfit < MIRRORED * kept.misfit)
            }
            _ => false,
        }
    }

    /// The pairs of a map that keeps the sides of the surface.
    pub fn pairs(&self) -> &[[VertexId; 2]] {
        self.kept.as_ref().map_or(&[], |kept| &kept.pairs)
    }
}

/// Most extremities of the source and of the target that are paired.
const EXTREMITIES: [usize; 2] = [7, 9];
/// Mean difference of how remote two points are below which a surface is too round for landmarks: any turn of it would do.
const TELLING: f64 = 0.02;
/// Distance between landmarks, on a surface of area 1, below which paths to others would have little room beside them.
const APART: f64 = 0.03;
/// Difference of distances to the other landmarks, on average, above which a pair is left out: as a multiple of the median, and at least.
const OUTLIER: [f64; 2] = [3.0, 0.05];

/// Pairs of vertices of two surfaces that correspond by their shapes. The result is the same for any number of threads.
///
/// # Errors
/// [`crate::Error::Argument`] for a surface without positions, whose sides are not known; those of [`crate::harmonic::spectrum()`];
/// [`crate::Error::Cancelled`].
pub fn find_landmarks(
    surfaces: [&Surface; 2],
    options: &LandmarkSearch,
    control: &Control,
) -> Result<FoundLandmarks> {
    search_landmarks(surfaces, options, control).map(|(found, _)| found)
}

/// [`find_landmarks`], and the samples of the surfaces.
///
/// # Errors
/// Those of [`find_landmarks`].
fn search_landmarks<'a>(
    surfaces: [&'a Surface; 2],
    options: &LandmarkSearch,
    control: &Control,
) -> Result<(FoundLandmarks, [EvenSample<'a>; 2])> {
    let (source, target) = parallel::join(
        || SampledSurface::new(surfaces[0], &control.part(0.0, 0.7)),
        || SampledSurface::new(surfaces[1], &control.part(0.0, 0.7)),
    );
    let sampled = [source?, target?];
    if sampled.iter().any(|side| side.even.spread() < TELLING) {
        return Ok((FoundLandmarks::default(), sampled.map(|side| side.even)));
    }
    let ends = [0, 1].map(|s| extremities(&sampled[s], EXTREMITIES[s], &control.part(0.7, 0.75)));
    let [from, to] = ends;
    let ends = [from?, to?];
    let (all, candidates) = candidates(&sampled, &ends, &control.part(0.75, 0.9))?;
    let best = |is_turned: bool, control: &Control| -> Result<Option<FoundPairs>> {
        let own = all.iter().filter(|c| (c.side < 0.0) == is_turned);
        let Some(best) = own.min_by(|a, b| a.misfit.total_cmp(&b.misfit)) else { return Ok(None) };
        let pairs = landmarks(&sampled, &ends[0], best, options.most, control)?;
        Ok(Some(FoundPairs { pairs, misfit: best.misfit, candidate: best.start }))
    };
    let kept = best(false, &control.part(0.9, 0.95))?;
    let mirrored = best(true, &control.part(0.95, 1.0))?;
    Ok((FoundLandmarks { kept, mirrored, candidates }, sampled.map(|side| side.even)))
}

/// Numbers of functions to which the map that is taken is refined, as one between samples and then as one to all vertices of the target: the
/// latter takes as many times longer as there are more vertices than samples.
const REFINED_AT_SAMPLES: [usize; 3] = [42, 46, 50];
const REFINED_AT_VERTICES: [usize; 2] = [50, FUNCTIONS];

/// Pairs of the map of a candidate, which is refined to all vertices of the target.
fn landmarks(
    [source, target]: &[SampledSurface<'_>; 2],
    ends: &[Extremity],
    candidate: &MapCandidate,
    most: usize,
    control: &Control,
) -> Result<Vec<[VertexId; 2]>> {
    let (from, shares) = (source.at_samples(), &source.even.shares);
    let coarse = SpectralSides { from: &from, shares, to: &target.at_samples() };
    let map = coarse.refined(candidate.map.clone(), REFINED_AT_SAMPLES.into_iter())?;
    let to: Vec<&[f64]> = target.functions.iter().map(Vec::as_slice).collect();
    let fine = SpectralSides { from: &from, shares, to: &to };
    let map = map.into_iter().map(|k| target.even.samples[k].index()).collect();
    let map = fine.refined(map, REFINED_AT_VERTICES.into_iter())?;
    let image = |i: usize| VertexId(map[i] as u32);
    let meshes = [source.even.surface.mesh(), target.even.surface.mesh()];
    let is_inside = |i: usize| {
        !meshes[0].is_boundary_vertex(source.even.samples[i]) && !meshes[1].is_boundary_vertex(image(i))
    };
    let mut chosen: Vec<(usize, PerVertex<f64>)> = Vec::new();
    let extreme: Vec<usize> = ends.iter().map(|end| source.even.nearest[end.vertex] as usize).collect();
    let mut rejected = vec![false; map.len()];
    while chosen.len() < most {
        let off =
            |i: usize| chosen.iter().map(|(j, _)| source.even.distances[*j][i]).fold(f64::INFINITY, f64::min);
        let far_in_target =
            |i: usize| chosen.iter().map(|(_, far)| far[image(i)]).fold(f64::INFINITY, f64::min);
        let is_open = |&i: &usize| !rejected[i] && is_inside(i) && off(i).min(far_in_target(i)) > APART;
        let next = extreme.iter().copied().find(is_open);
        let far = (0..map.len()).filter(is_open).max_by(|&i, &j| off(i).total_cmp(&off(j)).then(j.cmp(&i)));
        let Some(next) = next.or(far) else { break };
        rejected[next] = true;
        chosen.push((next, target.even.distances_from(image(next), control)?));
    }
    let kept = agreeing(source, &chosen, image);
    Ok(kept.into_iter().map(|i| [source.even.samples[i], image(i)]).collect())
}

/// The landmarks whose distances to the others are nearly the same on both surfaces.
fn agreeing(
    source: &SampledSurface<'_>,
    chosen: &[(usize, PerVertex<f64>)],
    image: impl Fn(usize) -> VertexId,
) -> Vec<usize> {
    let others = chosen.len().saturating_sub(1).max(1) as f64;
    let off = |(i, far): &(usize, PerVertex<f64>)| {
        let difference =
            |(j, _): &(usize, PerVertex<f64>)| (source.even.distances[*i][*j] - far[image(*j)]).abs();
        chosen.iter().map(difference).sum::<f64>() / others
    };
    let all: Vec<f64> = chosen.iter().map(off).collect();
    let mut sorted = all.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let limit = (OUTLIER[0] * median).max(OUTLIER[1]);
    chosen.iter().zip(all).filter(|(_, off)| *off <= limit).map(|((i, _), _)| *i).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    /// A ball with four arms of different lengths, which no symmetry turns over: twisted about x, or its mirror image.
    fn creature(bend: f64, is_mirrored: bool) -> Surface {
        let mut soup = shapes::icosphere(8).unwrap();
        let arms = [
            ([1.0, 0.0, 0.0], 1.6),
            ([0.0, 1.0, 0.0], 1.2),
            ([0.0, 0.0, 1.0], 0.9),
            ([-0.6, -0.8, 0.0], 1.4),
        ];
        for p in &mut soup.positions {
            let dot = |d: [f64; 3]| (0..3).map(|k| p[k] * d[k]).sum::<f64>();
            let out: f64 = arms.iter().map(|(d, l)| l * (-12.0 * (1.0 - dot(*d))).exp()).sum();
            let [x, y, z] = p.map(|x| x * (1.0 + out));
            let angle = bend * x;
            *p = [x, y * angle.cos() - z * angle.sin(), y * angle.sin() + z * angle.cos()];
            p[0] *= if is_mirrored { -1.0 } else { 1.0 };
        }
        if is_mirrored {
            soup.faces.iter_mut().for_each(|f| f.swap(1, 2));
        }
        Surface::from_soup(&soup).unwrap()
    }

    #[test]
    fn landmarks_of_a_twisted_creature_are_their_own_partners() {
        let (one, other) = (creature(0.0, false), creature(0.2, false));
        let found = find_landmarks([&one, &other], &LandmarkSearch::default(), &Control::new()).unwrap();
        assert!(found.pairs().len() >= 6 && !found.is_mirrored(), "{found:?}");
        let points = one.positions().unwrap();
        let apart = |pair: &[VertexId; 2]| {
            let [p, q] = pair.map(|v| points[v.index()]);
            crate::geometry::vector::distance(p, q)
        };
        let most = found.pairs().iter().map(apart).fold(0.0, f64::max);
        assert!(most < 0.25, "{most} {found:?}");
    }

    #[test]
    fn a_mirror_image_is_named() {
        let surfaces = [&creature(0.0, false), &creature(0.0, true)];
        let found = find_landmarks(surfaces, &LandmarkSearch::default(), &Control::new()).unwrap();
        assert!(found.is_mirrored(), "{found:?}");
        // The mirror image has the same vertices.
        let mirrored = found.mirrored.unwrap();
        assert!(
            mirrored.pairs.len() >= 6 && mirrored.candidate < found.candidates.iter().sum(),
            "{mirrored:?}"
        );
        assert!(mirrored.pairs.iter().all(|[v, w]| v == w), "{mirrored:?}");
    }
}

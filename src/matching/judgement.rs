//! The judgement of a map between two surfaces: how much it distorts, whether it brings alike points to each other, and one word for that.

use super::even_sample::{EvenSample, REMOTE};
use super::quality::{cycle_error, face_distortions};
use super::result::Matching;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel;

/// What a map is good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapVerdict {
    /// It keeps areas and angles as maps between poses of one shape do: values can be carried along it point by point.
    Good,
    /// Its parts correspond, but not every point: values can be carried along it where they vary slowly.
    Rough,
    /// Whole parts of a surface go to a spot, or to parts that are not alike: landmarks are needed.
    Unlikely,
}

impl MapVerdict {
    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            MapVerdict::Good => "good",
            MapVerdict::Rough => "rough",
            MapVerdict::Unlikely => "unlikely",
        }
    }
}

/// How much a map distorts, and whether it brings alike points to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapJudgement {
    /// Mean by area of |ln| of a face's share of the image's area over its share of its own surface.
    pub area_log_mean: f64,
    /// That of which it is exceeded on 1 % of the area.
    pub area_log_99: f64,
    /// Mean by area of the quasi-conformal dilatation of the faces.
    pub qc_mean: f64,
    /// That which is exceeded on 1 % of the area.
    pub qc_99: f64,
    /// Mean distance of a vertex from where the map and its inverse bring it, over the diagonal of the source's bounding box.
    pub cycle_mean: f64,
    /// Agreement of the descriptor of corresponding points: 1 less the mean difference at a vertex and its image over the mean difference
    /// at points that are chosen blindly. The descriptor is how remote a point is, its mean distance from the surface over the mean of
    /// that. 1 where they are equal, 0 where the map does no better than chance.
    pub agreement: f64,
    /// One word for all of it.
    pub verdict: MapVerdict,
}

/// Bounds of the five figures, those of [`MapVerdict::Good`] and those beyond which a map is [`MapVerdict::Unlikely`]: area_log_mean, qc_mean
/// and cycle_mean from above, agreement from below.
///
/// With eight landmarks, maps of cats and of people in two poses have the mean |ln area| 0.22 to 0.27, the mean dilatation 1.1 to 1.3 and come back
/// to 0.001 to 0.002 of the diagonal; without any it is 3.6 to 6.3, 1.2 to 1.3 and 0.06 to 0.08. The bounds of the agreement are a choice.
const AREA_LOG: [f64; 2] = [0.5, 2.0];
const DILATATION: [f64; 2] = [1.5, 6.0];
const CYCLE: [f64; 2] = [0.005, 0.1];
const AGREEMENT: [f64; 2] = [0.8, 0.4];
/// The same on surfaces with handles, where the class of a map decides what goes where: no agreement alone makes one unlikely.
const AGREEMENT_WITH_HANDLES: [f64; 2] = [0.8, f64::NEG_INFINITY];
/// Share of the area on which the 99 % figures are exceeded.
const TAIL: f64 = 0.01;
/// Difference of the descriptor between blindly chosen points below which it does not tell points of a surface apart, as on a sphere.
const TELLING: f64 = 0.1;

/// The judgement of a map that was found by [`super::match_surfaces`]. The result is the same for any number of threads.
///
/// # Errors
/// [`crate::Error::Size`] for other surfaces; [`crate::Error::Argument`] for surfaces without positions; [`crate::Error::Cancelled`].
pub fn judge(surfaces: [&Surface; 2], matching: &Matching, control: &Control) -> Result<MapJudgement> {
    let [from, to] =
        surfaces.map(|surface| move |control: &Control| EvenSample::new(surface, REMOTE, control));
    let (from, to) = parallel::join(|| from(&control.part(0.0, 1.0)), || to(&control.part(0.0, 1.0)));
    judge_sampled([&from?, &to?], matching)
}

/// [`judge`] for surfaces that are sampled already, with [`REMOTE`] vertices or more.
///
/// # Errors
/// Those of [`judge`].
pub(super) fn judge_sampled([from, to]: [&EvenSample<'_>; 2], matching: &Matching) -> Result<MapJudgement> {
    let surfaces = [from.surface, to.surface];
    let faces = face_distortions(surfaces, &matching.forward)?;
    let [cycle_mean, _] = cycle_error(surfaces, [&matching.forward, &matching.backward])?;
    let remote: Vec<[f64; 1]> = to.remoteness.iter().map(|r| [*r]).collect();
    let images = matching.forward.carry(surfaces[1].mesh(), &remote)?;
    let off = |v: VertexId| from.areas[v] * (from.remoteness[v] - images[v.index()][0]).abs();
    let apart: f64 = surfaces[0].mesh().vertices().map(off).sum();
    let area: Vec<(f64, f64)> = faces.iter().map(|f| (f.area_log, f.area)).collect();
    let dilatation: Vec<(f64, f64)> = faces.iter().map(|f| (f.dilatation, f.area)).collect();
    let mut judgement = MapJudgement {
        area_log_mean: mean(&area),
        area_log_99: exceeded(area),
        qc_mean: mean(&dilatation),
        qc_99: exceeded(dilatation),
        cycle_mean,
        agreement: 1.0 - apart / from.blind_difference(to).max(TELLING),
        verdict: MapVerdict::Rough,
    };
    let has_handles = surfaces[0].mesh().genus() > 0;
    judgement.verdict = judgement.word(if has_handles { AGREEMENT_WITH_HANDLES } else { AGREEMENT });
    Ok(judgement)
}

impl MapJudgement {
    /// One number by which maps of the same surfaces are compared, 0 for an isometry: the mean of |ln| of areas, that of the dilatation,
    /// and the missing agreement.
    pub fn distortion(&self) -> f64 {
        self.area_log_mean + self.qc_mean.ln() + 1.0 - self.agreement
    }

    /// The word for these figures: the worst that one of them asks for. `agreement`: its bounds.
    fn word(&self, agreement: [f64; 2]) -> MapVerdict {
        let within = |k: usize| {
            self.area_log_mean <= AREA_LOG[k]
                && self.qc_mean <= DILATATION[k]
                && self.cycle_mean <= CYCLE[k]
                && self.agreement >= agreement[k]
        };
        if within(0) {
            MapVerdict::Good
        } else if within(1) {
            MapVerdict::Rough
        } else {
            MapVerdict::Unlikely
        }
    }
}

fn mean(values: &[(f64, f64)]) -> f64 {
    let total = values.iter().map(|(_, area)| area).sum::<f64>().max(f64::MIN_POSITIVE);
    values.iter().map(|(x, area)| x * area).sum::<f64>() / total
}

/// The value that is exceeded on 1 % of the area.
fn exceeded(mut values: Vec<(f64, f64)>) -> f64 {
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut left = TAIL * values.iter().map(|(_, area)| area).sum::<f64>();
    for (value, area) in &values {
        left -= area;
        if left <= 0.0 {
            return *value;
        }
    }
    values.last().map_or(0.0, |(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::{MatchOptions, match_surfaces};
    use crate::mesh::shapes;

    fn egg(axes: [f64; 3]) -> Surface {
        Surface::from_soup(&shapes::ellipsoid(axes, 6).unwrap()).unwrap()
    }

    #[test]
    fn the_tail_is_what_one_percent_of_the_area_exceeds() {
        let values = vec![(5.0, 0.004), (4.0, 0.004), (3.0, 0.004), (1.0, 0.988)];
        assert_eq!(exceeded(values), 3.0);
    }

    #[test]
    fn the_identity_is_good_and_a_turned_ellipsoid_is_not() {
        let long = egg([1.0, 1.0, 3.0]);
        let control = Control::new();
        let same = match_surfaces(&long, &long, &MatchOptions::default(), &control).unwrap();
        let own = judge([&long, &long], &same, &control).unwrap();
        assert_eq!(own.verdict, MapVerdict::Good);
        assert!(own.agreement > 0.999 && own.area_log_99 < 1e-6 && own.qc_99 < 1.0 + 1e-6, "{own:?}");
        // The poles go to the equator.
        let points = long.positions().unwrap();
        let most = |k: usize, sign: f64| {
            let far = |v: &VertexId| sign * points[v.index()][k];
            long.mesh().vertices().max_by(|a, b| far(a).total_cmp(&far(b))).unwrap()
        };
        let landmarks = [[2, 0], [0, 1], [1, 2]].map(|[a, b]| [most(a, 1.0), most(b, 1.0)]);
        let options = MatchOptions { landmarks: landmarks.to_vec(), ..MatchOptions::default() };
        let turned = match_surfaces(&long, &long, &options, &control).unwrap();
        let other = judge([&long, &long], &turned, &control).unwrap();
        assert!(other.agreement < 0.5 && other.verdict == MapVerdict::Unlikely, "{other:?}");
    }
}

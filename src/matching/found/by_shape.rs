//! The choice between the map with landmarks that are found and the one without any.

use super::{FoundLandmarks, LandmarkSearch, search_landmarks};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::matching::even_sample::EvenSample;
use crate::matching::judgement::{MapJudgement, MapVerdict, judge_sampled};
use crate::matching::match_surfaces::{check_topology, match_surfaces};
use crate::matching::options::MatchOptions;
use crate::matching::result::Matching;
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel::within;

/// A map for which landmarks were looked for, with its judgement.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeMatching {
    /// The map.
    pub matching: Matching,
    /// Its landmarks: those that were found, the first half of them, or none where the map without any is better.
    pub landmarks: Vec<[VertexId; 2]>,
    /// The judgement of the map.
    pub judgement: MapJudgement,
    /// All landmarks that were found.
    pub found: FoundLandmarks,
}

/// Misfit above which the map without landmarks is made first, and on surfaces with handles the only one: that of animals is below it.
const UNCLEAR: f64 = 0.08;
/// Fewest landmarks of a map: with fewer a sphere is matched as without any.
const FEWEST: usize = 3;

/// The map from one surface to another one of the same topology, with landmarks that are found by their shapes where they make the map
/// better. Where these are clear the map with them is made first, and taken unless it is [`MapVerdict::Unlikely`]; elsewhere the map without
/// any is made first, and taken if it is [`MapVerdict::Good`]. Of two maps that of less distortion is taken. Landmarks, points, soft landmarks
/// and curves of the options are not looked at. The result is the same for any number of threads.
///
/// # Errors
/// Those of [`match_surfaces`] where no map is found, of [`super::find_landmarks`] and of [`crate::matching::judge`]; [`Error::Cancelled`].
pub fn match_by_shape(
    surfaces: [&Surface; 2],
    options: &MatchOptions,
    search: &LandmarkSearch,
    control: &Control,
) -> Result<ShapeMatching> {
    check_topology(surfaces[0], surfaces[1])?;
    let threads = options.flow.threads;
    let (found, sampled) = within(threads, || search_landmarks(surfaces, search, &control.part(0.0, 0.2)))?;
    let has_handles = surfaces[0].mesh().genus() > 0;
    let is_clear = found.kept.as_ref().is_some_and(|kept| kept.misfit <= UNCLEAR);
    let enough = found.pairs().len() >= FEWEST && (is_clear || !has_handles);
    let attempts = ShapeAttempts { sampled: &sampled, options, found: &found };
    let mut best: Option<ShapeMatching> = None;
    let marked_first = is_clear && enough && !has_handles;
    for (k, marked) in [marked_first, !marked_first].into_iter().enumerate() {
        let control = control.part(0.2 + 0.4 * k as f64, 0.6 + 0.4 * k as f64);
        let next = if marked && enough { attempts.with_most(&control) } else { attempts.with(0, &control) };
        best = match (best, next) {
            (None, Err(Error::Matching(_))) if k == 0 => None,
            (Some(best), Err(Error::Matching(_))) => Some(best),
            (Some(best), Ok(next)) if best.judgement.distortion() <= next.judgement.distortion() => {
                Some(best)
            }
            (_, next) => Some(next?),
        };
        let is_taken = best.as_ref().is_some_and(|best| match best.judgement.verdict {
            MapVerdict::Good => true,
            MapVerdict::Rough => marked,
            MapVerdict::Unlikely => false,
        });
        if is_taken || !enough && best.is_some() {
            break;
        }
    }
    best.ok_or_else(|| Error::Matching("no map was found, with landmarks or without".into()))
}

/// The maps that are tried.
struct ShapeAttempts<'a> {
    sampled: &'a [EvenSample<'a>; 2],
    options: &'a MatchOptions,
    found: &'a FoundLandmarks,
}

impl ShapeAttempts<'_> {
    /// The map with all landmarks, or with half of them if that of all is not found.
    fn with_most(&self, control: &Control) -> Result<ShapeMatching> {
        let all = self.found.pairs().len();
        match self.with(all, &control.part(0.0, 0.6)) {
            Err(Error::Matching(_)) if all / 2 >= FEWEST => self.with(all / 2, &control.part(0.6, 1.0)),
            found => found,
        }
    }

    fn with(&self, count: usize, control: &Control) -> Result<ShapeMatching> {
        let landmarks = self.found.pairs()[..count].to_vec();
        let (points, soft, curves) = (Vec::new(), Vec::new(), Vec::new());
        let options =
            MatchOptions { landmarks: landmarks.clone(), points, soft, curves, ..self.options.clone() };
        let [from, to] = self.sampled;
        let matching = match_surfaces(from.surface, to.surface, &options, control)?;
        let judgement = within(options.flow.threads, || judge_sampled([from, to], &matching))?;
        Ok(ShapeMatching { matching, landmarks, judgement, found: self.found.clone() })
    }
}

//! Maps for which landmarks are found by the shapes of the surfaces, and judgements of maps.

use crate::arrays::copy_out;
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::guard;
use crate::matching::{made, ricci_match_options, ricci_matching};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::matching::{FoundPairs, LandmarkSearch, MapVerdict, judge, match_by_shape};
use ricci::mesh::VertexId;
use ricci::parallel::within;

choices!(VERDICTS: MapVerdict = "verdict", [
    RICCI_VERDICT_GOOD => MapVerdict::Good,
    RICCI_VERDICT_ROUGH => MapVerdict::Rough,
    RICCI_VERDICT_UNLIKELY => MapVerdict::Unlikely,
]);

choices!(enum LandmarkKind, LANDMARKS = "kind of landmarks", [
    RICCI_LANDMARKS_USED => Used,
    RICCI_LANDMARKS_KEPT => Kept,
    RICCI_LANDMARKS_MIRRORED => Mirrored,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_matching_judgement {
    pub size: usize,
    pub area_log_mean: f64,
    pub area_log_99: f64,
    pub qc_mean: f64,
    pub qc_99: f64,
    pub cycle_mean: f64,
    pub agreement: f64,
    pub verdict: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_matching_judgement, "judgement", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_found_landmarks {
    pub size: usize,
    pub n_used: usize,
    pub n_kept: usize,
    pub n_mirrored: usize,
    pub n_paired: usize,
    pub n_signed: usize,
    pub candidate: usize,
    pub mirrored_candidate: usize,
    pub misfit: f64,
    pub mirrored_misfit: f64,
    pub has_kept: u32,
    pub has_mirrored: u32,
    pub mirror: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_found_landmarks, "found", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_match_by_shape(
    source: *const ricci_mesh,
    target: *const ricci_mesh,
    options: *const ricci_match_options,
    control: *const ricci_control,
    matching: *mut *mut ricci_matching,
) -> ricci_status {
    let surfaces = [source, target];
    made(surfaces, options, control, matching, |both, options, control, threads| {
        let shaped = match_by_shape(both, options, &LandmarkSearch::default(), control)?;
        let matching = ricci_matching::new(both, shaped.matching, &shaped.landmarks, threads)?;
        Ok(ricci_matching { found: shaped.found, ..matching })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_judge(
    matching: *const ricci_matching,
    control: *const ricci_control,
    judgement: *mut ricci_matching_judgement,
    size: usize,
) -> ricci_status {
    guard::with(matching, |ricci_matching { matching, source, target, threads, .. }| {
        let control = control::of(control)?;
        let n = source.mesh().n_vertices().saturating_add(target.mesh().n_vertices());
        let _reserve = memory::work(n, memory::LAYOUT)?;
        let found = within(*threads, || judge([source, target], matching, &control))?;
        let figures = ricci_matching_judgement {
            size: 0,
            area_log_mean: found.area_log_mean,
            area_log_99: found.area_log_99,
            qc_mean: found.qc_mean,
            qc_99: found.qc_99,
            cycle_mean: found.cycle_mean,
            agreement: found.agreement,
            verdict: VERDICTS.number(found.verdict)?,
            reserved: 0,
        };
        structs::write(figures, judgement, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_found(
    matching: *const ricci_matching,
    found: *mut ricci_found_landmarks,
    size: usize,
) -> ricci_status {
    guard::with(matching, |ricci_matching { landmarks, found: all, .. }| {
        let (kept, mirrored) = (all.kept.as_ref(), all.mirrored.as_ref());
        let n = |side: Option<&FoundPairs>| side.map_or(0, |side| side.pairs.len());
        let candidate = |side: Option<&FoundPairs>| side.map_or(0, |side| side.candidate);
        let misfit = |side: Option<&FoundPairs>| side.map_or(0.0, |side| side.misfit);
        let figures = ricci_found_landmarks {
            size: 0,
            n_used: landmarks.len(),
            n_kept: n(kept),
            n_mirrored: n(mirrored),
            n_paired: all.candidates[0],
            n_signed: all.candidates[1],
            candidate: candidate(kept),
            mirrored_candidate: candidate(mirrored),
            misfit: misfit(kept),
            mirrored_misfit: misfit(mirrored),
            has_kept: u32::from(kept.is_some()),
            has_mirrored: u32::from(mirrored.is_some()),
            mirror: u32::from(all.is_mirrored()),
            reserved: 0,
        };
        structs::write(figures, found, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_landmarks(
    matching: *const ricci_matching,
    kind: u32,
    pairs: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(matching, |ricci_matching { landmarks, found, .. }| {
        let mirrored = found.mirrored.as_ref();
        let all: &[[VertexId; 2]] = match LANDMARKS.choose(kind)? {
            LandmarkKind::Used => landmarks,
            LandmarkKind::Kept => found.pairs(),
            LandmarkKind::Mirrored => mirrored.map_or(&[], |side| &side.pairs),
        };
        let all: Vec<[u32; 2]> = all.iter().map(|pair| pair.map(|v| v.0)).collect();
        copy_out("pairs", &all, pairs, capacity)
    })
}

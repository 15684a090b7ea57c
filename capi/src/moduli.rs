//! Bounds of period matrices and moduli, lengths and twists of pairs of pants.

use crate::arrays::{array, check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::deck::{MOST_RESERVED, ricci_deck};
use crate::failure::{Failure, Outcome};
use crate::forms::ricci_forms;
use crate::guard;
use crate::matching::ricci_matching;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::paths::halfedges_of;
use crate::status::*;
use crate::structs::{self, sized};
use crate::uniformize::ricci_uniform;
use ricci::matching::{LowerBoundKind, dilatation_bracket};
use ricci::mesh::VertexId;
use ricci::moduli::{
    BoundsOptions, Degree, PantsCurve, PeriodBounds, SpectrumOptions, fenchel_nielsen,
    fenchel_nielsen_of_loops, modulus_bounds, pants_of_words, period_bounds,
};
use ricci::parallel::within;
use ricci::topology::Word;

choices!(DEGREES: Degree = "degree", [
    RICCI_DEGREE_QUADRATIC => Degree::Quadratic,
    RICCI_DEGREE_LINEAR => Degree::Linear,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_bounds_options {
    pub size: usize,
    pub width: f64,
    pub most_unknowns: usize,
    pub degree: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_bounds_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_bounds_summary {
    pub size: usize,
    pub gap: f64,
    pub first_gap: f64,
    pub modulus: [f64; 2],
    pub modulus_radius: f64,
    pub n_added: usize,
    pub n_unknowns: usize,
    pub n_systems: usize,
    pub reached: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_bounds_summary, "summary", reserved);

impl ricci_bounds_options {
    fn to_library(self) -> Outcome<BoundsOptions> {
        Ok(BoundsOptions {
            width: if self.width == 0.0 { BoundsOptions::default().width } else { self.width },
            degree: DEGREES.choose(self.degree)?,
            most_unknowns: Some(self.most_unknowns).filter(|&most| most > 0),
        })
    }
}

fn figures_of(bounds: &PeriodBounds) -> ricci_bounds_summary {
    let tau = bounds.modulus();
    ricci_bounds_summary {
        size: 0,
        gap: bounds.gap,
        first_gap: bounds.first_gap,
        modulus: tau.map_or([f64::NAN; 2], |tau| tau.value),
        modulus_radius: tau.map_or(f64::NAN, |tau| tau.radius),
        n_added: bounds.n_added,
        n_unknowns: bounds.n_unknowns,
        n_systems: bounds.rounds,
        reached: u32::from(bounds.is_reached),
        reserved: 0,
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_modulus_bounds(
    mesh: *const ricci_mesh,
    corners: *const u32,
    options: *const ricci_bounds_options,
    control: *const ricci_control,
    interval: *mut f64,
    summary: *mut ricci_bounds_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let threads = control::threads(control);
        let (given, control) = (structs::read(options)?, control::of(control)?);
        let options = given.to_library()?;
        let corners: Vec<u32> = if corners.is_null() { Vec::new() } else { array("corners", corners, 4)? };
        let corners: Vec<VertexId> = corners.into_iter().map(VertexId).collect();
        check_buffer("interval", 2, interval, 2)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices().saturating_mul(4), memory::UNIFORM)?;
        let surface = mesh.surface()?;
        let found = within(threads, || modulus_bounds(surface, &corners, &options, &control))?;
        structs::write(figures_of(&found.torus), summary, size)?;
        copy_out("interval", &found.interval, interval, 2)
    })
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_dilatation_bracket {
    pub size: usize,
    pub lower: f64,
    pub upper: f64,
    pub most: f64,
    pub left_out_area: f64,
    pub gaps: [f64; 2],
    pub n_left_out: usize,
    pub lower_by: u32,
    pub by_numbers: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_dilatation_bracket, "bracket");

choices!(LOWER: LowerBoundKind = "lower bound", [
    RICCI_LOWER_NONE => LowerBoundKind::None,
    RICCI_LOWER_PERIODS => LowerBoundKind::PeriodMatrices,
    RICCI_LOWER_MODULI => LowerBoundKind::Moduli,
]);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_bracket(
    matching: *const ricci_matching,
    corners: *const u32,
    options: *const ricci_bounds_options,
    control: *const ricci_control,
    bracket: *mut ricci_dilatation_bracket,
    size: usize,
) -> ricci_status {
    guard::with(matching, |ricci_matching { matching, source, target, threads, .. }| {
        let (given, control) = (structs::read(options)?, control::of(control)?);
        let options = given.to_library()?;
        let corners: Vec<u32> = if corners.is_null() { Vec::new() } else { array("corners", corners, 8)? };
        let corners: Vec<[VertexId; 2]> =
            corners.chunks_exact(2).map(|pair| [VertexId(pair[0]), VertexId(pair[1])]).collect();
        let n = source.mesh().n_vertices().saturating_add(target.mesh().n_vertices());
        let _reserve = memory::work(n, memory::UNIFORM)?;
        let found = within(*threads, || {
            let overlay = matching.domain.overlay(*threads, &control.part(0.0, 0.3))?;
            let control = control.part(0.3, 1.0);
            dilatation_bracket([source, target], &overlay, &corners, &options, &control)
        })?;
        let figures = ricci_dilatation_bracket {
            size: 0,
            lower: found.lower,
            upper: found.upper,
            most: found.most,
            left_out_area: found.left_out_area,
            gaps: found.gaps,
            n_left_out: found.left_out,
            lower_by: LOWER.number(found.kind)?,
            by_numbers: u32::from(found.by_numbers),
        };
        structs::write(figures, bracket, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_bounds(
    forms: *const ricci_forms,
    options: *const ricci_bounds_options,
    control: *const ricci_control,
    matrix: *mut f64,
    capacity: usize,
    summary: *mut ricci_bounds_summary,
    size: usize,
) -> ricci_status {
    guard::with(forms, |ricci_forms { forms, periods, .. }| {
        let threads = control::threads(control);
        let (given, control) = (structs::read(options)?, control::of(control)?);
        let Some(periods) = periods else {
            return Err(Failure::new(
                RICCI_LAYOUT,
                "only a closed surface of genus 1 or more has a period matrix",
            ));
        };
        check_buffer("matrix", 3 * periods.genus() * periods.genus(), matrix, capacity)?;
        let options = given.to_library()?;
        let _reserve = memory::work(forms.domain.mesh().n_vertices(), memory::UNIFORM)?;
        let bounds = within(threads, || period_bounds(forms, &options, &control))?;
        let g = bounds.matrix.len();
        let entry =
            |i: usize, j: usize| [bounds.matrix[i][j][0], bounds.matrix[i][j][1], bounds.radius(i, j)];
        let rows: Vec<[f64; 3]> =
            (0..g).flat_map(|i| (0..g).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        structs::write(figures_of(&bounds), summary, size)?;
        copy_out("matrix", &rows, matrix, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_fenchel_nielsen(
    uniform: *const ricci_uniform,
    coordinates: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let curves = fenchel_nielsen(&uniform.quotient()?.deck)?;
        copy_curves(&curves, coordinates, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_fenchel_nielsen_of_loops(
    uniform: *const ricci_uniform,
    edges: *const i32,
    starts: *const usize,
    n_loops: usize,
    control: *const ricci_control,
    coordinates: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let threads = control::threads(control);
        let (quotient, control) = (uniform.quotient()?, control::of(control)?);
        let mesh = quotient.metric.given();
        let starts: Vec<usize> = array("starts", starts, n_loops.saturating_add(1))?;
        if starts.first() != Some(&0) || starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(Failure::argument("starts must ascend from 0"));
        }
        let all: Vec<i32> = array("edges", edges, starts.last().copied().unwrap_or(0))?;
        let path = |row: &[usize]| halfedges_of(mesh, "edges", &all[row[0]..row[1]], row[0]);
        let loops: Vec<_> = starts.windows(2).map(path).collect::<Result<_, _>>()?;
        let _reserve = memory::work(mesh.n_vertices(), memory::UNIFORM)?;
        let curves = within(threads, || fenchel_nielsen_of_loops(quotient, &loops, &control))?;
        copy_curves(&curves, coordinates, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_pants(
    deck: *const ricci_deck,
    control: *const ricci_control,
    coordinates: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let threads = control::threads(control);
        let control = control::of(control)?;
        let limit = SpectrumOptions::default().limit;
        let _reserve = memory::work(limit.min(MOST_RESERVED), memory::ELEMENT)?;
        let words: Vec<Word> = deck.elements.iter().map(|element| element.word.clone()).collect();
        let curves = within(threads, || pants_of_words(&deck.quotient, &words, limit, &control))?;
        copy_curves(&curves, coordinates, capacity)
    })
}

fn copy_curves(curves: &[PantsCurve], coordinates: *mut f64, capacity: usize) -> Outcome {
    let rows: Vec<[f64; 2]> = curves.iter().map(|curve| [curve.length, curve.twist]).collect();
    copy_out("coordinates", &rows, coordinates, capacity)
}

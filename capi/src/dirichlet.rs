//! Dirichlet domains, and the copies around them.

use crate::arrays::{ambient, copy_out};
use crate::choice::name;
use crate::control::{self, ricci_control};
use crate::deck::ricci_deck;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::quotient::ricci_quotient;
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::canonical::Quotient;
use ricci::embed::cover::elements_within;
use ricci::embed::{DirichletDomain, dirichlet_domain};
use ricci::geometry::Space;
use std::sync::Arc;

/// The Dirichlet domain of a point in the universal cover: what is nearer to it than to its images under the deck group. A convex
/// polygon; each side lies on the bisector of the centre and its image under the side's element, which carries the domain onto its
/// neighbour there.
pub struct ricci_dirichlet {
    poison: Poison,
    quotient: Arc<Quotient>,
    domain: DirichletDomain,
}

handle!(ricci_dirichlet, "dirichlet domain");

/// Figures of a Dirichlet domain.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_dirichlet_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Where it lies.
    pub space: ricci_space,
    /// Number of sides, and of corners.
    pub n_sides: u32,
    /// Area of the polygon, from its sides and the rays to its corners: that of the surface.
    pub area: f64,
    /// Largest distance of a corner from the centre.
    pub radius: f64,
    /// Ambient coordinates of the centre.
    pub centre: [f64; 3],
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_dirichlet_summary, "summary");

/// A point of the space, from x and y.
fn centre_point(space: Space, centre: *const f64) -> Outcome<[f64; 3]> {
    let [x, y] = match ambient("centre", centre, usize::from(!centre.is_null()))?.first() {
        Some(&[x, y, _]) => [x, y],
        None => [0.0, 0.0],
    };
    let w = if space == Space::E2 { 1.0 } else { x.hypot(y).hypot(1.0) };
    if w.is_finite() { Ok([x, y, w]) } else { Err(Failure::argument("centre: too far out for doubles")) }
}

/// The Dirichlet domain of a point.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (the centre is not finite), RICCI_LAYOUT (none was found: the metric has not
/// converged, or the centre is too far out), RICCI_CANCELLED.
///
/// @param quotient   the quotient.
/// @param centre     3 entries, ambient coordinates, of which x and y count; NULL for the origin, where the base vertex is.
/// @param control    cancellation; NULL for none.
/// @param dirichlet  out: the new handle, to be released by ricci_dirichlet_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_new(
    quotient: *const ricci_quotient,
    centre: *const f64,
    control: *const ricci_control,
    dirichlet: *mut *mut ricci_dirichlet,
) -> ricci_status {
    guard::make("dirichlet", dirichlet, |door| {
        let quotient = door.shared(quotient)?.quotient.clone();
        let centre = centre_point(quotient.layout.space, centre)?;
        let domain = dirichlet_domain(&quotient.deck, centre, quotient.layout.area, &control::of(control))?;
        Ok(ricci_dirichlet { poison: Poison::default(), quotient, domain })
    })
}

/// Release a Dirichlet domain.
///
/// @param dirichlet  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_free(dirichlet: *mut ricci_dirichlet) {
    guard::free(dirichlet);
}

/// The figures of a Dirichlet domain.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param dirichlet  the domain.
/// @param summary    out: the figures.
/// @param size       sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_summarise(
    dirichlet: *const ricci_dirichlet,
    summary: *mut ricci_dirichlet_summary,
    size: usize,
) -> ricci_status {
    guard::with(dirichlet, |ricci_dirichlet { quotient, domain, .. }| {
        let figures = ricci_dirichlet_summary {
            size,
            space: name(quotient.deck.space)?,
            n_sides: domain.sides.len() as u32,
            area: domain.area,
            radius: domain.radius,
            centre: domain.centre,
        };
        sized::write(figures, summary, size)
    })
}

/// The corners of a Dirichlet domain, counterclockwise: side k runs from corner k to the next one.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param dirichlet  the domain.
/// @param corners    out: n_sides x 3, ambient coordinates.
/// @param capacity   entries of `corners`, at least 3 n_sides.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_corners(
    dirichlet: *const ricci_dirichlet,
    corners: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(dirichlet, |dirichlet| copy_out("corners", &dirichlet.domain.corners, corners, capacity))
}

/// The side with the inverse element, for every side.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param dirichlet  the domain.
/// @param partners   out: n_sides side numbers, 0-based.
/// @param capacity   entries of `partners`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_partners(
    dirichlet: *const ricci_dirichlet,
    partners: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let numbers: Vec<i32> = door.shared(dirichlet)?.domain.partner.iter().map(|&k| k as i32).collect();
        copy_out("partners", &numbers, partners, capacity)
    })
}

/// The elements of the sides.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param dirichlet  the domain.
/// @param deck       out: the new handle, n_sides elements, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_sides(
    dirichlet: *const ricci_dirichlet,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| {
        let ricci_dirichlet { quotient, domain, .. } = door.shared(dirichlet)?;
        Ok(ricci_deck::new(&quotient.deck, domain.sides.clone()))
    })
}

/// All deck transformations that move the centre of a Dirichlet domain by at most `radius`, each once, nearest first: the copies in a
/// round piece of the universal cover.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (the radius is NaN), RICCI_TOO_LARGE (more than `limit`), RICCI_CANCELLED.
///
/// @param dirichlet  the domain.
/// @param radius     largest distance.
/// @param limit      most elements that are looked at, a little more than those that are found.
/// @param control    cancellation; NULL for none.
/// @param deck       out: the new handle, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_cover_within(
    dirichlet: *const ricci_dirichlet,
    radius: f64,
    limit: usize,
    control: *const ricci_control,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| {
        let ricci_dirichlet { quotient, domain, .. } = door.shared(dirichlet)?;
        if radius.is_nan() {
            return Err(Failure::argument("radius is not a number"));
        }
        let elements = elements_within(&quotient.deck, domain, radius, limit, &control::of(control))?;
        Ok(ricci_deck::new(&quotient.deck, elements))
    })
}

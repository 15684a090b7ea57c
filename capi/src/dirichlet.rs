//! Dirichlet domains: the points of the universal cover that are nearest to a centre among its images.

use crate::arrays::{ambient, copy_each, copy_out};
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::mesh::SPACES;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use crate::uniformize::ricci_uniform;
use ricci::canonical::Quotient;
use ricci::embed::{DeckGroup, DirichletDomain, dirichlet_domain};
use ricci::geometry::Space;
use std::sync::Arc;

pub struct ricci_dirichlet {
    quotient: Arc<Quotient>,
    domain: DirichletDomain,
}
handle!(ricci_dirichlet, "dirichlet");

impl ricci_dirichlet {
    /// The domain, which must belong to this deck group.
    pub(crate) fn of(&self, group: &DeckGroup) -> Outcome<&DirichletDomain> {
        if std::ptr::eq(group, &self.quotient.deck) {
            return Ok(&self.domain);
        }
        Err(Failure::argument("this Dirichlet domain is of another surface"))
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_dirichlet_summary {
    pub size: usize,
    pub space: u32,
    pub n_sides: u32,
    pub area: f64,
    pub radius: f64,
    pub centre: [f64; 3],
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_dirichlet_summary, "summary");

/// The point of the space with the caller's coordinates x and y; the origin for NULL.
fn centre_point(space: Space, centre: *const f64) -> Outcome<[f64; 3]> {
    let [x, y] = match ambient("centre", centre, usize::from(!centre.is_null()))?.first() {
        Some(&[x, y, _]) => [x, y],
        None => [0.0, 0.0],
    };
    let w = if space == Space::E2 { 1.0 } else { x.hypot(y).hypot(1.0) };
    if w.is_finite() { Ok([x, y, w]) } else { Err(Failure::argument("centre: too far out for doubles")) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_new(
    uniform: *const ricci_uniform,
    centre: *const f64,
    control: *const ricci_control,
    dirichlet: *mut *mut ricci_dirichlet,
) -> ricci_status {
    guard::make(dirichlet, || {
        let quotient = shared(uniform)?.quotient()?.clone();
        let centre = centre_point(quotient.layout.space, centre)?;
        let domain = dirichlet_domain(&quotient.deck, centre, quotient.layout.area, &control::of(control)?)?;
        Ok(ricci_dirichlet { quotient, domain })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_free(dirichlet: *mut ricci_dirichlet) {
    guard::free(dirichlet);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_summarise(
    dirichlet: *const ricci_dirichlet,
    summary: *mut ricci_dirichlet_summary,
    size: usize,
) -> ricci_status {
    guard::with(dirichlet, |ricci_dirichlet { quotient, domain }| {
        let figures = ricci_dirichlet_summary {
            size,
            space: SPACES.number(quotient.deck.space)?,
            n_sides: domain.sides.len() as u32,
            area: domain.area,
            radius: domain.radius,
            centre: domain.centre,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_corners(
    dirichlet: *const ricci_dirichlet,
    corners: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(dirichlet, |dirichlet| copy_out("corners", &dirichlet.domain.corners, corners, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_dirichlet_partners(
    dirichlet: *const ricci_dirichlet,
    partners: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(dirichlet, |ricci_dirichlet { domain, .. }| {
        let numbers = domain.partner.iter().map(|partner| partner.map_or(-1, |k| k as i32));
        copy_each("partners", domain.partner.len(), numbers, partners, capacity)
    })
}

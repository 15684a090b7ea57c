//! Fundamental domains: a surface opened along a cut to a disk.

use crate::arrays::{CallerBuffer, array, check_buffer, copy_each, copy_rows};
use crate::failure::{FailureElement, no_such};
use crate::guard::{self, handle, shared};
use crate::homotopy::ricci_homotopy;
use crate::paths::{copy_paths, letters, signed_edge};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::mesh::{EdgeId, PerEdge};
use ricci::topology::FundamentalDomain;

pub struct ricci_domain(pub(crate) FundamentalDomain);
handle!(ricci_domain, "domain");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_domain_summary {
    pub size: usize,
    pub n_sides: usize,
    pub n_side_edges: usize,
    pub n_side_letters: usize,
    pub n_corner_letters: usize,
    pub base_edge: i64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_domain_summary, "summary");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_new(
    homotopy: *const ricci_homotopy,
    cut: *const u32,
    n_cut: usize,
    domain: *mut *mut ricci_domain,
) -> ricci_status {
    guard::make(domain, || {
        let ricci_homotopy { mesh, basis } = shared(homotopy)?;
        let is_cut = if cut.is_null() && n_cut == 0 {
            basis.cut(mesh)
        } else {
            let mut is_cut = PerEdge::filled(mesh.n_edges(), false);
            for e in array("cut", cut, n_cut)? {
                if e as usize >= mesh.n_edges() {
                    return Err(no_such(FailureElement::Edge, "edge", e as usize, mesh.n_edges()));
                }
                is_cut[EdgeId(e)] = true;
            }
            is_cut
        };
        Ok(ricci_domain(FundamentalDomain::new(mesh, &is_cut, basis)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_free(domain: *mut ricci_domain) {
    guard::free(domain);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_summarise(
    domain: *const ricci_domain,
    summary: *mut ricci_domain_summary,
    size: usize,
) -> ricci_status {
    guard::with(domain, |ricci_domain(domain)| {
        let figures = ricci_domain_summary {
            size,
            n_sides: domain.sides.len(),
            n_side_edges: domain.sides.iter().map(|side| side.halfedges.len()).sum(),
            n_side_letters: domain.sides.iter().map(|side| side.element.len()).sum(),
            n_corner_letters: domain.corners.iter().map(|corner| corner.element.len()).sum(),
            base_edge: signed_edge(domain.base_corner).into(),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_sides(
    domain: *const ricci_domain,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_domain(domain)| {
        let sides = domain.sides.iter().map(|side| &side.halfedges);
        copy_paths(sides, CallerBuffer(edges, edges_capacity), CallerBuffer(starts, starts_capacity))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_partners(
    domain: *const ricci_domain,
    partners: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_domain(domain)| {
        let numbers = domain.sides.iter().map(|side| side.partner.map_or(-1, |k| k as i32));
        copy_each("partners", domain.sides.len(), numbers, partners, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_elements(
    domain: *const ricci_domain,
    words: *mut i32,
    words_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_domain(domain)| {
        let rows = domain.sides.iter().map(|side| letters(&side.element));
        copy_rows("words", rows, CallerBuffer(words, words_capacity), CallerBuffer(starts, starts_capacity))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_corners(
    domain: *const ricci_domain,
    vertices: *mut u32,
    vertices_capacity: usize,
    words: *mut i32,
    words_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_domain(domain)| {
        let corners = &domain.corners;
        check_buffer("vertices", corners.len(), vertices, vertices_capacity)?;
        let rows = corners.iter().map(|corner| letters(&corner.element));
        copy_rows("words", rows, CallerBuffer(words, words_capacity), CallerBuffer(starts, starts_capacity))?;
        let names = corners.iter().map(|corner| corner.vertex.0);
        copy_each("vertices", corners.len(), names, vertices, vertices_capacity)
    })
}

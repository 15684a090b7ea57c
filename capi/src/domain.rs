//! Fundamental domains: a surface opened along a cut.

use crate::arrays::{array, copy_out, copy_rows};
use crate::edges::{copy_paths, signed_edge};
use crate::failure::Failure;
use crate::guard::{self, Poison, handle};
use crate::homotopy::ricci_homotopy;
use crate::letters;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::mesh::{EdgeId, PerEdge};
use ricci::topology::FundamentalDomain;

/// A surface opened along a cut into a disk, lifted to the universal cover: a polygon whose sides are paired by deck transformations.
pub struct ricci_domain {
    poison: Poison,
    domain: FundamentalDomain,
}

handle!(ricci_domain, "domain");

impl ricci_domain {
    pub(crate) fn new(domain: FundamentalDomain) -> ricci_domain {
        ricci_domain { poison: Poison::default(), domain }
    }
}

/// Figures of a fundamental domain.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_domain_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Number of sides, and of corners.
    pub n_sides: usize,
    /// Number of edges of all sides.
    pub n_side_edges: usize,
    /// Number of letters of all sides' words.
    pub n_side_letters: usize,
    /// Number of letters of all corners' words.
    pub n_corner_letters: usize,
    /// A half-edge of a face of the domain that starts at the base lift, as a signed edge number.
    pub base_edge: i64,
}

// SAFETY: integers of 8 bytes, size first.
sized!(ricci_domain_summary, "summary");

/// The fundamental domain of a cut, one of those that have a corner at the base lift.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such edge), RICCI_LAYOUT (the cut does not leave a disk).
///
/// @param homotopy  names lifts and deck transformations.
/// @param cut       n_cut edges, 0-based, that open the surface into a disk; NULL for those of the basis's own polygon.
/// @param n_cut     number of edges.
/// @param domain    out: the new handle, to be released by ricci_domain_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_new(
    homotopy: *const ricci_homotopy,
    cut: *const u32,
    n_cut: usize,
    domain: *mut *mut ricci_domain,
) -> ricci_status {
    guard::make("domain", domain, |door| {
        let ricci_homotopy { mesh, basis, .. } = door.shared(homotopy)?;
        let is_cut = if cut.is_null() && n_cut == 0 {
            basis.cut(mesh)
        } else {
            let mut is_cut = PerEdge::filled(mesh.n_edges(), false);
            for e in array("cut", cut, n_cut)? {
                if e as usize >= mesh.n_edges() {
                    let n = mesh.n_edges();
                    return Err(Failure::argument(format!("edge {e} does not exist: there are {n}")));
                }
                is_cut[EdgeId(e)] = true;
            }
            is_cut
        };
        Ok(ricci_domain::new(FundamentalDomain::new(mesh, &is_cut, basis)?))
    })
}

/// Release a fundamental domain.
///
/// @param domain  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_free(domain: *mut ricci_domain) {
    guard::free(domain);
}

/// The figures of a fundamental domain.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param domain   the domain.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_summarise(
    domain: *const ricci_domain,
    summary: *mut ricci_domain_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let domain = &door.shared(domain)?.domain;
        let figures = ricci_domain_summary {
            size,
            n_sides: domain.sides.len(),
            n_side_edges: domain.sides.iter().map(|side| side.halfedges.len()).sum(),
            n_side_letters: domain.sides.iter().map(|side| side.element.len()).sum(),
            n_corner_letters: domain.corners.iter().map(|corner| corner.element.len()).sum(),
            base_edge: signed_edge(domain.base_corner).into(),
        };
        sized::write(figures, summary, size)
    })
}

/// The edges of every side, counterclockwise: the domain lies on their left.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param domain           the domain.
/// @param edges            out: n_side_edges edge numbers, 1-based, negative against the edge's direction; side after side.
/// @param edges_capacity   entries of `edges`.
/// @param starts           out: n_sides + 1 offsets: side i is edges[starts[i] .. starts[i + 1]).
/// @param starts_capacity  entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_sides(
    domain: *const ricci_domain,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let sides = &door.shared(domain)?.domain.sides;
        copy_paths(
            sides.iter().map(|side| &side.halfedges),
            (edges, edges_capacity),
            (starts, starts_capacity),
        )
    })
}

/// The side with the same edges, run through the other way.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param domain    the domain.
/// @param partners  out: n_sides side numbers, 0-based; -1 on the boundary of the surface.
/// @param capacity  entries of `partners`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_partners(
    domain: *const ricci_domain,
    partners: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let sides = &door.shared(domain)?.domain.sides;
        let numbers: Vec<i32> = sides.iter().map(|side| side.partner.map_or(-1, |k| k as i32)).collect();
        copy_out("partners", &numbers, partners, capacity)
    })
}

/// The deck transformation of every side: it carries the side's partner onto it, and the domain onto its neighbour there.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param domain            the domain.
/// @param letters           out: n_side_letters letters, word after word; the partner's element is the inverse.
/// @param letters_capacity  entries of `letters`.
/// @param starts            out: n_sides + 1 offsets: the word of side i is letters[starts[i] .. starts[i + 1]).
/// @param starts_capacity   entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_elements(
    domain: *const ricci_domain,
    letters: *mut i32,
    letters_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let sides = &door.shared(domain)?.domain.sides;
        let rows = sides.iter().map(|side| letters::letters(&side.element));
        copy_rows("letters", rows, (letters, letters_capacity), (starts, starts_capacity))
    })
}

/// The lifts at which the sides start (ricci_homotopy_lift): vertices and deck transformations.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param domain             the domain.
/// @param vertices           out: n_sides vertices.
/// @param vertices_capacity  entries of `vertices`.
/// @param letters            out: n_corner_letters letters, word after word.
/// @param letters_capacity   entries of `letters`.
/// @param starts             out: n_sides + 1 offsets: the word of corner i is letters[starts[i] .. starts[i + 1]).
/// @param starts_capacity    entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_domain_corners(
    domain: *const ricci_domain,
    vertices: *mut u32,
    vertices_capacity: usize,
    letters: *mut i32,
    letters_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let corners = &door.shared(domain)?.domain.corners;
        let names: Vec<u32> = corners.iter().map(|corner| corner.vertex.0).collect();
        crate::arrays::check_buffer("vertices", names.len(), vertices, vertices_capacity)?;
        let rows = corners.iter().map(|corner| letters::letters(&corner.element));
        copy_rows("letters", rows, (letters, letters_capacity), (starts, starts_capacity))?;
        copy_out("vertices", &names, vertices, vertices_capacity)
    })
}

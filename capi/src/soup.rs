//! Triangle lists, which may have defects: reading, diagnosis, repair, writing.

use crate::arrays::{self, CallerBuffer, check_buffer, copy_out, copy_rows};
use crate::control;
use crate::defect_texts::{DefectTexts, ricci_defect};
use crate::failure::{Failure, FailureElement, Outcome, no_such};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::{MeshValue, VALUES, copy_attribute, count, ricci_attributes, ricci_mesh};
use crate::soup_cache::SoupLists;
use crate::soup_file::{read_soup, write_soup};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::mesh::check::{Diagnosis, diagnose};
use ricci::mesh::holes::{Filling, HoleChoice};
use ricci::mesh::io::{PolygonTriangles, Soup};
use ricci::mesh::repair::{Repair, RepairSteps, Repaired, repair};
use ricci::mesh::{Place, RefinedSoup};
use std::ffi::c_char;
use std::sync::OnceLock;

pub struct ricci_soup {
    pub(crate) soup: Soup,
    /// The record of the repair, if this list was repaired: origins of its elements and counts of the steps. Its own `soup` is empty.
    origin: Option<Repaired>,
    /// Where its elements lie in the list that it was refined from, if it was; its own `soup` is empty.
    finer: Option<RefinedSoup>,
    /// The polygon that each face is a part of, if the list was made of polygons.
    polygons: Option<Vec<u32>>,
    diagnosis: OnceLock<DiagnosisTexts>,
    pub(crate) lists: SoupLists,
}
handle!(ricci_soup, "soup", |list| list.soup.positions.len().max(list.soup.faces.len()));

/// The diagnosis of a triangle list, with the texts of the defects as C strings.
struct DiagnosisTexts {
    diagnosis: Diagnosis,
    defects: Vec<DefectTexts>,
    hints: Vec<DefectTexts>,
}

impl ricci_soup {
    pub(crate) fn new(soup: Soup) -> ricci_soup {
        ricci_soup {
            soup,
            origin: None,
            finer: None,
            polygons: None,
            diagnosis: OnceLock::new(),
            lists: SoupLists::default(),
        }
    }

    /// A refined list.
    pub(crate) fn refined(mut finer: RefinedSoup) -> ricci_soup {
        let soup = std::mem::take(&mut finer.soup);
        ricci_soup { finer: Some(finer), ..ricci_soup::new(soup) }
    }

    /// The triangles of polygons.
    pub(crate) fn of_polygons(found: PolygonTriangles) -> ricci_soup {
        ricci_soup { polygons: Some(found.polygon), ..ricci_soup::new(found.soup) }
    }

    /// For each face the polygon that it is a part of.
    pub(crate) fn polygons(&self) -> Outcome<&[u32]> {
        let polygons = self.polygons.as_deref();
        polygons.ok_or_else(|| Failure::argument("this triangle list was not made of polygons"))
    }

    /// For each face of a refined list its face, and for each vertex its place, in the list that it was made from.
    pub(crate) fn places(&self) -> Outcome<(&[u32], &[Option<Place>])> {
        let finer = self.finer.as_ref();
        let finer = finer.ok_or_else(|| Failure::argument("this triangle list was not refined"))?;
        Ok((&finer.face_origin, &finer.vertex_place))
    }

    fn diagnosis(&self) -> &DiagnosisTexts {
        self.diagnosis.get_or_init(|| {
            let diagnosis = match &self.origin {
                Some(done) => done.diagnosis.clone(),
                None => diagnose(&self.soup.positions, &self.soup.faces),
            };
            let defects = diagnosis.defects.iter().map(DefectTexts::of_defect).collect();
            let hints = diagnosis.hints.iter().map(DefectTexts::of_hint).collect();
            DiagnosisTexts { diagnosis, defects, hints }
        })
    }

    /// The loops of which a repair made a choice.
    pub(crate) fn filling(&self) -> Outcome<&Filling> {
        Ok(&self.origin()?.filling)
    }

    fn origin(&self) -> Outcome<&Repaired> {
        self.origin.as_ref().ok_or_else(|| Failure::argument("this triangle list was not repaired"))
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_soup_summary {
    pub size: usize,
    pub n_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub n_defects: usize,
    pub n_components: usize,
    pub n_boundary_loops: usize,
    pub euler: i64,
    pub genus: i64,
    pub n_normals: usize,
    pub n_colors: usize,
    pub n_uv: usize,
    pub n_corner_normals: usize,
    pub welded_vertices: usize,
    pub degenerate_faces: usize,
    pub duplicate_faces: usize,
    pub cut_edges: usize,
    pub split_vertices: usize,
    pub turned_faces: usize,
    pub faces_of_other_components: usize,
    pub isolated_vertices: usize,
    pub refused_edges: usize,
    pub refused_faces: usize,
    pub non_finite_faces: usize,
    pub joined_t_junctions: usize,
    pub collapsed_edges: usize,
    pub flipped_edges: usize,
    pub opened_faces: usize,
    pub filled_holes: usize,
    pub open_holes: usize,
    pub n_hints: usize,
    pub n_loops: usize,
    pub n_loop_vertices: usize,
    pub n_vertex_numbers: usize,
    pub n_face_numbers: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_soup_summary, "summary");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_repair_options {
    pub size: usize,
    pub weld: f64,
    pub component: usize,
    pub cut_non_manifold_edges: u32,
    pub drop_non_finite: u32,
    pub split_t_junctions: u32,
    pub mend_zero_area: u32,
    pub fill_holes: usize,
    pub holes: *const u32,
    pub n_holes: usize,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_repair_options, "options");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_from_arrays(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    soup: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(soup, || {
        let positions = arrays::points(positions, stride, n_vertices)?;
        Ok(ricci_soup::new(Soup::new(positions, arrays::array("faces", faces.cast(), n_faces)?)))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_with_attributes(
    soup: *const ricci_soup,
    attributes: *const ricci_attributes,
    result: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(result, || {
        let soup = &shared(soup)?.soup;
        if attributes.is_null() {
            return Err(Failure::null("attributes"));
        }
        let given = structs::read(attributes)?;
        if !given.png.is_null() {
            return Err(Failure::argument(
                "png is written into a file, it is no attribute of a triangle list",
            ));
        }
        let attributes = given.of(soup)?;
        Ok(ricci_soup::new(Soup { attributes, ..Soup::new(soup.positions.clone(), soup.faces.clone()) }))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_read(path: *const c_char, soup: *mut *mut ricci_soup) -> ricci_status {
    guard::make(soup, || {
        let path = arrays::path(path)?;
        Ok(ricci_soup::new(read_soup(&path)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_free(soup: *mut ricci_soup) {
    guard::free(soup);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_summarise(
    soup: *const ricci_soup,
    summary: *mut ricci_soup_summary,
    size: usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let Diagnosis { components, euler, boundary_loops, genus, edges, defects, .. } =
            &list.diagnosis().diagnosis;
        let [n_normals, n_colors, n_uv, n_corner_normals] = count(&list.soup.attributes);
        let steps = list.origin.as_ref().map_or_else(RepairSteps::default, |done| done.steps);
        let refused = list.origin.as_ref().map_or(&[][..], |done| &done.weld_refused);
        let [filled_holes, open_holes] =
            list.origin.as_ref().map_or([0; 2], |done| [done.filling.filled.len(), done.filling.open.len()]);
        let rims = list.lists.rims(&list.soup);
        let figures = ricci_soup_summary {
            size,
            n_vertices: list.soup.positions.len(),
            n_edges: *edges,
            n_faces: list.soup.faces.len(),
            n_defects: defects.len(),
            n_components: *components,
            n_boundary_loops: *boundary_loops,
            euler: *euler,
            genus: genus.map_or(-1, |genus| genus as i64),
            n_normals,
            n_colors,
            n_uv,
            n_corner_normals,
            welded_vertices: steps.welded_vertices,
            degenerate_faces: steps.degenerate_faces,
            duplicate_faces: steps.duplicate_faces,
            cut_edges: steps.cut_edges,
            split_vertices: steps.split_vertices,
            turned_faces: steps.turned_faces,
            faces_of_other_components: steps.faces_of_other_components,
            isolated_vertices: steps.isolated_vertices,
            refused_edges: refused.len(),
            refused_faces: refused.iter().map(|edge| edge.faces.len()).sum(),
            non_finite_faces: steps.non_finite_faces,
            joined_t_junctions: steps.joined_t_junctions,
            collapsed_edges: steps.collapsed_edges,
            flipped_edges: steps.flipped_edges,
            opened_faces: steps.opened_faces,
            filled_holes,
            open_holes,
            n_hints: list.diagnosis().hints.len(),
            n_loops: rims.len(),
            n_loop_vertices: rims.iter().map(|rim| rim.vertices.len()).sum(),
            n_vertex_numbers: list.soup.attributes.vertex_numbers.len(),
            n_face_numbers: list.soup.attributes.face_numbers.len(),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_values(
    soup: *const ricci_soup,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(soup, |list| match VALUES.choose(which)? {
        MeshValue::Positions => copy_out("positions", &list.soup.positions, values, capacity),
        which => copy_attribute(which, &list.soup.attributes, values, capacity),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_faces(
    soup: *const ricci_soup,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(soup, |list| copy_out("faces", &list.soup.faces, faces, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_defect(
    soup: *const ricci_soup,
    index: usize,
    defect: *mut ricci_defect,
    size: usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let defects = &list.diagnosis().defects;
        let record = defects
            .get(index)
            .ok_or_else(|| no_such(FailureElement::Entry, "defect", index, defects.len()))?;
        structs::write(record.view(size), defect, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_hint(
    soup: *const ricci_soup,
    index: usize,
    hint: *mut ricci_defect,
    size: usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let hints = &list.diagnosis().hints;
        let record =
            hints.get(index).ok_or_else(|| no_such(FailureElement::Entry, "hint", index, hints.len()))?;
        structs::write(record.view(size), hint, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_mesh(
    soup: *const ricci_soup,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || ricci_mesh::from_soup(shared(soup)?.soup.clone()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_write(soup: *const ricci_soup, path: *const c_char) -> ricci_status {
    guard::with(soup, |list| write_soup(&arrays::path(path)?, &list.soup))
}

/// The library's options for those of a caller.
fn repair_options(given: &ricci_repair_options) -> Outcome<Repair> {
    let flag = |name: &str, value: u32| match value {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(Failure::argument(format!("{name} is {other}: 0 or 1"))),
    };
    let named: Vec<u32> = arrays::array("holes", given.holes, given.n_holes)?;
    let holes = match given.fill_holes {
        0 if named.is_empty() => HoleChoice::Nothing,
        0 => HoleChoice::Through(named),
        _ if !named.is_empty() => {
            return Err(Failure::argument("fill_holes and holes: give one of them".to_string()));
        }
        usize::MAX => HoleChoice::All,
        most => HoleChoice::UpTo(most),
    };
    Ok(Repair {
        // The library refuses NaN as a tolerance, with a message.
        weld: (given.weld.is_nan() || given.weld >= 0.0).then_some(given.weld),
        component: given.component.checked_sub(1),
        cut_non_manifold_edges: flag("cut_non_manifold_edges", given.cut_non_manifold_edges)?,
        drop_non_finite: flag("drop_non_finite", given.drop_non_finite)?,
        split_t_junctions: flag("split_t_junctions", given.split_t_junctions)?,
        mend_zero_area: flag("mend_zero_area", given.mend_zero_area)?,
        holes,
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_repair(
    soup: *const ricci_soup,
    options: *const ricci_repair_options,
    repaired: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(repaired, || {
        let control = control::of_thread()?;
        let options = repair_options(&structs::read(options)?)?;
        let soup = &shared(soup)?.soup;
        let _reserve = memory::work(soup.positions.len().max(soup.faces.len()), memory::MESH)?;
        let mut done = repair(soup, &options, &control)?;
        let result = std::mem::take(&mut done.soup);
        Ok(ricci_soup { origin: Some(done), ..ricci_soup::new(result) })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_origins(
    repaired: *const ricci_soup,
    vertices: *mut u32,
    vertices_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
) -> ricci_status {
    guard::with(repaired, |list| {
        let done = list.origin()?;
        check_buffer("faces", done.face_origin.len(), faces, faces_capacity)?;
        copy_out("vertices", &done.vertex_origin, vertices, vertices_capacity)?;
        copy_out("faces", &done.face_origin, faces, faces_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_refused(
    repaired: *const ricci_soup,
    vertices: *mut u32,
    vertices_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(repaired, |list| {
        let refused = &list.origin()?.weld_refused;
        let ends: Vec<u32> = refused.iter().flat_map(|edge| edge.vertices).collect();
        check_buffer("vertices", ends.len(), vertices, vertices_capacity)?;
        let rows = refused.iter().map(|edge| edge.faces.iter().copied());
        copy_rows("faces", rows, CallerBuffer(faces, faces_capacity), CallerBuffer(starts, starts_capacity))?;
        copy_out("vertices", &ends, vertices, vertices_capacity)
    })
}

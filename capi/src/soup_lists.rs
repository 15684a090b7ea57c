//! Lists that a triangle list has beside its defects: boundary loops, sharp edges, corners, holes of a repair, names of faces, further
//! numbers.

use crate::arrays::{CallerBuffer, check_buffer, copy_counted, copy_each, copy_out, copy_rows};
use crate::choice::choices;
use crate::failure::{Failure, FailureElement, Outcome, no_such};
use crate::guard::{self, output};
use crate::soup::ricci_soup;
use crate::soup_cache::LABELS;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::mesh::check::Features;
use ricci::mesh::io::{Attributes, NumberColumn};
use std::ffi::{CStr, c_char};

choices!(enum NumbersOf, NUMBERS_OF = "of", [
    RICCI_OF_VERTICES => Vertices,
    RICCI_OF_FACES => Faces,
]);

/// Further numbers of an element kind.
fn numbers(attributes: &Attributes, of: NumbersOf) -> &[NumberColumn] {
    match of {
        NumbersOf::Vertices => &attributes.vertex_numbers,
        NumbersOf::Faces => &attributes.face_numbers,
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_hole {
    pub size: usize,
    pub reason: *const c_char,
    pub n_edges: usize,
    pub first_face: usize,
    pub n_faces: usize,
    pub first_vertex: usize,
    pub n_vertices: usize,
    pub length: f64,
    pub area: f64,
    pub vertex: u32,
    pub filled: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_hole, "hole");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_loops(
    soup: *const ricci_soup,
    lengths: *mut f64,
    lengths_capacity: usize,
    vertices: *mut u32,
    vertices_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let rims = list.lists.rims(&list.soup);
        check_buffer("lengths", rims.len(), lengths, lengths_capacity)?;
        let rows = rims.iter().map(|rim| rim.vertices.iter().copied());
        let to = CallerBuffer(vertices, vertices_capacity);
        copy_rows("vertices", rows, to, CallerBuffer(starts, starts_capacity))?;
        copy_each("lengths", rims.len(), rims.iter().map(|rim| rim.length), lengths, lengths_capacity)
    })
}

/// The features of a triangle list at an angle in radians.
fn features(list: &ricci_soup, angle: f64) -> Outcome<Features> {
    if !(angle > 0.0 && angle <= std::f64::consts::PI) {
        return Err(Failure::argument(format!("angle is {angle}: more than 0 and at most pi")));
    }
    Ok(Features::new(&list.soup.positions, &list.soup.faces, angle))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_sharp_edges(
    soup: *const ricci_soup,
    angle: f64,
    vertices: *mut u32,
    vertices_capacity: usize,
    angles: *mut f64,
    angles_capacity: usize,
    n_edges: *mut usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let edges = features(list, angle)?.edges;
        let ends: Vec<u32> = edges.iter().flat_map(|edge| edge.vertices).collect();
        let turns: Vec<f64> = edges.iter().map(|edge| edge.angle).collect();
        let count = output("the place for the number of edges", n_edges)?;
        let is_question = vertices.is_null() && vertices_capacity == 0;
        if !is_question {
            check_buffer("angles", turns.len(), angles, angles_capacity)?;
            copy_out("vertices", &ends, vertices, vertices_capacity)?;
            copy_out("angles", &turns, angles, angles_capacity)?;
        }
        count.set(edges.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_corners(
    soup: *const ricci_soup,
    angle: f64,
    vertices: *mut u32,
    capacity: usize,
    n_corners: *mut usize,
) -> ricci_status {
    guard::with(soup, |list| {
        copy_counted("vertices", &features(list, angle)?.corners, vertices, capacity, n_corners)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_hole(
    repaired: *const ricci_soup,
    index: usize,
    hole: *mut ricci_hole,
    size: usize,
) -> ricci_status {
    guard::with(repaired, |list| {
        let filling = list.filling()?;
        let n_filled = filling.filled.len();
        let none = ricci_hole {
            size,
            reason: c"filled".as_ptr(),
            n_edges: 0,
            first_face: 0,
            n_faces: 0,
            first_vertex: 0,
            n_vertices: 0,
            length: f64::NAN,
            area: f64::NAN,
            vertex: 0,
            filled: 0,
        };
        let figures = if let Some(found) = filling.filled.get(index) {
            ricci_hole {
                n_edges: found.edges,
                first_face: found.faces.start as usize,
                n_faces: found.faces.len(),
                first_vertex: found.vertices.start as usize,
                n_vertices: found.vertices.len(),
                length: found.length,
                area: found.area,
                vertex: found.vertex,
                filled: 1,
                ..none
            }
        } else if let Some(found) = index.checked_sub(n_filled).and_then(|k| filling.open.get(k)) {
            let reason = list.lists.reason(filling, index - n_filled).map_or(none.reason, CStr::as_ptr);
            ricci_hole { reason, n_edges: found.edges, vertex: found.vertex, ..none }
        } else {
            return Err(no_such(FailureElement::Entry, "hole", index, n_filled + filling.open.len()));
        };
        structs::write(figures, hole, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_labels(
    soup: *const ricci_soup,
    which: u32,
    numbers: *mut u32,
    capacity: usize,
    n_names: *mut usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let found = list.lists.names(&list.soup, LABELS.choose(which)?);
        let count = output("the place for the number of names", n_names)?;
        if !numbers.is_null() || capacity > 0 {
            copy_out("numbers", &found.of_face, numbers, capacity)?;
        }
        count.set(found.names.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_label(
    soup: *const ricci_soup,
    which: u32,
    index: usize,
    name: *mut c_char,
    capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let names = &list.lists.names(&list.soup, LABELS.choose(which)?).names;
        let found = names.get(index);
        let found = found.ok_or_else(|| no_such(FailureElement::Entry, "name", index, names.len()))?;
        let mut bytes = found.replace('\0', "\u{fffd}").into_bytes();
        bytes.push(0);
        copy_counted("name", &bytes, name.cast(), capacity, n_bytes)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_numbers(
    soup: *const ricci_soup,
    of: u32,
    index: usize,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(soup, |list| {
        let columns = numbers(&list.soup.attributes, NUMBERS_OF.choose(of)?);
        let missing = || no_such(FailureElement::Entry, "numbers", index, columns.len());
        copy_out("values", &columns.get(index).ok_or_else(missing)?.values, values, capacity)
    })
}

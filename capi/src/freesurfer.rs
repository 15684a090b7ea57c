//! Data at the vertices of surfaces in the files of FreeSurfer: values, labels, annotations, patches.

use crate::arrays::{self, check_buffer, copy_counted, copy_out, text};
use crate::data_file::{read, write};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, output};
use crate::status::ricci_status;
use ricci::mesh::io::freesurfer::{
    Annotation, AnnotationEntry, SurfacePatch, VertexLabel, annotation_bytes, label_text, parse_annotation,
    parse_label, parse_patch, parse_values, patch_bytes, values_bytes,
};
use std::ffi::c_char;

/// The region of a vertex in none, and the vertex of a point of the volume.
const NONE: i32 = -1;

/// Checks that a buffer that is asked for has room.
fn asked<T>(what: &str, n: usize, buffer: *mut T, capacity: usize) -> Outcome<bool> {
    if buffer.is_null() && capacity == 0 {
        return Ok(false);
    }
    check_buffer(what, n, buffer, capacity)?;
    Ok(true)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_values_read(
    path: *const c_char,
    values: *mut f64,
    capacity: usize,
    n: *mut usize,
) -> ricci_status {
    guard::call(|| {
        let (bytes, name) = read(path)?;
        copy_counted("values", &parse_values(&bytes, &name)?, values, capacity, n)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_values_write(
    path: *const c_char,
    values: *const f64,
    n: usize,
    n_faces: usize,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let values: Vec<f64> = arrays::array("values", values, n)?;
        write(&path, values_bytes(&values, n_faces)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_label_read(
    path: *const c_char,
    vertices: *mut i32,
    vertices_capacity: usize,
    positions: *mut f64,
    positions_capacity: usize,
    values: *mut f64,
    values_capacity: usize,
    n: *mut usize,
) -> ricci_status {
    guard::call(|| {
        let (bytes, name) = read(path)?;
        let label = parse_label(&String::from_utf8_lossy(&bytes), &name)?;
        let count = output("the place for the number of entries", n)?;
        let m = label.vertices.len();
        let numbers: Vec<i32> = label.vertices.iter().map(|v| v.map_or(NONE, |v| v as i32)).collect();
        let wanted = [
            asked("vertices", m, vertices, vertices_capacity)?,
            asked("positions", 3 * m, positions, positions_capacity)?,
            asked("values", m, values, values_capacity)?,
        ];
        if wanted[0] {
            copy_out("vertices", &numbers, vertices, vertices_capacity)?;
        }
        if wanted[1] {
            copy_out("positions", &label.positions, positions, positions_capacity)?;
        }
        if wanted[2] {
            copy_out("values", &label.values, values, values_capacity)?;
        }
        count.set(m);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_label_write(
    path: *const c_char,
    comment: *const c_char,
    vertices: *const i32,
    positions: *const f64,
    values: *const f64,
    n: usize,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let numbers: Vec<i32> = arrays::array("vertices", vertices, n)?;
        let zeros = |given: bool, width: usize| if given { Vec::new() } else { vec![0.0; width * n] };
        let mut positions_of =
            arrays::array("positions", positions, if positions.is_null() { 0 } else { 3 * n })?;
        positions_of.extend(zeros(!positions.is_null(), 3));
        let mut values_of = arrays::array("values", values, if values.is_null() { 0 } else { n })?;
        values_of.extend(zeros(!values.is_null(), 1));
        let label = VertexLabel {
            comment: if comment.is_null() { String::new() } else { text("comment", comment)?.into() },
            vertices: numbers.into_iter().map(|v| u32::try_from(v).ok()).collect(),
            positions: positions_of.as_chunks::<3>().0.to_vec(),
            values: values_of,
        };
        write(&path, label_text(&label)?.into_bytes())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_patch_read(
    path: *const c_char,
    vertices: *mut u32,
    vertices_capacity: usize,
    positions: *mut f64,
    positions_capacity: usize,
    is_border: *mut u32,
    is_border_capacity: usize,
    n: *mut usize,
) -> ricci_status {
    guard::call(|| {
        let (bytes, name) = read(path)?;
        let patch = parse_patch(&bytes, &name)?;
        let count = output("the place for the number of entries", n)?;
        let m = patch.vertices.len();
        let border: Vec<u32> = patch.is_border.iter().map(|&border| border.into()).collect();
        let wanted = [
            asked("vertices", m, vertices, vertices_capacity)?,
            asked("positions", 3 * m, positions, positions_capacity)?,
            asked("is_border", m, is_border, is_border_capacity)?,
        ];
        if wanted[0] {
            copy_out("vertices", &patch.vertices, vertices, vertices_capacity)?;
        }
        if wanted[1] {
            copy_out("positions", &patch.positions, positions, positions_capacity)?;
        }
        if wanted[2] {
            copy_out("is_border", &border, is_border, is_border_capacity)?;
        }
        count.set(m);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_patch_write(
    path: *const c_char,
    vertices: *const u32,
    positions: *const f64,
    is_border: *const u32,
    n: usize,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let border: Vec<u32> = arrays::array("is_border", is_border, n)?;
        let patch = SurfacePatch {
            vertices: arrays::array("vertices", vertices, n)?,
            positions: arrays::array::<[f64; 3]>("positions", positions.cast(), n)?,
            is_border: border.into_iter().map(|border| border != 0).collect(),
        };
        write(&path, patch_bytes(&patch)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_annotation_read(
    path: *const c_char,
    regions: *mut i32,
    regions_capacity: usize,
    n: *mut usize,
    colors: *mut u32,
    colors_capacity: usize,
    names: *mut c_char,
    names_capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::call(|| {
        let (bytes, name) = read(path)?;
        let found = parse_annotation(&bytes, &name)?;
        let count = output("the place for the number of vertices", n)?;
        let [length, m] = [found.regions.len(), found.entries.len()];
        let numbers: Vec<i32> = found.regions.iter().map(|k| k.map_or(NONE, |k| k as i32)).collect();
        let rows: Vec<[u32; 4]> = found.entries.iter().map(|entry| entry.color.map(u32::from)).collect();
        let mut words: String = found.entries.iter().map(|entry| entry.name.clone() + "\n").collect();
        words.push('\0');
        let with_regions = asked("regions", length, regions, regions_capacity)?;
        let with_colors = asked("colors", 4 * m, colors, colors_capacity)?;
        copy_counted("names", words.as_bytes(), names.cast(), names_capacity, n_bytes)?;
        if with_regions {
            copy_out("regions", &numbers, regions, regions_capacity)?;
        }
        if with_colors {
            copy_out("colors", &rows, colors, colors_capacity)?;
        }
        count.set(length);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_annotation_write(
    path: *const c_char,
    regions: *const i32,
    n: usize,
    names: *const c_char,
    colors: *const u32,
    n_regions: usize,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let numbers: Vec<i32> = arrays::array("regions", regions, n)?;
        let rows = arrays::array::<[u32; 4]>("colors", colors.cast(), n_regions)?;
        let words: Vec<&str> = text("names", names)?.lines().collect();
        if words.len() != n_regions {
            let why = format!("names has {} lines for {n_regions} regions", words.len());
            return Err(Failure::argument(why));
        }
        let entry = |k: usize| -> Outcome<AnnotationEntry> {
            let part = |x: u32| u8::try_from(x).map_err(|_| color(k, x));
            let [r, g, b, t] = rows[k];
            let color = [part(r)?, part(g)?, part(b)?, part(t)?];
            Ok(AnnotationEntry { name: words[k].into(), index: k as u32, color })
        };
        let annotation = Annotation {
            regions: numbers.into_iter().map(|k| u32::try_from(k).ok()).collect(),
            entries: (0..n_regions).map(entry).collect::<Outcome<_>>()?,
            source: String::new(),
        };
        write(&path, annotation_bytes(&annotation)?)
    })
}

fn color(k: usize, part: u32) -> Failure {
    Failure::argument(format!("colors: region {k} has a part {part}: 0 to 255 are needed"))
}

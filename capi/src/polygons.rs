//! Polygons as triangle lists.

use crate::arrays::{self, copy_out};
use crate::failure::{Failure, FailureElement};
use crate::guard;
use crate::memory;
use crate::soup::ricci_soup;
use crate::status::ricci_status;
use ricci::mesh::io::triangles_of_polygons;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_from_polygons(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    corners: *const u32,
    starts: *const usize,
    n_polygons: usize,
    soup: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(soup, || {
        let positions = arrays::points(positions, stride, n_vertices)?;
        let starts: Vec<usize> = arrays::array("starts", starts, n_polygons.saturating_add(1))?;
        // Checked here, since the last offset is the number of corners that are read.
        if let Some(i) = (0..n_polygons).find(|&i| starts[i] > starts[i + 1]) {
            let message = format!("starts[{}] is below starts[{i}]: offsets ascend", i + 1);
            return Err(Failure::argument(message).at(FailureElement::Entry, i + 1));
        }
        let corners: Vec<u32> = arrays::array("corners", corners, starts[n_polygons])?;
        let _reserve = memory::work(n_vertices.max(corners.len()), memory::SOUND_MESH)?;
        let found = triangles_of_polygons(positions, &corners, &starts)?;
        Ok(ricci_soup::of_polygons(found))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_polygons(
    soup: *const ricci_soup,
    polygons: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(soup, |list| copy_out("polygons", list.polygons()?, polygons, capacity))
}

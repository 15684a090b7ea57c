//! Layouts and charts as files: meshes with texture coordinates.

use crate::arrays;
use crate::charts::ricci_charts;
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::layout::ricci_layout;
use crate::refined::weights;
use crate::status::ricci_status;
use ricci::mesh::{Mesh, PerVertex, Point, io};
use std::ffi::c_char;
use std::path::Path;
use std::sync::Arc;

/// Write the mesh with the layout as texture coordinates (`f v/vt`), as OBJ with 17 significant digits.
///
/// If edges were flipped it is the common refinement: the `v` of the mesh come first, unchanged, then the
/// crossings. A file of that name is replaced only once the new one is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic).
///
/// @param layout  the layout.
/// @param path    file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_write_obj(
    layout: *const ricci_layout,
    path: *const c_char,
) -> ricci_status {
    guard::with(layout, |layout| File::of_layout(layout).write(path, None))
}

/// The same with homogeneous texture coordinates, `vt qx qy q` with the q of ricci_layout_weights: the
/// projective map of every piece is linear in these three, and divided by the third. Of a layout in the hyperbolic plane, in the Klein
/// disk alone.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic), RICCI_DOMAIN, RICCI_LAYOUT (a model that
/// is not projective).
///
/// @param layout  the layout.
/// @param path    file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_write_obj_homogeneous(
    layout: *const ricci_layout,
    path: *const c_char,
) -> ricci_status {
    guard::with(layout, |layout| {
        let weights = weights(&layout.surface, layout.layout.refinement())?;
        let heights = layout.heights()?;
        File { heights, ..File::of_layout(layout) }.write(path, Some(&weights))
    })
}

/// Write the mesh that the metric was made from, its own vertices and faces in order, with ricci_layout_input_uv as texture coordinates, as
/// OBJ with 17 significant digits. Seams run along its edges only.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic), RICCI_LAYOUT (as of ricci_layout_input_uv).
///
/// @param layout  the layout.
/// @param path    file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_write_input_obj(
    layout: *const ricci_layout,
    path: *const c_char,
) -> ricci_status {
    guard::call(|door| {
        let layout = door.shared(layout)?;
        let (corners, points) = (layout.input_corners()?, layout.input_points()?);
        let (mesh, positions) = (&**layout.surface.given(), layout.input_positions.as_ref());
        File { mesh, positions, points: &points, corners, heights: Vec::new() }.write(path, None)
    })
}

/// Write the mesh with its charts as texture coordinates (`f v/vt`), as OBJ with 17 significant digits.
///
/// A file of that name is replaced only once the new one is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic).
///
/// @param charts  the charts.
/// @param path    file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_write_obj(
    charts: *const ricci_charts,
    path: *const c_char,
) -> ricci_status {
    guard::with(charts, |charts| File::of_charts(charts).write(path, None))
}

/// The same with homogeneous texture coordinates, `vt qx qy q`.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic), RICCI_DOMAIN, RICCI_LAYOUT (charts of a
/// layout in the hyperbolic plane).
///
/// @param charts  the charts.
/// @param path    file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_write_obj_homogeneous(
    charts: *const ricci_charts,
    path: *const c_char,
) -> ricci_status {
    guard::with(charts, |charts| {
        charts.check_plane()?;
        let weights = weights(&charts.surface, charts.layout.refinement())?;
        File::of_charts(charts).write(path, Some(&weights))
    })
}

/// A mesh with points of the plane at the corners of its faces.
struct File<'a> {
    mesh: &'a Mesh,
    positions: Option<&'a Arc<Vec<Point>>>,
    points: &'a [[f64; 2]],
    corners: Vec<[u32; 3]>,
    /// Factors of the homogeneous weights, one per point; empty for 1.
    heights: Vec<f64>,
}

impl File<'_> {
    fn of_layout(layout: &ricci_layout) -> File<'_> {
        let (positions, points) = (layout.positions.as_ref(), &layout.points);
        File { mesh: layout.layout.mesh(), positions, points, corners: layout.corners(), heights: Vec::new() }
    }

    fn of_charts(charts: &ricci_charts) -> File<'_> {
        let (positions, points) = (charts.positions.as_ref(), &charts.charts.coordinates);
        File { mesh: charts.layout.mesh(), positions, points, corners: charts.corners(), heights: Vec::new() }
    }

    /// Write OBJ; with the homogeneous weights of the vertices, if given.
    fn write(&self, path: *const c_char, weights: Option<&PerVertex<f64>>) -> Outcome {
        let path = arrays::path("path", path)?;
        let positions = self.positions.ok_or_else(|| {
            Failure::argument("the layout is of an intrinsic mesh: it has no positions to write")
        })?;
        let of_vertices = |f| self.mesh.face_vertices(f);
        let mut of_points = vec![1.0; if weights.is_some() { self.points.len() } else { 0 }];
        if let Some(weights) = weights {
            for (f, corners) in self.mesh.faces().zip(&self.corners) {
                (0..3).for_each(|k| of_points[corners[k] as usize] = weights[of_vertices(f)[k]]);
            }
            of_points.iter_mut().zip(&self.heights).for_each(|(weight, height)| *weight *= height);
        }
        let faces = self.mesh.triangles();
        let data = io::Textured {
            positions,
            faces: &faces,
            texcoords: self.points,
            texcoord_weights: &of_points,
            face_texcoords: &self.corners,
            ..io::Textured::default()
        };
        Ok(io::write_obj(Path::new(&path), &data)?)
    }
}

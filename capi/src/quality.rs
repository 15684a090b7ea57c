//! The quality of the triangles of a mesh or a triangle list: angles, edge ratios, Delaunay edges.

use crate::guard;
use crate::mesh::ricci_mesh;
use crate::soup::ricci_soup;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::metric::ShapeQuality;

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quality_summary {
    pub size: usize,
    pub area: f64,
    pub min_angle: f64,
    pub obtuse_fraction: f64,
    pub edge_ratio: f64,
    pub non_delaunay_fraction: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quality_summary, "quality");

impl From<ShapeQuality> for ricci_quality_summary {
    fn from(quality: ShapeQuality) -> Self {
        let or_nan = |figure: Option<f64>| figure.unwrap_or(f64::NAN);
        ricci_quality_summary {
            size: 0,
            area: quality.area,
            min_angle: or_nan(quality.min_angle),
            obtuse_fraction: or_nan(quality.obtuse_fraction),
            edge_ratio: or_nan(quality.edge_ratio),
            non_delaunay_fraction: or_nan(quality.non_delaunay_fraction),
        }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_quality(
    mesh: *const ricci_mesh,
    quality: *mut ricci_quality_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| structs::write(ShapeQuality::of_surface(mesh.surface()?).into(), quality, size))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_quality(
    soup: *const ricci_soup,
    quality: *mut ricci_quality_summary,
    size: usize,
) -> ricci_status {
    guard::with(soup, |list| structs::write(ShapeQuality::of_soup(&list.soup).into(), quality, size))
}

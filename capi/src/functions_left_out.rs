//! The functions of parts of the library that a build leaves out: they are exported, so that programs link and load, and answer RICCI_LEFT_OUT.
//! `tests/header.rs` holds the lists against the headers.

use crate::failure::Failure;
use crate::guard;
use crate::status::{RICCI_LEFT_OUT, ricci_status};
use std::ffi::c_void;

/// A pointer, of whatever type the header says: all are passed alike.
type Address = *const c_void;

/// The answer of a function of a part, which has a cargo feature, that was left out.
fn answer(part: &str, feature: &str) -> ricci_status {
    guard::call(|| {
        let message = format!("{part} were left out when this library was built (cargo feature `{feature}`)");
        Err(Failure::new(RICCI_LEFT_OUT, message))
    })
}

/// Functions of a module `$part`, which is there under the condition `$have`, by their names and parameters: those that return a status, then those that release a handle, of which none was
/// made. Where the part is there, the functions are compiled for tests only, and not exported.
macro_rules! left_out {
    ($part:ident, $have:meta, $feature:literal, $words:literal, [$($name:ident($($kind:ty),*);)*], [$($free:ident;)*]) => {
        #[cfg(any(test, not($have)))]
        // Where the part is there, a test calls a few of them.
        #[cfg_attr($have, allow(dead_code))]
        mod $part {
            use super::*;
            $(
                #[cfg_attr(not($have), unsafe(no_mangle))]
                pub extern "C" fn $name($(_: $kind),*) -> ricci_status {
                    answer($words, $feature)
                }
            )*
            $(
                #[cfg_attr(not($have), unsafe(no_mangle))]
                pub extern "C" fn $free(_: Address) {}
            )*
        }
    };
}

left_out!(splines, feature = "splines", "splines", "splines", [
    ricci_spline_domain(Address, Address, usize, f64, Address);
    ricci_spline_new(Address, Address, Address);
    ricci_spline_with_points(Address, Address, usize, Address);
    ricci_spline_with_polynomial(Address, Address, usize, Address);
    ricci_spline_fit(Address, Address, usize, Address, Address, Address);
    ricci_spline_curvatures(Address, Address, usize, f64, Address, Address, usize);
    ricci_spline_fit_surface(Address, Address, Address, Address);
    ricci_spline_fit_mesh(Address, Address, Address, Address);
    ricci_spline_summarise(Address, Address, usize);
    ricci_spline_folds(Address, Address, usize);
    ricci_spline_values(Address, u32, Address, usize);
    ricci_spline_controls(Address, Address, usize);
    ricci_spline_locate(Address, Address, usize, Address, usize);
    ricci_spline_evaluate(Address, Address, u32, Address, Address, usize);
    ricci_spline_closest(Address, Address, usize, Address, Address, Address, usize);
    ricci_spline_blossom(Address, usize, Address, usize, Address);
    ricci_spline_tessellate(Address, usize, Address, Address);
    ricci_spline_read(Address, Address);
    ricci_spline_parse(Address, Address);
    ricci_spline_write(Address, Address);
    ricci_spline_text(Address, Address, usize, Address);
    ricci_bicubic_new(Address, Address, Address, Address);
    ricci_bicubic_summarise(Address, Address, usize);
    ricci_bicubic_write(Address, Address, Address);
    ricci_bicubic_text(Address, u32, Address, Address, usize, Address);
], [
    ricci_spline_free;
    ricci_bicubic_free;
]);

left_out!(quads, feature = "quads", "quads", "seamless metrics and quad meshes", [
    ricci_seamless_new(Address, Address, Address, Address);
    ricci_seamless_summarise(Address, Address, usize);
    ricci_seamless_cones(Address, Address, usize);
    ricci_seamless_turning(Address, Address, usize);
    ricci_seamless_features(Address, Address, usize);
    ricci_seamless_field(Address, Address, Address, Address, usize);
    ricci_seamless_metric(Address, Address);
    ricci_seamless_map(Address, Address, Address);
    ricci_seamless_flatten(Address, Address, Address, Address, usize, Address, usize, Address);
    ricci_quads_new(Address, Address, Address, Address);
    ricci_quads_summarise(Address, Address, usize);
    ricci_quads_faces(Address, Address, usize);
    ricci_quads_places(Address, Address, usize, Address, usize);
    ricci_quads_positions(Address, Address, usize);
    ricci_quads_creases(Address, Address, usize);
    ricci_quads_rectangles(Address, Address, usize);
    ricci_quad_layout_new(Address, Address, Address, Address);
    ricci_quad_layout_summarise(Address, Address, usize);
    ricci_quad_layout_quads(Address, Address);
    ricci_quad_layout_nodes(Address, Address, usize);
    ricci_quad_layout_arcs(Address, Address, usize);
    ricci_quad_layout_arc_vertices(Address, Address, usize, Address, usize);
    ricci_quad_layout_sides(Address, Address, usize, Address, usize);
    ricci_quad_layout_sizes(Address, Address, usize);
    ricci_quad_layout_patches(Address, Address, usize);
], [
    ricci_seamless_free;
    ricci_quads_free;
    ricci_quad_layout_free;
]);

left_out!(quad_splines, all(feature = "quads", feature = "splines"), "quads,splines", "splines over quad layouts", [
    ricci_quad_spline_fit_mesh(Address, f64, Address, Address, Address);
    ricci_quad_spline_fit(Address, Address, Address, Address, Address);
    ricci_quad_spline_summarise(Address, Address, usize);
    ricci_quad_spline_folds(Address, Address, usize);
    ricci_quad_spline_patch(Address, usize, Address, usize);
    ricci_quad_spline_poles(Address, usize, Address, usize);
    ricci_quad_spline_knots(Address, usize, u32, Address, usize, Address, usize);
    ricci_quad_spline_controls(Address, usize, Address, usize);
    ricci_quad_spline_arc(Address, usize, Address, usize);
    ricci_quad_spline_arc_poles(Address, usize, Address, usize);
    ricci_quad_spline_evaluate(Address, Address, u32, Address, Address, usize);
    ricci_quad_spline_closest(Address, Address, usize, Address, Address, Address, usize);
    ricci_quad_spline_tessellate(Address, usize, f64, Address, Address);
    ricci_quad_spline_patch_of_faces(Address, Address, Address, Address, usize);
    ricci_quad_spline_extraction(Address, Address, usize, Address, usize, Address, usize);
    ricci_quad_spline_bezier(Address, usize, u32, Address, usize);
    ricci_quad_spline_write_step(Address, Address, Address);
    ricci_quad_spline_write_json(Address, Address);
    ricci_quad_spline_fit_quads(Address, Address, Address, Address);
], [
    ricci_quad_spline_free;
]);

left_out!(gifti, feature = "gifti", "gifti", "notes, values and labels of GIFTI", [
    ricci_gifti_notes_new(Address);
    ricci_gifti_notes_read(Address, Address);
    ricci_gifti_notes_add(Address, Address, Address);
    ricci_gifti_notes_add_transform(Address, Address, Address, Address);
    ricci_gifti_notes_count(Address, Address, Address);
    ricci_gifti_notes_get(Address, usize, Address, usize);
    ricci_gifti_notes_transform(Address, usize, Address, usize);
    ricci_gifti_columns_read(Address, Address);
    ricci_gifti_columns_count(Address, Address, Address);
    ricci_gifti_columns_get(Address, usize, Address, usize);
    ricci_gifti_columns_label(Address, usize, Address, usize);
    ricci_gifti_surface_write(Address, Address, usize, Address, usize, Address);
    ricci_gifti_values_write(Address, Address, Address, usize, usize, Address);
    ricci_gifti_labels_write(Address, Address, usize, Address, Address, Address, usize, Address);
], [
    ricci_gifti_notes_free;
    ricci_gifti_columns_free;
]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thread_failure;
    use std::ffi::CStr;
    use std::ptr::null;

    #[test]
    fn a_function_that_is_left_out_says_so() {
        let last = || {
            // SAFETY: NUL-terminated, of this thread.
            unsafe { CStr::from_ptr(thread_failure::text()) }.to_string_lossy().into_owned()
        };
        assert_eq!(splines::ricci_spline_read(null(), null()), RICCI_LEFT_OUT);
        assert_eq!(last(), "splines were left out when this library was built (cargo feature `splines`)");
        assert_eq!(quads::ricci_seamless_new(null(), null(), null(), null()), RICCI_LEFT_OUT);
        assert!(last().starts_with("seamless metrics and quad meshes were left out"), "{}", last());
        assert_eq!(gifti::ricci_gifti_notes_new(null()), RICCI_LEFT_OUT);
        assert!(last().ends_with("(cargo feature `gifti`)"), "{}", last());
        splines::ricci_spline_free(null());
        quads::ricci_quads_free(null());
    }
}

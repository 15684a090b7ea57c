//! Handles that every sequence of calls shares: made once, only read from then on, never released.

use super::{CALLS, word};
use ricci_c::archive::{ricci_archive_new, ricci_objects};
use ricci_c::bicubic::{ricci_bicubic_new, ricci_bicubic_options};
use ricci_c::charts::ricci_charts_new;
use ricci_c::circle_domain::ricci_circle_domain_new;
use ricci_c::control::{ricci_control_cancel, ricci_control_new};
use ricci_c::deck::{ricci_deck_new, ricci_deck_spec};
use ricci_c::dirichlet::ricci_dirichlet_new;
use ricci_c::domain::ricci_domain_new;
use ricci_c::flow::ricci_flow;
use ricci_c::forms::ricci_forms_new;
use ricci_c::gifti::{ricci_gifti_notes_add, ricci_gifti_notes_read};
use ricci_c::gifti_columns::ricci_gifti_columns_read;
use ricci_c::homotopy::ricci_homotopy_new;
use ricci_c::layout::ricci_layout_new;
use ricci_c::map::ricci_map_new;
use ricci_c::matching::ricci_match;
use ricci_c::mesh::ricci_mesh;
use ricci_c::metric::{ricci_metric, ricci_metric_new};
use ricci_c::quad_layout::ricci_quad_layout_new;
use ricci_c::quad_spline::{ricci_quad_spline_fit, ricci_quad_spline_options};
use ricci_c::quads::{ricci_quads_new, ricci_quads_options};
use ricci_c::repaired_input::ricci_repaired_input_new;
use ricci_c::scene::{ricci_scene_read, ricci_scene_texture_atlas};
use ricci_c::seamless::ricci_seamless_new;
use ricci_c::shapes::{ricci_make, ricci_shape};
use ricci_c::soup::{ricci_soup_from_arrays, ricci_soup_repair, ricci_soup_write};
use ricci_c::spline::{ricci_spline_domain, ricci_spline_new, ricci_spline_spec};
use ricci_c::structure::ricci_structure_new;
use ricci_c::texture_atlas::{ricci_texture_atlas_new, ricci_texture_options};
use ricci_c::uniformize::{ricci_uniform, ricci_uniformize};
use std::collections::HashMap;
use std::ptr::{null, null_mut};
use std::sync::OnceLock;

/// Handles by the name of their type.
pub type Handles = HashMap<&'static str, Vec<u64>>;

/// The handle that a call makes; NULL if this surface has none of the kind.
fn made<T>(call: impl FnOnce(*mut *mut T) -> u32) -> *mut T {
    let mut place = null_mut();
    call(&raw mut place);
    place
}

/// A struct of zeros with its size, as `ricci_init` leaves it.
fn zeroed<T>() -> T {
    // SAFETY: structs of the face are numbers and pointers, of which zeros are valid; the size comes first.
    unsafe {
        let mut value: T = std::mem::zeroed();
        (&raw mut value).cast::<usize>().write(size_of::<T>());
        value
    }
}

/// Number, resolution and genus of a sample surface.
fn surface(shape: u32, [n, m, genus]: [usize; 3]) -> *mut ricci_mesh {
    let [a, b, c] = if shape == 3 { [0.5, 1.0, 0.0] } else { [2.0, 1.0, 1.0] };
    let spec = ricci_shape { shape, n, m, genus, a, b, c, ..zeroed() };
    made(|place| unsafe { ricci_make(&spec, place) })
}

struct Shelf(Handles);

impl Shelf {
    fn put<T>(&mut self, name: &'static str, handle: *mut T) -> *mut T {
        if !handle.is_null() {
            self.0.entry(name).or_default().push(word(handle));
        }
        handle
    }

    /// Surfaces of every topology, and the handles that are made from them.
    fn surfaces(&mut self) {
        // A sphere, a disk, an annulus, flat tori, surfaces of genus 2 with one and two vertices, a pair of pants.
        let given = [
            (11, [0, 0, 0]),
            (0, [1, 0, 0]),
            (2, [1, 0, 0]),
            (3, [1, 4, 0]),
            (7, [2, 2, 0]),
            (4, [3, 3, 0]),
            (9, [0, 0, 2]),
            (10, [0, 0, 2]),
            (12, [0, 0, 0]),
        ];
        for (shape, sizes) in given {
            let mesh = self.put("ricci_mesh", surface(shape, sizes));
            self.class_of(mesh, shape);
            let homotopy = made(|p| unsafe { ricci_homotopy_new(mesh, null(), null(), p) });
            self.put("ricci_homotopy", homotopy);
            self.put("ricci_domain", made(|p| unsafe { ricci_domain_new(homotopy, null(), 0, p) }));
            self.put("ricci_forms", made(|p| unsafe { ricci_forms_new(mesh, null(), null(), p) }));
            let kept = ricci_objects { mesh, ..zeroed() };
            self.put("ricci_archive", made(|p| unsafe { ricci_archive_new(&kept, p) }));
            self.put("ricci_structure", made(|p| unsafe { ricci_structure_new(mesh, 0, null(), null(), p) }));
        }
    }

    /// Metrics, layouts and canonical shapes of a surface.
    fn class_of(&mut self, mesh: *const ricci_mesh, shape: u32) {
        let metric: *mut ricci_metric = made(|p| unsafe { ricci_metric_new(mesh, 0, 0, p) });
        self.put("ricci_metric", metric);
        let kept = ricci_objects { metric, ..zeroed() };
        self.put("ricci_archive", made(|p| unsafe { ricci_archive_new(&kept, p) }));
        let uniform: *mut ricci_uniform = made(|p| unsafe { ricci_uniformize(mesh, null(), null(), p) });
        self.put("ricci_uniform", uniform);
        if matches!(shape, 2 | 3) {
            let circles = made(|p| unsafe { ricci_circle_domain_new(mesh, null(), null(), p) });
            self.put("ricci_circle_domain", circles);
        }
        if matches!(shape, 2 | 4 | 7) {
            let flat = made(|p| unsafe { ricci_flow(metric, null(), null(), null(), p) });
            self.put("ricci_metric", flat);
            let layout =
                self.put("ricci_layout", made(|p| unsafe { ricci_layout_new(flat, null(), null(), p) }));
            self.put("ricci_charts", made(|p| unsafe { ricci_charts_new(layout, 0.01, null(), p) }));
            let repaired = made(|p| unsafe { ricci_repaired_input_new(layout, null(), p) });
            self.put("ricci_repaired_input", repaired);
            self.put("ricci_map", made(|p| unsafe { ricci_map_new(flat, null(), p) }));
            let own = made(|p| unsafe { ricci_match(mesh, mesh, null(), null(), p) });
            self.put("ricci_matching", own);
        }
        if matches!(shape, 0 | 4 | 7 | 9) {
            let seamless = made(|p| unsafe { ricci_seamless_new(mesh, null(), null(), p) });
            self.put("ricci_seamless", seamless);
            let options = ricci_quads_options { sizing: 1, n_quads: 60, threads: 1, ..zeroed() };
            self.put("ricci_quads", made(|p| unsafe { ricci_quads_new(seamless, &options, null(), p) }));
            let layout = made(|p| unsafe { ricci_quad_layout_new(seamless, null(), null(), p) });
            self.put("ricci_quad_layout", layout);
            let options = ricci_quad_spline_options { most_spans: 1, threads: 1, ..zeroed() };
            let spline = made(|p| unsafe { ricci_quad_spline_fit(seamless, layout, &options, null(), p) });
            self.put("ricci_quad_spline", spline);
        }
        if matches!(shape, 4 | 7 | 9) {
            let domain = made(|p| unsafe { ricci_dirichlet_new(uniform, null(), null(), p) });
            self.put("ricci_dirichlet", domain);
            let deck = made(|p| unsafe { ricci_deck_new(uniform, &zeroed::<ricci_deck_spec>(), null(), p) });
            self.put("ricci_deck", deck);
        }
    }

    /// Splines over a square, patches, triangle lists with defects, a control that is cancelled.
    fn others(&mut self) {
        let corners = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
        let starts = [0, 4];
        let square = made(|p| unsafe { ricci_spline_domain(corners.as_ptr(), starts.as_ptr(), 1, 2.0, p) });
        self.put("ricci_mesh", square);
        for degree in [1, 2] {
            let spec = ricci_spline_spec { degree, ..zeroed() };
            let spline = made(|p| unsafe { ricci_spline_new(square, &spec, p) });
            self.put("ricci_spline", spline);
            let options = ricci_bicubic_options { tolerance: 0.1, angle: 1.0, ..zeroed() };
            self.put("ricci_bicubic", made(|p| unsafe { ricci_bicubic_new(spline, &options, null(), p) }));
        }
        let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let faces = [0, 2, 1, 0, 1, 3, 1, 2, 3, 4, 3, 2, 1, 2, 3, 0, 0, 1];
        let soup =
            made(|p| unsafe { ricci_soup_from_arrays(positions.as_ptr(), 0, 5, faces.as_ptr(), 6, p) });
        self.put("ricci_soup", soup);
        self.put("ricci_soup", made(|p| unsafe { ricci_soup_repair(soup, null(), p) }));
        let options = ricci_texture_options { page: 64, threads: 1, ..zeroed() };
        let atlas = made(|p| unsafe { ricci_texture_atlas_new(soup, &options, null(), p) });
        self.put("ricci_texture_atlas", atlas);
        let folder = tempfile::tempdir().expect("a folder for a scene");
        let path = folder.path().join("scene.glb");
        let path = std::ffi::CString::new(path.to_string_lossy().as_ref()).expect("a path has no zero");
        let plain =
            made(|p| unsafe { ricci_soup_from_arrays(positions.as_ptr(), 0, 4, faces.as_ptr(), 3, p) });
        assert_eq!(unsafe { ricci_soup_write(plain, path.as_ptr()) }, 0);
        let scene = made(|p| unsafe { ricci_scene_read(path.as_ptr(), p) });
        self.put(
            "ricci_texture_atlas",
            made(|p| unsafe { ricci_scene_texture_atlas(scene, &options, null(), p) }),
        );
        self.put("ricci_scene", scene);
        let seed = |name: &str| {
            let path = format!("{}/seeds/gifti/{name}", env!("CARGO_MANIFEST_DIR"));
            std::ffi::CString::new(path).expect("a path has no zero")
        };
        for name in ["ascii", "labels"] {
            let notes = made(|p| unsafe { ricci_gifti_notes_read(seed(name).as_ptr(), p) });
            assert_eq!(unsafe { ricci_gifti_notes_add(notes, c"a".as_ptr(), c"b".as_ptr()) }, 0);
            self.put("ricci_gifti_notes", notes);
            let columns = made(|p| unsafe { ricci_gifti_columns_read(seed(name).as_ptr(), p) });
            self.put("ricci_gifti_columns", columns);
        }
        self.put("ricci_control", made(|p| unsafe { ricci_control_new(p) }));
        let cancelled = made(|p| unsafe { ricci_control_new(p) });
        assert_eq!(unsafe { ricci_control_cancel(cancelled) }, 0);
        self.put("ricci_control", cancelled);
    }
}

/// All of them.
pub fn handles() -> &'static Handles {
    static ALL: OnceLock<Handles> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut shelf = Shelf(Handles::new());
        shelf.surfaces();
        shelf.others();
        let kinds: std::collections::BTreeSet<&str> =
            CALLS.iter().filter_map(|c| c.name.strip_suffix("_free")).collect();
        let missing: Vec<&&str> =
            kinds.iter().filter(|k| **k != "ricci_solver" && !shelf.0.contains_key(**k)).collect();
        assert!(missing.is_empty(), "no shared {missing:?}");
        shelf.0
    })
}

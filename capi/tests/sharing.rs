//! Handles that are only read are used by several threads at once: every thread finds the same, bit for bit, and has its own last
//! error. `tests/sanitize` runs this under ThreadSanitizer, which sees what the results do not show.

use ricci_c::control::{ricci_control, ricci_control_cancel, ricci_control_new, ricci_control_progress};
use ricci_c::deck::{ricci_deck, ricci_deck_new, ricci_deck_spec, ricci_deck_values};
use ricci_c::flow::ricci_flow;
use ricci_c::forms::{ricci_forms, ricci_forms_new, ricci_forms_periods};
use ricci_c::homotopy::{ricci_homotopy, ricci_homotopy_intersections, ricci_homotopy_new};
use ricci_c::last_error::ricci_last_error;
use ricci_c::layout::{ricci_layout, ricci_layout_new, ricci_layout_uv};
use ricci_c::map::{ricci_map, ricci_map_barycentric, ricci_map_new};
use ricci_c::mesh::{ricci_mesh, ricci_mesh_values};
use ricci_c::metric::{ricci_metric, ricci_metric_free, ricci_metric_new, ricci_metric_values};
use ricci_c::shapes::{ricci_make, ricci_shape};
use ricci_c::spline::{ricci_spline, ricci_spline_domain, ricci_spline_new};
use ricci_c::spline_file::ricci_spline_text;
use ricci_c::structure::{ricci_structure, ricci_structure_holonomy, ricci_structure_new};
use ricci_c::uniformize::{ricci_uniform, ricci_uniformize};
use std::ffi::CStr;
use std::ptr::{null, null_mut};
use std::sync::Barrier;

const THREADS: usize = 4;
const ROUNDS: usize = 3;
/// Entries that every buffer has room for.
const ROOM: usize = 1 << 16;

/// The handle that a call makes.
fn made<T>(call: impl FnOnce(*mut *mut T) -> u32) -> *const T {
    let mut place = null_mut();
    let status = call(&raw mut place);
    assert_eq!(status, 0, "{}", last());
    place
}

fn last() -> String {
    // SAFETY: NUL-terminated, of this thread.
    unsafe { CStr::from_ptr(ricci_last_error()) }.to_string_lossy().into_owned()
}

fn zeroed<T>() -> T {
    // SAFETY: structs of the face are numbers and pointers, of which zeros are valid; the size comes first.
    unsafe {
        let mut value: T = std::mem::zeroed();
        (&raw mut value).cast::<usize>().write(size_of::<T>());
        value
    }
}

/// One handle of each kind, of a torus and of a square.
#[derive(Clone, Copy)]
struct Handles {
    mesh: *const ricci_mesh,
    metric: *const ricci_metric,
    flat: *const ricci_metric,
    layout: *const ricci_layout,
    map: *const ricci_map,
    uniform: *const ricci_uniform,
    homotopy: *const ricci_homotopy,
    deck: *const ricci_deck,
    forms: *const ricci_forms,
    structure: *const ricci_structure,
    spline: *const ricci_spline,
    control: *const ricci_control,
}
// SAFETY: the header says that a `const T *` may be used by several threads, which is what is tested.
unsafe impl Send for Handles {}
unsafe impl Sync for Handles {}

impl Handles {
    fn new() -> Handles {
        let torus = ricci_shape { shape: 4, a: 2.0, b: 1.0, n: 8, m: 6, ..zeroed() };
        let (corners, starts) = ([0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0], [0, 4]);
        // SAFETY: pointers to what the header says.
        unsafe {
            let mesh = made(|p| ricci_make(&torus, p));
            let metric = made(|p| ricci_metric_new(mesh, 0, 0, p));
            let flat = made(|p| ricci_flow(metric, null(), null(), null(), p));
            let uniform = made(|p| ricci_uniformize(mesh, null(), null(), p));
            let square = made(|p| ricci_spline_domain(corners.as_ptr(), starts.as_ptr(), 1, 0.5, p));
            let spec = ricci_deck_spec { depth: 2, limit: 50, ..zeroed() };
            Handles {
                mesh,
                metric,
                flat,
                layout: made(|p| ricci_layout_new(flat, null(), null(), p)),
                map: made(|p| ricci_map_new(flat, null(), p)),
                uniform,
                homotopy: made(|p| ricci_homotopy_new(mesh, null(), null(), p)),
                deck: made(|p| ricci_deck_new(uniform, &spec, null(), p)),
                forms: made(|p| ricci_forms_new(mesh, null(), null(), p)),
                structure: made(|p| ricci_structure_new(mesh, 2, null(), null(), p)),
                spline: made(|p| ricci_spline_new(square, null(), p)),
                control: made(|p| ricci_control_new(p)),
            }
        }
    }

    /// What can be read of all of them, and what is made of them, as bits.
    fn found(&self) -> Vec<u64> {
        let mut all = Vec::new();
        let mut doubles = |call: &dyn Fn(*mut f64) -> u32| {
            let mut buffer = vec![0.0_f64; ROOM];
            let status = call(buffer.as_mut_ptr());
            assert_eq!(status, 0, "{}", last());
            all.extend(buffer.iter().map(|x| x.to_bits()));
        };
        // SAFETY: pointers to what the header says; buffers of ROOM entries.
        unsafe {
            doubles(&|p| ricci_mesh_values(self.mesh, 0, p, ROOM));
            doubles(&|p| ricci_metric_values(self.metric, 0, p, ROOM));
            doubles(&|p| ricci_layout_uv(self.layout, 0, p, ROOM));
            doubles(&|p| ricci_map_barycentric(self.map, 0, p, ROOM));
            doubles(&|p| ricci_deck_values(self.deck, 0, p, ROOM));
            doubles(&|p| ricci_forms_periods(self.forms, p, ROOM));
            doubles(&|p| ricci_structure_holonomy(self.structure, p, ROOM));
            let again = made(|p| ricci_flow(self.metric, null(), null(), null(), p));
            doubles(&|p| ricci_metric_values(again, 0, p, ROOM));
            ricci_metric_free(again.cast_mut());
            let layout = made(|p| ricci_layout_new(self.flat, null(), null(), p));
            doubles(&|p| ricci_layout_uv(layout, 0, p, ROOM));
            ricci_c::layout::ricci_layout_free(layout.cast_mut());
            let deck = made(|p| ricci_deck_new(self.uniform, &zeroed::<ricci_deck_spec>(), null(), p));
            doubles(&|p| ricci_deck_values(deck, 0, p, ROOM));
            ricci_c::deck::ricci_deck_free(deck.cast_mut());
            let mut numbers = vec![0_i64; 16];
            assert_eq!(ricci_homotopy_intersections(self.homotopy, numbers.as_mut_ptr(), 16), 0);
            all.extend(numbers.iter().map(|&n| n as u64));
            let (mut text, mut n) = (vec![0_u8; 8 * ROOM], 0);
            assert_eq!(ricci_spline_text(self.spline, text.as_mut_ptr().cast(), 8 * ROOM, &raw mut n), 0);
            all.extend(text.iter().map(|&b| u64::from(b)));
        }
        all
    }
}

#[test]
fn handles_that_are_read_are_shared_by_threads() {
    let handles = Handles::new();
    let expected = handles.found();
    let together = Barrier::new(THREADS + 1);
    std::thread::scope(|scope| {
        let mut threads = Vec::new();
        for thread in 0..THREADS {
            let (handles, expected, together) = (&handles, &expected, &together);
            threads.push(scope.spawn(move || {
                together.wait();
                for _ in 0..ROUNDS {
                    // A failure of this thread's own, whose words no other thread replaces.
                    let form = 1000 + thread;
                    let refused =
                        unsafe { ricci_c::forms::ricci_forms_values(handles.forms, form, null_mut(), 0) };
                    assert_ne!(refused, 0);
                    assert_eq!(handles.found(), *expected);
                    assert!(last().contains(&form.to_string()), "{}", last());
                }
            }));
        }
        // Progress and cancellation, from any thread.
        let (control, together) = (handles.control as usize, &together);
        threads.push(scope.spawn(move || {
            together.wait();
            let control = control as *const ricci_control;
            let (mut stage, mut fraction) = (0, 0.0);
            for _ in 0..1000 {
                assert_eq!(
                    unsafe { ricci_control_progress(control, &raw mut stage, &raw mut fraction, null_mut()) },
                    0
                );
            }
            assert_eq!(unsafe { ricci_control_cancel(control) }, 0);
        }));
        // Each is joined by name: the end of the scope is an order that ThreadSanitizer does not see.
        threads.into_iter().for_each(|thread| thread.join().unwrap());
    });
    let mut none: *mut ricci_metric = null_mut();
    assert_eq!(unsafe { ricci_flow(handles.metric, null(), null(), handles.control, &raw mut none) }, 4);
    // What threads have shared is released; the handles live through each other, so the order is free.
    unsafe {
        ricci_c::mesh::ricci_mesh_free(handles.mesh.cast_mut());
        ricci_metric_free(handles.metric.cast_mut());
        ricci_metric_free(handles.flat.cast_mut());
        ricci_c::layout::ricci_layout_free(handles.layout.cast_mut());
    }
}

/// What ThreadSanitizer has to report, so that its silence above says something.
#[test]
#[ignore = "a race on purpose, for tests/sanitize"]
fn a_race_on_purpose() {
    let mut number = 0_u64;
    let place = &raw mut number as usize;
    let add = move || {
        (0..1000).for_each(|_| unsafe {
            let place = place as *mut u64;
            place.write_volatile(place.read_volatile() + 1);
        });
    };
    let threads = [std::thread::spawn(add), std::thread::spawn(add)];
    threads.into_iter().for_each(|thread| thread.join().unwrap());
    assert!(number > 0);
}

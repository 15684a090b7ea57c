//! A sequence of calls, and the conditions on each: a status that the header names, a message for every failure, results without NaN,
//! nothing written by a call that fails, and nothing written beyond the buffers.

use super::draw::{UNTOUCHED, Watched};
use super::shared::{self, Handles};
use super::tape::Tape;
use super::{Answer, CALLS, Call, Kind, Struct, call, layouts, parameters, word};
use crate::is_rare;
use ricci_c::control::ricci_control_use;
use std::ffi::{CStr, c_char};
use std::sync::OnceLock;
use std::time::Instant;

/// Most calls of one input.
const MOST_CALLS: usize = 8;
/// Calls that take a hundred times as long as others: one input of eight makes them.
const LONG: [&str; 20] = [
    "ricci_match",
    "ricci_match_by_shape",
    "ricci_circle_domain_new",
    "ricci_spline_fit",
    "ricci_spline_fit_mesh",
    "ricci_spline_fit_surface",
    "ricci_bicubic_new",
    "ricci_matching_map",
    "ricci_quads_new",
    "ricci_quad_layout_new",
    "ricci_quad_spline_fit",
    "ricci_quad_spline_fit_mesh",
    "ricci_quad_spline_fit_quads",
    "ricci_quad_spline_closest",
    "ricci_quad_spline_patch_of_faces",
    "ricci_quad_spline_tessellate",
    "ricci_spline_closest",
    "ricci_texture_atlas_new",
    "ricci_scene_texture_atlas",
    "ricci_hyperelliptic_periods",
];
/// Faces of a mesh that is kept for later calls.
const MOST_FACES: usize = 40;
/// Statuses that say that the library is wrong: an internal error, a poisoned handle, broken connectivity.
const DEFECTS: [u32; 3] = [11, 12, 202];
const NULL_STATUS: u32 = 10;
const BUFFER_TOO_SMALL: u32 = 13;
const WRONG_SIZE: u32 = 1;

/// Functions whose capacity counts rows of two numbers of the last buffer.
const IN_PAIRS: [&str; 2] = ["ricci_structure_places", "ricci_uniform_sides"];
/// Fields of summaries that do not apply to every surface, and may be NaN, as the headers say.
const MAY_BE_NAN: [(&str, &str); 37] = [
    ("ricci_bounds_summary", "modulus"),
    ("ricci_bounds_summary", "modulus_radius"),
    ("ricci_circle_domain_summary", "modulus"),
    ("ricci_forms_summary", "asymmetry"),
    ("ricci_forms_summary", "star_residual"),
    ("ricci_forms_summary", "least_eigenvalue"),
    ("ricci_forms_summary", "modulus"),
    ("ricci_harmonic_summary", "mean_value_residual"),
    ("ricci_harmonic_summary", "modulus"),
    ("ricci_harmonic_summary", "modulus_low"),
    ("ricci_harmonic_summary", "modulus_high"),
    ("ricci_hole", "length"),
    ("ricci_hole", "area"),
    ("ricci_layout_summary", "qc_mean"),
    ("ricci_layout_summary", "qc_max"),
    ("ricci_layout_summary", "area_ratio_min"),
    ("ricci_layout_summary", "area_ratio_max"),
    ("ricci_layout_summary", "qc_mean_input"),
    ("ricci_layout_summary", "qc_max_input"),
    ("ricci_layout_summary", "area_ratio_min_input"),
    ("ricci_layout_summary", "area_ratio_max_input"),
    ("ricci_layout_summary", "overlap"),
    ("ricci_layout_summary", "symmetric_dirichlet"),
    ("ricci_quads_summary", "angle_mean"),
    ("ricci_quads_summary", "angle_max"),
    ("ricci_quads_summary", "edge_mean"),
    ("ricci_quads_summary", "edge_deviation"),
    ("ricci_quad_spline_summary", "volume"),
    ("ricci_quality_summary", "min_angle"),
    ("ricci_quality_summary", "obtuse_fraction"),
    ("ricci_quality_summary", "edge_ratio"),
    ("ricci_quality_summary", "non_delaunay_fraction"),
    ("ricci_spline_summary", "fit_rms"),
    ("ricci_spline_summary", "fit_max"),
    ("ricci_spline_summary", "folded_share"),
    ("ricci_uniform_summary", "modulus"),
    ("ricci_uniform_summary", "extremal_distance"),
];
/// Texts that say nothing where a file says nothing.
const MAY_BE_EMPTY: [(&str, &str); 7] = [
    ("ricci_gifti_column", "intent"),
    ("ricci_gifti_column", "name"),
    ("ricci_gifti_label", "name"),
    ("ricci_gifti_note", "name"),
    ("ricci_gifti_note", "value"),
    ("ricci_gifti_transform", "from"),
    ("ricci_gifti_transform", "to"),
];
/// Functions whose results may hold a NaN, as the headers say: curvatures where the surface has no tangent plane, circles that there
/// are not, lengths of loops whose points are not finite, numbers of a file.
const MAY_GIVE_NAN: [&str; 5] = [
    "ricci_spline_evaluate",
    "ricci_quad_spline_evaluate",
    "ricci_layout_circles",
    "ricci_soup_loops",
    "ricci_soup_numbers",
];

/// The state of one input.
pub struct Session<'a> {
    pub tape: Tape<'a>,
    pub shared: &'static Handles,
    pub own: Handles,
    pub kept: Vec<Vec<u8>>,
    pub watched: Vec<Watched>,
    /// The capacity or size that goes with the argument before.
    pub pending: Option<usize>,
    /// Entries that the last call asked for.
    pub needed: usize,
}

fn text(place: *const c_char) -> String {
    assert!(!place.is_null(), "a text is NULL");
    // SAFETY: the library's texts are NUL-terminated.
    unsafe { CStr::from_ptr(place) }.to_str().expect("UTF-8").into()
}

/// True if memory is as it was before the call.
fn untouched(bytes: &[u8]) -> bool {
    static BEFORE: [u8; 4096] = [UNTOUCHED; 4096];
    bytes.chunks(BEFORE.len()).all(|part| *part == BEFORE[..part.len()])
}

fn status(answer: Answer) -> u32 {
    match answer {
        Answer::Status(status) => status,
        _ => panic!("no status"),
    }
}

/// Make the calls that the bytes stand for.
pub fn run(bytes: &[u8]) {
    let mut session = Session {
        tape: Tape::new(bytes),
        shared: shared::handles(),
        own: Handles::new(),
        kept: Vec::new(),
        watched: Vec::new(),
        pending: None,
        needed: 0,
    };
    let makes_long = is_rare(bytes, 8);
    for _ in 0..MOST_CALLS {
        if session.tape.is_empty() {
            break;
        }
        let k = session.tape.below(CALLS.len());
        if makes_long || !LONG.contains(&CALLS[k].name) {
            session.step(&CALLS[k], &parameters()[k]);
        }
        session.kept.clear();
    }
    // A control that the thread uses would stay with it for the next input.
    // SAFETY: NULL is allowed.
    assert_eq!(unsafe { ricci_control_use(std::ptr::null()) }, 0);
    // Handles are released in any order.
    let mut left: Vec<(&str, u64)> =
        session.own.iter().flat_map(|(of, handles)| handles.iter().map(|&h| (*of, h))).collect();
    left.sort_unstable();
    while !left.is_empty() {
        let k = session.tape.below(left.len());
        let (of, handle) = left.swap_remove(k);
        release(of, handle);
    }
}

fn release(of: &str, handle: u64) {
    (call(&format!("{of}_free")).run)(&[handle]);
}

impl Session<'_> {
    fn step(&mut self, call: &Call, of: &[(&'static str, Kind)]) {
        self.tape.wild = false;
        self.watched.clear();
        self.pending = None;
        let releases = call.name.ends_with("_free");
        let mut words = Vec::new();
        for (i, &(name, kind)) in of.iter().enumerate() {
            let next = of.get(i + 1).map_or("", |(next, _)| next);
            words.push(self.argument(kind, name, next, releases));
        }
        static SAYS: OnceLock<bool> = OnceLock::new();
        let says = *SAYS.get_or_init(|| std::env::var_os("RICCI_FUZZ_SAYS").is_some());
        if says {
            eprintln!("{}({words:x?})", call.name);
        }
        let start = Instant::now();
        let answer = (call.run)(&words);
        if says {
            eprintln!("{}: {} us", call.name, start.elapsed().as_micros());
        }
        match answer {
            Answer::Status(0) => self.succeeded(call.name),
            Answer::Status(status) => self.failed(call.name, status),
            Answer::Text(place) => drop(text(place)),
            Answer::Nothing | Answer::Number(_) => {}
        }
    }

    /// Checks that a failed call has a message and has written nothing.
    fn failed(&mut self, name: &str, status: u32) {
        let sentence = match (call("ricci_status_text").run)(&[status.into()]) {
            Answer::Text(place) => text(place),
            _ => panic!("no text"),
        };
        let message = match (call("ricci_last_error").run)(&[]) {
            Answer::Text(place) => text(place),
            _ => panic!("no text"),
        };
        assert!(!DEFECTS.contains(&status), "{name}: {status}, {sentence}: {message}");
        assert!(!sentence.is_empty() && sentence != "unknown status", "{name}: {status}: {sentence}");
        assert!(!message.is_empty(), "{name}: {status} without a message");
        let failure = ricci_c::last_error::ricci_last_failure;
        // SAFETY: numbers, of which zeros are valid.
        let mut numbers: ricci_c::last_error::ricci_failure = unsafe { std::mem::zeroed() };
        assert_eq!(unsafe { failure(&raw mut numbers, size_of_val(&numbers)) }, 0);
        assert_eq!(numbers.status, status, "{name}");
        if [BUFFER_TOO_SMALL, WRONG_SIZE].contains(&status) {
            self.needed = numbers.needed;
        }
        for watched in &self.watched {
            let (Watched::Buffer { kept, .. } | Watched::Struct { kept, .. } | Watched::Made { kept, .. }) =
                watched;
            assert!(untouched(&self.kept[*kept]), "{name} failed with {status} ({message}) and has written");
        }
    }

    /// Checks that the results of a call are as the header says.
    fn succeeded(&mut self, name: &str) {
        for watched in std::mem::take(&mut self.watched) {
            match watched {
                Watched::Made { kept, of } => {
                    let handle = u64::from_ne_bytes(self.kept[kept][..8].try_into().unwrap());
                    let untouched = u64::from_ne_bytes([UNTOUCHED; 8]);
                    assert!(handle != 0 && handle != untouched, "{name} made no {of}");
                    if of == "ricci_mesh" && faces(handle) > MOST_FACES {
                        release(of, handle);
                    } else {
                        self.own.entry(of).or_default().push(handle);
                    }
                }
                Watched::Buffer { kept, at, word, bytes, capacity } => {
                    let written = &self.kept[kept][at..];
                    let row = if IN_PAIRS.contains(&name) { 2 } else { 1 };
                    let room = capacity.map_or(written.len(), |capacity| row * capacity * bytes);
                    assert!(untouched(&written[room..]), "{name}: beyond {capacity:?} {word}");
                    if word == "double" && !self.tape.wild && !MAY_GIVE_NAN.contains(&name) {
                        let number = |b: &[u8]| f64::from_ne_bytes(b.try_into().unwrap());
                        // Without a branch for each: what is traced takes long.
                        let found = written.chunks_exact(8).fold(false, |any, b| any | number(b).is_nan());
                        let nan = || written.chunks_exact(8).position(|b| number(b).is_nan());
                        assert!(!found, "{name}: entry {:?} is NaN", nan());
                    }
                }
                Watched::Struct { kept, of, size } => self.summarised(name, kept, of, size),
            }
        }
    }

    fn summarised(&mut self, name: &str, kept: usize, of: &Struct, size: usize) {
        let bytes = &self.kept[kept];
        assert!(untouched(&bytes[size..]), "{name}: beyond {size}");
        let (fields, full) = &layouts()[of.name];
        let filled = usize::from_ne_bytes(bytes[..8].try_into().unwrap());
        assert_eq!(filled, size.min(*full), "{name}");
        for &(field, kind, start, count) in
            fields.iter().filter(|(_, kind, start, _)| start + kind.size() <= filled)
        {
            for at in (0..count).map(|k| start + 8 * k).filter(|at| at + kind.size() <= filled) {
                match kind {
                    Kind::F64 if !MAY_BE_NAN.contains(&(of.name, field)) => {
                        let x = f64::from_ne_bytes(bytes[at..at + 8].try_into().unwrap());
                        assert!(!x.is_nan(), "{name}: {field} is NaN");
                    }
                    Kind::Text => {
                        let place = u64::from_ne_bytes(bytes[at..at + 8].try_into().unwrap());
                        let says = !text(place as *const c_char).is_empty();
                        assert!(
                            says || MAY_BE_EMPTY.contains(&(of.name, field)),
                            "{name}: {field} says nothing"
                        );
                    }
                    // An object that the call has made, and that this session releases.
                    Kind::Own(made) => {
                        let handle = u64::from_ne_bytes(bytes[at..at + 8].try_into().unwrap());
                        if handle != 0 {
                            self.own.entry(made).or_default().push(handle);
                        }
                    }
                    _ => {}
                }
            }
        }
    }
}

/// The number of faces of a mesh.
fn faces(mesh: u64) -> usize {
    let (fields, full) = &layouts()["ricci_mesh_summary"];
    let mut bytes = vec![0_u8; *full];
    let answer = (call("ricci_mesh_summarise").run)(&[mesh, word(bytes.as_mut_ptr()), *full as u64]);
    assert_eq!(status(answer), 0);
    let start = fields.iter().find(|(name, ..)| *name == "n_faces").unwrap().2;
    usize::from_ne_bytes(bytes[start..start + 8].try_into().unwrap())
}

/// Make the shared handles, and check that every function that takes a handle refuses NULL.
pub fn prepare() {
    shared::handles();
    for (call, of) in CALLS.iter().zip(parameters()) {
        if matches!(of.first(), Some((_, Kind::Handle(_)))) {
            // A thread that uses no control is told so with NULL.
            let expected = if call.name == "ricci_control_use" { 0 } else { NULL_STATUS };
            assert_eq!(status((call.run)(&vec![0; of.len()])), expected, "{}", call.name);
        }
    }
}

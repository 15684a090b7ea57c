//! Archives: objects of any type as bytes and files, which read back as they were.

use crate::archive_records::{ArchiveOrigin, ArchivedHandle};
use crate::arrays::{self, copy_out};
use crate::charts::ricci_charts;
use crate::circle_domain::ricci_circle_domain;
use crate::control;
use crate::failure::{Failure, Outcome};
use crate::forms::ricci_forms;
use crate::guard::{self, boxed, handle, shared};
use crate::layout::ricci_layout;
#[cfg(not(all(feature = "quads", feature = "splines")))]
use crate::left_out::QuadSplineLeftOut as ricci_quad_spline;
#[cfg(not(feature = "splines"))]
use crate::left_out::SplineLeftOut as ricci_spline;
#[cfg(not(feature = "quads"))]
use crate::left_out::{
    QuadLayoutLeftOut as ricci_quad_layout, QuadsLeftOut as ricci_quads, SeamlessLeftOut as ricci_seamless,
};
use crate::map::ricci_map;
use crate::matching::ricci_matching;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::ricci_metric;
#[cfg(feature = "quads")]
use crate::quad_layout::ricci_quad_layout;
#[cfg(all(feature = "quads", feature = "splines"))]
use crate::quad_spline::ricci_quad_spline;
#[cfg(feature = "quads")]
use crate::quads::ricci_quads;
#[cfg(feature = "quads")]
use crate::seamless::ricci_seamless;
#[cfg(feature = "splines")]
use crate::spline::ricci_spline;
use crate::status::*;
use crate::structs::{self, sized};
use crate::structure::ricci_structure;
use crate::uniformize::ricci_uniform;
use ricci::archive::{ArchiveFrame, FORMAT, Kept, to_bytes, write_atomically};
use ricci::control::Stage;
use std::ffi::{CString, c_char, c_void};
use std::io::Write;
use std::mem::offset_of;
use std::ptr::null_mut;

pub struct ricci_archive {
    /// A whole archive, whose frame was checked.
    bytes: Vec<u8>,
    /// The name of its file, for messages.
    path: String,
    kind: CString,
}
handle!(ricci_archive, "archive");

/// Most bytes per element of an object while it is written: 1,384 per vertex were measured for the archive of an atlas, which takes up to twice as much
/// while it grows, beside a copy of the object.
const WRITING: usize = 1 << 13;
/// Most bytes per byte of an archive while its object is made.
const READING: usize = 8;
/// The name of an archive that came from memory, for messages.
const IN_MEMORY: &str = "archive";

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_objects {
    pub size: usize,
    pub mesh: *mut ricci_mesh,
    pub metric: *mut ricci_metric,
    pub layout: *mut ricci_layout,
    pub charts: *mut ricci_charts,
    pub map: *mut ricci_map,
    pub uniform: *mut ricci_uniform,
    pub circle_domain: *mut ricci_circle_domain,
    pub forms: *mut ricci_forms,
    pub matching: *mut ricci_matching,
    pub structure: *mut ricci_structure,
    pub seamless: *mut ricci_seamless,
    pub quads: *mut ricci_quads,
    pub quad_layout: *mut ricci_quad_layout,
    pub quad_spline: *mut ricci_quad_spline,
    pub spline: *mut ricci_spline,
    pub target: *mut ricci_mesh,
    pub mirrored: u32,
    pub reserved: u32,
}
// SAFETY: a number and raw pointers; 8-byte alignment, size first.
sized!(ricci_objects, "objects", reserved);

const NONE: ricci_objects = ricci_objects {
    size: size_of::<ricci_objects>(),
    mesh: null_mut(),
    metric: null_mut(),
    layout: null_mut(),
    charts: null_mut(),
    map: null_mut(),
    uniform: null_mut(),
    circle_domain: null_mut(),
    forms: null_mut(),
    matching: null_mut(),
    structure: null_mut(),
    seamless: null_mut(),
    quads: null_mut(),
    quad_layout: null_mut(),
    quad_spline: null_mut(),
    spline: null_mut(),
    target: null_mut(),
    mirrored: 0,
    reserved: 0,
};

/// The name of the kind of a handle's archive.
fn kind_of<H: ArchivedHandle>() -> &'static str {
    <H::Record as Kept>::KIND
}

/// The archive of an object.
fn archived<H: ArchivedHandle>(object: *const H, is_mirrored: bool) -> Outcome<ricci_archive> {
    let object = shared(object)?;
    let _reserve = memory::work(object.n_elements(), WRITING)?;
    control::of_thread()?.step(Stage::Write, 0.2)?;
    let bytes = to_bytes(&object.record(is_mirrored));
    ricci_archive::new(bytes, IN_MEMORY.into())
}

/// The object of an archive, and those that it was made from, in the fields of their types. `end`: the byte of the caller's struct at which the field of
/// its own type ends.
fn restored<H: ArchivedHandle>(
    frame: &ArchiveFrame<'_>,
    end: usize,
    size: usize,
) -> Outcome<(H, ricci_objects)> {
    if end > size {
        let message = format!(
            "the caller's struct has no field for a {}: it was compiled for an older library",
            frame.kind
        );
        return Err(Failure::new(RICCI_STRUCT_SIZE, message));
    }
    let object = H::restored(frame.object()?)?;
    let ArchiveOrigin { mesh, target, layout } = object.origin();
    let fits = size >= size_of::<ricci_objects>();
    let layout = layout.filter(|_| fits).map(ricci_layout::restored).transpose()?;
    let (mesh, target) =
        (mesh.filter(|_| fits).map(ricci_mesh::of), target.filter(|_| fits).map(ricci_mesh::of));
    let mut objects = NONE;
    (objects.mesh, objects.target) = (mesh.map_or(null_mut(), boxed), target.map_or(null_mut(), boxed));
    objects.layout = layout.map_or(null_mut(), boxed);
    objects.mirrored = object.is_mirrored().into();
    Ok((object, objects))
}

/// The failure that a kind of object does not exist in this library.
fn no_such_kind(kind: &str) -> Failure {
    let is_complete = cfg!(all(feature = "quads", feature = "splines"));
    let status = if is_complete { RICCI_UNKNOWN_FORMAT } else { RICCI_LEFT_OUT };
    Failure::new(status, format!("this library has no objects of the kind `{}`", kind.escape_default()))
}

/// For every field of the objects its type, under the condition that the library has it.
macro_rules! fields {
    ($($(#[$have:meta])? $field:ident: $type:ty),* $(,)?) => {
        /// The archive of the one object that is given.
        fn archive_of(objects: &ricci_objects) -> Outcome<ricci_archive> {
            let given: &[*const c_void] = &[$(objects.$field.cast()),*];
            match given.iter().filter(|object| !object.is_null()).count() {
                0 => return Err(Failure::argument("objects has no object: one is needed")),
                1 => {}
                n => return Err(Failure::argument(format!("objects has {n} objects: one is needed"))),
            }
            $($(#[$have])? if !objects.$field.is_null() { return archived(objects.$field, objects.mirrored != 0); })*
            Err(no_such_kind("of the part that was left out"))
        }

        /// The object of an archive, for a caller's struct of this size.
        fn objects_of(frame: &ArchiveFrame<'_>, size: usize) -> Outcome<ricci_objects> {
            $($(#[$have])? if frame.kind == kind_of::<$type>() {
                let end = offset_of!(ricci_objects, $field) + size_of::<*mut $type>();
                let (object, others) = restored::<$type>(frame, end, size)?;
                return Ok(ricci_objects { $field: boxed(object), ..others });
            })*
            Err(no_such_kind(frame.kind))
        }
    };
}
fields! {
    mesh: ricci_mesh,
    metric: ricci_metric,
    layout: ricci_layout,
    charts: ricci_charts,
    map: ricci_map,
    uniform: ricci_uniform,
    circle_domain: ricci_circle_domain,
    forms: ricci_forms,
    matching: ricci_matching,
    structure: ricci_structure,
    #[cfg(feature = "quads")] seamless: ricci_seamless,
    #[cfg(feature = "quads")] quads: ricci_quads,
    #[cfg(feature = "quads")] quad_layout: ricci_quad_layout,
    #[cfg(all(feature = "quads", feature = "splines"))] quad_spline: ricci_quad_spline,
    #[cfg(feature = "splines")] spline: ricci_spline,
}

impl ricci_archive {
    /// The archive with these bytes, whose frame is checked.
    fn new(bytes: Vec<u8>, path: String) -> Outcome<ricci_archive> {
        let kind = ArchiveFrame::open(&bytes, &path)?.kind.to_owned();
        let kind = CString::new(kind).unwrap_or_default();
        Ok(ricci_archive { bytes, path, kind })
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_archive_summary {
    pub size: usize,
    pub kind: *const c_char,
    pub n_bytes: usize,
    pub format: u32,
    pub reserved: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_archive_summary, "summary", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_new(
    objects: *const ricci_objects,
    archive: *mut *mut ricci_archive,
) -> ricci_status {
    guard::make(archive, || archive_of(&structs::read(objects)?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_parse(
    bytes: *const u8,
    n_bytes: usize,
    archive: *mut *mut ricci_archive,
) -> ricci_status {
    guard::make(archive, || {
        control::of_thread()?.step(Stage::Read, 0.2)?;
        ricci_archive::new(arrays::array("bytes", bytes, n_bytes)?, IN_MEMORY.into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_read(
    path: *const c_char,
    archive: *mut *mut ricci_archive,
) -> ricci_status {
    guard::make(archive, || {
        let path = arrays::path(path)?;
        let _reserve = memory::file(&path)?;
        control::of_thread()?.step(Stage::Read, 0.2)?;
        let name = path.display().to_string();
        let failed = |e: std::io::Error| ricci::Error::Io { path: name.clone(), message: e.to_string() };
        let bytes = std::fs::read(&path).map_err(failed)?;
        ricci_archive::new(bytes, name)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_free(archive: *mut ricci_archive) {
    guard::free(archive);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_summarise(
    archive: *const ricci_archive,
    summary: *mut ricci_archive_summary,
    size: usize,
) -> ricci_status {
    guard::with(archive, |ricci_archive { bytes, kind, .. }| {
        let figures = ricci_archive_summary {
            size,
            kind: kind.as_ptr(),
            n_bytes: bytes.len(),
            format: FORMAT,
            reserved: 0,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_bytes(
    archive: *const ricci_archive,
    bytes: *mut u8,
    capacity: usize,
) -> ricci_status {
    guard::with(archive, |archive| copy_out("bytes", &archive.bytes, bytes, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_write(
    archive: *const ricci_archive,
    path: *const c_char,
) -> ricci_status {
    guard::with(archive, |archive| {
        let path = arrays::path(path)?;
        control::of_thread()?.step(Stage::Write, 0.2)?;
        Ok(write_atomically(&path, |out| out.write_all(&archive.bytes))?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_archive_objects(
    archive: *const ricci_archive,
    objects: *mut ricci_objects,
    size: usize,
) -> ricci_status {
    guard::with(archive, |ricci_archive { bytes, path, .. }| {
        structs::check_place(objects, size)?;
        let _reserve = memory::work(bytes.len(), READING)?;
        control::of_thread()?.step(Stage::Read, 0.2)?;
        let restored = objects_of(&ArchiveFrame::open(bytes, path)?, size)?;
        structs::write(restored, objects, size)
    })
}

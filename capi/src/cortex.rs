//! Inflated views, and parts of a surface that are laid flat: cortices without their medial wall.

use crate::arrays::{self, copy_out};
use crate::control::{self, ricci_control};
use crate::guard;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::ricci_status;
use crate::structs::or;
use ricci::Control;
use ricci::flatten::{InflateOptions, flat_part, inflate, medial_wall};

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_inflate(
    mesh: *const ricci_mesh,
    time: f64,
    steps: usize,
    control: *const ricci_control,
    positions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let threads = control::threads(control);
        let control: Control = control::of(control)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let usual = InflateOptions::default();
        let options = InflateOptions { time: or(time, usual.time), steps: or(steps, usual.steps), threads };
        let found = inflate(mesh.surface()?, &options, &control)?;
        copy_out("positions", &found, positions, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_medial_wall(
    mesh: *const ricci_mesh,
    view: *const f64,
    n_view: usize,
    medial: *const f64,
    share: f64,
    is_wall: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let view = arrays::ambient("view", view, n_view)?;
        let medial = arrays::ambient("medial", medial, 1)?[0];
        let found = medial_wall(mesh.surface()?, &view, medial, share)?;
        copy_out("is_wall", &numbers(&found), is_wall, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flat_part(
    mesh: *const ricci_mesh,
    marked: *const u32,
    n_marked: usize,
    is_kept: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let marked: Vec<u32> = arrays::array("marked", marked, n_marked)?;
        let marked: Vec<bool> = marked.into_iter().map(|mark| mark != 0).collect();
        let found = flat_part(mesh.surface()?, &marked)?;
        copy_out("is_kept", &numbers(&found), is_kept, capacity)
    })
}

/// 1 for true and 0 for false.
fn numbers(flags: &[bool]) -> Vec<u32> {
    flags.iter().map(|&flag| flag.into()).collect()
}

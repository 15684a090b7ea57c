//! Scenes of glTF that stay scenes.

use crate::arrays;
use crate::control::{self, ricci_control};
use crate::failure::Failure;
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::optional::{SceneFile, SceneOptions, SceneReport, write_with_tangents};
use crate::soup::ricci_soup;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use crate::texture_atlas::{ricci_texture_atlas, ricci_texture_options};
use ricci::control::Stage;
use std::ffi::c_char;

pub struct ricci_scene(SceneFile);
handle!(ricci_scene, "scene", |scene| scene.0.soup().positions.len().max(scene.0.soup().faces.len()));

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_scene_summary {
    pub size: usize,
    pub n_nodes: usize,
    pub n_meshes: usize,
    pub n_primitives: usize,
    pub n_materials: usize,
    pub n_vertices: usize,
    pub n_faces: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_scene_summary, "summary");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_scene_options {
    pub size: usize,
    pub texcoord: i32,
    pub tangents: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_scene_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_scene_report {
    pub size: usize,
    pub texcoord: usize,
    pub n_primitives: usize,
    pub n_vertices: usize,
    pub n_split_vertices: usize,
    pub n_replaced: usize,
    pub n_kept_textures: usize,
    pub n_misplaced_textures: usize,
    pub n_tangents: usize,
    pub n_without_tangents: usize,
    pub n_dropped_tangents: usize,
    pub n_unrolled: usize,
    pub n_shared_meshes: usize,
    pub n_notes: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_scene_report, "report");

impl ricci_scene_options {
    /// The library's options: 0 is its choice of a set, a negative number the set 0.
    fn read(&self) -> SceneOptions {
        let texcoord = (self.texcoord != 0).then(|| u32::try_from(self.texcoord).unwrap_or(0));
        SceneOptions { texcoord, tangents: self.tangents != 0 }
    }
}

impl ricci_scene_report {
    fn of(report: &SceneReport) -> ricci_scene_report {
        ricci_scene_report {
            size: size_of::<ricci_scene_report>(),
            texcoord: report.texcoord as usize,
            n_primitives: report.n_primitives,
            n_vertices: report.n_vertices,
            n_split_vertices: report.n_split_vertices,
            n_replaced: report.n_replaced,
            n_kept_textures: report.n_kept_textures,
            n_misplaced_textures: report.n_misplaced_textures,
            n_tangents: report.n_tangents,
            n_without_tangents: report.n_without_tangents,
            n_dropped_tangents: report.n_dropped_tangents,
            n_unrolled: report.n_unrolled,
            n_shared_meshes: report.n_shared_meshes,
            n_notes: report.notes.len(),
        }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_scene_read(path: *const c_char, scene: *mut *mut ricci_scene) -> ricci_status {
    guard::make(scene, || {
        let path = arrays::path(path)?;
        let _reserve = memory::file(&path)?;
        control::of_thread()?.step(Stage::Read, 0.0)?;
        Ok(ricci_scene(SceneFile::open(&path)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_scene_free(scene: *mut ricci_scene) {
    guard::free(scene);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_scene_summarise(
    scene: *const ricci_scene,
    summary: *mut ricci_scene_summary,
    size: usize,
) -> ricci_status {
    guard::with(scene, |ricci_scene(scene)| {
        let [n_nodes, n_meshes, n_primitives, n_materials] = scene.counts();
        let soup = scene.soup();
        let (n_vertices, n_faces) = (soup.positions.len(), soup.faces.len());
        let counts =
            ricci_scene_summary { size, n_nodes, n_meshes, n_primitives, n_materials, n_vertices, n_faces };
        structs::write(counts, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_scene_texture_atlas(
    scene: *const ricci_scene,
    options: *const ricci_texture_options,
    control: *const ricci_control,
    atlas: *mut *mut ricci_texture_atlas,
) -> ricci_status {
    guard::make(atlas, || {
        let (given, ricci_scene(scene)) = (structs::read(options)?, shared(scene)?);
        ricci_texture_atlas::new(scene.soup(), Some(scene.meshes()), given, control)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_scene_write(
    scene: *const ricci_scene,
    atlas: *const ricci_texture_atlas,
    options: *const ricci_scene_options,
    path: *const c_char,
    report: *mut ricci_scene_report,
    size: usize,
) -> ricci_status {
    guard::with(scene, |ricci_scene(scene)| {
        let (options, uv) = (structs::read(options)?.read(), shared(atlas)?.corner_uv());
        let path = arrays::path(path)?;
        structs::check_place(report, size)?;
        if uv.len() != scene.soup().faces.len() {
            return Err(Failure::argument("atlas: it is not that of this scene, which has other faces"));
        }
        control::of_thread()?.step(Stage::Write, 0.2)?;
        let made = scene.write(&path, uv, &options)?;
        for note in &made.notes {
            log::warn!("{}: {note}", path.display());
        }
        structs::write(ricci_scene_report::of(&made), report, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_write_with_tangents(
    soup: *const ricci_soup,
    path: *const c_char,
) -> ricci_status {
    guard::with(soup, |list| {
        let path = arrays::path(path)?;
        control::of_thread()?.step(Stage::Write, 0.2)?;
        for what in write_with_tangents(&path, &list.soup)? {
            log::warn!("{}: left out: {what}", path.display());
        }
        Ok(())
    })
}

//! Texture atlases of whole models.

use crate::arrays::{check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::soup::ricci_soup;
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::mesh::io::Soup;
use ricci::texture::{SeamSplitModel, TextureAtlas, TextureOptions, texture_atlas, texture_atlas_of_parts};

choices!(enum FaceList, LISTS = "which", [
    RICCI_TEXTURE_PLACELESS => Placeless,
    RICCI_TEXTURE_FOLDED => Folded,
    RICCI_TEXTURE_OVERLAPPING => Overlapping,
    RICCI_TEXTURE_TURNED => Turned,
]);

pub struct ricci_texture_atlas {
    atlas: TextureAtlas,
    /// The model, with the coordinates of the atlas.
    model: Soup,
    split: SeamSplitModel,
    page: u32,
}
handle!(ricci_texture_atlas, "texture atlas", |atlas| {
    atlas.model.positions.len().max(atlas.model.faces.len())
});

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_texture_options {
    pub size: usize,
    pub stretch: f64,
    pub fill: f64,
    pub page: u32,
    pub margin: i32,
    pub threads: usize,
    pub density: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_texture_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_texture_atlas_summary {
    pub size: usize,
    pub n_faces: usize,
    pub n_sheets: usize,
    pub n_opened_edges: usize,
    pub n_charts: usize,
    pub n_split_faces: usize,
    pub n_split_vertices: usize,
    pub n_placeless: usize,
    pub n_folded: usize,
    pub n_overlapping: usize,
    pub n_turned: usize,
    pub page: usize,
    pub stretch_l2: f64,
    pub stretch_max: f64,
    pub stretch_99: f64,
    pub angle_mean: f64,
    pub angle_99: f64,
    pub log_area_deviation: f64,
    pub seam_length: f64,
    pub fill: f64,
    pub texel_density: f64,
    pub n_pages: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_texture_atlas_summary, "summary");

impl ricci_texture_options {
    /// The library's options: zeros are its defaults, negative numbers stand for zero.
    fn read(&self) -> TextureOptions {
        let usual = TextureOptions::default();
        let margin = match self.margin {
            0 => usual.margin,
            given => u32::try_from(given).unwrap_or(0),
        };
        TextureOptions {
            stretch: or(self.stretch, usual.stretch),
            margin,
            page: or(self.page, usual.page),
            // NaN is refused by the library, with a message.
            fill: if self.fill < 0.0 { 0.0 } else { or(self.fill, usual.fill) },
            threads: self.threads,
            density: self.density,
        }
    }
}

impl ricci_texture_atlas {
    /// The atlas of a model, of several parts if they are given for each vertex.
    pub(crate) fn new(
        soup: &Soup,
        parts: Option<&[u32]>,
        given: ricci_texture_options,
        control: *const ricci_control,
    ) -> Outcome<ricci_texture_atlas> {
        let (threads, control) = (control::threads(control), control::of(control)?);
        let mut options = given.read();
        options.threads = or(options.threads, threads);
        let n = soup.positions.len().max(soup.faces.len().div_ceil(2));
        let _reserve = memory::work(n, memory::UNIFORM)?;
        let atlas = match parts {
            Some(parts) => texture_atlas_of_parts(soup, parts, &options, &control)?,
            None => texture_atlas(soup, &options, &control)?,
        };
        log::info!("texture atlas: {} charts, {:.3} of the page filled", atlas.charts, atlas.quality.fill);
        let split = atlas.split(&soup.faces);
        let mut model = soup.clone();
        model.attributes.uv = Some(atlas.corner_uv.clone());
        Ok(ricci_texture_atlas { atlas, model, split, page: options.page })
    }

    /// The coordinates of the corners of the model's faces.
    pub(crate) fn corner_uv(&self) -> &[[[f64; 2]; 3]] {
        &self.atlas.corner_uv
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_new(
    soup: *const ricci_soup,
    options: *const ricci_texture_options,
    control: *const ricci_control,
    atlas: *mut *mut ricci_texture_atlas,
) -> ricci_status {
    guard::make(atlas, || {
        let given = structs::read(options)?;
        ricci_texture_atlas::new(&shared(soup)?.soup, None, given, control)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_free(atlas: *mut ricci_texture_atlas) {
    guard::free(atlas);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_summarise(
    atlas: *const ricci_texture_atlas,
    summary: *mut ricci_texture_atlas_summary,
    size: usize,
) -> ricci_status {
    guard::with(atlas, |of| {
        let ricci_texture_atlas { atlas, split, page, .. } = of;
        let quality = &atlas.quality;
        let figures = ricci_texture_atlas_summary {
            size,
            n_faces: atlas.chart.len(),
            n_sheets: atlas.sheets,
            n_opened_edges: atlas.opened_edges,
            n_charts: atlas.charts,
            n_split_faces: split.faces.len(),
            n_split_vertices: split.uv.len(),
            n_placeless: atlas.placeless.len(),
            n_folded: atlas.folded.len(),
            n_overlapping: atlas.overlapping.len(),
            n_turned: atlas.turned.len(),
            page: *page as usize,
            stretch_l2: quality.stretch_l2,
            stretch_max: quality.stretch_max,
            stretch_99: quality.stretch_99,
            angle_mean: quality.angle_mean,
            angle_99: quality.angle_99,
            log_area_deviation: quality.log_area_deviation,
            seam_length: quality.seam_length,
            fill: quality.fill,
            texel_density: quality.texel_density,
            n_pages: atlas.pages,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_uv(
    atlas: *const ricci_texture_atlas,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(atlas, |of| copy_out("uv", &of.atlas.corner_uv, uv, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_charts(
    atlas: *const ricci_texture_atlas,
    charts: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(atlas, |of| copy_out("charts", &of.atlas.chart, charts, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_pages(
    atlas: *const ricci_texture_atlas,
    pages: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(atlas, |of| {
        let found: Vec<u32> = (0..of.atlas.chart.len()).map(|f| of.atlas.page(f)).collect();
        copy_out("pages", &found, pages, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_faces(
    atlas: *const ricci_texture_atlas,
    which: u32,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(atlas, |of| {
        let found = match LISTS.choose(which)? {
            FaceList::Placeless => &of.atlas.placeless,
            FaceList::Folded => &of.atlas.folded,
            FaceList::Overlapping => &of.atlas.overlapping,
            FaceList::Turned => &of.atlas.turned,
        };
        copy_out("faces", found, faces, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_split(
    atlas: *const ricci_texture_atlas,
    corners: *mut u32,
    corners_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
    vertices: *mut u32,
    vertices_capacity: usize,
    uv: *mut f64,
    uv_capacity: usize,
) -> ricci_status {
    guard::with(atlas, |of| {
        let split = &of.split;
        check_buffer("faces", split.face_origin.len(), faces, faces_capacity)?;
        check_buffer("vertices", split.vertex_origin.len(), vertices, vertices_capacity)?;
        check_buffer("uv", 2 * split.uv.len(), uv, uv_capacity)?;
        copy_out("corners", &split.faces, corners, corners_capacity)?;
        copy_out("faces", &split.face_origin, faces, faces_capacity)?;
        copy_out("vertices", &split.vertex_origin, vertices, vertices_capacity)?;
        copy_out("uv", &split.uv, uv, uv_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_texture_atlas_soup(
    atlas: *const ricci_texture_atlas,
    soup: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(soup, || Ok(ricci_soup::new(shared(atlas)?.model.clone())))
}

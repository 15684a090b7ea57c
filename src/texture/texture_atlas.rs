//! The texture atlas of a model, from its triangles to the page.

use super::atlas_model::AtlasModel;
use super::division::{divide_to_fill, divide_to_fit};
use super::flat_chart::{ChartFaces, FlatChart};
use super::opening::{alone, laid_flat};
use super::options::TextureOptions;
use super::page_packing::{MOST_PAGES, MOST_TEXELS, PackedPage, Packing, page_at, tile_of};
use super::quality::{FaceMap, TextureQuality, face_map};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::complex::doubled_area;
use crate::geometry::predicates::orientation;
use crate::geometry::triangle_overlap::{TriangleCorners, overlapping};
use crate::geometry::vector::distance;
use crate::mesh::Point;
use crate::mesh::io::Soup;
use crate::mesh::sheets::{Sheet, SheetList};
use crate::parallel;
use std::cmp::Ordering;
use std::collections::HashMap;

/// Coordinates are multiples of the inverse of this number, which numbers of 32 bits below 1 hold without rounding: the files that have
/// these and those that have 64 bits hold the same map.
const GRID: f64 = (1u64 << 24) as f64;
/// The same for several pages, whose tiles have coordinates below 16.
const TILE_GRID: f64 = (1u64 << 20) as f64;
/// The most times that faces which rounding folds are taken out of their charts. Faces that fold even then get no place.
const MENDINGS: usize = 4;
/// Least height, in steps of the grid, of a face that no rounding folds: its corner and the side across move by half the diagonal of a step
/// each, before, and by as much in the coordinates by which the height is measured.
const SAFE_STEPS: f64 = 3.0;
/// Least length of such a face in texels, and least height in its length.
const LEAST_TEXELS: f64 = 0.1;
const LEAST_HEIGHT: f64 = 0.02;
/// Largest coordinates of models that are laid out as they are: products of four lengths neither overflow nor lose digits.
const MODERATE: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
/// A model with texture coordinates on its own faces.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureAtlas {
    /// Per face of the model, in its order, the coordinates of its corners in the unit square: multiples of 2⁻²⁴. With several pages they are
    /// in the tiles of UDIM, multiples of 2⁻²⁰: page p has u from p mod 10 and v from ⌊p / 10⌋, so that its number there is 1001 + p.
    pub corner_uv: Vec<TriangleCorners>,
    /// The number of pages, at most 160; 1 unless a density is asked for.
    pub pages: usize,
    /// Per face its chart; charts are numbered by their area, the largest first. [`TextureAtlas::NO_CHART`] for a face without a place.
    pub chart: Vec<u32>,
    /// The number of charts.
    pub charts: usize,
    /// The faces without a place: with a corner that is missing or not finite, with two corners in one place, or so thin that rounding to
    /// the grid folds them in charts of their own too. Their coordinates are 0.
    pub placeless: Vec<u32>,
    /// The faces that are turned over or without area on the page, by exact arithmetic on [`TextureAtlas::corner_uv`]. There are none: faces
    /// that rounding to the grid folds, some thousand times thinner than a texel, get charts of their own, or else no place.
    pub folded: Vec<u32>,
    /// The faces whose interior meets that of an earlier face on the page, by exact arithmetic. There are none.
    pub overlapping: Vec<u32>,
    /// The faces whose corners run clockwise on the page because they run against those of most faces around them.
    pub turned: Vec<u32>,
    /// The edges of the model with several faces along which it was opened because it is no surface there.
    pub opened_edges: usize,
    /// The sheets of the model: connected pieces that are surfaces.
    pub sheets: usize,
    /// Stretch, seams and fill.
    pub quality: TextureQuality,
}

impl TextureAtlas {
    /// The chart of a face without a place.
    pub const NO_CHART: u32 = u32::MAX;

    /// The page of a face; 0 for one without a place.
    pub fn page(&self, face: usize) -> u32 {
        page_at(self.corner_uv[face][0])
    }
}

/// A texture atlas for any triangle list: every face keeps its number and gets a place.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] for an option outside its range; [`Error::Layout`] for a model of which no face has an area; [`Error::Cancelled`].
pub fn texture_atlas(soup: &Soup, options: &TextureOptions, control: &Control) -> Result<TextureAtlas> {
    of_model(soup, None, options, control)
}

/// [`texture_atlas`] of a model of several parts on one page, such as the meshes of a scene: vertices are of the same part where `parts`, with an
/// entry for each vertex, has the same number. No chart joins two parts, also where they touch, and texels have one size on all.
///
/// # Errors
/// As [`texture_atlas`], and [`Error::Size`] for another number of entries.
pub fn texture_atlas_of_parts(
    soup: &Soup,
    parts: &[u32],
    options: &TextureOptions,
    control: &Control,
) -> Result<TextureAtlas> {
    of_model(soup, Some(parts), options, control)
}

fn of_model(
    soup: &Soup,
    parts: Option<&[u32]>,
    options: &TextureOptions,
    control: &Control,
) -> Result<TextureAtlas> {
    options.check()?;
    let (moderate, factor) = at_moderate_size(soup);
    let model = AtlasModel::new(moderate.as_ref().unwrap_or(soup), parts)?;
    parallel::within(options.threads, || {
        control.step(Stage::Build, 0.0)?;
        let found = model.sheets();
        let mut charts = all_charts(model.soup, &found.sheets, options, control)?;
        if charts.is_empty() {
            return Err(Error::Layout(
                "no face of the model has a place: there is nothing to lay out".into(),
            ));
        }
        control.step(Stage::Layout, 0.6)?;
        let options = &options.for_scaled(factor);
        if options.density > 0.0 {
            let page = packed_page(options);
            divide_to_fit(&mut charts, &page, options.scale(page.texels), control)?;
        } else {
            divide_to_fill(&mut charts, options, control)?;
        }
        let mut atlas = packed(model, &found, &mut charts, options, control)?;
        for _ in 0..MENDINGS {
            if atlas.folded.is_empty() && atlas.overlapping.is_empty() {
                break;
            }
            take_out(&mut charts, &atlas);
            match packed(model, &found, &mut charts, options, control) {
                // A small page has no room for so many charts: these faces get no place.
                Err(Error::Layout(_)) => break,
                mended => atlas = mended?,
            }
        }
        let mut atlas = without_bad(atlas, model, options.page, control)?;
        atlas.quality.texel_density *= factor;
        control.finish();
        Ok(atlas)
    })
}

/// A model whose size has squares outside the range of numbers, times a power of two, and that power; no other model for 1.
fn at_moderate_size(soup: &Soup) -> (Option<Soup>, f64) {
    let sizes = soup.positions.as_flattened().iter().map(|x| x.abs()).filter(|x| x.is_finite());
    let most = sizes.fold(0.0, f64::max);
    if most == 0.0 || MODERATE.contains(&most) {
        return (None, 1.0);
    }
    let factor = (-most.log2().floor()).clamp(-1000.0, 1000.0).exp2();
    let positions = soup.positions.iter().map(|p| p.map(|x| factor * x)).collect();
    (Some(Soup::new(positions, soup.faces.clone())), factor)
}

/// The charts, sorted, on their page.
fn packed(
    model: AtlasModel<'_>,
    found: &SheetList,
    charts: &mut [FlatChart],
    options: &TextureOptions,
    control: &Control,
) -> Result<TextureAtlas> {
    charts.sort_by(|a, b| b.area().total_cmp(&a.area()).then(a.part.faces[0].cmp(&b.part.faces[0])));
    let page = packed_page(options);
    let packing = match options.density > 0.0 {
        true => page.pack_at(charts, options.scale(page.texels), control)?.ok_or_else(too_many_pages)?,
        false => page.pack(charts, 0.0, control)?.ok_or_else(no_room)?,
    };
    control.step(Stage::Layout, 0.9)?;
    let mut atlas = on_page(model.soup, charts, &packing, page.texels as f64);
    // Charts have the corners of a turned face in the other order.
    let turned: Vec<u32> = (0..model.soup.faces.len() as u32).filter(|f| found.turned[*f as usize]).collect();
    turned.iter().for_each(|f| atlas.corner_uv[*f as usize].swap(1, 2));
    let placeless = found.placeless.clone();
    let (opened_edges, sheets) = (found.opened_edges, found.sheets.len());
    TextureAtlas { turned, placeless, opened_edges, sheets, ..atlas }.checked(model, options.page, control)
}

/// The atlas, in which faces that are folded or overlap others have lost their places.
fn without_bad(
    mut atlas: TextureAtlas,
    model: AtlasModel<'_>,
    page: u32,
    control: &Control,
) -> Result<TextureAtlas> {
    if atlas.folded.is_empty() && atlas.overlapping.is_empty() {
        return Ok(atlas);
    }
    for f in [&atlas.folded[..], &atlas.overlapping[..]].concat() {
        atlas.corner_uv[f as usize] = [[0.0; 2]; 3];
        atlas.chart[f as usize] = TextureAtlas::NO_CHART;
        atlas.placeless.push(f);
    }
    atlas.placeless.sort_unstable();
    atlas.placeless.dedup();
    let mut used: Vec<u32> = atlas.chart.iter().copied().filter(|k| *k != TextureAtlas::NO_CHART).collect();
    used.sort_unstable();
    used.dedup();
    for chart in atlas.chart.iter_mut().filter(|k| **k != TextureAtlas::NO_CHART) {
        *chart = used.partition_point(|k| *k < *chart) as u32;
    }
    atlas.charts = used.len();
    atlas.checked(model, page, control)
}

/// The inverse of the step of the coordinates.
fn grid(pages: usize) -> f64 {
    if pages > 1 { TILE_GRID } else { GRID }
}

/// True for a face whose height on the page is so small that another rounding could fold it.
fn is_at_risk(uv: TriangleCorners, grid: f64) -> bool {
    let longest = (0..3).map(|k| {
        let [p, q] = [uv[k], uv[(k + 1) % 3]];
        (p[0] - q[0]).hypot(p[1] - q[1])
    });
    doubled_area(uv).abs() * grid < SAFE_STEPS * longest.fold(0.0, f64::max)
}

/// Gives each face that rounding folds or lets overlap, or could fold elsewhere, a chart of its own, wide enough for the grid.
fn take_out(charts: &mut Vec<FlatChart>, atlas: &TextureAtlas) {
    let is_folded =
        |f: &u32| atlas.folded.binary_search(f).is_ok() || atlas.overlapping.binary_search(f).is_ok();
    let least = LEAST_TEXELS * atlas.quality.texel_length();
    let mut kept = Vec::with_capacity(charts.len());
    for chart in std::mem::take(charts) {
        let is_alone = chart.part.faces.len() == 1;
        let is_bad = |f: &u32| {
            is_folded(f) || (!is_alone && is_at_risk(atlas.corner_uv[*f as usize], grid(atlas.pages)))
        };
        let bad: Vec<bool> = chart.part.faces.iter().map(is_bad).collect();
        if !bad.contains(&true) {
            kept.push(chart);
            continue;
        }
        // Each bad face has a number of its own; the others have those of their pieces.
        let n = bad.len() as u32;
        let pieces = chart.part.pieces_without(&bad);
        let number: Vec<u32> =
            (0..n).map(|f| if bad[f as usize] { f } else { n + pieces[f as usize] }).collect();
        for (part, origins) in chart.part.parts(&number) {
            let points = origins.iter().map(|&v| chart.points[v as usize]).collect();
            let is_alone = part.faces.len() == 1 && is_bad(&part.faces[0]);
            kept.push(if is_alone { alone(part, [least, LEAST_HEIGHT]) } else { FlatChart { part, points } });
        }
    }
    *charts = kept;
}

/// The page with the most texels in which charts are packed.
fn packed_page(options: &TextureOptions) -> PackedPage {
    let texels = (options.page as usize).min(MOST_TEXELS);
    let margin = (options.margin as usize * texels).div_ceil(options.page as usize);
    PackedPage { texels, margin, is_thorough: true }
}

fn too_many_pages() -> Error {
    let message =
        format!("the charts need more than {MOST_PAGES} pages: take larger ones or a smaller density");
    Error::Layout(message)
}

fn no_room() -> Error {
    Error::Layout("the charts find no room on the page: take a larger page or a smaller margin".into())
}

/// The flat charts of all sheets.
fn all_charts(
    soup: &Soup,
    sheets: &[Sheet],
    options: &TextureOptions,
    control: &Control,
) -> Result<Vec<FlatChart>> {
    let flat = parallel::map(sheets.len(), |k| {
        let Sheet { faces, corners, origins } = sheets[k].clone();
        let positions: Vec<Point> = origins.iter().map(|&v| soup.positions[v as usize]).collect();
        laid_flat(ChartFaces { faces, corners, positions }, options, control)
    });
    let mut all = Vec::new();
    for charts in flat {
        all.extend(charts?);
    }
    Ok(all)
}

/// The coordinates on the page.
fn on_page(soup: &Soup, charts: &[FlatChart], packing: &Packing, texels: f64) -> TextureAtlas {
    let n = soup.faces.len();
    let pages = packing.n_pages();
    let grid = grid(pages);
    let mut atlas = TextureAtlas {
        pages,
        corner_uv: vec![[[0.0; 2]; 3]; n],
        chart: vec![TextureAtlas::NO_CHART; n],
        charts: charts.len(),
        placeless: Vec::new(),
        folded: Vec::new(),
        overlapping: Vec::new(),
        turned: Vec::new(),
        opened_edges: 0,
        sheets: 0,
        quality: TextureQuality::default(),
    };
    for (k, (chart, place)) in charts.iter().zip(&packing.places).enumerate() {
        let rounded = |x: f64| (x / texels * grid).round().clamp(0.0, grid - 1.0) / grid;
        let tile = tile_of(packing.pages[k]);
        let on_tile = |p: [f64; 2]| [0, 1].map(|c| tile[c] + rounded(p[c]));
        let points: Vec<[f64; 2]> =
            chart.points.iter().map(|p| on_tile(place.of(*p, packing.scale))).collect();
        for (&f, corners) in chart.part.faces.iter().zip(&chart.part.corners) {
            atlas.corner_uv[f as usize] = corners.map(|v| points[v as usize]);
            atlas.chart[f as usize] = k as u32;
        }
    }
    atlas
}

impl TextureAtlas {
    /// The atlas with its checks and figures.
    fn checked(mut self, model: AtlasModel<'_>, page: u32, control: &Control) -> Result<TextureAtlas> {
        let is_placed = |f: &u32| self.chart[*f as usize] != TextureAtlas::NO_CHART;
        let is_folded = |f: &u32| {
            let [a, b, c] = self.corner_uv[*f as usize];
            let wanted =
                if self.turned.binary_search(f).is_ok() { Ordering::Less } else { Ordering::Greater };
            orientation(a, b, c) != wanted
        };
        self.folded = (0..self.chart.len() as u32).filter(is_placed).filter(is_folded).collect();
        self.overlapping =
            overlapping(&self.corner_uv, &control.still())?.into_iter().map(|f| f as u32).collect();
        let map = |f: u32| {
            let corners = model.soup.faces[f as usize].map(|v| model.point(v));
            let flat = self.corner_uv[f as usize];
            face_map(corners, flat).filter(|_| doubled_area(flat) != 0.0)
        };
        let placed = (0..self.chart.len() as u32).filter(is_placed);
        let maps: Vec<FaceMap> = placed.filter_map(map).collect();
        self.quality = TextureQuality::new(&maps, self.seam_length(model), page);
        self.quality.fill /= self.pages as f64;
        Ok(self)
    }

    /// The length of the seams: of each edge once for each pair of faces that have other coordinates there than all pairs before; of n faces
    /// (n + 1)/2 can be continued by none.
    fn seam_length(&self, model: AtlasModel<'_>) -> f64 {
        let key = |v: u32| model.place(v);
        let mut edges: HashMap<[([u64; 3], u32); 2], SeamEdge> = HashMap::new();
        for (f, corners) in model.soup.faces.iter().enumerate() {
            if self.chart[f] == TextureAtlas::NO_CHART {
                continue;
            }
            for k in 0..3 {
                let ends = [k, (k + 1) % 3].map(|k| (corners[k], self.corner_uv[f][k]));
                let ends = if key(ends[0].0) <= key(ends[1].0) { ends } else { [ends[1], ends[0]] };
                let edge = edges.entry(ends.map(|end| key(end.0))).or_insert_with(|| {
                    let [a, b] = ends.map(|end| model.point(end.0));
                    SeamEdge { length: distance(a, b), faces: 0, places: Vec::new() }
                });
                edge.faces += 1;
                let uv = ends.map(|end| end.1);
                if !edge.places.contains(&uv) {
                    edge.places.push(uv);
                }
            }
        }
        let mut lengths: Vec<f64> = edges.values().map(SeamEdge::seam).filter(|l| *l > 0.0).collect();
        // Sums do not depend on the order of a hash table.
        lengths.sort_by(f64::total_cmp);
        // From 0, since the sum of no numbers is −0.
        lengths.iter().fold(0.0, |sum, l| sum + l)
    }
}

/// An edge of the model with the places of its faces' sides on the page.
struct SeamEdge {
    length: f64,
    faces: usize,
    places: Vec<[[f64; 2]; 2]>,
}

impl SeamEdge {
    fn seam(&self) -> f64 {
        self.length * self.places.len().saturating_sub(self.faces.div_ceil(2)) as f64
    }
}

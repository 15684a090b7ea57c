//! Charts in a square page, by their shapes: the largest first, each where its top is lowest, into holes of others too.

use super::flat_chart::FlatChart;
use super::page_bits::{MaskRow, TexelMask};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::packing::{convex_hull, least_rectangle, least_square};
use crate::parallel;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The texels along a side in which charts are packed at most: those of a larger page are packed in blocks.
pub(super) const MOST_TEXELS: usize = 1024;
/// The number of charts up to which each is tried in twice as many directions.
const FEW_CHARTS: usize = 16;
/// The number of charts above which each is tried in four directions, and above which in two.
const FEW_DIRECTIONS: [usize; 2] = [48, 200];
/// Relative step of the share of the page that is filled at which the search for the largest ends.
const SHARE_STEP: f64 = 0.01;
/// The largest share that is tried: charts of straight sides can come near.
const MOST_SHARE: f64 = 0.97;
/// The share that is tried first where nothing is known, and the factors between those that follow while nothing, and while something, finds room.
const FIRST_SHARE: f64 = 0.62;
const LESS: f64 = 0.88;
const MORE: f64 = 1.05;
/// The least share that is tried: less of a page than its margins.
const LEAST_SHARE: f64 = 1e-6;

/// The most pages: those of ten columns and sixteen rows of tiles.
pub(super) const MOST_PAGES: usize = 160;
/// The columns of tiles in UDIM.
const COLUMNS: u32 = 10;

/// The lower left corner of the tile of a page.
pub(super) fn tile_of(page: u32) -> [f64; 2] {
    [page % COLUMNS, page / COLUMNS].map(f64::from)
}

/// The page of the tile with this point.
pub(super) fn page_at([u, v]: [f64; 2]) -> u32 {
    u as u32 + COLUMNS * v as u32
}

/// A page in texels.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedPage {
    pub texels: usize,
    /// Least number of free texels between two charts.
    pub margin: usize,
    /// True if several orders and more directions of the charts are tried.
    pub is_thorough: bool,
}

/// Where a chart lies: its points turned by the angle, times the scale, moved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PagePlace {
    pub angle: f64,
    pub shift: [f64; 2],
}

/// All charts on a page.
#[derive(Debug, Clone)]
pub(super) struct Packing {
    /// Texels per unit of length.
    pub scale: f64,
    pub places: Vec<PagePlace>,
    /// Per chart its page.
    pub pages: Vec<u32>,
    /// The share of the pages that the charts' areas fill.
    pub fill: f64,
}

impl Packing {
    pub fn n_pages(&self) -> usize {
        self.pages.iter().max().map_or(1, |last| *last as usize + 1)
    }
}

/// A chart in one direction.
struct TurnedMask {
    angle: f64,
    low: [f64; 2],
    mask: TexelMask,
    /// Of the mask with its margin.
    rows: Vec<MaskRow>,
}

/// The points of a chart in one direction, with the least whole numbers of texels and the texels along both axes.
struct TurnedPoints {
    points: Vec<[f64; 2]>,
    low: [f64; 2],
    size: [usize; 2],
}

/// Charts with the angles that are tried for each, at one scale.
#[derive(Clone, Copy)]
struct ScaledCharts<'a> {
    charts: &'a [FlatChart],
    directions: &'a [Vec<f64>],
    scale: f64,
}

impl PagePlace {
    pub fn of(&self, p: [f64; 2], scale: f64) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        [scale * (cos * p[0] - sin * p[1]) + self.shift[0], scale * (sin * p[0] + cos * p[1]) + self.shift[1]]
    }
}

impl PackedPage {
    /// The free texels at each side of the page.
    fn edge(&self) -> usize {
        self.margin / 2
    }

    /// The texels along a side between those edges.
    fn room(&self) -> usize {
        self.texels - 2 * self.edge()
    }

    /// The largest charts, all with one scale, that find room. `above`: the share of the page from which the search begins; none if charts
    /// of that share find no room, with `above` 0 always some.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn pack(&self, charts: &[FlatChart], above: f64, control: &Control) -> Result<Option<Packing>> {
        let area: f64 = charts.iter().map(FlatChart::area).sum();
        if !(area > 0.0 && area.is_finite()) {
            return Ok(None);
        }
        let directions = self.directions(charts);
        let orders = if self.is_thorough { orders(charts) } else { orders(charts)[..1].to_vec() };
        let accuracy = if self.is_thorough { SHARE_STEP } else { 2.0 * SHARE_STEP };
        let at = |share: f64| -> Result<Option<Packing>> {
            let scale = (share / area).sqrt() * self.texels as f64;
            for order in &orders {
                let scaled = ScaledCharts { charts, directions: &directions, scale };
                if let Some(places) = self.placed(&scaled, order, control)? {
                    let pages = vec![0; charts.len()];
                    return Ok(Some(Packing { scale, places, pages, fill: share }));
                }
            }
            Ok(None)
        };
        let (mut low, mut high) = (above.min(MOST_SHARE), MOST_SHARE);
        let mut best = None;
        if above == 0.0 {
            let mut share = FIRST_SHARE;
            while best.is_none() && share > LEAST_SHARE {
                best = at(share)?;
                (low, high) = if best.is_some() { (share, high) } else { (0.0, share) };
                share *= LESS;
            }
        } else {
            best = at(low)?;
        }
        let mut step = if above == 0.0 { MORE } else { 1.0 + 2.0 * accuracy };
        while best.is_some() && high > (1.0 + accuracy) * low {
            let share = if low * step < high { low * step } else { 0.5 * (low + high) };
            match at(share)? {
                Some(found) => (best, low) = (Some(found), share),
                None => high = share,
            }
            step = 1.0 + 2.0 * (step - 1.0);
        }
        Ok(best)
    }

    /// The angle at which a chart at this scale is no larger than the page: along its least square, or its least rectangle; none without.
    pub fn fitting(&self, chart: &FlatChart, scale: f64) -> Option<f64> {
        let hull = convex_hull(&chart.points);
        let angles = [least_square(&hull).0, least_rectangle(&hull).0];
        angles.into_iter().find(|angle| self.turned(chart, *angle, scale).is_some())
    }

    /// Charts at a scale, each on the first page that has room for it; none if they need more than [`MOST_PAGES`], or one is larger than a page.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn pack_at(&self, charts: &[FlatChart], scale: f64, control: &Control) -> Result<Option<Packing>> {
        let directions = self.directions(charts);
        let (mut masks, mut used): (Vec<TexelMask>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut places = vec![PagePlace::default(); charts.len()];
        let mut pages = vec![0; charts.len()];
        for &k in &orders(charts)[0] {
            control.check()?;
            // Of many charts few directions are tried, and of a large one all may be too long.
            let angles = [&directions[k][..], self.fitting(&charts[k], scale).as_slice()].concat();
            let turned = parallel::map(angles.len(), |d| self.mask(&charts[k], angles[d], scale));
            // A page with fewer free texels than the chart has no room for it, which is seen without a search.
            let least = turned.iter().flatten().map(|one| one.mask.count()).min().unwrap_or(0);
            let known = (0..masks.len())
                .filter(|p| used[*p] + least <= self.room() * self.room())
                .find_map(|p| Some((p, self.lowest(&masks[p], &turned)?)));
            let (page, (which, [x, y])) = match known {
                Some(found) => found,
                None if masks.len() == MOST_PAGES => return Ok(None),
                None => {
                    masks.push(self.empty());
                    used.push(0);
                    let Some(found) = self.lowest(&masks[masks.len() - 1], &turned) else { return Ok(None) };
                    (masks.len() - 1, found)
                }
            };
            let Some(chosen) = &turned[which] else { return Ok(None) };
            masks[page].add(&chosen.mask, [x + self.margin, y + self.margin]);
            used[page] += chosen.mask.count();
            places[k] = self.place(chosen, [x, y]);
            pages[k] = page as u32;
        }
        let area: f64 = charts.iter().map(FlatChart::area).sum();
        let fill = area * scale * scale / (self.texels * self.texels * masks.len().max(1)) as f64;
        Ok(Some(Packing { scale, places, pages, fill }))
    }

    /// A page without charts.
    fn empty(&self) -> TexelMask {
        TexelMask::new(self.room() + 2 * self.margin, self.room() + 2 * self.margin)
    }

    /// The place of a chart whose mask has its first bit at (x, y).
    fn place(&self, chosen: &TurnedMask, at: [usize; 2]) -> PagePlace {
        let shift = [0, 1].map(|c| (at[c] + self.edge()) as f64 - chosen.low[c]);
        PagePlace { angle: chosen.angle, shift }
    }

    /// The places of charts, added in an order; none if one of them finds no room.
    fn placed(
        &self,
        scaled: &ScaledCharts<'_>,
        order: &[usize],
        control: &Control,
    ) -> Result<Option<Vec<PagePlace>>> {
        let ScaledCharts { charts, directions, scale } = *scaled;
        let mut page = self.empty();
        let mut places = vec![PagePlace::default(); charts.len()];
        for &k in order {
            control.check()?;
            let turned =
                parallel::map(directions[k].len(), |d| self.mask(&charts[k], directions[k][d], scale));
            let Some((which, [x, y])) = self.lowest(&page, &turned) else { return Ok(None) };
            let Some(chosen) = &turned[which] else { return Ok(None) };
            page.add(&chosen.mask, [x + self.margin, y + self.margin]);
            places[k] = self.place(chosen, [x, y]);
        }
        Ok(Some(places))
    }

    /// The direction and place in which the top of a chart is lowest, of equal ones the leftmost.
    fn lowest(&self, page: &TexelMask, turned: &[Option<TurnedMask>]) -> Option<(usize, [usize; 2])> {
        let room = self.room();
        // The lowest top so far: a place above it is not the lowest, whichever thread finds it.
        let lowest = AtomicUsize::new(room);
        let places = parallel::map(turned.len(), |d| {
            let one = turned[d].as_ref()?;
            let [width, height] = [one.mask.width, one.mask.height];
            let n = room - width + 1;
            for y in 0..=room - height {
                if y + height > lowest.load(Ordering::Relaxed) {
                    return None;
                }
                if let Some(x) = page.free_place(&one.rows, y, n).filter(|x| *x < n) {
                    lowest.fetch_min(y + height, Ordering::Relaxed);
                    return Some((y + height, x, d, y));
                }
            }
            None
        });
        let (_, x, d, y) = places.into_iter().flatten().min()?;
        Some((d, [x, y]))
    }

    /// The texels of a chart in one direction; none if they are more than those of the page.
    fn mask(&self, chart: &FlatChart, angle: f64, scale: f64) -> Option<TurnedMask> {
        let TurnedPoints { points, low, size } = self.turned(chart, angle, scale)?;
        let mut mask = TexelMask::new(size[0], size[1]);
        for corners in &chart.part.corners {
            mask.cover(corners.map(|v| [0, 1].map(|c| points[v as usize][c] - low[c])));
        }
        let rows = mask.grown(self.margin).spread_rows();
        Some(TurnedMask { angle, low, mask, rows })
    }

    /// The points of a chart in one direction; none if they touch more texels than the page has.
    fn turned(&self, chart: &FlatChart, angle: f64, scale: f64) -> Option<TurnedPoints> {
        let turn = PagePlace { angle, shift: [0.0; 2] };
        let points: Vec<[f64; 2]> = chart.points.iter().map(|p| turn.of(*p, scale)).collect();
        let bound = |c: usize, pick: fn(f64, f64) -> f64| points.iter().map(|p| p[c]).reduce(pick);
        let low = [bound(0, f64::min)?, bound(1, f64::min)?].map(f64::floor);
        let high = [bound(0, f64::max)?, bound(1, f64::max)?];
        let size = [0, 1].map(|c| ((high[c] - low[c]).floor() as usize).saturating_add(1));
        size.iter().all(|s| *s <= self.room()).then_some(TurnedPoints { points, low, size })
    }

    /// Per chart the angles that are tried: sides of the least rectangle along the axes, those of the least square, and halfway between.
    fn directions(&self, charts: &[FlatChart]) -> Vec<Vec<f64>> {
        let quarters = match charts.len() {
            n if n > FEW_DIRECTIONS[1] => 2,
            _ => 4,
        };
        let of = |chart: &FlatChart| {
            let hull = convex_hull(&chart.points);
            let (along, square) = (least_rectangle(&hull).0, least_square(&hull).0);
            let mut starts = vec![along];
            if charts.len() <= FEW_DIRECTIONS[0] {
                starts.extend([square, along + FRAC_PI_4]);
            }
            if self.is_thorough && charts.len() <= FEW_CHARTS {
                starts.extend([1, 2, 4, 5].map(|k| along + FRAC_PI_2 * f64::from(k) / 6.0));
            }
            let turned = |start: f64| (0..quarters).map(move |k| start + FRAC_PI_2 * f64::from(k));
            starts.into_iter().flat_map(turned).collect()
        };
        charts.iter().map(of).collect()
    }
}

/// The orders in which charts are placed: those with the longest box first, and those with the largest area.
fn orders(charts: &[FlatChart]) -> Vec<Vec<usize>> {
    let box_sides = |chart: &FlatChart| least_rectangle(&chart.points).1;
    let sizes: [Vec<f64>; 3] = [
        charts.iter().map(|chart| box_sides(chart).iter().sum()).collect(),
        charts.iter().map(FlatChart::area).collect(),
        charts.iter().map(|chart| box_sides(chart)[0]).collect(),
    ];
    let by = |size: &Vec<f64>| {
        let mut order: Vec<usize> = (0..charts.len()).collect();
        order.sort_by(|&i, &j| size[j].total_cmp(&size[i]).then(i.cmp(&j)));
        order
    };
    let mut orders: Vec<Vec<usize>> = sizes.iter().map(by).collect();
    orders.dedup();
    orders
}

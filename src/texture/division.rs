//! Charts that are divided at their waists: for a page that is filled better, or because one is larger than a page.

use super::cross_cut::waist;
use super::flat_chart::FlatChart;
use super::options::TextureOptions;
use super::page_packing::PackedPage;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::packing::{least_rectangle, least_square};
use crate::mesh::Mesh;

/// The texels along a side at which divisions of charts are tried.
const TRIAL_TEXELS: usize = 256;
/// The least gain of the filled share, per division, by which divisions stay.
const WORTH_DIVIDING: f64 = 0.01;
/// The divisions in a row without such a gain after which no further one is tried.
const WITHOUT_GAIN: u32 = 5;
/// The part of the share filled before that charts with one more division have to fill to be divided further.
const MAY_LOSE: f64 = 0.8;
/// Charts that are tried at each division for what their boxes leave empty.
const WASTEFUL: usize = 2;
/// The most charts of a page that is filled by divisions: more fill it by themselves.
const MOST_CHARTS: usize = 64;

/// Divides charts at their waists as long as the page is filled better for it.
pub(super) fn divide_to_fill(
    charts: &mut Vec<FlatChart>,
    options: &TextureOptions,
    control: &Control,
) -> Result<()> {
    if options.fill == 0.0 || charts.len() > MOST_CHARTS {
        return Ok(());
    }
    let texels = (options.page as usize).min(TRIAL_TEXELS);
    // Texels that are touched in part already keep charts apart about as far as the margin does on the whole page.
    let page = PackedPage { texels, margin: 0, is_thorough: false };
    let Some(first) = page.pack(charts, 0.0, control)? else { return Ok(()) };
    let (mut now, mut best, mut since) = (charts.clone(), first.fill, 0);
    let mut fill = best;
    while best < options.fill && since < WITHOUT_GAIN {
        let Some((tried, filled)) = best_division(&now, fill, &page, control)? else { break };
        (now, fill, since) = (tried, filled, since + 1);
        if fill > best + WORTH_DIVIDING * f64::from(since) {
            (*charts, best, since) = (now.clone(), fill, 0);
        }
    }
    Ok(())
}

/// The charts with one of the most wasteful ones divided: the one that fills most of the page for its length, and what is filled then; none
/// if each leaves much less filled than before.
fn best_division(
    charts: &[FlatChart],
    fill: f64,
    page: &PackedPage,
    control: &Control,
) -> Result<Option<(Vec<FlatChart>, f64)>> {
    let mut found: Option<(f64, Vec<FlatChart>, f64)> = None;
    for k in candidates(charts) {
        let Some((parts, cost)) = divided(&charts[k]) else { continue };
        let mut tried = charts.to_vec();
        tried.splice(k..=k, parts);
        let Some(packing) = page.pack(&tried, MAY_LOSE * fill, control)? else { continue };
        let gain = packing.fill - fill;
        // Where none helps at once, the largest chart is divided: it keeps all others small.
        let is_first = found.is_none();
        let worth = if gain > WORTH_DIVIDING {
            gain / cost
        } else if is_first {
            0.0
        } else {
            gain.min(0.0) - WORTH_DIVIDING
        };
        if found.as_ref().is_none_or(|known| worth > known.0) {
            found = Some((worth, tried, packing.fill));
        }
    }
    Ok(found.map(|(_, charts, fill)| (charts, fill)))
}

/// The charts that may be divided for the page: the one that needs the largest square, and those with the largest part of their boxes empty.
fn candidates(charts: &[FlatChart]) -> Vec<usize> {
    let measure = |chart: &FlatChart| {
        let [long, short] = least_rectangle(&chart.points).1;
        [least_square(&chart.points).1[0], long * long.min(4.0 * short) - chart.area()]
    };
    let measured: Vec<[f64; 2]> = charts.iter().map(measure).collect();
    let by = |k: usize| {
        let mut order: Vec<usize> = (0..charts.len()).collect();
        order.sort_by(|&i, &j| measured[j][k].total_cmp(&measured[i][k]).then(i.cmp(&j)));
        order
    };
    let largest = by(0)[0];
    let wasteful = by(1).into_iter().filter(|&k| k != largest).take(WASTEFUL);
    std::iter::once(largest).chain(wasteful).collect()
}

/// A chart divided at its waist, and the length of the cut.
fn divided(chart: &FlatChart) -> Option<(Vec<FlatChart>, f64)> {
    let mesh: Mesh = chart.part.mesh().ok()?;
    let cut = waist(chart, &mesh)?;
    Some((chart.apart(&mesh, |e| cut.is_cut[e]), cut.length))
}

/// Divides charts until each finds room on a page, all at this scale.
///
/// # Errors
/// [`Error::Layout`] for a face that is larger than a page; [`Error::Cancelled`].
pub(super) fn divide_to_fit(
    charts: &mut Vec<FlatChart>,
    page: &PackedPage,
    scale: f64,
    control: &Control,
) -> Result<()> {
    let mut open: Vec<FlatChart> = std::mem::take(charts);
    open.reverse();
    while let Some(chart) = open.pop() {
        control.check()?;
        if page.fitting(&chart, scale).is_some() {
            charts.push(chart);
            continue;
        }
        if let [face] = chart.part.faces[..] {
            return Err(Error::Layout(format!(
                "face {face} is larger than a page at this density: take larger pages or fewer texels for a unit"
            )));
        }
        let parts = divided(&chart).map_or_else(|| faces_alone(&chart), |(parts, _)| parts);
        open.extend(parts.into_iter().rev());
    }
    Ok(())
}

/// Every face of a chart as one of its own.
fn faces_alone(chart: &FlatChart) -> Vec<FlatChart> {
    let number: Vec<u32> = (0..chart.part.faces.len() as u32).collect();
    let placed = |(part, origins): (_, Vec<u32>)| {
        let points = origins.iter().map(|&v| chart.points[v as usize]).collect();
        FlatChart { part, points }
    };
    chart.part.parts(&number).into_iter().map(placed).collect()
}

//! The squares of a quad mesh embedded in the surface, so that no two overlap.

use super::grid_charts::GridCharts;
use super::grid_distortion::{Advance, advanced, least_distorted};
use super::grid_lines::straight_lines;
use super::grid_map::{GridMap, TimedPlaces};
use super::grid_places::{MetricPlace, vertex_places};
use super::grid_surface::GridSurface;
use super::separation::Separation;
use super::t_mesh::TMesh;
use crate::control::Control;
use crate::error::Result;

/// Most parts into which the sides of unit squares are divided for them to embed.
const MOST_PARTS: usize = 8;
/// Most squares that are divided ones.
const MOST_SQUARES: usize = 4_000;

/// A quad mesh by the squares of a T-mesh, and the places of its vertices.
pub(super) struct EmbeddedSquares<'a> {
    pub charts: GridCharts<'a>,
    /// Per vertex its place on the metric's triangulation.
    pub places: Vec<MetricPlace>,
}

/// Squares that are embedded, or the rectangles in which they fold.
pub(super) enum Embedding<'a> {
    /// The squares.
    Embedded(EmbeddedSquares<'a>),
    /// The rectangles, ascending.
    Stuck(Vec<usize>),
}

/// Squares and their map.
struct MappedSquares<'a> {
    charts: GridCharts<'a>,
    map: GridMap,
}

impl<'a> EmbeddedSquares<'a> {
    /// The unit squares of these numbers, with sides divided in `parts`, embedded with little distortion, or the rectangles in which they
    /// fold even if they are divided further.
    ///
    /// # Errors
    /// Those of [`GridMap::new`] and [`vertex_places`]; [`crate::Error::Cancelled`].
    pub fn of_numbers(
        surface: &GridSurface,
        separation: &Separation<'a>,
        numbers: &[i64],
        parts: usize,
        control: &Control,
    ) -> Result<Embedding<'a>> {
        let t_mesh = separation.t_mesh;
        let squares = |parts: usize| MappedSquares::new(t_mesh, numbers, parts, separation);
        let mut mapped = squares(1)?;
        let whole_places = mapped.map.whole_places.clone();
        let mut found = TimedPlaces { time: 0.0, places: whole_places };
        let mut divided = 1;
        loop {
            let Advance { reached, stuck } = advanced(&mut mapped.map, found, &control.part(0.0, 0.6))?;
            found = reached;
            if found.time == 1.0 {
                break;
            }
            if divided == MOST_PARTS || 4 * mapped.charts.squares.len() > MOST_SQUARES {
                let mut rectangles: Vec<usize> =
                    stuck.iter().map(|&k| mapped.charts.rectangle[k] as usize).collect();
                rectangles.dedup();
                return Ok(Embedding::Stuck(rectangles));
            }
            divided *= 2;
            (mapped, found) = mapped.subdivided(squares(divided)?, &found, 2);
        }
        if divided < parts {
            (mapped, found) = mapped.subdivided(squares(parts)?, &found, parts / divided);
            divided = parts;
        }
        let places = least_distorted(&mut mapped.map, found.places, &control.part(0.6, 1.0))?;
        let places = vertex_places(surface, t_mesh, &mapped.charts, &mapped.map, &places)?;
        if divided == parts {
            return Ok(Embedding::Embedded(EmbeddedSquares { charts: mapped.charts, places }));
        }
        let charts = divided_charts(t_mesh, numbers, parts, separation);
        let vertices = mapped.charts.vertices_of(&charts, divided / parts);
        let places = vertices.into_iter().map(|v| places[v as usize]).collect();
        Ok(Embedding::Embedded(EmbeddedSquares { charts, places }))
    }

    /// The unit squares of positive numbers, with sides divided in `parts`, embedded with little distortion: from straight lines in every
    /// rectangle.
    ///
    /// # Errors
    /// Those of [`EmbeddedSquares::of_numbers`].
    pub fn of_positive(
        surface: &GridSurface,
        separation: &Separation<'a>,
        numbers: &[i64],
        parts: usize,
        control: &Control,
    ) -> Result<EmbeddedSquares<'a>> {
        let t_mesh = separation.t_mesh;
        let MappedSquares { charts, mut map } = MappedSquares::new(t_mesh, numbers, parts, separation)?;
        let places = straight_lines(t_mesh, &charts, &map);
        let places = least_distorted(&mut map, places, control)?;
        let places = vertex_places(surface, t_mesh, &charts, &map, &places)?;
        Ok(EmbeddedSquares { charts, places })
    }
}

/// The unit squares of these numbers with sides divided in `parts`.
fn divided_charts<'a>(
    t_mesh: &'a TMesh,
    numbers: &[i64],
    parts: usize,
    separation: &Separation<'_>,
) -> GridCharts<'a> {
    GridCharts::new(t_mesh, numbers.iter().map(|n| n * parts as i64).collect(), separation)
}

impl<'a> MappedSquares<'a> {
    /// # Errors
    /// Those of [`GridMap::new`].
    fn new(
        t_mesh: &'a TMesh,
        numbers: &[i64],
        parts: usize,
        separation: &Separation<'_>,
    ) -> Result<MappedSquares<'a>> {
        let charts = divided_charts(t_mesh, numbers, parts, separation);
        let on_grid: f64 = t_mesh.rectangles.iter().map(|r| r.size[0] as f64 * r.size[1] as f64).sum();
        let map = GridMap::new(&charts, (charts.squares.len() as f64 / on_grid).sqrt())?;
        Ok(MappedSquares { charts, map })
    }

    /// These squares and their places divided further.
    fn subdivided(
        &self,
        divided: MappedSquares<'a>,
        from: &TimedPlaces,
        parts: usize,
    ) -> (MappedSquares<'a>, TimedPlaces) {
        let parts_of = divided.charts.parts_of(&self.charts, parts);
        let places = divided.map.subdivided(&self.map, from, &parts_of);
        (divided, places)
    }
}

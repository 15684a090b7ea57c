//! The way from a seamless metric to quads: its T-mesh, whole numbers for a size of quads, and the quad mesh of these numbers.

use super::coarsening::coarsened;
use super::collapse::RawQuads;
use super::embedded_squares::EmbeddedSquares;
use super::grid_complex::GridComplex;
use super::grid_places::MetricPlace;
use super::grid_surface::GridSurface;
use super::options::QuadSize;
use super::quad_mesh::QuadMesh;
use super::quantisation::Quantisation;
use super::separation::Separation;
use super::t_mesh::TMesh;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::metric::curvature::area;
use crate::seamless::Seamless;

/// Rounds in which the edge length is changed to come near a number of quads.
const ROUNDS: usize = 5;
/// Share by which the number of quads may differ from the one that was asked for.
const NEAR_COUNT: f64 = 0.05;
/// Edge lengths, in lengths of the longest arc, that are tried where as few quads as possible are asked for: the longer, the less does the
/// length of an arc count against its number.
const COARSE_EDGES: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 8.0];
/// Factor and number of steps with which edges become longer until there are few enough quads.
const LONGER_EDGE: f64 = 1.25;
const LONGER_EDGES: usize = 12;
/// Edge lengths, in the same unit, that are tried one after the other where the squares of these fold.
const FINER_EDGES: [f64; 5] = [0.5, 0.25, 0.125, 0.0625, 0.03125];

/// A seamless metric with its T-mesh.
pub(super) struct QuadDivision<'a> {
    solution: &'a Solution,
    surface: GridSurface,
    t_mesh: TMesh,
    /// The length of a unit of the grid on the surface, where the map keeps the area.
    unit: f64,
    /// The area of the surface.
    area: f64,
}

/// Numbers for the arcs, with the edge length for which they are.
struct SizedNumbers {
    quantisation: Quantisation,
    edge: f64,
}

impl<'a> QuadDivision<'a> {
    /// # Errors
    /// Those of [`GridSurface::new`] and [`TMesh::new`].
    pub fn new(seamless: &'a Seamless, control: &Control) -> Result<QuadDivision<'a>> {
        let surface = GridSurface::new(seamless, control)?;
        let t_mesh = TMesh::new(&surface, control)?;
        let solution = &seamless.solution;
        let area = area(solution.given(), solution.initial().input_geometry, solution.surface().lengths())?;
        let on_grid: f64 = t_mesh.rectangles.iter().map(|r| r.size[0] as f64 * r.size[1] as f64).sum();
        Ok(QuadDivision { solution, surface, t_mesh, unit: (area / on_grid).sqrt(), area })
    }

    /// Whole numbers of the arcs for a size of quads; the next ones are for squares that fold with those before.
    ///
    /// # Errors
    /// Those of [`Quantisation::balanced`].
    fn quantised(
        &self,
        size: QuadSize,
        separation: &Separation<'_>,
        control: &Control,
        is_embedded: &mut dyn FnMut(SizedNumbers) -> Result<bool>,
    ) -> Result<()> {
        let is_apart = &mut |numbers: &[i64]| separation.holds(numbers);
        if !matches!(size, QuadSize::Coarse | QuadSize::AtMost(_)) {
            let mut found = self.near_size(size, separation, control)?;
            found.quantisation.descend(is_apart, control)?;
            is_embedded(found)?;
            return Ok(());
        }
        if let QuadSize::AtMost(most) = size
            && let Some(found) = self.at_most(most, separation, control)?
            && is_embedded(found)?
        {
            return Ok(());
        }
        let found = self.coarse(separation, control)?;
        let quantisation = coarsened(&found.quantisation, separation, control)?;
        let coarsest = SizedNumbers { quantisation, edge: found.edge };
        let least = self.n_squares(&coarsest);
        if let QuadSize::AtMost(most) = size
            && least > most
        {
            return Err(Error::Layout(format!(
                "the fewest quads that were found are {least}, more than asked for"
            )));
        }
        if is_embedded(coarsest)? {
            return Ok(());
        }
        if let QuadSize::AtMost(most) = size {
            if self.n_squares(&found) <= most && is_embedded(found)? {
                return Ok(());
            }
            let message =
                format!("those of at most {most} quads that were found fold on the surface: ask for more");
            return Err(Error::Layout(message));
        }
        if is_embedded(found)? {
            return Ok(());
        }
        for factor in FINER_EDGES {
            let mut found = self.near_size(self.edge(factor), separation, control)?;
            found.quantisation.descend(is_apart, control)?;
            if is_embedded(found)? {
                break;
            }
        }
        Ok(())
    }

    /// Numbers near the shortest edge length with at most so many squares, if one was found.
    fn at_most(
        &self,
        most: usize,
        separation: &Separation<'_>,
        control: &Control,
    ) -> Result<Option<SizedNumbers>> {
        let mut edge = (self.area / most as f64).sqrt();
        for _ in 0..LONGER_EDGES {
            let mut found = self.near_size(QuadSize::Edge(edge), separation, control)?;
            found.quantisation.descend(&mut |numbers| separation.holds(numbers), control)?;
            if self.n_squares(&found) <= most {
                return Ok(Some(found));
            }
            edge *= LONGER_EDGE;
        }
        Ok(None)
    }

    fn n_squares(&self, found: &SizedNumbers) -> usize {
        GridComplex::new(&self.t_mesh, &found.quantisation.numbers).n_squares()
    }

    /// An edge as long as the longest arc times a factor.
    fn edge(&self, factor: f64) -> QuadSize {
        let longest = self.t_mesh.arcs.iter().map(|arc| arc.length).max().unwrap_or(0);
        QuadSize::Edge(factor * longest as f64 * self.unit)
    }

    /// The numbers with the fewest squares of those near several edge lengths.
    fn coarse(&self, separation: &Separation<'_>, control: &Control) -> Result<SizedNumbers> {
        let is_apart = &mut |numbers: &[i64]| separation.holds(numbers);
        let mut best: Option<(usize, SizedNumbers)> = None;
        for factor in COARSE_EDGES {
            let mut found = self.near_size(self.edge(factor), separation, control)?;
            let mut other = found.quantisation.restarted(1, control)?;
            found.quantisation.descend(is_apart, control)?;
            other.descend(is_apart, control)?;
            let other = SizedNumbers { quantisation: other, edge: found.edge };
            for found in [found, other] {
                let n = self.n_squares(&found);
                if best.as_ref().is_none_or(|(least, _)| n < *least) {
                    best = Some((n, found));
                }
            }
        }
        best.map(|(_, found)| found).ok_or_else(|| Error::Layout("a T-mesh has no arcs".into()))
    }

    /// Numbers for a size of quads before any descent.
    fn near_size(
        &self,
        size: QuadSize,
        separation: &Separation<'_>,
        control: &Control,
    ) -> Result<SizedNumbers> {
        let of_edge = |edge: f64| -> Result<SizedNumbers> {
            let wanted = self.t_mesh.arcs.iter().map(|arc| arc.length as f64 * self.unit / edge).collect();
            let mut quantisation = Quantisation::balanced(&self.t_mesh, wanted, 0, control)?;
            separation.enforce(&mut quantisation, control)?;
            Ok(SizedNumbers { quantisation, edge })
        };
        let goal = match size {
            QuadSize::Edge(edge) => return of_edge(edge),
            QuadSize::Quads(n) | QuadSize::AtMost(n) => n as f64,
            QuadSize::Coarse => 1.0,
        };
        let ratio = |found: &SizedNumbers| self.n_squares(found) as f64 / goal;
        let mut found = of_edge((self.area / goal).sqrt())?;
        for _ in 0..ROUNDS {
            let now = ratio(&found);
            if (now - 1.0).abs() < NEAR_COUNT {
                break;
            }
            let next = of_edge(found.edge * now.sqrt())?;
            if ratio(&next).ln().abs() >= now.ln().abs() {
                break;
            }
            found = next;
        }
        Ok(found)
    }

    /// The quad mesh for a size of quads, each edge divided in `parts`. Where squares fold on the surface, as where many arcs have the length
    /// 0, other numbers are taken, and if nothing else helps all arcs get at least 1.
    ///
    /// # Errors
    /// Those of [`EmbeddedSquares::new`] and [`Quantisation::restarted`], and with `single_edges`, which asks for no two edges with the same
    /// ends, those of [`Separation::enforce_single_edges`]; [`Error::Cancelled`].
    pub fn mesh(
        &self,
        size: QuadSize,
        parts: u32,
        single_edges: bool,
        control: &Control,
    ) -> Result<QuadMesh> {
        let (surface, t_mesh) = (&self.surface, &self.t_mesh);
        let separation = Separation::new(surface, t_mesh);
        let (mut mesh, mut last) = (None, None);
        self.quantised(size, &separation, control, &mut |mut found| {
            if single_edges {
                separation.enforce_single_edges(&mut found.quantisation, control)?;
            }
            let numbers = &found.quantisation.numbers;
            if let Some(squares) = EmbeddedSquares::new(surface, t_mesh, numbers, parts as usize, control)? {
                mesh = Some(self.mesh_of(squares, &found, parts, control)?);
            }
            last = Some(found);
            Ok(mesh.is_some())
        })?;
        if let Some(mesh) = mesh {
            return Ok(mesh);
        }
        let Some(found) = last else { return Err(Error::Layout("a T-mesh has no arcs".into())) };
        let quantisation = found.quantisation.restarted(1, control)?;
        let raised = SizedNumbers { quantisation, edge: found.edge };
        let numbers = &raised.quantisation.numbers;
        let squares = EmbeddedSquares::of_positive(surface, t_mesh, numbers, parts as usize, control)?;
        self.mesh_of(squares, &raised, parts, control)
    }

    fn mesh_of(
        &self,
        squares: EmbeddedSquares<'_>,
        found: &SizedNumbers,
        parts: u32,
        control: &Control,
    ) -> Result<QuadMesh> {
        let EmbeddedSquares { charts, places: on_metric } = squares;
        let numbers = &found.quantisation.numbers;
        control.check()?;
        let mut is_border = vec![false; on_metric.len()];
        let mut creases = Vec::new();
        for a in (0..numbers.len()).filter(|&a| self.t_mesh.arcs[a].is_wall) {
            let vertices = charts.vertices_on_arc(a);
            creases.extend(vertices.windows(2).map(|pair| [pair[0], pair[1]]));
            if charts.is_border(a) {
                vertices.iter().for_each(|&v| is_border[v as usize] = true);
            }
        }
        let quads = charts.squares.iter().map(|square| square.map(|corner| corner.vertex)).collect();
        let mut raw = RawQuads { quads, rectangle: charts.rectangle, creases, is_border };
        let places = on_given(self.solution, on_metric, control)?;
        let (places, collapsed) = raw.collapse_single_corners(places);
        let RawQuads { quads, rectangle, creases, .. } = raw;
        Ok(QuadMesh {
            quads,
            places,
            rectangle,
            collapsed,
            t_mesh_size: [self.t_mesh.rectangles.len(), self.t_mesh.arcs.len()],
            creases,
            off_axis: self.surface.off_axis.clone(),
            cost: found.quantisation.cost(),
            edge: found.edge / f64::from(parts),
        })
    }
}

/// Places on the metric's triangulation as places on the surface as it came.
fn on_given(solution: &Solution, places: Vec<MetricPlace>, control: &Control) -> Result<Vec<MetricPlace>> {
    if solution.is_unflipped() {
        return Ok(places);
    }
    let subdivision = solution.common_subdivision(control)?;
    let back = subdivision.backward();
    let on = |(f, weights): MetricPlace| {
        let image = back.image(f, weights);
        image.ok_or_else(|| Error::Layout(format!("face {f} of the metric has no part of the surface")))
    };
    places.into_iter().map(on).collect()
}

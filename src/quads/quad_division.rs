//! The way from a seamless metric to quads: its T-mesh, whole numbers for a size of quads, and the quad mesh of these numbers.

use super::coarsening::coarsened;
use super::collapse::RawQuads;
use super::embedded_squares::{EmbeddedSquares, Embedding};
use super::grid_complex::GridComplex;
use super::grid_places::MetricPlace;
use super::grid_surface::GridSurface;
use super::options::QuadSize;
use super::quad_mesh::QuadMesh;
use super::quantisation::Quantisation;
use super::relaxation::Usable;
use super::separation::Separation;
use super::t_mesh::TMesh;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::metric::curvature::area;
use crate::parallel;
use crate::seamless::Seamless;

/// Rounds in which the edge length is changed to come near a number of quads.
const ROUNDS: usize = 5;
/// Share by which the number of quads may differ from the one that was asked for.
const NEAR_COUNT: f64 = 0.05;
/// Edge lengths, in lengths of the longest arc, that are tried where as few quads as possible are asked for: the longer, the less does the
/// length of an arc count against its number.
const COARSE_EDGES: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 8.0];
/// Attempts to embed squares, each with arcs above 0 where those before folded.
const MOST_ATTEMPTS: usize = 12;
/// Numbers of these from which a search for fewer quads begins.
const COARSE_STARTS: usize = 4;
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

/// The quads that are asked for.
struct Division {
    size: QuadSize,
    /// Parts into which each edge is divided.
    parts: u32,
    /// True if no two edges may have the same ends.
    single_edges: bool,
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
        control.step(Stage::Layout, 0.5)?;
        let t_mesh = TMesh::new(&surface, control)?;
        control.step(Stage::Layout, 1.0)?;
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
        match size {
            QuadSize::Edge(edge) => return is_embedded(self.nearest(edge, separation, control)?).map(drop),
            QuadSize::Quads(goal) => return is_embedded(self.about(goal, separation, control)?).map(drop),
            QuadSize::Coarse | QuadSize::AtMost(_) => {}
        }
        if let QuadSize::AtMost(most) = size
            && let Some(found) = self.at_most(most, separation, control)?
            && is_embedded(found)?
        {
            return Ok(());
        }
        let mut starts = self.coarse(separation, &control.part(0.0, 0.3))?;
        let coarsest = self.coarsest(&starts, separation, &control.part(0.3, 1.0))?;
        let found = starts.swap_remove(0);
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
            if is_embedded(self.nearest(self.edge(factor), separation, control)?)? {
                break;
            }
        }
        Ok(())
    }

    /// The numbers with the fewest squares that searches from these find.
    fn coarsest(
        &self,
        starts: &[SizedNumbers],
        separation: &Separation<'_>,
        control: &Control,
    ) -> Result<SizedNumbers> {
        let found = parallel::map(starts.len(), |i| coarsened(&starts[i].quantisation, separation, control));
        let mut best: Option<SizedNumbers> = None;
        for (quantisation, start) in found.into_iter().zip(starts) {
            let quantisation = quantisation?;
            if best.as_ref().is_none_or(|best| quantisation.value() < best.quantisation.value()) {
                best = Some(SizedNumbers { quantisation, edge: start.edge });
            }
        }
        best.ok_or_else(|| Error::Layout("a T-mesh has no arcs".into()))
    }

    /// Numbers near the wanted lengths for an edge length.
    fn nearest(&self, edge: f64, separation: &Separation<'_>, control: &Control) -> Result<SizedNumbers> {
        let mut found = self.start(edge, separation, control)?;
        lower(&mut found.quantisation, separation, control)?;
        Ok(found)
    }

    /// Numbers near the wanted lengths for the edge length with about so many squares, which is found by single descents.
    fn about(&self, goal: usize, separation: &Separation<'_>, control: &Control) -> Result<SizedNumbers> {
        let goal = goal as f64;
        let ratio = |found: &SizedNumbers| self.n_squares(found) as f64 / goal;
        let descended = |edge: f64| {
            let mut found = self.start(edge, separation, control)?;
            found.quantisation.descend(&mut |numbers| separation.holds(numbers), control)?;
            Ok(found)
        };
        let mut found = descended((self.area / goal).sqrt())?;
        for _ in 0..ROUNDS {
            let now = ratio(&found);
            if (now - 1.0).abs() < NEAR_COUNT {
                break;
            }
            let next = descended(found.edge * now.sqrt())?;
            if ratio(&next).ln().abs() >= now.ln().abs() {
                break;
            }
            found = next;
        }
        lower(&mut found.quantisation, separation, control)?;
        Ok(found)
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
            let found = self.nearest(edge, separation, control)?;
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
    fn edge(&self, factor: f64) -> f64 {
        let longest = self.t_mesh.arcs.iter().map(|arc| arc.length).max().unwrap_or(0);
        factor * longest as f64 * self.unit
    }

    /// The numbers with the fewest squares of those near several edge lengths, the best first.
    fn coarse(&self, separation: &Separation<'_>, control: &Control) -> Result<Vec<SizedNumbers>> {
        let is_apart = &mut |numbers: &[i64]| separation.holds(numbers);
        let mut all: Vec<(usize, SizedNumbers)> = Vec::new();
        for (k, factor) in COARSE_EDGES.into_iter().enumerate() {
            control.step(Stage::Layout, k as f64 / COARSE_EDGES.len() as f64)?;
            let mut found = self.start(self.edge(factor), separation, control)?;
            let mut other = found.quantisation.restarted(1, control)?;
            found.quantisation.descend(is_apart, control)?;
            other.descend(is_apart, control)?;
            let other = SizedNumbers { quantisation: other, edge: found.edge };
            for found in [found, other] {
                let is_new =
                    all.iter().all(|(_, known)| known.quantisation.numbers != found.quantisation.numbers);
                if is_new {
                    all.push((self.n_squares(&found), found));
                }
            }
        }
        all.sort_by_key(|(n, _)| *n);
        Ok(all.into_iter().take(COARSE_STARTS).map(|(_, found)| found).collect())
    }

    /// Numbers for an edge length before any descent, with cones apart.
    fn start(&self, edge: f64, separation: &Separation<'_>, control: &Control) -> Result<SizedNumbers> {
        let wanted = self.t_mesh.arcs.iter().map(|arc| arc.length as f64 * self.unit / edge).collect();
        let mut quantisation = Quantisation::balanced(&self.t_mesh, wanted, 0, control)?;
        separation.enforce(&mut quantisation, control)?;
        Ok(SizedNumbers { quantisation, edge })
    }

    /// The quad mesh for a size of quads, each edge divided in `parts`. Where squares fold on the surface, as where many arcs have the length
    /// 0, other numbers are taken, and if nothing else helps all arcs get at least 1.
    ///
    /// # Errors
    /// Those of [`EmbeddedSquares::of_numbers`] and [`Quantisation::restarted`], and with `single_edges`, which asks for no two edges with the same
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
        let embedding = control.part(0.5, 1.0);
        let division = Division { size, parts, single_edges };
        self.quantised(size, &separation, &control.part(0.0, 0.5), &mut |mut found| {
            mesh = self.embedded(&mut found, &division, &separation, &embedding)?;
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
        let squares = EmbeddedSquares::of_positive(surface, &separation, numbers, parts as usize, control)?;
        self.mesh_of(squares, &raised, parts, control)
    }

    /// The quad mesh of numbers; where its squares fold, of others with a longer arc there. None if they still fold after some attempts, or have
    /// more squares than asked for.
    fn embedded(
        &self,
        found: &mut SizedNumbers,
        division: &Division,
        separation: &Separation<'_>,
        control: &Control,
    ) -> Result<Option<QuadMesh>> {
        let Division { size, parts, single_edges } = *division;
        for _ in 0..MOST_ATTEMPTS {
            control.step(Stage::Layout, 0.0)?;
            if single_edges {
                separation.enforce_single_edges(&mut found.quantisation, control)?;
            }
            if matches!(size, QuadSize::AtMost(most) if self.n_squares(found) > most) {
                break;
            }
            let numbers = &found.quantisation.numbers;
            match EmbeddedSquares::of_numbers(&self.surface, separation, numbers, parts as usize, control)? {
                Embedding::Embedded(squares) => {
                    return self.mesh_of(squares, found, parts, control).map(Some);
                }
                Embedding::Stuck(rectangles) => {
                    if !separation.raise_near(&rectangles, &mut found.quantisation, control)? {
                        break;
                    }
                    found.quantisation.descend(&mut |numbers| separation.holds(numbers), control)?;
                }
            }
        }
        Ok(None)
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

/// Lowers the difference from the wanted lengths, with cones apart.
fn lower(numbers: &mut Quantisation, separation: &Separation<'_>, control: &Control) -> Result<()> {
    let usable = Usable {
        enforce: &mut |numbers| separation.enforce(numbers, control),
        holds: &mut |numbers| separation.holds(numbers),
    };
    numbers.lower(usable, control)
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

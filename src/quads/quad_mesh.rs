//! Quad meshes read off an integer-grid map, with places on the surface as it came.

use super::collapse::RawQuads;
use super::grid_complex::GridComplex;
use super::grid_surface::GridSurface;
use super::options::{QuadOptions, QuadSize};
use super::quantisation::Quantisation;
use super::rectangle_map::{MetricPlace, grid_places};
use super::separation::Separation;
use super::t_mesh::TMesh;
use super::t_mesh_node::NodeKey;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::mesh::{EdgeId, FaceId, Point};
use crate::metric::curvature::area;
use crate::parallel::Pool;
use crate::seamless::Seamless;

/// Rounds in which the edge length is changed to come near a number of quads.
const ROUNDS: usize = 5;
/// Share by which the number of quads may differ from the one that was asked for.
const NEAR_COUNT: f64 = 0.05;
/// Wanted lengths of arcs, in edges, where as few quads as possible are asked for.
const COARSEST: f64 = 1e-3;

/// A pure quad mesh on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadMesh {
    /// The corners of each quad, counterclockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
    /// Per vertex its place on the surface as it came: a face and barycentric coordinates in it.
    pub places: Vec<(FaceId, [f64; 3])>,
    /// Per quad the rectangle of the T-mesh that it is a part of.
    pub rectangle: Vec<u32>,
    /// The number of rectangles of the T-mesh, and of its arcs.
    pub t_mesh_size: [usize; 2],
    /// The number of quads that were collapsed because two of their sides were the same edge: those around cones of valence 1.
    pub collapsed: usize,
    /// Edges on features and on the boundary, each by its two vertices.
    pub creases: Vec<[u32; 2]>,
    /// Features that are not parallel to an axis exactly, so that edges need not run along them.
    pub off_axis: Vec<EdgeId>,
    /// The sum over the arcs of squared differences between edges and wanted lengths in edges.
    pub cost: f64,
    /// The edge length that was asked for, or found for a number of quads, in the units of the surface's lengths.
    pub edge: f64,
}

impl QuadMesh {
    /// The places of the vertices in space; none for a surface without positions.
    pub fn positions(&self, solution: &Solution) -> Option<Vec<Point>> {
        let (mesh, positions) = (solution.given(), solution.surface().positions()?);
        let at = |(f, weights): &(FaceId, [f64; 3])| {
            let corners = mesh.face_vertices(*f).map(|v| positions[v.index()]);
            [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum())
        };
        Some(self.places.iter().map(at).collect())
    }

    /// The number of quads around each vertex.
    pub fn valences(&self) -> Vec<u32> {
        let mut valence = vec![0; self.places.len()];
        self.quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        valence
    }
}

/// The quad mesh of a seamless metric: the motorcycle graph of its map, a whole number for each arc, and the integer points of the map in
/// which each rectangle has whole sides. Every vertex that is no cone or corner has four quads, two on the boundary.
///
/// # Errors
/// [`Error::Argument`] for a size that is not positive; [`Error::Layout`] for a metric that is not seamless (not converged);
/// [`Error::Cancelled`].
pub fn quad_mesh(seamless: &Seamless, options: &QuadOptions, control: &Control) -> Result<QuadMesh> {
    match options.size {
        QuadSize::Edge(edge) if !(edge > 0.0 && edge.is_finite()) => {
            return Err(Error::argument("edge", edge, "positive"));
        }
        QuadSize::Quads(0) => return Err(Error::argument("quads", 0, "positive")),
        _ => {}
    }
    Pool::new(options.threads)?.run(|| {
        let surface = GridSurface::new(seamless, control)?;
        let t_mesh = TMesh::new(&surface, control)?;
        let solution = &seamless.solution;
        let geometry = solution.initial().input_geometry;
        let given_area = area(solution.given(), geometry, solution.surface().lengths())?;
        let grid_area: f64 = t_mesh.rectangles.iter().map(|r| r.size[0] as f64 * r.size[1] as f64).sum();
        let unit = (given_area / grid_area).sqrt();
        let (numbers, edge, cost) = numbers(&surface, &t_mesh, options.size, [unit, given_area], control)?;
        let mut mesh = assemble(&surface, &t_mesh, &numbers, solution, control)?;
        (mesh.cost, mesh.edge) = (cost, edge);
        Ok(mesh)
    })
}

/// Whole numbers of the arcs, the edge length, and the cost. `scale`: length of a unit of the grid on the surface, and the surface's area.
fn numbers(
    surface: &GridSurface,
    t_mesh: &TMesh,
    size: QuadSize,
    [unit, given_area]: [f64; 2],
    control: &Control,
) -> Result<(Vec<i64>, f64, f64)> {
    let separation = Separation::new(surface, t_mesh);
    let quantised = |edge: f64| -> Result<Quantisation> {
        let wanted = t_mesh.arcs.iter().map(|arc| arc.length as f64 * unit / edge).collect();
        let mut found = Quantisation::balanced(t_mesh, wanted, 0, control)?;
        separation.enforce(&mut found, control)?;
        Ok(found)
    };
    let (mut edge, goal) = match size {
        QuadSize::Edge(edge) => (edge, None),
        QuadSize::Quads(n) => ((given_area / n as f64).sqrt(), Some(n as f64)),
        QuadSize::Coarse => {
            let longest = t_mesh.arcs.iter().fold(0.0f64, |top, arc| top.max(arc.length as f64));
            (2.0 * longest * unit, None)
        }
    };
    let mut found = quantised(edge)?;
    if let Some(goal) = goal {
        let count = |q: &Quantisation| GridComplex::new(t_mesh, &q.numbers).n_squares() as f64;
        let mut best = ((count(&found) / goal).ln().abs(), edge);
        for _ in 0..ROUNDS {
            let ratio = count(&found) / goal;
            if (ratio - 1.0).abs() < NEAR_COUNT {
                break;
            }
            edge *= ratio.sqrt();
            let next = quantised(edge)?;
            let off = (count(&next) / goal).ln().abs();
            if off >= best.0 {
                edge = best.1;
                break;
            }
            (found, best) = (next, (off, edge));
        }
    }
    let is_apart = &mut |numbers: &[i64]| separation.holds(numbers);
    found.descend(is_apart, control)?;
    if size == QuadSize::Coarse {
        let mut other = found.restarted(1, control)?;
        other.descend(is_apart, control)?;
        if other.cost() < found.cost() {
            found = other;
        }
    }
    separation.enforce_single_edges(&mut found, control)?;
    let cost = found.cost();
    Ok((found.numbers, edge, cost))
}

/// The quad mesh of these numbers.
fn assemble(
    surface: &GridSurface,
    t_mesh: &TMesh,
    numbers: &[i64],
    solution: &Solution,
    control: &Control,
) -> Result<QuadMesh> {
    let complex = GridComplex::new(t_mesh, numbers);
    let places = grid_places(surface, t_mesh, &complex, numbers)?;
    control.check()?;
    let mut same = complex.identified(complex.n_points);
    let (squares, rectangle) = complex.squares();
    // Of points that are the same, a vertex of the surface stands for all, else the first.
    let rank = |point: usize| match t_mesh.nodes.get(point) {
        Some(NodeKey::Vertex(_)) => 0,
        Some(_) => 1,
        None => 2,
    };
    let roots: Vec<u32> = (0..complex.n_points as u32).map(|p| same.root(p)).collect();
    let mut chosen: Vec<Option<usize>> = vec![None; complex.n_points];
    for (point, &root) in roots.iter().enumerate() {
        let known = &mut chosen[root as usize];
        if known.is_none_or(|other| rank(point) < rank(other)) {
            *known = Some(point);
        }
    }
    let mut number = vec![u32::MAX; complex.n_points];
    let mut on_metric: Vec<MetricPlace> = Vec::new();
    let mut vertex = |point: u32| -> Result<u32> {
        let root = roots[point as usize] as usize;
        if number[root] == u32::MAX {
            let place = chosen[root].and_then(|point| places[point]);
            let place = place.ok_or_else(|| Error::Layout(format!("grid point {point} has no place")))?;
            number[root] = on_metric.len() as u32;
            on_metric.push(place);
        }
        Ok(number[root])
    };
    let mut quads = Vec::with_capacity(squares.len());
    for [a, b, c, d] in squares {
        quads.push([vertex(a)?, vertex(b)?, vertex(c)?, vertex(d)?]);
    }
    let mut creases = Vec::new();
    for (a, arc) in t_mesh.arcs.iter().enumerate().filter(|(_, arc)| arc.is_wall) {
        debug_assert!(arc.is_wall);
        for k in 0..numbers[a] {
            creases.push([vertex(complex.arc_point(2 * a, k))?, vertex(complex.arc_point(2 * a, k + 1))?]);
        }
    }
    let mut raw = RawQuads { quads, rectangle, creases };
    let places = on_given(solution, on_metric, control)?;
    let (places, collapsed) = raw.collapse_single_corners(places);
    let RawQuads { quads, rectangle, creases } = raw;
    Ok(QuadMesh {
        quads,
        places,
        rectangle,
        collapsed,
        t_mesh_size: [t_mesh.rectangles.len(), t_mesh.arcs.len()],
        creases,
        off_axis: surface.off_axis.clone(),
        cost: 0.0,
        edge: 0.0,
    })
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

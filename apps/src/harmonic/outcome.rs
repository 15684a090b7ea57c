//! A harmonic map with its checks, its figures and its summary.

use super::args::{HarmonicArgs, HarmonicMethodChoice, MapTarget};
use crate::csv;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::report::{Checks, Done, Figures, InputSummary, timed};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::Control;
use ricci::geometry::complex::{distance, doubled_area};
use ricci::geometry::triangle_flatness::LEAST_RELATIVE_AREA;
use ricci::harmonic::{
    Domain, HarmonicMap, HeatOptions, MapConstraints, SphereMap, SphereMapOptions, SphereMethod,
    harmonic_map, heat_flow, planar, simple_domain, sphere_map,
};
use ricci::mesh::{FaceId, VertexId};
use ricci::metric::CommonSubdivision;
use std::collections::HashSet;

/// A map to the plane, carried back to the surface.
pub struct PlaneMap {
    pub map: HarmonicMap<2>,
    /// The vertices at the corners of a polygon or rectangle, its modulus, and the heat flow.
    course: MapCourse,
    /// The common subdivision of the domain's triangulation and the given one; none where they are the same.
    pub subdivision: Option<CommonSubdivision>,
    /// The image of each vertex of the subdivision.
    pub points: Vec<[f64; 2]>,
    /// The triangles that are written and turn over: pieces of the subdivision where there is one, else triangles of the domain.
    pub flipped: Vec<FaceId>,
    /// The number of triangles of the domain that turn over.
    pub flipped_in_domain: usize,
    /// The number of pieces without area.
    pub degenerate: usize,
}

/// What is known of a map to the plane beside the map.
#[derive(Default)]
struct MapCourse {
    /// The vertices at the corners of a polygon or rectangle.
    corners: Option<Vec<VertexId>>,
    /// The modulus of a rectangle, with its lower and its upper bound.
    modulus: Option<(f64, [f64; 2])>,
    /// The energies of a heat flow, and whether it converged.
    heat: Option<(Vec<f64>, bool)>,
}

/// The image of a surface, with the map onto it.
pub enum MappedSurface {
    Plane(Box<PlaneMap>),
    Sphere(SphereMap),
}

pub struct HarmonicOutcome {
    pub input: Input,
    pub to: MapTarget,
    pub domain: Domain,
    /// The input with the vertices that the map needs beside its own, where it needs any.
    refined: Option<Input>,
    added_vertices: usize,
    pub map: MappedSurface,
}

/// Largest distance of a vertex from the mean of its neighbours, as a share of the size of the image.
const MEAN_VALUE: f64 = 1e-10;

/// Rise of the energy in a step of the heat flow that rounding may make, as a share of the energy at the start: where the flow has come to
/// rest, sums over all edges differ in their last digits.
const ENERGY_ROUNDING: f64 = 1e-14;

impl HarmonicOutcome {
    pub fn new(
        input: Input,
        args: &HarmonicArgs,
        to: MapTarget,
        run: &mut CommandRun<'_>,
    ) -> Result<HarmonicOutcome, Failure> {
        let (seconds, control) = (&mut run.seconds, run.control);
        let simple = matches!(to, MapTarget::Disk | MapTarget::Polygon(_) | MapTarget::Rectangle);
        let mut refined = None;
        let domain = timed(&mut seconds.flip, || -> Result<Domain, Failure> {
            if !simple {
                return Ok(Domain::new(&input.surface, control)?);
            }
            let is_polygon = matches!(to, MapTarget::Polygon(_));
            let (split, domain) = simple_domain(&input.surface, is_polygon, control)?;
            refined = if split.n_added() > 0 { Some(input.halved(&split)?) } else { None };
            Ok(domain)
        })?;
        let map = if to == MapTarget::Sphere {
            let options = sphere_options(args);
            let map = || doing("sphere", || sphere_map(&domain, &options, control));
            MappedSurface::Sphere(timed(&mut seconds.solve, map)?)
        } else {
            let (map, course) = timed(&mut seconds.solve, || map_to_plane(&domain, args, &to, control))?;
            let carried = timed(&mut seconds.refine, || PlaneMap::new(&domain, map, course, control))?;
            MappedSurface::Plane(Box::new(carried))
        };
        let added_vertices = domain.mesh().n_vertices() - input.mesh().n_vertices();
        Ok(HarmonicOutcome { input, to, domain, refined, added_vertices, map })
    }

    /// What lets no triangle be turned over. No triangle of a disk folds in a map onto a convex region.
    fn remedy(&self) -> Option<&'static str> {
        match self.to {
            MapTarget::File(_) => Some(
                "give every vertex of the boundary a place, in its order around a convex curve, and let the others be free; or take \
                 --to disk",
            ),
            MapTarget::Rectangle => Some("take --to polygon:4 or --to disk, which turn no triangle over"),
            _ => None,
        }
    }

    /// The surface that is mapped: the input, with the vertices added to it that the map needs.
    pub fn mapped_input(&self) -> &Input {
        self.refined.as_ref().unwrap_or(&self.input)
    }

    /// The energies of the steps to the map, the start included; empty for a map that was solved for.
    pub fn energies(&self) -> &[f64] {
        match &self.map {
            MappedSurface::Plane(plane) => {
                plane.course.heat.as_ref().map_or(&[][..], |(energies, _)| energies.as_slice())
            }
            MappedSurface::Sphere(map) => &map.energies,
        }
    }

    /// The share of the domain's triangles that turn over, where pieces of them are counted too; empty if none does.
    fn flipped_share(&self, plane: &PlaneMap) -> String {
        match (&plane.subdivision, plane.flipped_in_domain) {
            (None, _) | (_, 0) => String::new(),
            (Some(_), n) => {
                format!(" (pieces of {n} of the {} triangles mapped)", self.domain.mesh().n_faces())
            }
        }
    }

    /// The largest rise of the energy in a step.
    fn energy_rise(&self) -> f64 {
        self.energies().windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }
}

impl JobOutcome for HarmonicOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        match &self.map {
            MappedSurface::Plane(plane) => {
                checks.add("mean_value_residual", plane.map.mean_value_residual, MEAN_VALUE);
                if let Some((energies, converged)) = &plane.course.heat {
                    let size = energies.first().copied().unwrap_or(0.0);
                    checks.add("energy_rise", self.energy_rise(), ENERGY_ROUNDING * size);
                    checks.add("not_converged", f64::from(u8::from(!converged)), 0.0);
                }
                checks.add_none("flipped_triangles", ["face", "faces"], &plane.flipped, self.remedy());
            }
            MappedSurface::Sphere(map) => {
                checks.add("flipped_triangles", map.flipped.len() as f64, 0.0);
                checks.add("energy_rise", self.energy_rise(), 0.0);
                checks.add("not_converged", f64::from(u8::from(!map.converged)), 0.0);
            }
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let figures = Figures::default()
            .with("left_out", run.outputs.left_out())
            .with("flips", self.domain.metric().start_flips())
            .with("added_vertices", self.added_vertices);
        match &self.map {
            MappedSurface::Plane(plane) => figures
                .with("energy", plane.map.energy)
                .with("mean_value_residual", plane.map.mean_value_residual)
                .with("flipped_triangles", plane.flipped.len())
                .with("flipped_domain_triangles", plane.flipped_in_domain)
                .with("degenerate_pieces", plane.degenerate)
                .if_some("corners", plane.course.corner_numbers())
                .if_some("modulus", plane.course.modulus.map(|(modulus, _)| modulus))
                .if_some("modulus_bounds", plane.course.modulus.map(|(_, bounds)| bounds.to_vec()))
                .if_some("iterations", plane.course.heat.as_ref().map(|(energies, _)| energies.len() - 1))
                .if_some("converged", plane.course.heat.as_ref().map(|(_, converged)| *converged))
                .if_some("energies", plane.course.heat.as_ref().map(|(energies, _)| energies.clone())),
            MappedSurface::Sphere(map) => figures
                .with("energy", map.energies.last().copied())
                .with("energies", map.energies.clone())
                .with("iterations", map.energies.len() - 1)
                .with("converged", map.converged)
                .with("flipped_triangles", map.flipped.len()),
        }
    }

    fn summary(&self, done: &Done) -> String {
        let added = match self.added_vertices {
            0 => String::new(),
            n => format!(", {} added", say::count(n, "vertex", "vertices")),
        };
        let map = match &self.map {
            MappedSurface::Plane(plane) => format!(
                "map      energy {}{}, off the means of neighbours by {:.1e}, {}{}{added}\n{}",
                say::size(plane.map.energy, 6),
                plane.course.steps(),
                plane.map.mean_value_residual,
                say::count(plane.flipped.len(), "triangle flipped", "triangles flipped"),
                self.flipped_share(plane),
                plane.course.modulus_line(),
            ),
            MappedSurface::Sphere(map) => format!(
                "map      energy {:.6} from {:.6} after {}, {}\n",
                map.energies.last().copied().unwrap_or(f64::NAN),
                map.energies.first().copied().unwrap_or(f64::NAN),
                say::count(map.energies.len() - 1, "step", "steps"),
                say::count(map.flipped.len(), "triangle flipped", "triangles flipped")
            ),
        };
        say::surface(&self.input) + &map + &say::finish(done)
    }
}

impl MapCourse {
    fn corner_numbers(&self) -> Option<Vec<u32>> {
        self.corners.as_ref().map(|corners| corners.iter().map(|v| v.0).collect())
    }

    /// The steps of a heat flow for the summary.
    fn steps(&self) -> String {
        let Some((energies, _)) = &self.heat else { return String::new() };
        let first = energies.first().copied().unwrap_or(f64::NAN);
        format!(" from {} after {}", say::size(first, 6), say::count(energies.len() - 1, "step", "steps"))
    }

    /// The modulus of a rectangle for the summary.
    fn modulus_line(&self) -> String {
        self.modulus.map_or_else(String::new, |(modulus, [low, high])| {
            format!("modulus  {modulus:.8}, width over height; between {low:.8} and {high:.8}\n")
        })
    }
}

fn sphere_options(args: &HarmonicArgs) -> SphereMapOptions {
    let usual = SphereMapOptions::default();
    SphereMapOptions {
        method: match args.method {
            HarmonicMethodChoice::Solve => SphereMethod::Implicit,
            HarmonicMethodChoice::Heat => SphereMethod::HeatFlow,
        },
        max_iterations: args.max_iterations.map_or(usual.max_iterations, |n| n as usize),
        ..usual
    }
}

/// The map to the plane, and what is known of it.
fn map_to_plane(
    domain: &Domain,
    args: &HarmonicArgs,
    to: &MapTarget,
    control: &Control,
) -> Result<(HarmonicMap<2>, MapCourse), Failure> {
    let given = || args.corners.iter().map(|&v| VertexId(v)).collect::<Vec<_>>();
    let mut course = MapCourse::default();
    let values = match to {
        MapTarget::Rectangle => {
            let found = planar::to_rectangle(domain, given().try_into().ok(), control)?;
            course.corners = Some(found.corners.to_vec());
            course.modulus = Some((found.modulus, found.bounds));
            return Ok((found.map, course));
        }
        MapTarget::Polygon(n) => {
            let at = match n {
                Some(n) if args.corners.is_empty() => planar::corners_by_length(domain, *n as usize)?,
                _ => given(),
            };
            let values = planar::polygon_values(domain, &planar::regular_polygon(at.len()), Some(&at))?;
            course.corners = Some(at);
            values
        }
        MapTarget::File(path) => csv::read_places(path, domain.mesh().n_vertices())?,
        MapTarget::Disk | MapTarget::Sphere => planar::disk_values(domain)?,
    };
    let data = MapConstraints { values, flux: None };
    if args.method == HarmonicMethodChoice::Solve {
        return Ok((harmonic_map(domain, &data, control)?, course));
    }
    let usual = HeatOptions::default();
    let max_iterations = args.max_iterations.map_or(usual.max_iterations, |n| n as usize);
    let options = HeatOptions { step: args.step.unwrap_or(0.0), max_iterations, ..usual };
    let found = heat_flow(domain, &data, &options, control)?;
    course.heat = Some((found.energies, found.converged));
    Ok((found.map, course))
}

impl PlaneMap {
    fn new(
        domain: &Domain,
        map: HarmonicMap<2>,
        course: MapCourse,
        control: &Control,
    ) -> ricci::Result<PlaneMap> {
        let subdivision = domain.common_subdivision(control)?;
        let points = match &subdivision {
            Some(r) => r.from_vertices(1, &map.points)?,
            None => map.points.clone(),
        };
        let of_domain = planar::flipped(domain, &map.points);
        let flipped_in_domain = of_domain.len();
        let Some(r) = &subdivision else {
            return Ok(PlaneMap {
                map,
                course,
                subdivision,
                points,
                flipped: of_domain,
                flipped_in_domain,
                degenerate: 0,
            });
        };
        // A piece is turned over where its triangle of the domain is, even if rounding leaves no area to see it by.
        let of_domain: HashSet<FaceId> = of_domain.into_iter().collect();
        let (mut flipped, mut degenerate) = (Vec::new(), 0);
        for f in r.mesh.faces() {
            let corners @ [a, b, c] = r.mesh.face_vertices(f).map(|v| points[v.index()]);
            let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
            let (area, least) = (0.5 * doubled_area(corners), LEAST_RELATIVE_AREA * longest * longest);
            if area < -least || of_domain.contains(&r.faces[1][f]) {
                flipped.push(f);
            } else {
                degenerate += usize::from(area <= least);
            }
        }
        Ok(PlaneMap { map, course, subdivision, points, flipped, flipped_in_domain, degenerate })
    }
}

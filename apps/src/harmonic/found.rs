//! A harmonic map with what is said of it.

use super::args::{HarmonicArgs, Target};
use crate::csv;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::report::{Attempts, Checks, Figures, Seconds, timed};
use crate::say;
use ricci::Control;
use ricci::geometry::complex::{distance, doubled_area};
use ricci::geometry::triangle_flatness::LEAST_RELATIVE_AREA;
use ricci::harmonic::{
    Domain, HarmonicMap, MapConstraints, SphereMap, SphereMapOptions, harmonic_map, planar, simple_domain,
    sphere_map,
};
use ricci::mesh::VertexId;
use ricci::metric::Refinement;

/// A map to the plane, carried back to the surface.
pub struct Plane {
    pub map: HarmonicMap<2>,
    /// The common refinement of the domain's triangulation and the given one; none where both are one.
    pub refinement: Option<Refinement>,
    /// Per vertex of the refinement.
    pub points: Vec<[f64; 2]>,
    /// Triangles of the domain that turn over, and pieces of the refinement that do; pieces without area.
    pub flipped: usize,
    pub degenerate: usize,
}

pub enum Map {
    Plane(Box<Plane>),
    Sphere(SphereMap),
}

pub struct Found {
    pub domain: Domain,
    /// The input with the vertices that the map needs.
    pub input: Option<Input>,
    pub added_vertices: usize,
    pub map: Map,
    pub corners: Option<Vec<VertexId>>,
    /// Whether no triangle may turn over.
    pub is_convex: bool,
    pub failed: Attempts,
    pub seconds: Seconds,
}

/// What the mean-value property must hold to, relative to the size of the image.
const MEAN_VALUE: f64 = 1e-10;

impl Found {
    pub fn new(input: &Input, args: &HarmonicArgs, to: &Target, control: &Control) -> Result<Found, Failure> {
        let mut seconds = input.seconds;
        let simple = matches!(to, Target::Disk | Target::Polygon(_) | Target::Rectangle);
        let mut refined = None;
        let domain = timed(&mut seconds.flip, || -> Result<Domain, Failure> {
            if !simple {
                return Ok(Domain::new(&input.surface, control)?);
            }
            let (split, domain) = simple_domain(&input.surface, matches!(to, Target::Polygon(_)), control)?;
            refined = if split.n_added() > 0 { Some(input.halved(&split)?) } else { None };
            Ok(domain)
        })?;
        let mut corners = None;
        let map = timed(&mut seconds.solve, || find(&domain, args, to, &mut corners, control))?;
        let map = match map {
            Ok(map) => {
                let carried = timed(&mut seconds.refine, || Plane::new(&domain, map, control))?;
                Map::Plane(Box::new(carried))
            }
            Err(sphere) => Map::Sphere(sphere),
        };
        let added_vertices = domain.mesh().n_vertices() - input.mesh().n_vertices();
        let is_convex = matches!(to, Target::Disk | Target::Polygon(_));
        let failed = Attempts::default();
        Ok(Found { domain, input: refined, added_vertices, map, corners, is_convex, failed, seconds })
    }

    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        match &self.map {
            Map::Plane(plane) => {
                checks.add("mean_value_residual", plane.map.mean_value_residual, MEAN_VALUE);
                if self.is_convex {
                    checks.add("flipped_triangles", plane.flipped as f64, 0.0);
                }
            }
            Map::Sphere(map) => {
                checks.add("flipped_triangles", map.flipped.len() as f64, 0.0);
                let rise = map.energies.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
                checks.add("energy_rise", rise, 0.0);
                checks.add("not_converged", f64::from(u8::from(!map.converged)), 0.0);
            }
        }
        checks
    }

    pub fn figures(&self) -> Figures {
        let figures = Figures::default()
            .with("flips", self.domain.metric().start_flips())
            .with("added_vertices", self.added_vertices);
        let corners = self.corners.as_ref().map(|corners| corners.iter().map(|v| v.0).collect::<Vec<_>>());
        match &self.map {
            Map::Plane(plane) => figures
                .with("energy", plane.map.energy)
                .with("mean_value_residual", plane.map.mean_value_residual)
                .with("flipped_triangles", plane.flipped)
                .with("degenerate_pieces", plane.degenerate)
                .if_some("corners", corners),
            Map::Sphere(map) => figures
                .with("energy", map.energies.last().copied())
                .with("energies", map.energies.clone())
                .with("iterations", map.energies.len() - 1)
                .with("converged", map.converged)
                .with("flipped_triangles", map.flipped.len()),
        }
    }

    pub fn text(&self) -> String {
        let added = match self.added_vertices {
            0 => String::new(),
            n => format!(", {} added", say::count(n, "vertex", "vertices")),
        };
        match &self.map {
            Map::Plane(plane) => format!(
                "map      energy {}, off the means of neighbours by {:.1e}, {}{added}\n",
                say::size(plane.map.energy, 6),
                plane.map.mean_value_residual,
                say::count(plane.flipped, "triangle flipped", "triangles flipped")
            ),
            Map::Sphere(map) => format!(
                "map      energy {:.6} from {:.6} after {}, {}\n",
                map.energies.last().copied().unwrap_or(f64::NAN),
                map.energies.first().copied().unwrap_or(f64::NAN),
                say::count(map.energies.len() - 1, "step", "steps"),
                say::count(map.flipped.len(), "triangle flipped", "triangles flipped")
            ),
        }
    }
}

/// The map to the plane, or else the one to the sphere.
fn find(
    domain: &Domain,
    args: &HarmonicArgs,
    to: &Target,
    corners: &mut Option<Vec<VertexId>>,
    control: &Control,
) -> Result<Result<HarmonicMap<2>, SphereMap>, Failure> {
    let given = || args.corners.iter().map(|&v| VertexId(v)).collect::<Vec<_>>();
    Ok(Ok(match to {
        Target::Sphere => {
            let map = doing("sphere", || sphere_map(domain, &SphereMapOptions::default(), control));
            return Ok(Err(map?));
        }
        Target::Disk => planar::to_disk(domain, control)?,
        Target::Polygon(n) => {
            let at = match n {
                Some(n) if args.corners.is_empty() => planar::corners_by_length(domain, *n as usize)?,
                _ => given(),
            };
            let polygon = planar::regular_polygon(at.len());
            let map = planar::to_polygon(domain, &polygon, Some(&at), control)?;
            *corners = Some(at);
            map
        }
        Target::Rectangle => {
            let (map, at) = planar::to_rectangle(domain, given().try_into().ok(), control)?;
            *corners = Some(at.to_vec());
            map
        }
        Target::File(path) => {
            let values = csv::read_places(path, domain.mesh().n_vertices())?;
            harmonic_map(domain, &MapConstraints { values, flux: None }, control)?
        }
    }))
}

impl Plane {
    fn new(domain: &Domain, map: HarmonicMap<2>, control: &Control) -> ricci::Result<Plane> {
        let refinement = domain.refinement(control)?;
        let points = match &refinement {
            Some(r) => r.from_final_vertices(&map.points)?,
            None => map.points.clone(),
        };
        let (mut flipped, mut degenerate) = (planar::flipped(domain, &map.points).len(), 0);
        for f in refinement.iter().flat_map(|r| r.mesh.faces().map(|f| r.mesh.face_vertices(f))) {
            let corners @ [a, b, c] = f.map(|v| points[v.index()]);
            let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
            let (area, least) = (0.5 * doubled_area(corners), LEAST_RELATIVE_AREA * longest * longest);
            flipped += usize::from(area < -least);
            degenerate += usize::from(area.abs() <= least);
        }
        Ok(Plane { map, refinement, points, flipped, degenerate })
    }
}

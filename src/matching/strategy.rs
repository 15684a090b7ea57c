//! The choice of the strategy by which both surfaces come into one domain, and of the order of their boundary loops.

use super::disk;
use super::domain_pair::DomainPair;
use super::handles::with_handles;
use super::landmarks::{MarkedSurface, Marks, loop_orders, marks};
use super::least_energy::LeastEnergy;
use super::options::{LoopShape, MatchOptions};
use super::orbifold::in_orbifold;
use super::pushed::with_pushed_landmarks;
use super::same_triangulation::{cone_order, in_frames_of_faces};
use super::sphere::on_sphere;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::VertexId;
use crate::metric::Surface;

/// A way to bring both surfaces into one domain.
///
/// | genus | loops | landmarks inside | corners | strategy |
/// |---|---|---|---|---|
/// | any | any | any | 0 | `SameTriangulation` first, if [`cone_order`] finds that it applies |
/// | 0 | 0 | 0, 1, 2 | | `Sphere` |
/// | 0 | 1 | 0, 1 | 0 | `Disk` |
/// | 0 | 1 | 0 | 1, 2 | `Disk` |
/// | 0 | | all others | | `Orbifold` |
/// | 1 | 0 | 0, 1 | | `Handles`: one landmark of a torus is met by a shift |
/// | ≥ 1 | any | 0 | 0 | `Handles` |
/// | ≥ 1 | | all others | | `PushedLandmarks` |
///
/// With [`LoopShape::Circles`] the pair that comes out is brought into the domain with round holes afterwards ([`super::round`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Strategy {
    /// One triangulation on both surfaces: every face has a frame of its own.
    SameTriangulation {
        /// Order of the cones at the landmarks.
        cone_order: usize,
    },
    /// A rotation or a Möbius transformation of the round sphere.
    Sphere,
    /// Corners are added to the boundary of a disk, after which it is an orbifold.
    Disk,
    /// A harmonic map into the orbifold with cones at the landmarks, in the class that trees of paths determine.
    Orbifold,
    /// A harmonic map in the class that the images of generators of the fundamental group determine.
    Handles,
    /// The map without landmarks, changed by pushing each landmark along a path to its partner.
    PushedLandmarks,
}

impl Strategy {
    /// The strategy for surfaces of this genus with these marks, if they have no triangulation in common.
    fn choose(genus: usize, marks: &Marks) -> Strategy {
        match (genus, marks.loops.len(), marks.landmarks.len(), marks.corners.len()) {
            (0, 0, 0..=2, _) => Strategy::Sphere,
            (0, 1, 0 | 1, 0) | (0, 1, 0, 1 | 2) => Strategy::Disk,
            (0, ..) => Strategy::Orbifold,
            (1, 0, 0 | 1, _) | (_, _, 0, 0) => Strategy::Handles,
            _ => Strategy::PushedLandmarks,
        }
    }

    fn follow(
        self,
        sides: [MarkedSurface; 2],
        options: &MatchOptions,
        control: &Control,
    ) -> Result<DomainPair> {
        match self {
            Strategy::SameTriangulation { cone_order } => {
                in_frames_of_faces(sides, cone_order, options, control)
            }
            Strategy::Sphere => on_sphere(sides, options, control),
            Strategy::Disk => disk::with_corners(sides, options, control),
            Strategy::Orbifold => in_orbifold(sides, options, control),
            Strategy::Handles => Ok(with_handles(sides, false, options, control)?.0),
            Strategy::PushedLandmarks => with_pushed_landmarks(sides, options, control),
        }
    }
}

/// Both surfaces in one domain.
fn in_one_domain(sides: [MarkedSurface; 2], options: &MatchOptions, control: &Control) -> Result<DomainPair> {
    if let Some(cone_order) = cone_order(sides, options) {
        match (Strategy::SameTriangulation { cone_order }).follow(sides, options, control) {
            // There may be a map of another class.
            Err(Error::Matching(why)) => log::debug!("in the class of the vertices' numbers: {why}"),
            found => return found,
        }
    }
    Strategy::choose(sides[0].surface.mesh().genus(), sides[0].marks).follow(sides, options, control)
}

/// Twist of a map ([`DomainPair::twist`]) below which no other order of loops is tried.
const UNTWISTED: f64 = 1.05;

/// The marks of both surfaces in corresponding order, and both surfaces in one domain. On surfaces with handles several orders of the
/// boundary loops are tried if the options leave it open; the one whose map has the least energy is taken.
///
/// # Errors
/// [`Error::Matching`] for marks that do not correspond, and if no map is found; those of the strategies; [`Error::Cancelled`].
pub(super) fn in_best_order(
    surfaces: [&Surface; 2],
    landmarks: &[[VertexId; 2]],
    options: &MatchOptions,
    control: &Control,
) -> Result<([Marks; 2], DomainPair)> {
    check_landmarks_beside_circles(surfaces[0], landmarks, options)?;
    let is_open = options.loops.is_none() && options.basis.is_empty() && surfaces[0].mesh().genus() > 0;
    let orders = if is_open {
        loop_orders(surfaces, landmarks)?.into_iter().map(Some).collect()
    } else {
        vec![options.loops.clone()]
    };
    let (mut least, mut markings) = (LeastEnergy::new(UNTWISTED), 0);
    for order in orders {
        let found = marks(surfaces, landmarks, order.as_deref()).and_then(|marks| {
            let sides = [0, 1].map(|s| MarkedSurface { surface: surfaces[s], marks: &marks[s] });
            let pair = in_one_domain(sides, options, control)?;
            Ok((pair.twist(), (marks, pair)))
        });
        match &found {
            Ok((_, (_, pair))) => markings += pair.markings,
            Err(Error::Matching(_)) => {}
            Err(_) => return found.map(|(_, best)| best),
        }
        if least.offer(found)? {
            break;
        }
    }
    let (marks, pair) = least.into_best("no order of the boundary loops")?;
    Ok((marks, DomainPair { markings, ..pair }))
}

fn check_landmarks_beside_circles(
    source: &Surface,
    landmarks: &[[VertexId; 2]],
    options: &MatchOptions,
) -> Result<()> {
    let mesh = source.mesh();
    let is_inside =
        |pair: &&[VertexId; 2]| pair[0].index() < mesh.n_vertices() && !mesh.is_boundary_vertex(pair[0]);
    let inside = landmarks.iter().filter(is_inside).count();
    if options.loop_shape == LoopShape::Circles && inside > 0 {
        return Err(Error::Matching(format!(
            "{inside} landmarks inside the surfaces and round holes: landmarks inside are met where loops become geodesics"
        )));
    }
    Ok(())
}

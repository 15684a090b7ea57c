//! The map that [`super::match_surfaces`] returns, from both surfaces in one domain.

use super::balance::BalanceReport;
use super::cover::locate;
use super::domain_pair::DomainPair;
use super::overlay::CommonDomain;
use super::round::RoundHole;
use super::surface_map::SurfaceMap;
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{FaceId, Place, VertexId};
use crate::metric::Split;

/// A map between two surfaces, with what certifies it.
#[derive(Debug, Clone, PartialEq)]
pub struct Matching {
    /// From the vertices of the source to the target.
    pub forward: SurfaceMap,
    /// From the vertices of the target to the source: the inverse of the map that is linear, in the domain, on the faces of the source.
    pub backward: SurfaceMap,
    /// The image on the target, and the place where it should be, of the source's points of [`super::MatchOptions::points`], and after them
    /// of the vertices of its curves that are no landmarks.
    pub points: Vec<[Place; 2]>,
    /// Per soft landmark the distance on the target that is left to its partner.
    pub soft_left: Vec<f64>,
    /// The space in which the domain lies.
    pub space: Space,
    /// The boundary loops as circles of the domain, in the order of the source's; empty unless loops become circles.
    pub holes: Vec<RoundHole>,
    /// Faces of the source that are not counterclockwise in the domain of the target, by positions in double-double precision. If there are
    /// none, and [`Matching::target_flipped`] is empty, the map is a homeomorphism. Both are empty in every result of
    /// [`super::match_surfaces`], which returns an error if there are such faces; reports show them to say that they were counted.
    pub flipped: Vec<FaceId>,
    /// Faces of the target that are not counterclockwise in its own domain: as [`Matching::flipped`].
    pub target_flipped: Vec<FaceId>,
    /// Largest distance by which a vertex lies outside the other surface's domain, or by which its places differ if it is reached on both
    /// sides of a cut, as a share of the nearest triangle: rounding.
    pub outside: f64,
    /// The steps by which the source, and the target, were brought into the domain.
    pub balance: [BalanceReport; 2],
    /// Steps of the flows to the canonical metrics of source and target.
    pub flow_iterations: [usize; 2],
    /// Number of homotopy classes whose maps were compared by their energies.
    pub markings: usize,
    /// Both triangulations in the domain: for their common subdivision, and for pictures.
    pub domain: CommonDomain,
}
stored!(sections Matching { forward, backward, points, soft_left, space, holes, flipped, target_flipped,
    outside, balance, flow_iterations, markings, domain });

impl Matching {
    /// The maps both ways between two surfaces in one domain. `splits`: the given surfaces with the vertices that were added; `points`: the
    /// added vertices of the source with the places on the given target where they should be.
    ///
    /// # Errors
    /// [`Error::Matching`] if faces fold; those of [`locate`].
    pub(super) fn new(
        pair: DomainPair,
        splits: [&Split; 2],
        points: &[(VertexId, Place)],
        control: &Control,
    ) -> Result<Matching> {
        let (flipped, target_flipped) = (pair.source.flipped(), pair.target.flipped());
        if !(flipped.is_empty() && target_flipped.is_empty()) {
            return Err(Error::Matching(format!(
                "{} faces of the source and {} of the target fold in the domain, the first face {}: positions have too few digits there",
                flipped.len(),
                target_flipped.len(),
                flipped.first().or(target_flipped.first()).map_or(0, |f| f.index())
            )));
        }
        let (forward, ahead) = locate(&pair.source, &pair.target, pair.seeds[0], &control.part(0.0, 0.5))?;
        let (backward, back) = locate(&pair.target, &pair.source, pair.seeds[1], &control.part(0.5, 1.0))?;
        let images =
            points.iter().map(|(v, goal)| [on_given(forward[v.index()], splits[1]), *goal]).collect();
        let map = |places: Vec<Place>, from: usize| {
            let n = splits[from].given().mesh().n_vertices();
            SurfaceMap { places: places.into_iter().take(n).map(|p| on_given(p, splits[1 - from])).collect() }
        };
        Ok(Matching {
            forward: map(forward, 0),
            backward: map(backward, 1),
            points: images,
            soft_left: Vec::new(),
            space: pair.source.cover.space,
            holes: Vec::new(),
            flipped,
            target_flipped,
            outside: ahead.max(back),
            balance: pair.reports,
            flow_iterations: pair.flow_iterations,
            markings: pair.markings,
            domain: CommonDomain::new([pair.source, pair.target], pair.seeds, splits),
        })
    }
}

/// A place in a face of a refined triangulation, as a place in a face of the given one.
fn on_given(place: Place, split: &Split) -> Place {
    let (face, corners) = split.place(place.face);
    let weights = std::array::from_fn(|c| (0..3).map(|k| place.weights[k] * corners[k][c]).sum());
    Place { face, weights }
}

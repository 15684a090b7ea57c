//! Maps between two surfaces of the same topology: homeomorphisms that bring given landmarks to each other and fold no face.
//!
//! # The map
//!
//! Both surfaces are drawn in one *domain*; the drawing of the source, followed by the inverse of the drawing of the target, is the map
//! \[JKLLG08, Eqn 18\]. The domain is the target with the metric of constant curvature in its conformal class. The source is drawn there by
//! a *harmonic map*: every vertex lies at the weighted mean of its neighbours, the weights being positive.
//!
//! In a disk with a convex boundary such a drawing is an embedding (Tutte's theorem). The same holds on flat and hyperbolic surfaces,
//! closed or with geodesic boundary, in every homotopy class that contains a homeomorphism \[LWZ23\], \[AL16\]. A landmark that is merely
//! held at its partner would not be a mean of its neighbours, and faces beside it could fold. So the metric gets a cone of angle 2π/n at
//! every landmark. If the Euler characteristic of this orbifold is not positive, its universal cover is the plane or the hyperbolic plane.
//! There the picture is symmetric about the lifts of a landmark, which therefore are the means of their neighbours already: landmarks are
//! met exactly, and no face folds. Boundary loops become closed geodesics or, between landmarks on them (*corners*), straight sides.
//!
//! The weights are the mean value weights of the source in its own canonical metric, in which every vertex is the mean of its neighbours
//! already. An isometry and a discretely conformal map are therefore found exactly. Only a sphere with fewer than three landmarks has no
//! flat or hyperbolic orbifold metric. Its harmonic maps onto the round sphere are the Möbius transformations; one is taken that meets the
//! landmarks and fits the conformal factors of the two surfaces best. A disk with too few landmarks gets corners on its boundary first.
//!
//! # The homotopy class
//!
//! There is one harmonic map, up to shifts of flat surfaces, in every homotopy class of maps that keep the landmarks. So a class has to be
//! chosen. If the user leaves it open, several classes are compared and the one whose map has the least energy is taken.
//! - *Genus 0*: a tree of paths joins all landmarks and loops (together: *marks*) of each surface. Opened along its tree a surface is a
//!   disk, and a homeomorphism of disks is determined up to isotopy by its boundary. Two trees of the same shape therefore determine the
//!   class.
//! - *Handles*: the class is an isomorphism of the fundamental groups, given by the images of generators. The user can name it by pairs of
//!   loops ([`MatchOptions::basis`]). Otherwise twists and exchanges of handles are applied as long as they lower the energy.
//! - *Landmarks on surfaces with handles*: the map without landmarks is found first; each landmark is then pushed from its image along a
//!   short path to its partner, beside the paths of the others. The paths determine the class. Several sets of paths are compared, also
//!   from maps that differ from the first by a symmetry of the generators.
//! - *One triangulation on both surfaces*, with the same numbers of landmarks and loops and hyperbolic metrics: the class of the map that
//!   brings every vertex to the vertex of the same number. No fundamental domain is laid out, so no digits are lost however far it would
//!   reach.
//!
//! # The way of a matching
//!
//! ```text
//! match_surfaces                                       match_surfaces.rs   options.rs
//!   what corresponds: landmarks, curves, loops         landmarks/          found/ (by shape)
//!   the strategy, from genus, loops, landmarks         strategy.rs         domain_pair.rs
//!   |  same numbering          frames of faces         same_triangulation.rs
//!   |  sphere, < 3 landmarks   rotation or Moebius     sphere/             fit/
//!   |  disk, < 3 corners       corners, then orbifold  disk/               fit/
//!   |  genus 0                 trees of paths          orbifold/
//!   |  handles                 generators              handles/
//!   |  handles and landmarks   pushed along paths      pushed/
//!   each of them uses
//!   |  canonical metric -> layout -> cover             canonical.rs        cover/
//!   |  harmonic map            balance at vertices     balance/
//!   |  several classes         the least energy        least_energy.rs
//!   loops as circles, if wanted                        round/
//!   the vertices of each in the other's triangles      cover/walk.rs       result.rs   surface_map.rs
//! common subdivision of both, distortion of the map    overlay/            quality.rs
//! the judgement of a map                               judgement.rs        even_sample.rs
//! bracket of the Teichmueller distance                 teichmuller.rs      energy_ratio.rs
//! ```
//!
//! # Example
//!
//! ```
//! use ricci::matching::{MatchOptions, map_quality, match_surfaces};
//! use ricci::mesh::{VertexId, shapes};
//! use ricci::{Control, Surface};
//! let [ball, egg] = [[1.0, 1.0, 1.0], [1.0, 1.3, 0.8]].map(|axes| shapes::ellipsoid(axes, 6));
//! let [ball, egg] = [Surface::from_soup(&ball?)?, Surface::from_soup(&egg?)?];
//! let landmarks = [0, 3, 5, 8, 11].map(|v| [VertexId(v), VertexId(v)]).to_vec();
//! let options = MatchOptions { landmarks, ..MatchOptions::default() };
//! let matching = match_surfaces(&ball, &egg, &options, &Control::new())?;
//! let quality = map_quality([&ball, &egg], &matching.forward, &options.landmarks)?;
//! assert!(matching.flipped.is_empty() && quality.landmark_error < 1e-12 && quality.qc_mean < 1.5);
//! # Ok::<(), ricci::Error>(())
//! ```

mod balance;
mod canonical;
mod cover;
mod disk;
mod domain_pair;
mod energy_ratio;
mod even_sample;
mod fit;
mod found;
mod handles;
mod judgement;
mod landmarks;
mod least_energy;
mod match_surfaces;
mod options;
mod orbifold;
mod overlay;
mod pushed;
mod quality;
mod result;
mod round;
mod same_triangulation;
mod sphere;
mod strategy;
mod surface_map;
mod teichmuller;
#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod teichmuller_tests;

pub use crate::mesh::Place;
pub use balance::BalanceReport;
pub use found::{FoundLandmarks, FoundPairs, LandmarkSearch, ShapeMatching, find_landmarks, match_by_shape};
pub use judgement::{MapJudgement, MapVerdict, judge};
pub use match_surfaces::match_surfaces;
pub use options::{BoundaryMatching, LoopShape, MatchOptions, SoftLandmark};
pub use overlay::{CommonDomain, DomainTriangle};
pub use quality::{MapQuality, cycle_error, dilatations, map_quality, point_error, uncovered};
pub use result::Matching;
pub use round::RoundHole;
pub use surface_map::SurfaceMap;
pub use teichmuller::{DilatationBracket, LowerBoundKind, dilatation_bracket};

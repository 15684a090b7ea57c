//! Maps between two surfaces of the same topology: both go to one canonical domain, the source by a harmonic map, and the one map is
//! followed by the inverse of the other \[JKLLG08, Eqn 18\].
//!
//! The domain is the target in its metric of constant curvature. Landmarks become cones of angle 2π/n in it, boundary loops become
//! geodesics or, between corners, straight sides. So wherever the Euler characteristic of this orbifold is not positive the domain is
//! covered by the plane or the hyperbolic plane without cones, and a map that puts every vertex at the mean of its neighbours, with
//! positive weights, is an embedding \[LWZ23\], \[AL16\]: landmarks are met exactly and no face folds. The weights are those with which the
//! source is harmonic in its own canonical metric, so that an isometry or a discretely conformal map is found as it is. A sphere with fewer
//! than three landmarks has no such metric: it goes to the other one by a rotation or a Möbius transformation that meets its landmarks, and
//! by which the conformal factors fit.
//!
//! On surfaces with handles the map without landmarks is found first. Each landmark is then pushed along a short path to its partner,
//! beside the paths of the others; that chooses the class of the map, and in the orbifold with cones at the landmarks the map of this class
//! is an embedding again. Several sets of paths are compared by the energies of these maps, also from the maps without landmarks that
//! differ by a symmetry of about the same energy.
//!
//! Which homotopy class is meant is said by a tree of paths between the landmarks and loops of both surfaces, or by bases of their
//! fundamental groups. Several are compared, and the one whose harmonic map has the least energy is taken. On surfaces with handles the
//! class can be named by pairs of loops ([`MatchOptions::basis`]). Two surfaces with one triangulation, the same numbers and landmarks,
//! whose metrics are hyperbolic, say it themselves: it is the class of the map that keeps numbers. There every face has a frame of its own,
//! and nothing loses digits however far a fundamental domain would reach.
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

#[path = "fit/turn_about_axis.rs"]
mod axis;
#[path = "balance/system.rs"]
mod balance;
#[path = "cover/face_boxes.rs"]
mod boxes;
mod canonical;
#[path = "handles/named_class.rs"]
mod class;
mod cover;
#[path = "landmarks/curves.rs"]
mod curves;
#[path = "fit/conformal_factors.rs"]
mod density;
mod disk;
#[path = "match_surfaces.rs"]
mod find;
#[path = "handles/generators.rs"]
mod generators;
mod handles;
#[path = "landmarks/marks.rs"]
mod marks;
#[path = "balance/matrices.rs"]
mod matrices;
#[path = "quality.rs"]
mod measure;
mod options;
mod orbifold;
mod overlay;
#[path = "surface_map.rs"]
pub mod place;
mod pushed;
#[path = "balance/folds.rs"]
mod repair;
#[path = "pushed/boundary.rs"]
mod rims;
mod round;
#[path = "landmarks/router.rs"]
mod route;
#[path = "same_triangulation.rs"]
mod same;
#[path = "round/common_boundary.rs"]
mod shared;
#[path = "pushed/slits.rs"]
mod slits;
#[path = "landmarks/soft.rs"]
mod soft;
mod sphere;
#[path = "orbifold/tree.rs"]
mod tree;
#[path = "sphere/rotations.rs"]
mod turn;
#[path = "balance/untangle.rs"]
mod untangle;
#[path = "cover/walk.rs"]
mod walk;
#[path = "balance/weights.rs"]
mod weights;

pub use crate::mesh::Place;
pub use balance::BalanceReport;
pub use find::{Matching, match_surfaces};
pub use measure::{MapQuality, cycle_error, dilatations, map_quality, point_error, uncovered};
pub use options::{Boundary, LoopShape, MatchOptions};
pub use overlay::{CommonDomain, DomainTriangle};
pub use place::SurfaceMap;
pub use round::RoundHole;
pub use soft::SoftLandmark;

//! The common subdivision of two triangulations of one surface: of the one that a surface came with and the one that flips have made of
//! it, or of source and target of a matching; and the maps between the two.
//!
//! After a flow, each final triangle is cut by the input's edges into pieces, each of which lies in one triangle of either. On every
//! piece the map between the two is projective [SSP08, §3.4; GSC21, §5]: vertices are vectors v_i of Lorentz space
//! ([`crate::geometry::flip`]), a point of the piece is a vector
//!
//! ```text
//! P = Σ α_a v_a = Σ β_i v_i      over the corners a of its face of the input and i of its final face,
//! ```
//!
//! and in a metric with variables u the vector `s_i v_i` stands for the position of vertex i (plane: (x, y, 1), `s = e^u`; hyperboloid
//! or sphere: `s = 2 e^u/(1 + λ ε e^{2u})`). So P lies at the positions' combination with weights `α_a / s_a(0)` in the input, with
//! weights `β_i / s_i` in the final face. Weights that are divided by their sum are called *barycentric* here; the quotient of the
//! two sums is the homogeneous weight of the point, the `q` of a projective texture coordinate: q · (final position) is linear in the
//! input position, as vectors.
//!
//! Where the flow has started from another triangulation of the same surface, made by isometric flips ([`IntrinsicTriangulation`]),
//! edges of the input are drawn straight on the surface. Otherwise they are drawn straight in the class, that is as straight lines of Lorentz space.
//!
//! ```
//! # use ricci::{Class, Control, Flow, Surface, Target, flow::Options, geometry::Space};
//! # use ricci::mesh::{FaceId, shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut flow = Flow::new(torus, Class::yamabe(Space::E2), &Options::default(), &Control::new())?;
//! let flat = flow.solve(&Target::Uniform, &Control::new())?;
//! let subdivision = flat.common_subdivision(&Control::new())?;
//! let (face, barycentric) = subdivision.forward().image(FaceId(0), [1.0, 0.0, 0.0]).unwrap();
//! assert!(face.index() < flat.mesh().n_faces() && barycentric.iter().any(|b| (b - 1.0).abs() < 1e-12));
//! # Ok::<(), ricci::Error>(())
//! ```

mod assemble;
mod chords;
mod crossings;
mod data;
mod geodesic;
mod intrinsic;
mod lines;
mod maps;
mod order;
mod pieces;
mod split_edges;
mod strip;
mod triangulations;

pub(crate) use assemble::Unpacked;
pub(crate) use data::{CORNERS, PlaceInFace, corner_at};
pub use data::{CommonSubdivision, Crossing, EdgePoint};
pub use maps::PointMap;
pub use triangulations::{FinalTriangulation, InputTriangulation, IntrinsicTriangulation, Triangulations};

use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::{Curves, FaceId};
use assemble::assemble;
use crossings::PlacedCrossings;
use lines::StraightLines;
use pieces::{DrawnCurves, PieceTriangles};

impl CommonSubdivision {
    /// The common subdivision, of the pieces in those faces of the input that `keep` names (of a double those of
    /// [`crate::mesh::Double::is_original`]; the vertices that are kept must come first, as they do there). O(input + output), parallel
    /// inside a pool.
    ///
    /// # Errors
    /// - [`crate::Error::Size`].
    /// - [`crate::Error::TooLarge`] for more crossings than can be numbered.
    /// - [`crate::Error::Connectivity`] if the normal coordinates did not see every flip.
    /// - [`crate::Error::EdgeWeight`] where imaginary circles leave no straight line.
    /// - [`crate::Error::Domain`] at a vertex whose weights leave the range of f64.
    /// - [`crate::Error::Cancelled`].
    pub fn new(
        all: Triangulations,
        keep: &dyn Fn(FaceId) -> bool,
        control: &Control,
    ) -> Result<CommonSubdivision> {
        all.check()?;
        let Triangulations { input, result, .. } = all;
        control.step(Stage::Layout, 0.0)?;
        let curves = Curves::trace(result.mesh, result.normal, control)?;
        let placed = PlacedCrossings::new(&all, &StraightLines::new(input, &result)?, &curves, control)?;
        let drawn = DrawnCurves { input: input.mesh, result: &result, curves: &curves, moved: &placed.moved };
        let pieces = PieceTriangles::cut(drawn, keep, control)?;
        assemble(pieces, placed.crossings, placed.weight)
    }
}

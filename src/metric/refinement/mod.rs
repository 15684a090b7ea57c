//! The way back: the common refinement of the triangulation that a surface came with and of the one that flips have made of it.
//!
//! Each final triangle is cut by the input's edges into pieces, each of which lies in one triangle of either. On every piece the
//! map between the two is projective [SSP08, §3.4; GSC21, §5]: vertices are vectors v_i of Lorentz space
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
//! Where the flow has started from another triangulation of the same surface, made by isometric flips ([`Intrinsic`]), edges of the
//! input are drawn straight on the surface. Otherwise they are drawn straight in the class, that is as straight lines of Lorentz space.
//!
//! ```
//! # use ricci::{Class, Control, Flow, Surface, Target, flow::Options, geometry::Space};
//! # use ricci::mesh::{FaceId, shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut flow = Flow::new(torus, Class::yamabe(Space::E2), &Options::default(), &Control::new())?;
//! let flat = flow.solve(&Target::Uniform, &Control::new())?;
//! let refinement = flat.refinement(&Control::new())?;
//! let (face, barycentric) = refinement.forward().image(FaceId(0), [1.0, 0.0, 0.0]).unwrap();
//! assert!(face.index() < flat.mesh().n_faces() && barycentric.iter().any(|b| (b - 1.0).abs() < 1e-12));
//! # Ok::<(), ricci::Error>(())
//! ```

mod assemble;
mod chords;
mod crossings;
mod geodesic;
mod intrinsic;
mod lines;
mod maps;
mod order;
mod parts;
mod pieces;
mod strip;
mod triangulations;

pub use maps::{PointMap, Values};
pub(crate) use parts::{CORNERS, Place, corner_at};
pub use parts::{Crossing, Origin, Refinement};
pub use triangulations::{Final, Input, Intrinsic, Triangulations};

use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::{Curves, FaceId};
use assemble::assemble;
use crossings::Drawn;
use lines::Lines;
use pieces::{Overlay, Pieces};

impl Refinement {
    /// The common refinement, of the pieces in those faces of the input that `keep` names (of a double those of
    /// [`crate::mesh::Double::is_original`]; the vertices that are kept must come first, as they do there). O(input + output), parallel
    /// inside a pool.
    ///
    /// # Errors
    /// - [`crate::Error::Size`].
    /// - [`crate::Error::TooLarge`] for more crossings than can be numbered.
    /// - [`crate::Error::Connectivity`] if the normal coordinates did not see every flip.
    /// - [`crate::Error::EdgeWeight`] where imaginary circles leave no straight line.
    /// - [`crate::Error::Domain`] at a vertex whose weights leave the range of doubles.
    /// - [`crate::Error::Cancelled`].
    pub fn new(all: Triangulations, keep: &dyn Fn(FaceId) -> bool, control: &Control) -> Result<Refinement> {
        all.check()?;
        let Triangulations { input, result, .. } = all;
        control.step(Stage::Layout, 0.0)?;
        let curves = Curves::trace(result.mesh, result.normal, control)?;
        let drawn = Drawn::new(&all, &Lines::new(input, &result)?, &curves, control)?;
        let overlay = Overlay { input: input.mesh, result: &result, curves: &curves, moved: &drawn.moved };
        let pieces = Pieces::cut(overlay, keep, control)?;
        assemble(pieces, drawn.crossings, drawn.weight)
    }
}

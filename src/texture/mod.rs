//! Texture atlases: a whole model, whatever its defects, as charts on its own faces, packed into a square page.
//!
//! ```text
//!     model ──► sheets ──► opened sheets ──► flat charts ──► page
//!               (mesh)     (seams where     (least stretch,  (packed by
//!                          the curvature is) split where      shape, in
//!                                            they overlap)    texels)
//! ```
//!
//! 1. The model is cut into sheets ([`crate::mesh::sheets`]): edges with more than two faces, vertices of several fans and one-sided strips are opened.
//! 2. Seams are added to a sheet until its conformal map that keeps the lengths of the seams changes lengths by little: the logarithm u of its factor
//!    solves `L u = −K` with u = 0 on the seams, which lead to the vertices where |u| is largest, as in \[GGH02\].
//! 3. The opened sheet is laid flat with least stretch ([`mod@crate::flatten`]), which turns no face over.
//! 4. A chart that overlaps itself is divided along a short path, and so is one that leaves much of the page empty.
//! 5. Charts are packed by their texels, with a margin between them: on one page, as large as they find room, or at a given density on several.
//!
//! ```
//! use ricci::mesh::shapes;
//! use ricci::texture::{TextureOptions, texture_atlas};
//! use ricci::Control;
//! # fn main() -> ricci::Result<()> {
//! let model = shapes::icosphere(2)?;
//! let atlas = texture_atlas(&model, &TextureOptions::default(), &Control::new())?;
//! assert_eq!(atlas.corner_uv.len(), model.faces.len());
//! assert!(atlas.folded.is_empty() && atlas.overlapping.is_empty());
//! # Ok(())
//! # }
//! ```

mod atlas_model;
mod cross_cut;
mod division;
mod flat_chart;
mod opening;
mod options;
mod page_bits;
mod page_packing;
mod quality;
mod seam_points;
mod seam_split;
mod texture_atlas;

pub use options::TextureOptions;
pub use quality::TextureQuality;
pub use seam_split::SeamSplitModel;
pub use texture_atlas::{TextureAtlas, texture_atlas, texture_atlas_of_parts};

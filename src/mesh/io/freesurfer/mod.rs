//! The files of FreeSurfer: surfaces, binary and ASCII, and data on their vertices: values (curv), annotations, labels, and patches, which
//! are parts of a surface, such as a cortex cut open and laid flat. Numbers are big-endian. The formats are those of
//! <https://surfer.nmr.mgh.harvard.edu/fswiki/FileFormats>.
//!
//! ```
//! use ricci::mesh::io::freesurfer::{parse_values, values_bytes};
//! let bytes = values_bytes(&[0.5, -1.25], 0)?;
//! assert_eq!(parse_values(&bytes, "lh.curv")?, [0.5, -1.25]);
//! # Ok::<(), ricci::Error>(())
//! ```

mod annotation;
mod big_endian;
mod label;
mod patch;
mod surface;
mod values;

pub use annotation::{Annotation, AnnotationEntry, annotation_bytes, parse_annotation};
pub use label::{VertexLabel, label_text, parse_label};
pub use patch::{SurfacePatch, parse_patch, patch_bytes};
pub use surface::{parse_freesurfer, write_freesurfer, write_freesurfer_text};
pub use values::{parse_values, values_bytes};

pub(super) use surface::{BINARY_MARK, TEXT_MARK};

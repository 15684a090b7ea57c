//! Polygons of VTK: the legacy files (.vtk), text or binary, and those in XML (.vtp). The formats are those of
//! <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

mod legacy;
mod legacy_file;
mod poly_data;
mod write;
#[cfg(feature = "gifti")]
mod xml;
#[cfg(feature = "gifti")]
mod xml_array;

pub use legacy::parse_vtk;
pub use write::write_vtk;
#[cfg(feature = "gifti")]
pub use write::write_vtp;
#[cfg(feature = "gifti")]
pub use xml::parse_vtp;

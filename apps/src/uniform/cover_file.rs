//! The copies of a cover as a file.

use super::copies::Copies;
use super::cover_glb::write_glb;
use super::cover_obj::write_obj;
use super::model_place::ModelPlace;
use super::quotient::Uniformized;
use crate::failure::Failure;
use crate::output::{Outputs, extension};
use crate::uv::corners;
use ricci::Control;
use std::path::Path;

/// Write all copies, OBJ or, from a name that ends in `.glb`, binary glTF.
pub fn write(
    outputs: &mut Outputs,
    path: &Path,
    u: &Uniformized,
    at: ModelPlace,
    threads: usize,
    control: &Control,
) -> Result<(), Failure> {
    let laid = u.laid()?;
    let copies = Copies {
        uniformized: u,
        elements: u.copies()?,
        points: &laid.layout.points,
        texcoords: laid.coordinates(),
        faces: corners(laid.mesh(), laid.corner_index()),
        at,
        threads,
    };
    let written = match extension(path).as_str() {
        "glb" => outputs.add(path, |out| write_glb(out, &copies, control)),
        _ => outputs.add(path, |out| write_obj(out, &copies, control)),
    };
    // A file that was given up halfway is no failure of its own.
    control.check()?;
    written
}

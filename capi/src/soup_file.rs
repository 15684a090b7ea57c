//! Files of triangle lists, with looks at the control of the call between the parts of the work.

use crate::control;
use crate::failure::Outcome;
use crate::memory;
use ricci::control::Stage;
use ricci::mesh::io::{self, Soup, SurfaceFile};
use std::path::Path;

/// The triangle list of a file.
pub fn read_soup(path: &Path) -> Outcome<Soup> {
    let _reserve = memory::file(path)?;
    let control = control::of_thread()?;
    control.step(Stage::Read, 0.0)?;
    let file = SurfaceFile::open(path)?;
    control.step(Stage::Read, 0.2)?;
    let soup = file.soup()?;
    control.step(Stage::Read, 0.6)?;
    Ok(soup)
}

/// Writes a triangle list in the format of the file's extension.
pub fn write_soup(path: &Path, soup: &Soup) -> Outcome {
    control::of_thread()?.step(Stage::Write, 0.2)?;
    for what in io::write(path, soup)? {
        log::warn!("{}: left out: {what}", path.display());
    }
    Ok(())
}

//! The connected pieces of a triangle list, each as a list of its own.
//!
//! ```
//! use ricci::control::Control;
//! use ricci::mesh::{components::components, io::Soup, shapes};
//! let disk = shapes::disk(2)?;
//! let n = disk.positions.len() as u32;
//! let moved = disk.positions.iter().map(|[x, y, z]| [x + 3.0, *y, *z]);
//! let positions = disk.positions.iter().copied().chain(moved).collect();
//! let faces = disk.faces.iter().copied().chain(disk.faces.iter().map(|f| f.map(|v| v + n))).collect();
//! let two = components(&Soup { positions, faces, ..Soup::default() }, &Control::new())?;
//! assert_eq!((two.len(), &two[0].soup.faces, two[1].vertices[0]), (2, &disk.faces, n));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check::{Defect, Diagnosis, diagnose};
use super::io::Soup;
use super::repair::{Repair, Repaired, repair};
use crate::control::Control;
use crate::error::{Error, Result};

/// A connected piece of a triangle list.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// The piece with its attributes; its elements keep their order.
    pub soup: Soup,
    /// For each vertex of the piece its number in the whole list.
    pub vertices: Vec<u32>,
    /// For each face of the piece its number in the whole list.
    pub faces: Vec<u32>,
}

/// The connected pieces of a list of triangles that has no other defect than to have several; those with the most faces first.
///
/// # Errors
/// [`Error::Defects`] with the other defects; [`Error::Cancelled`].
pub fn components(soup: &Soup, control: &Control) -> Result<Vec<Component>> {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    let is_known = |defect: &Defect| matches!(defect, Defect::SeveralComponents { .. });
    if !diagnosis.defects.iter().all(is_known) {
        let defects = diagnosis.defects.iter().filter(|defect| !is_known(defect)).cloned().collect();
        return Err(Error::Defects(Box::new(Diagnosis { defects, ..diagnosis })));
    }
    let piece = |k| {
        let one = Repair { weld: None, component: Some(k), ..Repair::default() };
        let Repaired { soup, vertex_origin, face_origin, .. } =
            repair(soup, &one, &control.part_of(k, diagnosis.components))?;
        Ok(Component { soup, vertices: vertex_origin, faces: face_origin })
    };
    (0..diagnosis.components).map(piece).collect()
}

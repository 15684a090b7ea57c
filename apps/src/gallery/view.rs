//! The view of a file in the gallery: of a surface alone, with its texture coordinates, or with another file of the same vertices.

use crate::failure::Failure;
use crate::page::{PageView, ViewSides};
use ricci::mesh::Point;
use ricci::mesh::io;
use std::path::Path;

/// Most vertices of a view of the gallery, those on a seam counted on each of its sides: it keeps a view below 1 MB.
pub const MOST_VERTICES: usize = 20_000;

/// The second side of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Companion {
    /// Nothing.
    Alone,
    /// The texture coordinates of its file.
    Texture,
    /// Another file with the same vertices, in order.
    Image,
}

/// The view of a file, or why there is none; `other`: the file with the image, where it is shown beside one.
///
/// # Errors
/// [`Failure::Input`] for files that cannot be read, and for an image with other vertices.
pub fn read(
    file: &Path,
    beside: Companion,
    other: &Path,
    up: Option<Point>,
) -> Result<Result<PageView, String>, Failure> {
    let soup = io::read(file)?;
    let sides = match beside {
        Companion::Alone => ViewSides::alone(&soup),
        Companion::Texture => ViewSides::textured(&soup),
        Companion::Image => {
            let image = io::read(other)?.positions;
            if image.len() != soup.positions.len() {
                return Err(Failure::Input(format!("{} has other vertices", other.display())));
            }
            ViewSides::imaged(&soup, &image)
        }
    };
    let n = sides.places.len();
    if n > MOST_VERTICES {
        let limit = "so the picture alone is shown";
        return Ok(Err(format!("A view has {MOST_VERTICES} vertices at most, and this one {n}, {limit}.")));
    }
    Ok(Ok(PageView::new(&sides, up, &[])))
}

//! Pages of one file, without any other, in which surfaces turn: the frame around them, and their data packed small enough to lie in it.

mod frame;
mod packed;
mod sides;

pub use frame::{PROGRAM, STYLE, data, embedded, escaped, fill, of_views};
pub use packed::{PageView, VertexQuantity};
pub use sides::ViewSides;

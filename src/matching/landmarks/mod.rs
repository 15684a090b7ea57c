//! The landmarks, boundary loops and curves by which the user says what corresponds on two surfaces, and paths between them.

pub(super) mod curves;
mod marked_surface;
mod marks;
mod router;
pub(super) mod soft;

pub(super) use marked_surface::{MarkedSurface, Marks};
pub(super) use marks::{loop_orders, marks};
pub(super) use router::PathRouter;

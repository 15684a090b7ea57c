//! Surfaces with boundary in their canonical shape: geodesic loops in H², straight sides in E², by known answers.

mod geodesic;
mod straight;
mod surfaces;

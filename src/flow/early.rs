//! The analysis for Newton's method, made beside the initial metric.

use super::options::{Method, Options};
use super::seconds::timed;
use super::system::System;
use crate::geometry::Space;
use crate::mesh::{Double, Mesh};
use crate::metric::Class;
use crate::parallel::is_shared;

/// The analysed system of a flow without pins by Newton's method, made while another thread forms the initial metric: one thread alone
/// finds its order.
pub(super) struct Early {
    pub system: System,
    /// What it took.
    pub seconds: f64,
}

impl Early {
    /// None where nobody else works, and where no system can be made: the error is then that of later.
    pub fn new(mesh: &Mesh, double: Option<&Double>, class: Class, options: &Options) -> Option<Early> {
        let is_plain =
            options.method == Method::Newton && class.space != Space::S2 && options.pinned.is_empty();
        if !is_plain || !is_shared() {
            return None;
        }
        let mut held = vec![false; mesh.n_vertices()];
        *held.first_mut()? = class.space == Space::E2;
        let mut seconds = 0.0;
        let system = timed(&mut seconds, || System::new(mesh, &held, double.map(mirror_of).as_deref()));
        Some(Early { system: system.ok()?, seconds })
    }
}

/// Per vertex of a double its mirror image.
pub(super) fn mirror_of(double: &Double) -> Vec<u32> {
    double.mesh.vertices().map(|v| double.mirror(v).0).collect()
}

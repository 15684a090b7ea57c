//! The copies of a cover as a file, one after the other: what is held at a time is as many copies as there are threads.

use super::cover_glb::write_glb;
use super::cover_obj::write_obj;
use super::group_file::name;
use super::model_place::ModelPlace;
use super::quotient::Uniformized;
use crate::failure::Failure;
use crate::output::{Outputs, extension};
use crate::picture::in_parallel;
use crate::uv::corners;
use ricci::Control;
use ricci::embed::DeckElement;
use ricci::embed::cover::moved;
use std::io;
use std::path::Path;

/// What all copies share, and how they are told apart.
pub struct Copies<'a> {
    pub uniformized: &'a Uniformized,
    pub elements: &'a [DeckElement],
    /// Ambient coordinates of the opened surface.
    pub points: &'a [[f64; 3]],
    /// Plane coordinates of the same.
    pub texcoords: &'a [[f64; 2]],
    pub faces: Vec<[u32; 3]>,
    pub at: ModelPlace,
    pub threads: usize,
}

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

impl Copies<'_> {
    /// The name of a copy.
    pub fn name(&self, k: usize) -> String {
        name(&self.uniformized.deck.group, &self.elements[k].word)
    }

    /// The points of a copy in the model.
    pub fn points(&self, k: usize) -> Vec<[f64; 3]> {
        let motion = &self.elements[k].motion;
        moved(self.points, motion).into_iter().map(|p| self.at.coordinates(p)).collect()
    }

    /// Work on copies in parallel and hand over what comes of each, in order.
    pub fn each<T: Send>(
        &self,
        control: &Control,
        work: impl Fn(usize) -> T + Sync,
        mut take: impl FnMut(T) -> io::Result<()>,
    ) -> io::Result<()> {
        let n = self.elements.len();
        let mut batch: Vec<Option<T>> = Vec::new();
        for first in (0..n).step_by(self.threads.max(1)) {
            control.check().map_err(io::Error::other)?;
            batch.clear();
            batch.resize_with(self.threads.max(1).min(n - first), || None);
            let slots: Vec<&mut Option<T>> = batch.iter_mut().collect();
            in_parallel(slots, self.threads, |k, slot| *slot = Some(work(first + k)));
            batch.drain(..).flatten().try_for_each(&mut take)?;
        }
        Ok(())
    }
}

//! The copies of a cover, one after the other: what is held at a time is as many copies as there are threads.

use super::group_file::name;
use super::model_place::ModelPlace;
use super::quotient::Uniformized;
use crate::picture::in_parallel;
use ricci::Control;
use ricci::embed::DeckElement;
use ricci::embed::cover::moved;
use std::io;

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

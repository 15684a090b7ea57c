//! Memory that threads share: each takes one piece, and lays it back.

use std::sync::{Mutex, PoisonError};

/// Pieces of memory that no thread has at the moment.
#[derive(Default)]
pub(super) struct Shelf<M> {
    free: Mutex<Vec<M>>,
}

impl<M: Default> Shelf<M> {
    /// Run `work` with a piece, as whoever had it last has left it.
    pub fn lend<R>(&self, work: impl FnOnce(&mut M) -> R) -> R {
        let kept = lock(&self.free).pop();
        let mut piece = kept.unwrap_or_default();
        let result = work(&mut piece);
        lock(&self.free).push(piece);
        result
    }

    /// Release what lies here.
    pub fn release(&self) {
        lock(&self.free).clear();
    }
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

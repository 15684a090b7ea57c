//! Memory that is reused by threads: each takes a piece from the pool and puts it back.

use std::sync::{Mutex, PoisonError};

/// The pieces of memory that no thread uses at the moment.
#[derive(Default)]
pub(super) struct MemoryPool<M> {
    free: Mutex<Vec<M>>,
}

impl<M: Default> MemoryPool<M> {
    /// Runs `work` with a piece of memory, which still has the contents of its last use.
    pub fn lend<R>(&self, work: impl FnOnce(&mut M) -> R) -> R {
        let kept = lock(&self.free).pop();
        let mut piece = kept.unwrap_or_default();
        let result = work(&mut piece);
        lock(&self.free).push(piece);
        result
    }

    /// Frees all pieces.
    pub fn release(&self) {
        lock(&self.free).clear();
    }
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

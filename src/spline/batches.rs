//! Work on many elements in parallel, which reports how far it is and ends when the call is cancelled.

use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::parallel;

/// The results of `work(memory, &all[i])` for every i, in parallel, or the first error. None is begun after the call is cancelled, and
/// progress is reported after every `size` of them; the memory is kept for many elements.
pub(super) fn in_batches<A: Sync, T: Send, M: Default>(
    all: &[A],
    size: usize,
    threads: usize,
    control: &Control,
    work: impl Fn(&mut M, &A) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    parallel::within(threads, || {
        let mut done = Vec::with_capacity(all.len());
        for batch in all.chunks(size) {
            control.step(Stage::Layout, done.len() as f64 / all.len() as f64)?;
            let mut found: Vec<Option<Result<T>>> = batch.iter().map(|_| None).collect();
            parallel::fill_with(&mut found, M::default, |memory, i| {
                Some(if control.is_cancelled() { Err(Error::Cancelled) } else { work(memory, &batch[i]) })
            });
            done.extend(found.into_iter().flatten().collect::<Result<Vec<_>>>()?);
        }
        control.step(Stage::Layout, 1.0)?;
        Ok(done)
    })
}

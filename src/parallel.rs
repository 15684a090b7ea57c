//! The thread pool of one call, and loops whose result does not depend on how many threads run them.
//!
//! The library never starts rayon's global pool: each solver has one of its own, or works in that of its caller, and everything parallel
//! runs inside [`Pool::run`], through the loops of this module. A pool of one thread is the caller's own: none is started. A loop writes
//! each element from one fixed computation, so results are bit-identical for any thread count.
//!
//! ```
//! use ricci::parallel::{Pool, fill};
//! let mut squares = vec![0; 5000];
//! Pool::new(2)?.run(|| fill(&mut squares, |i| i * i));
//! assert_eq!(squares[4000], 16_000_000);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use rayon::prelude::*;
use std::cell::Cell;
use std::fs::File;
use std::io::Read;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread::JoinHandle;

/// Elements that a thread takes at a time: enough that handing them over costs little. The number is fixed, so that the division of an
/// array does not depend on the number of threads.
const CHUNK: usize = 1024;

/// Most threads of a pool. No step of the library is divided finely enough for more to be of use.
pub const MAX_THREADS: usize = 256;

/// Bytes that a thread takes to start: its stack of 2 MiB, and what the C library notes about it, for which it may take 1 MiB at once.
const THREAD: usize = 3 << 20;

/// Bytes of address space from which the C library serves the small allocations of one thread, and to which it aligns them. Where glibc
/// cannot have them, each allocation of that thread becomes a page of its own: 4 KiB for 16 bytes.
const HEAP: usize = if cfg!(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64")) {
    64 << 20
} else {
    0
};

thread_local! {
    /// This thread runs the work of a pool that has no other.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Thread pool of one solver or call. Its threads have ended when it is dropped: a host that unloads the
/// library then leaves nothing behind.
pub struct Pool {
    threads: usize,
    /// Those that it has started, or none where the system refused; unset while the pools of its callers have done its work.
    own: OnceLock<Option<Threads>>,
}

/// Threads that have been started.
struct Threads {
    /// `None` while they are ended.
    pool: Option<rayon::ThreadPool>,
    workers: Vec<JoinHandle<()>>,
}

impl Pool {
    /// A pool of `threads` threads; 0 means one per available core, more than [`MAX_THREADS`] means that many. One thread is that
    /// which calls [`Pool::run`]. Where memory does not suffice for so many, there are as many as it suffices for. Inside a pool none is
    /// started before work comes from outside.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if the system cannot start that many threads.
    pub fn new(threads: usize) -> Result<Pool> {
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
        let mut threads = if threads == 0 { cores } else { threads.min(MAX_THREADS) };
        let own = OnceLock::new();
        if !is_shared() {
            threads = affordable(threads);
            if threads > 1 {
                let refused = || Error::argument("threads", threads, "as many as the system can start");
                let _ = own.set(Some(Threads::start(threads).ok_or_else(refused)?));
            }
        }
        Ok(Pool { threads, own })
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Run `work` inside the pool; one of several threads leaves it to the pool that the caller is in, if any.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        if self.threads == 1 {
            return alone(work);
        }
        if is_shared() {
            return work();
        }
        // The result is the same on any number of threads.
        let own = self.own.get_or_init(|| Threads::start(affordable(self.threads)));
        match own.as_ref().and_then(|own| own.pool.as_ref()) {
            Some(pool) => pool.install(work),
            None => alone(work),
        }
    }
}

impl Threads {
    /// `None` where the system refuses, and for one thread, which is that of the caller.
    fn start(n: usize) -> Option<Threads> {
        if n == 1 {
            return None;
        }
        let mut workers = Vec::new();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .spawn_handler(|worker| {
                let name = format!("ricci-{}", worker.index());
                workers.push(std::thread::Builder::new().name(name).spawn(|| worker.run())?);
                Ok(())
            })
            .build()
            .ok()?;
        Some(Threads { pool: Some(pool), workers })
    }
}

/// Of so many threads as many as memory suffices for.
fn affordable(mut threads: usize) -> usize {
    let heap = if threads > 1 && is_address_space_limited() { HEAP } else { 0 };
    while threads > 1 && !is_room_for(threads * (THREAD + heap) + heap) {
        threads /= 2;
    }
    threads
}

/// Whether the allocator has so many bytes. One that holds memory in reserve, as that of the C face does, then gives it back: the C
/// library, which ends the process if it finds no memory for a new thread's notes, does not ask for it.
pub(crate) fn is_room_for(bytes: usize) -> bool {
    let mut room = Vec::<u8>::new();
    let is_there = room.try_reserve_exact(bytes).is_ok();
    std::hint::black_box(&room);
    is_there
}

/// Whether the system limits the addresses of this process, as far as Linux tells. Nothing is allocated to find out.
fn is_address_space_limited() -> bool {
    let mut bytes = [0; 2048];
    let read = File::open("/proc/self/limits").and_then(|mut file| file.read(&mut bytes));
    let text = read.ok().and_then(|n| std::str::from_utf8(&bytes[..n]).ok());
    let limit = text.and_then(|text| text.lines().find_map(|line| line.strip_prefix("Max address space")));
    limit.is_some_and(|limit| !limit.trim_start().starts_with("unlimited"))
}

/// Run `work` on this thread, nothing of it on others.
fn alone<R>(work: impl FnOnce() -> R) -> R {
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            ALONE.set(self.0);
        }
    }
    let _before = Before(ALONE.replace(true));
    work()
}

/// Whether other threads may take part of the work of this one.
pub(crate) fn is_shared() -> bool {
    !ALONE.get() && rayon::current_thread_index().is_some()
}

/// Run `work` inside a pool: the one that the caller is in, else one of `threads` threads ([`Pool::new`]) for this call alone.
///
/// # Errors
///
/// Those of `work` and [`Pool::new`].
pub fn within<R: Send>(threads: usize, work: impl FnOnce() -> Result<R> + Send) -> Result<R> {
    if ALONE.get() || is_shared() { work() } else { Pool::new(threads)?.run(work) }
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.pool = None;
        for worker in self.workers.drain(..) {
            // A panic in a worker has already been passed on to the caller of `run`.
            let _ = worker.join();
        }
    }
}

/// `out[i] = f(i)` for every i, in parallel when called inside a pool, one after the other outside: rayon
/// would start its global pool there.
pub fn fill<T: Send>(out: &mut [T], f: impl Fn(usize) -> T + Sync) {
    in_parts(out, |start, part| {
        part.iter_mut().enumerate().for_each(|(i, x)| *x = f(start + i));
    });
}

/// [`fill`] with memory that is made once for many elements: `out[i] = f(&mut memory, i)`.
pub fn fill_with<T: Send, M>(
    out: &mut [T],
    new: impl Fn() -> M + Sync,
    f: impl Fn(&mut M, usize) -> T + Sync,
) {
    in_chunks(out.chunks_mut(CHUNK), |c, chunk| {
        let mut memory = new();
        chunk.iter_mut().enumerate().for_each(|(i, x)| *x = f(&mut memory, c * CHUNK + i));
    });
}

/// `(a[i], b[i]) = f(i)` for every i of two arrays of the same length, as [`fill`].
pub fn fill_both<A: Send, B: Send>(a: &mut [A], b: &mut [B], f: impl Fn(usize) -> (A, B) + Sync) {
    in_parts_of_both(a, b, |start, a, b| {
        a.iter_mut().zip(b).enumerate().for_each(|(i, (a, b))| (*a, *b) = f(start + i));
    });
}

/// `work` on parts of an array, `work(i, …)` on the one that begins with element i, as [`fill`].
pub fn in_parts<T: Send>(out: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    in_chunks(out.chunks_mut(CHUNK), |c, part| work(c * CHUNK, part));
}

/// `work` on parts of two arrays of the same length, `work(i, …)` on those that begin with element i, as [`fill`].
pub fn in_parts_of_both<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    work: impl Fn(usize, &mut [A], &mut [B]) + Sync,
) {
    in_chunks(a.chunks_mut(CHUNK).zip(b.chunks_mut(CHUNK)), |c, (a, b)| work(c * CHUNK, a, b));
}

/// `work` on each item, in parallel when called inside a pool, one after the other outside.
pub fn each<T: Send>(items: Vec<T>, work: impl Fn(T) + Sync) {
    if items.len() <= 1 || !is_shared() {
        items.into_iter().for_each(work);
        return;
    }
    let items: Vec<Mutex<Option<T>>> = items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    share(items.len(), &|k| {
        let item = items[k].lock().unwrap_or_else(PoisonError::into_inner).take();
        item.into_iter().for_each(&work);
    });
}

/// `f(0), f(1), …, f(n − 1)`, each a piece of work of its own, as [`fill`] runs them.
pub fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut out: Vec<Option<T>> = (0..n).map(|_| None).collect();
    in_chunks(out.chunks_mut(1), |k, slot| slot[0] = Some(f(k)));
    out.into_iter().flatten().collect()
}

/// Both results, side by side inside a pool of several threads, else one after the other.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    if is_shared() { rayon::join(a, b) } else { (a(), b()) }
}

/// Lets other work of the pool that waits for a thread go first: for work that nothing waits for, between two pieces of it.
pub fn give_way() {
    if is_shared() {
        rayon::yield_now();
    }
}

/// Hands each chunk with its number to `work`, which whoever comes to it locks.
fn in_chunks<C: Send>(chunks: impl ExactSizeIterator<Item = C>, work: impl Fn(usize, &mut C) + Sync) {
    if chunks.len() <= 1 || !is_shared() {
        chunks.enumerate().for_each(|(c, mut chunk)| work(c, &mut chunk));
        return;
    }
    let chunks: Vec<Mutex<C>> = chunks.map(Mutex::new).collect();
    share(chunks.len(), &|c| work(c, &mut chunks[c].lock().unwrap_or_else(PoisonError::into_inner)));
}

/// `work(c)` for every c below `n`, by all threads of the pool that this one belongs to. The machinery of rayon is compiled here, once for
/// all loops.
fn share(n: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..n).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn one_thread_is_that_of_the_caller_and_shares_nothing() {
        let (here, one, two) = (thread::current().id(), Pool::new(1).unwrap(), Pool::new(2).unwrap());
        let threads = || map(100, |_| thread::current().id());
        assert!(one.run(threads).iter().all(|id| *id == here));
        assert!(one.run(|| within(3, || Ok(threads()))).unwrap().iter().all(|id| *id == here));
        let ids = one.run(|| join(|| thread::current().id(), || thread::current().id()));
        assert_eq!(ids, (here, here));
        // Inside a pool of two threads as well, which is shared again afterwards.
        two.run(|| {
            let worker = thread::current().id();
            assert!(worker != here && one.run(threads).iter().all(|id| *id == worker));
            assert!(is_shared());
        });
        // A panic leaves the thread as it was.
        assert!(
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| one.run(|| panic!("on purpose"))))
                .is_err()
        );
        assert!(within(2, || Ok(thread::current().id())).unwrap() != here);
    }

    #[test]
    fn a_pool_leaves_work_to_that_of_the_caller_and_starts_its_own_outside() {
        let two = Pool::new(2).unwrap();
        let ids = || map(1000, |_| thread::current().id());
        let (inner, worker) = two.run(|| {
            let (inner, worker) = (Pool::new(3).unwrap(), thread::current().id());
            assert_eq!(inner.run(|| thread::current().id()), worker);
            assert!(inner.own.get().is_none());
            (inner, worker)
        });
        let others = inner.run(ids);
        assert!(
            inner.own.get().is_some()
                && !others.contains(&worker)
                && !others.contains(&thread::current().id())
        );
        assert_eq!(inner.threads(), 3);
    }

    #[test]
    fn fill_reaches_every_element_once_for_any_thread_count() {
        for threads in [1, 2, 3] {
            let mut out = vec![0usize; 10_000];
            Pool::new(threads).unwrap().run(|| fill(&mut out, |i| i * i));
            assert!(out.iter().enumerate().all(|(i, &x)| x == i * i));
        }
    }
}

//! The thread pool of one call, and parallel loops whose results do not depend on the number of threads.
//!
//! The library never starts rayon's global pool: each solver has a pool of its own or works in that of its caller, and everything
//! parallel runs inside [`Pool::run`], through the loops of this module. A pool of one thread is the caller's thread, and starts none. A
//! loop writes each element from one fixed computation, so results are bit-identical for any number of threads.
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

/// Elements that a thread takes at a time, so many that taking them costs little. The number is fixed, so that the division of an array
/// does not depend on the number of threads.
const CHUNK: usize = 1024;

/// Most threads of a pool. No step of the library is divided into enough parts for more to be of use.
pub const MAX_THREADS: usize = 256;

/// Bytes that starting a thread takes: its stack of 2 MiB, and the records of the C library about it, up to 1 MiB at once.
const THREAD: usize = 3 << 20;

/// Bytes of address space that glibc reserves per thread for small allocations, and aligns them to. Where it cannot have them, each
/// allocation of that thread becomes a page of its own: 4 KiB for 16 bytes.
const HEAP: usize = if cfg!(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64")) {
    64 << 20
} else {
    0
};

thread_local! {
    /// True while this thread runs the work of a pool of one thread.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// The thread pool of one solver or call. Its threads have ended when it is dropped, so that a host that unloads the library is left with
/// none.
pub struct Pool {
    threads: usize,
    /// The threads that it has started, `None` inside where the system refused. Unset as long as its work has run in the pools of its
    /// callers.
    own: OnceLock<Option<StartedThreads>>,
}

/// Started threads.
struct StartedThreads {
    /// `None` while the threads are ending.
    pool: Option<rayon::ThreadPool>,
    workers: Vec<JoinHandle<()>>,
}

impl Pool {
    /// A pool of `threads` threads; 0 means one per available core, and at most [`MAX_THREADS`] are used. A pool of one thread uses the
    /// thread that calls [`Pool::run`]. Where memory is short, there are as many threads as it suffices for. A pool made inside another
    /// pool starts its threads when it is first used outside.
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
                let _ = own.set(Some(StartedThreads::start(threads).ok_or_else(refused)?));
            }
        }
        Ok(Pool { threads, own })
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Runs `work` inside the pool, or, if the pool has several threads and the caller is in a pool already, inside the caller's.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        if self.threads == 1 {
            return alone(work);
        }
        if is_shared() {
            return work();
        }
        // The caller may be in another pool than when this one was made; the result is the same on any number of threads.
        let own = self.own.get_or_init(|| StartedThreads::start(affordable(self.threads)));
        match own.as_ref().and_then(|own| own.pool.as_ref()) {
            Some(pool) => pool.install(work),
            None => alone(work),
        }
    }
}

impl StartedThreads {
    /// Starts n threads; `None` where the system refuses, and for n = 1, which is the caller's thread.
    fn start(n: usize) -> Option<StartedThreads> {
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
        Some(StartedThreads { pool: Some(pool), workers })
    }
}

/// The number of threads, halved until memory suffices for them.
fn affordable(mut threads: usize) -> usize {
    let heap = if threads > 1 && is_address_space_limited() { HEAP } else { 0 };
    while threads > 1 && !is_room_for(threads * (THREAD + heap) + heap) {
        threads /= 2;
    }
    threads
}

/// True if the allocator has this many bytes. The allocator of the C face then releases its reserves. This is asked before a thread
/// starts, since the C library ends the process if it has no memory for the records of a new thread.
pub(crate) fn is_room_for(bytes: usize) -> bool {
    let mut room = Vec::<u8>::new();
    let is_there = room.try_reserve_exact(bytes).is_ok();
    std::hint::black_box(&room);
    is_there
}

/// True if the system limits the address space of this process, as far as Linux tells. Nothing is allocated to find out.
fn is_address_space_limited() -> bool {
    let mut bytes = [0; 2048];
    let read = File::open("/proc/self/limits").and_then(|mut file| file.read(&mut bytes));
    let text = read.ok().and_then(|n| std::str::from_utf8(&bytes[..n]).ok());
    let limit = text.and_then(|text| text.lines().find_map(|line| line.strip_prefix("Max address space")));
    limit.is_some_and(|limit| !limit.trim_start().starts_with("unlimited"))
}

/// Runs `work` on this thread, without any help of others.
fn alone<R>(work: impl FnOnce() -> R) -> R {
    struct RestoreAlone(bool);
    impl Drop for RestoreAlone {
        fn drop(&mut self) {
            ALONE.set(self.0);
        }
    }
    let _before = RestoreAlone(ALONE.replace(true));
    work()
}

/// True if other threads may take part in the work of this one.
pub(crate) fn is_shared() -> bool {
    !ALONE.get() && rayon::current_thread_index().is_some()
}

/// Runs `work` inside a pool: the one that the caller is in, else one of `threads` threads ([`Pool::new`]) for this call alone.
///
/// # Errors
///
/// Those of `work` and [`Pool::new`].
pub fn within<R: Send>(threads: usize, work: impl FnOnce() -> Result<R> + Send) -> Result<R> {
    if ALONE.get() || is_shared() { work() } else { Pool::new(threads)?.run(work) }
}

impl Drop for StartedThreads {
    fn drop(&mut self) {
        self.pool = None;
        for worker in self.workers.drain(..) {
            // A panic in a worker has already been passed on to the caller of `run`.
            let _ = worker.join();
        }
    }
}

/// `out[i] = f(i)` for every i: in parallel inside a pool, one after the other outside, where rayon would start its global pool.
pub fn fill<T: Send>(out: &mut [T], f: impl Fn(usize) -> T + Sync) {
    in_parts(out, |start, part| {
        part.iter_mut().enumerate().for_each(|(i, x)| *x = f(start + i));
    });
}

/// [`fill`] with memory that is allocated once for many elements: `out[i] = f(&mut memory, i)`.
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

/// `(a[i], b[i]) = f(i)` for every i of two arrays of the same length, run like [`fill`].
pub fn fill_both<A: Send, B: Send>(a: &mut [A], b: &mut [B], f: impl Fn(usize) -> (A, B) + Sync) {
    in_parts_of_both(a, b, |start, a, b| {
        a.iter_mut().zip(b).enumerate().for_each(|(i, (a, b))| (*a, *b) = f(start + i));
    });
}

/// Calls `work(i, part)` for parts of an array, i being the index of the part's first element; run like [`fill`].
pub fn in_parts<T: Send>(out: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    in_chunks(out.chunks_mut(CHUNK), |c, part| work(c * CHUNK, part));
}

/// Calls `work(i, part_a, part_b)` for parts of two arrays of the same length, i being the index of their first elements; run like
/// [`fill`].
pub fn in_parts_of_both<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    work: impl Fn(usize, &mut [A], &mut [B]) + Sync,
) {
    in_chunks(a.chunks_mut(CHUNK).zip(b.chunks_mut(CHUNK)), |c, (a, b)| work(c * CHUNK, a, b));
}

/// Calls `work` for each item: in parallel inside a pool, one after the other outside.
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

/// The results `f(0), f(1), …, f(n − 1)`, each computed as a task of its own, run like [`fill`].
pub fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut out: Vec<Option<T>> = (0..n).map(|_| None).collect();
    in_chunks(out.chunks_mut(1), |k, slot| slot[0] = Some(f(k)));
    out.into_iter().flatten().collect()
}

/// Both results, computed in parallel inside a pool of several threads, else one after the other.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    if is_shared() { rayon::join(a, b) } else { (a(), b()) }
}

/// Lets other tasks of the pool run first. To be called between two parts of a task that no thread waits for.
pub fn give_way() {
    if is_shared() {
        rayon::yield_now();
    }
}

/// Passes each chunk and its number to `work`; the thread that takes a chunk locks it.
fn in_chunks<C: Send>(chunks: impl ExactSizeIterator<Item = C>, work: impl Fn(usize, &mut C) + Sync) {
    if chunks.len() <= 1 || !is_shared() {
        chunks.enumerate().for_each(|(c, mut chunk)| work(c, &mut chunk));
        return;
    }
    let chunks: Vec<Mutex<C>> = chunks.map(Mutex::new).collect();
    share(chunks.len(), &|c| work(c, &mut chunks[c].lock().unwrap_or_else(PoisonError::into_inner)));
}

/// Calls `work(c)` for every c below `n`, on all threads of the current pool. rayon's loop is compiled only here, once for all loops.
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
        // The same holds inside a pool of two threads, which is shared again afterwards.
        two.run(|| {
            let worker = thread::current().id();
            assert!(worker != here && one.run(threads).iter().all(|id| *id == worker));
            assert!(is_shared());
        });
        // A panic leaves the state of the thread unchanged.
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

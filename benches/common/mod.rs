//! Helpers of several benches, each of which compiles this module by itself and uses a part of it.
#![allow(dead_code)]

pub mod heap;
pub mod machine;
pub mod peers;

/// The median of some numbers.
pub fn median(x: impl Iterator<Item = f64>) -> f64 {
    let mut x: Vec<f64> = x.collect();
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

/// The seconds of some work, and its result.
pub fn seconds<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let start = std::time::Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

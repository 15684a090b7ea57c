//! Golden vectors (`tests/vectors/README.md`): what the library computes agrees with the numbers that all languages are held to, and is the
//! same bit for bit for any number of threads.
#![cfg(all(feature = "json", feature = "splines"))]
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "vectors/calls.rs"]
mod calls;
#[path = "vectors/cases.rs"]
mod cases;
mod common;

use calls::{call, formula};
use cases::{Case, Found};
use ricci::geometry::conformal::{Vertex, differences, edge, length};
use std::collections::BTreeSet;

/// The numbers of a case; a call that does not exist fails.
fn numbers_of(case: &Case, threads: usize) -> Found {
    call(case, threads).or_else(|| formula(case)).unwrap_or_else(|| panic!("{}: no such call", case.name))
}

#[test]
fn every_case_agrees() {
    let cases = cases::all();
    assert!(!cases.is_empty());
    let failures: Vec<String> =
        cases.iter().flat_map(|case| case.failures(|case| Some(numbers_of(case, 0)))).collect();
    for line in &failures {
        eprintln!("{line}");
    }
    assert!(failures.is_empty(), "{} of {} cases do not agree", failures.len(), cases.len());
    let files: BTreeSet<&str> = cases.iter().filter_map(|case| Some(case.name.split_once('/')?.0)).collect();
    assert_eq!(files.len(), 14, "{files:?}");
    println!("{} cases of {} capabilities agree", cases.len(), files.len());
}

/// What a computation gives, as 64 bits: FNV-1a of its numbers' bits.
fn bits(found: &Found) -> u64 {
    let bytes = found.iter().flat_map(|(_, x)| x).flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |v, byte| (v ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// `tests/vectors/bits` compares the line that is printed with that of a release build.
#[test]
fn results_are_the_same_bits_for_any_number_of_threads() {
    let mut all = 0u64;
    for case in cases::all() {
        let [one, two, eight] = [1, 2, 8].map(|threads| bits(&numbers_of(&case, threads)));
        assert!(one == two && two == eight, "{}: {one:016x} {two:016x} {eight:016x}", case.name);
        all = all.rotate_left(1) ^ one;
    }
    println!("bits of all results: {all:016x}");
}

/// Lengths of twice the digits, which is how files hold them, give the differences that angles are formed from.
#[test]
fn circles_of_very_different_sizes_keep_their_differences_in_files() {
    let mut n = 0;
    for case in cases::all().iter().filter(|case| case.call() == "circle_pattern") {
        let (space, eta) = (case.space(), case.numbers("eta"));
        let u = case.numbers("u");
        let corners = [0, 1, 2].map(|k| Vertex::new(space, 1, u[k]));
        let edges =
            [0, 1, 2].map(|k| edge(space, corners[(k + 1) % 3], corners[(k + 2) % 3], eta[k]).unwrap());
        let r = differences(corners, edges);
        let l = edges.map(|e| length(space, e.q2));
        let lo = [0, 1, 2].map(|k| edges[k].remainder(corners[(k + 1) % 3], corners[(k + 2) % 3], l[k]));
        let longest = l.into_iter().fold(0.0, f64::max);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            // Exact in the order that Kahan's differences have.
            let (a, b) = if l[i] > l[j] { (l[i], l[j]) } else { (l[j], l[i]) };
            let high = if l[k] < b { a + (b - l[k]) } else { b + (a - l[k]) };
            let ours = 0.5 * (high + (lo[i] + lo[j] - lo[k]));
            assert!((ours - r[k]).abs() <= 1e-15 * r[k] + 1e-30 * longest, "{}: r {k}", case.name);
        }
        n += 1;
    }
    assert_eq!(n, 45);
}

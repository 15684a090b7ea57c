//! The readers of GIFTI: surfaces, and the values and labels on them.
#![no_main]

use ricci::mesh::io::{parse_gifti, parse_gifti_columns};
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_gifti, data);
    if let Ok(found) = parse_gifti_columns(data, "input")
        && let Some(labels) = found.labels()
    {
        assert!(labels.into_iter().flatten().all(|row| row < found.table.len()));
    }
});

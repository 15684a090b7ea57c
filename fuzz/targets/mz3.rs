//! The reader of MZ3.
#![no_main]

use ricci::mesh::io::parse_mz3;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_mz3, data);
});

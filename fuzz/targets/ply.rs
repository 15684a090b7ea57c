//! The reader of PLY.
#![no_main]

use ricci::mesh::io::parse_ply;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_ply, data);
});

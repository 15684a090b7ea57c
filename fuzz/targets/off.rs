//! The reader of OFF, text and binary.
#![no_main]

use ricci::mesh::io::parse_off;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_off, data);
});

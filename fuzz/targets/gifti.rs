//! The reader of GIFTI.
#![no_main]

use ricci::mesh::io::parse_gifti;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_gifti, data);
});

//! The reader of binary glTF.
#![no_main]

use ricci::mesh::io::parse_glb;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_glb, data);
});

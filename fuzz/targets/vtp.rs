//! The reader of VTK in XML.
#![no_main]

use ricci::mesh::io::parse_vtp;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_vtp, data);
});

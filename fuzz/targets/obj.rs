//! The reader of OBJ.
#![no_main]

use ricci::mesh::io::parse_obj;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_obj, data);
});

//! The reader of STL, welded exactly and by tolerance.
#![no_main]

use ricci::mesh::io::{parse_stl, parse_stl_welded};
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_stl, data);
    read(|bytes, path| parse_stl_welded(bytes, path, 0.5), data);
});

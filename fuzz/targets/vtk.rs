//! The reader of legacy VTK.
#![no_main]

use ricci::mesh::io::parse_vtk;
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_vtk, data);
});

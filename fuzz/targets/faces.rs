//! Building a mesh from faces: three bytes each, after one for the number of vertices.
#![no_main]

use ricci::mesh::io::Soup;
use ricci_fuzz::{build, position};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((&n, rest)) = data.split_first() else { return };
    // At most as many vertices as one bit less than a byte can name: some corners are out of range.
    let positions = (0..n % 128).map(|v| position(v.into())).collect();
    let faces = rest.chunks_exact(3).map(|f| [0, 1, 2].map(|k| u32::from(f[k]))).collect();
    build(&Soup::new(positions, faces));
});

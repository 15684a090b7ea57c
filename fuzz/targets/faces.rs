//! Building and repairing a mesh from faces: three bytes each, after one for the number of vertices and one for how to repair.
#![no_main]

use ricci::mesh::io::{Attributes, Soup};
use ricci_fuzz::{build, lattice, mend, options, position};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((&[n, how], rest)) = data.split_first_chunk() else { return };
    // At most as many vertices as one bit less than a byte can name: some corners are out of range. The first bit says where
    // they are: in places of their own, or on a few, so that they are welded.
    let place = if n < 128 { position } else { lattice };
    let vertices = 0..u32::from(n % 128);
    let faces: Vec<[u32; 3]> = rest.chunks_exact(3).map(|f| [0, 1, 2].map(|k| u32::from(f[k]))).collect();
    let mut soup = Soup::new(vertices.clone().map(place).collect(), faces);
    build(&soup);
    soup.attributes = Attributes {
        normals: Some(vertices.clone().map(|v| [1.0, v.into(), 0.0]).collect()),
        colors: Some(vertices.map(|v| [f64::from(v) / 128.0, 0.0, 0.0, 1.0]).collect()),
        corner_normals: Some(
            (0..soup.faces.len()).map(|f| [0.0, 1.0, 2.0].map(|k| [f as f64, k, 1.0])).collect(),
        ),
        uv: Some((0..soup.faces.len()).map(|f| [0.0, 1.0, 2.0].map(|k| [f as f64, k])).collect()),
        ..Attributes::default()
    };
    mend(&soup, &options(how));
});

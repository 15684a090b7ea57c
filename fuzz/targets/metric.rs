//! The reader of metric files: what it accepts is a surface with lengths, and is written and read again as it was.
#![no_main]

#[path = "../../apps/src/failure.rs"]
#[allow(dead_code)]
mod failure;
#[path = "../../apps/src/metric_file.rs"]
#[allow(dead_code)]
mod metric_file;

use failure::Failure;
use metric_file::LengthsFile;
use ricci::geometry::Space;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    for geometry in [None, Some(Space::S2)] {
        match metric_file::parse(Path::new("input"), text, geometry) {
            Ok(surface) => {
                let (mesh, lengths) = (surface.mesh(), surface.lengths());
                mesh.validate().unwrap();
                ricci_fuzz::counts(mesh);
                assert!(lengths.iter().all(|l| l.is_finite() && *l > 0.0));
                let again =
                    serde_json::to_string(&LengthsFile::new(mesh, surface.geometry(), lengths)).unwrap();
                let back = metric_file::parse(Path::new("again"), &again, None).unwrap();
                assert_eq!(back.mesh().triangles(), mesh.triangles());
                assert_eq!(back.geometry(), surface.geometry());
                for (f, g) in mesh.faces().zip(back.mesh().faces()) {
                    let sides = |of: &ricci::Surface, f| {
                        of.mesh().opposite_edges(f).map(|e| of.lengths()[e].to_bits())
                    };
                    assert_eq!(sides(&surface, f), sides(&back, g));
                }
            }
            Err(failure) => {
                assert!(!failure.to_string().is_empty());
                assert!(!matches!(failure, Failure::Failed(_) | Failure::Cancelled), "{failure}");
            }
        }
    }
});

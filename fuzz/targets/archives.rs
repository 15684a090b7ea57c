//! The reader of archives: what is accepted is written to the same bytes again.
#![no_main]

use ricci::archive::{self, ArchiveFrame, Kept};
use ricci::canonical::{CircleDomain, Uniformization};
use ricci::records::*;
use ricci::seamless::Seamless;
use ricci::structure::Atlas;

/// Reads a content as that of an archive of this kind.
fn read<T: Kept>(content: &[u8]) {
    let bytes = archive::framed(T::KIND, |writer| writer.raw(content));
    let again = match archive::from_bytes::<T>(&bytes) {
        Ok(object) => archive::to_bytes(&object),
        Err(error) => {
            assert!(error.to_string().len() > 8, "{error}");
            return;
        }
    };
    let object: T = archive::from_bytes(&again).unwrap();
    assert!(archive::to_bytes(&object) == again);
}

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = ArchiveFrame::open(data, "data");
    let Some((kind, content)) = data.split_first() else { return };
    match kind % 15 {
        0 => read::<MeshRecord>(content),
        1 => read::<MetricRecord>(content),
        2 => read::<LayoutRecord>(content),
        3 => read::<ChartsRecord>(content),
        4 => read::<MapRecord>(content),
        5 => read::<Uniformization>(content),
        6 => read::<CircleDomain>(content),
        7 => read::<FormsRecord>(content),
        8 => read::<MatchingRecord>(content),
        9 => read::<Atlas>(content),
        10 => read::<Seamless>(content),
        11 => read::<QuadsRecord>(content),
        12 => read::<QuadLayoutRecord>(content),
        13 => read::<QuadSplineRecord>(content),
        _ => read::<SplineRecord>(content),
    }
});

//! The readers of FreeSurfer's files: surfaces, and by the first byte of the others their values, annotations, labels or patches, which read back
//! to the same once they are written.
#![no_main]

use ricci::mesh::io::freesurfer::{
    annotation_bytes, label_text, parse_annotation, parse_freesurfer, parse_label, parse_patch, parse_values,
    patch_bytes, values_bytes,
};
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_freesurfer, data);
    if let Ok(values) = parse_values(data, "input")
        && let Ok(bytes) = values_bytes(&values, 0)
    {
        let singles = values.iter().map(|x| f64::from(*x as f32));
        assert!(parse_values(&bytes, "written").unwrap().into_iter().eq(singles));
    }
    if let Ok(annotation) = parse_annotation(data, "input")
        && let Ok(bytes) = annotation_bytes(&annotation)
    {
        assert_eq!(parse_annotation(&bytes, "written").unwrap(), annotation);
    }
    if let Ok(patch) = parse_patch(data, "input")
        && let Ok(bytes) = patch_bytes(&patch)
    {
        assert_eq!(parse_patch(&bytes, "written").unwrap(), patch);
    }
    let text = String::from_utf8_lossy(data);
    if let Ok(label) = parse_label(&text, "input")
        && let Ok(text) = label_text(&label)
    {
        assert_eq!(parse_label(&text, "written").unwrap(), label);
    }
});

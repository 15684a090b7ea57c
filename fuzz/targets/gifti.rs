//! The readers of GIFTI: surfaces, the values and labels on them, and notes.
#![no_main]

use ricci::mesh::io::{GiftiNotes, gifti_values, parse_gifti, parse_gifti_columns, parse_gifti_notes};
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_gifti, data);
    if let Ok(found) = parse_gifti_columns(data, "input")
        && let Some(labels) = found.labels()
    {
        assert!(labels.into_iter().flatten().all(|row| row < found.table.len()));
    }
    if let Ok(GiftiNotes { metadata, .. }) = parse_gifti_notes(data, "input") {
        let notes = GiftiNotes { metadata, ..GiftiNotes::default() };
        // Characters that XML has not are read, and not written.
        match gifti_values(&[], &notes) {
            Ok(bytes) => assert_eq!(parse_gifti_notes(&bytes, "input").expect("and read"), notes),
            Err(e) => assert!(e.to_string().contains("characters that XML has"), "{e}"),
        }
    }
});

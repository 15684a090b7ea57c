//! Sequences of calls of the C face, every function of its headers among them.
#![no_main]

libfuzzer_sys::fuzz_target!(
    // The shared handles are made before the clock of the first input runs.
    init: ricci_fuzz::face::prepare(),
    |data: &[u8]| {
        ricci_fuzz::face::run(data);
    }
);

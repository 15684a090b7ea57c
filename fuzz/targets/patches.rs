//! The reader of files of bicubic patches: what it accepts is evaluated without a NaN, and is written and read again as it was.
#![no_main]

use ricci::Error;
use ricci::spline::{BicubicSurface, StepOptions};

fn text(surface: &BicubicSurface) -> String {
    let mut bytes = Vec::new();
    surface.write_json(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(given) = std::str::from_utf8(bytes) else { return };
    let surface = match BicubicSurface::from_json(given, "input") {
        Ok(surface) => surface,
        Err(Error::Parse { message, .. } | Error::Spline { message, .. }) => {
            assert!(!message.is_empty());
            return;
        }
        Err(other) => panic!("{other}"),
    };
    // Differences of huge numbers overflow.
    let control = || surface.patches.iter().flat_map(|patch| patch.control.iter().flatten().flatten());
    let moderate = control().all(|x| x.abs() < 1e100);
    for patch in &surface.patches {
        for place in [[0.0, 0.0], [1.0, 1.0], [0.3, 0.7]] {
            let found = patch.evaluate(place);
            assert!(!moderate || found.point.iter().all(|x| x.is_finite()), "{found:?}");
        }
    }
    assert_eq!(surface.open_sides(), 0);
    assert_eq!(surface.parts().iter().map(Vec::len).sum::<usize>(), surface.patches.len());
    assert!(!moderate || !surface.diagonal().is_nan());
    let again = text(&surface);
    assert_eq!(text(&BicubicSurface::from_json(&again, "again").unwrap()), again);
    let mut step = Vec::new();
    match surface.write_step(&StepOptions::default(), &mut step) {
        Ok(()) => assert!(step.starts_with(b"ISO-10303-21;")),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

//! The reader of spline files: what it accepts is evaluated without a NaN, and is written and read again as it was.
#![no_main]
use libfuzzer_sys::fuzz_target;
use ricci::spline::{Parameter, Spline};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(spline) = Spline::from_json(text, "input") else { return };
    for (patch, of) in spline.space().patches().iter().enumerate() {
        let corners = of.corners();
        for weights in [[1.0, 0.0, 0.0], [0.2, 0.3, 0.5]] {
            let [x, y] = [0, 1].map(|x| (0..3).map(|k| weights[k] * corners[k][x]).sum());
            let found = spline.point(Parameter { patch: patch as u32, x, y }).unwrap();
            assert!(found.iter().all(|x| x.is_finite()), "{found:?}");
        }
    }
    let text = spline.to_json();
    assert_eq!(Spline::from_json(&text, "again").unwrap().to_json(), text);
});

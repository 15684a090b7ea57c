//! Copies of the opened surface as OBJ: an object each, named by its word; texture coordinates once, for all.

use super::copies::Copies;
use ricci::Control;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Write the copies: numbers with 17 significant digits.
pub fn write_obj(out: &mut impl Write, copies: &Copies<'_>, control: &Control) -> io::Result<()> {
    writeln!(out, "# {} copies in the model {}", copies.elements.len(), copies.at.name())?;
    for [s, t] in copies.texcoords {
        writeln!(out, "vt {s:.16e} {t:.16e}")?;
    }
    let n = copies.points.len();
    let text = |k: usize| -> String {
        let mut text = format!("o {}\n", copies.name(k));
        for [x, y, z] in copies.points(k) {
            let _ = match z == 0.0 {
                true => writeln!(text, "v {x:.16e} {y:.16e} 0"),
                false => writeln!(text, "v {x:.16e} {y:.16e} {z:.16e}"),
            };
        }
        for corners in &copies.faces {
            let [a, b, c] = corners.map(|c| c as usize + 1);
            let [l, m, r] = [a, b, c].map(|v| v + k * n);
            let _ = writeln!(text, "f {l}/{a} {m}/{b} {r}/{c}");
        }
        text
    };
    copies.each(control, text, |text| out.write_all(text.as_bytes()))
}

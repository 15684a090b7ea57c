//! What commands say on stdout: a few lines for people. All numbers are in the report.

use crate::failure::{Failure, names_element};
use crate::input::Input;
use crate::output::is_stdout;
use crate::report::{Attempts, Checks, Done};
use crate::solved::Solved;
use ricci::flow::Options;
use std::io::{self, Write};
use std::path::Path;

/// Angle in degrees below which the thinnest face is named where a check fails: rounding moves the cotangent of such an angle by
/// 1e-13 and more.
const SLIVER: f64 = 0.1;

/// What commands name that write no file.
pub const NO_FILES: &[&str] = &[];

/// Print the lines of a summary, and where elements are named that their numbers begin at 0.
pub fn lines(text: &str, files: &[impl AsRef<Path>]) -> Result<(), Failure> {
    let note = if names_element(text) { "elements are numbered from 0\n" } else { "" };
    print(&format!("{text}{note}"), files)
}

/// Print on stdout; on stderr where one of the files that were written is stdout. A reader that has gone away is no error.
pub fn print(text: &str, files: &[impl AsRef<Path>]) -> Result<(), Failure> {
    let taken = files.iter().any(|file| is_stdout(file.as_ref()));
    let mut out: Box<dyn Write> = if taken { Box::new(io::stderr()) } else { Box::new(io::stdout()) };
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Failed(format!("stdout: {e}"))),
        _ => Ok(()),
    }
}

/// `1 vertex`, `2 vertices`.
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// A length or an area: with so many decimals, or, where those would be zeros or noise, with as many digits and a power of ten.
pub fn size(x: f64, decimals: usize) -> String {
    if x == 0.0 || (1e-3..1e9).contains(&x.abs()) {
        format!("{x:.decimals$}")
    } else {
        format!("{x:.decimals$e}")
    }
}

/// What max |K| was held against, where it is not what goes without saying.
pub fn tolerance(held: f64) -> String {
    if held == Options::default().tolerance { String::new() } else { format!(", tolerance {held:.1e}") }
}

/// The first line of a summary: the surface.
pub fn surface(input: &Input) -> String {
    let mesh = input.mesh();
    format!(
        "surface  {}: {}, {}, genus {}, {}\n",
        input.path.display(),
        count(mesh.n_vertices(), "vertex", "vertices"),
        count(mesh.n_faces(), "face", "faces"),
        mesh.genus(),
        match mesh.boundary_loops().len() {
            0 => "closed".into(),
            n => count(n, "boundary loop", "boundary loops"),
        }
    )
}

/// Where a check fails: whether the surface has slivers, which cost digits.
fn slivers(input: &Input, checks: &Checks, may_flip: bool) -> String {
    let thinnest = || input.surface.thinnest_face().map(|(face, angle)| (face, angle.to_degrees()));
    match (!checks.failed().is_empty()).then(thinnest).flatten() {
        Some((face, angle)) if angle < SLIVER => format!(
            "slivers  face {face} is the thinnest, with an angle of {angle:.1e} degrees: remesh there{}\n",
            if may_flip { "" } else { ", or allow flips" }
        ),
        _ => String::new(),
    }
}

/// The last lines of a summary: what is not there, whether the checks hold, the files, the time.
pub fn ending<T>(done: &Done<T>, solved: &Solved) -> String {
    let Solved { failed, left_out, added, .. } = solved;
    let mut text = slivers(&done.input, &done.checks, solved.may_flip);
    let [vertices, faces] = *added;
    if vertices + faces > 0 {
        text += &format!(
            "added    {} and {} to the input's, where its edges cross others: --xref X.csv says where, --on input has none\n",
            count(vertices, "vertex", "vertices"),
            count(faces, "face", "faces")
        );
    }
    for what in left_out {
        text += &format!("left out {what}\n");
    }
    text + &finish(done, failed)
}

/// The last lines of every summary: wishes that failed, whether the checks hold, the files, the time.
pub fn finish<T>(done: &Done<T>, failed: &Attempts) -> String {
    let Done { checks, files, seconds, .. } = done;
    let mut text = String::new();
    for (wishes, why) in failed.by_cause() {
        text += &format!("FAILED   --{}: {why}\n", wishes.join(", --"));
    }
    text += &checks.told(failed.0.is_empty());
    if !files.is_empty() {
        text += &format!("wrote    {}\n", files.join(", "));
    }
    text + &format!("{seconds:.2} s\n")
}

impl Checks {
    /// Whether all hold, or which do not; `whole`: everything that was asked for was made.
    pub fn told(&self, whole: bool) -> String {
        match self.failed().as_slice() {
            [] if whole => "checks   all hold\n".into(),
            [] => "checks   all hold of what was made\n".into(),
            failed => {
                let named = failed.iter().map(|name| {
                    let c = self.0[name];
                    format!("{name} = {:.3e}, limit {:.3e}", c.value, c.limit)
                });
                format!("checks   FAILED: {}\n", named.collect::<Vec<_>>().join("; "))
            }
        }
    }
}

/// τ of a flat torus, after what else is said of its layout.
pub fn modulus(tau: Option<[f64; 2]>) -> String {
    tau.map_or_else(String::new, |[re, im]| {
        format!(", modulus {re:.6} {} {:.6} i", if im < 0.0 { '-' } else { '+' }, im.abs())
    })
}

//! The summaries of commands on stdout: a few lines for people. All numbers are in the report.

use crate::failure::{Failure, names_element};
use crate::input::Input;
use crate::output::is_stdout;
use crate::report::{Checks, Done};
use ricci::flow::Options;
use std::io::{self, Write};
use std::path::Path;

/// The angle in degrees below which the thinnest face is named where a check fails: rounding moves the cotangent of such an angle by
/// 1e-13 and more.
const SLIVER: f64 = 0.1;

/// The files of a command that writes none.
pub const NO_FILES: &[&str] = &[];

/// Print the lines of a summary and, where they name elements by number, a note that numbers begin at 0.
pub fn lines(text: &str, files: &[impl AsRef<Path>]) -> Result<(), Failure> {
    let note = if names_element(text) { "elements are numbered from 0\n" } else { "" };
    print(&format!("{text}{note}"), files)
}

/// Print on stdout, or on stderr where one of the written files is stdout. A reader that has closed the pipe is no error.
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

/// A length or an area with this many decimals; in scientific notation where those would be zeros or noise.
pub fn size(x: f64, decimals: usize) -> String {
    if x == 0.0 || (1e-3..1e9).contains(&x.abs()) {
        format!("{x:.decimals$}")
    } else {
        format!("{x:.decimals$e}")
    }
}

/// The limit of max |K|, where it is not the default.
pub fn tolerance(limit: f64) -> String {
    if limit == Options::default().tolerance { String::new() } else { format!(", tolerance {limit:.1e}") }
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

/// The thinnest face, if a check fails and it is a sliver, which costs digits.
fn slivers(input: &Input, checks: &Checks, may_flip: bool) -> String {
    let thinnest = || input.surface.thinnest_face().map(|(face, angle)| (face, angle.to_degrees()));
    match (!checks.failed().is_empty()).then(thinnest).flatten() {
        Some((face, angle)) if angle < SLIVER => format!(
            "slivers  face {face} is the thinnest, with an angle of {angle:.1e} degrees: remesh there, or refine the metric (ricci refine --intrinsic){}\n",
            if may_flip { "" } else { ", or allow flips" }
        ),
        _ => String::new(),
    }
}

/// The last lines of the summary of a metric: slivers, vertices added to the input's, then as [`finish`].
/// `may_flip`: whether edges were allowed to be flipped.
pub fn ending(input: &Input, done: &Done, may_flip: bool) -> String {
    let mut text = slivers(input, &done.checks, may_flip);
    let [vertices, faces] = done.added;
    if vertices + faces > 0 {
        text += &format!(
            "added    {} and {} to the input's, where its edges cross others: --xref X.csv says where, --on input has none\n",
            count(vertices, "vertex", "vertices"),
            count(faces, "face", "faces")
        );
    }
    text + &finish(done)
}

/// The last lines of a summary: options that failed, what the written mesh has no room for, the checks, the files, the time.
pub fn finish(done: &Done) -> String {
    let Done { checks, failed, files, seconds, .. } = done;
    let mut text = String::new();
    for (options, why) in failed.by_cause() {
        text += &format!("FAILED   --{}: {why}\n", options.join(", --"));
    }
    for what in &done.left_out {
        text += &format!("left out {what}\n");
    }
    text += &checks.told(failed.0.is_empty());
    if !files.is_empty() {
        text += &format!("wrote    {}\n", files.join(", "));
    }
    text + &format!("{seconds:.2} s\n")
}

impl Checks {
    /// The line that says that all checks hold, or which ones fail. `whole`: everything that was asked for was made.
    pub fn told(&self, whole: bool) -> String {
        match self.failed().as_slice() {
            [] if whole => "checks   all hold\n".into(),
            [] => "checks   all hold of what was made\n".into(),
            failed => {
                let named = failed.iter().map(|name| {
                    let c = &self.0[name];
                    let place = c.place.as_ref().map_or(String::new(), |place| format!(" ({place})"));
                    let remedy = c.remedy.as_ref().map_or(String::new(), |remedy| format!(": {remedy}"));
                    format!("{name} = {:.3e}, limit {:.3e}{place}{remedy}", c.value, c.limit)
                });
                format!("checks   FAILED: {}\n", named.collect::<Vec<_>>().join("; "))
            }
        }
    }
}

/// The modulus τ of a flat torus, to follow other figures of its layout.
pub fn modulus(tau: Option<[f64; 2]>) -> String {
    tau.map_or_else(String::new, |[re, im]| {
        format!(", modulus {re:.6} {} {:.6} i", if im < 0.0 { '-' } else { '+' }, im.abs())
    })
}

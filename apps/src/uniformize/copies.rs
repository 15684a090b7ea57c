//! The copies of a cover, one after the other, and as OBJ. Only as many copies are held at a time as there are threads.

use super::group_file::name;
use super::model_place::ModelPlace;
use super::quotient::Uniformized;
use crate::failure::Failure;
use crate::options::Common;
use crate::uv::corners;
use ricci::Control;
use ricci::embed::DeckElement;
use ricci::embed::cover::moved;
use ricci::parallel::{Pool, map};
use std::fmt::Write as _;
use std::io::{self, Write};

/// The copies of an opened surface.
pub struct CoverCopies<'a> {
    pub uniformized: &'a Uniformized,
    pub elements: &'a [DeckElement],
    /// The ambient coordinates of the points of the opened surface.
    pub points: &'a [[f64; 3]],
    /// The plane coordinates of the same points.
    pub texcoords: &'a [[f64; 2]],
    pub faces: Vec<[u32; 3]>,
    at: ModelPlace,
    threads: usize,
    pub quiet: bool,
    pub control: &'a Control,
}

impl<'a> CoverCopies<'a> {
    pub fn new(
        u: &'a Uniformized,
        at: ModelPlace,
        common: &Common,
        control: &'a Control,
    ) -> Result<CoverCopies<'a>, Failure> {
        let laid = u.laid()?;
        let (points, texcoords) = (&laid.layout.points[..], laid.coordinates());
        let faces = corners(laid.mesh(), laid.corner_index());
        let (elements, threads, quiet) = (u.copies()?, common.threads, common.quiet);
        Ok(CoverCopies { uniformized: u, elements, points, texcoords, faces, at, threads, quiet, control })
    }

    /// The approximate size in bytes of a file of all copies.
    pub fn bytes(&self, binary: bool) -> usize {
        let (points, faces, n) = (self.points.len(), self.faces.len(), self.elements.len());
        if !binary {
            // A vertex has two numbers of 23 characters; a face has three numbers of a vertex and three of a point.
            n * (50 * points + 40 * faces)
        } else if self.at == ModelPlace::Plane {
            20 * points + 12 * faces
        } else {
            (12 * n + 8) * points + 12 * faces
        }
    }

    /// The name of a copy.
    pub fn name(&self, k: usize) -> String {
        name(&self.uniformized.deck.group, &self.elements[k].word)
    }

    /// The points of a copy in the coordinates of the model.
    pub fn points(&self, k: usize) -> Vec<[f64; 3]> {
        let motion = &self.elements[k].motion;
        moved(self.points, motion).into_iter().map(|p| self.at.coordinates(p)).collect()
    }

    /// Work on the first `n` copies in parallel and hand over what comes of each, in order.
    pub fn each<T: Send>(
        &self,
        n: usize,
        work: impl Fn(usize) -> T + Sync,
        mut take: impl FnMut(T) -> io::Result<()>,
    ) -> io::Result<()> {
        let pool = Pool::new(self.threads).map_err(io::Error::other)?;
        for first in (0..n).step_by(pool.threads()) {
            self.control.check().map_err(io::Error::other)?;
            let batch = pool.threads().min(n - first);
            let made = pool.run(|| map(batch, |k| work(first + k)));
            made.into_iter().try_for_each(&mut take)?;
        }
        Ok(())
    }

    /// OBJ: an object each, named by its word; texture coordinates once, for all; numbers with 17 significant digits.
    pub fn write_obj(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "# {} copies in the model {}", self.elements.len(), self.at.name())?;
        for [s, t] in self.texcoords {
            writeln!(out, "vt {s:.16e} {t:.16e}")?;
        }
        let n = self.points.len();
        let text = |k: usize| -> String {
            let mut text = format!("o {}\n", self.name(k));
            for [x, y, z] in self.points(k) {
                let _ = if z == 0.0 {
                    writeln!(text, "v {x:.16e} {y:.16e} 0")
                } else {
                    writeln!(text, "v {x:.16e} {y:.16e} {z:.16e}")
                };
            }
            for corners in &self.faces {
                let [a, b, c] = corners.map(|c| c as usize + 1);
                let [l, m, r] = [a, b, c].map(|v| v + k * n);
                let _ = writeln!(text, "f {l}/{a} {m}/{b} {r}/{c}");
            }
            text
        };
        self.each(self.elements.len(), text, |text| out.write_all(text.as_bytes()))
    }
}

//! Closed geodesics as lines on the surface as it was given.

use super::args::LengthsArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::picture::{self, LineMeaning, Picture, ShownSurface, TextureChoice};
use ricci::Control;
use ricci::canonical::Quotient;
use ricci::mesh::{Place, Point};
use ricci::moduli::{GeodesicClass, LengthSpectrum, geodesics_on_surface};
use std::io::{self, Write};

/// Largest difference of lengths that count as one.
pub const SAME_LENGTH: f64 = 1e-9;

/// Lines in space: of the primitive geodesics of a spectrum from the shortest on, none for the others.
pub struct GeodesicLines {
    /// Per class of the spectrum, as far as they were drawn, the points of its closed line.
    pub lines: Vec<Vec<Point>>,
}

impl GeodesicLines {
    /// The shortest geodesics of a spectrum, or all.
    pub fn new(
        input: &Input,
        quotient: &Quotient,
        spectrum: &LengthSpectrum,
        all: bool,
        control: &Control,
    ) -> ricci::Result<GeodesicLines> {
        let first = spectrum.classes.first().map_or(0.0, |class| class.length);
        let is_wanted = |class: &&GeodesicClass| all || class.length <= first + SAME_LENGTH;
        let classes: Vec<&GeodesicClass> = spectrum.classes.iter().take_while(is_wanted).collect();
        let primitive = classes.iter().filter(|class| class.power == 1).map(|class| &class.element.motion);
        let mut drawn = geodesics_on_surface(quotient, primitive, control)?.into_iter();
        let (mesh, positions) = (input.mesh(), input.positions().unwrap_or_default());
        let point = |place: Place| {
            let corners = mesh.face_vertices(place.face).map(|v| positions[v.index()]);
            [0, 1, 2].map(|k| (0..3).map(|c| place.weights[c] * corners[c][k]).sum())
        };
        let mut line = |class: &&GeodesicClass| match class.power {
            1 => drawn.next().unwrap_or_default().into_iter().map(point).collect(),
            _ => Vec::new(),
        };
        Ok(GeodesicLines { lines: classes.iter().map(&mut line).collect() })
    }

    /// Write at most this many of the lines, each a group with the name of its geodesic.
    pub fn write(&self, out: &mut impl Write, names: &[String], most: usize) -> io::Result<()> {
        let mut next = 1;
        let named = self.lines.iter().zip(names).take(most);
        for (line, name) in named.filter(|(line, _)| !line.is_empty()) {
            writeln!(out, "g {name}")?;
            for [x, y, z] in line {
                writeln!(out, "v {x:?} {y:?} {z:?}")?;
            }
            write!(out, "l")?;
            (0..line.len()).try_for_each(|k| write!(out, " {}", next + k))?;
            writeln!(out, " {next}")?;
            next += line.len();
        }
        Ok(())
    }
}

/// The picture of the surface with the lines of its shortest geodesics.
pub fn draw(
    input: &Input,
    curves: &GeodesicLines,
    args: &LengthsArgs,
    most: usize,
) -> Result<Vec<u8>, Failure> {
    let mut positions = input.positions_on(None)?;
    let mesh = input.mesh();
    let mut strokes = Vec::new();
    for (k, line) in curves.lines.iter().take(most).enumerate() {
        let (first, n) = (positions.len() as u32, line.len() as u32);
        strokes.extend((0..n).map(|i| (first + i, first + (i + 1) % n, k)));
        positions.extend(line);
    }
    let faces = mesh.triangles();
    let surface = ShownSurface {
        positions: &positions,
        faces: &faces,
        corner_uv: None,
        seams: &strokes,
        cones: &[],
        is_closed: mesh.is_closed(),
    };
    let style = args.picture.style(TextureChoice::None, args.common.threads);
    let drawn = Picture { surface: Some(surface), lines: LineMeaning::Geodesics, ..Picture::default() };
    picture::png(&drawn, &style)
}

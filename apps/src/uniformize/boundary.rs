//! Command-line options for the boundary of a surface, and their conversion to the library's options.

use crate::failure::Failure;
use crate::input::Input;
use clap::{Args, ValueEnum};
use ricci::canonical::{Boundary, BoundaryCorner, Corners};
use ricci::mesh::VertexId;
use ricci::mesh::check::{Hint, hints};
use ricci::topology::{SurfaceGroup, Word};
use serde::Serialize;
use std::str::FromStr;

/// The shape of the boundary, and the words in the generators whose closed geodesics are measured.
#[derive(Args, Serialize, Debug, Clone)]
pub struct BoundaryArgs {
    /// What the boundary becomes: closed geodesics in the hyperbolic plane (χ < 0) or the plane (an annulus), or straight sides with
    /// corners in the plane [default: geodesic; straight with --corners]
    #[arg(long, value_enum)]
    #[serde(skip)]
    pub boundary: Option<BoundaryChoice>,
    /// Corners of a straight boundary, vertices V,V,… (numbered from 0), the angle inside in degrees as V:ANGLE; or how many, placed where
    /// the boundary turns [default: 4 on a disk, none on an annulus]
    #[arg(long, value_name = "CORNERS", long_help = CORNERS_HELP)]
    #[serde(skip)]
    pub corners: Option<CornersChoice>,
    /// Report the lengths of the closed geodesics of these words in the generators: a1.b1^-1,…
    #[arg(long, value_name = "WORD,…", value_delimiter = ',')]
    pub lengths: Vec<String>,
}

const CORNERS_HELP: &str = "\
Corners of a straight boundary (--boundary straight):
  V,V,…         these vertices, numbered from 0, with equal angles: right angles for four on a disk. The first side runs from the first corner,
                along the x axis
  V:ANGLE,V,…   with these angles inside, in degrees; those without one share what is left. N corners have 180° N − 360° χ together, χ = 1 for a
                disk
  N             this number of corners, with equal angles: the vertices where the boundary turns by more than 45° if there are just N, else
                at equal distances along the longest boundary loop
[default: 4 on a disk, none on an annulus, 4 |χ| of 270° on other surfaces]";

#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum BoundaryChoice {
    Geodesic,
    Straight,
}

/// The corners of `--corners`; angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub enum CornersChoice {
    Count(usize),
    At(Vec<(u32, Option<f64>)>),
}

impl FromStr for CornersChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Ok(n) = text.parse() {
            return Ok(CornersChoice::Count(n));
        }
        let corner = |part: &str| {
            let (vertex, angle) = part.split_once(':').map_or((part, None), |(v, angle)| (v, Some(angle)));
            let vertex = vertex.trim().parse().map_err(|_| format!("`{vertex}` is not a vertex number"))?;
            let degrees = |angle: &str| angle.trim().parse().ok().filter(|a: &f64| a.is_finite() && *a > 0.0);
            let angle = match angle {
                Some(angle) => {
                    Some(degrees(angle).ok_or_else(|| format!("`{angle}` is no angle in degrees"))?)
                }
                None => None,
            };
            Ok((vertex, angle))
        };
        text.split(',').map(corner).collect::<Result<_, String>>().map(CornersChoice::At)
    }
}

impl CornersChoice {
    /// Converts to the library's type.
    pub fn to_library(&self) -> Corners {
        let corner = |&(v, angle): &(u32, Option<f64>)| BoundaryCorner {
            vertex: VertexId(v),
            angle: angle.map(f64::to_radians),
        };
        match self {
            CornersChoice::Count(n) => Corners::Count(*n),
            CornersChoice::At(all) => Corners::At(all.iter().map(corner).collect()),
        }
    }
}

impl BoundaryArgs {
    /// The shape of the boundary, with the default put in.
    pub fn choice(&self) -> BoundaryChoice {
        let usual = if self.corners.is_some() { BoundaryChoice::Straight } else { BoundaryChoice::Geodesic };
        self.boundary.unwrap_or(usual)
    }

    /// Converts to the library's type.
    pub fn to_library(&self) -> Boundary {
        match (self.choice(), &self.corners) {
            (BoundaryChoice::Geodesic, _) => Boundary::Geodesic,
            (_, None) => Boundary::Straight(Corners::Default),
            (_, Some(corners)) => Boundary::Straight(corners.to_library()),
        }
    }

    /// True if the boundary of this surface gets corners.
    pub fn has_corners(&self, input: &Input) -> bool {
        let none = match &self.corners {
            None => input.mesh().euler() == 0,
            Some(CornersChoice::Count(n)) => *n == 0,
            Some(CornersChoice::At(all)) => all.is_empty(),
        };
        self.choice() == BoundaryChoice::Straight && !none
    }

    /// The words of `--lengths`.
    pub fn words(&self, group: &SurfaceGroup) -> Result<Vec<Word>, Failure> {
        let word = |text: &String| {
            let usage = |error: ricci::Error| Failure::Usage(format!("--lengths {text}: {error}"));
            group.parse(&text.replace('.', " ")).map_err(usage)
        };
        self.lengths.iter().map(word).collect()
    }

    /// Refuses options that do not fit this surface: boundary options on a closed surface, a geodesic boundary on a disk, words that are not
    /// in its group.
    pub fn check(&self, input: &Input) -> Result<(), Failure> {
        let mesh = input.mesh();
        let usage = |message: &str| Err(Failure::Usage(message.into()));
        if mesh.is_closed() && (self.boundary.is_some() || self.corners.is_some()) {
            return usage("--boundary, --corners: a closed surface has no boundary");
        }
        if self.choice() == BoundaryChoice::Geodesic && self.corners.is_some() {
            return usage("--corners: a geodesic boundary has none; use --boundary straight");
        }
        if self.choice() == BoundaryChoice::Geodesic && !mesh.is_closed() && mesh.euler() > 0 {
            let path = input.path.display();
            let why = "a disk has no closed geodesic as boundary; use --boundary straight for a rectangle or --corners for a polygon, \
                       ricci circles for the unit disk";
            return Err(Failure::Input(format!("{path}: {why}{}", open_seams(input))));
        }
        if self.has_corners(input) && !self.lengths.is_empty() {
            return usage(
                "--lengths: measures closed geodesics of a geodesic boundary; with corners the metric is flat and going around a loop turns it, so it has none",
            );
        }
        let group = SurfaceGroup { genus: mesh.genus(), boundaries: mesh.boundary_loops().len() };
        self.words(&group).map(drop)
    }
}

/// Hints about seams that rounding has left open. Such a mesh counts as a disk only because a seam that was meant to be closed is open.
fn open_seams(input: &Input) -> String {
    let Some(positions) = input.surface.positions() else { return String::new() };
    let faces: Vec<[u32; 3]> =
        input.mesh().faces().map(|f| input.mesh().face_vertices(f).map(|v| v.0)).collect();
    let is_seam = |hint: &Hint| matches!(hint, Hint::OpenSeam(_) | Hint::TJunctions(_));
    let seams = hints(positions, &faces).into_iter().filter(is_seam);
    seams
        .map(|hint| format!("; unless its boundary was meant to be closed: {hint}: {}", hint.remedy()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_vertices_with_angles_or_a_number() {
        assert_eq!("4".parse(), Ok(CornersChoice::Count(4)));
        assert_eq!("0,5:270, 7".parse(), Ok(CornersChoice::At(vec![(0, None), (5, Some(270.0)), (7, None)])));
        for text in ["", "a", "1,", "1:0,2", "1:-90,2", "1:x,2", "1:inf,2", "-1,2"] {
            assert!(text.parse::<CornersChoice>().is_err(), "{text}");
        }
    }
}

//! The kinds of geometric structures, and the coordinates of their charts.

use crate::archive::stored;
use crate::error::Error;
use crate::geometry::Space;
use crate::geometry::model::{from_klein, from_poincare, klein, poincare};

/// A geometric structure of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Structure {
    /// Charts in the complex plane, with Möbius transformations as transitions: those of the surface's metric of constant curvature, in the
    /// stereographic plane, the Euclidean plane or the Poincaré disk. A disk has a flat metric.
    Conformal,
    /// Stereographic charts of the unit sphere, with rotations in SU(2) as transitions; for genus 0.
    Spherical,
    /// Charts in the Euclidean plane, with its motions as transitions. Closed surfaces of genus other than 1 have singular vertices.
    Affine,
    /// Charts in the Poincaré disk, with transitions in SU(1,1); for χ < 0.
    Hyperbolic,
    /// Charts in the Klein disk, where geodesics are straight, with transitions in SO⁺(2,1) ⊂ PGL(3,R); for χ < 0.
    Projective,
    /// Charts in the Euclidean plane in which the quads of a mesh are unit squares with whole coordinates; transitions are rotations by
    /// multiples of 90° with integer translations. Vertices without four quads are singular.
    Integer,
}
stored!(variants Structure {
        Conformal = 0,
        Spherical = 1,
        Affine = 2,
        Hyperbolic = 3,
        Projective = 4,
        Integer = 5,
    }
);

impl Structure {
    /// All structures.
    pub const ALL: [Structure; 6] = [
        Structure::Conformal,
        Structure::Spherical,
        Structure::Affine,
        Structure::Hyperbolic,
        Structure::Projective,
        Structure::Integer,
    ];

    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Structure::Conformal => "conformal",
            Structure::Spherical => "spherical",
            Structure::Affine => "affine",
            Structure::Hyperbolic => "hyperbolic",
            Structure::Projective => "projective",
            Structure::Integer => "integer",
        }
    }

    /// True if coordinates are complex numbers, on which Möbius transformations act.
    pub fn is_complex(self) -> bool {
        matches!(self, Structure::Conformal | Structure::Spherical | Structure::Hyperbolic)
    }

    /// A number of a vertex's coordinates or of a transition: whole in an integer structure, where rounding alone keeps it from that.
    pub(super) fn exact(self, x: f64) -> f64 {
        // Adding 0 makes −0 positive.
        if self == Structure::Integer { x.round() + 0.0 } else { x }
    }

    /// The coordinates in a chart of a point in ambient coordinates.
    pub(super) fn coordinates(self, space: Space, p: [f64; 3]) -> [f64; 2] {
        match (self, space) {
            (_, Space::E2) => [p[0], p[1]],
            (Structure::Projective, _) => klein(p),
            // The same formula gives the stereographic plane of the sphere.
            _ => poincare(p),
        }
    }

    /// The point, in ambient coordinates, with given coordinates in a chart.
    pub(super) fn ambient(self, space: Space, [x, y]: [f64; 2]) -> [f64; 3] {
        match (self, space) {
            (_, Space::E2) => [x, y, 1.0],
            (Structure::Projective, _) => from_klein([x, y]),
            (_, Space::H2) => from_poincare([x, y]),
            (_, Space::S2) => {
                let r = x.hypot(y);
                let sum = 1.0 + r * r;
                [2.0 * x / sum, 2.0 * y / sum, (1.0 - r) * (1.0 + r) / sum]
            }
        }
    }
}

/// Coordinates in which geodesics are straight: those of the plane, the Klein disk, or the central projection of a hemisphere; none beyond
/// it.
pub(super) fn straight(space: Space, [x, y, w]: [f64; 3]) -> Option<[f64; 2]> {
    match space {
        Space::E2 => Some([x, y]),
        _ => (w > 0.0).then(|| [x / w, y / w]),
    }
}

impl std::fmt::Display for Structure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Structure {
    type Err = Error;

    fn from_str(name: &str) -> Result<Structure, Error> {
        let found = Structure::ALL.into_iter().find(|kind| kind.name().eq_ignore_ascii_case(name));
        found.ok_or_else(|| {
            Error::argument(
                "structure",
                name,
                "conformal, spherical, affine, hyperbolic, projective or integer",
            )
        })
    }
}

//! The options of `ricci make`: the sample surfaces, and how they can be spoiled.

use crate::options::{Common, FileName, choices, number};
use crate::picture::SurfacePictureArgs;
use clap::{Args, Subcommand};
use num_complex::Complex64;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, Sliver};
use serde::{Serialize, Serializer};
use std::path::Path;

#[derive(Subcommand, Serialize, Debug)]
#[serde(rename_all = "kebab-case")]
pub enum SampleShape {
    /// The unit sphere: an icosahedron with each edge cut into N
    #[command(alias = "icosphere")]
    Sphere {
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        #[command(flatten)]
        to: ToMesh,
    },
    /// An ellipsoid: the sphere scaled along x, y, z
    Ellipsoid {
        /// Half axes
        #[arg(long, num_args = 3, value_names = ["A", "B", "C"], default_values_t = [3.0, 2.0, 1.0])]
        axes: Vec<f64>,
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A torus of revolution
    Torus {
        /// Radius of the centre circle
        #[arg(long, default_value_t = 2.0)]
        big: f64,
        /// Radius of the tube
        #[arg(long, default_value_t = 1.0)]
        small: f64,
        /// Vertices along the centre circle
        #[arg(short, long, default_value_t = 64)]
        n: usize,
        /// Vertices around the tube [default: in proportion to the radii]
        #[arg(short, long)]
        m: Option<usize>,
        #[command(flatten)]
        to: ToMesh,
    },
    /// The unit disk, flat or with a hill and a hollow
    Disk {
        /// Rings
        #[arg(short, long, default_value_t = 24)]
        n: usize,
        /// Height of the hill
        #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
        height: f64,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A plane ring, flat or with a hill and a hollow
    Annulus {
        /// Inner radius
        #[arg(long, default_value_t = 0.3)]
        inner: f64,
        /// Outer radius
        #[arg(long, default_value_t = 1.0)]
        outer: f64,
        /// Steps from the inner to the outer radius
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        /// Vertices around [default: so that triangles are nearly equilateral]
        #[arg(short, long)]
        m: Option<usize>,
        /// Height of the hill
        #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
        height: f64,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A smooth closed surface of genus G ≥ 1: handles in a row
    Genus {
        /// Number of handles
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        /// Layers over a quarter of the tube; 8 (5 G + 1) N² + 2 − 2 G vertices
        #[arg(short, long, default_value_t = 6)]
        n: usize,
        /// How many times as wide the first hole is as the last: at most 6.8 for two handles, 17 for three
        #[arg(long, default_value_t = 1.0)]
        ratio: f64,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A knotted torus: a tube around a torus knot, by default the trefoil
    Knot {
        /// Times that the knot goes around the axis
        #[arg(short, long, default_value_t = 2)]
        p: u32,
        /// Times that it goes around the tube of the torus it lies on
        #[arg(short, long, default_value_t = 3)]
        q: u32,
        /// Radius of that torus's centre circle
        #[arg(long, default_value_t = 2.0)]
        big: f64,
        /// Radius of that torus's tube
        #[arg(long, default_value_t = 0.9)]
        small: f64,
        /// Radius of the tube around the knot
        #[arg(long, default_value_t = 0.4)]
        tube: f64,
        /// Cross-sections; at least about 40 for a trefoil
        #[arg(short, long, default_value_t = 240)]
        n: usize,
        /// Vertices around the tube [default: as far apart as the cross-sections]
        #[arg(short, long)]
        m: Option<usize>,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A hyperbolic pair of pants with geodesic boundaries of given lengths, as edge lengths
    Pants {
        /// Lengths of the three boundaries
        #[arg(long, num_args = 3, value_names = ["L1", "L2", "L3"], default_values_t = [1.0, 2.0, 3.0])]
        lengths: Vec<f64>,
        /// Times that every triangle is cut into four
        #[arg(short, long, default_value_t = 4)]
        level: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// A hyperbolic surface with given Fenchel–Nielsen coordinates: glued pairs of pants, as edge lengths
    ///
    /// The curves are a_1, …, a_g, the commutators of a_i and b_i (in genus 2 the first alone; in genus 1 with one boundary loop none), and the products
    /// of the first i of commutators and boundary loops, as `ricci lengths --pants` lists them.
    FenchelNielsen {
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        /// Lengths of the 3g − 3 + b curves, from 0.001 to 30
        #[arg(long, value_name = "L,L,…", value_delimiter = ',', default_values_t = [2.0, 2.0, 2.0])]
        lengths: Vec<f64>,
        /// Twists of these curves, to the left [default: 0]
        #[arg(long, value_name = "T,T,…", value_delimiter = ',', allow_negative_numbers = true)]
        twists: Vec<f64>,
        /// Lengths of boundary loops [default: none]
        #[arg(long, value_name = "L,L,…", value_delimiter = ',')]
        boundaries: Vec<f64>,
        /// Times that every triangle is cut into four
        #[arg(long, default_value_t = 2)]
        level: usize,
        /// Write the loops a1, b1, … that the coordinates belong to, for `ricci lengths --loops`
        #[arg(long, value_name = "L.csv")]
        loops: Option<FileName>,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The curve y² = Π (x − e): the round sphere's double cover branched over given points, as edge lengths
    ///
    /// The report has the period matrix. Default: y² = x⁶ − 1, genus 2.
    Hyperelliptic {
        /// A branch point of the x-plane; an odd number of points has ∞ as one more
        #[arg(long, value_name = "RE,IM", allow_hyphen_values = true, value_parser = complex,
              default_values = ["1,0", "0.5,0.8660254037844386", "-0.5,0.8660254037844386", "-1,0",
                                "-0.5,-0.8660254037844386", "0.5,-0.8660254037844386"])]
        #[serde(serialize_with = "pairs")]
        at: Vec<Complex64>,
        /// Frequency of the sphere below; 40 N² faces
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        /// Draw vertices in towards the branch points: at distance r, edges are about r^(1 − 1/P) as long as elsewhere; from 1 (even) to 4
        #[arg(long, value_name = "P", default_value_t = 1.0)]
        grading: f64,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The flat torus with periods 1 and τ, as edge lengths
    FlatTorus {
        /// τ, Im τ > 0
        #[arg(long, num_args = 2, value_names = ["RE", "IM"], default_values_t = [0.0, 1.0], allow_negative_numbers = true)]
        tau: Vec<f64>,
        /// Parallelograms along 1
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        /// Parallelograms along τ
        #[arg(short, long, default_value_t = 16)]
        m: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The Bolza surface: a regular hyperbolic octagon with opposite sides glued, as edge lengths
    Bolza {
        /// Times that every triangle is cut into four
        #[arg(short, long, default_value_t = 3)]
        level: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// A regular polygon with sides a1 b1 a1⁻¹ b1⁻¹ … glued, cut by diagonals: one vertex, as edge lengths
    OneVertex {
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The same polygon, cut from its centre: two vertices, as edge lengths
    TwoVertex {
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// Two equilateral triangles glued along their sides, as edge lengths
    TwoTriangles {
        #[command(flatten)]
        to: ToMetric,
    },
}

/// The output of a sample surface, and what is done to the surface before.
pub enum Destination<'a> {
    Mesh(&'a ToMesh),
    Metric(&'a ToMetric),
}

impl<'a> Destination<'a> {
    pub fn common(&self) -> &'a Common {
        match self {
            Destination::Mesh(to) => &to.common,
            Destination::Metric(to) => &to.common,
        }
    }

    /// The name of the file of `-o`.
    pub fn out(&self) -> &'a Path {
        match self {
            Destination::Mesh(to) => &to.out,
            Destination::Metric(to) => &to.out,
        }
    }
}

impl SampleShape {
    pub fn destination(&self) -> Destination<'_> {
        match self {
            SampleShape::Sphere { to, .. }
            | SampleShape::Ellipsoid { to, .. }
            | SampleShape::Torus { to, .. }
            | SampleShape::Disk { to, .. }
            | SampleShape::Annulus { to, .. }
            | SampleShape::Genus { to, .. }
            | SampleShape::Knot { to, .. } => Destination::Mesh(to),
            SampleShape::FlatTorus { to, .. }
            | SampleShape::Pants { to, .. }
            | SampleShape::FenchelNielsen { to, .. }
            | SampleShape::Hyperelliptic { to, .. }
            | SampleShape::Bolza { to, .. }
            | SampleShape::OneVertex { to, .. }
            | SampleShape::TwoVertex { to, .. }
            | SampleShape::TwoTriangles { to } => Destination::Metric(to),
        }
    }
}

impl SampleShape {
    /// The name of the file of `--loops`.
    pub fn loops(&self) -> Option<&Path> {
        match self {
            SampleShape::FenchelNielsen { loops, .. } => loops.as_deref(),
            _ => None,
        }
    }
}

/// The output of a surface in space.
#[derive(Args, Serialize, Debug)]
pub struct ToMesh {
    /// Mesh (.obj, .off, .ply, .glb, .vtk, .vtp, .mz3, .gii, FreeSurfer's; also .gz), or its edge lengths (.json)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: FileName,
    #[command(flatten)]
    #[serde(flatten)]
    pub spoil: SpoilArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(skip)]
    pub common: Common,
}

/// The output of a surface that is given by its edge lengths.
#[derive(Args, Serialize, Debug)]
pub struct ToMetric {
    /// Edge lengths (.json)
    #[arg(short = 'o', long = "out", value_name = "M.json")]
    pub out: FileName,
    #[command(flatten)]
    #[serde(skip)]
    pub common: Common,
}

/// Holes, noise, an inversion and bad triangles, in this order.
#[derive(Args, Serialize, Debug)]
pub struct SpoilArgs {
    /// Cut this many round holes, far from each other
    #[arg(long, default_value_t = 0, value_name = "COUNT")]
    pub holes: usize,
    /// Map by the inversion in the sphere about X, Y, Z of this radius: a conformal map
    #[arg(long, value_name = "X,Y,Z,RADIUS", value_parser = sphere, allow_hyphen_values = true)]
    pub invert: Option<[f64; 4]>,
    /// Halve the edges around a vertex (numbered from 0), again and again
    #[arg(long, value_name = "VERTEX,LEVELS", value_parser = grading)]
    pub grade: Option<(u32, usize)>,
    /// Cut this many faces into slivers
    #[arg(long, default_value_t = 0, value_name = "COUNT")]
    pub slivers: usize,
    /// Smallest angle of the slivers, radians
    #[arg(long, default_value_t = 1e-3, value_name = "ANGLE")]
    pub sliver_angle: f64,
    /// Flat ones, or short edges
    #[arg(long, value_enum, default_value_t = SliverChoice::Cap)]
    pub sliver_kind: SliverChoice,
    /// Move every vertex by up to this fraction of the mean edge length in each coordinate
    #[arg(long, default_value_t = 0.0, value_name = "A")]
    pub noise: f64,
    /// Seed of slivers and noise
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
}

impl SpoilArgs {
    /// The surface with the holes, the noise, the inversion and the bad triangles that were asked for.
    pub fn apply(&self, mut soup: Soup) -> ricci::Result<Soup> {
        if self.holes > 0 {
            soup = shapes::punch(&soup, self.holes)?;
        }
        if self.noise != 0.0 {
            shapes::noise(&mut soup, self.noise, self.seed)?;
        }
        if let Some([x, y, z, radius]) = self.invert {
            shapes::invert(&mut soup, [x, y, z], radius)?;
        }
        if let Some((vertex, levels)) = self.grade {
            shapes::grade(&mut soup, vertex, levels)?;
        }
        if self.slivers > 0 {
            shapes::slivers(&mut soup, self.sliver_kind.into(), self.slivers, self.sliver_angle, self.seed)?;
        }
        Ok(soup)
    }
}

choices!(
    SliverChoice = Sliver {
        /// A vertex near the middle of a side
        Cap,
        /// A vertex near a corner
        Needle,
    }
);

fn complex(text: &str) -> Result<Complex64, String> {
    let (re, im) = text.split_once(',').ok_or("must be RE,IM")?;
    let part = |x: &str| finite(x.trim());
    Ok(Complex64::new(part(re)?, part(im)?))
}

fn pairs<S: Serializer>(points: &[Complex64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().map(|z| [z.re, z.im]))
}

fn sphere(text: &str) -> Result<[f64; 4], String> {
    let numbers: Vec<f64> = text.split(',').map(|x| finite(x.trim())).collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|_| "must be X,Y,Z,RADIUS".into())
}

fn grading(text: &str) -> Result<(u32, usize), String> {
    let parts =
        text.split_once(',').and_then(|(v, l)| Some((v.trim().parse().ok()?, l.trim().parse().ok()?)));
    parts.ok_or_else(|| "must be VERTEX,LEVELS".into())
}

fn finite(text: &str) -> Result<f64, String> {
    number(text, |_| true, "must be a number")
}

//! The options of `ricci match`.

use crate::options::{Common, FileName, MeshArgs};
use crate::picture::PictureArgs;
use clap::{Args, ValueEnum};
use ricci::matching::{BoundaryMatching, LoopShape};
use serde::Serialize;
use std::path::{Path, PathBuf};

pub const HELP: &str = "\
Example: a torus onto a thicker one, and the first in the shape of the second
    ricci make torus --small 0.4 -o thin.obj
    ricci make torus --small 0.7 -o thick.obj
    ricci match thin.obj thick.obj --map M.csv -o shaped.obj --picture both.png --report R.json

The two surfaces have the same genus and the same number of boundary loops. The target gets its metric of constant curvature, with cones at the
landmarks and straight boundaries, and the source goes into it by a harmonic map with positive weights, which folds no face. Of the homotopy classes that
landmarks and loops leave open one of low energy is taken, or that which --basis names. Boundaries slide along each other between landmarks on them, or go to each other by
shares of their length; with --loop-shape circles they become round holes of a closed surface. Spheres without landmarks are
turned until their conformal factors fit best.

Where nothing says what corresponds, landmarks are found by the shapes of the surfaces: extremities and eigenfunctions of the Laplacian propose
maps, of which the one that keeps distances best is refined. The map with them is compared with the one without any, and the better one is taken.
The verdict on a map is good, rough or unlikely. Good: mean |ln area| at most 0.5, mean dilatation at most 1.5, there and back at most 0.005,
agreement at least 0.8. Unlikely, which is exit 1 unless landmarks are given: one of them beyond 2, 6, 0.1 or, on surfaces
without handles, 0.4. With --distance no landmarks are looked for: the map without any has the least dilatation.
The report tells the landmarks of the map (landmarks_found), whether one surface is like a mirror image of the other (mirror), and of the search, under
search, the best candidate that keeps the sides of the surface (kept) and the best that turns it over (mirrored): their pairs, their misfits and
how they began. Those of mirrored are landmarks of a map from the mirror image of the source, whose vertices have the same numbers.

Files
    --landmarks L.csv    rows source_vertex,target_vertex: pairs inside the surfaces, or on their boundaries, in any number. On surfaces with
                         handles each goes to its partner by a short way from where the map without landmarks has it
    --points P.csv       rows source_face,s0,s1,s2,target_face,t0,t1,t2: pairs of points inside faces, by barycentric coordinates
    --soft S.csv         rows source_vertex,target_vertex,weight: landmarks that need not be met; one of weight w goes to the share w/(1 + w) of the
                         way from where the map without it brings it
    --curves K.csv       rows curve,surface,vertex: curves that correspond by shares of their lengths, the surface source or target, the vertices in
                         order along edges; curves are numbered from 0
    --basis G.csv        rows loop,surface,vertex: loops of surfaces with handles that correspond and so name the homotopy class of the map, which else is
                         searched. The surface is source or target, the vertices follow each other along edges, the first again at the end; loops
                         are numbered from 0. They generate the fundamental groups (2g loops; with b boundary loops 2g + b − 1), and all of
                         one surface start at one vertex, but on tori
    --map M.csv          rows source_vertex,target_face,b0,b1,b2: where each vertex of the source goes, in barycentric coordinates
    --back B.csv         the same from the target to the source
    -o OUT.obj           the source's faces with its vertices where they go, .obj or .glb
    --carried C.obj      the source with the target's texture coordinates, .obj or .glb
    --overlay O.obj      the source, its faces cut by the target's edges, with the target's texture coordinates where it has them: every face is a part of
                         one face of either, on which the map is projective
    --overlay-places O.csv  rows face,vertex,source_face,a0,a1,a2,target_face,b0,b1,b2,weight for its corners: where they lie in both, and the
                         weight that barycentric coordinates in the source are multiplied by on the way
    --domains D.png      both triangulations in the domain, landmarks as dots
    --heat H.png         the source in colours: with --same-numbering how far each vertex comes to lie from its partner, else how much each
                         face is distorted";

/// The contents of a picture of `ricci match`.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum MatchPictureChoice {
    /// Both surfaces with one texture: the target's, carried over
    Carried,
    /// Both triangulations in the common domain
    Domains,
    /// The source, coloured by the distances from partners or by the dilatation
    Heat,
}

/// The correspondence of boundaries.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum BoundaryName {
    /// They slide along each other until the map is harmonic
    Slides,
    /// By shares of their length
    ArcLength,
}

impl From<BoundaryName> for BoundaryMatching {
    fn from(name: BoundaryName) -> BoundaryMatching {
        match name {
            BoundaryName::Slides => BoundaryMatching::Slides,
            BoundaryName::ArcLength => BoundaryMatching::ArcLength,
        }
    }
}

/// The shape of boundary loops in the domain.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum LoopShapeName {
    /// Geodesics of a hyperbolic metric, onto which no map folds
    Geodesics,
    /// Circles: the domain is a closed flat or hyperbolic surface with round holes
    Circles,
}

impl From<LoopShapeName> for LoopShape {
    fn from(name: LoopShapeName) -> LoopShape {
        match name {
            LoopShapeName::Geodesics => LoopShape::Geodesics,
            LoopShapeName::Circles => LoopShape::Circles,
        }
    }
}

/// What `--landmarks` says.
pub enum LandmarkChoice<'a> {
    /// They are found.
    Auto,
    /// There are none.
    None,
    /// They are in this file.
    File(&'a Path),
}

#[derive(Args, Serialize, Debug)]
pub struct MatchArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub source: MeshArgs,
    /// Mesh file of the surface that the source is mapped to
    pub target: PathBuf,
    /// Pairs of vertices that correspond: rows source_vertex,target_vertex; auto: they are found by the shapes of the surfaces where nothing
    /// else says what corresponds; none
    #[arg(long, value_name = "auto|none|L.csv", default_value = "auto")]
    pub landmarks: FileName,
    /// Pairs of points that correspond: rows source_face,s0,s1,s2,target_face,t0,t1,t2
    #[arg(long, value_name = "P.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<FileName>,
    /// Landmarks that need not be met: rows source_vertex,target_vertex,weight
    #[arg(long, value_name = "S.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub soft: Option<FileName>,
    /// Curves that correspond by shares of their lengths: rows curve,surface,vertex
    #[arg(long, value_name = "K.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curves: Option<FileName>,
    /// Loops that name the homotopy class: rows loop,surface,vertex
    #[arg(long, value_name = "G.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub basis: Option<FileName>,
    /// For each boundary loop of the source the target's that it goes to, numbered from 0 [default: loops
    /// with landmarks as these say, the others by descending length]
    #[arg(long, value_name = "K,K,…", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<usize>,
    /// How boundaries correspond between landmarks on them
    #[arg(long, value_enum, default_value = "slides")]
    pub boundary: BoundaryName,
    /// What boundary loops of surfaces with handles become in the domain
    #[arg(long, value_enum, default_value = "geodesics")]
    pub loop_shape: LoopShapeName,
    /// Vertices with the same number correspond: the report says how far from its partner each comes to lie
    #[arg(long)]
    pub same_numbering: bool,
    /// Write where each vertex of the source goes
    #[arg(long, value_name = "M.csv")]
    pub map: Option<FileName>,
    /// Write where each vertex of the target goes
    #[arg(long, value_name = "B.csv")]
    pub back: Option<FileName>,
    /// Write the source with its vertices where they go, .obj or .glb
    #[arg(short, long, value_name = "OUT.obj")]
    pub output: Option<FileName>,
    /// Write the source with the target's texture coordinates, .obj or .glb
    #[arg(long, value_name = "C.obj")]
    pub carried: Option<FileName>,
    /// Write the source with its faces cut by the target's edges, .obj or .glb
    #[arg(long, value_name = "O.obj")]
    pub overlay: Option<FileName>,
    /// Write where the corners of those parts lie in both surfaces
    #[arg(long, value_name = "O.csv")]
    pub overlay_places: Option<FileName>,
    /// Tell a bracket of the Teichmüller distance, half of the logarithm of the least dilatation of the maps of this class: from below by period
    /// matrices or moduli, from above by the map
    #[arg(long)]
    pub distance: bool,
    /// Largest relative width of these period matrices or moduli
    #[arg(long, value_name = "W", default_value_t = 1e-3, requires = "distance", value_parser = crate::forms::width)]
    pub width: f64,
    /// Write a picture of both triangulations in the domain (.png)
    #[arg(long, value_name = "D.png")]
    pub domains: Option<FileName>,
    /// Write a picture of the distances from partners, or of the distortion (.png)
    #[arg(long, value_name = "H.png")]
    pub heat: Option<FileName>,
    /// What the picture shows [default: carried]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub show: Option<MatchPictureChoice>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

impl MatchArgs {
    pub fn landmark_choice(&self) -> LandmarkChoice<'_> {
        let others = [&self.points, &self.soft, &self.curves, &self.basis];
        match self.landmarks.to_str() {
            Some("auto") if !self.distance && others.iter().all(|file| file.is_none()) => {
                LandmarkChoice::Auto
            }
            Some("auto" | "none") => LandmarkChoice::None,
            _ => LandmarkChoice::File(&self.landmarks),
        }
    }
}

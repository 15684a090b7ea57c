//! The options of pictures on the command line.

use super::{Style, TextureChoice, Viewpoint};
use crate::options::FileName;
use crate::output::extension;
use clap::{Args, ValueEnum};
use serde::Serialize;

/// The options of every command that draws a surface.
#[derive(Args, Serialize, Debug, Clone, Default)]
pub struct PictureArgs {
    /// Write a picture (.png; of a layout also .svg)
    #[arg(long, value_name = "P.png")]
    pub picture: Option<FileName>,
    /// Pixels of the longer side of each panel [default: 900]
    #[arg(long, value_name = "PIXELS", requires = "picture", value_parser = clap::value_parser!(u16).range(64..=4096))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<u16>,
    /// Look from this azimuth (0: from the front, growing to the right) and elevation, degrees [default: chosen]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", requires = "picture", value_parser = angles, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewAngles>,
    /// The direction that is up [default: by the shape of the surface]
    #[arg(long, value_name = "AXIS", requires = "picture", allow_hyphen_values = true, value_parser = ["x", "y", "z", "-x", "-y", "-z"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<String>,
    /// Draw the edges of the mesh
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub wire: bool,
    /// Without shadows, quickly
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub draft: bool,
    /// Follow the scale of the layout by steps of 8 in the size of the pattern, which so stays visible everywhere
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub bands: bool,
    /// At most 256 colours, for a small file
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub palette: bool,
}

/// Pictures of a surface alone.
#[derive(Args, Serialize, Debug, Clone, Default)]
pub struct SurfacePictureArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub base: PictureArgs,
    /// Show a quantity in colours: curvature, of the surface
    #[arg(long, value_name = "QUANTITY", requires = "picture", value_parser = ["curvature", "none"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

/// Pictures of a surface beside its layout.
#[derive(Args, Serialize, Debug, Clone, Default)]
pub struct FlowPictureArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub base: PictureArgs,
    /// Pattern of the layout on both [default: checker; none under colours]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texture: Option<TextureChoice>,
    /// Show a quantity in colours, with a legend
    #[arg(long, value_enum, value_name = "QUANTITY", requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<ColorChoice>,
    /// Show the surroundings of a vertex (numbered from 0), so many times larger
    #[arg(long, value_name = "VERTEX,FACTOR", requires = "picture", value_parser = zoom)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<Zoom>,
}

/// Quantities that have a colour map.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum ColorChoice {
    /// The logarithm of the conformal factor between input and result
    U,
    /// Gaussian curvature of the input: angle defect over area
    Curvature,
    /// Quasi-conformal dilatation of the layout
    Qc,
    /// Area in the layout over area in the input
    Area,
    /// Pieces of the common subdivision: a hue for the final face, a shade for that of the input
    Pieces,
    /// Charts, neighbours in different colours; the default with --charts
    Charts,
    None,
}

impl ColorChoice {
    /// The name of a quantity that only a layout has.
    pub fn of_layout(self) -> Option<&'static str> {
        match self {
            ColorChoice::Qc => Some("qc"),
            ColorChoice::Area => Some("area"),
            ColorChoice::Pieces => Some("pieces"),
            ColorChoice::Charts => Some("charts"),
            ColorChoice::U | ColorChoice::Curvature | ColorChoice::None => None,
        }
    }
}

/// A vertex and how many times larger than the whole its surroundings are drawn.
#[derive(Serialize, Debug, Clone, Copy, PartialEq)]
pub struct Zoom {
    pub vertex: u32,
    pub factor: f64,
}

/// Azimuth and elevation in degrees.
pub type ViewAngles = [f64; 2];

/// The unit vector along an axis by its name.
pub fn direction(axis: &str) -> [f64; 3] {
    let sign = if axis.starts_with('-') { -1.0 } else { 1.0 };
    ['x', 'y', 'z'].map(|name| if axis.ends_with(name) { sign } else { 0.0 })
}

impl PictureArgs {
    /// True if the picture is to be an SVG, which shows a layout alone.
    pub fn is_svg(&self) -> bool {
        self.picture.as_ref().is_some_and(|path| extension(path) == "svg")
    }

    /// True if the direction is given from which a surface is looked at.
    pub fn is_turned(&self) -> bool {
        self.view.is_some() || self.up.is_some()
    }

    pub fn style(&self, texture: TextureChoice, threads: usize) -> Style {
        let fallback = Style::default();
        let view = Viewpoint {
            up: self.up.as_deref().map(direction),
            angles: self.view.map(|angles| angles.map(f64::to_radians)),
            from: None,
        };
        let size = self.size.map_or(fallback.size, usize::from);
        Style {
            size,
            view,
            texture,
            threads,
            wire: self.wire,
            palette: self.palette,
            draft: self.draft,
            bands: self.bands,
            ..fallback
        }
    }
}

impl SurfacePictureArgs {
    pub fn style(&self, threads: usize) -> Style {
        self.base.style(TextureChoice::None, threads)
    }

    /// True if the curvature is to be shown.
    pub fn curvature(&self) -> bool {
        self.color.as_deref() == Some("curvature")
    }
}

impl FlowPictureArgs {
    pub fn style(&self, threads: usize) -> Style {
        let usual = if self.color().is_some() { TextureChoice::None } else { TextureChoice::Checker };
        self.base.style(self.texture.unwrap_or(usual), threads)
    }

    /// The quantity to show.
    pub fn color(&self) -> Option<ColorChoice> {
        self.color.filter(|c| *c != ColorChoice::None)
    }
}

fn angles(text: &str) -> Result<ViewAngles, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|x| x.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[azimuth, elevation] if azimuth.abs() <= 360.0 && elevation.abs() <= 90.0 => {
            Ok([azimuth, elevation])
        }
        _ => Err("must be two numbers of degrees, the second from −90 to 90".into()),
    }
}

pub fn zoom(text: &str) -> Result<Zoom, String> {
    let parts = text.split_once(',').map(|(vertex, factor)| (vertex.trim().parse(), factor.trim().parse()));
    match parts {
        Some((Ok(vertex), Ok(factor))) if (1.0..=1e6).contains(&factor) => Ok(Zoom { vertex, factor }),
        _ => Err("must be a vertex, counted from 0, and a factor from 1 to 1e6".into()),
    }
}

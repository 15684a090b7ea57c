//! The options of `ricci brain`.

use super::names::{FREESURFER, GIFTI, PICTURE};
use super::side::HemisphereSide;
use crate::failure::Failure;
use crate::options::{Common, FileName, choices, number, positive};
use crate::picture::PictureArgs;
use clap::Args;
use ricci::flatten::DistortionEnergy;
use serde::Serialize;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: a ball in the place of a left hemisphere
    ricci make ellipsoid -n 8 -o lh.pial
    ricci brain lh.pial -o maps --gifti --report brain.json

Both hemispheres of a subject, with a label for each: brain lh.pial rh.pial --label lh.cortex.label --label rh.cortex.label -o maps

Files in the folder, for each hemisphere (lh or rh)
    lh.sphere                  the map of least stretch to a sphere of radius 100, no triangle turned over
    lh.inflated, lh.sulc       the surface with its folds smoothed away, and how far each vertex moved outwards on the way, less the mean
    lh.cortex.patch.flat       the flat map of the cortex without the medial wall, with its border marked
    lh.cortex.label            the vertices of the cortex
    lh.sphere.areal, .shape    log2 of area on the sphere over area on the surface, and of the larger stretch over the smaller one
    lh.flat.areal, .shape      the same of the flat map; 0 outside the cortex
    lh.*.surf.gii, .shape.gii, .label.gii   the same as GIFTI, with --gifti
    lh.png                     inflated view, sphere and flat map in the colours of the sulci, with --pictures

Files are those of FreeSurfer, in single precision. Without --label the medial wall is looked for: the part of the inflated view that the middle
sees towards the other hemisphere (right for a left one, x growing), until it has the share --wall of the surface's area.
With --resume a hemisphere whose files are all there, and newer than what they are made from, is left alone.";

#[derive(Args, Serialize, Debug)]
pub struct BrainArgs {
    /// White or pial surfaces, one or both hemispheres: closed, of genus 0
    #[arg(required = true, num_args = 1..=2, value_name = "lh.pial")]
    pub surfaces: Vec<FileName>,
    /// Write the files into this folder
    #[arg(short, long, value_name = "FOLDER")]
    #[serde(skip)]
    pub out: FileName,
    /// The cortex without its medial wall, a label for each surface, in their order [default: found]
    #[arg(long, value_name = "lh.cortex.label")]
    pub label: Vec<FileName>,
    /// The hemisphere of a surface whose name does not say it
    #[arg(long, value_enum)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hemisphere: Option<HemisphereSide>,
    /// Share of the surface's area that a medial wall has that is looked for
    #[arg(long, value_name = "SHARE", default_value_t = 0.08, value_parser = share)]
    pub wall: f64,
    /// Radius of the sphere
    #[arg(long, value_name = "R", default_value_t = 100.0, value_parser = positive)]
    pub radius: f64,
    /// Time of the flow that inflates, a share of the surface's area
    #[arg(long, value_name = "T", default_value_t = ricci::flatten::INFLATE_TIME, value_parser = positive)]
    pub inflate: f64,
    /// What the flat map keeps
    #[arg(long, value_enum, default_value_t = FlatChoice::Isometric)]
    pub energy: FlatChoice,
    /// Let no part of the flat map lie on another one
    #[arg(long)]
    pub injective: bool,
    /// Write GIFTI too
    #[arg(long)]
    pub gifti: bool,
    /// Draw a picture of each hemisphere
    #[arg(long)]
    pub pictures: bool,
    /// Leave hemispheres alone whose files are there
    #[arg(long)]
    #[serde(skip)]
    pub resume: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

choices!(
    /// The energies of the flat map.
    FlatChoice = DistortionEnergy { Isometric, Area, Distance }
);

impl BrainArgs {
    /// The hemisphere of each surface.
    pub fn sides(&self) -> Result<Vec<HemisphereSide>, Failure> {
        let side = |path: &FileName| {
            HemisphereSide::of_name(path).or(self.hemisphere).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: the name says no hemisphere (lh. or rh. at its beginning): give --hemisphere left or right",
                    path.display()
                ))
            })
        };
        let sides: Vec<HemisphereSide> = self.surfaces.iter().map(side).collect::<Result<_, _>>()?;
        if sides.len() == 2 && sides[0] == sides[1] {
            let why = format!(
                "both surfaces are of the {} hemisphere: their files would have the same names",
                sides[0].short()
            );
            return Err(Failure::Usage(why));
        }
        Ok(sides)
    }

    /// The file of a hemisphere with this ending.
    pub fn file(&self, side: HemisphereSide, ending: &str) -> PathBuf {
        self.out.join(format!("{}.{ending}", side.short()))
    }

    /// The endings of the files of each hemisphere.
    pub fn endings(&self) -> Vec<&'static str> {
        let mut all = FREESURFER.to_vec();
        if self.gifti {
            all.extend(GIFTI);
        }
        if self.pictures {
            all.push(PICTURE);
        }
        all
    }

    /// The options of the picture.
    pub fn picture(&self) -> PictureArgs {
        PictureArgs::default()
    }
}

fn share(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0 && x < 1.0, "must be a share between 0 and 1")
}

//! Sheets that are cut by a flat map: their strain, and the darts that keep it within the limits of a material.

use super::args::FlattenArgs;
use super::outcome::StrainedSheet;
use super::part::Part;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::runner::CommandRun;
use ricci::flatten::{DartOptions, FaceStrain, FlattenOptions, Flattening, StrainLimits, flatten_with_darts};
use serde_json::{Value, json};

impl FlattenArgs {
    /// True if a material's limits are given.
    pub fn has_limits(&self) -> bool {
        self.strain.is_some() || self.shear.is_some()
    }

    /// The part opened by darts, laid flat.
    pub fn with_darts(
        &self,
        part: Part,
        options: &FlattenOptions,
        run: &CommandRun<'_>,
    ) -> Result<(Part, Flattening, StrainedSheet), Failure> {
        let [warp, weft] = self.strain.unwrap_or([f64::INFINITY; 2]);
        let limits = StrainLimits { warp, weft, shear: self.shear.map_or(f64::INFINITY, f64::to_radians) };
        let darts = DartOptions {
            limits,
            warp: self.warp.to_radians(),
            budget: self.open.unwrap_or(f64::INFINITY),
            most: self.darts,
        };
        let Part { input, origins, n_whole } = part;
        let found = doing("flattening", || flatten_with_darts(&input.surface, options, &darts, run.control))?;
        let number = |v: u32| origins.as_ref().map_or(v, |origins| origins[v as usize]);
        let vertices: Vec<u32> = found.origins.iter().map(|v| v.0).collect();
        let faces: Vec<u32> = (0..input.mesh().n_faces() as u32).collect();
        let mut darts = found.darts;
        darts.iter_mut().flat_map(|dart| &mut dart.path).for_each(|v| v.0 = number(v.0));
        let attributes = input.attributes.of_origins(&vertices, &faces);
        let opened = Part {
            origins: Some(vertices.iter().map(|&v| number(v)).collect()),
            input: Input { surface: found.surface, attributes, ..input },
            n_whole,
        };
        let sheet = StrainedSheet { limits, strains: found.strains, darts, taken: found.taken };
        Ok((opened, found.flat, sheet))
    }
}

impl StrainedSheet {
    /// The least and the largest of a strain, and where they are.
    fn range(&self, of: fn(&FaceStrain) -> f64) -> [(f64, usize); 2] {
        let all = || self.strains.iter().map(of).enumerate().map(|(f, x)| (x, f));
        let pick = |better: fn(f64, f64) -> bool| {
            all().reduce(|a, b| if better(b.0, a.0) { b } else { a }).unwrap_or((f64::NAN, 0))
        };
        [pick(|x, y| x < y), pick(|x, y| x > y)]
    }

    pub fn figures(&self) -> Value {
        let range = |of: fn(&FaceStrain) -> f64| {
            let [(least, least_face), (most, most_face)] = self.range(of);
            json!({"least": least, "least_face": least_face, "most": most, "most_face": most_face})
        };
        let over = self.strains.iter().filter(|strain| self.limits.taken(strain) > 1.0);
        let darts: Vec<Value> = self
            .darts
            .iter()
            .map(|dart| {
                let path: Vec<u32> = dart.path.iter().map(|v| v.0).collect();
                json!({"path": path, "length": dart.length, "energy": dart.energy, "of_limit": dart.taken})
            })
            .collect();
        json!({
            "warp": range(|strain| strain.warp),
            "weft": range(|strain| strain.weft),
            "shear": range(|strain| strain.shear.to_degrees()),
            "share_over_limit": over.map(|strain| strain.share).sum::<f64>(),
            "of_limit_without_darts": self.taken[0],
            "of_limit": self.taken[1],
            "darts": darts,
        })
    }

    pub fn summary(&self) -> String {
        let percent = |of: fn(&FaceStrain) -> f64| {
            let [(least, _), (most, _)] = self.range(of);
            format!("{:+.2} % to {:+.2} %", 100.0 * least, 100.0 * most)
        };
        let [(least, _), (most, _)] = self.range(|strain| strain.shear.to_degrees());
        let mut text = format!(
            "strain   along the warp {}, the weft {}, shear {least:+.1}° to {most:+.1}°: {:.2} of the limits, {:.2} without darts\n",
            percent(|strain| strain.warp),
            percent(|strain| strain.weft),
            self.taken[1],
            self.taken[0]
        );
        for dart in &self.darts {
            let [tip, border] = [dart.path.first(), dart.path.last()].map(|v| v.map_or(0, |v| v.0));
            text += &format!(
                "dart     from vertex {border} on the border to vertex {tip}, {:.4} long: {:.2} of the limits\n",
                dart.length, dart.taken
            );
        }
        text
    }
}

//! The parts of the library that a build of the C face can leave out, by cargo features of the same names: STEP and glTF. The functions are
//! there in every build; where a part is left out, they answer that.

use crate::failure::Outcome;
use ricci::mesh::io::Soup;
#[cfg(feature = "splines")]
use ricci::spline::BicubicSurface;
#[cfg(all(feature = "quads", feature = "splines"))]
use ricci::spline::QuadSpline;
use std::path::Path;

#[cfg(not(feature = "gltf"))]
pub use crate::left_out::{
    SceneLeftOut as SceneFile, SceneOptionsLeftOut as SceneOptions, SceneReportLeftOut as SceneReport,
    WrapLeftOut as Wrap,
};
#[cfg(all(feature = "splines", not(feature = "step")))]
pub use crate::left_out::{StepLeftOut as StepOptions, UnitLeftOut as LengthUnit};
#[cfg(feature = "gltf")]
pub use ricci::mesh::io::{SceneFile, SceneOptions, SceneReport, Wrap};
#[cfg(feature = "step")]
pub use ricci::spline::{LengthUnit, StepOptions};

#[cfg(not(all(feature = "gltf", any(feature = "step", not(feature = "splines")))))]
fn left_out(what: &str, feature: &str) -> Outcome {
    use crate::failure::Failure;
    use crate::status::RICCI_UNKNOWN_FORMAT;
    let message = format!("{what} was left out when this library was built (cargo feature `{feature}`)");
    Err(Failure::new(RICCI_UNKNOWN_FORMAT, message))
}

/// Adds patches as a STEP file to `bytes`.
#[cfg(feature = "splines")]
pub fn write_step(surface: &BicubicSurface, options: &StepOptions, bytes: &mut Vec<u8>) -> Outcome {
    #[cfg(feature = "step")]
    return Ok(surface.write_step(options, bytes)?);
    #[cfg(not(feature = "step"))]
    {
        let _ = (surface, options, bytes);
        left_out("STEP", "step")
    }
}

/// Adds the patches of a spline over a quad layout as a STEP file to `bytes`.
#[cfg(all(feature = "quads", feature = "splines"))]
pub fn write_quad_step(spline: &QuadSpline, options: &StepOptions, bytes: &mut Vec<u8>) -> Outcome {
    #[cfg(feature = "step")]
    return Ok(spline.write_step(options, bytes)?);
    #[cfg(not(feature = "step"))]
    {
        let _ = (spline, options, bytes);
        left_out("STEP", "step")
    }
}

/// Adds the patches of a spline over a quad layout as JSON to `bytes`.
#[cfg(all(feature = "quads", feature = "splines"))]
pub fn write_quad_json(spline: &QuadSpline, bytes: &mut Vec<u8>) -> Outcome {
    use crate::failure::Failure;
    use crate::status::RICCI_IO;
    spline.write_json(bytes).map_err(|why| Failure::new(RICCI_IO, why.to_string()))
}

/// Writes a mesh with a texture as .glb.
pub fn write_textured(path: &Path, soup: &Soup, png: &[u8], wrap: Wrap) -> Outcome {
    #[cfg(feature = "gltf")]
    {
        use ricci::mesh::io::{Texture, write_glb_textured};
        Ok(write_glb_textured(path, soup, Texture { png, wrap, repeat: 1.0 })?)
    }
    #[cfg(not(feature = "gltf"))]
    {
        let _ = (path, soup, png, wrap);
        left_out("glTF", "gltf")
    }
}

/// Writes a mesh with tangents of its texture coordinates as .glb; returns what was left out.
pub fn write_with_tangents(path: &Path, soup: &Soup) -> Outcome<Vec<String>> {
    #[cfg(feature = "gltf")]
    {
        Ok(ricci::mesh::io::write_glb_with_tangents(path, soup)?)
    }
    #[cfg(not(feature = "gltf"))]
    {
        let _ = (path, soup);
        left_out("glTF", "gltf").map(|()| Vec::new())
    }
}

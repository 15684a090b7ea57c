//! Maps of closed surfaces of genus 0 to the sphere: what they refuse, compute, write and report.

use super::args::FlattenArgs;
use super::descent::{descent_checks, descent_figures, descent_summary, reason};
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::Input;
use crate::on_sphere::n_turned;
use crate::output::{Outputs, format_of};
use crate::picture::{self, ColorField, ColorScale, Picture, ShownSurface, TextureChoice};
use crate::progress::doing;
use crate::report::{Checks, Done, Figures};
use crate::runner::CommandRun;
use crate::say;
use crate::vertex_distortion::VertexDistortion;
use ricci::flatten::{FlattenOptions, SphereFlattening, flatten_sphere};
use ricci::mesh::Mesh;
use ricci::mesh::io::freesurfer::values_bytes;
use ricci::mesh::io::{Soup, SurfaceFile, write_as};
use std::path::Path;
use std::sync::OnceLock;

/// A map to the sphere, and what was seen when its file was read again.
pub struct RoundOutcome {
    pub input: Input,
    pub map: SphereFlattening,
    distortion: VertexDistortion,
    /// The Newton decrement that was asked for.
    tolerance: f64,
    /// The number of triangles that the numbers in the file turn over; unset where no file was read again.
    written_turned: OnceLock<usize>,
}

impl FlattenArgs {
    /// True if the surface comes to the sphere.
    pub fn is_round(&self, mesh: &Mesh) -> bool {
        !self.has_seams(mesh) && mesh.boundary_loops().is_empty()
    }

    /// Refuses what is for maps to the plane alone.
    pub fn check_round(&self, input: &Input) -> Result<(), Failure> {
        let refused = [
            ("--uv", self.uv.is_some()),
            ("--flat", self.flat.flat.is_some()),
            ("--patch", self.patch.is_some()),
            ("--pin", self.pin.is_some()),
            ("--straight", self.straight.is_some()),
            ("--injective", self.injective),
            ("--strain", self.strain.is_some()),
            ("--shear", self.shear.is_some()),
            ("--picture .svg", self.picture.is_svg()),
        ];
        if let Some((option, _)) = refused.into_iter().find(|(_, is_given)| *is_given) {
            let why = "is for maps to the plane, and a closed surface of genus 0 comes to the sphere (--sphere S.obj); --cones auto:8 cuts it open along seams";
            return Err(Failure::Usage(format!("{option} {why}")));
        }
        if input.positions().is_none() {
            return Err(Failure::Usage(format!("a map to the sphere: {NO_POSITIONS}")));
        }
        Ok(())
    }

    /// The map of a surface to the sphere.
    pub fn round_map(
        &self,
        input: Input,
        options: &FlattenOptions,
        run: &mut CommandRun<'_>,
    ) -> Result<RoundOutcome, Failure> {
        let map = doing("flattening", || flatten_sphere(&input.surface, options, run.control))?;
        [run.seconds.layout, run.seconds.solve] = map.report.seconds;
        let distortion = VertexDistortion::of_sphere(&input.surface, &map.points)?;
        let written_turned = OnceLock::new();
        Ok(RoundOutcome { input, map, distortion, tolerance: self.tolerance, written_turned })
    }

    /// The files of a map to the sphere.
    pub fn write_round(&self, of: &RoundOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let n_faces = of.input.mesh().n_faces();
        run.file("sphere", self.sphere.as_deref(), |outputs, path| of.write(outputs, path))?;
        for (option, path, values) in
            [("areal", &self.areal, &of.distortion.areal), ("shape", &self.shape, &of.distortion.shape)]
        {
            let write =
                |outputs: &mut Outputs, path: &Path| outputs.add_bytes(path, &values_bytes(values, n_faces)?);
            run.file(option, path.as_deref(), write)?;
        }
        run.picture("picture", self.picture.picture.as_deref(), || of.draw(self))
    }
}

impl RoundOutcome {
    pub fn checks(&self) -> Checks {
        let mut checks = descent_checks(&self.map.report, self.tolerance);
        if let Some(&turned) = self.written_turned.get() {
            checks.add("turned_triangles_in_file", turned as f64, 0.0);
        }
        checks
    }

    pub fn figures(&self, run: &CommandRun<'_>) -> Figures {
        descent_figures(Figures::default().with("space", "s2"), &self.map.report)
            .with("one_to_one", self.map.report.one_to_one)
            // The library gives no map in which exact arithmetic finds a turned triangle.
            .with("turned_triangles", 0)
            .if_some("turned_triangles_in_file", self.written_turned.get().copied())
            .failed(&run.failed)
            .with("left_out", run.outputs.left_out())
    }

    pub fn summary(&self, done: &Done) -> String {
        let report = &self.map.report;
        let place = "sphere   of the surface's area; files have the unit sphere\n";
        say::surface(&self.input) + place + &descent_summary(report) + &reason(report) + &say::finish(done)
    }

    /// The surface on the unit sphere. The file is read again, and the triangles are counted that its numbers turn over as seen from the middle.
    fn write(&self, outputs: &mut Outputs, path: &Path) -> Result<(), Failure> {
        let mut attributes = self.input.attributes.clone();
        // Normals are those of the input's place in space.
        attributes.normals = None;
        attributes.corner_normals = None;
        let faces = self.input.mesh().triangles();
        let soup = Soup { attributes, ..Soup::new(self.map.points.clone(), faces) };
        let format = format_of(path)?;
        let left_out = outputs.add_named(path, |path| write_as(path, format, &soup))?;
        outputs.leave_out(left_out);
        let told = |why: &dyn std::fmt::Display| Failure::Failed(format!("{}: {why}", path.display()));
        let bytes = outputs.last_bytes().map_err(|why| told(&why))?;
        let back = SurfaceFile::of_bytes(bytes, &path.display().to_string())?.soup()?;
        if back.faces.len() != soup.faces.len() {
            return Err(told(&"the file does not read back with all faces"));
        }
        self.written_turned.get_or_init(|| n_turned(&back));
        Ok(())
    }

    /// The surface beside the sphere, in the colours of the areal distortion.
    fn draw(&self, args: &FlattenArgs) -> Result<Vec<u8>, Failure> {
        let style = args.picture.style(TextureChoice::None, args.common.threads);
        let faces = self.input.mesh().triangles();
        let shown = |positions| ShownSurface {
            positions,
            faces: &faces,
            corner_uv: None,
            seams: &[],
            cones: &[],
            is_closed: true,
        };
        let positions = self.input.positions().ok_or_else(Failure::no_positions)?;
        let areal = &self.distortion.areal;
        let corners = faces.iter().map(|f| f.map(|v| areal[v as usize])).collect();
        let field = ColorField { corners, scale: ColorScale::of_signed("log2 of area there / here", areal) };
        let drawn = Picture {
            surface: Some(shown(positions)),
            beside: Some(shown(&self.map.points)),
            field: Some(&field),
            ..Picture::default()
        };
        picture::png(&drawn, &style)
    }
}

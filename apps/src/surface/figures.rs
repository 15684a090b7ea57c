//! The checks, the figures and the summary of `ricci surface`.

use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::geometry::vector::{cross, dot, sub};
use ricci::seamless::Seamless;
use ricci::spline::{QuadFit, QuadSplineSpace};

/// Largest angle between normals of neighbouring patches, degrees: far below what CAD programs take for tangent.
const NORMAL_JUMP: f64 = 0.01;

/// The file and what is measured of it.
pub struct WrittenSurface {
    /// The largest angle between the normals of neighbouring patches, radians.
    pub normal_jump: f64,
    pub n_faces: usize,
    pub step: Vec<u8>,
}

pub struct ScanOutcome {
    pub input: Input,
    /// The metric whose cones are corners of patches; a control mesh has none.
    pub seamless: Option<Seamless>,
    pub fit: QuadFit,
    pub written: WrittenSurface,
    /// The limit of the distance.
    pub tolerance: f64,
}

impl JobOutcome for ScanOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        if let Some(seamless) = &self.seamless {
            checks.add("holonomy_error", seamless.error, seamless.tolerance);
        }
        let noise = self.fit.noise;
        let remedy = if self.tolerance < self.fit.noise_limit() {
            format!(
                "the mesh has noise of {noise:.1e} of the diagonal: ask for a --tolerance of four times as much"
            )
        } else {
            "ask for more --spans or less --bending, or for --features where the mesh has edges".into()
        };
        checks.add_with_remedy("max", self.fit.max(), self.tolerance, &remedy);
        checks.add("normal_jump", self.written.normal_jump.to_degrees(), NORMAL_JUMP);
        let remedy = "the surface turns over there: ask for more --bending or --spans, or for other --cones";
        checks.add_none("folded_patches", ["patch", "patches"], &self.fit.folded_patches, Some(remedy));
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let space = self.fit.spline.space();
        let volumes = volumes(&self.input, &self.fit);
        Figures::default()
            .with("patches", space.layout().patches().len())
            // STEP has one face for each patch, but one for those that lie in one plane and meet.
            .with("faces", self.written.n_faces)
            .with("degree", self.fit.spline.degree())
            // The most of a patch in a direction.
            .with("spans", most_spans(space))
            .with("control_points", space.n_control_points())
            .with("free_control_points", space.dimension())
            .with("cones", self.seamless.as_ref().map(|seamless| seamless.cones.len()))
            .with("features_left_out", self.seamless.as_ref().map(|seamless| seamless.left_out.len()))
            // Fractions of the diagonal of the bounding box.
            .with("rms", self.fit.rms())
            .with("max", self.fit.max())
            .with("vertex_rms", self.fit.of_vertices.rms)
            .with("vertex_max", self.fit.of_vertices.max)
            .with("noise", self.fit.noise)
            .with("worst_patch", self.fit.worst_patch())
            .with("folded_patches", &self.fit.folded_patches[..])
            // Degrees.
            .with("normal_error", self.fit.normal_error.to_degrees())
            .with("normal_jump", self.written.normal_jump.to_degrees())
            // The volume inside, and how much more that is than the mesh has inside, over that; none with a boundary.
            .with("volume", volumes.map(|[of_spline, _]| of_spline))
            .with("volume_error", volumes.map(|[of_spline, of_mesh]| of_spline / of_mesh - 1.0))
            .with("bytes", self.written.step.len())
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        let space = self.fit.spline.space();
        format!(
            "{}patches  {} with up to {} a side, {}, as {}\ndistance {:.2e} of the diagonal at most (patch {}), {:.2e} in the root of the mean square, noise {:.1e}\nnormals  of neighbouring patches agree to {:.1e} degrees, with the mesh to {:.2}\n{}",
            say::surface(&self.input),
            say::count(space.layout().patches().len(), "patch", "patches"),
            say::count(most_spans(space), "span", "spans"),
            say::count(space.n_control_points(), "control point", "control points"),
            say::count(self.written.n_faces, "face", "faces"),
            self.fit.max(),
            self.fit.worst_patch(),
            self.fit.rms(),
            self.fit.noise,
            self.written.normal_jump.to_degrees(),
            self.fit.normal_error.to_degrees(),
            say::finish(done)
        )
    }
}

fn most_spans(space: &QuadSplineSpace) -> usize {
    space.spans().iter().copied().max().unwrap_or(0)
}

/// The volumes inside the spline and inside the mesh; none with a boundary.
fn volumes(input: &Input, fit: &QuadFit) -> Option<[f64; 2]> {
    let (mesh, points) = (input.mesh(), input.positions().filter(|_| input.mesh().is_closed())?);
    let corner = points.first()?;
    let sixfold = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| sub(points[v.index()], *corner));
        dot(a, cross(b, c))
    };
    Some([fit.spline.volume(), mesh.faces().map(sixfold).sum::<f64>() / 6.0])
}

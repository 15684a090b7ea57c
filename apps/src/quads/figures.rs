//! The checks, the figures and the summary of `ricci quads`.

use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::mesh::Point;
use ricci::quads::{QuadDistance, QuadMesh};
use ricci::seamless::Seamless;

pub struct QuadsOutcome {
    pub input: Input,
    pub found: Seamless,
    pub mesh: QuadMesh,
    /// The places of the vertices in space.
    pub positions: Vec<Point>,
    pub distance: QuadDistance,
}

impl JobOutcome for QuadsOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        let topology = self.mesh.topology();
        checks.add("holonomy_error", self.found.error, self.found.tolerance);
        checks.add("edges_not_manifold", topology.bad_edges as f64, 0.0);
        checks.add("vertices_not_manifold", topology.bad_vertices as f64, 0.0);
        checks.add("euler_error", (topology.euler - self.input.mesh().euler()).abs() as f64, 0.0);
        // Around a cone of valence 1 a quad is collapsed: two irregular vertices are left instead of one.
        let irregular = topology.irregular.len().abs_diff(self.found.cones.len());
        checks.add("irregular_beside_cones", irregular.saturating_sub(self.mesh.collapsed) as f64, 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let topology = self.mesh.topology();
        let shape = self.mesh.shape(&self.positions);
        Figures::default()
            .with("quads", self.mesh.quads.len())
            .with("vertices", self.mesh.places.len())
            .with("irregular", topology.irregular.len())
            .with("cones", self.found.cones.len())
            .with("euler", topology.euler)
            .with("rectangles", self.mesh.t_mesh_size[0])
            .with("arcs", self.mesh.t_mesh_size[1])
            .with("cost", self.mesh.cost)
            .with("edge", self.mesh.edge)
            .with("crease_edges", self.mesh.creases.len())
            .with("features_left_out", self.found.left_out.len())
            .with("features_off_axis", self.mesh.off_axis.len())
            .with("angle_mean", shape.angle_mean)
            .with("angle_max", shape.angle_max)
            .with("edge_mean", shape.edge_mean)
            .with("edge_deviation", shape.edge_deviation)
            // In the units of the input.
            .with("distance_max", self.distance.max)
            .with("distance_rms", self.distance.rms)
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        let topology = self.mesh.topology();
        let shape = self.mesh.shape(&self.positions);
        format!(
            "{}T-mesh   {}, {}\nquads    {}, {}, edges of {:.4} on average, angles off 90° by {:.1}° on average,\n         at most {:.2e} from the surface\n{}",
            say::surface(&self.input),
            say::count(self.mesh.t_mesh_size[0], "rectangle", "rectangles"),
            say::count(self.mesh.t_mesh_size[1], "arc", "arcs"),
            say::count(self.mesh.quads.len(), "quad", "quads"),
            say::count(topology.irregular.len(), "irregular vertex", "irregular vertices"),
            shape.edge_mean,
            shape.angle_mean.to_degrees(),
            self.distance.max,
            say::ending(&self.input, done, false)
        )
    }
}

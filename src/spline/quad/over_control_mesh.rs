//! Splines over control meshes of Catmull–Clark surfaces.

use super::control_mesh::ControlMesh;
use super::fit::QuadFit;
use super::fitted_surface::{FittedSurface, no_positions};
use super::over_quads::{LEAST_BENDING, LayoutFitOptions, LayoutStart};
use super::patch_grid::DividedQuads;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Point};
use crate::metric::Surface;
use crate::parallel;
use crate::quads::{QuadMesh, QuadPatches};

/// The fewest and the most steps of refinement of the surface that a spline is fitted to, and the number of quads that it may have after more than the
/// fewest.
const LEAST_STEPS: u32 = 2;
const MOST_STEPS: u32 = 4;
const MOST_QUADS: usize = 30_000;
/// Most spans of a patch in each direction.
const MOST_SPANS: usize = 32;

/// A spline that is fitted to the limit surface of a control mesh.
pub struct ControlMeshFit {
    /// Triangles of the limit surface, whose vertices are points of it.
    pub surface: Surface,
    /// Per quad of the control mesh the patch in which it lies; of a mesh with other polygons, per corner of each face in turn.
    pub patch_of_quads: Vec<u32>,
    /// The fit; distances are those from the limit surface.
    pub fit: QuadFit,
}

/// Fits a spline to the Catmull–Clark surface of a control mesh. Patches lie between the lines of edges that go straight on from irregular vertices, and
/// have one span for each quad, as far as there may be 32: where no irregular vertex is near, the limit surface is such a spline. A mesh with other polygons
/// than quads is refined once before.
///
/// `options`: most spans count where they are more than the quads along a patch; bending is 1e-11 if none is asked for.
///
/// # Errors
/// [`Error::Layout`] where a piece between lines is no rectangle; those of [`Mesh::from_faces`], as for a mesh in several parts, and of
/// [`super::fit_quads`].
pub fn fit_control_mesh(
    control_mesh: &ControlMesh,
    options: &LayoutFitOptions,
    control: &Control,
) -> Result<ControlMeshFit> {
    parallel::within(options.threads, || ControlQuads::new(control_mesh)?.fitted(options, control))
}

/// Quads of a control mesh, and those into which they are refined.
struct ControlQuads {
    n_quads: usize,
    /// The steps of refinement between them.
    steps: u32,
    /// The refined ones, `4^steps` for each, and their edges on the boundary.
    quads: Vec<[u32; 4]>,
    border: Vec<[u32; 2]>,
    surface: Surface,
}

impl ControlQuads {
    fn new(given: &ControlMesh) -> Result<ControlQuads> {
        let mut mesh = if given.quads().is_some() { given.clone() } else { given.refined()? };
        let n_quads = mesh.faces().len();
        let fits = |steps: &u32| n_quads << (2 * steps) <= MOST_QUADS;
        let steps = (LEAST_STEPS..=MOST_STEPS).rev().find(fits).unwrap_or(LEAST_STEPS);
        for _ in 0..steps {
            mesh = mesh.refined()?;
        }
        let quads = mesh.quads().ok_or_else(|| Error::Layout("a refined face is no quad".into()))?;
        let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&quad| QuadMesh::halves(quad)).collect();
        let points = mesh.limit_points()?;
        let surface = Surface::in_space(Mesh::from_faces(points.len(), &triangles)?, points)?;
        Ok(ControlQuads { n_quads, steps, border: mesh.border()?, quads, surface })
    }

    fn fitted(self, options: &LayoutFitOptions, control: &Control) -> Result<ControlMeshFit> {
        let ControlQuads { n_quads, steps, quads, border, surface } = self;
        let points: &[Point] = surface.positions().ok_or_else(no_positions)?;
        let mut valence = vec![0; points.len()];
        quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        let QuadPatches { nodes, arcs, patches } = QuadPatches::new(&quads, valence, &border, 1 << steps)?;
        let of_patch: Vec<Vec<u32>> = patches
            .iter()
            .map(|patch| patch.quads.iter().flat_map(|&q| [2 * q, 2 * q + 1]).collect())
            .collect();
        let mut patch_of_quads = vec![0; n_quads];
        for (p, patch) in patches.iter().enumerate() {
            patch.quads.iter().for_each(|&q| patch_of_quads[q as usize >> (2 * steps)] = p as u32);
        }
        let along: Vec<usize> = arcs.iter().map(|arc| (arc.length as usize).min(MOST_SPANS)).collect();
        let most_spans = along.iter().copied().fold(options.most_spans, usize::max);
        let bending = Some(options.bending.unwrap_or(LEAST_BENDING));
        let options = LayoutFitOptions { most_spans, bending, ..options.clone() };
        let fitted = FittedSurface::of_mesh(surface.mesh(), points, &[], patches.len())?;
        let target = fitted.target(&of_patch)?;
        let lengths = arcs.iter().map(|arc| f64::from(arc.length)).collect();
        let divided = DividedQuads {
            quads: &quads,
            points,
            parts: 1 << steps,
            n_nodes: nodes.len(),
            arcs: &arcs,
            patches: &patches,
            lengths,
        };
        let start = LayoutStart::new(fitted, &divided, along)?.nearly_fitted();
        let fit = start.fitted(target, &options, control)?;
        Ok(ControlMeshFit { patch_of_quads, fit, surface })
    }
}

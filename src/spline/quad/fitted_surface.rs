//! The surface under a layout, and the parts of it to which each patch is fitted.

use super::target::{SplineTarget, TargetFaces};
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, Mesh, Point};
use crate::parallel;
use crate::quads::QuadLayout;
use crate::seamless::Seamless;
use std::collections::BTreeSet;

/// Barycentric coordinate below which a place may lie on an edge.
const ON_EDGE: f64 = 1e-6;
/// Rings of faces around a patch, as a share of the root of the number of faces of a patch: about a third of its width on each side.
const RINGS: f64 = 0.35;
const LEAST_RINGS: usize = 3;

/// A mesh in space with the creases over which patches do not reach.
pub(super) struct FittedSurface<'a> {
    mesh: &'a Mesh,
    faces: TargetFaces<'a>,
    /// Per edge true on creases.
    is_crease: Vec<bool>,
    /// Rings of faces that belong to a patch around those on which its places lie.
    rings: usize,
}

impl<'a> FittedSurface<'a> {
    /// # Errors
    /// [`Error::Layout`] for a surface without positions; those of [`TargetFaces::new`].
    pub fn new(seamless: &'a Seamless, layout: &QuadLayout) -> Result<FittedSurface<'a>> {
        let solution = &seamless.solution;
        let positions = solution.surface().positions().ok_or_else(no_positions)?;
        let mesh = solution.given();
        let creases: Vec<EdgeId> =
            seamless.features.iter().copied().filter(|e| !layout.mesh.off_axis.contains(e)).collect();
        FittedSurface::of_mesh(mesh, positions, &creases, layout.patches.len())
    }

    /// A mesh in space under this many patches.
    ///
    /// # Errors
    /// Those of [`TargetFaces::new`].
    pub fn of_mesh(
        mesh: &'a Mesh,
        positions: &'a [Point],
        creases: &[EdgeId],
        n_patches: usize,
    ) -> Result<FittedSurface<'a>> {
        let mut is_crease = vec![false; mesh.n_edges()];
        creases.iter().for_each(|e| is_crease[e.index()] = true);
        let faces_per_patch = mesh.n_faces() as f64 / n_patches.max(1) as f64;
        Ok(FittedSurface {
            mesh,
            faces: TargetFaces::new(
                positions,
                mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect(),
                creases.iter().map(|&e| mesh.ends(e).map(|v| v.0)),
            )?,
            is_crease,
            rings: LEAST_RINGS + (RINGS * faces_per_patch.sqrt()).ceil() as usize,
        })
    }

    /// Per patch the faces on which these corners of its quads lie in the layout, but those that may lie on the other side of a crease.
    pub fn faces_at_first(&self, layout: &QuadLayout, corners: &[Vec<u32>]) -> Vec<Vec<u32>> {
        let place = |v: u32| &layout.mesh.places[v as usize];
        let is_inside = |v: u32| place(v).1.iter().all(|&w| w >= ON_EDGE);
        let of_patch = |corners: &Vec<u32>| {
            let inside: Vec<u32> = corners.iter().filter(|&&v| is_inside(v)).map(|&v| place(v).0.0).collect();
            if inside.is_empty() { corners.iter().map(|&v| place(v).0.0).collect() } else { inside }
        };
        corners.iter().map(of_patch).collect()
    }

    /// The target of patches that lie on these faces, each with the rings of faces around them that are not beyond creases.
    ///
    /// # Errors
    /// Those of [`TargetFaces::of_patches`].
    pub fn target(&self, faces: &[Vec<u32>]) -> Result<SplineTarget> {
        let around = |p: usize| {
            let mut region: BTreeSet<FaceId> = faces[p].iter().map(|&f| FaceId(f)).collect();
            let mut last: Vec<FaceId> = region.iter().copied().collect();
            for _ in 0..self.rings {
                let sides = last.iter().flat_map(|&f| self.mesh.face_halfedges(f));
                let smooth = sides.filter(|h| !self.is_crease[h.edge().index()]);
                last =
                    smooth.filter_map(|h| self.mesh.face(h.twin())).filter(|&f| region.insert(f)).collect();
            }
            region.into_iter().map(|f| f.0).collect()
        };
        let regions: Vec<Vec<u32>> = parallel::map(faces.len(), around);
        self.faces.of_patches(&regions)
    }
}

/// The error where there is nothing in space to fit.
pub(super) fn no_positions() -> Error {
    Error::Layout("the surface has no positions in space, so there is nothing to fit".into())
}

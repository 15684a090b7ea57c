//! Maps from the vertices of one surface to points of another one, and attributes carried along them.
//!
//! ```
//! use ricci::matching::SurfaceMap;
//! use ricci::mesh::{FaceId, Mesh, Place};
//! let target = Mesh::from_faces(3, &[[0, 1, 2]])?;
//! let map = SurfaceMap { places: vec![Place { face: FaceId(0), weights: [0.5, 0.25, 0.25] }] };
//! assert_eq!(map.carry(&target, &[[0.0], [4.0], [8.0]])?, [[3.0]]);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::mesh::{Mesh, Place, VertexId};

/// A map from the vertices of a surface to points of another one.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMap {
    /// Per vertex of the surface that the map starts from its image.
    pub places: Vec<Place>,
}
stored!(sections SurfaceMap { places });

impl SurfaceMap {
    /// The values at the images of the vertices, from values at the vertices of the target (V entries): positions, texture coordinates
    /// without seams, colours.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Argument`] for a place in a face that the mesh has not.
    pub fn carry<const N: usize>(&self, target: &Mesh, values: &[[f64; N]]) -> Result<Vec<[f64; N]>> {
        check_size("values", values.len(), target.n_vertices())?;
        let at = |v: VertexId| values[v.index()];
        self.places.iter().map(|place| Ok(combine(place.weights, corners(target, place)?.map(at)))).collect()
    }

    /// The values at the images of the vertices, from values at the corners of the target's faces (F × 3 entries): texture coordinates with
    /// seams.
    ///
    /// # Errors
    /// As [`SurfaceMap::carry`].
    pub fn carry_corners<const N: usize>(
        &self,
        target: &Mesh,
        values: &[[[f64; N]; 3]],
    ) -> Result<Vec<[f64; N]>> {
        check_size("corner values", values.len(), target.n_faces())?;
        let of = |place: &Place| {
            corners(target, place)?;
            Ok(combine(place.weights, values[place.face.index()]))
        };
        self.places.iter().map(of).collect()
    }

    /// The vertex of the target nearest to each image, by weight.
    ///
    /// # Errors
    /// [`Error::Argument`] for a place in a face that the mesh has not.
    pub fn nearest_vertices(&self, target: &Mesh) -> Result<Vec<VertexId>> {
        let nearest = |place: &Place| {
            let corners = corners(target, place)?;
            let [a, b, c] = place.weights;
            Ok(if a >= b && a >= c {
                corners[0]
            } else if b >= c {
                corners[1]
            } else {
                corners[2]
            })
        };
        self.places.iter().map(nearest).collect()
    }
}

fn corners(mesh: &Mesh, place: &Place) -> Result<[VertexId; 3]> {
    if place.face.index() >= mesh.n_faces() {
        return Err(Error::argument("face of a place", place.face, "a face of the target"));
    }
    Ok(mesh.face_vertices(place.face))
}

fn combine<const N: usize>(weights: [f64; 3], values: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|i| (0..3).map(|k| weights[k] * values[k][i]).sum())
}

//! The records of maps: common subdivisions and matchings.

use super::meshes::MeshRecord;
use crate::archive::{Kept, in_range, stored};
use crate::error::{Result, check_size};
use crate::matching::{MapQuality, Matching};
use crate::metric::{CommonSubdivision, Surface};
use std::sync::Arc;

/// Two triangulations laid over each other.
#[derive(Debug, Clone)]
pub struct MapRecord {
    /// The surface that is mapped.
    pub first: Surface,
    /// The triangulation that it is laid over: that of the metric, or the target.
    pub second: MeshRecord,
    /// Their common subdivision.
    pub subdivision: Arc<CommonSubdivision>,
}
stored!(sections MapRecord { first, second, subdivision } check MapRecord::check_parts);

impl Kept for MapRecord {
    const KIND: &'static str = "map";
}

impl MapRecord {
    /// Checks that the subdivision names no element that the triangulations have not.
    fn check_parts(&self) -> Result<()> {
        self.subdivision.check_sides([self.first.mesh(), &self.second.mesh])
    }
}

/// A map between two surfaces, with the surfaces.
#[derive(Debug, Clone)]
pub struct MatchingRecord {
    /// The map and its inverse.
    pub matching: Matching,
    /// The surface that the map leads from.
    pub source: Surface,
    /// The surface that the map leads to.
    pub target: Surface,
    /// The quality of the map, and the mean and largest distance of a vertex from its image there and back; none between intrinsic surfaces.
    pub quality: Option<(MapQuality, [f64; 2])>,
    /// Largest distance of the image of a point from where it should be.
    pub point_error: f64,
    /// True if the source is the mirror image of the surface that is meant.
    pub mirrored: bool,
}
stored!(sections MatchingRecord { matching, source, target, quality, point_error, mirrored }
    check MatchingRecord::check_parts);

impl Kept for MatchingRecord {
    const KIND: &'static str = "matching";
}

impl MatchingRecord {
    /// Checks that every vertex has a place on the other surface.
    fn check_parts(&self) -> Result<()> {
        let (source, target) = (self.source.mesh(), self.target.mesh());
        let maps = [(&self.matching.forward, source, target), (&self.matching.backward, target, source)];
        for (map, from, to) in maps {
            check_size("places", map.places.len(), from.n_vertices())?;
            in_range("face", map.places.iter().map(|place| place.face.index()), to.n_faces())?;
        }
        Ok(())
    }
}

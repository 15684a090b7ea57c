//! The distortion of a map between two surfaces in space, and its difference from the inverse of the map back.

use super::result::Matching;
use super::surface_map::SurfaceMap;
use crate::archive::stored;
use crate::embed::quality::DILATATION_CAP;
use crate::error::{Error, Result, check_size};
use crate::geometry::vector::{cross, diagonal, distance, dot, norm, sub, triangle_normal};
use crate::mesh::{PerFace, Point, VertexId};
use crate::metric::{CommonSubdivision, Surface};

/// The distortion of a map, of its linear extension from the source's faces to space. Every number is finite; distances are shares of the
/// diagonal of the target's bounding box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapQuality {
    /// Quasi-conformal dilatation of the faces, largest over smallest singular value: the mean by area, and the largest.
    pub qc_mean: f64,
    /// The largest dilatation; [`DILATATION_CAP`] at most.
    pub qc_max: f64,
    /// Area of a face's image over its own, both as shares of the totals: the smallest.
    pub area_ratio_min: f64,
    /// The mean over the faces.
    pub area_ratio_mean: f64,
    /// The largest.
    pub area_ratio_max: f64,
    /// Mean by area of |ln ratio|: 0 where the map keeps areas up to one factor.
    pub area_log: f64,
    /// Distance in space between a vertex and its image: the mean over the vertices by area.
    pub distance_mean: f64,
    /// The largest.
    pub distance_max: f64,
    /// Largest distance between the image of a landmark and its partner.
    pub landmark_error: f64,
}
stored!(sections MapQuality { qc_mean, qc_max, area_ratio_min, area_ratio_mean, area_ratio_max, area_log,
    distance_mean, distance_max, landmark_error });

/// The distortion of a map. `landmarks`: pairs of vertices that it should bring to each other.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for a surface without positions.
pub fn map_quality(
    [source, target]: [&Surface; 2],
    map: &SurfaceMap,
    landmarks: &[[VertexId; 2]],
) -> Result<MapQuality> {
    let (from, to) = (positions(source)?, positions(target)?);
    check_size("places of the map", map.places.len(), from.len())?;
    let images = map.carry(target.mesh(), to)?;
    let size = diagonal(to).max(f64::MIN_POSITIVE);
    let mesh = source.mesh();
    let face = |points: &[Point], f| mesh.face_vertices(f).map(|v| points[v.index()]);
    let totals = [from, &images].map(|points| mesh.faces().map(|f| area(face(points, f))).sum::<f64>());
    let (mut qc, mut qc_max): (f64, f64) = (0.0, 1.0);
    let mut range = [f64::INFINITY, 0.0f64];
    let (mut ratios, mut logs, mut count) = (0.0, 0.0, 0usize);
    let mut shares = vec![0.0; from.len()];
    for f in mesh.faces() {
        let (own, image) = (face(from, f), face(&images, f));
        let weight = area(own);
        let k = dilatation(own, image);
        qc += weight * k;
        qc_max = qc_max.max(k);
        mesh.face_vertices(f).into_iter().for_each(|v| shares[v.index()] += weight / 3.0);
        if weight > 0.0 {
            let ratio = (area(image) / totals[1].max(f64::MIN_POSITIVE)) / (weight / totals[0]);
            range = [range[0].min(ratio), range[1].max(ratio)];
            (ratios, count) = (ratios + ratio, count + 1);
            logs += weight * ratio.max(f64::MIN_POSITIVE).ln().abs();
        }
    }
    let moved: Vec<f64> = from.iter().zip(&images).map(|(&p, &q)| distance(p, q) / size).collect();
    let total = totals[0].max(f64::MIN_POSITIVE);
    let error = |pair: &[VertexId; 2]| {
        let [p, q] = [images.get(pair[0].index()), to.get(pair[1].index())];
        p.zip(q).map_or(0.0, |(&p, &q)| distance(p, q) / size)
    };
    Ok(MapQuality {
        qc_mean: (qc / total).min(DILATATION_CAP),
        qc_max,
        area_ratio_min: if range[0].is_finite() { range[0] } else { 0.0 },
        area_ratio_mean: (ratios / count.max(1) as f64).min(f64::MAX),
        area_ratio_max: range[1].min(f64::MAX),
        area_log: logs / total,
        distance_mean: moved.iter().zip(&shares).map(|(d, share)| d * share).sum::<f64>() / total,
        distance_max: moved.iter().copied().fold(0.0, f64::max),
        landmark_error: landmarks.iter().map(error).fold(0.0, f64::max),
    })
}

/// The distortion of one face of the source, with its area.
pub(super) struct FaceDistortion {
    pub area: f64,
    /// |ln| of its share of the image's area over its share of its own surface.
    pub area_log: f64,
    pub dilatation: f64,
}

/// The distortion of the faces that have an area.
///
/// # Errors
/// As [`map_quality`].
pub(super) fn face_distortions(
    [source, target]: [&Surface; 2],
    map: &SurfaceMap,
) -> Result<Vec<FaceDistortion>> {
    let (from, to) = (positions(source)?, positions(target)?);
    check_size("places of the map", map.places.len(), from.len())?;
    let images = map.carry(target.mesh(), to)?;
    let mesh = source.mesh();
    let face = |points: &[Point], f| mesh.face_vertices(f).map(|v| points[v.index()]);
    let totals = [from, &images].map(|points| mesh.faces().map(|f| area(face(points, f))).sum::<f64>());
    let distortion = |f| {
        let (own, image) = (face(from, f), face(&images, f));
        let ratio = (area(image) / totals[1].max(f64::MIN_POSITIVE)) / (area(own) / totals[0]);
        let area_log = ratio.max(f64::MIN_POSITIVE).ln().abs();
        FaceDistortion { area: area(own), area_log, dilatation: dilatation(own, image) }
    };
    Ok(mesh.faces().map(distortion).filter(|face| face.area > 0.0).collect())
}

/// Per face of the source the dilatation of the map, [`DILATATION_CAP`] at most.
///
/// # Errors
/// As [`map_quality`].
pub fn dilatations([source, target]: [&Surface; 2], map: &SurfaceMap) -> Result<PerFace<f64>> {
    let (from, to) = (positions(source)?, positions(target)?);
    check_size("places of the map", map.places.len(), from.len())?;
    let images = map.carry(target.mesh(), to)?;
    let mesh = source.mesh();
    let at = |points: &[Point], f| mesh.face_vertices(f).map(|v| points[v.index()]);
    Ok(mesh.faces().map(|f| dilatation(at(from, f), at(&images, f))).collect::<Vec<_>>().into())
}

/// The differences of the areas of source and target from those that an overlay of the two covers, as shares of the areas.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for a surface without positions.
pub fn uncovered(surfaces: [&Surface; 2], overlay: &CommonSubdivision) -> Result<[f64; 2]> {
    let share = |side: usize| {
        let (mesh, points) = (surfaces[side].mesh(), positions(surfaces[side])?);
        let own: f64 = mesh.faces().map(|f| area(mesh.face_vertices(f).map(|v| points[v.index()]))).sum();
        let at: Vec<[Point; 3]> =
            mesh.faces().map(|f| mesh.face_vertices(f).map(|v| points[v.index()])).collect();
        let covered: f64 = overlay.from_corners(side, &at)?.into_iter().map(area).sum();
        Ok((covered / own.max(f64::MIN_POSITIVE) - 1.0).abs())
    };
    Ok([share(0)?, share(1)?])
}

fn area(corners: [Point; 3]) -> f64 {
    0.5 * norm(triangle_normal(corners))
}

/// Largest over smallest singular value of the linear map from one triangle to another, [`DILATATION_CAP`] at most.
pub(super) fn dilatation(from: [Point; 3], to: [Point; 3]) -> f64 {
    // In an orthonormal basis of the first triangle's plane the edges are (l, 0) and (x, y).
    let [a, b] = [sub(from[1], from[0]), sub(from[2], from[0])];
    let length = norm(a);
    let (x, y) = (dot(a, b) / length, norm(cross(a, b)) / length);
    let [p, q] = [sub(to[1], to[0]), sub(to[2], to[0])];
    let first = p.map(|c| c / length);
    let second: Point = std::array::from_fn(|k| (q[k] - x * first[k]) / y);
    let (e, f, g) = (dot(first, first), dot(first, second), dot(second, second));
    let spread = (0.25 * (e - g) * (e - g) + f * f).sqrt();
    let (largest, area) = (0.5 * (e + g) + spread, norm(cross(first, second)));
    let ratio = largest / area;
    if ratio.is_finite() { ratio.clamp(1.0, DILATATION_CAP) } else { DILATATION_CAP }
}

/// The mean and the largest distance of the vertices of a surface from their images under a map followed by one back, as shares of the
/// diagonal of its bounding box.
///
/// # Errors
/// As [`map_quality`].
pub fn cycle_error(
    [source, target]: [&Surface; 2],
    [forward, backward]: [&SurfaceMap; 2],
) -> Result<[f64; 2]> {
    let from = positions(source)?;
    check_size("places of the map", forward.places.len(), from.len())?;
    check_size("places of the map back", backward.places.len(), target.mesh().n_vertices())?;
    let returned = forward.carry(target.mesh(), &backward.carry(source.mesh(), from)?)?;
    let size = diagonal(from).max(f64::MIN_POSITIVE);
    let off: Vec<f64> = from.iter().zip(&returned).map(|(&p, &q)| distance(p, q) / size).collect();
    Ok([off.iter().sum::<f64>() / off.len().max(1) as f64, off.iter().copied().fold(0.0, f64::max)])
}

/// The largest distance of the image of a point of [`Matching::points`] from the place where it should be, as a share of the diagonal of
/// the target's bounding box.
///
/// # Errors
/// [`Error::Argument`] for a surface without positions, and for points on another one.
pub fn point_error(target: &Surface, matching: &Matching) -> Result<f64> {
    let to = positions(target)?;
    let [images, goals] = [0, 1].map(|k| {
        let places = matching.points.iter().map(|pair| pair[k]).collect();
        SurfaceMap { places }.carry(target.mesh(), to)
    });
    let apart = images?.into_iter().zip(goals?).map(|(p, q)| distance(p, q));
    Ok(apart.fold(0.0, f64::max) / diagonal(to).max(f64::MIN_POSITIVE))
}

fn positions(surface: &Surface) -> Result<&[Point]> {
    let Some(positions) = surface.positions() else {
        return Err(Error::argument("surface", "intrinsic", "one with positions in space"));
    };
    Ok(positions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FaceId, Mesh, Place};

    #[test]
    fn areas_change_by_the_shares_that_faces_have() {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        // The same corners but one, farther out: areas 1.5 and 0.5.
        let kite = vec![[0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let [source, target] = [square, kite].map(|points| Surface::in_space(mesh.clone(), points).unwrap());
        let corner = |face, k: usize| Place {
            face: FaceId(face),
            weights: std::array::from_fn(|i| f64::from(u8::from(i == k))),
        };
        let map = SurfaceMap { places: vec![corner(0, 0), corner(0, 1), corner(0, 2), corner(1, 2)] };
        let quality = map_quality([&source, &target], &map, &[]).unwrap();
        assert!((quality.area_ratio_min - 0.5).abs() < 1e-12 && (quality.area_ratio_max - 1.5).abs() < 1e-12);
        assert!((quality.area_ratio_mean - 1.0).abs() < 1e-12);
        assert!((quality.area_log - 0.5 * (1.5f64.ln() + 2f64.ln())).abs() < 1e-12, "{quality:?}");
        let all = dilatations([&source, &target], &map).unwrap();
        assert!((all[FaceId(1)] - 1.0).abs() < 1e-12 && (all[FaceId(0)] - quality.qc_max).abs() < 1e-12);
    }

    #[test]
    fn dilatation_is_the_quotient_of_singular_values() {
        let triangle = [[0.0, 0.0, 0.0], [2.0, 0.5, 0.1], [0.3, 1.0, -0.4]];
        assert!((dilatation(triangle, triangle.map(|p| p.map(|x| 3.0 * x))) - 1.0).abs() < 1e-12);
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 1.0, 0.0]];
        assert!((dilatation(flat, flat.map(|[x, y, z]| [4.0 * x, y, z])) - 4.0).abs() < 1e-12);
        assert_eq!(dilatation(flat, [[0.0; 3]; 3]), DILATATION_CAP);
    }
}

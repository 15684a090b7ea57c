//! The triangulation of polygons in the plane by constrained Delaunay refinement (crate `spade`).

use super::knots::{PlaneDomain, is_straight};
use crate::error::{Error, Result};
use crate::geometry::complex::{cross, distance, sub};
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};
use std::collections::HashSet;

/// Angle in degrees. Triangles with a smaller angle are divided, unless two sides of the boundary enclose it. The refinement provably ends
/// up to about 20 degrees, in practice up to 30.
const LEAST_ANGLE: f64 = 25.0;
/// Most vertices of a domain.
const MOST_VERTICES: usize = 2_000_000;

/// The triangulated inside of closed polygons: the points that an odd number of them wind around. Triangles are about as large as
/// equilateral ones with the side `edge`, or smaller where the boundary needs it. Vertices of the polygons at which they go straight on are
/// left out. Convex corners get a single triangle where possible ([`PlaneDomain::make_ears`]).
///
/// # Errors
/// [`Error::Spline`] for a polygon that crosses itself or another one, or has no area; [`Error::Argument`] for an edge that is not
/// positive, or so short that there would be more than two million vertices.
///
/// ```
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let domain = ricci::spline::triangulate(&square, 0.2)?;
/// assert!(domain.check().is_ok() && domain.triangles.len() > 40);
/// # Ok::<(), ricci::Error>(())
/// ```
pub fn triangulate(polygons: &[Vec<[f64; 2]>], edge: f64) -> Result<PlaneDomain> {
    let wrong = |index: usize, message: String| Error::Spline { what: "polygon", index, message };
    if !(edge > 0.0 && edge.is_finite()) {
        return Err(Error::argument("edge", edge, "positive and finite"));
    }
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut area = 0.0;
    for (at, polygon) in polygons.iter().enumerate() {
        let corners = corners(polygon);
        if corners.len() < 3 {
            return Err(wrong(at, "it has fewer than three corners".into()));
        }
        let around = |i: usize| corners[(i + 1) % corners.len()];
        area += 0.5 * (0..corners.len()).map(|i| cross(corners[i], around(i))).sum::<f64>();
        let mut vertices = Vec::with_capacity(corners.len());
        for &[x, y] in &corners {
            let inserted = cdt.insert(Point2::new(x, y));
            vertices.push(inserted.map_err(|why| wrong(at, format!("its corner ({x}, {y}): {why}")))?);
        }
        for (i, &from) in vertices.iter().enumerate() {
            let to = vertices[(i + 1) % vertices.len()];
            if from == to || !cdt.can_add_constraint(from, to) {
                let ([x, y], [z, w]) = (corners[i], around(i));
                let side = format!("its side from ({x}, {y}) to ({z}, {w}) crosses or meets another one");
                return Err(wrong(at, side));
            }
            cdt.add_constraint(from, to);
        }
    }
    let largest = 3f64.sqrt() / 4.0 * edge * edge;
    if area.abs() / largest > MOST_VERTICES as f64 {
        return Err(Error::argument("edge", edge, "longer: there would be more than two million vertices"));
    }
    let options = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE))
        .with_max_allowed_area(largest)
        .with_max_additional_vertices(MOST_VERTICES);
    let refined = cdt.refine(options);
    if !refined.refinement_complete {
        return Err(wrong(0, "triangles between its sides cannot be made large enough".into()));
    }
    let outside: HashSet<_> = refined.excluded_faces.into_iter().collect();
    let inside = cdt.inner_faces().filter(|face| !outside.contains(&face.fix()));
    let faces: Vec<[u32; 3]> = inside.map(|face| face.vertices().map(|v| v.fix().index() as u32)).collect();
    // Vertices that belong to outer triangles only are left out.
    let mut number = vec![u32::MAX; cdt.num_vertices()];
    let mut vertices = Vec::new();
    let triangles = faces.into_iter().map(|face| {
        face.map(|v| {
            if number[v as usize] == u32::MAX {
                number[v as usize] = vertices.len() as u32;
                let place = cdt.vertex(spade::handles::FixedVertexHandle::from_index(v as usize)).position();
                vertices.push([place.x, place.y]);
            }
            number[v as usize]
        })
    });
    let triangles = triangles.collect();
    let mut domain = PlaneDomain { vertices, triangles };
    domain.make_ears();
    Ok(domain)
}

/// The vertices at which a polygon turns.
fn corners(polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut distinct = polygon.to_vec();
    distinct.dedup();
    while distinct.len() > 1 && distinct.first() == distinct.last() {
        distinct.pop();
    }
    let n = distinct.len();
    let direction = |from: [f64; 2], to: [f64; 2]| sub(to, from).map(|x| x / distance(from, to));
    let turns = |i: &usize| {
        let [before, here, after] = [(i + n - 1) % n, *i, (i + 1) % n].map(|k| distinct[k]);
        !is_straight(direction(before, here), direction(here, after))
    };
    (0..n).filter(turns).map(|i| distinct[i]).collect()
}

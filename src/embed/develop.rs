//! Developing an opened surface into the plane, face by face.

use super::triangle::Triangle;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Faces between two looks at the control.
const FACES_PER_STEP: usize = 4096;

/// Where everything lies in the plane.
pub(crate) struct Development {
    /// Position per vertex of the opened surface.
    pub coordinates: Vec<[f64; 2]>,
    /// Unit direction per half-edge, in the frame of its own face.
    pub direction: PerHalfedge<[f64; 2]>,
    /// Sum of the triangles' areas.
    pub area: f64,
    /// Faces that break the triangle inequality, ascending.
    pub broken: Vec<FaceId>,
}

/// Develop the faces in order of their distance from the smallest one, which lies at the origin.
///
/// Each face inherits the *direction* of the edge it is entered through, not the difference of two rounded
/// positions, so an edge of any length passes a direction on to the same accuracy, and what a direction loses
/// grows with the number of faces crossed alone. A position loses `ε·|largest position on the way|`. Ways of
/// least length from the smallest face never go farther out than where they lead: positions are as accurate
/// as doubles of their size can be, and the origin is where doubles are dense. (Entering through the largest
/// edges first would lead from one small face to the next by way of large ones, and round there.)
pub(crate) fn develop(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    differences: &PerFace<[f64; 3]>,
    is_cut: &PerEdge<bool>,
    corner: &PerHalfedge<u32>,
    n_corners: usize,
    control: &Control,
) -> Result<Development> {
    let mut coordinates = vec![[0.0; 2]; n_corners];
    let mut placed = vec![false; n_corners];
    let mut direction = PerHalfedge::filled(mesh.n_halfedges(), [0.0; 2]);
    let mut done = vec![false; mesh.n_faces()];
    let mut area = 0.0;
    let mut broken = Vec::new();

    let size = |f: FaceId| mesh.opposite_edges(f).map(|e| lengths[e]).into_iter().fold(0.0, f64::max);
    let Some(first) = mesh.faces().min_by(|&f, &g| size(f).total_cmp(&size(g))) else {
        return Err(Error::Layout("the surface has no face".into()));
    };
    let root = mesh.face_halfedge(first);
    let mut queue = BinaryHeap::from([Reverse((Key(0.0), root))]);
    let mut count = 0;
    while let Some(Reverse((Key(distance), base))) = queue.pop() {
        let Some(f) = mesh.face(base) else { continue };
        if std::mem::replace(&mut done[f.index()], true) {
            continue;
        }
        if count % FACES_PER_STEP == 0 {
            control.step(Stage::Layout, count as f64 / mesh.n_faces() as f64)?;
        }
        count += 1;

        let sides = [base, mesh.next(base), mesh.prev(base)];
        let [l_base, l_right, l_left] = sides.map(|h| lengths[h.edge()]);
        let corners = mesh.face_halfedges(f);
        // Differences belong to corners: that at the origin of the base is opposite its next side.
        let at = |h: HalfedgeId| corners.iter().position(|&c| c == h).map_or(0.0, |k| differences[f][k]);
        let triangle = Triangle::from_differences(sides.map(at));
        if triangle.excess > 0.0 {
            broken.push(f);
        }
        area += triangle.area;
        let along = if base == root { [1.0, 0.0] } else { direction[base.twin()].map(|x| -x) };
        let [at_origin, at_tip, _] = triangle.direction;
        let up_left = unit(times(along, at_origin)); // from the base's origin to the apex
        let up_right = unit(times(along.map(|x| -x), [at_tip[0], -at_tip[1]]));
        direction[sides[0]] = along;
        direction[sides[1]] = up_right;
        direction[sides[2]] = up_left.map(|x| -x);

        let [a, b, apex] = sides.map(|h| corner[h] as usize);
        if base == root {
            coordinates[b] = along.map(|x| l_base * x);
            (placed[a], placed[b]) = (true, true);
        }
        if !std::mem::replace(&mut placed[apex], true) {
            let (from, way, l) =
                if l_left <= l_right { (a, up_left, l_left) } else { (b, up_right, l_right) };
            let [x, y] = coordinates[from];
            coordinates[apex] = [x + l * way[0], y + l * way[1]];
        }
        for h in sides {
            let across = h.twin();
            if !is_cut[h.edge()] && mesh.face(across).is_some_and(|g| !done[g.index()]) {
                let step = centre_to_side(mesh, lengths, h) + centre_to_side(mesh, lengths, across);
                queue.push(Reverse((Key(distance + step), across)));
            }
        }
    }
    broken.sort_unstable();
    Ok(Development { coordinates, direction, area, broken })
}

/// Distance from a face's centroid to the midpoint of its side `h`: a third of the median.
pub(super) fn centre_to_side(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> f64 {
    let [a, b, c] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
    // 4 median² = 2b² + 2c² − a² = (b − c)² + (b + c − a)(b + c + a)
    ((b - c) * (b - c) + f64::max(b + c - a, 0.0) * (b + c + a)).sqrt() / 6.0
}

/// Product of complex numbers.
pub(super) fn times([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c - b * d, a * d + b * c]
}

/// Direction of a nonzero complex number.
pub(super) fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let norm = x.hypot(y);
    [x / norm, y / norm]
}

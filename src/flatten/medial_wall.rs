//! The medial wall of a cortical hemisphere, found on its inflated view, and the part of a surface that is left without some vertices.

use super::inflate::VertexAreas;
use crate::error::{Error, Result, check_size};
use crate::geometry::vector::{Vector, norm, sub};
use crate::mesh::{FaceId, Mesh, Point, VertexId};
use crate::metric::Surface;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The vertices of the medial wall of a hemisphere of a cortex, by its inflated view: those nearest to where its middle looks along
/// `medial`, in the order of their distance along the edges of the view, until they have the share `share` of the surface's area. What they
/// cut off from the largest part of the others belongs to them too.
///
/// # Errors
/// [`Error::Argument`] for a share that is not between 0 and 1, a direction without length, a surface without positions; [`Error::Size`].
pub fn medial_wall(surface: &Surface, view: &[Point], medial: Vector, share: f64) -> Result<Vec<bool>> {
    let mesh = surface.mesh();
    check_size("points of the view", view.len(), mesh.n_vertices())?;
    if !(share > 0.0 && share < 1.0) {
        return Err(Error::argument("share", share, "a number between 0 and 1"));
    }
    if norm(medial) <= 0.0 || !norm(medial).is_finite() {
        return Err(Error::argument("medial direction", format!("{medial:?}"), "a direction"));
    }
    let Some(positions) = surface.positions() else {
        return Err(Error::argument("surface", "without positions", "a surface in space"));
    };
    let faces = mesh.triangles();
    let areas = VertexAreas::new(&faces, positions);
    let centre = VertexAreas::new(&faces, view).centre;
    let towards = |p: &Point| {
        let way = sub(*p, centre);
        (0..3).map(|c| way[c] * medial[c]).sum::<f64>() / norm(way)
    };
    let seed =
        (0..view.len()).fold(0, |best, v| if towards(&view[v]) > towards(&view[best]) { v } else { best });
    let mut is_wall = vec![false; view.len()];
    let mut area = 0.0;
    for v in in_order_of_distance(surface, view, seed) {
        if area >= share * areas.total {
            break;
        }
        is_wall[v] = true;
        area += areas.each[v];
    }
    let is_cortex: Vec<bool> = is_wall.iter().map(|wall| !wall).collect();
    Ok(flat_part(surface, &is_cortex)?.into_iter().map(|kept| !kept).collect())
}

/// The vertices by their distance from one along the edges of a view.
fn in_order_of_distance(surface: &Surface, view: &[Point], seed: usize) -> Vec<usize> {
    let mesh = surface.mesh();
    let mut least = vec![f64::INFINITY; view.len()];
    let mut order = Vec::new();
    let mut queue = BinaryHeap::new();
    let key = |length: f64, v: usize| Reverse((length.to_bits(), v));
    least[seed] = 0.0;
    queue.push(key(0.0, seed));
    // Bits of positive numbers have the order of the numbers.
    while let Some(Reverse((bits, v))) = queue.pop() {
        let length = f64::from_bits(bits);
        if length > least[v] {
            continue;
        }
        order.push(v);
        for h in mesh.outgoing(VertexId::from(v)) {
            let w = mesh.tip(h).index();
            let further = length + norm(sub(view[v], view[w]));
            if further < least[w] {
                least[w] = further;
                queue.push(key(further, w));
            }
        }
    }
    order
}

/// Of the vertices that are marked, those of the largest piece (by its faces) that is a surface with boundary: pieces join faces with three
/// marked vertices along edges, and vertices at which a piece touches itself are left out.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] where no face has three marked vertices.
pub fn flat_part(surface: &Surface, marked: &[bool]) -> Result<Vec<bool>> {
    let mesh = surface.mesh();
    check_size("marks", marked.len(), mesh.n_vertices())?;
    let mut kept = marked.to_vec();
    loop {
        let inside = |f: FaceId, kept: &[bool]| mesh.face_vertices(f).iter().all(|v| kept[v.index()]);
        let piece = largest_piece(mesh, |f| inside(f, &kept));
        if piece.is_empty() {
            return Err(Error::argument("marks", "too few", "three vertices of some face"));
        }
        let mut in_piece = vec![false; mesh.n_faces()];
        piece.iter().for_each(|f| in_piece[f.index()] = true);
        let mut next = vec![false; kept.len()];
        piece.iter().flat_map(|&f| mesh.face_vertices(f)).for_each(|v| next[v.index()] = true);
        for v in mesh.vertices().filter(|v| next[v.index()]).collect::<Vec<_>>() {
            let fan: Vec<bool> =
                mesh.outgoing(v).map(|h| mesh.face(h).is_some_and(|f| in_piece[f.index()])).collect();
            let begins = (0..fan.len()).filter(|&k| fan[k] && !fan[(k + fan.len() - 1) % fan.len()]).count();
            if begins > 1 {
                next[v.index()] = false;
            }
        }
        // Faces between vertices of the piece that are not of the piece do not arise: they would have three marked vertices.
        if next == kept {
            return Ok(kept);
        }
        kept = next;
    }
}

/// The largest set of such faces that edges join.
fn largest_piece(mesh: &Mesh, inside: impl Fn(FaceId) -> bool) -> Vec<FaceId> {
    let mut seen = vec![false; mesh.n_faces()];
    let mut largest = Vec::new();
    for begin in mesh.faces() {
        if seen[begin.index()] || !inside(begin) {
            continue;
        }
        seen[begin.index()] = true;
        let (mut piece, mut k) = (vec![begin], 0);
        while let Some(&f) = piece.get(k) {
            k += 1;
            for h in mesh.face_halfedges(f) {
                if let Some(g) = mesh.face(h.twin()).filter(|&g| !seen[g.index()] && inside(g)) {
                    seen[g.index()] = true;
                    piece.push(g);
                }
            }
        }
        if piece.len() > largest.len() {
            largest = piece;
        }
    }
    largest
}

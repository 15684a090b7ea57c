//! The edges of a triangle list that may have any defect, with the faces that meet in each.
//!
//! Side `3f + k` is the side of face f from its corner k to corner k + 1. Faces that name a missing vertex or the same vertex twice have
//! no sides.

use super::union_find::UnionFind;
use std::cmp::Reverse;

/// Marks the lack of a face, side or vertex in an array of them.
pub(super) const NONE: u32 = u32::MAX;

pub(super) struct Incidence {
    pub n_vertices: usize,
    /// For each face, true if it has three different existing vertices.
    triangle: Vec<bool>,
    /// Sides sorted by their unordered end vertices, then by number.
    sides: Vec<u32>,
    /// The start of each edge in `sides`, and the end of the last.
    group: Vec<u32>,
}

impl Incidence {
    pub fn new(n_vertices: usize, faces: &[[u32; 3]]) -> Incidence {
        let proper = |f: &[u32; 3]| f.iter().all(|&v| (v as usize) < n_vertices) && distinct(f);
        let triangle: Vec<bool> = faces.iter().map(proper).collect();
        // Counting sort by the smaller end; the few sides of each vertex are then sorted by the larger one.
        let mut start = vec![0u32; n_vertices + 1];
        each_side(faces, &triangle, |[a, _], _| start[a as usize + 1] += 1);
        (0..n_vertices).for_each(|v| start[v + 1] += start[v]);
        let n_sides = start[n_vertices] as usize;
        let mut sorted = vec![(0u32, 0u32); n_sides];
        // Each vertex's part is filled from the back, so that `start` ends as it was.
        each_side(faces, &triangle, |[a, b], side| {
            let slot = &mut start[a as usize + 1];
            *slot -= 1;
            sorted[*slot as usize] = (b, side);
        });
        let mut group = Vec::with_capacity(n_sides / 2 + n_vertices.min(n_sides) + 1);
        for v in 0..n_vertices {
            let (begin, end) =
                (start[v + 1] as usize, start.get(v + 2).map_or(n_sides, |&next| next as usize));
            let own = &mut sorted[begin..end];
            own.sort_unstable();
            let mut before = NONE;
            for (k, &(b, _)) in own.iter().enumerate() {
                if b != before {
                    group.push((begin + k) as u32);
                }
                before = b;
            }
        }
        group.push(n_sides as u32);
        Incidence { n_vertices, triangle, sides: sorted.into_iter().map(|(_, side)| side).collect(), group }
    }

    /// True if the faces are triangles, no two with the same vertices, and each edge has one face, or two that run along it in opposite
    /// directions. Vertices may still have several fans, or none.
    pub fn is_oriented(&self, faces: &[[u32; 3]]) -> bool {
        let third = |side: u32| faces[side as usize / 3][(side as usize + 2) % 3];
        let is_sound = |sides: &[u32]| match *sides {
            [_] => true,
            [a, b] => is_forward(faces, a) != is_forward(faces, b) && third(a) != third(b),
            _ => false,
        };
        let is_whole = !faces.is_empty() && self.triangle.iter().all(|&is_triangle| is_triangle);
        is_whole && self.edges().all(is_sound)
    }

    /// True if the face has three different existing vertices.
    pub fn is_triangle(&self, f: usize) -> bool {
        self.triangle[f]
    }

    /// The sides along each distinct edge.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.group.windows(2).map(|w| &self.sides[w[0] as usize..w[1] as usize])
    }

    /// The corners as sets, one for each fan of faces around a vertex that is connected through edges with at most `most` faces.
    pub fn fans(&self, faces: &[[u32; 3]], most: usize) -> UnionFind {
        let mut corners = UnionFind::new(3 * faces.len());
        self.join_fans(faces, |sides| sides.len() <= most, &mut corners);
        corners
    }

    /// Joins the corners on both sides of each edge for whose sides `through` is true.
    pub fn join_fans(
        &self,
        faces: &[[u32; 3]],
        mut through: impl FnMut(&[u32]) -> bool,
        corners: &mut UnionFind,
    ) {
        // Corner 3f + k is at the start of side 3f + k, the next corner at its end.
        let corners_of = |s: u32| {
            let (start, end) = (s, 3 * (s / 3) + (s % 3 + 1) % 3);
            if is_forward(faces, s) { (start, end) } else { (end, start) }
        };
        for sides in self.edges().filter(|sides| through(sides)) {
            for pair in sides.windows(2) {
                let ((a, b), (c, d)) = (corners_of(pair[0]), corners_of(pair[1]));
                corners.join(a, c);
                corners.join(b, d);
            }
        }
    }

    /// For each vertex the number of fans of edge-connected faces that touch it.
    pub fn sheets(&self, faces: &[[u32; 3]]) -> Vec<u32> {
        let mut corners = self.fans(faces, usize::MAX);
        let mut sheets = vec![0; self.n_vertices];
        for (f, face) in self.triangles(faces) {
            for (corner, &v) in (3 * f..).zip(face) {
                sheets[v as usize] += u32::from(corners.root(corner) == corner);
            }
        }
        sheets
    }

    /// The faces that are triangles, with their numbers.
    pub fn triangles<'a>(&self, faces: &'a [[u32; 3]]) -> impl Iterator<Item = (u32, &'a [u32; 3])> + Clone {
        (0u32..).zip(faces).filter(|(f, _)| self.triangle[*f as usize])
    }

    /// For each side the other side along its edge; `NONE` where the edge has one face or more than two.
    pub fn partners(&self, n_faces: usize) -> Vec<u32> {
        let mut partner = vec![NONE; 3 * n_faces];
        for sides in self.edges() {
            if let [a, b] = *sides {
                partner[a as usize] = b;
                partner[b as usize] = a;
            }
        }
        partner
    }
}

/// Passes the sides of triangles to `take`, in order, with their smaller and larger ends.
fn each_side(faces: &[[u32; 3]], is_triangle: &[bool], mut take: impl FnMut([u32; 2], u32)) {
    for (f, _) in is_triangle.iter().enumerate().filter(|(_, is_triangle)| **is_triangle) {
        for k in 0..3 {
            let (a, b) = (faces[f][k], faces[f][(k + 1) % 3]);
            take([a.min(b), a.max(b)], (3 * f + k) as u32);
        }
    }
}

/// True if all vertices exist and are connected through faces.
pub(super) fn hangs_together(n_vertices: usize, faces: &[[u32; 3]]) -> bool {
    if faces.as_flattened().iter().any(|&v| v as usize >= n_vertices) {
        return false;
    }
    let mut pieces = UnionFind::new(n_vertices);
    let join = |&[a, b, c]: &[u32; 3]| usize::from(pieces.join(a, b)) + usize::from(pieces.join(a, c));
    faces.iter().map(join).sum::<usize>() + 1 == n_vertices
}

/// The vertices as sets, one for each piece of the surface that is connected through faces.
pub(super) fn connected<'a>(
    n_vertices: usize,
    triangles: impl Iterator<Item = (u32, &'a [u32; 3])>,
) -> UnionFind {
    let mut pieces = UnionFind::new(n_vertices);
    for (_, face) in triangles {
        pieces.join(face[0], face[1]);
        pieces.join(face[0], face[2]);
    }
    pieces
}

/// The first face and the number of faces of each piece connected through vertices, pieces with the most faces first.
pub(super) fn components<'a>(
    n_vertices: usize,
    triangles: impl Iterator<Item = (u32, &'a [u32; 3])> + Clone,
) -> Vec<(u32, u32)> {
    let mut pieces = connected(n_vertices, triangles.clone());
    let mut count = vec![(NONE, 0); n_vertices];
    for (f, face) in triangles {
        let (first, size) = &mut count[pieces.root(face[0]) as usize];
        *first = f.min(*first);
        *size += 1;
    }
    count.retain(|&(_, size)| size > 0);
    count.sort_unstable_by_key(|&(first, size)| (Reverse(size), first));
    count
}

/// Connected pieces of the edges with one face, given by their ends: on a manifold, the boundary loops.
pub(super) fn boundary_loops(n_vertices: usize, boundary: impl Iterator<Item = [u32; 2]>) -> usize {
    let mut pieces = UnionFind::new(n_vertices);
    let mut on_boundary = vec![false; n_vertices];
    for [a, b] in boundary {
        pieces.join(a, b);
        on_boundary[a as usize] = true;
        on_boundary[b as usize] = true;
    }
    (0..n_vertices as u32).filter(|&v| on_boundary[v as usize] && pieces.root(v) == v).count()
}

/// Renumbers the vertices that faces use from 0, in their order, and leaves out the others; returns the used vertices.
pub(super) fn drop_unused(n_vertices: usize, faces: &mut [[u32; 3]]) -> Vec<u32> {
    let mut number = vec![NONE; n_vertices];
    faces.as_flattened().iter().for_each(|&v| number[v as usize] = 0);
    let used: Vec<u32> = (0..n_vertices as u32).filter(|&v| number[v as usize] != NONE).collect();
    (0..).zip(&used).for_each(|(k, &v)| number[v as usize] = k);
    faces.as_flattened_mut().iter_mut().for_each(|v| *v = number[*v as usize]);
    used
}

/// The vertices at which a side starts and ends.
pub(super) fn ends(faces: &[[u32; 3]], side: u32) -> [u32; 2] {
    let (face, k) = (faces[side as usize / 3], side as usize % 3);
    [face[k], face[(k + 1) % 3]]
}

/// True if a side runs from the smaller to the larger vertex.
pub(super) fn is_forward(faces: &[[u32; 3]], side: u32) -> bool {
    let [start, end] = ends(faces, side);
    start < end
}

/// True if a face has three different vertices.
pub(super) fn distinct([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

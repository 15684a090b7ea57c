//! Joining of vertices with the same position, without making edges of more than two faces.

use super::incidence::{Incidence, ends};
use super::union_find::UnionFind;
use std::collections::HashSet;

/// An edge in which more than two faces would meet if all vertices at the positions of its ends were joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefusedWeld {
    /// The input's vertices at the positions of its ends, the first of each.
    pub vertices: [u32; 2],
    /// The input's faces that would meet there.
    pub faces: Vec<u32>,
}

/// The faces with their corners at the `first` vertex of the same position, and the edges that prevented this.
///
/// Vertices are joined where their faces are then connected through edges; faces that meet in a point only stay apart. A cluster is a set
/// of positions connected by *crowded* edges, in which joining would make more than two faces meet, or by faces that joining would make
/// collapse or repeat another. In a cluster with a crowded edge, faces are connected through edges of two faces only; if an edge is
/// crowded even so, nothing in the cluster is joined. Edges that had more than two faces before joining are not counted.
pub(super) fn join(faces: &[[u32; 3]], first: &[u32]) -> (Vec<[u32; 3]>, Vec<RefusedWeld>) {
    let n = first.len();
    let joined: Vec<[u32; 3]> = faces.iter().map(|f| f.map(|v| first[v as usize])).collect();
    let whole = Incidence::new(n, &joined);
    let crowds = crowds(faces, &joined, &whole);
    let mut clusters = UnionFind::new(n);
    let lost = (0..faces.len()).zip(repeats(&joined)).filter(|&(f, again)| again || !whole.is_triangle(f));
    for (f, _) in lost {
        let [a, b, c] = joined[f];
        clusters.join(a, b);
        clusters.join(a, c);
    }
    for RefusedWeld { vertices: [a, b], .. } in &crowds {
        clusters.join(*a, *b);
    }
    let mut refused = vec![false; n];
    crowds.iter().for_each(|crowd| refused[clusters.root(crowd.vertices[0]) as usize] = true);

    let mut corners = Incidence::new(n, faces).fans(faces, usize::MAX);
    // Both ends of an edge with more than two faces are in one cluster: some of its faces repeat others, or it is crowded.
    let through =
        |sides: &[u32]| sides.len() <= 2 || !refused[clusters.root(ends(&joined, sides[0])[0]) as usize];
    whole.join_fans(&joined, through, &mut corners);
    let mut least: Vec<u32> = faces.as_flattened().to_vec();
    for (corner, &v) in faces.as_flattened().iter().enumerate() {
        let fan = corners.root(corner as u32) as usize;
        least[fan] = least[fan].min(v);
    }
    let mut welded = joined.clone();
    for corner in 0..3 * faces.len() {
        if whole.is_triangle(corner / 3) || refused[clusters.root(joined[corner / 3][corner % 3]) as usize] {
            welded[corner / 3][corner % 3] = least[corners.root(corner as u32) as usize];
        }
    }
    let mut apart = vec![false; n];
    for crowd in self::crowds(faces, &welded, &Incidence::new(n, &welded)) {
        crowd.vertices.iter().for_each(|&v| apart[clusters.root(first[v as usize]) as usize] = true);
    }
    for corner in 0..3 * faces.len() {
        let cluster = clusters.root(joined[corner / 3][corner % 3]) as usize;
        if refused[cluster] && apart[cluster] {
            welded[corner / 3][corner % 3] = faces[corner / 3][corner % 3];
        }
    }
    (welded, crowds)
}

/// The edges of `joined` with more than two faces, where repeated faces count once, that come from several edges of `before`.
fn crowds(before: &[[u32; 3]], joined: &[[u32; 3]], incidence: &Incidence) -> Vec<RefusedWeld> {
    let again = repeats(joined);
    let mut found = Vec::new();
    for sides in incidence.edges().filter(|sides| sides.len() > 2) {
        let kept: Vec<u32> = sides.iter().copied().filter(|side| !again[*side as usize / 3]).collect();
        let edge = |side: u32| {
            let [a, b] = ends(before, side);
            [a.min(b), a.max(b)]
        };
        if kept.len() > 2 && kept.iter().any(|&side| edge(side) != edge(kept[0])) {
            let [a, b] = ends(joined, kept[0]);
            let faces = kept.iter().map(|side| side / 3).collect();
            found.push(RefusedWeld { vertices: [a.min(b), a.max(b)], faces });
        }
    }
    found
}

/// For each face, true if an earlier one has the same vertices.
pub(super) fn repeats(faces: &[[u32; 3]]) -> Vec<bool> {
    let mut seen = HashSet::with_capacity(faces.len());
    let mut again = |mut face: [u32; 3]| {
        face.sort_unstable();
        !seen.insert(face)
    };
    faces.iter().map(|&face| again(face)).collect()
}

//! Whether a triangle list is oriented, or can be.

use super::defect::Defect;
use crate::mesh::incidence::{Incidence, NONE, ends, is_forward};
use std::collections::VecDeque;

/// Adds the edges at which orientations clash and a Möbius band for each piece that no turning of faces can
/// orient (pieces are joined through edges of two faces). Returns whether there is none of the latter.
pub(super) fn orientation(faces: &[[u32; 3]], incidence: &Incidence, defects: &mut Vec<Defect>) -> bool {
    let forward = |sides: &[u32]| sides.iter().filter(|&&s| is_forward(faces, s)).count();
    let clashes =
        |sides: &&[u32]| sides.len() > 1 && (forward(sides) > 1 || sides.len() - forward(sides) > 1);
    if !incidence.edges().any(|sides| clashes(&sides)) {
        return true;
    }
    let pieces = Pieces::new(faces, incidence);
    for sides in incidence.edges().filter(clashes) {
        if sides.len() == 2 && pieces.one_sided[sides[0] as usize / 3] {
            continue;
        }
        for direction in [true, false] {
            let along: Vec<u32> =
                sides.iter().copied().filter(|&s| is_forward(faces, s) == direction).collect();
            if along.len() > 1 {
                defects.push(Defect::InconsistentOrientation {
                    vertices: ends(faces, along[0]),
                    faces: along.iter().map(|s| s / 3).collect(),
                    meeting: sides.len() as u32,
                });
            }
        }
    }
    let orientable = pieces.strips.is_empty();
    defects.extend(pieces.strips.into_iter().map(|strip| Defect::NonOrientable { strip }));
    orientable
}

struct Pieces {
    /// Per face: whether its piece is one-sided.
    one_sided: Vec<bool>,
    /// A Möbius band of each one-sided piece.
    strips: Vec<Vec<u32>>,
}

impl Pieces {
    /// Orient each piece by breadth-first search from its first face; the first contradiction closes a Möbius
    /// band.
    fn new(faces: &[[u32; 3]], incidence: &Incidence) -> Pieces {
        let partner = incidence.partners(faces.len());
        let mut parent = vec![NONE; faces.len()];
        let mut turned = vec![false; faces.len()];
        let mut pieces = Pieces { one_sided: vec![false; faces.len()], strips: Vec::new() };
        let mut queue = VecDeque::new();
        for first in 0..faces.len() as u32 {
            if parent[first as usize] != NONE {
                continue;
            }
            parent[first as usize] = first;
            queue.push_back(first);
            let mut piece = Vec::new();
            let mut contradiction = None;
            while let Some(f) = queue.pop_front() {
                piece.push(f);
                for side in 3 * f..3 * f + 3 {
                    let other = partner[side as usize];
                    if other == NONE {
                        continue;
                    }
                    let g = other / 3;
                    let same_way = is_forward(faces, side) == is_forward(faces, other);
                    let turn = turned[f as usize] ^ same_way;
                    if parent[g as usize] == NONE {
                        (parent[g as usize], turned[g as usize]) = (f, turn);
                        queue.push_back(g);
                    } else if turned[g as usize] != turn {
                        contradiction = contradiction.or(Some((f, g)));
                    }
                }
            }
            if let Some((f, g)) = contradiction {
                piece.into_iter().for_each(|f| pieces.one_sided[f as usize] = true);
                pieces.strips.push(tree_path(&parent, f, g));
            }
        }
        pieces
    }
}

/// The faces on the way from `f` to `g` in the search tree.
fn tree_path(parent: &[u32], f: u32, g: u32) -> Vec<u32> {
    let to_root = |f: u32| {
        let up = |&f: &u32| Some(parent[f as usize]).filter(|&p| p != f);
        std::iter::successors(Some(f), up).collect::<Vec<_>>()
    };
    let (mut there, mut back) = (to_root(f), to_root(g));
    // What both share is the way from their last common ancestor to the root.
    while let ([.., a, _], [.., b, _]) = (&there[..], &back[..])
        && a == b
    {
        there.pop();
        back.pop();
    }
    back.pop();
    there.extend(back.into_iter().rev());
    there
}

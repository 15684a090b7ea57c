//! Orientation of triangle lists: finds faces that disagree with their neighbours, and one-sided pieces.

use super::defect::Defect;
use crate::mesh::incidence::{Incidence, NONE, ends, is_forward};
/// Adds the edges along which faces run in the same direction, and a Möbius band of each one-sided piece, to the defects (pieces are
/// connected through edges of two faces). Returns true if all pieces are two-sided.
pub(super) fn orientation(faces: &[[u32; 3]], incidence: &Incidence, defects: &mut Vec<Defect>) -> bool {
    let forward = |sides: &[u32]| sides.iter().filter(|&&s| is_forward(faces, s)).count();
    let clashes =
        |sides: &&[u32]| sides.len() > 1 && (forward(sides) > 1 || sides.len() - forward(sides) > 1);
    if !incidence.edges().any(|sides| clashes(&sides)) {
        return true;
    }
    let Orientation { parent, pieces, .. } = Orientation::new(faces, incidence);
    let mut one_sided = vec![false; faces.len()];
    let mut strips = Vec::new();
    for OrientedPiece { faces, clash } in pieces {
        if let Some([f, g]) = clash {
            faces.into_iter().for_each(|f| one_sided[f as usize] = true);
            strips.push(tree_path(&parent, f, g));
        }
    }
    for sides in incidence.edges().filter(clashes) {
        if sides.len() == 2 && one_sided[sides[0] as usize / 3] {
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
    let orientable = strips.is_empty();
    defects.extend(strips.into_iter().map(|strip| Defect::NonOrientable { strip }));
    orientable
}

/// The faces to turn so that neighbours agree, where possible: each piece is searched breadth first from its first face.
pub(in crate::mesh) struct Orientation {
    /// For each face, true if it has to be turned to agree with the first face of its piece.
    pub turned: Vec<bool>,
    pub pieces: Vec<OrientedPiece>,
    /// For each face the face from which it was reached; for the first of a piece itself.
    parent: Vec<u32>,
}

/// A piece: faces that are connected through edges of two faces.
pub(in crate::mesh) struct OrientedPiece {
    pub faces: Vec<u32>,
    /// The first two neighbours found that turning cannot make agree. Together with the paths by which they were reached they close a
    /// Möbius band: the piece is one-sided.
    pub clash: Option<[u32; 2]>,
}

impl Orientation {
    pub fn new(faces: &[[u32; 3]], incidence: &Incidence) -> Orientation {
        let partner = incidence.partners(faces.len());
        let mut parent = vec![NONE; faces.len()];
        let mut turned = vec![false; faces.len()];
        let mut pieces = Vec::new();
        for first in 0..faces.len() as u32 {
            if parent[first as usize] != NONE {
                continue;
            }
            parent[first as usize] = first;
            let mut piece = OrientedPiece { faces: vec![first], clash: None };
            let mut next = 0;
            while let Some(&f) = piece.faces.get(next) {
                next += 1;
                for side in (3 * f..3 * f + 3).filter(|&side| partner[side as usize] != NONE) {
                    let other = partner[side as usize];
                    let g = other / 3;
                    let same_way = is_forward(faces, side) == is_forward(faces, other);
                    let turn = turned[f as usize] ^ same_way;
                    if parent[g as usize] == NONE {
                        (parent[g as usize], turned[g as usize]) = (f, turn);
                        piece.faces.push(g);
                    } else if turned[g as usize] != turn {
                        piece.clash.get_or_insert([f, g]);
                    }
                }
            }
            pieces.push(piece);
        }
        Orientation { turned, pieces, parent }
    }
}

/// The faces on the path from `f` to `g` in the search tree.
fn tree_path(parent: &[u32], f: u32, g: u32) -> Vec<u32> {
    let to_root = |f: u32| {
        let up = |&f: &u32| Some(parent[f as usize]).filter(|&p| p != f);
        std::iter::successors(Some(f), up).collect::<Vec<_>>()
    };
    let (mut there, mut back) = (to_root(f), to_root(g));
    // The two paths to the root share their ends, from the last common ancestor on.
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

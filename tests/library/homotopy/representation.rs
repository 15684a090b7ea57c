//! Random homomorphisms of fundamental groups to symmetric groups, made of faces and edges alone: one permutation per half-edge such that
//! their product around every face is 1. They use no trees, polygons or words.

use crate::surfaces::Random;
use ricci::mesh::{HalfedgeId, Mesh};
use ricci::topology::Word;
use std::collections::VecDeque;

/// A permutation of N things; products act left factor first.
pub type Permutation<const N: usize> = [u8; N];

pub fn identity<const N: usize>() -> Permutation<N> {
    std::array::from_fn(|i| i as u8)
}

pub fn times<const N: usize>(p: Permutation<N>, q: Permutation<N>) -> Permutation<N> {
    p.map(|i| q[usize::from(i)])
}

pub fn inverse<const N: usize>(p: Permutation<N>) -> Permutation<N> {
    let mut q = p;
    (0..N).for_each(|i| q[usize::from(p[i])] = i as u8);
    q
}

fn random<const N: usize>(random: &mut Random) -> Permutation<N> {
    let mut p = identity();
    (1..N).for_each(|i| p.swap(i, random.below(i + 1)));
    p
}

/// A permutation per half-edge.
pub struct Representation<const N: usize>(Vec<Permutation<N>>);

impl<const N: usize> Representation<N> {
    /// Faces are settled from the leaves of a dual spanning tree to its root: each determines the edge towards the root, all other edges
    /// are free. The root is the outside; on a closed surface it is a face, and the choice is repeated until its product is 1, too.
    pub fn random(mesh: &Mesh, dice: &mut Random) -> Representation<N> {
        let (order, towards_root) = dual_tree(mesh);
        loop {
            let mut rho = vec![identity(); mesh.n_halfedges()];
            for e in mesh.edges() {
                let p = random(dice);
                rho[e.halfedge().index()] = p;
                rho[e.halfedge().twin().index()] = inverse(p);
            }
            for &h in &towards_root {
                let rest = times(rho[mesh.next(h).index()], rho[mesh.prev(h).index()]);
                rho[h.index()] = inverse(rest);
                rho[h.twin().index()] = rest;
            }
            let rho = Representation(rho);
            if order.iter().all(|&f| rho.path(&mesh.face_halfedges(f)) == identity()) {
                return rho;
            }
        }
    }

    pub fn path(&self, path: &[HalfedgeId]) -> Permutation<N> {
        path.iter().fold(identity(), |p, h| times(p, self.0[h.index()]))
    }

    /// The image of a word whose generators are these loops.
    pub fn word(&self, loops: &[Vec<HalfedgeId>], word: &Word) -> Permutation<N> {
        let images: Vec<_> = loops.iter().map(|path| self.path(path)).collect();
        let letter = |l: &ricci::topology::Letter| {
            if l.is_inverse() { inverse(images[l.index()]) } else { images[l.index()] }
        };
        word.letters().iter().map(letter).fold(identity(), times)
    }
}

/// All faces, and for each face except the root the half-edge towards the root, leaves first.
fn dual_tree(mesh: &Mesh) -> (Vec<ricci::mesh::FaceId>, Vec<HalfedgeId>) {
    let mut seen = vec![false; mesh.n_faces()];
    let (mut queue, mut towards_root) = (VecDeque::new(), Vec::new());
    if let Some(h) = mesh.halfedges().find(|&h| mesh.is_outside(h)) {
        let f = mesh.face(h.twin()).unwrap();
        seen[f.index()] = true;
        queue.push_back(f);
        towards_root.push(h.twin());
    } else {
        seen[0] = true;
        queue.push_back(mesh.faces().next().unwrap());
    }
    while let Some(f) = queue.pop_front() {
        for h in mesh.face_halfedges(f) {
            if let Some(g) = mesh.face(h.twin())
                && !std::mem::replace(&mut seen[g.index()], true)
            {
                queue.push_back(g);
                towards_root.push(h.twin());
            }
        }
    }
    towards_root.reverse();
    (mesh.faces().collect(), towards_root)
}

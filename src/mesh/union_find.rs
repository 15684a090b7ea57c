//! Disjoint sets of numbers, with path halving.

/// Disjoint sets of 0 … n − 1. The root of a set is its smallest member.
pub(crate) struct UnionFind(Vec<u32>);

impl UnionFind {
    /// The sets of one number each.
    pub fn new(n: usize) -> UnionFind {
        UnionFind((0..n as u32).collect())
    }

    /// The smallest member of the set of `i`.
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    /// Joins the sets of `a` and `b`; false if they were one set already.
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}

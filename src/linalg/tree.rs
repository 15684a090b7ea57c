//! The tree of supernodes, along which factorisation and substitution run: the updates that a supernode leaves for its parent, and the
//! division into subtrees that are processed in parallel.
//!
//! Supernodes are numbered in postorder: the subtree of s has the numbers from `first(s)` to s. A supernode is *heavy* where the work in
//! its subtree is more than a share of the whole; the subtrees below heavy supernodes are joined to *bundles*, which are independent of
//! each other. The division depends on the pattern alone, not on the number of threads.

use super::Pattern;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use std::ops::Range;

/// Share of the whole work in one bundle: with bundles of this size two threads wait little for each other, and few updates wait for
/// their parents at a time.
const SHARE: f64 = 1.0 / 16.0;
/// Work below which dividing costs more than it saves, in floating-point operations; about two milliseconds of one processor.
const LEAST_WORK: f64 = 4e6;
/// Cost of a supernode beside its arithmetic, in the same unit.
const WORK_PER_SUPERNODE: f64 = 2e3;

/// The tree of supernodes, and for each the entries of the matrix that belong to it.
#[derive(Default)]
pub(super) struct SupernodeTree {
    /// For each supernode the first one of its subtree.
    first: Vec<u32>,
    /// For each row below a diagonal block its position among the columns and rows of the parent.
    rows_in_parent: Vec<u32>,
    /// The entries of the matrix by supernodes, each with its position among the supernode's values.
    entry_start: Vec<u32>,
    source: Vec<u32>,
    place: Vec<u32>,
    /// The heavy supernodes and bundles, in the order of the supernodes.
    pub segments: Vec<TreeSegment>,
    /// The largest number of values in waiting updates inside a bundle, and the largest number of rows below a diagonal block there.
    pub most_waiting: usize,
    pub most_below: usize,
    /// Columns of the widest supernode.
    pub widest: usize,
}

/// A heavy supernode, or a bundle.
pub(super) struct TreeSegment {
    pub supernodes: Range<usize>,
    pub is_heavy: bool,
    /// The roots of its subtrees, ascending, each with the number of values and of rows in the updates of the roots before it.
    roots: Vec<(u32, [usize; 2])>,
}

impl TreeSegment {
    /// The position of this root's update among those of the segment.
    pub fn start_of(&self, root: usize) -> usize {
        self.before(root)[0]
    }

    /// The position of this root's update of a right-hand side among those of the segment.
    pub fn first_row_of(&self, root: usize) -> usize {
        self.before(root)[1]
    }

    fn before(&self, root: usize) -> [usize; 2] {
        let k = self.roots.partition_point(|&(r, _)| (r as usize) < root);
        self.roots.get(k).map_or([0; 2], |&(_, before)| before)
    }

    /// True if the updates of the segment are not needed after that of this root. Parents come in the order of their first children, so
    /// the first root is the last one whose parent comes.
    pub fn is_last_needed(&self, root: usize) -> bool {
        self.roots.first().is_some_and(|&(r, _)| r as usize == root)
    }
}

/// The number of entries of a lower triangle with m rows.
pub(super) fn packed(m: usize) -> usize {
    m * (m + 1) / 2
}

/// The supernodes of a symbolic factorisation with their tree.
#[derive(Clone, Copy)]
pub(super) struct Supernodes<'a> {
    pub symbolic: &'a SymbolicSupernodalCholesky<u32>,
    pub tree: &'a SupernodeTree,
}

impl<'a> Supernodes<'a> {
    pub fn columns(&self, s: usize) -> Range<usize> {
        self.symbolic.supernode_begin()[s] as usize..self.symbolic.supernode_end()[s] as usize
    }

    /// Rows below the diagonal block, ascending.
    pub fn rows(&self, s: usize) -> &'a [u32] {
        self.symbolic.supernode(s).pattern()
    }

    /// For each of these rows its position among the columns and rows of the parent, ascending.
    pub fn rows_in_parent(&self, s: usize) -> &'a [u32] {
        let start = self.symbolic.col_ptr_for_row_idx()[s] as usize;
        &self.tree.rows_in_parent[start..start + self.rows(s).len()]
    }

    /// The position of the values of a supernode in the factor.
    pub fn values_start(&self, s: usize) -> usize {
        self.symbolic.col_ptr_for_val()[s] as usize
    }

    /// The first column of a supernode; the number of columns for the one after the last.
    pub fn column_start(&self, s: usize) -> usize {
        if s == 0 { 0 } else { self.symbolic.supernode_end()[s - 1] as usize }
    }

    /// The children, last first.
    pub fn children(&self, s: usize) -> impl Iterator<Item = usize> + Clone + use<'a> {
        let (lowest, tree) = (self.tree.first[s] as usize, self.tree);
        let child = move |next: usize| next.checked_sub(1).filter(|&c| c >= lowest);
        std::iter::successors(child(s), move |&c| child(tree.first[c] as usize))
    }

    /// The segment of a supernode that is heavy or a root of its bundle.
    pub fn segment_of(&self, s: usize) -> usize {
        self.tree.segments.partition_point(|segment| segment.supernodes.end <= s)
    }

    /// The entries of the matrix in a supernode, as (number in the matrix, position among the supernode's values), ascending by position.
    pub fn entries(&self, s: usize) -> (&'a [u32], &'a [u32]) {
        let range = self.tree.entry_start[s] as usize..self.tree.entry_start[s + 1] as usize;
        (&self.tree.source[range.clone()], &self.tree.place[range])
    }
}

impl SupernodeTree {
    /// The tree of a factorisation of matrices with this pattern; `inverse` is the position of each row in the order of elimination.
    /// `None` where the supernodes are not in postorder.
    pub fn new(
        symbolic: &SymbolicSupernodalCholesky<u32>,
        pattern: &Pattern,
        inverse: &[u32],
    ) -> Option<SupernodeTree> {
        let n = symbolic.n_supernodes();
        let [begin, end] = [symbolic.supernode_begin(), symbolic.supernode_end()];
        let mut supernode_of = vec![0u32; pattern.size()];
        (0..n).for_each(|s| supernode_of[begin[s] as usize..end[s] as usize].fill(s as u32));
        let parents: Vec<Option<usize>> = (0..n)
            .map(|s| symbolic.supernode(s).pattern().first().map(|&r| supernode_of[r as usize] as usize))
            .collect();
        let mut first: Vec<u32> = (0..n as u32).collect();
        let mut size = vec![1u32; n];
        for s in 0..n {
            if size[s] != s as u32 - first[s] + 1 {
                return None;
            }
            if let Some(p) = parents[s] {
                first[p] = first[p].min(first[s]);
                size[p] += size[s];
            }
        }
        drop(size);
        let rows_in_parent = rows_in_parent(symbolic, &parents);
        let (entry_start, source, place) = entries(symbolic, pattern, inverse, &supernode_of);
        let segments = segments(symbolic, &parents, &first);
        let mut tree = SupernodeTree {
            first,
            rows_in_parent,
            entry_start,
            source,
            place,
            segments,
            most_waiting: 0,
            most_below: 0,
            widest: 0,
        };
        tree.count(symbolic);
        Some(tree)
    }

    fn count(&mut self, symbolic: &SymbolicSupernodalCholesky<u32>) {
        let below = |s: usize| symbolic.supernode(s).pattern().len();
        let supernodes = Supernodes { symbolic, tree: self };
        let [mut most_waiting, mut most_below, mut widest] = [0; 3];
        for segment in &self.segments {
            let mut waiting = 0;
            for s in segment.supernodes.clone() {
                widest = widest.max(supernodes.columns(s).len());
                if !segment.is_heavy {
                    waiting -= supernodes.children(s).map(|c| packed(below(c))).sum::<usize>();
                    waiting += packed(below(s));
                    (most_waiting, most_below) = (most_waiting.max(waiting), most_below.max(below(s)));
                }
            }
        }
        (self.most_waiting, self.most_below, self.widest) = (most_waiting, most_below, widest);
    }
}

/// [`Supernodes::rows_in_parent`] of all supernodes.
fn rows_in_parent(symbolic: &SymbolicSupernodalCholesky<u32>, parents: &[Option<usize>]) -> Vec<u32> {
    let mut rows_in_parent = vec![0; symbolic.row_idx().len()];
    for (s, &parent) in parents.iter().enumerate() {
        let Some(p) = parent else { continue };
        let (begin, end) = (symbolic.supernode_begin()[p], symbolic.supernode_end()[p]);
        let (rows, mut k) = (symbolic.supernode(p).pattern(), 0);
        let start = symbolic.col_ptr_for_row_idx()[s] as usize;
        for (to, &row) in rows_in_parent[start..].iter_mut().zip(symbolic.supernode(s).pattern()) {
            *to = if row < end {
                row - begin
            } else {
                while rows[k] < row {
                    k += 1;
                }
                end - begin + k as u32
            };
        }
    }
    rows_in_parent
}

/// [`Supernodes::entries`] of all supernodes: their starts, the numbers in the matrix, the positions.
fn entries(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    pattern: &Pattern,
    inverse: &[u32],
    supernode_of: &[u32],
) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let n = symbolic.n_supernodes();
    // Sorted by columns of the factor, then by rows in each column.
    let mut column_end = vec![0u32; pattern.size() + 1];
    let pairs = || {
        (0..pattern.size()).flat_map(|j| {
            let column = pattern.column_start[j] as usize..pattern.column_start[j + 1] as usize;
            column.map(move |k| {
                let (a, b) = (inverse[pattern.row[k] as usize], inverse[j]);
                (k as u32, a.max(b), a.min(b))
            })
        })
    };
    pairs().for_each(|(_, _, j)| column_end[j as usize + 1] += 1);
    (0..pattern.size()).for_each(|j| column_end[j + 1] += column_end[j]);
    let mut entry_start: Vec<u32> =
        (0..n).map(|s| column_end[symbolic.supernode_begin()[s] as usize]).collect();
    entry_start.push(pattern.entries() as u32);
    let mut keyed = vec![(0u32, 0u32); pattern.entries()];
    for (k, i, j) in pairs() {
        let at = &mut column_end[j as usize];
        keyed[*at as usize] = (i, k);
        *at += 1;
    }
    // `column_end[j]` is now the end of column j.
    let (mut source, mut place) = (Vec::with_capacity(keyed.len()), Vec::with_capacity(keyed.len()));
    let mut start = 0;
    for (j, &s) in supernode_of.iter().enumerate() {
        let (s, end) = (s as usize, column_end[j] as usize);
        let column = &mut keyed[start..end];
        column.sort_unstable();
        start = end;
        let (begin, after) = (symbolic.supernode_begin()[s] as usize, symbolic.supernode_end()[s] as usize);
        let rows = symbolic.supernode(s).pattern();
        let (width, mut at) = (after - begin, 0);
        let height = width + rows.len();
        for &(i, k) in &*column {
            let i = i as usize;
            let local = if i < after {
                i - begin
            } else {
                at += rows[at..].partition_point(|&r| (r as usize) < i);
                width + at
            };
            source.push(k);
            place.push(((j - begin) * height + local) as u32);
        }
    }
    (entry_start, source, place)
}

/// The heavy supernodes and bundles, in order.
fn segments(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    parents: &[Option<usize>],
    first: &[u32],
) -> Vec<TreeSegment> {
    let n = parents.len();
    let mut work: Vec<f64> = (0..n).map(|s| work_of(symbolic, s)).collect();
    for s in 0..n {
        if let Some(p) = parents[s] {
            work[p] += work[s];
        }
    }
    let total: f64 = (0..n).filter(|&s| parents[s].is_none()).map(|s| work[s]).sum();
    let most = (SHARE * total).max(LEAST_WORK);
    let mut segments: Vec<TreeSegment> = Vec::new();
    let (mut in_bundle, mut updates_before) = (f64::INFINITY, [0; 2]);
    let mut s = 0;
    while s < n {
        if work[s] > most {
            segments.push(TreeSegment {
                supernodes: s..s + 1,
                is_heavy: true,
                roots: vec![(s as u32, [0; 2])],
            });
            in_bundle = f64::INFINITY;
            s += 1;
            continue;
        }
        // The largest subtree of at most this work that begins here; the supernodes in it begin in their turn.
        let mut root = s;
        while let Some(p) = parents[root].filter(|&p| work[p] <= most && first[p] as usize <= s) {
            root = p;
        }
        match segments.last_mut() {
            Some(bundle) if in_bundle + work[root] <= most => {
                bundle.supernodes.end = root + 1;
                bundle.roots.push((root as u32, updates_before));
            }
            _ => {
                let roots = vec![(root as u32, [0; 2])];
                segments.push(TreeSegment { supernodes: s..root + 1, is_heavy: false, roots });
                (in_bundle, updates_before) = (0.0, [0; 2]);
            }
        }
        let below = symbolic.supernode(root).pattern().len();
        updates_before = [updates_before[0] + packed(below), updates_before[1] + below];
        in_bundle += work[root];
        s = root + 1;
    }
    segments
}

/// The number of floating-point operations at one supernode.
fn work_of(symbolic: &SymbolicSupernodalCholesky<u32>, s: usize) -> f64 {
    let width = symbolic.supernode_end()[s] - symbolic.supernode_begin()[s];
    let (w, m) = (f64::from(width), symbolic.supernode(s).pattern().len() as f64);
    w * (w * w / 3.0 + w * m + m * m) + WORK_PER_SUPERNODE
}

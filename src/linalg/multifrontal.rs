//! The numeric phase of a supernodal Cholesky factorisation, by the multifrontal method \[DR83\], \[Liu92\]: each supernode adds the
//! updates of its children to its entries of the matrix, eliminates its columns, and leaves a lower triangle, its own update, for its
//! parent.
//!
//! Bundles ([`super::tree`]) are factorised in parallel, then the heavy supernodes one after the other, each by several threads. Blocks
//! have fixed sizes and sums a fixed order, so that the bits do not depend on the number of threads.

use super::front::{
    Factored, NotPositiveDefinite, PANEL, eliminate, eliminate_panels, outer, outer_strip, scratch,
};
use super::number::FactorNumber;
use super::pool::{MemoryPool, lock};
use super::tree::{Supernodes, TreeSegment, packed};
use crate::parallel::each;
use faer::MatRef;
use faer::dyn_stack::MemBuffer;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Columns of an update that one thread computes at a time.
const STRIP: usize = 96;

/// Memory of one thread for factorising bundles.
pub(super) struct FrontMemory<T> {
    /// The updates that wait for their parents, packed by columns; the last one on top.
    waiting: Vec<T>,
    /// The update of one supernode as a full square, of which the lower triangle is used.
    front: Vec<T>,
    /// Memory of the dense kernels, for diagonal blocks of up to `widest` columns.
    scratch: MemBuffer,
    widest: usize,
}

/// The update of a child: a lower triangle, packed by columns.
#[derive(Clone, Copy)]
struct FrontUpdate<'a, T> {
    /// Its rows in the front of the parent, ascending.
    rows: &'a [u32],
    values: &'a [T],
}

impl<T: FactorNumber> FrontUpdate<'_, T> {
    /// Adds those columns of the update that are `columns` of the front. `out` holds them, from row `first_row` of the front on, with
    /// `height` rows each.
    fn add(&self, out: &mut [T], columns: std::ops::Range<usize>, first_row: usize, height: usize) {
        let m = self.rows.len();
        let from = self.rows.partition_point(|&r| (r as usize) < columns.start);
        let mut rest = &self.values[packed(m) - packed(m - from)..];
        for (j, &column) in self.rows.iter().enumerate().skip(from) {
            let column = column as usize;
            if column >= columns.end {
                break;
            }
            let (values, after) = rest.split_at(m - j);
            rest = after;
            let out = &mut out[(column - columns.start) * height..][..height];
            for (&row, &value) in self.rows[j..].iter().zip(values) {
                out[row as usize - first_row] += value;
            }
        }
    }
}

/// Overwrites `factor` with the factor of the matrix with these values.
pub(super) fn factor<T: FactorNumber>(
    supernodes: Supernodes<'_>,
    matrix: &[f64],
    factor: &mut [T],
    pool: &MemoryPool<FrontMemory<T>>,
) -> Factored {
    let segments = &supernodes.tree.segments;
    if let [bundle] = &segments[..]
        && !bundle.is_heavy
    {
        return pool.lend(|memory| memory.bundle(supernodes, bundle, matrix, factor));
    }
    let parts = parts(segments, factor, |s| supernodes.values_start(s));
    let failed = AtomicBool::new(false);
    let updates: Vec<Mutex<Vec<T>>> = segments.iter().map(|_| Mutex::default()).collect();
    let (heavy, bundles): (Vec<_>, Vec<_>) = parts.into_iter().partition(|(_, segment, _)| segment.is_heavy);
    each(bundles, |(k, segment, part)| {
        if failed.load(Ordering::Relaxed) {
            return;
        }
        pool.lend(|memory| match memory.bundle(supernodes, segment, matrix, part) {
            Ok(()) => *lock(&updates[k]) = memory.waiting.clone(),
            Err(NotPositiveDefinite) => failed.store(true, Ordering::Relaxed),
        });
    });
    pool.release();
    if failed.into_inner() {
        return Err(NotPositiveDefinite);
    }
    for (k, segment, part) in heavy {
        let update = heavy_supernode(supernodes, segment, matrix, part, &updates)?;
        *lock(&updates[k]) = update;
    }
    Ok(())
}

/// The parts of an array that belong to the segments; `start(s)` is the position of supernode s in it.
pub(super) fn parts<'a, T>(
    segments: &'a [TreeSegment],
    mut rest: &'a mut [T],
    start: impl Fn(usize) -> usize,
) -> Vec<(usize, &'a TreeSegment, &'a mut [T])> {
    let mut parts = Vec::with_capacity(segments.len());
    for (k, segment) in segments.iter().enumerate() {
        let length = start(segment.supernodes.end) - start(segment.supernodes.start);
        let (part, after) = rest.split_at_mut(length);
        parts.push((k, segment, part));
        rest = after;
    }
    parts
}

impl<T: FactorNumber> Default for FrontMemory<T> {
    fn default() -> FrontMemory<T> {
        FrontMemory { waiting: Vec::new(), front: Vec::new(), scratch: scratch::<T>(0), widest: 0 }
    }
}

impl<T: FactorNumber> FrontMemory<T> {
    /// Factorises a bundle into its part of the factor; the updates of its roots are left in order.
    fn bundle(
        &mut self,
        supernodes: Supernodes<'_>,
        bundle: &TreeSegment,
        matrix: &[f64],
        part: &mut [T],
    ) -> Factored {
        self.prepare(supernodes);
        let mut rest = part;
        for s in bundle.supernodes.clone() {
            let length = supernodes.values_start(s + 1) - supernodes.values_start(s);
            let (part, after) = rest.split_at_mut(length);
            rest = after;
            self.supernode(supernodes, s, matrix, part)?;
        }
        Ok(())
    }

    fn prepare(&mut self, supernodes: Supernodes<'_>) {
        let tree = supernodes.tree;
        self.waiting.clear();
        self.waiting.reserve_exact(tree.most_waiting);
        if self.front.len() < tree.most_below * tree.most_below {
            self.front = vec![T::ZERO; tree.most_below * tree.most_below];
        }
        if self.widest < tree.widest {
            (self.scratch, self.widest) = (scratch::<T>(tree.widest), tree.widest);
        }
    }

    /// Factorises one supernode into `own`.
    fn supernode(&mut self, supernodes: Supernodes<'_>, s: usize, matrix: &[f64], own: &mut [T]) -> Factored {
        let FrontMemory { waiting, front, scratch, .. } = self;
        let (width, m) = (supernodes.columns(s).len(), supernodes.rows(s).len());
        let height = width + m;
        let mut top = waiting.len();
        let updates = supernodes.children(s).map(|c| {
            let rows = supernodes.rows_in_parent(c);
            let values = top - packed(rows.len())..top;
            top = values.start;
            (rows, values)
        });
        own.fill(T::ZERO);
        let (sources, places) = supernodes.entries(s);
        sources.iter().zip(places).for_each(|(&k, &at)| own[at as usize] = T::nearest(matrix[k as usize]));
        for (rows, values) in updates {
            FrontUpdate { rows, values: &waiting[values] }.add(own, 0..width, 0, height);
        }
        eliminate(own, width, height, scratch)?;
        if m > 0 {
            let front = &mut front[..m * m];
            outer(own, width, height, front);
            let mut from = waiting.len();
            for c in supernodes.children(s) {
                let rows = supernodes.rows_in_parent(c);
                let values = &waiting[from - packed(rows.len())..from];
                from -= values.len();
                FrontUpdate { rows, values }.add(front, width..height, width, m);
            }
        }
        waiting.truncate(top);
        (0..m).for_each(|j| waiting.extend_from_slice(&front[j * m + j..(j + 1) * m]));
        Ok(())
    }
}

/// Factorises a heavy supernode into its part of the factor, and returns its update, packed.
fn heavy_supernode<T: FactorNumber>(
    supernodes: Supernodes<'_>,
    segment: &TreeSegment,
    matrix: &[f64],
    own: &mut [T],
    updates: &[Mutex<Vec<T>>],
) -> Result<Vec<T>, NotPositiveDefinite> {
    let s = segment.supernodes.start;
    let (width, m) = (supernodes.columns(s).len(), supernodes.rows(s).len());
    let height = width + m;
    let children = ChildUpdates::new(supernodes, s, updates);
    let (sources, places) = supernodes.entries(s);
    each(own.chunks_mut(PANEL * height).enumerate().collect(), |(p, panel)| {
        let start = p * PANEL * height;
        panel.fill(T::ZERO);
        let [from, to] =
            [start, start + panel.len()].map(|x| places.partition_point(|&at| (at as usize) < x));
        for k in from..to {
            panel[places[k] as usize - start] = T::nearest(matrix[sources[k] as usize]);
        }
        let columns = p * PANEL..p * PANEL + panel.len() / height;
        children.updates().for_each(|update| update.add(panel, columns.clone(), 0, height));
    });
    eliminate_panels(own, width, height)?;
    // Strips one after the other, each from the row of its first column on.
    let rows = |p: usize| m - p * STRIP;
    let strips = m.div_ceil(STRIP);
    let size: usize = (0..strips).map(|p| rows(p) * STRIP.min(rows(p))).sum();
    let mut front = vec![T::ZERO; size];
    let below = MatRef::from_column_major_slice(&*own, height, width).subrows(width, m);
    let mut parts = Vec::with_capacity(strips);
    let mut rest = &mut front[..];
    for p in 0..strips {
        let (strip, after) = rest.split_at_mut(rows(p) * STRIP.min(rows(p)));
        parts.push((p * STRIP, strip));
        rest = after;
    }
    each(parts, |(start, strip)| {
        let columns = strip.len() / (m - start);
        outer_strip(below.subrows(start, m - start), columns, strip);
        let first = width + start;
        children.updates().for_each(|update| update.add(strip, first..first + columns, first, m - start));
    });
    drop(children);
    supernodes.children(s).for_each(|c| release(supernodes, c, updates));
    let (mut from, mut end) = (0, 0);
    for j in 0..m {
        let (start, height) = (j / STRIP * STRIP, m - j / STRIP * STRIP);
        front.copy_within(from + j - start..from + height, end);
        from += height;
        end += m - j;
    }
    front.truncate(end);
    front.shrink_to_fit();
    Ok(front)
}

/// The updates of the children of a heavy supernode, last child first.
struct ChildUpdates<'a, T> {
    supernodes: Supernodes<'a>,
    /// The child, the updates of its segment, and where its own starts there.
    held: Vec<(usize, std::sync::MutexGuard<'a, Vec<T>>, Vec<(usize, usize)>)>,
}

impl<'a, T: FactorNumber> ChildUpdates<'a, T> {
    fn new(supernodes: Supernodes<'a>, s: usize, updates: &'a [Mutex<Vec<T>>]) -> ChildUpdates<'a, T> {
        let mut held: Vec<(usize, std::sync::MutexGuard<'a, Vec<T>>, Vec<(usize, usize)>)> = Vec::new();
        for c in supernodes.children(s) {
            let k = supernodes.segment_of(c);
            let start = supernodes.tree.segments[k].start_of(c);
            match held.last_mut() {
                Some((last, _, children)) if *last == k => children.push((c, start)),
                _ => held.push((k, lock(&updates[k]), vec![(c, start)])),
            }
        }
        ChildUpdates { supernodes, held }
    }

    fn updates(&self) -> impl Iterator<Item = FrontUpdate<'_, T>> {
        self.held.iter().flat_map(|(_, values, children)| {
            children.iter().map(|&(c, start)| {
                let rows = self.supernodes.rows_in_parent(c);
                FrontUpdate { rows, values: &values[start..start + packed(rows.len())] }
            })
        })
    }
}

/// Frees the updates of a child's segment, if this is the last one that is needed.
fn release<T>(supernodes: Supernodes<'_>, c: usize, updates: &[Mutex<Vec<T>>]) {
    let k = supernodes.segment_of(c);
    if supernodes.tree.segments[k].is_last_needed(c) {
        *lock(&updates[k]) = Vec::new();
    }
}

//! Forward and backward substitution with a supernodal factor, for one right-hand side. It has kernels of its own: on many small
//! supernodes, calling those of the factorisation costs more than the arithmetic.
//!
//! Bundles (groups of small supernodes, [`super::tree`]) run in parallel, heavy supernodes one after the other, each by several threads.
//! Every sum is formed in a fixed order for any number of threads.

use super::multifrontal::parts;
use super::number::FactorNumber;
use super::pool::{MemoryPool, lock};
use super::tree::{Supernodes, TreeSegment};
use crate::parallel::each;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;
use std::sync::Mutex;

/// Columns that are processed together, so that the other operand is read once for all of them.
const COLUMNS: usize = 4;
/// Columns of a heavy supernode that are solved for together.
const PANEL: usize = 128;
/// Rows below a panel that one thread processes at a time.
const ROWS: usize = 512;
/// Columns of a panel that one thread processes at a time; a multiple of [`COLUMNS`].
const PANEL_COLUMNS: usize = 32;

/// Memory of one thread for substitution in bundles.
#[derive(Default)]
pub(super) struct SubstitutionMemory<T> {
    /// The updates that wait for their parents; the last one on top.
    waiting: Vec<T>,
    /// The values at the columns of one supernode and at the rows below them.
    front: Vec<T>,
}

/// The columns of one supernode of the factor, all with the same rows below their diagonal block.
#[derive(Clone, Copy)]
struct Supernode<'a, T> {
    width: usize,
    /// The values column by column: the diagonal block, then the rows below it.
    values: &'a [T],
    height: usize,
}

/// `x` has its entries in elimination order. Overwrites it with the solution y of `L Lᵀ y = x`; `values` are those of L. `solved`: scratch of
/// the length of `x`, for the solution at heavy supernodes.
pub(super) fn solve<T: FactorNumber>(
    supernodes: Supernodes<'_>,
    values: &[T],
    [x, solved]: [&mut [T]; 2],
    pool: &MemoryPool<SubstitutionMemory<T>>,
) {
    let segments = &supernodes.tree.segments;
    let factor = SupernodalFactor { supernodes, values };
    if let [bundle] = &segments[..]
        && !bundle.is_heavy
    {
        pool.lend(|memory| {
            Arch::new().dispatch(ForwardBundle { factor, bundle, x, memory });
            Arch::new().dispatch(BackwardBundle { factor, bundle, x, solved, memory });
        });
        return;
    }
    let updates: Vec<Mutex<Vec<T>>> = segments.iter().map(|_| Mutex::default()).collect();
    let (mut heavy, mut bundles): (Vec<_>, Vec<_>) = parts(segments, x, |s| supernodes.column_start(s))
        .into_iter()
        .partition(|(_, segment, _)| segment.is_heavy);
    let forward = |(k, segment, part): &mut (usize, &TreeSegment, &mut [T])| {
        let below = pool.lend(|memory| {
            Arch::new().dispatch(ForwardBundle { factor, bundle: segment, x: part, memory });
            memory.waiting.clone()
        });
        *lock(&updates[*k]) = below;
    };
    each(bundles.iter_mut().collect(), forward);
    for (k, segment, part) in &mut heavy {
        let below = factor.forward_heavy(segment.supernodes.start, part, &updates);
        *lock(&updates[*k]) = below;
    }
    drop(updates);
    for (_, segment, part) in heavy.iter_mut().rev() {
        factor.backward_heavy(segment.supernodes.start, part, solved);
    }
    let solved = &*solved;
    each(bundles, |(_, segment, part)| {
        pool.lend(|memory| {
            Arch::new().dispatch(BackwardBundle { factor, bundle: segment, x: part, solved, memory })
        });
    });
}

#[derive(Clone, Copy)]
struct SupernodalFactor<'a, T> {
    supernodes: Supernodes<'a>,
    values: &'a [T],
}

impl<'a, T: FactorNumber> SupernodalFactor<'a, T> {
    fn supernode(&self, s: usize) -> Supernode<'a, T> {
        let [start, end] = [s, s + 1].map(|s| self.supernodes.values_start(s));
        let width = self.supernodes.columns(s).len();
        Supernode { width, values: &self.values[start..end], height: width + self.supernodes.rows(s).len() }
    }

    /// Forward substitution in a heavy supernode; returns the sum to be subtracted from the rows below.
    fn forward_heavy(&self, s: usize, own: &mut [T], updates: &[Mutex<Vec<T>>]) -> Vec<T> {
        let supernode = self.supernode(s);
        let Supernode { width, height, .. } = supernode;
        let mut front = vec![T::ZERO; height];
        for c in self.supernodes.children(s) {
            let (k, rows) = (self.supernodes.segment_of(c), self.supernodes.rows_in_parent(c));
            let start = self.supernodes.tree.segments[k].first_row_of(c);
            add(rows, &lock(&updates[k])[start..start + rows.len()], &mut front);
        }
        own.iter_mut().zip(&front).for_each(|(x, &y)| *x -= y);
        let mut below = front.split_off(width);
        for start in (0..width).step_by(PANEL) {
            let end = width.min(start + PANEL);
            supernode.solve_block(start..end, own);
            let (done, rest) = own.split_at_mut(end);
            // Rows of the diagonal block are updated in place; for those below it, the products are added up.
            let y = &done[start..];
            let minus: Vec<T> = y.iter().map(|&y| -y).collect();
            let own_rows = rest.chunks_mut(ROWS).enumerate().map(|(c, out)| (end + c * ROWS, &*minus, out));
            let rows = below.chunks_mut(ROWS).enumerate().map(|(c, out)| (width + c * ROWS, y, out));
            each(own_rows.chain(rows).collect(), |(row, y, out)| {
                Arch::new().dispatch(AddProduct { supernode, y, columns: start..end, from: row, out });
            });
        }
        below
    }

    /// Backward substitution in a heavy supernode, into `own` and `solved`.
    fn backward_heavy(&self, s: usize, own: &mut [T], solved: &mut [T]) {
        let supernode = self.supernode(s);
        let Supernode { width, height, .. } = supernode;
        let mut all = vec![T::ZERO; height];
        all[..width].copy_from_slice(own);
        all[width..].iter_mut().zip(self.supernodes.rows(s)).for_each(|(y, &row)| *y = solved[row as usize]);
        for start in (0..width.next_multiple_of(PANEL)).step_by(PANEL).rev() {
            let end = width.min(start + PANEL);
            let (own, below) = all.split_at_mut(end);
            each(own[start..].chunks_mut(PANEL_COLUMNS).enumerate().collect(), |(c, out)| {
                let from = start + c * PANEL_COLUMNS;
                let columns = from..from + out.len();
                Arch::new().dispatch(SubtractTransposedProduct {
                    supernode,
                    columns,
                    from: end,
                    y: below,
                    out,
                });
            });
            supernode.solve_block_transposed(start..end, &mut own[start..]);
        }
        own.copy_from_slice(&all[..width]);
        solved[self.supernodes.columns(s)].copy_from_slice(own);
    }
}

/// Adds the update of a child to the columns and rows of its parent.
fn add<T: FactorNumber>(rows: &[u32], values: &[T], front: &mut [T]) {
    rows.iter().zip(values).for_each(|(&r, &x)| front[r as usize] += x);
}

impl<T: FactorNumber> SubstitutionMemory<T> {
    /// Makes room for this many columns and rows of a supernode.
    fn reserve(&mut self, rows: usize) {
        if self.front.len() < rows {
            self.front.resize(rows, T::ZERO);
        }
    }
}

/// Forward substitution in a bundle; `x` holds the right-hand side at its rows. The updates of its roots are left in the memory of the
/// thread.
struct ForwardBundle<'a, T> {
    factor: SupernodalFactor<'a, T>,
    bundle: &'a TreeSegment,
    x: &'a mut [T],
    memory: &'a mut SubstitutionMemory<T>,
}

impl<T: FactorNumber> WithSimd for ForwardBundle<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let ForwardBundle { factor, bundle, x, memory } = self;
        let supernodes = factor.supernodes;
        memory.reserve(supernodes.tree.widest + supernodes.tree.most_below);
        let SubstitutionMemory { waiting, front } = memory;
        waiting.clear();
        let begin = supernodes.column_start(bundle.supernodes.start);
        for s in bundle.supernodes.clone() {
            let Range { start, end } = supernodes.columns(s);
            let own = &mut x[start - begin..end - begin];
            let supernode = factor.supernode(s);
            let front = &mut front[..supernode.height];
            front.fill(T::ZERO);
            let mut top = waiting.len();
            for c in supernodes.children(s) {
                let rows = supernodes.rows_in_parent(c);
                add(rows, &waiting[top - rows.len()..top], front);
                top -= rows.len();
            }
            waiting.truncate(top);
            own.iter_mut().zip(&*front).for_each(|(x, &y)| *x -= y);
            supernode.solve_block(0..own.len(), own);
            let below = &mut front[own.len()..];
            AddProduct { supernode, y: own, columns: 0..own.len(), from: own.len(), out: below }
                .with_simd(simd);
            waiting.extend_from_slice(below);
        }
    }
}

/// Backward substitution in a bundle; `solved` holds the solution at the rows of heavy supernodes.
struct BackwardBundle<'a, T> {
    factor: SupernodalFactor<'a, T>,
    bundle: &'a TreeSegment,
    x: &'a mut [T],
    solved: &'a [T],
    memory: &'a mut SubstitutionMemory<T>,
}

impl<T: FactorNumber> WithSimd for BackwardBundle<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let BackwardBundle { factor, bundle, x, solved, memory } = self;
        let supernodes = factor.supernodes;
        memory.reserve(supernodes.tree.most_below);
        let begin = supernodes.column_start(bundle.supernodes.start);
        for s in bundle.supernodes.clone().rev() {
            let supernode = factor.supernode(s);
            let below = &mut memory.front[..supernode.height - supernode.width];
            for (y, &row) in below.iter_mut().zip(supernodes.rows(s)) {
                let row = row as usize;
                *y = x.get(row - begin).copied().unwrap_or_else(|| solved[row]);
            }
            let Range { start, end } = supernodes.columns(s);
            let own = &mut x[start - begin..end - begin];
            SubtractTransposedProduct {
                supernode,
                columns: 0..own.len(),
                from: own.len(),
                y: below,
                out: own,
            }
            .with_simd(simd);
            supernode.solve_block_transposed(0..own.len(), own);
        }
    }
}

/// `out += A y`, where A has the rows from `from` on of `columns`.
struct AddProduct<'a, T> {
    supernode: Supernode<'a, T>,
    y: &'a [T],
    columns: Range<usize>,
    from: usize,
    out: &'a mut [T],
}

impl<T: FactorNumber> WithSimd for AddProduct<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let AddProduct { supernode, y, columns, from, out } = self;
        let blocks = columns.step_by(COLUMNS).zip(y.chunks(COLUMNS));
        for (j, y) in blocks {
            match *y {
                [a] => add_multiples(simd, supernode.block(j, from), [a], out),
                [a, b] => add_multiples(simd, supernode.block(j, from), [a, b], out),
                [a, b, c] => add_multiples(simd, supernode.block(j, from), [a, b, c], out),
                [a, b, c, d] => add_multiples(simd, supernode.block(j, from), [a, b, c, d], out),
                _ => (),
            }
        }
    }
}

/// `out −= Aᵀ y`, where A has the rows from `from` on of `columns`.
struct SubtractTransposedProduct<'a, T> {
    supernode: Supernode<'a, T>,
    columns: Range<usize>,
    from: usize,
    y: &'a [T],
    out: &'a mut [T],
}

impl<T: FactorNumber> WithSimd for SubtractTransposedProduct<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SubtractTransposedProduct { supernode, columns, from, y, out } = self;
        for (j, out) in columns.step_by(COLUMNS).zip(out.chunks_mut(COLUMNS)) {
            match out.len() {
                1 => subtract(out, products(simd, supernode.block::<1>(j, from), y)),
                2 => subtract(out, products(simd, supernode.block::<2>(j, from), y)),
                3 => subtract(out, products(simd, supernode.block::<3>(j, from), y)),
                _ => subtract(out, products(simd, supernode.block::<COLUMNS>(j, from), y)),
            }
        }
    }
}

fn subtract<T: FactorNumber, const N: usize>(x: &mut [T], what: [T; N]) {
    x.iter_mut().zip(what).for_each(|(x, y)| *x -= y);
}

impl<'a, T: FactorNumber> Supernode<'a, T> {
    /// Column j, from row `from` of the supernode on.
    #[inline(always)]
    fn column(&self, j: usize, from: usize) -> &'a [T] {
        &self.values[j * self.height + from..(j + 1) * self.height]
    }

    /// N columns from the j-th on, from row `from` on.
    #[inline(always)]
    fn block<const N: usize>(&self, j: usize, from: usize) -> [&'a [T]; N] {
        std::array::from_fn(|c| self.column(j + c, from))
    }

    /// Solves L y = own in place at `columns`, L the diagonal block of these columns; the columns before them have been subtracted. `own`
    /// has the entries of the supernode from its first column on.
    #[inline(always)]
    fn solve_block(&self, columns: Range<usize>, own: &mut [T]) {
        for j in columns.clone() {
            let column = &self.column(j, j)[..columns.end - j];
            own[j] /= column[0];
            let y = own[j];
            own[j + 1..columns.end].iter_mut().zip(&column[1..]).for_each(|(x, &l)| *x -= l * y);
        }
    }

    /// Solves Lᵀ y = own in place, L the diagonal block of `columns`; the rows below it have been subtracted. `own` has the entries of
    /// `columns` alone.
    #[inline(always)]
    fn solve_block_transposed(&self, columns: Range<usize>, own: &mut [T]) {
        let start = columns.start;
        for j in columns.clone().rev() {
            let column = &self.column(j, j)[..columns.end - j];
            let (own, after) = own.split_at_mut(j - start + 1);
            let sum = column[1..].iter().zip(&*after).fold(T::ZERO, |sum, (&l, &x)| sum + l * x);
            own[j - start] = (own[j - start] - sum) / column[0];
        }
    }
}

/// Adds columns, each times its entry of y, to `out`.
#[inline(always)]
fn add_multiples<T: FactorNumber, S: Simd, const N: usize>(
    simd: S,
    columns: [&[T]; N],
    y: [T; N],
    out: &mut [T],
) {
    let y = y.map(|y| T::splat(simd, y));
    let columns = columns.map(|column| T::vectors(simd, &column[..out.len()]));
    let (whole, rest) = T::vectors_mut(simd, out);
    let columns_whole = columns.map(|(vectors, _)| &vectors[..whole.len()]);
    for (i, out) in whole.iter_mut().enumerate() {
        for c in 0..N {
            *out = T::multiply_add(simd, columns_whole[c][i], y[c], *out);
        }
    }
    if !rest.is_empty() {
        let mut sum = T::load_partial(simd, rest);
        for c in 0..N {
            sum = T::multiply_add(simd, T::load_partial(simd, columns[c].1), y[c], sum);
        }
        T::store_partial(simd, sum, rest);
    }
}

/// The scalar products of several columns with y, which is read once.
#[inline(always)]
fn products<T: FactorNumber, S: Simd, const N: usize>(simd: S, columns: [&[T]; N], y: &[T]) -> [T; N] {
    let columns = columns.map(|column| T::vectors(simd, &column[..y.len()]));
    let (whole, rest) = T::vectors(simd, y);
    let columns_whole = columns.map(|(vectors, _)| &vectors[..whole.len()]);
    let mut sums = [T::splat(simd, T::ZERO); N];
    for (i, &y) in whole.iter().enumerate() {
        for c in 0..N {
            sums[c] = T::multiply_add(simd, columns_whole[c][i], y, sums[c]);
        }
    }
    if !rest.is_empty() {
        let y = T::load_partial(simd, rest);
        for c in 0..N {
            sums[c] = T::multiply_add(simd, T::load_partial(simd, columns[c].1), y, sums[c]);
        }
    }
    let mut products = [T::ZERO; N];
    for c in 0..N {
        products[c] = T::sum(simd, sums[c]);
    }
    products
}

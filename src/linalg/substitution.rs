//! Forward and backward substitution with a supernodal factor, for one right-hand side: the dense kernels that serve factorisations spend
//! more time on the calls for the many small supernodes than on their numbers.
//!
//! Bundles ([`super::tree`]) run one beside the other, heavy supernodes one after the other, each by several threads. Every sum is formed
//! in one order, whatever the threads.

use super::multifrontal::parts;
use super::number::Number;
use super::pool::{Shelf, lock};
use super::tree::{Segment, Supernodes};
use crate::parallel::each;
use std::ops::Range;
use std::sync::Mutex;

/// Columns that are taken together, so that what they are added to, or multiplied by, is read once for all.
const COLUMNS: usize = 4;
/// Partial sums of a scalar product, added up at its end in one order.
const LANES: usize = 4;
/// Columns of a heavy supernode that are solved for together.
const PANEL: usize = 128;
/// Rows below a panel that one thread takes at a time, and columns of a panel, a multiple of [`COLUMNS`].
const ROWS: usize = 512;
const PANEL_COLUMNS: usize = 32;

/// Memory of a thread that works through bundles.
#[derive(Default)]
pub(super) struct Desk<T> {
    /// What waits for its parent; the last one on top.
    waiting: Vec<T>,
    /// What the rows below one supernode hold.
    below: Vec<T>,
}

/// Columns of the factor with the same rows below their diagonal block.
#[derive(Clone, Copy)]
struct Supernode<'a, T> {
    width: usize,
    /// Column by column: the diagonal block, then the rows below it.
    values: &'a [T],
    height: usize,
}

/// Overwrite `x`, in the order of elimination, with the solution y of `L Lᵀ y = x`. `values`: those of L. `solved` is memory for as many
/// numbers.
pub(super) fn solve<T: Number>(
    supernodes: Supernodes<'_>,
    values: &[T],
    [x, solved]: [&mut [T]; 2],
    memory: &Shelf<Desk<T>>,
) {
    let segments = &supernodes.tree.segments;
    let factor = Factor { supernodes, values };
    if let [bundle] = &segments[..]
        && !bundle.is_heavy
    {
        memory.lend(|desk| {
            factor.forward(bundle, x, desk);
            factor.backward(bundle, x, solved, desk);
        });
        return;
    }
    let handed_on: Vec<Mutex<Vec<T>>> = segments.iter().map(|_| Mutex::default()).collect();
    let (mut heavy, mut bundles): (Vec<_>, Vec<_>) = parts(segments, x, |s| supernodes.column_start(s))
        .into_iter()
        .partition(|(_, segment, _)| segment.is_heavy);
    let forward = |(k, segment, part): &mut (usize, &Segment, &mut [T])| {
        let below = memory.lend(|desk| {
            factor.forward(segment, part, desk);
            desk.waiting.clone()
        });
        *lock(&handed_on[*k]) = below;
    };
    each(bundles.iter_mut().collect(), forward);
    for (k, segment, part) in &mut heavy {
        let below = factor.forward_heavy(segment.supernodes.start, part, &handed_on);
        *lock(&handed_on[*k]) = below;
    }
    drop(handed_on);
    for (_, segment, part) in heavy.iter_mut().rev() {
        factor.backward_heavy(segment.supernodes.start, part, solved);
    }
    let solved = &*solved;
    each(bundles, |(_, segment, part)| {
        memory.lend(|desk| factor.backward(segment, part, solved, desk));
    });
}

#[derive(Clone, Copy)]
struct Factor<'a, T> {
    supernodes: Supernodes<'a>,
    values: &'a [T],
}

impl<'a, T: Number> Factor<'a, T> {
    fn supernode(&self, s: usize) -> Supernode<'a, T> {
        let [start, end] = [s, s + 1].map(|s| self.supernodes.values_start(s));
        let width = self.supernodes.columns(s).len();
        Supernode { width, values: &self.values[start..end], height: width + self.supernodes.rows(s).len() }
    }

    /// Forward substitution in a bundle, of whose rows `x` holds the right-hand side. What its roots subtract from the rows of their
    /// parents waits on the desk.
    fn forward(&self, bundle: &Segment, x: &mut [T], desk: &mut Desk<T>) {
        desk.hold(self.supernodes.tree.most_below);
        let Desk { waiting, below } = desk;
        waiting.clear();
        let begin = self.supernodes.column_start(bundle.supernodes.start);
        for s in bundle.supernodes.clone() {
            let Range { start, end } = self.supernodes.columns(s);
            let own = &mut x[start - begin..end - begin];
            let supernode = self.supernode(s);
            let below = &mut below[..supernode.height - supernode.width];
            below.fill(T::ZERO);
            let mut top = waiting.len();
            for c in self.supernodes.children(s) {
                let rows = self.supernodes.relative(c);
                subtract(rows, &waiting[top - rows.len()..top], own, below);
                top -= rows.len();
            }
            supernode.forward(own);
            supernode.multiply(own, 0..own.len(), own.len(), below);
            waiting.truncate(top);
            waiting.extend_from_slice(below);
        }
    }

    /// Backward substitution in a bundle; `solved` holds the solution in the rows of heavy supernodes.
    fn backward(&self, bundle: &Segment, x: &mut [T], solved: &[T], desk: &mut Desk<T>) {
        desk.hold(self.supernodes.tree.most_below);
        let begin = self.supernodes.column_start(bundle.supernodes.start);
        for s in bundle.supernodes.clone().rev() {
            let supernode = self.supernode(s);
            let below = &mut desk.below[..supernode.height - supernode.width];
            for (y, &row) in below.iter_mut().zip(self.supernodes.rows(s)) {
                let row = row as usize;
                *y = x.get(row - begin).copied().unwrap_or_else(|| solved[row]);
            }
            let Range { start, end } = self.supernodes.columns(s);
            let own = &mut x[start - begin..end - begin];
            supernode.subtract_products(0..own.len(), own.len(), below, own);
            supernode.backward(0..own.len(), own);
        }
    }

    /// Forward substitution in a heavy supernode; returns what it subtracts from the rows below.
    fn forward_heavy(&self, s: usize, own: &mut [T], handed_on: &[Mutex<Vec<T>>]) -> Vec<T> {
        let supernode = self.supernode(s);
        let Supernode { width, height, .. } = supernode;
        let mut below = vec![T::ZERO; height - width];
        for c in self.supernodes.children(s) {
            let (k, rows) = (self.supernodes.segment_of(c), self.supernodes.relative(c));
            let start = self.supernodes.tree.segments[k].first_row_of(c);
            subtract(rows, &lock(&handed_on[k])[start..start + rows.len()], own, &mut below);
        }
        for start in (0..width).step_by(PANEL) {
            let end = width.min(start + PANEL);
            supernode.forward_block(start..end, own);
            let (done, rest) = own.split_at_mut(end);
            // Rows of the diagonal block are subtracted from, those below it added up.
            let y = &done[start..];
            let minus: Vec<T> = y.iter().map(|&y| -y).collect();
            let own_rows = rest.chunks_mut(ROWS).enumerate().map(|(c, out)| (end + c * ROWS, &*minus, out));
            let rows = below.chunks_mut(ROWS).enumerate().map(|(c, out)| (width + c * ROWS, y, out));
            each(own_rows.chain(rows).collect(), |(row, y, out)| supernode.multiply(y, start..end, row, out));
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
                supernode.subtract_products(from..from + out.len(), end, below, out);
            });
            supernode.backward(start..end, &mut own[start..]);
        }
        own.copy_from_slice(&all[..width]);
        solved[self.supernodes.columns(s)].copy_from_slice(own);
    }
}

/// Subtract what a child hands on from the columns of its parent, and add it to what the parent hands on.
fn subtract<T: Number>(rows: &[u32], values: &[T], own: &mut [T], below: &mut [T]) {
    let split = rows.partition_point(|&r| (r as usize) < own.len());
    rows[..split].iter().zip(values).for_each(|(&r, &x)| own[r as usize] -= x);
    let width = own.len();
    rows[split..].iter().zip(&values[split..]).for_each(|(&r, &x)| below[r as usize - width] += x);
}

impl<T: Number> Desk<T> {
    /// Rows below a supernode, at most.
    fn hold(&mut self, rows: usize) {
        if self.below.len() < rows {
            self.below.resize(rows, T::ZERO);
        }
    }
}

impl<T: Number> Supernode<'_, T> {
    /// Column j, from row `from` of the supernode on.
    fn column(&self, j: usize, from: usize) -> &[T] {
        &self.values[j * self.height + from..(j + 1) * self.height]
    }

    /// Overwrite `own` with the solution of `L own = own`, L the diagonal block.
    fn forward(&self, own: &mut [T]) {
        self.forward_block(0..self.width, own);
    }

    /// [`Supernode::forward`] for the diagonal block of some columns, those before having been subtracted.
    fn forward_block(&self, columns: Range<usize>, own: &mut [T]) {
        for j in columns.clone() {
            let column = &self.column(j, j)[..columns.end - j];
            own[j] /= column[0];
            let y = own[j];
            own[j + 1..columns.end].iter_mut().zip(&column[1..]).for_each(|(x, &l)| *x -= l * y);
        }
    }

    /// Overwrite `own` with the solution of `Lᵀ own = own`, L the diagonal block of these columns.
    fn backward(&self, columns: Range<usize>, own: &mut [T]) {
        let start = columns.start;
        for j in columns.clone().rev() {
            let column = &self.column(j, j)[..columns.end - j];
            let (own, after) = own.split_at_mut(j - start + 1);
            let sum = in_order(&column[1..], after);
            own[j - start] = (own[j - start] - sum) / column[0];
        }
    }

    /// Add the rows `from` and on of these columns, times y, to `out`.
    fn multiply(&self, y: &[T], columns: Range<usize>, from: usize, out: &mut [T]) {
        let mut blocks = y.chunks_exact(COLUMNS);
        for (b, y) in blocks.by_ref().enumerate() {
            let [l0, l1, l2, l3] = self.block(columns.start + b * COLUMNS, from);
            for ((((sum, &a), &b), &c), &d) in out.iter_mut().zip(l0).zip(l1).zip(l2).zip(l3) {
                *sum += (a * y[0] + b * y[1]) + (c * y[2] + d * y[3]);
            }
        }
        let rest = blocks.remainder();
        for (j, &y) in (columns.end - rest.len()..).zip(rest) {
            out.iter_mut().zip(self.column(j, from)).for_each(|(sum, &l)| *sum += l * y);
        }
    }

    /// Subtract the scalar products of these columns, from row `from` on, with y.
    fn subtract_products(&self, columns: Range<usize>, from: usize, y: &[T], out: &mut [T]) {
        let whole = columns.len() / COLUMNS;
        for b in 0..whole {
            let sums = dots(self.block(columns.start + b * COLUMNS, from), y);
            out[b * COLUMNS..].iter_mut().zip(sums).for_each(|(x, sum)| *x -= sum);
        }
        for k in COLUMNS * whole..columns.len() {
            out[k] -= dot(self.column(columns.start + k, from), y);
        }
    }

    /// [`COLUMNS`] columns, from row `from` on.
    fn block(&self, j: usize, from: usize) -> [&[T]; COLUMNS] {
        let m = self.height - from;
        [0, 1, 2, 3].map(|c| &self.column(j + c, from)[..m])
    }
}

/// The sum of products, one after the other.
fn in_order<T: Number>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (&a, &b)| sum + a * b)
}

fn dot<T: Number>(a: &[T], b: &[T]) -> T {
    let mut lanes = [T::ZERO; LANES];
    let whole = a.len() / LANES * LANES;
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        (0..LANES).for_each(|k| lanes[k] += a[k] * b[k]);
    }
    let tail = in_order(&a[whole..], &b[whole..]);
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + tail
}

/// [`dot`] of each column with y, which is read once.
fn dots<T: Number>(columns: [&[T]; COLUMNS], y: &[T]) -> [T; COLUMNS] {
    let mut lanes = [[T::ZERO; LANES]; COLUMNS];
    let whole = y.len() / LANES * LANES;
    let [a, b, c, d] = columns.map(|column| column[..whole].chunks_exact(LANES));
    for ((((y, a), b), c), d) in y.chunks_exact(LANES).zip(a).zip(b).zip(c).zip(d) {
        for k in 0..LANES {
            lanes[0][k] += a[k] * y[k];
            lanes[1][k] += b[k] * y[k];
            lanes[2][k] += c[k] * y[k];
            lanes[3][k] += d[k] * y[k];
        }
    }
    let mut sums = lanes.map(|lane| (lane[0] + lane[2]) + (lane[1] + lane[3]));
    for (sum, column) in sums.iter_mut().zip(columns) {
        *sum += in_order(&column[whole..], &y[whole..]);
    }
    sums
}

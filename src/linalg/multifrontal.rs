//! The numbers of a supernodal Cholesky factorisation, by the multifrontal method \[DR83\], \[Liu92\]: each supernode adds what its children
//! hand on to its entries of the matrix, eliminates its columns and hands the rest, a lower triangle, on to its parent.
//!
//! Bundles ([`super::tree`]) are worked through one beside the other, then the heavy supernodes one after the other, each by several
//! threads. Blocks are of fixed sizes and sums are formed in a fixed order, so that the bits do not depend on the number of threads.

use super::cholesky::NotPositiveDefinite;
use super::tree::{Segment, Supernodes, packed};
use crate::parallel::each;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Dense work is divided into blocks here, not by the kernels.
const PARTITION: Par = Par::Seq;
/// Columns of a heavy supernode that are eliminated together.
const PANEL: usize = 96;
/// Rows of a panel that one thread takes at a time.
const ROWS: usize = 192;
/// Columns of what is handed on that one thread takes at a time.
const STRIP: usize = 96;
/// Columns up to which a supernode is eliminated by the loops below: the dense kernels take longer to start.
const NARROW: usize = 16;

pub(super) type Factored = Result<(), NotPositiveDefinite>;

/// Memory of a thread that works through bundles.
pub(super) struct Arena {
    /// What waits for its parent, packed by columns; the last one on top.
    pub waiting: Vec<f64>,
    /// The lower triangle that a supernode hands on, in a square.
    pub front: Vec<f64>,
    scratch: MemBuffer,
}

/// Memory that is kept from one factorisation to the next.
#[derive(Default)]
pub(super) struct Memory {
    arenas: Mutex<Vec<Arena>>,
}

/// What a child hands on: a lower triangle, packed by columns.
#[derive(Clone, Copy)]
struct Update<'a> {
    /// Its rows in the front of the parent, ascending.
    rows: &'a [u32],
    values: &'a [f64],
}

impl Update<'_> {
    /// Add the columns that are `columns` of the front. `out` holds them, from row `first_row` of the front on, `height` rows each.
    fn add(&self, out: &mut [f64], columns: std::ops::Range<usize>, first_row: usize, height: usize) {
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
            for (&row, value) in self.rows[j..].iter().zip(values) {
                out[row as usize - first_row] += value;
            }
        }
    }
}

/// Overwrite `factor` with that of the matrix with these values.
pub(super) fn factor(
    supernodes: Supernodes<'_>,
    matrix: &[f64],
    factor: &mut [f64],
    memory: &Memory,
) -> Factored {
    let segments = &supernodes.tree.segments;
    if let [bundle] = &segments[..]
        && !bundle.is_heavy
    {
        return memory.bundle(supernodes, bundle, matrix, factor).map(|_| ());
    }
    let parts = parts(segments, factor, |s| supernodes.values_start(s));
    let failed = AtomicBool::new(false);
    let handed_on: Vec<Mutex<Vec<f64>>> = segments.iter().map(|_| Mutex::default()).collect();
    let (heavy, bundles): (Vec<_>, Vec<_>) = parts.into_iter().partition(|(_, segment, _)| segment.is_heavy);
    each(bundles, |(k, segment, part)| {
        if failed.load(Ordering::Relaxed) {
            return;
        }
        match memory.bundle(supernodes, segment, matrix, part) {
            Ok(updates) => *lock(&handed_on[k]) = updates,
            Err(NotPositiveDefinite) => failed.store(true, Ordering::Relaxed),
        }
    });
    if failed.into_inner() {
        return Err(NotPositiveDefinite);
    }
    for (k, segment, part) in heavy {
        let update = heavy_supernode(supernodes, segment, matrix, part, &handed_on)?;
        *lock(&handed_on[k]) = update;
    }
    Ok(())
}

/// The part of each segment in an array, `start(s)` telling where those of a supernode start.
pub(super) fn parts<'a>(
    segments: &'a [Segment],
    mut rest: &'a mut [f64],
    start: impl Fn(usize) -> usize,
) -> Vec<(usize, &'a Segment, &'a mut [f64])> {
    let mut parts = Vec::with_capacity(segments.len());
    for (k, segment) in segments.iter().enumerate() {
        let length = start(segment.supernodes.end) - start(segment.supernodes.start);
        let (part, after) = rest.split_at_mut(length);
        parts.push((k, segment, part));
        rest = after;
    }
    parts
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Memory {
    /// What the roots of a bundle hand on, one after the other.
    fn bundle(
        &self,
        supernodes: Supernodes<'_>,
        bundle: &Segment,
        matrix: &[f64],
        part: &mut [f64],
    ) -> Result<Vec<f64>, NotPositiveDefinite> {
        self.lend(supernodes, |arena| {
            let mut rest = part;
            for s in bundle.supernodes.clone() {
                let length = supernodes.values_start(s + 1) - supernodes.values_start(s);
                let (own, after) = rest.split_at_mut(length);
                rest = after;
                arena.supernode(supernodes, s, matrix, own)?;
            }
            Ok(arena.waiting.clone())
        })
    }

    /// Run `work` with the memory of a thread, in which nothing waits.
    pub fn lend<R>(&self, supernodes: Supernodes<'_>, work: impl FnOnce(&mut Arena) -> R) -> R {
        let tree = supernodes.tree;
        let kept = lock(&self.arenas).pop();
        let mut arena = kept.unwrap_or_else(|| Arena {
            waiting: Vec::with_capacity(tree.most_waiting),
            front: vec![0.0; tree.most_below * tree.most_below],
            scratch: scratch(tree.widest),
        });
        arena.waiting.clear();
        let result = work(&mut arena);
        lock(&self.arenas).push(arena);
        result
    }
}

fn scratch(widest: usize) -> MemBuffer {
    MemBuffer::new(cholesky_in_place_scratch::<f64>(widest, PARTITION, Spec::default()))
}

impl Arena {
    fn supernode(
        &mut self,
        supernodes: Supernodes<'_>,
        s: usize,
        matrix: &[f64],
        own: &mut [f64],
    ) -> Factored {
        let Arena { waiting, front, scratch } = self;
        let (width, m) = (supernodes.columns(s).len(), supernodes.rows(s).len());
        let height = width + m;
        let mut top = waiting.len();
        let updates = supernodes.children(s).map(|c| {
            let rows = supernodes.relative(c);
            let values = top - packed(rows.len())..top;
            top = values.start;
            (rows, values)
        });
        own.fill(0.0);
        let (sources, places) = supernodes.entries(s);
        sources.iter().zip(places).for_each(|(&k, &at)| own[at as usize] += matrix[k as usize]);
        for (rows, values) in updates {
            Update { rows, values: &waiting[values] }.add(own, 0..width, 0, height);
        }
        eliminate(own, width, height, scratch)?;
        if m > 0 {
            let front = &mut front[..m * m];
            outer(own, width, height, front);
            let mut from = waiting.len();
            for c in supernodes.children(s) {
                let rows = supernodes.relative(c);
                let values = &waiting[from - packed(rows.len())..from];
                from -= values.len();
                Update { rows, values }.add(front, width..height, width, m);
            }
        }
        waiting.truncate(top);
        (0..m).for_each(|j| waiting.extend_from_slice(&front[j * m + j..(j + 1) * m]));
        Ok(())
    }
}

/// Cholesky factorisation of the diagonal block, and the rows below it divided by its transpose.
fn eliminate(own: &mut [f64], width: usize, height: usize, scratch: &mut MemBuffer) -> Factored {
    if width <= NARROW {
        return eliminate_narrow(own, width, height);
    }
    let own = MatMut::from_column_major_slice_mut(own, height, width);
    let (mut diagonal, below) = own.split_at_row_mut(width);
    diagonal_block(diagonal.as_mut(), scratch)?;
    solve_lower_triangular_in_place(diagonal.as_ref(), below.transpose_mut(), PARTITION);
    Ok(())
}

fn diagonal_block(block: MatMut<'_, f64>, scratch: &mut MemBuffer) -> Factored {
    cholesky_in_place(block, LltRegularization::default(), PARTITION, MemStack::new(scratch), Spec::default())
        .map(|_| ())
        .map_err(|_| NotPositiveDefinite)
}

/// [`eliminate`] column by column.
fn eliminate_narrow(own: &mut [f64], width: usize, height: usize) -> Factored {
    for j in 0..width {
        let (before, column) = own.split_at_mut(j * height);
        let column = &mut column[j..height];
        for earlier in before.chunks_exact(height) {
            let earlier = &earlier[j..];
            let factor = earlier[0];
            column.iter_mut().zip(earlier).for_each(|(x, l)| *x -= factor * l);
        }
        // False also for what is no number.
        if !(column[0] > 0.0) {
            return Err(NotPositiveDefinite);
        }
        let inverse = 1.0 / column[0].sqrt();
        column.iter_mut().for_each(|x| *x *= inverse);
    }
    Ok(())
}

/// The lower triangle of −B Bᵀ into `front`, B being the rows below the diagonal block.
fn outer(own: &[f64], width: usize, height: usize, front: &mut [f64]) {
    let m = height - width;
    let below = MatRef::from_column_major_slice(own, height, width).subrows(width, m);
    triangular::matmul(
        MatMut::from_column_major_slice_mut(front, m, m),
        BlockStructure::TriangularLower,
        Accum::Replace,
        below,
        BlockStructure::Rectangular,
        below.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        PARTITION,
    );
}

/// What a heavy supernode hands on, packed.
fn heavy_supernode(
    supernodes: Supernodes<'_>,
    segment: &Segment,
    matrix: &[f64],
    own: &mut [f64],
    handed_on: &[Mutex<Vec<f64>>],
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let s = segment.supernodes.start;
    let (width, m) = (supernodes.columns(s).len(), supernodes.rows(s).len());
    let height = width + m;
    let children = Children::new(supernodes, s, handed_on);
    let (sources, places) = supernodes.entries(s);
    each(own.chunks_mut(PANEL * height).enumerate().collect(), |(p, panel)| {
        let start = p * PANEL * height;
        panel.fill(0.0);
        let [from, to] =
            [start, start + panel.len()].map(|x| places.partition_point(|&at| (at as usize) < x));
        for k in from..to {
            panel[places[k] as usize - start] += matrix[sources[k] as usize];
        }
        let columns = p * PANEL..p * PANEL + panel.len() / height;
        children.updates().for_each(|update| update.add(panel, columns.clone(), 0, height));
    });
    eliminate_panels(own, width, height)?;
    let mut front = vec![0.0; m * m];
    let below = MatRef::from_column_major_slice(&*own, height, width).subrows(width, m);
    each(front.chunks_mut(STRIP * m.max(1)).enumerate().collect(), |(p, strip)| {
        let columns = strip.len() / m;
        let start = p * STRIP;
        outer_strip(below, start, MatMut::from_column_major_slice_mut(strip, m, columns));
        let columns = width + start..width + start + columns;
        children.updates().for_each(|update| update.add(strip, columns.clone(), width, m));
    });
    drop(children);
    supernodes.children(s).for_each(|c| release(supernodes, c, handed_on));
    let mut end = 0;
    for j in 0..m {
        front.copy_within(j * m + j..(j + 1) * m, end);
        end += m - j;
    }
    front.truncate(end);
    Ok(front)
}

/// The lower part of columns `start` and on of −B Bᵀ.
fn outer_strip(below: MatRef<'_, f64>, start: usize, strip: MatMut<'_, f64>) {
    let (m, columns) = (strip.nrows(), strip.ncols());
    let (top, rest) = strip.split_at_row_mut(start).1.split_at_row_mut(columns);
    let own = below.subrows(start, columns);
    triangular::matmul(
        top,
        BlockStructure::TriangularLower,
        Accum::Replace,
        own,
        BlockStructure::Rectangular,
        own.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        PARTITION,
    );
    let after = start + columns;
    matmul(rest, Accum::Replace, below.subrows(after, m - after), own.transpose(), -1.0, PARTITION);
}

/// [`eliminate`] by panels, each by several threads.
fn eliminate_panels(own: &mut [f64], width: usize, height: usize) -> Factored {
    let mut scratch = scratch(PANEL);
    for start in (0..width).step_by(PANEL) {
        let columns = PANEL.min(width - start);
        let (done, panel) = own.split_at_mut(start * height);
        let done = MatRef::from_column_major_slice(&*done, height, start);
        let panel = MatMut::from_column_major_slice_mut(&mut panel[..columns * height], height, columns);
        let (mut diagonal, below) = panel.split_at_row_mut(start).1.split_at_row_mut(columns);
        let factors = done.subrows(start, columns).transpose();
        let subtract = |block: MatMut<'_, f64>, row: usize| {
            let rows = done.subrows(row, block.nrows());
            matmul(block, Accum::Add, rows, factors, -1.0, PARTITION);
        };
        if start > 0 {
            subtract(diagonal.as_mut(), start);
        }
        diagonal_block(diagonal.as_mut(), &mut scratch)?;
        let diagonal = diagonal.as_ref();
        each(row_blocks(below, start + columns), |(row, mut block)| {
            if start > 0 {
                subtract(block.as_mut(), row);
            }
            solve_lower_triangular_in_place(diagonal, block.transpose_mut(), PARTITION);
        });
    }
    Ok(())
}

/// Blocks of [`ROWS`] rows, each with the number of its first row, that of the first being `row`.
fn row_blocks(mut matrix: MatMut<'_, f64>, mut row: usize) -> Vec<(usize, MatMut<'_, f64>)> {
    let mut blocks = Vec::new();
    while matrix.nrows() > 0 {
        let rows = ROWS.min(matrix.nrows());
        let (block, rest) = matrix.split_at_row_mut(rows);
        blocks.push((row, block));
        (matrix, row) = (rest, row + rows);
    }
    blocks
}

/// What the children of a heavy supernode have handed on, last child first.
struct Children<'a> {
    supernodes: Supernodes<'a>,
    /// Child, what holds its update, where it starts there.
    held: Vec<(usize, std::sync::MutexGuard<'a, Vec<f64>>, Vec<(usize, usize)>)>,
}

impl<'a> Children<'a> {
    fn new(supernodes: Supernodes<'a>, s: usize, handed_on: &'a [Mutex<Vec<f64>>]) -> Children<'a> {
        let mut held: Vec<(usize, std::sync::MutexGuard<'a, Vec<f64>>, Vec<(usize, usize)>)> = Vec::new();
        for c in supernodes.children(s) {
            let k = supernodes.segment_of(c);
            let start = supernodes.tree.segments[k].start_of(c);
            match held.last_mut() {
                Some((last, _, children)) if *last == k => children.push((c, start)),
                _ => held.push((k, lock(&handed_on[k]), vec![(c, start)])),
            }
        }
        Children { supernodes, held }
    }

    fn updates(&self) -> impl Iterator<Item = Update<'_>> {
        self.held.iter().flat_map(|(_, values, children)| {
            children.iter().map(|&(c, start)| {
                let rows = self.supernodes.relative(c);
                Update { rows, values: &values[start..start + packed(rows.len())] }
            })
        })
    }
}

/// Release what holds the update of a child, where it is the last that is needed from there.
fn release(supernodes: Supernodes<'_>, c: usize, handed_on: &[Mutex<Vec<f64>>]) {
    let k = supernodes.segment_of(c);
    if supernodes.tree.segments[k].is_last_needed(c) {
        *lock(&handed_on[k]) = Vec::new();
    }
}

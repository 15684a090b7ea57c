//! Dense elimination of the columns of one supernode and its update of the parent, by faer's kernels on blocks of fixed sizes.

use super::number::FactorNumber;
use crate::parallel::each;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};

/// Kernels of faer run on one thread: dense work is divided into blocks here.
const PARTITION: Par = Par::Seq;
/// Columns of a heavy supernode that are eliminated together.
pub(super) const PANEL: usize = 96;
/// Rows of a panel that one thread takes at a time.
const ROWS: usize = 192;
/// Columns up to which a supernode is eliminated by the loops below: the dense kernels take longer to start.
const NARROW: usize = 16;

/// The matrix is not positive definite to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositiveDefinite;

pub(super) type Factored = Result<(), NotPositiveDefinite>;

/// Memory for the factorisation of diagonal blocks of up to so many columns.
pub(super) fn scratch<T: FactorNumber>(widest: usize) -> MemBuffer {
    MemBuffer::new(cholesky_in_place_scratch::<T>(widest, PARTITION, Spec::default()))
}

/// Cholesky factorisation of the diagonal block; the rows below it are divided by its transpose.
pub(super) fn eliminate<T: FactorNumber>(
    own: &mut [T],
    width: usize,
    height: usize,
    scratch: &mut MemBuffer,
) -> Factored {
    if width <= NARROW {
        return eliminate_narrow(own, width, height);
    }
    let own = MatMut::from_column_major_slice_mut(own, height, width);
    let (mut diagonal, below) = own.split_at_row_mut(width);
    diagonal_block(diagonal.as_mut(), scratch)?;
    solve_lower_triangular_in_place(diagonal.as_ref(), below.transpose_mut(), PARTITION);
    Ok(())
}

fn diagonal_block<T: FactorNumber>(block: MatMut<'_, T>, scratch: &mut MemBuffer) -> Factored {
    cholesky_in_place(block, LltRegularization::default(), PARTITION, MemStack::new(scratch), Spec::default())
        .map(|_| ())
        .map_err(|_| NotPositiveDefinite)
}

/// [`eliminate`] column by column, for narrow supernodes.
fn eliminate_narrow<T: FactorNumber>(own: &mut [T], width: usize, height: usize) -> Factored {
    for j in 0..width {
        let (before, column) = own.split_at_mut(j * height);
        let column = &mut column[j..height];
        for earlier in before.chunks_exact(height) {
            let earlier = &earlier[j..];
            let factor = earlier[0];
            column.iter_mut().zip(earlier).for_each(|(x, &l)| *x -= factor * l);
        }
        // False also for NaN.
        let is_positive = column[0] > T::ZERO;
        if !is_positive {
            return Err(NotPositiveDefinite);
        }
        let inverse = T::ONE / column[0].root();
        column.iter_mut().for_each(|x| *x *= inverse);
    }
    Ok(())
}

/// Writes the lower triangle of −B Bᵀ to `front`, B being the rows below the diagonal block.
pub(super) fn outer<T: FactorNumber>(own: &[T], width: usize, height: usize, front: &mut [T]) {
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
        -T::ONE,
        PARTITION,
    );
}

/// The lower part of the first columns of −B Bᵀ.
pub(super) fn outer_strip<T: FactorNumber>(below: MatRef<'_, T>, columns: usize, strip: &mut [T]) {
    let m = below.nrows();
    let strip = MatMut::from_column_major_slice_mut(strip, m, columns);
    let (top, rest) = strip.split_at_row_mut(columns);
    let own = below.subrows(0, columns);
    triangular::matmul(
        top,
        BlockStructure::TriangularLower,
        Accum::Replace,
        own,
        BlockStructure::Rectangular,
        own.transpose(),
        BlockStructure::Rectangular,
        -T::ONE,
        PARTITION,
    );
    matmul(rest, Accum::Replace, below.subrows(columns, m - columns), own.transpose(), -T::ONE, PARTITION);
}

/// [`eliminate`] by panels, each of which several threads share.
pub(super) fn eliminate_panels<T: FactorNumber>(own: &mut [T], width: usize, height: usize) -> Factored {
    let mut scratch = scratch::<T>(PANEL);
    for start in (0..width).step_by(PANEL) {
        let columns = PANEL.min(width - start);
        let (done, panel) = own.split_at_mut(start * height);
        let done = MatRef::from_column_major_slice(&*done, height, start);
        let panel = MatMut::from_column_major_slice_mut(&mut panel[..columns * height], height, columns);
        let (mut diagonal, below) = panel.split_at_row_mut(start).1.split_at_row_mut(columns);
        let factors = done.subrows(start, columns).transpose();
        let subtract = |block: MatMut<'_, T>, row: usize| {
            let rows = done.subrows(row, block.nrows());
            matmul(block, Accum::Add, rows, factors, -T::ONE, PARTITION);
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

/// The blocks of [`ROWS`] rows, each with the number of its first row; the first one starts at `row`.
fn row_blocks<T>(mut matrix: MatMut<'_, T>, mut row: usize) -> Vec<(usize, MatMut<'_, T>)> {
    let mut blocks = Vec::new();
    while matrix.nrows() > 0 {
        let rows = ROWS.min(matrix.nrows());
        let (block, rest) = matrix.split_at_row_mut(rows);
        blocks.push((row, block));
        (matrix, row) = (rest, row + rows);
    }
    blocks
}

//! Forward and backward substitution with a supernodal factor, for one right-hand side: the dense kernels that serve factorisations spend
//! more time on the calls for the many small supernodes than on their numbers.

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Columns that are taken together, so that what they are added to, or multiplied by, is read once for all.
const COLUMNS: usize = 4;
/// Partial sums of a scalar product, added up at its end in one order.
const LANES: usize = 4;

/// Columns of the factor with the same rows below their diagonal block.
struct Supernode<'a> {
    start: usize,
    width: usize,
    /// Rows below the diagonal block, ascending.
    rows: &'a [u32],
    /// Column by column: the diagonal block, then the rows below it.
    values: &'a [f64],
}

/// Overwrite `x`, in the order of elimination, with the solution y of `L Lᵀ y = x`. `values`: those of L. `below` is memory for as many
/// numbers as L has rows.
pub(super) fn solve(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    values: &[f64],
    x: &mut [f64],
    below: &mut [f64],
) {
    let supernode = |s: usize| {
        let start = symbolic.supernode_begin()[s] as usize;
        let [begin, end] = [s, s + 1].map(|s| symbolic.col_ptr_for_val()[s] as usize);
        Supernode {
            start,
            width: symbolic.supernode_end()[s] as usize - start,
            rows: symbolic.supernode(s).pattern(),
            values: &values[begin..end],
        }
    };
    let n = symbolic.n_supernodes();
    (0..n).for_each(|s| supernode(s).forward(x, below));
    (0..n).rev().for_each(|s| supernode(s).backward(x, below));
}

impl Supernode<'_> {
    /// Column j, from row `from` of the supernode on.
    fn column(&self, j: usize, from: usize) -> &[f64] {
        let height = self.width + self.rows.len();
        &self.values[j * height + from..(j + 1) * height]
    }

    fn forward(&self, x: &mut [f64], below: &mut [f64]) {
        let own = &mut x[self.start..self.start + self.width];
        for j in 0..self.width {
            let column = &self.column(j, j)[..self.width - j];
            own[j] /= column[0];
            let y = own[j];
            own[j + 1..].iter_mut().zip(&column[1..]).for_each(|(x, l)| *x -= l * y);
        }
        let below = &mut below[..self.rows.len()];
        below.fill(0.0);
        let mut blocks = own.chunks_exact(COLUMNS);
        for (b, y) in blocks.by_ref().enumerate() {
            let [l0, l1, l2, l3] = self.block(b);
            for ((((sum, a), b), c), d) in below.iter_mut().zip(l0).zip(l1).zip(l2).zip(l3) {
                *sum += (a * y[0] + b * y[1]) + (c * y[2] + d * y[3]);
            }
        }
        let rest = blocks.remainder();
        for (j, y) in (self.width - rest.len()..).zip(rest) {
            below.iter_mut().zip(self.column(j, self.width)).for_each(|(sum, l)| *sum += l * y);
        }
        self.rows.iter().zip(below).for_each(|(&i, sum)| x[i as usize] -= *sum);
    }

    fn backward(&self, x: &mut [f64], below: &mut [f64]) {
        let below = &mut below[..self.rows.len()];
        self.rows.iter().zip(&mut *below).for_each(|(&i, y)| *y = x[i as usize]);
        let own = &mut x[self.start..self.start + self.width];
        let whole = self.width / COLUMNS;
        for b in 0..whole {
            let sums = dots(self.block(b), below);
            own[b * COLUMNS..].iter_mut().zip(sums).for_each(|(x, sum)| *x -= sum);
        }
        for j in COLUMNS * whole..self.width {
            own[j] -= dot(self.column(j, self.width), below);
        }
        for j in (0..self.width).rev() {
            let column = &self.column(j, j)[..self.width - j];
            let sum: f64 = column[1..].iter().zip(&own[j + 1..]).map(|(l, y)| l * y).sum();
            own[j] = (own[j] - sum) / column[0];
        }
    }

    /// What the b-th [`COLUMNS`] columns have below the diagonal block.
    fn block(&self, b: usize) -> [&[f64]; COLUMNS] {
        let m = self.rows.len();
        [0, 1, 2, 3].map(|c| &self.column(b * COLUMNS + c, self.width)[..m])
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let whole = a.len() / LANES * LANES;
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        (0..LANES).for_each(|k| lanes[k] += a[k] * b[k]);
    }
    let tail: f64 = a[whole..].iter().zip(&b[whole..]).map(|(a, b)| a * b).sum();
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + tail
}

/// [`dot`] of each column with y, which is read once.
fn dots(columns: [&[f64]; COLUMNS], y: &[f64]) -> [f64; COLUMNS] {
    let mut lanes = [[0.0; LANES]; COLUMNS];
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
        *sum += column[whole..].iter().zip(&y[whole..]).map(|(l, y)| l * y).sum::<f64>();
    }
    sums
}

//! Tests of factorisations.

use super::*;
use crate::parallel::Pool;

/// Five-point Laplacian plus the identity on a k×k grid.
fn grid(k: usize) -> (Pattern, Vec<f64>) {
    let id = |x: usize, y: usize| (y * k + x) as u32;
    let mut pairs = Vec::new();
    for y in 0..k {
        for x in 0..k {
            if x + 1 < k {
                pairs.push((id(x, y), id(x + 1, y)));
            }
            if y + 1 < k {
                pairs.push((id(x, y), id(x, y + 1)));
            }
        }
    }
    let pattern = Pattern::new(k * k, &pairs).unwrap();
    let mut values = vec![0.0; pattern.entries()];
    (0..k * k).for_each(|j| values[pattern.diagonal(j)] = 1.0);
    for (i, j) in pairs {
        values[pattern.position(i as usize, j as usize).unwrap()] = -1.0;
        values[pattern.diagonal(i as usize)] += 1.0;
        values[pattern.diagonal(j as usize)] += 1.0;
    }
    (pattern, values)
}

#[test]
fn blocks_are_eliminated_in_an_order_of_their_own_pattern() {
    let (blocks, of_blocks) = grid(7);
    let (pattern, mut cholesky) = Cholesky::analyse_blocks(&blocks, 3).unwrap();
    // A block is its number on the diagonal, and 0.1 of it elsewhere.
    let mut pairs = Vec::new();
    let mut entries = Vec::new();
    for (i, j, x) in (Symmetric { pattern: &blocks, values: &of_blocks }).entries() {
        for (c, d) in (0..3).flat_map(|c| (0..3).map(move |d| (c, d))).filter(|(c, d)| i != j || c >= d) {
            pairs.push(((3 * i + c) as u32, (3 * j + d) as u32));
            entries.push((3 * i + c, 3 * j + d, if c == d { x } else { 0.1 * x }));
        }
    }
    assert_eq!(pattern, Pattern::new(3 * blocks.size(), &pairs).unwrap());
    let mut values = vec![0.0; pattern.entries()];
    entries.iter().for_each(|&(i, j, x)| values[pattern.position(i, j).unwrap()] = x);
    let matrix = Symmetric { pattern: &pattern, values: &values };
    cholesky.factor(matrix).unwrap();
    let right: Vec<f64> = (0..pattern.size()).map(|i| (i as f64).sin()).collect();
    let (mut x, mut residual) = (right.clone(), right.clone());
    cholesky.solve(&mut x);
    matrix.residual(&x, &right, &mut residual);
    assert!(residual.iter().all(|r| r.abs() < 1e-13), "{residual:?}");
}

#[test]
fn solution_leaves_no_residual() {
    for k in [0, 1, 7, 40] {
        let (pattern, values) = grid(k);
        let matrix = Symmetric { pattern: &pattern, values: &values };
        let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
        let mut cholesky = Cholesky::analyse(&pattern).unwrap();
        cholesky.factor(matrix).unwrap();
        let (mut x, mut r) = (b.clone(), b.clone());
        cholesky.solve(&mut x);
        matrix.residual(&x, &b, &mut r);
        assert!(r.iter().all(|r| r.abs() < 1e-13));
        let mut columns = [b.clone(), b.iter().map(|x| 2.0 * x).collect()].concat();
        cholesky.solve_columns(&mut columns).unwrap();
        let [once, twice] = [0, 1].map(|c| &columns[c * k * k..(c + 1) * k * k]);
        assert!((0..k * k).all(|i| (once[i] - x[i]).abs() < 1e-13 && twice[i] == 2.0 * once[i]));
    }
}

#[test]
fn a_factor_in_single_precision_solves_to_seven_digits_with_the_same_bits_for_any_threads() {
    let k = 150;
    let (pattern, values) = grid(k);
    let matrix = Symmetric { pattern: &pattern, values: &values };
    let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
    let mut in_f64 = Cholesky::analyse(&pattern).unwrap();
    in_f64.factor(matrix).unwrap();
    let mut exact = b.clone();
    in_f64.solve(&mut exact);
    let mut single: Cholesky<f32> = in_f64.held_in().unwrap();
    let mut solved = |threads| {
        let mut x = b.clone();
        Pool::new(threads).unwrap().run(|| {
            single.factor(matrix).unwrap();
            single.solve(&mut x);
        });
        x
    };
    let first = solved(1);
    let apart = first.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(apart > 0.0 && apart < 1e-6, "{apart:e}");
    assert!(solved(2) == first && solved(8) == first);
    // And back to f64.
    let mut in_f64: Cholesky = single.held_in().unwrap();
    in_f64.factor(matrix).unwrap();
    let mut x = b.clone();
    in_f64.solve(&mut x);
    assert!(x == exact);
}

#[test]
fn an_indefinite_matrix_is_refused() {
    let (pattern, mut values) = grid(9);
    values[pattern.diagonal(40)] = -1.0;
    let mut cholesky = Cholesky::analyse(&pattern).unwrap();
    assert_eq!(cholesky.factor(Symmetric { pattern: &pattern, values: &values }), Err(NotPositiveDefinite));
}

/// The solution by faer's own factorisation, in its order.
fn by_faer(pattern: &Pattern, values: &[f64], b: &[f64]) -> Vec<f64> {
    use faer::linalg::cholesky::llt::factor::LltRegularization;
    use faer::sparse::SparseColMatRef;
    use faer::{Par, Spec};
    let symbolic = analysis(pattern, SymmetricOrdering::Amd).unwrap();
    let mut factor = vec![0.0; symbolic.len_val()];
    let need = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
    let matrix = SparseColMatRef::new(structure(pattern), values);
    let mut memory = MemBuffer::new(need.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)));
    let stack = MemStack::new(&mut memory);
    let (regular, spec) = (LltRegularization::default(), Spec::default());
    symbolic.factorize_numeric_llt(&mut factor, matrix, Side::Lower, regular, Par::Seq, stack, spec).unwrap();
    let mut x = b.to_vec();
    LltRef::new(&symbolic, &factor).solve_in_place_with_conj(
        Conj::No,
        MatMut::from_column_major_slice_mut(&mut x, b.len(), 1),
        Par::Seq,
        MemStack::new(&mut memory),
    );
    x
}

#[test]
fn the_solution_is_that_of_faer_and_has_the_same_bits_for_any_threads() {
    // The larger ones have several bundles and heavy supernodes of several panels.
    for k in [3, 30, 90, 220] {
        let (pattern, values) = grid(k);
        let matrix = Symmetric { pattern: &pattern, values: &values };
        let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
        let expected = by_faer(&pattern, &values, &b);
        let mut cholesky = Cholesky::analyse(&pattern).unwrap();
        assert!(k < 90 || cholesky.tree.segments.iter().filter(|s| s.is_heavy).count() > 2);
        let mut before: Option<(Vec<f64>, Vec<f64>)> = None;
        for threads in [1, 2, 8, 2] {
            let mut x = b.clone();
            Pool::new(threads).unwrap().run(|| {
                cholesky.factor(matrix).unwrap();
                cholesky.solve(&mut x);
            });
            assert!(x.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-13));
            let now = (cholesky.factor.clone(), x);
            assert!(before.as_ref().is_none_or(|before| *before == now), "{k}, {threads} threads");
            before = Some(now);
        }
    }
}

/// Pairs of rows: a star, a path, a dense block, separate pieces, and edges all over.
fn graphs() -> [(usize, Vec<(u32, u32)>); 5] {
    let star = (1..30_000).map(|i| (0, i)).collect();
    let path = (1..30_000).map(|i| (i - 1, i)).collect();
    let dense = (0..500).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let pieces = (0..20_000).filter(|i| i % 10 > 2).map(|i| (i, i - i % 10)).collect();
    let all_over =
        (1..2_000u32).flat_map(|i| [(i, i * 7919 % 2_000), (i, i * i % 1_999), (i, i - 1)]).collect();
    [(30_000, star), (30_000, path), (500, dense), (20_000, pieces), (2_000, all_over)]
}

#[test]
fn matrices_of_every_shape_are_solved_with_the_same_bits_for_any_threads() {
    let pools = [1, 2].map(|threads| Pool::new(threads).unwrap());
    for (k, (n, pairs)) in graphs().into_iter().enumerate() {
        let pattern = Pattern::new(n, &pairs).unwrap();
        // Each pair counts once, by its place among the entries.
        let mut values = vec![0.0; pattern.entries()];
        for (i, j) in pairs.into_iter().map(|(i, j)| (i as usize, j as usize)).filter(|(i, j)| i != j) {
            let at = pattern.position(i, j).unwrap();
            if values[at] == 0.0 {
                values[at] = -1.0;
                [i, j].into_iter().for_each(|i| values[pattern.diagonal(i)] += 1.0);
            }
        }
        (0..n).for_each(|i| values[pattern.diagonal(i)] += 0.5);
        let matrix = Symmetric { pattern: &pattern, values: &values };
        let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut cholesky = Cholesky::analyse(&pattern).unwrap();
        let [first, second] = [0, 1].map(|p| {
            let mut x = b.clone();
            pools[p].run(|| {
                cholesky.factor(matrix).unwrap();
                cholesky.solve(&mut x);
            });
            x
        });
        assert!(first == second, "graph {k}");
        let mut left = b.clone();
        matrix.residual(&first, &b, &mut left);
        assert!(left.iter().all(|r| r.abs() < 1e-11), "graph {k}");
    }
}

fn analysis_in(pattern: &Pattern, forward: &[u32]) -> SymbolicCholesky<u32> {
    let mut inverse = vec![0; forward.len()];
    (0..).zip(forward).for_each(|(k, &i)| inverse[i as usize] = k);
    let order = PermRef::new_checked(forward, &inverse, forward.len());
    analysis(pattern, SymmetricOrdering::Custom(order)).unwrap()
}

#[test]
fn an_order_that_is_no_postorder_serves_as_well() {
    let k = 40;
    let (pattern, values) = grid(k);
    // Every row once, by steps that have no divisor in common with their number.
    let mut forward: Vec<u32> = (0..(k * k) as u32).map(|i| i * 997 % (k * k) as u32).collect();
    forward.reverse();
    assert!(tree(&analysis_in(&pattern, &forward), &pattern).is_none());
    let mut cholesky = Cholesky::with_postorder(&pattern, &forward).unwrap();
    let matrix = Symmetric { pattern: &pattern, values: &values };
    cholesky.factor(matrix).unwrap();
    let b: Vec<f64> = (0..k * k).map(|i| (i as f64).cos()).collect();
    let (mut x, mut left) = (b.clone(), b.clone());
    cholesky.solve(&mut x);
    matrix.residual(&x, &b, &mut left);
    assert!(left.iter().all(|r| r.abs() < 1e-12));
}

#[test]
fn a_matrix_is_refused_wherever_it_is_not_positive() {
    let k = 120;
    let (pattern, values) = grid(k);
    let mut cholesky = Cholesky::analyse(&pattern).unwrap();
    assert!(cholesky.tree.segments.len() > 2);
    let pool = Pool::new(2).unwrap();
    let order = cholesky.symbolic.perm().unwrap().arrays().0.to_vec();
    // From the first row that is eliminated to the last.
    for at in [0, k * k / 3, k * k - 400, k * k - 1] {
        for bad in [-1.0, f64::NAN] {
            let mut values = values.clone();
            values[pattern.diagonal(order[at] as usize)] = bad;
            let matrix = Symmetric { pattern: &pattern, values: &values };
            assert_eq!(pool.run(|| cholesky.factor(matrix)), Err(NotPositiveDefinite), "{at}");
        }
    }
    let matrix = Symmetric { pattern: &pattern, values: &values };
    assert_eq!(pool.run(|| cholesky.factor(matrix)), Ok(()));
}

#[test]
fn a_pattern_keeps_each_entry_once() {
    let pattern = Pattern::new(3, &[(0, 1), (1, 0), (2, 2), (1, 2)]).unwrap();
    assert_eq!(pattern.entries(), 5);
    assert_eq!(pattern.position(0, 1), pattern.position(1, 0));
    assert_eq!(pattern.position(0, 2), None);
    assert_eq!(pattern.position(2, 2), Some(pattern.diagonal(2)));
}

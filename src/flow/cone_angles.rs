//! The curvatures of cones at given places: a small convex quadratic program.

/// Steps of the active-set method per unknown before it is stopped: each adds or removes one bound, and one or two per unknown
/// are usual.
const STEPS_PER_UNKNOWN: usize = 8;
/// A multiplier of the wrong sign below this, relative to the gradient, is 0.
const NOTHING: f64 = 1e-12;

/// The curvatures of cones, and the multiplier of their sum.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ConeAngles {
    pub t: Vec<f64>,
    /// The value that the gradient `B t + g` has at every entry that is not at its bound; 0 without a sum.
    pub level: f64,
    /// ½ tᵀB t + gᵀt.
    pub energy: f64,
}

/// Minimise `½ tᵀB t + gᵀt` over `t_i ≤ bound`, with `Σ t = sum` if that is given (then `sum ≤ bound · k`).
///
/// `b`: k × k, symmetric, positive definite where Σ t = 0 (everywhere without a sum). Primal active-set method; each step solves
/// the equations of the entries that are not at their bound. `None` if those are singular to working precision.
pub(super) fn angles(b: &[Vec<f64>], g: &[f64], sum: Option<f64>, bound: f64) -> Option<ConeAngles> {
    let k = g.len();
    let gradient = |t: &[f64]| -> Vec<f64> {
        (0..k).map(|i| g[i] + b[i].iter().zip(t).map(|(b, t)| b * t).sum::<f64>()).collect()
    };
    let mut t = vec![sum.map_or(0.0, |sum| (sum / k.max(1) as f64).min(bound)); k];
    let mut held = vec![false; k];
    let mut level = 0.0;
    for _ in 0..STEPS_PER_UNKNOWN * (k + 1) {
        let slope = gradient(&t);
        let free: Vec<usize> = (0..k).filter(|&i| !held[i]).collect();
        let mut step = Vec::new();
        if !free.is_empty() {
            step = eliminate(equations(b, &slope, &free, sum.is_some()))?;
            if sum.is_some() {
                level = -step.pop()?;
            }
        }
        let mut reach = 1.0;
        let mut blocking = None;
        for (&i, &p) in free.iter().zip(&step) {
            if p > 0.0 && t[i] + reach * p > bound {
                (reach, blocking) = (((bound - t[i]) / p).max(0.0), Some(i));
            }
        }
        free.iter().zip(&step).for_each(|(&i, p)| t[i] += reach * p);
        if let Some(i) = blocking {
            (t[i], held[i]) = (bound, true);
            continue;
        }
        // The minimum under these bounds is reached. The bound with the largest multiplier of the wrong sign is given up.
        let slope = gradient(&t);
        let least = NOTHING * slope.iter().fold(1.0f64, |m, s| m.max(s.abs()));
        let pull = |i: usize| slope[i] - level;
        let wrong = (0..k).filter(|&i| held[i] && pull(i) > least);
        match wrong.max_by(|&i, &j| pull(i).total_cmp(&pull(j)).then(j.cmp(&i))) {
            Some(i) if !free.is_empty() || sum.is_none() => held[i] = false,
            _ => break,
        }
    }
    let slope = gradient(&t);
    let energy = t.iter().zip(&slope).zip(g).map(|((t, s), g)| 0.5 * t * (s + g)).sum();
    Some(ConeAngles { t, level, energy })
}

/// The equations of a step of the `free` entries to where the gradient, now `slope`, is 0 for them. With a sum, which the step is to
/// keep, the gradient has one value for all of them, and minus that is a further unknown, the last.
fn equations(b: &[Vec<f64>], slope: &[f64], free: &[usize], has_sum: bool) -> Vec<Vec<f64>> {
    let sum = has_sum.then_some(1.0);
    let row = |&i: &usize| free.iter().map(|&j| b[i][j]).chain(sum).chain([-slope[i]]).collect();
    let mut rows: Vec<Vec<f64>> = free.iter().map(row).collect();
    if has_sum {
        rows.push(free.iter().map(|_| 1.0).chain([0.0, 0.0]).collect());
    }
    rows
}

/// Solve n equations, each a row of n coefficients and its right-hand side, by elimination with partial pivoting.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()).then(j.cmp(&i)))?;
        rows.swap(k, pivot);
        let (done, below) = rows.split_at_mut(k + 1);
        let row = &done[k];
        if !(row[k].abs() > 0.0 && row[k].is_finite()) {
            return None;
        }
        for other in below {
            let factor = other[k] / row[k];
            if factor != 0.0 {
                other[k..].iter_mut().zip(&row[k..]).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::SplitMix64;

    /// A random positive definite matrix.
    fn problem(k: usize, seed: u64) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut random = SplitMix64::new(seed);
        let mut number = || 2.0 * random.unit() - 1.0;
        let a: Vec<Vec<f64>> = (0..k).map(|_| (0..k).map(|_| number()).collect()).collect();
        let entry = |i: usize, j: usize| {
            a[i].iter().zip(&a[j]).map(|(x, y)| x * y).sum::<f64>() + if i == j { 0.1 } else { 0.0 }
        };
        let b = (0..k).map(|i| (0..k).map(|j| entry(i, j)).collect()).collect();
        (b, (0..k).map(|_| 5.0 * number()).collect())
    }

    #[test]
    fn the_conditions_of_optimality_hold() {
        for seed in 0..200 {
            let k = 1 + seed as usize % 9;
            let (b, g) = problem(k, seed);
            for (sum, bound) in
                [(None, 0.7), (Some(2.0), 2.5), (Some(-3.0), 0.1), (Some(0.4 * k as f64), 0.5)]
            {
                let ConeAngles { t, level, .. } = angles(&b, &g, sum, bound).unwrap();
                let slope: Vec<f64> =
                    (0..k).map(|i| g[i] + (0..k).map(|j| b[i][j] * t[j]).sum::<f64>()).collect();
                for i in 0..k {
                    assert!(t[i] <= bound);
                    let off = slope[i] - level;
                    // At its bound an entry may only want to go on.
                    let holds = if t[i] == bound { off <= 1e-9 } else { off.abs() <= 1e-9 };
                    assert!(holds, "seed {seed} k {k}: {off} at {i} of {t:?}");
                }
                if let Some(sum) = sum {
                    assert!((t.iter().sum::<f64>() - sum).abs() < 1e-12);
                } else {
                    assert_eq!(level, 0.0);
                }
            }
        }
    }

    #[test]
    fn without_room_every_entry_is_at_its_bound() {
        let (b, g) = problem(4, 3);
        assert_eq!(angles(&b, &g, Some(2.0), 0.5).unwrap().t, [0.5; 4]);
    }
}

//! Homogeneous equations between control points, solved one after the other: each control point becomes a combination of free ones.

use crate::archive::stored;

/// Entries of a row: columns, ascending, with values.
pub(super) type SparseRow = Vec<(u32, f64)>;

/// An equation whose entries are below this share of what they were given as follows from those before it.
const REDUNDANT: f64 = 1e-9;
/// Entries below this share of the largest are rounding.
const ROUNDING: f64 = 1e-13;
/// Least share of the largest entry of an equation that it may be solved for.
const LEAST_PIVOT: f64 = 0.35;

/// An equation solved for one of its columns.
struct SolvedRow {
    pivot: u32,
    /// The combination of other columns that the pivot is.
    combination: SparseRow,
}

/// The equations that were solved so far.
pub(super) struct ControlEquations {
    rows: Vec<SolvedRow>,
    /// Per column the row that is solved for it.
    solved: Vec<Option<u32>>,
    /// Per column the rows with it in their combination.
    uses: Vec<Vec<u32>>,
    /// Per column the number of arcs in whose equations it is: those of one arc only are solved for first, so that rows stay short.
    arcs: Vec<u32>,
}

/// The columns that are free, and every column as a combination of them.
pub(super) struct Combinations {
    /// Number of free columns.
    pub dimension: usize,
    /// For each column, the numbers of free ones with their weights.
    pub rows: Vec<SparseRow>,
}
stored!(sections Combinations { dimension, rows });

impl ControlEquations {
    /// No equation yet; `arcs`: per column the number of arcs in whose equations it is.
    pub fn new(arcs: Vec<u32>) -> ControlEquations {
        let n = arcs.len();
        ControlEquations { rows: Vec::new(), solved: vec![None; n], uses: vec![Vec::new(); n], arcs }
    }

    /// Adds an equation Σ value · column = 0.
    pub fn add(&mut self, row: &[(u32, f64)]) {
        let scale = largest(row);
        let mut sum = Vec::with_capacity(4 * row.len());
        for &(column, value) in row {
            match self.solved[column as usize] {
                Some(at) => {
                    sum.extend(self.rows[at as usize].combination.iter().map(|&(c, w)| (c, w * value)))
                }
                None => sum.push((column, value)),
            }
        }
        let sum = merged(sum, ROUNDING * scale);
        let most = largest(&sum);
        let may = sum.iter().filter(|entry| most > REDUNDANT * scale && entry.1.abs() >= LEAST_PIVOT * most);
        let order = |c: u32| (self.arcs[c as usize], self.uses[c as usize].len(), c);
        let Some(&(pivot, value)) = may.min_by_key(|entry| order(entry.0)) else { return };
        let others = sum.iter().filter(|entry| entry.0 != pivot);
        let combination: SparseRow = others.map(|&(c, w)| (c, -w / value)).collect();
        self.put_in(pivot, &combination);
        let number = self.rows.len() as u32;
        combination.iter().for_each(|&(c, _)| self.uses[c as usize].push(number));
        self.solved[pivot as usize] = Some(number);
        self.rows.push(SolvedRow { pivot, combination });
    }

    /// Replaces a column by a combination in all rows that have it.
    fn put_in(&mut self, pivot: u32, combination: &SparseRow) {
        for at in std::mem::take(&mut self.uses[pivot as usize]) {
            let row = &mut self.rows[at as usize].combination;
            let Some(i) = row.iter().position(|entry| entry.0 == pivot) else { continue };
            let mut sum = std::mem::take(row);
            let weight = sum.remove(i).1;
            for &(c, w) in combination {
                sum.push((c, w * weight));
                self.uses[c as usize].push(at);
            }
            self.rows[at as usize].combination = merged(sum, ROUNDING);
        }
    }

    /// Every column as a combination of those for which no equation was solved.
    pub fn finish(self) -> Combinations {
        let mut number = vec![0; self.solved.len()];
        let mut dimension = 0;
        for (number, _) in number.iter_mut().zip(&self.solved).filter(|(_, solved)| solved.is_none()) {
            *number = dimension;
            dimension += 1;
        }
        let mut rows: Vec<SparseRow> = number.iter().map(|&k| vec![(k, 1.0)]).collect();
        for SolvedRow { pivot, combination } in self.rows {
            rows[pivot as usize] = combination.iter().map(|&(c, w)| (number[c as usize], w)).collect();
        }
        Combinations { dimension: dimension as usize, rows }
    }
}

fn largest(row: &[(u32, f64)]) -> f64 {
    row.iter().fold(0.0, |most, entry| most.max(entry.1.abs()))
}

/// The row with entries of one column added up, without those up to a size.
fn merged(mut row: SparseRow, rounding: f64) -> SparseRow {
    row.sort_by_key(|entry| entry.0);
    row.dedup_by(|entry, before| {
        let same = entry.0 == before.0;
        if same {
            before.1 += entry.1;
        }
        same
    });
    row.retain(|entry| entry.1.abs() > rounding);
    row
}

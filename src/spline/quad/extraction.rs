//! The extraction matrix of a space of splines: all control points as combinations of the free ones.

use super::space::QuadSplineSpace;

/// A sparse matrix by rows, one for each control point, with a column for each free one.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtractionMatrix {
    /// Where the entries of each row start, and those of the last one end.
    pub starts: Vec<usize>,
    /// The column of each entry.
    pub columns: Vec<u32>,
    /// The entries.
    pub values: Vec<f64>,
}

impl QuadSplineSpace {
    /// The extraction matrix. Its rows add up to 1, and each free control point has the row of a control point to itself.
    pub fn extraction(&self) -> ExtractionMatrix {
        let mut matrix = ExtractionMatrix { starts: vec![0], columns: Vec::new(), values: Vec::new() };
        for point in 0..self.n_control_points() {
            for &(column, value) in self.combination(point) {
                matrix.columns.push(column);
                matrix.values.push(value);
            }
            matrix.starts.push(matrix.columns.len());
        }
        matrix
    }
}

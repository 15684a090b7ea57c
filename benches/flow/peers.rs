//! CHOLMOD and Eigen on the same matrix, by the program of benches/peers.

use crate::common::peers::Program;
use crate::linear::{Linear, Matrix};

/// The solvers that the program can measure, by its names for them.
const SOLVERS: [&str; 3] = ["CHOLMOD AMD", "CHOLMOD METIS", "Eigen LDLT"];

/// The measurements of each solver for the matrix.
pub fn measure(program: &Program, matrix: &Matrix) -> Vec<Linear> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    matrix.write(file.as_file_mut()).unwrap();
    let measured = |solver: &str| row(solver, &program.run(&[file.path().as_ref(), solver.as_ref()]));
    SOLVERS.into_iter().map(measured).collect()
}

/// `analyse factor solve entries cores residual`, separated by tabs.
fn row(solver: &str, line: &str) -> Linear {
    let numbers: Vec<f64> = line.trim().split('\t').map(|x| x.parse().unwrap()).collect();
    let [analyse, factor, solve, entries, cores, residual] = numbers[..] else { panic!("{solver}: {line}") };
    Linear { solver: solver.into(), analyse, factor, solve, entries: entries as usize, cores, residual }
}

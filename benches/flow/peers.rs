//! CHOLMOD and Eigen on the same matrix, by the program of benches/peers.

use super::linear::{Linear, Matrix};
use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

/// What the program can measure, in its words.
const SOLVERS: [&str; 3] = ["CHOLMOD AMD", "CHOLMOD METIS", "Eigen LDLT"];

/// The program of benches/peers.
pub struct Peers {
    program: PathBuf,
}

impl Peers {
    /// The program that `RICCI_PEERS` names, or else the one that cmake builds below the target folder; why there is none.
    pub fn find() -> Result<Peers, String> {
        if let Some(program) = std::env::var_os("RICCI_PEERS") {
            return Ok(Peers { program: program.into() });
        }
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers");
        let build = concat!(env!("CARGO_TARGET_TMPDIR"), "/peers");
        cmake(&["-S", source, "-B", build])?;
        cmake(&["--build", build])?;
        Ok(Peers { program: [build, "peers"].iter().collect() })
    }

    /// The libraries, with their versions and the BLAS under them.
    pub fn libraries(&self) -> String {
        self.run(&[]).trim().into()
    }

    /// What each solver takes for the matrix.
    pub fn measure(&self, matrix: &Matrix) -> Vec<Linear> {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        matrix.write(file.as_file_mut()).unwrap();
        let measured = |solver: &str| row(solver, &self.run(&[file.path().as_ref(), solver.as_ref()]));
        SOLVERS.into_iter().map(measured).collect()
    }

    fn run(&self, arguments: &[&OsStr]) -> String {
        let output = Command::new(&self.program).args(arguments).output();
        let output = output.unwrap_or_else(|e| panic!("{}: {e}", self.program.display()));
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }
}

/// `analyse factor solve entries cores residual`, separated by tabs.
fn row(solver: &str, line: &str) -> Linear {
    let numbers: Vec<f64> = line.trim().split('\t').map(|x| x.parse().unwrap()).collect();
    let [analyse, factor, solve, entries, cores, residual] = numbers[..] else { panic!("{solver}: {line}") };
    Linear { solver: solver.into(), analyse, factor, solve, entries: entries as usize, cores, residual }
}

fn cmake(arguments: &[&str]) -> Result<(), String> {
    let output = Command::new("cmake").args(arguments).output().map_err(|e| format!("cmake: {e}"))?;
    if output.status.success() {
        return Ok(());
    }
    // CMake puts the message of its own check into a paragraph below "CMake Error at".
    let text = String::from_utf8_lossy(&output.stderr);
    let said = text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with("CMake Error at"));
    Err(said.take(1).collect::<String>())
}

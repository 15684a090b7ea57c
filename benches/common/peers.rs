//! The programs of benches/peers, which do the same work by other libraries, each in a process of its own.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

/// One program of benches/peers.
pub struct Program(PathBuf);

impl Program {
    /// The program in the folder that `RICCI_PEERS` names, or else built by cmake below the target folder; or why there is none.
    pub fn find(name: &str) -> Result<Program, String> {
        if let Some(folder) = std::env::var_os("RICCI_PEERS") {
            return Ok(Program(PathBuf::from(folder).join(name)));
        }
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers");
        let build = concat!(env!("CARGO_TARGET_TMPDIR"), "/peers");
        cmake(&["-S", source, "-B", build])?;
        cmake(&["--build", build, "--target", name])?;
        Ok(Program([build, name].iter().collect()))
    }

    /// The output of the program.
    pub fn run(&self, arguments: &[&OsStr]) -> String {
        let output = Command::new(&self.0).args(arguments).output();
        let output = output.unwrap_or_else(|e| panic!("{}: {e}", self.0.display()));
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// The libraries, with their versions.
    pub fn libraries(&self) -> String {
        self.run(&[]).trim().into()
    }
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

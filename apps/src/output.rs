//! Files are written beside their destination and renamed into place when all of them are complete.

use crate::failure::Failure;
use serde::Serialize;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// The files of one run, all of them or none.
#[derive(Default)]
pub struct Outputs {
    pending: Vec<(NamedTempFile, PathBuf)>,
}

impl Outputs {
    /// Write a file's content; it appears under its name on [`Outputs::commit`].
    pub fn add(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<&mut NamedTempFile>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let failed = |e: io::Error| Failure::Failed(format!("{}: {e}", path.display()));
        let mut file = temporary(directory_of(path)).map_err(failed)?;
        let mut buffer = BufWriter::new(&mut file);
        write(&mut buffer).and_then(|()| buffer.flush()).map_err(failed)?;
        drop(buffer);
        self.pending.push((file, path.into()));
        Ok(())
    }

    /// Let the library write a file by name.
    pub fn add_named(
        &mut self,
        path: &Path,
        write: impl FnOnce(&Path) -> ricci::Result<()>,
    ) -> Result<(), Failure> {
        let failed = |e: String| Failure::Failed(format!("{}: {e}", path.display()));
        let file = temporary(directory_of(path)).map_err(|e| failed(e.to_string()))?;
        write(file.path()).map_err(|e| failed(e.to_string()))?;
        self.pending.push((file, path.into()));
        Ok(())
    }

    /// Write a JSON file, indented for people.
    pub fn add_report(&mut self, path: &Path, value: &impl Serialize) -> Result<(), Failure> {
        self.add(path, |out| {
            serde_json::to_writer_pretty(&mut *out, value)?;
            writeln!(out)
        })
    }

    /// Write a JSON file on one line.
    pub fn add_json(&mut self, path: &Path, value: &impl Serialize) -> Result<(), Failure> {
        self.add(path, |out| {
            serde_json::to_writer(&mut *out, value)?;
            writeln!(out)
        })
    }

    /// Rename every file into place; returns their names.
    pub fn commit(self) -> Result<Vec<PathBuf>, Failure> {
        let mut written = Vec::new();
        for (file, path) in self.pending {
            file.persist(&path).map_err(|e| Failure::Failed(format!("{}: {}", path.display(), e.error)))?;
            written.push(path);
        }
        Ok(written)
    }
}

/// A usage error if a file of this name could not be written: found before the work, not after it.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::Usage(format!("{}: {why}", path.display())));
    if path.is_dir() {
        return refuse("is a directory".into());
    }
    let directory = directory_of(path);
    if !directory.is_dir() {
        return refuse(format!("the directory {} does not exist", directory.display()));
    }
    match temporary(directory) {
        Ok(_) => Ok(()),
        Err(e) => refuse(format!("cannot be written: {}", e.kind())),
    }
}

/// A usage error unless the file's extension is one of these (lower case).
pub fn check_extension(option: &str, path: &Path, known: &[&str]) -> Result<(), Failure> {
    if known.contains(&extension(path).as_str()) {
        return Ok(());
    }
    let known: Vec<_> = known.iter().map(|e| format!(".{e}")).collect();
    Err(Failure::Usage(format!("{option} {}: the name must end in {}", path.display(), known.join(" or "))))
}

/// The extension in lower case.
pub fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file that will have the permissions of an ordinary one (those the umask leaves).
fn temporary(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".ricci-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

//! Files are written beside their destination and renamed into place when all of them are complete.

use crate::failure::Failure;
use ricci::mesh::io::destination;
use serde::Serialize;
use std::fs::{self, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// The files of one run: none is there before all are complete.
#[derive(Default)]
pub struct Outputs {
    pending: Vec<Pending>,
}

/// A complete file under a temporary name.
struct Pending {
    file: NamedTempFile,
    /// The name that was asked for, and what it names once links are followed.
    path: PathBuf,
    target: PathBuf,
    /// Of the file that is replaced.
    permissions: Option<Permissions>,
}

impl Pending {
    fn new(path: &Path) -> io::Result<Pending> {
        let (target, permissions) = destination(path);
        Ok(Pending { file: temporary(directory_of(&target))?, path: path.into(), target, permissions })
    }

    fn commit(self) -> Result<PathBuf, Failure> {
        let Pending { file, path, target, permissions } = self;
        let failed = |e: io::Error| Failure::Failed(format!("{}: {e}", path.display()));
        if let Some(permissions) = permissions {
            // The library may have replaced the file itself, so that its handle is that of another.
            fs::set_permissions(file.path(), permissions).map_err(failed)?;
        }
        file.persist(&target).map_err(|e| failed(e.error))?;
        Ok(path)
    }
}

impl Outputs {
    /// Write a file's content; it appears under its name on [`Outputs::commit`].
    pub fn add(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<&mut NamedTempFile>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let failed = |e: io::Error| Failure::Failed(format!("{}: {e}", path.display()));
        let mut pending = Pending::new(path).map_err(failed)?;
        let mut buffer = BufWriter::new(&mut pending.file);
        write(&mut buffer).and_then(|()| buffer.flush()).map_err(failed)?;
        drop(buffer);
        self.pending.push(pending);
        Ok(())
    }

    /// Write these bytes.
    pub fn add_bytes(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Failure> {
        self.add(path, |out| out.write_all(bytes))
    }

    /// Let the library write a file by name.
    pub fn add_named<T>(
        &mut self,
        path: &Path,
        write: impl FnOnce(&Path) -> ricci::Result<T>,
    ) -> Result<T, Failure> {
        let failed = |e: String| Failure::Failed(format!("{}: {e}", path.display()));
        let pending = Pending::new(path).map_err(|e| failed(e.to_string()))?;
        let written = write(pending.file.path()).map_err(|e| failed(e.to_string()))?;
        self.pending.push(pending);
        Ok(written)
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

    /// Rename every file into place; returns their names. Links stay links, and permissions those of what is replaced. Where one
    /// fails, the others are still there.
    pub fn commit(self) -> Result<Vec<PathBuf>, Failure> {
        let done: Vec<_> = self.pending.into_iter().map(Pending::commit).collect();
        done.into_iter().collect()
    }
}

/// A usage error if a file of this name could not be written: found before the work, not after it.
fn check_writable(path: &Path) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::Usage(format!("{}: {why}", path.display())));
    if path.is_dir() {
        return refuse("is a directory".into());
    }
    let directory = directory_of(path);
    if !directory.is_dir() {
        return refuse(format!("the directory {} does not exist", directory.display()));
    }
    match Pending::new(path) {
        Ok(_) => Ok(()),
        Err(e) => refuse(format!("cannot be written: {}", e.kind())),
    }
}

/// A usage error if two outputs are one file, if one would take the place of an input, or could not be written.
pub fn check_outputs(inputs: &[Option<&Path>], outputs: &[Option<&Path>]) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().flatten().map(|path| (path, place_of(path))).collect();
    let mut seen: Vec<(&Path, PathBuf)> = Vec::new();
    for path in outputs.iter().flatten() {
        let place = place_of(path);
        if let Some((input, _)) = inputs.iter().find(|(_, input)| *input == place) {
            let (output, input) = (path.display(), input.display());
            let same = format!("the output {output} is the input {input}, which it would replace");
            return Err(Failure::Usage(format!("{same}; choose another name")));
        }
        if let Some((other, _)) = seen.iter().find(|(_, other)| *other == place) {
            let [a, b] = [path, other].map(|path| path.display().to_string());
            let also = if a == b { String::new() } else { format!(", as {b} too") };
            return Err(Failure::Usage(format!("{a} is named for two outputs{also}")));
        }
        seen.push((path, place));
        check_writable(path)?;
    }
    Ok(())
}

/// Where a file is, or would be: one name per file, however it is called.
fn place_of(path: &Path) -> PathBuf {
    let (target, _) = destination(path);
    match (directory_of(&target).canonicalize(), target.file_name()) {
        (Ok(directory), Some(name)) => directory.join(name),
        _ => target,
    }
}

/// A usage error unless the file that an option names, if it names one, has one of these extensions (lower case).
pub fn check_extension(option: &str, path: Option<&Path>, known: &[&str]) -> Result<(), Failure> {
    let Some(path) = path.filter(|path| !known.contains(&extension(path).as_str())) else { return Ok(()) };
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
        builder.permissions(Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

//! Output files: they are written beside their destination and renamed into place when all of them are complete. Outputs that are no
//! regular files are written in place.

use crate::failure::Failure;
use ricci::mesh::io::{Format, TexturedMesh, destination, is_packed, packed};
use serde::Serialize;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// The file name that stands for stdin and stdout.
pub const STANDARD: &str = "-";

/// The files of this process that are not in place yet.
static DRAFTS: Mutex<Drafts> = Mutex::new(Drafts { directories: Vec::new(), in_place: false });

struct Drafts {
    /// The directories that hold them.
    directories: Vec<PathBuf>,
    /// True once all files of the last run are in place.
    in_place: bool,
}

fn drafts() -> MutexGuard<'static, Drafts> {
    DRAFTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Give up the files that are not in place yet, for a process that is about to end; false if all are in place. Files that are being
/// put in place are waited for, and no further one will be.
pub fn abandon() -> bool {
    let drafts = std::mem::ManuallyDrop::new(drafts());
    for directory in &drafts.directories {
        let _ = fs::remove_dir_all(directory);
    }
    let abandoned = !drafts.in_place;
    if !abandoned {
        drop(std::mem::ManuallyDrop::into_inner(drafts));
    }
    abandoned
}

/// True if the files of the last run are in place.
pub fn in_place() -> bool {
    drafts().in_place
}

/// The files of one run, none of which appears under its name before all are complete.
#[derive(Default)]
pub struct Outputs {
    pending: Vec<Pending>,
    /// What the input's file holds and the written mesh has no room for.
    left_out: Vec<String>,
}

/// A complete file in a temporary directory of its own, which is removed with it.
struct Pending {
    directory: TempDir,
    /// The file name that was asked for.
    path: PathBuf,
    place: OutputPlace,
}

/// The destination of a file.
enum OutputPlace {
    Stdout,
    /// A device, a pipe or an open file, which is written to.
    Open,
    /// A regular file, which is replaced: the path that its name leads to once links are followed, and its permissions.
    Regular(PathBuf, Option<Permissions>),
}

impl OutputPlace {
    fn of(path: &Path) -> OutputPlace {
        let exists_otherwise = fs::metadata(path).is_ok_and(|found| !found.is_file());
        // A file that a shell has opened must not be replaced, even where it is a regular file.
        let opened = ["/dev", "/proc"].iter().any(|root| path.starts_with(root));
        if path == Path::new(STANDARD) {
            OutputPlace::Stdout
        } else if exists_otherwise || opened {
            OutputPlace::Open
        } else {
            let (target, permissions) = destination(path);
            OutputPlace::Regular(target, permissions)
        }
    }
}

impl Pending {
    fn new(path: &Path) -> io::Result<Pending> {
        let place = OutputPlace::of(path);
        let mut builder = tempfile::Builder::new();
        builder.prefix(".ricci-");
        let directory = match &place {
            OutputPlace::Regular(target, _) => builder.tempdir_in(directory_of(target))?,
            _ => builder.tempdir()?,
        };
        let mut drafts = drafts();
        drafts.directories.push(directory.path().into());
        drafts.in_place = false;
        Ok(Pending { directory, path: path.into(), place })
    }

    /// The path at which the file is written.
    fn draft(&self) -> PathBuf {
        self.directory.path().join("draft")
    }

    /// Packs the complete file where its name ends in `.gz`.
    fn pack(&self) -> io::Result<()> {
        if is_packed(&self.path) {
            let bytes = packed(&fs::read(self.draft())?)?;
            fs::write(self.draft(), bytes)?;
        }
        Ok(())
    }

    fn commit(&self) -> Result<PathBuf, Failure> {
        self.put_in_place().map_err(|e| failed(&self.path, e))?;
        Ok(self.path.clone())
    }

    fn put_in_place(&self) -> io::Result<()> {
        match &self.place {
            OutputPlace::Stdout => {
                let mut out = io::stdout().lock();
                io::copy(&mut File::open(self.draft())?, &mut out)?;
                out.flush()
            }
            OutputPlace::Open => {
                let mut out = File::options().append(true).open(&self.path)?;
                io::copy(&mut File::open(self.draft())?, &mut out).map(drop)
            }
            OutputPlace::Regular(target, permissions) => {
                if let Some(permissions) = permissions {
                    fs::set_permissions(self.draft(), permissions.clone())?;
                }
                fs::rename(self.draft(), target)
            }
        }
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        drafts().directories.retain(|known| known != self.directory.path());
    }
}

fn failed(path: &Path, why: impl std::fmt::Display) -> Failure {
    Failure::Failed(format!("{}: {why}", path.display()))
}

impl Outputs {
    /// Write a file's content; it appears under its name on [`Outputs::commit`].
    pub fn add(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let pending = Pending::new(path).map_err(|e| failed(path, e))?;
        let mut buffer = BufWriter::new(File::create(pending.draft()).map_err(|e| failed(path, e))?);
        write(&mut buffer).and_then(|()| buffer.flush()).map_err(|e| failed(path, e))?;
        pending.pack().map_err(|e| failed(path, e))?;
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
        let pending = Pending::new(path).map_err(|e| failed(path, e))?;
        let written = write(&pending.draft()).map_err(|e| failed(path, e))?;
        pending.pack().map_err(|e| failed(path, e))?;
        self.pending.push(pending);
        Ok(written)
    }

    /// The bytes of the file that was written last.
    pub fn last_bytes(&self) -> io::Result<Vec<u8>> {
        let last = self.pending.last().ok_or_else(|| io::Error::other("no file was written"))?;
        fs::read(last.draft())
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

    /// Add the files of `others` behind these.
    pub fn append(&mut self, others: Outputs) {
        self.pending.extend(others.pending);
        self.leave_out(others.left_out);
    }

    /// Note what a written mesh has no room for.
    pub fn leave_out(&mut self, what: impl IntoIterator<Item = String>) {
        for what in what {
            if !self.left_out.contains(&what) {
                self.left_out.push(what);
            }
        }
    }

    /// What the input's file holds and the meshes that were written have no room for.
    pub fn left_out(&self) -> &[String] {
        &self.left_out
    }

    /// Put every file in place; returns their names. Links stay links, and a file keeps the permissions of the one that it replaces. Where
    /// one fails, the others are still put in place.
    pub fn commit(self) -> Result<Vec<PathBuf>, Failure> {
        // The lock makes a process that is about to end wait for this.
        let mut drafts = drafts();
        let done: Vec<_> = self.pending.iter().map(Pending::commit).collect();
        drafts.in_place = true;
        drop(drafts);
        done.into_iter().collect()
    }
}

/// A usage error if a file of this name could not be written: found before the work, not after it.
fn check_writable(path: &Path) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::Usage(format!("{}: {why}", path.display())));
    let target = match OutputPlace::of(path) {
        _ if path.is_dir() => return refuse("is a directory".into()),
        OutputPlace::Regular(_, Some(permissions)) if permissions.readonly() => {
            return refuse("is write-protected".into());
        }
        OutputPlace::Regular(target, _) => target,
        OutputPlace::Stdout | OutputPlace::Open => return Ok(()),
    };
    let directory = directory_of(&target);
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
    let files = inputs.iter().flatten().filter(|path| **path != Path::new(STANDARD));
    let inputs: Vec<_> = files.map(|path| (path, place_of(path))).collect();
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

/// The one path of a file, existing or not, whatever name it is called by.
fn place_of(path: &Path) -> PathBuf {
    let (target, _) = destination(path);
    match (directory_of(&target).canonicalize(), target.file_name()) {
        (Ok(directory), Some(name)) => directory.join(name),
        _ => target,
    }
}

/// A usage error unless the file that an option names, if it names one, has one of these extensions (lower case). An output that is no
/// regular file has the format of the first.
pub fn check_extension(option: &str, path: Option<&Path>, known: &[&str]) -> Result<(), Failure> {
    let named = |path: &&Path| matches!(OutputPlace::of(path), OutputPlace::Regular(..));
    let Some(path) = path.filter(named).filter(|path| !known.contains(&extension(path).as_str())) else {
        return Ok(());
    };
    let known: Vec<_> = known.iter().map(|e| format!(".{e}")).collect();
    Err(Failure::Usage(format!("{option} {}: the name must end in {}", path.display(), known.join(" or "))))
}

/// The extensions of mesh files that are written; the last ones are the names that FreeSurfer gives surfaces.
const MESH_FILES: [&str; 17] = [
    "obj",
    "off",
    "ply",
    "glb",
    "vtk",
    "vtp",
    "mz3",
    "gii",
    "asc",
    "white",
    "pial",
    "inflated",
    "sphere",
    "reg",
    "orig",
    "smoothwm",
    "midthickness",
];

/// [`check_extension`] for mesh files and those with `more` extensions.
pub fn check_mesh_extension(option: &str, path: Option<&Path>, more: &[&str]) -> Result<(), Failure> {
    check_extension(option, path, &[&MESH_FILES[..], more].concat())
}

/// True if a file of this name is the stdout of the process.
pub fn is_stdout(path: &Path) -> bool {
    [STANDARD, "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path == Path::new(name))
}

/// The format of a mesh file to be written: OBJ where the name does not say it.
pub fn format_of(path: &Path) -> Result<Format, Failure> {
    match OutputPlace::of(path) {
        OutputPlace::Regular(..) => Ok(Format::of(path)?),
        OutputPlace::Stdout | OutputPlace::Open => Ok(Format::of(path).unwrap_or(Format::Obj)),
    }
}

/// Write a triangle list with texture coordinates: binary glTF for .glb, else OBJ.
pub fn write_textured(outputs: &mut Outputs, path: &Path, data: &TexturedMesh) -> Result<(), Failure> {
    match extension(path).as_str() {
        "glb" => outputs.add_named(path, |path| ricci::mesh::io::write_glb(path, data, None).map(drop)),
        _ => outputs.add(path, |out| ricci::mesh::io::write_obj_to(out, data).map_err(io::Error::other)),
    }
}

/// The extension in lower case; that before `.gz`, if that is the end.
pub fn extension(path: &Path) -> String {
    let inner = if is_packed(path) { &path.with_extension("") } else { path };
    inner.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

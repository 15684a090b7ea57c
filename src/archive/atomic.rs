//! Writing of files so that they appear whole or not at all.

use crate::error::{Error, Result};
use std::fs::{self, File, Permissions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file through `write` to a temporary file beside it, which is then renamed. On any error the temporary file is removed and an
/// existing file stays as it was. A symbolic link is kept and its target replaced; the permissions of an existing file are kept.
///
/// # Errors
///
/// [`Error::Io`].
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<()> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let failed = |e: std::io::Error| Error::Io { path: path.display().to_string(), message: e.to_string() };
    let (target, permissions) = destination(path);
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let unique = COUNT.fetch_add(1, Ordering::Relaxed);
    let temporary = target.with_file_name(format!(".{name}.{}.{unique}.tmp", std::process::id()));
    let file = File::options().write(true).create_new(true).open(&temporary).map_err(failed)?;
    let mut out = BufWriter::new(file);
    let written = write(&mut out)
        .and_then(|()| out.flush())
        .and_then(|()| permissions.map_or(Ok(()), |kept| out.get_ref().set_permissions(kept)))
        .and_then(|()| out.get_ref().sync_all())
        .and_then(|()| fs::rename(&temporary, &target));
    written.map_err(|e| {
        let _ = fs::remove_file(&temporary);
        failed(e)
    })
}

/// The file that a path names after following symbolic links, and the permissions that it has if it exists: the data for replacing it by
/// renaming.
pub fn destination(path: &Path) -> (PathBuf, Option<Permissions>) {
    if let Ok(target) = fs::canonicalize(path) {
        let permissions = fs::metadata(&target).ok().filter(fs::Metadata::is_file);
        return (target, permissions.map(|found| found.permissions()));
    }
    // The path may be a link to a file that does not exist yet.
    match fs::read_link(path) {
        Ok(link) => (path.parent().unwrap_or(Path::new("")).join(link), None),
        Err(_) => (path.into(), None),
    }
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_files_keep_their_permissions() {
        use super::*;
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("secret"), "old").unwrap();
        fs::set_permissions(at("secret"), Permissions::from_mode(0o600)).unwrap();
        symlink("secret", at("link")).unwrap();
        symlink("later", at("dangling")).unwrap();
        for (name, target) in [("secret", "secret"), ("link", "secret"), ("dangling", "later")] {
            write_atomically(&at(name), |out| write!(out, "by {name}")).unwrap();
            assert_eq!(fs::read_to_string(at(target)).unwrap(), format!("by {name}"));
        }
        for name in ["link", "dangling"] {
            assert!(fs::symlink_metadata(at(name)).unwrap().is_symlink(), "{name}");
        }
        assert_eq!(fs::metadata(at("secret")).unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4, "a temporary was left behind");
    }
}

//! Writing files so that a reader never sees half of one.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Beginning and end of the names under which files are written before they take their place.
const HALF_WRITTEN: [&str; 2] = [".writing-", ".partial"];

/// A file or folder that could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{action} `{}`: {source}", path.display())]
pub struct FileError {
    /// `write`, `read`, `create the folder`, …: fits after "failed to".
    pub action: &'static str,
    /// The file or folder.
    pub path: PathBuf,
    /// What the system said.
    pub source: io::Error,
}

impl FileError {
    /// Makes a closure for `map_err`.
    pub fn of<'a>(action: &'static str, path: &'a Path) -> impl FnOnce(io::Error) -> Self + 'a {
        move |source| Self { action, path: path.into(), source }
    }
}

/// Writes a file under a temporary name beside its place, flushes it to the disk and renames it.
///
/// When `fill` or the disk fails, the old file, if there was one, stays as it was and the temporary one is removed.
///
/// # Errors
/// What the system or `fill` said, with the path.
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
    publish(staged(path, fill)?, path)
}

/// Writes several files that belong together: each as by [`write_atomically`], and none takes its place before all are safe
/// on the disk.
///
/// # Errors
/// What the system said, with the path.
pub fn write_together(files: &[(&Path, &[u8])]) -> Result<(), FileError> {
    let staged: Result<Vec<_>, _> =
        files.iter().map(|(path, bytes)| staged(path, |writer| writer.write_all(bytes))).collect();
    staged?.into_iter().zip(files).try_for_each(|(temporary, (path, _))| publish(temporary, path))
}

/// A temporary file beside the place of `path`, filled and safe on the disk.
fn staged(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<NamedTempFile, FileError> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(HALF_WRITTEN[0]).suffix(HALF_WRITTEN[1]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o644));
    }
    let temporary = builder.tempfile_in(folder).map_err(FileError::of("write", path))?;
    let mut writer = BufWriter::new(temporary.as_file());
    fill(&mut writer).and_then(|()| writer.flush()).map_err(FileError::of("write", path))?;
    drop(writer);
    sync(temporary.as_file()).map_err(FileError::of("write", path))?;
    Ok(temporary)
}

fn publish(temporary: NamedTempFile, path: &Path) -> Result<(), FileError> {
    temporary.persist(path).map_err(|error| FileError { action: "write", path: path.into(), source: error.error })?;
    Ok(())
}

/// Writes bytes by [`write_atomically`].
///
/// # Errors
/// What the system said, with the path.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_atomically(path, |writer| writer.write_all(bytes))
}

/// Removes what a killed process left half-written in a folder that nobody else writes into now.
pub fn remove_half_written(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(HALF_WRITTEN[0]) && name.ends_with(HALF_WRITTEN[1]) {
            // What cannot be removed stays, and does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Reads a whole text file.
///
/// # Errors
/// What the system said, with the path.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    fs::read_to_string(path).map_err(FileError::of("read", path))
}

/// Creates a folder and its parents.
///
/// # Errors
/// What the system said, with the path.
pub fn create_folder(path: &Path) -> Result<(), FileError> {
    fs::create_dir_all(path).map_err(FileError::of("create the folder", path))
}

/// The known name that is nearest to what somebody typed, if one is near enough to be worth naming.
pub fn nearest_name<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(typed, name), name))
        .filter(|(distance, name)| *distance <= 1 + name.len() / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

fn sync(file: &File) -> io::Result<()> {
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk that fills up half-way: the old result stays, nothing half-written is left.
    #[test]
    fn a_failing_writer_leaves_the_old_file_and_no_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.csv");
        write_bytes(&path, b"old").unwrap();
        let error = write_atomically(&path, |writer| {
            writer.write_all(b"half of the new on")?;
            Err(io::Error::new(io::ErrorKind::StorageFull, "no space left on device"))
        })
        .unwrap_err();
        assert_eq!(error.to_string(), format!("write `{}`: no space left on device", path.display()));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// The second of two cannot be written: the first is not there either.
    #[test]
    fn files_that_belong_together_come_together() {
        let folder = tempfile::tempdir().unwrap();
        let (one, other) = (folder.path().join("a.rd3"), folder.path().join("a.rad"));
        write_together(&[(&one, b"1"), (&other, b"2")]).unwrap();
        assert_eq!((fs::read(&one).unwrap(), fs::read(&other).unwrap()), (b"1".to_vec(), b"2".to_vec()));
        let nowhere = folder.path().join("none/b.rad");
        assert!(write_together(&[(&folder.path().join("b.rd3"), b"1"), (&nowhere, b"2")]).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn the_nearest_name_is_named_only_when_it_is_near() {
        assert_eq!(nearest_name("fowling", ["fouling", "voids"]), Some("fouling"));
        assert_eq!(nearest_name("xyzzy", ["fouling", "voids"]), None);
    }
}

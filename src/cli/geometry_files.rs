//! The geometry files that an input file asks for (`#geometry_objects_write`).

use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::files::write_bytes;
use crate::gprmax;
use crate::model::Model;

/// Refuses geometry files that cannot or may not be written, before anything is computed.
///
/// A file that is there with the very bytes that would be written is no obstacle.
///
/// # Errors
/// When a folder is missing, another file is there and `force` is not given, or a file is needed for something else.
pub(super) fn check(model: &Model, input: &Path, results: &[PathBuf], force: bool) -> Result<(), CliError> {
    let paths = gprmax::geometry_paths(model, &folder(input));
    if paths.is_empty() {
        return Ok(());
    }
    let needed: Vec<PathBuf> = gprmax::input_files(input)?.iter().map(|path| whole(path)).collect();
    for path in &paths {
        let at = path.display();
        if results.iter().any(|result| whole(path) == whole(result)) {
            return Err(CliError::input(format!(
                "`#geometry_objects_write` would write `{at}`, where the traces go\n\nhint: name another geometry file, or other traces with `--out FILE.h5`"
            )));
        }
        if needed.contains(&whole(path)) {
            return Err(CliError::input(format!(
                "`#geometry_objects_write` would write `{at}`, which `{}` reads\n\nhint: name another geometry file",
                input.display()
            )));
        }
        if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty() && !parent.is_dir()) {
            return Err(CliError::input(format!(
                "`#geometry_objects_write` would write `{at}`, but `{}` is not a folder\n\nhint: make it with `mkdir`",
                parent.display()
            )));
        }
    }
    if force || !paths.iter().any(|path| path.exists()) {
        return Ok(());
    }
    for (path, bytes) in files(model, input)? {
        if path.exists() && std::fs::read(&path).ok() != Some(bytes) {
            return Err(CliError::input(format!(
                "`#geometry_objects_write` would write `{}`, which exists already with another content\n\nhint: overwrite it with `--force`, or name another file",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Writes the geometry files, each whole or not at all, and gives their paths.
///
/// # Errors
/// When a material cannot be written, or the system refuses.
pub(super) fn write(model: &Model, input: &Path) -> Result<Vec<PathBuf>, CliError> {
    let mut written = vec![];
    for (path, bytes) in files(model, input)? {
        write_bytes(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
}

fn files(model: &Model, input: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, CliError> {
    Ok(gprmax::geometry_files(model, &folder(input))?)
}

fn folder(input: &Path) -> PathBuf {
    input.with_file_name("")
}

/// A path whose folder is written out in full, for comparison.
fn whole(path: &Path) -> PathBuf {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let parent = parent.canonicalize().unwrap_or_else(|_| parent.into());
    path.file_name().map_or_else(|| parent.clone(), |name| parent.join(name))
}

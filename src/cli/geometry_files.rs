//! The geometry files and views that an input file asks for (`#geometry_objects_write`, `#geometry_view`).

use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::files::write_bytes;
use crate::gprmax;
use crate::model::Model;

/// A file to write.
struct Asked {
    command: &'static str,
    path: PathBuf,
}

/// Refuses geometry files and views that cannot or may not be written, before anything is computed.
///
/// A file that is there with the very bytes that would be written is no obstacle. `results` are the traces that are going to be
/// written; of a B-scan (`numbered`) each has views of its own.
///
/// # Errors
/// When a folder is missing, another file is there and `force` is not given, or a file is needed for something else.
pub(super) fn check(
    model: &Model,
    input: &Path,
    results: &[PathBuf],
    numbered: bool,
    force: bool,
) -> Result<(), CliError> {
    let paths = gprmax::geometry_paths(model, &folder(input)).into_iter();
    let mut asked: Vec<Asked> = paths.map(|path| Asked { command: "#geometry_objects_write", path }).collect();
    for (index, result) in results.iter().enumerate() {
        let paths = gprmax::view_paths(model, result, numbered.then_some(index + 1)).into_iter();
        asked.extend(paths.map(|path| Asked { command: "#geometry_view", path }));
    }
    if asked.is_empty() {
        return Ok(());
    }
    let needed: Vec<PathBuf> = gprmax::input_files(input)?.iter().map(|path| whole(path)).collect();
    for Asked { command, path } in &asked {
        let at = path.display();
        if results.iter().any(|result| whole(path) == whole(result)) {
            return Err(CliError::input(format!(
                "`{command}` would write `{at}`, where the traces go\n\nhint: name another geometry file, or other traces with `--out FILE.h5`"
            )));
        }
        if needed.contains(&whole(path)) {
            return Err(CliError::input(format!(
                "`{command}` would write `{at}`, which `{}` reads\n\nhint: name another geometry file",
                input.display()
            )));
        }
        if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty() && !parent.is_dir()) {
            return Err(CliError::input(format!(
                "`{command}` would write `{at}`, but `{}` is not a folder\n\nhint: make it with `mkdir`",
                parent.display()
            )));
        }
    }
    if force || !asked.iter().any(|asked| asked.path.exists()) {
        return Ok(());
    }
    let mut files = gprmax::geometry_files(model, &folder(input))?;
    for (index, result) in results.iter().enumerate() {
        files.extend(views(model, result, index, numbered)?);
    }
    for (Asked { command, path }, (_, bytes)) in asked.iter().zip(files) {
        if path.exists() && std::fs::read(path).ok() != Some(bytes) {
            return Err(CliError::input(format!(
                "`{command}` would write `{}`, which exists already with another content\n\nhint: overwrite it with `--force`, or name another file",
                path.display()
            )));
        }
    }
    Ok(())
}

/// The views of one result; those of a B-scan show where its sources and receivers are.
fn views(model: &Model, result: &Path, index: usize, numbered: bool) -> Result<Vec<(PathBuf, Vec<u8>)>, CliError> {
    if model.geometry_views.is_empty() {
        return Ok(vec![]);
    }
    Ok(gprmax::view_files(&model.at_trace(index), result, numbered.then_some(index + 1))?)
}

/// Writes the geometry files, each whole or not at all, and gives their paths.
///
/// # Errors
/// When a material cannot be written, or the system refuses.
pub(super) fn write(model: &Model, input: &Path) -> Result<Vec<PathBuf>, CliError> {
    write_all(gprmax::geometry_files(model, &folder(input))?)
}

/// Writes the views of one result, each whole or not at all, and gives their paths.
///
/// # Errors
/// When the model cannot be painted, or the system refuses.
pub(super) fn write_views(
    model: &Model,
    result: &Path,
    index: usize,
    numbered: bool,
) -> Result<Vec<PathBuf>, CliError> {
    write_all(views(model, result, index, numbered)?)
}

fn write_all(files: Vec<(PathBuf, Vec<u8>)>) -> Result<Vec<PathBuf>, CliError> {
    let mut written = vec![];
    for (path, bytes) in files {
        write_bytes(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
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

//! Traces from whatever a user names: a folder of this program, gprMax's HDF5, two-column text.

use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::compare::text;
use crate::files;
use crate::gprmax;
use crate::trace::AScan;

/// Names of the results in a folder, the preferred first.
const RESULTS: [&str; 2] = ["fdtd.h5", "gprmax.h5"];

/// The result file that a target stands for.
///
/// # Errors
/// When a folder holds no result.
pub fn result_of(target: &Path) -> Result<PathBuf, CliError> {
    if !target.is_dir() {
        return Ok(target.into());
    }
    RESULTS.iter().map(|name| target.join(name)).find(|path| path.is_file()).ok_or_else(|| {
        CliError::input(format!(
            "the folder `{0}` holds no trace (`{1}` or `{2}`)\n\nhint: make one with `ballast-gpr run {0}`",
            target.display(),
            RESULTS[0],
            RESULTS[1]
        ))
    })
}

/// Both solvers' results of a folder, if both are there.
pub fn both_results(target: &Path) -> Option<[PathBuf; 2]> {
    let paths = RESULTS.map(|name| target.join(name));
    paths.iter().all(|path| path.is_file()).then_some(paths)
}

/// Reads the radar trace of a file: HDF5 by its ending (`.h5`, `.out`) or content, else two-column text.
///
/// # Errors
/// When the file cannot be read as either.
pub fn read(path: &Path) -> Result<AScan, CliError> {
    let path = result_of(path)?;
    let name = short_name(&path);
    if is_hdf5(&path)? {
        let traces = gprmax::read_traces(&path)?;
        let trace = traces
            .radar_trace()
            .cloned()
            .ok_or_else(|| CliError::input(format!("`{}` holds no electric field at a receiver", path.display())))?;
        return Ok(AScan { name, ..trace });
    }
    let text = files::read_text(&path)?;
    Ok(text::read_trace(&text, &name, &text::TextOptions::default())?)
}

/// The folder that `build` made, if the target is one or lies in one.
pub fn built_folder(target: &Path) -> Option<PathBuf> {
    let folder = if target.is_dir() { Some(target) } else { target.parent() };
    folder.filter(|folder| folder::is_built(folder)).map(Path::to_path_buf)
}

/// The last two parts of a path: enough to tell siblings apart.
fn short_name(path: &Path) -> String {
    let parts: Vec<_> =
        path.components().rev().take(2).map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}

fn is_hdf5(path: &Path) -> Result<bool, CliError> {
    if path.extension().is_some_and(|extension| extension == "h5" || extension == "out") {
        return Ok(true);
    }
    let mut head = [0; 8];
    let mut file = std::fs::File::open(path).map_err(files::FileError::of("read", path))?;
    let count = std::io::Read::read(&mut file, &mut head).map_err(files::FileError::of("read", path))?;
    Ok(count == 8 && head == *b"\x89HDF\r\n\x1a\n")
}

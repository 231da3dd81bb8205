//! What lies in an output folder, and when one may be written.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::files;
use crate::gprmax;
use crate::packing::settle;

/// Name of the resolved scene.
pub const SCENE: &str = "scene.toml";
/// Name of the manifest; written last, so that its presence says the folder is whole.
pub const MANIFEST: &str = "manifest.json";
/// Name of the gprMax input file.
pub const MODEL: &str = "model.in";
/// Files that decide what a solver computes, hashed into each result.
const MODEL_FILES: [&str; 4] = [MODEL, "model_geometry.h5", "model_materials.json", "model_pulse1.txt"];

/// Refuses a folder that may not be written, before anything is computed for it.
///
/// # Errors
/// When it is a file, or holds something and `force` is not set.
pub fn check_free(folder: &Path, force: bool) -> Result<(), CliError> {
    // What a stopped bed left is there to go on from.
    let of_a_stop = |name: &std::ffi::OsStr| name == settle::STATE || name == settle::STAGE;
    let occupied = fs::read_dir(folder)
        .is_ok_and(|mut entries| entries.any(|entry| entry.map_or(true, |entry| !of_a_stop(&entry.file_name()))));
    if folder.is_file() {
        return Err(CliError::input(format!(
            "`{}` is a file, not a folder\n\nhint: choose another name with `--out`",
            folder.display()
        )));
    }
    if occupied && !force {
        return Err(CliError::input(format!(
            "the folder `{}` is not empty\n\nhint: choose another with `--out`, or overwrite its files with `--force`",
            folder.display()
        )));
    }
    Ok(())
}

/// Makes a folder ready to be written.
///
/// # Errors
/// See [`check_free`]; when it cannot be made.
pub fn prepare(folder: &Path, force: bool) -> Result<(), CliError> {
    check_free(folder, force)?;
    files::create_folder(folder)?;
    let manifest = folder.join(MANIFEST);
    if manifest.exists() {
        fs::remove_file(&manifest).map_err(files::FileError::of("remove", &manifest))?;
    }
    Ok(())
}

/// Refuses to overwrite a file unless `force` is set.
///
/// # Errors
/// When the file exists and `force` is not set.
pub fn may_write(path: &Path, force: bool) -> Result<(), CliError> {
    if path.exists() && !force {
        return Err(CliError::input(format!(
            "`{}` exists already\n\nhint: choose another with `--out`, or overwrite it with `--force`",
            path.display()
        )));
    }
    Ok(())
}

/// A path as it can be typed in a shell: in single quotes where it holds more than plain characters.
pub fn typed(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

/// `stem` with a dot and an ending behind it, whatever dots the stem itself has.
pub fn with_ending(stem: &Path, ending: &str) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(".");
    name.push(ending);
    name.into()
}

/// Whether this is a folder that `build` has written completely.
pub fn is_built(folder: &Path) -> bool {
    folder.join(MANIFEST).is_file() && folder.join(MODEL).is_file()
}

/// A fingerprint of the files that decide what a solver computes (FNV-1a, 64 bit, hexadecimal).
///
/// # Errors
/// When a file cannot be read.
pub fn model_fingerprint(input: &Path) -> Result<String, CliError> {
    let folder = input.parent().unwrap_or(Path::new(""));
    let mut paths = vec![input.to_path_buf()];
    if input.file_name().is_some_and(|name| name == MODEL) {
        paths.extend(MODEL_FILES[1..].iter().map(|name| folder.join(name)).filter(|path| path.exists()));
    } else if let Ok(files) = gprmax::input_files(input) {
        paths.extend(files.into_iter().skip(1).filter(|path| path.exists()));
    }
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for path in &paths {
        let bytes = fs::read(path).map_err(files::FileError::of("read", path))?;
        for byte in bytes {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    Ok(format!("{hash:016x}"))
}

/// Beside a result: what made it.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RunRecord {
    /// Version of this record's format.
    pub format_version: u32,
    /// Program, version and commit.
    pub program: String,
    /// `fdtd` or `gprmax`.
    pub solver: String,
    /// `single` or `double`.
    pub precision: String,
    /// Threads used; absent when left to the solver.
    pub threads: Option<usize>,
    /// Fingerprint of the model's files.
    pub model: String,
    /// Wall time of the whole run, s.
    pub wall_seconds: f64,
    /// Wall time of the time loop, s, where the solver tells it.
    pub loop_seconds: Option<f64>,
}

impl RunRecord {
    /// The record's place beside a result.
    pub fn path_for(result: &Path) -> PathBuf {
        result.with_extension("run.json")
    }

    /// Reads the record beside a result, if there is a readable one.
    pub fn beside(result: &Path) -> Option<Self> {
        serde_json::from_str(&fs::read_to_string(Self::path_for(result)).ok()?).ok()
    }

    /// Writes the record beside a result.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_beside(&self, result: &Path) -> Result<(), CliError> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(files::write_bytes(&Self::path_for(result), text.as_bytes())?)
    }
}

/// Name, version and commit of this program.
pub fn program() -> String {
    format!("ballast-gpr {} ({})", env!("CARGO_PKG_VERSION"), env!("BALLAST_GPR_COMMIT"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_in_a_hint_can_be_typed() {
        assert_eq!(typed(Path::new("runs/fouling-20cm_1")), "runs/fouling-20cm_1");
        assert_eq!(typed(Path::new("my runs/a")), "'my runs/a'");
        assert_eq!(typed(Path::new("it's")), r"'it'\''s'");
    }

    #[test]
    fn an_ending_goes_behind_every_dot() {
        assert_eq!(with_ending(Path::new("a/cell-1.5mm"), "png"), Path::new("a/cell-1.5mm.png"));
    }
}

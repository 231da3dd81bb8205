//! Pythons on this machine.

use std::path::{Path, PathBuf};
use std::process::Command;

use etcetera::BaseStrategy as _;

use super::{CACHE_FOLDER, InstallError, PYTHON_TO_INSTALL_WITH};

/// A Python that has gprMax.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interpreter {
    /// The program.
    pub python: PathBuf,
}

impl Interpreter {
    /// A command that starts it: unbuffered, text in UTF-8 whatever the locale, and without modules from the current folder.
    pub fn command(&self) -> Command {
        start(&self.python)
    }
}

/// See [`Interpreter::command`]. A path with a folder in it is made absolute, since the command may run elsewhere; a bare
/// name is looked for in `PATH`.
pub(super) fn start(python: &Path) -> Command {
    let bare = python.components().count() == 1;
    let place = if bare { python.into() } else { std::path::absolute(python).unwrap_or_else(|_| python.into()) };
    let mut command = Command::new(place);
    command.env("PYTHONUNBUFFERED", "1").env("PYTHONUTF8", "1").env("PYTHONSAFEPATH", "1");
    command
}

/// Versions of what an [`Interpreter`] holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VersionInfo {
    /// Of Python.
    pub python: String,
    /// Of gprMax.
    pub gprmax: String,
    /// Of h5py.
    pub h5py: String,
}

/// The folder for what can be made again: `$BALLAST_GPR_CACHE`, else the user's cache folder.
///
/// # Errors
/// [`InstallError::NoCacheFolder`] for a user without a home.
pub fn cache_folder() -> Result<PathBuf, InstallError> {
    if let Some(folder) = std::env::var_os(CACHE_FOLDER).filter(|folder| !folder.is_empty()) {
        return Ok(folder.into());
    }
    let strategy = etcetera::choose_base_strategy().map_err(|_| InstallError::NoCacheFolder)?;
    Ok(strategy.cache_dir().join("ballast-gpr"))
}

/// Finds a Python that gprMax 4 runs on: `$BALLAST_GPR_PYTHON` alone if it is set, else the usual names, newest first.
pub(super) fn python_to_install_with() -> Result<PathBuf, InstallError> {
    let candidates: Vec<PathBuf> = match std::env::var_os(PYTHON_TO_INSTALL_WITH).filter(|name| !name.is_empty()) {
        Some(name) => vec![name.into()],
        None => ["python3.13", "python3.12", "python3.11", "python3", "python"].map(PathBuf::from).into(),
    };
    suitable(&candidates)
}

/// The first candidate of a suitable version.
fn suitable(candidates: &[PathBuf]) -> Result<PathBuf, InstallError> {
    let mut found = vec![];
    for candidate in candidates {
        match version(candidate) {
            Ok(version @ (3, 11..=13)) => {
                let _ = version;
                return Ok(candidate.clone());
            }
            Ok((major, minor)) => found.push(format!("  {}: Python {major}.{minor}", candidate.display())),
            Err(why) => found.push(format!("  {}: {why}", candidate.display())),
        }
    }
    Err(InstallError::NoPython { found })
}

fn version(python: &Path) -> Result<(u32, u32), String> {
    // `venv` and `ensurepip` are split off from Python on some systems; without them it is of no use here.
    let script = "import sys, venv, ensurepip; print(*sys.version_info[:2])";
    let output = start(python).args(["-c", script]).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<u32> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [major, minor] if output.status.success() => Ok((major, minor)),
        _ => {
            let errors = String::from_utf8_lossy(&output.stderr);
            Err(format!(
                "does not run ({})",
                errors.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("no message")
            ))
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Each candidate is listed with what it is.
    #[test]
    fn where_none_fits_all_are_listed() {
        let folder = tempfile::tempdir().unwrap();
        let fake = |name: &str, body: &str| {
            use std::os::unix::fs::PermissionsExt as _;
            let path = folder.path().join(name);
            std::fs::write(&path, format!("#!/bin/sh\n{body}\n")).unwrap();
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
            path
        };
        let old = fake("old", "echo 3 9");
        let broken = fake("broken", "echo 'No module named venv' >&2; exit 1");
        let missing = folder.path().join("missing");
        let message = suitable(&[old.clone(), broken.clone(), missing]).unwrap_err().to_string();
        assert!(message.contains(&format!("{}: Python 3.9", old.display())), "{message}");
        assert!(message.contains(&format!("{}: does not run (No module named venv)", broken.display())), "{message}");
        assert!(message.contains("missing: No such file"), "{message}");
        assert!(message.contains("BALLAST_GPR_PYTHON"), "{message}");
        let good = fake("good", "echo 3 12");
        assert_eq!(suitable(&[old, good.clone()]).unwrap(), good);
    }
}

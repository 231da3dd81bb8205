//! Why gprMax is not at hand.

use std::path::PathBuf;

use crate::files::FileError;

/// Why gprMax could not be found or installed.
#[derive(Debug, thiserror::Error)]
pub enum InstallError {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// No home folder to put a cache into.
    #[error("no cache folder is known for this user\n\nhint: set `BALLAST_GPR_CACHE` to a folder")]
    NoCacheFolder,
    /// No Python that gprMax runs on.
    #[error(
        "no Python from 3.11 to 3.13 was found, which gprMax needs; looked at:\n{}\n\nhint: set `BALLAST_GPR_PYTHON` to one",
        found.join("\n")
    )]
    NoPython {
        /// Each candidate and what it is.
        found: Vec<String>,
    },
    /// gprMax has not been installed.
    #[error("gprMax is not installed (looked in `{}`)\n\nhint: `ballast-gpr gprmax install` installs it there, or set `BALLAST_GPR_GPRMAX_PYTHON` to a Python that has it", folder.display())]
    NotInstalled {
        /// Where the private environment would be.
        folder: PathBuf,
    },
    /// A Python that cannot be started.
    #[error("`{}` could not be started: {source}", python.display())]
    NotStarted {
        /// The interpreter.
        python: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A Python without gprMax, or with one that does not start.
    #[error("`{}` cannot import gprMax:\n{output}", python.display())]
    NoGprMax {
        /// The interpreter.
        python: PathBuf,
        /// What it said, in full.
        output: String,
    },
    /// Another version of gprMax.
    #[error("`{}` has gprMax {found}, this program needs version 4 (made for {wanted})", python.display())]
    WrongVersion {
        /// The interpreter.
        python: PathBuf,
        /// The version found.
        found: String,
        /// The version that the tests hold fast.
        wanted: &'static str,
    },
    /// A step of the installation failed.
    #[error("`{command}` failed ({status}):\n{output}")]
    Step {
        /// The command.
        command: String,
        /// How it ended.
        status: String,
        /// All that it printed.
        output: String,
    },
}

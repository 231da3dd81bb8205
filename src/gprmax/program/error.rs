//! Why a run of gprMax gave no traces.

use std::path::PathBuf;

use super::super::output::OutputError;
use super::super::writer::WriteError;
use crate::files::FileError;
use crate::model::Order;

/// Why a run of gprMax gave no traces.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// The input file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// gprMax's output could not be read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The interpreter could not be started.
    #[error("`{}` could not be started: {source}\n\nhint: `ballast-gpr gprmax install` installs gprMax", python.display())]
    NotStarted {
        /// The interpreter.
        python: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// gprMax ended with an error.
    #[error("gprMax failed ({status}) on `{}`; its last lines:\n\n{}\n\nall that it printed: `{}`", input.display(), last_lines.join("\n"), log.display())]
    Failed {
        /// The input file.
        input: PathBuf,
        /// How it ended.
        status: String,
        /// The last 40 lines that it printed.
        last_lines: Vec<String>,
        /// A file with all of them.
        log: PathBuf,
    },
    /// gprMax ended well but left no output file.
    #[error("gprMax ended without an error on `{}`, but wrote no output; all that it printed: `{}`", input.display(), log.display())]
    NoOutput {
        /// The input file.
        input: PathBuf,
        /// A file with all that it printed.
        log: PathBuf,
    },
    /// Another scheme than gprMax's.
    #[error("gprMax has differences of order 2 only, but the model asks for order {order}\n\nhint: `--order 2`")]
    Order {
        /// What the model asks for.
        order: Order,
    },
    /// Other edges than gprMax's.
    #[error(
        "gprMax takes the mean of four cells on an edge, but the model asks for the mean over the true shapes\n\n\
         hint: `build --smoothing edges`, or leave `## ballast-gpr: averaging shapes` out of the file"
    )]
    Averaging,
    /// The caller asked to stop.
    #[error("stopped on request")]
    Stopped,
}

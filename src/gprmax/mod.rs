//! gprMax: its input files, its HDF5 files, and running it.
//!
//! - [`read_input`] turns an `.in` file into a [`Model`](crate::model::Model); [`write_input`] does the reverse.
//! - [`read_traces`] and [`write_traces`] speak gprMax's output files.
//! - [`install`](mod@install) finds or installs gprMax, [`GprMax`] runs it as a separate process.
//!
//! Nothing of gprMax is copied or linked: its formats and rules are facts, its program is called.

mod geometry;
pub mod hdf5;
pub mod install;
mod output;
mod program;
mod reader;
mod writer;

pub use geometry::{GeometryError, GeometryWriteError, geometry_files, geometry_paths, view_files, view_paths};
pub use install::{InstallError, Interpreter, VersionInfo};
pub use output::{
    OutputError, OutputWriteError, read_snapshot, read_traces, snapshot_file, snapshot_folder, snapshot_path,
    snapshot_to_bytes, traces_to_bytes, write_traces,
};
pub use program::{GprMax, GprMaxRun, RunError, check_scheme};
pub use reader::{
    COMMANDS, CommandKind, Directives, InFileError, Input, Note, Problem, input_files, read_directives, read_input,
    read_model,
};
pub use writer::{DEFAULT_TEMPLATE, InputOptions, WriteError, excitation_text, number, write_input};

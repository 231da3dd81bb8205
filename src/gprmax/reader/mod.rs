//! Reading gprMax input files.
//!
//! The grammar is gprMax 4.0.1's: a command starts at the first column with `#`, lines that start otherwise (also with a
//! blank) are ignored, `##` starts a comment, a space follows the first colon, essential commands are `#domain`,
//! `#dx_dy_dz` and `#time_window`, and commands other than objects may stand in any order. What the embedded solver cannot
//! do is an error that names the command; what does not change a trace becomes a [`Note`]. Nothing is dropped in silence.

mod boundary;
mod build;
mod commands;
mod directives;
mod dispersion;
mod error;
mod excitation;
mod fractal;
mod include;
mod lines;
mod multiple;
mod outputs;
mod shapes;
mod single;
mod sources;
mod values;

pub(super) use directives::DIRECTIVE;

pub use build::{Input, Note, input_files, read_directives, read_input, read_model};
pub use commands::{COMMANDS, CommandKind};
pub use directives::Directives;
pub use error::{InFileError, Problem};

//! Writing gprMax input files.
//!
//! [`templates/model.in`](DEFAULT_TEMPLATE) lays the file out; a user's own template may take its place. It sees one flat
//! struct in which every field is always present and every number is already text.

mod error;
mod number;
mod pulse_files;
mod render;
mod voxel_files;

pub use error::WriteError;
pub use number::number;
pub use pulse_files::excitation_text;
pub use render::{DEFAULT_TEMPLATE, InputOptions, write_input};

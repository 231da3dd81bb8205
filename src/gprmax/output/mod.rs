//! gprMax's output files: `.h5` of version 4 and `.out` of version 3.

mod error;
mod read;
mod write;

pub use error::{OutputError, OutputWriteError};
pub use read::read_traces;
pub use write::{traces_to_bytes, write_traces};

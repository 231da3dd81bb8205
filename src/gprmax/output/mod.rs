//! gprMax's output files: `.h5` of version 4 and `.out` of version 3.

mod error;
mod read;
mod snapshot;
mod write;

pub use error::{OutputError, OutputWriteError};
pub use read::read_traces;
pub(super) use snapshot::vtk_image;
pub use snapshot::{read_snapshot, snapshot_file, snapshot_folder, snapshot_path, snapshot_to_bytes};
pub(super) use write::{LAYOUT, generated};
pub use write::{traces_to_bytes, write_traces};

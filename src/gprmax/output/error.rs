//! What can be wrong with an output file.

use std::path::PathBuf;

use super::super::hdf5::Hdf5Error;
use crate::files::FileError;

/// Why an output file was not read.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The HDF5 file is missing or damaged, or lacks something.
    #[error(transparent)]
    Hdf5(#[from] Hdf5Error),
    /// It is an HDF5 file, but not an output of gprMax.
    #[error("`{}` holds no receivers\n\nhint: an output file of gprMax has a group `/rxs` with `rx1` in it; does the model have an `#rx`?", path.display())]
    NoReceivers {
        /// The file.
        path: PathBuf,
    },
    /// The traces do not have the length that the file claims.
    #[error("`{dataset}` in `{}` has the shape {shape:?}, {iterations} samples were expected", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// The dataset.
        dataset: String,
        /// Its extents.
        shape: Vec<usize>,
        /// Samples per trace, from the attribute `Iterations`.
        iterations: usize,
    },
    /// A number that no run can have.
    #[error("attribute `{name}` in `{}` is {value}, it should be {limit}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The attribute.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        limit: &'static str,
    },
}

/// Why an output file was not written.
#[derive(Debug, thiserror::Error)]
pub enum OutputWriteError {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// The data could not be laid out.
    #[error(transparent)]
    Hdf5(#[from] Hdf5Error),
    /// The traces are not those of the model.
    #[error("the traces have {traces} receivers, the model has {model}")]
    Receivers {
        /// In the traces.
        traces: usize,
        /// In the model.
        model: usize,
    },
    /// A trace has another length than the run.
    #[error("{component} of receiver `{receiver}` has {found} samples, the run has {wanted}")]
    Length {
        /// Name of the receiver.
        receiver: String,
        /// Name of the component.
        component: &'static str,
        /// Samples of the trace.
        found: usize,
        /// Samples of the run.
        wanted: usize,
    },
    /// A source refers to a waveform that is not there.
    #[error("waveform number {0} of the model is not there")]
    Waveform(usize),
}

//! gprMax's files: HDF5, input, geometry and output files. None of these tests needs gprMax itself.

#[path = "../common/mod.rs"]
mod common;
mod hdf5;
mod media;
mod output;
mod reader;
mod writer;

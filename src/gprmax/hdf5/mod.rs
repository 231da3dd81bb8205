//! HDF5 files behind eight small functions; the only place that names the crate that reads and writes them.
//!
//! Reading: [`H5File::open`], [`H5File::has`], [`H5File::children`], [`H5File::shape`], [`H5File::read_f64`] (and its
//! siblings), [`H5File::attribute`]. Writing: [`to_bytes`] and [`write`](fn@write) of a [`Group`].

mod error;
mod read;
mod write;

pub use error::Hdf5Error;
pub use read::H5File;
pub use write::{Attribute, Data, Dataset, Group, to_bytes, write};

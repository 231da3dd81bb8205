//! Blocks of voxels as gprMax 4 reads them: an HDF5 file of indices and a JSON database of materials.
//!
//! gprMax 4 no longer takes the text file of materials that gprMax 3 had, and neither does this module.

mod database;
mod error;
mod voxels;

pub(super) use database::{Database, write_database};
pub use error::GeometryError;
pub(super) use voxels::{read_voxels, voxel_group};

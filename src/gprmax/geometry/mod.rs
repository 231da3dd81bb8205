//! Blocks of voxels as gprMax 4 reads them: an HDF5 file of indices and a JSON database of materials.
//!
//! gprMax 4 no longer takes the text file of materials that gprMax 3 had, and neither does this module.

mod catalogue;
mod database;
mod error;
mod finished_file;
mod request;
mod views;
mod voxels;

pub(super) use database::{Database, write_database};
pub use error::GeometryError;
pub(super) use request::geometry_names;
pub use request::{GeometryWriteError, geometry_files, geometry_paths};
pub use views::{view_files, view_paths};
pub(super) use voxels::{read_voxels, voxel_group};

//! What can be wrong with a geometry file or a material database.

use std::path::PathBuf;

use super::super::hdf5::Hdf5Error;
use crate::files::FileError;

/// Why a block of voxels was not read.
#[derive(Debug, thiserror::Error)]
pub enum GeometryError {
    /// The HDF5 file is missing or damaged, or lacks something.
    #[error(transparent)]
    Hdf5(#[from] Hdf5Error),
    /// The database is missing or unreadable.
    #[error(transparent)]
    File(#[from] FileError),
    /// The pair of HDF5 file and text file that gprMax 3 used.
    #[error(
        "`{}` has no `/material_keys`: it is a geometry file of gprMax 3\n\nhint: `python -m gprMax.toolboxes.MaterialDatabase convert-geometry {} MATERIALS.txt` converts it",
        path.display(), path.display()
    )]
    OldFormat {
        /// The HDF5 file.
        path: PathBuf,
    },
    /// Finished edges that do not fit the cells.
    #[error("`{dataset}` in `{}` has the shape {shape:?}, it should be {wanted:?}", path.display())]
    Edges {
        /// The HDF5 file.
        path: PathBuf,
        /// `/ID`, `/rigidE` or `/rigidH`.
        dataset: &'static str,
        /// Extents.
        shape: Vec<usize>,
        /// What they should be.
        wanted: Vec<usize>,
    },
    /// An edge without a material.
    #[error("`/ID` in `{}` holds the index {index}, allowed are 0 to {last}", path.display())]
    EdgeIndex {
        /// The HDF5 file.
        path: PathBuf,
        /// The index.
        index: i64,
        /// The highest that has a material.
        last: i64,
    },
    /// The cells of the file are not those of the model.
    #[error("`{}` has cells of {found:?} m, the model has cells of {wanted:?} m", path.display())]
    Spacing {
        /// The HDF5 file.
        path: PathBuf,
        /// Cell sizes of the file, m.
        found: Vec<f64>,
        /// Cell sizes of the model, m.
        wanted: [f64; 3],
    },
    /// The indices are not an array over x, y, z that the model can take.
    #[error("`/data` in `{}` has the shape {shape:?}, it should have three extents above zero{}", path.display(), if *two_dimensional { ", the one along the invariant axis 1" } else { "" })]
    Shape {
        /// The HDF5 file.
        path: PathBuf,
        /// Extents.
        shape: Vec<usize>,
        /// Whether the model is two-dimensional.
        two_dimensional: bool,
    },
    /// An index without a material.
    #[error("`/data` in `{}` holds the index {index}, allowed are -1 (leave as is) to {last}", path.display())]
    Index {
        /// The HDF5 file.
        path: PathBuf,
        /// The index.
        index: i16,
        /// The highest that has a material.
        last: i64,
    },
    /// The file was made for another database.
    #[error("`{}` was written for the material database `{recorded}`, not for `{given}`", path.display())]
    OtherDatabase {
        /// The HDF5 file.
        path: PathBuf,
        /// Name in the file.
        recorded: String,
        /// Name in the command.
        given: String,
    },
    /// The database is not JSON of the right form.
    #[error("`{}` is not a material database of gprMax 4: {reason}", path.display())]
    NotADatabase {
        /// The JSON file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A material that the database lacks.
    #[error("`{}` has no material `{key}`", path.display())]
    NoMaterial {
        /// The JSON file.
        path: PathBuf,
        /// Key of the material.
        key: String,
    },
    /// A material of a kind that is not supported.
    #[error(
        "material `{key}` in `{}` is {kind}, which the embedded solver cannot do\n\nhint: `--solver gprmax` runs the file in gprMax itself",
        path.display()
    )]
    Kind {
        /// The JSON file.
        path: PathBuf,
        /// Key of the material.
        key: String,
        /// What it is.
        kind: String,
    },
    /// A material with an impossible value.
    #[error("{what} of material `{key}` in `{}` is {value}, it should be {limit}", path.display())]
    Value {
        /// The JSON file.
        path: PathBuf,
        /// Key of the material.
        key: String,
        /// What the number means.
        what: &'static str,
        /// The number.
        value: f64,
        /// What is allowed.
        limit: &'static str,
    },
    /// More materials than a model holds.
    #[error("`{}` brings the model to {count} materials, {limit} is the most", path.display())]
    TooManyMaterials {
        /// The HDF5 file.
        path: PathBuf,
        /// How many there would be.
        count: usize,
        /// The most.
        limit: usize,
    },
}

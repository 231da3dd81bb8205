//! What can go wrong when writing an input file.

use super::super::hdf5::Hdf5Error;
use crate::files::FileError;

/// Why an input file was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// A geometry file could not be laid out.
    #[error(transparent)]
    Hdf5(#[from] Hdf5Error),
    /// The template is wrong.
    #[error("the template `{name}` could not be filled in: {reason}")]
    Template {
        /// File name of the template.
        name: String,
        /// What the template engine said, with the line.
        reason: String,
    },
    /// The material database could not be laid out.
    #[error("the material database could not be laid out: {0}")]
    Database(#[from] serde_json::Error),
    /// An identifier that gprMax would not read back.
    #[error("gprMax does not take `{id}` as the name of a {what}: it must not be empty, nor hold blanks{}", if *what == "material" { " or `+`" } else { "" })]
    Identifier {
        /// `material`, `waveform`, `receiver` or `geometry file`.
        what: &'static str,
        /// The identifier.
        id: String,
    },
    /// A block of cells that brings its own edges.
    #[error(
        "object {number}, a block of cells with edges of its own, is not written again\n\nhint: use the input file and the geometry file that it came from"
    )]
    BlockEdges {
        /// Place in the list of objects, from 1.
        number: usize,
    },
    /// A value that gprMax refuses.
    #[error("gprMax does not take {value} as {what}: it must be {limit}")]
    Value {
        /// What the number means.
        what: String,
        /// The number.
        value: f64,
        /// What is allowed.
        limit: &'static str,
    },
    /// A material with poles of more than one kind.
    #[error(
        "`{id}` has poles of more than one kind: gprMax knows only Debye, only Lorentz or only Drude poles in a material"
    )]
    KindsOfPoles {
        /// Identifier of the material.
        id: String,
    },
    /// A block of voxels of a material that a database of ours cannot hold.
    #[error(
        "`{id}` has Lorentz or Drude poles, which are not written into a material database\n\nhint: use boxes and spheres"
    )]
    Resonant {
        /// Identifier of the material.
        id: String,
    },
    /// Something in the model refers to something that is not there.
    #[error("{what} number {index} of the model is not there")]
    Dangling {
        /// `material` or `waveform`.
        what: &'static str,
        /// The index.
        index: usize,
    },
    /// More materials in one block of voxels than 16-bit indices can name.
    #[error("a block of voxels has {count} materials, gprMax's geometry files hold at most {limit}")]
    TooManyMaterials {
        /// Materials in the block.
        count: usize,
        /// The most.
        limit: usize,
    },
}

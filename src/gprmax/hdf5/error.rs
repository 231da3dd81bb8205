//! What can go wrong with an HDF5 file.

use std::path::PathBuf;

use crate::files::FileError;

/// A file that could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum Hdf5Error {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// The first bytes are not those of an HDF5 file.
    #[error("`{}` is not an HDF5 file", path.display())]
    NotHdf5 {
        /// The file.
        path: PathBuf,
    },
    /// The file starts like an HDF5 file but cannot be decoded.
    #[error(
        "`{}` is cut short or damaged: {reason}\n\nhint: was the run that wrote it stopped, or the copy interrupted?",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What could not be decoded.
        reason: String,
    },
    /// A dataset or group is not there.
    #[error("`{object}` is missing in `{}`", path.display())]
    MissingObject {
        /// The file.
        path: PathBuf,
        /// Path inside the file.
        object: String,
    },
    /// An attribute is not there.
    #[error(
        "attribute `{name}` of `{object}` is missing in `{}`\n\nhint: gprMax writes it; was the run cut short, or the file made by another program?",
        path.display()
    )]
    MissingAttribute {
        /// The file.
        path: PathBuf,
        /// Path inside the file.
        object: String,
        /// Name of the attribute.
        name: String,
    },
    /// A dataset or attribute holds something else than expected.
    #[error("`{object}` in `{}` should hold {wanted} but holds {found}", path.display())]
    WrongType {
        /// The file.
        path: PathBuf,
        /// Path inside the file; for an attribute with ` @ name` behind it.
        object: String,
        /// What was expected.
        wanted: &'static str,
        /// What is there.
        found: String,
    },
    /// A dataset claims to be larger than the file could hold, even compressed.
    #[error("`{object}` in `{}` claims {bytes} bytes, more than a file of {file_bytes} bytes can hold", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Path inside the file.
        object: String,
        /// Bytes claimed.
        bytes: u128,
        /// Bytes of the file.
        file_bytes: u64,
    },
    /// The data could not be laid out as HDF5.
    #[error("the data could not be laid out as HDF5: {reason}")]
    Encode {
        /// What the encoder said.
        reason: String,
    },
}

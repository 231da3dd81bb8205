//! Why a file of an instrument could not be read or written.

use std::path::PathBuf;

use crate::files::FileError;
use crate::trace::BScanError;

/// Why a file of an instrument could not be read or written. Byte offsets are counted from zero.
#[derive(Debug, thiserror::Error)]
pub enum MeasuredError {
    /// The file could not be opened or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Traces that are no radargram.
    #[error(transparent)]
    Traces(#[from] BScanError),
    /// A folder, a device or a pipe.
    #[error("`{}` is not a regular file", path.display())]
    NotAFile {
        /// What was named.
        path: PathBuf,
    },
    /// An ending of no known instrument.
    #[error("the ending of `{}` is that of no instrument\n\nhint: known are {known}", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The known endings.
        known: String,
    },
    /// The other file of a pair is missing.
    #[error("`{}` needs its other half beside it: a file of the same name that ends with {wanted}", path.display())]
    NoCompanion {
        /// The file that is there.
        path: PathBuf,
        /// Endings of the other.
        wanted: &'static str,
    },
    /// Two files could be the other half.
    #[error(
        "`{}` describes both `{}` and `{}`\n\nhint: name the one to read",
        path.display(), first.display(), second.display()
    )]
    TwoCompanions {
        /// The header.
        path: PathBuf,
        /// One file of samples.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// The file ends before something that it should hold.
    #[error("`{}` ends too early: `{field}` at byte {offset} needs {needed} bytes, the file has {size}", path.display())]
    Ends {
        /// The file.
        path: PathBuf,
        /// What is cut off.
        field: String,
        /// Where it begins.
        offset: u64,
        /// Bytes that it needs.
        needed: u64,
        /// Bytes of the file.
        size: u64,
    },
    /// A field that cannot be right.
    #[error("`{}`: `{field}` at byte {offset} is {value}: {limit}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Name of the field.
        field: String,
        /// Where it stands.
        offset: u64,
        /// What it says.
        value: String,
        /// What it may say.
        limit: String,
    },
    /// A header of text that lacks a field.
    #[error("`{}` has no field `{field}` in its {size} bytes", path.display())]
    NoField {
        /// The file.
        path: PathBuf,
        /// Name of the field.
        field: &'static str,
        /// Bytes of the file.
        size: u64,
    },
    /// Something that a format cannot hold.
    #[error("{format} cannot hold {what} of {value}: {limit}")]
    CannotHold {
        /// The format.
        format: &'static str,
        /// What cannot be held.
        what: &'static str,
        /// Its value.
        value: String,
        /// What would do.
        limit: String,
    },
}

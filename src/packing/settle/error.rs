//! What can go wrong while a bed settles.

use crate::files::FileError;
use crate::packing::dem::DemError;
use crate::packing::error::PackingError;

/// Why a bed did not settle.
#[derive(Debug, thiserror::Error)]
pub enum SettleError {
    /// The stones cannot be had.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// The motion failed.
    #[error(transparent)]
    Dem(#[from] DemError),
    /// The caller asked to stop.
    #[error("stopped on request")]
    Stopped,
    /// The state to go on from could not be kept or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A ratio or a time that is not above zero.
    #[error("`packing.dem.{key}` is {value}, but must be above 0")]
    NotAboveZero {
        /// Key in the scene file.
        key: &'static str,
        /// What it is.
        value: f64,
    },
}

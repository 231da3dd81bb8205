//! The embedded finite-difference time-domain solver, gprMax's numerics: two-dimensional (TMz, invariant along z) here, all
//! else in `three`; [`Model::route`](crate::model::Model::route) decides.
//!
//! [`Fdtd`] fulfils [`Forward`](crate::forward::Forward). A model is painted, turned into coefficients (`setup`), cut
//! into blocks of rows, one per thread (`block`), and stepped (`team`), several steps per pass over the rows; the loops over
//! a row are in `kernel`. Nodes where no wave is that a receiver will see are not stepped (`reach`).
//!
//! An effect that a model does not call for has no array: without conductivity there is no `ca`, the absorbing boundary has
//! memory in its slabs only, and Debye relaxation on dispersive nodes only.
//!
//! Numbers below 1e-38 (single precision) are computed as IEEE 754 has them, never flushed to zero, so that the bits are the
//! same everywhere. They occur in thin rims only: ahead of the first arrival, and some ninety skin depths inside a
//! conductor. A field made of nothing else runs at 0.77 of the usual speed (750 x 500 cells, Zen 5, one thread).

mod block;
mod checkpoint;
mod coefficients;
mod conductor;
mod dispersion;
mod error;
mod instructions;
mod keeping;
mod kernel;
mod lanes;
mod layout;
mod predict;
mod reach;
mod real;
mod setup;
mod slab;
mod solver;
mod state;
mod team;
mod three;

pub use checkpoint::{CheckpointError, CheckpointEvent, Checkpoints};
pub use error::FdtdError;
pub use instructions::InstructionSet;
pub use keeping::{Keeping, Snapshots};
pub use predict::{Prediction, TimeShares, memory, predict};
pub use reach::{Reach, reach};
pub use solver::{Fdtd, Precision, Stats, Stepping};
pub use three::{memory_three, predict_three};

//! The embedded finite-difference time-domain solver: two-dimensional (TMz, invariant along z), gprMax's numerics.
//!
//! [`Fdtd`] fulfils [`Forward`](crate::forward::Forward). A model is painted, turned into coefficients (`setup`), cut
//! into blocks of rows, one per thread (`block`), and stepped (`team`); the loops over a row are in `kernel`. An effect
//! that a model does not call for has no array: without conductivity there is no `ca`, the absorbing boundary has memory
//! in its slabs only, and Debye relaxation on dispersive nodes only.

mod block;
mod coefficients;
mod error;
mod instructions;
mod kernel;
mod layout;
mod predict;
mod real;
mod setup;
mod solver;
mod team;

pub use error::FdtdError;
pub use instructions::InstructionSet;
pub use predict::{Prediction, predict};
pub use solver::{Fdtd, Precision, Stats};

//! Running gprMax as a process of its own.

mod error;
mod process;
mod progress;
mod run;

pub use error::RunError;
pub use run::{GprMax, GprMaxRun, check_scheme};

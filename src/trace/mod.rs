//! A-scans and B-scans: what a radar, simulated or real, gives. Every later module speaks of these.

mod ascan;
mod bscan;
mod snapshot;

pub use ascan::{AScan, Component, ReceiverTraces, Traces};
pub use bscan::{BScan, BScanError};
pub use snapshot::{FieldSnapshot, FieldValues};

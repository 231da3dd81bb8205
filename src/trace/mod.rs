//! A-scans and B-scans: what a radar, simulated or real, gives. Every later module speaks of these.

mod ascan;
mod snapshot;

pub use ascan::{AScan, Component, ReceiverTraces, Traces};
pub use snapshot::{FieldSnapshot, FieldValues};

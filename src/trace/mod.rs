//! A-scans and B-scans: what a radar, simulated or real, gives. Every later module speaks of these.

mod ascan;

pub use ascan::{AScan, Component, ReceiverTraces, Traces};

//! A mutational fuzzer for the readers: seeded, deterministic, in plain Rust.
#![allow(dead_code, reason = "the test and the long run each use their part")]

pub mod mutate;
pub mod targets;
pub mod watch;

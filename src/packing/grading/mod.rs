//! Sieve curves: what share of a ballast, by mass, passes each sieve.
//!
//! [`Grading`] holds a checked curve, made from sieves, by name ([`Grading::named`]), from CSV ([`Grading::from_csv`])
//! or from TOML. [`Grading::classes`] splits it into the size classes that a packing draws its stones from.

mod builtin;
mod classes;
mod curve;
mod error;
mod text;

pub use classes::{ClassReading, LARGEST_UNSIZED_SHARE, SizeClass};
pub use curve::{Confidence, Grading, Sieve};
pub use error::GradingError;

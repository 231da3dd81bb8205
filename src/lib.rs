//! From a sieve curve to a ground-penetrating-radar trace of railway ballast.
#![warn(missing_docs)]

pub mod cli;
pub mod compare;
pub mod fdtd;
pub mod files;
pub mod forward;
pub mod geometry;
pub mod gprmax;
pub mod material;
pub mod model;
pub mod packing;
pub mod plot;
pub mod raster;
pub mod scene;
pub mod study;
pub mod trace;
pub mod units;

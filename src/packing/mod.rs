//! Grading in, particles out.
//!
//! [`pack`] makes a 2-D bed by the method of Benedetto et al. 2018 (doi:10.1111/mice.12342): stones drawn from a sieve
//! curve ([`grading`]) are placed at random without overlap and then dropped straight down ([`compact`]). The height and
//! density to start from follow from the height and voids wanted ([`optimise`]); [`calibrate`] refits that relation.
//! [`export`] writes and reads packings. Beds in space are [`spheres`]: their statistics, sections through them, and random
//! sequential addition.
//!
//! Where the paper's print is at odds with itself the code says so at the place: eqs. 15, 22, 23, 25–27, the order inside
//! a strip, and the sizes a sieve stands for ([`grading::ClassReading`]).

pub mod calibrate;
pub mod dem;
pub mod export;
pub mod grading;
pub mod spheres;

mod bed;
mod compaction;
mod error;
mod optimise;
mod porosity;
mod rsa;
mod run;
pub mod settle;
mod statistics;
mod void_cells;

pub use bed::{FORMAT_VERSION, Overlap, Packing};
pub use compaction::compact;
pub use error::PackingError;
pub use grading::{ClassReading, Grading};
pub use optimise::{CompactionFit, RsaStart, optimise};
pub use porosity::Porosity;
pub use rsa::ClassFilled;
pub use run::{InputRule, RsaInput, RsaOutcome, pack};
pub use spheres::{SlicePlane, SphereBed, SphereContact};
pub use statistics::{GradingRow, ProfileRow};

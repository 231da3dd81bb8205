//! Beds of spheres: what they are, what they are like, and the discs that a plane cuts out of them.
//!
//! A [`SphereBed`] stands beside [`Packing`](super::Packing) and not within it: adsorption, compaction, the CAD files and the
//! 2-D raster are about discs, and none of them has anything to do with a sphere. What both share is the reader
//! ([`export::particles_from_json`](super::export::particles_from_json)) and the bridge, [`SphereBed::slice`].

mod bed;
mod coordination;
mod forces;
mod random_addition;
mod sizes;
mod slice;
mod statistics;

pub use bed::{SphereBed, SphereContact};
pub use coordination::{Coordination, TOUCHING};
pub use forces::{ForceBin, ForceDistribution};
pub use random_addition::{RandomAddition, place_spheres, random_addition};
pub use sizes::{mean_stone_volume, stone_diameters};
pub use slice::SlicePlane;

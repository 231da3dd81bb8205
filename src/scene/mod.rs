//! Layers, packing, materials and antenna: what the user wrote, and what it comes to.
//!
//! A [`SceneSpec`] is the TOML file (or the flags) with every default filled in; a [`Scene`] is that, checked once and
//! packed, with the derived figures (bulk permittivities, arrivals, fouling indices) that `explain` and the manifest show.

mod arrivals;
mod bed;
mod check;
mod error;
mod fouling;
mod medium;
mod mixture;
mod resolve;
mod sample;
mod spec;

pub use arrivals::{Arrivals, Layer, arrivals};
pub use bed::{Bed, BulkPermittivity};
pub use error::SceneError;
pub use fouling::{FoulingAmount, FoulingReport};
pub use medium::{MaterialSpec, Medium};
pub use resolve::{Scene, resolve, resolve_with, rsa_input};
pub use sample::settle_input;
pub use spec::{
    AntennaSpec, Dimension, EquivalentStone, FoulingSpec, GeometryKind, GradingSpec, GridSpec, MoistureSpec,
    PackingMethod, PackingSpec, SceneSpec, Smoothing, TankSpec,
};

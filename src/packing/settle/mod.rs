//! A bed of spheres that fell into its box: gravitational packing with the discrete elements.

mod error;
mod keep;
mod run;
mod spec;
mod stage;

pub use error::SettleError;
pub use keep::{STAGE, STATE};
pub use run::settle;
pub use spec::{SettleInput, SettleSpec, Settled, Settling, Stage};
pub use stage::box_of_stones;

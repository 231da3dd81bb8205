//! The law of a contact: Hertz and Mindlin with damping and Coulomb's limit, and the models of rolling friction.

mod damping;
mod normal;
mod rolling;
mod table;
mod tangential;

pub use damping::{LEAST_RESTITUTION, UNDAMPED_RESTITUTION, damping_share};
pub use normal::normal;
pub use rolling::{Bounded, Rolling, RollingSpring, bounded, constant_torque, elastic_plastic};
pub use table::{Laws, effective_young};
pub use tangential::{Before, tangential};

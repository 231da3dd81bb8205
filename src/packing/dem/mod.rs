//! Spheres that press, rub and roll on each other: discrete elements with bounded rolling friction.
//!
//! A [`Setup`] holds grains, walls and their materials; a [`Simulation`] moves them step by step by the law of
//! Irazábal, Salazar & Oñate 2017: Hertz and Mindlin with viscous damping, Coulomb's limit and rolling friction that is
//! bounded by the moment that stops a grain within the step ([`Rolling::Bounded`]; eq. 9 of the paper is misprinted, and
//! the code says where). What a set-up does not call for is absent: without friction contacts have no history and grains
//! no torque, far from walls nobody looks for them.
//!
//! One step is two sweeps: over the near pairs, each of which writes into slots of its own, and over the grains, each of which
//! gathers its slots in a fixed order, bounds its rolling friction and moves. Grains are kept in the order of their places
//! and the list of near pairs lasts until a contact could be missing from it. The bits do not depend on the number of
//! threads, on how the steps are split into calls, or on being saved and loaded in between.
//!
//! ```
//! use std::num::NonZeroUsize;
//! use ballast_gpr::geometry::Sphere;
//! use ballast_gpr::packing::dem::{Grain, Setup, Simulation, Stuff, Wall};
//!
//! // A stone dropped onto a floor comes to rest one radius above it, less a few tenths of a micrometre.
//! let stone = Grain::at_rest(Sphere { centre: [0.0, 0.0, 0.03], radius: 0.025 });
//! let mut setup = Setup::new(Stuff::BALLAST, vec![stone]);
//! setup.walls.push(Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0));
//! let mut simulation = Simulation::new(setup)?;
//! simulation.run_quietly(20_000, NonZeroUsize::MIN)?;
//! let rest = simulation.grains()[0].sphere.centre[2];
//! assert!((rest - 0.025).abs() < 1e-6);
//! # Ok::<(), ballast_gpr::packing::dem::DemError>(())
//! ```

mod barrier;
mod bodies;
mod cells;
mod check;
mod error;
mod grains;
mod insert;
mod instructions;
mod keeping;
mod kernel;
mod law;
mod mesh_grid;
mod pairs;
mod rebuild;
mod report;
mod segment;
mod setup;
mod shared;
mod simulation;
mod stuff;
mod tape;
mod time_step;
mod vector;
mod wall_contacts;
mod watch;

pub use bodies::BodyState;
pub use error::DemError;
pub use law::{LEAST_RESTITUTION, Rolling, UNDAMPED_RESTITUTION, damping_share};
pub use rebuild::Lost;
pub use report::{Contact, WallContact, WallLoad};
pub use setup::{Grain, Limits, Motion, Setup, TimeStep, Wall, WallShape};
pub use simulation::{Progress, Simulation};
pub use stuff::{Pairing, Stuff};
pub use time_step::{StepLength, WARN_CONTACT, WARN_RAYLEIGH, contact_time, rayleigh_time};

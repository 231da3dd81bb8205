//! The Yee scheme in three dimensions, with gprMax's numerics: for every model of
//! [`Route::Space`](crate::model::Route::Space).
//!
//! A model is painted, turned into coefficients (`setup`, its sources `drive`), cut into planes across x (`plane`, with
//! `grades` for the coefficients of its edges, `absorbing` and `poles` for its memories, `step` for what is done to it) and
//! stepped by passes that follow one another through the planes (`team`); the loops over a row are in `kernel`. Rows that
//! no wave has reached, or that no receiver will hear of, are not stepped (`reach`). Where the model asks for snapshots,
//! all passes end at their steps and the fields are read off the planes (`camera`). Where surfaces lie aslant `couple` lets the axes take
//! from each other. An effect that a model does not call for has no array. Two-dimensional models (TE, TM across x or y, and TMz beyond what the plane knows) run here too,
//! turned so that y is the invariant axis (`turn`), with three components and one row in a plane.

mod absorbing;
mod absorbing_fourth;
mod arena;
mod camera;
mod couple;
mod drive;
mod fields;
mod fourth;
mod grades;
mod instructions;
mod kernel;
mod plane;
mod poles;
mod reach;
mod run;
mod setup;
mod sheet;
mod step;
mod team;
mod turn;
mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use run::{memory_three, predict_three};

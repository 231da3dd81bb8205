//! The Yee scheme in three dimensions, with gprMax's numerics: for every model of
//! [`Route::Space`](crate::model::Route::Space).
//!
//! A model is painted, turned into coefficients (`setup`), cut into planes across x (`plane`, with `grades` for the
//! coefficients of its edges, `absorbing` and `poles` for its memories) and stepped by passes that follow one another
//! through the planes (`team`); the loops over a row are in `kernel`. An effect that a model does not call for has no
//! array. Grids of one cell along an axis (TMx, TMy, and TMz beyond what the plane knows) run here
//! too: the walls along that axis leave only its own fields.

mod absorbing;
mod grades;
mod instructions;
mod kernel;
mod plane;
mod poles;
mod run;
mod setup;
mod sheet;
mod team;

pub use run::predict_three;

//! Comparing two traces, simulated or measured: what was done to them, where their echoes are, and how far apart they are.
//!
//! [`compare`] takes two traces through the same named steps and returns the prepared traces, their envelopes and spectra,
//! the picks, and the metrics in the order in which they matter: times of the surface and plate echo first. Each step is
//! also a plain function on a trace. [`ensemble`] puts
//! many comparisons with one measurement together, [`structural_similarity`] compares radargrams. [`relative_l2`] is the number for "two solvers agree". [`process`] holds the
//! steps of the field. [`text`] reads two-column files,
//! [`permittivity`] turns picks into permittivities.
//!
//! Differences are the second trace minus the first, so a positive time means that the second is later.

mod comparison;
mod ensemble;
mod error;
mod fields;
mod metrics;
pub mod permittivity;
mod picks;
mod plate;
pub mod process;
pub mod pulse;
mod radargrams;
mod resample;
mod similarity;
mod spectrum;
mod steps;
pub mod text;
mod warp;

pub use comparison::{CompareOptions, Comparison, Normalisation, Polarity, TimeZero, compare};
pub use ensemble::{Ensemble, Spread, ensemble};
pub use error::CompareError;
pub use fields::worst_field_difference;
pub use metrics::{CrossCorrelation, Metrics, TimeError, correlation, cross_correlation, relative_l2, rmse};
pub use picks::{Echo, EchoPick, Event, ExpectedEchoes, NoEcho, Pick, PickedOn, Picks, pick_echoes};
pub use plate::{PlateEcho, plate_echo};
pub use radargrams::prepare_as;
pub use resample::resample;
pub use similarity::{SIMILARITY_WINDOW, structural_similarity};
pub use spectrum::{Spectrum, envelope, spectrum};
pub use steps::{
    Step, crop, first_peak, flip, normalise, remove_dc, resample_to_step, set_time_zero, subtract_reference,
};
pub use warp::{TimeWarp, time_warp};

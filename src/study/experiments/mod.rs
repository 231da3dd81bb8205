//! Experiments with spheres: a rolling ball, the angle of repose, the lateral resistance of a sleeper, a pressed box, rain.
//!
//! Each is a file of TOML that holds every assumed number, marked as such; a run gives an [`Outcome`]: readings, a curve, the
//! stones, and what must be said beside them. A run that is stopped keeps its state and goes on to the same bits.

mod bench;
mod closed_form;
mod error;
mod impact;
mod lateral;
mod oedometer;
mod outcome;
mod placing;
mod pluviation;
mod repose;
mod rolling_sphere;
mod slope;
mod spec;

pub use bench::{JOURNAL, RestSpec, Running, STATE, Told};
pub use closed_form::{Course, ThrownBall};
pub use error::ExperimentError;
pub use impact::{Impact, hertz_depth, hertz_duration, settle_on_floor, throw};
pub use lateral::{BedSpec, GravityPackingSpec, LateralSpec, PAPERS_STONES, PushSpec, SleeperSpec, run as run_lateral};
pub use oedometer::{OedometerSpec, run as run_oedometer};
pub use outcome::{Curve, Outcome, Reading};
pub use pluviation::{PluviationSpec, run as run_pluviation};
pub use repose::{ArchSpec, HopperSpec, ReposeResult, ReposeSpec, run as run_repose};
pub use rolling_sphere::{
    RollingCaseSpec, RollingRun, RollingSphereSpec, run as run_rolling_sphere, run_cases as run_rolling_cases,
};
pub use slope::{SECTORS, Slope, measure as measure_slope};
pub use spec::{EvenBy, ExperimentSpec, RollingName, RunSpec, SizeSpec, StoneSpec};

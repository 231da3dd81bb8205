//! The experiments by name.

use std::path::Path;

use clap::ValueEnum;

use crate::cli::error::CliError;
use crate::study::experiments::{
    self, ExperimentError, ExperimentSpec as _, LateralSpec, OedometerSpec, Outcome, PluviationSpec, ReposeSpec,
    RollingSphereSpec, Running,
};

/// The experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExperimentName {
    /// A ball thrown onto a floor and up a slope, with several models of rolling resistance (Ai et al. 2011, cases 1 and 2).
    RollingSphere,
    /// The angle of repose: stones from a hopper with a square opening (Irazábal et al. 2017, section 4.2).
    Repose,
    /// The lateral resistance of a sleeper (Irazábal et al. 2017, section 4.3).
    Lateral,
    /// A plate presses stones in a box.
    Oedometer,
    /// Stones rain into a box in layers.
    Pluviation,
}

impl ExperimentName {
    /// The file to begin with.
    pub const fn template(self) -> &'static str {
        match self {
            Self::RollingSphere => RollingSphereSpec::TEMPLATE,
            Self::Repose => ReposeSpec::TEMPLATE,
            Self::Lateral => LateralSpec::TEMPLATE,
            Self::Oedometer => OedometerSpec::TEMPLATE,
            Self::Pluviation => PluviationSpec::TEMPLATE,
        }
    }
}

/// What an experiment is to be.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Specified {
    /// See [`ExperimentName::RollingSphere`].
    RollingSphere(RollingSphereSpec),
    /// See [`ExperimentName::Repose`].
    Repose(ReposeSpec),
    /// See [`ExperimentName::Lateral`].
    Lateral(LateralSpec),
    /// See [`ExperimentName::Oedometer`].
    Oedometer(OedometerSpec),
    /// See [`ExperimentName::Pluviation`].
    Pluviation(PluviationSpec),
}

impl Specified {
    /// Reads and checks the file of an experiment.
    ///
    /// # Errors
    /// With the line, or the value that is out of range.
    pub fn read(name: ExperimentName, text: &str, file: &Path) -> Result<Self, ExperimentError> {
        Ok(match name {
            ExperimentName::RollingSphere => Self::RollingSphere(RollingSphereSpec::read(text, file)?),
            ExperimentName::Repose => Self::Repose(ReposeSpec::read(text, file)?),
            ExperimentName::Lateral => Self::Lateral(LateralSpec::read(text, file)?),
            ExperimentName::Oedometer => Self::Oedometer(OedometerSpec::read(text, file)?),
            ExperimentName::Pluviation => Self::Pluviation(PluviationSpec::read(text, file)?),
        })
    }

    fn seed_mut(&mut self) -> Option<&mut u64> {
        match self {
            Self::RollingSphere(_) => None,
            Self::Repose(spec) => Some(&mut spec.run.seed),
            Self::Lateral(spec) => Some(&mut spec.run.seed),
            Self::Oedometer(spec) => Some(&mut spec.run.seed),
            Self::Pluviation(spec) => Some(&mut spec.run.seed),
        }
    }

    /// The seed, if anything is random.
    pub fn seed(&self) -> Option<u64> {
        self.clone().seed_mut().copied()
    }

    /// The same with another seed.
    ///
    /// # Errors
    /// When nothing is random.
    pub fn with_seed(&self, seed: u64) -> Result<Self, CliError> {
        let mut spec = self.clone();
        *spec.seed_mut().ok_or_else(super::no_seed)? = seed;
        Ok(spec)
    }

    /// Runs it.
    ///
    /// # Errors
    /// When the simulation cannot be made or goes bad, or on request.
    pub fn run(&self, running: &Running<'_>) -> Result<Outcome, ExperimentError> {
        match self {
            Self::RollingSphere(spec) => experiments::run_rolling_sphere(spec, running),
            Self::Repose(spec) => Ok(experiments::run_repose(spec, running)?.outcome),
            Self::Lateral(spec) => experiments::run_lateral(spec, running),
            Self::Oedometer(spec) => experiments::run_oedometer(spec, running),
            Self::Pluviation(spec) => experiments::run_pluviation(spec, running),
        }
    }
}

//! What a bed that was stopped leaves behind, and how it is taken up again.

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;

use crate::files::{self, FileError};
use crate::packing::dem::Simulation;

use super::error::SettleError;
use super::spec::{SettleInput, Settling, Stage};

/// Name of the file with the state of a bed that was stopped.
pub const STATE: &str = "settling.state";
/// Name of the file that says what the state belongs to.
pub const STAGE: &str = "settling.json";

/// A stage that is over.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Before {
    pub(super) stage: Stage,
    pub(super) struck_off: usize,
    pub(super) lost: usize,
}

/// What a kept state belongs to.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Kept {
    format_version: u32,
    input: serde_json::Value,
    seed: u64,
    before: Vec<Before>,
}

/// A bed that is being settled.
pub(super) struct Place<'a> {
    pub(super) input: &'a SettleInput,
    pub(super) seed: u64,
    pub(super) threads: NonZeroUsize,
    pub(super) keep: Option<&'a Path>,
    pub(super) on_progress: &'a dyn Fn(Settling) -> ControlFlow<()>,
    pub(super) before: Vec<Before>,
}

impl Place<'_> {
    fn kept(&self) -> Kept {
        let input = serde_json::to_value(self.input).unwrap_or_default();
        Kept { format_version: 1, input, seed: self.seed, before: self.before.clone() }
    }

    /// The state that was kept of the same bed, with the stages before it.
    pub(super) fn read(&self) -> Option<(Simulation, Vec<Before>)> {
        let folder = self.keep?;
        let kept: Kept = serde_json::from_str(&fs::read_to_string(folder.join(STAGE)).ok()?).ok()?;
        let own = self.kept();
        let same = kept.format_version == own.format_version && kept.input == own.input && kept.seed == own.seed;
        let simulation = Simulation::load(&folder.join(STATE)).ok().filter(|_| same)?;
        Some((simulation, kept.before))
    }

    pub(super) fn write(&self, simulation: &Simulation) -> Result<(), SettleError> {
        let Some(folder) = self.keep else { return Ok(()) };
        files::create_folder(folder)?;
        simulation.save(&folder.join(STATE))?;
        let text = serde_json::to_string_pretty(&self.kept()).unwrap_or_default();
        Ok(files::write_bytes(&folder.join(STAGE), text.as_bytes())?)
    }

    pub(super) fn remove(&self) -> Result<(), SettleError> {
        for path in self.keep.iter().flat_map(|folder| [folder.join(STATE), folder.join(STAGE)]) {
            if path.exists() {
                fs::remove_file(&path).map_err(FileError::of("remove", &path))?;
            }
        }
        Ok(())
    }
}

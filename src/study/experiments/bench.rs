//! The bench on which experiments run: stages, samples, what is told on the way, and the state kept when one is stopped.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::error::ExperimentError;
use crate::files;
use crate::packing::dem::{Grain, Setup, Simulation};

/// What is told some ten times a second, and more often while steps are fast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// What is going on.
    pub stage: &'static str,
    /// How far the stage has come, 0 to 1, as far as that can be told.
    pub share: f64,
    /// Kinetic energy of all stones over their weight times their mean diameter.
    pub energy_ratio: f64,
    /// Unbalanced over mean contact force.
    pub unbalanced: f64,
    /// Stones that have left the domain.
    pub lost: usize,
}

/// How an experiment is run.
#[derive(Clone)]
pub struct Running<'a> {
    /// Threads at most; the result has the same bits on any number.
    pub threads: NonZeroUsize,
    /// Called now and then; `Break` stops the run.
    pub watch: &'a dyn Fn(&Told) -> ControlFlow<()>,
    /// Folder in which the state is kept when the run is stopped, and every ten minutes; none: it is not.
    pub keep_in: Option<PathBuf>,
    /// Whether to begin anew although a state is there.
    pub fresh: bool,
}

/// Name of the file with the stones, walls and contacts of an experiment that was stopped.
pub const STATE: &str = "experiment.state";
/// Name of the file with what was read off before it was stopped.
pub const JOURNAL: &str = "experiment.journal.json";
/// Steps from which on the end of a slice is told of.
const WORTH_TELLING: u64 = 100;
/// Time between two states kept without being asked.
const EVERY: Duration = Duration::from_secs(600);

/// When stones count as being at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestSpec {
    /// Kinetic energy over weight times mean diameter, at most.
    pub energy_ratio: f64,
    /// Unbalanced over mean contact force, at most.
    pub unbalanced: f64,
    /// Time after which a stage that has not come to rest is given up, s.
    pub within: crate::units::Seconds,
}

/// What an experiment remembers beside the state of its stones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Journal {
    experiment: String,
    /// The specification, as JSON.
    spec: serde_json::Value,
    step: u64,
    pub stage: usize,
    /// Time at which the stage began, s.
    pub began: f64,
    pub rows: Vec<Vec<f64>>,
    pub memo: BTreeMap<String, f64>,
}

/// A simulation with its journal.
pub(super) struct Bench<'a> {
    pub simulation: Simulation,
    pub journal: Journal,
    running: &'a Running<'a>,
    kept: Instant,
    stop_asked: Cell<bool>,
    /// Weight of all stones times their mean diameter, J.
    scale: f64,
    /// The folder, locked, once a state has been read from it or kept in it.
    locked: Option<File>,
}

impl<'a> Bench<'a> {
    /// Goes on from a state that is kept, or begins with the set-up that `make` gives.
    pub fn open(
        experiment: &'static str,
        spec: &impl Serialize,
        running: &'a Running<'a>,
        make: impl FnOnce() -> Result<Setup, ExperimentError>,
    ) -> Result<Self, ExperimentError> {
        let spec = serde_json::to_value(spec).unwrap_or_default();
        let kept = running.keep_in.as_deref().filter(|folder| !running.fresh && folder.join(JOURNAL).exists());
        let locked = kept.map(lock).transpose()?.flatten();
        let (simulation, journal) = match kept {
            Some(folder) => go_on(folder, experiment, &spec)?,
            None => {
                let simulation = Simulation::new(make()?)?;
                let (stage, began, step) = (0, 0.0, 0);
                let (rows, memo) = (vec![], BTreeMap::new());
                (simulation, Journal { experiment: experiment.into(), spec, step, stage, began, rows, memo })
            }
        };
        let scale = scale(&simulation);
        Ok(Self { simulation, journal, running, kept: Instant::now(), stop_asked: Cell::new(false), scale, locked })
    }

    /// Exchanges the simulation for one of another set-up, whose time begins at zero.
    pub fn rebuild(&mut self, setup: Setup) -> Result<(), ExperimentError> {
        self.simulation = Simulation::new(setup)?;
        self.scale = scale(&self.simulation);
        Ok(())
    }

    /// Puts further stones in; contacts keep what they remember.
    pub fn insert(&mut self, grains: &[Grain]) -> Result<(), ExperimentError> {
        self.simulation.insert(grains)?;
        self.scale = scale(&self.simulation);
        Ok(())
    }

    /// Goes to the next stage.
    pub fn next_stage(&mut self) {
        self.journal.stage += 1;
        self.journal.began = self.time();
    }

    /// Time of the simulation, s.
    pub fn time(&self) -> f64 {
        self.simulation.time().si()
    }

    /// Time since the stage began, s.
    pub fn in_stage(&self) -> f64 {
        self.time() - self.journal.began
    }

    /// Kinetic energy over weight times mean diameter.
    pub fn energy_ratio(&self) -> f64 {
        self.simulation.kinetic_energy() / self.scale
    }

    /// Makes steps; `share` is how far the stage has come. Stops before them where that was asked for: what is done between two
    /// calls is done again from the same state when the experiment goes on.
    pub fn steps(&mut self, stage: &'static str, steps: u64, share: f64) -> Result<(), ExperimentError> {
        if self.stop_asked.get() {
            let kept = self.keep()?.map_or_else(String::new, |folder| {
                let folder = folder.display();
                format!("; the state is kept in `{folder}`\n\nhint: the same command goes on from there")
            });
            return Err(ExperimentError::Stopped { seconds: self.in_stage(), stage, kept });
        }
        if self.kept.elapsed() > EVERY {
            self.keep()?;
        }
        self.steps_on(stage, steps, share)
    }

    /// Makes steps that belong to those before and cannot be gone on with alone.
    pub fn steps_on(&mut self, stage: &'static str, steps: u64, share: f64) -> Result<(), ExperimentError> {
        let (scale, watch, stop_asked) = (self.scale, self.running.watch, &self.stop_asked);
        let tell = |told: Told| stop_asked.set(stop_asked.get() || watch(&told).is_break());
        self.simulation.run(steps, self.running.threads, &|progress| {
            tell(Told {
                stage,
                share,
                energy_ratio: progress.kinetic_energy / scale,
                unbalanced: progress.unbalanced_force_ratio,
                lost: progress.lost,
            });
            ControlFlow::Continue(())
        })?;
        // Steps may be over before anybody is told.
        if steps >= WORTH_TELLING {
            tell(self.told(stage, share));
        }
        Ok(())
    }

    fn told(&self, stage: &'static str, share: f64) -> Told {
        Told {
            stage,
            share,
            energy_ratio: self.energy_ratio(),
            unbalanced: self.simulation.unbalanced_force_ratio(),
            lost: self.simulation.lost().len(),
        }
    }

    /// Runs for so many seconds in all of this stage, and calls `sample` after each `every` of them.
    pub fn for_time(
        &mut self,
        stage: &'static str,
        seconds: f64,
        every: f64,
        mut sample: impl FnMut(&mut Self),
    ) -> Result<(), ExperimentError> {
        let slice = self.count_of(every);
        let slices = (seconds / every).round().max(1.0) as u64;
        let mut done = (self.in_stage() / (slice as f64 * self.simulation.step_length().seconds)).round() as u64;
        while done < slices {
            self.steps(stage, slice, done as f64 / slices as f64)?;
            sample(self);
            done += 1;
        }
        Ok(())
    }

    /// Runs until all is at rest.
    pub fn until_rest(&mut self, stage: &'static str, rest: &RestSpec) -> Result<(), ExperimentError> {
        let slice = self.count_of(0.01);
        // Stones that have been let go this moment are at rest too: let them fall a little first.
        let least = 0.05_f64.min(0.5 * rest.within.si());
        loop {
            let ratios = [self.energy_ratio(), self.simulation.unbalanced_force_ratio()];
            if self.in_stage() >= least && ratios[0] <= rest.energy_ratio && ratios[1] <= rest.unbalanced {
                return Ok(());
            }
            if self.in_stage() > rest.within.si() {
                return Err(ExperimentError::NeverEnds {
                    stage,
                    limit: rest.within.si(),
                    what: format!(
                        "energy ratio {:.1e} (wanted {:.1e}), unbalanced force {:.1e} (wanted {:.1e})",
                        ratios[0], rest.energy_ratio, ratios[1], rest.unbalanced
                    ),
                    hint: "raise `within` or the ratios under `[rest]`",
                });
            }
            let share = self.in_stage() / rest.within.si();
            self.steps(stage, slice, share)?;
        }
    }

    /// Steps in so many seconds, at least one.
    pub fn count_of(&self, seconds: f64) -> u64 {
        (seconds / self.simulation.step_length().seconds).round().max(1.0) as u64
    }

    /// Keeps the state, if there is a folder for it.
    fn keep(&mut self) -> Result<Option<&'a Path>, ExperimentError> {
        self.kept = Instant::now();
        let Some(folder) = self.running.keep_in.as_deref() else { return Ok(None) };
        self.journal.step = self.simulation.step();
        files::create_folder(folder)?;
        if self.locked.is_none() {
            self.locked = lock(folder)?;
        }
        self.simulation.save(&folder.join(STATE))?;
        let text = serde_json::to_string(&self.journal).unwrap_or_default();
        files::write_bytes(&folder.join(JOURNAL), text.as_bytes())?;
        Ok(Some(folder))
    }

    /// Removes a state that was kept: the experiment is over.
    pub fn forget(&self) {
        if let Some(folder) = &self.running.keep_in {
            for name in [STATE, JOURNAL] {
                // Neither need be there.
                let _ = std::fs::remove_file(folder.join(name));
            }
            if self.locked.is_some() {
                files::remove_half_written(folder);
            }
        }
    }

    /// Says what went wrong on the way, though not so wrong that the run was stopped.
    pub fn notes(&self) -> Vec<String> {
        let length = self.simulation.step_length();
        let mut notes = vec![format!(
            "time step {:.3} µs, {:.0} % of the Rayleigh time of the smallest stone, {:.1} % of the duration of an impact at 1 m/s",
            1e6 * length.seconds,
            100.0 * length.share_of_rayleigh(),
            100.0 * length.share_of_contact()
        )];
        if length.is_worth_a_warning() {
            notes.push("the time step is longer than usual (20 % of the Rayleigh time, 10 % of an impact)".into());
        }
        let lost = self.simulation.lost().len();
        if lost > 0 {
            notes.push(format!("{lost} stones have left the domain"));
        }
        notes
    }
}

/// Keeps other runs out of a folder for as long as what is returned lives; `None` where a folder cannot be locked.
fn lock(folder: &Path) -> Result<Option<File>, ExperimentError> {
    let Ok(opened) = File::open(folder) else { return Ok(None) };
    match opened.try_lock() {
        Ok(()) => Ok(Some(opened)),
        Err(TryLockError::WouldBlock) => Err(ExperimentError::InUse { folder: folder.into() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

fn scale(simulation: &Simulation) -> f64 {
    let grains = simulation.grains();
    let (mut weight, mut diameter) = (0.0, 0.0);
    for grain in &grains {
        let density = simulation.stuffs().get(grain.material).map_or(0.0, |stuff| stuff.density);
        weight += 9.81 * density * grain.sphere.volume();
        diameter += 2.0 * grain.sphere.radius;
    }
    (weight * diameter / grains.len().max(1) as f64).max(f64::MIN_POSITIVE)
}

fn go_on(folder: &Path, experiment: &str, spec: &serde_json::Value) -> Result<(Simulation, Journal), ExperimentError> {
    let file = folder.join(JOURNAL);
    let other = |what: String| ExperimentError::OtherSave { file: file.clone(), what };
    let journal: Journal = serde_json::from_str(&files::read_text(&file)?).map_err(|error| other(error.to_string()))?;
    if journal.experiment != experiment {
        return Err(other(format!("it belongs to the experiment `{}`", journal.experiment)));
    }
    if journal.spec != *spec {
        return Err(other("its experiment was specified otherwise".into()));
    }
    let simulation = Simulation::load(&folder.join(STATE))?;
    if simulation.step() != journal.step {
        let [state, told] = [simulation.step(), journal.step];
        return Err(other(format!("it is of step {told}, and `{STATE}` of step {state}")));
    }
    Ok((simulation, journal))
}

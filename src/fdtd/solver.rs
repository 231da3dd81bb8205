//! The solver as others see it.

use std::num::NonZeroUsize;

use super::FdtdError;
use super::block::{Block, Probe};
use super::instructions::InstructionSet;
use super::keeping::Keeping;
use super::predict::{bytes_needed, painting_bytes};
use super::reach::Cones;
use super::real::Real;
use super::setup::{Setup, check_model};
use super::team;
use crate::forward::{Forward, ForwardError, OnProgress};
use crate::model::{Model, Painted, Resolution, available_memory, check_memory, paint};
use crate::trace::{AScan, Component, ReceiverTraces, Traces};
use crate::units::{Metres, Seconds};

/// Precision of the fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// 32 bits; traces differ from double precision by less than 1e-5 of their norm.
    #[default]
    Single,
    /// 64 bits.
    Double,
}

impl Precision {
    /// `single` or `double`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Double => "double",
        }
    }

    /// Bytes of a number.
    pub const fn bytes(self) -> u64 {
        match self {
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

/// The embedded solver: second-order finite differences in time and space, two- or three-dimensional, with gprMax's rules
/// for edges, sources, dispersion and the absorbing boundary.
///
/// The traces have the same bits for every instruction set and any number of threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fdtd {
    /// Precision of the fields.
    pub precision: Precision,
    /// Threads at most; `None`: what the model asks for, else one per core.
    pub threads: Option<NonZeroUsize>,
    /// Vector instructions.
    pub instruction_set: InstructionSet,
}

/// In which order a run makes its steps, and which it leaves out; the traces have the same bits in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stepping {
    /// Steps that a row takes while it is in the cache; `None`: by the length of the rows.
    pub steps_per_pass: Option<NonZeroUsize>,
    /// Leaves out what no wave has reached or no receiver will see ([`reach`](super::reach())).
    pub skip: bool,
}

impl Default for Stepping {
    fn default() -> Self {
        Self { steps_per_pass: None, skip: true }
    }
}

/// What a run cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stats {
    /// Wall time of the loop over the steps.
    pub wall: Seconds,
    /// Cells times steps, those left out included.
    pub cell_steps: u64,
    /// Memory of the fields and coefficients, bytes.
    pub bytes: u64,
    /// Threads used.
    pub threads: usize,
    /// Instructions used.
    pub instruction_set: InstructionSet,
}

impl Stats {
    /// Cells times steps per second of wall time.
    pub fn cell_steps_per_second(&self) -> f64 {
        self.cell_steps as f64 / self.wall.si()
    }
}

impl Forward for Fdtd {
    fn name(&self) -> &'static str {
        "fdtd"
    }

    fn solve(&self, model: &Model, on_progress: OnProgress<'_>) -> Result<Traces, ForwardError> {
        Ok(self.solve_stats(model, on_progress)?.0)
    }
}

impl Fdtd {
    /// Runs a model and tells what it cost.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_stats(&self, model: &Model, on_progress: OnProgress<'_>) -> Result<(Traces, Stats), FdtdError> {
        self.solve_kept(model, Keeping::default(), on_progress)
    }

    /// As [`Fdtd::solve_stats`], with checkpoints to go on from and the snapshots that the model asks for; models that are
    /// solved as a plane take so little time that they have no checkpoints.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_kept(
        &self,
        model: &Model,
        keeping: Keeping<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        if !model.is_plane() {
            return self.solve_three(model, keeping, on_progress);
        }
        check_model(model)?;
        check_memory(painting_bytes(model), available_memory())?;
        let painted = paint(model)?;
        if let Some(resolution) = Resolution::of(model, &painted) {
            resolution.check()?;
        }
        self.solve_painted(model, &painted, on_progress)
    }

    /// Runs a model of [`Route::Plane`](crate::model::Route::Plane) that has been painted (and its resolution checked)
    /// already; for all others see [`Fdtd::solve_painted_three`].
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_painted(
        &self,
        model: &Model,
        painted: &Painted,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        self.solve_stepping(model, painted, Stepping::default(), on_progress)
    }

    /// Runs a painted model with an order of steps of the caller's choice, for measurements and tests.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_stepping(
        &self,
        model: &Model,
        painted: &Painted,
        stepping: Stepping,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let setup = Setup::new(model, painted)?;
        let bytes = bytes_needed(&setup, self.precision);
        check_memory(bytes, available_memory())?;
        let (probes, mut stats) = match self.precision {
            Precision::Single => self.run::<f32>(model, &setup, stepping, on_progress)?,
            Precision::Double => self.run::<f64>(model, &setup, stepping, on_progress)?,
        };
        stats.bytes = bytes;
        Ok((self.traces(model, &setup, probes), stats))
    }

    /// Threads that a model gets.
    pub(super) fn threads_for(&self, model: &Model) -> usize {
        let asked = self.threads.or_else(|| model.threads.and_then(NonZeroUsize::new));
        let wanted = asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN);
        team::worthwhile_threads(model.grid.cell_count(), model.grid.cells[0] - 1, wanted)
    }

    /// Steps that a row of a model takes while it is in the cache.
    pub(super) fn steps_per_pass(&self, model: &Model, setup: &Setup<'_>) -> usize {
        team::steps_per_pass::<f32>(setup, self.threads_for(model))
    }

    /// Runs a model that has been turned into numbers.
    pub(super) fn run<T: Real>(
        &self,
        model: &Model,
        setup: &Setup<'_>,
        stepping: Stepping,
        on_progress: OnProgress<'_>,
    ) -> Result<(Vec<Probe>, Stats), FdtdError> {
        let sweep = self.instruction_set.resolve()?;
        let threads = self.threads_for(model);
        let cones = Cones::new(setup, stepping.skip);
        let automatic = || team::steps_per_pass::<T>(setup, threads);
        let most = (model.grid.cells[0] - 1).div_ceil(setup.order.cells_per_step());
        let depth = stepping.steps_per_pass.map_or_else(automatic, |asked| asked.get().min(most));
        let blocks: Vec<Block<T>> = team::blocks(setup, &cones, threads, depth);
        let threads = blocks.len();
        let (probes, wall) = team::run(blocks, setup, &cones, depth, sweep, on_progress)?;
        let cell_steps = model.grid.cell_count() as u64 * setup.iterations as u64;
        let wall = Seconds(wall.as_secs_f64());
        Ok((probes, Stats { wall, cell_steps, bytes: 0, threads, instruction_set: sweep.set() }))
    }

    /// Puts what the receivers recorded into the order of the model, with all six components.
    fn traces(&self, model: &Model, setup: &Setup<'_>, mut probes: Vec<Probe>) -> Traces {
        probes.sort_by_key(|probe| probe.receiver);
        let [scale_x, scale_y] = setup.magnetic_scale();
        let dt = setup.dt;
        let receivers = probes.into_iter().map(|probe| {
            let node = setup.receivers[probe.receiver];
            let named = model.receivers[probe.receiver].name.clone();
            let name = named.unwrap_or_else(|| format!("Rx({},{},{})", node[0], node[1], node[2]));
            let position = model.grid.node_position(node).map(Metres);
            let [ez, mut hx, mut hy] = probe.samples;
            hx.iter_mut().for_each(|v| *v *= scale_x);
            hy.iter_mut().for_each(|v| *v *= scale_y);
            let mut recorded = [None, None, Some(ez), Some(hx), Some(hy), None];
            let components = Component::FIELDS.iter().zip(&mut recorded).map(|(&component, samples)| AScan {
                samples: samples.take().unwrap_or_else(|| vec![0.0; setup.iterations]),
                time_step: Seconds(dt),
                first_sample: Seconds(if component.is_magnetic() { -0.5 * dt } else { 0.0 }),
                component,
                position: Some(position),
                name: name.clone(),
            });
            ReceiverTraces { components: components.collect(), position, name: name.clone() }
        });
        Traces {
            title: model.title.clone(),
            solver: format!("ballast-gpr {} fdtd, {} precision", env!("CARGO_PKG_VERSION"), self.precision.name()),
            time_step: Seconds(dt),
            iterations: setup.iterations,
            cells: model.grid.cells,
            spacing: model.grid.spacing.map(Metres),
            double_precision: self.precision == Precision::Double,
            receivers: receivers.collect(),
        }
    }
}

//! A three-dimensional run from a painted model to traces, and what it will cost.

use std::borrow::Cow;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use super::super::checkpoint::Keeper;
use super::super::keeping::Keeping;
use super::super::predict::{Prediction, TimeShares};
use super::super::{Fdtd, FdtdError, Precision, Stats};
use super::absorbing::Absorbing;
use super::camera::{Camera, Look};
use super::couple::Couples;
use super::fields::Fields;
use super::fourth;
use super::grades::Grades;
use super::plane::{Probe, Shared};
use super::reach::Cones;
use super::setup::{Setup3, check_model};
use super::sheet::{Sheets, padded};
use super::team;
use super::turn::Turn;
use super::vector::Number;
use crate::forward::OnProgress;
use crate::model::{Grid, Model, Order, Painted3, Resolution, TimeWindow, available_memory, check_memory, paint3};
use crate::trace::{AScan, Component, ReceiverTraces, Traces};
use crate::units::{Metres, Seconds};

/// How a run goes.
#[derive(Clone, Copy)]
struct Manner<'a> {
    /// Leaves out what no wave has reached or no receiver will see.
    skip: bool,
    keeping: Keeping<'a>,
    /// How the model has been turned.
    turn: Option<Turn>,
}

impl<'a> Manner<'a> {
    fn of(skip: bool, keeping: Keeping<'a>) -> Self {
        Self { skip, keeping, turn: None }
    }
}

impl Fdtd {
    /// Paints a model of [`Route::Space`](crate::model::Route::Space) and runs it.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub(in super::super) fn solve_three(
        &self,
        model: &Model,
        keeping: Keeping<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        check_model(model)?;
        check_memory(painting_bytes(model), available_memory())?;
        let painted = paint3(model)?;
        if let Some(resolution) = Resolution::of_three(model, &painted) {
            resolution.check()?;
        }
        self.solve_upright(model, Cow::Owned(painted), Manner::of(true, keeping), on_progress)
    }

    /// Runs a model that has been painted by [`paint3`] (and its resolution checked) already.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_painted_three(
        &self,
        model: &Model,
        painted: &Painted3,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        self.solve_upright(model, Cow::Borrowed(painted), Manner::of(true, Keeping::default()), on_progress)
    }

    /// As [`Fdtd::solve_painted_three`], with checkpoints to go on from and the snapshots that the model asks for.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_painted_three_kept(
        &self,
        model: &Model,
        painted: &Painted3,
        keeping: Keeping<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let manner = Manner::of(true, keeping);
        self.solve_upright(model, Cow::Borrowed(painted), manner, on_progress)
    }

    /// Runs a painted model, all of its nodes in every step where `skip` is false, for measurements and tests; the traces
    /// have the same bits either way.
    ///
    /// # Errors
    /// See [`FdtdError`].
    pub fn solve_stepping_three(
        &self,
        model: &Model,
        painted: &Painted3,
        skip: bool,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        self.solve_upright(model, Cow::Borrowed(painted), Manner::of(skip, Keeping::default()), on_progress)
    }

    /// Turns a two-dimensional model so that y is its invariant axis, and runs it.
    fn solve_upright(
        &self,
        model: &Model,
        painted: Cow<'_, Painted3>,
        manner: Manner<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let Some(turn) = Turn::of(model) else {
            return self.solve_setup(model, Setup3::new(model, painted)?, manner, on_progress);
        };
        let (turned, manner) = (turn.model(model), Manner { turn: Some(turn), ..manner });
        let setup = Setup3::new(&turned, Cow::Owned(turn.painted(&painted)));
        let run = setup.and_then(|setup| self.solve_setup(&turned, setup, manner, on_progress));
        let (traces, stats) = run.map_err(|error| turn.error_back(error))?;
        Ok((turn.traces_back(model, traces), stats))
    }

    /// Runs a model whose invariant axis, if it has one, is y.
    fn solve_setup(
        &self,
        model: &Model,
        mut setup: Setup3<'_>,
        manner: Manner<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let bytes = bytes_needed(&setup, self.precision);
        check_memory(bytes, available_memory())?;
        if setup.order == Order::Fourth {
            return match self.precision {
                Precision::Single => self.run_fourth::<f32>(model, &setup, bytes, on_progress),
                Precision::Double => self.run_fourth::<f64>(model, &setup, bytes, on_progress),
            };
        }
        let (mut probes, mut stats) = match self.precision {
            Precision::Single => self.run_three::<f32>(model, &mut setup, bytes, manner, on_progress)?,
            Precision::Double => self.run_three::<f64>(model, &mut setup, bytes, manner, on_progress)?,
        };
        stats.bytes = bytes;
        // Nothing lies beyond the last plane: what a receiver on that wall reads is zero.
        let samples = |receiver: usize| {
            let place = probes.iter().position(|probe| probe.receiver == receiver);
            let nothing = || std::array::from_fn(|_| vec![0.0; setup.iterations]);
            place.map_or_else(nothing, |place| probes.swap_remove(place).samples)
        };
        Ok((traces(self.precision, model, &setup, samples), stats))
    }

    /// Threads that a model gets.
    fn threads_in_space(&self, model: &Model) -> usize {
        let asked = self.threads.or_else(|| model.threads.and_then(NonZeroUsize::new));
        let wanted = asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN);
        team::worthwhile_threads(model.grid.cell_count(), model.grid.cells[0], wanted)
    }

    /// Runs a model with differences of fourth order.
    fn run_fourth<T: Number>(
        &self,
        model: &Model,
        setup: &Setup3<'_>,
        bytes: u64,
        on_progress: OnProgress<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let instruction_set = self.instruction_set.resolve()?.set();
        let threads = self.threads_in_space(model);
        let (mut samples, wall) = fourth::run::<T>(setup, threads, on_progress)?;
        let cell_steps = model.grid.cell_count() as u64 * setup.iterations as u64;
        let stats = Stats { wall: Seconds(wall.as_secs_f64()), cell_steps, bytes, threads, instruction_set };
        let samples = |receiver: usize| std::mem::replace(&mut samples[receiver], std::array::from_fn(|_| vec![]));
        Ok((traces(self.precision, model, setup, samples), stats))
    }

    fn run_three<T: Number>(
        &self,
        model: &Model,
        setup: &mut Setup3<'_>,
        bytes: u64,
        manner: Manner<'_>,
        on_progress: OnProgress<'_>,
    ) -> Result<(Vec<Probe>, Stats), FdtdError> {
        let instruction_set = self.instruction_set.resolve()?.set();
        let threads = self.threads_in_space(model);
        let shared = Shared::<T>::new(setup, instruction_set, manner.skip);
        let share = team::Share { threads, height: team::tile_height(model.grid.cells, bytes) };
        let planes = team::planes(setup, &shared);
        let Keeping { checkpoints, snapshots } = manner.keeping;
        let mut keeper = checkpoints.map(|checkpoints| Keeper::new(checkpoints, model, self.precision));
        let mut camera = snapshots.map(|snapshots| Camera::new(*snapshots, setup, manner.turn));
        let (probes, wall) = team::run(setup, &shared, planes, share, keeper.as_mut(), camera.as_mut(), on_progress)?;
        let cell_steps = model.grid.cell_count() as u64 * setup.iterations as u64;
        let wall = Seconds(wall.as_secs_f64());
        Ok((probes, Stats { wall, cell_steps, bytes: 0, threads, instruction_set }))
    }
}

/// Puts what the receivers recorded into the order of the model.
fn traces(
    precision: Precision,
    model: &Model,
    setup: &Setup3<'_>,
    mut samples_of: impl FnMut(usize) -> [Vec<f64>; 6],
) -> Traces {
    let dt = setup.dt;
    let scale = setup.scale();
    let receivers = model.receivers.iter().enumerate().map(|(index, receiver)| {
        let samples = samples_of(index);
        let node = setup.receivers[index];
        let name = receiver.name.clone().unwrap_or_else(|| format!("Rx({},{},{})", node[0], node[1], node[2]));
        let position = model.grid.node_position(node).map(Metres);
        let components = Component::FIELDS.into_iter().zip(samples).zip(scale);
        let components = components.map(|((component, mut samples), scale)| {
            samples.iter_mut().for_each(|v| *v *= scale);
            AScan {
                samples,
                time_step: Seconds(dt),
                first_sample: Seconds(if component.is_magnetic() { -0.5 * dt } else { 0.0 }),
                component,
                position: Some(position),
                name: name.clone(),
            }
        });
        ReceiverTraces { components: components.collect(), position, name: name.clone() }
    });
    let receivers = receivers.collect();
    Traces {
        title: model.title.clone(),
        solver: format!("ballast-gpr {} fdtd, {} precision", env!("CARGO_PKG_VERSION"), precision.name()),
        time_step: Seconds(dt),
        iterations: setup.iterations,
        cells: model.grid.cells,
        spacing: model.grid.spacing.map(Metres),
        double_precision: precision == Precision::Double,
        receivers,
    }
}

/// Memory while objects are painted: cells, claims and edges.
pub fn painting_bytes(model: &Model) -> u64 {
    model.grid.cell_count() as u64 * 12
}

/// Memory of the fields, the coefficients and the absorbing boundary of a run, bytes.
pub fn bytes_needed(setup: &Setup3<'_>, precision: Precision) -> u64 {
    match (setup.order, precision) {
        (Order::Second, Precision::Single) => bytes::<f32>(setup),
        (Order::Second, Precision::Double) => bytes::<f64>(setup),
        (Order::Fourth, Precision::Single) => fourth::bytes::<f32>(setup),
        (Order::Fourth, Precision::Double) => fourth::bytes::<f64>(setup),
    }
}

fn bytes<T: Number>(setup: &Setup3<'_>) -> u64 {
    let [nx, ny, nz] = setup.painted.cells;
    let width = padded(nz);
    let fields = (nx as u64 + 2) * Fields::<T>::bytes(ny, width);
    let magnetic = if setup.magnetic() { nx as u64 * Sheets::<T>::bytes(6, ny - 1, width) } else { 0 };
    let per_entry = setup.painted.edges_per_entry();
    let poles: usize = setup.edges.iter().zip(per_entry).map(|(edge, count)| edge.memories() * count).sum();
    let samples = setup.receivers.len() * 6 * 8 + setup.drives.len() * (8 + size_of::<T>());
    let snapshot = setup.looks.iter().map(|look: &Look| look.bytes(size_of::<T>())).max().unwrap_or(0);
    fields
        + magnetic
        + snapshot
        + Grades::<T>::bytes(setup)
        + Couples::<T>::bytes(setup)
        + Absorbing::<T>::bytes(setup, width)
        + Cones::bytes(setup.painted.cells)
        + (poles * size_of::<T>() + samples * setup.iterations) as u64
}

/// Memory of the fields and coefficients of a three-dimensional model, bytes.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn memory_three(model: &Model, painted: &Painted3, precision: Precision) -> Result<u64, FdtdError> {
    Ok(bytes_needed(&Setup3::new(model, Cow::Borrowed(painted))?, precision))
}

/// Cells of the trial run of a prediction: about as many as the outer cache holds four times over.
const TRIAL_CELLS: usize = 2_000_000;
/// Cell-steps of a trial run: a tenth of a second.
const TRIAL_CELL_STEPS: usize = 100_000_000;

/// Predicts memory and wall time of a three-dimensional run in single precision, from trial runs of about half a second
/// on this machine: the model itself, cut along x where it is large, for a few steps.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn predict_three(
    model: &Model,
    painted: &Painted3,
    threads: Option<NonZeroUsize>,
) -> Result<Prediction, FdtdError> {
    if let Some(turn) = Turn::of(model) {
        let predicted = predict_three(&turn.model(model), &turn.painted(painted), threads);
        return predicted.map_err(|error| turn.error_back(error));
    }
    let setup = Setup3::new(model, Cow::Borrowed(painted))?;
    let bytes = bytes_needed(&setup, Precision::Single);
    let [nx, ny, nz] = model.grid.cells;
    let planes = nx.min((TRIAL_CELLS / (ny * nz)).max(4 * team::STAGES));
    let mut cut = model.clone();
    cut.grid = Grid { cells: [planes, ny, nz], spacing: model.grid.spacing };
    let mut absorbing = model.absorbing_cells();
    if planes < nx {
        (absorbing[0], absorbing[3]) = (0, 0);
    }
    cut.pml_cells = Some(absorbing);
    cut.sources.clear();
    cut.receivers.clear();
    cut.snapshots.clear();
    // The middle of the model, whose objects are those that cost.
    let first = (nx - planes) / 2;
    let piece = painted.cut_x(first..first + planes);
    let fdtd = Fdtd { threads, ..Fdtd::default() };
    let cells = planes * ny * nz;
    let pass = team::STAGES;
    let steps = (TRIAL_CELL_STEPS / cells).next_multiple_of(pass).clamp(4 * pass, 400 * pass);
    let mut fastest = |steps: usize| {
        cut.time_window = TimeWindow::Iterations(steps + 1);
        let run = |_| {
            let run = fdtd.solve_stepping_three(&cut, &piece, false, &|_| ControlFlow::Continue(()));
            run.map(|(_, stats)| stats.wall.si())
        };
        (0..3).map(run).try_fold(f64::INFINITY, |fastest, seconds| Ok::<_, FdtdError>(seconds?.min(fastest)))
    };
    // What a run pays once, above all for touching memory for the first time, shows in the shorter run.
    let (short, long) = (fastest(pass)?, fastest(pass + steps)?);
    let per_step = ((long - short) / steps as f64).max(0.2 * long / steps as f64);
    let once = (short - pass as f64 * per_step).max(0.0) * model.grid.cell_count() as f64 / cells as f64;
    let per_cell = per_step / cells as f64;
    let cell_steps = model.grid.cell_count() as u64 * setup.iterations as u64;
    // With differences of fourth order every cell makes every step.
    let skips = setup.order == Order::Second;
    let (share_saved, share_of_time) = if skips {
        let cones = Cones::new(&setup, true);
        (cones.reach().share_saved, cones.share_of_time())
    } else {
        (0.0, 1.0)
    };
    let seconds = once + per_cell * cell_steps as f64 * share_of_time;
    Ok(Prediction { bytes, seconds, cell_steps, share_saved, shares: TimeShares::default() })
}

//! The threads of a run: each steps its own block and hands the neighbours the E rows on its rims.
//!
//! After step `n` a thread writes its first and last E row into the letterbox of that parity and announces `n + 1`;
//! before the next step it waits until both neighbours have announced as much. A letterbox is written again two steps
//! later, when the neighbours have announced the step in between and so have read it. Nobody waits for the whole team.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::FdtdError;
use super::block::{Block, Probe};
use super::instructions::Sweep;
use super::real::Real;
use super::setup::Setup;
use crate::forward::{OnProgress, Progress};

/// Steps between two looks at the whole field.
const STEPS_BETWEEN_SCANS: usize = 256;
/// Time between two calls of `on_progress`.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);
/// Rounds of waiting before a thread lets others run: about 10 µs.
const SPINS: u32 = 400;
/// Fewest cells that are worth a thread.
const LEAST_CELLS_PER_THREAD: usize = 16_384;

/// Announced steps, each on its own cache line.
#[repr(align(128))]
struct Announced(AtomicUsize);

/// E rows on the way from a block to its neighbours.
struct Letterbox<T> {
    first: Mutex<Vec<T>>,
    last: Mutex<Vec<T>>,
}

struct Team<T> {
    announced: Vec<Announced>,
    letterboxes: Vec<[Letterbox<T>; 2]>,
    halt: AtomicBool,
    failure: Mutex<Option<FdtdError>>,
}

/// How many threads a grid is worth, given how many are wanted.
pub fn worthwhile_threads(cells: usize, rows: usize, wanted: NonZeroUsize) -> usize {
    wanted.get().min(cells / LEAST_CELLS_PER_THREAD).min(rows / 4).max(1)
}

/// Cuts the rows `1..nx` of the grid into blocks of nearly equal numbers of rows.
pub fn blocks<T: Real>(setup: &Setup<'_>, threads: usize) -> Vec<Block<T>> {
    let rows = setup.painted.cells_xy[0] - 1;
    let bound = |block: usize| 1 + rows * block / threads;
    (0..threads).map(|block| Block::new(setup, bound(block), bound(block + 1) - bound(block))).collect()
}

/// Runs all steps; returns what the receivers recorded and the wall time of the loop.
///
/// # Errors
/// When a field diverges or the caller asks to stop.
pub fn run<T: Real>(
    blocks: Vec<Block<T>>,
    setup: &Setup<'_>,
    sweep: Sweep,
    on_progress: OnProgress<'_>,
) -> Result<(Vec<Probe>, Duration), FdtdError> {
    let letterbox = |block: &Block<T>| Letterbox {
        first: Mutex::new(block.rim(false).to_vec()),
        last: Mutex::new(block.rim(true).to_vec()),
    };
    let team = Team {
        announced: blocks.iter().map(|_| Announced(AtomicUsize::new(0))).collect(),
        letterboxes: blocks.iter().map(|block| [letterbox(block), letterbox(block)]).collect(),
        halt: AtomicBool::new(false),
        failure: Mutex::new(None),
    };
    let begin = Instant::now();
    let done: Vec<Block<T>> = std::thread::scope(|scope| {
        let team = &team;
        let mut blocks = blocks.into_iter().enumerate();
        let mine = blocks.next();
        let others: Vec<_> = blocks
            .map(|(me, block)| {
                scope.spawn(move || team.steps(me, block, setup, sweep, &mut |_| ControlFlow::Continue(())))
            })
            .collect();
        let mut clock = Clock { on_progress, last: None, total: setup.iterations };
        let mine = mine.map(|(me, block)| team.steps(me, block, setup, sweep, &mut |step| clock.tick(step)));
        let others = others.into_iter().map(|other| match other.join() {
            Ok(block) => block,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        mine.into_iter().chain(others).collect()
    });
    let wall = begin.elapsed();
    if let Some(failure) = lock(&team.failure).take() {
        return Err(failure);
    }
    if let Some(node) = done.iter().find_map(|block| block.find_beyond(T::of(setup.limit()))) {
        let value = done.iter().find_map(|block| block.value_at(node)).unwrap_or(f64::NAN);
        return Err(diverged(setup, setup.iterations, node, value));
    }
    let _ = on_progress(Progress { done: setup.iterations, total: setup.iterations });
    Ok((done.into_iter().flat_map(Block::into_probes).collect(), wall))
}

/// Calls `on_progress` now and then.
struct Clock<'a> {
    on_progress: OnProgress<'a>,
    last: Option<Instant>,
    total: usize,
}

impl Clock<'_> {
    fn tick(&mut self, done: usize) -> ControlFlow<()> {
        let now = Instant::now();
        if self.last.is_some_and(|last| now - last < PROGRESS_INTERVAL) {
            return ControlFlow::Continue(());
        }
        self.last = Some(now);
        (self.on_progress)(Progress { done, total: self.total })
    }
}

/// Tells the others to stop when this thread panics.
struct HaltOnPanic<'a>(&'a AtomicBool);

impl Drop for HaltOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

impl<T: Real> Team<T> {
    fn steps(
        &self,
        me: usize,
        mut block: Block<T>,
        setup: &Setup<'_>,
        sweep: Sweep,
        tick: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Block<T> {
        let _guard = HaltOnPanic(&self.halt);
        let limit = T::of(setup.limit());
        // A look at the clock costs as much as some hundred cells.
        let steps_per_tick = (65_536 / setup.painted.solid.len().max(1)).clamp(1, 64);
        for step in 0..setup.iterations {
            block.record();
            let scan = step % STEPS_BETWEEN_SCANS == STEPS_BETWEEN_SCANS - 1;
            let found = if scan { block.find_beyond(limit) } else { block.find_beyond_at_receivers(limit) };
            if let Some(node) = found {
                self.fail(diverged(setup, step, node, block.value_at(node).unwrap_or(f64::NAN)));
            }
            if step % steps_per_tick == 0 && tick(step).is_break() {
                self.fail(FdtdError::Stopped);
            }
            if step + 1 == setup.iterations || !self.receive(me, step, &mut block) {
                break;
            }
            sweep.run(&mut block, step);
            self.send(me, step + 1, &block);
        }
        block
    }

    /// Notes the first failure and stops the team.
    fn fail(&self, failure: FdtdError) {
        lock(&self.failure).get_or_insert(failure);
        self.halt.store(true, Ordering::Relaxed);
    }

    /// Waits for the neighbours to come as far as `step` and takes their rims; false when the team is to stop.
    fn receive(&self, me: usize, step: usize, block: &mut Block<T>) -> bool {
        if me > 0 {
            if !self.wait(me - 1, step) {
                return false;
            }
            block.halo(false).copy_from_slice(&lock(&self.letterboxes[me - 1][step % 2].last));
        }
        if me + 1 < self.announced.len() {
            if !self.wait(me + 1, step) {
                return false;
            }
            block.halo(true).copy_from_slice(&lock(&self.letterboxes[me + 1][step % 2].first));
        }
        !self.halt.load(Ordering::Relaxed)
    }

    fn send(&self, me: usize, step: usize, block: &Block<T>) {
        let Letterbox { first, last } = &self.letterboxes[me][step % 2];
        if me > 0 {
            lock(first).copy_from_slice(block.rim(false));
        }
        if me + 1 < self.announced.len() {
            lock(last).copy_from_slice(block.rim(true));
        }
        self.announced[me].0.store(step, Ordering::Release);
    }

    /// Spins for a while, then yields the core, so that a crowded machine is not spun dry.
    fn wait(&self, neighbour: usize, step: usize) -> bool {
        let mut rounds = 0;
        while self.announced[neighbour].0.load(Ordering::Acquire) < step {
            if self.halt.load(Ordering::Relaxed) {
                return false;
            }
            if rounds < SPINS {
                rounds += 1;
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
        true
    }
}

fn diverged(setup: &Setup<'_>, step: usize, [i, j]: [usize; 2], value: f64) -> FdtdError {
    let [dx, dy, _] = setup.spacing;
    FdtdError::Diverged { step, i, j, x: i as f64 * dx, y: j as f64 * dy, value }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fdtd::InstructionSet;
    use crate::model::{
        Axis, Excitation, Grid, HertzianDipole, Model, Receiver, Source, TimeWindow, Waveform, WaveformKind, paint,
    };

    fn model(nx: usize, ny: usize, steps: usize) -> Model {
        let d = 0.002;
        let mut model = Model::new("", Grid { cells: [nx, ny, 1], spacing: [d; 3] }, TimeWindow::Iterations(steps));
        model.pml_cells = Some([3, 2, 0, 4, 1, 0]);
        model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
        let position = [d * (nx / 2) as f64, d * (ny / 2) as f64, 0.0];
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole = HertzianDipole { polarisation: Axis::Z, position, waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        for i in 0..=nx {
            model.receivers.push(Receiver { position: [d * i as f64, d * (i % ny) as f64, 0.0], name: None });
        }
        model
    }

    fn go(model: &Model, threads: usize, faster: f64) -> Result<Vec<Vec<f64>>, FdtdError> {
        let painted = paint(model).unwrap();
        let mut setup = Setup::new(model, &painted).unwrap();
        setup.edges.iter_mut().for_each(|edge| edge.cb *= faster);
        let sweep = InstructionSet::Auto.resolve().unwrap();
        let (mut probes, _) = run(blocks::<f32>(&setup, threads), &setup, sweep, &|_| ControlFlow::Continue(()))?;
        probes.sort_by_key(|probe| probe.receiver);
        assert_eq!(probes.len(), model.receivers.len());
        Ok(probes.into_iter().flat_map(|probe| probe.samples).collect())
    }

    /// Blocks down to a single row, walls and absorbing rows cut through: the same bits at every node along a diagonal.
    #[test]
    fn any_cut_gives_the_same_bits() {
        let model = model(15, 9, 300);
        let whole = go(&model, 1, 1.0).unwrap();
        assert!(whole.iter().flatten().any(|v| *v != 0.0));
        for threads in [2, 3, 7, 14] {
            assert!(go(&model, threads, 1.0).unwrap() == whole, "{threads}");
        }
    }

    /// A scheme made unstable (a step beyond the Courant limit by 5 %) is stopped, and the place is in the grid.
    #[test]
    fn a_diverging_run_is_stopped_at_a_place() {
        for threads in [1, 3] {
            let model = model(40, 40, 100_000);
            match go(&model, threads, 1.1) {
                Err(FdtdError::Diverged { step, i, j, value, .. }) => {
                    assert!((10..20_000).contains(&step), "{step}");
                    assert!((1..40).contains(&i) && (1..40).contains(&j));
                    assert!(value.is_nan() || value.abs() > 1e8, "{value}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

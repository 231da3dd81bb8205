//! The threads of a run: passes of several steps that follow one another through the grid.
//!
//! A pass takes [`STAGES`] steps: its front moves along x plane by plane, and behind it plane `p - s` is taken through the
//! pass's step `s`, so that a plane is read from memory once for several steps. H of a plane needs E of the next one, and
//! E needs H of the one before: both are as they should be, in place. Thread `t` runs the passes `t, t + threads, …`; a pass
//! waits until the one before has left the planes that its front is about to touch. A plane is stepped by the same
//! operations in the same order whoever does it, so the bits do not depend on the number of threads.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use std::time::{Duration, Instant};

use super::super::FdtdError;
use super::instructions::{Number, step};
use super::plane::{Plane, Probe, Scratch, Shared, Step};
use super::setup::{Setup3, axis_of};
use crate::forward::{OnProgress, Progress};

/// Steps of a pass: the planes of five steps and their neighbours fit into an outer cache of 32 MB up to 200 x 200 cells.
pub const STAGES: usize = 4;
/// Steps between two looks at the whole field.
const STEPS_BETWEEN_SCANS: usize = 256;
/// Time between two calls of `on_progress`.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);
/// Rounds of waiting before a thread lets others run: about 10 µs.
const SPINS: u32 = 400;
/// Fewest cells that are worth a thread.
const LEAST_CELLS_PER_THREAD: usize = 8_192;

/// How far a thread has come, each on its own cache line.
#[repr(align(128))]
struct Done(AtomicUsize);

struct Team<'a, T> {
    setup: &'a Setup3<'a>,
    shared: &'a Shared<T>,
    /// Plane `i` is number `i + 1`; the first and the last lie beyond the outer walls.
    planes: Vec<RwLock<Plane<T>>>,
    done: Vec<Done>,
    halt: AtomicBool,
    failure: Mutex<Option<FdtdError>>,
    limit: T,
}

/// How many threads a grid is worth, given how many are wanted.
pub fn worthwhile_threads(cells: usize, planes: usize, wanted: NonZeroUsize) -> usize {
    wanted.get().min(cells / LEAST_CELLS_PER_THREAD).min(planes / (STAGES + 2)).max(1)
}

/// Builds the planes of a grid, and one beyond each outer wall across x; frees the painting, where it can, between what
/// is read off it and the fields.
pub fn planes<T: Number>(setup: &mut Setup3<'_>, shared: &Shared<T>) -> Vec<Plane<T>> {
    let nx = setup.painted.cells[0];
    let bare: Vec<_> = (0..nx).map(|i| Plane::new(setup, shared, i)).collect();
    setup.forget_painting();
    let inside = bare.into_iter().map(|plane| plane.add_fields(setup, shared));
    std::iter::once(Plane::beyond(setup)).chain(inside).chain(std::iter::once(Plane::beyond(setup))).collect()
}

/// Runs all steps; returns what the receivers recorded and the wall time of the loop.
///
/// # Errors
/// When a field diverges or the caller asks to stop.
pub fn run<T: Number>(
    setup: &Setup3<'_>,
    shared: &Shared<T>,
    planes: Vec<Plane<T>>,
    threads: usize,
    on_progress: OnProgress<'_>,
) -> Result<(Vec<Probe>, Duration), FdtdError> {
    let team = Team {
        setup,
        shared,
        planes: planes.into_iter().map(RwLock::new).collect(),
        done: (0..threads).map(|_| Done(AtomicUsize::new(0))).collect(),
        halt: AtomicBool::new(false),
        failure: Mutex::new(None),
        limit: T::of(setup.limit()),
    };
    let begin = Instant::now();
    std::thread::scope(|scope| {
        let team = &team;
        for me in 1..threads {
            scope.spawn(move || team.passes(me, &mut |_| ControlFlow::Continue(())));
        }
        let mut last: Option<Instant> = None;
        team.passes(0, &mut |done| {
            let now = Instant::now();
            if last.is_some_and(|last| now - last < PROGRESS_INTERVAL) {
                return ControlFlow::Continue(());
            }
            last = Some(now);
            on_progress(Progress { done, total: setup.iterations })
        });
    });
    let wall = begin.elapsed();
    if let Some(failure) = lock(&team.failure).take() {
        return Err(failure);
    }
    let _ = on_progress(Progress { done: setup.iterations, total: setup.iterations });
    let planes = team.planes.into_iter().map(|plane| plane.into_inner().unwrap_or_else(PoisonError::into_inner));
    Ok((planes.flat_map(|plane| plane.probes).collect(), wall))
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

impl<T: Number> Team<'_, T> {
    fn passes(&self, me: usize, tick: &mut dyn FnMut(usize) -> ControlFlow<()>) {
        let _guard = HaltOnPanic(&self.halt);
        let mut scratch = Scratch::new(self.shared);
        let (nx, steps) = (self.setup.painted.cells[0], self.setup.iterations);
        // Positions of a pass's front until its last stage has left the grid.
        let positions = nx + STAGES - 1;
        for pass in (me..steps.div_ceil(STAGES)).step_by(self.done.len()) {
            let first = pass * STAGES;
            if tick(first).is_break() {
                self.fail(FdtdError::Stopped);
            }
            for front in 0..positions {
                let needed = pass.saturating_sub(1) * positions + (front + STAGES + 1).min(positions);
                if pass > 0 && !self.wait((pass - 1) % self.done.len(), needed) {
                    return;
                }
                for stage in 0..STAGES.min(steps - first) {
                    if let Some(i) = front.checked_sub(stage).filter(|&i| i < nx) {
                        self.step_plane(i, first + stage, &mut scratch);
                    }
                }
                self.done[me].0.store(pass * positions + front + 1, Ordering::Release);
                if self.halt.load(Ordering::Relaxed) {
                    return;
                }
            }
        }
    }

    /// Records what the receivers of a plane hold before a step, and takes the step unless it is the last.
    fn step_plane(&self, i: usize, number: usize, scratch: &mut Scratch<T>) {
        let mut plane = write(&self.planes[i + 1]);
        let (mut found, last) = (plane.record(self.limit), number + 1 == self.setup.iterations);
        if !last {
            let (west, east) = (read(&self.planes[i]), read(&self.planes[i + 2]));
            let action = Step { shared: self.shared, step: number, west: &west, east: &east };
            step(self.shared.set(), &action, &mut plane, scratch);
        }
        if last || number % STEPS_BETWEEN_SCANS == STEPS_BETWEEN_SCANS - 1 {
            found = found.or_else(|| plane.find_beyond(self.shared, self.limit));
        }
        if let Some((axis, [j, k])) = found {
            let node = [i, j, k];
            let d = self.setup.spacing;
            let value = plane.e[axis].at(j, k, 1)[0].double() / d[axis];
            let position = std::array::from_fn(|axis| node[axis] as f64 * d[axis]);
            self.fail(FdtdError::DivergedAt { step: number, axis: axis_of(axis), node, position, value });
        }
    }

    /// Notes the first failure and stops the team.
    fn fail(&self, failure: FdtdError) {
        lock(&self.failure).get_or_insert(failure);
        self.halt.store(true, Ordering::Relaxed);
    }

    /// Spins for a while, then yields the core, so that a crowded machine is not spun dry; false when the team is to stop.
    fn wait(&self, other: usize, needed: usize) -> bool {
        let mut rounds = 0;
        while self.done[other].0.load(Ordering::Acquire) < needed {
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
        !self.halt.load(Ordering::Relaxed)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn read<T>(plane: &RwLock<T>) -> RwLockReadGuard<'_, T> {
    plane.read().unwrap_or_else(PoisonError::into_inner)
}

fn write<T>(plane: &RwLock<T>) -> RwLockWriteGuard<'_, T> {
    plane.write().unwrap_or_else(PoisonError::into_inner)
}

//! The threads of a run: passes of several steps that follow one another through the grid, tile by tile.
//!
//! A pass takes [`STAGES`] steps: its front moves along x plane by plane, and behind it plane `p - s` is taken through the
//! pass's step `s`, so that a plane is read from memory once for several steps. H of a plane needs E of the next one, and
//! E needs H of the one before: both are as they should be, in place. So that the planes at work fit into a core's own cache,
//! a pass takes them in [`Tiles`] of some rows, one after the other; a tile lies one row lower in each step of its pass, for
//! the same reason.
//!
//! The tiles of all passes make one line. Thread `t` takes the items `t, t + threads, …` of it; each waits until the one before
//! has left the planes that its front is about to touch. A plane is stepped by the same operations in the same order whoever
//! does it, so the bits depend neither on the number of threads nor on the height of the tiles.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use std::time::{Duration, Instant};

use super::super::FdtdError;
use super::super::checkpoint::Keeper;
use super::super::state::{Numbers, State};
use super::absorbing::Absorbing;
use super::arena::Arena;
use super::camera::Camera;
use super::couple::couple;
use super::fields::Fields;
use super::instructions::step;
use super::plane::{Plane, Probe, Scratch, Shared};
use super::setup::{Setup3, axis_of};
use super::sheet::padded;
use super::step::Step;
use super::vector::Number;
use crate::forward::{OnProgress, Progress};

/// Steps of a pass.
pub const STAGES: usize = 4;
/// Bytes of a core's own cache that a pass may count on, of the megabyte that most have.
const OWN_CACHE: u64 = 750_000;
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

/// How the rows of a plane are cut: tile `t` is taken through its pass's step `s` from row `t height - s` on, because H needs
/// E of the next row and E needs H of the one before.
#[derive(Debug, Clone, Copy)]
struct Tiles {
    height: usize,
    count: usize,
    /// Rows of a plane.
    rows: usize,
}

impl Tiles {
    /// Tiles of about `height` rows; all of one height, but for the last.
    fn new(rows: usize, height: usize) -> Self {
        let height = height.max(STAGES + 1);
        let count = (rows + STAGES - 1).div_ceil(height);
        Self { height: (rows + STAGES - 1).div_ceil(count).max(STAGES + 1), count, rows }
    }

    /// The rows of a tile in a step of its pass.
    fn rows(&self, tile: usize, stage: usize) -> Range<usize> {
        let at = |row: usize| row.saturating_sub(stage).min(self.rows);
        at(tile * self.height)..at((tile + 1) * self.height)
    }
}

struct Team<'a, T> {
    setup: &'a Setup3<'a>,
    shared: &'a Shared<T>,
    /// Plane `i` is number `i + 1`; the first and the last lie beyond the outer walls.
    planes: Vec<RwLock<Plane<T>>>,
    done: Vec<Done>,
    /// How the rows of a plane are cut.
    tiles: Tiles,
    /// Steps made when the passes begin.
    begun: usize,
    /// Steps made when they end, at the latest.
    until: usize,
    /// The pass before which all stop, so that all planes have made the same steps.
    end: AtomicUsize,
    halt: AtomicBool,
    failure: Mutex<Option<FdtdError>>,
    limit: T,
}

/// How a run is shared out.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    pub threads: usize,
    /// About how many rows a tile has.
    pub height: usize,
}

/// The height of tiles at which what a pass works on fits into a core's own cache; all planes together take `bytes`.
pub fn tile_height(cells: [usize; 3], bytes: u64) -> usize {
    let per_row = bytes / (cells[0] * cells[1]).max(1) as u64;
    (OWN_CACHE / ((STAGES as u64 + 2) * per_row.max(1))) as usize
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
    let width = padded(setup.painted.cells[2]);
    let fields = (nx as u64 + 2) * Fields::<T>::bytes(setup.painted.cells[1], width);
    let mut arena = Arena::of_bytes(fields + Absorbing::<T>::bytes(setup, width));
    let mut planes = vec![Plane::beyond(setup, &mut arena)];
    planes.extend(bare.into_iter().map(|plane| plane.add_fields(setup, shared, &mut arena)));
    planes.push(Plane::beyond(setup, &mut arena));
    planes
}

/// What the thread that asks is told before a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tick {
    Go,
    /// Stop when all planes have made the same steps.
    Pause,
    /// Stop at once.
    Stop,
}

/// Runs all steps, those that a checkpoint holds left out; returns what the receivers recorded and the wall time of the
/// loop.
///
/// # Errors
/// When a field diverges, the caller asks to stop, or the checkpoint is of something else.
pub fn run<T: Number>(
    setup: &Setup3<'_>,
    shared: &Shared<T>,
    mut planes: Vec<Plane<T>>,
    Share { threads, height }: Share,
    mut keeper: Option<&mut Keeper<'_>>,
    mut camera: Option<&mut Camera<'_>>,
    on_progress: OnProgress<'_>,
) -> Result<(Vec<Probe>, Duration), FdtdError> {
    let loaded = keeper.as_mut().map(|keeper| keeper.load(planes.as_mut_slice())).transpose()?;
    let mut team = Team {
        setup,
        shared,
        planes: planes.into_iter().map(RwLock::new).collect(),
        done: (0..threads).map(|_| Done(AtomicUsize::new(0))).collect(),
        tiles: Tiles::new(setup.painted.cells[1], height),
        begun: loaded.unwrap_or(0),
        until: setup.iterations,
        end: AtomicUsize::new(usize::MAX),
        halt: AtomicBool::new(false),
        failure: Mutex::new(None),
        limit: T::of(setup.limit()),
    };
    if let Some(camera) = &mut camera {
        camera.go_on(team.begun)?;
    }
    let begin = Instant::now();
    let mut last: Option<Instant> = None;
    loop {
        if let Some(camera) = &mut camera {
            team.show(camera)?;
        }
        let (mut asked, due) = (false, keeper.as_ref().map(|keeper| (keeper.due(), keeper.stop_from())));
        team.leg(&mut |done| {
            let now = Instant::now();
            if last.is_none_or(|last| now - last >= PROGRESS_INTERVAL) {
                last = Some(now);
                asked = on_progress(Progress { done, total: setup.iterations }).is_break();
            }
            match due {
                Some((_, from)) if asked => {
                    if now >= from {
                        Tick::Pause
                    } else {
                        Tick::Stop
                    }
                }
                Some((due, _)) if now >= due => Tick::Pause,
                _ => {
                    if asked {
                        Tick::Stop
                    } else {
                        Tick::Go
                    }
                }
            }
        });
        if let Some(failure) = lock(&team.failure).take() {
            return Err(failure);
        }
        let passes = team.end.swap(usize::MAX, Ordering::Relaxed);
        team.begun = team.begun.saturating_add(passes.saturating_mul(STAGES)).min(team.until);
        if team.begun >= setup.iterations {
            break;
        }
        if let Some(keeper) = keeper.as_mut().filter(|_| passes != usize::MAX) {
            keeper.write(team.begun, team.planes.as_mut_slice());
        }
        if asked {
            return Err(FdtdError::Stopped);
        }
        team.done.iter_mut().for_each(|done| *done.0.get_mut() = 0);
    }
    let wall = begin.elapsed();
    let _ = on_progress(Progress { done: setup.iterations, total: setup.iterations });
    let planes = team.planes.into_iter().map(|plane| plane.into_inner().unwrap_or_else(PoisonError::into_inner));
    Ok((planes.flat_map(|plane| plane.probes).collect(), wall))
}

impl<S: State> State for RwLock<S> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        self.get_mut().unwrap_or_else(PoisonError::into_inner).visit(visitor);
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

impl<T: Number> Team<'_, T> {
    /// Takes the snapshots that are due now, and lets the passes end at the next.
    fn show(&mut self, camera: &mut Camera<'_>) -> Result<(), FdtdError> {
        if camera.next() == Some(self.begun) {
            let planes = self.planes.iter_mut().map(|plane| &*plane.get_mut().unwrap_or_else(PoisonError::into_inner));
            let planes: Vec<&Plane<T>> = planes.skip(1).take(self.setup.painted.cells[0]).collect();
            camera.take(self.begun, self.setup, &planes)?;
        }
        self.until = camera.next().unwrap_or(self.setup.iterations);
        Ok(())
    }

    /// Runs passes until the steps are done or the first thread is told to pause or stop.
    fn leg(&self, tick: &mut dyn FnMut(usize) -> Tick) {
        std::thread::scope(|scope| {
            for me in 1..self.done.len() {
                scope.spawn(move || self.passes(me, &mut |_| Tick::Go));
            }
            self.passes(0, tick);
        });
    }

    fn passes(&self, me: usize, tick: &mut dyn FnMut(usize) -> Tick) {
        let _guard = HaltOnPanic(&self.halt);
        let mut scratch = Scratch::new(self.shared);
        let (nx, steps, tiles) = (self.setup.painted.cells[0], self.until, self.tiles);
        // Positions of a tile's front until its last stage has left the grid.
        let positions = nx + STAGES - 1;
        let items = (steps - self.begun).div_ceil(STAGES) * tiles.count;
        for item in (me..items).step_by(self.done.len()) {
            let (pass, tile) = (item / tiles.count, item % tiles.count);
            if pass >= self.end.load(Ordering::Relaxed) {
                return;
            }
            let first = self.begun + pass * STAGES;
            match tick(first) {
                Tick::Go => {}
                // Nobody has begun an item later by as many as there are threads: it would have to wait for this one.
                Tick::Pause => {
                    let end = (item + self.done.len()).div_ceil(tiles.count);
                    let _ = self.end.compare_exchange(usize::MAX, end, Ordering::Relaxed, Ordering::Relaxed);
                }
                Tick::Stop => self.fail(FdtdError::Stopped),
            }
            for front in 0..positions {
                let needed = item.saturating_sub(1) * positions + (front + STAGES + 1).min(positions);
                if item > 0 && !self.wait((item - 1) % self.done.len(), needed) {
                    return;
                }
                for stage in 0..STAGES.min(steps - first) {
                    if let Some(i) = front.checked_sub(stage).filter(|&i| i < nx) {
                        self.step_plane(i, tiles.rows(tile, stage), first + stage, &mut scratch);
                    }
                }
                self.done[me].0.store(item * positions + front + 1, Ordering::Release);
                if self.halt.load(Ordering::Relaxed) {
                    return;
                }
            }
        }
    }

    /// Records what the receivers in some rows of a plane hold before a step, and takes the step unless it is the last.
    fn step_plane(&self, i: usize, rows: Range<usize>, number: usize, scratch: &mut Scratch<T>) {
        let mut plane = write(&self.planes[i + 1]);
        let (mut found, last) = (plane.record(number, &rows, self.limit), number + 1 == self.setup.iterations);
        if !last && self.shared.cones.touches(i, number) {
            let (west, east) = (read(&self.planes[i]), read(&self.planes[i + 2]));
            let action = Step { shared: self.shared, step: number, rows: rows.clone(), west: &west, east: &east };
            step(self.shared.set(), &action, &mut plane, scratch);
            drop(west);
            if plane.couples.as_ref().is_some_and(|couples| couples.are_in(&rows)) {
                couple(self.shared, number, &rows, &mut plane, &mut write(&self.planes[i]));
            }
        }
        if last || number % STEPS_BETWEEN_SCANS == STEPS_BETWEEN_SCANS - 1 {
            found = found.or_else(|| plane.find_beyond(self.shared, &rows, self.limit));
        }
        if let Some((axis, [j, k])) = found {
            let node = [i, j, k];
            let d = self.setup.spacing;
            let value = plane.fields.at(axis, j, k, 1)[0].double() / d[axis];
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

#[cfg(test)]
mod tests {
    use std::borrow::Cow;
    use std::ops::ControlFlow;

    use proptest::prelude::*;

    use super::*;
    use crate::fdtd::InstructionSet;
    use crate::model::{
        DebyePole, Excitation, Grid, HertzianDipole, MagneticDipole, Material, MaterialId, Model, Object, Receiver,
        Source, TimeWindow, VoltageSource, Waveform, WaveformKind, paint3,
    };

    /// Any model: several sources of every kind along any axis that begin late, receivers anywhere, conductors, loss, Debye
    /// media of one pole and of two, magnetic ones, absorbing cells on some sides, a palette small or too large for a table.
    pub fn any_model() -> impl Strategy<Value = Model> {
        let node = prop::array::uniform3(0usize..1000);
        let objects =
            prop::collection::vec((0usize..7, node.clone(), prop::array::uniform3(1usize..14), any::<bool>()), 0..6);
        let sources = prop::collection::vec((node.clone(), 0usize..4, 0usize..3, 0usize..40), 0..4);
        let receivers = prop::collection::vec(node, 0..4);
        let pml = prop::array::uniform6(0usize..4);
        let cells = [1usize..16, 2usize..18, 2usize..50];
        (cells, 0usize..90, objects, sources, receivers, pml, any::<bool>()).prop_map(
            |(cells, steps, objects, sources, receivers, pml, many)| {
                let grid = Grid { cells, spacing: [0.002, 0.0025, 0.003] };
                let mut model = Model::new("", grid, TimeWindow::Iterations(steps));
                let place = |node: [usize; 3], shift: usize, to: usize| -> [f64; 3] {
                    std::array::from_fn(|a| {
                        let room = (grid.cells[a] + to).saturating_sub(shift).max(1);
                        (shift.min(grid.cells[a] - 1) + node[a] % room) as f64 * grid.spacing[a]
                    })
                };
                model.pml_cells = Some(std::array::from_fn(|side| {
                    let both = pml[side % 3] + pml[side % 3 + 3];
                    if both < grid.cells[side % 3] { pml[side] } else { 0 }
                }));
                let mut wet = Material::dielectric("wet", 3.0, 0.01);
                wet.poles = vec![DebyePole { delta_eps: 3.0, tau: 1e-11 }, DebyePole { delta_eps: 1.0, tau: 2e-11 }];
                let ore = Material { mu_r: 1.5, sigma_magnetic: 10.0, ..Material::dielectric("ore", 3.0, 0.0) };
                let mut materials = vec![MaterialId::PEC];
                let lossy = Material::dielectric("lossy", 4.0, 0.2);
                let poles = vec![DebyePole { delta_eps: 2.0, tau: 9e-12 }];
                let damp = Material { poles, ..Material::dielectric("damp", 3.5, 0.0) };
                for material in [lossy, Material::dielectric("dense", 9.0, 0.0), wet, ore, damp] {
                    materials.push(model.add_material(material));
                }
                for (kind, at, size, averaging) in objects {
                    let lower = place(at, 0, 0);
                    let upper = std::array::from_fn(|a| lower[a] + size[a] as f64 * grid.spacing[a]);
                    let material = if kind < 6 { materials[kind] } else { MaterialId::FREE_SPACE };
                    model.objects.push(Object::Box { lower, upper, material, averaging });
                }
                if many {
                    for k in 0..8 {
                        let stone = Material::dielectric(format!("stone{k}"), 4.0 + 0.3 * f64::from(k), 0.0);
                        let material = model.add_material(stone);
                        let lower = place([3 * k as usize, 5 * k as usize, 7 * k as usize], 0, 0);
                        let upper = std::array::from_fn(|a| lower[a] + 4.0 * grid.spacing[a]);
                        model.objects.push(Object::Box { lower, upper, material, averaging: true });
                    }
                }
                model.waveforms.push(Waveform {
                    id: "w".into(),
                    kind: WaveformKind::Ricker,
                    amplitude: 1.0,
                    frequency: 3e9,
                });
                for (at, kind, axis, late) in sources {
                    let (polarisation, position, waveform) = (axis_of(axis), place(at, 1, 0), 0);
                    let excitation = Excitation { start: late as f64 * 4e-12, stop: None };
                    let voltage =
                        |resistance| VoltageSource { polarisation, position, resistance, waveform, excitation };
                    model.sources.push(match kind {
                        0 => Source::HertzianDipole(HertzianDipole { polarisation, position, waveform, excitation }),
                        1 => Source::MagneticDipole(MagneticDipole { polarisation, position, waveform, excitation }),
                        2 => Source::VoltageSource(voltage(50.0)),
                        _ => Source::VoltageSource(voltage(0.0)),
                    });
                }
                let receiver = |at| Receiver { position: place(at, 0, 1), name: None };
                model.receivers = receivers.into_iter().map(receiver).collect();
                model
            },
        )
    }

    /// How a run is ordered.
    #[derive(Debug, Clone, Copy)]
    struct Order {
        threads: usize,
        /// About how many rows a tile has.
        height: usize,
        skip: bool,
        /// Nodes by which the light cones are made too narrow.
        narrower: i32,
        set: InstructionSet,
    }

    const PLAIN: Order = Order { threads: 1, height: 1000, skip: false, narrower: 0, set: InstructionSet::Scalar };

    fn go<T: Number>(model: &Model, order: Order) -> Result<Vec<u64>, FdtdError> {
        let painted = paint3(model).map_err(FdtdError::from)?;
        let mut setup = Setup3::new(model, Cow::Owned(painted))?;
        let set = order.set.resolve().unwrap_or(InstructionSet::Auto.resolve()?).set();
        let mut shared = Shared::<T>::new(&setup, set, order.skip);
        shared.cones.narrow(order.narrower);
        let planes = planes(&mut setup, &shared);
        let (mut probes, _) =
            run(&setup, &shared, planes, Share { threads: order.threads, height: order.height }, None, None, &|_| {
                ControlFlow::Continue(())
            })?;
        probes.sort_by_key(|probe| probe.receiver);
        Ok(probes.into_iter().flat_map(|probe| probe.samples).flatten().map(f64::to_bits).collect())
    }

    proptest! {
        /// In every step of a pass the tiles take each row once, and none is too low for its neighbours.
        #[test]
        fn tiles_take_every_row_once(rows in 1usize..400, height in 0usize..60) {
            let tiles = Tiles::new(rows, height);
            for stage in 0..STAGES {
                let taken: Vec<usize> = (0..tiles.count).flat_map(|tile| tiles.rows(tile, stage)).collect();
                prop_assert_eq!(taken, (0..rows).collect::<Vec<_>>());
            }
            prop_assert!(tiles.height > STAGES);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

        /// Threads, instructions and what is left out change no bit of any sample, in either precision.
        #[test]
        fn no_order_of_steps_changes_a_bit(
            model in any_model(), threads in 1usize..5, height in 1usize..20, skip in any::<bool>(),
            set in prop::sample::select(vec![InstructionSet::Scalar, InstructionSet::Avx2, InstructionSet::Avx512]),
        ) {
            let order = Order { threads, height, skip, set, ..PLAIN };
            match go::<f32>(&model, PLAIN) {
                Ok(plain) => prop_assert_eq!(plain, go::<f32>(&model, order).unwrap()),
                // A source on a wall or in a conductor, or a grid of one row.
                Err(error) => prop_assert_eq!(error.to_string(), go::<f32>(&model, order).unwrap_err().to_string()),
            }
            if let Ok(plain) = go::<f64>(&model, PLAIN) {
                let order = Order { skip: true, ..order };
                prop_assert_eq!(plain, go::<f64>(&model, order).unwrap());
            }
        }
    }

    /// Light cones that begin a few steps late show in the samples: the test above can fail. (How many steps, depends on when
    /// the first numbers are large enough to count beside the rest.)
    #[test]
    fn narrower_cones_would_change_the_samples() {
        let mut model = Model::new("", Grid { cells: [20; 3], spacing: [0.002; 3] }, TimeWindow::Iterations(70));
        model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 9e9 });
        let (position, excitation) = ([0.02; 3], Excitation { start: 0.0, stop: None });
        let dipole = HertzianDipole { polarisation: axis_of(2), position, waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model.receivers.push(Receiver { position: [0.024, 0.026, 0.02], name: None });
        model.pml_cells = Some([3; 6]);
        let plain = go::<f64>(&model, PLAIN).unwrap();
        let narrow = |narrower| go::<f64>(&model, Order { skip: true, narrower, ..PLAIN }).unwrap();
        assert!(narrow(0) == plain && narrow(12) != plain);
    }
}

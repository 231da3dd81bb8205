//! The threads of a run: each steps its own block and hands the neighbours the rows on its rims.
//!
//! After pass `p` a thread writes the state of its first and last rows into the letterbox of that parity and announces
//! `p + 1`; before the next pass it waits until both neighbours have announced as much. A letterbox is written again two
//! passes later, when the neighbours have announced the pass in between and so have read it. Nobody waits for the whole
//! team, and neighbours meet once in several steps only, so a crowded machine does not hold them up at each step.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::FdtdError;
use super::block::{Beyond, Block, Probe};
use super::instructions::Sweep;
use super::layout::padded_width;
use super::reach::Cones;
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

/// Most steps per pass.
const MOST_STEPS_PER_PASS: usize = 16;
/// What the rows between the first and the last step of a pass may take, bytes: half of an outer cache of 1 MiB per core.
const CACHE_FOR_A_PASS: usize = 512 * 1024;

/// Announced passes, each on its own cache line.
#[repr(align(128))]
struct Announced(AtomicUsize);

/// Rows on the way from a block to its neighbours.
struct Letterbox<T> {
    first: Mutex<Vec<T>>,
    last: Mutex<Vec<T>>,
}

struct Team<'a, T> {
    cones: &'a Cones,
    /// Steps per pass.
    depth: usize,
    /// Rows of a neighbour that a block stores.
    rim: usize,
    announced: Vec<Announced>,
    letterboxes: Vec<[Letterbox<T>; 2]>,
    halt: AtomicBool,
    failure: Mutex<Option<FdtdError>>,
}

/// How many threads a grid is worth, given how many are wanted.
pub fn worthwhile_threads(cells: usize, rows: usize, wanted: NonZeroUsize) -> usize {
    wanted.get().min(cells / LEAST_CELLS_PER_THREAD).min(rows / 4).max(1)
}

/// Steps per pass: as many as the cache has room for, and few enough that the neighbours' rows, which a block steps too,
/// are at most a tenth of its own.
///
/// More steps per pass move less memory. On rows of 1000 cells in single precision 1, 2, 4, 8 and 16 steps per pass made
/// 1.1, 1.3, 1.8, 2.3 and 2.8 10⁹ cell-steps per second of processor time (`cargo bench --bench fdtd`, Zen 5, one thread,
/// other load on the machine); a grid that the outermost cache holds gains next to nothing from any.
pub fn steps_per_pass<T: Real>(setup: &Setup<'_>, threads: usize) -> usize {
    let [nx, ny] = setup.painted.cells_xy;
    let arrays = if setup.lossy() { 5 } else { 4 };
    let reach = setup.order.cells_per_step();
    let row = reach * arrays * padded_width(ny) * size_of::<T>();
    let by_cache = (CACHE_FOR_A_PASS / row).max(4);
    let by_rows = if threads == 1 { MOST_STEPS_PER_PASS } else { nx / threads / (10 * reach) };
    by_cache.min(by_rows).clamp(1, MOST_STEPS_PER_PASS)
}

/// Rows that a value moves in a pass of `depth` steps.
fn rim(setup: &Setup<'_>, depth: usize) -> usize {
    setup.order.cells_per_step() * depth
}

/// Cuts the rows `1..nx` of the grid into blocks of nearly equal work, each with rows enough for its neighbours' rims.
///
/// There are fewer blocks than `threads` where rows are too few.
pub fn blocks<T: Real>(setup: &Setup<'_>, cones: &Cones, threads: usize, depth: usize) -> Vec<Block<T>> {
    let bounds = bounds(setup, cones, threads, depth);
    bounds.windows(2).map(|ends| Block::new(setup, ends[0]..ends[1], rim(setup, depth))).collect()
}

/// What a row costs beside its nodes, as a number of nodes: 18 ns to 0.137 ns, from processor times of rows of 64 to 512 nodes
/// without absorbing cells, which it meets within 3 % (single precision, Zen 5, one thread).
const NODES_PER_ROW: usize = 133;

/// The time of a run as a share of that of one that steps every cell, which is cut into blocks of equal size: that of each
/// step is that of its busiest block. From a sample of the steps.
pub fn share_of_time<T: Real>(setup: &Setup<'_>, cones: &Cones, threads: usize) -> f64 {
    let depth = steps_per_pass::<T>(setup, threads);
    let every_cell = Cones::new(setup, false);
    let steps = setup.iterations.saturating_sub(1);
    let busiest = |cones: &Cones| {
        let bounds = bounds(setup, cones, threads, depth);
        let every = (setup.painted.cells_xy[0] * steps / 200_000).max(1);
        let of_row = |row: usize, step| cones.span(row, step).map_or(0, |(_, nodes)| nodes + NODES_PER_ROW);
        let of_block = |ends: &[usize], step| (ends[0]..ends[1]).map(|row| of_row(row, step)).sum::<usize>();
        let of_step = |step| bounds.windows(2).map(|ends| of_block(ends, step)).max().unwrap_or(0);
        (0..steps).step_by(every).map(of_step).sum::<usize>() as f64
    };
    let all = busiest(&every_cell);
    if all > 0.0 { busiest(cones) / all } else { 1.0 }
}

/// First rows of the blocks, and the far wall.
fn bounds(setup: &Setup<'_>, cones: &Cones, threads: usize, depth: usize) -> Vec<usize> {
    let nx = setup.painted.cells_xy[0];
    let rim = rim(setup, depth);
    let threads = threads.min((nx - 1) / rim.max(1)).max(1);
    let (mut work, _) = cones.work_per_row();
    work.pop();
    let total = work.iter().sum::<u64>() as f64;
    let mut bounds = vec![1];
    let (mut row, mut done) = (0, 0.0);
    for block in 1..threads {
        let goal = total * block as f64 / threads as f64;
        while row + 1 < nx && done + work[row] as f64 <= goal {
            done += work[row] as f64;
            row += 1;
        }
        // Rows without work are shared out evenly.
        let wanted = if total > 0.0 { row } else { 1 + (nx - 1) * block / threads };
        bounds.push(wanted.clamp(bounds[block - 1] + rim, nx - (threads - block) * rim));
    }
    bounds.push(nx);
    bounds
}

/// Runs all steps, `depth` per pass; returns what the receivers recorded and the wall time of the loop.
///
/// # Errors
/// When a field diverges or the caller asks to stop.
pub fn run<T: Real>(
    mut blocks: Vec<Block<T>>,
    setup: &Setup<'_>,
    cones: &Cones,
    depth: usize,
    sweep: Sweep,
    on_progress: OnProgress<'_>,
) -> Result<(Vec<Probe>, Duration), FdtdError> {
    let (count, rim) = (blocks.len(), rim(setup, depth));
    let mut letterboxes = Vec::with_capacity(count);
    for (me, block) in blocks.iter_mut().enumerate() {
        // Packed once already, so that each letter has the room it needs.
        let mut letter = |last, wanted| {
            let mut letter = vec![];
            if wanted {
                block.pack(last, rim, &mut letter);
            }
            Mutex::new(letter)
        };
        letterboxes
            .push([0, 1].map(|_| Letterbox { first: letter(false, me > 0), last: letter(true, me + 1 < count) }));
    }
    let team = Team {
        cones,
        depth,
        rim,
        announced: blocks.iter().map(|_| Announced(AtomicUsize::new(0))).collect(),
        letterboxes,
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
    if let Some(beyond) = done.iter().find_map(|block| block.find_beyond(setup.iterations)) {
        return Err(diverged(setup, beyond));
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

impl<T: Real> Team<'_, T> {
    fn steps(
        &self,
        me: usize,
        mut block: Block<T>,
        setup: &Setup<'_>,
        sweep: Sweep,
        tick: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Block<T> {
        let _guard = HaltOnPanic(&self.halt);
        let steps = setup.iterations.saturating_sub(1);
        for (pass, step) in (0..steps).step_by(self.depth).enumerate() {
            if tick(step).is_break() {
                self.fail(FdtdError::Stopped);
            }
            if !self.receive(me, pass, &mut block) {
                break;
            }
            let count = self.depth.min(steps - step);
            sweep.run(&mut block, self.cones, step, count);
            self.send(me, pass + 1, &mut block);
            let done = step + count;
            let scan = done / STEPS_BETWEEN_SCANS > step / STEPS_BETWEEN_SCANS;
            let scanned = || if scan { block.find_beyond(done) } else { None };
            if let Some(beyond) = block.beyond_at_receivers().or_else(scanned) {
                self.fail(diverged(setup, beyond));
            }
        }
        block
    }

    /// Notes the first failure and stops the team.
    fn fail(&self, failure: FdtdError) {
        lock(&self.failure).get_or_insert(failure);
        self.halt.store(true, Ordering::Relaxed);
    }

    /// Waits for the neighbours to have made `pass` passes and takes their rims; false when the team is to stop.
    fn receive(&self, me: usize, pass: usize, block: &mut Block<T>) -> bool {
        if pass > 0 && me > 0 {
            if !self.wait(me - 1, pass) {
                return false;
            }
            block.unpack(false, self.rim, &lock(&self.letterboxes[me - 1][pass % 2].last));
        }
        if pass > 0 && me + 1 < self.announced.len() {
            if !self.wait(me + 1, pass) {
                return false;
            }
            block.unpack(true, self.rim, &lock(&self.letterboxes[me + 1][pass % 2].first));
        }
        !self.halt.load(Ordering::Relaxed)
    }

    fn send(&self, me: usize, pass: usize, block: &mut Block<T>) {
        let Letterbox { first, last } = &self.letterboxes[me][pass % 2];
        if me > 0 {
            block.pack(false, self.rim, &mut lock(first));
        }
        if me + 1 < self.announced.len() {
            block.pack(true, self.rim, &mut lock(last));
        }
        self.announced[me].0.store(pass, Ordering::Release);
    }

    /// Spins for a while, then yields the core, so that a crowded machine is not spun dry.
    fn wait(&self, neighbour: usize, pass: usize) -> bool {
        let mut rounds = 0;
        while self.announced[neighbour].0.load(Ordering::Acquire) < pass {
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

fn diverged(setup: &Setup<'_>, beyond: Beyond) -> FdtdError {
    let [dx, dy, _] = setup.spacing;
    let Beyond { step, node: [i, j], value } = beyond;
    FdtdError::Diverged { step, i, j, x: i as f64 * dx, y: j as f64 * dy, value }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::fdtd::InstructionSet;
    use crate::model::{
        self, Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, MaterialId, Model, Object, Receiver, Source,
        TimeWindow, Waveform, WaveformKind, paint,
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

    /// How a run is cut and ordered.
    #[derive(Debug, Clone, Copy)]
    struct Order {
        threads: usize,
        depth: usize,
        skip: bool,
        set: InstructionSet,
    }

    const PLAIN: Order = Order { threads: 1, depth: 1, skip: false, set: InstructionSet::Scalar };

    fn go<T: Real>(model: &Model, order: Order, faster: f64) -> Result<Vec<Vec<f64>>, FdtdError> {
        let painted = paint(model).unwrap();
        let mut setup = Setup::new(model, &painted)?;
        setup.edges.iter_mut().for_each(|edge| edge.cb *= faster);
        let sweep = order.set.resolve().unwrap_or(InstructionSet::Auto.resolve()?);
        let cones = Cones::new(&setup, order.skip);
        let blocks = blocks::<T>(&setup, &cones, order.threads, order.depth);
        let (mut probes, _) = run(blocks, &setup, &cones, order.depth, sweep, &|_| ControlFlow::Continue(()))?;
        probes.sort_by_key(|probe| probe.receiver);
        assert_eq!(probes.len(), model.receivers.len());
        Ok(probes.into_iter().flat_map(|probe| probe.samples).collect())
    }

    /// Blocks down to as many rows as a pass has steps, walls and absorbing rows cut through: the same bits at every node
    /// along a diagonal.
    #[test]
    fn any_cut_gives_the_same_bits() {
        for order in [model::Order::Second, model::Order::Fourth] {
            let mut model = model(15, 9, 300);
            model.order = order;
            let whole = go::<f32>(&model, PLAIN, 1.0).unwrap();
            assert!(whole.iter().flatten().any(|v| *v != 0.0));
            for (threads, depth) in [(1, 3), (1, 14), (2, 1), (2, 2), (2, 7), (3, 4), (4, 1), (7, 2), (14, 1)] {
                let order = Order { threads, depth, ..PLAIN };
                assert!(go::<f32>(&model, order, 1.0).unwrap() == whole, "{order:?} {:?}", model.order);
            }
        }
    }

    /// A model of any kind: several sources that begin late, receivers anywhere, conductors, loss, Debye media of one to
    /// three poles, thin absorbing slabs.
    fn any_model() -> impl Strategy<Value = Model> {
        let node = (0usize..1000, 0usize..1000);
        let objects = prop::collection::vec((0usize..5, node.clone(), 1usize..12, 1usize..40, any::<bool>()), 0..6);
        let sources = prop::collection::vec((node.clone(), 0usize..60), 0..4);
        let receivers = prop::collection::vec(node, 0..4);
        let pml = prop::array::uniform4(0usize..4);
        let order = prop::sample::select(vec![model::Order::Second, model::Order::Fourth]);
        (2usize..40, 2usize..70, 0usize..160, objects, sources, receivers, (pml, order)).prop_map(
            |(nx, ny, steps, objects, sources, receivers, (pml, order))| {
                let mut made = model(nx, ny, steps);
                made.order = order;
                made.grid.spacing[1] = 0.0025;
                let [dx, dy, _] = made.grid.spacing;
                let fits = |low: usize, high: usize, cells: usize| low + high < cells;
                let [x0, y0, x1, y1] = pml;
                let (x0, x1) = if fits(x0, x1, nx) { (x0, x1) } else { (0, 0) };
                let (y0, y1) = if fits(y0, y1, ny) { (y0, y1) } else { (0, 0) };
                made.pml_cells = Some([x0, y0, 0, x1, y1, 0]);
                let relaxing = |poles: usize| {
                    let mut material = Material::dielectric(format!("debye{poles}"), 3.0, 0.01);
                    material.poles =
                        (0..poles).map(|p| DebyePole { delta_eps: 3.0, tau: 1e-11 * (p + 1) as f64 }).collect();
                    material
                };
                let materials = [
                    MaterialId::PEC,
                    made.add_material(Material::dielectric("lossy", 4.0, 0.2)),
                    made.add_material(Material::dielectric("dense", 9.0, 0.0)),
                    made.add_material(relaxing(1)),
                    made.add_material(relaxing(3)),
                ];
                for (material, (i, j), wide, high, averaging) in objects {
                    let (i, j) = (i % nx, j % ny);
                    let lower = [i as f64 * dx, j as f64 * dy, 0.0];
                    let upper = [(i + wide).min(nx) as f64 * dx, (j + high).min(ny) as f64 * dy, 0.002];
                    made.objects.push(Object::Box { lower, upper, material: materials[material], averaging });
                }
                let template = made.sources.remove(0);
                for ((i, j), late) in sources {
                    let Source::HertzianDipole(mut dipole) = template.clone() else { panic!("a current") };
                    dipole.position = [(1 + i % (nx - 1)) as f64 * dx, (1 + j % (ny - 1)) as f64 * dy, 0.0];
                    dipole.excitation.start = late as f64 * 4e-12;
                    made.sources.push(Source::HertzianDipole(dipole));
                }
                let place = |(i, j): (usize, usize)| [(i % (nx + 1)) as f64 * dx, (j % (ny + 1)) as f64 * dy, 0.0];
                made.receivers =
                    receivers.into_iter().map(|node| Receiver { position: place(node), name: None }).collect();
                made
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

        /// Steps per pass, threads, instructions and what is left out change no bit of any sample, in either precision.
        #[test]
        fn no_order_of_steps_changes_a_bit(
            model in any_model(), threads in 1usize..5, depth in 1usize..18, skip in any::<bool>(),
            set in prop::sample::select(vec![InstructionSet::Scalar, InstructionSet::Avx2, InstructionSet::Avx512]),
        ) {
            let depth = depth.min(model.grid.cells[0] - 1);
            let order = Order { threads, depth, skip, set };
            let bits = |samples: Vec<Vec<f64>>| -> Vec<u64> { samples.iter().flatten().map(|v| v.to_bits()).collect() };
            match go::<f32>(&model, PLAIN, 1.0) {
                Ok(plain) => prop_assert_eq!(bits(plain), bits(go::<f32>(&model, order, 1.0).unwrap())),
                // A source that an object has buried in a conductor.
                Err(error) => prop_assert!(matches!(error, FdtdError::SourceInConductor { .. }), "{error}"),
            }
            if let Ok(plain) = go::<f64>(&model, PLAIN, 1.0) {
                let order = Order { skip: true, ..order };
                prop_assert_eq!(bits(plain), bits(go::<f64>(&model, order, 1.0).unwrap()));
            }
        }
    }

    /// A scheme made unstable (a step beyond the Courant limit by 5 %) is stopped, and the place is in the grid.
    #[test]
    fn a_diverging_run_is_stopped_at_a_place() {
        for (threads, depth, order) in
            [(1, 1, model::Order::Second), (3, 8, model::Order::Second), (3, 4, model::Order::Fourth)]
        {
            let mut model = model(40, 40, 100_000);
            model.order = order;
            match go::<f32>(&model, Order { threads, depth, ..PLAIN }, 1.1) {
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

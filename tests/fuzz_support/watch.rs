//! Runs inputs under watch: panics are caught, memory is counted, time is measured.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, Once};
use std::time::{Duration, Instant};

use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use super::targets::Target;

/// The system's allocator; keeps the memory in use, the most there was, and the largest single request.
pub struct Watched;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
static LARGEST: AtomicUsize = AtomicUsize::new(0);

/// A request beyond this is refused, which ends the process with a message: no reader may make one.
const REFUSED: usize = 2 << 30;

fn count(old: usize, new: usize) {
    LARGEST.fetch_max(new, Relaxed);
    let live = LIVE.fetch_add(new, Relaxed) + new - old.min(new);
    LIVE.fetch_sub(old, Relaxed);
    MOST.fetch_max(live, Relaxed);
}

// SAFETY: every call is handed to the system's allocator unchanged, or answered by null, which the contract allows.
unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > REFUSED {
            return std::ptr::null_mut();
        }
        count(0, layout.size());
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if layout.size() > REFUSED {
            return std::ptr::null_mut();
        }
        count(0, layout.size());
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size > REFUSED {
            return std::ptr::null_mut();
        }
        count(layout.size(), size);
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// After so many inputs.
    pub inputs: u64,
    /// After so long.
    pub time: Duration,
}

/// What was found.
#[derive(Debug, Default)]
pub struct Report {
    pub inputs: u64,
    /// Inputs that were read without an error.
    pub accepted: u64,
    pub time: Duration,
    pub slowest: Duration,
    /// The largest single request for memory, bytes.
    pub largest_request: usize,
    /// The most memory in use at once beyond what was in use before, bytes.
    pub most_memory: usize,
    /// Panics inside the HDF5 crate that the reader turned into errors.
    pub caught_inside: u64,
    /// Inputs that were not survived, with what happened.
    pub failures: Vec<String>,
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mebibytes = |bytes: usize| bytes as f64 / f64::from(1 << 20);
        write!(
            f,
            "{:>9} inputs, {:>8} read, {:>6.1} s, slowest {:>7.1} ms, largest request {:>6.1} MiB, most memory {:>6.1} MiB, \
             {} panics turned into errors, {} failures",
            self.inputs,
            self.accepted,
            self.time.as_secs_f64(),
            1e3 * self.slowest.as_secs_f64(),
            mebibytes(self.largest_request),
            mebibytes(self.most_memory),
            self.caught_inside,
            self.failures.len()
        )
    }
}

thread_local! {
    static LAST_PANIC: Cell<Option<String>> = const { Cell::new(None) };
}
static PANICS: AtomicU64 = AtomicU64::new(0);
static QUIET: Once = Once::new();
/// Inputs begun, and which: what the watchdog looks at.
static BEGUN: AtomicU64 = AtomicU64::new(0);
static RUNNING: Mutex<String> = Mutex::new(String::new());

/// Runs one input; tells whether it was read, or how it was not survived.
pub fn run_one(target: &Target, folder: &Path, input: &[u8]) -> Result<bool, String> {
    QUIET.call_once(quieten);
    match catch_unwind(AssertUnwindSafe(|| target.run(folder, input))) {
        Ok(read) => Ok(read),
        Err(_) => Err(LAST_PANIC.take().unwrap_or_default()),
    }
}

/// Keeps panics quiet but for their place, and starts the watchdog, which ends the process when one input takes a minute.
fn quieten() {
    set_hook(Box::new(|info| {
        PANICS.fetch_add(1, Relaxed);
        LAST_PANIC.set(Some(info.to_string()));
    }));
    std::thread::spawn(|| {
        let mut seen = 0;
        loop {
            std::thread::sleep(Duration::from_secs(60));
            let begun = BEGUN.load(Relaxed);
            if begun == seen && begun > 0 && RUNNING.lock().is_ok_and(|running| !running.is_empty()) {
                eprintln!("an input took more than a minute: {:?}", RUNNING.lock());
                std::process::exit(1);
            }
            seen = begun;
        }
    });
}

/// Feeds a target with mutated inputs; those not survived are kept in `kept`.
///
/// Memory is counted for the process as a whole: one target at a time.
pub fn run(target: &Target, seed: u64, budget: Budget, kept: &Path) -> Report {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let folder = tempfile::tempdir().unwrap();
    target.prepare(folder.path());
    let seeds = target.seeds();
    let mut random = Pcg64::seed_from_u64(seed);
    let mut report = Report::default();
    let (started, panics) = (Instant::now(), PANICS.load(Relaxed));
    LARGEST.store(0, Relaxed);
    let mut not_survived = 0;
    while report.inputs < budget.inputs && started.elapsed() < budget.time {
        let input = target.mutate(&seeds, &mut random);
        if let Ok(mut running) = RUNNING.lock() {
            *running = format!("{}, seed {seed}, input {}, {}", target.name(), report.inputs, folder.path().display());
        }
        BEGUN.fetch_add(1, Relaxed);
        let before = LIVE.load(Relaxed);
        MOST.store(before, Relaxed);
        let begun = Instant::now();
        let outcome = run_one(target, folder.path(), &input);
        let took = begun.elapsed();
        let memory = MOST.load(Relaxed).saturating_sub(before);
        report.inputs += 1;
        report.slowest = report.slowest.max(took);
        report.most_memory = report.most_memory.max(memory);
        let mut survived = true;
        let mut failed = |what: String| {
            let place = keep(kept, target, &input);
            report.failures.push(format!("{}: {what}\n  input kept in {}", target.name(), place.display()));
        };
        match outcome {
            Ok(read) => report.accepted += u64::from(read),
            Err(panic) => {
                failed(panic);
                survived = false;
            }
        }
        if took > target.most_time() {
            failed(format!("took {took:?}"));
        }
        if memory > target.most_memory(input.len()) {
            failed(format!("took {memory} bytes for an input of {}", input.len()));
        }
        not_survived += u64::from(!survived);
        if report.failures.len() > 20 {
            break;
        }
    }
    if let Ok(mut running) = RUNNING.lock() {
        running.clear();
    }
    report.time = started.elapsed();
    report.largest_request = LARGEST.load(Relaxed);
    report.caught_inside = PANICS.load(Relaxed) - panics - not_survived;
    report
}

/// Writes an input that was not survived, under a name made of its bytes.
fn keep(folder: &Path, target: &Target, input: &[u8]) -> PathBuf {
    let hash = input.iter().fold(0xcbf2_9ce4_8422_2325_u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let folder = folder.join(target.name());
    let path = folder.join(format!("{hash:016x}"));
    let written = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, input));
    written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

//! Runs experiments with a bar: one alone, or many side by side.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::cli::error::{CliError, Kind};
use crate::cli::experiment::Specified;
use crate::cli::progress::Bar;
use crate::forward::Progress;
use crate::study::experiments::{Outcome, Running, Told};

/// Runs an experiment with a bar that shows the stage and its energy ratio.
///
/// # Errors
/// When it cannot be run.
pub fn in_sight(
    spec: &Specified,
    threads: Option<NonZeroUsize>,
    keep_in: Option<&Path>,
    fresh: bool,
) -> Result<Outcome, CliError> {
    let bar = Bar::new("experiment");
    watched(spec, or_all(threads), keep_in, fresh, &|told| {
        let progress = Progress { done: (1000.0 * told.share.clamp(0.0, 1.0)) as usize, total: 1000 };
        bar.update_with(progress, || said(told))
    })
}

/// Runs `count` experiments, each on one of the threads or on its share of them, and gives what `run` makes of each, in their
/// order. Small beds gain little from a second thread; two of them side by side gain all of it.
///
/// # Errors
/// The first error of any; those that have not begun then do not begin.
pub fn side_by_side<T: Send>(
    count: usize,
    threads: Option<NonZeroUsize>,
    run: impl Fn(usize, &Place) -> Result<T, CliError> + Sync,
) -> Result<Vec<T>, CliError> {
    let threads = or_all(threads);
    let workers = threads.get().min(count).max(1);
    let each = NonZeroUsize::new(threads.get() / workers).unwrap_or(NonZeroUsize::MIN);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(workers)
        .build()
        .map_err(|error| CliError::new(Kind::Fault, format!("{workers} threads cannot be started: {error}")))?;
    let place = Place { bar: Bar::new("experiments"), over: AtomicUsize::new(0), count, threads: each };
    pool.install(|| {
        (0..count)
            .into_par_iter()
            .with_max_len(1)
            .map(|index| {
                let made = run(index, &place);
                place.over.fetch_add(1, Ordering::Relaxed);
                made
            })
            .collect()
    })
}

/// Where one of many experiments runs.
pub struct Place {
    bar: Bar,
    over: AtomicUsize,
    count: usize,
    threads: NonZeroUsize,
}

impl Place {
    /// Runs an experiment here; the bar tells how many are over and what one of them is at.
    ///
    /// # Errors
    /// When it cannot be run.
    pub fn run(&self, spec: &Specified, keep_in: Option<&Path>, fresh: bool) -> Result<Outcome, CliError> {
        watched(spec, self.threads, keep_in, fresh, &|told| {
            let over = self.over.load(Ordering::Relaxed);
            let progress = Progress { done: over, total: self.count };
            self.bar.update_with(progress, || format!("{over} of {} over; {}", self.count, said(told)))
        })
    }
}

fn watched(
    spec: &Specified,
    threads: NonZeroUsize,
    keep_in: Option<&Path>,
    fresh: bool,
    watch: &dyn Fn(&Told) -> ControlFlow<()>,
) -> Result<Outcome, CliError> {
    Ok(spec.run(&Running { threads, watch, keep_in: keep_in.map(Path::to_owned), fresh })?)
}

fn said(told: &Told) -> String {
    let lost = if told.lost > 0 { format!(", {} lost", told.lost) } else { String::new() };
    format!("{}: energy {:.1e}, unbalanced {:.1e}{lost}", told.stage, told.energy_ratio, told.unbalanced)
}

fn or_all(threads: Option<NonZeroUsize>) -> NonZeroUsize {
    threads.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
}

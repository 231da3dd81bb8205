//! A B-scan: several traces of one input file, sources and receivers moved between them, the geometry painted once.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use crate::cli::checkpoint::Used;
use crate::cli::error::CliError;
use crate::cli::folder::RunRecord;
use crate::cli::geometry_files;
use crate::cli::progress::Bar;
use crate::cli::run::{Outcome, RunArgs, SolverName, built_in_solver, fingerprint, kept_or_refused, paths, record};
use crate::cli::snapshots::{self, Album};
use crate::cli::table::Report;
use crate::fdtd::{Fdtd, FdtdError, Keeping, Stats};
use crate::forward::Progress;
use crate::gprmax;
use crate::model::{self, Model, Painted, Painted3, Resolution};
use crate::trace::Traces;

/// The cells and edges that all traces share.
enum Geometry {
    Two(Painted),
    Three(Box<Painted3>),
}

impl Geometry {
    fn of(model: &Model) -> Result<Self, CliError> {
        let (geometry, resolution) = if model.is_plane() {
            let painted = model::paint(model)?;
            let resolution = Resolution::of(model, &painted);
            (Self::Two(painted), resolution)
        } else {
            let painted = model::paint3(model)?;
            let resolution = Resolution::of_three(model, &painted);
            (Self::Three(Box::new(painted)), resolution)
        };
        if let Some(resolution) = resolution {
            resolution.check()?;
        }
        Ok(geometry)
    }

    fn solve(
        &self,
        solver: &Fdtd,
        model: &Model,
        keeping: Keeping<'_>,
        shown: &Shown<'_>,
    ) -> Result<(Traces, Stats), FdtdError> {
        let told = AtomicUsize::new(0);
        let on_progress = |progress: Progress| {
            let within = PARTS * progress.done / progress.total.max(1);
            shown.add(within.saturating_sub(told.fetch_max(within, Ordering::Relaxed)))
        };
        Ok(match self {
            Self::Two(painted) => solver.solve_painted(model, painted, &on_progress)?,
            Self::Three(painted) => solver.solve_painted_three_kept(model, painted, keeping, &on_progress)?,
        })
    }

    /// How many of `count` traces are made at once, one thread each, which saves what threads tell each other; 1 where all
    /// threads go into one trace: in three dimensions, and where too few traces would leave threads idle.
    fn side_by_side(&self, threads: usize, count: usize) -> usize {
        let even = count.is_multiple_of(threads) || count >= 8 * threads;
        if matches!(self, Self::Two(_)) && even { threads } else { 1 }
    }
}

/// Parts of a trace on the bar, so that it moves within one, too.
const PARTS: usize = 1000;

/// The progress of all traces together.
struct Shown<'a> {
    bar: &'a Bar,
    done: AtomicUsize,
    total: usize,
}

impl Shown<'_> {
    fn add(&self, parts: usize) -> ControlFlow<()> {
        let done = self.done.fetch_add(parts, Ordering::Relaxed) + parts;
        self.bar.update(Progress { done, total: self.total })
    }
}

/// Runs `count` traces of one input file, numbered from 1 as gprMax does.
///
/// # Errors
/// When the target is none, a trace leaves the grid, or a result may not be overwritten.
pub fn run(args: &RunArgs, count: NonZeroUsize) -> Result<(), CliError> {
    let [target] = args.targets.as_slice() else {
        return Err(CliError::input(
            "`--traces` takes one target\n\nhint: run the files of several B-scans one after another",
        ));
    };
    if args.solver == SolverName::Gprmax {
        return Err(CliError::input(
            "`--traces` is for the built-in solver\n\nhint: leave `--solver gprmax` out, or start gprMax itself with `-n`",
        ));
    }
    let (input, result) = paths(args, target)?;
    let fingerprint = fingerprint(args, &input)?;
    let mut model = gprmax::read_model(&input)?;
    model.order = args.order.unwrap_or(model.order);
    if model.source_steps == [0.0; 3] && model.receiver_steps == [0.0; 3] {
        eprintln!("warning: without `#src_steps` and `#rx_steps` all traces are the same");
    }
    let results: Vec<PathBuf> = (1..=count.get()).map(|number| numbered(&result, number)).collect();
    geometry_files::check(&model, &input, &results, true, args.force)?;
    let mut albums = vec![];
    for result in &results {
        let kept = kept_or_refused(args, result, &fingerprint)?;
        albums.push(if kept.is_none() { Some(Album::open(&model, result, args.force)?) } else { None });
    }
    let geometry = Geometry::of(&model)?;
    let mut solver = built_in_solver(args);
    let asked = solver.threads.or_else(|| model.threads.and_then(NonZeroUsize::new));
    let threads = asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN);
    let side_by_side = geometry.side_by_side(threads.get(), count.get());
    if side_by_side > 1 {
        solver.threads = Some(NonZeroUsize::MIN);
    }
    let bar = Bar::new("B-scan");
    let shown = Shown { bar: &bar, done: AtomicUsize::new(0), total: PARTS * count.get() };
    let make = |trace: usize, result: PathBuf, album: Option<Album>| -> Result<Made, CliError> {
        if let Some(record) = kept_or_refused(args, &result, &fingerprint)? {
            let _ = shown.add(PARTS);
            return Ok(Made { result, how: How::Kept(record) });
        }
        let album = album.map_or_else(|| Album::open(&model, &result, args.force), Ok)?;
        let started = Instant::now();
        let moved = model.at_trace(trace);
        let ((traces, stats), used) = snapshots::solve_kept(&args.keep, &album, &result, |keeping| {
            geometry.solve(&solver, &moved, keeping, &shown)
        })?;
        let record = record(args, &fingerprint, started, Some(stats.wall.si()));
        let new = New { trace, moved, traces, album, used, record };
        Ok(Made { result, how: How::New(Box::new(new)) })
    };
    let write = |Made { result, how }: Made| -> Result<Outcome, CliError> {
        let target = target.clone();
        match how {
            How::Kept(record) => Ok(Outcome { target, result, files: vec![], kept: true, record }),
            How::New(new) => {
                let New { trace, moved, traces, album, used, record } = *new;
                gprmax::write_traces(&result, &traces, &moved)?;
                let mut files = album.publish()?;
                files.extend(geometry_files::write_views(&model, &result, trace, true)?);
                used.remove();
                record.write_beside(&result)?;
                Ok(Outcome { target, result, files, kept: false, record })
            }
        }
    };
    let traces: Vec<_> = results.into_iter().zip(albums).enumerate().collect();
    let mut outcomes = in_turn(side_by_side, traces, |(trace, (result, album))| make(trace, result, album), write)?;
    drop(bar);
    if let Some(outcome) = outcomes.iter_mut().find(|outcome| !outcome.kept) {
        outcome.files.extend(geometry_files::write(&model, &input)?);
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&outcomes)?);
        return Ok(());
    }
    let mut table = Report::new(format!("{count} traces of {}", input.display()), ["result", "outcome", "seconds"]);
    for outcome in &outcomes {
        let how = if outcome.kept { "was there already" } else { "written" };
        table.row([outcome.result.display().to_string(), how.into(), format!("{:.2}", outcome.record.wall_seconds)]);
    }
    table.print();
    for file in outcomes.iter().flat_map(|outcome| &outcome.files) {
        println!("{} written", file.display());
    }
    Ok(())
}

/// A trace that has been computed, or was there.
struct Made {
    result: PathBuf,
    how: How,
}

enum How {
    Kept(RunRecord),
    New(Box<New>),
}

/// What is to be written of a trace.
struct New {
    trace: usize,
    moved: Model,
    traces: Traces,
    album: Album,
    used: Used,
    record: RunRecord,
}

/// What becomes of each thing, in order, `side_by_side` made at a time; the first failure in that order.
///
/// Each is written while the next is made: a disk takes its time to say that a file is safe.
fn in_turn<A: Send, M: Send, B: Send>(
    side_by_side: usize,
    things: Vec<A>,
    make: impl Fn(A) -> Result<M, CliError> + Sync,
    write: impl Fn(M) -> Result<B, CliError> + Sync,
) -> Result<Vec<B>, CliError> {
    let slots: Vec<_> = things.iter().map(|_| Mutex::new(None)).collect();
    let (queue, failed) = (Mutex::new(things.into_iter().enumerate()), AtomicBool::new(false));
    let next = || queue.lock().ok().filter(|_| !failed.load(Ordering::Relaxed)).and_then(|mut queue| queue.next());
    let keep = |index: usize, outcome: Result<B, CliError>| {
        failed.fetch_or(outcome.is_err(), Ordering::Relaxed);
        if let Ok(mut slot) = slots[index].lock() {
            *slot = Some(outcome);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..side_by_side {
            scope.spawn(|| {
                let mut writing: Option<std::thread::ScopedJoinHandle<'_, ()>> = None;
                while let Some((index, thing)) = next() {
                    let made = make(thing);
                    // One at a time, so that no more than one trace waits to be written.
                    if let Some(Err(panic)) = writing.take().map(|writing| writing.join()) {
                        std::panic::resume_unwind(panic);
                    }
                    let (keep, write) = (&keep, &write);
                    match made {
                        Ok(made) => writing = Some(scope.spawn(move || keep(index, write(made)))),
                        Err(error) => keep(index, Err(error)),
                    }
                }
            });
        }
    });
    slots.into_iter().filter_map(|slot| slot.into_inner().ok().flatten()).collect()
}

/// `scan.h5` becomes `scan3.h5`.
fn numbered(result: &Path, number: usize) -> PathBuf {
    let stem = result.file_stem().map_or("trace".into(), |stem| stem.to_string_lossy());
    result.with_file_name(format!("{stem}{number}.h5"))
}

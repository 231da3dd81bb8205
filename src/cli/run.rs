//! `run`: simulate a folder or a gprMax input file.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};

use crate::cli::batch;
use crate::cli::bscan;
use crate::cli::checkpoint::CheckpointArgs;
use crate::cli::error::CliError;
use crate::cli::folder::{self, RunRecord};
use crate::cli::geometry_files;
use crate::cli::progress::Bar;
use crate::cli::snapshots::{self, Album};
use crate::fdtd::{Fdtd, Precision};
use crate::gprmax;
use crate::model::Order;

/// Simulate folders written by `build`, or anybody's gprMax input files.
#[derive(Debug, Clone, Args)]
pub struct RunArgs {
    /// Folders written by `build`, or `.in` files. Several run side by side, one process per free core; results that are
    /// already there are kept, a failure is reported and the rest goes on.
    #[arg(required = true, value_name = "FOLDER|FILE.in")]
    pub targets: Vec<PathBuf>,
    /// `fdtd`: built in. `gprmax`: runs the real gprMax (see `ballast-gpr gprmax install`).
    #[arg(long, value_enum, default_value = "fdtd")]
    pub solver: SolverName,
    /// Threads of one run [default: all cores for one target, one for each of several].
    #[arg(long, value_name = "NUM")]
    pub threads: Option<NonZeroUsize>,
    /// Runs side by side when there are several targets [default: the number of free cores].
    #[arg(long, value_name = "NUM")]
    pub jobs: Option<NonZeroUsize>,
    /// Floating-point numbers of the fields.
    #[arg(long, value_enum, default_value = "single")]
    pub precision: PrecisionName,
    /// Order of the differences in space, 2 or 4 [default: what the file asks for, else 2, as gprMax].
    #[arg(long, value_name = "2|4")]
    pub order: Option<Order>,
    /// Result file, for a single target [default: FOLDER/fdtd.h5 or FOLDER/gprmax.h5, FILE.h5 beside FILE.in].
    #[arg(long, value_name = "FILE.h5")]
    pub out: Option<PathBuf>,
    /// Compute again and overwrite a result that is there.
    #[arg(long)]
    pub force: bool,
    /// Python interpreter that has gprMax, in place of the private one.
    #[arg(long, value_name = "PYTHON", env = "BALLAST_GPR_GPRMAX_PYTHON")]
    pub gprmax_python: Option<PathBuf>,
    /// B-scan: NUM traces of one `.in` file, sources and receivers moved by its `#src_steps` and `#rx_steps`, the geometry
    /// built once; the results are FILE1.h5, FILE2.h5 and so on, as gprMax numbers them.
    #[arg(short = 'n', long, value_name = "NUM")]
    pub traces: Option<NonZeroUsize>,
    #[command(flatten)]
    pub keep: CheckpointArgs,
    /// Print the outcome as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Which solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SolverName {
    /// The built-in solver.
    Fdtd,
    /// Real gprMax.
    Gprmax,
}

impl SolverName {
    /// The word on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fdtd => "fdtd",
            Self::Gprmax => "gprmax",
        }
    }
}

/// Which floating-point numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PrecisionName {
    /// 32 bits.
    Single,
    /// 64 bits.
    Double,
}

impl PrecisionName {
    /// The word on the command line and in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Double => "double",
        }
    }
}

/// What one run came to.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Outcome {
    /// Folder or file that was run.
    pub target: PathBuf,
    /// The result.
    pub result: PathBuf,
    /// What else the input file asks for: geometry files and snapshots.
    pub files: Vec<PathBuf>,
    /// Whether it was there already.
    pub kept: bool,
    /// What made it and how long that took.
    pub record: RunRecord,
}

/// Runs the subcommand.
///
/// # Errors
/// When a run fails; with several targets, after the others have finished.
pub fn run(args: &RunArgs) -> Result<(), CliError> {
    if let Some(count) = args.traces {
        return bscan::run(args, count);
    }
    if args.targets.len() > 1 {
        if args.out.is_some() {
            return Err(CliError::input(
                "`--out` names one file, but there are several targets\n\nhint: leave `--out` out; each result goes into its folder",
            ));
        }
        return batch::run_many(args);
    }
    let outcome = run_one(args, &args.targets[0])?;
    if args.json {
        println!("{}", serde_json::to_string_pretty(&outcome)?);
    } else {
        let record = &outcome.record;
        let how = if outcome.kept { "was there already" } else { "written" };
        println!("{} {how}: {} in {:.2} s", outcome.result.display(), record.solver, record.wall_seconds);
        for file in &outcome.files {
            println!("{} written", file.display());
        }
    }
    Ok(())
}

/// The flags of a plain run of one target.
pub fn plain_run(target: &Path, solver: SolverName, force: bool) -> RunArgs {
    RunArgs {
        keep: CheckpointArgs::default(),
        targets: vec![target.into()],
        solver,
        threads: None,
        jobs: None,
        order: None,
        precision: PrecisionName::Single,
        out: None,
        force,
        gprmax_python: None,
        traces: None,
        json: false,
    }
}

/// Runs one target in this process.
///
/// # Errors
/// When the target cannot be read, the result may not be overwritten, or the solver fails.
pub fn run_one(args: &RunArgs, target: &Path) -> Result<Outcome, CliError> {
    let (input, result) = paths(args, target)?;
    let fingerprint = fingerprint(args, &input)?;
    if let Some(record) = kept_or_refused(args, &result, &fingerprint)? {
        return Ok(Outcome { target: target.into(), result, files: vec![], kept: true, record });
    }
    let started = Instant::now();
    let (loop_seconds, files) = match args.solver {
        SolverName::Fdtd => run_fdtd(args, &input, &result)?,
        SolverName::Gprmax => run_gprmax(args, &input, &result)?,
    };
    let record = record(args, &fingerprint, started, loop_seconds);
    record.write_beside(&result)?;
    Ok(Outcome { target: target.into(), result, files, kept: false, record })
}

/// The fingerprint of what is run: the model's files, and the order where it is not left to them.
pub(super) fn fingerprint(args: &RunArgs, input: &Path) -> Result<String, CliError> {
    let files = folder::model_fingerprint(input)?;
    Ok(match args.order {
        Some(order) => format!("{files}, order {order}"),
        None => files,
    })
}

/// The record of a result that is there and is the one asked for; none where there is no result or it may be overwritten.
///
/// # Errors
/// When another result is there.
pub(super) fn kept_or_refused(args: &RunArgs, result: &Path, fingerprint: &str) -> Result<Option<RunRecord>, CliError> {
    if !result.exists() || args.force {
        return Ok(None);
    }
    let same = |record: &RunRecord| {
        record.model == fingerprint && record.solver == args.solver.name() && record.precision == args.precision.name()
    };
    match RunRecord::beside(result).filter(same) {
        Some(record) => Ok(Some(record)),
        None => Err(other_result(args, result, fingerprint)),
    }
}

/// What made a result.
pub(super) fn record(args: &RunArgs, fingerprint: &str, started: Instant, loop_seconds: Option<f64>) -> RunRecord {
    RunRecord {
        format_version: 1,
        program: folder::program(),
        solver: args.solver.name().into(),
        precision: args.precision.name().into(),
        threads: args.threads.map(NonZeroUsize::get),
        model: fingerprint.into(),
        wall_seconds: started.elapsed().as_secs_f64(),
        loop_seconds,
    }
}

/// The built-in solver as the flags want it.
pub(super) fn built_in_solver(args: &RunArgs) -> Fdtd {
    Fdtd {
        precision: match args.precision {
            PrecisionName::Single => Precision::Single,
            PrecisionName::Double => Precision::Double,
        },
        threads: args.threads,
        ..Fdtd::default()
    }
}

/// Says why a result that is there is not the one asked for.
fn other_result(args: &RunArgs, result: &Path, fingerprint: &str) -> CliError {
    let why = match RunRecord::beside(result) {
        None => "and nothing beside it says what made it".to_string(),
        Some(record) if record.model != fingerprint => "of another model: the input has changed since".to_string(),
        Some(record) if record.solver != args.solver.name() => format!("by the solver `{}`", record.solver),
        Some(record) => format!("in {} precision", record.precision),
    };
    CliError::input(format!(
        "`{}` exists already, {why}\n\nhint: overwrite it with `--force`, or write another with `--out FILE.h5`",
        result.display()
    ))
}

/// The input file and the result of a target.
pub(super) fn paths(args: &RunArgs, target: &Path) -> Result<(PathBuf, PathBuf), CliError> {
    let (input, default) = if target.is_dir() {
        if !folder::is_built(target) {
            let scene = target.join(folder::SCENE);
            let build = if scene.is_file() {
                format!(
                    "finish it with `ballast-gpr build {} --out {} --force`",
                    folder::typed(&scene),
                    folder::typed(target)
                )
            } else {
                "make a folder with one with `ballast-gpr build --out FOLDER`".to_string()
            };
            return Err(CliError::input(format!(
                "`{}` holds no complete model (`{}` and `{}`)\n\nhint: {build}",
                target.display(),
                folder::MODEL,
                folder::MANIFEST
            )));
        }
        (target.join(folder::MODEL), target.join(format!("{}.h5", args.solver.name())))
    } else if !target.exists() {
        let hint = if target.extension().is_some() {
            String::new()
        } else {
            format!("\n\nhint: `ballast-gpr build --out {}` makes a folder of that name", folder::typed(target))
        };
        return Err(CliError::input(format!("`{}` does not exist{hint}", target.display())));
    } else if target.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("in")) {
        (target.to_path_buf(), target.with_extension("h5"))
    } else {
        return Err(CliError::input(format!(
            "`{}` is neither a folder nor a gprMax input file (.in)\n\nhint: `ballast-gpr build` makes a folder, then `ballast-gpr run FOLDER`",
            target.display()
        )));
    };
    if !input.is_file() {
        return Err(CliError::input(format!("`{}` is not a file", input.display())));
    }
    Ok((input, args.out.clone().unwrap_or(default)))
}

/// Runs the built-in solver; gives the time of its loop and the files beside the result.
fn run_fdtd(args: &RunArgs, input: &Path, result: &Path) -> Result<(Option<f64>, Vec<PathBuf>), CliError> {
    let read = gprmax::read_input(input)?;
    for note in &read.notes {
        eprintln!("note: {note}");
    }
    geometry_files::check(&read.model, input, &[result.to_path_buf()], false, args.force)?;
    let album = Album::open(&read.model, result, args.force)?;
    let bar = Bar::new("simulating");
    let mut model = read.model;
    model.order = args.order.unwrap_or(model.order);
    let solver = built_in_solver(args);
    let ((traces, stats), used) = snapshots::solve_kept(&args.keep, &album, result, |keeping| {
        solver.solve_kept(&model, keeping, &|progress| bar.update(progress))
    })?;
    drop(bar);
    gprmax::write_traces(result, &traces, &model)?;
    let mut files = geometry_files::write(&model, input)?;
    files.extend(geometry_files::write_views(&model, result, 0, false)?);
    files.extend(album.publish()?);
    used.remove();
    Ok((Some(stats.wall.si()), files))
}

/// Runs gprMax; gives the time of its loop and the files beside the result.
fn run_gprmax(args: &RunArgs, input: &Path, result: &Path) -> Result<(Option<f64>, Vec<PathBuf>), CliError> {
    let asked = gprmax::read_directives(input)?;
    gprmax::check_scheme(args.order.unwrap_or(asked.order), asked.averaging)?;
    let solver = gprmax_solver(args.gprmax_python.as_deref(), args.precision, args.threads)?;
    snapshots::check_any(input, result, args.force)?;
    let bar = Bar::new("gprMax");
    let run = solver.run_file(input, result, &|progress| bar.update(progress))?;
    Ok((run.loop_seconds, run.snapshots))
}

/// Finds gprMax and sets it up for a run.
///
/// # Errors
/// When it is not installed.
pub fn gprmax_solver(
    python: Option<&Path>,
    precision: PrecisionName,
    threads: Option<NonZeroUsize>,
) -> Result<gprmax::GprMax, CliError> {
    let python = gprmax::install::find(python)?;
    Ok(gprmax::GprMax {
        python,
        threads: threads.map(NonZeroUsize::get),
        double_precision: precision == PrecisionName::Double,
    })
}

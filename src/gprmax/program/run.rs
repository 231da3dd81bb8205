//! From an input file to traces.

use std::collections::VecDeque;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use super::super::install::Interpreter;
use super::super::output::{read_traces, snapshot_folder};
use super::super::writer::{InputOptions, write_input};
use super::error::RunError;
use super::process::{Event, run};
use super::progress::{loop_seconds, progress};
use crate::files::{FileError, create_folder};
use crate::forward::{Forward, ForwardError, OnProgress, Progress};
use crate::model::{Averaging, Model, Order};
use crate::trace::Traces;

/// Lines of gprMax's own output that an error shows.
const SHOWN_LINES: usize = 40;

/// gprMax as a solver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GprMax {
    /// A Python that has gprMax.
    pub python: Interpreter,
    /// Threads; gprMax's own choice (one per physical core) where `None`. `#omp_threads` in a file goes before it.
    pub threads: Option<usize>,
    /// Whether to compute in double precision.
    pub double_precision: bool,
}

/// What a run of gprMax gave.
#[derive(Debug, Clone, PartialEq)]
pub struct GprMaxRun {
    /// The traces.
    pub traces: Traces,
    /// Wall time from the start of the process to its end, s. About 1.5 s of it is the start of Python.
    pub wall_seconds: f64,
    /// Time of the loop over time steps as gprMax prints it, s.
    pub loop_seconds: Option<f64>,
    /// The snapshots that the input file asks for, in the order of their names.
    pub snapshots: Vec<PathBuf>,
}

impl GprMax {
    /// Runs an input file and writes gprMax's output to `output`.
    ///
    /// The output is computed under another name beside its place and renamed at the end: a run that fails or is stopped
    /// leaves nothing but, when it fails, a log `<output>.log`. Where the file has an `#output_dir`, gprMax also leaves its
    /// output there.
    ///
    /// Threads: where `threads` is given, `OMP_NUM_THREADS` is set to it and `OMP_PROC_BIND` to `FALSE`. With an inherited `TRUE`
    /// (common on clusters) two runs of one thread side by side both sat on core 0 and did half the work each (gprMax 4.0.1).
    ///
    /// # Errors
    /// See [`RunError`]; what gprMax said is shown.
    pub fn run_file(&self, input: &Path, output: &Path, on_progress: OnProgress<'_>) -> Result<GprMaxRun, RunError> {
        let folder = output.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let scratch = tempfile::Builder::new()
            .prefix(".gprmax-")
            .suffix(".partial")
            .tempdir_in(folder)
            .map_err(FileError::of("write a folder in", folder))?;
        let place = fs::canonicalize(scratch.path()).map_err(FileError::of("read", scratch.path()))?;
        let (partial, partial_log) = (place.join("out.h5"), place.join("log"));
        let mut log = fs::File::create(&partial_log).map_err(FileError::of("write", &partial_log))?;
        let mut command = self.command(&fs::canonicalize(input).map_err(FileError::of("read", input))?, &partial);
        let (mut last_lines, mut loop_time) = (VecDeque::new(), None);
        let mut elsewhere = Elsewhere::default();
        let start = Instant::now();
        let mut log_failure = None;
        let status = run(&mut command, |event| {
            let Event::Line(line) = event else {
                return on_progress(last_progress(&last_lines)).is_continue();
            };
            loop_time = loop_seconds(line).or(loop_time);
            elsewhere.read(line);
            if let Err(error) = writeln!(log, "{line}") {
                log_failure = Some(error);
            }
            if last_lines.len() == SHOWN_LINES {
                last_lines.pop_front();
            }
            last_lines.push_back(line.to_owned());
            match progress(line) {
                Some(progress) => on_progress(progress).is_continue(),
                None => true,
            }
        })?;
        let wall_seconds = start.elapsed().as_secs_f64();
        if let Some(error) = log_failure {
            return Err(FileError { action: "write", path: partial_log, source: error }.into());
        }
        let keep_log = || -> Result<PathBuf, RunError> {
            let kept = log_path(output);
            fs::rename(&partial_log, &kept).map_err(FileError::of("write", &kept))?;
            Ok(kept)
        };
        if !status.success() {
            let last_lines = last_lines.into_iter().filter(|line| !line.trim().is_empty()).collect();
            let (input, status) = (input.into(), status.to_string());
            return Err(RunError::Failed { input, status, last_lines, log: keep_log()? });
        }
        if let Some(written) = elsewhere.path().filter(|path| !partial.is_file() && path.is_file()) {
            fs::copy(&written, &partial).map_err(FileError::of("read", &written))?;
        }
        if !partial.is_file() {
            return Err(RunError::NoOutput { input: input.into(), log: keep_log()? });
        }
        let traces = read_traces(&partial)?;
        fs::rename(&partial, output).map_err(FileError::of("write", output))?;
        let snapshots = move_files(&snapshot_folder(&partial), &snapshot_folder(output))?;
        Ok(GprMaxRun { traces, wall_seconds, loop_seconds: loop_time, snapshots })
    }

    /// Writes a model into a folder that is removed afterwards, and runs it.
    ///
    /// # Errors
    /// See [`RunError`].
    pub fn run_model(&self, model: &Model, on_progress: OnProgress<'_>) -> Result<GprMaxRun, RunError> {
        check_scheme(model.order, model.averaging)?;
        let place = std::env::temp_dir();
        let folder = tempfile::Builder::new()
            .prefix("ballast-gpr-")
            .tempdir()
            .map_err(FileError::of("write a folder in", &place))?;
        write_input(model, folder.path(), "model", &InputOptions::default())?;
        let result = self.run_file(&folder.path().join("model.in"), &folder.path().join("out.h5"), on_progress);
        if matches!(result, Err(RunError::Failed { .. } | RunError::NoOutput { .. })) {
            // The error names files in the folder: leave them for whoever reads it.
            let _ = folder.keep();
        }
        result
    }

    fn command(&self, input: &Path, output: &Path) -> Command {
        let mut command = self.python.command();
        // gprMax looks for geometry files in the current folder before it looks beside the input file: make them one.
        if let Some(folder) = input.parent().filter(|parent| parent.is_dir()) {
            command.current_dir(folder);
        }
        command.args(["-m", "gprMax"]).arg(input).arg("-o").arg(output).arg("--show-progress-bars");
        if self.double_precision {
            command.args(["-cpu_precision", "double"]);
        }
        if let Some(threads) = self.threads {
            command.env("OMP_NUM_THREADS", threads.max(1).to_string()).env("OMP_PROC_BIND", "FALSE");
            command.env_remove("OMP_PLACES").env_remove("GOMP_CPU_AFFINITY");
        }
        command
    }
}

/// Refuses what gprMax cannot do, though a model or file asks for it.
///
/// # Errors
/// For differences of fourth order, and for edges averaged over true shapes.
pub fn check_scheme(order: Order, averaging: Averaging) -> Result<(), RunError> {
    if order != Order::Second {
        return Err(RunError::Order { order });
    }
    if averaging != Averaging::Cells { Err(RunError::Averaging) } else { Ok(()) }
}

impl Forward for GprMax {
    fn name(&self) -> &'static str {
        "gprmax"
    }

    fn solve(&self, model: &Model, on_progress: OnProgress<'_>) -> Result<Traces, ForwardError> {
        match self.run_model(model, on_progress) {
            Ok(run) => Ok(run.traces),
            Err(RunError::Stopped) => Err(ForwardError::Stopped),
            Err(error @ (RunError::Write(_) | RunError::Order { .. } | RunError::Averaging)) => {
                Err(ForwardError::Model(Box::new(error)))
            }
            Err(error) => Err(ForwardError::Solver(Box::new(error))),
        }
    }
}

/// The newest progress among the last lines; nothing of one step before the bar appears.
fn last_progress(lines: &VecDeque<String>) -> Progress {
    lines.iter().rev().find_map(|line| progress(line)).unwrap_or(Progress { done: 0, total: 1 })
}

/// Where gprMax says it put its output: `#output_dir` in a file goes before the name given on its command line.
#[derive(Default)]
struct Elsewhere {
    folder: Option<PathBuf>,
    name: Option<PathBuf>,
}

impl Elsewhere {
    fn read(&mut self, line: &str) {
        let after = |words: &str| line.strip_prefix(words).map(|rest| PathBuf::from(rest.trim()));
        self.folder = after("Output directory:").or(self.folder.take());
        self.name = after("Written output file:").or(self.name.take());
    }

    fn path(&self) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(self.name.as_ref()?))
    }
}

/// Moves the files of one folder, if it is there, into another.
fn move_files(from: &Path, to: &Path) -> Result<Vec<PathBuf>, FileError> {
    if !from.is_dir() {
        return Ok(vec![]);
    }
    create_folder(to)?;
    let mut moved = vec![];
    for entry in fs::read_dir(from).map_err(FileError::of("read", from))? {
        let entry = entry.map_err(FileError::of("read", from))?;
        let place = to.join(entry.file_name());
        fs::rename(entry.path(), &place).map_err(FileError::of("write", &place))?;
        moved.push(place);
    }
    moved.sort();
    Ok(moved)
}

/// `trace.h5` → `trace.h5.log`.
fn log_path(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".log");
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsStr;

    #[test]
    fn bounded_threads_are_not_bound_to_cores() {
        let python = Interpreter { python: "python".into() };
        let gprmax = GprMax { python, threads: Some(2), double_precision: true };
        let command = gprmax.command(Path::new("a b.in"), Path::new("out.h5"));
        let arguments: Vec<_> = command.get_args().collect();
        assert_eq!(
            arguments,
            ["-m", "gprMax", "a b.in", "-o", "out.h5", "--show-progress-bars", "-cpu_precision", "double"]
        );
        let variable = |name: &str| command.get_envs().find(|(key, _)| *key == name).and_then(|(_, value)| value);
        assert_eq!(variable("OMP_NUM_THREADS"), Some(OsStr::new("2")));
        assert_eq!(variable("OMP_PROC_BIND"), Some(OsStr::new("FALSE")));
    }

    /// gprMax takes a geometry file of the same name from the current folder before the one beside the input.
    #[test]
    fn gprmax_runs_in_the_folder_of_its_input() {
        let folder = tempfile::tempdir().unwrap();
        let python = Interpreter { python: "envs/bin/python".into() };
        let gprmax = GprMax { python, threads: None, double_precision: false };
        let command = gprmax.command(&folder.path().join("a.in"), Path::new("out.h5"));
        assert_eq!(command.get_current_dir(), Some(folder.path()));
        assert!(Path::new(command.get_program()).is_absolute());
        assert!(command.get_envs().all(|(key, _)| key != "OMP_NUM_THREADS"));
    }

    #[test]
    fn the_place_of_the_output_is_read_off_the_log() {
        let mut elsewhere = Elsewhere::default();
        for line in ["Output directory: /runs/results", "|--->: 100%", "Written output file: s2.h5"] {
            elsewhere.read(line);
        }
        assert_eq!(elsewhere.path(), Some(PathBuf::from("/runs/results/s2.h5")));
    }
}

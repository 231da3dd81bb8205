//! Checkpoints of long runs: the flags, and what is said about them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::str::FromStr;
use std::sync::Mutex;
use std::time::Duration;

use clap::Args;

use crate::cli::error::{CliError, Kind};
use crate::cli::folder;
use crate::fdtd::{CheckpointEvent, Checkpoints, FdtdError};

/// Time between two checkpoints where the user names none.
const EVERY: Duration = Duration::from_secs(600);
/// How long a run must have been stepping before Ctrl-C makes it write one, where the user asked for none: what is lost in
/// a shorter run is not worth a large file.
const STOP_AFTER: Duration = Duration::from_secs(60);

/// When a run keeps its state, and whether it goes on from one.
#[derive(Debug, Clone, Default, Args)]
pub struct CheckpointArgs {
    /// Write all that a three-dimensional run has in hand to RESULT.checkpoint every so often, and on Ctrl-C; the same
    /// command goes on from it to the same result. `off`: never [default: 10min, so that only long runs do].
    #[arg(long, value_name = "TIME")]
    pub checkpoint: Option<Interval>,
    /// Go on from a checkpoint, and fail where there is none [default: go on from one that is there].
    #[arg(long, conflicts_with = "fresh")]
    pub resume: bool,
    /// Begin anew, whatever checkpoint is there.
    #[arg(long)]
    pub fresh: bool,
}

impl CheckpointArgs {
    /// Gives the same flags to another process.
    pub fn pass_on(&self, command: &mut Command) {
        if let Some(Interval(every)) = self.checkpoint {
            command.arg("--checkpoint").arg(every.map_or("off".into(), |every| format!("{}s", every.as_secs_f64())));
        }
        for (flag, on) in [("--resume", self.resume), ("--fresh", self.fresh)] {
            if on {
                command.arg(flag);
            }
        }
    }
}

/// A time between two checkpoints; none for `off`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval(Option<Duration>);

impl FromStr for Interval {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == "off" {
            return Ok(Self(None));
        }
        let number = text.trim_end_matches(char::is_alphabetic);
        let unit = match &text[number.len()..] {
            "s" => 1.0,
            "min" => 60.0,
            "h" => 3600.0,
            _ => return Err("write for example `90s`, `10min`, `2h` or `off`".into()),
        };
        let seconds = number.trim().parse::<f64>().ok().filter(|v| (0.0..1e9).contains(v));
        let seconds = seconds.ok_or("write for example `90s`, `10min`, `2h` or `off`")?;
        Ok(Self(Some(Duration::from_secs_f64(seconds * unit))))
    }
}

/// What the run said of its checkpoint.
#[derive(Default)]
struct Told {
    /// It went on from one, or wrote one.
    used: bool,
    /// Step and steps in all of the last that was written.
    written: Option<[usize; 2]>,
}

/// The checkpoint of a result.
pub fn path(result: &Path) -> PathBuf {
    folder::with_ending(result, "checkpoint")
}

/// Runs a solver with the checkpoint of a result; [`Used::remove`] it when the result is written.
///
/// # Errors
/// What the solver said; that there is no checkpoint to go on from.
pub fn with_checkpoint<R>(
    args: &CheckpointArgs,
    result: &Path,
    solve: impl FnOnce(Option<&Checkpoints<'_>>) -> Result<R, FdtdError>,
) -> Result<(R, Used), CliError> {
    let path = path(result);
    if args.resume && !path.exists() {
        return Err(CliError::input(format!(
            "there is no checkpoint `{}` to go on from\n\nhint: leave `--resume` out, and the run begins anew",
            path.display()
        )));
    }
    let every = args.checkpoint.map_or(Some(EVERY), |interval| interval.0);
    let told = Mutex::new(Told::default());
    let tell = |event: CheckpointEvent<'_>| {
        let Ok(mut told) = told.lock() else { return };
        match event {
            CheckpointEvent::Resumed { step, iterations } => {
                told.used = true;
                eprintln!("note: goes on after step {step} of {iterations}, from `{}`", path.display());
            }
            CheckpointEvent::Written { step, iterations, .. } => {
                told.used = true;
                told.written = Some([step, iterations]);
            }
            CheckpointEvent::Failed { error } => eprintln!("warning: no checkpoint: failed to {error}"),
        }
    };
    let stop_after = if args.checkpoint.is_some() { Duration::ZERO } else { STOP_AFTER };
    let settings =
        every.map(|every| Checkpoints { path: path.clone(), every, stop_after, go_on: !args.fresh, tell: &tell });
    let solved = solve(settings.as_ref());
    let told = told.into_inner().unwrap_or_default();
    match (solved, told.written) {
        (Ok(solved), _) => Ok((solved, Used(told.used.then_some(path)))),
        (Err(FdtdError::Stopped), Some([step, iterations])) => Err(CliError::new(
            Kind::Interrupted,
            format!(
                "stopped on request after step {step} of {iterations}; `{}` keeps them\n\nhint: the same command goes on from there",
                path.display()
            ),
        )),
        (Err(error), _) => Err(error.into()),
    }
}

/// A checkpoint that a run has used, if it has.
pub struct Used(Option<PathBuf>);

impl Used {
    /// Removes it: its result is written.
    pub fn remove(self) {
        if let Some(path) = self.0
            && let Err(error) = fs::remove_file(&path)
        {
            eprintln!("warning: failed to remove `{}`: {error}", path.display());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_have_units() {
        let seconds = |text: &str| text.parse::<Interval>().map(|interval| interval.0.map(|d| d.as_secs_f64()));
        assert_eq!(seconds("10min"), Ok(Some(600.0)));
        assert_eq!((seconds("0.5 h"), seconds("90s"), seconds("off")), (Ok(Some(1800.0)), Ok(Some(90.0)), Ok(None)));
        for wrong in ["10", "min", "-1s", "1d", "", "nan s"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}

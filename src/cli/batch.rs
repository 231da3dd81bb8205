//! Many runs side by side, one process per free core: a failed one is reported, the rest finishes.

use std::path::PathBuf;
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::cli::child;
use crate::cli::error::{CliError, Kind};
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::run::RunArgs;
use crate::cli::table::Report;
use crate::forward::Progress;

/// What became of one target.
struct Finished {
    target: PathBuf,
    outcome: Result<serde_json::Value, Failure>,
}

/// Why a target has no result.
enum Failure {
    /// It was stopped along with this program.
    Stopped,
    /// It failed, with this message.
    Failed(String),
}

impl Failure {
    fn message(&self) -> &str {
        match self {
            Self::Stopped => "stopped on request",
            Self::Failed(message) => message,
        }
    }
}

/// What a run printed as its error, without the word.
fn message_of(stderr: &[u8]) -> String {
    let text = String::from_utf8_lossy(stderr);
    text.split_once("error: ").map_or(&*text, |(_, message)| message).trim().to_string()
}

/// Runs every target in a process of its own.
///
/// # Errors
/// When one of them failed, after all have finished.
pub fn run_many(args: &RunArgs) -> Result<(), CliError> {
    let program = std::env::current_exe()
        .map_err(|error| CliError::new(Kind::Fault, format!("cannot find this program: {error}")))?;
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let threads = args.threads.map_or(1, |n| n.get());
    let jobs = args.jobs.map_or((cores / threads).max(1), |n| n.get()).min(args.targets.len());
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let finished: Mutex<Vec<(usize, Finished)>> = Mutex::new(Vec::new());
    let bar = Bar::new(format!("{} runs", args.targets.len()));
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(target) = args.targets.get(index) else { break };
                    if interrupt::requested() {
                        break;
                    }
                    let mut command = Command::new(&program);
                    command.arg("run").arg(target).args(["--json", "--solver", args.solver.name()]);
                    if let Some(order) = args.order {
                        command.args(["--order", &order.to_string()]);
                    }
                    command.args(["--precision", args.precision.name(), "--threads", &threads.to_string()]);
                    if args.force {
                        command.arg("--force");
                    }
                    args.keep.pass_on(&mut command);
                    if let Some(python) = &args.gprmax_python {
                        command.arg("--gprmax-python").arg(python);
                    }
                    let outcome = match child::output(&mut command) {
                        Ok(output) if output.status.success() => serde_json::from_slice(&output.stdout)
                            .map_err(|error| Failure::Failed(format!("unreadable outcome: {error}"))),
                        Ok(_) if interrupt::requested() => Err(Failure::Stopped),
                        Ok(output) => Err(Failure::Failed(message_of(&output.stderr))),
                        Err(error) => Err(Failure::Failed(format!("cannot start: {error}"))),
                    };
                    if let Ok(mut finished) = finished.lock() {
                        finished.push((index, Finished { target: target.clone(), outcome }));
                    }
                    let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                    let _ = bar.update(Progress { done, total: args.targets.len() });
                }
            });
        }
    });
    drop(bar);
    let mut finished = finished.into_inner().unwrap_or_default();
    finished.sort_by_key(|(index, _)| *index);
    report(args, &finished)
}

fn report(args: &RunArgs, finished: &[(usize, Finished)]) -> Result<(), CliError> {
    let failed = finished.iter().filter(|(_, run)| matches!(run.outcome, Err(Failure::Failed(_)))).count();
    if args.json {
        let rows: Vec<_> = finished
            .iter()
            .map(|(_, run)| match &run.outcome {
                Ok(outcome) => outcome.clone(),
                Err(error) => serde_json::json!({ "target": run.target, "error": error.message() }),
            })
            .collect();
        println!("{}", serde_json::to_string_pretty(&rows)?);
    } else {
        let stopped = finished.iter().filter(|(_, run)| matches!(run.outcome, Err(Failure::Stopped))).count();
        let mut title = format!("{} runs, {failed} failed", finished.len());
        if stopped > 0 {
            title.push_str(&format!(", {stopped} stopped"));
        }
        let mut table = Report::new(title, ["target", "outcome", "seconds"]);
        for (_, run) in finished {
            let (what, seconds) = match &run.outcome {
                Ok(value) => {
                    let kept = value["kept"].as_bool() == Some(true);
                    let seconds = value["record"]["wall_seconds"].as_f64().unwrap_or(0.0);
                    (if kept { "was there already" } else { "written" }.to_string(), format!("{seconds:.2}"))
                }
                Err(error) => (error.message().lines().next().unwrap_or("failed").to_string(), "–".into()),
            };
            table.row([run.target.display().to_string(), what, seconds]);
        }
        table.print();
    }
    for (_, run) in finished {
        if let Err(Failure::Failed(message)) = &run.outcome {
            eprintln!("{}: {message}\n", run.target.display());
        }
    }
    if interrupt::requested() {
        return Err(CliError::new(Kind::Interrupted, "stopped on request; start the same command again to go on"));
    }
    if failed > 0 {
        return Err(CliError::new(
            Kind::Verdict,
            format!("{failed} of {} runs failed; the others are complete", finished.len()),
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::cli::run::Outcome;

    #[test]
    fn an_outcome_has_the_keys_that_are_read_here() {
        let outcome = Outcome {
            target: "a".into(),
            result: "a/fdtd.h5".into(),
            files: vec![],
            kept: true,
            record: crate::cli::folder::RunRecord {
                format_version: 1,
                program: "p".into(),
                solver: "fdtd".into(),
                precision: "single".into(),
                threads: None,
                model: "0".into(),
                wall_seconds: 1.5,
                loop_seconds: None,
            },
        };
        let value = serde_json::to_value(&outcome).unwrap();
        assert_eq!(value["kept"].as_bool(), Some(true));
        assert_eq!(value["record"]["wall_seconds"].as_f64(), Some(1.5));
    }
}

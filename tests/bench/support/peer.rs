//! Runs of gprMax and of this program from the shell, and the medians of their times.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use ballast_gpr::gprmax::Interpreter;

/// What a bench returns.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// A setting from the environment.
pub fn setting(name: &str, default: &str) -> String {
    std::env::var(name).unwrap_or_else(|_| default.into())
}

/// Wall time of a process and what it printed.
fn timed(command: &mut Command) -> Outcome<(f64, String)> {
    let start = Instant::now();
    let output = command.output()?;
    let seconds = start.elapsed().as_secs_f64();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    if output.status.success() {
        Ok((seconds, text))
    } else {
        Err(format!("{command:?}: {}\n{text}", output.status).into())
    }
}

/// Whole process and time loop of `ballast-gpr run`, s.
pub fn ours(input: &Path, output: &Path, threads: usize, more: &[&str]) -> Outcome<[f64; 2]> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ballast-gpr"));
    command.arg("run").arg(input).args(["--force", "--json", "--threads", &threads.to_string(), "--out"]).arg(output);
    let (seconds, text) = timed(command.args(more))?;
    let start = text.find('{').ok_or("no JSON")?;
    let mut values = serde_json::Deserializer::from_str(&text[start..]).into_iter::<serde_json::Value>();
    let value = values.next().ok_or("no JSON")??;
    Ok([seconds, value["record"]["loop_seconds"].as_f64().unwrap_or(f64::NAN)])
}

/// Whole process and time loops (as it prints them, all traces together) of gprMax, s. Its OpenMP policy is its own; only the
/// number of threads is set.
pub fn theirs(python: &Interpreter, input: &Path, output: &Path, threads: usize, more: &[&str]) -> Outcome<[f64; 2]> {
    let mut command = python.command();
    command.args(["-m", "gprMax"]).arg(input).arg("-o").arg(output).env("OMP_NUM_THREADS", threads.to_string());
    let (seconds, text) = timed(command.args(more))?;
    let taken = text.lines().filter_map(|line| line.trim().strip_prefix("Time taken:")).map(|taken| {
        // `12.3 seconds`, `1 minute and 2.5 seconds`
        let numbers = taken.split_whitespace().filter_map(|word| word.parse().ok());
        numbers.fold(0.0, |sum: f64, number: f64| 60.0 * sum + number)
    });
    let loops: Vec<f64> = taken.collect();
    if loops.is_empty() { Err("gprMax printed no `Time taken`".into()) } else { Ok([seconds, loops.iter().sum()]) }
}

/// Middle value.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

/// Smallest value.
pub fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// What else the machine was doing: processes that ran or waited, over 1, 5 and 15 minutes.
pub fn load() -> String {
    fs::read_to_string("/proc/loadavg")
        .map_or("unknown".into(), |text| text.split(' ').take(3).collect::<Vec<_>>().join(" "))
}

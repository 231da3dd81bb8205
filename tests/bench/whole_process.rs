//! One A-scan from the shell: `ballast-gpr run` against `python -m gprMax`, wall time of the whole process.
//!
//! The clean tank at 2 mm over 25 ns, single precision, the same `.in` file for both, the same number of threads, run in turns.
//! gprMax keeps its own OpenMP policy; only the number of threads is set. `cargo bench --bench whole_process` prints the table.
//!
//! Environment: `BENCH_ROUNDS` (5), `BENCH_THREADS` ("1 2"), `BENCH_WINDOW` ("25ns"), `BENCH_CELL` ("2mm"), and
//! `BALLAST_GPR_GPRMAX_PYTHON` for a gprMax other than the private one. Where there is no gprMax the bench fails.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use ballast_gpr::compare::relative_l2;
use ballast_gpr::gprmax::{InputOptions, Interpreter, install, read_traces, write_input};
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{SceneSpec, resolve};

type Outcome<T> = Result<T, Box<dyn Error>>;

fn setting(name: &str, default: &str) -> String {
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

/// Whole process and time loop of the built-in solver, s.
fn ours(input: &Path, output: &Path, threads: usize) -> Outcome<[f64; 2]> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ballast-gpr"));
    command.arg("run").arg(input).args(["--force", "--json", "--threads", &threads.to_string(), "--out"]).arg(output);
    let (seconds, text) = timed(&mut command)?;
    let start = text.find('{').ok_or("no JSON")?;
    let mut values = serde_json::Deserializer::from_str(&text[start..]).into_iter::<serde_json::Value>();
    let value = values.next().ok_or("no JSON")??;
    Ok([seconds, value["record"]["loop_seconds"].as_f64().ok_or("no `loop_seconds`")?])
}

/// Whole process and time loop (as it prints it) of gprMax, s.
fn theirs(python: &Interpreter, input: &Path, output: &Path, threads: usize) -> Outcome<[f64; 2]> {
    let mut command = python.command();
    command.args(["-m", "gprMax"]).arg(input).arg("-o").arg(output).env("OMP_NUM_THREADS", threads.to_string());
    let (seconds, text) = timed(&mut command)?;
    let taken = text.lines().find_map(|line| line.trim().strip_prefix("Time taken:")).ok_or("no `Time taken`")?;
    // `12.3 seconds`, `1 minute and 2.5 seconds`
    let numbers: Vec<f64> = taken.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    Ok([seconds, numbers.iter().fold(0.0, |sum, number| 60.0 * sum + number)])
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn load() -> String {
    fs::read_to_string("/proc/loadavg")
        .map_or("unknown".into(), |text| text.split(' ').take(3).collect::<Vec<_>>().join(" "))
}

fn main() -> Outcome<()> {
    let rounds: usize = setting("BENCH_ROUNDS", "5").parse()?;
    let threads: Vec<usize> =
        setting("BENCH_THREADS", "1 2").split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let python = install::find(None)?;
    let mut spec = SceneSpec::preset("tank")?;
    (spec.grid.time_window, spec.grid.cell) =
        (setting("BENCH_WINDOW", "25ns").parse()?, setting("BENCH_CELL", "2mm").parse()?);
    let model = build_model(&resolve(&spec)?)?;
    let folder = tempfile::tempdir()?;
    write_input(&model, folder.path(), "model", &InputOptions::default())?;
    let place = |name: &str| -> PathBuf { folder.path().join(name) };
    let [nx, ny, _] = model.grid.cells;
    println!("clean tank, {nx} x {ny} cells, {} steps, single precision; {rounds} rounds in turns", model.iterations());
    println!(
        "{:<9}{:>9}{:>24}{:>24}{:>8}{:>26}  load",
        "threads", "", "ballast-gpr, s", "gprMax, s", "ratio", "loops: ours, gprMax, s"
    );
    for threads in threads {
        let before = load();
        let (mut our_times, mut their_times) = (vec![], vec![]);
        for round in 0..rounds {
            // Each goes first as often as the other, so that a machine that slows down or warms up favours neither.
            for turn in 0..2 {
                if (round + turn) % 2 == 0 {
                    our_times.push(ours(&place("model.in"), &place("ours.h5"), threads)?);
                } else {
                    their_times.push(theirs(&python, &place("model.in"), &place("theirs.h5"), threads)?);
                }
            }
        }
        let (a, b) = (read_traces(&place("theirs.h5"))?, read_traces(&place("ours.h5"))?);
        let difference = relative_l2(a.radar_trace().ok_or("no trace")?, b.radar_trace().ok_or("no trace")?)?;
        // Two runs in single precision: the same work was done.
        if difference.is_nan() || difference > 2e-5 {
            return Err(format!("the traces differ by {difference:e}").into());
        }
        let column = |times: &[[f64; 2]], which: usize| times.iter().map(|time| time[which]).collect::<Vec<_>>();
        for (name, of) in [("median", median as fn(&[f64]) -> f64), ("least", least)] {
            let [we, they] = [of(&column(&our_times, 0)), of(&column(&their_times, 0))];
            let loops = format!("{:.2}, {:.2}", of(&column(&our_times, 1)), of(&column(&their_times, 1)));
            println!(
                "{threads:<9}{name:>9}{we:>24.2}{they:>24.2}{:>8.1}{loops:>26}  {before} -> {}",
                they / we,
                load()
            );
        }
        println!("         the traces differ by {difference:.1e}");
    }
    Ok(())
}

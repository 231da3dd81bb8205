//! `compare`: two traces, or many against one.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::cli::comparison_figure;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::manifest::{self, Window};
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::{
    self, CompareOptions, Comparison, EchoPick, ExpectedEchoes, Normalisation, Polarity, TimeError, TimeZero,
};
use crate::files;
use crate::plot::Figure as _;
use crate::trace::AScan;
use crate::units::Seconds;

/// Compare traces: peak times first, then correlation, differences, envelopes and spectra.
#[derive(Debug, Clone, Args)]
pub struct CompareArgs {
    /// Two traces: folders of `build` and `run`, gprMax's `.h5` or `.out`, two-column text. One folder with the results of
    /// both solvers compares those. With --to, any number, each against that one.
    #[arg(required = true, value_name = "TRACE")]
    pub traces: Vec<PathBuf>,
    /// The trace that all others are compared with.
    #[arg(long, value_name = "TRACE")]
    pub to: Option<PathBuf>,
    /// Trace of the antenna in free space, taken off all others, so that the direct wave is gone.
    #[arg(long, value_name = "TRACE")]
    pub free_space: Option<PathBuf>,
    /// What is put at time zero in both traces.
    #[arg(long, value_enum, default_value = "keep")]
    pub time_zero: TimeZeroFlag,
    /// What both traces are divided by.
    #[arg(long, value_enum, default_value = "maximum")]
    pub normalise: NormaliseFlag,
    /// What happens to the sign of the second trace; `auto` suits a measured one, whose cable may turn it.
    #[arg(long, value_enum, default_value = "keep")]
    pub polarity: PolarityFlag,
    /// Part of the time axis to keep, as FROM..TO (2ns..15ns).
    #[arg(long, value_name = "FROM..TO", value_parser = read_window)]
    pub window: Option<(Seconds, Seconds)>,
    /// Write figure and numbers as STEM.png, STEM.svg and STEM.json [default: comparison; in the folder when there is one].
    #[arg(long, value_name = "STEM")]
    pub out: Option<PathBuf>,
    /// Draw no figure and write no files.
    #[arg(long)]
    pub no_figure: bool,
    /// Overwrite figures that are there.
    #[arg(long)]
    pub force: bool,
    /// Print the numbers as JSON.
    #[arg(long)]
    pub json: bool,
}

/// See [`TimeZero`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TimeZeroFlag {
    /// Leave both as they are.
    Keep,
    /// The direct wave.
    DirectWave,
    /// The first strong peak.
    FirstPeak,
}

/// See [`Normalisation`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum NormaliseFlag {
    /// Nothing.
    None,
    /// The largest amplitude.
    Maximum,
    /// The direct wave.
    DirectWave,
    /// The plate echo.
    PlateEcho,
}

/// See [`Polarity`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PolarityFlag {
    /// Leave it.
    Keep,
    /// Turn it when the traces correlate negatively.
    Auto,
    /// Turn it.
    Flip,
}

fn read_window(text: &str) -> Result<(Seconds, Seconds), String> {
    let (from, to) = text.split_once("..").ok_or("write it as FROM..TO, for example 2ns..15ns")?;
    let read = |text: &str| text.parse::<Seconds>().map_err(|error| error.to_string());
    let (from, to) = (read(from)?, read(to)?);
    if to.si() <= from.si() {
        return Err(format!("{to} does not come after {from}"));
    }
    Ok((from, to))
}

/// Runs the subcommand.
///
/// # Errors
/// When a trace cannot be read or compared, or a file not written.
pub fn run(args: &CompareArgs) -> Result<(), CliError> {
    let pairs = pairs(args)?;
    let mut results = Vec::new();
    for (first, second) in &pairs {
        let comparison = compare_files(args, first, second)?;
        results.push(comparison);
    }
    if !args.no_figure {
        for (index, comparison) in results.iter().enumerate() {
            write_figure(args, comparison, (pairs.len() > 1).then_some(index + 1))?;
        }
    }
    if args.json {
        let values: Vec<_> = results.iter().map(summary).collect();
        let value = if values.len() == 1 { values[0].clone() } else { values.into() };
        println!("{}", serde_json::to_string_pretty(&value)?);
    } else {
        for comparison in &results {
            table(comparison).print();
        }
    }
    Ok(())
}

fn pairs(args: &CompareArgs) -> Result<Vec<(PathBuf, PathBuf)>, CliError> {
    if let Some(reference) = &args.to {
        return Ok(args.traces.iter().map(|trace| (reference.clone(), trace.clone())).collect());
    }
    match args.traces.as_slice() {
        [first, second] => Ok(vec![(first.clone(), second.clone())]),
        [one] => trace_file::both_results(one).map(|[fdtd, gprmax]| vec![(gprmax, fdtd)]).ok_or_else(|| {
            CliError::input(format!(
                "one trace has nothing to be compared with: `{}` does not hold the results of both solvers\n\n\
                 hint: name two traces, or first run both `ballast-gpr run {0}` and `ballast-gpr run {0} --solver gprmax`",
                one.display()
            ))
        }),
        many => Err(CliError::input(format!(
            "{} traces, but none to compare them with\n\nhint: name it with `--to TRACE`",
            many.len()
        ))),
    }
}

fn compare_files(args: &CompareArgs, first: &Path, second: &Path) -> Result<Comparison, CliError> {
    let (a, b) = (trace_file::read(first)?, trace_file::read(second)?);
    let reference: Option<AScan> = args.free_space.as_deref().map(trace_file::read).transpose()?;
    let options = CompareOptions {
        reference_a: reference.clone(),
        reference_b: reference,
        time_zero: match args.time_zero {
            TimeZeroFlag::Keep => TimeZero::Keep,
            TimeZeroFlag::DirectWave => TimeZero::DirectWave,
            TimeZeroFlag::FirstPeak => TimeZero::FirstPeak,
        },
        normalisation: match args.normalise {
            NormaliseFlag::None => Normalisation::None,
            NormaliseFlag::Maximum => Normalisation::Maximum,
            NormaliseFlag::DirectWave => Normalisation::DirectWave,
            NormaliseFlag::PlateEcho => Normalisation::PlateEcho,
        },
        polarity: match args.polarity {
            PolarityFlag::Keep => Polarity::Keep,
            PolarityFlag::Auto => Polarity::Auto,
            PolarityFlag::Flip => Polarity::Flip,
        },
        window: args.window,
        expected: if args.time_zero == TimeZeroFlag::Keep {
            expected(&[first, second])?
        } else {
            ExpectedEchoes::default()
        },
        ..CompareOptions::default()
    };
    Ok(compare::compare(&a, &b, &options)?)
}

/// Windows that hold the echoes of every folder among the targets; none where no target is one.
fn expected(targets: &[&Path]) -> Result<ExpectedEchoes, CliError> {
    let mut found = ExpectedEchoes::default();
    let join = |window: &mut Option<(Seconds, Seconds)>, [from, to]: Window| {
        let (low, high) = window.map_or((from, to), |(low, high)| (low.si().min(from), high.si().max(to)));
        *window = Some((whole_picoseconds(low), whole_picoseconds(high)));
    };
    for target in targets {
        if let Some(folder) = trace_file::built_folder(target) {
            let windows = manifest::expected_windows(&folder)?;
            found.no_noise = true;
            join(&mut found.surface, windows.surface);
            if let Some(plate) = windows.plate {
                join(&mut found.plate, plate);
            }
        }
    }
    Ok(found)
}

/// Rounds a time to what a message should show of it.
fn whole_picoseconds(time: f64) -> Seconds {
    Seconds((1e12 * time).round() / 1e12)
}

fn write_figure(args: &CompareArgs, comparison: &Comparison, number: Option<usize>) -> Result<(), CliError> {
    let default = match args.traces.as_slice() {
        [one] if one.is_dir() && args.to.is_none() => one.join("comparison"),
        _ => PathBuf::from("comparison"),
    };
    let mut stem = args.out.clone().unwrap_or(default);
    if let Some(number) = number {
        let name = format!("{}-{number}", stem.file_name().map_or("comparison".into(), |name| name.to_string_lossy()));
        stem.set_file_name(name);
    }
    for extension in ["png", "svg", "json"] {
        folder::may_write(&folder::with_ending(&stem, extension), args.force)?;
    }
    let parent = stem.parent().unwrap_or(Path::new(""));
    files::create_folder(parent)?;
    let name = stem.file_name().map_or("comparison".into(), |name| name.to_string_lossy().into_owned());
    let title = format!("{} and {}", comparison.a.name, comparison.b.name);
    comparison_figure::figure(&title, comparison).write(parent, &name)?;
    let mut text = serde_json::to_string_pretty(comparison)?;
    text.push('\n');
    files::write_bytes(&folder::with_ending(&stem, "json"), text.as_bytes())?;
    eprintln!("written: {0}.png, {0}.svg, {0}.json", stem.display());
    Ok(())
}

fn summary(comparison: &Comparison) -> serde_json::Value {
    serde_json::json!({
        "a": comparison.a.name,
        "b": comparison.b.name,
        "metrics": comparison.metrics,
        "picks_a": comparison.picks_a,
        "picks_b": comparison.picks_b,
        "steps_a": comparison.steps_a,
        "steps_b": comparison.steps_b,
    })
}

/// A number with its sign, and none on what rounds to zero.
fn signed(value: f64, digits: usize) -> String {
    let text = format!("{value:+.digits$}");
    let zero = text.chars().all(|c| "+-0.".contains(c));
    if zero { text.replace(['+', '-'], "") } else { text }
}

/// The numbers of a comparison as a table.
pub fn table(comparison: &Comparison) -> Report {
    let Comparison { metrics, picks_a, picks_b, a, b, .. } = comparison;
    let mut table = Report::new(format!("A: {}\nB: {}", a.name, b.name), ["", "A", "B", "B − A"]);
    let time = |pick: &EchoPick, envelope: bool| match pick {
        EchoPick::Picked(echo) => {
            let pick = if envelope { echo.envelope } else { echo.waveform };
            format!("{:.3}", 1e9 * pick.time.si())
        }
        EchoPick::NotPicked(_) => "–".into(),
    };
    let error = |error: &TimeError, envelope: bool| {
        let value = if envelope { error.envelope } else { error.waveform };
        value.map_or("–".into(), |value| signed(1e9 * value.si(), 3))
    };
    for (name, pick_a, pick_b, found) in [
        ("surface echo", &picks_a.surface, &picks_b.surface, &metrics.surface_time_error),
        ("plate echo", &picks_a.plate, &picks_b.plate, &metrics.plate_time_error),
    ] {
        for (how, envelope) in [("waveform", false), ("envelope", true)] {
            table.row([
                format!("{name}, {how}, ns"),
                time(pick_a, envelope),
                time(pick_b, envelope),
                error(found, envelope),
            ]);
        }
    }
    let mut single = |name: &str, value: String| table.row([name.into(), String::new(), String::new(), value]);
    single("largest cross-correlation", format!("{:.4}", metrics.cross_correlation.maximum));
    single("its lag, ns", signed(1e9 * metrics.cross_correlation.lag.si(), 3));
    single("correlation without lag", format!("{:.4}", metrics.zero_lag_correlation));
    single("RMSE after normalisation", format!("{:.3e}", metrics.rmse));
    single("relative L2 difference", format!("{:.3e}", metrics.relative_l2));
    single("correlation of envelopes", format!("{:.4}", metrics.envelope_correlation));
    single("correlation of spectra", format!("{:.4}", metrics.spectral_correlation));
    single("shift of the spectral peak, MHz", signed(1e-6 * metrics.peak_frequency_shift.si(), 1));
    for (letter, picks) in [("A", picks_a), ("B", picks_b)] {
        for (name, pick) in [("surface echo", &picks.surface), ("plate echo", &picks.plate)] {
            if let EchoPick::NotPicked(reason) = pick {
                single(&format!("no {name} in {letter}"), reason.to_string());
            }
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(signed(-1e-9, 3), "0.000");
        assert_eq!(signed(-0.0014, 3), "-0.001");
        assert_eq!(signed(12.34, 1), "+12.3");
    }
}

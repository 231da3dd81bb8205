//! `compare`: two traces, or many against one.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use serde_json::json;

use crate::cli::comparison_figure;
use crate::cli::ensemble_figure;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::manifest::{self, Window};
use crate::cli::process_figure;
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::process::mean_trace;
use crate::compare::{
    self, CompareOptions, Comparison, EchoPick, ExpectedEchoes, Normalisation, PlateEcho, Polarity, TimeError, TimeZero,
};
use crate::files;
use crate::plot::{Figure as _, Panels};
use crate::trace::{AScan, Component};
use crate::units::{Metres, Seconds};

/// Compare traces: peak times first, then correlation, differences, envelopes and spectra.
#[derive(Debug, Clone, Args)]
#[command(after_help = AFTER_HELP)]
pub struct CompareArgs {
    /// Two traces: folders of `build` and `run`, gprMax's `.h5` or `.out`, files of instruments, two-column text. One folder
    /// with the results of both solvers compares those. With --to, any number, each against that one, and all of them as an
    /// ensemble; a folder of folders stands for all of these.
    #[arg(required = true, value_name = "TRACE")]
    pub traces: Vec<PathBuf>,
    /// The trace that all others are compared with: the measured one, when the others are simulations.
    #[arg(long, value_name = "TRACE")]
    pub to: Option<PathBuf>,
    /// Trace of the antenna in free space, taken off all others, so that the direct wave is gone.
    #[arg(long, value_name = "TRACE")]
    pub free_space: Option<PathBuf>,
    /// Measurement of a metal plate with the antenna of the measured trace: its echo normalises that trace. The simulated one
    /// is fitted to it, or has a --plate-simulated of its own.
    #[arg(long, value_name = "TRACE")]
    pub plate: Option<PathBuf>,
    /// Simulation of a plate with the antenna of the simulated trace: its echo normalises that trace.
    #[arg(long, value_name = "TRACE", requires = "plate")]
    pub plate_simulated: Option<PathBuf>,
    /// Height of the antenna over the plate: its echo comes to 2 HEIGHT/c, and the traces move with it.
    #[arg(long, value_name = "HEIGHT", requires = "plate", conflicts_with = "time_zero")]
    pub plate_height: Option<Metres>,
    /// Where the plate echo is in its measurement, as FROM..TO [default: the strongest echo after the direct wave].
    #[arg(long, value_name = "FROM..TO", value_parser = read_window, requires = "plate")]
    pub plate_window: Option<(Seconds, Seconds)>,
    /// Compare radargrams, too: the mean traces by all metrics, and all traces side by side by their structural similarity
    /// (SSIM).
    #[arg(long, conflicts_with = "to")]
    pub radargram: bool,
    /// What is put at time zero in both traces.
    #[arg(long, value_enum, default_value = "keep")]
    pub time_zero: TimeZeroFlag,
    /// What both traces are divided by [default: maximum; the measured plate with --plate].
    #[arg(long, value_enum, conflicts_with = "plate")]
    pub normalise: Option<NormaliseFlag>,
    /// What happens to the sign of the second trace [default: auto between a recorded and a simulated trace, whose cable may
    /// turn it; else keep].
    #[arg(long, value_enum)]
    pub polarity: Option<PolarityFlag>,
    /// Part of the time axis to keep, as FROM..TO (2ns..15ns).
    #[arg(long, value_name = "FROM..TO", value_parser = read_window)]
    pub window: Option<(Seconds, Seconds)>,
    /// Write figure and numbers as STEM.png, STEM.svg and STEM.json [default: comparison; in the folder when there is one].
    #[arg(long, value_name = "STEM")]
    pub out: Option<PathBuf>,
    /// Print and draw each pair of an ensemble, too.
    #[arg(long)]
    pub each: bool,
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

const AFTER_HELP: &str = "\
For example:
  ballast-gpr compare tank-seed-1 measured.csv --plate plate.csv --time-zero first-peak
  ballast-gpr compare seeds/ --to measured.csv --window 2ns..15ns    mean and band of all folders in seeds/, and the share
                                                                     of the measured samples inside";

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

/// Reads a part of a time axis, FROM..TO.
///
/// # Errors
/// With what to write.
pub fn read_window(text: &str) -> Result<(Seconds, Seconds), String> {
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
    if args.radargram {
        return radargrams(args);
    }
    let pairs = pairs(args)?;
    let many = pairs.len() > 1;
    let prepared = Shared::read(args)?;
    let reference = args.to.as_deref().map(trace_file::read).transpose()?;
    let read = |(a, b): &(PathBuf, PathBuf)| -> Result<(AScan, AScan), CliError> {
        let a = reference.clone().map_or_else(|| trace_file::read(a), Ok)?;
        Ok((a, trace_file::read(b)?))
    };
    let traces = pairs.iter().map(read).collect::<Result<Vec<_>, CliError>>()?;
    let finest = traces.iter().flat_map(|(a, b)| [a.time_step.si(), b.time_step.si()]).fold(f64::INFINITY, f64::min);
    let mut results = Vec::new();
    for ((first, second), (a, b)) in pairs.iter().zip(&traces) {
        let mut options = prepared.options(args, [a, b], &[first.as_path(), second.as_path()])?;
        // All members of an ensemble lie on one axis.
        options.time_step = many.then_some(Seconds(finest));
        results.push(compare::compare(a, b, &options)?);
    }
    let mut flaws: Vec<String> = results.iter().flat_map(|found| &found.flaws).map(ToString::to_string).collect();
    flaws.dedup();
    for flaw in flaws {
        eprintln!("warning: {flaw}");
    }
    let band = if many { Some(compare::ensemble(&results)?) } else { None };
    if !args.no_figure {
        if let Some(band) = &band {
            let figure = ensemble_figure::figure(band, &results)?;
            write_files(args, None, &figure, &json!({ "ensemble": band }))?;
        }
        for (index, comparison) in results.iter().enumerate().filter(|_| !many || args.each) {
            let title = format!("{} and {}", comparison.a.name, comparison.b.name);
            let figure = comparison_figure::figure(&title, comparison, measured_is_second(args, comparison));
            write_files(args, many.then_some(index + 1), &figure, &serde_json::to_value(comparison)?)?;
        }
    }
    if args.json {
        let values: Vec<_> = results.iter().map(summary).collect();
        let value = match &band {
            Some(band) => json!({ "ensemble": ensemble_figure::summary(band), "members": values }),
            None => values[0].clone(),
        };
        println!("{}", serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    for comparison in results.iter().filter(|_| !many || args.each) {
        table(comparison).print();
    }
    if let Some(band) = &band {
        ensemble_figure::table(band).print();
    }
    Ok(())
}

/// Compares two radargrams: their mean traces by all metrics, all their traces by structural similarity.
fn radargrams(args: &CompareArgs) -> Result<(), CliError> {
    let [first, second] = args.traces.as_slice() else {
        return Err(CliError::input(
            "`--radargram` compares two radargrams\n\nhint: name two files with several traces each",
        ));
    };
    let sections = [trace_file::read_scan(first)?, trace_file::read_scan(second)?];
    let means = [mean_trace(&sections[0]), mean_trace(&sections[1])];
    let shared = Shared::read(args)?;
    let options = shared.options(args, [&means[0], &means[1]], &[first.as_path(), second.as_path()])?;
    let comparison = compare::compare(&means[0], &means[1], &options)?;
    let prepared = [
        compare::prepare_as(&sections[0], &comparison.steps_a, &comparison.a, options.reference_a.as_ref())?,
        compare::prepare_as(&sections[1], &comparison.steps_b, &comparison.b, options.reference_b.as_ref())?,
    ];
    let similarity = compare::structural_similarity(&prepared[0], &prepared[1])?;
    for flaw in &comparison.flaws {
        eprintln!("warning: {flaw}");
    }
    let mut told = summary(&comparison);
    told["structural_similarity"] = similarity.into();
    if !args.no_figure {
        let title = format!("{} and {}", comparison.a.name, comparison.b.name);
        let mut figure = comparison_figure::figure(&title, &comparison, measured_is_second(args, &comparison));
        figure.charts.extend(prepared.iter().map(|section| process_figure::radargram(&section.name, section)));
        figure.size[1] += 600.0;
        write_files(args, None, &figure, &told)?;
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&told)?);
    } else {
        let mut table = table(&comparison);
        table.row(["structural similarity".into(), String::new(), String::new(), format!("{similarity:.4}")]);
        table.print();
    }
    Ok(())
}

fn pairs(args: &CompareArgs) -> Result<Vec<(PathBuf, PathBuf)>, CliError> {
    if let Some(reference) = &args.to {
        let members: Vec<PathBuf> = args.traces.iter().flat_map(|trace| members(trace)).collect();
        return Ok(members.into_iter().map(|trace| (reference.clone(), trace)).collect());
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

/// The folders with results in a folder that has none itself, by name; else the target itself.
fn members(target: &Path) -> Vec<PathBuf> {
    let alone = || vec![target.to_path_buf()];
    if !target.is_dir() || trace_file::result_of(target).is_ok() {
        return alone();
    }
    let entries = std::fs::read_dir(target).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.is_dir() && trace_file::result_of(path).is_ok()).collect();
    found.sort();
    if found.is_empty() { alone() } else { found }
}

/// What all comparisons of one command share.
struct Shared {
    free_space: Option<AScan>,
    measured: Option<PlateEcho>,
    simulated: Option<PlateEcho>,
}

impl Shared {
    fn read(args: &CompareArgs) -> Result<Self, CliError> {
        let free_space = args.free_space.as_deref().map(trace_file::read).transpose()?;
        let plate = |path: &Option<PathBuf>| -> Result<Option<PlateEcho>, CliError> {
            let Some(path) = path else { return Ok(None) };
            let trace = trace_file::read(path)?;
            Ok(Some(compare::plate_echo(&trace, free_space.as_ref(), args.plate_window)?))
        };
        let (measured, simulated) = (plate(&args.plate)?, plate(&args.plate_simulated)?);
        if args.plate.is_some() && args.plate_simulated.is_none() {
            eprintln!(
                "the simulated trace is fitted to the measured one: its own amplitude counts with `--plate-simulated TRACE`"
            );
        }
        Ok(Self { free_space, measured, simulated })
    }

    fn options(&self, args: &CompareArgs, traces: [&AScan; 2], targets: &[&Path]) -> Result<CompareOptions, CliError> {
        let recorded = traces.map(|trace| trace.component == Component::Recorded);
        let second = second_is_measured(args, recorded);
        let plates = [self.simulated.clone(), self.measured.clone()];
        let [plate_a, plate_b] = if second {
            plates
        } else {
            let [simulated, measured] = plates;
            [measured, simulated]
        };
        let kept = args.time_zero == TimeZeroFlag::Keep && args.plate_height.is_none();
        Ok(CompareOptions {
            reference_a: self.free_space.clone(),
            reference_b: self.free_space.clone(),
            plate_a,
            plate_b,
            time_zero: match (args.time_zero, args.plate_height) {
                (_, Some(height)) => TimeZero::PlateMeasured { height },
                (TimeZeroFlag::Keep, None) => TimeZero::Keep,
                (TimeZeroFlag::DirectWave, None) => TimeZero::DirectWave,
                (TimeZeroFlag::FirstPeak, None) => TimeZero::FirstPeak,
            },
            normalisation: match args.normalise {
                _ if args.plate.is_some() => Normalisation::PlateMeasured,
                Some(NormaliseFlag::None) => Normalisation::None,
                Some(NormaliseFlag::Maximum) | None => Normalisation::Maximum,
                Some(NormaliseFlag::DirectWave) => Normalisation::DirectWave,
                Some(NormaliseFlag::PlateEcho) => Normalisation::PlateEcho,
            },
            polarity: match args.polarity {
                Some(PolarityFlag::Keep) => Polarity::Keep,
                Some(PolarityFlag::Auto) => Polarity::Auto,
                Some(PolarityFlag::Flip) => Polarity::Flip,
                None if recorded[0] != recorded[1] => Polarity::Auto,
                None => Polarity::Keep,
            },
            window: args.window,
            expected: if kept { expected(targets)? } else { ExpectedEchoes::default() },
            ..CompareOptions::default()
        })
    }
}

/// Which trace is the measured one: the one that was recorded, where the other was not; else that of --to, or the second.
fn second_is_measured(args: &CompareArgs, recorded: [bool; 2]) -> bool {
    match recorded {
        [true, false] => false,
        [false, true] => true,
        _ => args.to.is_none(),
    }
}

/// Whether the second trace was recorded and the first simulated, so that it is drawn solid.
fn measured_is_second(args: &CompareArgs, comparison: &Comparison) -> bool {
    let recorded = [&comparison.a, &comparison.b].map(|trace| trace.component == Component::Recorded);
    recorded[0] != recorded[1] && second_is_measured(args, recorded)
}

/// Windows that hold the echoes of every folder among the targets; none where no target is one.
///
/// # Errors
/// When a folder's manifest cannot be read.
pub fn expected(targets: &[&Path]) -> Result<ExpectedEchoes, CliError> {
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

fn write_files(
    args: &CompareArgs,
    number: Option<usize>,
    figure: &Panels,
    numbers: &serde_json::Value,
) -> Result<(), CliError> {
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
    figure.write(parent, &name)?;
    let mut text = serde_json::to_string_pretty(numbers)?;
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
        "flaws": comparison.flaws,
    })
}

/// A number with its sign, and none on what rounds to zero.
pub fn signed(value: f64, digits: usize) -> String {
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
    let warped = metrics.time_warp.map_or("–".into(), |warp| format!("{:.3e}", warp.distance));
    single("difference after time warping by up to 0.5 ns", warped);
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

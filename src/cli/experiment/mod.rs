//! `experiment`: tests of the mechanics of ballast, each from a file that holds every assumed number.

mod figures;
mod files_of;
mod kinds;
mod sight;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum as _};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::table::Report;
use crate::files;
use crate::study::MeanAndSpread;
use crate::study::experiments::{JOURNAL, Outcome};

pub use kinds::{ExperimentName, Specified};
pub use sight::{in_sight, side_by_side};

/// Test the mechanics of ballast: rolling ball, angle of repose, lateral resistance, oedometer, pluviation.
///
/// Each experiment is a TOML file that holds every number, those without a source marked as assumed. The output folder
/// gets the curve (CSV, JSON, PNG, SVG), the stones and a manifest. Ctrl-C stops with the state kept; the same command goes on
/// from there to the same bits.
#[derive(Debug, Clone, Args)]
pub struct ExperimentArgs {
    /// Which experiment.
    #[arg(value_enum)]
    pub name: ExperimentName,
    /// Its file [default: the template].
    #[arg(value_name = "EXPERIMENT.toml")]
    pub spec: Option<PathBuf>,
    /// Print the file to begin with, and end.
    #[arg(long)]
    pub print_template: bool,
    /// Output folder [default: the name of the experiment].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Seed of sizes and places, in place of the file's.
    #[arg(long, value_name = "NUM")]
    pub seed: Option<u64>,
    /// Run NUM times, seeds counted from the first, and tell mean and spread; side by side, one on each thread, each in a
    /// folder of its own, and those that are there already are kept.
    #[arg(long, value_name = "NUM", default_value = "1")]
    pub seeds: NonZeroUsize,
    /// Threads; the result is the same on any number [default: one for each core].
    #[arg(long, value_name = "NUM")]
    pub threads: Option<NonZeroUsize>,
    /// Write into a folder that is not empty, over files of the same names.
    #[arg(long)]
    pub force: bool,
    /// Begin anew, whatever state of a stopped run is there.
    #[arg(long)]
    pub fresh: bool,
    /// Print the readings as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When the file cannot be read, the experiment not run or its files not written.
pub fn run(args: &ExperimentArgs) -> Result<(), CliError> {
    if args.print_template {
        print!("{}", args.name.template());
        return Ok(());
    }
    let (text, origin) = match &args.spec {
        Some(path) => (files::read_text(path)?, path.clone()),
        None => (args.name.template().to_owned(), PathBuf::from("template")),
    };
    let spec = Specified::read(args.name, &text, &origin)?;
    let spec = args.seed.map(|seed| spec.with_seed(seed)).transpose()?.unwrap_or(spec);
    let name = args.name.to_possible_value().map_or(String::new(), |value| value.get_name().to_string());
    let out = args.out.clone().unwrap_or_else(|| name.into());
    if args.seeds.get() == 1 {
        let outcome = run_one(args, &spec, &text, &out, |keep_in| in_sight(&spec, args.threads, keep_in, args.fresh))?;
        return show(args, &outcome, &out);
    }
    let first = spec.seed().ok_or_else(no_seed)?;
    let specs = (first..first + args.seeds.get() as u64)
        .map(|seed| spec.with_seed(seed).map(|spec| (out.join(format!("seed-{seed}")), spec)))
        .collect::<Result<Vec<_>, _>>()?;
    let outcomes = side_by_side(specs.len(), args.threads, |index, place| {
        let (folder, spec) = &specs[index];
        match files_of::finished(folder, spec).filter(|_| !args.force) {
            Some(outcome) => Ok(outcome),
            None => run_one(args, spec, &text, folder, |keep_in| place.run(spec, keep_in, args.fresh)),
        }
    })?;
    show_ensemble(args, &outcomes, &out)
}

/// What is said of an experiment without anything random.
pub fn no_seed() -> CliError {
    CliError::input("this experiment has nothing random in it\n\nhint: leave `--seed` and `--seeds` out")
}

fn run_one(
    args: &ExperimentArgs,
    spec: &Specified,
    text: &str,
    out: &Path,
    run: impl FnOnce(Option<&Path>) -> Result<Outcome, CliError>,
) -> Result<Outcome, CliError> {
    let goes_on = out.join(JOURNAL).exists() && !out.join(folder::MANIFEST).exists();
    folder::check_free(out, args.force || goes_on)?;
    if goes_on && !args.fresh {
        eprintln!("note: goes on from the state in `{}`", out.display());
    }
    let started = Instant::now();
    let outcome = run(Some(out))?;
    folder::prepare(out, true)?;
    files_of::write(out, spec, text, &outcome, started.elapsed().as_secs_f64())?;
    Ok(outcome)
}

fn show(args: &ExperimentArgs, outcome: &Outcome, out: &Path) -> Result<(), CliError> {
    if args.json {
        let readings: serde_json::Map<_, _> =
            outcome.readings.iter().map(|reading| (reading.key.clone(), reading.value.into())).collect();
        let told = serde_json::json!({
            "experiment": outcome.experiment, "folder": out, "readings": readings, "notes": outcome.notes,
        });
        println!("{}", serde_json::to_string_pretty(&told)?);
        return Ok(());
    }
    let mut table = Report::new(format!("{}, in `{}`", outcome.experiment, out.display()), ["reading", "value"]);
    for reading in &outcome.readings {
        table.row([reading.quantity.clone(), format!("{:.*}", reading.decimals, reading.value)]);
    }
    table.print();
    for note in &outcome.notes {
        println!("note: {note}");
    }
    Ok(())
}

fn show_ensemble(args: &ExperimentArgs, outcomes: &[Outcome], out: &Path) -> Result<(), CliError> {
    let Some(first) = outcomes.first() else { return Ok(()) };
    let spreads: Vec<_> = first
        .readings
        .iter()
        .filter_map(|reading| {
            let values: Vec<f64> = outcomes.iter().filter_map(|outcome| outcome.reading(&reading.key)).collect();
            Some((reading, MeanAndSpread::of(&values)?, values))
        })
        .collect();
    let json: serde_json::Map<_, _> = spreads
        .iter()
        .map(|(reading, spread, values)| {
            let told = serde_json::json!({
                "mean": spread.mean, "standard_deviation": spread.standard_deviation, "values": values,
            });
            (reading.key.clone(), told)
        })
        .collect();
    let told = serde_json::json!({ "experiment": first.experiment, "seeds": outcomes.len(), "readings": json });
    let text = serde_json::to_string_pretty(&told)? + "\n";
    files::write_bytes(&out.join("ensemble.json"), text.as_bytes())?;
    if args.json {
        print!("{text}");
        return Ok(());
    }
    let title = format!("{}, {} seeds, in `{}`", first.experiment, outcomes.len(), out.display());
    let mut table = Report::new(title, ["reading", "mean", "standard deviation", "of how many"]);
    for (reading, spread, values) in &spreads {
        table.row([
            reading.quantity.clone(),
            format!("{:.*}", reading.decimals.max(1), spread.mean),
            format!("{:.*}", reading.decimals.max(1), spread.standard_deviation),
            values.len().to_string(),
        ]);
    }
    table.print();
    for note in &first.notes {
        println!("note: {note}");
    }
    Ok(())
}

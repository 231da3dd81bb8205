//! `process`: steps of the field over a trace or a radargram.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::process_figure;
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::process::{self, Chain, Processed, STEPS};
use crate::compare::{Step, subtract_reference};
use crate::files;
use crate::plot::Figure as _;
use crate::trace::BScan;
use crate::units::Seconds;

/// Process traces: time zero, dewow, band-pass, background, stacking, gain, envelope.
///
/// The steps are done in the order in which they are written, and are recorded in what comes out.
#[derive(Debug, Clone, Args)]
#[command(after_help = after_help())]
pub struct ProcessArgs {
    /// What to process: a folder of `build` and `run`, or a file with traces.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// Where the result goes: `.csv` (commas) or `.txt` (spaces), the time in ns and one column per trace. Without it nothing
    /// is written but what --figure asks for.
    #[arg(value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Steps, separated by commas, done in this order; see below.
    #[arg(long, value_name = "STEPS")]
    pub steps: Chain,
    /// Trace of the antenna in free space, taken off each trace before all steps, so that the direct wave is gone.
    #[arg(long, value_name = "TRACE")]
    pub free_space: Option<PathBuf>,
    /// Draw before and after, spectra and short-time spectrum as STEM.png and STEM.svg.
    #[arg(long, value_name = "STEM")]
    pub figure: Option<PathBuf>,
    /// Window of the short-time spectrum in the figure [default: four periods of the spectral peak].
    #[arg(long, value_name = "TIME")]
    pub short_time: Option<Seconds>,
    /// Overwrite files that are there.
    #[arg(long)]
    pub force: bool,
    /// Print what was done as JSON.
    #[arg(long)]
    pub json: bool,
}

fn after_help() -> String {
    let mut text = String::from("Steps:\n");
    for (form, what) in STEPS {
        let _ = writeln!(text, "  {form}\n      {what}");
    }
    text.push_str(
        "\nFor example, a horn of 1 GHz over ballast:\n  ballast-gpr process line.csv clean.csv --figure line \\\n      \
         --steps 'dewow=3ns, timezero=direct, bandpass=300MHz..1.5GHz, background=100, sec=0.2:1'\n\
         and a hundred traces at one place made one:\n  ballast-gpr process static.csv trace.csv --steps 'dc, stack'",
    );
    text
}

/// Runs the subcommand.
///
/// # Errors
/// When the input cannot be read, a step cannot be done, or a file not be written.
pub fn run(args: &ProcessArgs) -> Result<(), CliError> {
    let separator = args.output.as_deref().map(separator_of).transpose()?;
    let pictures = args.figure.iter().flat_map(|stem| ["png", "svg"].map(|ending| folder::with_ending(stem, ending)));
    for path in pictures.chain(args.output.clone()) {
        folder::may_write(&path, args.force)?;
    }
    let section = trace_file::read_scan(&args.input)?;
    let (before, taken) = without_direct_wave(args, section)?;
    let mut done = process::process(&before, &args.steps)?;
    done.steps.splice(0..0, taken);
    for flaw in &done.flaws {
        eprintln!("warning: {flaw}");
    }
    if let Some((path, separator)) = args.output.as_ref().zip(separator) {
        files::write_bytes(path, as_text(&done, separator).as_bytes())?;
        eprintln!("written: {}", path.display());
    }
    if let Some(stem) = &args.figure {
        let parent = stem.parent().unwrap_or(Path::new(""));
        files::create_folder(parent)?;
        let name = stem.file_name().map_or("process".into(), |name| name.to_string_lossy().into_owned());
        process_figure::figure(&before, &done.section, args.short_time)?.write(parent, &name)?;
        eprintln!("written: {0}.png, {0}.svg", stem.display());
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&summary(args, &before, &done))?);
    } else {
        table(&before, &done).print();
    }
    Ok(())
}

/// Takes the free-space trace off each trace, if one is given.
fn without_direct_wave(args: &ProcessArgs, section: BScan) -> Result<(BScan, Option<Step>), CliError> {
    let Some(path) = &args.free_space else { return Ok((section, None)) };
    let reference = trace_file::read(path)?;
    let (new, step) = subtract_reference(&section, &reference);
    Ok((new, Some(step)))
}

/// What goes between two numbers in a file of this ending.
fn separator_of(path: &Path) -> Result<char, CliError> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Ok(','),
        Some("txt" | "dat" | "asc") => Ok(' '),
        _ => Err(CliError::input(format!(
            "`{}` has no ending that says how to write it\n\nhint: end it in `.csv` or `.txt`",
            path.display()
        ))),
    }
}

/// The traces as text: the steps as comments, a header, the time in ns and one column per trace.
fn as_text(done: &Processed, separator: char) -> String {
    let section = &done.section;
    let mut text = format!("# {}\n", section.name);
    for step in &done.steps {
        let _ = writeln!(text, "# {step}");
    }
    text.push_str("time_ns");
    for number in 0..section.count() {
        let _ = write!(text, "{separator}trace_{number}");
    }
    text.push('\n');
    for sample in 0..section.samples_per_trace() {
        let time = section.first_sample.si() + sample as f64 * section.time_step.si();
        let _ = write!(text, "{:.9}", 1e9 * time);
        for trace in section.traces() {
            let _ = write!(text, "{separator}{}", trace[sample]);
        }
        text.push('\n');
    }
    text
}

fn summary(args: &ProcessArgs, before: &BScan, done: &Processed) -> serde_json::Value {
    let said: Vec<String> = done.steps.iter().map(ToString::to_string).collect();
    let axis = |section: &BScan| {
        serde_json::json!({
            "traces": section.count(),
            "samples": section.samples_per_trace(),
            "first_sample_s": section.first_sample.si(),
            "time_step_s": section.time_step.si(),
        })
    };
    serde_json::json!({
        "input": args.input,
        "output": args.output,
        "before": axis(before),
        "after": axis(&done.section),
        "steps": done.steps,
        "said": said,
        "flaws": done.flaws,
    })
}

fn table(before: &BScan, done: &Processed) -> Report {
    let size = |section: &BScan| {
        let traces = if section.count() == 1 { "1 trace".into() } else { format!("{} traces", section.count()) };
        format!("{traces} of {} samples, {:.4} ns apart", section.samples_per_trace(), 1e9 * section.time_step.si())
    };
    let mut table = Report::new(before.name.clone(), ["", "what was done"]);
    table.row(["before".into(), size(before)]);
    for (number, step) in done.steps.iter().enumerate() {
        table.row([format!("{}", number + 1), step.to_string()]);
    }
    table.row(["after".into(), size(&done.section)]);
    table
}

//! `convert`: traces into files that other programs read.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::trace_file;
use crate::compare;
use crate::measured::{self, About, Written};
use crate::trace::{BScan, Component};
use crate::units::Seconds;

/// Convert traces, simulated or measured, into a file for other programs; the ending of OUT chooses the format.
///
/// Formats: `.rd3` and `.rad` (MALÅ), `.dt1` and `.hd` (Sensors & Software), `.sgy` or `.segy` (SEG-Y, the time step in
/// picoseconds), `.csv`, `.npz` (NumPy). RD3 and DT1 hold counts of 16 bits: whole numbers that fit are kept, others are scaled
/// so that the largest is 32000 counts; the amplitude of one count is printed and stands in the header.
///
/// IN is whatever `inspect` reads. ImpulseRadar (.iprb) and IDS (.dt) are read on trial: no real file was at hand.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  ballast-gpr convert tank-fouling-20cm-seed-1 tank.rd3   a simulated trace for MALÅ's software
  ballast-gpr convert scan_merged.h5 scan.sgy --step 5ps  a simulated B-scan as SEG-Y
  ballast-gpr convert line.dzt#1: channel-1.csv           channel 1 of a measured line as text")]
pub struct ConvertArgs {
    /// File or folder with traces; `FILE#12` is trace 12, `FILE#1:` channel 1, counted from 0.
    #[arg(value_name = "IN")]
    pub from: PathBuf,
    /// File to write; of a pair, either name will do.
    #[arg(value_name = "OUT")]
    pub to: PathBuf,
    /// Component of a simulated field (Ex, Ey, Ez, Hx, Hy, Hz) [default: Ez, or else the strongest electric field].
    #[arg(long, value_name = "NAME", value_parser = read_component)]
    pub component: Option<Component>,
    /// Resample to this time step (5ps), band-limited; a text with uneven times by a cubic spline.
    #[arg(long, value_name = "TIME", value_parser = read_step)]
    pub step: Option<Seconds>,
    /// Overwrite files that are there.
    #[arg(long)]
    pub force: bool,
    /// Print what was written as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Most samples that resampling may make of a trace.
const MOST_SAMPLES: f64 = 1e7;

fn read_component(text: &str) -> Result<Component, String> {
    let found = Component::FIELDS.into_iter().find(|component| component.name().eq_ignore_ascii_case(text));
    found.ok_or_else(|| "it is one of Ex, Ey, Ez, Hx, Hy, Hz".into())
}

fn read_step(text: &str) -> Result<Seconds, String> {
    let step: Seconds = text.parse().map_err(|error: crate::units::UnitError| error.to_string())?;
    if step.si() > 0.0 { Ok(step) } else { Err("a time step must be above 0".into()) }
}

/// A format to write, by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Rd3,
    Dt1,
    SegY,
    Csv,
    Npz,
}

impl Target {
    /// The format, the file with the samples, and its header where there is one.
    fn of(path: &Path) -> Result<(Self, PathBuf, Option<PathBuf>), CliError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
        let capital = ending.chars().any(|c| c.is_ascii_uppercase());
        let with = |other: &str| path.with_extension(if capital { other.to_ascii_uppercase() } else { other.into() });
        Ok(match ending.to_ascii_lowercase().as_str() {
            "rd3" | "rad" => (Self::Rd3, with("rd3"), Some(with("rad"))),
            "dt1" | "hd" => (Self::Dt1, with("dt1"), Some(with("hd"))),
            "sgy" | "segy" => (Self::SegY, path.into(), None),
            "csv" => (Self::Csv, path.into(), None),
            "npz" => (Self::Npz, path.into(), None),
            _ => {
                return Err(CliError::input(format!(
                    "`{}` has an ending that is not written\n\nhint: choose .rd3, .dt1, .sgy, .csv or .npz",
                    path.display()
                )));
            }
        })
    }
}

/// Runs the subcommand.
///
/// # Errors
/// When the traces cannot be read, the format cannot hold them, or a file cannot be written.
pub fn run(args: &ConvertArgs) -> Result<(), CliError> {
    let (target, samples, header) = Target::of(&args.to)?;
    for path in [Some(&samples), header.as_ref()].into_iter().flatten() {
        if path.exists() && !args.force {
            return Err(CliError::input(format!(
                "`{}` exists already\n\nhint: choose another name, or overwrite it with `--force`",
                path.display()
            )));
        }
    }
    let mut scan = trace_file::read_component(&args.from, args.component, args.step)?;
    if let Some(step) = args.step {
        scan = resampled(&scan, step)?;
    }
    let recording = trace_file::read_recording(&args.from)?;
    let about = recording.map_or_else(About::default, |recording| About {
        antenna: recording.antenna,
        centre_frequency: recording.centre_frequency,
        antenna_separation: recording.antenna_separation,
    });
    if let Some(parent) = samples.parent() {
        crate::files::create_folder(parent)?;
    }
    let written = match target {
        Target::Rd3 => measured::write_rd3(&samples, &scan, &about),
        Target::Dt1 => measured::write_dt1(&samples, &scan, &about),
        Target::SegY => measured::write_segy(&samples, &scan, &about),
        Target::Csv => measured::write_csv(&samples, &scan),
        Target::Npz => measured::write_npz(&samples, &scan),
    };
    let written = written.map_err(|error| with_hint(error, &args.from, &args.to, &scan))?;
    report(args, &scan, &written)
}

/// What would do, in words to type, for a time step that SEG-Y cannot hold.
fn with_hint(error: measured::MeasuredError, from: &Path, to: &Path, scan: &BScan) -> CliError {
    let measured::MeasuredError::CannotHold { what: "a time step", .. } = error else { return error.into() };
    let step = (1e12 * scan.time_step.si()).floor().clamp(1.0, 32767.0);
    CliError::input(format!(
        "{error}\n\nhint: resample with `ballast-gpr convert {} {} --step {step}ps`",
        folder::typed(from),
        folder::typed(to)
    ))
}

/// Every trace on an axis of another step, over the same time.
fn resampled(scan: &BScan, step: Seconds) -> Result<BScan, CliError> {
    let length = (scan.samples_per_trace() - 1) as f64 * scan.time_step.si();
    let count = (length / step.si() + 1e-9).floor() + 1.0;
    if count > MOST_SAMPLES {
        return Err(CliError::input(format!(
            "a step of {step} makes {count:.0} samples of each trace: {MOST_SAMPLES:.0} are the most"
        )));
    }
    let traces: Vec<_> = (0..scan.count())
        .filter_map(|index| scan.trace(index))
        .map(|trace| compare::resample(&trace, scan.first_sample, step, count as usize))
        .collect();
    Ok(BScan::of(&traces, scan.name.clone())?)
}

fn report(args: &ConvertArgs, scan: &BScan, written: &Written) -> Result<(), CliError> {
    let files: Vec<_> = written.files.iter().map(|file| file.display().to_string()).collect();
    if args.json {
        let value = serde_json::json!({
            "files": files,
            "traces": scan.count(),
            "samples_per_trace": scan.samples_per_trace(),
            "time_step_s": scan.time_step.si(),
            "amplitude_of_one_count": written.amplitude_of_count,
        });
        println!("{}", serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    let traces = if scan.count() == 1 { "1 trace".into() } else { format!("{} traces", scan.count()) };
    println!("{} written: {traces} of {} samples", files.join(", "), scan.samples_per_trace());
    if written.amplitude_of_count != 1.0 {
        println!("one count is an amplitude of {:e}", written.amplitude_of_count);
    }
    Ok(())
}

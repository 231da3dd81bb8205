//! `inspect`: what is in a file of traces.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::process_figure;
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::measured::{Recording, SampleKind};
use crate::plot::{Axis, Chart, Figure as _, Panels, Series};
use crate::trace::BScan;

/// Show what is in files of traces: format, channels, traces, samples, time axis, antenna, and what a header contradicts.
///
/// Reads GSSI (.dzt), Sensors & Software (.dt1, .hd), MALÅ (.rd3, .rd7, .rad) and SEG-Y (.sgy, .segy), gprMax's HDF5, folders
/// of `run`, and columns of text. Experimental, since no real file was at hand to check the reader: ImpulseRadar (.iprb,
/// .iprh) and IDS (.dt).
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Example:
  ballast-gpr inspect plate.dzt --figure plate
  ballast-gpr inspect *.DZT --json")]
pub struct InspectArgs {
    /// Files of instruments, gprMax's `.h5` or `.out`, text, or folders with a result. Of a pair, either file will do.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// List every field of the header too.
    #[arg(long)]
    pub header: bool,
    /// Draw the radargram of each channel as STEM.png and STEM.svg; for one FILE.
    #[arg(long, value_name = "STEM")]
    pub figure: Option<PathBuf>,
    /// Overwrite figures that are there.
    #[arg(long)]
    pub force: bool,
    /// Print all of it as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a file cannot be read, or a figure not written.
pub fn run(args: &InspectArgs) -> Result<(), CliError> {
    if let Some(stem) = &args.figure {
        if args.files.len() > 1 {
            return Err(CliError::input("`--figure` draws one file\n\nhint: name one, or leave `--figure` out"));
        }
        for ending in ["png", "svg"] {
            folder::may_write(&folder::with_ending(stem, ending), args.force)?;
        }
    }
    let contents = args.files.iter().map(|file| Content::of(file)).collect::<Result<Vec<_>, _>>()?;
    if let (Some(stem), [content]) = (&args.figure, contents.as_slice()) {
        content.draw(stem)?;
    }
    if args.json {
        let values: Vec<_> = contents.iter().map(Content::json).collect();
        let value = if values.len() == 1 { values[0].clone() } else { values.into() };
        println!("{}", serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    for content in &contents {
        content.table(args.header).print();
        for warning in content.recording.iter().flat_map(|recording| &recording.warnings) {
            println!("warning: {warning}");
        }
    }
    Ok(())
}

/// What a file holds.
struct Content {
    path: PathBuf,
    format: &'static str,
    recording: Option<Recording>,
    /// The radargram, of a file that no instrument made.
    scan: Option<BScan>,
}

impl Content {
    fn of(path: &Path) -> Result<Self, CliError> {
        if let Some(recording) = trace_file::read_recording(path)? {
            let format = recording.format.name();
            return Ok(Self { path: path.into(), format, recording: Some(recording), scan: None });
        }
        let scan = trace_file::read_scan(path)?;
        let file = trace_file::Named::of(path).path;
        let text = file.is_file() && !trace_file::is_hdf5(&file)?;
        let format = if text { "columns of text" } else { "gprMax HDF5" };
        Ok(Self { path: path.into(), format, recording: None, scan: Some(scan) })
    }

    fn channels(&self) -> &[BScan] {
        match (&self.recording, &self.scan) {
            (Some(recording), _) => &recording.channels,
            (None, scan) => scan.as_slice(),
        }
    }

    fn kind(&self) -> Option<SampleKind> {
        self.recording.as_ref().map(|recording| recording.sample_kind)
    }

    /// One radargram for each channel; of a single trace its curve.
    fn draw(&self, stem: &Path) -> Result<(), CliError> {
        let chart = |scan: &BScan| match scan.trace(0) {
            Some(trace) if scan.count() == 1 => {
                let points = trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect();
                Chart::new(&scan.name, Axis::linear("time", "ns"), Axis::linear("amplitude", ""))
                    .with(Series::line(&scan.name, points))
            }
            _ => process_figure::radargram(&scan.name, scan),
        };
        let charts: Vec<_> = self.channels().iter().map(chart).collect();
        let name = stem.file_name().map_or("traces".into(), |name| name.to_string_lossy().into_owned());
        let title = self.path.display().to_string();
        Panels::stacked(&title, charts).write(stem.parent().unwrap_or(Path::new("")), &name)?;
        eprintln!("written: {0}.png, {0}.svg", stem.display());
        Ok(())
    }

    fn table(&self, header: bool) -> Report {
        let mut table = Report::new(self.path.display().to_string(), ["field", "value"]);
        let mut row = |name: &str, value: String| table.row([name.into(), value]);
        row("format", self.format.into());
        if let Some(kind) = self.kind() {
            row("samples are of", kind.name().into());
        }
        let channels = self.channels();
        row("channels", channels.len().to_string());
        for (index, channel) in channels.iter().enumerate() {
            let of = |what: &str| if channels.len() > 1 { format!("{what}, channel {index}") } else { what.to_owned() };
            let about = About::of(channel, self.kind());
            row(&of("traces"), format!("{} (0 to {})", channel.count(), channel.count() - 1));
            row(&of("samples per trace"), channel.samples_per_trace().to_string());
            row(&of("time step"), nanoseconds(channel.time_step.si()));
            let last = channel.first_sample.si() + (channel.samples_per_trace() - 1) as f64 * channel.time_step.si();
            row(&of("times"), format!("{} to {}", nanoseconds(channel.first_sample.si()), nanoseconds(last)));
            row(
                &of("amplitudes"),
                format!("{} to {}, mean {}", rounded(about.least), rounded(about.greatest), rounded(about.mean)),
            );
            if about.clipped > 0 {
                row(&of("samples at the limit"), about.clipped.to_string());
            }
            if let Some([first, last]) = along(channel) {
                row(&of("positions"), format!("{} m to {} m", rounded(first), rounded(last)));
            }
            if channel.component.is_magnetic() || self.kind().is_none() {
                row(&of("component"), channel.component.name().into());
            }
        }
        if let Some(recording) = &self.recording {
            if let Some(antenna) = &recording.antenna {
                row("antenna", antenna.clone());
            }
            if let Some(frequency) = recording.centre_frequency {
                row("centre frequency", frequency.to_string());
            }
            if let Some(separation) = recording.antenna_separation {
                row("antenna separation", separation.to_string());
            }
            for (name, value) in recording.header.iter().filter(|_| header) {
                row(name, value.clone());
            }
        }
        table
    }

    fn json(&self) -> serde_json::Value {
        let kind = self.kind();
        let channel = |scan: &BScan| {
            let about = About::of(scan, kind);
            serde_json::json!({
                "traces": scan.count(),
                "samples_per_trace": scan.samples_per_trace(),
                "time_step_s": scan.time_step.si(),
                "first_sample_s": scan.first_sample.si(),
                "window_s": scan.time_step.si() * scan.samples_per_trace() as f64,
                "component": scan.component.name(),
                "least": about.least,
                "greatest": about.greatest,
                "mean": about.mean,
                "samples_at_the_limit": about.clipped,
                "positions_m": along(scan),
            })
        };
        let recording = self.recording.as_ref();
        let warnings = recording.map_or(&[][..], |recording| &recording.warnings);
        serde_json::json!({
            "file": self.path.display().to_string(),
            "format": self.format,
            "experimental": recording.is_some_and(|recording| recording.format.is_experimental()),
            "samples_are_of": kind.map(SampleKind::name),
            "channels": self.channels().iter().map(channel).collect::<Vec<_>>(),
            "antenna": recording.and_then(|recording| recording.antenna.clone()),
            "centre_frequency_hz": recording.and_then(|recording| recording.centre_frequency).map(|f| f.si()),
            "antenna_separation_m": recording.and_then(|recording| recording.antenna_separation).map(|s| s.si()),
            "warnings": warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "header": recording.map(|recording| {
                let field = |(name, value): &(String, String)| (name.clone(), value.clone().into());
                recording.header.iter().map(field).collect::<serde_json::Map<_, _>>()
            }),
        })
    }
}

/// The range of a radargram's amplitudes.
struct About {
    least: f64,
    greatest: f64,
    mean: f64,
    /// Samples at either end of what the file can hold.
    clipped: usize,
}

impl About {
    fn of(scan: &BScan, kind: Option<SampleKind>) -> Self {
        let samples = scan.samples();
        let limits = kind.and_then(|kind| match kind {
            SampleKind::Unsigned8 => Some((-128.0, 127.0)),
            SampleKind::Unsigned16 | SampleKind::Signed16 => Some((-32768.0, 32767.0)),
            SampleKind::Signed32 => Some((f64::from(i32::MIN), f64::from(i32::MAX))),
            SampleKind::Float32 | SampleKind::Ibm32 => None,
        });
        let at_limit = |value: &&f64| limits.is_some_and(|(low, high)| **value <= low || **value >= high);
        Self {
            least: samples.iter().copied().fold(f64::INFINITY, f64::min),
            greatest: samples.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            mean: samples.iter().sum::<f64>() / samples.len() as f64,
            clipped: samples.iter().filter(at_limit).count(),
        }
    }
}

/// Abscissae of the first and the last trace.
fn along(scan: &BScan) -> Option<[f64; 2]> {
    let places = scan.positions()?;
    Some([places.first()?[0].si(), places.last()?[0].si()])
}

fn nanoseconds(seconds: f64) -> String {
    format!("{} ns", rounded(1e9 * seconds))
}

/// A number with six significant digits, without zeros at its end.
fn rounded(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = (5 - value.abs().log10().floor() as i32).clamp(0, 30) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 48.0, -0.048828125, 1234567.0, 1e-9].map(rounded),
            ["0", "48", "-0.0488281", "1234567", "0.000000001"]
        );
    }
}

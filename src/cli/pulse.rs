//! `pulse`: the pulse of an antenna from a measurement.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::pulse::DeconvolutionOptions;
use crate::compare::{PickedOn, spectrum};
use crate::fdtd::Fdtd;
use crate::files;
use crate::gprmax;
use crate::model::{Between, Beyond, Sampled};
use crate::plot::{Axis, Chart, Figure as _, Marker, Panels, Series, Stroke};
use crate::scene::Dimension;
use crate::study::{PlateSetup, PulseOfPlate, pulse_of_plate};
use crate::trace::AScan;
use crate::units::{Hertz, Metres, Seconds, Share};

/// Find the pulse that an antenna sends, for models in place of an analytic one.
#[derive(Debug, Clone, Args)]
pub struct PulseArgs {
    #[command(subcommand)]
    command: PulseCommand,
}

#[derive(Debug, Clone, Subcommand)]
enum PulseCommand {
    FromPlate(FromPlateArgs),
}

/// From the echo of a metal plate to the pulse whose simulated echo it is.
///
/// The mean of the traces, free space taken off, is cut to the echo; the pulse is what the source of a model has to send for the
/// same echo, by a regularised deconvolution with the simulated echo of a known pulse at the same height. The file is a gprMax
/// `#excitation_file`; `build --pulse` uses it.
#[derive(Debug, Clone, Args)]
#[command(
    after_help = "Example:\n  ballast-gpr pulse from-plate plate.dzt --free-space sky.dzt --height 43cm --out pulse.txt\n  ballast-gpr build --pulse pulse.txt --fouling 20cm"
)]
pub struct FromPlateArgs {
    /// Measurement over a metal plate: an instrument's file or two-column text.
    #[arg(value_name = "PLATE")]
    pub plate: PathBuf,
    /// Measurement without a plate, on the same mount (sky, or the trolley): what it holds is no echo of the plate.
    #[arg(long, value_name = "TRACE")]
    pub free_space: Option<PathBuf>,
    /// Height of the antenna above the plate.
    #[arg(long, value_name = "LENGTH")]
    pub height: Metres,
    /// Nominal frequency of the antenna.
    #[arg(long, value_name = "FREQUENCY", default_value = "1GHz")]
    pub frequency: Hertz,
    /// Distance between source and receiver of the model [default: 4 cm, as in the scenes].
    #[arg(long, value_name = "LENGTH")]
    pub separation: Option<Metres>,
    /// Dimensions of the model that the pulse is for: a line source needs another than a dipole.
    #[arg(long, value_name = "2|3", default_value = "2")]
    pub dimension: Dimension,
    /// Where the plate's echo is looked for, as FROM..TO (9ns..11ns) [default: the strongest echo].
    #[arg(long, value_name = "FROM..TO", value_parser = crate::cli::compare::read_window)]
    pub window: Option<(Seconds, Seconds)>,
    /// Noise that is reckoned with, as a share of the strongest component of the echo.
    #[arg(long, value_name = "SHARE", default_value = "1%")]
    pub regularisation: Share,
    /// File to write; figure and numbers go beside it as .png, .svg and .json.
    #[arg(long, value_name = "FILE", default_value = "pulse.txt")]
    pub out: PathBuf,
    /// Overwrite files that are there.
    #[arg(long)]
    pub force: bool,
    /// Print the numbers as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a trace cannot be read, holds no echo, or a file cannot be written.
pub fn run(args: &PulseArgs) -> Result<(), CliError> {
    match &args.command {
        PulseCommand::FromPlate(args) => from_plate(args),
    }
}

fn from_plate(args: &FromPlateArgs) -> Result<(), CliError> {
    check(args)?;
    let stem = args.out.with_extension("");
    let beside = ["png", "svg", "json"].map(|ending| folder::with_ending(&stem, ending));
    for path in std::iter::once(&args.out).chain(&beside) {
        folder::may_write(path, args.force)?;
    }
    let measured = trace_file::read(&args.plate)?;
    let free_space = args.free_space.as_deref().map(trace_file::read).transpose()?;
    let mut setup = PlateSetup::new(args.height, args.frequency, args.dimension);
    setup.separation = args.separation.unwrap_or(setup.separation);
    let options = DeconvolutionOptions {
        regularisation: args.regularisation.si(),
        ..DeconvolutionOptions::of_frequency(args.frequency.si())
    };
    let bar = Bar::new("simulating the plate");
    let solver = Fdtd::default();
    let found = pulse_of_plate(&solver, &measured, free_space.as_ref(), &setup, args.window, &options, &|progress| {
        bar.update(progress)
    })?;
    drop(bar);
    if interrupt::flow().is_break() {
        return Err(crate::forward::ForwardError::Stopped.into());
    }
    files::create_folder(args.out.parent().unwrap_or(Path::new("")))?;
    files::write_bytes(&args.out, gprmax::excitation_text("pulse", &sampled(&found.found.pulse)?).as_bytes())?;
    let name = stem.file_name().map_or("pulse".into(), |name| name.to_string_lossy().into_owned());
    figure(&format!("Pulse from the plate, {}", measured.name), &found)
        .write(stem.parent().unwrap_or(Path::new("")), &name)?;
    let value = summary(args, &setup, &found);
    let mut text = serde_json::to_string_pretty(&value)?;
    text.push('\n');
    files::write_bytes(&beside[2], text.as_bytes())?;
    if args.json {
        print!("{text}");
    } else {
        table(&found, &measured.name).print();
    }
    eprintln!("written: {}, {1}.png, {1}.svg, {1}.json", args.out.display(), stem.display());
    Ok(())
}

fn check(args: &FromPlateArgs) -> Result<(), CliError> {
    for (name, length, hint) in [("--height", Some(args.height), "43cm"), ("--separation", args.separation, "4cm")] {
        if let Some(length) = length.filter(|length| !(0.0..100.0).contains(&length.si())) {
            return Err(CliError::input(format!(
                "`{name}` is {length}, but must be from 0 to 100 m\n\nhint: `{name} {hint}`"
            )));
        }
    }
    if !(1e7..=1e11).contains(&args.frequency.si()) {
        let found = args.frequency;
        return Err(CliError::input(format!(
            "`--frequency` is {found}, but must be from 10 MHz to 100 GHz\n\nhint: `--frequency 1GHz`"
        )));
    }
    if args.height.si() < 0.05 * 3e8 / args.frequency.si() {
        return Err(CliError::input(format!(
            "`--height` is {}, too near to the plate for the echo to be told from the direct wave\n\nhint: `--height 43cm`",
            args.height
        )));
    }
    if !(1e-6..=1.0).contains(&args.regularisation.si()) {
        return Err(CliError::input(format!(
            "`--regularisation` is {}, but must be from 0.0001% to 100%\n\nhint: `--regularisation 1%`",
            args.regularisation
        )));
    }
    Ok(())
}

/// A trace as the samples of a pulse.
///
/// # Errors
/// When it is no pulse, which a fault of this program would make it.
pub fn sampled(pulse: &AScan) -> Result<Sampled, CliError> {
    Sampled::new(pulse.times().collect(), pulse.samples.clone(), Between::Linear, Beyond::Value(0.0))
        .ok_or_else(|| CliError::new(crate::cli::error::Kind::Fault, "the pulse holds a number that is not finite"))
}

fn summary(args: &FromPlateArgs, setup: &PlateSetup, of: &PulseOfPlate) -> serde_json::Value {
    let fit = |fit: &crate::compare::pulse::PulseFit| serde_json::json!({ "pulse": fit.kind, "frequency_hz": fit.frequency.si(), "correlation": fit.correlation });
    let measured = spectrum(&of.measured.trace);
    serde_json::json!({
        "format_version": 1,
        "program": folder::program(),
        "plate": args.plate,
        "free_space": args.free_space,
        "setup": setup,
        "regularisation": args.regularisation.si(),
        "steps": of.measured.steps,
        "echo": of.measured.echo,
        "share_of_energy_outside_the_gate": of.measured.energy_outside,
        "echo_spectrum": { "peak_hz": measured.peak_frequency.si(), "centre_hz": measured.centre_frequency.si(),
            "band_3_db_hz": [measured.band_3_db.0.si(), measured.band_3_db.1.si()] },
        "correlation": of.found.correlation,
        "measured_over_simulated": of.found.scale,
        "pulse_peak_s": of.found.peak.si(),
        "clock_offset_s": of.found.lag.si(),
        "ricker_nominal": fit(&of.ricker),
        "best_fits": of.fits.iter().map(fit).collect::<Vec<_>>(),
    })
}

fn table(of: &PulseOfPlate, name: &str) -> Report {
    let mut table = Report::new(
        format!("Simulated plate echoes against that of `{name}`"),
        ["pulse", "frequency, GHz", "correlation"],
    );
    table.row(["from the plate".into(), "–".into(), format!("{:.4}", of.found.correlation)]);
    for (note, fit) in std::iter::once((", nominal", &of.ricker)).chain(of.fits.iter().map(|fit| (", best fit", fit))) {
        table.row([
            format!("{}{note}", fit.kind.name()),
            format!("{:.3}", 1e-9 * fit.frequency.si()),
            format!("{:+.4}", fit.correlation),
        ]);
    }
    table
}

/// Measured echo with the simulated ones, the pulse, and their spectra.
fn figure(title: &str, of: &PulseOfPlate) -> Panels {
    let curve = |trace: &AScan| trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect::<Vec<_>>();
    let echo = &of.measured.echo;
    let unit = of.measured.trace.peak();
    let scaled = |trace: &AScan| curve(trace).into_iter().map(|(t, v)| (t, v / unit)).collect::<Vec<_>>();
    let centre = 1e9 * echo.envelope.time.si();
    let time = Axis::linear("time of the measurement", "ns").between(centre - 4.0, centre + 6.0);
    let mut echoes = Chart::new("Echo of the plate", time, Axis::linear("amplitude over the largest", ""))
        .with(Series::line("measured", scaled(&of.measured.ungated)))
        .with(Series::line("from the plate", scaled(&of.found.predicted)).drawn(Stroke::Dashed, 1));
    let ricker_name = format!("Ricker {:.2} GHz, r = {:.3}", 1e-9 * of.ricker.frequency.si(), of.ricker.correlation);
    echoes.series.push(Series::line(&ricker_name, scaled(&of.ricker.echo)).drawn(Stroke::Dotted, 2));
    let best = of.fits.iter().max_by(|a, b| a.correlation.abs().total_cmp(&b.correlation.abs()));
    if let Some(best) = best {
        let name = format!("{}, {:.2} GHz, r = {:.3}", best.kind.name(), 1e-9 * best.frequency.si(), best.correlation);
        echoes.series.push(Series::line(&name, scaled(&best.echo)).drawn(Stroke::DashDotted, 3));
    }
    let on = |on: PickedOn| if on == PickedOn::Waveform { "waveform" } else { "envelope" };
    for pick in [echo.waveform, echo.envelope] {
        echoes.markers.push(Marker {
            x: 1e9 * pick.time.si(),
            y: pick.amplitude / unit,
            label: on(pick.on).into(),
            colour: 0,
        });
    }
    let pulse = Chart::new("Pulse", Axis::linear("time", "ns"), Axis::linear("amplitude", ""))
        .with(Series::line("", curve(&of.found.pulse)).drawn(Stroke::Solid, 1));
    let highest = 3.0 * spectrum(&of.measured.trace).peak_frequency.si();
    let amplitudes = |trace: &AScan| {
        let spectrum = spectrum(trace);
        let largest = spectrum.amplitude.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let points = spectrum.amplitude.iter().enumerate().map(|(k, v)| (spectrum.frequency(k), v / largest));
        points.take_while(|(f, _)| *f <= highest).map(|(f, v)| (1e-9 * f, v)).collect::<Vec<_>>()
    };
    let mut spectra =
        Chart::new("Spectra over their peaks", Axis::linear("frequency", "GHz"), Axis::linear("amplitude", ""))
            .with(Series::line("measured echo", amplitudes(&of.measured.trace)))
            .with(Series::line("pulse", amplitudes(&of.found.pulse)).drawn(Stroke::Dashed, 1))
            .with(Series::line(&ricker_name, amplitudes(&of.ricker.echo)).drawn(Stroke::Dotted, 2));
    if let Some(best) = best {
        spectra.series.push(Series::line("best fit", amplitudes(&best.echo)).drawn(Stroke::DashDotted, 3));
    }
    Panels::stacked(title, vec![echoes, pulse, spectra])
}

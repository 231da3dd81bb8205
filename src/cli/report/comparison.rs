//! Traces beside one another in the page.

use std::path::{Path, PathBuf};

use super::ReportArgs;
use super::model::as_layers;
use super::page::{Compared, Picture, Table};
use crate::cli::compare::{expected, table};
use crate::cli::comparison_figure;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::trace_file;
use crate::compare::pulse::{Gate, PlateOptions, plate_echo};
use crate::compare::{self, CompareOptions, Comparison, ExpectedEchoes, Normalisation, Polarity, Step, TimeZero};
use crate::fdtd::Fdtd;
use crate::scene::SceneSpec;
use crate::study::plate_reference;
use crate::trace::AScan;
use crate::units::Seconds;
use crate::units::constants::C0;

/// Each folder's trace but the first against the first.
///
/// # Errors
/// When a trace cannot be read or compared.
pub fn among(folders: &[PathBuf]) -> Result<Vec<Compared>, CliError> {
    let Some((first, others)) = folders.split_first() else { return Ok(vec![]) };
    let mut found = vec![];
    for other in others {
        let (a, b) = (trace_file::read(first)?, trace_file::read(other)?);
        let options = CompareOptions { expected: expected(&[first, other])?, ..CompareOptions::default() };
        let how = "Both over their largest amplitude, times as simulated.";
        found.push(compared(compare::compare(&a, &b, &options)?, how, vec![], false)?);
    }
    Ok(found)
}

/// Each folder's trace against a measurement.
///
/// # Errors
/// When a trace cannot be read or compared, or the plate has no echo.
pub fn with_measured(args: &ReportArgs, measured: &Path) -> Result<Vec<Compared>, CliError> {
    let measured = trace_file::read(measured)?;
    let free_space = args.free_space.as_deref().map(trace_file::read).transpose()?;
    let plate = args.plate.as_deref().map(trace_file::read).transpose()?;
    let mut found = vec![];
    for path in &args.folders {
        let Ok(simulated) = trace_file::read(path) else { continue };
        found.push(match &plate {
            Some(plate) => by_plate(path, &simulated, &measured, plate, free_space.as_ref())?,
            None => by_shape(&simulated, &measured, free_space.clone())?,
        });
    }
    Ok(found)
}

fn by_shape(simulated: &AScan, measured: &AScan, free_space: Option<AScan>) -> Result<Compared, CliError> {
    let options = CompareOptions {
        reference_b: free_space,
        time_zero: TimeZero::FirstPeak,
        normalisation: Normalisation::Maximum,
        polarity: Polarity::Auto,
        ..CompareOptions::default()
    };
    let how = "Both over their largest amplitude, time zero at the first strong peak, the measurement turned where that fits better.";
    compared(compare::compare(simulated, measured, &options)?, how, vec![], true)
}

/// Both over the echo of a metal plate at the bed's surface, both from the emission that this echo tells.
fn by_plate(
    path: &Path,
    simulated: &AScan,
    measured: &AScan,
    plate: &AScan,
    free_space: Option<&AScan>,
) -> Result<Compared, CliError> {
    let scene = as_layers(&SceneSpec::read(&path.join(folder::SCENE))?)?;
    let reference = plate_reference(&Fdtd::default(), &scene, &|_| interrupt::flow())?;
    let (a, first) = compare::subtract_reference(simulated, &reference.free_space);
    let (a, second) = compare::normalise(&a, -signed_peak(&reference.plate_echo), "plate echo");
    let (a, third) = compare::set_time_zero(&a, reference.zero(), Seconds(0.0), "emission, by the plate echo");

    let gate = Gate::of_frequency(scene.spec.antenna.frequency.si());
    let echo = plate_echo(plate, free_space, &PlateOptions { gate, window: None })?;
    let emission = Seconds(echo.echo.envelope.time.si() - 2.0 * scene.spec.antenna.height.si() / C0);
    let mut measured_steps = vec![];
    let mut b = measured.clone();
    if let Some(free_space) = free_space {
        let (left, step) = compare::subtract_reference(&b, free_space);
        b = left;
        measured_steps.push(step);
    }
    let (b, step) = compare::normalise(&b, -echo.echo.waveform.amplitude, "plate echo");
    measured_steps.push(step);
    let (b, step) = compare::set_time_zero(&b, emission, Seconds(0.0), "emission, by the plate echo");
    measured_steps.push(step);

    let [surface, base] = scene.echo_windows();
    let options = CompareOptions {
        expected: ExpectedEchoes {
            surface: Some((surface[0], surface[1])),
            plate: Some((base[0], base[1])),
            no_direct_wave: true,
            no_noise: true,
            ..ExpectedEchoes::default()
        },
        normalisation: Normalisation::None,
        polarity: Polarity::Keep,
        remove_dc: false,
        window: Some((Seconds(0.0), Seconds(base[1].si() + 4e-9))),
        ..CompareOptions::default()
    };
    let comparison = compare::compare(&a, &b, &options)?;
    let named = |name: &str, steps: &[Step]| steps.iter().map(|step| format!("{name}: {step}")).collect::<Vec<_>>();
    let mut steps = named("simulated", &[first, second, third]);
    steps.extend(named("measured", &measured_steps));
    let how = "Both over the echo of a metal plate at the bed's surface, times from the emission that this echo tells.";
    compared(comparison, how, steps, true)
}

/// Largest amplitude with its sign.
fn signed_peak(trace: &AScan) -> f64 {
    trace.samples.iter().copied().fold(0.0, |most: f64, v| if v.abs() > most.abs() { v } else { most })
}

fn compared(comparison: Comparison, how: &str, mut steps: Vec<String>, measured: bool) -> Result<Compared, CliError> {
    let title = format!("{} and {}", comparison.a.name, comparison.b.name);
    for (letter, done) in [("A", &comparison.steps_a), ("B", &comparison.steps_b)] {
        steps.extend(done.iter().map(|step| format!("{letter}: {step}")));
    }
    Ok(Compared {
        figure: Picture::of(
            "Traces, difference, envelopes and spectra",
            &comparison_figure::figure(&title, &comparison, measured),
        )?,
        metrics: Table::from(&table(&comparison)),
        title,
        how: how.into(),
        steps,
    })
}

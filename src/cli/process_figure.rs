//! The figure of `process`: before and after, spectra, short-time spectrum.

use crate::cli::error::CliError;
use crate::compare::process::{mean_trace, short_time_spectrum};
use crate::compare::{Spectrum, envelope, spectrum};
use crate::plot::{Axis, Chart, Legend, Panels, Pixels, Series, Shades, Stroke};
use crate::trace::{AScan, BScan};
use crate::units::Seconds;

/// Share of the samples of a radargram that are not beyond the ends of its greys.
const SHOWN: f64 = 0.99;

/// Draws what a section was and what became of it: radargrams where there are several traces, else traces.
///
/// # Errors
/// A window of the short-time spectrum that does not fit the trace.
pub fn figure(before: &BScan, after: &BScan, window: Option<Seconds>) -> Result<Panels, CliError> {
    let (mean_before, mean_after) = (mean_trace(before), mean_trace(after));
    let (spectrum_before, spectrum_after) = (spectrum(&mean_before), spectrum(&mean_after));
    let highest = 3.0 * spectrum_before.peak_frequency.si().max(spectrum_after.peak_frequency.si()).max(1.0);
    let charts = vec![
        section_chart("Before", before, &mean_before),
        section_chart("After", after, &mean_after),
        Chart::new(
            "Spectra of the mean trace",
            Axis::linear("frequency", "GHz"),
            Axis::linear("amplitude / largest", ""),
        )
        .with(Series::line("before", amplitudes(&spectrum_before, highest)).drawn(Stroke::Dashed, 7))
        .with(Series::line("after", amplitudes(&spectrum_after, highest)).drawn(Stroke::Solid, 0)),
        short_time_chart(&mean_after, &spectrum_after, highest, window)?,
    ];
    Ok(Panels::stacked(&before.name, charts))
}

fn section_chart(title: &str, section: &BScan, mean: &AScan) -> Chart {
    if section.count() > 1 { radargram(title, section) } else { trace_chart(title, mean) }
}

fn nanoseconds(trace: &AScan) -> Vec<(f64, f64)> {
    trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect()
}

fn trace_chart(title: &str, trace: &AScan) -> Chart {
    let (first, last) = (1e9 * trace.time(0), 1e9 * trace.time(trace.samples.len().saturating_sub(1)));
    Chart::new(title, Axis::linear("time", "ns").between(first, last), Axis::linear("amplitude", ""))
        .with(Series::line("envelope", nanoseconds(&envelope(trace))).drawn(Stroke::Dotted, 7))
        .with(Series::line("trace", nanoseconds(trace)).drawn(Stroke::Solid, 0))
}

/// A section in greys, time downwards: white at and above the level that 99 % of the samples stay below, black at minus that.
pub fn radargram(title: &str, section: &BScan) -> Chart {
    let mut sizes: Vec<f64> = section.samples().iter().map(|v| v.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let limit = sizes.get((SHOWN * (sizes.len() - 1) as f64) as usize).copied().unwrap_or(0.0);
    let last = section.samples_per_trace().saturating_sub(1) as f64;
    let time = |sample: f64| 1e9 * (section.first_sample.si() + sample * section.time_step.si());
    let title = format!("{title} (greys end at ±{limit:.3e})");
    let mut chart = Chart::new(&title, Axis::linear("trace", ""), Axis::linear("time", "ns").downwards());
    chart.legend = Legend::None;
    chart.pixels = Some(Pixels {
        values: section.samples().to_vec(),
        columns: section.count(),
        rows: section.samples_per_trace(),
        x: (0.0, section.count().saturating_sub(1) as f64),
        y: (time(0.0), time(last)),
        shades: Shades::Grey,
        limit: (limit > 0.0).then_some(limit),
    });
    chart
}

fn amplitudes(spectrum: &Spectrum, highest: f64) -> Vec<(f64, f64)> {
    let largest = spectrum.amplitude.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let points = spectrum.amplitude.iter().enumerate().map(|(k, v)| (spectrum.frequency(k), v / largest));
    points.take_while(|(f, _)| *f <= highest).map(|(f, v)| (1e-9 * f, v)).collect()
}

fn short_time_chart(
    trace: &AScan,
    spectrum: &Spectrum,
    highest: f64,
    window: Option<Seconds>,
) -> Result<Chart, CliError> {
    let length = trace.samples.len() as f64 * trace.time_step.si();
    let shortest = 4.0 * trace.time_step.si();
    let usual = (4.0 / spectrum.peak_frequency.si().max(1.0)).min(0.25 * length).max(shortest);
    let found = short_time_spectrum(trace, window.unwrap_or(Seconds(usual)))?;
    let rows = ((highest / found.frequency_step.si()) as usize + 1).min(found.frequencies);
    let kept = found.amplitude.chunks_exact(found.frequencies).flat_map(|spectrum| &spectrum[..rows]);
    let title = format!("Short-time spectrum after (window {:.2} ns)", 1e9 * found.window.si());
    let mut chart = Chart::new(&title, Axis::linear("time", "ns"), Axis::linear("frequency", "GHz"));
    chart.legend = Legend::None;
    let last = found.times().saturating_sub(1) as f64;
    chart.pixels = Some(Pixels {
        values: kept.copied().collect(),
        columns: found.times(),
        rows,
        x: (1e9 * found.first_time.si(), 1e9 * (found.first_time.si() + last * found.time_step.si())),
        y: (0.0, 1e-9 * (rows - 1) as f64 * found.frequency_step.si()),
        shades: Shades::Viridis,
        limit: None,
    });
    Ok(chart)
}

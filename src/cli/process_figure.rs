//! The figure of `process`: before and after, spectra, short-time spectrum.

use crate::cli::error::CliError;
use crate::compare::process::short_time_spectrum;
use crate::compare::{envelope, spectrum};
use crate::plot::{Axis, Chart, Legend, Panels, Pixels, Series, Shades, Stroke};
use crate::trace::{AScan, BScan};
use crate::units::Seconds;

/// Share of the samples of a radargram that are not beyond the ends of its greys.
const SHOWN: f64 = 0.99;

/// Most traces whose spectra are averaged for the figure.
const MOST_TRACES: usize = 64;

/// Draws what a section was and what became of it: radargrams where there are several traces, else traces; below, the roots
/// of the mean power spectra over (up to 64, evenly chosen) traces.
///
/// # Errors
/// A window of the short-time spectrum that does not fit the trace.
pub fn figure(before: &BScan, after: &BScan, window: Option<Seconds>) -> Result<Panels, CliError> {
    let (first, second) = (MeanSpectrum::of(before), MeanSpectrum::of(after));
    let highest = 3.0 * first.peak_frequency().max(second.peak_frequency()).max(1.0);
    let charts = vec![
        section_chart("Before", before),
        section_chart("After", after),
        Chart::new("Spectra", Axis::linear("frequency", "GHz"), Axis::linear("amplitude / largest", ""))
            .with(Series::line("before", first.curve(highest)).drawn(Stroke::Dashed, 7))
            .with(Series::line("after", second.curve(highest)).drawn(Stroke::Solid, 0)),
        short_time_chart(after, second.peak_frequency(), highest, window)?,
    ];
    Ok(Panels::stacked(&before.name, charts))
}

/// Up to 64 traces of a section, evenly chosen.
fn chosen(section: &BScan) -> impl Iterator<Item = AScan> + '_ {
    let stride = section.count().div_ceil(MOST_TRACES).max(1);
    (0..section.count()).step_by(stride).filter_map(|number| section.trace(number))
}

/// Adds the squares of some amplitudes to a sum.
fn add_power(sum: &mut Vec<f64>, amplitude: &[f64]) {
    sum.resize(amplitude.len(), 0.0);
    sum.iter_mut().zip(amplitude).for_each(|(sum, v)| *sum += v * v);
}

/// Root of the mean power spectrum, relative to its largest value: a mean of the traces would be nothing once their
/// background is off.
struct MeanSpectrum {
    frequency_step: f64,
    amplitude: Vec<f64>,
}

impl MeanSpectrum {
    fn of(section: &BScan) -> Self {
        let (mut power, mut frequency_step) = (Vec::new(), 0.0);
        for trace in chosen(section) {
            let found = spectrum(&trace);
            frequency_step = found.frequency_step.si();
            add_power(&mut power, &found.amplitude);
        }
        let largest = power.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        Self { frequency_step, amplitude: power.iter().map(|v| (v / largest).sqrt()).collect() }
    }

    fn peak_frequency(&self) -> f64 {
        let peak = (0..self.amplitude.len()).max_by(|a, b| self.amplitude[*a].total_cmp(&self.amplitude[*b]));
        peak.unwrap_or(0) as f64 * self.frequency_step
    }

    fn curve(&self, highest: f64) -> Vec<(f64, f64)> {
        let points = self.amplitude.iter().enumerate().map(|(k, v)| (k as f64 * self.frequency_step, *v));
        points.take_while(|(f, _)| *f <= highest).map(|(f, v)| (1e-9 * f, v)).collect()
    }
}

fn section_chart(title: &str, section: &BScan) -> Chart {
    match section.trace(0) {
        Some(trace) if section.count() == 1 => trace_chart(title, &trace),
        _ => radargram(title, section),
    }
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

fn short_time_chart(
    section: &BScan,
    peak_frequency: f64,
    highest: f64,
    window: Option<Seconds>,
) -> Result<Chart, CliError> {
    let length = section.samples_per_trace() as f64 * section.time_step.si();
    let shortest = 4.0 * section.time_step.si();
    let usual = (4.0 / peak_frequency.max(1.0)).min(0.25 * length).max(shortest);
    let window = window.unwrap_or(Seconds(usual));
    let (mut power, mut last) = (Vec::new(), None);
    for trace in chosen(section) {
        let found = short_time_spectrum(&trace, window)?;
        add_power(&mut power, &found.amplitude);
        last = Some(found);
    }
    let mut chart = Chart::new("", Axis::linear("time", "ns"), Axis::linear("frequency", "GHz"));
    chart.legend = Legend::None;
    let Some(found) = last else { return Ok(chart) };
    let rows = ((highest / found.frequency_step.si()) as usize + 1).min(found.frequencies);
    let kept = power.chunks_exact(found.frequencies).flat_map(|spectrum| &spectrum[..rows]);
    chart.title = format!("Short-time spectrum after (window {:.2} ns)", 1e9 * found.window.si());
    let end = found.times().saturating_sub(1) as f64 * found.time_step.si();
    chart.pixels = Some(Pixels {
        values: kept.map(|v| v.sqrt()).collect(),
        columns: found.times(),
        rows,
        x: (1e9 * found.first_time.si(), 1e9 * (found.first_time.si() + end)),
        y: (0.0, 1e-9 * (rows - 1) as f64 * found.frequency_step.si()),
        shades: Shades::Viridis,
        limit: None,
    });
    Ok(chart)
}

//! An ensemble of simulations against one measurement, as figure, table and numbers.

use crate::cli::compare::signed;
use crate::cli::comparison_figure::markers;
use crate::cli::error::CliError;
use crate::cli::table::Report;
use crate::compare::{
    CompareOptions, Comparison, Ensemble, ExpectedEchoes, Normalisation, Polarity, Spectrum, compare, envelope,
};
use crate::plot::{Axis, Band, Chart, Panels, Series, Stroke};

const MEASURED: usize = 6;
const SIMULATED: usize = 0;
const SPAN: usize = 5;
const OUTSIDE: usize = 1;

/// Draws the measurement solid over the band of the simulations and their mean, dashed; below it what is left, envelopes
/// and spectra.
///
/// # Errors
/// When mean and measurement cannot be compared.
pub fn figure(band: &Ensemble, comparisons: &[Comparison]) -> Result<Panels, CliError> {
    let Some(first) = comparisons.first() else { return Err(CliError::input("an ensemble needs simulations")) };
    let measured = band.curve(&band.measured_name, &band.measured, &first.a);
    let mean = band.curve(&format!("mean of {} simulations", band.members), &band.mean, &first.b);
    let options = CompareOptions {
        remove_dc: false,
        normalisation: Normalisation::None,
        polarity: Polarity::Keep,
        expected: ExpectedEchoes::default(),
        ..CompareOptions::default()
    };
    let of_mean = compare(&measured, &mean, &options)?;
    let times: Vec<f64> = (0..band.mean.len()).map(|k| 1e9 * band.time(k)).collect();
    let axis = || {
        let (first, last) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
        Axis::linear("time", "ns").between(first, last)
    };
    let line = |samples: &[f64]| times.iter().copied().zip(samples.iter().copied()).collect::<Vec<_>>();
    let shade = |name: &str, lower: Vec<f64>, upper: Vec<f64>, colour: usize| Band {
        name: name.into(),
        x: times.clone(),
        lower,
        upper,
        colour,
    };
    let about = |centre: &dyn Fn(usize) -> f64, sign: f64| -> Vec<f64> {
        band.deviation.iter().enumerate().map(|(k, deviation)| centre(k) + sign * deviation).collect()
    };
    let middle = |k: usize| band.mean[k];
    let none = |_: usize| 0.0;

    let [span, deviation] = [band.inside_span, band.inside_deviation].map(|share| format!("{:.0} %", 100.0 * share));
    let title = format!("A-scans: measured in the span of the simulations {span}, within one deviation {deviation}");
    let mut traces = Chart::new(&title, axis(), Axis::linear("amplitude", ""));
    traces.bands.push(shade("smallest to largest", band.low.clone(), band.high.clone(), SPAN));
    traces.bands.push(shade("mean ± standard deviation", about(&middle, -1.0), about(&middle, 1.0), SIMULATED));
    // A strip at the foot of the chart, where the measurement is outside.
    let values = || band.low.iter().chain(&band.high).chain(&band.measured);
    let lowest = values().copied().fold(f64::INFINITY, f64::min);
    let highest = values().copied().fold(f64::NEG_INFINITY, f64::max);
    let foot = lowest - 0.05 * (highest - lowest);
    let strip = times.iter().zip(band.inside()).map(|(t, inside)| (*t, if inside { f64::NAN } else { foot })).collect();
    let mut outside = Series::line("measured outside", strip).drawn(Stroke::Solid, OUTSIDE);
    outside.width = 4.0;
    let mut traces = traces
        .with(outside)
        .with(Series::line(&mean.name, line(&band.mean)).drawn(Stroke::Dashed, SIMULATED))
        .with(Series::line(&measured.name, line(&band.measured)).drawn(Stroke::Solid, MEASURED));
    traces.markers.extend(markers(&of_mean.picks_a, "", MEASURED));
    traces.markers.extend(markers(&of_mean.picks_b, "′", SIMULATED));

    let left: Vec<f64> = band.measured.iter().zip(&band.mean).map(|(v, mean)| v - mean).collect();
    let mut residual = Chart::new("Measured minus mean", axis(), Axis::linear("amplitude", ""));
    residual.bands.push(shade("± standard deviation", about(&none, -1.0), about(&none, 1.0), SIMULATED));
    let residual = residual.with(Series::line("", line(&left)).drawn(Stroke::Solid, 2));

    let envelopes = Chart::new("Envelopes", axis(), Axis::linear("amplitude", ""))
        .with(Series::line("of the mean", line(&envelope(&mean).samples)).drawn(Stroke::Dashed, SIMULATED))
        .with(Series::line("of the measurement", line(&envelope(&measured).samples)).drawn(Stroke::Solid, MEASURED));

    let most = 3.0 * of_mean.spectrum_a.peak_frequency.si().max(of_mean.spectrum_b.peak_frequency.si()).max(1.0);
    let amplitudes = |spectrum: &Spectrum| {
        let points = spectrum.amplitude.iter().enumerate().map(|(k, v)| (spectrum.frequency(k), *v));
        points.take_while(|(f, _)| *f <= most).map(|(f, v)| (1e-9 * f, v)).collect::<Vec<_>>()
    };
    let mut spectra = Chart::new("Spectra", Axis::linear("frequency", "GHz"), Axis::linear("amplitude", ""));
    for (index, comparison) in comparisons.iter().enumerate() {
        let name = if index == 0 { "each simulation" } else { "" };
        let mut one = Series::line(name, amplitudes(&comparison.spectrum_b)).drawn(Stroke::Solid, SPAN);
        one.width = 0.6;
        spectra = spectra.with(one);
    }
    let spectra = spectra
        .with(Series::line("of the mean", amplitudes(&of_mean.spectrum_b)).drawn(Stroke::Dashed, SIMULATED))
        .with(Series::line("of the measurement", amplitudes(&of_mean.spectrum_a)).drawn(Stroke::Solid, MEASURED));

    let title = format!("{} and {} simulations", band.measured_name, band.members);
    let mut panels = Panels::stacked(&title, vec![traces, residual, envelopes, spectra]);
    panels.heights = vec![1.5, 1.0, 1.0, 1.0];
    panels.size[1] += 150.0;
    Ok(panels)
}

/// The numbers of an ensemble as a table.
pub fn table(band: &Ensemble) -> Report {
    let title = format!("A: {}\nB: {} simulations", band.measured_name, band.members);
    let mut table = Report::new(title, ["B − A", "members", "mean", "± deviation", "least", "largest"]);
    for (name, spread) in &band.metrics {
        let small = name.contains("RMSE") || name.contains("difference");
        let show = |value: f64| {
            if small {
                format!("{value:.3e}")
            } else if name.ends_with("MHz") {
                signed(value, 1)
            } else if name.ends_with("ns") {
                signed(value, 3)
            } else {
                format!("{value:.4}")
            }
        };
        let deviation = if small { format!("{:.1e}", spread.deviation) } else { format!("{:.3}", spread.deviation) };
        let members = spread.members.to_string();
        table.row([(*name).into(), members, show(spread.mean), deviation, show(spread.low), show(spread.high)]);
    }
    let mut share = |name: &str, value: f64| {
        let empty = String::new;
        table.row([name.into(), empty(), format!("{:.1} %", 100.0 * value), empty(), empty(), empty()]);
    };
    share("measured samples between smallest and largest", band.inside_span);
    share("  that share for one more member, on average", band.inside_span_of_a_member);
    share("measured samples within mean ± deviation", band.inside_deviation);
    table
}

/// The numbers of an ensemble without its curves.
pub fn summary(band: &Ensemble) -> serde_json::Value {
    let metrics: serde_json::Map<String, serde_json::Value> =
        band.metrics.iter().map(|(name, spread)| ((*name).to_string(), serde_json::json!(spread))).collect();
    serde_json::json!({
        "measured": band.measured_name,
        "members": band.members,
        "inside_span": band.inside_span,
        "inside_span_of_a_member": band.inside_span_of_a_member,
        "inside_deviation": band.inside_deviation,
        "metrics": metrics,
    })
}

//! The figure of a comparison: traces, residual, envelopes and spectra, as in Figs. 9 and 10 of Benedetto et al. 2018.

use crate::compare::{Comparison, Event, Picks, Spectrum};
use crate::plot::{Axis, Chart, Marker, Panels, Series, Stroke};
use crate::trace::AScan;

/// Draws a comparison; the first trace solid, the second dashed, or the other way round where the second is the measured
/// one.
pub fn figure(title: &str, comparison: &Comparison, second_solid: bool) -> Panels {
    let Comparison { a, b, .. } = comparison;
    let curve = |trace: &AScan| trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect::<Vec<_>>();
    let time = || {
        let (first, last) = (a.time(0), a.time(a.samples.len().saturating_sub(1)));
        Axis::linear("time", "ns").between(1e9 * first, 1e9 * last)
    };
    let strokes = if second_solid { [Stroke::Dashed, Stroke::Solid] } else { [Stroke::Solid, Stroke::Dashed] };
    let pair = |chart: Chart, first: Vec<(f64, f64)>, second: Vec<(f64, f64)>| {
        chart
            .with(Series::line(&a.name, first).drawn(strokes[0], 0))
            .with(Series::line(&b.name, second).drawn(strokes[1], 1))
    };
    let mut traces = pair(Chart::new("A-scans", time(), Axis::linear("amplitude", "")), curve(a), curve(b));
    for (picks, letter, colour) in [(&comparison.picks_a, "", 0), (&comparison.picks_b, "′", 1)] {
        traces.markers.extend(markers(picks, letter, colour));
    }
    let difference = a.times().zip(a.samples.iter().zip(&b.samples)).map(|(t, (a, b))| (1e9 * t, b - a)).collect();
    let residual = Chart::new("Difference, second minus first", time(), Axis::linear("amplitude", ""))
        .with(Series::line("", difference).drawn(Stroke::Solid, 2));
    let envelopes = pair(
        Chart::new("Envelopes", time(), Axis::linear("amplitude", "")),
        curve(&comparison.envelope_a),
        curve(&comparison.envelope_b),
    );
    let highest =
        3.0 * comparison.spectrum_a.peak_frequency.si().max(comparison.spectrum_b.peak_frequency.si()).max(1.0);
    let amplitudes = |spectrum: &Spectrum| {
        let points = spectrum.amplitude.iter().enumerate().map(|(k, v)| (spectrum.frequency(k), *v));
        points.take_while(|(f, _)| *f <= highest).map(|(f, v)| (1e-9 * f, v)).collect::<Vec<_>>()
    };
    let spectra = pair(
        Chart::new("Spectra", Axis::linear("frequency", "GHz"), Axis::linear("amplitude", "")),
        amplitudes(&comparison.spectrum_a),
        amplitudes(&comparison.spectrum_b),
    );
    Panels::stacked(title, vec![traces, residual, envelopes, spectra])
}

/// The surface and plate echoes as points with names.
pub fn markers(picks: &Picks, letter: &str, colour: usize) -> Vec<Marker> {
    [(Event::SurfaceEcho, "surface"), (Event::PlateEcho, "plate")]
        .into_iter()
        .filter_map(|(event, name)| {
            let pick = picks.of(event).echo()?.waveform;
            Some(Marker { x: 1e9 * pick.time.si(), y: pick.amplitude, label: format!("{name}{letter}"), colour })
        })
        .collect()
}

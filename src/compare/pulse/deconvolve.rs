//! From the measured echo to the pulse.

use std::f64::consts::PI;

use super::filter::Filter;
use crate::compare::error::CompareError;
use crate::compare::metrics::cross_correlation;
use crate::compare::picks::Echo;
use crate::compare::resample::resample;
use crate::compare::steps::resample_to;
use crate::trace::AScan;
use crate::units::Seconds;

/// How a pulse is taken out of an echo.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct DeconvolutionOptions {
    /// The noise that is reckoned with, as a share of the strongest component of the simulated echo.
    pub regularisation: f64,
    /// Length of the pulse before the peak of its envelope.
    pub before: Seconds,
    /// Length after it.
    pub after: Seconds,
    /// Over which the ends of the pulse rise and fall, inside its length.
    pub taper: Seconds,
    /// Time step of the pulse.
    pub time_step: Seconds,
}

impl DeconvolutionOptions {
    /// The options for pulses of a centre frequency: 1 % of noise, 2 periods before the peak and 3 after it, ends of half a
    /// period, 200 samples a period (linear interpolation between them is off by 3e-4 at three times the frequency).
    pub fn of_frequency(frequency: f64) -> Self {
        let period = 1.0 / frequency;
        Self {
            regularisation: 0.01,
            before: Seconds(2.0 * period),
            after: Seconds(3.0 * period),
            taper: Seconds(0.5 * period),
            time_step: Seconds(period / 200.0),
        }
    }
}

/// A pulse and how well it does.
#[derive(Debug, Clone)]
pub struct Deconvolved {
    /// The pulse: largest amplitude one, from time zero.
    pub pulse: AScan,
    /// Time of the peak of its envelope.
    pub peak: Seconds,
    /// By what the simulated echo of the pulse has to be multiplied to be as large as the measured one.
    pub scale: f64,
    /// The simulated echo of the pulse, scaled, on the axis of the measured one.
    pub predicted: AScan,
    /// Correlation of that echo with the measured one.
    pub correlation: f64,
    /// By how much the measured echo is later than the simulated one of the known pulse: the offset of the two clocks.
    pub lag: Seconds,
}

/// Finds the pulse whose simulated plate echo is the measured one (see the module).
///
/// `known` is a pulse and `response` its simulated plate echo, the direct wave taken off, both from the same time zero; `wanted`
/// the measured echo, gated, on a clock of its own. The sign is the source's: a measured trace of opposite polarity gives a pulse
/// of opposite sign.
///
/// # Errors
/// Traces of zeros.
pub fn deconvolve(
    known: &AScan,
    response: &AScan,
    wanted: &AScan,
    of_wanted: &Echo,
    options: &DeconvolutionOptions,
) -> Result<Deconvolved, CompareError> {
    let step = options.time_step.si();
    let response = resample_to(response, step);
    let known = onto_axis_of(known, &response);
    // Both echoes on one axis, the measured one where the simulated one is.
    let simulated_peak = crate::compare::picks::strongest(&response).ok_or_else(|| all_zero(&response))?;
    let rough = of_wanted.envelope.time.si() - simulated_peak.envelope.time.si();
    let on_axis = |lag: f64| {
        let onto =
            resample(wanted, Seconds(lag + response.first_sample.si()), options.time_step, response.samples.len());
        inside_only(AScan { first_sample: response.first_sample, ..onto }, wanted, lag)
    };
    let roughly = on_axis(rough);
    let fine = cross_correlation(&response, &roughly, Seconds(2.0 * options.before.si()))?;
    let lag = rough + fine.lag.si();
    let measured = on_axis(lag);
    let filter = Filter::between(&response, &measured, options.regularisation)?;
    // Room before the pulse, so that nothing of it is cut off at time zero.
    let room = (options.before.si() / step).ceil() as usize;
    let padded = AScan {
        samples: std::iter::repeat_n(0.0, room).chain(known.samples.iter().copied()).collect(),
        first_sample: Seconds(known.first_sample.si() - room as f64 * step),
        ..known.clone()
    };
    let whole = filter.apply(&padded);
    let centre = crate::compare::picks::strongest(&whole).ok_or_else(|| all_zero(&whole))?.envelope.time.si();
    let (before, after) = (options.before.si(), options.after.si());
    let count = ((before + after) / step).round() as usize + 1;
    let first = centre - before;
    let cut = inside_only(resample(&whole, Seconds(first), options.time_step, count), &whole, 0.0);
    let length = before + after;
    let weight = |t: f64| {
        let inside = (t / options.taper.si()).min((length - t) / options.taper.si()).clamp(0.0, 1.0);
        0.5 - 0.5 * (PI * inside).cos()
    };
    let samples: Vec<f64> = cut.samples.iter().enumerate().map(|(k, v)| v * weight(k as f64 * step)).collect();
    let unscaled = AScan { samples, first_sample: Seconds(0.0), ..cut };
    let size = unscaled.peak();
    if size == 0.0 {
        return Err(all_zero(&unscaled));
    }
    let pulse = AScan {
        samples: unscaled.samples.iter().map(|v| v / size).collect(),
        name: format!("pulse of {}", wanted.name),
        ..unscaled
    };
    // The echo of the pulse by way of the response: what the filter from the known pulse to this one makes of it.
    let placed = AScan { first_sample: Seconds(first), ..pulse.clone() };
    let predicted = super::fit::echo_of(&placed, &known, &response)?;
    let dot = |a: &AScan, b: &AScan| a.samples.iter().zip(&b.samples).map(|(a, b)| a * b).sum::<f64>();
    let scale = dot(&predicted, &measured) / dot(&predicted, &predicted);
    let correlation = crate::compare::metrics::correlation(&predicted, &measured)?;
    let predicted = AScan {
        samples: predicted.samples.iter().map(|v| scale * v).collect(),
        first_sample: Seconds(predicted.first_sample.si() + lag),
        name: "simulated echo of the pulse".into(),
        ..predicted
    };
    Ok(Deconvolved { pulse, peak: Seconds(before), scale, predicted, correlation, lag: Seconds(lag) })
}

fn all_zero(trace: &AScan) -> CompareError {
    CompareError::AllZero { name: trace.name.clone() }
}

/// A trace on the axis of another, zero beyond its own ends.
pub(super) fn onto_axis_of(trace: &AScan, axis: &AScan) -> AScan {
    inside_only(resample(trace, axis.first_sample, axis.time_step, axis.samples.len()), trace, 0.0)
}

/// Sets to zero what lies beyond the ends of the trace that was resampled; `shift` is added to the times first.
fn inside_only(mut resampled: AScan, of: &AScan, shift: f64) -> AScan {
    let (first, last) = (of.first_sample.si(), of.time(of.samples.len().saturating_sub(1)));
    for k in 0..resampled.samples.len() {
        let t = resampled.time(k) + shift;
        if t < first || t > last {
            resampled.samples[k] = 0.0;
        }
    }
    resampled
}

#[cfg(test)]
mod tests {
    use super::super::fit::AnalyticPulse;
    use super::super::{Gate, PlateOptions, plate_echo};
    use super::*;
    use crate::compare::steps::test_traces::{noise, trace};
    use crate::units::Hertz;

    /// A lopsided pulse, not of the family of the known one.
    fn odd(t: f64) -> f64 {
        let x = t / 0.35e-9;
        (-x * x).exp() * (2.0 * PI * 0.9e9 * t + 0.7 + 0.3 * x).cos()
    }

    /// The antenna and the plate delay by 4 ns, turn the sign and halve; the instrument's clock is 3.3 ns ahead, its step
    /// another, and it adds 1 % of noise. Over the echo's length that is about 3 % of its norm, which leaves a correlation of
    /// `1 - 0.03²/2`; of the echo itself as much again is lost to the soft ends of gate and pulse.
    #[test]
    fn a_known_pulse_comes_back_under_noise() {
        let known = AnalyticPulse::GaussianFirst.trace(Hertz(1e9), Seconds(2e-9), Seconds(5e-12), 3000);
        let response = trace("response", 3000, 5e-12, |t| -0.5 * AnalyticPulse::GaussianFirst.value(t - 6e-9, 1e9));
        let mut measured = trace("measured", 512, 25e-9 / 512.0, |t| -0.5 * odd(t - 9.3e-9));
        for (v, e) in measured.samples.iter_mut().zip(noise(512, 3)) {
            *v += 0.005 * e;
        }
        let options = PlateOptions { gate: Gate::of_frequency(1e9), window: None };
        let flat = trace("sky", 512, 25e-9 / 512.0, |_| 0.0);
        let echo = plate_echo(&measured, Some(&flat), &options).unwrap();
        let options = DeconvolutionOptions::of_frequency(1e9);
        let found = deconvolve(&known, &response, &echo.trace, &echo.echo, &options).unwrap();
        let centre = crate::compare::picks::strongest(&trace("odd", 2000, 5e-12, |t| odd(t - 5e-9))).unwrap();
        let lead = centre.envelope.time.si() - 5e-9;
        let wanted = trace("wanted", found.pulse.samples.len(), 5e-12, |t| odd(t - found.peak.si() + lead));
        let fit = cross_correlation(&wanted, &found.pulse, Seconds(0.2e-9)).unwrap();
        assert!(fit.maximum > 0.999 && fit.lag.si().abs() < 2e-11, "{fit:?}");
        assert!(found.correlation > 0.998, "{}", found.correlation);
        assert!((found.pulse.peak() - 1.0).abs() < 1e-12);
    }

    /// Opposite polarity of the instrument turns the pulse and nothing else.
    #[test]
    fn a_turned_measurement_gives_a_turned_pulse() {
        let known = AnalyticPulse::GaussianFirst.trace(Hertz(1e9), Seconds(2e-9), Seconds(5e-12), 3000);
        let response = trace("response", 3000, 5e-12, |t| -0.5 * AnalyticPulse::GaussianFirst.value(t - 6e-9, 1e9));
        let flat = trace("sky", 512, 25e-9 / 512.0, |_| 0.0);
        let pulse_of = |sign: f64| {
            let measured = trace("measured", 512, 25e-9 / 512.0, |t| sign * odd(t - 9.3e-9));
            let options = PlateOptions { gate: Gate::of_frequency(1e9), window: None };
            let echo = plate_echo(&measured, Some(&flat), &options).unwrap();
            deconvolve(&known, &response, &echo.trace, &echo.echo, &DeconvolutionOptions::of_frequency(1e9)).unwrap()
        };
        let (plain, turned) = (pulse_of(1.0), pulse_of(-1.0));
        let same = plain.pulse.samples.iter().zip(&turned.pulse.samples).all(|(a, b)| (a + b).abs() < 1e-6);
        assert!(same, "lags {:?} and {:?}", plain.lag, turned.lag);
    }
}

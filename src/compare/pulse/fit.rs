//! The analytic pulse whose echo is nearest to the measured one.

use std::f64::consts::PI;

use super::deconvolve::onto_axis_of;
use super::filter::Filter;
use crate::compare::error::CompareError;
use crate::compare::metrics::{CrossCorrelation, cross_correlation};
use crate::compare::resample::resample;
use crate::trace::{AScan, Component};
use crate::units::{Hertz, Seconds};

/// A pulse by a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnalyticPulse {
    /// Second derivative of a Gaussian, sign turned.
    Ricker,
    /// First derivative of a Gaussian.
    GaussianFirst,
    /// Third derivative of a Gaussian.
    GaussianThird,
}

impl AnalyticPulse {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Ricker, Self::GaussianFirst, Self::GaussianThird];

    /// Its name in figures.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ricker => "Ricker",
            Self::GaussianFirst => "Gaussian, first derivative",
            Self::GaussianThird => "Gaussian, third derivative",
        }
    }

    /// Value at time `t`, s, from the centre, with the frequency `f`, Hz, at which a Ricker's spectrum peaks: derivatives of
    /// `exp(-(pi f t)²)`, not normalised.
    pub fn value(self, t: f64, f: f64) -> f64 {
        let a = PI * f;
        let x = a * t;
        let gaussian = (-x * x).exp();
        match self {
            Self::Ricker => (1.0 - 2.0 * x * x) * gaussian,
            Self::GaussianFirst => -2.0 * x * gaussian,
            Self::GaussianThird => (12.0 * x - 8.0 * x * x * x) * gaussian,
        }
    }

    /// The pulse as a trace from time zero, centred at `centre`.
    pub fn trace(self, frequency: Hertz, centre: Seconds, time_step: Seconds, count: usize) -> AScan {
        let value = |k: usize| self.value(k as f64 * time_step.si() - centre.si(), frequency.si());
        AScan {
            samples: (0..count).map(value).collect(),
            time_step,
            first_sample: Seconds(0.0),
            component: Component::Recorded,
            position: None,
            name: format!("{}, {:.2} GHz", self.name(), 1e-9 * frequency.si()),
        }
    }
}

/// How well the echo of an analytic pulse fits.
#[derive(Debug, Clone)]
pub struct PulseFit {
    /// Which formula.
    pub kind: AnalyticPulse,
    /// Its frequency.
    pub frequency: Hertz,
    /// Largest correlation with the measured echo, negative where the signs differ.
    pub correlation: f64,
    /// The simulated echo of this pulse, scaled and moved onto the measured one.
    pub echo: AScan,
}

/// The simulated echo of any pulse, by what was simulated for a known one: both with their time zero that of `response`.
///
/// # Errors
/// A known pulse of zeros.
pub fn echo_of(pulse: &AScan, known: &AScan, response: &AScan) -> Result<AScan, CompareError> {
    let known = onto_axis_of(known, response);
    let pulse = onto_axis_of(pulse, response);
    // Next to nothing is divided by: where the known pulse has no strength left, no pulse of interest has.
    Ok(Filter::between(&known, &pulse, 1e-4)?.apply(response))
}

/// Simulates, by way of the known pulse's echo, that of an analytic pulse of each frequency from `lowest` to `highest` in steps of
/// 1 %, and takes the one with the largest correlation with the measured echo, of either sign and at any lag.
///
/// With `lowest == highest` that one pulse is taken.
///
/// # Errors
/// Traces of zeros.
pub fn fit_pulse(
    kind: AnalyticPulse,
    (lowest, highest): (Hertz, Hertz),
    known: &AScan,
    response: &AScan,
    wanted: &AScan,
) -> Result<PulseFit, CompareError> {
    let count = ((highest.si() / lowest.si()).ln() / 1.01f64.ln()).round().max(0.0) as usize + 1;
    // As many samples as both need, each from its own first: the lag says the rest.
    let span =
        |trace: &AScan| (trace.samples.len() as f64 * trace.time_step.si() / response.time_step.si()).ceil() as usize;
    let length = span(wanted).max(span(response));
    let measured = AScan {
        first_sample: Seconds(0.0),
        ..padded(&resample(wanted, wanted.first_sample, response.time_step, span(wanted)), length)
    };
    let mut best: Option<(CrossCorrelation, Hertz, AScan)> = None;
    for index in 0..count {
        let frequency = Hertz(lowest.si() * 1.01f64.powi(index as i32));
        let centre = Seconds(2.0 / frequency.si());
        let pulse = kind.trace(frequency, centre, response.time_step, response.samples.len());
        let echo = padded(&echo_of(&pulse, known, response)?, length);
        let found = cross_correlation(&echo, &measured, Seconds(length as f64 * response.time_step.si()))?;
        if best.as_ref().is_none_or(|(other, _, _)| found.maximum.abs() > other.maximum.abs()) {
            best = Some((found, frequency, echo));
        }
    }
    let (found, frequency, echo) = best.ok_or_else(|| CompareError::AllZero { name: wanted.name.clone() })?;
    let norm = |trace: &AScan| trace.samples.iter().map(|v| v * v).sum::<f64>().sqrt();
    let factor = found.maximum * norm(&measured) / norm(&echo);
    let echo = AScan {
        samples: echo.samples.iter().map(|v| factor * v).collect(),
        first_sample: Seconds(wanted.first_sample.si() + found.lag.si()),
        name: format!("{}, {:.2} GHz", kind.name(), 1e-9 * frequency.si()),
        ..echo
    };
    Ok(PulseFit { kind, frequency, correlation: found.maximum, echo })
}

fn padded(trace: &AScan, length: usize) -> AScan {
    let mut samples = trace.samples.clone();
    samples.resize(length, 0.0);
    AScan { samples, first_sample: Seconds(0.0), ..trace.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::trace;

    /// The response is a delay of 3 ns and a turn of the sign, so the echo of a Ricker of 0.8 GHz is a turned Ricker of 0.8 GHz:
    /// the fit finds it within its step of 1 %, whatever the clock of the measurement.
    #[test]
    fn the_frequency_of_a_ricker_comes_back() {
        let known = AnalyticPulse::GaussianFirst.trace(Hertz(1e9), Seconds(2e-9), Seconds(1e-11), 1500);
        let response = trace("response", 1500, 1e-11, |t| -AnalyticPulse::GaussianFirst.value(t - 5e-9, 1e9));
        let wanted = trace("measured", 512, 25e-9 / 512.0, |t| 7.0 * AnalyticPulse::Ricker.value(t - 11e-9, 0.8e9));
        let found = fit_pulse(AnalyticPulse::Ricker, (Hertz(0.5e9), Hertz(1.5e9)), &known, &response, &wanted).unwrap();
        assert!((found.frequency.si() / 0.8e9 - 1.0).abs() < 0.01, "{:?}", found.frequency);
        assert!(found.correlation < -0.999, "{}", found.correlation);
        let at = found.echo.times().zip(&found.echo.samples).max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert!((at.0 - 11e-9).abs() < 2e-11 && (at.1 - 7.0).abs() < 0.1, "{at:?}");
    }
}

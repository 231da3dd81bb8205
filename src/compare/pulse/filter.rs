//! The filter that turns one trace into another.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::compare::error::CompareError;
use crate::compare::steps::resample_to;
use crate::trace::AScan;

/// A linear filter, as its transform on a time step.
#[derive(Debug, Clone)]
pub struct Filter {
    transform: Vec<Complex<f64>>,
    time_step: f64,
}

/// The transform of a trace whose time zero is that of the axis, padded to `length`; samples before time zero wrap around.
fn transform(trace: &AScan, length: usize) -> Vec<Complex<f64>> {
    let mut buffer: Vec<Complex<f64>> = trace.samples.iter().map(|v| Complex::new(*v, 0.0)).collect();
    buffer.resize(length, Complex::new(0.0, 0.0));
    FftPlanner::new().plan_fft_forward(length).process(&mut buffer);
    buffer
}

impl Filter {
    /// Finds the filter that turns `from` into `to`, `W = T F* / (|F|² + r² max|F|²)` with `r = regularisation`.
    ///
    /// Both traces on the same axis: the same step, the same first sample, the same length. A shift between them is part of
    /// the filter, so it should be taken out first where the filter is to be short.
    ///
    /// # Errors
    /// Different axes, or a `from` of zeros.
    pub fn between(from: &AScan, to: &AScan, regularisation: f64) -> Result<Self, CompareError> {
        crate::compare::metrics::same_axis(from, to)?;
        if from.peak() == 0.0 {
            return Err(CompareError::AllZero { name: from.name.clone() });
        }
        let length = (2 * from.samples.len()).next_power_of_two();
        let (f, t) = (transform(from, length), transform(to, length));
        let floor = regularisation.powi(2) * f.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
        let transform = f.iter().zip(&t).map(|(f, t)| t * f.conj() / (f.norm_sqr() + floor)).collect();
        Ok(Self { transform, time_step: from.time_step.si() })
    }

    /// Filters a trace, which is brought to the filter's time step; what the filter puts before its first sample or after its
    /// last is cut off.
    pub fn apply(&self, trace: &AScan) -> AScan {
        let trace = resample_to(trace, self.time_step);
        let length = self.transform.len();
        let kept = trace.samples.len();
        let mut samples = trace.samples.clone();
        samples.truncate(length);
        let mut buffer = transform(&AScan { samples, ..trace.clone() }, length);
        for (value, filter) in buffer.iter_mut().zip(&self.transform) {
            *value *= filter;
        }
        FftPlanner::new().plan_fft_inverse(length).process(&mut buffer);
        let samples = buffer.iter().take(kept).map(|v| v.re / length as f64).collect();
        AScan { samples, ..trace }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{ricker, trace};
    use crate::units::Seconds;

    /// Two echoes 2 ns apart, the second of half the size and turned: the filter is `delta(t - 1 ns) - delta(t - 3 ns)/2`,
    /// and does the same to another pulse of a narrower band. In the pass band the regularisation takes `r²` of it.
    #[test]
    fn a_filter_does_to_another_pulse_what_it_did_to_the_first() {
        let from = trace("from", 2000, 1e-11, |t| ricker(t - 6e-9));
        let to = trace("to", 2000, 1e-11, |t| ricker(t - 7e-9) - 0.5 * ricker(t - 9e-9));
        let filter = Filter::between(&from, &to, 1e-3).unwrap();
        let other = |t: f64| (-(t / 0.9e-9).powi(2)).exp() * (2.0 * std::f64::consts::PI * 1e9 * t).sin();
        let found = filter.apply(&trace("other", 2000, 1e-11, |t| other(t - 6e-9)));
        let wanted = trace("wanted", 2000, 1e-11, |t| other(t - 7e-9) - 0.5 * other(t - 9e-9));
        let difference = crate::compare::relative_l2(&wanted, &found).unwrap();
        assert!(difference < 1e-3, "{difference}");
    }

    #[test]
    fn nothing_to_filter_from_is_refused() {
        let flat = trace("flat", 100, 1e-11, |_| 0.0);
        let pulse = trace("pulse", 100, 1e-11, |t| ricker(t - 0.5e-9));
        assert!(matches!(Filter::between(&flat, &pulse, 0.01), Err(CompareError::AllZero { .. })));
        let later = AScan { time_step: Seconds(2e-11), ..pulse.clone() };
        assert!(matches!(Filter::between(&pulse, &later, 0.01), Err(CompareError::DifferentAxes { .. })));
    }
}

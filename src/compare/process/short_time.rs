//! How the spectrum changes along a trace.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::error::ProcessError;
use super::running::odd_count;
use crate::trace::AScan;
use crate::units::{Hertz, Seconds};

/// Most times at which spectra are taken.
const MOST_TIMES: usize = 512;

/// Amplitude spectra of a window that moves along a trace.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ShortTimeSpectrum {
    /// Centre of the first window.
    pub first_time: Seconds,
    /// Time between windows.
    pub time_step: Seconds,
    /// Length of the window.
    pub window: Seconds,
    /// Frequency between entries; the first is at zero.
    pub frequency_step: Hertz,
    /// Number of frequencies of each spectrum.
    pub frequencies: usize,
    /// Amplitudes in the unit of the trace, window by window; a tone of amplitude A gives A/2.
    pub amplitude: Vec<f64>,
}

impl ShortTimeSpectrum {
    /// Number of windows.
    pub fn times(&self) -> usize {
        self.amplitude.len() / self.frequencies.max(1)
    }
}

/// Computes spectra under a Hann window that moves along a trace.
///
/// The windows (an odd number of samples, the periodic Hann function) are centred on every sample, or on every k-th so that
/// there are at most 512; beyond its ends the trace counts as zero. Each is padded to a power of two of at least four
/// times its length and divided by the sum of the window: SciPy's `stft(..., boundary="zeros", scaling="spectrum")`.
///
/// # Errors
/// A window of fewer than three samples or longer than the trace.
pub fn short_time_spectrum(trace: &AScan, window: Seconds) -> Result<ShortTimeSpectrum, ProcessError> {
    let count = odd_count(trace, window)?;
    let hop = trace.samples.len().div_ceil(MOST_TIMES);
    let length = (4 * count).next_power_of_two();
    let hann: Vec<f64> =
        (0..count).map(|k| 0.5 - 0.5 * (2.0 * std::f64::consts::PI * k as f64 / count as f64).cos()).collect();
    let sum: f64 = hann.iter().sum();
    let transform = FftPlanner::new().plan_fft_forward(length);
    let frequencies = length / 2 + 1;
    let mut amplitude = Vec::new();
    for centre in (0..trace.samples.len()).step_by(hop) {
        let mut buffer = vec![Complex::new(0.0, 0.0); length];
        for (k, weight) in hann.iter().enumerate() {
            let sample = (centre + k).checked_sub(count / 2).and_then(|at| trace.samples.get(at));
            buffer[k].re = weight * sample.copied().unwrap_or(0.0) / sum;
        }
        transform.process(&mut buffer);
        amplitude.extend(buffer[..frequencies].iter().map(|v| v.norm()));
    }
    let dt = trace.time_step.si();
    Ok(ShortTimeSpectrum {
        first_time: trace.first_sample,
        time_step: Seconds(hop as f64 * dt),
        window: Seconds(count as f64 * dt),
        frequency_step: Hertz(1.0 / (length as f64 * dt)),
        frequencies,
        amplitude,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::trace;

    /// A tone that changes from 1 to 2 GHz in the middle: each half peaks at its own, with half its amplitude.
    #[test]
    fn a_change_of_tone_is_seen_when_it_happens() {
        let tone = trace("tone", 2000, 1e-11, |t| {
            let f = if t < 10e-9 { 1e9 } else { 2e9 };
            3.0 * (2.0 * std::f64::consts::PI * f * t).cos()
        });
        let found = short_time_spectrum(&tone, Seconds(4e-9)).unwrap();
        assert_eq!((found.times(), found.time_step), (500, Seconds(4e-11)));
        for (time, f) in [(5e-9, 1e9), (15e-9, 2e9)] {
            let at = (time / found.time_step.si()).round() as usize;
            let spectrum = &found.amplitude[at * found.frequencies..(at + 1) * found.frequencies];
            let peak = (0..spectrum.len()).max_by(|a, b| spectrum[*a].total_cmp(&spectrum[*b])).unwrap();
            assert!((peak as f64 * found.frequency_step.si() - f).abs() <= found.frequency_step.si());
            assert!((spectrum[peak] - 1.5).abs() < 0.02, "{}", spectrum[peak]);
        }
    }
}

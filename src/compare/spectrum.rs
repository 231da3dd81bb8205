//! Envelope and amplitude spectrum of a trace.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::trace::AScan;
use crate::units::{Hertz, Seconds};

/// Computes the envelope: the modulus of the analytic signal, as a trace on the same axis.
///
/// The trace and its mirror image go through the transform together: the cycle closes without a jump between the last and
/// the first sample, which would ring into both ends. An empty trace gives an empty envelope.
pub fn envelope(trace: &AScan) -> AScan {
    AScan { samples: envelope_of(&trace.samples), ..trace.clone() }
}

/// As [`envelope`], of samples.
pub(super) fn envelope_of(samples: &[f64]) -> Vec<f64> {
    let n = samples.len();
    let padded = samples.iter().chain(samples.iter().rev());
    let mut buffer: Vec<Complex<f64>> = padded.map(|v| Complex::new(*v, 0.0)).collect();
    let total = buffer.len();
    if total == 0 {
        return vec![];
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(total).process(&mut buffer);
    for (k, value) in buffer.iter_mut().enumerate() {
        *value *= match k {
            0 => 1.0,
            k if 2 * k == total => 1.0,
            k if 2 * k < total => 2.0,
            _ => 0.0,
        };
    }
    planner.plan_fft_inverse(total).process(&mut buffer);
    buffer[..n].iter().map(|v| v.norm() / total as f64).collect()
}

/// Amplitude spectrum of a trace, `|integral of x exp(-i omega t) dt|`.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Spectrum {
    /// Frequency between entries; the first is at zero.
    pub frequency_step: Hertz,
    /// Amplitude (unit of the trace times s), from zero to half the sampling rate.
    pub amplitude: Vec<f64>,
    /// Where the amplitude is largest, between entries by a parabola.
    pub peak_frequency: Hertz,
    /// Mean frequency, weighted by the square of the amplitude.
    pub centre_frequency: Hertz,
    /// Where the amplitude falls to 1/sqrt 2 of its largest, below and above the peak (the ends of the axis where it does
    /// not).
    pub band_3_db: (Hertz, Hertz),
}

impl Spectrum {
    /// Frequency of entry `index`, Hz.
    pub fn frequency(&self, index: usize) -> f64 {
        index as f64 * self.frequency_step.si()
    }
}

/// Computes the amplitude spectrum of a trace, padded with zeros to a power of two of at least four times its length.
pub fn spectrum(trace: &AScan) -> Spectrum {
    let length = (4 * trace.samples.len()).next_power_of_two();
    spectrum_of_length(&trace.samples, trace.time_step, length)
}

pub(super) fn spectrum_of_length(samples: &[f64], time_step: Seconds, length: usize) -> Spectrum {
    let mut buffer: Vec<Complex<f64>> = samples.iter().map(|v| Complex::new(*v, 0.0)).collect();
    buffer.resize(length, Complex::new(0.0, 0.0));
    FftPlanner::new().plan_fft_forward(length).process(&mut buffer);
    let amplitude: Vec<f64> = buffer[..=length / 2].iter().map(|v| v.norm() * time_step.si()).collect();
    let step = 1.0 / (length as f64 * time_step.si());
    let peak = (0..amplitude.len()).max_by(|a, b| amplitude[*a].total_cmp(&amplitude[*b])).unwrap_or(0);
    let power: f64 = amplitude.iter().map(|a| a * a).sum();
    let moment: f64 = amplitude.iter().enumerate().map(|(k, a)| k as f64 * a * a).sum();
    let centre = if power > 0.0 { moment / power } else { 0.0 };
    let level = amplitude[peak] / std::f64::consts::SQRT_2;
    let crossing = |inside: usize, outside: usize| {
        let share = (amplitude[inside] - level) / (amplitude[inside] - amplitude[outside]);
        inside as f64 + share * (outside as f64 - inside as f64)
    };
    let low = (0..peak).rev().find(|k| amplitude[*k] < level).map_or(0.0, |k| crossing(k + 1, k));
    let last = amplitude.len() - 1;
    let high = (peak + 1..=last).find(|k| amplitude[*k] < level).map_or(last as f64, |k| crossing(k - 1, k));
    Spectrum {
        frequency_step: Hertz(step),
        peak_frequency: Hertz((peak as f64 + vertex(&amplitude, peak).0) * step),
        centre_frequency: Hertz(centre * step),
        band_3_db: (Hertz(low * step), Hertz(high * step)),
        amplitude,
    }
}

/// Offset (in samples, within ±0.5) and height of the parabola through the samples around an extremum at `index`; the
/// sample itself at an end or on a plateau.
pub(super) fn vertex(samples: &[f64], index: usize) -> (f64, f64) {
    if index == 0 || index + 1 >= samples.len() {
        return (0.0, samples[index]);
    }
    let (left, middle, right) = (samples[index - 1], samples[index], samples[index + 1]);
    let curvature = left - 2.0 * middle + right;
    let offset = 0.5 * (left - right) / curvature;
    if offset.abs() <= 0.5 { (offset, middle - 0.25 * (left - right) * offset) } else { (0.0, middle) }
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;

    /// A Ricker is even about its centre, so its Hilbert transform is zero there and the envelope is the pulse: 1.
    #[test]
    fn envelope_of_a_ricker_is_one_at_its_centre() {
        let pulse = trace("pulse", 1000, 1e-11, |t| ricker(t - 5e-9));
        let envelope = envelope(&pulse);
        assert!((envelope.samples[500] - 1.0).abs() < 1e-6, "{}", envelope.samples[500]);
        assert!((envelope.peak() - 1.0).abs() < 1e-6);
        assert!(envelope.samples.iter().zip(&pulse.samples).all(|(e, v)| *e >= v.abs() - 1e-6));
    }

    /// A cosine of 12.5 periods, even about both ends: mirrored it closes, so its envelope is 1 up to the last sample. Taken
    /// as periodic by itself it would jump by 2 there.
    #[test]
    fn envelope_of_a_tone_is_flat_to_the_ends() {
        let n = 1234;
        let tone = trace("tone", n, 1.0, |t| (std::f64::consts::PI * 25.0 * (t + 0.5) / n as f64).cos());
        assert!(envelope(&tone).samples.iter().all(|v| (v - 1.0).abs() < 1e-11));
    }

    /// Parseval: the energy in time is that in frequency (both halves of the axis).
    #[test]
    fn parseval_holds() {
        let pulse = trace("pulse", 777, 1e-11, |t| ricker(t - 3e-9) + 0.2 * ricker(t - 5.2e-9));
        let spectrum = spectrum(&pulse);
        let time: f64 = pulse.samples.iter().map(|v| v * v).sum::<f64>() * 1e-11;
        let last = spectrum.amplitude.len() - 1;
        let twice = |k: usize| if k == 0 || k == last { 1.0 } else { 2.0 };
        let frequency: f64 = spectrum.amplitude.iter().enumerate().map(|(k, a)| twice(k) * a * a).sum();
        assert!((frequency * spectrum.frequency_step.si() / time - 1.0).abs() < 1e-12);
    }

    /// A Ricker's spectrum is f^2 exp(-f^2/fc^2): its peak is at fc, its -3 dB band ends where x e^(1-x) = 1/sqrt 2 with
    /// x = (f/fc)^2, and its mean frequency, weighted by the square, is fc Gamma(3)/Gamma(5/2)/sqrt 2 = 1.063846 fc.
    #[test]
    fn spectrum_of_a_ricker() {
        let spectrum = spectrum(&trace("pulse", 2000, 1e-11, |t| ricker(t - 10e-9)));
        assert!((spectrum.peak_frequency.si() / 1e9 - 1.0).abs() < 1e-4, "{:?}", spectrum.peak_frequency);
        assert!((spectrum.centre_frequency.si() / 1e9 - 1.063_846).abs() < 1e-4, "{:?}", spectrum.centre_frequency);
        for edge in [spectrum.band_3_db.0, spectrum.band_3_db.1] {
            let x = (edge.si() / 1e9).powi(2);
            assert!((x * (1.0 - x).exp() - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-3, "{edge}");
        }
        assert!(spectrum.band_3_db.0 < spectrum.peak_frequency && spectrum.peak_frequency < spectrum.band_3_db.1);
    }

    #[test]
    fn a_vertex_of_a_parabola_is_exact() {
        let samples: Vec<f64> = (0..5).map(|k| 2.0 - (f64::from(k) - 2.3).powi(2)).collect();
        let (offset, height) = vertex(&samples, 2);
        assert!((offset - 0.3).abs() < 1e-12 && (height - 2.0).abs() < 1e-12);
        assert_eq!(vertex(&samples, 0), (0.0, samples[0]));
    }
}

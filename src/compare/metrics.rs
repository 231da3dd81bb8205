//! How far apart two traces are.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::error::CompareError;
use super::picks::EchoPick;
use super::spectrum::{Spectrum, vertex};
use super::warp::TimeWarp;
use crate::trace::AScan;
use crate::units::{Hertz, Seconds};

/// Difference of the times of one echo, second trace minus first; none where one of them was not picked.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct TimeError {
    /// By the extremum of the waveform. Half a period off when the pick fell on another lobe.
    pub waveform: Option<Seconds>,
    /// By the peak of the envelope.
    pub envelope: Option<Seconds>,
}

impl TimeError {
    pub(super) fn of(a: &EchoPick, b: &EchoPick) -> Self {
        let pair = a.echo().zip(b.echo());
        Self {
            waveform: pair.map(|(a, b)| Seconds(b.waveform.time.si() - a.waveform.time.si())),
            envelope: pair.map(|(a, b)| Seconds(b.envelope.time.si() - a.envelope.time.si())),
        }
    }
}

/// Where two traces fit best.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct CrossCorrelation {
    /// The correlation of largest size, -1 to 1; negative when the traces have opposite sign.
    pub maximum: f64,
    /// By how much the second trace is later there, between samples by a parabola.
    pub lag: Seconds,
}

/// The metrics, in the order in which they matter.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Metrics {
    /// Time of the surface echo, second minus first.
    pub surface_time_error: TimeError,
    /// Time of the plate echo, second minus first.
    pub plate_time_error: TimeError,
    /// Largest normalised cross-correlation and its lag.
    pub cross_correlation: CrossCorrelation,
    /// Normalised correlation as the traces stand.
    pub zero_lag_correlation: f64,
    /// Root of the mean square of the difference, after normalisation.
    pub rmse: f64,
    /// `||b - a|| / ||a||`, after normalisation.
    pub relative_l2: f64,
    /// Difference that is left when each sample may come up to half a nanosecond early or late; none where the traces have
    /// too many samples for it.
    pub time_warp: Option<TimeWarp>,
    /// Correlation of the envelopes about their means.
    pub envelope_correlation: f64,
    /// Correlation of the amplitude spectra about their means, up to where both have fallen below 1 % of their peaks.
    pub spectral_correlation: f64,
    /// Peak frequency of the second spectrum minus that of the first.
    pub peak_frequency_shift: Hertz,
}

impl Metrics {
    /// Each number with its name and unit, in their order; none where it could not be had.
    pub fn named(&self) -> Vec<(&'static str, Option<f64>)> {
        let ns = |time: Option<Seconds>| time.map(|time| 1e9 * time.si());
        vec![
            ("surface echo, waveform, ns", ns(self.surface_time_error.waveform)),
            ("surface echo, envelope, ns", ns(self.surface_time_error.envelope)),
            ("plate echo, waveform, ns", ns(self.plate_time_error.waveform)),
            ("plate echo, envelope, ns", ns(self.plate_time_error.envelope)),
            ("largest cross-correlation", Some(self.cross_correlation.maximum)),
            ("its lag, ns", ns(Some(self.cross_correlation.lag))),
            ("correlation without lag", Some(self.zero_lag_correlation)),
            ("RMSE after normalisation", Some(self.rmse)),
            ("relative L2 difference", Some(self.relative_l2)),
            ("difference after time warping", self.time_warp.map(|warp| warp.distance)),
            ("correlation of envelopes", Some(self.envelope_correlation)),
            ("correlation of spectra", Some(self.spectral_correlation)),
            ("shift of the spectral peak, MHz", Some(1e-6 * self.peak_frequency_shift.si())),
        ]
    }
}

/// Computes the normalised cross-correlation, `sum a(t) b(t + lag) / (||a|| ||b||)`, of largest size within `max_lag`.
///
/// Beyond their ends the traces count as zero. Zero and lag zero where one of them is zero.
///
/// # Errors
/// Different steps or lengths.
pub fn cross_correlation(a: &AScan, b: &AScan, max_lag: Seconds) -> Result<CrossCorrelation, CompareError> {
    same_axis(a, b)?;
    let n = a.samples.len();
    let (norm_a, norm_b) = (norm(&a.samples), norm(&b.samples));
    if norm_a == 0.0 || norm_b == 0.0 {
        return Ok(CrossCorrelation { maximum: 0.0, lag: Seconds(0.0) });
    }
    let length = (2 * n).next_power_of_two();
    let padded = |samples: &[f64], norm: f64| {
        let mut buffer: Vec<Complex<f64>> = samples.iter().map(|v| Complex::new(*v / norm, 0.0)).collect();
        buffer.resize(length, Complex::new(0.0, 0.0));
        buffer
    };
    let (mut first, mut second) = (padded(&a.samples, norm_a), padded(&b.samples, norm_b));
    let mut planner = FftPlanner::new();
    let forward = planner.plan_fft_forward(length);
    forward.process(&mut first);
    forward.process(&mut second);
    for (x, y) in first.iter_mut().zip(&second) {
        *x = x.conj() * y;
    }
    planner.plan_fft_inverse(length).process(&mut first);
    let most = ((max_lag.si() / a.time_step.si()).floor().clamp(0.0, (n - 1) as f64)) as usize;
    // Lags -most..=most, in order.
    let ordered: Vec<f64> = (length - most..length).chain(0..=most).map(|k| first[k].re / length as f64).collect();
    // Of equals (a constant, a tone) the lag nearest to zero.
    let better = |x: usize, y: usize| {
        ordered[x].abs().total_cmp(&ordered[y].abs()).then(y.abs_diff(most).cmp(&x.abs_diff(most)))
    };
    let best = (0..ordered.len()).max_by(|x, y| better(*x, *y)).unwrap_or(most);
    let (offset, maximum) = vertex(&ordered, best);
    let lag = (best as f64 - most as f64 + offset) * a.time_step.si();
    // A symmetric peak at lag zero is at lag zero, whatever the last bits of the transform say.
    let lag = if lag.abs() < 1e-9 * a.time_step.si() { 0.0 } else { lag };
    Ok(CrossCorrelation { maximum: maximum.clamp(-1.0, 1.0), lag: Seconds(lag) })
}

/// Computes the normalised correlation of two traces as they stand, `sum a b / (||a|| ||b||)`; zero where one is zero.
///
/// # Errors
/// Different steps or lengths.
pub fn correlation(a: &AScan, b: &AScan) -> Result<f64, CompareError> {
    same_axis(a, b)?;
    Ok(cosine(&a.samples, &b.samples))
}

/// Computes `||b - a|| / ||a||` over the samples: 0 for equal traces, infinite where only `a` is zero.
///
/// The number for "two solvers agree": `a` is the reference. No step is applied; see [`compare`](super::compare) for that.
///
/// # Errors
/// Different steps or lengths, no samples.
pub fn relative_l2(a: &AScan, b: &AScan) -> Result<f64, CompareError> {
    same_axis(a, b)?;
    let difference: Vec<f64> = a.samples.iter().zip(&b.samples).map(|(a, b)| b - a).collect();
    let (above, below) = (norm(&difference), norm(&a.samples));
    Ok(if above == 0.0 { 0.0 } else { above / below })
}

/// Computes the root of the mean square of `b - a`.
///
/// # Errors
/// Different steps or lengths, no samples.
pub fn rmse(a: &AScan, b: &AScan) -> Result<f64, CompareError> {
    same_axis(a, b)?;
    let squares: f64 = a.samples.iter().zip(&b.samples).map(|(a, b)| (b - a).powi(2)).sum();
    Ok((squares / a.samples.len() as f64).sqrt())
}

pub(super) fn same_axis(a: &AScan, b: &AScan) -> Result<(), CompareError> {
    for trace in [a, b] {
        if trace.samples.is_empty() {
            return Err(CompareError::Empty { name: trace.name.clone() });
        }
    }
    // Over the whole trace the axes may drift apart by a hundredth of a sample.
    let drift = (a.time_step.si() - b.time_step.si()).abs() * a.samples.len() as f64;
    if a.samples.len() == b.samples.len() && drift <= 0.01 * a.time_step.si() {
        return Ok(());
    }
    Err(CompareError::DifferentAxes {
        a: a.name.clone(),
        samples_a: a.samples.len(),
        step_a: a.time_step,
        b: b.name.clone(),
        samples_b: b.samples.len(),
        step_b: b.time_step,
    })
}

pub(super) fn norm(samples: &[f64]) -> f64 {
    let largest = samples.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * samples.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let (norm_a, norm_b) = (norm(a), norm(b));
    if norm_a == 0.0 || norm_b == 0.0 {
        return 0.0;
    }
    a.iter().zip(b).map(|(a, b)| (a / norm_a) * (b / norm_b)).sum::<f64>().clamp(-1.0, 1.0)
}

/// Pearson's correlation: about the means.
pub(super) fn pearson(a: &[f64], b: &[f64]) -> f64 {
    let centred = |samples: &[f64]| {
        let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
        samples.iter().map(|v| v - mean).collect::<Vec<_>>()
    };
    cosine(&centred(a), &centred(b))
}

/// Pearson's correlation of two spectra on the same axis, up to where both stay below 1 % of their peaks.
pub(super) fn spectral_correlation(a: &Spectrum, b: &Spectrum) -> f64 {
    let last = |s: &Spectrum| {
        let largest = s.amplitude.iter().copied().fold(0.0, f64::max);
        s.amplitude.iter().rposition(|v| *v >= 0.01 * largest).unwrap_or(0)
    };
    let end = last(a).max(last(b)).min(a.amplitude.len().min(b.amplitude.len()).saturating_sub(1));
    pearson(&a.amplitude[..=end], &b.amplitude[..=end])
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;

    fn pulse(at: f64) -> AScan {
        trace("pulse", 1000, 1e-11, move |t| ricker(t - at))
    }

    #[test]
    fn a_trace_fits_itself_at_lag_zero() {
        let found = cross_correlation(&pulse(4e-9), &pulse(4e-9), Seconds(5e-9)).unwrap();
        assert!((found.maximum - 1.0).abs() < 1e-12 && found.lag.si() == 0.0, "{found:?}");
        assert_eq!(relative_l2(&pulse(4e-9), &pulse(4e-9)), Ok(0.0));
        assert_eq!(rmse(&pulse(4e-9), &pulse(4e-9)), Ok(0.0));
    }

    /// Shifts between samples come back to 1e-3 ns, of either sign, and flipped traces with a negative correlation.
    #[test]
    fn known_shifts_come_back() {
        for shift in [0.6973e-9, -1.2346e-9, 0.0021e-9] {
            let found = cross_correlation(&pulse(4e-9), &pulse(4e-9 + shift), Seconds(5e-9)).unwrap();
            assert!((found.lag.si() - shift).abs() < 1e-12 && found.maximum > 0.9999, "{found:?}");
            let (flipped, _) = super::super::steps::flip(&pulse(4e-9 + shift));
            let found = cross_correlation(&pulse(4e-9), &flipped, Seconds(5e-9)).unwrap();
            assert!((found.lag.si() - shift).abs() < 1e-12 && found.maximum < -0.9999, "{found:?}");
        }
    }

    /// Twice the trace is off by its own size, half of it by half; two separate pulses by sqrt 2.
    #[test]
    fn relative_l2_by_hand() {
        let (double, _) = super::super::steps::normalise(&pulse(4e-9), 0.5, "");
        assert!((relative_l2(&pulse(4e-9), &double).unwrap() - 1.0).abs() < 1e-12);
        assert!((relative_l2(&double, &pulse(4e-9)).unwrap() - 0.5).abs() < 1e-12);
        assert!((relative_l2(&pulse(2.5e-9), &pulse(7.5e-9)).unwrap() - 2.0_f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn different_axes_are_refused() {
        let short = trace("short", 900, 1e-11, |t| ricker(t - 4e-9));
        assert_eq!(
            relative_l2(&pulse(4e-9), &short).unwrap_err().to_string(),
            "`pulse` (1000 samples of 0.01 ns) and `short` (900 samples of 0.01 ns) are not on the same time axis\n\nhint: resample one onto the other first"
        );
        assert!(correlation(&pulse(4e-9), &trace("coarse", 1000, 2e-11, |_| 1.0)).is_err());
    }

    #[test]
    fn tiny_and_huge_amplitudes_do_not_over_or_underflow() {
        let scaled = |factor: f64| trace("scaled", 1000, 1e-11, move |t| factor * ricker(t - 4e-9));
        assert!((correlation(&scaled(1e-200), &scaled(1e200)).unwrap() - 1.0).abs() < 1e-12);
        assert!((relative_l2(&scaled(1e-200), &scaled(2e-200)).unwrap() - 1.0).abs() < 1e-12);
    }
}

//! Band-limited resampling.

use crate::trace::AScan;
use crate::units::Seconds;

/// Zero crossings of the sinc on each side.
const HALF_WIDTH: f64 = 32.0;
/// Shape of the Kaiser window: side lobes below 1e-5 of the pass band.
const KAISER_BETA: f64 = 10.0;

/// Resamples a trace onto `count` samples from `first`, every `time_step`.
///
/// A sinc under a Kaiser window (32 zero crossings each side, beta 10), cut off at half the lower of the two sampling
/// rates, so nothing is folded back when the new step is coarser. What lies below 0.9 of that cut-off comes through to
/// 1e-5 of its amplitude away from the ends. Beyond its ends the trace is mirrored; times beyond them by more than one
/// length give zero. Times that already are samples of the trace are copied bit for bit when the step stays.
///
/// `time_step` should be above zero.
pub fn resample(trace: &AScan, first: Seconds, time_step: Seconds, count: usize) -> AScan {
    let (old, new) = (trace.time_step.si(), time_step.si());
    let offset = (first.si() - trace.first_sample.si()) / old;
    let same_step = ((new - old) / old).abs() * count.max(1) as f64 <= 1e-6;
    let samples = if same_step && (offset - offset.round()).abs() < 1e-6 {
        let start = offset.round() as i64;
        (0..count as i64).map(|k| mirrored(&trace.samples, start + k)).collect()
    } else {
        let stretch = (new / old).max(1.0);
        (0..count).map(|k| interpolate(&trace.samples, offset + k as f64 * (new / old), stretch)).collect()
    };
    AScan { samples, time_step, first_sample: first, ..trace.clone() }
}

/// The value at the fractional index `at`; `stretch` widens the kernel when the new rate is lower.
fn interpolate(samples: &[f64], at: f64, stretch: f64) -> f64 {
    if !at.is_finite() || at.abs() > 4e15 {
        return 0.0;
    }
    let reach = HALF_WIDTH * stretch;
    let (from, to) = ((at - reach).ceil() as i64, (at + reach).floor() as i64);
    let (mut sum, mut weights) = (0.0, 0.0);
    for index in from..=to {
        let x = (at - index as f64) / stretch;
        let weight = sinc(x) * kaiser(x / HALF_WIDTH);
        sum += weight * mirrored(samples, index);
        weights += weight;
    }
    sum / weights
}

/// The sample at `index`, mirrored once about each end; zero further out.
fn mirrored(samples: &[f64], index: i64) -> f64 {
    let last = samples.len() as i64 - 1;
    let inside = if index < 0 {
        -index
    } else if index > last {
        2 * last - index
    } else {
        index
    };
    usize::try_from(inside).ok().and_then(|i| samples.get(i)).copied().unwrap_or(0.0)
}

fn sinc(x: f64) -> f64 {
    let y = std::f64::consts::PI * x;
    if y.abs() < 1e-8 { 1.0 } else { y.sin() / y }
}

fn kaiser(x: f64) -> f64 {
    if x.abs() >= 1.0 { 0.0 } else { bessel_i0(KAISER_BETA * (1.0 - x * x).sqrt()) / bessel_i0(KAISER_BETA) }
}

/// Modified Bessel function of order zero by its power series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut term, mut sum, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-17 * sum {
        term *= quarter / (k * k);
        sum += term;
        k += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;

    /// A Ricker of 1 GHz sampled at 49 ps (512 samples in 25 ns, as radars do) onto 7.3 ps: its spectrum is below 1e-8 at
    /// 0.9 of the cut-off, so only the 1e-5 of the kernel is left. Linear interpolation would be off by
    /// 6 pi^2 f^2 dt^2/8 = 1.8 %.
    #[test]
    fn a_pulse_comes_through_to_1e_5() {
        let coarse = trace("coarse", 512, 25e-9 / 512.0, |t| ricker(t - 8e-9));
        let fine = resample(&coarse, Seconds(0.0), Seconds(7.3e-12), 3300);
        for (t, v) in fine.times().zip(&fine.samples) {
            assert!((v - ricker(t - 8e-9)).abs() < 1e-5, "{v} at {t}");
        }
    }

    /// The new step of 50 ps cuts off at 10 GHz: 8.5 GHz stays to 1e-4, of 12 GHz less than that is left.
    #[test]
    fn a_tone_below_the_cut_off_stays_and_one_above_it_goes() {
        let tone = |f: f64| trace("tone", 4000, 1e-11, move |t| (2.0 * std::f64::consts::PI * f * t).sin());
        let below = resample(&tone(8.5e9), Seconds(10e-9), Seconds(50e-12), 400);
        for (t, v) in below.times().zip(&below.samples) {
            assert!((v - (2.0 * std::f64::consts::PI * 8.5e9 * t).sin()).abs() < 1e-4);
        }
        let above = resample(&tone(12e9), Seconds(10e-9), Seconds(50e-12), 400);
        assert!(above.peak() < 1e-4, "{}", above.peak());
    }

    #[test]
    fn times_that_are_samples_are_copied_bit_for_bit() {
        let pulse = trace("pulse", 300, 1e-11, |t| ricker(t - 1.5e-9));
        let part = resample(&pulse, Seconds(pulse.time(17)), pulse.time_step, 100);
        assert_eq!(part.samples, pulse.samples[17..117]);
    }

    #[test]
    fn a_constant_stays_a_constant() {
        let flat = trace("flat", 100, 1e-11, |_| 3.0);
        assert!(resample(&flat, Seconds(0.0), Seconds(3.7e-12), 260).samples.iter().all(|v| (v - 3.0).abs() < 1e-12));
    }

    /// I0(10) = 2815.716628466254 (Abramowitz and Stegun, table 9.8: e^-10 I0(10) = 0.1278333372).
    #[test]
    fn bessel_function_of_order_zero() {
        assert!((bessel_i0(10.0) * (-10.0_f64).exp() - 0.127_833_337_2).abs() < 1e-9);
    }
}

//! Running means and medians, and what they leave: dewow.

use super::error::ProcessError;
use super::section::Section;
use crate::compare::Step;
use crate::units::Seconds;

/// What is taken in a running window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Running {
    /// The mean: linear, so that spectra can be told; a strong echo leaves a shallow trough as long as the window.
    #[default]
    Mean,
    /// The median: a strong echo leaves less of a trough.
    Median,
}

impl std::fmt::Display for Running {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Mean => "mean",
            Self::Median => "median",
        })
    }
}

/// Takes a running mean or median off each trace: the slow drift (wow) goes, the pulses stay.
///
/// The window is centred and has an odd number of samples, `2 round(window / 2 dt) + 1`; beyond its ends a trace is
/// mirrored (the last sample counts twice), as SciPy's `uniform_filter1d` and `median_filter` do by default.
///
/// # Errors
/// A window of fewer than three samples or longer than the trace.
pub fn dewow<T: Section>(section: &T, window: Seconds, by: Running) -> Result<(T, Step), ProcessError> {
    let count = odd_count(section, window)?;
    let new = section.mapped(|trace| {
        let low = match by {
            Running::Mean => running_mean(trace, count),
            Running::Median => running_median(trace, count),
        };
        trace.iter().zip(low).map(|(v, low)| v - low).collect()
    });
    let window = Seconds(count as f64 * section.time_step().si());
    Ok((new, Step::Dewowed { window, samples: count, by }))
}

/// The odd number of samples in a window.
pub(super) fn odd_count<T: Section>(section: &T, window: Seconds) -> Result<usize, ProcessError> {
    let (time_step, length) = (section.time_step(), section.length());
    let half = (0.5 * window.si() / time_step.si()).round();
    let name = section.name().to_string();
    if half.is_nan() || half < 1.0 {
        let samples = if half.is_nan() || half < 0.0 { 0 } else { 1 };
        return Err(ProcessError::WindowShort { name, window, samples, time_step });
    }
    if 2.0 * half + 1.0 > length as f64 {
        let duration = crate::compare::error::rounded(length as f64 * time_step.si());
        return Err(ProcessError::WindowLong { name, window, duration });
    }
    Ok(2 * half as usize + 1)
}

/// The samples with `half` more at each end, mirrored about the ends with the last sample twice; `half` at most the length.
fn reflected(samples: &[f64], half: usize) -> Vec<f64> {
    let before = samples[..half].iter().rev();
    let after = samples[samples.len() - half..].iter().rev();
    before.chain(samples).chain(after).copied().collect()
}

/// Means over `count` samples (odd, at most the length) about each sample.
///
/// Each sum is made of two, from a block border backwards and forwards, so that nothing large is added and taken off again:
/// behind a strong pulse a running sum would keep its rounding error.
pub(super) fn running_mean(samples: &[f64], count: usize) -> Vec<f64> {
    let padded = reflected(samples, count / 2);
    let mut forward = padded.clone();
    let mut backward = padded;
    for block in forward.chunks_mut(count) {
        for k in 1..block.len() {
            block[k] += block[k - 1];
        }
    }
    for block in backward.chunks_mut(count) {
        for k in (1..block.len()).rev() {
            block[k - 1] += block[k];
        }
    }
    let sum = |start: usize| {
        let end = forward[start + count - 1];
        if start.is_multiple_of(count) { end } else { backward[start] + end }
    };
    (0..samples.len()).map(|start| sum(start) / count as f64).collect()
}

/// Medians over `count` samples (odd, at most the length) about each sample.
pub(super) fn running_median(samples: &[f64], count: usize) -> Vec<f64> {
    let padded = reflected(samples, count / 2);
    let mut sorted: Vec<f64> = padded[..count].to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut medians = Vec::with_capacity(samples.len());
    medians.push(sorted[count / 2]);
    for (gone, new) in padded.iter().zip(&padded[count..]) {
        let at = sorted.partition_point(|v| v.total_cmp(gone).is_lt());
        sorted.remove(at);
        let at = sorted.partition_point(|v| v.total_cmp(new).is_lt());
        sorted.insert(at, *new);
        medians.push(sorted[count / 2]);
    }
    medians
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{noise, ricker, trace};

    /// By hand, window of three: (1 + 1 + 2)/3, (1 + 2 + 6)/3, (2 + 6 + 6)/3.
    #[test]
    fn means_and_medians_by_hand() {
        assert_eq!(running_mean(&[1.0, 2.0, 6.0], 3), [4.0 / 3.0, 3.0, 14.0 / 3.0]);
        assert_eq!(running_median(&[1.0, 2.0, 6.0], 3), [1.0, 2.0, 6.0]);
        assert_eq!(running_median(&[5.0, -1.0, 7.0, 0.0, 2.0], 5), [5.0, 5.0, 2.0, 2.0, 2.0]);
    }

    /// Against the definition, over lengths and windows that are and are not multiples of each other.
    #[test]
    fn blocks_give_the_plain_sums() {
        for (length, count) in [(50, 3), (51, 17), (40, 39), (9, 9), (64, 21)] {
            let samples = noise(length, 5);
            let padded = reflected(&samples, count / 2);
            let plain = padded.windows(count).map(|w| w.iter().sum::<f64>() / count as f64);
            for (found, plain) in running_mean(&samples, count).iter().zip(plain) {
                assert!((found - plain).abs() < 1e-13);
            }
        }
    }

    /// A drift of twenty times the pulse goes, the pulse stays. The mean leaves of a ramp nothing away from the ends and of
    /// a 1 GHz Ricker (whose mean is zero) all but the trough of what the window cuts off; the samples of the pulse (1.3 ns)
    /// move the median by at most half the drift over them, 0.65.
    #[test]
    fn wow_goes_and_the_pulse_stays() {
        let wow = |t: f64| 20.0 * t / 20e-9;
        let drifting = trace("wow", 2000, 1e-11, |t| wow(t) + ricker(t - 10e-9));
        for (by, bound) in [(Running::Mean, 0.05), (Running::Median, 0.65)] {
            let (clean, step) = dewow(&drifting, Seconds(4e-9), by).unwrap();
            assert!(matches!(step, Step::Dewowed { samples: 401, .. }), "{step:?}");
            for k in 250..1750 {
                let kept = ricker(clean.time(k) - 10e-9);
                assert!((clean.samples[k] - kept).abs() < bound, "{by}: {} at {k}", clean.samples[k] - kept);
            }
        }
    }

    #[test]
    fn windows_that_do_not_fit_are_refused_word_for_word() {
        let pulse = trace("pulse", 500, 5e-11, |t| ricker(t - 5e-9));
        let message = |window: f64| dewow(&pulse, Seconds(window), Running::Mean).unwrap_err().to_string();
        let hint = "hint: a window of about the period of the lowest frequency of the pulse, for example 3ns for 500 MHz and above";
        assert_eq!(message(30e-9), format!("a window of 30 ns is longer than the traces of `pulse`, 25 ns\n\n{hint}"));
        assert_eq!(
            message(0.01e-9),
            format!(
                "a window of 0.01 ns holds 1 of the samples of `pulse` (0.05 ns apart): at least 3 are needed\n\n{hint}"
            )
        );
        assert!(message(f64::NAN).starts_with("a window of NaN ns holds 0 of") && message(-1.0).contains("holds 0 of"));
    }
}

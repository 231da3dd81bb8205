//! The steps that prepare a trace. Each takes a trace and gives a new one, with a [`Step`] for the report.

use super::error::{CompareError, rounded};
use super::picks::Event;
use super::process::{Running, Section};
use super::resample::resample;
use crate::trace::AScan;
use crate::units::{Hertz, Seconds};

/// What was done to a trace.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "step")]
pub enum Step {
    /// Another trace, times a factor, was taken off.
    Subtracted {
        /// Name of that trace.
        reference: String,
    },
    /// The mean was taken off.
    MeanRemoved {
        /// That mean; of several traces the mean of their means.
        mean: f64,
    },
    /// A running mean or median was taken off.
    Dewowed {
        /// Length of the window.
        window: Seconds,
        /// The same in samples.
        samples: usize,
        /// What was taken in the window.
        by: Running,
    },
    /// A Butterworth filter was run forwards and backwards.
    Filtered {
        /// Lower corner, if there is one.
        from: Option<Hertz>,
        /// Upper corner, if there is one.
        to: Option<Hertz>,
        /// Order of each of the two runs.
        order: usize,
    },
    /// The mean over traces was taken off.
    BackgroundRemoved {
        /// Traces in each mean.
        traces: usize,
        /// Whether the mean moved along the traces.
        moving: bool,
    },
    /// Means were put in the place of traces.
    Stacked {
        /// Traces there were.
        traces: usize,
        /// Traces that came out.
        into: usize,
        /// Which were left out, from 0.
        dropped: Vec<usize>,
    },
    /// Samples were multiplied by `exp(rate t) t^power`.
    GainByTime {
        /// The rate, 1/ns.
        rate_per_ns: f64,
        /// The power.
        power: f64,
    },
    /// Samples were divided by the level about them.
    GainByLevel {
        /// Length of the window.
        window: Seconds,
        /// The same in samples.
        samples: usize,
    },
    /// Traces gave way to their envelopes.
    EnvelopeTaken,
    /// The time axis was moved.
    TimeZeroSet {
        /// What happens at the new zero, for example `direct wave`.
        by: String,
        /// What was added to every time.
        shift: Seconds,
    },
    /// The trace was put onto another time axis.
    Resampled {
        /// The step before.
        from: Seconds,
        /// The step after.
        to: Seconds,
    },
    /// Only a window was kept.
    Cropped {
        /// Its first time.
        from: Seconds,
        /// Its last time.
        to: Seconds,
    },
    /// What lies outside a gate with soft ends was set to zero.
    Gated {
        /// Where its reference is.
        around: Seconds,
        /// Kept before that.
        before: Seconds,
        /// Kept after that.
        after: Seconds,
        /// Length of the soft ends, inside what is kept.
        taper: Seconds,
    },
    /// The sign was turned.
    Flipped,
    /// The amplitude was divided by a number.
    Normalised {
        /// What that number is, for example `plate echo`.
        by: String,
        /// The number.
        divisor: f64,
    },
}

impl std::fmt::Display for Step {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Subtracted { reference } => write!(f, "`{reference}` subtracted"),
            Self::MeanRemoved { mean } => write!(f, "mean of {mean:.3e} removed"),
            Self::Dewowed { window, samples, by } => {
                write!(f, "running {by} over {} ({samples} samples) removed", rounded(window.si()))
            }
            Self::Filtered { from, to, order } => {
                match (from, to) {
                    (Some(from), Some(to)) => write!(f, "band-pass {from} to {to}")?,
                    (Some(from), None) => write!(f, "high-pass {from}")?,
                    (None, Some(to)) => write!(f, "low-pass {to}")?,
                    (None, None) => f.write_str("no filter")?,
                }
                write!(f, ", Butterworth order {order} forwards and backwards")
            }
            Self::BackgroundRemoved { traces, moving: true } => write!(f, "moving mean of {traces} traces removed"),
            Self::BackgroundRemoved { traces, moving: false } => write!(f, "mean of all {traces} traces removed"),
            Self::Stacked { traces, into, dropped } => {
                write!(f, "{traces} traces stacked into {into}, ")?;
                match dropped.as_slice() {
                    [] => f.write_str("none dropped"),
                    [one] => write!(f, "trace {one} dropped (from 0)"),
                    many if many.len() <= 8 => {
                        let names: Vec<String> = many.iter().map(ToString::to_string).collect();
                        write!(f, "traces {} dropped (from 0)", names.join(", "))
                    }
                    many => write!(f, "{} dropped", many.len()),
                }
            }
            Self::GainByTime { rate_per_ns, power } => write!(f, "gain of exp({rate_per_ns} t/ns) (t/ns)^{power}"),
            Self::GainByLevel { window, samples } => {
                write!(f, "divided by the level over {} ({samples} samples)", rounded(window.si()))
            }
            Self::EnvelopeTaken => f.write_str("envelope taken"),
            Self::TimeZeroSet { by, shift } => write!(f, "time zero at the {by} (moved by {})", rounded(shift.si())),
            Self::Resampled { from, to } => {
                write!(f, "resampled from {} to {}", rounded(from.si()), rounded(to.si()))
            }
            Self::Cropped { from, to } => write!(f, "cropped to {} to {}", rounded(from.si()), rounded(to.si())),
            Self::Gated { around, before, after, taper } => write!(
                f,
                "gated from {} before {} to {} after it, ends of {}",
                rounded(before.si()),
                rounded(around.si()),
                rounded(after.si()),
                rounded(taper.si())
            ),
            Self::Flipped => write!(f, "polarity flipped"),
            Self::Normalised { by, divisor } => write!(f, "divided by the {by}, {divisor:.4e}"),
        }
    }
}

/// Takes off the mean of the samples, of each trace its own.
pub fn remove_dc<T: Section>(section: &T) -> (T, Step) {
    let mut means = 0.0;
    let new = section.mapped(|trace| {
        let mean = trace.iter().sum::<f64>() / trace.len().max(1) as f64;
        means += mean;
        trace.iter().map(|v| v - mean).collect()
    });
    (new, Step::MeanRemoved { mean: means / section.traces().max(1) as f64 })
}

/// Takes another trace off each, for example one in free space, which leaves them without their direct wave.
///
/// The reference is resampled onto the axis of the section; beyond its ends it counts as zero.
pub fn subtract_reference<T: Section>(section: &T, reference: &AScan) -> (T, Step) {
    let onto = resample(reference, section.first_sample(), section.time_step(), section.length());
    let last = reference.time(reference.samples.len().saturating_sub(1));
    let slack = 1e-6 * section.time_step().si();
    let covered = (reference.first_sample.si() - slack)..=(last + slack);
    let taken: Vec<f64> =
        onto.times().zip(&onto.samples).map(|(t, r)| if covered.contains(&t) { *r } else { 0.0 }).collect();
    let new = section.mapped(|trace| trace.iter().zip(&taken).map(|(v, r)| v - r).collect());
    (new, Step::Subtracted { reference: reference.name.clone() })
}

/// Moves the time axis so that what happens at `event_time` happens at `becomes`.
pub fn set_time_zero<T: Section>(section: &T, event_time: Seconds, becomes: Seconds, by: &str) -> (T, Step) {
    let shift = Seconds(becomes.si() - event_time.si());
    let first_sample = Seconds(section.first_sample().si() + shift.si());
    (section.moved(first_sample), Step::TimeZeroSet { by: by.into(), shift })
}

/// Resamples a trace over its own time window with another step, by [`resample`].
pub fn resample_to_step(trace: &AScan, time_step: Seconds) -> (AScan, Step) {
    let duration = trace.samples.len().saturating_sub(1) as f64 * trace.time_step.si();
    let count = (duration / time_step.si() + 1e-9).floor() as usize + 1;
    let step = Step::Resampled { from: trace.time_step, to: time_step };
    (resample(trace, trace.first_sample, time_step, count), step)
}

/// A trace over its own window with another step; the trace itself where it has that step already.
pub(super) fn resample_to(trace: &AScan, time_step: f64) -> AScan {
    if (trace.time_step.si() / time_step - 1.0).abs() * trace.samples.len() as f64 <= 1e-6 {
        return trace.clone();
    }
    resample_to_step(trace, Seconds(time_step)).0
}

/// Keeps the samples between two times, both included.
///
/// # Errors
/// Fewer than two samples inside.
pub fn crop<T: Section>(section: &T, from: Seconds, to: Seconds) -> Result<(T, Step), CompareError> {
    let slack = 1e-6 * section.time_step().si();
    let inside = |k: &usize| (from.si() - slack..=to.si() + slack).contains(&section.time_of(*k));
    let indices: Vec<usize> = (0..section.length()).filter(inside).collect();
    let (Some(&start), Some(&end), 2..) = (indices.first(), indices.last(), indices.len()) else {
        return Err(CompareError::Window {
            name: section.name().into(),
            from,
            to,
            samples: indices.len(),
            first: rounded(section.first_sample().si()),
            last: rounded(section.time_of(section.length().saturating_sub(1))),
            least: 2,
        });
    };
    let (first, last) = (Seconds(section.time_of(start)), Seconds(section.time_of(end)));
    let new = section.rebuilt(first, section.time_step(), |trace| trace[start..=end].to_vec())?;
    Ok((new, Step::Cropped { from: first, to: last }))
}

/// Turns the sign of every sample.
pub fn flip<T: Section>(section: &T) -> (T, Step) {
    (section.mapped(|trace| trace.iter().map(|v| -v).collect()), Step::Flipped)
}

/// Divides every sample by `divisor`, which should not be zero.
pub fn normalise<T: Section>(section: &T, divisor: f64, by: &str) -> (T, Step) {
    let new = section.mapped(|trace| trace.iter().map(|v| v / divisor).collect());
    (new, Step::Normalised { by: by.into(), divisor })
}

/// Time of the first local extremum of at least a quarter of the largest amplitude, between samples by a parabola.
///
/// # Errors
/// No such extremum: the trace only rises or falls.
pub fn first_peak(trace: &AScan) -> Result<Seconds, CompareError> {
    let (samples, least) = (&trace.samples, 0.25 * trace.peak());
    let is_peak = |k: &usize| {
        let (left, middle, right) = (samples[k - 1].abs(), samples[*k].abs(), samples[k + 1].abs());
        middle >= least && left < middle && middle >= right
    };
    let found = (1..samples.len().saturating_sub(1)).find(is_peak).ok_or_else(|| CompareError::NoEvent {
        name: trace.name.clone(),
        event: Event::DirectWave,
        purpose: "set the time zero by",
        reason: super::picks::NoEcho::NoPeakInWindow {
            from: rounded(trace.first_sample.si()),
            to: rounded(trace.time(samples.len().saturating_sub(1))),
        },
    })?;
    let (offset, _) = super::spectrum::vertex(samples, found);
    Ok(Seconds(trace.time(found) + offset * trace.time_step.si()))
}

#[cfg(test)]
pub(in crate::compare) mod test_traces {
    use crate::trace::{AScan, Component};
    use crate::units::Seconds;

    /// A Ricker pulse of 1 GHz with its unit peak at zero.
    pub fn ricker(t: f64) -> f64 {
        let a = (std::f64::consts::PI * 1e9 * t).powi(2);
        (1.0 - 2.0 * a) * (-a).exp()
    }

    /// A trace of a function of time.
    pub fn trace(name: &str, count: usize, dt: f64, of: impl Fn(f64) -> f64) -> AScan {
        AScan {
            samples: (0..count).map(|k| of(k as f64 * dt)).collect(),
            time_step: Seconds(dt),
            first_sample: Seconds(0.0),
            component: Component::Ez,
            position: None,
            name: name.into(),
        }
    }

    /// White noise of unit standard deviation: sums of twelve uniform numbers.
    pub fn noise(count: usize, seed: u64) -> Vec<f64> {
        use rand::{RngExt as _, SeedableRng as _};
        let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
        (0..count).map(|_| (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::test_traces::{ricker, trace};
    use super::*;

    #[test]
    fn the_mean_goes_and_only_the_mean() {
        let (clean, step) = remove_dc(&trace("offset", 1000, 1e-11, |t| 0.25 + ricker(t - 5e-9)));
        assert!(clean.samples.iter().sum::<f64>().abs() < 1e-12);
        assert!(matches!(step, Step::MeanRemoved { mean } if (mean - 0.25).abs() < 1e-6), "{step:?}");
    }

    /// The free-space run has another step and is shorter; what is left is the echo, to the 1e-5 of the resampling.
    #[test]
    fn the_direct_wave_goes_with_the_free_space_run() {
        let full = trace("full", 1000, 1e-11, |t| ricker(t - 2e-9) + 0.1 * ricker(t - 7e-9));
        let free = trace("free space", 300, 1.7e-11, |t| ricker(t - 2e-9));
        let (left, step) = subtract_reference(&full, &free);
        assert!(left.times().zip(&left.samples).all(|(t, v)| (v - 0.1 * ricker(t - 7e-9)).abs() < 2e-5));
        assert_eq!(step.to_string(), "`free space` subtracted");
    }

    #[test]
    fn crop_and_time_zero_move_what_they_say() {
        let pulse = trace("pulse", 1000, 1e-11, |t| ricker(t - 2.003e-9));
        let peak = first_peak(&pulse).unwrap();
        // The first extremum with a quarter of the peak is the side lobe, sqrt(3/2)/(pi f) = 0.38985 ns ahead.
        assert!((peak.si() - (2.003e-9 - 0.389_848e-9)).abs() < 1e-12, "{peak}");
        let (zeroed, step) = set_time_zero(&pulse, Seconds(2.003e-9), Seconds(0.0), "first peak");
        assert!((zeroed.first_sample.si() + 2.003e-9).abs() < 1e-20);
        assert_eq!(step.to_string(), "time zero at the first peak (moved by -2.003 ns)");
        let (window, step) = crop(&zeroed, Seconds(-1e-9), Seconds(1e-9)).unwrap();
        assert_eq!(window.samples.len(), 200);
        assert_eq!(step.to_string(), "cropped to -0.993 ns to 0.997 ns");
        assert_eq!(
            crop(&pulse, Seconds(20e-9), Seconds(30e-9)).unwrap_err().to_string(),
            "the window 20 ns to 30 ns holds 0 samples of `pulse` (0 ns to 9.99 ns): at least 2 are needed"
        );
    }

    #[test]
    fn a_new_step_keeps_the_window() {
        let pulse = trace("pulse", 1001, 1e-11, |t| ricker(t - 5e-9));
        let (coarse, step) = resample_to_step(&pulse, Seconds(4e-11));
        assert_eq!(coarse.samples.len(), 251);
        assert!(coarse.times().zip(&coarse.samples).all(|(t, v)| (v - ricker(t - 5e-9)).abs() < 1e-5));
        assert_eq!(step.to_string(), "resampled from 0.01 ns to 0.04 ns");
    }

    #[test]
    fn a_ramp_has_no_first_peak() {
        let ramp = trace("ramp", 10, 1e-11, |t| t);
        assert_eq!(
            first_peak(&ramp).unwrap_err().to_string(),
            "`ramp` has no direct wave to set the time zero by: the envelope has no peak between 0 ns and 0.09 ns\n\nhint: give its time, or choose another rule"
        );
    }
}
